"""Scales of the axes that maps of regions share."""

from collections.abc import Mapping, Sequence

import xarray as xr
from matplotlib.ticker import FixedLocator, NullFormatter, NullLocator

from disc_model.data.variables import axis_of
from disc_model.figures.cells import decades_between, scale_of
from disc_model.figures.types import Array, Axes


def set_scales(axes: Sequence[Axes], study: xr.Dataset, names: Mapping[str, str]) -> None:
    """Set limits, labels and scales of shared axes; a logarithmic scale with a 0 is linear up to
    the second value."""
    for which, name in names.items():
        label, factor = axis_of(name)
        values = study[name].values * factor
        _set_scale(axes[0], which, scale_of(name, values), values)
        for ax in axes:
            ax.set(**{f"{which}label": label})
            ax.label_outer()


def _set_scale(ax: Axes, which: str, scale: str, values: Array) -> None:
    """Set the scale of one axis of a panel, and limits with some room beside its values."""
    axis = getattr(ax, f"{which}axis")
    if scale != "linear":
        ticks = decades_between(values)
        start = {}
        if scale == "symlog":
            ticks = [0.0, *ticks]
            start = {"linthresh": values[1], "linscale": 0.4}
        getattr(ax, f"set_{which}scale")(scale, **start)
        axis.set_major_locator(FixedLocator(ticks))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())
    if scale == "symlog":
        axis.set_minor_locator(NullLocator())
    to_axis = axis.get_transform()
    low, high = to_axis.transform(values[[0, -1]])
    room = 0.02 * (high - low) or 0.02 * abs(high) or 1.0
    limits = to_axis.inverted().transform([low - room, high + room])
    getattr(ax, f"set_{which}lim")(limits)
