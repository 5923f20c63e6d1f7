"""How many modes a case needs: `choose_modes` finds the smallest model that agrees with larger ones."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache
from itertools import product
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from disc_model.arrays import Array
from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import coupled_frequencies, mode_arrays
from disc_model.errors import DiscModelError, require
from disc_model.parameters import Parameters
from disc_model.stability.cycle import floquet
from disc_model.stability.sliding import steady_sliding
from disc_model.units import Finite, checked

Size = tuple[int, int]
"""Size of a model: diameters and circles."""

FREQUENCIES = "frequencies"
DEFAULT_TOLERANCES = {FREQUENCIES: 1e-3, "growth": 1e-2, "sliding_growth": 1e-2}
# Least tolerance, relative: the coupled frequencies of `RICH` change as much with more modes (5e-5 as
# published, 2e-4 orthonormal, against 30 diameters and 8 circles).
TRUSTED = 1e-4
RICH = (20, 6)  # diameters and circles of the reference model for frequencies
BAND = 2.0  # upper end of the band of compared frequencies, relative to the lowest frequency of the disc
# diameters and circles of the candidates by a growth rate; further ones for steady sliding, which takes
# no simulation
CANDIDATES = ((1, 0), (2, 0), (3, 0), (4, 0), (6, 0), (8, 0), (6, 1), (8, 1))
LARGER = ((10, 1), (10, 2), (14, 2), (10, 3), (14, 3))


class UndecidedModes(DiscModelError):
    """No number of modes could be chosen; the message has the least error."""


@checked
def choose_modes(
    case: Parameters,
    tolerance: Annotated[Finite, Field(ge=TRUSTED)] | None = None,
    *,
    quantity: Literal["frequencies", "growth", "sliding_growth"] = "frequencies",
) -> Parameters:
    """Find the fewest real-valued modes with which a quantity's error is within ``tolerance``.

    A growth rate is that at the case's own speed and preload. More modes may take part at higher speeds, so
    choose at the highest speed of interest.

    Parameters
    ----------
    case : the case, whose n_diameters and n_circles are ignored.  With ``contact_compliance="residual"`` each model has
        the flexibility of the modes that it leaves out
    tolerance : relative, at least 1e-4; None is 1e-3 for frequencies, 1e-2 for a growth rate
    quantity : "frequencies", the coupled frequencies of disc and slider at rest up to twice the lowest one of the disc,
        compared with those of 20 diameters and 6 circles; "growth", the growth rate of the stick-slip cycle, which
        takes simulations, or "sliding_growth", that of steady sliding, each compared with two models of twice the
        diameters, of which one has a circle more

    Returns
    -------
    Parameters
        The case with the n_diameters and n_circles that were chosen.

    Raises
    ------
    ParameterError
        If the quantity is unknown, the tolerance is below 1e-4, or the disc is given by its modes.
    disc_model.mode_choice.UndecidedModes
        If no model meets the tolerance. The growth rate does not converge where friction acts on the surface at a
        point: give the arc of the pad.

    Examples
    --------
    >>> import disc_model as dm
    >>> dm.choose_modes(dm.Parameters(N=385, Omega=15.1), 1e-3).n_diameters
    3
    """
    rule = "must be left out: modes of a plate are chosen"
    require((case.disc is None, "disc", case.disc, rule))
    asked = tolerance or DEFAULT_TOLERANCES[quantity]
    least = math.inf
    for size, *larger in _candidates(quantity):
        chosen = _resized(case, size)
        error = max(error_of(quantity, chosen, _resized(case, other)) for other in larger)
        if error <= asked:
            return chosen
        least = min(least, error)
    advice = "enlarge the tolerance"
    if case.friction_offset != 0 and case.contact_arc == 0:
        advice = "friction on the surface at a point does not converge: give contact_arc"
    best = f"no model has the {quantity} of larger ones, the best errs by {least:.2g}"
    raise UndecidedModes(f"n_diameters: undecided: {best}; {advice}")


def _candidates(quantity: str) -> Iterator[tuple[Size, ...]]:
    """Candidates, each with the larger models for comparison."""
    if quantity == FREQUENCIES:
        # by the number of real modes, of which pairs are two
        every = product(range(RICH[0] + 1), range(RICH[1] + 1))
        for size in sorted(every, key=lambda size: ((size[1] + 1) * (2 * size[0] + 1), size[1])):
            if size != RICH:
                yield size, RICH
        return
    sizes = [*CANDIDATES]
    if quantity == "sliding_growth":
        sizes += LARGER
    for l, c in sizes:
        yield (l, c), (2 * l, c), (2 * l, c + 1)


def _resized(p: Parameters, size: Size) -> Parameters:
    """The case with the modes of a size."""
    return p.replace(n_diameters=size[0], n_circles=size[1])


def error_of(quantity: str, p: Parameters, larger: Parameters) -> float:
    """Relative error of a quantity against a larger model: the largest one of coupled frequencies up to
    `BAND` times the disc's lowest one, or that of a growth rate; infinite if a value is missing."""
    mine, right = (_values(quantity, case) for case in (p, larger))
    if quantity == FREQUENCIES:
        right = right[right <= BAND * float(mode_arrays(larger).omega.min())]
    if mine.size < right.size:
        return math.inf
    mine = mine[: right.size]
    if np.array_equal(mine, right):
        return 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        error = float(np.max(np.abs(mine / right - 1.0)))
    return error if math.isfinite(error) else math.inf


@lru_cache(maxsize=128)  # a larger model is the same for many, and may be a candidate later
def _values(quantity: str, p: Parameters) -> Array:
    """Coupled frequencies of a case, rad/s, or the growth rate of its stick-slip cycle or of steady
    sliding, 1/s, nan without it."""
    if quantity == FREQUENCIES:
        return coupled_frequencies(p, contact_compliance(p))
    if quantity == "growth":
        return np.array([floquet(p).growth_rate])
    return np.array([steady_sliding(p).growth_rate])
