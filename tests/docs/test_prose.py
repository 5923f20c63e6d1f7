"""Pages are written in short sentences, in the words of the glossary, with symbols that are defined."""

import io
import re
import tokenize
from functools import cache
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "config" / "README.md", ROOT / "results" / "README.md"]
PAGES += sorted(path for path in (ROOT / "docs").rglob("*.md") if "_build" not in path.parts)
PAGES = [page for page in PAGES if "{include}" not in page.read_text(encoding="utf-8")]
LONG, SHARE, MEAN, LONGEST = 30, 0.08, 20, 45
"""Words of a long sentence, the share that may be long; words of the mean sentence and of the longest."""
SOURCES, TEXTS = ("workflow", "config", "src/disc_model"), (".py", ".yaml", ".smk", ".rst")
OLD: dict[str, str] = yaml.safe_load(Path(__file__).with_name("old_terms.yaml").read_text(encoding="utf-8"))
"""Words that pages do not use, and those of the glossary that they do."""
NAMES = "alpha beta delta kappa mu nu xi psi Psi Pi Phi Sigma sigma omega Omega varphi rho theta Lambda lambda"
GREEK = dict(zip(NAMES.split(), "αβδκμνξψΨΠΦΣσωΩφρθΛλ", strict=True))
STANDARD = {"e", "i", "I", "O", "T", "H"}
"""Letters of mathematics: Euler's number, the imaginary unit, the identity, Landau's symbol, transposes."""


def plain(text: str) -> str:
    """The running text of a page: no code, formulas, tables, references, comments or addresses."""
    text = re.sub(r"\A---\n.*?\n---\n|^```.*?^```$|<!--.*?-->|^\$\$.*?\$\$$", "\n\n", text, flags=re.M | re.S)
    text = re.sub(r"^## References\n.*?(?=^## |\Z)|^\|[^\n]*$|^!\[[^\n]*$|^#+ [^\n]*$", "\n\n", text, flags=re.M | re.S)
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)|\{nb-download\}", r"\1", text)
    return re.sub(r"`[^`]+`|\$[^$]+\$", "Code", text)


def sentences(text: str) -> list[int]:
    """Words of each sentence; an entry of a list begins one."""
    text = re.sub(r"\b(Eqs?|Figs?|e\.g|i\.e|vs|al|ca)\.", r"\1", re.sub(r"\n(?=[ ]*(?:[-*]|\d+\.) )", "\n\n", text))
    parts = (re.split(r"(?<=[.!?])[*)\"]*\s+(?=[\"*(]*[A-Z`0-9]|\([a-z]\))", p) for p in re.split(r"\n\s*\n", text))
    counts = [len(re.findall(r"[^\s]*\w[^\s]*", part)) for paragraph in parts for part in paragraph]
    return [count for count in counts if count > 2]


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
def test_sentences_are_short(page: Path) -> None:
    counts = sentences(plain(page.read_text(encoding="utf-8")))
    long = sum(count > LONG for count in counts)
    assert long <= max(1, SHARE * len(counts)), f"{long} of {len(counts)} sentences have more than {LONG} words"
    assert sum(counts) <= MEAN * len(counts)
    assert max(counts) <= LONGEST


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_old_terms_are_gone(page: Path) -> None:
    text = re.sub(r"`[^`]+`|^```.*?^```$|\]\([^)]*\)", " ", page.read_text(encoding="utf-8"), flags=re.M | re.S)
    found = {match[0]: now for old, now in OLD.items() for match in re.finditer(rf"\b(?:{old})\b", text, re.I)}
    assert found == {}


def prose(path: Path) -> str:
    """Comments and texts of a module, or all of another file, without names in code."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        tokens = tokenize.generate_tokens(io.StringIO(text).readline)
        text = "\n".join(token.string for token in tokens if token.type in (tokenize.COMMENT, tokenize.STRING))
    return re.sub(r"`+[^`]+`+", " ", text)


def test_old_terms_are_gone_from_sources() -> None:
    """But for the engine, whose names are its own, the table of old names, and American names of arguments."""
    files = [path for folder in SOURCES for path in (ROOT / folder).rglob("*") if path.suffix in TEXTS]
    files = [path for path in files if "engine" not in path.relative_to(ROOT).parts and path.name != "renamed.py"]
    assert len(files) > 150
    old = "|".join(term for term in OLD if not re.search("floors|normaliz", term))
    found = {(file.name, match[0]) for file in files for match in re.finditer(rf"\b(?:{old})\b", prose(file), re.I)}
    assert found == set()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_symbols_are_defined(page: Path) -> None:
    """In the table of symbols of docs/model.md or in docs/glossary.md; running indices need no definition."""
    found = symbols(page.read_text(encoding="utf-8"))
    assert {symbol for symbol in found if not {symbol, re.sub(r"_[jklnrIY0-9K]$", "", symbol)} & defined()} == set()
