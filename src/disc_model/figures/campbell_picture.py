"""A Campbell diagram of a study on a reader's axes."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.errors import raise_faults, require, violations
from disc_model.figures.campbell import column_of, highest_of
from disc_model.figures.campbell_legend import entries_of
from disc_model.figures.campbell_names import name_peaks
from disc_model.figures.campbell_panels import FREQUENCY, RATE, draw_panels
from disc_model.figures.canvas import Wishes, page_for
from disc_model.figures.drawing import COLUMN
from disc_model.figures.named_axes import Quantities, check_free
from disc_model.figures.selection import without_single
from disc_model.figures.sweep_choice import values_of
from disc_model.figures.words import SPEED, what_case
from disc_model.units import in_si, is_number, is_whole

NEEDED = ("Omega", "sliding_frequency", "growth_rate", "crossing_Omega")
"""What a study has that such a diagram can show."""
OTHERS = ("Omega", "mode", "crossing")
"""Dimensions of such a study beside those of its grid."""
HEIGHT = 5.4  # inch, with its legend


def plot_campbell(
    study: xr.Dataset,
    *,
    highest: float | str | None = None,
    multiples: Sequence[int] = (),
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | bool | None = None,
) -> np.ndarray:
    """Draw frequencies, multiples and growth rates over the speed, as `disc_model.plot_campbell`
    describes."""
    is_study = isinstance(study, xr.Dataset) and all(name in study for name in NEEDED)
    faults: list[Any] = []
    limit: Any = in_si(highest, "Hz", faults, ("highest",))
    known = bool(faults) or limit is None or (is_number(limit) and limit > 0)
    faults += violations(
        (is_study, "study", study, "must be a study of `quantity: campbell`, as of run_study"),
        (known, "highest", highest, "must be a number > 0, in Hz"),
        (
            _are_multiples(multiples),
            "multiples",
            multiples,
            "must be whole numbers > 0, such as [2, 3]",
        ),
    )
    raise_faults(faults)
    drawn = without_single(study, *OTHERS).transpose("Omega", ...)
    further = [str(dim) for dim in drawn.dims if dim not in OTHERS]
    rule = f"must not vary along it: select one, as by study.isel({'=0, '.join(further)}=0)"
    points = "must have two speeds or more"
    require(
        (not further, "study", ", ".join(further), rule),
        (drawn.sizes["Omega"] > 1, "study", "a single speed", points),
    )

    column = column_of(drawn)
    shown = limit or highest_of([column])
    wishes = Wishes(ax, legend, labels, title)
    case = what_case(values_of(drawn))
    shared: dict[str, Any] = {"sharex": True, "height_ratios": [3, 2]}
    with page_for(wishes, COLUMN, HEIGHT, 2, 1, title=case, **shared) as page:
        check_free(page.axes, FREQUENCY, "a Campbell diagram")
        page.show(Quantities(SPEED, FREQUENCY), Quantities(SPEED, " ".join(RATE.split())))
        top, bottom = page.axes
        draw_panels([top], [bottom], [column], shown, multiples)
        name_peaks(top, bottom, column, shown)
        page.explain(entries_of([column], shown, multiples), beside="below")
    return np.array(page.axes, dtype=object)


def _are_multiples(multiples: Any) -> bool:
    """Whether these are whole numbers from 1 on, or none."""
    if np.ndim(multiples) != 1:
        return False
    return all(is_whole(each) and each >= 1 for each in multiples)
