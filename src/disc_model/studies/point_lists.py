"""Lists of the points of a study of which there is something to say, in files beside its dataset."""

from collections.abc import Iterable, Iterator, Mapping
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
from disc_model.units import is_number

NONE = "no point"
"""The line of a file that lists none."""


def point_list(lines: Iterable[str]) -> str:
    """The text of a file that lists points, a line for each."""
    return "".join(f"{line}\n" for line in [*lines] or [NONE])


def failures(study: xr.Dataset) -> Iterator[str]:
    """Yield one line for each point without a result: its parameters, status and message."""
    status = flag_names(study["status"])
    for place, point in _points_at(study, (status != "ok") & (status != EXCLUDED)):
        word = str(flag_names(point["status"]))
        yield f"{place}: {_status_text(word, str(point['message'].item()))}"


def remarks(study: xr.Dataset) -> Iterator[str]:
    """Yield one line for each point with a result and a message: its parameters, and the message."""
    status = flag_names(study["status"])
    remarked = (status == "ok") & (study["message"].values != "")
    for place, point in _points_at(study, remarked):
        yield f"{place}: {point['message'].item()}"


def _points_at(study: xr.Dataset, mask: np.ndarray) -> Iterator[tuple[str, xr.Dataset]]:
    """Yield some points of a study, each with its parameters as a text."""
    dims = study["status"].dims
    varied = [str(name) for name in study.coords if {*study[name].dims} <= {*dims}]
    for index in np.argwhere(mask):
        point = study.isel(dict(zip(dims, index, strict=True)))
        yield point_text({name: point[name].item() for name in varied}), point


def _status_text(word: str, message: str) -> str:
    """Return a status and a message in a line, the status once."""
    what = WITHOUT_CYCLE.get(word, word)
    return message if message.startswith(what) else f"{what}: {message}"


def point_text(values: Mapping[str, Any]) -> str:
    """The values of a point, by their names, in a line."""
    return ", ".join(f"{name} = {_value_text(name, value)}" for name, value in values.items())


def _value_text(name: str, value: Any) -> str:
    """A value of a point with its unit; a word as it is."""
    return f"{value:.9g} {_si_unit(name)}".strip() if is_number(value) else str(value)


def _si_unit(name: str) -> str:
    """The unit of SI of what varies at the points of a study, as it is written; "" without one."""
    if name in (*Parameters.model_fields, *RATIOS):
        return unit_of_parameter(name)
    unit = str(attributes(name).get("units", ""))
    return "" if unit == "1" else unit.replace(" s-1", "/s")
