"""The workflow outside its repository's folder: from elsewhere, as a module, without the package
installed."""

import re
import sys
from pathlib import Path

import pytest
import xarray as xr

from tests.processes import run
from tests.workflow.conftest import BRACES as STUDY
from tests.workflow.conftest import ROOT

pytestmark = pytest.mark.slow

SNAKEFILE = ROOT / "workflow" / "Snakefile"
MODULE = f"""\
configfile: "config.yaml"

module vibration:
    snakefile: "{SNAKEFILE}"
    config: config["vibration"]

use rule * from vibration as vibration_*

rule all:
    default_target: True
    input: rules.vibration_all.input
"""


def snakemake(folder: Path, *options: str | Path, fails: bool = False) -> str:
    """What Snakemake says in a folder, where it has to succeed, or to fail."""
    done = run(sys.executable, "-m", "snakemake", *options, cwd=folder, fails=fails, timeout=900)
    return done.stdout + done.stderr


@pytest.fixture(scope="module")
def elsewhere(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a study of both kinds, its name with what a shell would take apart, computed
    there."""
    folder = tmp_path_factory.mktemp("else where & {more}")
    (folder / "mine.yaml").write_text(STUDY)
    snakemake(
        ROOT, "-j2", "-s", SNAKEFILE, "--directory", folder, "--configfile", folder / "mine.yaml"
    )
    return folder


def test_a_study_is_computed_in_another_folder(elsewhere: Path) -> None:
    made = {path.name for path in (elsewhere / "results" / "mine").rglob("*.*")}
    assert {"mine.nc", "growth.png", "growth.pdf", "seen.png", "provenance.html"} <= made
    assert not [name for name in made if name.startswith(("claims", "table"))], (
        "nobody asked for them"
    )


def test_neither_the_folder_of_the_environment_nor_the_locale_matters(tmp_path: Path) -> None:
    """A shell executed parts of the folder's name, and a title that is not ASCII ended the
    merge."""
    environment = tmp_path / 'we$ird `touch EXECUTED` "x'
    environment.symlink_to(sys.prefix)
    mine_path = tmp_path / "mine.yaml"
    mine_path.write_text(
        STUDY.replace("itle: Growth", "itle: Grüße Ω, growth").replace("P_{max}", "Größe P_{max}"),
        encoding="utf-8",
    )
    plain = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    command = (
        environment / "bin" / "python",
        "-m",
        "snakemake",
        "-s",
        SNAKEFILE,
        "--configfile",
        "mine.yaml",
    )
    run(*command, "-j2", cwd=tmp_path, timeout=900, **plain)
    executed_path = tmp_path / "EXECUTED"
    assert not executed_path.exists()
    mine_file = tmp_path / "results" / "mine" / "mine.nc"
    with xr.open_dataset(mine_file) as study:
        assert study.attrs["title"].startswith("Grüße Ω")


def test_all_is_made_by_default_wherever_the_snakefile_is(tmp_path: Path) -> None:
    """What an included file makes by default is not the default: the root's made nothing, and said
    that all was so."""
    mine_path = tmp_path / "mine.yaml"
    mine_path.write_text(STUDY)
    for place in (ROOT / "Snakefile", SNAKEFILE):
        assert re.search(
            r"^draw_figure +2$",
            snakemake(tmp_path, "-n", "-s", place, "--configfile", "mine.yaml"),
            re.M,
        )
    phrase = snakemake(tmp_path, "-n", "-s", ROOT / "Snakefile", "results/paper/figures/fig13.pdf")
    assert re.search(r"^simulate_case +2$", phrase, re.M), (
        "the two cases of the paper's figure, if no study is given"
    )


def test_it_is_a_module_of_another_workflow(elsewhere: Path, tmp_path: Path) -> None:
    snakefile_path = tmp_path / "Snakefile"
    snakefile_path.write_text(MODULE)
    study = "".join(f"  {line}\n" for line in STUDY.splitlines())
    config_path = tmp_path / "config.yaml"
    config_path.write_text(f"mine: 3\nvibration:\n{study}")
    snakemake(tmp_path, "-j2")
    mine_path = tmp_path / "results" / "mine"
    for name in ("mine.nc", "cases/A.nc"):
        assert (mine_path / name).is_file()
