"""The SLURM profile on a real SLURM: jobs that run, fail, take too long or too much, and what survives of a study."""

from __future__ import annotations

import itertools
import os
import re
import subprocess
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
import xarray as xr

from tests import needs
from tests.workflow import slurm
from tests.workflow.conftest import Project, copy_repository
from tests.workflow.slurm import Cluster

pytestmark = [
    pytest.mark.workflow,
    pytest.mark.slow,
    needs.SLURM.mark,
]

PROFILE = ("--workflow-profile", "workflow/profiles/slurm")
PROFILE_FILE = "workflow/profiles/slurm/config.yaml"
CONFIG = "config/queue.yaml"
GRID = "config/queue_map.yaml"
MAIN = """\
study: queue
record:
  windows:
    history: {rate: 500, envelope: 50}
cases:
  F13: {title: growing, parameters: {N: 385, Omega: 15.1}, t_end: 2}
figures: [fig13]
studies: [config/queue_map.yaml]
"""
MAP = """\
study: queue_map
quantity: outcome
options: {horizon: 1, late: 0.2, after_separation: 0.2}
axes:
  N: [100, 200]
  Omega: [10, 15]
  normalization: [as_published, orthonormal]
batch: {over: [Omega], size: 2}
figures:
  chart: {kind: stability_map, x: Omega, y: N}
"""
PUBLISHED = "results/queue_map/queue_map.nc"

# Every Python of the project's copy starts with this. It notes which job computes which batch, and plays the faults
# that a test asks for: one line for each attempt at a batch.
WITNESS = """\
import os
import signal
import sys
import time
from pathlib import Path

if any(word.endswith("workflow/scripts/compute_batch.py") for word in sys.orig_argv):
    here = Path(__file__).parent
    [batch] = [Path(word).stem for word in sys.orig_argv if "/batches/" in word]
    with (here / "witness").open("a+") as file:
        file.write(f"{batch} {os.environ.get('SLURM_JOB_ID')}\\n")
        file.seek(0)
        attempt = sum(line.startswith(batch) for line in file)
    faults = here / f"{batch}.faults"
    fault = dict(enumerate(faults.read_text().split(), 1)).get(attempt) if faults.exists() else None
    if fault == "die":
        os.kill(os.getpid(), signal.SIGKILL)
    if fault == "hang":
        time.sleep(600)
    if fault == "hog":
        block = b"x" * (1300 << 20)
        time.sleep(10)
        del block
"""


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    """SLURM, with the environment that Snakemake needs to find it."""
    with pytest.MonkeyPatch.context() as patch:
        for name in [name for name in os.environ if name.startswith(("SLURM_", "SBATCH_", "SRUN_"))]:
            patch.delenv(name)
        try:
            with slurm.cluster(tmp_path_factory.mktemp("slurm")) as running:
                for name, value in running.environment.items():
                    patch.setenv(name, value)
                yield running
        except slurm.Unavailable as error:
            pytest.skip(str(error))


def small_study(folder: Path) -> Project:
    return copy_repository(folder, {CONFIG: MAIN, GRID: MAP, "src/sitecustomize.py": WITNESS})


@pytest.fixture(scope="module")
def local(tmp_path_factory: pytest.TempPathFactory) -> Project:
    """The study as one machine computes it."""
    project = small_study(tmp_path_factory.mktemp("slurm") / "project")
    project.complete("-j2")
    return replace(project, folder=project.folder.rename(project.folder.with_name("local")))


@pytest.fixture(scope="module")
def queued(cluster: Cluster, local: Project) -> tuple[Project, str]:
    """The study as the cluster computes it, in the place where it was before (compiled code is found by its place)."""
    project = small_study(local.folder.with_name("project"))
    return project, project.complete(*PROFILE)


NEW_VALUES = itertools.count(300, 10)


@pytest.fixture
def grown(queued: tuple[Project, str]) -> Iterator[tuple[Project, list[str]]]:
    """The finished study with a value of N that it never had, and the two batches which that asks for."""
    project, _ = queued
    kept = {project.folder / path: (project.folder / path).read_text() for path in (GRID, PROFILE_FILE)}
    project.edit(GRID, "N: [100, 200]", f"N: [100, 200, {next(NEW_VALUES)}]")
    batches = planned_batches(project)
    assert len(batches) == 2
    yield project, batches
    for path, text in kept.items():
        path.write_text(text)


def planned_batches(project: Project) -> list[str]:
    jobs = project.jobs(PUBLISHED)
    return sorted(wildcards["batch"] for _, wildcards in jobs if "batch" in wildcards)


def submitted(said: str) -> dict[str, str]:
    """Rule of each job that Snakemake says it submitted, by SLURM's number."""
    return dict(re.findall(r"SLURM jobid (\d+) \(log: \S*/rule_(\w+)/", said))


def counted(said: str) -> dict[str, int]:
    """How many jobs of each rule Snakemake announced at its start, but for the rules that run beside it."""
    table = said[said.index("Job stats:") :]
    jobs = {
        rule: int(count)
        for rule, count in re.findall(r"^(\w+) +(\d+)$", table[: table.index("\ntotal ")], re.MULTILINE)
    }
    for rule in re.findall(r"^localrule (\w+):", said, re.MULTILINE):
        jobs.pop(rule, None)
    return jobs


def attempts(project: Project) -> dict[str, list[str]]:
    """Jobs that computed a batch, in order, for each batch."""
    found: dict[str, list[str]] = {}
    for line in (project.folder / "src" / "witness").read_text().splitlines():
        batch, job = line.split()
        found.setdefault(batch, []).append(job)
    return found


def ask_for(project: Project, batch: str, *faults: str) -> None:
    (project.folder / "src" / f"{batch}.faults").write_text("\n".join(faults))


def times(project: Project) -> dict[str, int]:
    """When each batch was written."""
    return {path.stem: path.stat().st_mtime_ns for path in project.folder.glob("results/queue_map/batches/*.nc")}


def start(project: Project, *options: str) -> subprocess.Popen[bytes]:
    """Snakemake in the background, on the grid study alone."""
    return project.start(*PROFILE, PUBLISHED, *options, prepare=slurm.die_with_parent)


def wait_for_attempt(project: Project, batch: str) -> str:
    """The job that has begun with a batch."""
    for _ in range(900):
        if jobs := attempts(project).get(batch):
            return jobs[-1]
        time.sleep(0.1)
    raise AssertionError("the batch was not begun: " + (project.folder / "run.log").read_text())


def ended_well(process: subprocess.Popen[bytes], project: Project) -> str:
    """What Snakemake said."""
    code = process.wait(timeout=900)
    said = (project.folder / "run.log").read_text()
    assert code == 0, said
    return said


def assert_same_results(one: Project, other: Project) -> None:
    """Same files with the same variables, coordinates and attributes."""
    files = sorted(path.relative_to(one.folder) for path in one.folder.glob("results/queue*/**/*.nc"))
    assert files == sorted(path.relative_to(other.folder) for path in other.folder.glob("results/queue*/**/*.nc"))
    assert len(files) >= 7
    for file in files:
        with xr.open_dataset(one.folder / file) as ours, xr.open_dataset(other.folder / file) as theirs:
            xr.testing.assert_identical(ours, theirs)


def test_every_job_of_a_study_is_run_by_the_cluster(queued: tuple[Project, str], cluster: Cluster) -> None:
    project, said = queued
    jobs = submitted(said)
    rules = Counter(jobs.values())
    assert rules == counted(said)
    assert rules["compute_batch"] == 4
    finished = cluster.finished()
    launched = re.findall(r"Launching batch job (\d+) ", (cluster.folder / "slurmd.log").read_text())
    for job, rule in jobs.items():
        assert finished[job]["JobState"] == "COMPLETED"
        assert finished[job]["NodeList"] == "localhost"
        assert finished[job]["TimeLimit"] == ("30" if rule == "compute_batch" else "10")
        assert job in launched
    computed = attempts(project)
    assert len(computed) == 4
    assert {job for [job] in computed.values()} == {job for job, rule in jobs.items() if rule == "compute_batch"}
    assert cluster.queue() == {}


def test_results_are_those_of_one_machine(queued: tuple[Project, str], local: Project) -> None:
    assert all(jobs == ["None"] for jobs in attempts(local).values())
    assert_same_results(queued[0], local)


def test_a_cancelled_job_is_submitted_again(grown: tuple[Project, list[str]], cluster: Cluster) -> None:
    project, (unlucky, other) = grown
    before = times(project)
    ask_for(project, unlucky, "hang")
    process = start(project)
    job = wait_for_attempt(project, unlucky)
    cluster.call("scancel", job)
    said = ended_well(process, project)
    assert f"SLURM-job '{job}' failed, SLURM status is: 'CANCELLED'" in said
    assert "Trying to restart job" in said
    first, second = attempts(project)[unlucky]
    finished = cluster.finished()
    assert (first, finished[first]["JobState"]) == (job, "CANCELLED")
    assert finished[second]["JobState"] == "COMPLETED"
    assert len(attempts(project)[other]) == 1
    assert {batch: at for batch, at in times(project).items() if batch in before} == before
    assert planned_batches(project) == []


def test_a_job_that_takes_too_long_gets_more_time(grown: tuple[Project, list[str]], cluster: Cluster) -> None:
    project, (slow, other) = grown
    project.edit(PROFILE_FILE, "runtime: 30 * attempt", "runtime: 1 * attempt")
    ask_for(project, slow, "hang")
    before = times(project)
    said = ended_well(start(project), project)
    first, second = attempts(project)[slow]
    assert f"SLURM-job '{first}' failed, SLURM status is: 'TIMEOUT'" in said
    finished = cluster.finished()
    assert (finished[first]["JobState"], finished[first]["TimeLimit"]) == ("TIMEOUT", "1")
    assert (finished[second]["JobState"], finished[second]["TimeLimit"]) == ("COMPLETED", "2")
    assert len(attempts(project)[other]) == 1
    assert {batch: at for batch, at in times(project).items() if batch in before} == before
