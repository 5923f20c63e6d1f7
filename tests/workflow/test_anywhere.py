"""The workflow outside its repository's folder: from elsewhere, as a module, without the package
installed."""

import os
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


def test_neither_the_environment_nor_the_locale_matters(tmp_path: Path) -> None:
    """A shell executed parts of the folder's name, a title that is not ASCII ended the merge, jobs
    called a `python` of another version, and drew as a notebook had chosen."""
    environment = tmp_path / 'we$ird `touch EXECUTED` "x'
    environment.symlink_to(sys.prefix)
    other = tmp_path / "python"
    other.write_text("#!/bin/sh\necho another version >&2\nexit 99\n")
    other.chmod(0o755)
    (tmp_path / "mine.yaml").write_text(
        STUDY.replace("itle: Growth", "itle: Grüße Ω, growth").replace("P_{max}", "Größe P_{max}"),
        encoding="utf-8",
    )
    variables = {
        "LC_ALL": "C",
        "PYTHONUTF8": "0",
        "PYTHONCOERCECLOCALE": "0",
        "PATH": os.pathsep.join([str(tmp_path), os.environ["PATH"]]),
        "MPLBACKEND": "module://no_such_module.backend",
    }
    command = [environment / "bin" / "python3", "-m", "snakemake", "-s", SNAKEFILE]
    command += ["--configfile", "mine.yaml", "-j2"]
    run(*command, cwd=tmp_path, timeout=900, **variables)
    assert not (tmp_path / "EXECUTED").exists()
    assert (tmp_path / "results/mine/figures/growth.png").read_bytes().startswith(b"\x89PNG")
    with xr.open_dataset(tmp_path / "results/mine/mine.nc") as study:
        assert study.attrs["title"].startswith("Grüße Ω")


def test_a_profile_that_looks_at_times_alone_leaves_nothing_out_of_date(tmp_path: Path) -> None:
    """Results of the former values stayed, and nothing was said."""
    (tmp_path / "config.yaml").write_text("rerun-triggers: [mtime]\n")
    made = tmp_path / "results" / "mine"

    def results(text: str) -> tuple[xr.Dataset, bytes]:
        (tmp_path / "mine.yaml").write_text(text)
        command = [sys.executable, "-m", "disc_model", "study", "mine.yaml", "-j2"]
        run(*command, cwd=tmp_path, timeout=300, SNAKEMAKE_PROFILE=str(tmp_path))
        return xr.load_dataset(made / "mine.nc"), (made / "figures" / "growth.png").read_bytes()

    before, picture = results(STUDY)
    after, _ = results(STUDY.replace("N: 200", "N: 210"))
    assert not after["growth_rate"].equals(before["growth_rate"])
    again, other_picture = results(STUDY.replace("variable: growth_rate", "variable: period"))
    xr.testing.assert_identical(again, before)
    assert other_picture != picture


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
