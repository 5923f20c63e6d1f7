"""Claims about the disc and the slider at rest (Section 4 and 4.4): eigenvalues, no simulation."""

from __future__ import annotations

import numpy as np

from disc_model.claims import measures
from disc_model.claims.measures import many
from disc_model.claims.model import Cases, Claim, Finding, Needed, claim, finding
from disc_model.parameters import Parameters
from disc_model.plate import plate_modes, slider_at_rest_frequencies

BASE = Parameters(N=200, Omega=20)
DISC = (1491.92, 1516.76, 1823.88, 2774.19, 4383.04)
ATTACHED = (850.86, 1492.55, 1516.76, 1814.90, 1823.88, 2758.02, 2774.19, 4360.49, 4383.04)
ATTACHED_HZ = (135.42, 237.55, 241.40, 288.85, 290.28, 441.53, 438.95, 693.99, 697.58)
PRINTED = "one unit of the last digit printed"
_TRUNCATED = {"N": 385, "Omega": 15.1}


@claim(
    "P01",
    "Sec. 4",
    "Lowest frequencies of the disc, no nodal circle, 0 to 4 nodal diameters",
    paper=f"{many(DISC)} rad/s",
    tolerance="0.01 rad/s",
    reason=f"{PRINTED}: the first is cut off there, not rounded",
    bound=0.0101,
)
def disc_frequencies(cases: Cases, claim: Claim) -> Finding:
    ours = plate_modes(BASE)["omega"].to_numpy()
    return finding(f"{many(ours)} rad/s", bool(np.all(np.abs(ours - DISC) <= claim.bound)))


@claim(
    "P02",
    "Sec. 4",
    "The first is single, the others double: nine modes",
    paper="1 + 4 x 2",
    tolerance="exact",
)
def nine_modes(cases: Cases, claim: Claim) -> Finding:
    modes = plate_modes(BASE)
    single = int((modes["diameters"] == 0).sum())
    pairs = int((modes["diameters"] > 0).sum())
    return finding(f"{single} single, {pairs} pairs", single + 2 * pairs == 9 and single == 1)


@claim(
    "P03",
    "Sec. 4",
    "Nine modes suffice",
    paper="no noticeable change with more",
    tolerance="2 s in the first separation",
    reason="the time follows slow growth: 1e-5 m in the start moves it by 0.5 s",
    bound=2.0,
    needs={"F13": Needed(_TRUNCATED)} | {f"P03l{n}": Needed(_TRUNCATED | {"n_diameters": n}) for n in (5, 6, 8)},
)
def truncation(cases: Cases, claim: Claim) -> Finding:
    first = {name: cases[name]["first_separation"] for name in ("F13", "P03l5", "P03l6", "P03l8")}
    shift = max(first.values()) - min(first.values())
    coupled = [slider_at_rest_frequencies(BASE.replace(n_diameters=n))[0] for n in (4, 8)]
    late = [measures.range_within(cases[name], "w_point", 100, 120).width for name in ("F13", "P03l8")]
    remark = (
        f"qualitatively; up to 8 nodal diameters bring the first separation forward by {shift:.2f} s "
        f"and the lowest coupled frequency from {coupled[0]:.2f} to {coupled[1]:.2f} rad/s; "
        f"after separation the disc's range is {1e3 * late[0]:.2f} and {1e3 * late[1]:.2f} mm"
    )
    return finding(f"{many(first.values())} s for l up to 4, 5, 6, 8", shift <= claim.bound, remark)


@claim(
    "P04",
    "Sec. 4.4",
    "Frequencies with the slider attached and nothing rotating",
    paper=f"{many(ATTACHED)} rad/s",
    tolerance="0.01 rad/s",
    reason=PRINTED,
    bound=0.0101,
)
def attached(cases: Cases, claim: Claim) -> Finding:
    ours = slider_at_rest_frequencies(BASE)
    other = slider_at_rest_frequencies(BASE.replace(normalization="orthonormal"))
    shifted = [value for value in other if np.min(np.abs(value - np.array(DISC))) > claim.bound]
    remark = (
        "with mode shapes whose coefficient of J_l is 1, not with those normalised as Eq. (17) says, "
        f"which give {many(shifted)} rad/s for the shifted ones"
    )
    return finding(f"{many(ours)} rad/s", bool(np.all(np.abs(ours - ATTACHED) <= claim.bound)), remark)


@claim(
    "P05",
    "Sec. 4.4",
    "The same in Hz",
    paper=f"{many(ATTACHED_HZ)} Hz",
    tolerance="0.01 Hz",
    reason=PRINTED,
    bound=0.0101,
)
def attached_hertz(cases: Cases, claim: Claim) -> Finding:
    ours = slider_at_rest_frequencies(BASE) / (2 * np.pi)
    off = np.abs(ours - ATTACHED_HZ) > claim.bound
    swapped = bool(np.all(np.abs(np.sort(ATTACHED_HZ) - ours) <= claim.bound))
    remark = f"printed in another order: {many(np.array(ATTACHED_HZ)[off])} Hz are swapped" if off.any() else ""
    return finding(f"{many(ours)} Hz", swapped, remark)


@claim(
    "P06",
    "Sec. 4.4",
    "The slider splits every pair of equal frequencies",
    paper="no pair remains equal",
    tolerance="0.1 rad/s",
    reason="far below the smallest shift, far above rounding",
    bound=0.1,
)
def pairs_split(cases: Cases, claim: Claim) -> Finding:
    attached = slider_at_rest_frequencies(BASE)
    disc = plate_modes(BASE).query("diameters > 0")["omega"].to_numpy()
    below = np.array([omega - attached[attached < omega - claim.bound].max() for omega in disc])
    kept = np.array([np.min(np.abs(attached - omega)) for omega in disc])
    return finding(
        f"one of each pair lower by {many(below, 1)} rad/s, the other unchanged",
        bool(np.all(below > claim.bound) and np.all(kept < claim.bound)),
    )


@claim(
    "P07",
    "Sec. 4.3",
    "Critical speed of a load moving around the disc",
    paper="608 rad/s",
    tolerance="0.5 rad/s",
    reason="half a unit of the last digit printed",
    bound=0.5,
)
def moving_load(cases: Cases, claim: Claim) -> Finding:
    modes = plate_modes(BASE).query("diameters > 0")
    omega, diameters = modes["omega"].to_numpy(), modes["diameters"].to_numpy()
    ours = float(np.min(omega / diameters))
    shifted = float(np.min(plate_modes(BASE)["omega"] / (plate_modes(BASE)["diameters"] + 1)))
    remark = f"the least omega_l/l is ours; the printed value is the least omega_l/(l + 1) = {shifted:.2f} rad/s"
    return finding(f"{ours:.2f} rad/s", abs(ours - 608) <= claim.bound, remark)
