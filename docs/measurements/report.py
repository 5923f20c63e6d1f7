"""Write the tables of docs/measurements.md and draw its pictures: `make measurements`."""

import re
import warnings
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
from docs.measurements import load, stick_slip, wheel
from docs.measurements.comparison import Comparison, read
from matplotlib.figure import Figure

import disc_model as dm
from disc_model.errors import script
from disc_model.figures.drawing import BLACK, BLUE, GREY, SEPARATED, styled

DOCS = Path(__file__).parents[1]
PAGE = DOCS / "measurements.md"
GALLERY = DOCS / "gallery"


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


def compared(comparisons: Iterable[Comparison], scale: float = 1.0) -> list[list[str]]:
    """Return rows of measured and predicted values, their ratio and the verdict."""
    rows = []
    for each in comparisons:
        measured, predicted = scale * each.measured, scale * each.predicted
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
            measured, predicted = scale * each.measured, scale * each.predicted
            mark = "" if each.agrees else " ✗"
            cells[each.what] = f"{digits(measured)}, {digits(predicted)}{mark}"
        for run, row in rows.items():
            row.append(cells.get(run, "fitted"))
    head = ("run", "duration, ms", "period, ms", "fall of force over weight")
    return table(head, [[run, *cells] for run, cells in rows.items()])


def spread() -> str:
    """Return A3."""
    head = ("run", "measured", "predicted", "ratio", "agrees")
    return table(head, compared(stick_slip.spreads()))


def shapes() -> str:
    """Return B."""
    rows = [[each.what, f"{each.measured:.3f}", verdict(each)] for each in wheel.shapes()]
    return table(("mode", "root mean square difference", "agrees"), rows)


def frequencies() -> str:
    """Return C."""
    head = ("mode", "measured, Hz", "predicted, Hz", "ratio", "agrees")
    rows = []
    for each in wheel.frequencies():
        values = [f"{each.measured:.0f}", f"{each.predicted:.0f}", f"{each.ratio:.3f}"]
        rows.append([each.what, *values, verdict(each)])
    return table(head, rows)


def damping() -> str:
    """Return D."""
    head = ("mode and law", "measured, %", "predicted, %", "ratio", "agrees")
    return table(head, compared(wheel.damping(), 100))


def loads() -> str:
    """Return E."""
    head = ("series", "measured there", "at the middle load", "ratio", "agrees")
    return table(head, compared(load.loads()))


def mass() -> str:
    """Return the mass that the periods of the fastest runs ask for."""
    fit = stick_slip.moving_mass()
    moving = fit.parameters["m"].value
    share = moving / stick_slip.MASS
    text = f"a moving mass of {1e3 * moving:.1f} g, {share:.2f} of the stated one"
    return text + f" (chi squared {fit.chi_squared:.0f} with {fit.freedom} degrees of freedom)"


SECTIONS: dict[str, Callable[[], str]] = {
    "slips": slips,
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


# ---- Pictures


def draw_slips() -> Figure:
    """Draw measured and predicted medians of the runs, with quartiles of the measured slips."""
    mu_s, mu_k = stick_slip.friction()
    with styled():
        figure = Figure(figsize=(6.9, 2.5), layout="constrained")
        axes = figure.subplots(1, 3)
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
            for axis, value, number in zip(axes, values, expected, strict=True):
                low, middle, high = np.percentile(value, [25, 50, 75])
                axis.plot([place, place], [low, high], color=BLACK, linewidth=0.8)
                axis.plot(place, middle, "o", color=BLACK, ms=3.5)
                axis.plot(place, number, "D", color=SEPARATED, ms=4, mfc="none")
        names = [f"{stiffness}\n{speed}" for stiffness, speed in stick_slip.runs()]
        for axis, label, marks in zip(axes, labels, ticks, strict=True):
            axis.set(ylabel=label, yscale="log", xticks=range(len(names)))
            axis.set_yticks(marks, [f"{mark:g}" for mark in marks])
            axis.minorticks_off()
            axis.margins(x=0.07)
            axis.set_xticklabels(names, fontsize=6)
            axis.set_xlabel("Stiffness (N/m), speed (µm/s)")
    return figure


def draw_shapes() -> Figure:
    """Draw the wheel's shapes on the rim, measured and as the model has them."""
    with styled():
        figure = Figure(figsize=(6.9, 2.0), layout="constrained")
        axes = figure.subplots(1, 4, sharey=True)
        fine = np.linspace(0, 165, 166)
        for axis, (diameters, rows) in zip(
            axes, read("wheel.csv").groupby("diameters"), strict=True
        ):
            response = rows["real"].to_numpy() + 1j * rows["imaginary"].to_numpy()
            axis.axhline(0, color=GREY, linewidth=0.6)
            model = wheel.shape(int(diameters), np.radians(fine))
            axis.plot(fine, model, color=BLUE, linewidth=0.8)
            axis.plot(rows["angle_deg"], (response / response[0]).real, "o", color=BLACK, ms=3)
            axis.set(xlabel="Angle (°)", xticks=(0, 60, 120, 180))
            axis.set_title(f"{rows['frequency_Hz'].iloc[0]:.0f} Hz, l = {diameters}")
        axes[0].set_ylabel("Amplitude over\nthat at the hammer")
    return figure


@script
def main() -> None:
    """Write the tables and draw the pictures."""
    warnings.simplefilter("ignore", dm.ImplausibleValue)  # a slider of 31 g is light
    text = PAGE.read_text(encoding="utf-8")
    for name, build in SECTIONS.items():
        content = build()
        text = marked(name).sub(lambda _, content=content: content, text)
    PAGE.write_text(text, encoding="utf-8")
    print(mass())
    for name, figure in (("slips", draw_slips()), ("shapes", draw_shapes())):
        figure.savefig(GALLERY / f"measured_{name}.png", dpi=130)
