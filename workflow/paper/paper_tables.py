"""Tables of results: Tables 1 and 2 of the paper beside ours, and those on which results rest.

The latter are periods under other tolerances and numbers of modes, motion after impacts with more
modes, and those of `judging_tables`.
"""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from disc_model.analysis import spectra
from disc_model.analysis.classify import FEWEST, Motion, motion_of
from disc_model.data.dataset import Missing
from disc_model.data.variables import Outcome
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.states import State
from workflow.paper import TABLE_CASES, judging_tables
from workflow.paper.measures import CaseView, place
from workflow.paper.model import read_texts

TEXTS: dict[str, Any] = read_texts("paper_tables.yaml")

TABLE_1: dict[str, float] = TEXTS["table_1"]
"""Base values of the paper, SI units."""
TABLE_2 = pd.DataFrame(TEXTS["table_2"])
"""Lines of the paper's Table 2."""
COLUMNS = ["symbol", "paper_Hz", "ours_Hz", "level_dB", "ours_is", "predicted_Hz", "paper_says"]
"""Columns of our Table 2."""

SEARCHED = 2.0
"""Search width about a frequency of Table 2, Hz; a quarter of it about the drive's."""
LOWEST_SEARCHED = 10.0
"""Frequency in Hz above which the whole width is searched."""
COMBINED = 0.3
"""Greatest distance of a line from n f_s + m f_Omega to count as one of these, Hz."""
UNNAMED = "no n f_s + m f_Ω"


# ---- Tables of the paper


def table_1(p: Parameters) -> pd.DataFrame:
    """Return Table 1: symbol, meaning, unit, the paper's value and the value of a case."""
    rows = []
    for symbol, value in TABLE_1.items():
        meaning = Parameters.model_fields[symbol].description or symbol
        rows.append((symbol, meaning, Parameters.unit(symbol), value, getattr(p, symbol)))
    return pd.DataFrame(rows, columns=["symbol", "quantity", "unit", "paper", "ours"])


def table_2(case: CaseView) -> pd.DataFrame:
    """Return Table 2: lines of the disc's displacement at r_0, theta = 1 in the first 10 s.

    It has the `COLUMNS`. ``level_dB`` is relative to the drive's line, and ``predicted_Hz`` the
    frequency of the nearest combination.
    """
    rate = stick_slip_rate(case)
    lines = table_2_lines(case)
    reference = lines[0].amplitude
    rows = []
    for line in lines:
        name = spectra.identify(line.frequency, rate, case.drive)
        row = {
            "ours_Hz": line.frequency,
            "level_dB": 20 * np.log10(line.amplitude / reference),
            "ours_is": str(name) if abs(name.deviation) <= COMBINED else UNNAMED,
            "predicted_Hz": name.frequency,
        }
        rows.append(row)
    return TABLE_2.join(pd.DataFrame(rows))[COLUMNS]


def table_2_lines(case: CaseView) -> list[spectra.Line]:
    """Return the strongest line near each frequency of Table 2."""
    signal = case.signal("spectrum_a", 0, 10)
    found = []
    for frequency in TABLE_2["paper_Hz"]:
        width = SEARCHED / 4 if frequency <= LOWEST_SEARCHED else SEARCHED
        found.append(signal.strongest(frequency, width))
    return found


def stick_slip_rate(case: CaseView) -> float:
    """Return the stick-slip frequency in the first 10 s, Hz.

    It is that of the strongest line of psi, which is seen from the slider.
    """
    (line,) = case.signal("spectrum_a", 0, 10, "psi").lines(1, above=20.0)
    return line.frequency


# ---- What results rest on


AS_COMPUTED = "as computed"
TOL = 1e-10
VARIED: dict[str, dict[str, Any]] = {
    "tolerance 1e-8": {"tol": 1e-8},
    "tolerance 1e-12": {"tol": 1e-12},
    "8 nodal diameters": {"n_diameters": 8},
    "one nodal circle": {"n_circles": 1},
}
"""Tolerances and numbers of modes of further runs."""

RECORD = 60.0
"""Length of the record by which a motion is classified, s: four of the longest periods."""
SETTLE = 150.0
"""Time to settle before it after a small change of the speed, s."""
FIRST_CHANGE = 1e-4
"""First change of the speed that is tried, rad/s."""
LARGEST_CHANGE = 1.0
"""Change of the speed from which on none is tried, rad/s."""


def motion_to(
    p: Parameters, t_end: float, tol: float = TOL, start: State | None = None
) -> tuple[Motion, State]:
    """Simulate a case and classify its motion by the releases in the last `RECORD` s.

    Parameters
    ----------
    p : the case
    t_end : end of the run, s
    tol : tolerance
    start : state to begin with; the static start if None

    Returns
    -------
    Motion
        Undecided if there are few releases.
    State
        At the end.
    """
    run = simulate(p, t_end, tol=tol, initial_state=start)
    times = run.events.loc[run.events["kind"] == "stick_to_slip", "time"].to_numpy()
    intervals = np.diff(times[times > t_end - RECORD])
    motion = Motion(Outcome.UNDECIDED)
    if intervals.size >= FEWEST:
        motion = motion_of(intervals)
    return motion, run.final_state


def locked(p: Parameters, start: State, period: int, sign: int) -> float:
    """Return how far the speed may change until a motion has another period, rad/s.

    It is known to an eighth.

    Parameters
    ----------
    p : the case
    start : state of the motion
    period : releases in its period
    sign : 1 to raise the speed, -1 to lower it
    """

    def holds(change: float) -> bool:
        changed = p.replace(Omega=p.Omega + sign * change)
        end = start.time + SETTLE + RECORD
        motion, _ = motion_to(changed, end, start=start)
        return motion.period == period

    low = 0.0
    high = FIRST_CHANGE
    while high < LARGEST_CHANGE and holds(high):
        low = high
        high = 2 * high
    for _ in range(3):
        middle = (low + high) / 2
        if holds(middle):
            low = middle
        else:
            high = middle
    return low


def periods(cases: Mapping[str, CaseView]) -> pd.DataFrame:
    """Return after how many releases cases repeat, under `VARIED`.

    The column ``width`` is the interval of speeds with the same period, rad/s.
    """
    rows = []
    for name in TABLE_CASES["periods"]:
        case = cases[name]
        p = case.parameters
        stated = place(p.N, p.Omega)
        if name == "F22":
            stated += f", k_p = {1e-3 * p.k_p:g} kN/m"
        row: dict[str, Any] = {"case": stated}

        as_computed, state = motion_to(p, case["t_end"])
        row[AS_COMPUTED] = str(as_computed.period or as_computed.kind)
        for words, varied in VARIED.items():
            modes = {name: value for name, value in varied.items() if name != "tol"}
            motion, _ = motion_to(p.replace(**modes), case["t_end"], varied.get("tol", TOL))
            row[words] = str(motion.period or motion.kind)

        row["width"] = np.nan
        if as_computed.period:
            down = locked(p, state, as_computed.period, -1)
            up = locked(p, state, as_computed.period, 1)
            row["width"] = down + up
        rows.append(row)
    return pd.DataFrame(rows)


def impact_law(cases: Mapping[str, CaseView]) -> pd.DataFrame:
    """Return what follows the first separation at 385 N, 15.1 rad/s with other modes.

    All but the time of the first separation is of the last 20 s of each run. Where it is missing,
    the last column says why.
    """
    rows = []
    for name, modes in zip(TABLE_CASES["impact_law"], TEXTS["impact_law"], strict=True):
        case = cases[name]
        row: dict[str, Any] = {"modes": modes}
        try:
            row |= {
                "first_s": case["first_separation"],
                "rate_Hz": case.rate_of("separation"),
                "longest_ms": 1e3 * case.longest_separation,
                "separated_%": 100 * case.phase_share("separation"),
                "stick_%": 100 * case.stick,
                "range_mm": 1e3 * case.disc.width,
                "releases": str(case.late_motion),
            }
        except Missing as reason:
            row["releases"] = str(reason)
        rows.append(row)
    return pd.DataFrame(rows)


TABLES: dict[str, Callable[[Mapping[str, CaseView]], pd.DataFrame]] = {
    "table1": lambda cases: table_1(cases["F13"].parameters),
    "table2": lambda cases: table_2(cases["F13"]),
    "periods": periods,
    "impact_law": impact_law,
    "energies": judging_tables.energies,
    "small_changes": judging_tables.small_changes,
    "precursor": judging_tables.precursor,
}
"""Functions that make a table from the cases that it needs."""
