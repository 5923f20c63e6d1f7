"""Studies: their files are read and checked, and yield named cases and grids.

One `StudyError` lists all faults: those of single values, or those between values once these are
right.
"""

import os
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property, reduce
from glob import glob
from pathlib import Path
from typing import Annotated, Any, Literal, Self

import pydantic
from pydantic import (
    AfterValidator,
    BeforeValidator,
    Field,
    PlainValidator,
    PrivateAttr,
    WithJsonSchema,
    create_model,
)

from disc_model.data.variables import BESIDE_WINDOWS, SCALARS, rule_of_taken, values_text
from disc_model.disc.table import disc_of_table
from disc_model.errors import Fault, ParameterError, raise_faults, suggestion
from disc_model.figures.schema import NORM, CasePlot, Kind, Plot, Role
from disc_model.parameters import RATIOS, Disc, Parameters
from disc_model.simulation.case import (
    CaseSpec,
    Poincare,
    Ramp,
    SomeParameters,
    Span,
    Start,
    Window,
    ramp_faults,
)
from disc_model.studies.grid import GRID_KEYS, BatchSpec, Columns, FigureEntry, GridStudy, described
from disc_model.studies.options import Option, options_of
from disc_model.studies.quantity import compiled_rule
from disc_model.studies.reading import StudyError, read_file
from disc_model.studies.registry import quantity_names, quantity_of
from disc_model.units import Positive, Seconds, Strict, Tolerance

MODES = {
    "as_published": "modes scaled as in the published results",
    "orthonormal": "modes normalised as Eq. (17) says",
}

# ---- Reading


def mapping(value: Any) -> Mapping[Any, Any]:
    """The value if it is a mapping, else an empty one."""
    return value if isinstance(value, Mapping) else {}


def inherit(base: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """`changes` over `base`, mappings merged key by key; None drops what is inherited."""
    merged = dict(base)
    for key, value in changes.items():
        if value is None and key in base:
            del merged[key]
        elif isinstance(value, Mapping) and isinstance(merged.get(key), Mapping):
            merged[key] = inherit(merged[key], value)
        else:
            merged[key] = value
    return merged


# ---- Names
TAKEN = frozenset({"case", "message", "title", "reference", *SCALARS, *Parameters.model_fields})
"""Names of variables in a study's file. Cases and windows become groups beside them and must differ."""


def _no_folder(name: str) -> str:
    """The name of a study, which is not that of another folder of results."""
    if name in ("compiled", "bench"):
        raise ValueError("is the name of another folder of results")
    return name


def _no_variable(name: str) -> str:
    """The name of a case, which is not that of a parameter or of another variable."""
    if name in TAKEN:
        raise ValueError(f"{rule_of_taken(name)}; case_{name} would do")
    return name


def _no_group(name: str) -> str:
    """The name of a window, which is not that of a parameter, variable or group of results."""
    if name in TAKEN | BESIDE_WINDOWS:
        raise ValueError(f"{rule_of_taken(name)}; window_{name} would do")
    return name


_LETTERS = pydantic.StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9_]*$", max_length=100)
Name = Annotated[str, _LETTERS]
CaseName = Annotated[Name, AfterValidator(_no_variable)]
WindowName = Annotated[Name, AfterValidator(_no_group)]

# ---- Named cases


class RecordSpec(Strict):
    """What is recorded of a case. Figures and claims refer to windows by their names."""

    windows: dict[WindowName, Window | None] = Field({})  # None drops one that is inherited
    poincare: Poincare | None = None
    events: bool | Span = True


_ratios: dict[str, Any] = {
    name: (Positive | None, Field(None, **described(name))) for name in RATIOS
}
GivenParameters = create_model("GivenParameters", __base__=SomeParameters, **_ratios)
"""Parameters, or ratios of them, any of which may be left out."""


def _mapping(raw: Any) -> Mapping[str, Any]:
    if not isinstance(raw, Mapping):
        raise ValueError("must be a mapping")
    return raw


class NamedCase(Strict):
    """One named simulation of a study."""

    title: str = ""
    reference: str = ""
    parameters: Annotated[
        Parameters,
        PlainValidator(
            lambda raw: Parameters.model_validate(_mapping(raw)),
            json_schema_input_type=GivenParameters,
        ),
    ] = Field({}, validate_default=True)
    t_end: Seconds
    tol: Tolerance = 1e-10
    stop_at: Literal["first_separation"] | None = None
    start: Start = Start()
    ramps: tuple[Ramp, ...] = ()
    record: RecordSpec = RecordSpec()

    @cached_property
    def spec(self) -> CaseSpec:
        """What is simulated; raises `ParameterError` with places inside the case."""
        p = self.parameters
        spans, faults = self._spans()
        if self.ramps:
            for fault in ramp_faults(p, self.ramps, poincare=self.record.poincare is not None):
                if fault.path[0] in Parameters.model_fields:
                    fault = fault.inside(("parameters",))
                faults.append(fault)
        raise_faults(faults)

        events = spans.pop(("events",), None)
        return CaseSpec(
            parameters=p,
            t_end=self.t_end,
            tol=self.tol,
            stop_at=self.stop_at,
            windows=tuple((name, window) for (_, name), window in spans.items()),
            poincare=self.record.poincare,
            events=self._kept_events(events),
            start=_with_ratios_of(p, self.start),
            ramps=self.ramps,
        )

    def _kept_events(self, span: Span | None) -> tuple[float, float] | Span | None:
        """The span of time whose events are kept, as `CaseSpec` states it."""
        if span is None or span.last is not None:
            return span
        return span.start, span.stop

    def _spans(self) -> tuple[dict[tuple[str, ...], Any], list[Fault]]:
        """Spans of time that are recorded, by their places in the record, resolved in the run unless
        they count back from where it stops; and faults of those that are not within it."""
        record = self.record
        spans: dict[tuple[str, ...], Any] = {}
        for name, window in record.windows.items():
            if window is not None:
                spans["windows", name] = window
        if record.events is True:
            spans["events",] = Span()
        elif record.events:
            spans["events",] = record.events
        faults = []
        for path, span in spans.items():
            start, stop = span.ends(0.0, self.t_end)
            counts_back = self.stop_at is not None and span.last is not None and start > 0
            if counts_back:
                continue
            if 0 <= start < stop <= self.t_end:
                spans[path] = span.resolved(0.0, self.t_end)
            else:
                rule = f"0 <= start={start:g} < stop={stop:g} <= t_end={self.t_end:g}"
                place = ("record", *path)
                faults.append(Fault(place, "", f"must be within the run: {rule}"))
        return spans, faults

    @pydantic.model_validator(mode="after")
    def _consistent(self) -> Self:
        """Check the rules between the values of the case."""
        self.spec  # noqa: B018
        return self


def _with_ratios_of(p: Parameters, start: Start) -> Start:
    """The start with the numbers that follow, in its prerun, from ratios by which the case is
    given, since the text of a `CaseSpec` has no ratios. Raises `ParameterError` with places in the
    case."""
    if start.prerun is None:
        return start
    changed = start.prerun.parameters
    try:
        before = p.replace(**changed)
    except ParameterError as error:
        place = ("start", "prerun", "parameters")
        raise ParameterError(*(fault.inside(place) for fault in error.faults)) from None
    followers = {upper for upper, lower in RATIOS.values() if lower in changed}
    differing = [name for name in followers if getattr(before, name) != getattr(p, name)]
    values = changed | {name: getattr(before, name) for name in sorted(differing)}
    return start.replace(prerun=start.prerun.replace(parameters=values))


# ---- Figures


def _figure(raw: Any) -> Kind:
    if isinstance(raw, Kind):
        return raw
    from disc_model.figures.kinds import kind_of  # brings in matplotlib

    return kind_of(_mapping(raw).get("kind")).model_validate(raw)


_KIND = Annotated[
    Any,
    WithJsonSchema(
        {"type": "object", "properties": {"kind": {"type": "string"}}, "required": ["kind"]}
    ),
]
Figure = Annotated[Kind, PlainValidator(_figure, json_schema_input_type=_KIND)]
"""A figure of any kind; `workflow/schemas/write_schema.py` adds the keys of each kind to the schema."""


def _given_figures(raw: Any) -> Any:
    """Figures by their names, without those that null drops."""
    if not isinstance(raw, Mapping):
        return raw
    return {name: plot for name, plot in raw.items() if plot is not None}


def _several(value: Any) -> Any:
    return value if isinstance(value, list | tuple) else [value]


def _options(raw: Any, info: pydantic.ValidationInfo) -> Any:
    """The quantity with its options; what is given for an unknown one is checked once it is
    known."""
    name = info.data.get("quantity")
    if name is None:
        return raw
    quantity = quantity_of(name)
    try:
        return quantity.model_validate(_mapping(raw))
    except ParameterError as error:
        known = {option.name: option for option in options_of(quantity)}
        faults = [_with_form(fault, known) for fault in error.faults]
        raise ParameterError(*faults) from None


def _with_form(fault: Fault, known: Mapping[str, Option]) -> Fault:
    """A fault of options, which says of a missing one what is to be given."""
    if len(fault.path) != 1 or fault.rule != "is required":
        return fault
    option = known.get(fault.path[0])
    if option is None:
        return fault
    unit = f" ({option.unit})" if option.unit else ""
    return Fault(fault.path, "", f"is required: {option.form}{unit}, {option.meaning}")


# ---- The study


class Study(Strict):
    """A study: named cases, a grid of points, or both, and their figures; see docs/studies.md."""

    study: Annotated[Name, AfterValidator(_no_folder)]
    title: str = ""
    base: GivenParameters = Field({}, validate_default=True)
    figures: Annotated[
        dict[Name, Figure],
        BeforeValidator(_given_figures, json_schema_input_type=dict[Name, Figure | None]),
    ] = Field({})
    tol: Tolerance | None = 1e-10  # of all cases, as `record`
    record: RecordSpec = RecordSpec()
    cases: Annotated[dict[CaseName, NamedCase], Field(min_length=1)] = Field(
        {}, validate_default=False
    )
    claims: bool = False  # whether the paper's claims and tables are checked against the cases
    quantity: Annotated[
        str | None,
        AfterValidator(lambda name: name and quantity_of(name) and name),
        WithJsonSchema({"enum": quantity_names()}),
    ] = None
    options: Annotated[Any, PlainValidator(_options), WithJsonSchema({"type": "object"})] = None
    axes: Columns = Columns()
    where: Annotated[
        tuple[Annotated[str, AfterValidator(lambda rule: compiled_rule(rule) and rule)], ...],
        BeforeValidator(_several, json_schema_input_type=str | list[str]),
    ] = ()
    zip: Annotated[
        tuple[Columns, ...],
        BeforeValidator(_several, json_schema_input_type=Columns | list[Columns]),
    ] = ()
    batch: BatchSpec = BatchSpec()
    discs: dict[str, Annotated[Disc, WithJsonSchema({"type": "string"})]] = Field({})
    studies: tuple[str, ...] = ()  # further files of grid studies, * stands for any part of a name
    _tables: dict[str, str] = PrivateAttr(default_factory=dict)

    @pydantic.model_validator(mode="after")
    def _consistent(self) -> Self:
        """Check the rules between the parts of the file."""
        faults: list[Fault] = []
        given = self.model_fields_set
        if self.quantity is None and (given & GRID_KEYS or not given & {"cases", "studies"}):
            faults.append(
                Fault(("quantity",), "", "is required, unless the file has cases or studies alone")
            )
        recorded = {name: spec.longest_sections for name, spec in self.specs.items()}
        for name, plot in self.figures.items():
            if isinstance(plot, CasePlot):
                faults += (fault.inside(("figures", name)) for fault in plot.faults(recorded))
        try:
            self.grid  # noqa: B018
        except ParameterError as error:
            faults += error.faults
        raise_faults(faults)
        return self

    @property
    def name(self) -> str:
        return self.study

    @property
    def tables(self) -> Mapping[str, str]:
        """The files of the grid's discs, by their names along an axis; that of `base` is ""."""
        return self._tables

    @property
    def specs(self) -> dict[str, CaseSpec]:
        """What is simulated of each case."""
        return {name: case.spec for name, case in self.cases.items()}

    @property
    def plots(self) -> dict[str, Plot]:
        """The figures of grids."""
        return {name: plot for name, plot in self.figures.items() if isinstance(plot, Plot)}

    @cached_property
    def grid(self) -> GridStudy | None:
        """The file's own grid; raises `ParameterError` with the faults between its parts."""
        own = {name: plot for name, plot in self.plots.items() if plot.study in ("", self.name)}
        if self.quantity is None:
            return None
        return GridStudy(self, own)

    @property
    def labels(self) -> dict[str, dict[str, str]]:
        """Texts about the cases, which do not change their results."""
        return {
            name: {"title": case.title or name, "reference": case.reference}
            for name, case in self.cases.items()
        }

    def entries(self, grids: Mapping[str, GridStudy]) -> dict[tuple[str, str], FigureEntry]:
        """All figures of the file and of grids, by the study in whose folder they are and their
        names."""
        figures = {}
        for name, plot in self.figures.items():
            if isinstance(plot, Plot):
                figures[self.name, name] = grids[plot.study or self.name].entry_of(name, plot)
            elif isinstance(plot, CasePlot):
                figures[self.name, name] = self._entry_of_cases(name, plot)
        for grid in grids.values():
            for name, grid_plot in grid.plots.items():
                figures.setdefault((grid.name, name), grid.entry_of(name, grid_plot))
        return figures

    def _entry_of_cases(self, name: str, plot: CasePlot) -> FigureEntry:
        """A figure of named cases, whose caption states their parameters."""
        parameters = [self.specs[case].parameters for case in plot.cases]
        values = "; ".join(dict.fromkeys(values_text(dict(p)) for p in parameters))
        normalizations = {p.normalization for p in parameters}
        modes = " and ".join(MODES[each] for each in sorted(normalizations))
        title = plot.title or name
        caption = plot.caption or f"{title}:"
        return FigureEntry(
            plot=plot,
            inputs={case: case for case in plot.cases},
            category="Figures",
            section=plot.section or plot.case,
            title=title,
            caption=f"{caption} {values}; everything else as in Table 1; {modes}.",
            titles={case: self.cases[case].title for case in plot.cases if self.cases[case].title},
        )

    def grids(
        self, folders: Sequence[Path] = (Path(),)
    ) -> tuple[dict[str, GridStudy], tuple[str, ...]]:
        """All grids, also those that only figures show, and the names of those of this file and the
        files it names."""
        paths: dict[str, Path] = {}
        for pattern in self.studies:
            paths.update((path.stem, path) for path in _matching(pattern, folders))
        grids = {}
        if self.grid is not None:
            grids[self.name] = self.grid
        requested = (*grids, *paths)
        for name in sorted(self._shown_studies().difference(requested)):
            further = _matching(f"{name}.yaml", folders)
            paths.update((path.stem, path) for path in further if path.is_file())
        grids.update((name, self._grid_of(path)) for name, path in paths.items())

        faults = []
        figures = [(self.name, name, plot) for name, plot in self.plots.items()]
        for name in sorted({*requested} - {self.name}):
            figures += ((name, figure, plot) for figure, plot in grids[name].plots.items())
        for owner, figure, plot in figures:
            for fault in _misfits(plot, owner, grids):
                faults.append(f"{owner}: {fault.inside(('figures', figure))}")
        if faults:
            raise StudyError(*faults, source="grid studies")
        return grids, requested

    def _shown_studies(self) -> set[str]:
        """Names of the studies that figures name."""
        shown: set[str] = set()
        for plot in self.plots.values():
            shown.update(name for name in (plot.study, *plot.overlays.values()) if name)
        return shown

    def _grid_of(self, path: Path) -> GridStudy:
        """The grid of another file."""
        study = parse_study(read_file(path), path.parent, _shown(path))
        wrong = {
            "must be the name of the file": study.name != path.stem,
            "is the name of another folder of results": study.name == self.name,
            "must be a grid alone": study.grid is None or study.cases or study.studies,
            "must have no figures of other studies": any(
                p.study not in ("", study.name) for p in study.plots.values()
            ),
        }
        if study.grid is None or any(wrong.values()):
            faults = [f"study = {study.name!r}: {rule}" for rule, broken in wrong.items() if broken]
            raise StudyError(*faults, source=str(path))
        return study.grid


def load_study(*paths: str | Path) -> Study:
    """Read and check study files, later ones laid over earlier ones, but not the files that they
    name."""
    return study_from_config(read_files(*paths), paths)


def read_files(*paths: str | Path) -> Any:
    return reduce(
        lambda below, changes: inherit(mapping(below), mapping(changes)),
        map(read_file, map(Path, paths)),
    )


def study_from_config(config: Any, files: Iterable[str | Path]) -> Study:
    """The study from Snakemake's merged configuration files, and its command line."""
    paths = [Path(file) for file in files]
    for path in paths:
        read_file(path)  # finds duplicate keys, which the mapping no longer shows
    folder = paths[-1].parent if paths else Path()
    source = ", ".join(map(_shown, paths)) or "study"
    return parse_study(config, folder, source)


def _shown(path: Path) -> str:
    """A path as short as it can be in a message."""
    if path.is_relative_to(Path.cwd()):
        return str(path.relative_to(Path.cwd()))
    return str(path)


def parse_study(raw: Any, folder: Path | None = None, source: str = "study") -> Study:
    """The study of the mapping that a file holds, with tables of discs from a folder, if it may
    name any."""
    try:
        study = _validated(raw if folder is None else _with_discs(raw, folder))
    except ParameterError as error:
        raise StudyError(*error.faults, source=source) from None
    if folder is not None:
        study._tables = _tables_of(raw, folder)
    return study


def _validated(content: Any) -> Study:
    """The study of a file's content; raises `ParameterError`, where what is wrong in the values for
    all cases is not said of each of them."""
    try:
        return Study.model_validate(_inherited(content))
    except ParameterError as error:
        faults = [fault for fault in error.faults if fault.path[:1] != ("cases",)] or error.faults
        raise ParameterError(*faults) from None


def _inherited(raw: Any) -> Any:
    """The content of a file, in which each case has what it inherits."""
    if not isinstance(raw, Mapping):
        return raw
    content = dict(raw)
    keys = {"base": "parameters", "record": "record", "tol": "tol"}
    shared = {inner: content[key] for key, inner in keys.items() if content.get(key) is not None}
    cases = content.get("cases")
    if isinstance(cases, Mapping):
        content["cases"] = {name: _inheriting(shared, case) for name, case in cases.items()}
    if content.get("quantity") is not None:
        content.setdefault("options", {})
    return content


def _inheriting(shared: Mapping[str, Any], case: Any) -> Any:
    """The content of a case with what it shares with others."""
    if not isinstance(case, Mapping):
        return case
    return {"parameters": {}, **inherit(shared, case)}


def _with_discs(raw: Any, folder: Path) -> Any:
    """A file's content with discs in place of the names of their tables: recomputation depends on a
    table's content."""

    def read(value: Any, path: tuple[str, ...]) -> Any:
        if isinstance(value, Mapping):
            return {key: read(part, (*path, str(key))) for key, part in value.items()}
        named = path[:-1] == ("discs",) or path[-2:] in (("base", "disc"), ("parameters", "disc"))
        if not (named and isinstance(value, str)):
            return value
        try:
            return disc_of_table(folder / value).model_dump(mode="json", exclude_none=True)
        except ParameterError as error:
            raise ParameterError(*(Fault(path, "", str(fault)) for fault in error.faults)) from None

    content = mapping(raw)
    varied = _varied_discs(content)
    if not varied:
        return read(raw, ())
    return read({**content, "discs": {**varied, **mapping(content.get("discs"))}}, ())


def _varied_discs(content: Mapping[str, Any]) -> dict[str, str]:
    """The discs along an axis of a file, each a table of its own name."""
    varied: dict[str, str] = {}
    for group in (content.get("axes"), *_several(content.get("zip"))):
        axis = mapping(group).get("disc")
        if isinstance(axis, list):
            varied.update((name, name) for name in axis if isinstance(name, str))
    return varied


def _tables_of(raw: Any, folder: Path) -> dict[str, str]:
    """The tables of the discs that a file names, by their names along an axis; that of `base` is ""."""
    content = mapping(raw)
    named = {**_varied_discs(content), **mapping(content.get("discs"))}
    named[""] = mapping(content.get("base")).get("disc")
    return {
        name: _table_path(folder / table) for name, table in named.items() if isinstance(table, str)
    }


def _table_path(path: Path) -> str:
    """The path of a table without steps back into folders that it names; as short as it can be."""
    resolved = path.resolve()
    if path.is_absolute():
        return _shown(resolved)
    return os.path.relpath(resolved)


def _matching(pattern: str, folders: Sequence[Path]) -> list[Path]:
    """Files that match a pattern, in the first folder that has any; the pattern itself if there are
    none."""
    matches = (sorted(glob(str(folder / pattern))) for folder in folders)
    return [Path(path) for path in next(filter(None, matches), [pattern])]


def _misfits(plot: Plot, owner: str, grids: Mapping[str, GridStudy]) -> list[Fault]:
    """What keeps a figure in the file of a study from showing grids of other files."""
    named: dict[tuple[str, ...], str] = {("study",): plot.study or owner}
    for role, name in plot.overlays.items():
        named["overlays", role] = name
    known = sorted(grids)
    unknown = []
    for path, name in named.items():
        if name not in grids:
            told = suggestion(name, known)
            key = f"; name the file of another study by the key studies: [{name}.yaml]"
            unknown.append(Fault.of(path, name, f"no such study{told}{key}"))
    if unknown:
        return unknown

    study = grids[plot.study or owner]
    faults: list[Fault] = []
    if plot.study not in ("", owner):
        faults += study.faults_of(plot)
    for role in plot.overlays.keys() & plot.roles.keys():
        other = grids[plot.overlays[role]]
        rule = _rule_of_overlay(plot.roles[role], study, other)
        if rule:
            faults.append(Fault.of(("overlays", role), other.name, rule))
    return faults


def _rule_of_overlay(wanted: Role, study: GridStudy, other: GridStudy) -> str:
    """The rule that a study breaks as an overlay of a figure of another one, or ""."""
    if other.quantity != wanted.quantity:
        return f"must be a study of the quantity {wanted.quantity}"
    if not _normalizations(study) <= _normalizations(other):
        return f"must be computed for the same {NORM}"
    return ""


def _normalizations(grid: GridStudy) -> set[str]:
    """The normalisations of the modes in a grid."""
    values = grid.values.get(NORM, ((grid.base.get(NORM),),))
    return {str(value) for (value,) in values}
