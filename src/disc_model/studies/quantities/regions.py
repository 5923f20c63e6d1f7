"""Outcome of the static start over two parameters, refined at borders, and the cycle at every
point."""

from collections.abc import Sequence
from typing import Annotated, Any, ClassVar

from pydantic import Field

from disc_model.data.variables import OF_QUANTITIES
from disc_model.studies.quantity import COME_TO, COME_TO_BY, Made, Point, Quantity, State
from disc_model.units import Count, Seconds, Tolerance


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
    COLUMNS: ClassVar = OF_QUANTITIES["regions"]["columns"]

    def state_at(self, point: Point) -> State:
        from disc_model.simulation.api import simulate
        from disc_model.stability.follower import find_outcome

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
