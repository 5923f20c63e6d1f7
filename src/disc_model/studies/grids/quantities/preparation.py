"""Starting a motion where that of another case has led."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.result import State

if TYPE_CHECKING:
    from disc_model.studies.grids.quantities.schema import Lead


def prepared(p: Parameters, options: Lead) -> State | None:
    """The state that a point starts from, at time 0; None is the published start.

    Raises
    ------
    SimulationError, ParameterError
        If the other motion ends early, or its parameters are not right.
    """
    if options.prepare is None:
        return None
    return _end_of(p.replace(**options.prepare.parameters), options.prepare.time, options.tol)


@lru_cache(maxsize=8)
def _end_of(p: Parameters, time: float, tol: float) -> State:
    return simulate(p, time, tol=tol).raise_for_status().final_state.replace(time=0.0, time_low=0.0)
