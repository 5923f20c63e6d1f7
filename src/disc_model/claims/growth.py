"""Growth rates of the stick-slip cycle, for claims about stability; computed once per case and process."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

from disc_model.claims.model import CaseView, Missing
from disc_model.parameters import Parameters

if TYPE_CHECKING:
    from disc_model.stability.cycle import FloquetResult


@lru_cache(maxsize=256)
def cycle_of(p: Parameters) -> FloquetResult:
    """The stick-slip cycle near the published start, stable or not; raises `Missing` if there is none."""
    from disc_model.stability.cycle import CycleStatus, floquet

    found = floquet(p)
    if found.status is not CycleStatus.OK:
        raise Missing(f"no stick-slip cycle: {found.message}")
    return found


def rate(case: CaseView) -> float:
    """Largest growth rate of small disturbances of the case's stick-slip cycle, 1/s; raises `Missing`."""
    return cycle_of(case.parameters).growth_rate


def in_words(case: CaseView) -> str:
    """The same in words; that there is no cycle, if so."""
    try:
        return f"growth {rate(case):+.4f}/s"
    except Missing:
        return "no stick-slip cycle"
