"""What runs again after a change, and what does not: real Snakemake, real files."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import pytest
import xarray as xr

from tests.workflow.conftest import STUDY, TINY, Project

pytestmark = [pytest.mark.workflow, pytest.mark.slow]

SIMULATIONS = {"simulate_case:F11", "simulate_case:F13", "simulate_case:X"}
FIGURES = {"draw_figure:fig11", "draw_figure:fig13"}
TABLES = {"merge_cases", "check_claims", "describe_study"}
KERNELS = {"warm:simulate-rigid_vertical", "warm:floquet-rigid_vertical"}
EVERYTHING = SIMULATIONS | FIGURES | TABLES


def test_the_study_is_complete(finished: Project) -> None:
    results = finished.folder / "results" / "tiny"
    for name in ("fig11", "fig13"):
        assert (results / "figures" / f"{name}.pdf").read_bytes().startswith(b"%PDF")
        assert (results / "figures" / f"{name}.png").stat().st_size > 10_000
    assert (results / "claims.csv").read_text().startswith("id,location,claim,paper_value,ours")
    assert (results / "claims.md").read_text().startswith("# ")
    with xr.open_dataset(results / "cases.nc") as table:
        assert list(table["case"].values) == ["F11", "F13", "X"]
        assert list(table["Omega"].values) == [15, 15.1, 20]
    assert not list(results.rglob("*.tmp"))


def test_second_run_does_nothing(project: Project) -> None:
    before = {path: path.stat().st_mtime_ns for path in (project.folder / "results").rglob("*")}
    assert "Nothing to be done" in project.complete("-j2")
    assert before == {path: path.stat().st_mtime_ns for path in (project.folder / "results").rglob("*")}


def test_the_default_is_the_paper_with_the_fast_scheduler(project: Project) -> None:
    usual = replace(project, config=None)
    jobs = usual.planned()
    assert {"simulate_case:F02", "simulate_case:F13", "draw_figure:fig02"} <= jobs
    assert "simulate_case:X" not in jobs
    assert "profiles/default" in usual.complete("-n")


def test_another_study_does_not_inherit_the_papers_cases(project: Project) -> None:
    jobs = replace(project, config="config/test.yaml").planned()
    cases = {job for job in jobs if job.startswith("simulate_case")}
    assert cases == {f"simulate_case:{name}" for name in ("F02", "F04", "F11", "F13")}


@pytest.mark.parametrize(
    ("old", "new", "jobs"),
    [
        ("Omega: 15.1", "Omega: 15.2", {"simulate_case:F13", "draw_figure:fig13"}),
        ("title: quiet", "title: calm", set()),
        ("figures:", "  Y: {title: new, parameters: {N: 100, Omega: 20}, t_end: 2}\nfigures:", {"simulate_case:Y"}),
    ],
    ids=["value", "title", "case"],
)
def test_a_change_of_a_case_runs_that_case_and_what_shows_it(project: Project, old: str, new: str, jobs: set) -> None:
    project.edit(TINY, old, new)
    assert project.planned() == jobs | TABLES


def test_other_spelling_and_order_run_nothing(project: Project) -> None:
    lines = STUDY.replace("N: 385, Omega: 15}", "Omega: 1.50e+1, N: 385.0}").splitlines()
    cases = lines.index("cases:")
    lines[cases + 1 : cases + 4] = reversed(lines[cases + 1 : cases + 4])
    (project.folder / TINY).write_text("\n".join(lines))
    assert project.planned() == set()


def test_a_removed_case_leaves_the_merged_file(project: Project) -> None:
    project.edit(TINY, "  X: {title: another, parameters: {N: 200, Omega: 20}, t_end: 2}\n", "")
    assert project.planned() == TABLES
    project.complete("-j2")
    with xr.open_dataset(project.folder / "results" / "tiny" / "cases.nc") as table:
        assert list(table["case"].values) == ["F11", "F13"]


def test_what_is_said_of_sources_runs_nothing(project: Project) -> None:
    """Neither their times nor comments nor docstrings."""
    for folder in ("src", "workflow/scripts"):
        for path in (project.folder / folder).rglob("*.py"):
            path.write_text(path.read_text() + "\n# a comment\n")
    api = "src/disc_model/simulation/api.py"
    project.edit(api, "def simulate(", '"""Of what follows."""\n\n\ndef simulate(')
    os.utime(project.folder / TINY)
    assert project.planned() == set()


@pytest.mark.parametrize(
    ("source", "jobs"),
    [
        ("src/disc_model/engine/machine.py", KERNELS | EVERYTHING),
        ("src/disc_model/plate.py", EVERYTHING),
        ("src/disc_model/simulation/api.py", EVERYTHING),
        ("src/disc_model/parameters.py", EVERYTHING),
        ("src/disc_model/figures/paper/histories.py", FIGURES),
        ("src/disc_model/figures/disc_model.mplstyle", FIGURES),
        ("src/disc_model/figures/parts.py", FIGURES),
        ("workflow/scripts/draw_figure.py", FIGURES),
        # the provenance page and the ledger are laid out alike
        ("src/disc_model/claims/section42.py", {"check_claims", "describe_study"}),
        ("src/disc_model/claims/section42.yaml", {"check_claims", "describe_study"}),
        ("src/disc_model/studies/cases.py", TABLES),
        ("workflow/scripts/simulate_case.py", SIMULATIONS | FIGURES | TABLES),
        ("src/disc_model/cli/run.py", set()),
        ("src/disc_model/studies/study.py", set()),
    ],
)
def test_sources_run_what_uses_them_and_no_more(project: Project, source: str, jobs: set[str]) -> None:
    project.change(source)
    assert project.planned() == jobs


def test_deleted_intermediate_is_not_missed_but_a_deleted_figure_is(project: Project) -> None:
    (project.folder / "results" / "tiny" / "cases" / "X.nc").unlink()
    assert project.planned() == set()
    (project.folder / "results" / "tiny" / "figures" / "fig11.png").unlink()
    assert project.planned() == {"draw_figure:fig11"}


def test_equal_sources_give_equal_results(project: Project) -> None:
    case = project.folder / "results" / "tiny" / "cases" / "F13.nc"
    before = case.read_bytes()
    project.complete("-j2", "--force", str(case.relative_to(project.folder)))
    assert case.read_bytes() == before


def test_an_interrupted_run_goes_on(project: Project, tmp_path: Path) -> None:
    """A job that dies in the middle of writing leaves nothing that is taken for a result."""
    project.edit(TINY, "t_end: 2}\nfigures", "t_end: 3}\nfigures")
    source, lives, dies = "src/disc_model/data/dataset.py", "os.replace(temporary, path)", "os.kill(os.getpid(), 9)"
    project.edit(source, lives, dies)
    project.refused("-j2")
    assert not (project.folder / "results" / "tiny" / "cases" / "X.nc").exists()
    project.edit(source, dies, lives)
    project.complete("-j2")
    assert project.planned() == set()
