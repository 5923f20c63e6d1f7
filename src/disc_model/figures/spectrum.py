"""Spectra: the amplitude of a variable over the frequency."""

from typing import Any

import xarray as xr

from disc_model.data.dataset import Missing
from disc_model.errors import Fault, ParameterError, require
from disc_model.figures.amplitudes import amplitudes
from disc_model.figures.canvas import Wishes, page_for
from disc_model.figures.drawing import COLUMN
from disc_model.figures.labels import words_of
from disc_model.figures.named_axes import Quantities
from disc_model.figures.overlay import Case, draw_case, is_beside, name_of_case
from disc_model.figures.runs import span_of, window_of
from disc_model.figures.spectrum_lines import (
    FREQUENCY,
    amplitude_label,
    draw_spectrum,
    lines_beside,
)
from disc_model.figures.stated_case import stated, told_apart
from disc_model.figures.types import Axes
from disc_model.units import is_number

ROUNDING = 1e-9  # relative, of half the rate of a window


def plot_spectrum(
    case: xr.DataTree,
    window: str,
    variable: str,
    highest: float | None,
    *,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | bool | None = None,
) -> Axes:
    """Draw the spectrum of a variable of a run; returns the axes."""
    known = highest is None or (is_number(highest) and highest > 0)
    require((known, "highest", highest, "must be a number > 0, in Hz"))
    samples = window_of(case, window, ("variable", variable), samples=True)
    _check_range(samples, highest)
    name, labels = name_of_case(labels)
    try:
        wishes = Wishes(ax, legend, labels, title)
        with page_for(wishes, COLUMN, 2.6, title=stated(case)) as page:
            page.show(Quantities(FREQUENCY, amplitude_label(samples, variable)))
            apart = told_apart(case, name, window=f"window {window}")
            overlaid = Case("spectrum", apart, stated(case))
            axes = page.ax
            former = words_of(axes.xaxis.label)
            found = amplitudes(samples, variable, highest)
            panels = [lines_beside(axes, samples, variable, found)]
            named = not is_beside(axes, "spectrum")  # peaks on other axes have the same names
            alone = draw_case(
                page, overlaid, panels, lambda: draw_spectrum(axes, samples, variable, found, named)
            )
            resolutions_differ = words_of(axes.xaxis.label) != former
            if not alone and resolutions_differ:
                axes.set_xlabel(FREQUENCY)
    except Missing as reason:
        raise ParameterError(Fault.of(("window",), window, str(reason))) from None
    return page.ax


def _check_range(samples: xr.Dataset, highest: float | None) -> None:
    """Raise `ParameterError` unless a window shows frequencies up to the highest, Hz."""
    span = span_of(samples)
    if highest is None or not span:
        return
    half_rate = (samples["time"].size - 1) / (2 * span)
    resolution = 1 / span
    rule = (
        f"must be within {resolution:.3g} Hz, the resolution, and {half_rate:.6g} Hz, half the"
        " rate of the window"
    )
    within = resolution <= highest <= half_rate * (1 + ROUNDING)
    require((within, "highest", highest, rule))
