"""Units of the reader in which pictures are drawn that are called from Python."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import wraps
from typing import Any

import pandas as pd
import xarray as xr

from disc_model.data.variables import SHOWN, attributes_of_number
from disc_model.errors import Fault, ParameterError, require
from disc_model.figures.kinds.base import known_units, si_unit
from disc_model.figures.words import DRAWN_IN, UNITS, factors_of, label_of, parameter_along
from disc_model.units import size_of_unit

OF_CAMPBELL = ("Omega", "crossing_Omega", "crossing_step")
"""Speeds of a Campbell diagram, and steps of them."""
ARE_UNITS = 'must be None, or units by names of parameters, such as {"Omega": "rpm"}'


def in_readers_units(picture: Callable[..., Any]) -> Callable[..., Any]:
    """A picture with the option `units`, which draws coordinates with a unit of their own in it."""

    @wraps(picture)
    def drawn(data: Any, *inputs: Any, units: Any = None, **options: Any) -> Any:
        with drawn_in(data, units) as shown:
            return picture(shown, *inputs, **options)

    return drawn


@contextmanager
def drawn_in(data: Any, units: Any) -> Iterator[Any]:
    """Draw and say values of data in units that a reader asks for, and coordinates with a unit of their own
    in it; yields the data with these coordinates in SI. Raises `ParameterError`."""
    asked = checked_units(units)
    own: dict[str, str] = {}
    if isinstance(data, xr.Dataset):
        own = units_of_coordinates(data)
        data = with_coordinates_in_si(data)
    factors = factors_of({**own, **asked})
    said = UNITS.set({**UNITS.get(), **factors})
    shown = DRAWN_IN.set({**DRAWN_IN.get(), **factors})
    try:
        yield data
    finally:
        DRAWN_IN.reset(shown)
        UNITS.reset(said)


def checked_units(units: Any) -> dict[str, str]:
    """The units that a reader asks for; raises `ParameterError`."""
    if units is None:
        return {}
    is_mapping = isinstance(units, Mapping)
    are_texts = is_mapping and all(isinstance(text, str) for text in (*units, *units.values()))
    require((are_texts, "units", units, ARE_UNITS))
    try:
        return known_units(dict(units))
    except ParameterError as error:
        faults = [fault.inside(("units",)) for fault in error.faults if isinstance(fault, Fault)]
        raise ParameterError(*faults) from None


def units_of_coordinates(study: xr.Dataset) -> dict[str, str]:
    """Units of the coordinates that have another one than that of SI, by the names of their parameters."""
    found = {}
    for coordinate in study.coords.values():
        name = parameter_along(coordinate)
        if name and _size_of_unit(coordinate, name):
            found[name] = str(coordinate.attrs["units"])
    return found


def with_coordinates_in_si(study: xr.Dataset) -> xr.Dataset:
    """The study with such coordinates in SI."""
    converted = {}
    for key, coordinate in study.coords.items():
        name = parameter_along(coordinate)
        size = _size_of_unit(coordinate, name) if name else 0.0
        if size:
            attrs = {**coordinate.attrs, "units": attributes_of_number(name)["units"]}
            converted[key] = (coordinate.dims, coordinate.values * size, attrs)
    return study.assign_coords(converted)


def with_drawn_speeds(study: xr.Dataset) -> xr.Dataset:
    """A Campbell diagram's speeds, and those of its crossings, as they are drawn."""
    _, factor = label_of(study["Omega"])
    if factor == 1.0:
        return study
    drawn = {}
    for name in OF_CAMPBELL:
        if name in study.variables:
            drawn[name] = study[name].copy(data=study[name].values * factor)
    return study.assign_coords(Omega=drawn.pop("Omega")).assign(drawn)


def _size_of_unit(coordinate: xr.DataArray, name: str) -> float:
    """The size in SI of the unit that a coordinate of a parameter has for itself; 0 if it has the usual
    one, or one of another kind."""
    unit = coordinate.attrs.get("units")
    usual = attributes_of_number(name).get("units")
    is_plain = coordinate.dtype.kind in "iuf" and not _is_within_index(coordinate)
    if not isinstance(unit, str) or unit == usual or not is_plain or name not in SHOWN:
        return 0.0
    return size_of_unit(unit, si_unit(name))


def _is_within_index(coordinate: xr.DataArray) -> bool:
    """Whether a coordinate is a level of an index of several."""
    index = coordinate.indexes.get(coordinate.name)
    return isinstance(index, pd.MultiIndex)
