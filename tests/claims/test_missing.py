"""What a study does not hold ends no table: the rows that need it say so, the others are judged."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pytest
import xarray as xr

from disc_model.claims import ledger
from disc_model.claims.ledger import CLAIMS, views
from disc_model.claims.model import FAILS, HOLDS, NOT_COMPUTED, REMARK, UNDECIDED, CaseView, Claim
from tests.claims import made_up
from tests.claims.damaged import DAMAGES, damaged

pytestmark = pytest.mark.usefixtures("cycles_as_told")
NOT_HELD = {
    "failed": "failed (case ",
    "nothing recorded": "did not record",
    "no events": "keeps no events",
    "no envelopes": "as samples, not as ranges",
    "only envelopes": "as ranges, not as samples",
    "empty windows": "at least",
    "single samples": "at least",
}
"""Words of the reason by damage. The others may leave a claim decided."""


def verdicts_of(cases: dict[str, CaseView], claims: Iterable[Claim]) -> list[str]:
    found = [claim.evaluate(cases).verdict for claim in claims]
    assert all(
        verdict in (HOLDS, REMARK, FAILS, UNDECIDED) or verdict.startswith(f"{NOT_COMPUTED}: ") for verdict in found
    )
    return found


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("damage", DAMAGES)
def test_damage_ends_no_claim(damage: str, told: xr.DataTree) -> None:
    """This used to end the whole table with a KeyError, IndexError, ValueError or ZeroDivisionError."""
    cases = {name: CaseView(name, damaged(node, DAMAGES[damage])) for name, node in told.children.items()}
    said = verdicts_of(cases, CLAIMS)
    if damage in NOT_HELD:
        assert any(NOT_HELD[damage] in verdict and "case " in verdict for verdict in said)


@pytest.mark.slow
@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_case_among_whole_ones_ends_no_claim(damage: str, told: xr.DataTree) -> None:
    """One at a time: what is missing first may hide what is missing next."""
    cases = views(told)
    for name, view in cases.items():
        hurt = cases | {name: CaseView(name, damaged(view.node, DAMAGES[damage]))}
        verdicts_of(hurt, [claim for claim in CLAIMS if name in claim.said.cases])


def test_a_failed_case_counts_for_neither_normalisation(told: xr.DataTree) -> None:
    """It used to be listed among those that no longer separate."""
    tree = made_up.orthonormal(told)
    tree["F17"] = damaged(tree["F17"], DAMAGES["failed"])
    found = ledger.compare(told, tree)
    text, table = found.sections[1][1:]
    assert "No longer: none." in text
    assert text.endswith("Without a result: F17.")
    assert table.set_index("Case").loc["F17", "First separation, Eq. (17)"] == "failed"
    assert not np.any(table.map(lambda cell: "nan" in str(cell)))
