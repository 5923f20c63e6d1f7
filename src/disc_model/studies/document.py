"""The model of a study file: `Document`.

Rules within one part are checked here, rules between parts in `disc_model.studies.study`. The module imports nothing
heavy. A job receives the values of all options, so this module is not among the sources of its result.

``python -m disc_model.studies.document`` prints the JSON Schema, with which editors complete and check study files. The
shipped copy is ``workflow/schemas/study.schema.json``.
"""

import json
import math
import re
from collections.abc import Callable, Collection, Mapping
from itertools import chain
from typing import Annotated, Any, ClassVar, Literal, NamedTuple, Self, TypeVar, Union

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    Discriminator,
    Field,
    PlainValidator,
    StringConstraints,
    Tag,
    WithJsonSchema,
    WrapValidator,
    create_model,
    model_validator,
)
from pydantic.json_schema import GenerateJsonSchema, NoDefault, models_json_schema

from disc_model.data.variables import BESIDE_WINDOWS, PERTURBATIONS, SAMPLE, SCALARS, START, attributes
from disc_model.disc.truncation import CHOSEN_BY, FREQUENCIES, TRUSTED, ModeRequest, by_frequencies, read_asked
from disc_model.errors import DiscModelError, Fault, ParameterError
from disc_model.figures.kind import Kind, kind_of, library_kinds
from disc_model.parameters import AUTO, RATIOS, Disc, Parameters
from disc_model.simulation.case import CaseSpec, Poincare, SomeParameters, Span, Start, Window
from disc_model.simulation.ramps import RAMPED, Ramp
from disc_model.simulation.ramps import faults as ramp_faults
from disc_model.studies.rules import checked_rule
from disc_model.units import (
    Count,
    CycleTolerance,
    Finite,
    Positive,
    Real,
    Seconds,
    Speed,
    Strict,
    Title,
    Tolerance,
    Unit,
    Units,
    must,
)

# ----------------------------------------------------------------------------------------------------
# Names

STATIC = "static"
"""Name of the default start."""
TAKEN = frozenset({"case", "message", "title", "reference", *SCALARS, *Parameters.model_fields})
"""Names of variables in a study's file. Cases and windows become groups beside them and must differ."""


def _but(taken: Collection[str], rule: str) -> AfterValidator:
    """Refuse some names."""
    return AfterValidator(must(lambda name: name not in taken, rule))


_LENGTH = must(lambda name: len(name) <= 100, "must be at most 100 characters")
_REPETITION = must(lambda name: not re.search(r"(.+)\1{19}$", name), "must not end in 20 equal parts")
Name = Annotated[
    str,
    StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9_]*$"),
    AfterValidator(_LENGTH),
    AfterValidator(_REPETITION),
]
"""A name that files are called by; Snakemake takes a name that repeats itself for an endless recursion."""
CaseName = Annotated[Name, _but(TAKEN, "a case must not be called so, the name is taken by a variable")]
WindowName = Annotated[
    Name, _but(TAKEN | BESIDE_WINDOWS, "a window must not be called so, the name is taken by a variable or group")
]
StartName = Annotated[Name, _but({STATIC}, "is the name of the default start")]

# ----------------------------------------------------------------------------------------------------
# Values along an axis: lists, linear and logarithmic ranges, and blocks of them

Value = float | int | str
NumberOrUnit = Annotated[Any, WithJsonSchema({"type": ["number", "string"]})]
"""A value as given in the file; its parameter determines its meaning."""
Blocks = tuple[tuple[Value, ...], ...]
MOST = 100_000
"""Greatest number of values along one axis; a slip of the pen can ask for more than fit into memory."""


Rules = tuple[tuple[Callable[[Any], bool], str], ...]


class Ruled(Strict):
    """A part of a file with conditions between its fields.

    _rules : conditions, each with its message, which may show values of the part
    """

    _rules: ClassVar[Rules] = ()

    @model_validator(mode="after")
    def _keep_rules(self) -> Self:
        for holds, stated in self._rules:
            if not holds(self):
                raise ValueError(stated.format(self))
        return self


class Range(Ruled):
    """Evenly spaced values from `start` to `stop`, both included: `count` of them, or one each `step`.

    On a logarithmic scale the ratio of neighbours is constant.
    """

    start: Finite
    stop: Finite
    count: Annotated[Count, Field(ge=2)] | None = None
    step: Positive | None = None
    scale: Literal["linear", "log"] = "linear"

    _rules = (
        (lambda r: r.start < r.stop, "start={0.start:g} must be < stop={0.stop:g}"),
        (lambda r: math.isfinite(r.stop - r.start), "stop - start must be finite"),
        (lambda r: (r.count is None) != (r.step is None), "must give either count or step"),
        (
            lambda r: r.scale == "linear" or (r.count and r.start > 0),
            "a logarithmic range must give count, and start > 0",
        ),
        (lambda r: r._steps < MOST, f"must be at most {MOST} values"),
        (
            lambda r: abs(r._steps - r.intervals) <= 1e-9 * r._steps,
            "stop - start must be a multiple of step={0.step:g}",
        ),
    )

    @property
    def _steps(self) -> float:
        return (self.stop - self.start) / self.step if self.step else float((self.count or 2) - 1)

    @property
    def intervals(self) -> int:
        """Number of intervals: one less than the number of values."""
        return round(self._steps)

    @property
    def values(self) -> list[float]:
        """All values, in ascending order."""
        return [float(value) for value in self.blocks()[0]]

    def blocks(self, resolution: int = 1) -> Blocks:
        """The range's own values, then those that divide each interval further.

        A finer grid adds blocks and keeps the existing ones: resolution 4 has the blocks of 2, and one more.
        """
        n = self.intervals * resolution
        if n >= MOST:
            raise ValueError(f"must be at most {MOST} values, and not {n + 1}")
        found: dict[int, list[Value]] = {}
        for i in range(n + 1):
            # the lowest resolution at which this value is there
            level = resolution // math.gcd(i, resolution)
            found.setdefault(level, []).append(self._at(i / n))
        if len({*chain(*found.values())}) <= n:
            raise ValueError(f"must be {n + 1} values that differ in their first 12 digits")
        return tuple(tuple(found[level]) for level in sorted(found))

    def _at(self, share: float) -> float:
        """The value at a fraction of the range, rounded to 12 digits, so that ranges and lists agree on 0.3."""
        if share in (0.0, 1.0):
            return self.stop if share else self.start
        if self.scale == "log":
            return float(f"{self.start * (self.stop / self.start) ** share:.12g}")
        return float(f"{self.start + share * (self.stop - self.start):.12g}")


class AxisRange(Range):
    """Evenly spaced values along an axis, and `extra` ones, whose batches leave those of the range unchanged."""

    extra: list[NumberOrUnit] = Field([])

    def blocks(self, resolution: int = 1) -> Blocks:
        return (*super().blocks(resolution), *([tuple(self.extra)] if self.extra else []))


def _axis_kind(raw: Any) -> str | None:
    if isinstance(raw, Mapping):
        return "BlocksOf" if "blocks" in raw else "AxisRange"
    return "a list" if isinstance(raw, list) and raw else None


_NO_AXIS = {
    "custom_error_type": "axis",
    "custom_error_message": "must be a list of values, or a range {start, stop, count or step}",
}
Listed = Annotated[list[NumberOrUnit], Field(min_length=1), Tag("a list")]
Block = Annotated[Listed | Annotated[AxisRange, Tag("AxisRange")], Discriminator(_axis_kind, **_NO_AXIS)]


class BlocksOf(Strict):
    """Values in blocks, each with batches of its own; a value in several blocks belongs to the first."""

    blocks: Annotated[list[Block], Field(min_length=1)]


Axis = Annotated[
    Listed | Annotated[AxisRange, Tag("AxisRange")] | Annotated[BlocksOf, Tag("BlocksOf")],
    Discriminator(_axis_kind, **_NO_AXIS),
]


def blocks_of(axis: list[Any] | AxisRange | BlocksOf, resolution: int = 1) -> Blocks:
    """Blocks of the values of an axis; raises ValueError if there are too many values."""
    if isinstance(axis, BlocksOf):
        return tuple(block for part in axis.blocks for block in blocks_of(part, resolution))
    return axis.blocks(resolution) if isinstance(axis, AxisRange) else (tuple(axis),)


VARIED = (*Parameters.model_fields, *RATIOS, START, *PERTURBATIONS)
"""Names that a grid may vary, in the order of its dimensions: parameters, ratios in their place, and the start."""


class _Columns(Strict):
    """Values by what varies."""

    _unknown: ClassVar[str] = "cannot be an axis"


def _described(name: str) -> dict[str, Any]:
    if name == START:
        return {"description": "where the motion starts: names of starts"}
    if name == "disc":
        return {"description": "discs: tables of modes, or names of `discs`"}
    if name in (*PERTURBATIONS, *RATIOS):
        stated = attributes(name)
        return {"description": stated["long_name"], "json_schema_extra": {"unit": stated["units"]}}
    field = Parameters.model_fields[name]
    return {"description": field.description, "json_schema_extra": field.json_schema_extra}


_columns: dict[str, Any] = {name: (Axis, Field(None, **_described(name))) for name in VARIED}
Columns = create_model("Columns", __base__=_Columns, **_columns)
"""An axis for each of several names of `VARIED`."""


# ----------------------------------------------------------------------------------------------------
# Distributions of uncertain parameters

NUMBERS = tuple(name for name in Parameters.model_fields if Parameters.unit(name) and not name.startswith("n_"))
"""Parameters that can be distributed."""
FARTHEST = 6.47
"""Standard deviations at which a normal distribution is cut off, rounded up: a fraction of 1e-10 lies beyond."""


class _Distribution(Ruled):
    """Of one parameter.

    relative : whether the numbers are multiples of the parameter's own value at the point
    """

    relative: bool = False


class _Bounded(_Distribution):
    low: Finite
    high: Finite

    _rules: ClassVar[Rules] = ((lambda d: d.low < d.high, "low={0.low:g} must be < high={0.high:g}"),)

    @property
    def ends(self) -> tuple[float, float]:
        return self.low, self.high


class Uniform(_Bounded):
    """A uniform distribution: all values from `low` to `high` are equally likely."""

    distribution: Literal["uniform"]


class Normal(_Distribution):
    """A normal distribution, cut off at 6.47 standard deviations."""

    distribution: Literal["normal"]
    mean: Finite
    deviation: Positive

    @property
    def ends(self) -> tuple[float, float]:
        return self.mean - FARTHEST * self.deviation, self.mean + FARTHEST * self.deviation


class TruncatedNormal(_Bounded):
    """A normal distribution, restricted to values from `low` to `high`; mean and deviation are those of the whole."""

    distribution: Literal["truncated_normal"]
    mean: Finite
    deviation: Positive

    _rules = (
        *_Bounded._rules,
        (
            lambda d: max(d.low - d.mean, d.mean - d.high) <= FARTHEST * d.deviation,
            f"low and high must be within {FARTHEST:g} deviations of mean={{0.mean:g}}",
        ),
    )


Distribution = Annotated[Uniform | Normal | TruncatedNormal, Field(discriminator="distribution")]

# ----------------------------------------------------------------------------------------------------
# Options of each quantity

Energy = Annotated[Real, Field(ge=0, allow_inf_nan=False), Unit("J")]


class EarlyEndOptions(Ruled):
    """Simulations that may end before the horizon.

    early_end : whether a simulation ends as soon as its outcome is known, see `disc_model.stability.attractor`
    """

    tol: Tolerance = 1e-10
    early_end: bool = True


class OutcomeOptions(EarlyEndOptions):
    """Outcome of one simulation at each point, within a horizon.

    horizon : s
    evaluation_time : s, length of the last stretch, over which ranges and fractions of the phases are taken
    after_separation : s, simulated after the first separation, so that the late stretch shows the motion it leads to
    """

    horizon: Seconds
    evaluation_time: Seconds = 1.0
    after_separation: Seconds = 5.0

    _rules = (
        (
            lambda o: o.evaluation_time <= min(o.after_separation, o.horizon),
            "evaluation_time must be <= after_separation and <= horizon",
        ),
    )


class RegionsOptions(Ruled):
    """Outcomes over a plane of two parameters, computed more densely where they change.

    horizon : s
    initial_cell_size : initial side of a cell, in intervals of the grid
    """

    tol: Tolerance = 1e-8
    horizon: Seconds
    initial_cell_size: Annotated[Count, Field(ge=1, le=1000)] = 8


class CriticalSpeedOptions(EarlyEndOptions):
    """Scan of the speed, then bisection of each interval in which separation begins or ends.

    horizons : s; each has a critical speed of its own, all from the same simulations
    scan : rad/s
    precision : rad/s, width of the last interval; the scan's step must be a multiple
    max_crossings : room for that many crossings at each horizon
    """

    horizons: Annotated[tuple[Seconds, ...], Field(min_length=1), AfterValidator(lambda h: tuple(sorted(set(h))))]
    scan: Annotated[Range, Unit("rad/s")]
    precision: Speed = 0.1
    max_crossings: Annotated[Count, Field(ge=1, le=10_000)] = 12

    _rules = (
        (lambda o: o.scan.scale == "linear", "scan must be linear"),
        (
            lambda o: 0.5 < o.step < math.inf and abs(o.step - round(o.step)) <= 1e-6,
            "the scan's step must be a multiple of precision",
        ),
    )

    @property
    def step(self) -> float:
        """The scan's step as a multiple of the precision."""
        return (self.scan.stop - self.scan.start) / self.scan.intervals / self.precision


class FloquetOptions(Ruled):
    """The stick-slip cycle at each point and its growth rate, by Floquet multipliers."""

    tol: CycleTolerance = 1e-12


class HysteresisOptions(Ruled):
    """A sweep of the speed up from the static start and down again; each speed continues the motion of the last one.

    scan : rad/s
    dwell : s at each speed; it is doubled until the motion has settled
    max_dwell : s, greatest length of the stay then
    evaluation_time : s, the last stretch of it, over which separations, ranges and shares of the phases are taken
    """

    tol: Tolerance = 1e-10
    scan: Annotated[Range, Unit("rad/s")]
    dwell: Seconds
    max_dwell: Seconds = 480.0
    evaluation_time: Seconds = 5.0

    _rules = ((lambda o: o.evaluation_time <= o.dwell, "evaluation_time must be <= dwell"),)


class RampsOptions(Ruled):
    """Slow ramps of the speed, up from the static start and down again, once for each rate.

    low, high : rad/s, ends of the ramps
    rates : rad/s^2
    dwell : s, at the highest speed, and at the lowest one at the end
    """

    tol: Tolerance = 1e-10
    low: Speed
    high: Speed
    rates: Annotated[Range, Unit("rad/s^2")]
    dwell: Seconds = 60.0

    _rules = (
        (lambda o: o.low < o.high, "low must be < high"),
        (lambda o: o.rates.start > 0, "rates must be > 0"),
    )


class BifurcationOptions(Ruled):
    """Samples of the motion after a transient, for bifurcation diagrams.

    section : once a turn of the drive, or at events: each separation if there are any, else each release. A periodic
        motion then shows as many points as its period has events
    transient : s, left out; at events it is doubled until the motion has settled
    max_transient : s, greatest length of the transient then
    samples : number of turns or events sampled after it
    theta : rad, the disc's point whose displacement is sampled once a turn
    """

    tol: Tolerance = 1e-10
    section: Literal["stroboscopic", "event"] = "stroboscopic"
    transient: Seconds
    max_transient: Seconds = 480.0
    samples: Annotated[Count, Field(ge=1, le=MOST)] = 50
    theta: Annotated[Finite, Unit("rad")] = 1.0


class LyapunovOptions(Ruled):
    """The largest Lyapunov exponents of the motion, without the one along it, which is zero.

    transient : s, left out
    duration : s, averaging time of the rates
    exponents : number of exponents, 1 to 7
    interval : s, between orthonormalisations; exponents below -400/s need a shorter one
    """

    tol: Tolerance = 1e-10
    transient: Seconds
    duration: Seconds
    exponents: Annotated[Count, Field(ge=1, le=7)] = 2
    interval: Seconds = 0.05


class BasinsOptions(Ruled):
    """Attractors, basin fractions and critical energy, from many starts.

    energies : J, of the perturbations that are added to the start in random directions; 0 adds nothing
    n_starts : number of starts at each energy
    seed : whole number; a direction depends on it, on the place of the energy, and on the number of the start
    horizon : s
    attractor_tol : relative; a motion ends early if its range agrees with that of a known attractor to this, and
        approaches it. 0: every motion is simulated to the horizon
    confidence : confidence level of the intervals of fractions
    n_bisection_directions : number of directions for the critical energy, those of the separating starts with the least
        energies
    precision : relative precision of the critical energy
    """

    tol: Tolerance = 1e-10
    energies: Annotated[tuple[Energy, ...], Field(min_length=1)] = (0.0,)
    n_starts: Annotated[Count, Field(ge=1, le=MOST)] = 1
    seed: Annotated[Count, Field(ge=0)] = 1
    horizon: Seconds = 200.0
    attractor_tol: Annotated[Real, Field(ge=0, le=0.25)] = 0.1
    confidence: Annotated[Real, Field(gt=0, lt=1)] = 0.95
    n_bisection_directions: Annotated[Count, Field(ge=0, le=1000)] = 1
    precision: Annotated[Real, Field(gt=1e-6, le=1)] = 0.05

    _rules = (
        (lambda o: [*o.energies] == sorted({*o.energies}), "energies must ascend"),
        (
            lambda o: o.n_starts == 1 or 0.0 not in o.energies,
            "n_starts must be 1 where an energy is 0, since no direction tells them apart",
        ),
    )


Free = Literal["Omega", "N", "D_star", "c", "c_p", "k", "k_p", "E", "m"]


class StabilityCurvesOptions(Ruled):
    """Neutral curves and folds of the stick-slip cycle in the plane of two parameters.

    x, y : the parameters
    x_range : from, to; cycles are searched for at `points` values in it
    y_lines : values of y for this search; curves are followed from the first to the last, widened by `margin`
    margin : fraction of the range of y, beyond the lines at both ends
    max_step : arclength of the longest step along a curve
    max_points : greatest number of points of a curve in each direction
    max_curves : room for that many
    """

    x: Free = "Omega"
    y: Free = "N"
    x_range: Annotated[tuple[Finite, Finite], Unit(of="x")]
    y_lines: Annotated[Range, Unit(of="y")]
    margin: Annotated[Real, Field(ge=0, le=1)] = 0.0
    points: Annotated[Count, Field(ge=2, le=10_000)] = 31
    max_step: Positive = 0.1
    max_points: Annotated[Count, Field(ge=2, le=10_000)] = 100
    max_curves: Annotated[Count, Field(ge=1, le=1000)] = 24
    tol: CycleTolerance = 1e-12

    _rules = (
        (lambda o: o.x != o.y, "x and y must differ"),
        (lambda o: o.x_range[0] < o.x_range[1], "x_range must ascend"),
    )


class BranchesOptions(Ruled):
    """Branches of stable and unstable cycles against one parameter, by continuation, and a sweep up and down.

    parameter : the one that varies
    scan : its values in the sweep; each cycle found is followed between the first and the last
    dwell : s at each value; it is doubled until the motion has settled
    max_dwell : s, greatest length of the stay then
    evaluation_time : s, the last stretch of it, over which the range is taken
    releases : greatest number of releases of a cycle that is followed
    max_step : arclength of the longest step along a branch
    max_points : greatest number of points of a branch in each direction
    max_branches : room for that many
    """

    parameter: Free = "Omega"
    scan: Annotated[Range, Unit(of="parameter")]
    dwell: Seconds
    max_dwell: Seconds = 480.0
    evaluation_time: Seconds = 2.0
    releases: Annotated[Count, Field(ge=1, le=100)] = 4
    max_step: Positive = 0.05
    max_points: Annotated[Count, Field(ge=2, le=10_000)] = 200
    max_branches: Annotated[Count, Field(ge=1, le=1000)] = 12
    tol: Tolerance = 1e-10

    _rules = ((lambda o: o.evaluation_time <= o.dwell, "evaluation_time must be <= dwell"),)


class SensitivityOptions(Ruled):
    """The stick-slip cycle at samples of uncertain parameters, and the outcome of the static start.

    distributions : by parameter; for a disc given by its modes also by mode, such as omega_2_0, amplitude_2_0 and
        damping_ratio_2_0 for two nodal diameters and no circle
    samples : number of samples, a power of two; more samples keep the existing ones
    seed : whole number; a sample depends only on it and on the sample's own number
    simulated_samples : number of samples, from the first on, whose motion is simulated as well
    horizon : s, of this simulation
    growth_rate_cap : 1/s; larger growth rates count as this in their indices, since a few would dominate the variance
    tol : tolerance of the cycles; motion_tol : tolerance of the motions
    """

    distributions: Annotated[dict[str, Distribution], Field(min_length=1)]
    # the grid contains it: the result of a sample does not depend on their number
    samples: Annotated[Count, Field(ge=2, le=2**16, exclude=True)] = 64
    seed: Annotated[Count, Field(ge=0)] = 0
    simulated_samples: Annotated[Count, Field(ge=0)] = 0
    horizon: Seconds = 500.0
    growth_rate_cap: Annotated[Positive, Unit("1/s")] = 0.5
    tol: CycleTolerance = 1e-12
    motion_tol: Tolerance = 1e-10

    @classmethod
    def _units(cls, data: Mapping[str, Any]) -> dict[str, Units]:
        given = data.get("distributions")
        names = map(str, given if isinstance(given, Mapping) else ())
        of_modes = {name: "rad/s" for name in names if name.startswith("omega_")}
        return super()._units(data) | {"distributions": {name: Parameters.unit(name) for name in NUMBERS} | of_modes}

    _rules = ((lambda o: o.samples & (o.samples - 1) == 0, "samples={0.samples} must be a power of two"),)


class CampbellOptions(Ruled):
    """Frequencies and growth rates of steady sliding and of the stick-slip cycle.

    modes : room for that many, the lowest in frequency
    half_bandwidth : Hz, on either side of a crossing, within which growth rates are compared
    min_rise : 1/s, least rise of a growth rate within the window above those at its ends
    max_crossings : room for that many
    """

    modes: Annotated[Count, Field(ge=1, le=1000)] = 12
    half_bandwidth: Annotated[Positive, Unit("Hz")] = 1.0
    min_rise: Annotated[Positive, Unit("1/s")] = 0.01
    max_crossings: Annotated[Count, Field(ge=1, le=10_000)] = 100
    tol: CycleTolerance = 1e-12


class Entry(NamedTuple):
    """Properties of a quantity: its options, the cost of a point, and its grids and motions.

    options : model of the key ``options`` in a study file
    seconds : approximate processor time of a point with given options, s, measured at points of the paper's study
    scans : parameters that the quantity varies by itself, or the options that name them
    motions : number of values of each axis for which a motion is stored; smaller if a motion is expensive. 0: none
    motion : description of the motions, which begin at the quantity's ``state_at``
    tiled : whether the quantity needs a whole tile of a plane at once
    over : the required dimension over which a merged study is summarised
    tasks : the tasks of `disc_model.kernels` for which kernels are needed
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
        """Parameters that the quantity varies by itself; the default ones if the options are not known."""
        usual = {name: field.default for name, field in self.options.model_fields.items()}
        return tuple(getattr(options, name, usual.get(name, name)) for name in self.scans)

    def batch_size(self, options: Strict) -> int:
        """Number of points in a batch if a study does not state it."""
        return max(1, round(WORK / self.seconds(options)))


def _with_start(options: type[Strict]) -> type[Strict]:
    """Options of a quantity whose motions may begin elsewhere than at the static start: the file gives it as one."""
    return create_model(options.__name__, __base__=(Start, options), __doc__=options.__doc__)


WORK = 20.0
"""Processor time of a batch, s: its job costs about 1 s in itself. Three times as much does no harm."""
# Measured costs, s. A new value changes the batches of all studies of a quantity without `batch.size`.
SIMULATED = 7e-4
"""Cost of a simulated second, s: 3e-4 in contact, two or three times as much with repeated separation."""
CYCLE = 2.5e-3
"""Cost of finding a cycle and its multipliers, s."""
COME_TO = (
    "What the motion has come to: a while after the first separation, on the cycle it settled to, or at the horizon."
)
AFTER_TRANSIENT: dict[str, Any] = {"motions": 8, "motion": "After the transient."}
QUANTITIES = {
    "outcome": Entry(_with_start(OutcomeOptions), lambda o: SIMULATED * o.horizon / 2, motions=4, motion=COME_TO),
    "regions": Entry(RegionsOptions, lambda o: WORK, motions=4, motion=COME_TO, tiled=True),
    "critical_speed": Entry(
        CriticalSpeedOptions, lambda o: SIMULATED * o.scan.intervals * o.horizons[-1] / 9, scans=("Omega",)
    ),
    "floquet": Entry(FloquetOptions, lambda o: CYCLE, motions=7, motion="The stick-slip cycle itself, stable or not."),
    "hysteresis": Entry(HysteresisOptions, lambda o: SIMULATED * 2 * o.scan.intervals * o.dwell, scans=("Omega",)),
    "ramps": Entry(
        RampsOptions,
        lambda o: SIMULATED * sum(2 * ((o.high - o.low) / rate + o.dwell) for rate in o.rates.values),
        scans=("Omega",),
        tasks=("simulate", "ramp"),
    ),
    "basins": Entry(_with_start(BasinsOptions), lambda o: SIMULATED * len(o.energies) * o.n_starts * o.horizon / 6),
    "bifurcation": Entry(
        _with_start(BifurcationOptions), lambda o: SIMULATED * (o.transient + o.max_transient / 2), **AFTER_TRANSIENT
    ),
    "lyapunov": Entry(
        _with_start(LyapunovOptions),
        lambda o: SIMULATED * (o.transient + 20 * o.exponents * o.duration),
        **AFTER_TRANSIENT,
    ),
    "stability_curves": Entry(StabilityCurvesOptions, lambda o: WORK, scans=("x", "y")),
    "branches": Entry(BranchesOptions, lambda o: WORK, scans=("parameter",)),
    "sensitivity": Entry(
        SensitivityOptions,
        # independent of the number of samples, so that more samples keep the batches
        lambda o: CYCLE * (2 + len(o.distributions)) + SIMULATED * o.horizon / 4 * (o.simulated_samples > 0),
        over=SAMPLE,
    ),
    "campbell": Entry(CampbellOptions, lambda o: 1.5 * CYCLE, over="Omega"),
}


class BatchSpec(Strict):
    """Division of the points of a grid into jobs.

    over : dimensions that are cut; each value of the others has batches of its own. If not given, the first dimensions
        are cut as far as `size` requires
    size : greatest number of points in a batch; if not given, about 20 s of work by the cost of a point
    tile : approximate intervals along the side of a tile, for a quantity that needs a plane at once. `over` names its
        two dimensions first, then those whose values share a batch. If not given, the plane's are the only two that are
        numbers, and all other values share a batch
    """

    over: Annotated[tuple[str, ...], Field(min_length=1)] | None = None
    size: Annotated[Count, Field(ge=1)] | None = None
    tile: Annotated[Count, Field(ge=1)] = 32


# ----------------------------------------------------------------------------------------------------
# Named cases


def _in_part(model: type[BaseModel], **others: Any) -> type[Strict]:
    """What may be said of a model in part, since the rest is inherited; as null, to drop what is inherited.

    others : types of fields that are models themselves
    """
    fields: dict[str, Any] = {
        name: (others.get(name, Annotated[field.annotation, *field.metadata, "in part"]) | None, None)
        for name, field in model.model_fields.items()
    }
    return create_model(f"Some{model.__name__.removesuffix('Spec')}", __base__=Strict, __doc__=model.__doc__, **fields)


class RecordSpec(Strict):
    """What is recorded of a case. Figures and claims refer to windows by their names."""

    windows: dict[WindowName, Window] = Field({})
    poincare: Poincare | None = None
    events: bool | Span = True
    audit_every_step: bool = False


SomeRecord = _in_part(RecordSpec, windows=dict[WindowName, _in_part(Window) | None])  # type: ignore[misc]


_diameters = Parameters.model_fields["n_diameters"]


class GivenParameters(SomeParameters):  # type: ignore[misc, valid-type]
    """Parameters, any of which may be left out; the number of modes may be left to each case."""

    n_diameters: Annotated[
        int,
        *_diameters.metadata,
        WrapValidator(lambda value, check: value if value == AUTO else check(value)),
        WithJsonSchema({"anyOf": [{"type": "integer", "minimum": -1, "maximum": 60}, {"const": AUTO}]}),
    ] = Field(  # type: ignore[assignment]
        None, description=_diameters.description, json_schema_extra=_diameters.json_schema_extra
    )
    truncation_quantity: Literal[*CHOSEN_BY] = Field(  # type: ignore[valid-type]
        None, description="quantity by which n_diameters: auto chooses the modes"
    )
    truncation_tolerance: Annotated[Finite, Field(ge=TRUSTED)] = Field(  # type: ignore[assignment]
        None, description="relative tolerance of this quantity"
    )


def _of_case(values: Any) -> tuple[Parameters, ModeRequest | None]:
    if not isinstance(values, Mapping):
        raise ValueError("must be a mapping")
    return read_asked(values)


SomeSpan = TypeVar("SomeSpan", bound=Span)


class NamedCase(Strict):
    """One named simulation of a study."""

    title: str
    reference: str = ""
    parameters: Annotated[
        tuple[Parameters, ModeRequest | None], PlainValidator(_of_case, json_schema_input_type=GivenParameters)
    ] = Field({}, validate_default=True)
    t_end: Seconds
    tol: Tolerance = 1e-10
    stop_at: Literal["first_separation"] | None = None
    start: Start = Start()
    ramps: tuple[Ramp, ...] = ()
    record: Annotated[RecordSpec, BeforeValidator(lambda stated: stated, json_schema_input_type=SomeRecord)] = (
        RecordSpec()
    )

    def spec(self) -> CaseSpec:
        """The specification to simulate; raises `ParameterError` with places inside the case."""
        faults: list[Fault] = []
        p, truncation, modes = self._modes(faults)
        record, events = self.record, None
        windows = {
            name: self._within(window, ("record", "windows", name), faults) for name, window in record.windows.items()
        }
        if record.events:
            span = self._within(Span() if record.events is True else record.events, ("record", "events"), faults)
            events = span.start, span.stop
        for fault in ramp_faults(p, self.ramps, poincare=record.poincare is not None) if self.ramps else ():
            faults.append(fault.inside(("parameters",)) if fault.path[0] in RAMPED else fault)
        if faults:
            raise ParameterError(*faults)
        return CaseSpec(
            parameters=p,
            truncation=truncation,
            modes=modes,
            windows=tuple(windows.items()),
            poincare=record.poincare,
            events=events,
            audit_every_step=record.audit_every_step,
            **{name: getattr(self, name) for name in ("t_end", "tol", "stop_at", "start", "ramps")},
        )

    def _modes(self, faults: list[Fault]) -> tuple[Parameters, str, str]:
        """Parameters, and how their modes were chosen or will be chosen when the case runs."""
        p, asked = self.parameters
        if asked is None or asked.quantity != FREQUENCIES:
            return p, "", "" if asked is None else json.dumps(asked.model_dump(), sort_keys=True)
        try:
            choice = by_frequencies(p, asked.tolerance)
        except DiscModelError as error:  # no number of modes meets the tolerance
            faults.append(Fault.of(("parameters", "n_diameters"), AUTO, str(error)))
            return p, "", ""
        return choice.parameters, choice.to_json(), ""

    def _within(self, span: SomeSpan, place: tuple[str, ...], faults: list[Fault]) -> SomeSpan:
        """A stretch of the run with absolute times."""
        start, stop = span.ends(0.0, self.t_end)
        if 0 <= start < stop <= self.t_end:
            return span.resolved(0.0, self.t_end)
        rule = f"must be within the run: 0 <= start={start:g} < stop={stop:g} <= t_end={self.t_end:g}"
        faults.append(Fault(place, "", rule))
        return span


# ----------------------------------------------------------------------------------------------------
# Figures


def _figure(raw: Any) -> Kind:
    if isinstance(raw, Kind):
        return raw
    if not isinstance(raw, Mapping):
        raise ValueError("must be a mapping")
    return kind_of(raw.get("kind")).model_validate(raw)


_OTHER_KIND = {
    "type": "object",
    "properties": {"kind": {"type": "string", "pattern": r"^\w+\.\w+$"}},
    "required": ["kind"],
}
Figure = Annotated[
    Kind,
    PlainValidator(
        _figure,
        json_schema_input_type=Annotated[Union[*library_kinds().values()], Field(discriminator="kind")]
        | Annotated[Any, WithJsonSchema(_OTHER_KIND)],
    ),
]
"""A figure of any kind; the schema for editors knows the keys of the library's kinds, and not those of the paper's."""


def _without_null(raw: Any) -> Any:
    return {name: plot for name, plot in raw.items() if plot is not None} if isinstance(raw, Mapping) else raw


Figures = Annotated[
    dict[Name, Figure], BeforeValidator(_without_null, json_schema_input_type=dict[Name, Figure | None])
]
"""Figures by their names; null drops one that is inherited."""

# ----------------------------------------------------------------------------------------------------
# The whole document


def _several(value: Any) -> Any:
    """A list, also of a single value."""
    return value if isinstance(value, list | tuple) else [value]


class Document(Strict):
    """A study: named cases, a grid of points, or both, and their figures; see docs/studies.md.

    study : name of the study, and of its folder of results
    title : subject of the study
    base : parameters of all cases and of all points; the rest is Table 1 of the paper
    figures : contents of each figure by its name
    cases : named simulations, with inherited values; `tol` and `record` are common to them
    claims : whether the paper's claims and tables are checked against the cases
    quantity, options : the quantity that a grid computes at each point
    axes, zip, starts : varying parameters, and starts of the motions
    discs : tables of modes by the names that an axis of discs has for them
    where : rules between values, such as mu_k <= mu_s; points that break one are excluded
    batch : division of the points into jobs
    studies : further files of grid studies, * stands for any part of a name
    overrides : values that replace those of these files, by name
    resolution : whole number that divides the intervals of all ranges
    """

    study: Name
    title: Title = ""
    base: GivenParameters = GivenParameters()
    figures: Figures = Field({})
    tol: Tolerance | None = 1e-10
    record: SomeRecord = SomeRecord()  # type: ignore[valid-type]
    cases: Annotated[dict[CaseName, NamedCase], Field(min_length=1)] = Field({}, validate_default=False)
    claims: bool = False
    quantity: Annotated[str | None, WithJsonSchema({"enum": list(QUANTITIES)})] = None
    options: Annotated[Any, WithJsonSchema({"type": "object"})] = None
    axes: Columns = Columns()
    where: Annotated[
        tuple[Annotated[str, AfterValidator(checked_rule)], ...],
        BeforeValidator(_several, json_schema_input_type=str | list[str]),
    ] = ()
    zip: Annotated[tuple[Columns, ...], BeforeValidator(_several, json_schema_input_type=Columns | list[Columns])] = ()
    batch: BatchSpec = BatchSpec()
    starts: dict[StartName, Start] = Field({})
    discs: dict[str, Annotated[Disc, WithJsonSchema({"type": "string"})]] = Field({})
    studies: tuple[str, ...] = ()
    overrides: dict[str, dict[str, Any]] = Field({})
    resolution: Annotated[Count, Field(ge=1)] = 1


DOCUMENTS: dict[str, type[Document]] = {
    name: create_model(f"Study_of_{name}", __base__=Document, options=(entry.options, ...))
    for name, entry in QUANTITIES.items()
}
"""Models of files that give a quantity."""


# ----------------------------------------------------------------------------------------------------
# For editors


class _Plain(GenerateJsonSchema):
    """JSON Schema without redundant text: titles that repeat a name, and paragraphs of docstrings after the first."""

    def field_title_should_be_set(self, schema: Any) -> bool:
        return False

    def float_schema(self, schema: Any) -> Any:
        """Numbers may be given as text: with a unit, or because YAML reads 1e-3 as text."""
        return super().float_schema(schema) | {"type": ["number", "string"], "pattern": r"^\s*[-+.]*\d"}

    def get_default_value(self, schema: Any) -> Any:
        found = super().get_default_value(schema)
        return found if isinstance(found, str | int | float) else NoDefault

    def model_schema(self, schema: Any) -> Any:
        found = super().model_schema(schema)
        found.pop("title", None)
        if "description" in found:
            found["description"] = found["description"].split("\n\n")[0].replace("\n", " ")
        return found


def schema_text() -> str:
    """The JSON Schema of study files, as shipped; it describes the values of each key, but no rules between keys."""
    options = {name: quantity.options for name, quantity in QUANTITIES.items()}
    models: tuple[type[BaseModel], ...] = (Document, *options.values())
    refs, found = models_json_schema([(model, "validation") for model in models], schema_generator=_Plain)
    schema = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "A study of disc_model",
        **found["$defs"].pop(Document.__name__),
        "anyOf": [{"required": [key]} for key in ("cases", "quantity", "studies")],
        "allOf": [
            {
                "if": {"properties": {"quantity": {"const": name}}, "required": ["quantity"]},
                "then": {"properties": {"options": refs[model, "validation"]}},
            }
            for name, model in options.items()
        ],
        **found,
    }
    return json.dumps(schema, indent=1, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    print(schema_text(), end="")
