"""Tables by which rows of the ledger are judged, made from computations beyond the paper's cases.

They are energies with separation and without it, what a change of a parameter by a thousandth does,
and growth of steady sliding on the precursor's disc.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from disc_model.data.dataset import Missing
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from workflow.paper import energy
from workflow.paper.growth import sliding_growth
from workflow.paper.measures import Absent, CaseView, pairs

# ---- Energies with separation and without it

ENERGIES = ["supplied_mJ", "supplied_bilateral_mJ", "damped_mJ", "impacts_mJ", "surplus_mJ"]
"""Columns of energies in one period of the vibration."""
COMPLIANT = ["compliant_mJ", "compliant_least_mJ", "compliant_most_mJ"]
"""Columns of the energy supplied in one period in a compliant contact: mean over all stretches, and
over those in which it is least and most."""
POWERS = ["pushes_W", "pulls_W"]
"""Columns of mean powers at the end of the run without separation, while the force is positive and
while it is negative."""

COLUMNS = [*ENERGIES, *COMPLIANT, *POWERS]


def energies(cases: Mapping[str, CaseView]) -> pd.DataFrame:
    """Return energies of motions with separation, and of the same without it at equal range, mJ.

    The columns are ``case``, the `ENERGIES`, the `COMPLIANT`, the `POWERS` and ``remark``, which
    says why there are none.
    """
    rows = []
    for free, bilateral in pairs(list(cases.values())):
        row: dict[str, Any] = {"case": free.name}
        try:
            found = energies_of(free, bilateral)
            row |= dict(zip(COLUMNS, found, strict=True))
        except (Absent, Missing) as reason:
            row["remark"] = str(reason)
        rows.append(row)
    return pd.DataFrame(rows, columns=["case", *COLUMNS, "remark"])


def energies_of(free: CaseView, bilateral: CaseView) -> list[float]:
    """Return the `COLUMNS` of a case with separation and of one without it.

    Raises `Absent` if the latter stays smaller, or `Missing` if the former keeps no separations.
    """
    period = free.intervals("separation").mean()
    history = energy.power_history(free.parameters, free["time_reached"])
    steady = energy.in_the_end(history)
    until = bilateral["time_reached"]
    kept = energy.power_history(bilateral.parameters, until)
    settled = energy.in_the_end(kept)
    same = energy.at_range(bilateral.parameters, until, steady.width, kept)
    end = simulate(free.parameters, free["time_reached"], events=False).raise_for_status()
    soft = energy.taken_in_compliant_contact(free.parameters, end.final_state)
    watts = [steady.supplied, same.supplied, steady.damped, steady.impacts, same.gained]
    watts += [soft.mean(), soft.min(), soft.max()]
    in_period = [float(1e3 * period * power) for power in watts]
    return [*in_period, settled.pushes, settled.pulls]


# ---- Small changes of parameters

PHYSICAL = ("a", "b", "r_0", "h", "E", "nu", "rho", "D_star", "mu_s", "mu_k", "k", "k_p", "m", "N")
"""Parameters that are changed by 0.1 %, one at a time."""
FOLLOWED = 600.0
"""Time to which a motion is then followed, s."""


def small_changes(cases: Mapping[str, CaseView]) -> pd.DataFrame:
    """Return first separations within `FOLLOWED` s if one parameter is a thousandth larger.

    The columns are ``case``, ``parameter`` and ``first_s``, which is nan where contact is kept.
    """
    rows = []
    for case in cases.values():
        p = case.parameters
        for name in PHYSICAL:
            larger = p.replace(**{name: 1.001 * getattr(p, name)})
            run = simulate(larger, FOLLOWED, stop_at="first_separation").raise_for_status()
            rows.append((case.name, name, run.first_separation))
    return pd.DataFrame(rows, columns=["case", "parameter", "first_s"])


# ---- The model's precursor: steady sliding with friction that falls

PRECURSOR: dict[str, Any] = {"loads": [20, 50, 200], "c": 0.5, "c_p": 5, "friction_decay": 0.02}
"""Loads (N), dampers (N s/m) and fall of friction (s/m) of the combinations."""
SPEEDS = np.arange(5.0, 1501.0, 5.0)
"""Speeds in rad/s, up to where sliding is unstable at all speeds without friction."""
GROWTHS = ["frictionless_1/s", "friction_1/s", "damper_1/s"]
"""Columns of growth rates: without friction, with it, and with it and a damper."""


def precursor(_: Mapping[str, CaseView]) -> pd.DataFrame:
    """Return largest growth rates of steady sliding over load and speed: ``N``, ``Omega`` and
    `GROWTHS`."""
    p = Parameters(
        N=PRECURSOR["loads"][0],
        Omega=SPEEDS[0],
        contact="bilateral",
        c_p=PRECURSOR["c_p"],
        friction_decay=PRECURSOR["friction_decay"],
    )
    models = (p.replace(mu_s=0.0, mu_k=0.0), p, p.replace(c=PRECURSOR["c"]))
    rows = []
    for N in PRECURSOR["loads"]:
        for speed in SPEEDS:
            rates = [sliding_growth(model.replace(N=N, Omega=speed)) for model in models]
            rows.append((N, speed, *rates))
    return pd.DataFrame(rows, columns=["N", "Omega", *GROWTHS])
