"""What quantities of the motion after a transient share; in a module of its own, since others need no simulation."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from disc_model.simulation.case import Start
from disc_model.studies.quantity import Point, Quantity
from disc_model.units import Seconds, Tolerance

if TYPE_CHECKING:
    from disc_model.simulation.states import State


class AfterTransient(Start, Quantity):
    """A quantity of the motion after a transient.

    transient : s, left out
    """

    tol: Tolerance = 1e-10
    transient: Seconds

    motions: ClassVar = 8
    motion: ClassVar = "After the transient."

    def state_at(self, point: Point) -> State:
        """State at the end of the transient; raises `SimulationError` if the motion does not reach it."""
        from disc_model.simulation.api import state_after

        return state_after(point.parameters, point.start, self.transient, self.tol)
