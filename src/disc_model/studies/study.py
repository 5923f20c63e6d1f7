"""Studies: their files are read and checked, and yield named cases, grids and figures.

One `StudyError` lists all faults: those of single values, or those between values once these are right.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property, reduce
from glob import glob
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, NamedTuple, Self

import numpy as np
import pandas as pd
import pydantic
import yaml
from pydantic import AfterValidator, BeforeValidator, Field, PlainValidator, WithJsonSchema
from yaml.constructor import ConstructorError

from disc_model.data.files import MissingFile, unreadable
from disc_model.data.variables import PERTURBATIONS, values_text
from disc_model.disc.table import disc_of_table
from disc_model.display import counted
from disc_model.errors import Fault, ParameterError, raise_faults, require, suggestion
from disc_model.figures.schema import CasePlot, Kind, Plot
from disc_model.figures.shown import IN_WORDS, factors_of
from disc_model.parameters import DEFAULTS, Disc, Parameters
from disc_model.provenance import content_key, physics_hash
from disc_model.simulation.case import CaseSpec, Name, RecordSpec, SomeParameters, without_null
from disc_model.studies.grid import Columns, case_of, dimensions, expand, keeps
from disc_model.studies.quantity import HOMES, Quantity, quantity_of
from disc_model.units import Size, Strict, Tolerance

Content = dict[str, Any]
"""What a file, or a part of it, says by key."""
GRID_KEYS = frozenset({"options", "axes", "zip", "where", "points_per_job", "discs"})


class StudyError(ParameterError):
    """A study file that breaks rules; `faults` are all of them, each once, as ``path=value: rule``."""

    def __init__(self, *faults: Fault | str, source: str = "study") -> None:
        super().__init__(*dict.fromkeys(faults))
        head = f"{source}: {counted(len(self.faults), 'fault')}"
        self.args = ("\n  ".join([head, *map(str, self.faults)]),)


# ---- Files


class _Loader(yaml.CSafeLoader):
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
        return yaml.load(path.read_text(encoding="utf-8"), _Loader)
    except FileNotFoundError:
        raise MissingFile(f"{path}: there is no such file") from None
    except OSError as error:
        raise unreadable(path, error) from None
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        raise StudyError(f"cannot be read as YAML: {error}", source=str(path)) from None


def mapping(value: Any) -> Content:
    """The value if it is a mapping, else an empty one."""
    return value if isinstance(value, dict) else {}


def inherit(base: Content, changes: Content) -> Content:
    """`changes` over `base`, mappings merged key by key; None drops what is inherited."""
    merged = {**base, **changes}
    for key in base.keys() & changes.keys():
        if changes[key] is None:
            del merged[key]
        elif isinstance(base[key], dict) and isinstance(changes[key], dict):
            merged[key] = inherit(base[key], changes[key])
    return merged


# ---- Figures


def _figure(raw: Any) -> Kind | None:
    if raw is None:
        return None
    from disc_model.figures.kinds import kind_of  # brings in matplotlib

    return kind_of(mapping(raw).get("kind")).model_validate(raw)


Figure = Annotated[Kind, PlainValidator(_figure, json_schema_input_type=Any)]
"""A figure of any kind; `workflow/schemas/write_schema.py` adds the keys of each kind to the schema."""


class FigureEntry(NamedTuple):
    """A figure as lists and reports show it, and what it is drawn from."""

    plot: Kind
    inputs: Mapping[str, str]  # names of cases, or of grid studies by their roles
    section: str
    title: str
    caption: str
    titles: Mapping[str, str] = MappingProxyType({})  # of the cases that have one, by their names


# ---- The study


def _several(value: Any) -> Any:
    return value if isinstance(value, list | tuple) else [value]


def _text(content: Any) -> str:
    """JSON that is equal for equal content."""
    return json.dumps(content, sort_keys=True)


def _options(raw: Any, info: pydantic.ValidationInfo) -> Any:
    """The options of the quantity; what is given for an unknown one is checked once it is known."""
    name = info.data.get("quantity")
    return raw if name is None else quantity_of(name).options.model_validate(raw)


class Study(Strict):
    """A study: named cases, a grid of points, or both, and their figures; see docs/studies.md."""

    study: Name
    title: str = ""
    base: SomeParameters = SomeParameters()
    figures: Annotated[dict[Name, Figure], AfterValidator(without_null)] = Field({})
    tol: Tolerance | None = 1e-10  # of all cases, as `record`
    record: RecordSpec = RecordSpec()
    cases: Annotated[dict[Name, CaseSpec], Field(min_length=1)] = Field({})
    claims: bool = False  # whether the paper's claims and tables are checked against the cases
    quantity: Annotated[
        str | None,
        AfterValidator(lambda name: name and quantity_of(name).name),
        WithJsonSchema({"enum": [*HOMES]}),
    ] = None
    options: Annotated[Any, PlainValidator(_options), WithJsonSchema({"type": "object"})] = Field(
        {}, validate_default=True
    )
    axes: Columns = Columns()
    zip: Annotated[
        tuple[Columns, ...],
        BeforeValidator(_several, json_schema_input_type=Columns | list[Columns]),
    ] = ()
    where: Annotated[
        tuple[str, ...], BeforeValidator(_several, json_schema_input_type=str | list[str])
    ] = ()  # rules that points keep, such as mu_k <= mu_s
    points_per_job: Size | None = None
    discs: dict[str, Annotated[Disc, WithJsonSchema({"type": "string"})]] = Field({})
    studies: tuple[str, ...] = ()  # further files of grid studies, * stands for any part of a name

    @pydantic.model_validator(mode="after")
    def _consistent(self) -> Self:
        """Check the rules between the parts of the file."""
        given = self.model_fields_set
        alone = not given & GRID_KEYS and given & {"cases", "studies"}
        rule = "is required, unless the file has cases or studies alone"
        require((self.has_grid or alone, "quantity", "", rule))
        if self.has_grid:
            raise_faults([*self._wrong_axes()])
            self.case  # noqa: B018
        recorded = {name: spec.longest_sections for name, spec in self.cases.items()}
        faults = []
        for name, plot in self.figures.items():
            wrong: Iterable[Fault] = ()
            if isinstance(plot, CasePlot):
                wrong = plot.faults(recorded)
            elif self.has_grid and isinstance(plot, Plot) and plot.study in ("", self.study):
                wrong = self._faults_of(plot)
            faults += [fault.inside(("figures", name)) for fault in wrong]
        raise_faults(faults)
        return self

    # ---- Named cases

    @property
    def labels(self) -> dict[str, dict[str, str]]:
        """Titles and places in the paper of the cases, as pages show them."""
        return {
            name: {"Title": case.title or name, "Place in the paper": case.reference}
            for name, case in self.cases.items()
        }

    # ---- The grid

    @property
    def has_grid(self) -> bool:
        """Whether the file has a grid of its own."""
        return bool(self.quantity)

    @property
    def of(self) -> Quantity:
        """The quantity."""
        return quantity_of(str(self.quantity))

    @cached_property
    def dims(self) -> dict[str, pd.DataFrame]:
        """Columns by dimension, in the order of the parameters; raises `ParameterError`."""
        return dimensions(self.axes, self.zip)

    @property
    def _varied(self) -> list[str]:
        """What varies, along axes or by the quantity itself."""
        along = (str(name) for frame in self.dims.values() for name in frame)
        return [*along, *self.of.varied(self.options)]

    def _wrong_axes(self) -> Iterator[Fault]:
        """Each parameter must vary once; and only some quantities take another start."""
        if not self.dims:
            yield Fault(("axes",), "", "is required: at least one axis or zip")
        for name in dict.fromkeys(self._varied):
            if self._varied.count(name) > 1:
                yield Fault(
                    ("axes", name), "", "varies twice: in another place, or by the quantity"
                )
            if name in PERTURBATIONS and not hasattr(self.options, "start"):
                yield Fault(("axes", name), "", "the quantity follows no motion from a start")

    @cached_property
    def points(self) -> pd.DataFrame:
        """What varies, a row for each point that is not left out; raises `ParameterError`."""
        points = expand(self.dims)[self._kept]
        require((len(points), "where", " and ".join(self.where), "leaves no point"))
        return points

    @cached_property
    def _kept(self) -> list[bool]:
        """Of all points of the grid, which are not left out, by what varies and by the parameters that do not."""
        return keeps(expand(self.dims), self.where, {**DEFAULTS, **self._base})

    @property
    def _base(self) -> Content:
        """What the file says of the parameters that do not vary."""
        return self.base.model_dump(exclude_unset=True)

    @cached_property
    def case(self) -> Parameters:
        """The case of the first point that is possible; raises `ParameterError`, with what is wrong at the
        last point, if none is."""
        base = {**self.of.unset(self.options), **self._base}
        wrong = ParameterError()
        own = self.points.drop(columns=[*PERTURBATIONS], errors="ignore")
        for point in own.to_dict("records"):
            try:
                return case_of(base, self.discs, **{str(name): x for name, x in point.items()})
            except ParameterError as error:
                wrong = error
        faults = []
        for fault in wrong.faults:
            place = "base"
            if fault.path[0] in self._varied:
                place = "axes"
            faults.append(fault.inside((place,)))
        raise ParameterError(*faults)

    @cached_property
    def fixed(self) -> Content:
        """The values of the case that all points have: not of what varies, nor those that something else
        replaces."""
        without = {*self._varied}
        if self.case.damping_ratio is not None:
            without.add("D_star")
        return {name: x for name, x in self.case.canonical.items() if name not in without}

    @property
    def layout(self) -> Content:
        """What all points have in common, and the dimensions, for JSON."""
        used = {*self.points.get("disc", ())}
        return {
            "quantity": self.quantity,
            "options": self.options.model_dump(mode="json"),
            "base": self.fixed,
            "discs": {
                x: disc.model_dump(mode="json") for x, disc in self.discs.items() if x in used
            },
            "dims": {dim: frame.to_dict("list") for dim, frame in self.dims.items()},
            "kept": self._kept,
        }

    @cached_property
    def jobs(self) -> dict[str, str]:
        """What each job computes, as JSON, by the name of its file: a hash of what all have in common,
        and one of their own points."""
        codes = {name: column.flags for name, column in self.of.columns.items()}
        common = {**self.layout, "dims": {}, "kept": [], "code": physics_hash(), "codes": codes}
        content = content_key(_text(common))
        size = self.points_per_job or self.of.points_per_job
        points = np.array(self.points.to_dict("records"))
        jobs = {}
        for part in np.array_split(points, math.ceil(len(points) / size)):
            of_part = part.tolist()
            jobs[f"{content}-{content_key(_text(of_part))}"] = _text({**common, "points": of_part})
        return jobs

    @property
    def motions(self) -> dict[str, str]:
        """The job of the points whose motions are stored, by the name of its file: all of a small grid, some
        of a large one; none for some quantities."""
        motion = self.of.motion
        if motion is None:
            return {}
        # a regular choice might miss one of few words along a dimension
        chosen = self.points.sample(min(motion.number, len(self.points)), random_state=1)
        points = chosen.sort_index().to_dict("records")
        text = _text({**self.layout, "code": physics_hash(), "points": points})
        return {content_key(text): text}

    @property
    def attrs(self) -> dict[str, str]:
        """Attributes of the merged dataset that describe the study."""
        return {"study": self.study, "title": self.title}

    @property
    def page(self) -> Content:
        """What the explorer shows of the grid: units of figures, dimensions across and up in the first map,
        and what stored motions are."""
        units: dict[str, str] = {}
        axes: list[str] = []
        for plot in reversed([*self.plots.values()]):
            units |= plot.units
            if {"x", "y"} <= plot.axes.keys():
                axes = [plot.axes["x"], plot.axes["y"]]
        return {"units": units, "axes": axes, "motion": getattr(self.of.motion, "text", "")}

    # ---- Figures

    @property
    def plots(self) -> dict[str, Plot]:
        """The figures of grids."""
        return {name: plot for name, plot in self.figures.items() if isinstance(plot, Plot)}

    def _faults_of(self, plot: Plot) -> list[Fault]:
        """What keeps a figure from showing the grid of this study."""
        quantities = plot.shows.quantities
        if quantities and self.quantity not in quantities:
            return [Fault.of(("kind",), plot.kind, f"needs the quantity {quantities[0]}")]
        along: dict[str, list[Any]] = {}
        for dim, frame in self.dims.items():
            rows = [*frame.itertuples(index=False, name=None)]
            along[dim] = rows
            if len(frame.columns) == 1:
                along[dim] = [value for (value,) in rows]
        for name in plot.axes.values():
            if math.inf in along.get(name, ()):
                return [Fault(("x",), name, "has the value inf, which no axis can show")]
        variables = {}
        for name, column in self.of.columns.items():
            variables[name] = {**along, **{dim: [] for dim in column.dims if dim not in along}}
        return plot.faults(along, variables)

    def _misfits(self, plot: Plot, grids: Mapping[str, Study]) -> list[Fault]:
        """What keeps a figure in this file from showing grids of other files."""
        shown: dict[tuple[str, ...], str] = {("study",): plot.study or self.study}
        shown |= {("overlays", role): name for role, name in plot.overlays.items()}
        key = "; name the file of another study by the key studies: [{}.yaml]"
        faults = []
        for path, name in shown.items():
            if name not in grids:
                rule = f"no such study{suggestion(name, sorted(grids))}{key.format(name)}"
                faults.append(Fault.of(path, name, rule))
        if faults:
            return faults
        if plot.study not in ("", self.study):
            faults += grids[plot.study]._faults_of(plot)
        for role in plot.overlays.keys() & plot.roles.keys():
            rule = grids[plot.overlays[role]]._no_overlay(plot, plot.roles[role].quantity)
            if rule:
                faults.append(Fault.of(("overlays", role), plot.overlays[role], rule))
        return faults

    def _no_overlay(self, plot: Plot, quantity: str) -> str:
        """The rule that this study breaks as one that a figure draws over another of its plane; "" if none."""
        plane = {getattr(self.options, name, None) for name in ("x", "y")} - {None}
        if self.quantity != quantity:
            return f"must be a study of the quantity {quantity}"
        if {"x", "y"} <= plot.axes.keys() and not plane <= {*plot.axes.values()}:
            return "must be computed in the plane of the figure"
        return ""

    def entries(self, grids: Mapping[str, Study]) -> dict[tuple[str, str], FigureEntry]:
        """All figures of the file and of grids, by the study in whose folder they are and their names."""
        figures = {}
        for name, plot in self.figures.items():
            owner = grids[plot.study or self.study] if isinstance(plot, Plot) else self
            figures[self.study, name] = owner._entry(name, plot)
        for study in grids.values():
            for name, grid_plot in study.plots.items():
                figures.setdefault((study.study, name), study._entry(name, grid_plot))
        return figures

    def _entry(self, name: str, plot: Kind) -> FigureEntry:
        """A figure, whose caption states what its cases are: the values that differ from Table 1 and do not
        vary."""
        if isinstance(plot, CasePlot):
            return self._entry_of_cases(name, plot)
        assert isinstance(plot, Plot)
        values = values_text(self.fixed, factors_of(plot.units))
        source = ", with ".join(filter(None, [f"the grid study {self.study}", values]))
        title = plot.title or f"{self.title or self.study}: {name}"
        inputs = {"study": self.study, **dict(sorted(plot.overlays.items()))}
        caption = f"{plot.caption} From {source}.".strip()
        return FigureEntry(plot, inputs, plot.section, title, caption)

    def _entry_of_cases(self, name: str, plot: CasePlot) -> FigureEntry:
        cases = {case: self.cases[case] for case in plot.cases}
        every = [case.parameters for case in cases.values()]
        values = "; ".join(dict.fromkeys(values_text(dict(p)) for p in every))
        modes = " and ".join(IN_WORDS[each] for each in sorted({p.normalization for p in every}))
        title = plot.title or name
        head = plot.caption or f"{title}:"
        caption = f"{head} {values}; everything else as in Table 1; {modes}."
        titles = {case: spec.title for case, spec in cases.items()}
        inputs = dict(zip(cases, cases, strict=True))
        return FigureEntry(plot, inputs, plot.section or plot.case, title, caption, titles)

    # ---- Further files

    def all_grids(
        self, folders: Sequence[Path] = (Path(),)
    ) -> tuple[dict[str, Study], tuple[str, ...]]:
        """Studies of all grids, also those that only figures show, and the names of those of this file and
        the files it names."""
        grids = self._named_grids(folders)
        asked = tuple(grids)
        for plot in self.plots.values():
            for name in {plot.study, *plot.overlays.values()} - {"", *grids}:
                [path] = _matching(f"{name}.yaml", folders)
                if path.is_file():
                    grids[name] = load_study(path)
        faults = []
        for owner in (self, *(grids[name] for name in asked if name != self.study)):
            for figure, plot in owner.plots.items():
                for fault in owner._misfits(plot, grids):
                    faults.append(f"{owner.study}: {fault.inside(('figures', figure))}")
        if faults:
            raise StudyError(*faults, source="grid studies")
        return grids, asked

    def _named_grids(self, folders: Sequence[Path]) -> dict[str, Study]:
        """The grid of this file, and those of the files that it names."""
        named = [load_study(path) for each in self.studies for path in _matching(each, folders)]
        every = [self] * self.has_grid + named
        grids = {study.study: study for study in every}
        wrong = [study.study for study in named if study.cases or study.studies]
        if wrong or len(grids) < len(every):
            rule = "must be files of grids alone, each of another study"
            raise StudyError(Fault.of(("studies",), wrong, rule), source=self.study)
        return grids


def _matching(pattern: str, folders: Sequence[Path]) -> list[Path]:
    """Files that match a pattern, in the first folder that has any; the pattern itself if there are none."""
    for folder in folders:
        if matches := sorted(glob(str(folder / pattern))):
            return [Path(path) for path in matches]
    return [Path(pattern)]


# ---- From files to studies


def load_study(*files: str | Path) -> Study:
    """Read and check study files, later ones laid over earlier ones, but not the files that they name."""
    paths = [Path(file) for file in files]
    return parse_study(reduce(inherit, [mapping(read_file(path)) for path in paths]), paths)


def parse_study(raw: Any, files: Sequence[Path] = ()) -> Study:
    """The study of the mapping that files hold, merged, such as Snakemake's configuration; tables of discs
    lie beside the last one."""
    folder = files[-1].parent if files else Path()
    content = dict(mapping(raw))
    content |= _inherited(content)
    content |= _named_discs(content)
    try:
        return Study.model_validate(_with_discs(content, folder))
    except ParameterError as error:
        shared = [fault for fault in error.faults if fault.path[:1] != ("cases",)]
        source = ", ".join(map(str, files)) or "study"
        raise StudyError(*(shared or error.faults), source=source) from None


def _inherited(content: Content) -> Content:
    """The cases of a file, in which each has what it inherits."""
    shared: Content = {"parameters": {}}
    for key, inner in (("base", "parameters"), ("record", "record"), ("tol", "tol")):
        if content.get(key) is not None:
            shared[inner] = content[key]
    cases = content.get("cases")
    if not isinstance(cases, dict):
        return {}
    every = {}
    for name, case in cases.items():
        every[name] = inherit(shared, case) if isinstance(case, dict) else case
    return {"cases": every}


def _named_discs(content: Content) -> Content:
    """The discs of a file; those along an axis that have no name there stand for themselves."""
    discs = dict(mapping(content.get("discs")))
    for group in (content.get("axes"), *_several(content.get("zip"))):
        for name in _several(mapping(group).get("disc", [])):
            discs.setdefault(name, name)
    return {"discs": discs} if discs else {}


def _with_discs(raw: Any, folder: Path, *path: str) -> Any:
    """A file's content with discs in place of the names of their tables: recomputation depends on a
    table's content."""
    if isinstance(raw, dict):
        return {str(x): _with_discs(part, folder, *path, str(x)) for x, part in raw.items()}
    named = path[:-1] == ("discs",) or path[-2:] in (("base", "disc"), ("parameters", "disc"))
    if not (named and isinstance(raw, str)):
        return raw
    try:
        return disc_of_table(folder / raw).model_dump(mode="json", exclude_none=True)
    except ParameterError as error:
        raise ParameterError(*(Fault(path, "", str(fault)) for fault in error.faults)) from None
