"""What all quantities of grid studies have in common, and ranges and rules as parts of files.

A quantity imports the engine only where it computes: reading a study file does not wait for it.
"""

import ast
import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from types import CodeType, MappingProxyType
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, NamedTuple, Self

import numpy as np
from pydantic import AfterValidator, ConfigDict, Field, PrivateAttr, model_validator

from disc_model.data.variables import Variable
from disc_model.errors import DiscModelError, Fault
from disc_model.parameters import DEFAULTS, RATIOS, Parameters, with_ratios
from disc_model.simulation.case import Start
from disc_model.units import Count, Finite, Positive, Strict, must, number

if TYPE_CHECKING:
    from xarray import Dataset

    from disc_model.simulation.result import Result
    from disc_model.simulation.states import State
    from disc_model.stability.attractors import Arrival
    from disc_model.stability.cycle import FloquetResult
    from disc_model.stability.follower import Attractor, OutcomeResult
    from disc_model.stability.segments import Segment
else:  # names for annotations
    Arrival = Attractor = Dataset = FloquetResult = OutcomeResult = Result = Segment = State = Any

Value = float | int | str
Blocks = tuple[tuple[Value, ...], ...]
MOST = 100_000  # greatest number of values along one axis; a slip of the pen can ask for more than fit into memory
Rules = tuple[tuple[Callable[[Any], bool], str], ...]


class Ruled(Strict):
    """A part of a file with conditions between its fields."""

    _rules: ClassVar[Rules] = ()  # each with its message, which may show values of the part

    @model_validator(mode="after")
    def _keep_rules(self) -> Self:
        for holds, stated in self._rules:
            if not holds(self):
                raise ValueError(stated.format(self))
        return self


class Range(Ruled):
    """Evenly spaced values from `start` to `stop`, both included: `count` of them, or one each
    `step`."""

    start: Finite
    stop: Finite
    count: Annotated[Count, Field(ge=2)] | None = None
    step: Positive | None = None
    scale: Literal["linear", "log"] = "linear"  # log: the ratio of neighbours is constant

    _rules = (
        (lambda r: r.start < r.stop, "start={0.start:g} must be < stop={0.stop:g}"),
        (lambda r: math.isfinite(r.stop - r.start), "stop - start must be finite"),
        (lambda r: (r.count is None) != (r.step is None), "must give either count or step"),
        (
            lambda r: r.scale == "linear" or (r.count and r.start > 0),
            "a logarithmic range needs count and start > 0",
        ),
        # by steps there may be a little less than a whole number of them
        (lambda r: r._steps < MOST - 0.5, f"must be at most {MOST} values"),
        (
            lambda r: math.isclose(r._steps, r.intervals),
            "stop - start must be a multiple of step={0.step:g}",
        ),
    )

    @property
    def _steps(self) -> float:
        if self.step:
            return (self.stop - self.start) / self.step
        return (self.count or 2) - 1

    @property
    def intervals(self) -> int:
        return round(self._steps)

    @property
    def values(self) -> list[float]:
        """All values, those inside rounded to 12 digits, so that ranges and lists agree on 0.3."""
        return [self.value_at(place) for place in range(self.intervals + 1)]

    def value_at(self, place: int) -> float:
        """The value at a place, 0 for the first one."""
        if place == 0:
            return self.start
        if place == self.intervals:
            return self.stop
        share = place / self.intervals
        if self.scale == "log":
            value = self.start * (self.stop / self.start) ** share
        else:
            value = self.start + share * (self.stop - self.start)
        return float(f"{value:.12g}")


# ---- Rules between the values of a point, such as ``mu_k <= mu_s``, that exclude points of a grid
_MADE_OF = (
    *(ast.Name, ast.Load, ast.Constant, ast.BinOp, ast.UnaryOp, ast.Compare, ast.BoolOp),
    *(ast.Add, ast.Sub, ast.Mult, ast.Div, ast.USub, ast.And, ast.Or),
    *(ast.Lt, ast.LtE, ast.Gt, ast.GtE, ast.Eq, ast.NotEq),
)


@cache
def compiled_rule(rule: str) -> CodeType:
    """A rule such as ``0.5 < a/b < 0.8``, with floats only: a whole number could repeat a word
    without end."""
    try:
        tree = ast.parse(rule.strip(), mode="eval")
        nodes = list(ast.walk(tree.body))
        if not isinstance(tree.body, ast.Compare | ast.BoolOp) or not all(
            isinstance(node, _MADE_OF) for node in nodes
        ):
            raise ValueError
        for node in nodes:
            if isinstance(node, ast.Constant) and not isinstance(node.value, str):
                node.value = number(node.value)
        return compile(tree, "where", "eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise ValueError("must compare values in SI, without units, such as mu_k <= mu_s") from None


def holds(rules: Sequence[str], values: Mapping[str, Any]) -> bool:
    """Whether all rules hold at a point; a rule that cannot be evaluated, such as a division by
    zero, does not."""
    floats = {}
    for name, value in {**DEFAULTS, **with_ratios(values)}.items():
        floats[name] = float(value) if isinstance(value, int) else value
    try:
        return all(eval(compiled_rule(rule), {"__builtins__": {}}, floats) for rule in rules)
    except (ArithmeticError, TypeError):
        return False


# ---- Quantities
Row = Mapping[str, Any]
Made = Parameters | DiscModelError  # parameters, or the error in their place
NUMERICAL = (
    DiscModelError,
    ArithmeticError,
    np.linalg.LinAlgError,
)  # errors that make a point fail


class Point(NamedTuple):
    """A point of a grid: its parameters, the start of its motion, and its sample number, if it is a
    sample."""

    parameters: Parameters
    start: Start = Start()
    sample: int = 0

    @classmethod
    def perturbed(cls, case: Parameters, perturbation: Mapping[str, float] | None) -> Self:
        """The point of a case whose static start is perturbed, by name."""
        given = {} if perturbation is None else {"perturbation": perturbation}
        return cls(case, Start.model_validate(given))


class Coordinate(NamedTuple):
    """A dimension of a quantity's own: values for given options, and the option by which it has room
    for more."""

    values: Callable[[Any], Sequence[Any]]
    room: str = ""


DIRECTION = Coordinate(lambda options: ("up", "down"))


def failed(error: Exception, flag: str = "status") -> tuple[Row, str]:
    """Values and message of what an error has ended."""
    return {flag: "failed"}, f"{type(error).__name__}: {error}"


def tried(
    flag: str, compute: Callable[..., tuple[Row, str]], subject: Any, *options: Any
) -> tuple[Row, str]:
    """Values and message that a function returns, or those of an error, which the subject may be
    already."""
    if isinstance(subject, Exception):
        return failed(subject, flag)
    try:
        return compute(subject, *options)
    except NUMERICAL as error:
        return failed(error, flag)


def with_ends(name: str, values: Iterable[Any]) -> dict[str, Any]:
    """Three columns by name: a share, and the ends of its confidence interval."""
    return dict(zip((name, f"{name}_low", f"{name}_high"), values, strict=True))


def listed(rows: Sequence[Row]) -> dict[str, list[Any]]:
    """Columns of the rows along a quantity's own dimension; None, which is missing, where rows lack
    a value."""
    names = dict.fromkeys(name for row in rows for name in row)
    columns = {}
    for name in names:
        columns[name] = [row.get(name) for row in rows]
    return columns


COME_TO = (
    "What the motion has come to: a while after the first separation, on the cycle it settled to, "
    "or at the horizon."
)
ON_CYCLE = "The motion on the cycle that it has settled to."
AT_HORIZON = "The motion at the horizon."
COME_TO_BY: Mapping[str, str] = MappingProxyType(
    {
        "separation": "The motion a while after the first separation.",
        "stick_slip": ON_CYCLE,
        "other_cycle": ON_CYCLE,
        "separating": ON_CYCLE,
        "steady_sliding": "The steady sliding that the motion has settled to.",
        "at_rest": "The rest to which the motion has come.",
        "undecided": AT_HORIZON,
        "growing": AT_HORIZON,
    }
)
"""What a motion has come to, by its outcome."""
SETTLED_TO_BY: Mapping[str, str] = MappingProxyType(
    {
        "stick_slip": "After the transient, of a motion that comes to the cycle of the static start.",
        "other_cycle": "After the transient, of a motion that comes to another cycle in contact.",
        "separating": "After the transient, of a motion that comes to a cycle with separations.",
        "quasi_periodic": "After the transient, of a motion that is quasi-periodic.",
        "irregular": "After the transient, of a motion that is irregular.",
        "steady_sliding": "After the transient, of a motion that comes to steady sliding.",
        "at_rest": "After the transient, of a motion that comes to permanent stick.",
        "undecided": "After the transient, of a motion that has not shown what it comes to.",
    }
)
"""What a stored motion is, by the kind that the samples of its point have."""
NUMBERS = tuple(
    name for name in Parameters.model_fields if Parameters.unit(name) and not name.startswith("n_")
)
_FREE = re.compile(
    "|".join([*NUMBERS, *RATIOS, r"(omega|amplitude|damping_ratio|tangential)_\d+_\d+"])
)
Free = Annotated[
    str,
    AfterValidator(must(lambda name: bool(_FREE.fullmatch(name)), "must be a number of the case")),
]
"""A number along which cycles are continued: a parameter, a ratio, or one of a disc's modes."""


class Quantity(Ruled):
    """A quantity of grid studies: its fields are its options, each with its description below."""

    model_config = ConfigDict(use_attribute_docstrings=True)

    points_per_job: ClassVar[int] = 1
    """Most points of a batch, of some 20 s of work with nine modes, where the file does not say it."""
    COLUMNS: ClassVar[Mapping[str, Variable]] = {}
    COORDINATES: ClassVar[
        Mapping[str, Coordinate]
    ] = {}  # its own dimensions, beyond those of the grid
    SUMMARY_COLUMNS: ClassVar[Mapping[str, Variable]] = {}
    # they number what is found, and grow with that
    SUMMARY_COORDINATES: ClassVar[Mapping[str, Coordinate]] = {}
    scans: ClassVar[
        tuple[str, ...]
    ] = ()  # parameters that it varies by itself, or the options that name them
    motions: ClassVar[int] = (
        0  # number of values of each axis for which a motion is stored, fewer if it is expensive
    )
    motion: ClassVar[str] = ""  # description of these motions, which begin at `state_at`
    # more exact descriptions, by the outcome, the kind or the status of a point
    motion_by: ClassVar[Mapping[str, str]] = MappingProxyType({})
    tiled: ClassVar[bool] = (
        False  # whether `compute_tile`, as of `Regions`, computes a whole tile of a plane at once
    )
    # the required dimension over which `summarise`, as of `Campbell`, makes a row of a merged
    # study; a rule of the file may have left out some points, or all
    over: ClassVar[str] = ""

    _advance: Callable[[], object] | None = PrivateAttr(default=None)
    """Is called after each of the starts of a point, if it is given."""

    @property
    def starts(self) -> int:
        """Number of motions of a point whose progress is told."""
        return 1

    def report_to(self, advance: Callable[[], object]) -> None:
        """Have a function called after each of the starts of a point."""
        self._advance = advance

    def start_is_done(self) -> None:
        """Tell that one of the starts of a point is done."""
        if self._advance is not None:
            self._advance()

    @property
    def scanned(self) -> tuple[str, ...]:
        return tuple(getattr(self, name, name) for name in self.scans)

    @property
    def dimensions(self) -> Mapping[str, Blocks]:
        """Dimensions that the options add to the grid, with their blocks of values."""
        return {}

    def faults(self, grid: Any) -> Iterable[Fault]:
        """Faults of the options in a grid, a `disc_model.studies.grid.GridStudy`."""
        return ()

    def compute_point(self, point: Point) -> tuple[Row, str]:
        """Values at one point by column, flags as words, and a message. Too short lists are padded,
        long ones cut, which the message then says."""
        raise NotImplementedError

    def state_at(self, point: Point) -> State:
        """The state in which the motions of a point begin; raises `DiscModelError` if there is
        none."""
        raise NotImplementedError
