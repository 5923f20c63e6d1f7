"""Paper dragged over paper: friction from one run predicts the others (A1, A2)."""

import numpy as np
import pandas as pd
from docs.measurements.comparison import Comparison, read, within
from docs.measurements.signals import FALL, RATE, slips

import disc_model as dm

MASS = 30.7e-3
"""Mass of the slider, kg."""
GRAVITY = 9.81
STIFFNESSES = (168, 1002, 2254)
"""N/m."""
SPEEDS = (42, 1100, 4300)
"""Of the drive, µm/s."""
CALIBRATION = (1002, 42)
"""Stiffness and speed of the run from whose slips friction is taken."""
RADIUS = 0.1
"""Of the slider's path in the model, m; a block on a rigid disc moves as on a straight path."""
MEDIANS = 0.20
"""Tolerance of medians, relative."""
PERIODS = 12
"""Periods that are simulated."""


def runs() -> list[tuple[int, int]]:
    """Return stiffness and speed of the runs but (2254, 42), which the source calls sliding."""
    every = [(stiffness, speed) for stiffness in STIFFNESSES for speed in SPEEDS]
    return [run for run in every if run != (2254, 42)]


def measured(run: tuple[int, int], least_fall: float = FALL) -> pd.DataFrame:
    """Return the slips of a run, found with a least fall of the force over the weight."""
    table = read("stick_slip.csv")
    table = table[table["least_fall"] == least_fall]
    stiffness, speed = run
    chosen = (table["stiffness_N_per_m"] == stiffness) & (table["speed_um_per_s"] == speed)
    return table[chosen]


def block(run: tuple[int, int], mu_s: float, mu_k: float) -> dm.Parameters:
    """Return the case of a run: a block on a rigid disc, pressed on by the stated weight."""
    stiffness, speed = run
    return dm.Parameters(
        N=MASS * GRAVITY,
        Omega=1e-6 * speed / RADIUS,
        n_diameters=-1,
        r_0=RADIUS,
        m=MASS,
        k=0,
        k_p=stiffness,
        mu_s=mu_s,
        mu_k=mu_k,
    )


def predicted(
    run: tuple[int, int], mu_s: float, mu_k: float, least_fall: float = FALL
) -> pd.DataFrame:
    """Return the slips of a simulated run, found as in the measured ones.

    The simulated force has neither noise nor the steps of the measured one.
    """
    result = simulated(run, mu_s, mu_k)
    p = result.parameters
    force = p.k_p * p.r_0 * result["late"]["psi"].to_numpy() / p.N
    found = slips(force, least_fall)
    return pd.DataFrame(found, columns=["start_s", "before", "after", "duration_s"])


def simulated(run: tuple[int, int], mu_s: float, mu_k: float) -> dm.Result:
    """Return a simulation over some periods, with their record, `late`, after the first loading."""
    p = block(run, mu_s, mu_k)
    loading = p.mu_s * p.N / (p.r_0 * p.k_p * p.Omega)
    repeating = 2 * (p.mu_s - p.mu_k) * p.N / (p.r_0 * p.k_p * p.Omega)
    swing = 2 * np.pi * np.sqrt(p.m / p.k_p)
    lasting = PERIODS * (repeating + swing)
    window = dm.Window(start=loading, stop=loading + lasting, rate=RATE)
    return dm.simulate(p, loading + lasting, windows={"late": window})


def period(table: pd.DataFrame) -> float:
    """Return the median time from one slip to the next, s."""
    return float(np.median(np.diff(table["start_s"])))


def fall(table: pd.DataFrame) -> float:
    """Return the median fall of the force over the weight."""
    return float(np.median(table["before"] - table["after"]))


def duration(table: pd.DataFrame) -> float:
    """Return the median duration of a slip, s."""
    return float(np.median(table["duration_s"]))


def name(run: tuple[int, int]) -> str:
    """Return a run in words."""
    return f"{run[0]} N/m, {run[1]} µm/s"


def friction(run: tuple[int, int] = CALIBRATION, least_fall: float = FALL) -> tuple[float, float]:
    """Return the medians of static and kinetic friction in the slips of a run.

    A block with constant kinetic friction swings about the force mu_k m g. Its force before a slip is
    mu_s m g at a low speed only, as in the calibrating run; at others it is larger.
    """
    table = measured(run, least_fall)
    kinetic = (table["before"] + table["after"]) / 2
    return float(table["before"].median()), float(kinetic.median())


def medians(least_fall: float = FALL) -> dict[str, list[Comparison]]:
    """Return A1, durations of slips in all runs, and A2, periods and falls in the others."""
    mu_s, mu_k = friction(least_fall=least_fall)
    found: dict[str, list[Comparison]] = {quantity: [] for quantity in QUANTITIES}
    for run in runs():
        seen = measured(run, least_fall)
        model = predicted(run, mu_s, mu_k, least_fall)
        for quantity, (of, unit) in QUANTITIES.items():
            if quantity != "duration" and run == CALIBRATION:
                continue
            value = of(seen)
            expected = of(model)
            agrees = within(value, expected, MEDIANS)
            found[quantity].append(Comparison(name(run), value, expected, unit, agrees))
    return found


QUANTITIES = {"duration": (duration, "s"), "period": (period, "s"), "fall": (fall, "")}
"""What is compared in A1 and A2: medians over slips, and their units."""
