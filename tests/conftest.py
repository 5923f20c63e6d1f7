"""What all tests share."""

from __future__ import annotations

import pytest

from tests import tally


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Say how much was tried."""
    if found := list(tally.lines()):
        terminalreporter.section("tried")
        for line in found:
            terminalreporter.line(line)
