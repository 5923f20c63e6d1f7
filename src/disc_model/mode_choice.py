"""How many modes a case needs: `choose_modes`. It is the smallest model that agrees with larger ones; a
table is never compared with itself, because nothing tells whether all its modes are enough.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import product
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from disc_model.arrays import Array
from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import coupled_frequencies, mode_arrays
from disc_model.display import counted
from disc_model.errors import DiscModelError
from disc_model.parameters import Parameters
from disc_model.stability.cycle import floquet
from disc_model.stability.sliding import steady_sliding
from disc_model.units import Finite, checked

Size = tuple[int, ...]
"""Size of a model: (diameters, circles), or (modes,) of a table."""

FREQUENCIES = "frequencies"
# Least tolerance, relative: the coupled frequencies of `RICH` change as much with more modes (5e-5 as
# published, 2e-4 orthonormal, against 30 diameters and 8 circles).
TRUSTED = 1e-4
RICH = (20, 6)  # diameters and circles of the reference model for frequencies
BAND = 2.0  # upper end of the band of compared frequencies, relative to the lowest frequency of the disc
# diameters and circles of the candidates by a growth rate; further ones for steady sliding, which takes
# no simulation
CANDIDATES = ((1, 0), (2, 0), (3, 0), (4, 0), (6, 0), (8, 0), (6, 1), (8, 1))
LARGER = ((10, 1), (10, 2), (14, 2), (10, 3), (14, 3))


@dataclass(frozen=True)
class ModeChoice:
    """The smallest model that meets a tolerance, and the basis of the choice.

    Attributes
    ----------
    parameters : the case with the chosen n_diameters and n_circles, or with the first modes of its table
    quantity, tolerance : as asked for
    error : relative, of the coupled frequencies in the band, or of the growth rate
    rich : (diameters, circles) of the largest model in the comparison; (modes,) for a table
    errors : of each model that was tried, by size as in `rich`
    """

    parameters: Parameters
    quantity: str
    tolerance: float
    error: float
    rich: Size
    errors: Mapping[Size, float]

    @property
    def modes(self) -> int:
        """Number of real-valued modes: a pair, cosine and sine, counts as two."""
        return int(np.sum(1 + (mode_arrays(self.parameters).diameters > 0)))

    def __repr__(self) -> str:
        modes = counted(self.modes, "real mode")
        return f"ModeChoice({modes}, by {self.quantity}, error {self.error:.2g})"


class UndecidedModes(DiscModelError):
    """No number of modes could be chosen; the message has the least error."""


@checked
def choose_modes(
    case: Parameters,
    tolerance: Annotated[Finite, Field(ge=TRUSTED)] | None = None,
    *,
    quantity: Literal["frequencies", "growth", "sliding_growth"] = "frequencies",
) -> ModeChoice:
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
        diameters, of which one has a circle more. Modes of a table are compared with the whole table, and by a
        growth rate with twice as many too

    Returns
    -------
    ModeChoice
        Its `parameters` are the case with the modes that were chosen.

    Raises
    ------
    ParameterError
        If the quantity is unknown, or the tolerance is below 1e-4.
    disc_model.mode_choice.UndecidedModes
        If no model meets the tolerance, or too few modes of a table are left to tell. The growth rate does not
        converge where friction acts on the surface at a point: give the arc of the pad.

    Examples
    --------
    >>> import disc_model as dm
    >>> dm.choose_modes(dm.Parameters(N=385, Omega=15.1), 1e-3).parameters.n_diameters
    3
    """
    asked = tolerance or 1e-2
    error_between: Callable[[Parameters, Parameters], float] = partial(_rate_error, quantity)
    if quantity == FREQUENCIES:
        asked = tolerance or 1e-3
        error_between = frequency_error
    errors: dict[Size, float] = {}
    for size, *larger in _compared(case, quantity):
        chosen = _resized(case, size)
        errors[size] = max(error_between(chosen, _resized(case, other)) for other in larger)
        if errors[size] <= asked:
            return ModeChoice(chosen, quantity, asked, errors[size], larger[-1], errors)
    advice = "enlarge the tolerance"
    if case.disc is not None:
        advice = "give a table with more modes, or a larger tolerance"
    elif case.friction_offset != 0 and case.contact_arc == 0:
        advice = "friction on the surface at a point does not converge: give contact_arc"
    least = min(errors.values(), default=math.inf)
    best = f"no model has the {quantity} of larger ones, the best errs by {least:.2g}"
    raise UndecidedModes(f"n_diameters: undecided: {best}; {advice}")


def _compared(p: Parameters, quantity: str) -> Iterator[tuple[Size, ...]]:
    """Candidates, each with the larger models for comparison."""
    if p.disc is not None:
        # at least one of the first modes of a table must move under the slider
        count = 1 + next(i for i, each in enumerate(p.disc.amplitude) if each)
        most = len(p.disc.omega)
        while count < most:
            yield tuple(dict.fromkeys([(count,), (min(2 * count, most),), (most,)]))
            count += 1 if quantity == FREQUENCIES else (count + 1) // 2
    elif quantity == FREQUENCIES:
        every = product(range(RICH[0] + 1), range(RICH[1] + 1))
        # by the number of real modes, of which pairs are two
        for size in sorted(every, key=lambda size: ((size[1] + 1) * (2 * size[0] + 1), size[1]))[
            :-1
        ]:
            yield size, RICH
    else:
        for l, c in CANDIDATES + (LARGER if quantity == "sliding_growth" else ()):
            yield (l, c), (2 * l, c), (2 * l, c + 1)


# ---- Models of a case


def _resized(p: Parameters, size: Size) -> Parameters:
    """The case with the modes of a size."""
    if p.disc is not None:
        return p.replace(disc=p.disc.first(*size))
    return p.replace(n_diameters=size[0], n_circles=size[1])


def frequency_error(p: Parameters, rich: Parameters) -> float:
    """Largest relative error, against `rich`, of the coupled frequencies up to `BAND` times the
    disc's lowest one; 1 if one is missing."""
    mine, right = map(_frequencies, (p, rich))
    right = right[right <= BAND * float(mode_arrays(rich).omega.min())]
    if mine.size < right.size:
        return 1.0
    return min(1.0, float(np.max(np.abs(mine[: right.size] / right - 1.0), initial=0.0)))


@lru_cache(maxsize=8)  # the larger model is the same for all
def _frequencies(p: Parameters) -> Array:
    """Coupled frequencies of a case, rad/s."""
    return coupled_frequencies(p, contact_compliance(p))


def _rate_error(quantity: str, p: Parameters, larger: Parameters) -> float:
    """Relative error of a growth rate; infinite if one or both models have no such motion."""
    mine, right = (_growth_rate(quantity, case) for case in (p, larger))
    if mine == right:
        return 0.0
    if math.isfinite(mine) and math.isfinite(right) and right:
        return abs(mine / right - 1.0)
    return math.inf


@lru_cache(maxsize=128)  # a larger model may be a candidate later
def _growth_rate(quantity: str, p: Parameters) -> float:
    """Growth rate of the stick-slip cycle or of steady sliding, 1/s; nan without it."""
    if quantity == "growth":
        return floquet(p).growth_rate
    return steady_sliding(p).growth_rate
