"""What is asked of a simulation: recorded windows, ramps, the start, and a case of a study as a text."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Annotated, Any, Literal, NamedTuple, Self

from pydantic import (
    AfterValidator,
    BeforeValidator,
    Field,
    StringConstraints,
    create_model,
    field_validator,
    model_validator,
)

from disc_model.data.variables import BESIDE_WINDOWS, TAKEN
from disc_model.errors import as_text, require
from disc_model.parameters import Parameters
from disc_model.provenance import content_key
from disc_model.units import Count, Finite, Positive, Real, Seconds, Strict, Tolerance, Unit, must

Time = Annotated[Real, Field(ge=0, allow_inf_nan=False), Unit("s")]
Stop = Annotated[Real, Field(ge=0), Unit("s")]
Angle = Annotated[Finite, Unit("rad")]
ROUNDING = 1e-9  # of a time at the end of a run, relative; of a sample's, in intervals


class SampleTimes(NamedTuple):
    """When samples are taken in a run, and at which point of the disc."""

    first: float  # s
    interval: float  # s
    number: int
    theta: float  # rad, angle of the point fixed to the disc
    end: float  # s, of the run


class Span(Strict):
    """A stretch of time: from `start` to `stop`, over the `last` seconds of the run, or over all of
    it."""

    start: Time = 0.0
    stop: Stop = math.inf
    last: Seconds | None = None

    @model_validator(mode="after")
    def _possible(self) -> Self:
        alone = self.last is None or (self.start == 0 and self.stop == math.inf)
        require(
            (self.start <= self.stop, "start", self.start, f"must be <= stop={as_text(self.stop)}"),
            (alone, "last", self.last, "must not be given beside start or stop"),
        )
        return self

    def ends(self, start: float, t_end: float) -> tuple[float, float]:
        """Absolute times of its ends, s, for a run from ``start`` to ``t_end``, even if they are
        not within the run."""
        if self.last is not None:
            return max(t_end - self.last, start), t_end
        if self.stop == math.inf:
            return self.start, t_end
        return self.start, self.stop


class Sampled(Span):
    """Samples an interval apart in a stretch of time, of the disc point at `theta` (rad), fixed to the
    disc."""

    theta: Angle = 1.0

    def clock(self, p: Parameters) -> tuple[float, float]:
        """A time at which there is a sample if it is in the stretch, and the interval, s."""
        raise NotImplementedError

    def grid(self, p: Parameters, start: float, t_end: float) -> SampleTimes:
        """When samples are taken in a run of the case from ``start`` to ``t_end``, s, before they are
        combined to an envelope; for absolute times of the ends."""
        origin, interval = self.clock(p)
        interval = min(interval, sys.float_info.max)
        begin = (max(self.start, start) - origin) / interval
        end = (min(self.stop, t_end) - origin) / interval
        first = math.ceil(begin - ROUNDING)
        # the last one may be rounded to behind the end; as many samples are refused by what holds them
        last = math.floor(min(end * (1 + 1e-15) + ROUNDING, 2.0**62))
        number = max(0, last - first + 1)
        return SampleTimes(origin + first * interval, interval, number, self.theta, t_end)


class Window(Sampled):
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
    envelope: Annotated[Count, Field(ge=2, le=2**53)] | None = None

    @property
    def count(self) -> int:
        """Number of samples from `start` to `stop`, before they are combined to an envelope."""
        return math.floor((self.stop - self.start) * self.rate + ROUNDING) + 1

    def clock(self, p: Parameters) -> tuple[float, float]:
        return self.start, 1 / self.rate


class Poincare(Sampled):
    """One sample per turn of the drive, at t = i 2 pi/Omega, with `start`, `stop`, `last` and `theta` as
    of a `Window`.

    Examples
    --------
    >>> import disc_model as dm
    >>> run = dm.simulate(dm.Parameters(N=385, Omega=15.1), 1, {"turns": dm.Poincare()})
    >>> run["turns"]["time"].values.round(4)
    array([0.    , 0.4161, 0.8322])
    """

    def clock(self, p: Parameters) -> tuple[float, float]:
        turn = math.inf
        if p.Omega > 0:
            turn = math.tau / p.Omega
        return 0.0, turn


Windows = Mapping[str, Window | Poincare]  # samples to keep, by their names


def resolved_windows(windows: Windows, start: float, t_end: float) -> Windows:
    """Windows by name with absolute times, for a run from ``start`` to ``t_end``. One may end before
    the run starts, as parts of a run may share windows, but not begin after its end. Raises
    `ParameterError`."""
    resolved: dict[str, Window | Poincare] = {}
    for name, window in windows.items():
        path = f"windows.{name}"
        length = window.last or 0.0
        require(
            (window.start <= t_end, f"{path}.start", window.start,
             f"must be <= {as_text(t_end)}, where the run ends"),
            (t_end - length >= start - ROUNDING * t_end, f"{path}.last", length,
             f"must be <= {as_text(t_end - start)} s, the length of the run"),
        )  # fmt: skip
        first, stop = window.ends(start, t_end)
        resolved[name] = window.replace(start=first, stop=stop, last=None)
    return resolved


# ---- Slow ramps of the drive speed or of the preload, and the values of Omega and N at any time


class Ramp(Strict):
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
    >>> round(braked.final_state.drive_angle, 3)  # 15.1 + 3 * 10.05 + 5 rad
    50.25

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
    def _possible(self) -> Self:
        require(
            (self.parameter != "N" or self.to > 0, "to", self.to, "must be > 0 for N"),
            (self.start < self.end, "start", self.start, f"must be < end={as_text(self.end)}"),
        )
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
        since = time - max(self.begin, 0.0)  # before any ramp, since the time 0
        return self.angle + (self.Omega + 0.5 * self.Omega_rate * since) * since

    def from_time(self, time: float) -> Piece:
        """The later part of the interval, from a time on."""
        since = time - max(self.begin, 0.0)
        Omega = self.Omega + self.Omega_rate * since
        N = self.N + self.N_rate * since
        return self._replace(begin=time, angle=self.angle_at(time), Omega=Omega, N=N)


def check_ramps(p: Parameters, ramps: Sequence[Ramp], windows: Windows) -> None:
    """Raise `ParameterError` if a case cannot have these ramps, or such windows with them."""
    require((not ramps or p.N > 0, "N", p.N, "must be > 0 where there are ramps"))
    order = sorted(enumerate(ramps), key=lambda pair: (pair[1].parameter, pair[1].start))
    for (_, before), (i, ramp) in pairwise(order):
        apart = before.parameter != ramp.parameter or ramp.start >= before.end
        rule = (
            f"must be >= {as_text(before.end)}, where the ramp of {ramp.parameter} before it ends"
        )
        require((apart, f"ramps.{i}.start", ramp.start, rule))
    if any(ramp.parameter == "Omega" for ramp in ramps):
        rule = "must be no Poincare on ramps of Omega: the drive has no period there"
        for name, window in windows.items():
            require((not isinstance(window, Poincare), f"windows.{name}", window, rule))


def pieces(p: Parameters, ramps: Sequence[Ramp]) -> tuple[Piece, ...]:
    """The intervals of constant rates, in order, the first before any ramp; ramps to the present
    value do not count."""
    knots = []  # time, parameter, its value there and its rate from there on
    for name in ("Omega", "N"):
        value = getattr(p, name)
        for ramp in sorted(ramps, key=lambda ramp: ramp.start):
            if ramp.parameter == name and ramp.to != value:
                rate = (ramp.to - value) / (ramp.end - ramp.start)
                knots += [(ramp.start, name, value, rate), (ramp.end, name, ramp.to, 0.0)]
                value = ramp.to
    now = Piece(-math.inf, math.inf, 0.0, p.Omega, 0.0, p.N, 0.0)
    parts: list[Piece] = []
    for time, name, value, rate in sorted(knots, key=lambda knot: knot[0]):
        if time > now.begin:
            parts.append(now._replace(end=time))
            now = now.from_time(time)
        now = now._replace(**{name: value, f"{name}_rate": rate})
    return (*parts, now)


def angle_of_drive(intervals: Sequence[Piece], time: float) -> float:
    """Angle by which the drive point has turned since the time 0, rad, from `pieces`."""
    now = next(piece for piece in reversed(intervals) if piece.begin <= time)
    return now.angle_at(time)


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


class Start(Strict):
    """The state from which a motion starts: the static start, unless one of these keys is given.

    prerun : after another motion, such as one that has separated
    u, u_velocity : m and m/s, added to the state of the slider and of the disc under it
    f : rad/s, added to the slider's angular velocity
    """

    prerun: Prerun | None = Field(
        None, description="another case that is simulated first, with parameters and time"
    )
    u: Annotated[Finite, Unit("m")] = 0.0
    u_velocity: Annotated[Finite, Unit("m/s")] = 0.0
    f: Annotated[Finite, Unit("rad/s")] = 0.0


# ---- Named cases of studies, and their content addresses

Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z]\w*$", max_length=100)]
WindowName = Annotated[
    str,
    StringConstraints(pattern=r"^\w([^/]*[^/\s])?$", max_length=60),  # of a group in files
    AfterValidator(must(lambda name: name not in BESIDE_WINDOWS, TAKEN)),
]
_CALLED = {"title", "reference"}


def without_null(parts: dict[str, Any]) -> dict[str, Any]:
    """The parts of a file that null does not drop."""
    return {name: part for name, part in parts.items() if part is not None}


class RecordSpec(Strict):
    """What is recorded of a case. Figures and claims refer to windows by their names."""

    windows: Annotated[dict[WindowName, Window | None], AfterValidator(without_null)] = Field({})
    poincare: Poincare | None = None
    events: bool | Span = True

    @property
    def sections(self) -> dict[str, Window | Poincare]:
        """Windows by name, and the Poincare section as ``poincare``, if it is recorded."""
        return without_null({**self.windows, "poincare": self.poincare})


class CaseSpec(Strict):
    """A named simulation of a study: what it depends on, and how it is called."""

    title: str = ""
    reference: str = ""
    parameters: Annotated[
        Parameters,
        BeforeValidator(Parameters.model_validate, json_schema_input_type=SomeParameters),
    ]
    t_end: Seconds
    tol: Tolerance = 1e-10
    stop_at: Literal["first_separation"] | None = None
    start: Start = Start()
    ramps: tuple[Ramp, ...] = ()
    record: RecordSpec = RecordSpec()

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        """Check the rules between the values of the case."""
        check_ramps(self.parameters, self.ramps, self.longest_sections)
        return self

    @property
    def longest_sections(self) -> Windows:
        """What is recorded, with absolute times in a run that does not stop before its end."""
        return resolved_windows(self.record.sections, 0.0, self.t_end)

    @property
    def canonical(self) -> str:
        """JSON text that is equal for equal cases, however they were written and are called;
        `model_validate_json` reads it."""
        return json.dumps(self.model_dump(mode="json", exclude=_CALLED), sort_keys=True)

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
    max_steps : largest number of steps; None sets a generous limit from the highest frequency

    Examples
    --------
    >>> import disc_model as dm
    >>> short = dm.simulate(dm.Parameters(N=385, Omega=15.1), 60, execution=dm.Execution(max_steps=100))
    >>> short.status.value
    'step_limit'
    """

    audit_every_step: bool = False
    max_steps: Annotated[Count, Field(ge=1)] | None = None
