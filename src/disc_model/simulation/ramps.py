"""Slow ramps of the drive speed or of the preload, and the values of Omega and N at any time."""

import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from typing import Annotated, Literal, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field, model_validator

from disc_model.errors import Fault, ParameterError, as_text
from disc_model.parameters import Parameters
from disc_model.units import Checked, Positive, Real, Seconds, Unit

Ramped = Literal["Omega", "N"]
RAMPED: tuple[Ramped, ...] = ("Omega", "N")


class Ramp(Checked):
    """A slow change of the drive speed or the preload: linear from `start` to `end`, and constant afterwards.

    The slider's spring k is held where it was: N is the load beside it.

    Parameters
    ----------
    parameter : "Omega" or "N"
    to : rad/s or N, the value at ``end``
    start, end : s, absolute times

    Examples
    --------
    >>> import disc_model as dm
    >>> stop = dm.Ramp(parameter="Omega", to=5, start=1, end=4)
    >>> braked = dm.simulate(dm.Parameters(N=385, Omega=15.1), 5, ramps=stop)
    >>> braked.value_at("Omega", [0.5, 2.5, 5]).round(3)
    array([15.1 , 10.05,  5.  ])
    """

    parameter: Ramped
    to: Annotated[Positive, Unit(of="parameter")]
    start: Annotated[Real, Field(ge=0, allow_inf_nan=False), Unit("s")]
    end: Seconds

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if not self.start < self.end:
            raise ParameterError(Fault(("start",), as_text(self.start), f"must be < end={as_text(self.end)}"))
        return self


class Piece(NamedTuple):
    """An interval of time over which Omega and N change at constant rates.

    begin, end : s
    angle : rad, of the drive point at ``begin``
    Omega, Omega_rate, N, N_rate : rad/s, rad/s^2, N, N/s; values at ``begin``
    constant : whether Omega and N are those of the case, before any ramp
    """

    begin: float
    end: float
    angle: float
    Omega: float
    Omega_rate: float
    N: float
    N_rate: float
    constant: bool


def faults(p: Parameters, ramps: object, poincare: bool) -> Iterator[Fault]:
    """Faults of the ramps of a case; ``poincare``: whether samples at the drive's period are requested."""
    if not isinstance(ramps, tuple) or not all(isinstance(ramp, Ramp) for ramp in ramps):
        yield Fault(("ramps",), as_text(ramps), "must be a Ramp or a tuple of them")
        return
    for name in RAMPED if ramps else ():
        if not getattr(p, name) > 0:
            yield Fault((name,), as_text(getattr(p, name)), "must be > 0 where there are ramps")
    for name in RAMPED:
        of_name = [(i, ramp) for i, ramp in enumerate(ramps) if ramp.parameter == name]
        of_name.sort(key=lambda entry: entry[1].start)
        for (_, before), (i, ramp) in pairwise(of_name):
            if ramp.start < before.end:
                rule = f"must be >= {as_text(before.end)}, where the ramp of {name} before it ends"
                yield Fault(("ramps", str(i), "start"), as_text(ramp.start), rule)
    if poincare and any(ramp.parameter == "Omega" for ramp in ramps):
        yield Fault(
            ("record", "poincare"), "", "must not be asked for on ramps of Omega: the drive has no period there"
        )


def pieces(p: Parameters, ramps: Sequence[Ramp]) -> tuple[Piece, ...]:
    """The intervals of constant rates, in order, the last one unbounded; ramps to the present value do not count."""
    steady = Piece(-math.inf, math.inf, 0.0, p.Omega, 0.0, p.N, 0.0, constant=True)
    if not ramps:
        return (steady,)
    lines = {name: _line(p, ramps, name) for name in RAMPED}
    knots = sorted({time for line in lines.values() for time, _, _ in line[1:]})
    parts = [steady._replace(end=knots[0] if knots else math.inf)]
    angle = p.Omega * parts[0].end if knots else 0.0
    for begin, end in pairwise([*knots, math.inf]):
        (Omega, Omega_rate), (N, N_rate) = (_at(lines[name], begin) for name in RAMPED)
        parts.append(Piece(begin, end, angle, Omega, Omega_rate, N, N_rate, constant=False))
        angle += (Omega + 0.5 * Omega_rate * (end - begin)) * (end - begin) if end < math.inf else 0.0
    return tuple(parts)


def values_at(p: Parameters, ramps: Sequence[Ramp], name: str, times: ArrayLike) -> NDArray[np.float64]:
    """Omega or N at given times (s)."""
    knots, values, _ = zip(*_line(p, ramps, name), strict=True)
    return np.asarray(np.interp(np.asarray(times, dtype=float), knots, values))


def _line(p: Parameters, ramps: Iterable[Ramp], name: str) -> list[tuple[float, float, float]]:
    """Times at which the rate of Omega or N changes, with value and rate from then on; the first time is -inf."""
    value = getattr(p, name)
    line = [(-math.inf, value, 0.0)]
    for ramp in sorted(ramps, key=lambda ramp: ramp.start):
        if ramp.parameter == name and ramp.to != value:
            if line[-1][0] == ramp.start:  # one ramp continues where another ends
                line.pop()
            line += [(ramp.start, value, (ramp.to - value) / (ramp.end - ramp.start)), (ramp.end, ramp.to, 0.0)]
            value = ramp.to
    return line


def _at(line: list[tuple[float, float, float]], time: float) -> tuple[float, float]:
    """Value and rate from ``time`` on."""
    begin, value, rate = next(knot for knot in reversed(line) if knot[0] <= time)
    return (value + rate * (time - begin) if rate else value), rate
