"""tests/needs.py: the skips, the summary of a run and CONTRIBUTING.md say the same."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests import needs

ROOT = Path(__file__).parents[1]
pytest_plugins = "pytester"


def test_contributing_has_the_table() -> None:
    assert needs.table() in (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")


def test_a_run_says_what_it_did_not_try(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    absent = needs.Need("nothing", "nothing", debian="no-such-package", programs=(("no-such-program",),))
    monkeypatch.setattr(needs, "ALL", (absent, needs.SLURM))
    pytester.makeconftest((ROOT / "tests" / "conftest.py").read_text(encoding="utf-8"))
    pytester.makepyfile(
        """
        import pytest
        from tests import needs
        absent, _ = needs.ALL

        @absent.mark
        def test_marked(): ...

        def test_asking(): pytest.skip(absent.reason)

        def test_here(): ...
        """
    )
    out = pytester.runpytest_inprocess("-p", "no:cacheprovider").stdout
    out.fnmatch_lines(["*not tried*", "2 tests: needs nothing (Debian: no-such-package)"])
    out.no_fnmatch_line("*SLURM*")
