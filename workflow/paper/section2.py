"""Rows on the abstract, Sections 2 to 4 and the precursor.

They are about the scale and the number of modes, and about the disc and the slider at rest.
"""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
import xarray as xr
from scipy.integrate import fixed_quad

from disc_model.data.dataset import Missing
from disc_model.data.variables import flag_names, stated_in
from disc_model.disc.modes import coupled_natural_frequencies, plate_modes
from disc_model.disc.plate import mode_shapes
from disc_model.parameters import Parameters
from workflow.paper import measures
from workflow.paper.judging_tables import GROWTHS, PRECURSOR
from workflow.paper.measures import Array, CaseView
from workflow.paper.model import FALSE, NOT_COMPUTED, PART, TRUE, Answer, graded, parameters_of

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
    """Return the points of `SEPARATING` on maps; raises `Missing` if one is not computed."""
    points = {}
    for figure, (name, case) in SEPARATING.items():
        parameters = parameters_of(case, "as_published")
        axes = {*maps[name]["outcome"].dims} - {"normalization"}
        values = {axis: getattr(parameters, str(axis)) for axis in axes}
        point = maps[name].sel(values, method="nearest")
        for axis, value in values.items():
            if not np.isclose(point[axis], value):
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


def survive(*maps: xr.Dataset, share: float) -> Answer:
    """Judge whether low speeds separate with both sets of modes.

    Parameters
    ----------
    maps : that over speed and preload first, and those with the other points of `SEPARATING`
    share : of the critical speed of a moving load, below which a speed is low
    """
    critical = moving_load_speed(BASE)
    plane = maps[0].transpose("normalization", "Omega", ...)
    lowest = []
    for separates in flag_names(plane["outcome"]) == "separation":
        speeds = plane["Omega"].values[separates.any(axis=1)]
        lowest.append(np.min(speeds, initial=np.inf))

    points = separating_points({study.attrs["study"]: study for study in maps})
    as_published = 0
    in_contact = 0
    grow = []
    for point in points.values():
        published = str(flag_names(point.sel(normalization="as_published")["outcome"]))
        as_published += published == "separation"
        outcome = str(flag_names(point.sel(normalization="orthonormal")["outcome"]))
        if outcome == "separation":
            continue
        in_contact += 1
        if outcome == "growing":
            grow.append(stated_in(point, "options")["horizon"])

    counts = (
        len(points),
        as_published,
        len(points) - in_contact,
        in_contact - len(grow),
        len(grow),
    )
    return Answer(
        graded(speed < share * critical for speed in lowest),
        counts=counts,
        until=measures.extent(grow) if grow else None,
        lowest=lowest,
        critical=critical,
    )


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


def normalised(*, within: float) -> Answer:
    """Judge whether the published modes satisfy the first relation of Eq. (17)."""
    first = norms(BASE)
    off = np.max(np.abs(first - 1))
    return Answer(off <= within, norms=[*first])


def second_relation(*, within: float) -> Answer:
    """Judge whether normalised modes satisfy the second relation of Eq. (17)."""
    p = NORMALISED
    # the biharmonic operator multiplies a mode by rho h omega^2/D
    omega = plate_modes(p)["omega"].to_numpy()
    second = norms(p) * omega**2 / p.D
    off = np.max(np.abs(second - 1))
    return Answer(off <= within, second=[*second])


def truncation(*evidence: CaseView, seconds: float, share: float) -> Answer:
    """Judge whether more modes change nothing.

    Parameters
    ----------
    evidence : cases with 4, 5, 6 and 8 nodal diameters, then with one and with two nodal circles
    seconds : greatest difference of first separations that counts as none
    share : greatest relative difference of rates and shares of time that counts as none
    """
    first = [case["first_separation"] for case in evidence]
    soon = np.ptp(first[:4]) <= seconds  # false if one does not separate: its time is nan
    all_soon = np.ptp(first) <= seconds

    rows = [
        (case.rate_of("separation"), case.phase_share("separation"), case.stick)
        for case in (evidence[0], *evidence[3:])
    ]
    equal = [bool(np.allclose(row, rows[0], rtol=share)) for row in rows[1:]]
    diameters, *circles = equal
    if all_soon and diameters and all(circles):
        verdict = TRUE
    elif soon and diameters:
        verdict = PART
    else:
        verdict = FALSE
    effect = {True: "hardly change", False: "change"}
    change = [effect[diameters], effect[all(circles)]]
    return Answer(verdict, change=change, rows=rows)


# ---- Conditions and frequencies


def slip_condition(*cases: CaseView) -> Answer:
    """Judge Eq. (24) at stops of the slider, where ψ' = Ω; in these cases c_p = 0."""
    holds: list[bool] = []
    for case in cases:
        stops = case.switches("slip_to_stick")
        damper = case["c_p"] * case["Omega"]
        spring = case["k_p"] * stops["psi"].values
        pull = case["r_0"] * np.abs(damper + spring)
        friction = case["mu_s"] * stops["P"].values
        holds += (pull < friction).tolist()
    if not holds:
        raise Missing("no case keeps an end of slip")
    return Answer(not any(holds), held=sum(holds), ends=len(holds))


def attached_frequencies(*, printed: Sequence[float], within: float) -> Answer:
    """Judge the printed natural frequencies with the slider attached, rad/s."""
    ours = coupled_natural_frequencies(BASE)
    off = np.abs(ours - np.sort(printed))
    return Answer(np.all(off <= within), ours=[*ours])


def moving_load(*, printed: float, within: float) -> Answer:
    """Judge the printed critical speed of a moving load, rad/s."""
    ours = moving_load_speed(BASE)
    holds = abs(ours - printed) <= within
    shifted: float | str = ""
    if not holds:
        modes = plate_modes(BASE)
        orders = modes["diameters"] + 1
        shifted = float(np.min(modes["omega"] / orders))
    return Answer(holds, ours=ours, shifted=shifted)


def moving_load_speed(p: Parameters) -> float:
    """Return the critical speed of a load that moves round the disc, min omega_l/l, in rad/s."""
    modes = plate_modes(p).query("diameters > 0")
    return float(np.min(modes["omega"] / modes["diameters"]))


# ---- What separation changes


def different(*cases: CaseView, factor: float, share: float = 0.0, both: bool = False) -> Answer:
    """Judge whether separation changes the range of the disc or the share of stick.

    Parameters
    ----------
    cases : with separation and without it, which form pairs
    factor : by which one of the two has to change
    share : of the pairs in which it has to; at least one
    both : whether range and share of stick have to change
    """
    rows = []
    differ = 0
    for case, other in measures.pairs(cases):
        ratio = measures.width_ratio(case, other)
        sticks = (case.stick, other.stick)
        changes = [ratio * factor <= 1, max(sticks) >= factor * min(sticks)]
        if all(changes) or (any(changes) and not both):
            differ += 1
        rows.append((case.place, ratio, *sticks, case.disc.width, other.disc.width))
    fewest = max(1, share * len(rows))
    return Answer(differ >= fewest, rows=rows, differ=differ)


# ---- The abstract of the model's precursor, J. Sound Vib. 209 (1998): steady sliding with friction
# that falls


def additional(*, precursor: pd.DataFrame) -> Answer:
    """Judge whether friction makes stable speeds unstable, and the damper raises growth there.

    The statement is open if the damper raises some of these growth rates only: of the precursor we
    have the abstract, and do not know its disc. The table is that of `judging_tables.precursor`.
    """
    without, both, damped = (precursor[name].to_numpy() for name in GROWTHS)
    speeds = precursor["Omega"].to_numpy()
    critical = moving_load_speed(BASE)
    new = (both > 0) & ~(without > 0)
    raised = new & (damped > both)
    if not raised.any():
        verdict = FALSE
    elif np.array_equal(raised, new):
        verdict = TRUE
    else:
        verdict = NOT_COMPUTED
    slowest = np.min(speeds[raised], initial=np.inf)
    below = new & (speeds < critical)
    counts = (new.sum(), raised.sum(), below.sum())
    return Answer(
        verdict, size=len(precursor), counts=counts, slowest=slowest, critical=critical, **PRECURSOR
    )


def reduced(*, precursor: pd.DataFrame) -> Answer:
    """Judge whether friction lowers growth where sliding is unstable without it."""
    without, both, _ = (precursor[name].to_numpy() for name in GROWTHS)
    unstable = without > 0
    stabilised = (unstable & (both < 0)).sum()
    lowered = (unstable & (both < without)).sum()
    if not lowered:
        verdict = FALSE
    elif lowered == unstable.sum() and stabilised:
        verdict = TRUE
    else:
        verdict = NOT_COMPUTED
    counts = (unstable.sum(), stabilised, lowered)
    return Answer(verdict, size=len(precursor), counts=counts, **PRECURSOR)
