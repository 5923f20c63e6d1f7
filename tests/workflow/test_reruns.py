"""What runs again after a change, and what does not, counted in jobs and points: real Snakemake, real files."""

import os
import re
from collections.abc import Callable

import pytest
import xarray as xr

from tests.workflow.conftest import MAP, SMALL, STUDIES, Project

pytestmark = pytest.mark.slow

SIMULATIONS = {f"simulate_case:{case}" for case in ("F11", "F13", "X")}
FIGURES = {"draw_figure:small:fig11", "draw_figure:small:fig13"}
LISTED = {"list_cases", "check_claims"}
OF_F13 = {"make_table:table1", "make_table:table2", "make_table:small_changes"}
OF_CASE = {"simulate_case:F13", "draw_figure:small:fig13"}
TABLES = OF_F13 | {"make_table:precursor"}
PLOT = {"draw_figure:small_map:chart"}
MAP_TAIL = {"merge_grid:small_map"} | PLOT
GROWTH_TAIL = {"merge_grid:small_growth"} | PLOT
Jobs = Callable[[Project], set[str]]


def parts(project: Project, name: str) -> set[str]:
    """The jobs of all parts that a study now has."""
    jobs = project.jobs("--forceall")
    return {
        f"{rule}:{name}:{wildcards['part']}"
        for rule, wildcards in jobs
        if rule == "compute_part" and name in wildcards.values()
    }


def whole_map(project: Project) -> set[str]:
    return parts(project, "small_map") | MAP_TAIL


def everything(project: Project) -> set[str]:
    grids = whole_map(project) | parts(project, "small_growth") | GROWTH_TAIL
    return SIMULATIONS | FIGURES | TABLES | LISTED | grids


def dataset(project: Project, name: str) -> xr.Dataset:
    with xr.open_dataset(project.folder / "results" / name) as found:
        return found.load()


def points_computed(project: Project, name: str) -> int:
    """Points that jobs of a study have computed since its logs were removed."""
    logs = (project.folder / "results" / name / "logs").rglob("*.log")
    counts = [re.findall(r"(\d+) of \d+ points computed", log.read_text()) for log in logs]
    return sum(int(number) for found in counts for number in found)


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
        (SMALL, "Omega: 15.1", "Omega: 15.2", lambda _: OF_CASE | OF_F13 | LISTED),
        (SMALL, "title: quiet", "title: calm", lambda _: {"list_cases", "draw_figure:small:fig11"}),
        (SMALL, "  X: {title: another,", "  Y: {title: new,", lambda _: {"simulate_case:Y"} | LISTED),
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


@pytest.mark.parametrize(
    ("new", "values", "points"),
    [("[100, 300]", [100, 300], 0), ("[100, 150, 200, 300]", [100, 150, 200, 300], 8)],
)
def test_only_points_that_are_new_are_computed(
    project: Project, new: str, values: list[float], points: int
) -> None:
    for log in (project.folder / "results" / "small_map" / "logs").rglob("*.log"):
        log.unlink()
    before = dataset(project, "small_map/small_map.nc")
    project.edit(MAP, "[100, 200.0, 300]", new)
    project.complete("-j2")
    after = dataset(project, "small_map/small_map.nc")
    assert after["N"].values.tolist() == values
    assert points_computed(project, "small_map") == points
    kept = [100, 300]
    xr.testing.assert_equal(after.sel(N=kept), before.sel(N=kept))


def test_spelling_order_and_times_run_nothing(project: Project) -> None:
    cases = STUDIES[SMALL].replace("N: 385, Omega: 15}", "Omega: 1.50e+1, N: 385.0}")
    listed = re.findall(r"  [FX]\w*: .*\n", cases)
    (project.folder / SMALL).write_text(cases.replace("".join(listed), "".join(listed[::-1])))
    project.edit(MAP, "[100, 200.0, 300]", "[3.0e+2, 100.00, '200']")
    project.edit(MAP, "[10, 15, 20, 25]", "[25, {start: 10, stop: 20, step: 5}]")
    for path in (project.folder / "config").glob("*"):
        os.utime(path)
    assert project.planned() == {"list_cases"}  # which lists the cases in their order


@pytest.mark.parametrize(
    ("source", "jobs"),
    [
        ("src/disc_model/engine/loop.py", everything),
        ("src/disc_model/studies/quantities/sliding_modes.py", everything),
        ("src/disc_model/studies/study.py", lambda _: set()),
        ("src/disc_model/figures/runs.py", lambda _: FIGURES | PLOT),
        ("workflow/paper/ledger.py", lambda _: {"check_claims"} | TABLES),
    ],
)
def test_sources_run_what_uses_them_and_no_more(project: Project, source: str, jobs: Jobs) -> None:
    project.change(source)
    assert project.planned() == jobs(project)


def test_a_deleted_figure_is_missed(project: Project) -> None:
    (project.folder / "results" / "small" / "figures" / "fig11.png").unlink()
    assert project.planned() == {"draw_figure:small:fig11"}


def test_the_explorer_computes_motions_of_what_changed(project: Project) -> None:
    def explored() -> list[str]:
        known = ("compute_motions", "build_explorer")
        return sorted(rule for rule, _ in project.jobs("explorer") if rule in known)

    project.complete("-j2", "explorer")
    assert "small_growth" in (project.folder / "results" / "small" / "explorer.html").read_text()
    assert explored() == []
    project.edit(MAP, "title: outcome", "title: what becomes of it")
    assert explored() == ["build_explorer"]
    # another point of which a motion is kept, in the one study of two that has motions
    project.edit(MAP, "N: [100, 200.0, 300]", "N: [100, 200, 400]")
    assert explored() == ["build_explorer", "compute_motions"]


def test_a_point_that_fails_is_reported(project: Project) -> None:
    project.edit(MAP, "N: [100, 200.0, 300]", "N: [100, 200, 1.0e+6]")
    project.edit(MAP, "axes:\n", "base: {k_p: 2.0e+6, mu_s: 3, mu_k: 2.9, E: 1.0e+9}\naxes:\n")
    project.complete("-j2", "--until", "draw_figure")
    bad = int((dataset(project, "small_map/small_map.nc")["status"] != 0).sum())
    lines = (project.folder / "results/small_map/small_map.failed.txt").read_text().splitlines()
    assert len(lines) - 1 == bad > 0  # below a heading
    assert any(
        all(x in line for x in ("1000000", "25", "as_published", "paradox")) for line in lines
    )
