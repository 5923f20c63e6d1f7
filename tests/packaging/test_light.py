"""The numerics alone: what a plain installation can do, and that what is written of versions
agrees."""

import re
import tomllib
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

import disc_model
from tests.processes import python

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
EXTRAS = PROJECT["project"]["optional-dependencies"]
MODULES = {"pyyaml": "yaml", "netcdf4": "netCDF4"}
"""How packages are imported, where not by their name."""

# Modules that a plain installation lacks cannot be imported here either.
HIDDEN = """\
import importlib.abc, sys

class Hidden(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in MISSING:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name.partition(".")[0])

sys.meta_path.insert(0, Hidden())
"""
USE = """\
import disc_model as dm

for name in dir(dm):
    getattr(dm, name)
p = dm.Parameters(N=200, Omega=20, n_diameters=1, normalization="orthonormal")
result = dm.simulate(p, 0.02, {"late": dm.Window(last=0.01, rate=1000)})
result.save(sys.argv[1])
assert dm.load(sys.argv[1])["late/P"].sizes["time"] == 11
assert len(result.events) == result.statistics["n_events"]
dm.deflection(p, dm.snapshots(p, [0.0, 0.01]), p.r_0, 0.0)
dm.plate_modes(p), dm.residual_flexibility(p), dm.choose_modes(p.replace(n_diameters=4), 0.1)
try:
    result.plot()
except ImportError as error:
    assert str(error) == "there is no module matplotlib: pip install 'disc_model[plot]'"
else:
    raise AssertionError("it was drawn")

from disc_model.cli import main

def code(*command):
    try:
        main([*command])
    except SystemExit as ended:
        return ended.code

assert code("run", "N=1", "Omega=1", "--t-end", "1", "--plot", "x.png") == 2
assert not code("modes", "normalization=orthonormal")
assert not code("run", "N=200", "Omega=20", "--t-end", "0.02")
main(["study", "my.yaml"])
"""


def names(lines: list[str]) -> set[str]:
    """Canonical names of the packages that lines require; comments and options of pip require
    none."""
    texts = (line.split("#")[0].strip() for line in lines)
    wanted = [text for text in texts if text and not text.startswith("-")]
    return {canonicalize_name(Requirement(text).name) for text in wanted} - {"disc-model"}


def test_the_numerics_need_nothing_of_the_workflow(tmp_path: Path) -> None:
    missing = sorted(
        MODULES.get(name, name) for name in names([*EXTRAS["workflow"], *EXTRAS["plot"]])
    )
    path = tmp_path / "run.nc"
    done = python(f"MISSING = {missing}\n{HIDDEN}{USE}", path, fails=True)
    assert done.returncode == 2, done.stdout + done.stderr
    assert "Disc alone" in done.stdout
    assert done.stderr.count("pip install 'disc_model[workflow]'") == 1
    assert done.stderr.endswith(
        "error: there is no module snakemake.cli: pip install 'disc_model[workflow]'\n"
    )


def test_there_is_one_version() -> None:
    assert PROJECT["project"]["dynamic"] == ["version"]
    assert PROJECT["tool"]["setuptools"]["dynamic"]["version"] == {"attr": "disc_model.__version__"}
    cited = re.search(
        r"^version: (\S+)$", (ROOT / "CITATION.cff").read_text(encoding="utf-8"), re.MULTILINE
    )
    assert cited
    assert cited[1] == disc_model.__version__
    released = re.findall(
        r"^## (\d\S*)", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE
    )
    assert released[:1] in ([], [disc_model.__version__])
