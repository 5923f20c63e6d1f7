"""Scripts of jobs that run as copies of a process which has imported what they need."""

import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.workflow.conftest import ROOT

pytestmark = pytest.mark.workflow

WARM = (sys.executable, ROOT / "workflow" / "scripts" / "warm.py")
SCRIPT = """\
import os, sys
print(sys.argv[1:], os.getcwd(), os.environ["OF_JOB"], sys.stdin.read(), "xarray" in sys.modules)
print("to stderr", file=sys.stderr)
match sys.argv[1]:
    case "number": sys.exit(3)
    case "words": sys.exit("what is wrong")
    case "bug": raise ValueError("a bug")
    case "killed": os.kill(os.getpid(), 9)
"""


def test_a_job_is_what_it_would_be_by_itself(tmp_path: Path) -> None:
    """Arguments, folder, environment, standard streams and exit code; and it runs where no such
    process is."""
    (tmp_path / "job.py").write_text(SCRIPT)

    def job(way: str) -> tuple[int, str, str]:
        words = [*WARM, tmp_path / "socket", "job.py", way]
        done = subprocess.run(
            words, cwd=tmp_path, env={"OF_JOB": "own"}, input="in", capture_output=True, text=True
        )
        return done.returncode, done.stdout, done.stderr

    ways = ("well", "number", "words", "bug", "killed")
    alone = [job(way) for way in ways]
    assert [code for code, *_ in alone] == [0, 3, 1, 1, -9]
    server = subprocess.Popen([*WARM, tmp_path / "socket"], stdin=subprocess.PIPE, cwd=ROOT)
    while not (tmp_path / "socket").exists():
        assert server.poll() is None
        time.sleep(0.1)
    warm = [job(way) for way in ways]
    server.communicate(timeout=60)
    assert server.returncode == 0
    assert [code for code, *_ in warm] == [0, 3, 1, 1, 1]
    assert [out for _, out, _ in warm[:4]] == [
        out.replace("False", "True") for _, out, _ in alone[:4]
    ]
    assert warm[4][2] == "to stderr\nkilled, perhaps for want of memory\n"
    assert [err.splitlines()[-1] for *_, err in warm[:4]] == [
        err.splitlines()[-1] for *_, err in alone[:4]
    ]


def test_a_job_waits_for_the_process_that_has_been_started(tmp_path: Path) -> None:
    """Its first jobs had imports of their own, which held up both on two cores."""
    (tmp_path / "job.py").write_text("import sys; print('xarray' in sys.modules)")
    server = subprocess.Popen([*WARM, tmp_path / "socket"], stdin=subprocess.PIPE, cwd=ROOT)
    (tmp_path / "started").write_text(str(server.pid))
    words = [*WARM, tmp_path / "socket", "job.py"]
    first = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True)
    server.communicate(timeout=60)
    (tmp_path / "socket").unlink()
    later = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True)
    assert first.stdout == "True\n"
    assert later.stdout == "False\n", "the process has ended"
