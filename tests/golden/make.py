"""Make the golden tables: cycles, and special points of branches, as the code at hand finds them.

Run from the repository's root, for some minutes::

    python -m tests.golden.make

Cases are drawn at random, and kept where the motion is regular: where another tolerance gives the
same to within `WORST`. Numbers are in SI units; an empty cell is the parameter's default.
"""

import math
from contextlib import suppress
from pathlib import Path

import numpy as np
import pandas as pd

import disc_model as dm

FOLDER = Path(__file__).parent
RTOL = 1e-9
"""To which regular motions agree on all processors."""
WORST = 1e-6
GRAZING = 1e-4
"""The same of an end where a switch is grazed: the map has an infinite slope there."""
SHORTEST = 1e-6
"""Tolerance of such an end at least: it is known to the shortest step, 1e-7 of the arclength."""
TIGHTER = 1e-13
"""Tolerance of cycles that check others, of 1e-12."""

COUPLE = {"friction_offset": 0.02}
"""Ten times the plate's thickness, so that it shows."""
FALLING = {"friction_decay": 2.0}
EXPONENTIAL = {**FALLING, "friction_law": "exponential"}
VISCOUS = {"viscous_friction": 0.005}
COMPLIANT = {"contact_compliance": 2.656e-7}
NORMAL = {"contact_force": "normal"}
BLOCK = {"n_diameters": -1, "k": 0.0, "c_p": 6.0, "mu_s": 0.6, "mu_k": 0.2, "friction_decay": 10.0}
LAWS = {
    "paper": {},
    "bilateral": {"contact": "bilateral"},
    "damping ratio": {"damping_ratio": 1e-4},
    "compliant": COMPLIANT,
    "normal": NORMAL,
    "compliant, normal": COMPLIANT | NORMAL,
    "surface": {"friction_offset": "surface"},
    "couple": COUPLE,
    "falling": FALLING,
    "falling, couple": FALLING | COUPLE,
    "exponential": EXPONENTIAL,
    "viscous": VISCOUS,
    "arc": {"contact_arc": 0.4},
    "arc, surface": {"contact_arc": 0.4, "friction_offset": "surface"},
    "all": COMPLIANT | NORMAL | EXPONENTIAL | VISCOUS | COUPLE,
    "block": BLOCK,
    "slipping": BLOCK,
}
"""Parameters by law."""
CYCLES = dict.fromkeys(LAWS, 5) | {"paper": 20}
"""Number of cycles by law, in each normalisation."""
FREE = ("Omega", "N", "k", "mu_k", "k_p", "mu_s", "c_p", "m", "D_star", "E")
"""Parameters along which branches are followed."""
OF_POINTS = ["kind", "value", "period", "range"]
OF_CYCLES = ["period", "slip_time", "growth_rate", "multiplier"]


# ---- What is compared


def case_of(row):
    """Return the parameters of a row of a table."""
    values = {}
    for name in dm.Parameters.model_fields:
        if name in row and not pd.isna(row[name]):
            values[name] = row[name]
            with suppress(ValueError):  # a word
                values[name] = float(row[name])
    counts = {name: int(values[name]) for name in ("n_diameters", "n_circles")}
    return dm.Parameters(**{**values, **counts})


def cycle_of(row, tol=1e-12):
    """Return status and numbers of the cycle of a row."""
    kind = "stick_slip"
    if row["law"] == "slipping":
        kind = "slipping"
    found = dm.floquet(case_of(row), tol=tol, kind=kind)
    modulus = np.abs(found.multipliers).max(initial=0.0)
    numbers = (found.period, found.slip_time, found.growth_rate, modulus)
    return {"status": found.status.name.lower(), **dict(zip(OF_CYCLES, numbers, strict=True))}


def special_points_of(row, **steps):
    """Return the special points of the branch of a row, with the words for its ends."""
    case = case_of(row)
    guess = None
    if row["kick"]:  # lifts slider and disc, to a motion with separation
        start = dm.initial_state(case, {"u": row["kick"]})
        guess = dm.simulate(case, 60, initial_state=start).final_state
    branch = dm.continue_cycle(
        case,
        row["along"],
        (row["low"], row["high"]),
        direction=row["direction"],
        guess=guess,
        releases=row["releases"],
        steps=dm.StepControl(**steps),
    )
    found = branch.special_points.rename(columns={row["along"]: "value"})
    return found[OF_POINTS].to_dict("records")


def errors(found, stored):
    """Return the largest relative difference of numbers; a growth rate counts over one period."""
    worst = 0.0
    for name, value in stored.items():
        if isinstance(value, float):
            scale = abs(value)
            if name == "growth_rate":
                scale = max(scale, 1 / stored["period"])
            if name == "range":  # whose samples have peaks to 1e-8, of heights above rounding
                scale = 10 * max(scale, 1e-9)
            same = math.isnan(value) == math.isnan(found[name])
            if not same:
                return math.inf
            if scale > 0 and not math.isnan(value):
                worst = max(worst, abs(found[name] - value) / scale)
    return worst


def tolerance(error, worst=WORST):
    """Return the power of ten to which numbers hold that err so much; nan if they are irregular."""
    if error > worst / 10:
        return math.nan
    return max(RTOL, 10.0 ** math.ceil(math.log10(10 * max(error, 1e-300))))


# ---- Cases


def drawn(rng, law, normalization):
    """Return the row of a random case, its numbers of four digits."""
    mu_s = rng.uniform(0.3, 0.6)
    if law in ("block", "slipping"):
        logarithmic = {"N": (5, 20), "Omega": (1.7, 2.2), "m": (0.3, 0.8), "k_p": (5e3, 1e4)}
        other = {}
    else:
        logarithmic = {"N": (50, 900), "Omega": (5, 60), "m": (0.05, 0.2), "k_p": (8e3, 4e4)}
        logarithmic |= {"k": (2e4, 1e5), "D_star": (3e-6, 3e-5), "E": (1e11, 2.1e11)}
        other = {
            "c": rng.choice([0, 0, 0.1, 1.0]),
            "c_p": rng.choice([0, 0, 0.05, 0.3]),
            "mu_s": mu_s,
            "mu_k": mu_s * rng.uniform(0.4, 0.9),
            "n_diameters": int(rng.integers(0, 5)),
            "n_circles": int(rng.integers(0, 5) == 0),
        }
    numbers = {name: math.exp(rng.uniform(*np.log(limits))) for name, limits in logarithmic.items()}
    modes = {"n_diameters": 4, "n_circles": 0}
    row = {"law": law, "normalization": normalization, **modes, **numbers, **other, **LAWS[law]}
    if "damping_ratio" in row:
        del row["D_star"]
    if law == "compliant":
        row["contact_compliance"] *= rng.uniform(0.3, 3)
    return {
        name: float(f"{value:.4g}") if isinstance(value, float) else value
        for name, value in row.items()
    }


def cycles():
    """Yield rows of cases with their cycles."""
    rng = np.random.default_rng(1)
    for law, count in CYCLES.items():
        for normalization in ("as_published", "orthonormal"):
            kept = 0
            while kept < count:
                row = drawn(rng, law, normalization)
                found = cycle_of(row)
                again = cycle_of(row, TIGHTER)
                rtol = tolerance(errors(again, found))
                same = again["status"] == found["status"] and not math.isnan(rtol)
                # some that cannot have a cycle are kept, and none where a search gave up
                without = found["status"] in ("no_stick_slip", "separates")
                if same and (found["status"] == "ok" or (without and rng.random() < 0.3)):
                    kept += 1
                    yield {**row, **found, "rtol": rtol}


PAPER = {
    "N": 385.0,
    "n_diameters": 4,
    "n_circles": 0,
    "along": "Omega",
    "low": 5.0,
    "high": 25.0,
    "direction": 0,
    "releases": 1,
}
STORED = {
    "quiet, up": {"Omega": 14.9, "direction": 1},
    "quiet, down": {"Omega": 14.9, "direction": -1, "low": 10.0},
    "separating": {"Omega": 12.0, "kick": -0.02},
    "two releases": {"Omega": 15.0, "kick": -0.02, "releases": 2},
}
"""The branches of the paper's study, from the quiet cycle or from motions with separation."""
BRANCHES = {"paper": 14, "couple": 4, "falling": 2, "exponential": 2, "compliant": 2}
"""Number of random branches by law."""


def of_branches():
    """Yield rows of cases, each with its special points."""
    for name, of_branch in STORED.items():
        row = {"branch": name, "kick": 0.0, **PAPER, **of_branch}
        yield row, with_tolerances(row)
    rng = np.random.default_rng(2)
    for law, count in BRANCHES.items():
        kept = 0
        while kept < count:
            row = drawn(rng, law, str(rng.choice(["as_published", "orthonormal"])))
            name = str(rng.choice([name for name in FREE if row.get(name)]))
            ends = {"low": 0.88 * row[name], "high": 1.12 * row[name]}
            row |= {
                "branch": f"{law} {kept}",
                "along": name,
                **ends,
                "direction": 0,
                "kick": 0.0,
                "releases": 1,
            }
            try:
                points = with_tolerances(row, max_points=60)
            except dm.DiscModelError:
                continue
            # few without bifurcations
            if points and (len(points) > 2 or rng.random() < 0.06):
                kept += 1
                yield row, points


def with_tolerances(row, **limits):
    """Return the special points of a row with their tolerances; none of a branch that does not end
    within limits, or whose points depend on the steps."""
    found = special_points_of(row, **limits)
    again = special_points_of(row, longest=0.06, **limits)
    kinds = [point["kind"] for point in found]
    if kinds != [point["kind"] for point in again] or {"max_points", "lost"} & {*kinds}:
        return []
    points = []
    for point, other in zip(found, again, strict=True):
        worst = WORST
        if point["kind"] == "grazing":
            worst = GRAZING
        rtol = tolerance(errors(other, point), worst)
        if math.isnan(rtol):
            return []
        if point["kind"] == "grazing":
            rtol = max(rtol, SHORTEST)
        points.append({**point, "rtol": rtol})
    return points


def write(name, rows):
    """Write a table."""
    pd.DataFrame(rows).to_csv(FOLDER / f"{name}.csv", index=False)


def main():
    """Write all tables."""
    write("cycles", cycles())
    found = [*of_branches()]
    write("branches", [row for row, _ in found])
    write(
        "special_points",
        [{"branch": row["branch"], **point} for row, points in found for point in points],
    )


if __name__ == "__main__":
    main()
