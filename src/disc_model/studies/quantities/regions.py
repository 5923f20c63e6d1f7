"""Outcome of the static start over two parameters, refined at borders, and the cycle at every
point."""

from collections.abc import Sequence
from typing import Annotated, Any, ClassVar

from pydantic import Field

from disc_model.data.variables import Variable
from disc_model.studies.quantity import (
    COME_TO,
    COME_TO_BY,
    START_OUTCOME,
    STATUS,
    TIMED_SEPARATION,
    Made,
    Point,
    Quantity,
    State,
)
from disc_model.units import Count, Seconds, Tolerance

METHODS = ("none", "multipliers", "simulation", "inferred", "extrapolation")
JOINED = ("no", "yes")
_CONTINUES = "whether the cycle continues into the next point's along the plane's"
CYCLES = ("no_cycle", "followed", "nearby_only", "steady_sliding", "at_rest", "unstable_sliding")
"""The last one where stick ends for good, and sliding is unstable: the search for a cycle has not failed there."""


class Regions(Quantity):
    """Outcomes over a plane of two parameters. Only separation is inferred, within cells that
    separate wherever they are computed."""

    tol: Tolerance = 1e-10
    """tolerance of simulations: error of event times after a second of motion"""
    horizon: Seconds
    """longest simulated time"""
    extrapolate: bool = True
    """whether slow departures from cycles are extrapolated, which halves the time; their separations are not timed"""
    initial_cell_size: Annotated[Count, Field(ge=1, le=1000)] = 8
    """side of the first cells, in intervals of the grid"""
    points_per_job: ClassVar = 800
    motions: ClassVar = 4
    motion: ClassVar = COME_TO
    motion_by: ClassVar = COME_TO_BY
    tiled: ClassVar = True
    COLUMNS: ClassVar = {
        "status": STATUS,
        "outcome": START_OUTCOME,
        "method": Variable(
            "1",
            "how the outcome is known; extrapolation: simulated from where a departure ceases to be linear; "
            "inferred: separation, as at the cell's corners and middle",
            METHODS,
        ),
        "first_separation": TIMED_SEPARATION,
        "simulated_time": Variable("s", "simulated time"),
        "cycle": Variable(
            "1",
            "whether the static start follows the cycle found; without one, what it does",
            CYCLES,
        ),
        "growth_rate": Variable(
            "s-1", "growth rate of disturbances of the cycle that the static start follows"
        ),
        "period": Variable("s", "period of the cycle"),
        "releases": Variable("1", "number of stick releases in its period", whole=True),
        "period_ratio": Variable(
            "1", "period of the cycle over that of the lowest mode of disc and slider at rest"
        ),
        "branch_continues_first": Variable("1", f"{_CONTINUES} first dimension", JOINED),
        "branch_continues_second": Variable("1", f"{_CONTINUES} second dimension", JOINED),
        "other_cycles": Variable(
            "1", "number of other cycles known, followed from neighbours", whole=True
        ),
    }

    def state_at(self, point: Point) -> State:
        from disc_model.simulation.api import simulate
        from disc_model.stability.outcome import find_outcome

        p = point.parameters
        result = find_outcome(p, self.horizon, tol=self.tol)
        if (
            result.near is not None
            and result.near.cycle.stable
            and result.near.cycle.state is not None
        ):
            return result.near.cycle.state
        # to the horizon, or to what the separation leads to
        end = self.horizon if result.state is None else result.state.time + 5.0
        return (
            simulate(p, end, tol=self.tol, initial_state=result.state)
            .raise_for_status()
            .final_state
        )

    def compute_tile(
        self, points: Sequence[Sequence[Made]], sampled: Sequence[tuple[int, int]]
    ) -> list[list[Any]]:
        """Rows and messages of a tile, of which at least the places `sampled` are computed."""
        from disc_model.studies.refinement import Tile, TileOptions

        options = TileOptions(self.horizon, self.tol, self.extrapolate, self.initial_cell_size)
        tile = Tile(points, sampled, options)
        tile.compute()
        return tile.rows()
