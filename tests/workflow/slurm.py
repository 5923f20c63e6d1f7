"""A SLURM of one node for tests: daemons, key, ports, state and logs of its own, all in one folder."""

import contextlib
import ctypes
import getpass
import os
import re
import signal
import socket
import subprocess
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from tests import needs
from tests.processes import run

# No cgroups, so that it starts in any container: SLURM looks at the memory of jobs once a second instead, and kills
# what exceeds its share.
CONFIGURATION = Path(__file__).with_suffix(".conf").read_text()


class Unavailable(Exception):
    """SLURM cannot run here; the text says why."""


@dataclass
class Cluster:
    """A running SLURM; commands and Snakemake find it through `environment`."""

    folder: Path
    environment: dict[str, str]
    daemons: dict[str, subprocess.Popen[bytes]] = field(default_factory=dict)

    def call(self, *command: str) -> str:
        """Output of one of SLURM's commands."""
        answer = subprocess.run(
            command, env=os.environ | self.environment, capture_output=True, text=True, timeout=60, check=False
        )
        if answer.returncode:
            raise Unavailable(f"{' '.join(command)}: {answer.stderr.strip()}")
        return answer.stdout

    def queue(self) -> dict[str, str]:
        """State of every job that is not finished."""
        return dict(line.split() for line in self.call("squeue", "--noheader", "--format=%i %T").splitlines())

    def finished(self) -> dict[str, dict[str, str]]:
        """What the controller noted of each finished job: JobState, NodeList, TimeLimit (minutes), Tres, ..."""
        log = self.folder / "finished.log"
        lines = log.read_text().splitlines() if log.exists() else []
        jobs = [dict(re.findall(r"(\w+)=(\S*)", line)) for line in lines]
        return {job["JobId"]: job for job in jobs}

    def start(self, daemon: str, *options: str) -> None:
        """Start a daemon that ends when the tests do, even if these are killed."""
        program = needs.program(daemon)
        assert program, needs.SLURM.reason
        with (self.folder / f"{daemon}.out").open("ab") as out:
            self.daemons[daemon] = subprocess.Popen(
                [program, *options],
                env=os.environ | self.environment,
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=out,
                start_new_session=True,
                preexec_fn=die_with_parent,
            )

    def stop(self, daemon: str) -> None:
        process = self.daemons.pop(daemon)
        process.terminate()
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()

    def wait_until(self, ready: Callable[[], bool], daemon: str, seconds: float = 30.0) -> None:
        """Wait for a condition; a daemon that ended or is late makes SLURM unavailable, with what it said."""
        until = time.monotonic() + seconds
        while True:
            with contextlib.suppress(Unavailable):
                if ready():
                    return
            if self.daemons[daemon].poll() is not None or time.monotonic() > until:
                logs = [self.folder / f"{daemon}.out", self.folder / f"{daemon}.log"]
                phrase = [line for log in logs if log.exists() for line in log.read_text(errors="replace").splitlines()]
                raise Unavailable(f"{daemon} does not start: " + " | ".join(phrase[-5:]))
            time.sleep(0.2)


@contextlib.contextmanager
def cluster(folder: Path) -> Iterator[Cluster]:
    """A SLURM with two processors and one partition, main; raises Unavailable where it cannot be started."""
    if not needs.SLURM.met:
        raise Unavailable(needs.SLURM.reason)
    path = os.pathsep.join([str(folder / "bin"), needs.SEARCH])
    slurm = Cluster(folder, {"SLURM_CONF": str(folder / "slurm.conf"), "PATH": path})
    _configure(folder)
    try:
        _start(slurm)
        yield slurm
    finally:
        _clean_up(slurm)


def die_with_parent() -> None:
    """Run in a new process: it gets SIGTERM when the process that started it ends, however that comes about."""
    pr_set_pdeathsig = 1
    ctypes.CDLL(None).prctl(pr_set_pdeathsig, signal.SIGTERM)


def _configure(folder: Path) -> None:
    for name in ("spool", "state", "bin"):
        (folder / name).mkdir()
    key = folder / "munge.key"
    key.touch(mode=0o600)
    key.write_bytes(os.urandom(128))
    controller_port, node_port = _free_ports()
    text = CONFIGURATION.format(
        folder=folder,
        user=getpass.getuser(),
        host=socket.gethostname().split(".")[0],
        controller_port=controller_port,
        node_port=node_port,
    )
    (folder / "slurm.conf").write_text(text)
    if _version() >= (23, 2):  # before, this plugin did not exist, and none was loaded without need
        (folder / "cgroup.conf").write_text("CgroupPlugin=disabled\n")
    # Snakemake clears the environment of srun inside a job, and with it where the configuration is.
    srun = folder / "bin" / "srun"
    srun.write_text(f'#!/bin/sh\nSLURM_CONF={folder}/slurm.conf exec {needs.program("srun")} "$@"\n')
    srun.chmod(0o755)


def _version() -> tuple[int, ...]:
    phrase = run(needs.program("slurmd"), "-V", timeout=60).stdout
    return tuple(int(number) for number in re.findall(r"\d+", phrase)[:2])


def _free_ports() -> tuple[int, int]:
    with socket.socket() as one, socket.socket() as two:
        one.bind(("127.0.0.1", 0))
        two.bind(("127.0.0.1", 0))
        return one.getsockname()[1], two.getsockname()[1]


def _start(slurm: Cluster) -> None:
    options = {"key-file": "key", "socket": "socket", "pid-file": "pid", "seed-file": "seed"}
    files = [f"--{option}={slurm.folder}/munge.{ending}" for option, ending in options.items()]
    # by force: temporary folders are closed to others, which munge takes for a mistake
    slurm.start("munged", "--foreground", "--force", *files)
    slurm.wait_until((slurm.folder / "munge.socket").exists, "munged")
    slurm.start("slurmctld", "-D", "-f", str(slurm.folder / "slurm.conf"))
    slurm.wait_until(lambda: "UP" in slurm.call("scontrol", "ping"), "slurmctld")
    slurm.start("slurmd", "-D", "-f", str(slurm.folder / "slurm.conf"))
    slurm.wait_until(lambda: "State=IDLE" in slurm.call("scontrol", "show", "node", "localhost"), "slurmd")


def _clean_up(slurm: Cluster) -> None:
    """End jobs first: they are not children of the daemons' processes and would outlive them."""
    with contextlib.suppress(Unavailable, subprocess.TimeoutExpired):
        if "slurmd" in slurm.daemons and (jobs := slurm.queue()):
            slurm.call("scancel", *jobs)
            until = time.monotonic() + 30
            while slurm.queue() and time.monotonic() < until:
                time.sleep(0.5)
    for daemon in reversed(list(slurm.daemons)):
        slurm.stop(daemon)
