"""Measurements beside what a fitted case computes of them."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.data.variables import SHOWN, typeset
from disc_model.display import counted
from disc_model.figures.canvas import Wishes, page_for
from disc_model.figures.drawing import (
    BLACK,
    GREY,
    PAGE,
    SEPARATED,
    large,
    leave_to_first,
    mark,
    wide,
)
from disc_model.figures.fitted_values import fitted_text
from disc_model.figures.named_axes import Quantities, check_free
from disc_model.figures.types import Axes
from disc_model.figures.value_texts import stated_value

if TYPE_CHECKING:
    from disc_model.fitting.result import Fit

DIFFERENCE = "Difference from the measured value (%)"
DEVIATION = "Deviation (standard deviations)"
OF_ZERO = "measured 0, which has no %"
ROWS = "Measurements"
EXPECTED = 2.0  # standard deviations, within which most deviations are if the model is right
BAND = "95 % if the fit is right"
LEAST_SPAN = 3.0  # standard deviations that are shown at least, on both sides
WORDS = {
    "period": "period",
    "growth_rate": "growth rate",
    "stick_fraction": "share of stick",
    "stick_time": "duration of stick",
    "slip_time": "duration of slip",
    "slip_length": "path of a slip",
    "sliding_growth_rate": "growth rate of sliding",
    "sliding_frequency": "frequency of sliding",
}
"""What rows call quantities of a case,"""
OF_MODES = {
    r"^coupled_frequency_(\d+)$": r"frequency \1 of disc and slider",
    r"^(frequency|damping_ratio)_(\d+)_(\d+)$": r"\1 of mode (\2, \3)",
    r"^damping_ratio": "damping ratio",
}
"""and those of single modes, by their nodal diameters and circles."""
NARROW = 1.5  # inch, place of a panel in which a title would have three lines or more
ROW = 0.18  # inch, height of a measurement


def plot_fit(
    fit: Fit,
    *,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | bool | None = None,
) -> np.ndarray:
    """Draw computed over measured values, both relative to the measured ones, and their deviations
    in standard deviations; two panels with a row for each measurement, the first on top."""
    wishes = Wishes(ax, legend, labels, title)
    rows = ROW * len(fit.measurements)
    said = fitted_text(fit)
    page_of_two = page_for(
        wishes, PAGE, 1.3 + rows, 1, 2, stacked=1.9 + rows, title=said, sharey=True
    )
    with page_of_two as page:
        check_free(page.axes, ROWS, "a fit")
        page.show(Quantities(DIFFERENCE, ROWS), Quantities(DEVIATION, ROWS))
        left, right = page.axes
        _draw_differences(left, fit)
        _draw_deviations(right, fit)
        _set_rows(left, right, fit)
        if not page.own:
            page.note = said
        shown = [handle for ax in (left, right) for handle in ax.get_legend_handles_labels()[0]]
        said = _goodness(fit)
        if legend is not False and _is_narrow(right):  # it would be a title of many lines
            page.explain(shown, title=said)
        else:
            right.set_title(said, fontsize=large(8))
            page.explain(shown)
    return np.array([left, right], dtype=object)


def _draw_differences(ax: Axes, fit: Fit) -> None:
    """Draw measured values with their uncertainties, and computed ones, in % of what was
    measured; none where that is 0."""
    value = np.array([each.value for each in fit.measurements])
    error = np.array([each.uncertainty for each in fit.measurements])
    has_size = value != 0
    size = np.abs(value[has_size])
    rows = _rows(fit)[has_size]
    ax.errorbar(
        np.zeros(rows.size),
        rows,
        xerr=100 * error[has_size] / size,
        fmt="o",
        color=BLACK,
        markersize=mark(3.5),
        capsize=mark(3),
        linewidth=wide(0.8),
        label="measured, standard deviation",
    )
    shift = 100 * (fit.computed - value)[has_size] / size
    ax.plot(shift, rows, label="computed", **_computed())
    for row in _rows(fit)[~has_size]:
        _say_without_size(ax, int(row))
    if not has_size.any():
        ax.set_xticks([])
    ax.set_xlabel(DIFFERENCE)
    ax.margins(x=0.08)


def _say_without_size(ax: Axes, row: int) -> None:
    """Say in the row of a measured 0 why it has no marks: it has no per cent."""
    place = ax.get_yaxis_transform()
    said: dict[str, Any] = {"ha": "center", "va": "center", "color": GREY, "fontsize": large(7)}
    ax.text(0.5, row, OF_ZERO, transform=place, **said)


def _draw_deviations(ax: Axes, fit: Fit) -> None:
    """Draw computed minus measured values, in standard deviations."""
    ax.axvspan(-EXPECTED, EXPECTED, color=GREY, alpha=0.15, linewidth=0, label=BAND)
    ax.axvline(0, color=GREY, linewidth=wide(0.6))
    ax.plot(fit.deviations, _rows(fit), **_computed())
    span = max(LEAST_SPAN, 1.1 * float(np.abs(fit.deviations).max()))
    ax.set_xlabel(DEVIATION)
    ax.set_xlim(-span, span)


def _goodness(fit: Fit) -> str:
    """How good a fit is, in words."""
    freedom = counted(fit.freedom, "degree")
    return f"chi squared {fit.chi_squared:.3g}, {freedom} of freedom"


def _is_narrow(ax: Axes) -> bool:
    """Whether the place of a panel on its page is narrow."""
    figure: Any = ax.get_figure(root=True)
    return bool(ax.get_position(original=True).width * figure.get_figwidth() < NARROW)


def _set_rows(left: Axes, right: Axes, fit: Fit) -> None:
    """Give both panels the same rows, whether or not they share an axis, and name them in both
    unless these stand beside each other."""
    rows = _rows(fit)
    for ax in (left, right):
        ax.set_yticks(rows)
        ax.set_yticklabels([_said(each) for each in fit.measurements], fontsize=large(7))
        ax.set_ylim(-0.7, rows.size - 0.3)
    leave_to_first([right], [left])


def _said(measurement: Any) -> str:
    """What a row says of a measurement: its quantity in words, and what was set, by symbols and with
    units."""
    name = measurement.quantity
    if callable(name):
        name = getattr(name, "__name__", "quantity").replace("_", " ")
    words = WORDS.get(name, name)
    for pattern, shown in OF_MODES.items():
        words = re.sub(pattern, shown, words)
    settings = [_setting(parameter, value) for parameter, value in measurement.at.items()]
    return typeset(", ".join([words, *settings]))


def _setting(parameter: str, value: Any) -> str:
    """A value of a parameter by its symbol; also one that is a text with a unit."""
    if isinstance(value, str) and parameter in SHOWN:
        return f"{SHOWN[parameter].symbol} = {value}"
    return stated_value(parameter, value)


def _rows(fit: Fit) -> np.ndarray:
    """Heights of the measurements, the first on top."""
    return np.arange(len(fit.measurements))[::-1]


def _computed() -> dict[str, Any]:
    """Look of the marks of computed values."""
    return {
        "marker": "D",
        "linestyle": "",
        "color": SEPARATED,
        "markersize": mark(3.5),
        "markerfacecolor": "none",
    }
