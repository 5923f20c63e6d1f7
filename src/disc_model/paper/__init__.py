"""The paper's claims as data and checks: `ledger.check_claims`. Here are names that the workflow
reads."""

_MAPS = (f"map_{name}" for name in ("D_star", "E", "N", "c_p", "k", "k_p", "m"))
SCANS = ("basins", "bonded", "critical_speed", "hysteresis", *_MAPS)
"""Grid studies that rows of the ledger use."""
SURVIVAL_GRIDS = (
    "survival_growth",
    "survival_outcome",
    "survival_speed",
    "survival_curves",
    "survival_damping",
)
"""Grid studies of config/survival.yaml, by which `survival` judges the conclusions under other models."""
TABLE_CASES = {
    "table1": ("F13",),
    "table2": ("F13",),
    "periods": ("F02", "F07", "F22"),
    "impact_law": ("F13", "P03l8", "P03l4c1", "P03l4c2", "P03res"),
}
"""Cases of each table; of periods those that the paper calls quasi-periodic or unpredictable, and that repeat."""
