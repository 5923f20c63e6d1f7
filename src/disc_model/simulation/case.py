"""Requests to a simulation: recorded quantities, ramps, initial state, and a case of a study as a
text."""

from __future__ import annotations

import json
import math
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Annotated, Any, Literal, NamedTuple, Self

from pydantic import (
    BeforeValidator,
    Field,
    create_model,
    field_validator,
    model_serializer,
    model_validator,
)

from disc_model.data.variables import BESIDE_WINDOWS, rule_of_taken
from disc_model.errors import Fault, ParameterError, as_text, raise_faults, require
from disc_model.parameters import FORMAT, Parameters
from disc_model.provenance import canonical_json, content_key
from disc_model.units import Count, Finite, Positive, Real, Seconds, Strict, Unit

Time = Annotated[Real, Field(ge=0, allow_inf_nan=False), Unit("s")]
Angle = Annotated[Real, Field(allow_inf_nan=False), Unit("rad")]


class SampleTimes(NamedTuple):
    """When samples are taken in a run, and at which point of the disc."""

    first: float  # s
    interval: float  # s
    number: int
    theta: float  # rad, angle of the point fixed to the disc
    end: float  # s, of the run


class Interval(Strict):
    """An interval of time, from a `start` to a later `stop` or `end`."""

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        values = dict(self)
        start = values["start"]
        end = "end" if "end" in values else "stop"
        require((start < values[end], "start", start, f"must be < {end}={as_text(values[end])}"))
        return self


class Span(Interval):
    """A stretch of time: from `start` to `stop`, over the `last` seconds of the run, or over all of
    it."""

    start: Time = 0.0
    stop: Annotated[Real, Field(ge=0), Unit("s")] = math.inf
    last: Seconds | None = None

    @model_validator(mode="after")
    def _either(self) -> Self:
        alone = self.last is None or (self.start == 0 and self.stop == math.inf)
        require((alone, "last", self.last, "must not be given beside start or stop"))
        return self

    @model_serializer(mode="wrap")
    def _plain(self, handler: Any) -> dict[str, Any]:
        """Leave out an absent ``last``, so that older content addresses stay valid."""
        return {
            name: value
            for name, value in handler(self).items()
            if name != "last" or value is not None
        }

    def resolved(self, start: float, t_end: float) -> Self:
        """The same span with absolute times, for a run from ``start`` to ``t_end``. Raises
        `ParameterError` if it has no stop time and begins at the end of the run or later."""
        first, stop = self.ends(start, t_end)
        if (first, stop) == (self.start, self.stop):
            return self
        return self.replace(start=first, stop=stop, last=None)

    def ends(self, start: float, t_end: float) -> tuple[float, float]:
        """Absolute times of its ends, s, for a run from ``start`` to ``t_end``, even if they are
        not within the run."""
        first = self.start
        if self.last is not None:
            first = max(t_end - self.last, start)
        if self.stop < math.inf:
            return first, self.stop
        return first, self._end(first, t_end)

    def _end(self, first: float, t_end: float) -> float:
        return t_end


class Window(Span):
    """Samples at a fixed rate: from `start` to `stop`, over the `last` seconds of the run, or over
    all of it.

    What jumps at a switch (phase and P; velocities of slider and disc at an impact) is at that very
    instant what it was before.  So it is 6e-14 of the time later, because the time of an event is
    rounded.  A sample at the start of a run shows the state from which the run starts.  Where `start`
    or `stop` lies outside the run, there is what the run covers.

    Parameters
    ----------
    start, stop : s, absolute times; from the start of the run to its end if not given
    last : s, counted back from the end of the run, instead of start and stop; not longer than the run, and not with
        ``stop_at``, because the end is not known before
    rate : Hz
    theta : rad, angle of the point fixed to the disc at radius r_0 where ``w_point`` is taken
    envelope : if given, the least and the greatest of each ``envelope`` successive samples are kept instead of them;
        samples that do not fill a bin are left out

    Examples
    --------
    >>> import disc_model as dm
    >>> run = dm.simulate(dm.Parameters(N=385, Omega=15.1), 1, {"late": dm.Window(last=0.5, rate="10 kHz")})
    >>> run["late"]["P"].sizes["time"], run.windows["late"].start
    (5001, 0.5)
    """

    rate: Annotated[Positive, Unit("Hz")]
    theta: Angle = 1.0
    envelope: Annotated[Count, Field(ge=2, le=2**53)] | None = None

    def _end(self, first: float, t_end: float) -> float:
        """End of the span; an envelope up to ``t_end`` excludes that instant, which would be a bin
        of its own."""
        if self.envelope is None:
            return t_end
        return min(max(t_end - 0.5 / self.rate, first + 0.25 / self.rate), t_end)

    @property
    def count(self) -> int:
        """Number of samples, before they are combined to an envelope."""
        return math.floor(self.last_sample) + 1

    @property
    def last_sample(self) -> float:
        """Index of the last sample, from 0 on, before rounding down; infinite beyond the range of
        floats."""
        return (self.stop - self.start) * self.rate * (1 + 1e-15) + 1e-9

    def grid(self, p: Parameters, start: float, t_end: float) -> SampleTimes:
        """When samples are taken in a run of the case from ``start`` to ``t_end``, s."""
        interval = min(1 / self.rate, sys.float_info.max)
        skipped = max(0.0, (start - self.start) * self.rate - 1e-9)
        reached = min(self.last_sample, (t_end - self.start) * self.rate + 1e-9)
        if not skipped <= reached < math.inf:
            return SampleTimes(start, interval, 0, self.theta, t_end)
        index = math.ceil(skipped)
        count = math.floor(reached) - index + 1
        return SampleTimes(self.start + index * interval, interval, count, self.theta, t_end)


class Poincare(Interval):
    """One sample per turn of the drive, at t = i 2 pi/Omega, from `start` to `stop`, of the disc
    point at `theta`.

    Examples
    --------
    >>> import disc_model as dm
    >>> run = dm.simulate(dm.Parameters(N=385, Omega=15.1), 1, {"turns": dm.Poincare()})
    >>> run["turns"]["time"].values.round(4)
    array([0.    , 0.4161, 0.8322])
    """

    start: Time = 0.0
    stop: Annotated[Real, Field(gt=0), Unit("s")] = math.inf
    theta: Angle = 1.0

    def grid(self, p: Parameters, start: float, t_end: float) -> SampleTimes:
        """When samples are taken, as of a `Window`; never if the drive rests."""
        if p.Omega == 0:
            return SampleTimes(0.0, 1.0, 0, self.theta, t_end)
        interval = min(2 * math.pi / p.Omega, sys.float_info.max)
        index = math.ceil(max(self.start, start) / interval - 1e-9)
        last = math.floor(min(self.stop, t_end) / interval + 1e-9)
        count = max(0, last - index + 1)
        return SampleTimes(index * interval, interval, count, self.theta, t_end)


Windows = Mapping[str, Window | Poincare]  # samples to keep, by their names
ROUNDING = 1e-9  # of a time at the end of a run, relative
NAME = re.compile(r"\w([^/\x00-\x1f]{0,58}[^/\s])?")
"""Name of a window, which is that of a group in files."""


def resolved_windows(windows: object, start: float, t_end: float) -> Windows:
    """Windows by name with absolute times, for a run from ``start`` to ``t_end``, by
    `Span.resolved`. Each becomes a group of a file, beside others. One may end before the run
    starts, as parts of a run may share windows, but not begin after its end. Raises
    `ParameterError`."""
    rule = "must be windows by name, such as {'late': Window(last=1, rate=1000)}"
    require((isinstance(windows, Mapping), "windows", windows, rule))
    resolved: dict[str, Window | Poincare] = {}
    for name, window in dict(windows).items():  # type: ignore[call-overload]
        path = f"windows.{name}"
        named = isinstance(name, str) and NAME.fullmatch(name) is not None
        rule = "the name of a window must begin with a letter, a digit or _, and have at most 60 characters and no /"
        require(
            (named, "windows", name, rule),
            (isinstance(window, Window | Poincare), path, window, "must be a Window, or Poincare"),
        )
        if name in BESIDE_WINDOWS:
            rule = f"the name of a window {rule_of_taken(name)}"
            raise ParameterError(Fault.of(("windows",), name, rule))
        length = getattr(window, "last", None) or 0.0
        try:
            require(
                (window.start <= t_end, "start", window.start, f"must be <= {as_text(t_end)}, where the run ends"),
                (t_end - length >= start - ROUNDING * t_end, "last", length,
                 f"must be <= {as_text(t_end - start)} s, the length of the run"),
            )  # fmt: skip
            resolved[name] = window
            if isinstance(window, Window):
                resolved[name] = window.resolved(start, t_end)
        except ParameterError as error:
            raise ParameterError(
                *(fault.inside(("windows", name)) for fault in error.faults)
            ) from None
    return resolved


# ---- Slow ramps of the drive speed or of the preload, and the values of Omega and N at any time

RAMPED = ("Omega", "N")


class Ramp(Interval):
    """A slow change of the drive speed or the preload: linear from `start` to `end`, and constant
    afterwards.

    The slider's spring k is held where it was: N is the load beside it.

    Parameters
    ----------
    parameter : "Omega" or "N"
    to : rad/s or N, the value at ``end``; 0 stops the drive, whereas a preload stays positive
    start, end : s, absolute times

    Examples
    --------
    >>> import disc_model as dm
    >>> stop = dm.Ramp(parameter="Omega", to=5, start=1, end=4)
    >>> braked = dm.simulate(dm.Parameters(N=385, Omega=15.1), 5, ramps=stop)
    >>> braked.value_at("Omega", [0.5, 2.5, 5]).round(3)
    array([15.1 , 10.05,  5.  ])

    A brake stop, after which friction holds the slider:

    >>> stop = dm.Ramp(parameter="Omega", to=0, start=1, end=4)
    >>> stopped = dm.simulate(dm.Parameters(N=385, Omega=15.1, c_p=5), 5, ramps=stop)
    >>> stopped.status.value, stopped.final_state.phase
    ('at_rest', 'stick')
    """

    parameter: Literal["Omega", "N"]
    to: Annotated[Real, Field(ge=0, allow_inf_nan=False), Unit(of="parameter")]
    start: Time
    end: Seconds

    @model_validator(mode="after")
    def _loaded(self) -> Self:
        require((self.parameter != "N" or self.to > 0, "to", self.to, "must be > 0 for N"))
        return self


class Piece(NamedTuple):
    """An interval of time (s) over which Omega (rad/s) and N (N) change at constant rates; values
    are at ``begin``."""

    begin: float
    end: float
    angle: float  # rad, of the drive point
    Omega: float
    Omega_rate: float
    N: float
    N_rate: float

    def angle_at(self, time: float) -> float:
        """Angle by which the drive point has turned at a time of the interval, rad."""
        if self.begin == -math.inf:
            return self.Omega * time
        since = time - self.begin
        return self.angle + (self.Omega + 0.5 * self.Omega_rate * since) * since


def ramp_faults(p: Parameters, ramps: object, poincare: bool) -> Iterator[Fault]:
    """Faults of the ramps of a case; ``poincare``: whether samples at the drive's period are
    requested."""
    if not isinstance(ramps, tuple) or not all(isinstance(ramp, Ramp) for ramp in ramps):
        yield Fault(("ramps",), as_text(ramps), "must be a Ramp or a tuple of them")
        return
    if ramps and not p.N > 0:
        yield Fault.of(("N",), p.N, "must be > 0 where there are ramps")
    for name in RAMPED:
        of_name = [
            (ramp.start, i, ramp.end) for i, ramp in enumerate(ramps) if ramp.parameter == name
        ]
        for (_, _, end), (start, i, _) in pairwise(sorted(of_name)):
            if start < end:
                rule = f"must be >= {as_text(end)}, where the ramp of {name} before it ends"
                yield Fault.of(("ramps", str(i), "start"), start, rule)
    if poincare and any(ramp.parameter == "Omega" for ramp in ramps):
        rule = "must not be asked for on ramps of Omega: the drive has no period there"
        yield Fault(("record", "poincare"), "", rule)


def pieces(p: Parameters, ramps: Sequence[Ramp]) -> tuple[Piece, ...]:
    """The intervals of constant rates, in order, the first before any ramp; ramps to the present
    value do not count."""
    steady = Piece(-math.inf, math.inf, 0.0, p.Omega, 0.0, p.N, 0.0)
    if not ramps:  # as in most cases, which are short
        return (steady,)
    lines = {name: line(p, ramps, name) for name in RAMPED}
    knots = [*sorted({time for knots in lines.values() for time, _, _ in knots[1:]}), math.inf]
    parts = [steady._replace(end=knots[0])]
    angle = p.Omega * knots[0]
    for begin, end in pairwise(knots):
        (Omega, Omega_rate), (N, N_rate) = (_at(lines[name], begin) for name in RAMPED)
        parts.append(Piece(begin, end, angle, Omega, Omega_rate, N, N_rate))
        if end < math.inf:
            angle = parts[-1].angle_at(end)
    return tuple(parts)


def angle_of_drive(intervals: Sequence[Piece], time: float) -> float:
    """Angle by which the drive point has turned since the time 0, rad, from `pieces`."""
    now = next(piece for piece in reversed(intervals) if piece.begin <= time)
    return now.angle_at(time)


def line(p: Parameters, ramps: Iterable[Ramp], name: str) -> list[tuple[float, float, float]]:
    """Times at which the rate of Omega or N changes, with value and rate from then on; the first
    time is -inf."""
    value = getattr(p, name)
    knots = [(-math.inf, value, 0.0)]
    for ramp in sorted(ramps, key=lambda ramp: ramp.start):
        if ramp.parameter == name and ramp.to != value:
            if knots[-1][0] == ramp.start:  # one ramp continues where another ends
                knots.pop()
            knots += [
                (ramp.start, value, (ramp.to - value) / (ramp.end - ramp.start)),
                (ramp.end, ramp.to, 0.0),
            ]
            value = ramp.to
    return knots


def _at(knots: list[tuple[float, float, float]], time: float) -> tuple[float, float]:
    """Value and rate from ``time`` on."""
    begin, value, rate = next(knot for knot in reversed(knots) if knot[0] <= time)
    return (value + rate * (time - begin) if rate else value), rate


# ---- Initial states

_OPTIONAL: Any = {
    name: (Annotated[x.annotation, x], None) for name, x in Parameters.model_fields.items()
}
SomeParameters = create_model("SomeParameters", __base__=Parameters, **_OPTIONAL)
"""Parameters of which any may be absent; rules between several are checked if all of them are present."""


class Prerun(Strict):
    """Another case that is simulated first, from the static start: the motion starts from its last
    state.

    parameters : those that differ from the motion's own
    time : s
    """

    parameters: dict[str, Any]
    time: Seconds

    @field_validator("parameters")
    @classmethod
    def _checked(cls, values: dict[str, Any]) -> dict[str, Any]:
        """The values as `Parameters` converts them: floats, whole numbers, words."""
        checked = SomeParameters(**values)
        return {name: getattr(checked, name) for name in values}


def _without_keys_of_studies(kick: Any) -> Any:
    """Perturbations by name; raises `ParameterError` for what a study file has around them."""
    if isinstance(kick, Mapping):
        rule = "is a key of study files."
        forms = {
            "perturbation": "",
            "prerun": " In functions it is initial_state(case, prerun=...)",
        }
        known = [name for name in forms if name in kick]
        raise_faults([Fault((name,), "", rule + forms[name]) for name in known])
    return kick


class Start(Strict):
    """The state from which a motion starts: the static start, unless one of these keys is given.

    prerun : after another motion, such as one that has separated
    perturbation : added to a coordinate: ``u`` (m) and ``u_velocity`` (m/s) of the slider and of the disc under it,
        ``f`` (rad/s), the slider's angular velocity
    """

    prerun: Prerun | None = Field(
        None, description="another case that is simulated first, with parameters and time"
    )
    perturbation: Annotated[
        dict[Literal["u", "u_velocity", "f"], Finite],
        BeforeValidator(_without_keys_of_studies),
        Unit({"u": "m", "u_velocity": "m/s", "f": "rad/s"}),
    ] = Field({}, description="what is added to coordinates of the start, u, u_velocity or f")


# ---- One case ready to be run, and its content address


class CaseSpec(Strict):
    """A case ready to be run: everything that a simulation depends on, and nothing else."""

    parameters: Parameters
    t_end: float
    tol: float = 1e-10
    stop_at: Literal["first_separation"] | None = None
    windows: tuple[tuple[str, Window], ...] = ()
    poincare: Poincare | None = None
    events: tuple[float, float] | Span | None = (
        None  # a span if it counts back from where the run stops
    )
    audit_every_step: bool = False
    start: Start = Start()
    ramps: tuple[Ramp, ...] = ()
    format: Literal[1] = FORMAT

    @property
    def sections(self) -> dict[str, Window | Poincare]:
        """Windows by name, and the Poincare section as ``poincare``, if it is recorded."""
        return {
            **dict(self.windows),
            **({} if self.poincare is None else {"poincare": self.poincare}),
        }

    @property
    def longest_sections(self) -> dict[str, Window | Poincare]:
        """The same, with absolute times in a run that does not stop before its end."""
        return dict(resolved_windows(self.sections, 0.0, self.t_end))

    def kept_events(self, stopped: float) -> tuple[float, float] | None:
        """From when to when (s) events are kept in a run that stopped at a time."""
        if isinstance(self.events, Span):
            return self.events.ends(0.0, stopped)
        return self.events

    @property
    def canonical(self) -> str:
        """JSON text that is equal for equal cases, however they were written; `model_validate_json`
        reads it."""
        return canonical_json(self.model_dump())

    @property
    def beside(self) -> str:
        """JSON text of all fields but the parameters."""
        return canonical_json(
            {name: x for name, x in json.loads(self.canonical).items() if name != "parameters"}
        )

    @property
    def key(self) -> str:
        """First 12 hexadecimal digits of the sha256 of `canonical`."""
        return content_key(self.canonical)


# ---- How a run is carried out


class Execution(Strict):
    """How a run is carried out. No setting changes the motion, but a run ends early after
    `max_steps`.

    Attributes
    ----------
    audit_every_step : whether to audit both energy balances on every step instead of every 256th
        (the run takes about ten times as long)
    progress : function that is called repeatedly with the time reached
    max_steps : largest number of steps; None sets a generous limit from the highest frequency

    Examples
    --------
    >>> import disc_model as dm
    >>> short = dm.simulate(dm.Parameters(N=385, Omega=15.1), 60, execution=dm.Execution(max_steps=100))
    >>> short.status.value
    'step_limit'
    """

    audit_every_step: bool = False
    progress: Callable[[float], object] | None = None
    max_steps: Annotated[Count, Field(ge=1)] | None = None
