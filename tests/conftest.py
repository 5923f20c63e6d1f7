"""What all tests share."""

from __future__ import annotations

import pytest

from tests import needs, tally


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Say how much was tried, and what was not because something is not installed."""
    # the last part of a skipped test's (file, line, reason)
    skipped = [report.longrepr[-1] for report in terminalreporter.getreports("skipped")]
    for title, found in (("tried", list(tally.lines())), ("not tried", list(needs.lines(skipped)))):
        if found:
            terminalreporter.section(title)
            for line in found:
                terminalreporter.line(line)
