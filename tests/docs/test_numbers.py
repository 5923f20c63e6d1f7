"""Numbers of README, docs and captions are those of results: docs/statements.yaml, docs/sentences.py."""

import re

import pytest
from docs.sentences import ROOT, STATEMENTS, Statement, Value
from docs.sources import Sources

from disc_model.data.dataset import MissingFile
from docs import sentences

WHOLE_PAGES = {
    "README.md": "",
    "docs/findings.md": "",
    "docs/evidence.md": "",
    "docs/note.md": "",
    "docs/brake_disc.md": "## What friction on the surface does",
}
"""Pages all of whose numbers are accounted for, from a heading on if one is given."""


@pytest.mark.parametrize("statement", sentences.statements(), ids=lambda each: each.text[:60])
def test_pages_say_the_stored_numbers(statement: Statement) -> None:
    count, wrong = sentences.faults(statement, sentences.pages(), sentences.stored())
    assert count, "no page says so: change docs/statements.yaml"
    words = []
    for page, match, i, number in wrong:
        words.append(f"{page}: '{match[0]}': {match[i]} has to be {number}")
    assert not words


def test_the_stored_numbers_are_those_of_the_expressions() -> None:
    names = {expression for expression, _ in sentences.expressions()}
    assert sentences.stored().keys() == names, "run `make numbers`"


def test_the_stored_numbers_are_those_of_the_results() -> None:
    """Of results that are there; some need none but pages that are written from results."""
    sources = Sources(ROOT / "results")
    stored = sentences.stored()
    missing = set()
    wrong = []
    for expression, spec in sentences.expressions():
        try:
            value = sources.value(expression)
        except MissingFile as error:
            missing.add(str(error))
            continue
        text = sentences.shown(stored[expression], spec)
        if not sentences.reproduced(expression, text, value, spec):
            wrong.append(f"{expression} is {value}, not {stored[expression]}")
    assert not wrong, "run `make numbers`"
    if missing:
        pytest.skip(f"needs `make reproduce`: {len(missing)} files are missing")


def without_known_numbers(text: str) -> str:
    """Return a page without its statements, and without what is listed as no result."""
    text = text.partition("\n## References\n")[0]
    text = re.sub(r"^```.*?^```$|<!-- bench .*?<!-- end -->", " ", text, flags=re.M | re.S)
    for statement in sentences.statements():
        text = statement.pattern.sub(" ", text)
    code_links_formulas = r"`[^`]+`|\]\([^)]*\)|\${1,2}[^$]+\${1,2}"
    text = re.sub(code_links_formulas, " ", text)
    phrases = sorted(map(str, STATEMENTS["not_from_results"]), key=len, reverse=True)
    for phrase in phrases:
        words = r"\s+".join(map(re.escape, phrase.split()))
        text = re.sub(rf"(?<![\w.]){words}(?![\w.]*\d)", " ", text)
    return text


@pytest.mark.parametrize("page", WHOLE_PAGES)
def test_every_number_is_of_a_statement(page: str) -> None:
    """Or docs/statements.yaml lists it as no result."""
    text = sentences.pages()[page]
    start = text.index(WHOLE_PAGES[page])
    text = without_known_numbers(text[start:])
    assert re.findall(r"[^\n|]{,60}\d[^\n|]{,30}", text) == []


# ---- Statements of a made-up page

FOLD = Statement.parse("a fold at {fold:.2f} rad/s in {models:w} models")
PAGE = {"page.md": "There is a [fold](method.md#folds) at 15.10 rad/s\nin four models."}


def test_a_number_that_is_not_that_of_the_results_is_named() -> None:
    count, wrong = sentences.faults(FOLD, PAGE, {"fold": 15.0949, "models": 3.0})
    assert count == 1
    found = [(fault.match[fault.group], fault.number) for fault in wrong]
    assert found == [("15.10", "15.09"), ("four", "three")]


def test_a_number_that_is_that_of_the_results_is_no_fault() -> None:
    assert sentences.faults(FOLD, PAGE, {"fold": 15.099, "models": 4.0}) == (1, [])


def test_pages_are_corrected_at_all_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sentences, "statements", lambda: (FOLD,))
    texts = sentences.corrected(PAGE, {"fold": 15.0949, "models": 3.0})
    assert texts == {
        "page.md": "There is a [fold](method.md#folds) at 15.09 rad/s\nin three models."
    }


@pytest.mark.parametrize("value", [0.125 + 1e-12, 0.125 - 1e-12])
def test_noise_may_decide_how_the_last_digit_is_rounded(value: float) -> None:
    assert sentences.agrees("0.13", value, ".2f")


@pytest.mark.parametrize(
    ("expression", "text", "value", "spec", "right"),
    [
        ("first_separation('S43c12')", "1793", 1770.0, "", True),
        ("first_separation('S43c12')", "1793", 1740.0, "", False),
        # before any irregular motion
        ("first_separation('F13')", "54.42", 54.43, ".2f", False),
        ("round(range_law().single, -1)", "250", 240.0, "", True),
        ("ratios().max()", "11", 11.97, ".2g", True),
        ("ratios().max()", "11", 13.0, ".2g", False),
        ("chance(...)", "0.45 (0.34 to 0.57)", "0.47 (0.36 to 0.59)", "s", True),
        ("chance(...)", "0.45 (0.34 to 0.57)", "0.50 (0.38 to 0.62)", "s", False),
        ("most_changing(...)", "h 0.64, E 0.50", "h 0.65, E 0.51", "s", True),
        ("most_changing(...)", "h 0.64, E 0.50", "h 0.65, k 0.50", "s", False),
    ],
)
def test_results_of_another_processor_may_differ_where_a_last_bit_decides(
    expression: str, text: str, value: Value, spec: str, right: bool
) -> None:
    assert sentences.reproduced(expression, text, value, spec) == right
