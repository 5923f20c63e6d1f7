"""Studies: their files are read and checked, and yield named cases, grids and figures.

One `StudyError` lists all faults: those of single values, or those between values once these are right.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property, partial, reduce
from glob import glob
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, Literal, NamedTuple, Self

import pydantic
import yaml
from pydantic import AfterValidator, BeforeValidator, Field, PlainValidator, WithJsonSchema
from yaml.constructor import ConstructorError

from disc_model.data.files import MissingFile, unreadable
from disc_model.data.variables import BESIDE_WINDOWS, SCALARS, rule_of_taken, values_text
from disc_model.disc.table import disc_of_table
from disc_model.display import counted
from disc_model.errors import DiscModelError, Fault, ParameterError, raise_faults, suggestion
from disc_model.figures.schema import NORM, CasePlot, Kind, Plot
from disc_model.figures.shown import factors_of
from disc_model.parameters import Disc, Parameters
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
from disc_model.studies.grid import REQUIRED, Columns, Grid, checked_value, dimensions, grid_of
from disc_model.studies.quantity import HOMES, quantity_of
from disc_model.units import Count, Seconds, Strict, Tolerance

GRID_KEYS = frozenset({"options", "axes", "zip", "where", "points_per_job", "discs"})
MODES = {
    "as_published": "modes scaled as in the published results",
    "orthonormal": "modes normalised as Eq. (17) says",
}
MOST_SHOWN = 50  # greatest number of faults in a message


class StudyError(DiscModelError, ValueError):
    """A study file that breaks rules; `faults` are all of them, each once, as ``path=value: rule``."""

    def __init__(self, *faults: str, source: str = "study") -> None:
        self.faults = tuple(dict.fromkeys(map(str, faults)))
        self.source = source
        lines = [f"{source}: {counted(len(self.faults), 'fault')}", *self.faults[:MOST_SHOWN]]
        if len(self.faults) > MOST_SHOWN:
            lines.append(f"and {len(self.faults) - MOST_SHOWN} more")
        super().__init__("\n  ".join(lines))

    def __reduce__(self) -> tuple[Any, ...]:
        return (partial(type(self), source=self.source), self.faults)


# ---- Files


class _Loader(yaml.SafeLoader):
    """Refuses a key that is given twice, of which YAML would take the last value."""

    def construct_mapping(self, node: Any, deep: bool = False) -> Any:
        keys = [key.value for key, _ in node.value if key.tag != "tag:yaml.org,2002:merge"]
        for key in keys:
            if keys.count(key) > 1:
                raise ConstructorError(None, None, f"{key} is given twice", node.start_mark)
        return super().construct_mapping(node, deep)


def read_file(path: Path) -> Any:
    """The content of a YAML file; raises `MissingFile`, `UnreadableFile` or `StudyError`."""
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise MissingFile(f"{path}: there is no such file") from None
    except (OSError, ValueError) as error:  # no file, or no text
        raise unreadable(path, error) from None
    try:
        return yaml.load(text, _Loader)
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        raise StudyError(f"cannot be read as YAML: {error}", source=str(path)) from None


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


def _free_name(kind: str, taken: Iterable[str]) -> AfterValidator:
    """The name of a case or of a window, which is not that of a parameter, variable or group."""

    def checked(name: str) -> str:
        if name in taken:
            raise ValueError(f"{rule_of_taken(name)}; {kind}_{name} would do")
        return name

    return AfterValidator(checked)


_LETTERS = pydantic.StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9_]*$", max_length=100)
Name = Annotated[str, _LETTERS]
CaseName = Annotated[Name, _free_name("case", TAKEN)]
WindowName = Annotated[Name, _free_name("window", TAKEN | BESIDE_WINDOWS)]


def _as_mapping(raw: Any) -> Mapping[str, Any]:
    if not isinstance(raw, Mapping):
        raise ValueError("must be a mapping")
    return raw


# ---- Named cases


class RecordSpec(Strict):
    """What is recorded of a case. Figures and claims refer to windows by their names."""

    windows: dict[WindowName, Window | None] = Field({})  # None drops one that is inherited
    poincare: Poincare | None = None
    events: bool | Span = True


class NamedCase(Strict):
    """One named simulation of a study."""

    title: str = ""
    reference: str = ""
    parameters: Annotated[
        Parameters,
        PlainValidator(
            lambda raw: Parameters.model_validate(_as_mapping(raw)),
            json_schema_input_type=SomeParameters,
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
                inside = fault.path[0] in Parameters.model_fields
                faults.append(fault.inside(("parameters",)) if inside else fault)
        raise_faults(faults)

        events = spans.pop(("events",), None)
        if events is not None and events.last is None:
            events = (events.start, events.stop)
        return CaseSpec(
            parameters=p,
            t_end=self.t_end,
            tol=self.tol,
            stop_at=self.stop_at,
            windows=tuple((name, window) for (_, name), window in spans.items()),
            poincare=self.record.poincare,
            events=events,
            start=self.start,
            ramps=self.ramps,
        )

    def _spans(self) -> tuple[dict[tuple[str, ...], Any], list[Fault]]:
        """Spans of time that are recorded, by their places in the record, resolved in the run unless
        they count back from where it stops; and faults of those that are not within it."""
        record = self.record
        spans: dict[tuple[str, ...], Any] = {}
        for name, window in record.windows.items():
            if window is not None:
                spans["windows", name] = window
        if record.events:
            spans["events",] = Span() if record.events is True else record.events
        faults = []
        for path, span in spans.items():
            start, stop = span.ends(0.0, self.t_end)
            if self.stop_at is not None and span.last is not None and start > 0:
                continue
            if 0 <= start < stop <= self.t_end:
                spans[path] = span.resolved(0.0, self.t_end)
            else:
                rule = f"0 <= start={start:g} < stop={stop:g} <= t_end={self.t_end:g}"
                faults.append(Fault(("record", *path), "", f"must be within the run: {rule}"))
        return spans, faults

    @pydantic.model_validator(mode="after")
    def _consistent(self) -> Self:
        """Check the rules between the values of the case."""
        self.spec  # noqa: B018
        return self


# ---- Figures


def _figure(raw: Any) -> Kind:
    if isinstance(raw, Kind):
        return raw
    from disc_model.figures.kinds import kind_of  # brings in matplotlib

    return kind_of(_as_mapping(raw).get("kind")).model_validate(raw)


_KIND = Annotated[
    Any,
    WithJsonSchema(
        {"type": "object", "properties": {"kind": {"type": "string"}}, "required": ["kind"]}
    ),
]
Figure = Annotated[Kind, PlainValidator(_figure, json_schema_input_type=_KIND)]
"""A figure of any kind; `workflow/schemas/write_schema.py` adds the keys of each kind to the schema."""


class FigureEntry(NamedTuple):
    """A figure as lists and reports show it, and what it is drawn from."""

    plot: Kind
    inputs: Mapping[str, str]  # names of cases, or of grid studies by their roles
    category: str
    section: str
    title: str
    caption: str
    titles: Mapping[str, str] = MappingProxyType({})  # of the cases that have one, by their names


# ---- The study


def _several(value: Any) -> Any:
    return value if isinstance(value, list | tuple) else [value]


def _given(raw: Any) -> Any:
    """What is given by name, without what null drops."""
    return (
        {name: x for name, x in raw.items() if x is not None} if isinstance(raw, Mapping) else raw
    )


def _base(raw: Any) -> dict[str, Any]:
    """Values of parameters in SI units; raises `ParameterError`."""
    values = {}
    faults = []
    for name, value in _given(_as_mapping(raw)).items():
        try:
            if name not in Parameters.model_fields:
                rule = f"unknown parameter{suggestion(name, [*Parameters.model_fields])}"
                raise ParameterError(Fault.of((), value, rule))
            values[name] = (
                Disc.model_validate(value) if name == "disc" else checked_value(name, value)
            )
        except ParameterError as error:
            faults += [each.inside((str(name),)) for each in error.faults]
    raise_faults(faults)
    return values


def _options(raw: Any, info: pydantic.ValidationInfo) -> Any:
    """The options of the quantity; what is given for an unknown one is checked once it is known."""
    name = info.data.get("quantity")
    return raw if name is None else quantity_of(name).options.model_validate(_as_mapping(raw))


class Study(Strict):
    """A study: named cases, a grid of points, or both, and their figures; see docs/studies.md."""

    study: Name
    title: str = ""
    base: Annotated[
        dict[str, Any], PlainValidator(_base, json_schema_input_type=SomeParameters)
    ] = Field({})
    figures: Annotated[
        dict[Name, Figure],
        BeforeValidator(_given, json_schema_input_type=dict[Name, Figure | None]),
    ] = Field({})
    tol: Tolerance | None = 1e-10  # of all cases, as `record`
    record: RecordSpec = RecordSpec()
    cases: Annotated[dict[CaseName, NamedCase], Field(min_length=1)] = Field(
        {}, validate_default=False
    )
    claims: bool = False  # whether the paper's claims and tables are checked against the cases
    quantity: Annotated[
        str | None,
        AfterValidator(lambda name: name and quantity_of(name).name),
        WithJsonSchema({"enum": [*HOMES]}),
    ] = None
    options: Annotated[Any, PlainValidator(_options), WithJsonSchema({"type": "object"})] = None
    axes: Columns = Columns()
    zip: Annotated[
        tuple[Columns, ...],
        BeforeValidator(_several, json_schema_input_type=Columns | list[Columns]),
    ] = ()
    where: Annotated[
        tuple[str, ...], BeforeValidator(_several, json_schema_input_type=str | list[str])
    ] = ()  # rules that points keep, such as mu_k <= mu_s, as pandas.DataFrame.query has them
    points_per_job: Annotated[Count, Field(ge=1)] | None = None
    discs: dict[str, Annotated[Disc, WithJsonSchema({"type": "string"})]] = Field({})
    studies: tuple[str, ...] = ()  # further files of grid studies, * stands for any part of a name

    @pydantic.model_validator(mode="after")
    def _consistent(self) -> Self:
        """Check the rules between the parts of the file."""
        faults: list[Fault] = []
        given = self.model_fields_set
        if self.quantity is None and (given & GRID_KEYS or not given & {"cases", "studies"}):
            rule = "is required, unless the file has cases or studies alone"
            faults.append(Fault(("quantity",), "", rule))
        recorded = {name: spec.longest_sections for name, spec in self.specs.items()}
        for name, plot in self.figures.items():
            if isinstance(plot, CasePlot):
                faults += (fault.inside(("figures", name)) for fault in plot.faults(recorded))
        raise_faults(faults)
        if self.grid is not None:
            own = {
                name: plot for name, plot in self.plots.items() if plot.study in ("", self.study)
            }
            for name, plot in own.items():
                faults += (fault.inside(("figures", name)) for fault in self._faults_of(plot))
        raise_faults(faults)
        return self

    @property
    def specs(self) -> dict[str, CaseSpec]:
        """What is simulated of each case."""
        return {name: case.spec for name, case in self.cases.items()}

    @property
    def plots(self) -> dict[str, Plot]:
        """The figures of grids."""
        return {name: plot for name, plot in self.figures.items() if isinstance(plot, Plot)}

    @cached_property
    def grid(self) -> Grid | None:
        """The file's own grid; raises `ParameterError` with the faults between its parts."""
        if self.quantity is None:
            return None
        dims = dimensions(self.axes, self.zip, self.discs)
        quantity = quantity_of(self.quantity)
        return grid_of(
            quantity, self.options, self.base, dims, self.where, self.discs, self.points_per_job
        )

    @property
    def attrs(self) -> dict[str, str]:
        """Attributes of the merged dataset that describe the study."""
        attrs = {"study": self.study, "title": self.title}
        if self.where:
            attrs["where"] = " and ".join(f"({rule})" for rule in self.where)
        return attrs

    @property
    def labels(self) -> dict[str, dict[str, str]]:
        """Titles and places in the paper of the cases, as pages show them."""
        return {
            name: {"Title": case.title or name, "Place in the paper": case.reference}
            for name, case in self.cases.items()
        }

    @property
    def page(self) -> dict[str, Any]:
        """What the explorer shows of the grid: units of figures, dimensions across and up in the first map,
        and what stored motions are."""
        assert self.grid is not None
        units: dict[str, str] = {}
        axes: list[str] = []
        for plot in reversed([*self.plots.values()]):
            units |= plot.units
            if {"x", "y"} <= plot.axes.keys():
                axes = [plot.axes["x"], plot.axes["y"]]
        motion = self.grid.quantity.motion
        stored = (
            {"motion": motion.text, "motion_by": dict(motion.by)}
            if motion
            else {"motion": "", "motion_by": {}}
        )
        return {"units": units, "axes": axes, **stored}

    # ---- Figures

    def _faults_of(self, plot: Plot) -> Iterable[Fault]:
        """What keeps a figure from showing the grid of this study."""
        assert self.grid is not None
        quantities = plot.shows.quantities
        if quantities and self.quantity not in quantities:
            return [Fault.of(("kind",), plot.kind, f"needs the quantity {quantities[0]}")]
        along: dict[str, list[Any]] = {}
        for dim, frame in self.grid.dims.items():
            rows = [*frame.itertuples(index=False, name=None)]
            along[dim] = [row[0] for row in rows] if [*frame] == [dim] else rows
        endless = [name for name in plot.axes.values() if math.inf in along.get(name, [])]
        if endless:
            return [Fault(("x",), endless[0], "has the value inf, which no axis can show")]
        variables = {}
        columns = self.grid.quantity.columns
        for name, column in columns.items():
            variables[name] = {dim: along.get(dim, []) for dim in (*along, *column.dims)}
        return plot.faults(along, variables)

    def entries(self, grids: Mapping[str, Study]) -> dict[tuple[str, str], FigureEntry]:
        """All figures of the file and of grids, by the study in whose folder they are and their names."""
        figures = {}
        for name, plot in self.figures.items():
            if isinstance(plot, Plot):
                figures[self.study, name] = grids[plot.study or self.study]._entry(name, plot)
            elif isinstance(plot, CasePlot):
                figures[self.study, name] = self._entry_of_cases(name, plot)
        for study in grids.values():
            for name, grid_plot in study.plots.items():
                figures.setdefault((study.study, name), study._entry(name, grid_plot))
        return figures

    def _entry(self, name: str, plot: Plot) -> FigureEntry:
        """A figure of the grid, whose caption states the values that differ from Table 1 and do not vary."""
        assert self.grid is not None
        title = plot.title or f"{self.title or self.study}: {name}"
        stated = {name: x for name, x in self.grid.fixed.items() if x or name not in REQUIRED}
        values = values_text(stated, factors_of(plot.units))
        source = f"the grid study {self.study}" + (f", with {values}" if values else "")
        return FigureEntry(
            plot=plot,
            inputs={"study": self.study, **dict(sorted(plot.overlays.items()))},
            category="Figures" if plot.section else "Maps and curves",
            section=plot.section,
            title=title,
            caption=f"{plot.caption} From {source}.".strip(),
        )

    def _entry_of_cases(self, name: str, plot: CasePlot) -> FigureEntry:
        """A figure of named cases, whose caption states their parameters."""
        parameters = [self.specs[case].parameters for case in plot.cases]
        values = "; ".join(dict.fromkeys(values_text(dict(p)) for p in parameters))
        modes = " and ".join(MODES[each] for each in sorted({p.normalization for p in parameters}))
        title = plot.title or name
        return FigureEntry(
            plot=plot,
            inputs={case: case for case in plot.cases},
            category="Figures",
            section=plot.section or plot.case,
            title=title,
            caption=f"{plot.caption or f'{title}:'} {values}; everything else as in Table 1; {modes}.",
            titles={case: self.cases[case].title for case in plot.cases if self.cases[case].title},
        )

    # ---- Further files

    def all_grids(
        self, folders: Sequence[Path] = (Path(),)
    ) -> tuple[dict[str, Study], tuple[str, ...]]:
        """Studies of all grids, also those that only figures show, and the names of those of this file and
        the files it names."""
        paths: dict[str, Path] = {}
        for pattern in self.studies:
            paths.update((path.stem, path) for path in _matching(pattern, folders))
        grids = {self.study: self} if self.grid is not None else {}
        requested = (*grids, *paths)
        for name in sorted(self._shown_studies().difference(requested)):
            paths.update(
                (path.stem, path) for path in _matching(f"{name}.yaml", folders) if path.is_file()
            )
        grids.update((name, self._grid_of(path)) for name, path in paths.items())
        faults = []
        for owner in (self, *(grids[name] for name in sorted({*requested} - {self.study}))):
            for figure, plot in owner.plots.items():
                for fault in _misfits(plot, owner.study, grids):
                    faults.append(f"{owner.study}: {fault.inside(('figures', figure))}")
        if faults:
            raise StudyError(*faults, source="grid studies")
        return grids, requested

    def _shown_studies(self) -> set[str]:
        """Names of the studies that figures name."""
        names = [
            name for plot in self.plots.values() for name in (plot.study, *plot.overlays.values())
        ]
        return {*filter(None, names)}

    def _grid_of(self, path: Path) -> Study:
        """The study of another file, which is a grid alone."""
        study = load_study(path)
        wrong = {
            "must be the name of the file": study.study != path.stem,
            "is the name of another folder of results": study.study == self.study,
            "must be a grid alone": study.grid is None or study.cases or study.studies,
            "must have no figures of other studies": any(
                plot.study not in ("", study.study) for plot in study.plots.values()
            ),
        }
        faults = [f"study={study.study!r}: {rule}" for rule, broken in wrong.items() if broken]
        if faults:
            raise StudyError(*faults, source=str(path))
        return study


def _matching(pattern: str, folders: Sequence[Path]) -> list[Path]:
    """Files that match a pattern, in the first folder that has any; the pattern itself if there are none."""
    matches = (sorted(glob(str(folder / pattern))) for folder in folders)
    return [Path(path) for path in next(filter(None, matches), [pattern])]


def _misfits(plot: Plot, owner: str, grids: Mapping[str, Study]) -> Iterator[Fault]:
    """What keeps a figure in the file of a study from showing grids of other files."""
    named: dict[tuple[str, ...], str] = {("study",): plot.study or owner}
    named |= {("overlays", role): name for role, name in plot.overlays.items()}
    unknown = [(path, name) for path, name in named.items() if name not in grids]
    for path, name in unknown:
        key = f"; name the file of another study by the key studies: [{name}.yaml]"
        yield Fault.of(path, name, f"no such study{suggestion(name, sorted(grids))}{key}")
    if unknown:
        return
    study = grids[plot.study or owner]
    if plot.study not in ("", owner):
        yield from study._faults_of(plot)
    for role in plot.overlays.keys() & plot.roles.keys():
        other = grids[plot.overlays[role]]
        plane = {getattr(other.options, name, None) for name in ("x", "y")} - {None}
        rules = {
            f"must be a study of the quantity {plot.roles[role].quantity}": (
                other.quantity != plot.roles[role].quantity
            ),
            f"must be computed for the same {NORM}": not _normalizations(study)
            <= _normalizations(other),
            "must be computed in the plane of the figure": {"x", "y"} <= plot.axes.keys()
            and not plane <= {*plot.axes.values()},
        }
        for rule, broken in rules.items():
            if broken:
                yield Fault.of(("overlays", role), other.study, rule)


def _normalizations(study: Study) -> set[str]:
    """The normalisations of the modes in a grid."""
    assert study.grid is not None
    return (
        {*study.grid.points[NORM]} if NORM in study.grid.points else {study.grid.case.normalization}
    )


# ---- From files to studies


def load_study(*paths: str | Path) -> Study:
    """Read and check study files, later ones laid over earlier ones, but not the files that they name."""
    return study_from_config(read_files(*paths), paths)


def read_files(*paths: str | Path) -> Any:
    """The content of study files, later ones laid over earlier ones."""
    return reduce(
        lambda below, above: inherit(mapping(below), mapping(above)),
        map(read_file, map(Path, paths)),
    )


def study_from_config(config: Any, files: Iterable[str | Path]) -> Study:
    """The study of merged configuration files, such as Snakemake's."""
    paths = [Path(file) for file in files]
    folder = paths[-1].parent if paths else Path()
    return parse_study(config, folder, ", ".join(map(str, paths)) or "study")


def parse_study(raw: Any, folder: Path, source: str = "study") -> Study:
    """The study of the mapping that a file holds, with tables of discs from a folder."""
    try:
        return Study.model_validate(_inherited(_with_discs(raw, folder)))
    except ParameterError as error:
        shared = [fault for fault in error.faults if fault.path[:1] != ("cases",)]
        raise StudyError(*(shared or error.faults), source=source) from None


def _inherited(raw: Any) -> Any:
    """The content of a file, in which each case has what it inherits."""
    if not isinstance(raw, Mapping):
        return raw
    content = dict(raw)
    keys = {"base": "parameters", "record": "record", "tol": "tol"}
    shared = {inner: content[key] for key, inner in keys.items() if content.get(key) is not None}
    cases = content.get("cases")
    if isinstance(cases, Mapping):
        content["cases"] = {
            name: {"parameters": {}, **inherit(shared, case)} if isinstance(case, Mapping) else case
            for name, case in cases.items()
        }
    if content.get("quantity") is not None:
        content.setdefault("options", {})
    return content


def _with_discs(raw: Any, folder: Path) -> Any:
    """A file's content with discs in place of the names of their tables: recomputation depends on a
    table's content. Along an axis, a table that `discs` does not name stands for itself."""

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

    content = dict(mapping(raw))
    varied = [
        mapping(group).get("disc") for group in (content.get("axes"), *_several(content.get("zip")))
    ]
    named = {
        name: name
        for axis in varied
        if isinstance(axis, list)
        for name in axis
        if isinstance(name, str)
    }
    if named:
        content["discs"] = {**named, **mapping(content.get("discs"))}
    return read(content, ()) if isinstance(raw, Mapping) else raw
