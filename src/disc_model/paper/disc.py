"""Claims about the disc and the slider at rest (Section 4 and 4.4): eigenvalues, no simulation."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import xarray as xr
from scipy.integrate import fixed_quad

from disc_model.disc.plate import coupled_natural_frequencies, mode_shapes, plate_modes
from disc_model.paper.model import Answer
from disc_model.parameters import Parameters

BASE = Parameters(N=200, Omega=20)


def disc_frequencies(*, printed: Sequence[float], hertz: float) -> Answer:
    """Whether the frequencies of the disc alone are the printed ones, which are in rad/s or, if `hertz`, in Hz."""
    ours = plate_modes(BASE)["omega"].to_numpy() / (2 * np.pi if hertz else 1)
    digits = np.round(100 * np.array(printed))
    rounded, cut = digits == np.round(100 * ours), digits == np.floor(100 * ours)
    return Answer(np.all(rounded | cut), frequency=ours, cut=list(ours[cut & ~rounded]))


def nine_modes() -> Answer:
    diameters = plate_modes(BASE).sort_values("omega")["diameters"].to_numpy()
    single, pairs = int((diameters == 0).sum()), int((diameters > 0).sum())
    holds = single + 2 * pairs == 9 and single == 1 and diameters[0] == 0
    return Answer(holds, single=single, pairs=pairs, lowest=diameters[0])


def truncation(*evidence: Any, seconds: float, share: float) -> Answer:
    """Whether more modes change nothing; undecided if one circle alone does, which may only move a jump."""
    *cases, speeds = evidence
    first = [case["first_separation"] for case in cases]
    coupled = [coupled_natural_frequencies(BASE.replace(n_diameters=n))[0] for n in (4, 8)]
    nine, *others = (
        (case.rate_of("separation"), case.phase_share("separation"), case.phase_share("stick"))
        for case in (cases[0], *cases[3:])
    )
    more, *circles = [bool(np.allclose(found, nine, rtol=share)) for found in others]
    jump = [] if speeds is None or circles[0] else _like_jumps(speeds, nine[2], others[1][2], share)
    soon = np.ptp(first) <= seconds  # nan if one does not separate
    return Answer(
        None if soon and more and circles[1] and jump else soon and more and all(circles),
        "jump",
        first=first,
        later=[
            f"{x:.0f} separations/s, {100 * y:.1f} % of the time in separation, {100 * z:.1f} % sticking"
            for x, y, z in (nine, *others[1:])
        ],
        coupled=coupled,
        changes=["" if alike else "not " for alike in (more, *circles)],
        jump=jump,
    )


def _like_jumps(study: xr.Dataset, before: float, after: float, share: float) -> list[dict[str, float]]:
    """Neighbouring speeds of a diagram between which the share of stick changes as much, to a fraction of both."""
    speed, stick = study["Omega"].values, study["stick_fraction"].values
    found = np.isclose(stick[:-1], before, rtol=share, atol=0) & np.isclose(stick[1:], after, rtol=share, atol=0)
    return [
        {"before": 100 * stick[i], "after": 100 * stick[i + 1], "low": speed[i], "high": speed[i + 1]}
        for i in np.flatnonzero(found)
    ]


def attached_frequencies(*, printed: Sequence[float], within: float, hertz: float) -> Answer:
    """The same with the slider attached; the order in which they are printed is a remark."""
    ours = coupled_natural_frequencies(BASE) / (2 * np.pi if hertz else 1)
    swapped = [*np.array(printed)[np.abs(ours - printed) > within]]
    shifted = shifted_frequencies(BASE.replace(normalization="orthonormal"))
    return Answer(np.all(np.abs(ours - np.sort(printed)) <= within), frequency=ours, shifted=shifted, swapped=swapped)


def shifted_frequencies(p: Parameters) -> list[float]:
    """Frequencies with the slider attached that are none of the disc alone, rad/s."""
    alone = plate_modes(p)["omega"].to_numpy()
    return [f for f in coupled_natural_frequencies(p) if np.min(np.abs(f - alone)) > 1e-6 * f]


def pairs_split(*, within: float) -> Answer:
    """Whether frequencies interlace: one of the coupled system lies between two of the disc if the slider lowers it."""
    attached = coupled_natural_frequencies(BASE)
    disc = plate_modes(BASE)["omega"].to_numpy()
    lowered = []
    for below, omega in pairwise(disc):
        between = attached[(attached > below + within) & (attached < omega - within)]
        lowered += [omega - float(between[0])] if between.size else []
    kept = [omega for omega in disc[1:] if np.min(np.abs(attached - omega)) < within]
    split = len(lowered) == len(disc) - 1
    counts = {"count": len(lowered), "pairs": len(disc) - 1, "lowered": lowered, "kept": kept, "stays": len(kept)}
    return Answer(None if split and kept else split, "one", **counts)


def moving_load(*, printed: float, within: float) -> Answer:
    ours = moving_load_speed(BASE)
    modes = plate_modes(BASE)
    shifted = float(np.min(modes["omega"] / (modes["diameters"] + 1)))
    holds = abs(ours - printed) <= within
    return Answer(holds, ours=ours, printed_is=not holds, shifted=shifted)


def moving_load_speed(p: Parameters) -> float:
    """Critical speed of a load that moves around the disc: the least omega_l/l, rad/s."""
    modes = plate_modes(p).query("diameters > 0")
    return float(np.min(modes["omega"] / modes["diameters"]))


def second_relation(*, within: float) -> Answer:
    """Check both relations of Eq. (17), with modes normalised by the first."""
    p = BASE.replace(normalization="orthonormal")
    modes = plate_modes(p)
    pairs = np.where(modes["diameters"] > 0, 2.0, 1.0)  # plate_modes has one amplitude for the two of a pair
    square, _ = fixed_quad(lambda r: mode_shapes(p, r) ** 2 * r, p.a, p.b, n=40)
    first = 2 * np.pi * p.rho * p.h * square / pairs
    second = first * modes["omega"].to_numpy() ** 2 / p.D  # of the biharmonic: rho h omega^2/D
    holds = bool(np.max(np.abs(second - 1)) <= within)
    return Answer(holds, first=first, second=second, misprint=not holds)
