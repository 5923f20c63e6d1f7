"""A Campbell diagram of a study on a reader's axes."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.figures.campbell import column_of, highest_of
from disc_model.figures.campbell_arguments import checked_study
from disc_model.figures.campbell_legend import entries_of
from disc_model.figures.campbell_names import name_peaks
from disc_model.figures.campbell_panels import FREQUENCY, RATE, draw_panels
from disc_model.figures.canvas import Wishes, page_for
from disc_model.figures.drawing import COLUMN
from disc_model.figures.head_texts import what_case
from disc_model.figures.named_axes import Quantities, check_free
from disc_model.figures.sweep_titles import values_of
from disc_model.figures.words import SPEED

HEIGHT = 5.4  # inch, with its legend


def plot_campbell(
    study: xr.Dataset,
    *,
    highest: float | str | None = None,
    multiples: Sequence[float] = (),
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | bool | None = None,
) -> np.ndarray:
    """Draw frequencies, multiples and growth rates over the speed, as `disc_model.plot_campbell`
    describes."""
    drawn, limit = checked_study(study, highest, multiples)
    asked_for = tuple(multiples)
    column = column_of(drawn)
    shown = limit or highest_of([column])
    wishes = Wishes(ax, legend, labels, title)
    case = what_case(values_of(drawn))
    shared: dict[str, Any] = {"sharex": True, "height_ratios": [3, 2]}
    with page_for(wishes, COLUMN, HEIGHT, 2, 1, title=case, **shared) as page:
        check_free(page.axes, FREQUENCY, "a Campbell diagram")
        page.show(Quantities(SPEED, FREQUENCY), Quantities(SPEED, " ".join(RATE.split())))
        top, bottom = page.axes
        draw_panels([top], [bottom], [column], shown, asked_for)
        name_peaks(top, bottom, column, shown, asked_for)
        page.is_small = True
        page.explain(entries_of([column], shown, asked_for), beside="below")
    return np.array(page.axes, dtype=object)
