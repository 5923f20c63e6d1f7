"""Results of a quantity at points: rows of values by column, a status, and the errors that make a point fail."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from disc_model.data.variables import OUTCOMES_TO_HORIZON, STABLE_CYCLES, Variable
from disc_model.errors import DiscModelError, Status
from disc_model.parameters import Parameters
from disc_model.simulation.case import Start

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
# Results at samples of distributed parameters

UNSTABLE = ("unstable", "no_cycle", "separates", "unstable_sliding")
SAMPLE_CYCLES = ("failed", *STABLE_CYCLES, *UNSTABLE)
"""Classes of the cycle near the static start: one of `STABLE_CYCLES`; or an unstable cycle, none though the slider
sticks and slips, immediate separation, or unstable sliding."""
SAMPLE_OUTCOMES = ("not_simulated", *OUTCOMES_TO_HORIZON)
DRAWS = ("A", "B")
