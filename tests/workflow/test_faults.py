"""Faults during a study: after a rerun the results are those of an undisturbed run, byte for byte.
Bad study files end Snakemake before any job, with every fault in the message."""

import os
import random
import signal
import time
from dataclasses import replace

import pytest

from tests.workflow.conftest import SMALL, Project

pytestmark = pytest.mark.slow


def assert_recovered(project: Project, finished: Project) -> None:
    """Inputs of finished files may be missing: nothing asks for them."""
    found = project.products()
    wanted = finished.products()
    assert {name for name in found if found[name] != wanted.get(name)} == set()
    assert not {
        name
        for name in wanted.keys() - found.keys()
        if "/cases/" not in name and "/batches/" not in name
    }


@pytest.mark.parametrize("run", range(3))
def test_a_run_killed_at_random(run: int, project: Project, finished: Project) -> None:
    """What a power failure does: Snakemake and its jobs are gone at once, and its lock stays."""
    project.forget()
    process = project.start("-j2")
    # by what is done, and not by the clock alone: where jobs are quick, all was done before
    while len(project.products()) < 3 * run:
        assert process.poll() is None
        time.sleep(0.05)
    time.sleep(random.Random(run).uniform(0.0, 3.0))
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    assert project.products().keys() < finished.products().keys()
    project.complete("-j2", "--unlock")
    project.complete("-j2")
    assert_recovered(project, finished)


def test_two_workflows_without_lock(project: Project, finished: Project) -> None:
    """They remove each other's files and may fail, but no file is ever half one's and half the
    other's."""
    project.forget()
    both = [project.start("-j2", "--nolock", log=f"run{i}.log") for i in range(2)]
    for process in both:
        process.wait(timeout=900)
    wanted = finished.products()
    assert all(
        content == wanted[name]
        for name, content in project.products().items()
        if name.endswith(".nc")
    )
    project.complete("-j2")
    assert_recovered(project, finished)


@pytest.mark.parametrize(
    ("patterns", "count"),
    [(("small/cases/*.nc", "small_map/batches/*.nc"), 6), (("small_map/small_map.nc",), 1)],
)
def test_damaged_files(
    project: Project, finished: Project, patterns: tuple[str, ...], count: int
) -> None:
    """A damaged file that a job reads is named; without it the same command computes it anew."""
    results = project.folder / "results"
    damaged = [path for pattern in patterns for path in results.glob(pattern)]
    for path in damaged:
        os.truncate(path, path.stat().st_size // 2)
    assert len(damaged) == count
    merged = results / "small_map" / "small_map.nc"
    if merged not in damaged:
        merged.unlink()  # else nothing asks for the batches
    told = project.complete("-j2", "--keep-going", fails=True)
    assert any(f"{path.relative_to(project.folder)}: cannot be read" in told for path in damaged)
    for path in damaged:
        path.unlink()
    project.complete("-j2")
    assert_recovered(project, finished)


# ---- bad study files


FAULTS = [
    f"{SMALL}: 2 faults",
    "cases.X.parameters.N=-5: must be >= 0",
    "cases.X.t_end=0: must be > 0",
]


@pytest.mark.parametrize(
    ("file", "old", "new", "faults"),
    [
        (SMALL, "N: 200, Omega: 20}, t_end: 2}", "N: -5, Omega: 20}, t_end: 0}", FAULTS),
        # which Snakemake itself would end in a traceback
        ("config/paper.yaml", "\ntitle: ", "\ntitle: [", ["config/paper.yaml: 1 fault", "line "]),
    ],
    ids=["values", "no YAML"],
)
def test_every_fault_is_shown_and_nothing_runs(
    project: Project, file: str, old: str, new: str, faults: list[str]
) -> None:
    project.edit(file, old, new)
    config = None
    if file == SMALL:
        config = SMALL
    changed = replace(project, config=config)
    shown = changed.complete("-j2", fails=True)
    assert [fault for fault in faults if fault not in shown] == []
    assert "Traceback" not in shown
    assert "Job stats" not in shown
