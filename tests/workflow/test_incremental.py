"""Grid studies in a real Snakemake: which jobs a change brings about, and what survives a crash."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from pathlib import Path

import pytest
import xarray as xr

from tests.workflow.conftest import Project, copy_repository

pytestmark = [pytest.mark.workflow, pytest.mark.slow]

GRIDS = "src/disc_model/studies/grids"
CONFIG = "config/inc.yaml"
GRID = "config/inc_map.yaml"
MAIN = """\
study: inc
title: beside the grids
cases:
  X: {title: another, parameters: {N: 200, Omega: 20}, t_end: 1}
studies: [config/inc_*.yaml]
"""
MAP = """\
study: inc_map
title: outcome
quantity: outcome
options: {horizon: 1, late: 0.2, after_separation: 0.2}
axes:
  N: [100, 200.0, 300]
  Omega: [10, 15, 20, 25]
  normalization: [as_published, orthonormal]
batch: {over: [Omega, normalization], size: 8}
figures:
  chart: {kind: stability_map, x: Omega, y: N, others: {growth: inc_growth}}
"""
GROWTH = """\
study: inc_growth
quantity: floquet
axes:
  N: [100, 200, 300]
  Omega: {start: 10, stop: 25, count: 3}
  normalization: [as_published, orthonormal]
batch: {over: [Omega, normalization], size: 6}
"""
MAP_TAIL = {("merge_batches", "inc_map"), ("draw_plot", "inc_map")}
GROWTH_TAIL = {("merge_batches", "inc_growth"), ("draw_plot", "inc_map")}
Jobs = set[tuple[str, str]]
RULES = ("warm", "compute_batch", "merge_batches", "draw_plot")
RUN = ("-j2", "--until", "draw_plot")
"""Grid studies alone; the cases beside them have tests of their own."""


@pytest.fixture(scope="session")
def finished_grid(tmp_path_factory: pytest.TempPathFactory) -> Project:
    """A map and its growth rates, computed."""
    studies = {CONFIG: MAIN, GRID: MAP, "config/inc_growth.yaml": GROWTH}
    project = copy_repository(tmp_path_factory.mktemp("grid"), studies)
    project.complete(*RUN)
    return project


@pytest.fixture
def grid(finished_grid: Project, tmp_path: Path) -> Project:
    """A copy of it, times included."""
    return finished_grid.copy(tmp_path / "project")


def planned(project: Project, *options: str) -> Jobs:
    """Jobs of grid studies that a run would do: rule and study, for batches the batch instead."""
    jobs = project.jobs(*options)
    return {(rule, found.get("batch") or found.get("study", "")) for rule, found in jobs if rule in RULES}


def batches(project: Project, name: str) -> Jobs:
    """The jobs of all batches that a study now has, its sources hashed as in the project."""
    code = f"from disc_model.studies.study import load_study; print(*load_study('config/{name}.yaml').grid.batches)"
    return {("compute_batch", batch) for batch in project.python(code).split()}


def test_the_studies_are_complete(finished_grid: Project) -> None:
    results = finished_grid.folder / "results" / "inc_map"
    with xr.open_dataset(results / "inc_map.nc") as study:
        assert dict(study["status"].sizes) == {"N": 3, "Omega": 4, "normalization": 2}
        assert (study["status"] == 0).all()
    assert (results / "inc_map.failed.txt").read_text() == ""
    assert (results / "figures" / "chart.pdf").read_bytes().startswith(b"%PDF")
    assert not list(results.rglob("*.tmp"))
    assert planned(finished_grid) == set()


@pytest.mark.parametrize(
    ("old", "new", "count"),
    [
        ("N: [100, 200.0, 300]", "N: [250, 100, 200, 300]", 1),
        ("Omega: [10, 15, 20, 25]", "Omega: {blocks: [[10, 15, 20, 25], [30]]}", 3),
    ],
)
def test_an_added_value_or_block_runs_its_own_batches(grid: Project, old: str, new: str, count: int) -> None:
    before = batches(grid, "inc_map")
    grid.edit(GRID, old, new)
    added = batches(grid, "inc_map") - before
    assert len(added) == count
    assert planned(grid) == added | MAP_TAIL


def test_a_removed_value_computes_nothing_and_is_gone(grid: Project) -> None:
    def preloads() -> list[float]:
        grid.complete(*RUN)
        with xr.open_dataset(grid.folder / "results" / "inc_map" / "inc_map.nc") as study:
            return list(study["N"].values)

    grid.edit(GRID, "N: [100, 200.0, 300]", "N: [100, 300]")
    assert planned(grid) == MAP_TAIL
    assert preloads() == [100, 300]
    grid.edit(GRID, "N: [100, 300]", "N: [100, 200, 300]")
    assert planned(grid) == MAP_TAIL
    assert preloads() == [100, 200, 300]


def test_order_spelling_and_times_run_nothing(grid: Project) -> None:
    text = MAP.replace("[100, 200.0, 300]", "[3.0e+2, 100, '200', 100.00]").replace(
        "[10, 15, 20, 25]", "[25, 20, 15, 10]"
    )
    axes = text[text.index("  N:") : text.index("batch")]
    (grid.folder / GRID).write_text(text.replace(axes, "\n".join(axes.splitlines()[::-1]) + "\n"))
    for path in [*(grid.folder / "src").rglob("*.py"), *(grid.folder / "config").glob("*")]:
        os.utime(path)
    assert planned(grid) == set()


@pytest.mark.parametrize(
    ("old", "new", "jobs"),
    [
        ("axes:\n", "base: {mu_k: 0.23}\naxes:\n", lambda project: batches(project, "inc_map") | MAP_TAIL),
        ("axes:\n", "base: {c: 0.1}\naxes:\n", lambda project: batches(project, "inc_map") | MAP_TAIL),
        ("horizon: 1,", "horizon: 1.5,", lambda project: batches(project, "inc_map") | MAP_TAIL),
        # the default as it was
        ("axes:\n", "base: {mu_k: 2.4e-1}\naxes:\n", lambda _: set()),
        ("title: outcome", "title: what becomes of it", lambda _: MAP_TAIL),
    ],
)
def test_what_is_said_for_all_points_runs_the_whole_study_and_no_more(
    grid: Project, old: str, new: str, jobs: Callable[[Project], Jobs]
) -> None:
    grid.edit(GRID, old, new)
    assert planned(grid) == jobs(grid)


def test_finer_resolution_keeps_what_is_there(grid: Project) -> None:
    jobs = planned(grid, "--config", "resolution=2")
    new = {job for job in jobs if job[0] == "compute_batch"}
    assert jobs - new == GROWTH_TAIL
    assert len(new) == 3
    assert not new & batches(grid, "inc_growth")


def test_an_overlay_changes_a_study(grid: Project) -> None:
    grid.edit(CONFIG, "studies:", "overrides: {inc_map: {axes: {N: [100, 200, 300, 400]}}}\nstudies:")
    jobs = planned(grid)
    assert jobs > MAP_TAIL
    assert len(jobs - MAP_TAIL) == 1


ALL: Callable[[Project], Jobs] = lambda project: batches(project, "inc_map") | batches(project, "inc_growth")  # noqa: E731


@pytest.mark.parametrize(
    ("source", "jobs"),
    [
        ("src/disc_model/figures/grids/stability_map.py", lambda _: {("draw_plot", "inc_map")}),
        ("src/disc_model/figures/disc_model.mplstyle", lambda _: {("draw_plot", "inc_map")}),
        ("workflow/scripts/draw_figure.py", lambda _: {("draw_plot", "inc_map")}),
        (f"{GRIDS}/merge.py", lambda _: MAP_TAIL | GROWTH_TAIL),
        ("src/disc_model/studies/study.py", lambda _: set()),
        ("src/disc_model/studies/document.py", lambda _: set()),
        (f"{GRIDS}/quantities/hysteresis.py", lambda _: set()),
        (f"{GRIDS}/quantities/floquet.py", lambda project: batches(project, "inc_growth") | GROWTH_TAIL),
        ("src/disc_model/stability/attractor/course.py", lambda project: batches(project, "inc_map") | MAP_TAIL),
        (
            "src/disc_model/engine/machine.py",
            lambda project: ALL(project) | MAP_TAIL | GROWTH_TAIL | {("warm", "")},
        ),
    ],
)  # fmt: skip
def test_sources_run_what_uses_them(grid: Project, source: str, jobs: Callable[[Project], Jobs]) -> None:
    grid.change(source)
    assert planned(grid) == jobs(grid)


def test_the_explorer_computes_motions_of_what_changed(grid: Project) -> None:
    page = grid.folder / "results" / "inc" / "explorer.html"
    grid.complete("-j2", "explorer")
    assert {path.parents[1].name for path in (grid.folder / "results").glob("*/motions/*.nc")} == {
        "inc_map",
        "inc_growth",
    }
    assert "inc_growth" in page.read_text()
    assert explored(grid) == {}
    grid.edit(GRID, "title: outcome", "title: what becomes of it")
    assert explored(grid) == {"build_explorer": 1}
    (grid.folder / "src/disc_model/explorer/static/page.css").write_text("p { margin: 0 }")
    assert explored(grid) == {"build_explorer": 1}
    # another point of which a motion is kept, of one study of two
    grid.edit(GRID, "N: [100, 200.0, 300]", "N: [100, 200, 400]")
    assert explored(grid) == {"compute_motions": 1, "build_explorer": 1}
    grid.change("src/disc_model/studies/grids/motions.py")
    assert explored(grid) == {"compute_motions": 2, "build_explorer": 1}
    # and a plain run knows nothing of it
    assert "compute_motions" not in grid.complete("-n")


def explored(project: Project) -> dict[str, int]:
    """How many jobs of motions and of the explorer a run would do."""
    jobs = dict(re.findall(r"^(\w+) +(\d+)$", project.complete("-n", "explorer"), re.MULTILINE))
    return {rule: int(jobs[rule]) for rule in ("compute_motions", "build_explorer") if rule in jobs}


def test_a_point_that_fails_is_reported_and_the_study_completes(grid: Project) -> None:
    grid.edit(GRID, "N: [100, 200.0, 300]", "N: [100, 200, 1.0e+6]")
    grid.edit(GRID, "axes:\n", "base: {k_p: 2.0e+6, mu_s: 3, mu_k: 2.9, E: 1.0e+9}\naxes:\n")
    grid.complete(*RUN)
    results = grid.folder / "results" / "inc_map"
    with xr.open_dataset(results / "inc_map.nc") as study:
        bad = int((study["status"] != 0).sum())
        assert dict(study["status"].sizes) == {"N": 3, "Omega": 4, "normalization": 2}
    lines = (results / "inc_map.failed.txt").read_text().splitlines()
    assert bad
    assert len(lines) == bad
    assert lines[-2].startswith("N = 1000000.0, Omega = 25.0, normalization = as_published: paradox: at t = ")


def test_gc_removes_what_no_study_needs(grid: Project) -> None:
    kept = {path.name for path in (grid.folder / "results" / "inc_growth").rglob("*.nc")}
    grid.edit(GRID, "N: [100, 200.0, 300]", "N: [100, 300, 400]")
    grid.complete(*RUN)
    grid.complete("-j1", "gc")
    left = {path.stem for path in (grid.folder / "results" / "inc_map" / "batches").iterdir()}
    assert left == {batch for _, batch in batches(grid, "inc_map")}
    assert {path.name for path in (grid.folder / "results" / "inc_growth").rglob("*.nc")} == kept
    assert planned(grid) == set()
