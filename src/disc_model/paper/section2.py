"""Rows on the abstract and Sections 2 to 4: the scale of the modes, disc and slider at rest, the number of modes."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray
from scipy.integrate import fixed_quad

from disc_model.data.dataset import Missing
from disc_model.data.variables import flag_names, stated_in
from disc_model.disc.plate import coupled_natural_frequencies, mode_shapes, plate_modes
from disc_model.paper.measures import CaseView, extent, facts, or_none, pairs, separates_within, width_ratio
from disc_model.paper.model import FALSE, PART, TRUE, Answer, graded, parameters_of
from disc_model.parameters import Parameters

Array = NDArray[np.float64]
BASE = Parameters(N=200, Omega=20)
SEPARATING = {
    "Fig. 2": ("map_N", {"N": 200.0, "Omega": 20.0}),
    "Fig. 7": ("map_N", {"N": 300.0, "Omega": 20.0}),
    "Fig. 9": ("map_N", {"N": 200.0, "Omega": 50.0}),
    "Fig. 13": ("map_N", {"N": 385.0, "Omega": 15.1}),
    "Fig. 17": ("map_N", {"N": 200.0, "Omega": 15.0}),
    "Fig. 18": ("map_D_star", {"D_star": 0.0, "Omega": 10.0}),
    "Fig. 19": ("map_c_p", {"N": 385.0, "c_p": 0.5}),
    "Fig. 22": ("map_k_p", {"k_p": 2e3, "Omega": 50.0}),
    "Fig. 23": ("map_m", {"m": 0.01, "Omega": 20.0}),
}
"""The figures of the paper that show separation, each with a map and its point."""


def _points(maps: Mapping[str, xr.Dataset]) -> dict[str, xr.Dataset]:
    """The points of `SEPARATING`; raises `Missing` if one is not computed."""
    points = {}
    for figure, (name, values) in SEPARATING.items():
        point = points[figure] = maps[name].sel(values, method="nearest")
        if not all(np.isclose(point[axis], value) for axis, value in values.items()):
            raise Missing(f"study {name} has no point of {figure}")
        if np.any(flag_names(point["outcome"]) == "failed"):
            raise Missing(f"study {name} failed at {figure}")
    return points


def first_separations(maps: Mapping[str, xr.Dataset]) -> pd.DataFrame:
    """Times of the first separation at the points of `SEPARATING`, s, nan for none: a column for each normalization."""
    return pd.DataFrame({figure: point["first_separation"].to_series() for figure, point in _points(maps).items()}).T


def survive(*maps: xr.Dataset, share: float) -> Answer:
    """Whether points of the map of speed and preload separate at low speed, with either scale of the modes."""
    critical, plane = moving_load_speed(BASE), maps[0].transpose("normalization", "Omega", ...)
    apart, run = (flag_names(plane[x]) == word for x, word in (("outcome", "separation"), ("method", "simulation")))
    lowest = [np.min(plane["Omega"].values[each.any(axis=1)], initial=np.inf) for each in apart]
    by_name = {study.attrs["study"]: study for study in maps}
    times, points = first_separations(by_name), _points(by_name)
    horizons = {figure: stated_in(by_name[SEPARATING[figure][0]], "options")["horizon"] for figure in points}
    kinds = {
        figure: str(flag_names(point.sel(normalization="orthonormal")["outcome"])) for figure, point in points.items()
    }
    quiet = {x: parameters_of(f"F{x[5:]:0>2}", "orthonormal") for x in points if kinds[x] != "separation"}
    kept = [x for x, p in quiet.items() if not separates_within(p, horizons[x])]
    grow = [horizons[figure] for figure in kept if kinds[figure] == "growing"]
    return Answer(
        graded(speed < share * critical for speed in lowest),
        counts=(len(times), times["as_published"].count(), len(times) - len(kept), len(kept) - len(grow), len(grow)),
        until=extent(grow) if grow else None,
        lowest=lowest,
        critical=critical,
        area=facts(maps[0]),
        first=[
            f"{figure}, {or_none(was, '.0f', ' s')} and "
            f"{or_none(now, '.0f', ' s', f'none within {horizons[figure]:g} s ({kinds[figure]})')}"
            for figure, was, now in times.itertuples()
        ],
        points=(apart[0].size, *np.sum([*apart, *(apart & run)], axis=(1, 2))),
    )


def norms(p: Parameters) -> Array:
    """Left side of the first relation of Eq. (17), which should be 1, for the modes of 0, 1, ... nodal diameters."""
    # plate_modes has one amplitude for the two modes of a pair
    pairs = np.where(plate_modes(p)["diameters"] > 0, 2.0, 1.0)
    square, _ = fixed_quad(lambda r: mode_shapes(p, r) ** 2 * r, p.a, p.b, n=40)
    return np.asarray(2 * np.pi * p.rho * p.h * square / pairs)


def normalised(*, within: float) -> Answer:
    norms_of_base = norms(BASE)
    squares = [plate_modes(p)["psi"][1] ** 2 for p in (BASE, BASE.replace(normalization="orthonormal"))]
    return Answer(np.max(np.abs(norms_of_base - 1)) <= within, norms=[*norms_of_base], squares=squares)


def second_relation(*, within: float) -> Answer:
    p = BASE.replace(normalization="orthonormal")
    second = norms(p) * plate_modes(p)["omega"].to_numpy() ** 2 / p.D  # of the biharmonic: rho h omega^2/D
    return Answer(np.max(np.abs(second - 1)) <= within, second=[*second])


def slip_condition(*cases: CaseView) -> Answer:
    """Check the relation at a stop of the slider: ψ' = Ω there, and c_p = 0 in both cases."""
    true, ends = 0, 0
    for case in cases:
        stops = case.switches("slip_to_stick")
        pull = case["r_0"] * np.abs(case["c_p"] * case["Omega"] + case["k_p"] * stops["psi"].values)
        true += int(np.sum(pull < case["mu_s"] * stops["P"].values))
        ends += stops.sizes["event"]
    if not ends:
        raise Missing("no case keeps an end of slip")
    return Answer(not true, held=true, ends=ends, place=cases[0].place, spans=[x.kept_span().width for x in cases])


def truncation(*evidence: CaseView, seconds: float, share: float) -> Answer:
    """Whether more modes change nothing: cases with 4, 5, 6 and 8 diameters, and with one and two circles."""
    first = [case["first_separation"] for case in evidence]
    soon, all_soon = np.ptp(first[:4]) <= seconds, np.ptp(first) <= seconds  # nan if one does not separate
    nine, *others = (
        (case.rate_of("separation"), case.phase_share("separation"), case.stick)
        for case in (evidence[0], *evidence[3:])
    )
    more, *circles = [bool(np.allclose(norm, nine, rtol=share)) for norm in others]
    return Answer(
        TRUE if all_soon and more and all(circles) else PART if soon and more else FALSE,
        change=["hardly change" if same else "change" for same in (more, all(circles))],
        place=evidence[0].place,
        rows=[nine, *others],
        first=first,
    )


def attached_frequencies(*, printed: Sequence[float], within: float) -> Answer:
    ours = coupled_natural_frequencies(BASE)
    shifted, other = (shifted_frequencies(p) for p in (BASE, BASE.replace(normalization="orthonormal")))
    return Answer(np.all(np.abs(ours - np.sort(printed)) <= within), ours=[*ours], shifted=shifted, other=other)


def shifted_frequencies(p: Parameters) -> list[float]:
    """Frequencies with the slider attached that are none of the disc alone, rad/s."""
    alone = plate_modes(p)["omega"].to_numpy()
    return [f for f in coupled_natural_frequencies(p) if np.min(np.abs(f - alone)) > 1e-6 * f]


def moving_load(*, printed: float, within: float) -> Answer:
    ours, modes = moving_load_speed(BASE), plate_modes(BASE)
    shifted = float(np.min(modes["omega"] / (modes["diameters"] + 1)))
    holds = abs(ours - printed) <= within
    return Answer(holds, ours=ours, shifted="" if holds else shifted)


def moving_load_speed(p: Parameters) -> float:
    """Critical speed of a load that moves around the disc: the least omega_l/l, rad/s."""
    modes = plate_modes(p).query("diameters > 0")
    return float(np.min(modes["omega"] / modes["diameters"]))


def often(*cases: CaseView, factor: float, share: float) -> Answer:
    rows, differ = [], []
    for case, bonded in pairs(cases):
        rows.append((case.place, width_ratio(case, bonded), case.stick, bonded.stick))
        _, ratio, *sticks = rows[-1]
        differ.append(ratio * factor <= 1 or max(sticks) >= factor * min(sticks))
    return Answer(sum(differ) >= share * len(differ), rows=rows, differ=sum(differ), factor=factor)
