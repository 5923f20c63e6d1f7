"""Names of version 0.2 that were replaced, and their successors: keys, values, variables, commands and functions."""

from collections.abc import Collection

_WITH_INTERVALS = {
    "share": "basin_fraction",
    "energy_share": "basin_fraction_by_energy",
    "separating_share": "separating_fraction",
    "cycle_share": "cycle_fraction",
    "outcome_share": "outcome_fraction",
    "first_index": "sobol_first",
    "total_index": "sobol_total",
}
"""Variables that have an interval as well, from `_low` to `_high`."""
RENAMED: dict[str, tuple[str, ...]] = {
    **{f"{old}{end}": (f"{new}{end}",) for old, new in _WITH_INTERVALS.items() for end in ("", "_low", "_high")},
    # variables and dimensions of datasets
    "energy_transverse": ("energy_residual_transverse",),
    "energy_inplane": ("energy_residual_inplane",),
    "likeness": ("mac",),
    "forward": ("forward_wave_fraction",),
    "fate": ("attractor_class",),
    "reached": ("attractor_index",),
    "least_kick": ("critical_energy",),
    "least_kick_not": ("critical_energy_lower",),
    "least_kick_sample": ("critical_energy_sampled",),
    "attractor_share_stick": ("attractor_stick_fraction",),
    "attractor_share_separation": ("attractor_separation_fraction",),
    "simulated": ("simulated_time",),
    "separated": ("lost_contact",),
    "onset": ("onset_speed",),
    "persists_to": ("offset_speed",),
    "share_stick": ("stick_fraction",),
    "share_slip": ("slip_fraction",),
    "share_separation": ("separation_fraction",),
    "distance": ("cycle_distance",),
    "difference": ("return_map_residual",),
    "difference_rate": ("return_map_residual_rate",),
    "closure": ("period_residual",),
    "steady": ("stationary",),
    "period": ("period_events",),
    "transient": ("transient_time",),
    "origin": ("method",),
    "oscillations": ("period_ratio",),
    "joined_first": ("branch_continues_first",),
    "joined_second": ("branch_continues_second",),
    "border": ("adjoins_stable_cycle",),
    "n_unfollowed": ("n_continuation_failures",),
    "tongue_harmonic": ("resonance_harmonic",),
    "tongue_frequency": ("resonance_frequency",),
    "tongue_diameters": ("resonance_diameters",),
    "tongue_sign": ("resonance_sign",),
    "tongue_detuning": ("resonance_detuning",),
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
    "kick": ("perturbation",),
    "kick_u": ("perturbation_u",),
    "kick_u_velocity": ("perturbation_u_velocity",),
    "kick_f": ("perturbation_f",),
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
