"""A shell at a terminal: what a user types, and what the screen then shows."""

import os
import pty
import re
import select
import signal
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

CONTROL = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]|\x1b[=>]|\r|\x07")


class Shell:
    """An interactive shell on a pseudo-terminal of its own."""

    def __init__(self, process: int, terminal: int) -> None:
        self.process, self.terminal = process, terminal
        self.screen = ""

    def type(self, text: str) -> None:
        os.write(self.terminal, text.encode())

    def read(self, seconds: float) -> None:
        """Take in what is shown meanwhile."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0 and select.select([self.terminal], [], [], left)[0]:
            self.screen += CONTROL.sub("", os.read(self.terminal, 65536).decode(errors="replace"))

    def wait_for(self, text: str, seconds: float = 60.0) -> str:
        """What is shown up to a text, which the next search begins after; fails if it does not come."""
        end = time.monotonic() + seconds
        while text not in self.screen:
            assert time.monotonic() < end, f"{text!r} did not come: {self.screen}"
            self.read(0.1)
        before, _, self.screen = self.screen.partition(text)
        return before

    def wait_for_program(self, seconds: float = 60.0) -> None:
        """Wait until the shell has given the terminal to a program: a Ctrl-C before that reaches the shell alone."""
        end = time.monotonic() + seconds
        while os.tcgetpgrp(self.terminal) == self.process:
            assert time.monotonic() < end, self.screen
            time.sleep(0.001)


@contextmanager
def shell(command: Sequence[str], folder: Path, **variables: str) -> Iterator[Shell]:
    """Start a shell in a folder, with these variables of the environment besides; hang up at the end."""
    environment: Mapping[str, str] = os.environ | {"TERM": "dumb", "COLUMNS": "200"} | variables
    process, terminal = pty.fork()
    if process == 0:
        os.chdir(folder)
        os.execvpe(command[0], command, environment)
    try:
        yield Shell(process, terminal)
    finally:
        os.kill(process, signal.SIGHUP)
        os.waitpid(process, 0)
        os.close(terminal)
