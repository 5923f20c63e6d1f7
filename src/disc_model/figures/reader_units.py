"""Units of the reader for variables that have another name than their parameter: the range of a sampled
variable, such as P_max, and speeds and critical values that are found."""

from collections.abc import Mapping

import xarray as xr

from disc_model.data.variables import FOUND_SPEEDS, SERIES, SHOWN, ranged_variable
from disc_model.figures.kinds.general import General
from disc_model.figures.words import BORDER, CRITICAL, UNITS, known_name, label_in, parameter_within


def unit_key(variable: xr.DataArray) -> str:
    """The parameter or sampled variable by which a reader gives the unit of a variable; "" if there is
    none."""
    known = known_name(variable)
    if known:
        return known
    for around in (CRITICAL, BORDER):
        parameter = parameter_within(variable, around)
        if parameter:
            return parameter
    name = str(variable.name)
    if name in FOUND_SPEEDS:
        return "Omega"
    base = ranged_variable(name)
    if base == name or base not in SERIES:
        return ""
    same_unit = variable.attrs.get("units") == SERIES[base].attributes.get("units")
    return base if same_unit else ""


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
