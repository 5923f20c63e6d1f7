"""Names of version 0.2 that were replaced, and their successors: keys, values, variables, commands and functions."""

from collections.abc import Collection

_INTERVAL = ("", "_low", "_high")
_ALIKE = (
    ("share{}", "basin_fraction{}", _INTERVAL),
    ("energy_share{}", "basin_fraction_by_energy{}", _INTERVAL),
    ("separating_share{}", "separating_fraction{}", _INTERVAL),
    ("cycle_share{}", "cycle_fraction{}", _INTERVAL),
    ("outcome_share{}", "outcome_fraction{}", _INTERVAL),
    ("first_index{}", "sobol_first{}", _INTERVAL),
    ("total_index{}", "sobol_total{}", _INTERVAL),
    ("energy_{}", "energy_residual_{}", ("transverse", "inplane")),
    ("attractor_share_{}", "attractor_{}_fraction", ("stick", "separation")),
    ("share_{}", "{}_fraction", ("stick", "slip", "separation")),
    ("joined_{}", "branch_continues_{}", ("first", "second")),
    ("tongue_{}", "resonance_{}", ("harmonic", "frequency", "diameters", "sign", "detuning")),
    ("kick{}", "perturbation{}", ("", "_u", "_u_velocity", "_f")),
)
"""Old and new names that changed alike, and what stands for the braces in both."""
RENAMED: dict[str, tuple[str, ...]] = {
    **{old.format(part): (new.format(part),) for old, new, parts in _ALIKE for part in parts},
    # variables and dimensions of datasets
    "likeness": ("mac",),
    "forward": ("forward_wave_fraction",),
    "fate": ("attractor_class",),
    "reached": ("attractor_index",),
    "least_kick": ("critical_energy",),
    "least_kick_not": ("critical_energy_lower",),
    "least_kick_sample": ("critical_energy_sampled",),
    "simulated": ("simulated_time",),
    "separated": ("lost_contact",),
    "onset": ("onset_speed",),
    "persists_to": ("offset_speed",),
    "distance": ("cycle_distance",),
    "difference": ("return_map_residual",),
    "difference_rate": ("return_map_residual_rate",),
    "closure": ("period_residual",),
    "steady": ("stationary",),
    "period": ("period_events",),
    "transient": ("transient_time",),
    "origin": ("method",),
    "oscillations": ("period_ratio",),
    "border": ("adjoins_stable_cycle",),
    "n_unfollowed": ("n_continuation_failures",),
    "along": ("trivial_exponent",),
    "covered": ("averaging_time",),
    "draw": ("sample_matrix",),
    "drawn": ("parameter_values",),
    "n_draws": ("n_known_cycles",),
    "n_followed": ("n_known_outcomes",),
    "left_out": ("excluded_fraction",),
    # a variable of outcome, and keys of study files
    "settled": ("settling_time", "early_end"),
    "near": ("early_end", "attractor_tol"),
    "late": ("evaluation_time",),
    "coarse": ("initial_cell_size",),
    "longest": ("max_transient", "max_step"),
    "starts": ("n_starts",),
    "bisected": ("n_bisection_directions",),
    "outcomes": ("simulated_samples",),
    "cap": ("growth_rate_cap",),
    "window": ("half_bandwidth",),
    "rise": ("min_rise",),
    "stay": ("dwell",),
    "prepare": ("prerun",),
    "others": ("overlays",),
    "claim": ("paper_points",),
    "paper": ("paper_outcome", "paper_cases"),
    # values of keys, and flags that can be values
    "turn": ("stroboscopic",),
    "switch": ("event",),
    "published": ("static",),
    "stable": ("quiet",),
    "unstable": ("growing",),
    # keys of cases, functions of Python
    "energy": ("audit_every_step",),
    "slider_at_rest_frequencies": ("coupled_natural_frequencies",),
    # commands
    "warm": ("compile",),
    "stale": ("outdated",),
}
"""Successors by the old name; a name with several meanings has several successors."""


def renamed(name: object, known: Collection[str]) -> str:
    """Addition to a message on a replaced name, if its successor is among the known names; else ""."""
    new = next((new for new in RENAMED.get(str(name), ()) if new in known), "")
    return f": it is now called {new}" if new else ""
