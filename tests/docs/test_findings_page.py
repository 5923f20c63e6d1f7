"""The numbers of docs/findings.md and the verdicts of docs/normalisation.md are those of the ledger."""

import re
from pathlib import Path

import pandas as pd
import pytest

from disc_model.paper.ledger import CLAIMS
from disc_model.paper.model import FAILS, HOLDS, NOT_TESTABLE, REMARK, UNDECIDED

ROOT = Path(__file__).parents[2]
LEDGER = ROOT / "results" / "paper" / "claims.csv"
COUNTED = (
    r"The paper makes (\d+) statements\. Of these, (\d+) hold and (\d+) hold with a remark\. (\d+) do not hold, "
    r"(\d+) cannot be decided, and one is a recommendation\."
)


def told() -> tuple[int, list[int], str]:
    """Number of statements, numbers of verdicts, and the text."""
    text = " ".join((ROOT / "docs" / "findings.md").read_text(encoding="utf-8").split())
    found = re.search(COUNTED, text)
    assert found is not None
    total, *counts = map(int, found.groups())
    return total, [*counts, 1], text


def test_every_row_of_the_ledger_is_counted() -> None:
    total, counts, text = told()
    apart = sum(bool(claim.apart) for claim in CLAIMS)
    assert total == sum(counts) == len(CLAIMS) - apart
    assert f"Another {apart} rows of that table" in text


needs_results = pytest.mark.skipif(not LEDGER.exists(), reason="needs results/paper/claims.csv, by `make reproduce`")


@needs_results
def test_the_verdicts_are_those_of_the_results() -> None:
    """After `make reproduce`."""
    table = pd.read_csv(LEDGER, keep_default_na=False)
    found = table["verdict"][table["apart"] == ""].value_counts()
    assert told()[1] == [found.get(verdict, 0) for verdict in (HOLDS, REMARK, FAILS, UNDECIDED, NOT_TESTABLE)]


@needs_results
def test_both_pages_have_one_verdict_for_a_statement() -> None:
    """C5 was undecided in the ledger and held, with a remark, on the page on the normalisation."""
    verdicts = pd.read_csv(LEDGER, keep_default_na=False).set_index("id")["verdict"]
    page = (ROOT / "docs" / "normalisation.md").read_text(encoding="utf-8").partition("| Statement |")[2]
    told = dict(re.findall(r"^\| (\w+): .*? \| ([a-z ]+) \| [a-z ]+ \| ", page, flags=re.MULTILINE))
    assert len(told) > 20
    assert told == verdicts[list(told)].to_dict()
