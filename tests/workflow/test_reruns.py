"""What runs again after a change, and what does not: real Snakemake, real files."""

import os
import re
from collections.abc import Callable

import pytest
import xarray as xr

from tests.workflow.conftest import MAP, SMALL, STUDIES, Project

pytestmark = [pytest.mark.workflow, pytest.mark.slow]

SIMULATIONS = {f"simulate_case:{case}" for case in ("F11", "F13", "X")}
FIGURES = {"draw_figure:small:fig11", "draw_figure:small:fig13"}
MERGED = {"merge_cases", "check_claims"}
OF_F13 = {"make_table:table1", "make_table:table2", "make_table:small_changes"}
OF_CASE = {"simulate_case:F13", "draw_figure:small:fig13"}
TABLES = OF_F13 | {"make_table:precursor"}
PLOT = {"draw_figure:small_map:chart"}
MAP_TAIL = {"merge_batches:small_map"} | PLOT
GROWTH_TAIL = {"merge_batches:small_growth"} | PLOT
Jobs = Callable[[Project], set[str]]


def batches(project: Project, name: str) -> set[str]:
    """The jobs of all batches that a study now has."""
    jobs = project.jobs("--forceall")
    return {
        f"{rule}:{name}:{wildcards['batch']}"
        for rule, wildcards in jobs
        if rule == "compute_batch" and name in wildcards.values()
    }


def whole_map(project: Project) -> set[str]:
    return batches(project, "small_map") | MAP_TAIL


def whole_growth(project: Project) -> set[str]:
    return batches(project, "small_growth") | GROWTH_TAIL


def everything(project: Project) -> set[str]:
    return SIMULATIONS | FIGURES | TABLES | MERGED | whole_map(project) | whole_growth(project)


def dataset(project: Project, name: str) -> xr.Dataset:
    with xr.open_dataset(project.folder / "results" / name) as found:
        return found.load()


def test_a_second_run_does_nothing(project: Project) -> None:
    before = {path: path.stat().st_mtime_ns for path in (project.folder / "results").rglob("*")}
    assert not [path for path in before if path.suffix == ".tmp"]
    assert "Nothing to be done" in project.complete("-j2")
    assert before == {
        path: path.stat().st_mtime_ns for path in (project.folder / "results").rglob("*")
    }


@pytest.mark.parametrize(
    ("file", "old", "new", "jobs"),
    [
        (SMALL, "Omega: 15.1", "Omega: 15.2", lambda _: OF_CASE | OF_F13 | MERGED),
        (SMALL, "title: quiet", "title: calm", lambda _: {"merge_cases", "draw_figure:small:fig11"}),
        (SMALL, "  X: {title: another,", "  Y: {title: new,", lambda _: {"simulate_case:Y"} | MERGED),
        (MAP, "axes:\n", "base: {c: 0.1}\naxes:\n", whole_map),
        (MAP, "axes:\n", "base: {mu_k: 2.4e-1}\naxes:\n", lambda _: set()),  # the default as it was
        (MAP, "title: outcome", "title: what becomes of it", lambda _: MAP_TAIL),
    ],
)  # fmt: skip
def test_a_change_runs_what_depends_on_it(
    project: Project, file: str, old: str, new: str, jobs: Jobs
) -> None:
    project.edit(file, old, new)
    assert project.planned() == jobs(project)


def test_what_is_removed_computes_nothing_and_is_gone(project: Project) -> None:
    project.edit(SMALL, "  X: {title: another, parameters: {N: 200, Omega: 20}, t_end: 2}\n", "")
    project.edit(MAP, "N: [100, 200.0, 300]", "N: [100, 300]")
    assert project.planned() == MERGED | MAP_TAIL
    project.complete("-j2")
    assert list(dataset(project, "small/cases.nc")["case"].values) == ["F11", "F13"]
    assert list(dataset(project, "small_map/small_map.nc")["N"].values) == [100, 300]
    project.edit(MAP, "N: [100, 300]", "N: [100, 200, 300]")
    assert project.planned() == MAP_TAIL


def test_spelling_order_times_and_comments_run_nothing(project: Project) -> None:
    cases = STUDIES[SMALL].replace("N: 385, Omega: 15}", "Omega: 1.50e+1, N: 385.0}")
    listed = re.findall(r"  [FX]\w*: .*\n", cases)
    (project.folder / SMALL).write_text(cases.replace("".join(listed), "".join(listed[::-1])))
    project.edit(MAP, "[100, 200.0, 300]", "[3.0e+2, 100.00, '200']")
    project.edit(MAP, "[10, 15, 20, 25]", "[25, 20, 15, 10]")
    for path in [
        *(project.folder / "src").rglob("*.py"),
        *(project.folder / "workflow/scripts").glob("*.py"),
    ]:
        path.write_text(path.read_text() + "\n# a comment\n")
    api = "src/disc_model/simulation/api.py"
    project.edit(api, "def _with_windows", '"""Of what follows."""\n\n\ndef _with_windows')
    for path in (project.folder / "config").glob("*"):
        os.utime(path)
    assert project.planned() == set()


@pytest.mark.parametrize(
    ("source", "jobs"),
    [
        ("src/disc_model/engine/loop.py", everything),
        ("src/disc_model/stability/outcome.py", everything),
        ("src/disc_model/studies/quantities/sliding.py", whole_growth),
        ("src/disc_model/studies/quantities/hysteresis.py", lambda _: set()),
        ("src/disc_model/studies/merge.py", lambda _: MAP_TAIL | GROWTH_TAIL | {"merge_cases"}),
        ("src/disc_model/studies/study.py", lambda _: set()),
        ("src/disc_model/figures/runs.py", lambda _: FIGURES | PLOT),
        ("workflow/paper/figures.py", lambda _: {"check_claims"} | TABLES),
        ("src/disc_model/figures/style.mplstyle", lambda _: FIGURES | PLOT),
        ("workflow/scripts/draw_figure.py", lambda _: FIGURES | PLOT),
        ("workflow/scripts/simulate_case.py", lambda _: SIMULATIONS | FIGURES | OF_F13 | MERGED),
        ("workflow/paper/section41.py", lambda _: {"check_claims"} | TABLES),
        ("workflow/paper/section41.yaml", lambda _: {"check_claims"} | TABLES),
    ],
)
def test_sources_run_what_uses_them_and_no_more(project: Project, source: str, jobs: Jobs) -> None:
    project.change(source)
    assert project.planned() == jobs(project)


def test_deleted_intermediate_is_not_missed_but_a_deleted_figure_is(project: Project) -> None:
    (project.folder / "results" / "small" / "cases" / "X.nc").unlink()
    assert project.planned() == set()
    (project.folder / "results" / "small" / "figures" / "fig11.png").unlink()
    assert project.planned() == {"draw_figure:small:fig11"}


def test_the_explorer_computes_motions_of_what_changed(project: Project) -> None:
    def explored() -> list[str]:
        return sorted(
            rule
            for rule, _ in project.jobs("explorer")
            if rule in ("compute_motions", "build_explorer")
        )

    project.complete("-j2", "explorer")
    assert "small_growth" in (project.folder / "results" / "small" / "explorer.html").read_text()
    assert explored() == []
    project.edit(MAP, "title: outcome", "title: what becomes of it")
    assert explored() == ["build_explorer"]
    # another point of which a motion is kept, in the one study of two that has motions
    project.edit(MAP, "N: [100, 200.0, 300]", "N: [100, 200, 400]")
    assert explored() == ["build_explorer", "compute_motions"]
    project.edit(MAP, "N: [100, 200, 400]", "N: [100, 200.0, 300]")
    assert explored() == ["build_explorer"]
    project.change("src/disc_model/studies/motions.py")
    assert explored() == ["build_explorer", "compute_motions"]
    # and a plain run leaves the page as it was
    assert "compute_motions" not in project.complete("-n")


def test_a_point_that_fails_is_reported(project: Project) -> None:
    project.edit(MAP, "N: [100, 200.0, 300]", "N: [100, 200, 1.0e+6]")
    project.edit(MAP, "axes:\n", "base: {k_p: 2.0e+6, mu_s: 3, mu_k: 2.9, E: 1.0e+9}\naxes:\n")
    project.complete("-j2", "--until", "draw_figure")
    bad = int((dataset(project, "small_map/small_map.nc")["status"] != 0).sum())
    lines = (project.folder / "results/small_map/small_map.failed.txt").read_text().splitlines()
    assert len(lines) == bad > 0
    assert lines[-2].startswith(
        "N = 1000000 N, Omega = 25 rad/s, normalization = as_published: paradox: at t = "
    )
