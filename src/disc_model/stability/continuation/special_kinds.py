"""Kinds of special points of a branch, and their labels."""

LABELS: dict[str, str] = {
    "fold": "LP",
    "period_doubling": "PD",
    "neimark_sacker": "TR",
    "branch_point": "BP",
    "grazing": "GR",
    "hopf": "HB",
    "end": "EP",
    "max_points": "EP",
    "lost": "EP",
}
"""Kinds of special points, and their labels in AUTO and COCO."""
CHANGES = ("fold", "period_doubling", "neimark_sacker")
"""Kinds of special points that are located to rounding, and at which a multiplier crosses the unit
circle."""
