"""What legends call the discs of several cases on the same axes, which may be plates, or tables of modes."""

from collections.abc import Mapping, Sequence
from typing import Any

from disc_model.display import counted, frequencies_text
from disc_model.modal_disc import Disc
from disc_model.parameters import DEFAULTS, PLATE, PLATE_NAME


def disc_name(disc: object, others: Sequence[object]) -> str:
    """What a legend calls a disc beside others: by the number of its modes, and by their frequencies where
    another one has as many."""
    if disc is None:
        return PLATE_NAME
    frequencies = _as_disc(disc).omega
    name = f"disc of {counted(len(frequencies), 'mode')}"
    range_text = frequencies_text(frequencies)
    for other in others:
        if other is None or same_disc(disc, other):
            continue
        beside = _as_disc(other).omega
        if len(beside) == len(frequencies) and frequencies_text(beside) != range_text:
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
