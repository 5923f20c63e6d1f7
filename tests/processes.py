"""Programs in processes of their own, as users start them."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]


def run(
    *command: object, cwd: Path = ROOT, fails: bool = False, timeout: float = 3600, **variables: str
) -> subprocess.CompletedProcess[str]:
    """Run a program, with these variables of the environment besides; it has to succeed, or to
    fail."""
    words = [*map(str, command)]
    environment = os.environ | variables
    done = subprocess.run(
        words,
        cwd=cwd,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=timeout,
    )
    assert (done.returncode != 0) == fails, done.stdout + done.stderr
    return done


def python(code: str, *arguments: object, **how: object) -> subprocess.CompletedProcess[str]:
    """Run a piece of Python; ``how`` is that of `run`."""
    return run(sys.executable, "-c", code, *arguments, **how)  # type: ignore[arg-type]
