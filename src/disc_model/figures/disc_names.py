"""What legends call the discs of several cases on the same axes, which may be plates, or tables of modes."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from disc_model.modal_disc import Disc
from disc_model.parameters import DEFAULTS, PLATE

PLATE_NAME = "plate"
"""What a disc is called that is given by its sizes and material, beside discs given by their modes."""
SHORT = ".4g"
"""Digits of a frequency."""


def disc_name(disc: object, others: Sequence[object]) -> str:
    """What a legend calls a disc beside others: by the number of its modes, and by their frequencies where
    another one has as many."""
    if disc is None:
        return PLATE_NAME
    frequencies = _frequencies(disc)
    name = f"disc of {len(frequencies)} modes"
    if len(frequencies) == 1:
        name = "disc of 1 mode"
    range_text = _range_text(frequencies)
    for other in others:
        if other is None or same_disc(disc, other):
            continue
        beside = _frequencies(other)
        if len(beside) == len(frequencies) and _range_text(beside) != range_text:
            return f"{name} of {range_text}"
    return name


def same_disc(one: object, other: object) -> bool:
    """Whether two discs have the same table, or are both given by sizes and material."""
    if one is None or other is None:
        return one is other
    return _as_disc(one) == _as_disc(other)


def without_plates(values: Mapping[str, Any], discs: Sequence[object]) -> dict[str, Any]:
    """Values of a case beside others with these discs: if some are given by their modes and others by
    their sizes and material, only sizes and material that differ from Table 1 are kept."""
    is_mixed = any(disc is None for disc in discs) and any(disc is not None for disc in discs)
    if not is_mixed:
        return dict(values)
    kept = {}
    for name, value in values.items():
        is_usual = values.get("disc") is not None or DEFAULTS.get(name) == value
        if name not in PLATE or not is_usual:
            kept[name] = value
    return kept


def _as_disc(disc: Any) -> Disc:
    """A disc, also from the values of a dataset."""
    return disc if isinstance(disc, Disc) else Disc.model_validate(disc)


def _frequencies(disc: object) -> Sequence[float]:
    """The natural frequencies of a disc, Hz."""
    return [omega / math.tau for omega in _as_disc(disc).omega]


def _range_text(frequencies: Sequence[float]) -> str:
    """The lowest and the highest of frequencies with their unit."""
    lowest = f"{min(frequencies):{SHORT}}"
    highest = f"{max(frequencies):{SHORT}}"
    return f"{lowest} to {highest} Hz" if lowest != highest else f"{lowest} Hz"
