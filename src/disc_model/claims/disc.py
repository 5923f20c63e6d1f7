"""Claims about the disc and the slider at rest (Section 4 and 4.4): eigenvalues, no simulation."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from scipy.integrate import fixed_quad

from disc_model.claims.cases import asked
from disc_model.claims.measures import many, phase_share, rate_of
from disc_model.claims.model import CaseView, Claim, Finding, finding
from disc_model.parameters import Parameters
from disc_model.plate import mode_shapes, plate_modes, slider_at_rest_frequencies

BASE = Parameters(N=200, Omega=20)
DISC = (1491.92, 1516.76, 1823.88, 2774.19, 4383.04)
ATTACHED = (850.86, 1492.55, 1516.76, 1814.90, 1823.88, 2758.02, 2774.19, 4360.49, 4383.04)
ATTACHED_HZ = (135.42, 237.55, 241.40, 288.85, 290.28, 441.53, 438.95, 693.99, 697.58)
PRINTED = "one unit of the last digit printed"
LAST_DIGIT = 0.0101


@Claim(
    "P01",
    "Sec. 4",
    "Lowest frequencies of the disc, no nodal circle, 0 to 4 nodal diameters",
    paper=f"{many(DISC)} rad/s",
    tolerance="0.01 rad/s",
    reason=f"{PRINTED}: the first is cut off there, not rounded",
)
def disc_frequencies() -> Finding:
    ours = plate_modes(BASE)["omega"].to_numpy()
    return finding(f"{many(ours)} rad/s", bool(np.all(np.abs(ours - DISC) <= LAST_DIGIT)))


@Claim(
    "P02",
    "Sec. 4",
    "The first is single, the others double: nine modes",
    paper="1 + 4 x 2",
    tolerance="exact",
)
def nine_modes() -> Finding:
    diameters = plate_modes(BASE).sort_values("omega")["diameters"].to_numpy()
    single, pairs = int((diameters == 0).sum()), int((diameters > 0).sum())
    ours = f"{single} single, {pairs} pairs; the lowest has {diameters[0]} nodal diameters"
    return finding(ours, single + 2 * pairs == 9 and single == 1 and diameters[0] == 0)


@Claim(
    "P03",
    "Sec. 4",
    "Nine modes suffice",
    paper="no noticeable change with more",
    tolerance="2 s in the first separation; a tenth in what follows it: separations, shares of stick and separation",
    reason="the time follows slow growth: 1e-5 m in the start moves it by 0.5 s; what follows does not",
    needs=asked(F13=0, P03l5=0, P03l6=0, P03l8=0, P03l8c2=0),
)
def truncation(*cases: CaseView) -> Finding:
    first = [case["first_separation"] for case in cases]
    shift = float(np.ptp(first))  # nan if one does not separate
    coupled = [slider_at_rest_frequencies(BASE.replace(n_diameters=n))[0] for n in (4, 8)]
    nine, more, circles = (
        (rate_of(case, "separation"), phase_share(case, "separation"), phase_share(case, "stick"))
        for case in (cases[0], *cases[3:])
    )
    alike, alike_with_circles = (np.allclose(found, nine, rtol=0.1) for found in (more, circles))
    said = ", ".join(
        f"{rate:.0f} separations/s, {100 * apart:.1f} % of the time apart, {100 * stick:.1f} % sticking"
        for rate, apart, stick in (nine, circles)
    )
    remark = (
        f"with 8 nodal diameters the lowest coupled frequency is {coupled[1]:.2f} instead of {coupled[0]:.2f} rad/s, "
        f"and what follows separation is {'' if alike else 'not '}the same; with two nodal circles besides, "
        f"which the paper leaves out, it is {'' if alike_with_circles else 'not '}the same"
    )
    ours = (
        f"first separation at {many(first)} s for l up to 4, 5, 6, 8, and 8 with two circles; later, with nine modes "
        f"and with the last: {said}"
    )
    return finding(ours, shift <= 2.0 and alike and alike_with_circles, remark)


@Claim(
    "P04",
    "Sec. 4.4",
    "Frequencies with the slider attached and nothing rotating",
    paper=f"{many(ATTACHED)} rad/s",
    tolerance="0.01 rad/s",
    reason=PRINTED,
)
def attached() -> Finding:
    ours = slider_at_rest_frequencies(BASE)
    other = slider_at_rest_frequencies(BASE.replace(normalization="orthonormal"))
    shifted = [value for value in other if np.min(np.abs(value - np.array(DISC))) > LAST_DIGIT]
    remark = (
        "with mode shapes whose coefficient of J_l is 1, not with those normalised as Eq. (17) says, "
        f"which give {many(shifted)} rad/s for the shifted ones"
    )
    return finding(f"{many(ours)} rad/s", bool(np.all(np.abs(ours - ATTACHED) <= LAST_DIGIT)), remark)


@Claim(
    "P05",
    "Sec. 4.4",
    "The same in Hz",
    paper=f"{many(ATTACHED_HZ)} Hz",
    tolerance="0.01 Hz",
    reason=PRINTED,
)
def attached_hertz() -> Finding:
    ours = slider_at_rest_frequencies(BASE) / (2 * np.pi)
    off = np.abs(ours - ATTACHED_HZ) > LAST_DIGIT
    swapped = bool(np.all(np.abs(np.sort(ATTACHED_HZ) - ours) <= LAST_DIGIT))
    remark = f"printed in another order: {many(np.array(ATTACHED_HZ)[off])} Hz are swapped" if off.any() else ""
    return finding(f"{many(ours)} Hz", swapped, remark)


@Claim(
    "P06",
    "Sec. 4.4",
    "The slider splits every pair of equal frequencies",
    paper="no pair remains equal",
    tolerance="0.1 rad/s",
    reason="far below the smallest shift, far above rounding",
)
def pairs_split() -> Finding:
    """The frequencies interlace: between two of the disc's there is one of those that the slider lowers, if it does."""
    attached = slider_at_rest_frequencies(BASE)
    disc = plate_modes(BASE)["omega"].to_numpy()
    lowered = []
    for below, omega in pairwise(disc):
        between = attached[(attached > below + 0.1) & (attached < omega - 0.1)]
        lowered += [omega - float(between[0])] if between.size == 1 else []
    ours = f"{len(lowered)} of {len(disc) - 1} pairs have one lower by {many(lowered, 1)} rad/s"
    return finding(ours, len(lowered) == len(disc) - 1)


@Claim(
    "P06b",
    "Sec. 4.4",
    "No frequency of such a pair stays at its value for the disc alone",
    paper="not at the same values",
    tolerance="0.1 rad/s",
    reason="far below the smallest shift, far above rounding",
)
def pairs_move() -> Finding:
    attached = slider_at_rest_frequencies(BASE)
    disc = plate_modes(BASE).query("diameters > 0")["omega"].to_numpy()
    kept = [omega for omega in disc if np.min(np.abs(attached - omega)) < 0.1]
    remark = "the mode whose nodal line passes under the slider: the paper's own two lists share these values"
    return finding(f"{len(kept)} of {len(disc)} pairs keep one: {many(kept)} rad/s", not kept, remark if kept else "")


@Claim(
    "P07",
    "Sec. 4.3",
    "Critical speed of a load moving around the disc",
    paper="608 rad/s",
    tolerance="0.5 rad/s",
    reason="half a unit of the last digit printed",
)
def moving_load() -> Finding:
    ours = moving_load_speed(BASE)
    modes = plate_modes(BASE)
    shifted = float(np.min(modes["omega"] / (modes["diameters"] + 1)))
    remark = f"the least omega_l/l is ours; the printed value is the least omega_l/(l + 1) = {shifted:.2f} rad/s"
    holds = abs(ours - 608) <= 0.5
    return finding(f"{ours:.2f} rad/s", holds, "" if holds else remark)


def moving_load_speed(p: Parameters) -> float:
    """Of a load that moves around the disc: the least omega_l/l, rad/s."""
    modes = plate_modes(p).query("diameters > 0")
    return float(np.min(modes["omega"] / modes["diameters"]))


@Claim(
    "E17",
    "Sec. 2.3, Eq. (17)",
    "Normalised modes: the integral of Ψ times its biharmonic is 1, second relation",
    paper="δ_kr δ_ls",
    tolerance="1e-6",
    reason="far above the rounding of the integral",
)
def second_relation() -> Finding:
    """Both relations of Eq. (17), with modes normalised by the first."""
    p = BASE.replace(normalization="orthonormal")
    modes = plate_modes(p)
    pairs = np.where(modes["diameters"] > 0, 2.0, 1.0)  # plate_modes has one amplitude for the two of a pair
    square, _ = fixed_quad(lambda r: mode_shapes(p, r) ** 2 * r, p.a, p.b, n=40)
    first = 2 * np.pi * p.rho * p.h * square / pairs
    second = first * modes["omega"].to_numpy() ** 2 / p.D  # of the biharmonic: rho h omega^2/D
    ours = f"first relation {many(first, 6)}; second {', '.join(f'{value:.3g}' for value in second)} 1/(kg m²)"
    remark = "a misprint: the right side lacks ω²/D; nothing computed depends on it"
    holds = bool(np.max(np.abs(second - 1)) <= 1e-6)
    return finding(ours, holds, "" if holds else remark)
