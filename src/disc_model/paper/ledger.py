"""The ledger: a check of every claim of the paper."""

from collections.abc import Mapping

import pandas as pd

from disc_model.paper import disc, section41, section42, section43, section44
from disc_model.paper.measures import CaseView
from disc_model.paper.model import claims, judge

CLAIMS = claims(disc, section41, section42, section43, section44)
"""All claims, in the order of the files."""
COLUMNS = ["id", "location", "claim", "paper_value", "ours", "tolerance", "reason"]
COLUMNS += ["verdict", "remark", "apart", "robust"]


def check_claims(cases: Mapping[str, CaseView]) -> pd.DataFrame:
    """Check every claim: a row per claim, of `COLUMNS`.

    cases : the paper's cases and the grid studies of `disc_model.paper.SCANS`; claims that need missing ones are not
        computed
    """
    table = pd.DataFrame(claim.model_dump(include={"id", "location", "claim", "reason", "apart"}) for claim in CLAIMS)
    table["paper_value"] = [claim.fill(claim.paper) for claim in CLAIMS]
    table["tolerance"] = [claim.fill(claim.tolerance) for claim in CLAIMS]
    return table.merge(judge(CLAIMS, {"": cases}), on="id")[COLUMNS]


def verdict_counts(table: pd.DataFrame) -> str:
    """How many claims have each verdict, and how many are not counted, in words."""
    counted = table["apart"] == ""
    counts = table.loc[counted, "verdict"].str.partition(":")[0].value_counts()
    text = ", ".join(f"{verdict}: {number}" for verdict, number in counts.items())
    return text if counted.all() else f"{text}; not counted, for they repeat others or are misprints: {sum(~counted)}"
