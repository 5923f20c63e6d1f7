"""A command whose output is read in part, as by `head`."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = str(Path(sys.executable).with_name("disc-model"))
THICK = """
study: thick
quantity: outcome
options: {horizon: 20}
base: {N: 385, h: 0.1}
axes: {Omega: [10, 12]}
"""


@pytest.mark.skipif(not hasattr(signal, "SIGPIPE"), reason="no such signal here")
def test_a_plan_ends_quietly_without_its_reader(tmp_path: Path) -> None:
    """The warning about the thick disc, which follows it, ended in a hundred lines about a broken pipe."""
    (tmp_path / "thick.yaml").write_text(THICK)
    words = [PROGRAM, "study", "thick.yaml", "-n"]
    pipe = subprocess.PIPE
    with subprocess.Popen(words, cwd=tmp_path, stdout=pipe, stderr=pipe, text=True) as started:
        assert started.stdout is not None
        assert started.stderr is not None
        while not started.stdout.readline().startswith("Estimated time"):
            pass
        started.stdout.close()
        assert started.stderr.read() == ""
