"""Tables 1 and 2 of the paper beside ours; periods under other tolerances and modes; impacts with
more modes."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml

from disc_model.analysis import spectra
from disc_model.analysis.classify import FEWEST, Motion, motion_of
from disc_model.data.dataset import Missing
from disc_model.data.variables import Outcome
from disc_model.paper import TABLE_CASES
from disc_model.paper.measures import CaseView, place
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.states import State

TEXTS: dict[str, Any] = yaml.safe_load(
    Path(__file__).with_suffix(".yaml").read_text(encoding="utf-8")
)
TABLE_1: dict[str, float] = TEXTS["table_1"]  # base values of the paper, SI units
TABLE_2 = pd.DataFrame(TEXTS["table_2"])
COLUMNS = ["symbol", "paper_Hz", "ours_Hz", "level_dB", "ours_is", "predicted_Hz", "paper_says"]
LISTED = tuple(TABLE_2["paper_Hz"])
SEARCHED = 2.0  # search width about a frequency of Table 2, Hz; a quarter of it about the drive's
COMBINED = 0.3  # greatest distance of a line from n f_s + m f_Omega to count as one of these, Hz
UNNAMED = "no n f_s + m f_Ω"


def table_1(p: Parameters) -> pd.DataFrame:
    """Table 1: symbol, meaning, unit, the paper's value and the value used here."""
    meanings = {name: Parameters.model_fields[name].description or name for name in TABLE_1}
    rows = [
        (x, meanings[x], Parameters.unit(x), value, getattr(p, x)) for x, value in TABLE_1.items()
    ]
    return pd.DataFrame(rows, columns=["symbol", "quantity", "unit", "paper", "ours"])


def table_2(case: CaseView) -> pd.DataFrame:
    """Table 2: the lines of the disc's displacement at r_0, theta = 1 during the first 10 s, with
    `COLUMNS`: level_dB is relative to the drive's line, predicted_Hz of the nearest combination."""
    rate, lines = stick_slip_rate(case), table_2_lines(case)
    names = [spectra.identify(line.frequency, rate, case.drive) for line in lines]
    return TABLE_2.assign(
        ours_Hz=[line.frequency for line in lines],
        level_dB=[20 * np.log10(line.amplitude / lines[0].amplitude) for line in lines],
        ours_is=[str(name) if abs(name.deviation) <= COMBINED else UNNAMED for name in names],
        predicted_Hz=[name.frequency for name in names],
    )[COLUMNS]


def table_2_lines(case: CaseView) -> list[spectra.Line]:
    """The strongest line near each frequency of Table 2."""
    signal = case.signal("spectrum_a", 0, 10)
    return [signal.strongest(paper, SEARCHED if paper > 10 else SEARCHED / 4) for paper in LISTED]


def stick_slip_rate(case: CaseView) -> float:
    """Stick-slip frequency in the first 10 s, Hz: the strongest line of psi, in the slider's own
    frame."""
    (line,) = case.signal("spectrum_a", 0, 10, "psi").lines(1, above=20.0)
    return line.frequency


# ---- What results rest on
VARIED: dict[str, tuple[float, dict[str, int]]] = {
    "as computed": (1e-10, {}), "tolerance 1e-8": (1e-8, {}), "tolerance 1e-12": (1e-12, {}),
    "8 nodal diameters": (1e-10, {"n_diameters": 8}), "one nodal circle": (1e-10, {"n_circles": 1}),
}  # fmt: skip
"""Tolerance and numbers of modes of further runs."""
RECORD = (
    60.0  # length of the record from which a motion is classified, s: four of the longest periods
)
SETTLE = 150.0  # time to settle before it after a small change of the speed, s


def motion_to(
    p: Parameters, t_end: float, tol: float = 1e-10, start: State | None = None
) -> tuple[Motion, State]:
    """Class of a motion by its releases in the last `RECORD` s before t_end, undecided if few; and
    the state there."""
    run = simulate(p, t_end, tol=tol, initial_state=start)
    times = run.events.loc[run.events["kind"] == "stick_to_slip", "time"].to_numpy()
    intervals = np.diff(times[times > t_end - RECORD])
    return motion_of(intervals) if intervals.size >= FEWEST else Motion(
        Outcome.UNDECIDED
    ), run.final_state


def locked(p: Parameters, start: State, period: int, sign: int) -> float:
    """How far the speed may rise (sign 1) or fall (-1) until the motion has another period, rad/s,
    to an eighth."""

    def holds(change: float) -> bool:
        changed = p.replace(Omega=p.Omega + sign * change)
        return motion_to(changed, start.time + SETTLE + RECORD, start=start)[0].period == period

    low, high = 0.0, 1e-4
    while high < 1 and holds(high):
        low, high = high, 2 * high
    for _ in range(3):
        middle = (low + high) / 2
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low


def periods(cases: Mapping[str, CaseView]) -> pd.DataFrame:
    """Releases after which cases repeat, under `VARIED`, and the interval of speeds with the same
    period."""
    rows = []
    for name in TABLE_CASES["periods"]:
        case = cases[name]
        p = case.parameters
        runs = {
            words: motion_to(p.replace(**changed), case["t_end"], tol)
            for words, (tol, changed) in VARIED.items()
        }
        (motion, state), *_ = runs.values()
        width = (
            sum(locked(p, state, motion.period, sign) for sign in (-1, 1))
            if motion.period
            else np.nan
        )
        stated = place(p.N, p.Omega) + (f", k_p = {1e-3 * p.k_p:g} kN/m" if name == "F22" else "")
        found = {words: str(each.period or each.kind) for words, (each, _) in runs.items()}
        rows.append({"case": stated, **found, "width": width})
    return pd.DataFrame(rows)


def impact_law(cases: Mapping[str, CaseView]) -> pd.DataFrame:
    """What follows the first separation at 385 N, 15.1 rad/s with other modes, in the last 20 s of
    each run."""
    rows = []
    for name, words in zip(TABLE_CASES["impact_law"], TEXTS["impact_law"], strict=True):
        case = cases[name]
        try:
            row = [
                case["first_separation"],
                case.rate_of("separation"),
                1e3 * case.longest_separation,
            ]
            row += [100 * case.phase_share("separation"), 100 * case.stick, 1e3 * case.disc.width]
            rows.append([words, *row, str(case.late_motion)])
        except Missing as reason:
            rows.append([words, *[np.nan] * 6, str(reason)])
    columns = [
        "modes",
        "first_s",
        "rate_Hz",
        "longest_ms",
        "separated_%",
        "stick_%",
        "range_mm",
        "releases",
    ]
    return pd.DataFrame(rows, columns=columns)


TABLES = {
    "table1": lambda cases: table_1(cases["F13"].parameters),
    "table2": lambda cases: table_2(cases["F13"]),
    "periods": periods,
    "impact_law": impact_law,
}
"""Functions that make a table from the cases that it needs."""
