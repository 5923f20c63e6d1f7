"""What all quantities of grid studies have in common.

A quantity is a module of `disc_model.studies.quantities` under its own name. It holds a class whose fields are the
options in a study file, with its variables, its computation at a point and its summary. `quantity_of` finds it by its
name. A quantity imports the engine only where it computes: reading a study file does not wait for it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib import import_module
from pkgutil import iter_modules
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, NamedTuple

import numpy as np
from pydantic import AfterValidator

from disc_model.data.variables import Variable
from disc_model.errors import DiscModelError, Fault, ParameterError, Status, suggestion
from disc_model.parameters import RATIOS, Parameters
from disc_model.simulation.case import Start
from disc_model.studies.ranges import Blocks, Ruled
from disc_model.units import Tolerance, must

if TYPE_CHECKING:
    import xarray as xr

    from disc_model.simulation.states import State

STATUSES = ("ok", *(status.value for status in Status if not status.complete), "failed")
"""Status of a point. `failed`: it raised an error, or was not reached."""
STATUS = Variable("1", "what became of the computation", STATUSES)

Row = Mapping[str, Any]
Made = Parameters | DiscModelError
"""Parameters, or the error in their place."""


class Point(NamedTuple):
    """A point of a grid: its parameters, the start of its motion, and its sample number, if it is a sample."""

    parameters: Parameters
    start: Start = Start()
    sample: int = 0


class Coordinate(NamedTuple):
    """A dimension of a quantity's own: unit, name in words, which may show options, and values for given options."""

    units: str
    long_name: str
    values: Callable[[Any], Sequence[Any]]


DIRECTION = Coordinate("", "direction of the sweep", lambda options: ("up", "down"))
"""Coordinate of sweeps up and down."""


NUMERICAL = (DiscModelError, ArithmeticError, np.linalg.LinAlgError)
"""Errors that make a point fail: this package's errors, division by zero and overflow, unsolvable matrices."""


def failed(error: Exception, flag: str = "status") -> tuple[Row, str]:
    """Values and message of what an error has ended."""
    return {flag: "failed"}, f"{type(error).__name__}: {error}"


def tried(flag: str, compute: Callable[..., tuple[Row, str]], *arguments: Any) -> tuple[Row, str]:
    """Values and message that a function returns; with an error (see `NUMERICAL`) this flag is `failed`."""
    try:
        return compute(*arguments)
    except NUMERICAL as error:
        return failed(error, flag)


def with_ends(name: str, values: Iterable[Any]) -> dict[str, Any]:
    """Three columns by name: a share, and the ends of its confidence interval."""
    return dict(zip((name, f"{name}_low", f"{name}_high"), values, strict=True))


def listed(rows: Sequence[Row]) -> dict[str, list[Any]]:
    """Columns of the rows along a quantity's own dimension; None, which means missing, where rows lack a value."""
    names = dict.fromkeys(name for row in rows for name in row)
    return {name: [row.get(name) for row in rows] for name in names}


# ----------------------------------------------------------------------------------------------------
# Quantities

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
_NUMBERS = [name for name in Parameters.model_fields if Parameters.unit(name) and not name.startswith("n_")]
_FREE = re.compile("|".join([*_NUMBERS, *RATIOS, r"(omega|amplitude|damping_ratio)_\d+_\d+"]))
Free = Annotated[str, AfterValidator(must(lambda name: bool(_FREE.fullmatch(name)), "must be a number of the case"))]
"""A number along which cycles are continued: a parameter, a ratio, or one of a disc's modes."""


_QUANTITIES = "disc_model.studies.quantities"


class Quantity(Ruled):
    """A quantity of grid studies: its fields are its options.

    COLUMNS, COORDINATES : its variables, and its own dimensions beyond those of the grid
    SUMMARY_COLUMNS, SUMMARY_COORDINATES : those of its summary
    scans : parameters that it varies by itself, or the options that name them
    motions : number of values of each axis for which a motion is stored; smaller if a motion is expensive. 0: none
    motion : description of the motions, which begin at `state_at`
    tiled : whether it needs a whole tile of a plane at once
    over : the required dimension over which a merged study is summarised
    """

    COLUMNS: ClassVar[Mapping[str, Variable]] = {}
    COORDINATES: ClassVar[Mapping[str, Coordinate]] = {}
    SUMMARY_COLUMNS: ClassVar[Mapping[str, Variable]] = {}
    SUMMARY_COORDINATES: ClassVar[Mapping[str, Coordinate]] = {}
    scans: ClassVar[tuple[str, ...]] = ()
    motions: ClassVar[int] = 0
    motion: ClassVar[str] = ""
    tiled: ClassVar[bool] = False
    over: ClassVar[str] = ""

    @property
    def seconds(self) -> float:
        """Approximate processor time of a point, s, measured at points of the paper's study."""
        raise NotImplementedError

    @property
    def batch_size(self) -> int:
        """Number of points in a batch if a study does not state it."""
        return max(1, round(WORK / self.seconds))

    @property
    def scanned(self) -> tuple[str, ...]:
        """Parameters that it varies by itself."""
        return tuple(getattr(self, name, name) for name in self.scans)

    @property
    def dimensions(self) -> Mapping[str, Blocks]:
        """Dimensions that the options add to the grid, with their blocks of values."""
        return {}

    def faults(self, grid: Any) -> Iterable[Fault]:
        """Faults of the options in a grid, a `disc_model.studies.grid.GridStudy`."""
        return ()

    def compute_point(self, point: Point) -> tuple[Row, str]:
        """Values at one point by column (flags as words), and a message.

        Omitted columns are missing. Lists and arrays shorter than their dimension are padded with missing values,
        longer ones are cut.
        """
        raise NotImplementedError

    def compute_tile(
        self, points: Sequence[Sequence[Made]], sampled: Sequence[tuple[int, int]]
    ) -> Sequence[Sequence[tuple[Row, str]]]:
        """Instead of it, rows and messages of a whole tile of a plane, at least at the places `sampled`."""
        raise NotImplementedError

    def state_at(self, point: Point) -> State:
        """The state in which the motions of a point begin."""
        raise NotImplementedError

    def summarise(self, cell: xr.Dataset) -> Row:
        """Values of the summary by column, for a merged dataset that has only the dimension `over` left.

        A rule of the grid may leave out some of its points, or all.
        """
        raise NotImplementedError


class EarlyEnd(Quantity):
    """A quantity whose simulations may end before the horizon.

    early_end : whether a simulation ends as soon as its outcome is known, see `disc_model.stability.attractor`
    """

    tol: Tolerance = 1e-10
    early_end: bool = True


def quantity_names() -> list[str]:
    """Names of all quantities."""
    return [module.name for module in iter_modules(import_module(_QUANTITIES).__path__)]


def quantity_of(name: str) -> type[Quantity]:
    """The quantity of a name; raises `ParameterError`."""
    if name not in quantity_names():
        raise ParameterError(Fault.of((), name, f"unknown quantity{suggestion(name, quantity_names())}"))
    module = import_module(f"{_QUANTITIES}.{name}")
    (quantity,) = (
        each
        for each in vars(module).values()
        if isinstance(each, type) and issubclass(each, Quantity) and each.__module__ == module.__name__
    )
    return quantity
