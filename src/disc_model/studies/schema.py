"""Study files: one kind of YAML, which says a grid, named cases, or both, and is checked all at once.

`load_study` reads such a file, `study_from_config` takes what Snakemake read from one or several, `parse_study` the
mapping itself. All raise one `StudyError` that lists every fault with its path. Each case inherits the study's base
values and what is recorded by default, and may override any of it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from glob import glob
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from disc_model.data.variables import BESIDE_WINDOWS, SCALARS
from disc_model.errors import DiscModelError, ParameterError, suggestion
from disc_model.figures.kinds import CASE_PLOTS, PLOTS, CasePlot
from disc_model.figures.paper.catalogue import CATALOGUE, lacking
from disc_model.parameters import AUTO, Parameters, Positive, Real, Strict, Tolerance, leaves_modes
from disc_model.plausibility import RULES
from disc_model.simulation.case import CaseSpec, Poincare, Start, Window
from disc_model.simulation.ramps import Ramp
from disc_model.simulation.ramps import faults as ramp_faults
from disc_model.studies.files import (
    Faults,
    Name,
    Origin,
    StudyError,
    add_parameter_faults,
    inherit,
    is_name,
    mapping,
    read_file,
    shown_path,
    validated,
    with_more_faults,
)
from disc_model.studies.grids.schema import GRID_KEYS, GridStudy, load_grids, parse_grid
from disc_model.studies.modes import to_text
from disc_model.truncation import FREQUENCIES, by_frequencies, read_asked

TAKEN = ("compiled", "bench")
"""Folders of results that no study may have."""
TAKEN_CASES = frozenset({"case", "message", "title", "reference", *SCALARS, *Parameters.model_fields})
"""Names of variables in a study's file. Cases and windows become groups beside them and must differ."""
TAKEN_WINDOWS = TAKEN_CASES | BESIDE_WINDOWS

# ----------------------------------------------------------------------------------------------------
# What a file may say


class Document(Strict):
    """A study file. What its parts may say is checked part by part.

    study : name of the study, and of its folder of results
    title : what it is about
    base : parameters of all cases and of all points; the rest is Table 1 of the paper
    figures : by name, what each shows; or a list of the paper's
    cases : named simulations; `tol` and `record` are what they share
    claims : whether the paper's statements and tables are to be checked against the cases
    quantity, options, axes, zip, batch, starts : a grid; see `disc_model.studies.grids.schema`
    studies : further files of grid studies, * stands for any part of a name
    overrides : by name, what is laid over one of those files
    resolution : whole number by which the intervals of all ranges are divided
    """

    study: Name
    title: str = ""
    base: dict[str, Any] = Field({})
    figures: Any = ()
    tol: Any = 1e-10
    record: dict[str, Any] = Field({})
    cases: Annotated[dict[str, Any], Field(min_length=1)] = Field({}, validate_default=False)
    claims: bool = False
    quantity: Any = None
    options: Any = None
    axes: Any = None
    zip: Any = None
    batch: Any = None
    starts: Any = None
    studies: tuple[str, ...] = ()
    overrides: dict[str, Any] = Field({})
    resolution: Any = 1


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


# ----------------------------------------------------------------------------------------------------
# Studies


@dataclass(frozen=True)
class Study:
    """A checked study. `cases` and `specs` have the same keys, in the order of the file.

    Attributes
    ----------
    figures : those of the paper that are asked for
    plots : figures of cases, by name
    claims : whether the paper's statements are checked against the cases
    grid : the file's own grid, if it says one
    studies : files of further grid studies; * stands for any part of a name
    """

    name: str
    title: str
    cases: Mapping[str, Case]
    specs: Mapping[str, CaseSpec]
    figures: tuple[str, ...]
    plots: Mapping[str, CasePlot]
    claims: bool
    grid: GridStudy | None
    studies: tuple[str, ...]
    overrides: Mapping[str, Any]
    resolution: Any

    @property
    def labels(self) -> dict[str, dict[str, str]]:
        """What is written about the cases and does not change their results."""
        return {name: {"title": case.title, "reference": case.reference} for name, case in self.cases.items()}

    @property
    def drawable(self) -> tuple[str, ...]:
        """Figures that these cases have all that is needed for: of the paper, and of cases."""
        return (*(name for name in CATALOGUE if not list(lacking(name, self.specs))), *self.plots)

    @property
    def doubts(self) -> Iterator[str]:
        """What is implausible about its cases, each with their number."""
        for rule in RULES.values():
            if found := [text for spec in self.specs.values() if (text := rule.doubt(spec.parameters))]:
                yield f"{found[0]} ({len(found)} of {len(self.specs)} cases)"

    def grids(self, folders: Sequence[Path] = (Path(),)) -> tuple[dict[str, GridStudy], tuple[str, ...]]:
        """Its own grid and those of its files, and the names of those that are asked for.

        Besides them there are those that a figure of its own grid shows as well, read from files beside it.

        Parameters
        ----------
        folders : where files are looked for, the first that has one counts
        """
        paths = [path for pattern in self.studies for path in _found(pattern, folders)]
        own = {} if self.grid is None else {self.name: self.grid}
        asked = (*own, *(Path(path).stem for path in paths))
        plots = {} if self.grid is None else self.grid.plots
        shown = {name for plot in plots.values() for name in plot.others.values()}.difference(asked)
        helpers = [path for name in sorted(shown) for path in _found(f"{name}.yaml", folders) if Path(path).is_file()]
        taken = {*TAKEN} if self.grid is not None else {self.name, *TAKEN}
        grids = load_grids([*paths, *helpers], self.overrides, self.resolution, taken=taken, own=own, asked=asked)
        return grids, asked


def load_study(path: str | Path) -> Study:
    """Read and check a study file, but for the files that it names."""
    raw, faults = read_file(Path(path))
    return with_more_faults(parse_study, raw, faults, str(path))


def study_from_config(config: Any, files: Iterable[str | Path]) -> Study:
    """The study that Snakemake read from files, later ones over earlier ones, and its command line.

    Keys given twice are looked for in the files, since the mapping no longer shows them.
    """
    paths = [Path(file) for file in files]
    faults = [fault for path in paths for fault in read_file(path)[1]]
    return with_more_faults(parse_study, config, faults, ", ".join(map(shown_path, paths)) or "study")


def parse_study(raw: Any) -> Study:
    """Check the mapping that a study file holds."""
    faults = Faults()
    header = validated(Document, raw, (), faults)
    raw = mapping(raw)
    if header is not None and header.study in TAKEN:
        faults.add(("study",), header.study, "is the name of another folder of results")
    if not raw.keys() & {"cases", "studies", *GRID_KEYS}:
        faults.add((), "", "must say what to compute: cases, or quantity and axes, or studies")
    parsed = {str(name): _parse_case(raw, str(name), own, faults) for name, own in mapping(raw.get("cases")).items()}
    right = {name: case for name, case in parsed.items() if case is not None}
    specs = {name: spec for name, (_, spec) in right.items()}
    listed, plots, of_grid = _figures(raw, specs, faults)
    grid = _grid(raw, of_grid, faults) if raw.keys() & GRID_KEYS else None
    if faults or header is None:
        raise StudyError(*faults)
    cases = {name: case for name, (case, _) in right.items()}
    return Study(
        header.study, header.title, cases, specs, listed, plots, header.claims, grid, header.studies,
        header.overrides, header.resolution,
    )  # fmt: skip


# ----------------------------------------------------------------------------------------------------
# Cases


def _parse_case(raw: Mapping[str, Any], name: str, own: Any, faults: Faults) -> tuple[Case, CaseSpec] | None:
    """A case and what it amounts to, if all of it is right."""
    path = ("cases", name)
    if not is_name(name):
        faults.add(path, "", "a case's name must be letters, digits and _, starting with a letter")
    if name in TAKEN_CASES:
        faults.add(path, "", "a case must not be called so, the name is taken by a variable")
    if not isinstance(own, Mapping):
        faults.add(path, own, "must be a mapping")
        return None
    said = {"parameters": raw.get("base"), "record": raw.get("record"), "tol": raw.get("tol")}
    inherited = {key: value for key, value in said.items() if value is not None}
    whole = inherit(inherited, own)
    place = Origin(path, own, inherited)
    case = validated(Case, whole, path, faults, place)
    read = _parse_parameters(whole.get("parameters", {}), place, faults)
    if case is None:
        return None
    windows = _resolve_windows(case, place, faults)
    events = _resolve_events(case, place, faults)
    if read is None or windows is None:
        return None
    parameters, truncation, modes = read
    if case.ramps:
        wrong = ramp_faults(parameters, case.ramps, poincare=case.record.poincare is not None)
        keys = Case.model_fields
        add_parameter_faults(wrong, lambda name: place.of((name,) if name in keys else ("parameters", name)), faults)
    kept = {"windows": windows, "poincare": case.record.poincare, "events": events, "energy": case.record.energy}
    how = {name: getattr(case, name) for name in ("t_end", "tol", "stop_at", "start", "ramps")}
    return case, CaseSpec(parameters=parameters, truncation=truncation, modes=modes, **kept, **how)


def _parse_parameters(values: Any, place: Origin, faults: Faults) -> tuple[Parameters, str, str] | None:
    """Parameters, and how their modes were chosen, or by what they are to be chosen when the case is run."""
    if not isinstance(values, Mapping):
        return None  # already reported by the schema
    try:
        if not leaves_modes(values):
            return Parameters.model_validate(values), "", ""
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


# ----------------------------------------------------------------------------------------------------
# The grid, and figures


def _grid(raw: Mapping[str, Any], figures: Mapping[str, Any], faults: Faults) -> GridStudy | None:
    """The file's own grid, with those of the figures that show it."""
    said = {key: value for key, value in raw.items() if key in GRID_KEYS or key in ("study", "title", "base")}
    try:
        return parse_grid(said | {"figures": figures}, raw.get("resolution", 1))
    except StudyError as error:
        for fault in error.faults:
            faults.add_text(fault)
        return None


def _figures(
    raw: Mapping[str, Any], specs: Mapping[str, CaseSpec], faults: Faults
) -> tuple[tuple[str, ...], dict[str, CasePlot], dict[str, Any]]:
    """The paper's figures that are listed, those of cases, and what is said of those of the grid."""
    given = raw.get("figures") or ()
    if isinstance(given, Mapping):
        plots, of_grid = {}, {}
        for name, said in given.items():
            kind = mapping(said).get("kind")
            if not isinstance(kind, str) or kind not in {*CASE_PLOTS, *PLOTS}:
                known = (*CASE_PLOTS, *PLOTS)
                faults.add(("figures", str(name), "kind"), kind, f"unknown kind of figure{suggestion(kind, known)}")
            elif kind in CASE_PLOTS:
                plot = _case_plot(str(name), kind, said, raw, specs, faults)
                if plot is not None:
                    plots[str(name)] = plot
            elif raw.keys() & GRID_KEYS:
                of_grid[name] = said
            else:
                faults.add(("figures", str(name), "kind"), kind, "shows a grid, and this study has none")
        return (), plots, of_grid
    if isinstance(given, str) or not isinstance(given, Iterable):
        faults.add(("figures",), given, "must be a mapping of names to {kind: ...}, or a list of the paper's figures")
        return (), {}, {}
    _check_listed(given, raw, specs, faults)
    return tuple(map(str, given)), {}, {}


def _case_plot(
    name: str, kind: str, said: Any, raw: Mapping[str, Any], specs: Mapping[str, CaseSpec], faults: Faults
) -> CasePlot | None:
    path = ("figures", name)
    if not name.isidentifier() or name in CATALOGUE:
        faults.add(path, "", "a figure's name must be letters, digits and _, and not that of one of the paper's")
    plot = validated(CASE_PLOTS[kind], said, path, faults)
    if plot is None:
        return None
    cases = {str(case): specs[case].sections if case in specs else None for case in mapping(raw.get("cases"))}
    for place, value, rule in plot.faults(cases):
        faults.add((*path, *place), value, rule)
    return plot


def _check_listed(given: Iterable[Any], raw: Mapping[str, Any], specs: Mapping[str, CaseSpec], faults: Faults) -> None:
    """Figures of the paper must exist and find their cases and windows in the study."""
    known = set(mapping(raw.get("cases")))
    for i, name in enumerate(given):
        path = ("figures", str(i))
        if not isinstance(name, str) or name not in CATALOGUE:
            faults.add(path, name, f"unknown figure{suggestion(name, CATALOGUE)}")
            continue
        for case, fault in lacking(name, specs):
            if case in specs or case not in known:  # else the case has faults of its own
                faults.add(path, name, fault)


# ----------------------------------------------------------------------------------------------------
# Files


def _found(pattern: str, folders: Sequence[Path]) -> list[str]:
    """Files that a pattern stands for, in the first folder that has any; the pattern itself if none has."""
    for folder in folders:
        if matches := sorted(glob(str(folder / pattern))):
            return matches
    return [pattern]
