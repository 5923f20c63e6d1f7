"""The paper's claims as data and checks: see `ledger.check_claims`.

Here are the names that the workflow reads.
"""

SCANS = (
    "basins",
    "bonded",
    "brake_outcome",
    "critical_speed",
    "hysteresis",
    "map_D_star",
    "map_E",
    "map_N",
    "map_c_p",
    "map_k",
    "map_k_p",
    "map_m",
    "stretching_motions",
)
"""Grid studies that rows of the ledger use."""

SURVIVAL_GRIDS = (
    "survival_growth",
    "survival_outcome",
    "survival_speed",
    "survival_curves",
    "survival_damping",
)
"""Grid studies of config/survival.yaml, by which `survival` judges conclusions under other models."""

TABLE_CASES = {
    "table1": ("F13",),
    "table2": ("F13",),
    "periods": ("F02", "F07", "F22"),
    "impact_law": ("F13", "P03l8", "P03l4c1", "P03l4c2", "P03res"),
    "energies": ("F02", "F04", "F06", "F07", "F08", "F09"),
    "small_changes": ("F11", "F13"),
    "precursor": (),
}
"""Cases of each table.

Those of `periods` repeat, although the paper calls them quasi-periodic or unpredictable.
"""

JUDGING_TABLES = ("energies", "precursor", "small_changes")
"""Tables that checks of the ledger are given."""
