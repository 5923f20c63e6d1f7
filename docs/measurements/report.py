"""Write the tables of the comparisons with measurements: `python -m docs.measurements.report`."""

from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
from docs.measurements import load, stick_slip, wheel
from docs.measurements.comparison import Comparison
from docs.measurements.signals import LEAST_FALLS

from disc_model.data.dataset import markdown_table
from disc_model.errors import script

TABLES = Path("results/measurements.md")


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """Return a table in Markdown."""
    return "\n".join(markdown_table(head, rows))


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
    """Return A1 and A2: a row for each run, and in each cell a ratio for each least fall."""
    cells: dict[str, dict[str, list[str]]] = {}
    for least_fall in LEAST_FALLS:
        for quantity, found in stick_slip.medians(least_fall).items():
            for each in found:
                of_run = cells.setdefault(each.what, {})
                of_run.setdefault(quantity, []).append(crossed(f"{each.ratio:.2f}", each.agrees))
    rows = []
    for run, of_run in cells.items():
        ratios = [", ".join(of_run.get(name, ["fitted"])) for name in stick_slip.QUANTITIES]
        rows.append([run, *ratios])
    return table(("run", *stick_slip.QUANTITIES), rows)


def shapes() -> str:
    """Return B: root mean square differences of measured shapes on the rim from the model's."""
    rows = []
    for diameters, row in wheel.peaks().iterrows():
        errors = [row["error_real"], row["error_complex"]]
        cells = [crossed(f"{error:.3f}", error < wheel.SHAPES) for error in errors]
        rows.append([f"{diameters} nodal diameters", *cells, f"{row['error_other']:.2f}"])
    return table(("mode", "real parts", "complex", "another number, real parts"), rows)


def frequencies() -> str:
    """Return C, and ratios by squares of numbers of diameters."""
    rows = []
    for each, ratio in zip(wheel.frequencies(), wheel.squares(), strict=True):
        values = [f"{each.measured:.0f}", f"{each.predicted:.0f}", f"{each.ratio:.3f}"]
        rows.append([each.what, *values, verdict(each), f"{ratio:.3f}"])
    head = ("mode", "measured, Hz", "predicted, Hz", "ratio", "agrees", "ratio by l²")
    return table(head, rows)


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
    "shapes": shapes,
    "frequencies": frequencies,
    "damping": damping,
    "loads": loads,
}
"""Tables by their names."""


@script
def main() -> None:
    """Write the tables."""
    parts = [f"## {name}\n\n{build()}\n" for name, build in SECTIONS.items()]
    TABLES.parent.mkdir(exist_ok=True)
    TABLES.write_text("# Comparison with measurements\n\n" + "\n".join(parts), encoding="utf-8")
