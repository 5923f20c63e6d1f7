"""Words for lists and starts along a dimension of a sweep, with their names and units."""

import re
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.variables import PERTURBATIONS, SHOWN
from disc_model.figures.sweep_options import list_text
from disc_model.figures.value_texts import number_or_text
from disc_model.units import is_number

NUMBER = re.compile(r"-?(\d|\.\d|inf)")
"""What a number begins with."""
NAMED = re.compile(r"(?P<name>\w+) = (?P<value>[^,]+)")
"""A number of a start, as sweeps write it."""

OF_SLIDER = "Perturbation of the slider's "
"""What names of perturbations begin with."""


def with_names_of_lists(study: xr.Dataset, dim: str | None) -> xr.Dataset:
    """The study with names and units in the words along a dimension, whose values have a line each, if
    these are lists, such as bounds, or starts."""
    if dim is None or dim not in study.coords or study[dim].dtype.kind != "U":
        return study
    values = study[dim]
    texts = _texts_of(study, dim, [str(word) for word in values.values])
    if not texts:
        return study
    return study.assign_coords({dim: (dim, np.array(texts), values.attrs)})


def name_of_list(study: xr.Dataset, name: str) -> str:
    """What is said of a coordinate of one value that is a list or a start; "" of any other."""
    word = study[name].item()
    if not isinstance(word, str):
        return ""
    return "".join(_texts_of(study, name, [word]))


def _texts_of(study: xr.Dataset, name: str, words: Sequence[str]) -> list[str]:
    """What is said of lists or starts by their words; nothing of other words."""
    if all(map(_is_start, words)):
        return [_start_text(word) for word in words]
    if any("," in word for word in words) and all(map(_is_list, words)):
        return [list_text(study, name, _numbers_of(word)) for word in words]
    return []


def _is_list(words: str) -> bool:
    """Whether words are those of a list of numbers, which may have units."""
    return all(NUMBER.match(part) for part in words.split(", "))


def _numbers_of(words: str) -> list[Any]:
    """The numbers of a list by its words; those with units stay texts."""
    return [number_or_text(part) for part in words.split(", ")]


def _is_start(words: str) -> bool:
    """Whether words are those of perturbations of the static start."""
    found = [NAMED.fullmatch(part) for part in words.split(", ")]
    return all(part and f"perturbation_{part['name']}" in PERTURBATIONS for part in found)


def _start_text(words: str) -> str:
    """The perturbations of a start with units."""
    return ", ".join(_perturbation_text(part) for part in words.split(", "))


def _perturbation_text(words: str) -> str:
    """A perturbation by its name, with its unit."""
    name, _, text = words.partition(" = ")
    shown = SHOWN[f"perturbation_{name}"]
    value = number_or_text(text)
    if is_number(value):
        text = f"{shown.factor * value:g} {shown.unit}"
    return f"{shown.name.removeprefix(OF_SLIDER)} = {text}"
