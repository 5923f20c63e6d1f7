"""Study files: what a YAML file under config/ may say, checked all at once, and the cases it expands to.

A study of named cases has a name, base values, things to record by default, and the cases; each case inherits
the base and may override any of it. `load_study` reads such a file, `parse_study` takes the mapping itself;
both raise one `StudyError` that lists every fault with its path.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import Field, StringConstraints, model_validator

from disc_model.data.variables import SCALARS
from disc_model.errors import DiscModelError, ParameterError
from disc_model.figures.paper.catalogue import CATALOGUE, faults_of
from disc_model.parameters import Parameters
from disc_model.schema import Real, Strict, Tolerance
from disc_model.simulation.case import CaseSpec, Poincare, Start, Window
from disc_model.studies.files import (
    Faults,
    Origin,
    StudyError,
    add_parameter_faults,
    inherit,
    is_name,
    mapping,
    read_file,
    shown_path,
    validated,
)
from disc_model.truncation import AUTO, read_parameters

Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9_]*$")]
TAKEN = frozenset({"case", "message", "title", "reference", *SCALARS, *Parameters.model_fields})
"""Names of variables in a study's file. Cases and windows become groups beside them and must differ."""
TAKEN_WINDOWS = TAKEN | {"events", "poincare"}


class Span(Strict):
    """A stretch of time: ``{start, stop}`` in s, or ``{last: s}`` counted back from the end of the run.

    The last 20 s of a shorter run are all of it.
    """

    start: Annotated[Real, Field(ge=0, allow_inf_nan=False)] | None = None
    stop: Annotated[Real, Field(gt=0, allow_inf_nan=False)] | None = None
    last: Annotated[Real, Field(gt=0, allow_inf_nan=False)] | None = None

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

    rate: Annotated[Real, Field(gt=0, allow_inf_nan=False)]
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
    t_end: Annotated[Real, Field(gt=0, allow_inf_nan=False)]
    tol: Tolerance = 1e-10
    stop_at: Literal["first_separation"] | None = None
    start: Start = Start()
    record: RecordSpec = RecordSpec()


class _Header(Strict):
    """The parts of a study file that are not cases. `cases` is checked case by case."""

    study: Name
    title: str = ""
    base: dict[str, Any] = Field({})
    tol: Any = 1e-10
    record: dict[str, Any] = Field({})
    cases: Annotated[dict[str, Any], Field(min_length=1)]
    figures: tuple[str, ...] = ()
    studies: tuple[str, ...] = ()
    # of the grid studies; see disc_model.studies.grids.schema.load_grids
    overrides: dict[str, Any] = Field({})
    resolution: Any = 1


@dataclass(frozen=True)
class Study:
    """A checked study file. `cases` and `specs` have the same keys, in the order of the file.

    `studies` are files of grid studies that a run computes as well; * stands for any part of a name.
    """

    name: str
    title: str
    cases: Mapping[str, Case]
    specs: Mapping[str, CaseSpec]
    figures: tuple[str, ...]
    studies: tuple[str, ...]

    @property
    def labels(self) -> dict[str, dict[str, str]]:
        """What is written about the cases and does not change their results."""
        return {name: {"title": case.title, "reference": case.reference} for name, case in self.cases.items()}


def load_study(path: str | Path) -> Study:
    """Read and check a study file.

    Raises
    ------
    StudyError
        Listing every fault: wrong YAML, keys given twice, unknown keys, values that break a rule.
    """
    raw, faults = read_file(Path(path))
    return _with_more_faults(raw, faults, str(path))


def study_from_config(config: Any, files: Iterable[str | Path]) -> Study:
    """The study that Snakemake read from files, later ones over earlier ones, and its command line.

    Raises
    ------
    StudyError
        As `load_study`; keys given twice are looked for in the files, since the mapping no longer shows them.
    """
    paths = [Path(file) for file in files]
    faults = [fault for path in paths for fault in read_file(path)[1]]
    return _with_more_faults(config, faults, ", ".join(map(shown_path, paths)))


def parse_study(raw: Any) -> Study:
    """Check the mapping a study file holds; raises `StudyError` listing every fault."""
    faults = Faults()
    header = validated(_Header, raw, (), faults)
    raw = raw if isinstance(raw, Mapping) else {}
    cases: dict[str, Case] = {}
    specs: dict[str, CaseSpec] = {}
    for name, own in mapping(raw.get("cases")).items():
        case, spec = _parse_case(raw, str(name), own, faults)
        if case is not None and spec is not None:
            cases[str(name)], specs[str(name)] = case, spec
    _check_figures(raw, specs, faults)
    if faults or header is None:
        raise StudyError(*faults)
    return Study(header.study, header.title, cases, specs, header.figures, header.studies)


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
    parameters, truncation = read
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
    )
    return case, spec


def _parse_parameters(values: Any, place: Origin, faults: Faults) -> tuple[Parameters, str] | None:
    """Parameters, and how their modes were chosen."""
    if not isinstance(values, Mapping):
        return None  # already reported by the schema
    try:
        return read_parameters(values)
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


def _check_figures(raw: Mapping[str, Any], specs: Mapping[str, CaseSpec], faults: Faults) -> None:
    """Figures must exist and find their cases and windows in the study."""
    listed = raw.get("figures") or ()
    if isinstance(listed, str) or not isinstance(listed, Iterable):
        return
    known = set(mapping(raw.get("cases")))
    for i, name in enumerate(listed):
        path = ("figures", str(i))
        if not isinstance(name, str) or name not in CATALOGUE:
            faults.add(path, name, f"unknown figure (known: {', '.join(CATALOGUE)})")
            continue
        for case, windows in CATALOGUE[name].needs.items():
            if case not in known:
                faults.add(path, name, f"needs a case {case}")
            elif case in specs:
                recorded = dict(specs[case].windows)
                for window in windows:
                    if window not in recorded:
                        faults.add(path, name, f"needs a window {window} in cases.{case}.record.windows")
                        continue
                    for fault in faults_of(name, window, recorded[window]):
                        faults.add(path, name, f"cases.{case}.record.windows.{window} {fault}")
                if not windows and specs[case].poincare is None:
                    faults.add(path, name, f"needs cases.{case}.record.poincare")


# ----------------------------------------------------------------------------------------------------
# Plain helpers


def _with_more_faults(raw: Any, more: list[str], source: str) -> Study:
    """`parse_study`, with faults found already and the name of the file in the error."""
    try:
        study = parse_study(raw)
    except StudyError as error:
        raise StudyError(*more, *error.faults, source=source) from None
    if more:
        raise StudyError(*more, source=source)
    return study
