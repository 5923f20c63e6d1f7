"""Units of the reader for variables that have another name than their parameter: the range of a sampled
variable, such as P_max, and speeds and critical values that are found."""

from collections.abc import Mapping

import xarray as xr

from disc_model.data.variables import SHOWN
from disc_model.figures.kinds.general import General
from disc_model.figures.words import UNITS, label_in, unit_key


def key_by_label(plot: object, study: xr.Dataset) -> dict[str, str]:
    """The parameter or sampled variable by which a reader gives the unit of what a general figure shows,
    by the label of its axis."""
    if not isinstance(plot, General) or plot.variable not in study:
        return {}
    return {label_in(study, plot.variable): unit_key(study[plot.variable])}


def with_limits_of_label(plot: General, study: xr.Dataset) -> General:
    """The figure with its limits in the unit in which it is drawn, before axes are given in those of the
    reader."""
    key = unit_key(study[plot.variable])
    units: Mapping[str, tuple[str, float]] = UNITS.get()
    if plot.limits is None or key not in units:
        return plot
    _, factor = units[key]
    low, high = plot.limits
    ratio = SHOWN[key].factor / factor
    return plot.model_copy(update={"limits": (low * ratio, high * ratio)})
