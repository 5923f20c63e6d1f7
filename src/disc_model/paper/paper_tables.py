"""Tables 1 and 2 of the paper: its values and ours, with the origin of every line of Table 2."""

import numpy as np
import pandas as pd
import yaml

from disc_model.analysis import spectra
from disc_model.data.dataset import Missing
from disc_model.paper import measures
from disc_model.paper.measures import CaseView
from disc_model.paper.model import FOLDER
from disc_model.parameters import Parameters

TEXTS = yaml.safe_load((FOLDER / "paper_tables.yaml").read_text(encoding="utf-8"))
TABLE_1: dict[str, float] = TEXTS["table_1"]
"""Base values of the paper, SI units."""
TABLE_2 = pd.DataFrame(
    [(symbol, value, TEXTS[kind]) for symbol, (value, kind) in TEXTS["table_2"].items()],
    columns=["symbol", "paper_Hz", "paper_says"],
)
COLUMNS = ["symbol", "paper_Hz", "ours_Hz", "level_dB", "ours_is", "predicted_Hz", "paper_says"]
LISTED = tuple(TABLE_2["paper_Hz"])
SEARCHED = 2.0
"""Search width about a frequency of Table 2, Hz; a quarter of it about the drive's."""
COMBINED = 0.3
"""Greatest distance of a line from n f_s + m f_Omega to count as one of these, Hz."""
UNNAMED = "no n f_s + m f_Ω"


def table_1(p: Parameters) -> pd.DataFrame:
    """Table 1: symbol, meaning, unit, the paper's value and the value used here."""
    rows = [
        (name, Parameters.model_fields[name].description or name, Parameters.unit(name), value, getattr(p, name))
        for name, value in TABLE_1.items()
    ]
    return pd.DataFrame(rows, columns=["symbol", "quantity", "unit", "paper", "ours"])


def table_2(case: CaseView) -> pd.DataFrame:
    """Table 2: the lines of the disc's displacement at r_0, theta = 1 during the first 10 s.

    Returns
    -------
    DataFrame
        symbol, paper_Hz, ours_Hz, level_dB (relative to the drive's line), ours_is (`UNNAMED` if no
        combination is within `COMBINED` of the line), predicted_Hz (of the nearest combination), paper_says
    """
    rate, lines = stick_slip_rate(case), table_2_lines(case)
    names = [spectra.identify(line.frequency, rate, case.drive) for line in lines]
    return TABLE_2.assign(
        ours_Hz=[line.frequency for line in lines],
        level_dB=[20 * np.log10(line.amplitude / lines[0].amplitude) for line in lines],
        ours_is=[str(name) if abs(name.deviation) <= COMBINED else UNNAMED for name in names],
        predicted_Hz=[name.frequency for name in names],
    )[COLUMNS]


def table_2_or_why(case: CaseView) -> tuple[pd.DataFrame, str]:
    """`table_2` and ""; or only the paper's values, and the data that the case lacks."""
    try:
        return table_2(case), ""
    except Missing as reason:
        return TABLE_2.reindex(columns=COLUMNS), f"Not computed: {reason}."


def table_2_lines(case: CaseView) -> list[spectra.Line]:
    """The strongest line near each frequency of Table 2."""
    signal = case.signal("spectrum_a", 0, 10)
    return [signal.strongest(paper, SEARCHED if paper > 10 else SEARCHED / 4) for paper in LISTED]


def stick_slip_rate(case: CaseView, window: str = "spectrum_a", start: float = 0.0, stop: float = 10.0) -> float:
    """Stick-slip frequency, Hz: the strongest line of psi, in the slider's own frame."""
    (line,) = measures.loudest(case.signal(window, start, stop, "psi").lines(above=20.0), 1)
    return line.frequency
