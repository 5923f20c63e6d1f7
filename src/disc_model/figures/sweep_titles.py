"""What titles and legends say of the case of a sweep."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

import xarray as xr

from disc_model.figures.head_texts import what_case
from disc_model.figures.sweep_choice import Drawn
from disc_model.figures.sweep_dimensions import numbers_along
from disc_model.figures.sweep_options import option_text, stays_in
from disc_model.figures.value_texts import symbol_of, value_text
from disc_model.figures.varied_discs import single_disc, varied_numbers, with_frequencies
from disc_model.figures.words import known_name


def values_of(study: xr.Dataset) -> dict[str, Any]:
    """The values of the case that do not vary in a study."""
    case = json.loads(study.attrs.get("base", study.attrs.get("parameters", "{}")))
    shown = {str(name).removeprefix("sweep_").removeprefix("scan_") for name in study.coords}
    fixed = {name: value for name, value in case.items() if name not in shown}
    single = {}
    for name, values in study.coords.items():
        if not values.ndim or values.size == 1:
            single[str(name)] = values.item()
    single.update(single_disc(study))
    return with_frequencies({**fixed, **single}, {**varied_numbers(*shown), **single})


def said_of(study: xr.Dataset) -> dict[str, str]:
    """Words for single values of what is no parameter and has a unit, such as a horizon."""
    said = {}
    for name, values in study.coords.items():
        if values.size == 1 and values.attrs.get("units", "1") != "1" and not known_name(values):
            stated = f"{name} = {value_text(study, str(name))}"
            said[str(name)] = option_text(str(name), values.item()) or stated
    return said


def title_of(study: xr.Dataset, drawn: Drawn, selected: Mapping[str, str]) -> str:
    """What does not vary in a study, and of paired samples, what varies beside the column over which
    they are drawn.

    selected : words for what was selected of the study
    """
    said = [what_case({**values_of(study), **stays_in(study)}, selected)]
    if drawn.sampled:
        said.append(_varies(numbers_along(study, str(drawn.second))))
    else:
        said.append(_said_of_samples(study, drawn.across))
    return ", ".join(filter(None, said))


def _said_of_samples(study: xr.Dataset, column: str) -> str:
    """What varies with a column of paired samples; "" if nothing does."""
    beside = [name for name in numbers_along(study, column) if name != column]
    return f"{_varies(beside)} as well" if beside else ""


def _varies(names: Sequence[str]) -> str:
    """What is said of numbers that vary between samples; "" of none."""
    if not names:
        return ""
    verb = "vary" if len(names) > 1 else "varies"
    return f"{' and '.join(map(symbol_of, names))} {verb}"
