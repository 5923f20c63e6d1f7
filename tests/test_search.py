"""The random search of tests: what it draws is decided by the test, or by a seed, and by nothing else."""

import sys
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st


def drawn() -> list[str]:
    found = []

    @settings(settings.get_profile("quick"), max_examples=20)
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
