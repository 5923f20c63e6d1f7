"""Symbols on pages are defined."""

import re
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "config" / "README.md", ROOT / "results" / "README.md"]
PAGES += sorted(path for path in (ROOT / "docs").rglob("*.md") if "_build" not in path.parts)
PAGES = [page for page in PAGES if "{include}" not in page.read_text(encoding="utf-8")]
NAMES = "alpha beta delta kappa mu nu xi psi Psi Pi Phi Sigma sigma omega Omega varphi rho theta Lambda lambda"
GREEK = dict(zip(NAMES.split(), "αβδκμνξψΨΠΦΣσωΩφρθΛλ", strict=True))
STANDARD = {"e", "i", "I", "O", "T", "H"}
"""Letters of mathematics: Euler's number, the imaginary unit, the identity, Landau's symbol, transposes."""


def symbols(text: str) -> set[str]:
    """Letters in formulas, with an index of one letter or without; names with an index in running text."""
    text = re.sub(r"^```.*?^```$|\]\([^)]*\)|<!--.*?-->", " ", text, flags=re.M | re.S)
    found = set()
    for formula in re.findall(r"\$\$?([^$]+)\$\$?", re.sub(r"`[^`]+`", " ", text)):
        formula = re.sub(r"\\(text|mathrm|mathsf)\{[^}]*\}|_\\text\{?\w+\}?", " ", formula)
        formula = re.sub(r"\\(?:mathcal|mathbf)\{\\?(\w+)\}", r" \1", formula)
        formula = re.sub(r"\\([A-Za-z]+)", lambda m: GREEK.get(m[1], " "), formula)
        found |= set(re.findall(r"(?<![A-Za-z_])[A-Za-zΑ-ω](?:_\{?[A-Za-zΑ-ω0-9])?", formula))
    running = re.sub(r"\$\$?[^$]+\$\$?|`[^`]+`", " ", text)
    found |= set(re.findall(r"(?<![\w/.])[A-Za-z]{1,3}_[A-Za-zΑ-ω0-9]{1,2}(?!\w)", running))
    return {symbol.replace("{", "") for symbol in found}


@cache
def defined() -> set[str]:
    """Symbols of the model's table and of the glossary's, with the names beside them."""
    rows = "\n".join(
        cell
        for page, columns in (("model.md", (1, 2)), ("glossary.md", (1, 2)))
        for line in (ROOT / "docs" / page).read_text(encoding="utf-8").splitlines()
        if line.startswith("|")
        for cell in re.split(r"(?<!\\)\|", line)[columns[0] : columns[1] + 1]
    )
    return symbols(rows) | set(re.findall(r"`(\w+)`", rows)) | STANDARD


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_symbols_are_defined(page: Path) -> None:
    """In the table of symbols of docs/model.md or in docs/glossary.md; running indices need no definition."""
    found = symbols(page.read_text(encoding="utf-8"))
    assert {symbol for symbol in found if not {symbol, re.sub(r"_[jklnrIY0-9K]$", "", symbol)} & defined()} == set()
