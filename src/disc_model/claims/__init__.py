"""The paper's claims, as data and checks, against what was computed.

Each claim states in our own words what the paper says, where, and what would count as agreement and why; its
check computes everything it reports from the merged cases, from grid studies or from the disc's modes.
`ledger.check_claims` makes the table.
"""

SCANS = ("bonded", "critical_speed", "map_E", "map_c_p")
"""Grid studies that claims look at; here, where the workflow learns of them without importing what computes."""
SURVIVAL_GRIDS = ("survival_growth", "survival_outcome", "survival_speed", "survival_curves", "survival_damping")
"""Those of config/survival.yaml, by which `survival` judges the conclusions under other models."""
