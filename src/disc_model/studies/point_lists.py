"""Lists of the points of a study of which there is something to say, in files beside its dataset."""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.variables import (
    EXCLUDED,
    WITHOUT_CYCLE,
    attributes,
    flag_names,
    unit_of_parameter,
)
from disc_model.parameters import RATIOS, Parameters
from disc_model.units import is_number, size_of_unit

NONE = "no point"
"""The line of a file that lists none."""


def point_list(lines: Iterable[str]) -> str:
    """The text of a file that lists points, a line for each."""
    return "".join(f"{line}\n" for line in [*lines] or [NONE])


def listed_in(file: Path) -> list[str]:
    """The lines of the points that a file lists."""
    lines = file.read_text(encoding="utf-8").splitlines()
    return [] if lines == [NONE] else lines


def failures(study: xr.Dataset, units: Mapping[str, str] = MappingProxyType({})) -> Iterator[str]:
    """Yield one line for each point without a result: its parameters, in units by their names or those of
    SI, status and message."""
    status = flag_names(study["status"])
    for place, point in _points_at(study, (status != "ok") & (status != EXCLUDED), units):
        word = str(flag_names(point["status"]))
        yield f"{place}: {_status_text(word, str(point['message'].item()))}"


def remarks(study: xr.Dataset, units: Mapping[str, str] = MappingProxyType({})) -> Iterator[str]:
    """Yield one line for each point with a result and a message: its parameters, in units as of
    `failures`, and the message."""
    status = flag_names(study["status"])
    remarked = (status == "ok") & (study["message"].values != "")
    for place, point in _points_at(study, remarked, units):
        yield f"{place}: {point['message'].item()}"


def _points_at(
    study: xr.Dataset, mask: np.ndarray, units: Mapping[str, str]
) -> Iterator[tuple[str, xr.Dataset]]:
    """Yield some points of a study, each with its parameters as a text."""
    dims = study["status"].dims
    varied = [str(name) for name in study.coords if {*study[name].dims} <= {*dims}]
    for index in np.argwhere(mask):
        point = study.isel(dict(zip(dims, index, strict=True)))
        yield point_text({name: point[name].item() for name in varied}, units), point


def _status_text(word: str, message: str) -> str:
    """Return a status and a message in a line, the status once."""
    what = WITHOUT_CYCLE.get(word, word)
    return message if message.startswith(what) else f"{what}: {message}"


def point_text(values: Mapping[str, Any], units: Mapping[str, str]) -> str:
    """The values of a point, by their names, in a line: numbers in units by parameter, and in those of
    SI without one."""
    parts = [f"{name} = {_value_text(name, value, units)}" for name, value in values.items()]
    return ", ".join(parts)


def _value_text(name: str, value: Any, units: Mapping[str, str]) -> str:
    """A value of a point with its unit; a word as it is."""
    if not is_number(value):
        return str(value)
    unit = _si_unit(name)
    number = value
    if name in units:
        number = value / size_of_unit(units[name], unit)
        unit = units[name]
    return f"{number:.9g} {unit}".strip()


def _si_unit(name: str) -> str:
    """The unit of SI of what varies at the points of a study, as it is written; "" without one."""
    if name in (*Parameters.model_fields, *RATIOS):
        return unit_of_parameter(name)
    unit = str(attributes(name).get("units", ""))
    return "" if unit == "1" else unit.replace(" s-1", "/s")
