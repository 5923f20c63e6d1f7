"""Paper dragged over paper: friction from one run predicts the others (A1 to A4)."""

import numpy as np
import pandas as pd
from docs.measurements.comparison import Comparison, read, within
from docs.measurements.signals import RATE, slips

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
SLIDING = (2254, 42)
"""The run in which the source finds sliding without stick."""
RADIUS = 0.1
"""Of the slider's path in the model, m; a block on a rigid disc moves as on a straight path."""
MEDIANS = 0.20
"""Tolerance of medians, relative."""
SPREAD = 1.5
"""Factor within which spreads agree."""
DRAWS = 60
"""Pairs of coefficients whose scatter is carried into a prediction."""
PERIODS = 12
"""Periods that are simulated."""


def runs() -> list[tuple[int, int]]:
    """Return stiffness and speed of the runs in which the source finds stick and slip."""
    every = [(stiffness, speed) for stiffness in STIFFNESSES for speed in SPEEDS]
    return [run for run in every if run != SLIDING]


def measured(run: tuple[int, int]) -> pd.DataFrame:
    """Return the slips of a run."""
    table = read("stick_slip.csv")
    stiffness, speed = run
    chosen = (table["stiffness_N_per_m"] == stiffness) & (table["speed_um_per_s"] == speed)
    return table[chosen]


def coefficients(table: pd.DataFrame) -> tuple[np.ndarray, np.ndarray]:
    """Return static and kinetic friction of each slip.

    A block with constant kinetic friction swings about the force mu_k m g, from mu_s m g on.
    """
    static = table["before"].to_numpy()
    kinetic = (table["before"] + table["after"]).to_numpy() / 2
    return static, kinetic


def block(run: tuple[int, int], mu_s: float, mu_k: float, mass: float = MASS) -> dm.Parameters:
    """Return the case of a run: a block on a rigid disc, pressed on by the stated weight."""
    stiffness, speed = run
    return dm.Parameters(
        N=MASS * GRAVITY,
        Omega=1e-6 * speed / RADIUS,
        n_diameters=-1,
        r_0=RADIUS,
        m=mass,
        k=0,
        k_p=stiffness,
        mu_s=mu_s,
        mu_k=mu_k,
    )


def predicted(run: tuple[int, int], mu_s: float, mu_k: float, mass: float = MASS) -> pd.DataFrame:
    """Return the slips of a simulated run, found as in the measured ones."""
    p = block(run, mu_s, mu_k, mass)
    loading = p.mu_s * p.N / (p.r_0 * p.k_p * p.Omega)
    repeating = 2 * (p.mu_s - p.mu_k) * p.N / (p.r_0 * p.k_p * p.Omega)
    swing = 2 * np.pi * np.sqrt(p.m / p.k_p)
    lasting = PERIODS * (repeating + swing)
    window = dm.Window(start=loading, stop=loading + lasting, rate=RATE)
    result = dm.simulate(p, loading + lasting, windows={"late": window})
    force = p.k_p * p.r_0 * result["late"]["psi"].to_numpy() / p.N
    return pd.DataFrame(slips(force), columns=["start_s", "before", "after", "duration_s"])


def period(table: pd.DataFrame) -> float:
    """Return the median time from one slip to the next, s."""
    return float(np.median(np.diff(table["start_s"])))


def fall(table: pd.DataFrame) -> float:
    """Return the median fall of the force over the weight."""
    return float(np.median(table["before"] - table["after"]))


def duration(table: pd.DataFrame) -> float:
    """Return the median duration of a slip, s."""
    return float(np.median(table["duration_s"]))


def quartiles(values: np.ndarray) -> float:
    """Return the range between the quartiles."""
    low, high = np.percentile(values, [25, 75])
    return float(high - low)


def name(run: tuple[int, int]) -> str:
    """Return a run in words."""
    return f"{run[0]} N/m, {run[1]} µm/s"


def friction() -> tuple[float, float]:
    """Return the medians of static and kinetic friction in the calibrating run."""
    static, kinetic = coefficients(measured(CALIBRATION))
    return float(np.median(static)), float(np.median(kinetic))


def medians(mass: float = MASS) -> dict[str, list[Comparison]]:
    """Return A1, durations of slips in all runs, and A2, periods and falls in the others.

    A block of another `mass` (kg) is used afterwards only.
    """
    mu_s, mu_k = friction()
    found: dict[str, list[Comparison]] = {"duration": [], "period": [], "fall": []}
    for run in runs():
        seen, model = measured(run), predicted(run, mu_s, mu_k, mass)
        for quantity, unit, of in (
            ("duration", "s", duration),
            ("period", "s", period),
            ("fall", "", fall),
        ):
            if quantity != "duration" and run == CALIBRATION:
                continue
            value, expected = of(seen), of(model)
            agrees = within(value, expected, MEDIANS)
            found[quantity].append(Comparison(name(run), value, expected, unit, agrees))
    return found


def spreads() -> list[Comparison]:
    """Return A3: the spread of the fall in the other runs, from that of friction in one run."""
    static, kinetic = coefficients(measured(CALIBRATION))
    order = np.argsort(static - kinetic)
    chosen = order[np.linspace(0, len(order) - 1, DRAWS).round().astype(int)]
    found = []
    for run in runs():
        if run == CALIBRATION:
            continue
        seen = measured(run)
        falls = [fall(predicted(run, static[i], kinetic[i])) for i in chosen]
        value = quartiles((seen["before"] - seen["after"]).to_numpy())
        expected = quartiles(np.array(falls))
        agrees = 1 / SPREAD <= expected / value <= SPREAD
        found.append(Comparison(name(run), value, expected, "", agrees))
    return found


def sticks() -> list[Comparison]:
    """Return A4: whether the slider sticks, 1 or 0, as the source says and as simulated."""
    mu_s, mu_k = friction()
    found = []
    for run in (*runs(), SLIDING):
        said = float(run != SLIDING)
        simulated = float(len(predicted(run, mu_s, mu_k)) > 0)
        found.append(Comparison(name(run), said, simulated, "", said == simulated))
    return found


# ---- Afterwards: a mass that explains the fastest runs

FASTEST = 4300
"""Speed of the runs to whose periods the moving mass is fitted, µm/s."""


def moving_mass() -> dm.Fit:
    """Fit the moving mass to the periods of the three fastest runs; load and friction stay."""
    mu_s, mu_k = friction()
    base = block(CALIBRATION, mu_s, mu_k)
    measurements = []
    for stiffness in STIFFNESSES:
        table = measured((stiffness, FASTEST))
        gaps = np.diff(table["start_s"])
        error = 1.25 * quartiles(gaps) / 1.35 / np.sqrt(len(gaps))
        sampling = 1 / RATE / np.sqrt(12)
        at = {"k_p": float(stiffness), "Omega": 1e-6 * FASTEST / RADIUS}
        uncertainty = float(np.hypot(error, sampling))
        measurements.append(dm.Measurement("period", period(table), uncertainty, at=at))
    return dm.fit(base, ["m"], measurements)
