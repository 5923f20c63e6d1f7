"""What is shown of long work on a terminal."""

import io
import sys

import pytest
from rich.console import Console

from disc_model import Parameters, critical, display


def test_a_long_search_is_shown_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", stderr := io.StringIO())
    monkeypatch.setattr(display, "_terminal", lambda: Console(file=stderr, force_terminal=True))
    for terminal in (False, True):
        monkeypatch.setattr(stderr, "isatty", lambda terminal=terminal: terminal)
        assert stderr.getvalue() == ""
        critical(Parameters(N=385, Omega=12, mu_k_over_mu_s=0.6), "mu_s", (0.3, 0.42), points=7)
    assert all(f" {what} of mu_s" in stderr.getvalue() for what in ("7 values", "further values", "crossings"))
