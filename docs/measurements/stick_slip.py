"""Paper dragged over paper: friction from one run predicts the others (A1 to A4)."""

from typing import NamedTuple

import numpy as np
import pandas as pd
from docs.measurements.comparison import Comparison, read, within
from docs.measurements.signals import FALL, RATE, slips
from numpy.typing import ArrayLike

import disc_model as dm

MASS = 30.7e-3
"""Mass of the slider, kg."""
GRAVITY = 9.81
STIFFNESSES = (168, 1002, 2254)
"""N/m."""
SPEEDS = (42, 1100, 4300)
"""Of the drive, µm/s."""
FASTEST = 4300
"""The largest of these."""
CALIBRATION = (1002, 42)
"""Stiffness and speed of the run from whose slips friction is taken."""
SLIDING = (2254, 42)
"""The run that the source calls continuous sliding (plot_signal_example_Fig8.m)."""
INERTIAL = (168, 4300)
"""The run that the source calls inertial (README.md, ex2.m)."""
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
    """Return stiffness and speed of the runs but the one that the source calls sliding."""
    every = [(stiffness, speed) for stiffness in STIFFNESSES for speed in SPEEDS]
    return [run for run in every if run != SLIDING]


def others() -> list[tuple[int, int]]:
    """Return the runs that friction of the calibrating one predicts."""
    return [run for run in runs() if run != CALIBRATION]


def measured(run: tuple[int, int], least_fall: float = FALL) -> pd.DataFrame:
    """Return the slips of a run, found with a least fall of the force over the weight."""
    table = read("stick_slip.csv")
    table = table[table["least_fall"] == least_fall]
    stiffness, speed = run
    chosen = (table["stiffness_N_per_m"] == stiffness) & (table["speed_um_per_s"] == speed)
    return table[chosen]


def record(run: tuple[int, int]) -> pd.Series:
    """Return what is known of a run's record: its length, the step of the force, its mean, and
    numbers of slips."""
    table = read("stick_slip_runs.csv").set_index(["stiffness_N_per_m", "speed_um_per_s"])
    return table.loc[run]


def coefficients(table: pd.DataFrame) -> tuple[np.ndarray, np.ndarray]:
    """Return static and kinetic friction of each slip.

    A block with constant kinetic friction swings about the force mu_k m g. Its force before a slip is
    mu_s m g at a low speed only, as in the calibrating run; at others it is larger (`swing`).
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


def simulated(run: tuple[int, int], mu_s: float, mu_k: float, mass: float = MASS) -> dm.Result:
    """Return a simulation over some periods, with their record, `late`, after the first loading."""
    p = block(run, mu_s, mu_k, mass)
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


def quartiles(values: np.ndarray) -> float:
    """Return the range between the quartiles."""
    low, high = np.percentile(values, [25, 75])
    return float(high - low)


def name(run: tuple[int, int]) -> str:
    """Return a run in words."""
    return f"{run[0]} N/m, {run[1]} µm/s"


def friction(run: tuple[int, int] = CALIBRATION, least_fall: float = FALL) -> tuple[float, float]:
    """Return the medians of static and kinetic friction in a run, as `coefficients` find them."""
    static, kinetic = coefficients(measured(run, least_fall))
    return float(np.median(static)), float(np.median(kinetic))


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


def spreads(least_fall: float = FALL) -> list[Comparison]:
    """Return A3: the spread of the fall in the other runs, from that of friction in one run."""
    static, kinetic = coefficients(measured(CALIBRATION, least_fall))
    order = np.argsort(static - kinetic)
    chosen = order[np.linspace(0, len(order) - 1, DRAWS).round().astype(int)]
    found = []
    for run in others():
        seen = measured(run, least_fall)
        falls = []
        for i in chosen:
            slipping = predicted(run, static[i], kinetic[i], least_fall=least_fall)
            falls.append(fall(slipping))
        value = quartiles((seen["before"] - seen["after"]).to_numpy())
        expected = quartiles(np.array(falls))
        agrees = 1 / SPREAD <= expected / value <= SPREAD
        found.append(Comparison(name(run), value, expected, "", agrees))
    return found


def carried_spreads(least_fall: float = FALL) -> list[Comparison]:
    """Return A3 without a model, which was not planned: the spread of the calibrating run's fall, as
    it is, against that of the others."""
    measured_there = measured(CALIBRATION, least_fall)
    carried = quartiles((measured_there["before"] - measured_there["after"]).to_numpy())
    found = []
    for run in others():
        seen = measured(run, least_fall)
        value = quartiles((seen["before"] - seen["after"]).to_numpy())
        agrees = 1 / SPREAD <= carried / value <= SPREAD
        found.append(Comparison(name(run), value, carried, "", agrees))
    return found


def sticks() -> list[Comparison]:
    """Return A4: whether the slider sticks and slips, 1 or 0, as the source says and as simulated.

    Two runs are left out: the calibrating one, whose slips make static friction exceed the kinetic
    one, and the one that the source calls inertial, for which it gives no number that tells it from
    stick and slip.
    """
    found = []
    for run in (*others(), SLIDING):
        if run == INERTIAL:
            continue
        said = float(run != SLIDING)
        computed = float(0.0 < stick_share(run) < 1.0)
        found.append(Comparison(name(run), said, computed, "", said == computed))
    return found


def stick_share(run: tuple[int, int]) -> float:
    """Return the part of the time in which the simulated slider sticks, after the first loading."""
    late = simulated(run, *friction())["late"]
    return float(np.mean(late["phase"] == 0))


# ---- The same block in closed form


class Swing(NamedTuple):
    """Motion of a block with constant friction: its period (s), the part of it in which the block
    sticks, and the fall of the force over the weight from its maximum to its minimum."""

    period: np.ndarray
    stick: np.ndarray
    fall: np.ndarray


def swing(run: tuple[int, int], difference: ArrayLike) -> Swing:
    """Return the motion of a block whose static friction exceeds the kinetic one by `difference`, a
    number or an array.

    In slip the force swings about the kinetic one, by the angular frequency sqrt(k/m), and begins
    and ends with the rate of stick. The period is never less than 2 pi sqrt(m/k), and the force
    falls in half a swing, whatever the friction and the speed.
    """
    stiffness, speed = run[0], 1e-6 * run[1]
    omega = np.sqrt(stiffness / MASS)
    reach = np.asarray(difference) * MASS * GRAVITY / stiffness
    slip = (2 * np.pi - 2 * np.arctan(reach * omega / speed)) / omega
    stick = 2 * reach / speed
    period = stick + slip
    fall = 2 * np.hypot(reach, speed / omega) * stiffness / (MASS * GRAVITY)
    return Swing(period, stick / period, fall)


def force_before(run: tuple[int, int]) -> float:
    """Return the force over the weight before a slip, by the friction of the calibrating run.

    The force rises above static friction until the block is as fast as the drive, and swings about
    the kinetic one.
    """
    mu_s, mu_k = friction()
    return float(mu_k + swing(run, mu_s - mu_k).fall / 2)


def force_of_speed(run: tuple[int, int]) -> float:
    """Return v sqrt(k m) / m g, the half fall of the force over the weight that a block would have
    without a difference of static and kinetic friction."""
    return float(swing(run, 0.0).fall / 2)


# ---- Afterwards, not planned: what needs no model, and what no friction can mend


class Baseline(NamedTuple):
    """Ratios of a run, over what was measured, that need no simulation.

    Parameters
    ----------
    what : the run in words
    fall, duration : of the calibrating run, as they are
    period : of the calibrating run, scaled by 1/(k v), as the drive loads the spring
    least_fall, least_period : of a block with the stated mass and stiffness, whatever its constants
        of friction
    """

    what: str
    fall: float
    duration: float
    period: float
    least_fall: float
    least_period: float


def baselines(least_fall: float = FALL) -> list[Baseline]:
    """Return the ratios without a model of the runs that friction of the calibrating one predicts."""
    known = measured(CALIBRATION, least_fall)
    rate = CALIBRATION[0] * CALIBRATION[1]
    found = []
    for run in others():
        seen = measured(run, least_fall)
        loading = rate / (run[0] * run[1])
        least = swing(run, 0.0)
        ratios = Baseline(
            what=name(run),
            fall=fall(known) / fall(seen),
            duration=duration(known) / duration(seen),
            period=period(known) * loading / period(seen),
            least_fall=float(least.fall) / fall(seen),
            least_period=float(least.period) / period(seen),
        )
        found.append(ratios)
    return found


def stick_stiffness(run: tuple[int, int], least_fall: float = FALL) -> float:
    """Return the median stiffness (N/m) by which the force rises from a slip to the next, while the
    drive goes on.

    It is that of the spring only if the slider sticks all the while, and if the force was not found
    from the spring's deflection.
    """
    table = measured(run, least_fall)
    before = table["before"].to_numpy()[1:]
    after = table["after"].to_numpy()[:-1]
    lasting = np.diff(table["start_s"]) - table["duration_s"].to_numpy()[:-1]
    travel = 1e-6 * run[1] * lasting
    return float(np.median((before - after) * MASS * GRAVITY / travel))
