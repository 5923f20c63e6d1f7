"""What figures of bifurcations say of motions without events, such as steady sliding. Nothing here draws."""

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures.classes import name_of
from disc_model.figures.types import Array

CALM = ("steady_sliding", "at_rest")
"""Kinds of motions that have no events, so that they have no period either."""
OF_EVENTS = ("psi", "psi_velocity", "P", "u", "period_events", "period_residual")
"""Variables that have no value where a motion has no events."""


def without_zeros(study: xr.Dataset) -> xr.Dataset:
    """The study with no number of events in a period where a motion is not shown to repeat, for which it
    has 0."""
    if "period_events" not in study:
        return study
    events = study["period_events"]
    words = str(events.attrs.get("long_name", "")).replace(", 0 if", ", nan if")
    shown = events.where(events > 0).assign_attrs({**events.attrs, "long_name": words})
    return study.assign(period_events=shown)


def calm_points(study: xr.Dataset, name: str) -> dict[str, xr.DataArray]:
    """Points at which a variable of events has no value because the motion has none, by the names of
    what the motion is; nothing for other variables."""
    if name not in OF_EVENTS or not {"kind", "period_events"} <= {*study}:
        return {}
    kinds = study["kind"].copy(data=kinds_of(study))
    return {name_of(word): kinds == word for word in CALM}


def kinds_of(study: xr.Dataset) -> Array:
    """What the motion has come to at each point, in words."""
    return np.asarray(flag_names(study["kind"]))
