"""The random search of tests: what it draws is decided by the test, or by a seed, and by nothing else."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st


def drawn() -> list[str]:
    found = []

    @settings(settings.get_profile("quick"))
    @given(st.floats(), st.text())
    def collect(number: float, text: str) -> None:
        found.append(f"{number!r} {text!r}")

    collect()
    return found


def test_draws_are_the_same_whatever_else_is_loaded(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    before = drawn()
    (tmp_path / "constants_of_a_project.py").write_text(f"X = {[x + 0.125 for x in range(1000)]}\n")
    monkeypatch.syspath_prepend(tmp_path)
    __import__("constants_of_a_project")
    try:
        assert drawn() == before
    finally:
        del sys.modules["constants_of_a_project"]


def test_the_quick_search_keeps_nothing_and_draws_nothing_at_random() -> None:
    quick, long = (settings.get_profile(name) for name in ("quick", "long"))
    assert quick.derandomize
    assert not long.derandomize
    assert quick.database is long.database is None
    assert long.max_examples >= 10 * quick.max_examples
