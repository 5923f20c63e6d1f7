"""The ledger: every claim of the paper, checked."""

from __future__ import annotations

import pandas as pd
import xarray as xr

from disc_model.claims import disc, section41, section42, section43, section44
from disc_model.claims.model import CaseView, Claim

COLUMNS = ("id", "location", "claim", "paper_value", "ours", "tolerance", "reason", "verdict", "remark")
CLAIMS: tuple[Claim, ...] = tuple(
    found
    for section in (disc, section41, section42, section43, section44)
    for found in vars(section).values()
    if isinstance(found, Claim)
)
"""In the order in which they stand in the files."""


def check_claims(tree: xr.DataTree) -> pd.DataFrame:
    """Check every claim against merged cases: a row per claim, columns `COLUMNS` (see `studies.cases.merge`)."""
    cases = {name: CaseView(name, node) for name, node in tree.children.items()}
    rows = []
    for claim in CLAIMS:
        found = claim.evaluate(cases)
        said = (claim.id, claim.location, claim.text, claim.paper, found.ours, claim.tolerance, claim.reason)
        rows.append((*said, found.verdict, found.remark))
    return pd.DataFrame(rows, columns=list(COLUMNS))
