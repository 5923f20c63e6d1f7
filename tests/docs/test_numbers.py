"""Numbers of README, docs and captions are those of results: docs/statements.yaml,
docs/collect_numbers.py."""

import re

import pytest
from docs.collect_numbers import ROOT, STATEMENTS, Sources, Statement

from disc_model.data.dataset import MissingFile
from docs import collect_numbers


@pytest.mark.parametrize(
    "statement", collect_numbers.statements(), ids=lambda statement: statement.text[:60]
)
def test_pages_say_the_stored_numbers(statement: Statement) -> None:
    count, wrong = collect_numbers.faults(
        statement, collect_numbers.pages(), collect_numbers.stored()
    )
    assert count, "no page says so: change docs/statements.yaml"
    assert not [
        f"{page}: '{match[0]}': {match[i]} has to be {number}" for page, match, i, number in wrong
    ]


def test_the_stored_numbers_are_those_of_the_results() -> None:
    """Of results that are there; some need none but pages that are written from results."""
    sources, values, missing, wrong = Sources(ROOT / "results"), collect_numbers.stored(), set(), []
    fields = {field for statement in collect_numbers.statements() for field in statement.fields}
    for expression, spec in sorted(fields):
        try:
            value = sources.value(expression)
        except MissingFile as error:
            missing.add(str(error))
        else:
            if not collect_numbers.reproduced(
                expression, collect_numbers.shown(values[expression], spec), value, spec
            ):
                wrong.append(f"{expression} is {value}, not {values[expression]}")
    assert not wrong, "run `make numbers`"
    assert values.keys() == {expression for expression, _ in fields}, "run `make numbers`"
    if missing:
        pytest.skip(f"needs `make reproduce`: {len(missing)} files are missing")


@pytest.mark.parametrize(
    "page",
    [
        "README.md",
        "docs/findings.md",
        "docs/details.md",
        "docs/details_friction.md",
        "docs/note.md",
    ],
)
def test_every_number_is_of_a_statement(page: str) -> None:
    """Or docs/statements.yaml lists it as no result."""
    text = collect_numbers.pages()[page].partition("\n## References\n")[0]
    text = re.sub(r"^```.*?^```$|<!-- bench .*?<!-- end -->", " ", text, flags=re.M | re.S)
    for statement in collect_numbers.statements():
        text = statement.pattern.sub(" ", text)
    text = re.sub(r"`[^`]+`|\]\([^)]*\)|\${1,2}[^$]+\${1,2}", " ", text)  # code, links, formulas
    for phrase in sorted(map(str, STATEMENTS["not_from_results"]), key=len, reverse=True):
        words = r"\s+".join(map(re.escape, phrase.split()))
        text = re.sub(rf"(?<![\w.]){words}(?![\w.]*\d)", " ", text)
    assert re.findall(r"[^\n|]{,60}\d[^\n|]{,30}", text) == []


def test_a_number_that_is_not_that_of_the_results_is_corrected() -> None:
    statement = Statement.parse("a fold at {fold:.2f} rad/s in {models:w} models")
    page = {"page.md": "There is a [fold](method.md#folds) at 15.10 rad/s\nin four models."}
    count, wrong = collect_numbers.faults(statement, page, {"fold": 15.0949, "models": 3.0})
    assert count == 1
    assert [(match[i], number) for _, match, i, number in wrong] == [
        ("15.10", "15.09"),
        ("four", "three"),
    ]
    assert collect_numbers.faults(statement, page, {"fold": 15.099, "models": 4.0}) == (1, [])
    assert collect_numbers.agrees("0.13", 0.125 + 1e-12, ".2f")
    assert collect_numbers.agrees("0.13", 0.125 - 1e-12, ".2f"), (
        "noise decides how the last digit is rounded"
    )


@pytest.mark.parametrize(
    ("expression", "text", "value", "right"),
    [
        ("first_separation('S43c12')", "1793", 1770.0, True),
        ("first_separation('S43c12')", "1793", 1740.0, False),
        ("first_separation('F13')", "54.42", 54.43, False),  # before any irregular motion
        (
            "chance('sensitivity', 200, 'separation')",
            "0.45 (0.34 to 0.57)",
            "0.47 (0.36 to 0.59)",
            True,
        ),
        (
            "chance('sensitivity', 200, 'separation')",
            "0.45 (0.34 to 0.57)",
            "0.50 (0.38 to 0.62)",
            False,
        ),
        ("most_changing('sensitivity', 200)", "h 0.64, E 0.50", "h 0.65, k 0.50", False),
    ],
)
def test_results_of_another_processor_may_differ_where_a_last_bit_decides(
    expression, text, value, right
) -> None:
    spec = (
        "s" if isinstance(value, str) else "w" if text.isalpha() else ".2f" if "." in text else ""
    )
    assert collect_numbers.reproduced(expression, text, value, spec) == right
