"""Common kinds of finding, so that equal outcomes read alike."""

from __future__ import annotations

import math

from disc_model.claims.model import FAILS, HOLDS, REMARK, CaseView, Finding


def verdict(holds: bool, remark: str = "") -> str:
    """The verdict for a statement that holds or not, with or without a remark."""
    if not holds:
        return FAILS
    return REMARK if remark else HOLDS


def finding(ours: str, holds: bool, remark: str = "") -> Finding:
    return Finding(ours, verdict(holds, remark), remark)


def first_separation(case: CaseView) -> str:
    """When a case first separates, in words."""
    time = case["first_separation"]
    if math.isnan(time):
        return f"no separation in {case['time_reached']:g} s"
    return f"first separation at {time:.2f} s"


def many(values: object, digits: int = 2) -> str:
    """Numbers in a row."""
    return ", ".join(f"{value:.{digits}f}" for value in values)  # type: ignore[attr-defined]
