"""A warning of a plate with too few modes for friction on its surface, by the growth of steady sliding
with half as many nodal diameters again and one circle more."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable
from typing import NamedTuple

from disc_model.disc.plausibility import is_told, note_told, trial_cases, warn_if
from disc_model.display import counted
from disc_model.errors import DiscModelError
from disc_model.parameters import DEFAULTS, Parameters

RULE = "number of modes"
"""The name of this doubt among those of a case."""
TIMES = 1.5  # as fast a growth with more modes, from which the number is doubted
NEGLIGIBLE = 1e-5  # growth over the angular frequency up to which more modes change nothing
LARGEST = 80  # real modes of the larger model: less than a tenth of a second
MOST_FOR_A_PLATE = 3  # cases of one plate that are compared, unless the first ones tell
MOST_IN_ALL = 20  # and of all plates in a process, which bounds the time that this takes
OF_PLATE = ("a", "b", "h", "nu", "rho")
"""Parameters by which a plate is not the paper's disc, of which the paper varies E alone."""
OF_FAMILY = (*OF_PLATE, "E", "r_0", "n_diameters", "n_circles", "contact_arc", "friction_offset")
"""Parameters of which it depends how many modes are enough."""

_compared: Counter[tuple[object, ...]] = Counter()
"""How many cases of each plate were compared."""


class Growth(NamedTuple):
    """Growth rate of steady sliding, 1/s, and frequency of the mode that grows fastest, Hz; nan if none
    grows."""

    rate: float
    frequency: float


def may_have_few_modes(p: Parameters) -> bool:
    """Whether a case is to be compared with more modes: friction acts on the surface of a plate that is
    not the paper's disc, which has the modes of the paper."""
    if p.disc is not None or p.n_diameters < 1 or p.friction_offset == 0:
        return False
    if all(getattr(p, name) == DEFAULTS[name] for name in OF_PLATE):
        return False
    richer = _richer(p)
    modes = (richer.n_circles + 1) * (2 * richer.n_diameters + 1)
    known = _compared[_family(p)] >= MOST_FOR_A_PLATE or _compared.total() >= MOST_IN_ALL
    return modes <= LARGEST and not known and not is_told(RULE)


def check_few_modes(
    p: Parameters, growth: Callable[[Parameters], Growth], found: Growth | None = None
) -> None:
    """Warn, once in a process, of a case whose steady sliding grows much faster with more modes; arguments
    as of `doubt_of_modes`."""
    warn_if(doubt_of_modes(p, growth, found))


def doubt_of_modes(
    p: Parameters, growth: Callable[[Parameters], Growth], found: Growth | None = None
) -> str:
    """What is said, once in a process, of a case whose steady sliding grows much faster with more modes;
    "" of others.

    growth : computes that of a case
    found : that of this case, if it is known
    """
    if not may_have_few_modes(p):
        return ""
    if found is None:
        with trial_cases():
            found = growth(p)
    if math.isnan(found.rate):
        return ""
    _compared[_family(p)] += 1
    try:
        with trial_cases():
            richer = growth(_richer(p))
    except (DiscModelError, ArithmeticError):  # more modes cannot be computed
        return ""
    if math.isnan(richer.frequency):  # nothing grows, which tells little of other speeds
        return ""
    _compared[_family(p)] = MOST_FOR_A_PLATE
    if not _grows_faster(richer, max(found.rate, 0.0)):
        return ""
    note_told(RULE)
    return _text(p, found, richer)


def _grows_faster(richer: Growth, rate: float) -> bool:
    """Whether sliding grows much faster with more modes than at a rate, and not only by little."""
    matters = richer.rate - rate > NEGLIGIBLE * math.tau * richer.frequency
    return matters and richer.rate > TIMES * rate


def _family(p: Parameters) -> tuple[object, ...]:
    """What cases have in common of which the number of modes is doubted together."""
    return tuple(getattr(p, name) for name in OF_FAMILY)


def _richer(p: Parameters) -> Parameters:
    """The case with half as many nodal diameters again, and one circle more."""
    diameters = min(math.ceil(1.5 * p.n_diameters), 60)
    return p.replace(n_diameters=diameters, n_circles=min(p.n_circles + 1, 20))


def _text(p: Parameters, found: Growth, richer: Growth) -> str:
    """What is said of a case whose steady sliding grows much faster with more modes."""
    own = "does not grow"
    if not math.isnan(found.frequency):
        own = f"grows at {_growth_text(found)}"
    text = f"with {_size_text(p)} steady sliding {own}, and with {_size_text(_richer(p))} at "
    text += f"{_growth_text(richer)}: choose_modes(case, quantity='sliding_growth') finds how many "
    text += "modes are enough"
    if p.contact_arc == 0:
        text += "; under a point no number is: give contact_arc, the arc of the pad"
    return text


def _growth_text(growth: Growth) -> str:
    """A growth rate and a frequency in words."""
    return f"{growth.rate:.3g}/s ({growth.frequency:.4g} Hz)"


def _size_text(p: Parameters) -> str:
    """The number of modes of a plate in words."""
    return f"{counted(p.n_diameters, 'diameter')} and {counted(p.n_circles, 'circle')}"
