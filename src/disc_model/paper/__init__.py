"""The paper's claims, as data and checks against the computed results.

Each claim states in our own words what the paper says, where it says it, and what counts as agreement and why. Its
check computes all numbers from merged cases, grid studies or the disc's modes. `ledger.check_claims` makes the table.
"""

SCANS = (
    "basins",
    "bonded",
    "critical_speed",
    "hysteresis",
    "map_D_star",
    "map_E",
    "map_N",
    "map_c_p",
    "map_k",
    "map_k_p",
    "map_m",
)
"""Grid studies that rows use; listed here so that the workflow reads them without importing the computations."""
SURVIVAL_GRIDS = ("survival_growth", "survival_outcome", "survival_speed", "survival_curves", "survival_damping")
"""Grid studies of config/survival.yaml, by which `survival` judges the conclusions under other models."""
