"""Write the tables of docs/measurements.md and draw its picture: `make measurements`."""

import re
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
from docs.measurements import load, robustness, stick_slip, wheel
from docs.measurements.comparison import Comparison
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from disc_model.errors import script
from disc_model.figures.draw import styled
from disc_model.figures.looks import BLACK, RED

DOCS = Path(__file__).parents[1]
PAGE = DOCS / "measurements.md"
PICTURE = DOCS.parent / "results" / "measured_slips.png"


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """Return a table in Markdown."""
    columns = list(head)
    lines = ["| " + " | ".join(columns) + " |", "| --- " * len(columns) + "|"]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines)


def digits(value: float) -> str:
    """Return a number with three digits."""
    return np.format_float_positional(value, precision=3, fractional=False, trim="-")


def verdict(comparison: Comparison) -> str:
    """Return the verdict in a word."""
    return "yes" if comparison.agrees else "no"


def crossed(text: str, agrees: bool) -> str:
    """Return a cell, with a cross if it disagrees."""
    return text if agrees else f"{text} ✗"


def compared(comparisons: Iterable[Comparison], scale: float = 1.0) -> list[list[str]]:
    """Return rows of measured and predicted values, their ratio and the verdict."""
    rows = []
    for each in comparisons:
        measured = scale * each.measured
        predicted = scale * each.predicted
        row = [each.what, digits(measured), digits(predicted), f"{each.ratio:.2f}"]
        rows.append([*row, verdict(each)])
    return rows


# ---- Tables


def slips() -> str:
    """Return A1 and A2: a row for each run."""
    medians = stick_slip.medians()
    rows: dict[str, list[str]] = {stick_slip.name(run): [] for run in stick_slip.runs()}
    for quantity, scale in (("duration", 1e3), ("period", 1e3), ("fall", 1.0)):
        cells = {}
        for each in medians[quantity]:
            measured = scale * each.measured
            predicted = scale * each.predicted
            cells[each.what] = crossed(f"{digits(measured)}, {digits(predicted)}", each.agrees)
        for run, row in rows.items():
            row.append(cells.get(run, "fitted"))
    head = ("run", "duration, ms", "period, ms", "fall of force over weight")
    return table(head, [[run, *cells] for run, cells in rows.items()])


def thresholds() -> str:
    """Return A1 and A2 with verdicts by intervals: a row for each run, and in each cell a ratio for
    each least fall."""
    columns = robustness.ratios()
    rows: dict[str, dict[str, str]] = {}
    for ratios in zip(*columns.values(), strict=True):
        quantity, run = ratios[0].what.split(", ", 1)
        cells = []
        for each in ratios:
            mark = {"yes": "", "no": " ✗", "undecided": " ?"}[each.verdict]
            cells.append(f"{each.value:.2f}{mark}")
        rows.setdefault(run, {})[quantity] = ", ".join(cells)
    quantities = ("duration", "period", "fall")
    lines = []
    for run, cell_of in rows.items():
        lines.append([run, *(cell_of.get(quantity, "fitted") for quantity in quantities)])
    return table(("run", *quantities), lines)


def spread() -> str:
    """Return A3, and the ratios of the calibrating run's own spread."""
    rows = []
    for each, carried in zip(stick_slip.spreads(), stick_slip.carried_spreads(), strict=True):
        ratios = []
        for comparison in (each, carried):
            ratios.append(crossed(f"{comparison.ratio:.2f}", comparison.agrees))
        rows.append([each.what, digits(each.measured), digits(each.predicted), *ratios])
    return table(("run", "measured", "predicted", "ratio", "ratio, carried over"), rows)


def shapes() -> str:
    """Return B."""
    rows = []
    for each in wheel.shapes():
        cells = []
        for error in (each.real, each.complex):
            cells.append(crossed(f"{error:.3f}", error < wheel.SHAPES))
        rows.append([each.mode, *cells, f"{each.other:.2f}"])
    return table(("mode", "real parts", "complex", "another number, real parts"), rows)


def frequencies() -> str:
    """Return C, and ratios for other Poisson's ratios and by squares of numbers of diameters."""
    rows = []
    for each in wheel.frequencies():
        values = [f"{each.measured:.0f}", f"{each.predicted:.0f}", f"{each.ratio:.3f}"]
        rows.append([each.what, *values, verdict(each)])
    for nu in wheel.POISSON:
        for row, each in zip(rows, wheel.frequencies(nu), strict=True):
            cell = "stated"
            if each.what.startswith("wheel"):
                cell = crossed(f"{each.ratio:.3f}", each.agrees)
            row.append(cell)
    for row, ratio in zip(rows, wheel.squares(), strict=True):
        row.append(f"{ratio:.3f}")
    head = ["mode", "measured, Hz", "predicted, Hz", "ratio", "agrees"]
    head += [f"ratio, ν = {nu:g}" for nu in wheel.POISSON]
    return table([*head, "ratio by l²"], rows)


def damping() -> str:
    """Return D."""
    head = ("mode and law", "measured, %", "predicted, %", "ratio", "agrees")
    return table(head, compared(wheel.damping(), 100))


def loads() -> str:
    """Return E."""
    ranges = load.ranges()
    rows = compared(load.loads())
    for row, name in zip(rows, ranges, strict=True):
        row.append(f"{ranges[name]:.2f}")
    head = (
        "series",
        "measured there",
        "at the middle load",
        "ratio",
        "agrees",
        "largest over least",
    )
    return table(head, rows)


SECTIONS: dict[str, Callable[[], str]] = {
    "slips": slips,
    "thresholds": thresholds,
    "spread": spread,
    "shapes": shapes,
    "frequencies": frequencies,
    "damping": damping,
    "loads": loads,
}
"""Tables of the page by their marks."""


def marked(name: str) -> re.Pattern[str]:
    """Return a pattern of what stands between the marks of a table."""
    return re.compile(rf"(?<=<!-- measured {name} -->\n\n).*?(?=\n\n<!-- end -->)", re.S)


# ---- Picture


def draw_slips() -> Figure:
    """Draw measured and predicted medians of the runs, with quartiles of the measured slips."""
    mu_s, mu_k = stick_slip.friction()
    measured = {"color": BLACK, "marker": "o", "ms": 3.5, "linewidth": 0.8}
    computed = {"color": RED, "marker": "D", "ms": 4, "mfc": "none", "linestyle": "none"}
    with styled():
        figure = Figure(figsize=(6.9, 3.1), layout="constrained")
        axes = figure.subplots(1, 3)
        above = {"textcoords": "offset points", "ha": "center", "fontsize": 6, "color": RED}
        labels = ("Duration of a slip (ms)", "Period (ms)", "Fall of the force over the weight")
        ticks = ((5, 10, 20, 30), (20, 50, 100, 500, 2000), (0.03, 0.05, 0.1, 0.2))
        for place, run in enumerate(stick_slip.runs()):
            seen, model = stick_slip.measured(run), stick_slip.predicted(run, mu_s, mu_k)
            values = (
                1e3 * seen["duration_s"],
                1e3 * np.diff(seen["start_s"]),
                seen["before"] - seen["after"],
            )
            expected = (
                1e3 * stick_slip.duration(model),
                1e3 * stick_slip.period(model),
                stick_slip.fall(model),
            )
            if run == stick_slip.CALIBRATION:
                expected = (expected[0], np.nan, np.nan)  # friction is fitted to these slips
            for axis, value, number in zip(axes, values, expected, strict=True):
                low, middle, high = np.percentile(value, [25, 50, 75])
                axis.plot([place] * 3, [low, middle, high], markevery=[1], **measured)
                axis.plot(place, number, **computed)
                if np.isnan(number):
                    axis.annotate("fitted", (place, high), (0, 3), **above)
        names = [f"{stiffness}, {speed}" for stiffness, speed in stick_slip.runs()]
        for axis, label, marks in zip(axes, labels, ticks, strict=True):
            axis.set(ylabel=label, yscale="log", xticks=range(len(names)))
            axis.set_yticks(marks, [f"{mark:g}" for mark in marks])
            axis.minorticks_off()
            axis.margins(x=0.07)
            axis.set_xticklabels(names, fontsize=6, rotation=90)  # of up to ten characters each
            axis.set_xlabel("Stiffness (N/m), speed (µm/s)")
        named = [
            Line2D([], [], label="measured: median and quartiles", **measured),
            Line2D([], [], label="predicted", **computed),
        ]
        figure.legend(handles=named, loc="outside lower right", ncols=2)
    return figure


@script
def main() -> None:
    """Write the tables and draw the picture."""
    text = PAGE.read_text(encoding="utf-8")
    for name, build in SECTIONS.items():
        content = build()
        text = marked(name).sub(lambda _, content=content: content, text)
    PAGE.write_text(text, encoding="utf-8")
    draw_slips().savefig(PICTURE, dpi=130)
