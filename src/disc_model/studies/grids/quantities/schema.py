"""The quantities that a grid study can compute, and what its file may say of each. Imports nothing heavy.

A job is told all values of the options, so that nothing here is among the sources of its result: a quantity computes
from the values alone, and what they amount to is worked out in its own file.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Annotated, Any, Literal, NamedTuple, Self

from pydantic import AfterValidator, Field, model_validator

from disc_model.data.variables import SAMPLE
from disc_model.parameters import Count, CycleTolerance, Finite, Positive, Real, Strict, Tolerance
from disc_model.simulation.case import Start
from disc_model.studies.grids.dimensions import MOST, Range, values_of
from disc_model.studies.grids.distributions import Sampled

Deviation = Annotated[Real, Field(ge=0, le=1e-2)]

# ----------------------------------------------------------------------------------------------------
# Parts


class SettlingOptions(Strict):
    """When a motion without separation may be left before the horizon; see `disc_model.stability.attractor`.

    settled : successive cycles that agree this well, relative, end the simulation; 0 never does
    near : a motion this near to a stable stick-slip cycle, relative, and ever nearer, ends it too; 0 never does
    """

    tol: Tolerance = 1e-10
    settled: Deviation = 1e-9
    near: Deviation = 1e-4


class Lead(Start):
    """Where a motion starts, see `disc_model.simulation.case`, and how it is computed."""

    tol: Tolerance = 1e-10


# ----------------------------------------------------------------------------------------------------
# Options of each quantity


class OutcomeOptions(Lead, SettlingOptions):
    """One simulation.

    horizon : s
    late : s, length of the last stretch, over which ranges and shares of the phases are taken
    after_separation : s that are simulated beyond the first separation, so that the late stretch shows its regime
    """

    horizon: Positive
    late: Positive = 1.0
    after_separation: Positive = 5.0

    @model_validator(mode="after")
    def _room(self) -> Self:
        if self.late > min(self.after_separation, self.horizon):
            raise ValueError("late must be <= after_separation and <= horizon")
        return self


class RegionsOptions(Strict):
    """Outcomes over a plane, refined where they change.

    horizon : s
    coarse : intervals of the grid along the side of a cell, before it is divided
    """

    tol: Tolerance = 1e-8
    horizon: Positive
    coarse: Annotated[Count, Field(ge=1, le=1000)] = 8


class CriticalSpeedOptions(SettlingOptions):
    """Scan of the speed, then bisection of each interval in which separation begins or ends.

    horizons : s, each has its own critical speed; all come from the same simulations
    scan : rad/s
    precision : rad/s, width of the last interval; the scan's step must be a multiple
    max_crossings : room for that many crossings at each horizon
    """

    horizons: Annotated[tuple[Positive, ...], Field(min_length=1), AfterValidator(lambda h: tuple(sorted(set(h))))]
    scan: Range
    precision: Positive = 0.1
    max_crossings: Annotated[Count, Field(ge=1, le=10_000)] = 12

    @model_validator(mode="after")
    def _lattice(self) -> Self:
        if self.scan.scale != "linear":
            raise ValueError("scan must be linear")
        step = (self.scan.stop - self.scan.start) / self.scan.intervals / self.precision
        if not math.isfinite(step) or abs(step - round(step)) > 1e-6 or round(step) < 1:
            raise ValueError("the scan's step must be a multiple of precision")
        return self


class FloquetOptions(Strict):
    """The stick-slip cycle of each point."""

    tol: CycleTolerance = 1e-12


class HysteresisOptions(Strict):
    """Sweep of the speed up from the published start and down again, each speed going on where the last one ended.

    scan : rad/s
    dwell : s at each speed
    late : s, the last stretch of it, over which separations, ranges and shares of the phases are taken
    """

    tol: Tolerance = 1e-10
    scan: Range
    dwell: Positive
    late: Positive = 5.0

    @model_validator(mode="after")
    def _room(self) -> Self:
        if self.late > self.dwell:
            raise ValueError("late must be <= dwell")
        return self


class RampsOptions(Strict):
    """The speed goes steadily up from the published start, stays, goes down and stays, once for each rate.

    low, high : rad/s, between which it goes
    rates : rad/s^2
    stay : s, at the highest speed, and at the lowest one after the way down
    """

    tol: Tolerance = 1e-10
    low: Positive
    high: Positive
    rates: Range
    stay: Positive = 60.0

    @model_validator(mode="after")
    def _rising(self) -> Self:
        if not self.low < self.high:
            raise ValueError("low must be < high")
        if not self.rates.start > 0:
            raise ValueError("rates must be > 0")
        return self


class BifurcationOptions(Lead):
    """Samples of what the motion has settled to.

    section : once a turn of the drive; or at switches, each separation if there are any, else each release of stick: a
        periodic motion then shows as many points as its period has switches
    transient : s, left out; at switches it is doubled until the motion is known to repeat
    longest : s, of the transient then, at most
    samples : number of turns, or of switches, sampled after it
    theta : rad, the disc's point whose displacement is sampled once a turn
    """

    section: Literal["turn", "switch"] = "turn"
    transient: Positive
    longest: Positive = 240.0
    samples: Annotated[Count, Field(ge=1, le=MOST)] = 50
    theta: Finite = 1.0


class LyapunovOptions(Lead):
    """The largest Lyapunov exponents of the motion but for the one along it, which is zero.

    transient : s, left out
    duration : s, over which the rates are averaged
    exponents : how many, 1 to 7
    interval : s, between orthonormalisations
    """

    transient: Positive
    duration: Positive
    exponents: Annotated[Count, Field(ge=1, le=7)] = 2
    interval: Positive = 0.01


class BasinsOptions(Lead):
    """What many starts come to; see `disc_model.stability.attractor`.

    energies : J, of the kicks that are added to the start in random directions; 0 adds nothing
    starts : of each energy
    seed : whole number; directions follow from it and from the place of the energy and the number of the start
    horizon : s
    near : a motion whose range is within this of a known attractor's, relative, and comes ever closer, is left; 0: all
        are followed to the horizon
    confidence : of the intervals of shares
    bisected : number of directions along which the least kick is looked for, those that separate at the least energies
    precision : relative, of the least kick
    """

    energies: Annotated[tuple[Annotated[Real, Field(ge=0, allow_inf_nan=False)], ...], Field(min_length=1)] = (0.0,)
    starts: Annotated[Count, Field(ge=1, le=MOST)] = 1
    seed: Annotated[Count, Field(ge=0)] = 1
    horizon: Positive = 200.0
    near: Annotated[Real, Field(ge=0, le=0.25)] = 0.1
    confidence: Annotated[Real, Field(gt=0, lt=1)] = 0.95
    bisected: Annotated[Count, Field(ge=0, le=1000)] = 1
    precision: Annotated[Real, Field(gt=1e-6, le=1)] = 0.05

    @model_validator(mode="after")
    def _different(self) -> Self:
        if list(self.energies) != sorted(set(self.energies)):
            raise ValueError("energies must ascend")
        if self.starts > 1 and 0.0 in self.energies:
            raise ValueError("starts must be 1 where an energy is 0, since no direction tells them apart")
        return self


Free = Literal["Omega", "N", "D_star", "c", "c_p", "k", "k_p", "E", "m"]


class StabilityCurvesOptions(Strict):
    """Neutral curves and folds of the stick-slip cycle in the plane of two parameters.

    x, y : the parameters
    x_range : from, to; the cycle is looked for at `points` places of it
    y_lines : values of y along which that is done; curves are followed from the first to the last, widened by `margin`
    margin : of the range of y, beyond the lines at both ends
    longest : arclength of the longest step along a curve
    max_points : of a curve, each way from where it was met
    max_curves : room for that many
    """

    x: Free = "Omega"
    y: Free = "N"
    x_range: tuple[Finite, Finite]
    y_lines: Range
    margin: Annotated[Real, Field(ge=0, le=1)] = 0.0
    points: Annotated[Count, Field(ge=2, le=10_000)] = 31
    longest: Positive = 0.1
    max_points: Annotated[Count, Field(ge=2, le=10_000)] = 100
    max_curves: Annotated[Count, Field(ge=1, le=1000)] = 24
    tol: CycleTolerance = 1e-12

    @model_validator(mode="after")
    def _plane(self) -> Self:
        if self.x == self.y:
            raise ValueError("x and y must differ")
        if not self.x_range[0] < self.x_range[1]:
            raise ValueError("x_range must ascend")
        return self

    @property
    def scans(self) -> tuple[str, ...]:
        """Parameters varied by the quantity itself."""
        return (self.x, self.y)


class SensitivityOptions(Sampled):
    """The stick-slip cycle at samples of distributed parameters, and what becomes of the published start.

    outcomes : of so many samples, the first ones, the motion is followed as well
    horizon : s, to which it is followed
    cap : 1/s, growth rates above which count as this in their indices: a few violent ones would be all the variance
    tol : of the cycles; motion_tol : of the motions
    """

    outcomes: Annotated[Count, Field(ge=0)] = 0
    horizon: Positive = 500.0
    cap: Positive = 0.5
    tol: CycleTolerance = 1e-12
    motion_tol: Tolerance = 1e-10


class CampbellOptions(Strict):
    """Frequencies and growth rates of steady sliding and of the stick-slip cycle.

    modes : room for that many, the lowest in frequency
    window : Hz, on either side of a crossing, within which growth rates are looked at
    rise : 1/s, of a growth rate within the window over that at its ends, from which it counts as one
    max_crossings : room for that many
    """

    modes: Annotated[Count, Field(ge=1, le=1000)] = 12
    window: Positive = 1.0
    rise: Positive = 0.01
    max_crossings: Annotated[Count, Field(ge=1, le=10_000)] = 100
    tol: CycleTolerance = 1e-12


# ----------------------------------------------------------------------------------------------------
# All of them


class Quantity(NamedTuple):
    """An entry: the schema of the options, what a point costs, the parameters that the quantity varies by itself, its
    motions, and whether it needs a whole tile of a plane at once.

    ``seconds`` is about the processor time of a point with given options, s, measured at points of the paper's study.
    Options with a property ``scans`` name those parameters themselves. ``motions`` is how many values of each axis get
    a motion to be looked at (`disc_model.studies.grids.motions`): the fewer, the more one costs. 0: none.
    ``motion`` says what they show: where the quantity's ``state_at`` lets the motion go on. ``over`` is the dimension
    over which `disc_model.studies.grids.summaries` summarises a merged study, which has to have it. ``tasks`` are those
    of `disc_model.kernels` that it needs kernels for.
    """

    options: type[Strict]
    seconds: Callable[[Any], float]
    scans: tuple[str, ...] = ()
    motions: int = 0
    motion: str = ""
    tiled: bool = False
    over: str = ""
    tasks: tuple[str, ...] = ("simulate", "floquet")

    def scanned(self, options: Strict | None) -> tuple[str, ...]:
        """Parameters that the quantity varies by itself, given its options."""
        return tuple(getattr(options, "scans", self.scans))

    @property
    def starts(self) -> bool:
        """Whether it follows motions that may start elsewhere than from the published start."""
        return issubclass(self.options, Start)

    def batch_size(self, options: Strict) -> int:
        """How many points make a batch, if a study does not say."""
        return max(1, round(WORK / self.seconds(options)))


WORK = 20.0
"""Of a batch, s of processor time: its job costs about 1 s in itself. Three times as much does no harm."""
# As measured, s. A new value cuts all studies of a quantity anew that do not say `batch.size`.
SIMULATED = 7e-4
"""A simulated second: 3e-4 in contact, twice or three times that where contact is lost again and again."""
CYCLE = 2.5e-3
"""To find a cycle and its multipliers."""

COME_TO = (
    "What the motion has come to: a while after the first separation, on the cycle it settled to, or at the horizon."
)
QUANTITIES = {
    "outcome": Quantity(OutcomeOptions, lambda o: SIMULATED * o.horizon / 2, motions=4, motion=COME_TO),
    "regions": Quantity(RegionsOptions, lambda o: WORK, motions=4, motion=COME_TO, tiled=True),
    "critical_speed": Quantity(
        CriticalSpeedOptions, lambda o: SIMULATED * o.scan.intervals * o.horizons[-1] / 9, scans=("Omega",)
    ),
    "floquet": Quantity(
        FloquetOptions, lambda o: CYCLE, motions=7, motion="The stick-slip cycle itself, stable or not."
    ),
    "hysteresis": Quantity(HysteresisOptions, lambda o: SIMULATED * 2 * o.scan.intervals * o.dwell, scans=("Omega",)),
    "ramps": Quantity(
        RampsOptions,
        lambda o: SIMULATED * sum(2 * ((o.high - o.low) / rate + o.stay) for rate in values_of(o.rates)),
        scans=("Omega",),
        tasks=("simulate", "ramp"),
    ),
    "basins": Quantity(BasinsOptions, lambda o: SIMULATED * len(o.energies) * o.starts * o.horizon / 2),
    "bifurcation": Quantity(
        BifurcationOptions,
        lambda o: SIMULATED * (o.transient + o.longest / 2),
        motions=8,
        motion="After the transient.",
    ),
    "lyapunov": Quantity(
        LyapunovOptions,
        lambda o: SIMULATED * (o.transient + 20 * o.exponents * o.duration),
        motions=8,
        motion="After the transient.",
    ),
    "stability_curves": Quantity(StabilityCurvesOptions, lambda o: WORK),
    "sensitivity": Quantity(
        SensitivityOptions,
        # the same for more samples, whose batches are to stay
        lambda o: CYCLE * (2 + len(o.distributions)) + SIMULATED * o.horizon / 4 * (o.outcomes > 0),
        over=SAMPLE,
    ),
    "campbell": Quantity(CampbellOptions, lambda o: 1.5 * CYCLE, over="Omega"),
}


def module_of(name: str) -> str:
    """Module that computes a quantity, of the same name."""
    return f"{__package__}.{name}"
