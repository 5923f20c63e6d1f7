"""Measures for rows on the abstract, Sections 2 to 4 and the precursor.

They are about the scale and the number of modes, and about the disc and the slider at rest.
"""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from scipy.integrate import fixed_quad

from disc_model.data.dataset import Missing
from disc_model.data.variables import flag_names, stated_in
from disc_model.disc.modes import coupled_natural_frequencies, plate_modes
from disc_model.disc.plate import mode_shapes
from disc_model.parameters import Parameters
from workflow.paper.judging_tables import GROWTHS, PRECURSOR
from workflow.paper.measures import Array, Cases, Found, extent, pairs, width_ratio
from workflow.paper.model import parameters_of

BASE = Parameters(N=200, Omega=20)
NORMALISED = BASE.replace(normalization="orthonormal")

SEPARATING = {
    "Fig. 2": ("map_N", "F02"),
    "Fig. 7": ("map_N", "F07"),
    "Fig. 9": ("map_N", "F09"),
    "Fig. 13": ("map_N", "F13"),
    "Fig. 17": ("map_N", "F17"),
    "Fig. 18": ("map_D_star", "F18"),
    "Fig. 19": ("map_c_p", "F19"),
    "Fig. 22": ("map_k_p", "F22"),
    "Fig. 23": ("map_m", "F23"),
}
"""The figures of the paper that show separation, each with a map that has its case, and the case."""


def separating_points(maps: Mapping[str, xr.Dataset]) -> dict[str, xr.Dataset]:
    """Return the points of `SEPARATING` on maps, in SI units or as readers see them; raises `Missing`
    if one is not computed."""
    points = {}
    for figure, (name, case) in SEPARATING.items():
        study, parameters = maps[name], parameters_of(case, "as_published")
        axes = {*study["outcome"].dims} - {"normalization"}
        factors = {axis: study[axis].attrs.get("factor", 1.0) for axis in axes}
        values = {axis: getattr(parameters, str(axis)) * factors[axis] for axis in axes}
        point = study.sel(values, method="nearest")
        if not all(np.isclose(point[axis], value) for axis, value in values.items()):
            raise Missing(f"study {name} has no point of {figure}")
        if np.any(flag_names(point["outcome"]) == "failed"):
            raise Missing(f"study {name} failed at {figure}")
        points[figure] = point
    return points


def first_separations(points: Mapping[str, xr.Dataset]) -> pd.DataFrame:
    """Return times of the first separation at the points of `SEPARATING`, s.

    There is a column for each normalisation; nan stands for no separation.
    """
    times = {figure: point["first_separation"].to_series() for figure, point in points.items()}
    return pd.DataFrame(times).T


def separation_by_normalisation(*maps: xr.Dataset) -> Found:
    """Measure what becomes of the points of `SEPARATING` with both sets of modes.

    Parameters
    ----------
    maps : that over speed and preload first, and those with the other points

    Returns
    -------
    dict
        ``counts`` of points, of those that separate as published, and that separate, stay quiet or
        grow by Eq. (17); ``lowest`` speeds with separation with both; ``until`` when motions grow.
    """
    plane = maps[0].transpose("normalization", "Omega", ...)
    lowest = []
    for separates in flag_names(plane["outcome"]) == "separation":
        speeds = plane["Omega"].values[separates.any(axis=1)]
        lowest.append(np.min(speeds, initial=np.inf))

    points = separating_points({study.attrs["study"]: study for study in maps}).values()
    outcomes = pd.DataFrame(
        [flag_names(point["outcome"].sortby("normalization")).tolist() for point in points],
        columns=sorted(plane["normalization"].values),
    )
    other = outcomes["orthonormal"]
    horizons = [stated_in(point, "options")["horizon"] for point in points]
    grow = [end for end, outcome in zip(horizons, other, strict=True) if outcome == "growing"]
    separate = (outcomes == "separation").sum()
    quiet = len(other) - separate["orthonormal"] - len(grow)
    counts = (len(other), separate["as_published"], separate["orthonormal"], quiet, len(grow))
    return {"counts": counts, "until": extent(grow) if grow else None, "lowest": lowest}


# ---- Scale and number of modes


def norms(p: Parameters) -> Array:
    """Return the left side of the first relation of Eq. (17), which should be 1.

    It has an entry for the modes of 0, 1, ... nodal diameters.
    """
    # in `plate_modes` the two modes of a pair share one amplitude
    modes_of_amplitude = np.where(plate_modes(p)["diameters"] > 0, 2.0, 1.0)
    square, _ = fixed_quad(lambda r: mode_shapes(p, r) ** 2 * r, p.a, p.b, n=40)
    mass_per_area = p.rho * p.h
    return np.asarray(2 * np.pi * mass_per_area * square / modes_of_amplitude)


def second_relation(p: Parameters) -> Array:
    """Return the left side of the second relation of Eq. (17).

    The biharmonic operator multiplies a mode by rho h omega^2/D.
    """
    omega = plate_modes(p)["omega"].to_numpy()
    return norms(p) * omega**2 / p.D


def after_more_modes(cases: Cases, share: float) -> Found:
    """Measure what more modes change after a separation.

    Parameters
    ----------
    cases : with 4, 5, 6 and 8 nodal diameters, then with one and with two nodal circles
    share : greatest relative difference that counts as none

    Returns
    -------
    dict
        ``rows`` of rates and shares of time of the first case and the last three, and whether more
        ``diameters`` and ``circles`` leave them equal.
    """
    rows = [
        (case.rate_of("separation"), case.phase_share("separation"), case.stick)
        for case in (cases[0], *cases[3:])
    ]
    diameters, *circles = (bool(np.allclose(row, rows[0], rtol=share)) for row in rows[1:])
    return {"rows": rows, "diameters": diameters, "circles": all(circles)}


# ---- Conditions and frequencies


def slip_condition(cases: Cases) -> Array:
    """Return whether Eq. (24) holds at stops of the slider, where ψ' = Ω."""
    holds: list[bool] = []
    for case in cases:
        stops = case.switches("slip_to_stick")
        spring = case["k_p"] * stops["psi"].values + case["c_p"] * case["Omega"]
        friction = case["mu_s"] * stops["P"].values
        holds += (case["r_0"] * np.abs(spring) < friction).tolist()
    if not holds:
        raise Missing("no case keeps an end of slip")
    return np.array(holds)


def coupled(p: Parameters) -> Array:
    """Return natural frequencies with the slider attached, rad/s."""
    return np.asarray(coupled_natural_frequencies(p))


def moving_load_speed(p: Parameters, further: int = 0) -> float:
    """Return the critical speed of a load that moves round the disc, min omega_l/l, in rad/s.

    With a number of further diameters, it is min omega_l/(l + further) over all modes.
    """
    modes = plate_modes(p)
    orders = modes["diameters"] + further
    return float(np.min((modes["omega"] / orders)[orders > 0]))


# ---- What separation changes


def pairs_of(cases: Cases, factor: float = math.inf) -> list[tuple[Any, ...]]:
    """Return a row for each pair of a case with separation and one without it.

    It has their place, the ratio of the disc's ranges, both shares of stick, both ranges, and how
    many of range and stick separation changes by a factor.
    """
    rows = []
    for case, other in pairs(cases):
        ratio = width_ratio(case, other)
        sticks = (case.stick, other.stick)
        changed = (ratio * factor <= 1) + (max(sticks) >= factor * min(sticks))
        rows.append((case.place, ratio, *sticks, case.disc.width, other.disc.width, changed))
    return rows


# ---- The abstract of the model's precursor, J. Sound Vib. 209 (1998): steady sliding with friction
# that falls


def growth_of_sliding(precursor: pd.DataFrame) -> Found:
    """Count combinations of load and speed by what friction and a damper do to growth.

    Parameters
    ----------
    precursor : growth rates, as `judging_tables.precursor`

    Returns
    -------
    dict
        Numbers of combinations that are ``unstable`` without friction, of these ``stabilised`` and
        ``lowered`` by it; that are ``new``, unstable with friction alone, of these ``raised`` by the
        damper, and ``below`` the critical speed of a moving load; the ``slowest`` that is raised.
    """
    without, both, damped = (precursor[name].to_numpy() for name in GROWTHS)
    speeds = precursor["Omega"].to_numpy()
    unstable = without > 0
    new = (both > 0) & ~unstable
    raised = new & (damped > both)
    critical = moving_load_speed(BASE)
    found = {
        "unstable": unstable,
        "stabilised": unstable & (both < 0),
        "lowered": unstable & (both < without),
        "new": new,
        "raised": raised,
        "below": new & (speeds < critical),
    }
    counts = {name: int(points.sum()) for name, points in found.items()}
    slowest = np.min(speeds[raised], initial=np.inf)
    return {**counts, **PRECURSOR, "size": len(precursor), "slowest": slowest, "critical": critical}
