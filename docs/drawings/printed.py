"""Draw numbers that the paper prints beside those that were computed.

python docs/drawings/printed.py    writes printed.svg beside this file, after some seconds of simulation
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from disc_model.disc.modes import coupled_natural_frequencies
from disc_model.simulation.named_case import run_case
from disc_model.studies.study import load_study
from workflow.paper.measures import CaseView
from workflow.paper.model import read_texts
from workflow.paper.paper_tables import table_2
from workflow.paper.section2 import BASE, NORMALISED

ROOT = Path(__file__).parents[2]
FONT: Any = {
    "font.size": 9,
    "svg.hashsalt": "printed",
    "font.family": "DejaVu Sans",
    "axes.spines.top": False,
    "axes.spines.right": False,
}
FILLED: Any = {"linestyle": "", "marker": "o", "color": "#D55E00", "markersize": 5}
HOLLOW: Any = {**FILLED, "color": "#0072B2", "markerfacecolor": "white", "markersize": 8}
TIMES = ("F13", "F27")
"""Rows of the ledger on printed times of separation."""
UNTIL = 1000.0
"""Time to which cases with modes by Eq. (17) are followed, s."""


def draw_frequencies(ax: Axes, rows: dict[str, Any]) -> None:
    """Draw natural frequencies with the slider attached, by both scales of the modes."""
    printed = np.array(rows["P04"]["given"]["printed"])
    models = {"modes by Eq. (17)": (NORMALISED, HOLLOW), "modes as published": (BASE, FILLED)}
    for name, (p, look) in models.items():
        deviation = 100 * (np.sort(coupled_natural_frequencies(p)) / np.sort(printed) - 1)
        ax.plot(np.sort(printed), deviation, label=name, **look)
        print(name, deviation.round(3))
    ax.set_title("(a) natural frequencies", loc="left", fontsize=9)
    ax.set_xlabel("Printed (rad/s)")
    ax.set_ylabel("Computed less printed (%)")
    ax.legend(frameon=False)


def draw_lines(ax: Axes, case: CaseView, normalised: CaseView) -> None:
    """Draw the lines of Table 2, which the paper prints to a tenth of a Hz at best."""
    for each, look in ((normalised, HOLLOW), (case, FILLED)):
        table = table_2(each)
        deviation = table["ours_Hz"] - table["paper_Hz"]
        ax.plot(table["paper_Hz"], deviation, **look)
        print(deviation.round(2).tolist())
    ax.set_title("(b) lines of Table 2", loc="left", fontsize=9)
    ax.set_xlabel("Printed (Hz)")
    ax.set_ylabel("Computed less printed (Hz)")
    ax.set_ylim(-2.2, 2.2)


def draw_times(
    ax: Axes, cases: dict[str, CaseView], normalised: dict[str, CaseView], rows: dict[str, Any]
) -> None:
    """Draw times of the first separation, which the paper prints to a tenth of a second."""
    for row in TIMES:
        (name,) = rows[row]["cases"]
        printed = rows[row]["given"]["printed"]
        computed = cases[name]["first_separation"]
        ax.plot(printed, computed - printed, **FILLED)
        print(printed, computed)
    for name, case in normalised.items():
        assert math.isnan(case["first_separation"]), name
    ax.text(100, -0.25, f"none by Eq. (17) in {UNTIL:g} s", ha="center", color="#0072B2")
    ax.set_title("(c) first separation", loc="left", fontsize=9)
    ax.set_xlabel("Printed (s)")
    ax.set_ylabel("Computed less printed (s)")
    ax.set_xlim(0, 200)
    ax.set_ylim(-0.3, 0.3)


def main() -> None:
    rows = read_texts("paper/section44.yaml")
    specs = load_study(ROOT / "config" / "paper.yaml").specs
    cases = {}
    normalised = {}
    for name in ("F13", "F07"):
        spec = specs[name]
        cases[name] = CaseView(name, run_case(spec))
        parameters = spec.parameters.replace(normalization="orthonormal")
        other = spec.model_copy(update={"parameters": parameters, "t_end": UNTIL})
        normalised[name] = CaseView(name, run_case(other))
    with plt.rc_context(FONT):
        figure, axes = plt.subplots(1, 3, figsize=(7.6, 2.7), layout="constrained")
        for ax in axes:
            ax.axhline(0, color="#767676", linewidth=0.8, zorder=0)
        draw_frequencies(axes[0], rows)
        draw_lines(axes[1], cases["F13"], normalised["F13"])
        draw_times(axes[2], cases, normalised, rows)
        title = "The published modes give the printed frequencies and times"
        figure.suptitle(title, fontsize=10)
        target = Path(__file__).with_suffix(".svg")
        figure.savefig(target, metadata={"Date": None}, facecolor="white")


if __name__ == "__main__":
    main()
