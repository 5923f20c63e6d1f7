"""Names of modes by their nodal diameters, where lines of a figure begin or end."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from disc_model.figures.arrays import Array, Indices


class Named(NamedTuple):
    """Modes that share a name, since they are too near each other: their indices, and the name."""

    modes: Indices
    name: str


def name_of(*diameters: int) -> str:
    """Name of modes by their nodal diameters; -1: in the plane."""
    names = ["in-plane"] if min(diameters) < 0 else []
    numbers = [str(number) for number in sorted({*diameters}) if number >= 0]
    if numbers:
        names.append(f"l = {', '.join(numbers)}")
    return ", ".join(names)


def named_modes(diameters: Array, heights: Array, apart: float) -> Iterator[Named]:
    """Modes, ascending by height, and their names; those nearer than `apart` to the one below share
    one."""
    known = np.argsort(heights)[: int(np.isfinite(heights).sum())]
    steps = np.flatnonzero(np.diff(heights[known]) > apart) + 1
    for part in np.split(known, steps):
        if part.size:
            yield Named(part, name_of(*diameters[part].astype(int).tolist()))
