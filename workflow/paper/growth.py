"""Growth rates that rows of the ledger compute, each once."""

from functools import cache

from disc_model.parameters import Parameters
from disc_model.stability.cycle import floquet
from disc_model.stability.sliding import steady_sliding


@cache
def growth_of(p: Parameters) -> float:
    """Return the largest growth rate of small disturbances of the stick-slip cycle, in 1/s.

    The cycle is the one near the static start; the rate is nan where there is none.
    """
    return floquet(p).growth_rate


@cache
def sliding_growth(p: Parameters) -> float:
    """Return the largest growth rate of small disturbances of steady sliding, in 1/s.

    It is nan without an equilibrium.
    """
    return steady_sliding(p).growth_rate
