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
from disc_model.studies.grid import Columns, case_of, dimensions, expand
from disc_model.studies.quantity import HOMES, Quantity, quantity_of
from disc_model.units import Size, Strict, Tolerance

Content = dict[str, Any]
"""What a file, or a part of it, says by key."""
GRID_KEYS = frozenset({"options", "axes", "zip", "where", "points_per_job", "discs"})


class StudyError(ParameterError):
    """A study file that breaks rules; `faults` are all of them, as ``path=value: rule``."""

    def __init__(self, *faults: Fault | str, source: str = "study") -> None:
        super().__init__(*faults)
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
    where: str = ""  # a rule that points keep, such as mu_k <= mu_s
    points_per_job: Size | None = None
    discs: dict[str, Annotated[Disc, WithJsonSchema({"type": "string"})]] = Field({})
    studies: tuple[str, ...] = ()  # further files of grid studies, * stands for any part of a name

    @pydantic.model_validator(mode="after")
    def _consistent(self) -> Self:
        """Check the rules between the parts of the file, but for those of figures."""
        given = self.model_fields_set
        alone = not given & GRID_KEYS and given & {"cases", "studies"}
        rule = "is required, unless the file has cases or studies alone"
        require((self.quantity or alone, "quantity", "", rule))
        if self.quantity:
            raise_faults([*self._wrong_axes()])
            self.case  # noqa: B018
        return self

    # ---- The grid

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
            place = ("axes", name)
            if self._varied.count(name) > 1:
                yield Fault(place, "", "varies twice: in another place, or by the quantity")
            if name in PERTURBATIONS and not hasattr(self.options, "start"):
                yield Fault(place, "", "the quantity follows no motion from a start")

    @property
    def _base(self) -> Content:
        """What the file says of the parameters that do not vary."""
        return self.base.model_dump(exclude_unset=True)

    @cached_property
    def points(self) -> pd.DataFrame:
        """What varies, a row for each point that is not left out; raises `ParameterError`."""
        return expand(self.dims, self.where, {**DEFAULTS, **self._base})

    @cached_property
    def case(self) -> Parameters:
        """The case of the first point that is possible; raises `ParameterError`, with what is wrong at the
        last point, if none is."""
        base = {**self.of.unset(self.options), **self._base}
        own = self.points.drop(columns=[*PERTURBATIONS], errors="ignore")
        wrong = ParameterError()
        for point in own.to_dict("records"):
            try:
                return case_of(base, self.discs, **{str(name): x for name, x in point.items()})
            except ParameterError as error:
                wrong = error
        raise wrong

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
        """What all points have in common, the dimensions, and the places of points among all that these
        give, for JSON."""
        used = {*self.points.get("disc", ())}
        return {
            "quantity": self.quantity,
            "options": self.options.model_dump(mode="json"),
            "base": self.fixed,
            "discs": {x: y.model_dump(mode="json") for x, y in self.discs.items() if x in used},
            "dims": {dim: frame.to_dict("list") for dim, frame in self.dims.items()},
            "places": self.points.index.tolist(),
        }

    @cached_property
    def jobs(self) -> dict[str, str]:
        """What each job computes, as JSON, by the name of its file: a hash of what all have in common,
        and one of their own points."""
        codes = {name: column.flags for name, column in self.of.columns.items()}
        common = {**self.layout, "dims": {}, "places": [], "code": physics_hash(), "codes": codes}
        content = content_key(_text(common))
        points = np.array(self.points.to_dict("records"))
        count = math.ceil(len(points) / (self.points_per_job or self.of.points_per_job))
        jobs = {}
        for part in np.array_split(points, count):
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

    # ---- Figures and pages

    @property
    def labels(self) -> dict[str, dict[str, str]]:
        """Titles and places in the paper of the cases, as pages show them."""
        return {
            name: {"Title": case.title or name, "Place in the paper": case.reference}
            for name, case in self.cases.items()
        }

    @property
    def plots(self) -> dict[str, Plot]:
        """The figures of grids."""
        return {name: plot for name, plot in self.figures.items() if isinstance(plot, Plot)}

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

    def _wrong_figures(self, grids: Mapping[str, Study]) -> Iterator[Fault]:
        """What keeps figures in this file from showing its cases, or grids."""
        recorded = {name: spec.longest_sections for name, spec in self.cases.items()}
        for name, plot in self.figures.items():
            faults: Iterable[Fault] = ()
            if isinstance(plot, CasePlot):
                faults = plot.faults(recorded)
            elif isinstance(plot, Plot):
                faults = self._wrong_plot(plot, grids)
            for fault in faults:
                yield fault.inside(("figures", name))

    def _wrong_plot(self, plot: Plot, grids: Mapping[str, Study]) -> Iterator[Fault]:
        """What keeps a figure in this file from showing grids."""
        shown: dict[tuple[str, ...], str] = {("study",): plot.study or self.study}
        shown |= {("overlays", role): name for role, name in plot.overlays.items()}
        for path, name in shown.items():
            if name not in grids:
                key = f"name the file of another study by the key studies: [{name}.yaml]"
                yield Fault.of(path, name, f"no such study{suggestion(name, sorted(grids))}; {key}")
                return
        yield from grids[shown["study",]]._wrong_below(plot)
        for role in plot.overlays.keys() & plot.roles.keys():
            above = grids[plot.overlays[role]]
            quantity = plot.roles[role].quantity
            plane = {getattr(above.options, name, None) for name in ("x", "y")} - {None}
            rule = ""
            if above.quantity != quantity:
                rule = f"must be a study of the quantity {quantity}"
            elif {"x", "y"} <= plot.axes.keys() and not plane <= {*plot.axes.values()}:
                rule = "must be computed in the plane of the figure"
            if rule:
                yield Fault.of(("overlays", role), above.study, rule)

    def _wrong_below(self, plot: Plot) -> list[Fault]:
        """What keeps a figure from showing the grid of this study."""
        quantities = plot.shows.quantities
        if quantities and self.quantity not in quantities:
            return [Fault.of(("kind",), plot.kind, f"needs the quantity {quantities[0]}")]
        along: dict[str, list[Any]] = {}
        for dim, frame in self.dims.items():
            along[dim] = [*frame.itertuples(index=False, name=None)]
            if len(frame.columns) == 1:
                along[dim] = frame[dim].tolist()
        own = {}
        for name, column in self.of.columns.items():
            own[name] = {**{dim: [] for dim in column.dims}, **along}
        return plot.faults(along, own)

    def entries(self, grids: Mapping[str, Study]) -> dict[tuple[str, str], FigureEntry]:
        """All figures of the file and of grids, by the study in whose folder they are and their names."""
        entries = {}
        for study in {**grids, self.study: self}.values():
            for name, plot in study.figures.items():
                if isinstance(plot, CasePlot):
                    entries[study.study, name] = study._entry_of_cases(name, plot)
                elif isinstance(plot, Plot):
                    shown = grids.get(plot.study, study)
                    entries[study.study, name] = shown._entry(name, plot)
        return entries

    def _entry(self, name: str, plot: Plot) -> FigureEntry:
        """A figure of the grid, whose caption states the values that differ from Table 1 and do not vary."""
        values = values_text(self.fixed, factors_of(plot.units))
        source = ", with ".join(filter(None, [f"the grid study {self.study}", values]))
        title = plot.title or f"{self.title or self.study}: {name}"
        inputs = {"study": self.study, **dict(sorted(plot.overlays.items()))}
        caption = f"{plot.caption} From {source}.".strip()
        return FigureEntry(plot, inputs, plot.section, title, caption)

    def _entry_of_cases(self, name: str, plot: CasePlot) -> FigureEntry:
        """A figure of cases, whose caption states their values that differ from Table 1."""
        every = [self.cases[case].parameters for case in plot.cases]
        values = "; ".join(dict.fromkeys(values_text(dict(p)) for p in every))
        modes = " and ".join(IN_WORDS[each] for each in sorted({p.normalization for p in every}))
        title = plot.title or name
        head = plot.caption or f"{title}:"
        caption = f"{head} {values}; everything else as in Table 1; {modes}."
        titles = {case: self.cases[case].title for case in plot.cases}
        inputs = {case: case for case in plot.cases}
        return FigureEntry(plot, inputs, plot.section or plot.case, title, caption, titles)

    # ---- Further files

    def all_grids(
        self, folders: Sequence[Path] = (Path(),)
    ) -> tuple[dict[str, Study], tuple[str, ...]]:
        """Studies of all grids, also those that only figures show, and the names of those of this file and
        the files it names; raises `StudyError` also for what keeps figures from showing them."""
        named = [load_study(path) for each in self.studies for path in _matching(each, folders)]
        asked = [self] * bool(self.quantity) + named
        grids = {study.study: study for study in asked}
        wrong = [study.study for study in named if study.cases or study.studies]
        if wrong or len(grids) < len(asked):
            rule = "must be files of grids alone, each of another study"
            raise StudyError(Fault.of(("studies",), wrong, rule), source=self.study)
        for plot in self.plots.values():
            for name in {plot.study, *plot.overlays.values()} - {"", *grids}:
                [path] = _matching(f"{name}.yaml", folders)
                if path.is_file():
                    grids[name] = load_study(path)
        for study in (self, *named):
            faults = [*study._wrong_figures(grids)]
            if faults:
                raise StudyError(*faults, source=study.study)
        return grids, tuple(study.study for study in asked)


def _matching(pattern: str, folders: Sequence[Path]) -> list[Path]:
    """Files that match a pattern, in the first folder that has any; the pattern itself if there are none."""
    for folder in folders:
        if matches := sorted(glob(str(folder / pattern))):
            return [Path(path) for path in matches]
    return [Path(pattern)]


# ---- From files to studies


def load_study(*files: str | Path) -> Study:
    """Read and check study files, later ones laid over earlier ones, but not their figures, nor the files
    that they name."""
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
    cases = content.get("cases")
    if not isinstance(cases, dict):
        return {}
    inner = {"parameters": content.get("base") or {}}
    inner |= {key: content[key] for key in ("record", "tol") if content.get(key) is not None}
    every = {}
    for name, case in cases.items():
        every[name] = inherit(inner, case) if isinstance(case, dict) else case
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
        raise ParameterError(*(fault.inside(path) for fault in error.faults)) from None
