"""The numbers of docs/model.md, and the table of symbols."""

import re
from pathlib import Path

import numpy as np
import pytest

from disc_model import Parameters
from disc_model.data.variables import SCALARS, SERIES, attributes
from disc_model.disc.plate import coupled_frequencies

MODEL, SYMBOLS = (
    (Path(__file__).parents[2] / "docs" / f"{name}.md").read_text("utf-8")
    for name in ("model", "glossary")
)
POWERS = str.maketrans("⁻¹²³", "-123")


def section(page, title):
    """The text under a heading of the second level."""
    return page.split(f"\n## {title}\n")[1].split("\n## ")[0]


@pytest.mark.parametrize("normalization", ["as_published", "orthonormal"])
def test_attached_frequencies_on_the_page(normalization):
    row = re.search(
        rf"^\| `{normalization}` \|(.*)\|$", section(MODEL, "Two normalisations"), re.M
    )[1]
    p = Parameters(N=200, Omega=20, normalization=normalization)
    digits = max(len(number.strip().split(".")[1]) for number in row.split(","))
    own, text = coupled_frequencies(p), [float(number) for number in row.split(",")]
    np.testing.assert_allclose(own, text, rtol=0, atol=0.51 * 10**-digits)


def symbols():
    """Names in the table of symbols and their units."""
    rows = [
        line.strip("|").split("|")
        for line in section(SYMBOLS, "Symbols").splitlines()
        if line.startswith("|")
    ]
    assert all(len(row) == 4 for row in rows)
    return {
        name: row[3].strip().translate(POWERS)
        for row in rows[2:]
        for name in re.findall(r"`(\w+)`(?! ¹)", row[1])
    }


def test_every_variable_is_in_the_table_of_symbols():
    known = {*SERIES, *SCALARS, *Parameters.model_fields}
    table = symbols()
    assert known - set(table) == set(), "add a row to docs/glossary.md, Symbols"
    assert set(table) - known == set(), "no such variable: docs/glossary.md, Symbols"
    assert {name: attributes(name)["units"] for name in known} == table
