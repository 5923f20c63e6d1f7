"""Rows on the abstract, Sections 2 to 4 and the precursor: scale and number of modes, disc and
slider at rest."""

from collections.abc import Mapping, Sequence
from functools import cache
from itertools import product

import numpy as np
import pandas as pd
import xarray as xr
from scipy.integrate import fixed_quad

from disc_model.data.dataset import Missing
from disc_model.data.variables import flag_names, stated_in
from disc_model.disc.plate import coupled_natural_frequencies, mode_shapes, plate_modes
from disc_model.paper import measures
from disc_model.paper.measures import Array, CaseView, extent, pairs, sliding_growth
from disc_model.paper.model import FALSE, NOT_COMPUTED, PART, TRUE, Answer, graded, parameters_of
from disc_model.parameters import Parameters

BASE = Parameters(N=200, Omega=20)
NORMALISED = BASE.replace(normalization="orthonormal")
SEPARATING = {f"Fig. {figure}": ("map_N", f"F{figure:02}") for figure in (2, 7, 9, 13, 17)}
SEPARATING |= {"Fig. 18": ("map_D_star", "F18"), "Fig. 19": ("map_c_p", "F19")}
SEPARATING |= {"Fig. 22": ("map_k_p", "F22"), "Fig. 23": ("map_m", "F23")}
"""The figures of the paper that show separation, each with a map that has its case, and this case."""


def separating_points(maps: Mapping[str, xr.Dataset]) -> dict[str, xr.Dataset]:
    """The points of `SEPARATING`; raises `Missing` if one is not computed."""
    points = {}
    for figure, (name, case) in SEPARATING.items():
        axes = {*maps[name]["outcome"].dims} - {"normalization"}
        values = {axis: getattr(parameters_of(case, "as_published"), str(axis)) for axis in axes}
        point = points[figure] = maps[name].sel(values, method="nearest")
        if not all(np.isclose(point[axis], value) for axis, value in values.items()):
            raise Missing(f"study {name} has no point of {figure}")
        if np.any(flag_names(point["outcome"]) == "failed"):
            raise Missing(f"study {name} failed at {figure}")
    return points


def first_separations(points: Mapping[str, xr.Dataset]) -> pd.DataFrame:
    """Times of the first separation at the points of `SEPARATING`, s, nan for none: a column for
    each normalization."""
    return pd.DataFrame(
        {figure: point["first_separation"].to_series() for figure, point in points.items()}
    ).T


def survive(*maps: xr.Dataset, share: float) -> Answer:
    critical, plane = moving_load_speed(BASE), maps[0].transpose("normalization", "Omega", ...)
    apart = flag_names(plane["outcome"]) == "separation"
    lowest = [np.min(plane["Omega"].values[each.any(axis=1)], initial=np.inf) for each in apart]
    points = separating_points({study.attrs["study"]: study for study in maps})
    times, horizons = (
        first_separations(points),
        {x: stated_in(points[x], "options")["horizon"] for x in points},
    )
    kinds = {
        x: str(flag_names(point.sel(normalization="orthonormal")["outcome"]))
        for x, point in points.items()
    }
    quiet = {
        x: parameters_of(SEPARATING[x][1], "orthonormal")
        for x in points
        if kinds[x] != "separation"
    }
    kept = [x for x, p in quiet.items() if not measures.separates_within(p, horizons[x])]
    grow = [horizons[figure] for figure in kept if kinds[figure] == "growing"]
    counts = (
        len(times),
        times["as_published"].count(),
        len(times) - len(kept),
        len(kept) - len(grow),
        len(grow),
    )
    verdict, until = (
        graded(speed < share * critical for speed in lowest),
        extent(grow) if grow else None,
    )
    return Answer(verdict, counts=counts, until=until, lowest=lowest, critical=critical)


def norms(p: Parameters) -> Array:
    """Left side of the first relation of Eq. (17), which should be 1, for the modes of 0, 1, ...
    nodal diameters."""
    pairs = np.where(
        plate_modes(p)["diameters"] > 0, 2.0, 1.0
    )  # whose two modes have one amplitude in `plate_modes`
    square, _ = fixed_quad(lambda r: mode_shapes(p, r) ** 2 * r, p.a, p.b, n=40)
    return np.asarray(2 * np.pi * p.rho * p.h * square / pairs)


def normalised(*, within: float) -> Answer:
    norms_of_base = norms(BASE)
    return Answer(np.max(np.abs(norms_of_base - 1)) <= within, norms=[*norms_of_base])


def second_relation(*, within: float) -> Answer:
    p = NORMALISED
    second = (
        norms(p) * plate_modes(p)["omega"].to_numpy() ** 2 / p.D
    )  # of the biharmonic: rho h omega^2/D
    return Answer(np.max(np.abs(second - 1)) <= within, second=[*second])


def slip_condition(*cases: CaseView) -> Answer:
    """Check the relation at a stop of the slider: ψ' = Ω there, and c_p = 0 in both cases."""
    true: list[bool] = []
    for case in cases:
        stops = case.switches("slip_to_stick")
        pull = case["r_0"] * np.abs(case["c_p"] * case["Omega"] + case["k_p"] * stops["psi"].values)
        true += (pull < case["mu_s"] * stops["P"].values).tolist()
    if not true:
        raise Missing("no case keeps an end of slip")
    return Answer(not any(true), held=sum(true), ends=len(true))


def truncation(*evidence: CaseView, seconds: float, share: float) -> Answer:
    """Whether more modes change nothing: cases with 4, 5, 6 and 8 diameters, and with one and two
    circles."""
    first = [case["first_separation"] for case in evidence]
    soon, all_soon = (
        np.ptp(first[:4]) <= seconds,
        np.ptp(first) <= seconds,
    )  # nan if one does not separate
    shown = (evidence[0], *evidence[3:])
    rows = [
        (case.rate_of("separation"), case.phase_share("separation"), case.stick) for case in shown
    ]
    more, *circles = [bool(np.allclose(row, rows[0], rtol=share)) for row in rows[1:]]
    verdict = TRUE if all_soon and more and all(circles) else PART if soon and more else FALSE
    change = ["hardly change" if same else "change" for same in (more, all(circles))]
    return Answer(verdict, change=change, rows=rows)


def attached_frequencies(*, printed: Sequence[float], within: float) -> Answer:
    ours = coupled_natural_frequencies(BASE)
    return Answer(np.all(np.abs(ours - np.sort(printed)) <= within), ours=[*ours])


def moving_load(*, printed: float, within: float) -> Answer:
    ours, modes = moving_load_speed(BASE), plate_modes(BASE)
    holds = abs(ours - printed) <= within
    return Answer(
        holds,
        ours=ours,
        shifted="" if holds else float(np.min(modes["omega"] / (modes["diameters"] + 1))),
    )


def moving_load_speed(p: Parameters) -> float:
    """Critical speed of a load that moves around the disc: the least omega_l/l, rad/s."""
    modes = plate_modes(p).query("diameters > 0")
    return float(np.min(modes["omega"] / modes["diameters"]))


def different(*cases: CaseView, factor: float, share: float = 0.0, both: bool = False) -> Answer:
    """Whether separation changes range of the disc or share of stick, or both, in a pair or in a
    share of the pairs."""
    rows, differ = [], 0
    for case, other in pairs(cases):
        ratio, sticks = measures.width_ratio(case, other), (case.stick, other.stick)
        changes = ratio * factor <= 1, max(sticks) >= factor * min(sticks)
        differ += all(changes) if both else any(changes)
        rows.append((case.place, ratio, *sticks, case.disc.width, other.disc.width))
    return Answer(differ >= max(1, share * len(rows)), rows=rows, differ=differ)


# ---- The abstract of the model's precursor, J. Sound Vib. 209 (1998): steady sliding where
# friction falls
SPEEDS = np.arange(5.0, 1501.0, 5.0)  # rad/s, up to where all speeds are unstable without friction


@cache
def growths(loads: tuple[float, ...], c: float, **friction: float) -> Array:
    """Largest growth rates of sliding, 1/s: without friction, with it, and with a damper too: (3,
    load, speed)."""
    p = BASE.replace(contact="bilateral", **friction)
    points = product((p.replace(mu_s=0.0, mu_k=0.0), p, p.replace(c=c)), loads, SPEEDS)
    growth = [sliding_growth(each.replace(N=N, Omega=speed)) for each, N, speed in points]
    return np.reshape(growth, (3, len(loads), SPEEDS.size))


def additional(*, loads: Sequence[float], c: float, **friction: float) -> Answer:
    """Whether friction makes speeds unstable that are stable without, and the damper raises growth
    at all of them."""
    alone, both, damped = growths(tuple(loads), c, **friction)
    critical, new = moving_load_speed(BASE), (both > 0) & ~(alone > 0)
    raised = new & (damped > both)
    # open if it raises some: the disc of the precursor, of which we have the abstract, is not known
    verdict = FALSE if not raised.any() else TRUE if (raised == new).all() else NOT_COMPUTED
    slowest, below = SPEEDS[raised.any(axis=0)].min(initial=np.inf), new[:, critical > SPEEDS]
    counts = (new.sum(), raised.sum(), below.sum())
    return Answer(verdict, size=new.size, counts=counts, slowest=slowest, critical=critical)


def reduced(*, loads: Sequence[float], c: float, **friction: float) -> Answer:
    alone, both, _ = growths(tuple(loads), c, **friction)
    old = alone > 0
    stable, lower = ((old & each).sum() for each in (both < 0, both < alone))
    verdict = FALSE if not lower else TRUE if lower == old.sum() and stable else NOT_COMPUTED
    return Answer(verdict, size=old.size, counts=(old.sum(), stable, lower))
