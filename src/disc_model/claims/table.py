"""The table of claims, and how it is written."""

from __future__ import annotations

import pandas as pd
import xarray as xr

from disc_model.claims import disc, section41, section42, section43, section44
from disc_model.claims.model import CaseView, Claim

COLUMNS = ("id", "location", "claim", "paper_value", "ours", "tolerance", "reason", "verdict", "remark")
CLAIMS: tuple[Claim, ...] = (*disc.CLAIMS, *section41.CLAIMS, *section42.CLAIMS, *section43.CLAIMS, *section44.CLAIMS)


def check_claims(tree: xr.DataTree) -> pd.DataFrame:
    """Check every claim against merged cases: a row per claim, columns `COLUMNS` (see `studies.cases.merge`)."""
    cases = {name: CaseView(name, node) for name, node in tree.children.items()}
    rows = []
    for claim in CLAIMS:
        found = claim.evaluate(cases)
        said = (claim.id, claim.location, claim.text, claim.paper, found.ours, claim.tolerance, claim.reason)
        rows.append((*said, found.verdict, found.remark))
    return pd.DataFrame(rows, columns=list(COLUMNS))


def to_markdown(table: pd.DataFrame) -> str:
    """The table as a Markdown document, with a count of the verdicts above it."""
    count = table["verdict"].str.partition(":")[0].value_counts()
    summary = ", ".join(f"{verdict}: {number}" for verdict, number in count.items())
    header = [name.replace("_", " ").replace("ours", "computed") for name in COLUMNS]
    lines = ["# The paper's claims", "", f"{len(table)} claims; {summary}.", ""]
    lines += [_row(header), _row(["---"] * len(header))]
    lines += [_row(row) for row in table.itertuples(index=False)]
    return "\n".join(lines) + "\n"


def _row(cells: object) -> str:
    return "| " + " | ".join(str(cell).replace("|", r"\|") for cell in cells) + " |"  # type: ignore[attr-defined]
