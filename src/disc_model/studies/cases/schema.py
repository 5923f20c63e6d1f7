"""Named cases: what a study file may say of them, and what they expand to.

Each case inherits the study's base values and what is recorded by default, and may override any of it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import Field, StringConstraints, model_validator

from disc_model.data.variables import BESIDE_WINDOWS, SCALARS
from disc_model.errors import DiscModelError, ParameterError
from disc_model.parameters import Parameters
from disc_model.schema import Positive, Real, Strict, Tolerance
from disc_model.simulation.case import CaseSpec, Poincare, Start, Window
from disc_model.simulation.ramps import Ramp
from disc_model.simulation.ramps import faults as ramp_faults
from disc_model.studies.files import (
    Faults,
    Origin,
    add_parameter_faults,
    inherit,
    is_name,
    mapping,
    validated,
)
from disc_model.studies.modes import to_text
from disc_model.truncation import AUTO, FREQUENCIES, by_frequencies, read_asked

Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9_]*$")]
TAKEN = frozenset({"case", "message", "title", "reference", *SCALARS, *Parameters.model_fields})
"""Names of variables in a study's file. Cases and windows become groups beside them and must differ."""
TAKEN_WINDOWS = TAKEN | BESIDE_WINDOWS


class Span(Strict):
    """A stretch of time: ``{start, stop}`` in s, or ``{last: s}`` counted back from the end of the run.

    The last 20 s of a shorter run are all of it.
    """

    start: Annotated[Real, Field(ge=0, allow_inf_nan=False)] | None = None
    stop: Positive | None = None
    last: Positive | None = None

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if self.last is not None and (self.start is not None or self.stop is not None):
            raise ValueError("must give either last, or start and stop")
        return self

    def resolve(self, t_end: float) -> tuple[float, float]:
        """Start and stop in s; raises ValueError if they do not lie within [0, t_end] in this order."""
        stop = t_end if self.stop is None else self.stop
        start = (self.start or 0.0) if self.last is None else max(t_end - self.last, 0.0)
        if not 0 <= start < stop <= t_end:
            raise ValueError(f"must be within the run: 0 <= start={start:g} < stop={stop:g} <= t_end={t_end:g}")
        return start, stop


class WindowSpec(Span):
    """Uniform samples over a span; see `disc_model.Window` for `rate`, `theta` and `envelope`."""

    rate: Positive
    theta: Real = 1.0
    envelope: Annotated[int, Field(ge=2)] | None = None

    def window(self, t_end: float) -> Window:
        """The window; an envelope leaves out the instant `stop`, which would be a bin of its own."""
        start, stop = self.resolve(t_end)
        if self.envelope is not None:
            stop = max(stop - 0.5 / self.rate, start + 0.25 / self.rate)
        return Window(start=start, stop=stop, rate=self.rate, theta=self.theta, envelope=self.envelope)


class RecordSpec(Strict):
    """What a case keeps. Windows bear names, under which figures and claims find them."""

    windows: dict[Name, WindowSpec] = Field({})
    poincare: Poincare | None = None
    events: bool | Span = True
    energy: bool = False


class Case(Strict):
    """One named simulation of a study."""

    title: str
    reference: str = ""
    parameters: dict[str, Any] = Field({})
    t_end: Positive
    tol: Tolerance = 1e-10
    stop_at: Literal["first_separation"] | None = None
    start: Start = Start()
    ramps: tuple[Ramp, ...] = ()
    record: RecordSpec = RecordSpec()


_KEYS = frozenset(Case.model_fields)


def parse_cases(raw: Mapping[str, Any], faults: Faults) -> tuple[dict[str, Case], dict[str, CaseSpec]]:
    """The cases of a study that are right, and what each amounts to; adds to `faults` what is wrong with the others."""
    cases: dict[str, Case] = {}
    specs: dict[str, CaseSpec] = {}
    for name, own in mapping(raw.get("cases")).items():
        case, spec = _parse_case(raw, str(name), own, faults)
        if case is not None and spec is not None:
            cases[str(name)], specs[str(name)] = case, spec
    return cases, specs


# ----------------------------------------------------------------------------------------------------
# One case


def _parse_case(raw: Mapping[str, Any], name: str, own: Any, faults: Faults) -> tuple[Case | None, CaseSpec | None]:
    path = ("cases", name)
    if not is_name(name):
        faults.add(path, "", "a case's name must be letters, digits and _, starting with a letter")
    if name in TAKEN:
        faults.add(path, "", "a case must not be called so, the name is taken by a variable")
    if not isinstance(own, Mapping):
        faults.add(path, own, "must be a mapping")
        return None, None
    said = {"parameters": raw.get("base"), "record": raw.get("record"), "tol": raw.get("tol")}
    inherited = {key: value for key, value in said.items() if value is not None}
    whole = inherit(inherited, own)
    place = Origin(path, own, inherited)
    case = validated(Case, whole, path, faults, place)
    read = _parse_parameters(whole.get("parameters", {}), place, faults)
    if case is None:
        return None, None
    windows = _resolve_windows(case, place, faults)
    events = _resolve_events(case, place, faults)
    if read is None or windows is None:
        return case, None
    parameters, truncation, modes = read
    wrong = ramp_faults(parameters, case.ramps, poincare=case.record.poincare is not None)
    add_parameter_faults(wrong, lambda name: place.of((name,) if name in _KEYS else ("parameters", name)), faults)
    spec = CaseSpec(
        parameters,
        case.t_end,
        case.tol,
        case.stop_at,
        windows,
        case.record.poincare,
        events,
        case.record.energy,
        case.start,
        truncation,
        modes,
        case.ramps,
    )
    return case, spec


def _parse_parameters(values: Any, place: Origin, faults: Faults) -> tuple[Parameters, str, str] | None:
    """Parameters, and how their modes were chosen, or by what they are to be chosen when the case is run."""
    if not isinstance(values, Mapping):
        return None  # already reported by the schema
    try:
        p, asked = read_asked(values)
        if asked is None:
            return p, "", ""
        if asked.quantity != FREQUENCIES:
            return p, "", to_text(asked)
        choice = by_frequencies(p, asked.tolerance)
        return choice.parameters, choice.to_json(), ""
    except ParameterError as error:
        add_parameter_faults(error.faults, lambda name: place.of(("parameters", name)), faults)
    except DiscModelError as error:  # no number of modes meets the tolerance
        faults.add(place.of(("parameters", "n_diameters")), AUTO, str(error))
    return None


def _resolve_windows(case: Case, place: Origin, faults: Faults) -> tuple[tuple[str, Window], ...] | None:
    windows = []
    for name, spec in case.record.windows.items():
        path = place.of(("record", "windows", name))
        if name in TAKEN_WINDOWS:
            faults.add(path, "", "a window must not be called so, the name is taken by a variable or group")
        try:
            windows.append((name, spec.window(case.t_end)))
        except ValueError as error:
            faults.add(path, "", str(error))
    return tuple(windows) if len(windows) == len(case.record.windows) else None


def _resolve_events(case: Case, place: Origin, faults: Faults) -> tuple[float, float] | None:
    if isinstance(case.record.events, bool):
        return (0.0, case.t_end) if case.record.events else None
    try:
        return case.record.events.resolve(case.t_end)
    except ValueError as error:
        faults.add(place.of(("record", "events")), "", str(error))
        return None
