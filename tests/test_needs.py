"""tests/needs.py: the skips, the summary of a run and CONTRIBUTING.md say the same."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests import needs

ROOT = Path(__file__).parents[1]
pytest_plugins = "pytester"


def test_contributing_has_the_table() -> None:
    assert needs.table() in (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("need", needs.ALL, ids=lambda need: need.name)
def test_every_need_says_what_brings_it(need: needs.Need) -> None:
    assert need.debian or need.pip
    # a need of no tests would stand in the table for nothing
    name = next((name for name, value in vars(needs).items() if value is need), "PYTHONS")
    users = [path for path in ROOT.glob("tests/**/*.py") if f"needs.{name}" in path.read_text(encoding="utf-8")]
    assert users


def test_no_test_looks_for_an_optional_package_by_itself() -> None:
    alone = re.compile(r"importorskip\(|skipif\((shutil\.which|not shutil\.which)")
    own = Path(__file__)
    assert [p for p in ROOT.glob("tests/**/*.py") if p != own and alone.search(p.read_text(encoding="utf-8"))] == []


def test_packages_of_the_long_mode_are_locked() -> None:
    """What pip is told to install brings the modules."""
    lock = (ROOT / "requirements-bench.lock").read_text(encoding="utf-8")
    for name in ("heyoka", "mpmath", "scikit-sundae"):
        assert re.search(rf"^{name}==", lock, re.MULTILINE), name


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
