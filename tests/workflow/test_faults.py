"""Faults during a study: after a rerun the results are those of an undisturbed run, byte for byte.

What was tried, and how often, is said at the end of the tests' output.
"""

from __future__ import annotations

import os
import random
import resource
import shutil
import signal
import subprocess
import time
from base64 import urlsafe_b64encode
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import pytest

from tests import needs
from tests.workflow.conftest import Project, copy_repository
from tests.workflow.faulty import CONFIG, STUDY, Copy, jobs, kill, needs_proc, products, wait_until

pytestmark = [pytest.mark.workflow, pytest.mark.slow]
LOCKED = "Directory cannot be locked"


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> Copy:
    """The study, undisturbed."""
    project = copy_repository(tmp_path_factory.mktemp("undisturbed"), STUDY)
    project.complete("-j2")
    return Copy(project.folder, project.config, undisturbed=products(project))


@pytest.fixture
def finished(done: Copy, tmp_path: Path) -> Copy:
    """A copy of it, times included."""
    return done.copy(tmp_path / "project")


@pytest.fixture
def fresh(done: Copy, tmp_path: Path) -> Copy:
    """The study before its first run."""
    project = done.copy(tmp_path / "project")
    for made in ("results", ".snakemake"):
        shutil.rmtree(project.folder / made)
    return project


# ---- killed


@needs_proc
def test_jobs_killed_at_random(fresh: Copy) -> None:
    wanted, killed, chance = 8, 0, random.Random(7)
    failed = True
    while killed < wanted and failed:
        process, before = fresh.start("-j2"), killed
        while process.poll() is None:
            time.sleep(chance.uniform(0.2, 2.0))
            running = jobs(fresh)
            if running and killed < wanted:
                killed += kill(chance.choice(running))
        failed = process.returncode != 0
        assert failed or killed == before  # where jobs are quick, the last may end unharmed
    assert killed > 0
    fresh.recovers("jobs killed", killed)


@needs_proc
def test_whole_runs_killed_at_random(fresh: Copy) -> None:
    """What a power failure does: Snakemake and its jobs are gone at once, and its lock stays."""
    chance = random.Random(3)
    for number in range(4):
        process = fresh.start("-j2")
        # by what is done, and not by the clock: where jobs are quick, all was done before the last kill
        wait_until(lambda number=number: len(products(fresh)) >= number and jobs(fresh))
        time.sleep(chance.uniform(0.0, 0.3))
        os.killpg(process.pid, signal.SIGKILL)
        assert process.wait() == -signal.SIGKILL
        told = fresh.refused("-j2")
        assert LOCKED in told
        assert "--unlock" in told
        fresh.complete("-j2", "--unlock")
    fresh.recovers("whole runs killed", 4)


@needs_proc
def test_snakemake_killed_while_its_jobs_go_on(fresh: Copy) -> None:
    """The next run makes the same files at the same time."""
    process = fresh.start("-j2")
    wait_until(lambda: bool(jobs(fresh)))
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    assert jobs(fresh)
    fresh.complete("-j2", "--unlock")
    fresh.complete("-j2")
    wait_until(lambda: not jobs(fresh))
    fresh.recovered("Snakemake alone killed")


# ---- disk full


FULL = """
mount -t tmpfs -o size=64m none "$DISK"
cp -a "$PROJECT/." "$DISK"
cd "$DISK"
mount -o remount,size=$(($(df --output=used -k . | tail -1) + ROOM))k "$DISK"
! "$@" > "$PROJECT/full.log" 2>&1
mkdir -p results
find results -name "*.nc" | while read -r file; do cmp "$file" "$UNDISTURBED/$file"; done
mount -o remount,size=64m "$DISK"
"$@"
cp -a results/. "$PROJECT/results"
"""
NAMESPACE = ("unshare", "--map-root-user", "--mount")
CAN_MOUNT = shutil.which("unshare") is not None and subprocess.run([*NAMESPACE, "true"], check=False).returncode == 0


@pytest.mark.skipif(not CAN_MOUNT, reason="needs a mount namespace of its own")
@pytest.mark.parametrize("room", [0, 150, 300])
def test_disk_full(fresh: Copy, done: Copy, tmp_path: Path, room: int) -> None:
    """So many kB are left for everything: results, logs, Snakemake's records."""
    disk = tmp_path / "disk"
    disk.mkdir()
    places = {"DISK": str(disk), "PROJECT": str(fresh.folder), "UNDISTURBED": str(done.folder), "ROOM": str(room)}
    script = ["bash", "-euo", "pipefail", "-c", FULL, "bash", *fresh.command("-j2")]
    ran = subprocess.run(
        [*NAMESPACE, *script], env=fresh.environment | places, capture_output=True, text=True, check=False, timeout=900
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert "No space left on device" in (fresh.folder / "full.log").read_text()
    fresh.recovered("disk full")


def test_files_may_not_grow(fresh: Copy) -> None:
    """A limit to the size of files, as quotas impose: the library that writes them only says "HDF error"."""
    limit = 80_000
    ran = fresh.snakemake("-j2", prepare=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
    assert ran.returncode != 0
    assert "results/faulty/cases/F13.nc: cannot be written: File too large" in ran.stdout
    found = products(fresh)
    assert found
    assert all(found[name] == fresh.undisturbed[name] for name in found)
    fresh.recovers("file size limited")


# ---- damaged files


def cut(path: Path, _: random.Random) -> None:
    os.truncate(path, path.stat().st_size // 2)


def empty(path: Path, _: random.Random) -> None:
    os.truncate(path, 0)


def flip(path: Path, chance: random.Random) -> None:
    """One bit."""
    content = bytearray(path.read_bytes())
    content[chance.randrange(len(content))] ^= 1 << chance.randrange(8)
    path.write_bytes(content)


def lose_the_end(path: Path, _: random.Random) -> None:
    """The last block is zero, as after a crash of the machine."""
    content = path.read_bytes()
    path.write_bytes(content[:-4096] + bytes(4096))


DAMAGE = [cut, flip, empty, lose_the_end]


def damage(paths: Iterable[Path], seed: int, *, keep_times: bool = False) -> list[Path]:
    chance, damaged = random.Random(seed), sorted(paths)
    for i, path in enumerate(damaged):
        times = path.stat()
        DAMAGE[i % len(DAMAGE)](path, chance)
        if keep_times:
            os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))
    return damaged


@pytest.mark.parametrize(
    ("patterns", "count", "what"),
    [
        (("faulty/cases/*.nc", "faulty_map/batches/*.nc"), 4, "input datasets damaged"),
        (("faulty/cases.nc",), 1, "merged datasets damaged"),
    ],
)
def test_damaged_files(finished: Copy, patterns: tuple[str, ...], count: int, what: str) -> None:
    """Every damaged file that a job reads is named, and the same command again computes it anew."""
    results = finished.folder / "results"
    damaged = damage((path for pattern in patterns for path in results.glob(pattern)), count)
    assert len(damaged) == count
    (results / "faulty_map" / "faulty_map.nc").unlink()  # else nothing asks for the batches
    told = finished.refused("-j2")
    for path in damaged:
        assert f"{path.relative_to(finished.folder)}: damaged" in told
    assert "Run snakemake again" in told
    finished.recovers(what, len(damaged))


def test_damage_that_left_the_times_is_found_by_check(finished: Copy) -> None:
    results = finished.folder / "results"
    damaged = damage(results.rglob("*.nc"), 3, keep_times=True)
    (results / "faulty" / "cases" / ".F11.nc.abc.tmp").write_text("left by a killed job")
    checked = finished.complete("-j1", "check")
    for path in damaged:
        assert f"{path.relative_to(finished.folder)}: damaged" in checked
    assert not list(results.rglob(".*.tmp"))
    finished.recovers("datasets damaged without a change of times", len(damaged))


def test_damaged_kernels(fresh: Copy, tmp_path: Path) -> None:
    """What is damaged in the cache of compiled kernels is compiled again: no crash, no other numbers."""
    kept = cache_of(fresh)
    cache = tmp_path / "cache" / kept.name
    shutil.copytree(kept, cache)
    by_size = sorted(cache.glob("*.kernel"), key=lambda path: path.stat().st_size)
    # one for each type of model; which of them the study needs does not matter
    solvers = sorted(cache.glob("machine.run-*.kernel"))
    damaged = damage([*by_size[:11], *solvers], 4)
    bad = {path: path.read_bytes() for path in damaged}
    damaging = replace(fresh, variables={"NUMBA_CACHE_DIR": str(cache.parent)})
    damaging.recovers("compiled kernels damaged", len(damaged))
    assert any(path.read_bytes() != bad[path] for path in solvers)


def cache_of(project: Project) -> Path:
    """Folder of the compiled kernels."""
    code = "from disc_model.engine import machine; print(machine.run.stats.cache_path)"
    return Path(project.python(code).strip())


# ---- Snakemake's records


def test_records_in_a_database(finished: Copy) -> None:
    """Those in files do not count there."""
    assert "`snakemake -j1 check` removes them" in finished.refused("-n", "--persistence-backend", "db")


def test_lost_records(finished: Copy) -> None:
    """Without its records Snakemake would take everything for up to date."""
    shutil.rmtree(finished.folder / ".snakemake")
    finished.edit(CONFIG, "Omega: 15.1", "Omega: 15.2")
    told = finished.refused("-j2")
    assert "`snakemake -j1 check` removes them" in told
    assert "If results/ was copied from another folder, copy that folder's .snakemake" in told
    finished.complete("-j1", "check")
    finished.edit(CONFIG, "Omega: 15.2", "Omega: 15.1")
    finished.recovers("all records lost")


def test_a_damaged_record(finished: Copy) -> None:
    records = finished.folder / ".snakemake" / "metadata"
    record = records / urlsafe_b64encode(b"results/faulty/cases/F13.nc").decode()
    os.truncate(record, record.stat().st_size // 2)
    told = finished.refused("-j2")
    assert "results/faulty/cases/F13.nc and 0 more are there" in told
    finished.complete("-j1", "check")
    (finished.folder / "results" / "faulty" / "cases.nc").unlink()
    finished.recovers("record damaged")


# ---- two at once


def test_a_second_workflow_is_told_and_leaves_the_first_alone(fresh: Copy) -> None:
    first = fresh.start("-j2")
    wait_until(lambda: any((fresh.folder / ".snakemake" / "locks").glob("*")))
    second = fresh.refused("-j2")
    assert first.poll() is None
    assert second.count(LOCKED) == 1
    assert "Traceback" not in second
    assert first.wait(timeout=900) == 0, (fresh.folder / "run.log").read_text()
    fresh.recovered("second workflow started")


def test_two_workflows_without_lock(fresh: Copy) -> None:
    """They remove each other's files and may fail, but no file is ever half one's and half the other's."""
    both = [fresh.start("-j2", "--nolock", log=f"run{i}.log") for i in range(2)]
    for process in both:
        process.wait(timeout=900)
    found = {name: content for name, content in products(fresh).items() if name.endswith(".nc")}
    assert all(content == fresh.undisturbed[name] for name, content in found.items())
    fresh.recovers("two workflows without lock")


# ---- the clock


def test_clock_set_back_between_two_runs(finished: Copy) -> None:
    """A case computed anew by an earlier clock looks older than what was made of its former self."""
    finished.edit(CONFIG, "Omega: 15.1", "Omega: 15.2")
    finished.complete("-j2", "--until", "simulate_case", "compute_batch")
    case = finished.folder / "results" / "faulty" / "cases" / "F13.nc"
    assert case.read_bytes() != finished.undisturbed["faulty/cases/F13.nc"]
    set_times(case, days=-2)
    finished.complete("-j2")
    assert products(finished)["faulty/cases.nc"] != finished.undisturbed["faulty/cases.nc"]
    finished.edit(CONFIG, "Omega: 15.2", "Omega: 15.1")
    finished.complete("-j2", "--until", "simulate_case", "compute_batch")
    set_times(case, days=-4)
    finished.recovers("clock set back between runs", 2)


def test_results_from_the_future(finished: Copy) -> None:
    """Snakemake says so and stops; `check` puts the times right."""
    results = finished.folder / "results"
    files = [*results.glob("faulty/cases/*.nc"), *results.glob("faulty_map/batches/*.nc")]
    for path in files:
        set_times(path, days=1)
    for made_of_them in (results / "faulty" / "cases.nc", results / "faulty_map" / "faulty_map.nc"):
        made_of_them.unlink()
    told = finished.refused("-j2")
    assert "has older modification time" in told
    finished.complete("-j1", "check")
    finished.recovers("files from the future", len(files))


def set_times(path: Path, days: float) -> None:
    at = time.time() + 86400 * days
    os.utime(path, (at, at))


@needs.FAKETIME.mark
@needs_proc
def test_clock_set_back_during_a_run(fresh: Copy) -> None:
    """The first part is made tomorrow, and killed; the rest today."""
    process = fresh.start("-j2", wrapper=("faketime", "+1 day"))
    wait_until(lambda: bool(list((fresh.folder / "results").rglob("*.nc"))) or process.poll() is not None)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    assert products(fresh)
    fresh.snakemake("-j2", "--unlock")
    assert "has older modification time" in fresh.refused("-j2")
    fresh.complete("-j1", "check")
    fresh.recovers("clock set back within a run")
