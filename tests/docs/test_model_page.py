"""The numbers of docs/model.md, and the table of symbols."""

import re
from pathlib import Path

import numpy as np
import pytest

from disc_model import Parameters
from disc_model.data.variables import SCALARS, SERIES, attributes
from disc_model.disc.plate import coupled_frequencies

DOCS = Path(__file__).parents[2] / "docs"
MODEL = (DOCS / "model.md").read_text("utf-8")
SYMBOLS = (DOCS / "glossary.md").read_text("utf-8")
POWERS = str.maketrans("⁻¹²³", "-123")


def section(page: str, title: str) -> str:
    """Return the text under a heading of the second level."""
    return page.split(f"\n## {title}\n")[1].split("\n## ")[0]


@pytest.mark.parametrize("normalization", ["as_published", "orthonormal"])
def test_attached_frequencies_on_the_page(normalization: str) -> None:
    text = section(MODEL, "Two normalisations")
    row = re.search(rf"^\| `{normalization}` \|(.*)\|$", text, re.M)[1]
    words = [word.strip() for word in row.split(",")]
    digits = max(len(word.split(".")[1]) for word in words)
    p = Parameters(N=200, Omega=20, normalization=normalization)
    expected = [float(word) for word in words]
    # half of the last digit
    np.testing.assert_allclose(coupled_frequencies(p), expected, rtol=0, atol=0.51 * 10**-digits)


def symbols() -> dict[str, str]:
    """Return the units in the table of symbols, by name."""
    lines = [line for line in section(SYMBOLS, "Symbols").splitlines() if line.startswith("|")]
    units = {}
    for line in lines[2:]:
        _, names, _, unit = line.strip("|").split("|")
        for name in re.findall(r"`(\w+)`(?! ¹)", names):
            units[name] = unit.strip().translate(POWERS)
    return units


def test_every_variable_is_in_the_table_of_symbols() -> None:
    known = {*SERIES, *SCALARS, *Parameters.model_fields}
    table = symbols()
    assert known - table.keys() == set(), "add a row to docs/glossary.md, Symbols"
    assert table.keys() - known == set(), "no such variable: docs/glossary.md, Symbols"
    assert {name: attributes(name)["units"] for name in known} == table
