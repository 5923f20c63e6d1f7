"""Studies: their files are read and checked, and yield named cases and grids, cut into batches of points.

`load_study` reads files, `study_from_config` takes what Snakemake read from one or more files, and `parse_study` takes
the mapping itself. All raise one `StudyError` that lists every fault with its path. The keys of a file are defined in
`disc_model.studies.document`. Each case inherits the study's base values and default records.

A workflow job receives one batch as a text. Blocks of values are cut into batches of similar cost, by position and only
inside a block. A finer axis therefore adds batches and keeps the others. Quantities that need a plane at once are cut
into tiles. The text holds everything that its result depends on, and its hash is the name of the batch. A batch with
equal content is therefore not computed again, however the file describes it.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial, reduce
from glob import glob
from itertools import chain, pairwise, product
from pathlib import Path
from typing import Any, NamedTuple

import yaml
from pydantic import create_model

from disc_model.data.variables import PERTURBATIONS, SAMPLE, START, values_text
from disc_model.disc.plausibility import RULES
from disc_model.disc.tables import read_disc
from disc_model.disc.truncation import FREQUENCIES, ModeRequest, asked_modes
from disc_model.errors import DiscModelError, Fault, ParameterError, as_text, suggestion
from disc_model.figures.general import General
from disc_model.figures.kind import NORM, CasePlot, Kind, Plot, Values
from disc_model.figures.region_map import RegionMap
from disc_model.kernels import DECIDING, kinds_of
from disc_model.parameters import (
    AUTO,
    CHOOSING,
    DEFAULTS,
    PLATE,
    RATIOS,
    RELATED,
    RESIDUAL,
    Disc,
    Parameters,
    case_of,
    cross_faults,
    with_ratios,
)
from disc_model.simulation.case import CaseSpec, SomeParameters, Start
from disc_model.studies.document import (
    STATIC,
    VARIED,
    BatchSpec,
    Document,
    blocks_of,
)
from disc_model.studies.quantities.sensitivity import NUMBERS, Sensitivity
from disc_model.studies.quantity import Quantity
from disc_model.studies.ranges import Blocks, Value
from disc_model.studies.rules import holds, names_in
from disc_model.units import Finite, Positive, canonical_json, content_key, given_values, is_number

GRID_KEYS = frozenset({"quantity", "options", "axes", "zip", "where", "batch", "starts", "discs"})
"""Keys of a study file that concern the grid alone."""
REQUIRED = ("N", "Omega")
"""Parameters without a base value."""

# ----------------------------------------------------------------------------------------------------
# Reading: what YAML itself would ignore, or report in its own form, is a fault


class StudyError(DiscModelError, ValueError):
    """A study file that breaks rules; lists every fault once, as ``path = value: rule``."""

    def __init__(self, *faults: str, source: str = "study") -> None:
        texts = (fault.in_file if isinstance(fault, Fault) and fault.path else str(fault) for fault in faults)
        self.faults = tuple(dict.fromkeys(texts))
        self.source = source
        count = f"{len(self.faults)} fault{'s' if len(self.faults) > 1 else ''}"
        super().__init__("\n  ".join([f"{source}: {count}", *self.faults]))

    def __reduce__(self) -> tuple[Any, ...]:
        return (partial(type(self), source=self.source), self.faults)


def read_file(path: Path) -> tuple[Any, list[str]]:
    """A YAML file's content and the keys that it gives twice; raises `StudyError` if it cannot be read."""
    try:
        return read_yaml(path.read_text(encoding="utf-8"), str(path))
    except OSError as error:
        raise StudyError(f"cannot be read: {error.strerror}", source=str(path)) from None
    except UnicodeDecodeError as error:
        raise StudyError(f"cannot be read: byte {error.start} is no UTF-8", source=str(path)) from None


def _given_twice(root: yaml.Node) -> list[str]:
    """Keys that are given twice, of which YAML itself would take the last value."""
    nodes, faults, visited = [root], [], set[int]()
    for node in nodes:
        if id(node) in visited:  # an alias of an earlier node
            continue
        visited.add(id(node))
        if isinstance(node, yaml.MappingNode):
            first: dict[Any, int] = {}
            for key, line in ((key.value, key.start_mark.line + 1) for key, _ in node.value):
                if key in first and key != "<<":
                    faults.append(f"{key}: given twice, in lines {first[key]} and {line}")
                first.setdefault(key, line)
            nodes += chain(*node.value)
        elif isinstance(node, yaml.SequenceNode):
            nodes += node.value
    return faults


def read_yaml(text: str, source: str = "study") -> tuple[Any, list[str]]:
    """A YAML document and the keys that it gives twice; raises `StudyError` if the text is none."""
    try:
        loader = yaml.SafeLoader(text)
        node = loader.get_single_node()
        faults = [] if node is None else _given_twice(node)
        return None if node is None else loader.construct_document(node), faults
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = f"line {mark.line + 1}, column {mark.column + 1}: " if mark else ""
        fault = place + ", ".join(part for part in (error.context, error.problem) if part)
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        # ValueError: text that looks like a number or date but is none
        fault = " ".join(str(error).split())
    except (AttributeError, KeyError, TypeError) as error:
        # raised by a tag such as !!timestamp or !!bool before an invalid value
        fault = f"a value does not fit its tag ({' '.join(str(error).split())})"
    raise StudyError(fault, source=source)


def mapping(value: Any) -> Mapping[Any, Any]:
    """The value if it is a mapping, else an empty one."""
    return value if isinstance(value, Mapping) else {}


def inherit(base: Mapping[str, Any], own: Mapping[str, Any]) -> dict[str, Any]:
    """`own` over `base`, mappings merged key by key; None drops what is inherited."""
    merged = dict(base)
    for key, value in own.items():
        old = merged.get(key)
        if value is None and key in base:
            del merged[key]
        else:
            merged[key] = inherit(old, value) if isinstance(old, Mapping) and isinstance(value, Mapping) else value
    return merged


# ----------------------------------------------------------------------------------------------------
# Studies


class FigureEntry(NamedTuple):
    """A figure as lists and reports show it, and what it is drawn from.

    inputs : names of cases, or of grid studies by their roles
    """

    plot: Kind
    inputs: Mapping[str, str]
    category: str
    section: str
    title: str
    caption: str


MODES = {
    "as_published": "modes scaled as in the published results",
    "orthonormal": "modes normalised as Eq. (17) says",
}
"""Normalizations in captions."""


class Study:
    """A study. What is wrong with it is added to a list of faults as it is made.

    document : content of the file; the study has its name, title, claims, cases, and files of further grid studies
    specs : what is simulated of each case, in the order of the file
    figures : figures of cases and of grids, by name
    grid : the file's own grid, if it has one
    """

    def __init__(self, document: Document, raw: Mapping[str, Any], faults: list[Fault]) -> None:
        self.document, self.name, self.title, self.claims = document, document.study, document.title, document.claims
        self.cases, self.studies = document.cases, document.studies
        if self.name in ("compiled", "bench"):  # folders beside those of studies
            faults.append(Fault.of(("study",), self.name, "is the name of another folder of results"))
        if not raw.keys() & {"cases", "studies", *GRID_KEYS}:
            faults.append(Fault(("study",), "", "must say what to compute: cases, or quantity and axes, or studies"))
        self.specs: dict[str, CaseSpec] = {}
        for name, case in self.cases.items():
            try:
                self.specs[name] = case.spec()
            except ParameterError as error:
                faults += [_locate(fault.inside(("cases", name)), raw) for fault in error.faults]
        self.figures = document.figures
        own = {name: plot for name, plot in self._plots if plot.study in ("", self.name)}
        faults += self._wrong_figures(raw)
        self.grid = GridStudy(document, raw, own, faults) if raw.keys() & GRID_KEYS else None

    @property
    def _plots(self) -> Iterator[tuple[str, Plot]]:
        """The figures of grids, with their names."""
        return ((name, plot) for name, plot in self.figures.items() if isinstance(plot, Plot))

    def _wrong_figures(self, raw: Mapping[str, Any]) -> Iterator[Fault]:
        """Faults of the figures of cases, and of those of a grid that the file lacks."""
        known = [str(name) for name in mapping(raw.get("cases"))]
        cases = {name: self.specs[name].sections if name in self.specs else None for name in known}
        for name, plot in self.figures.items():
            if isinstance(plot, CasePlot):
                yield from (fault.inside(("figures", name)) for fault in plot.faults(cases))
            elif isinstance(plot, Plot) and not plot.study and not raw.keys() & GRID_KEYS:
                rule = "shows a grid: this study has none, and no other one is named as its study"
                yield Fault.of(("figures", name, "kind"), plot.kind, rule)

    @property
    def labels(self) -> dict[str, dict[str, str]]:
        """Texts about the cases, which do not change their results."""
        return {name: {"title": case.title, "reference": case.reference} for name, case in self.cases.items()}

    def entries(self, grids: Mapping[str, GridStudy]) -> dict[tuple[str, str], FigureEntry]:
        """All figures of the file and of grids, by the study in whose folder they are and their names."""
        figures = {}
        for name, plot in self.figures.items():
            if isinstance(plot, Plot):
                figures[self.name, name] = grids[plot.study or self.name].entry_of(name, plot)
            elif isinstance(plot, CasePlot):
                figures[self.name, name] = self._entry_of(name, plot)
        for grid in grids.values():
            for name, plot in grid.plots.items():
                figures.setdefault((grid.name, name), grid.entry_of(name, plot))
        return figures

    def _entry_of(self, name: str, plot: CasePlot) -> FigureEntry:
        """A figure of cases; its caption has their parameters."""
        every = [self.specs[case].parameters for case in plot.cases]
        values = "; ".join(dict.fromkeys(values_text(dict(p)) for p in every))
        modes = " and ".join(MODES[mode] for mode in sorted({p.normalization for p in every}))
        stated = f"{plot.caption or f'{plot.title or name}:'} {values}; everything else as in Table 1; {modes}."
        section = plot.section or plot.case
        return FigureEntry(plot, {case: case for case in plot.cases}, "Figures", section, plot.title or name, stated)

    @property
    def doubts(self) -> Iterator[str]:
        """Warnings about implausible cases, each with their number."""
        for rule in RULES.values():
            if found := [text for spec in self.specs.values() if (text := rule.doubt(spec.parameters))]:
                yield f"{found[0]} ({len(found)} of {len(self.specs)} cases)"

    def grids(self, folders: Sequence[Path] = (Path(),)) -> tuple[dict[str, GridStudy], tuple[str, ...]]:
        """All grids, the file's own and those of its further files, and the names of the requested ones.

        A figure of the file's own grid may show further grids. These are read from files beside it and are included.

        folders : searched for the files; the first that has one counts
        """
        grids = {} if self.grid is None else {self.name: self.grid}
        paths = [path for pattern in self.studies for path in _found(pattern, folders)]
        asked = (*grids, *(path.stem for path in paths))
        shown = {name for _, plot in self._plots for name in (plot.study, *plot.overlays.values()) if name}
        shown_too = shown.difference(asked)
        helpers = [path for name in sorted(shown_too) for path in _found(f"{name}.yaml", folders) if path.is_file()]
        known = {*asked, *(path.stem for path in helpers)}
        faults: list[str] = []
        for path in [*paths, *helpers]:
            self._add_grid(path, grids, faults)
        for name in self.document.overrides.keys() - known:
            faults.append(f"overrides.{name}: no such study{suggestion(name, sorted(known))}")
        for name in sorted(grids.keys() & set(asked)):
            for figure, plot in grids[name].plots.items():
                faults += _misfits(f"{name}: figures.{figure}", plot, grids[name], grids, known)
        for figure, plot in self._plots:
            if plot.study in grids and plot.study != self.name:
                shown_grid = grids[plot.study]
                faults += [fault.inside(("figures", figure)).in_file for fault in shown_grid.faults_of(plot)]
                faults += _misfits(f"{self.name}: figures.{figure}", plot, shown_grid, grids, known)
            elif plot.study and plot.study not in known:
                rule = f"no such study{suggestion(plot.study, sorted(known))}"
                faults.append(Fault.of(("figures", figure, "study"), plot.study, rule).in_file)
        if faults:
            raise StudyError(*faults, source="grid studies")
        return grids, asked

    def _add_grid(self, path: Path, grids: dict[str, GridStudy], faults: list[str]) -> None:
        """Add the grid of another file, with the overriding values applied."""
        try:
            raw, more = read_file(path)
            own = inherit(mapping(raw), self.document.overrides.get(path.stem, {}))
            raw = {"resolution": self.document.resolution, **own}
            study = parse_study(raw, path.parent, _shown_path(path), more)
        except StudyError as error:
            faults += [f"{error.source}: {fault}" for fault in error.faults]
            return
        wrong = {
            "must be the name of the file": study.name != path.stem,
            "is another file's study": path.stem in grids,
            "is the name of another folder of results": study.name == self.name and self.grid is None,
            "must be a grid alone": study.grid is None or study.cases or study.studies,
        }
        faults += [f"{path}: study = {study.name!r}: {rule}" for rule, broken in wrong.items() if broken]
        if study.grid is not None:
            grids[path.stem] = study.grid


def load_study(*paths: str | Path) -> Study:
    """Read and check study files, later ones laid over earlier ones, but not the files that they name."""
    return study_from_config(read_files(*paths), paths)


def read_files(*paths: str | Path) -> Any:
    """Contents of study files, later ones laid over earlier ones."""
    contents = (read_file(Path(path))[0] for path in paths)
    return reduce(lambda below, own: inherit(mapping(below), mapping(own)), contents)


def study_from_config(config: Any, files: Iterable[str | Path]) -> Study:
    """The study from Snakemake's merged configuration files, later ones first, and its command line.

    The files are searched for duplicate keys, which the mapping no longer shows.
    """
    paths = [Path(file) for file in files]
    faults = [fault for path in paths for fault in read_file(path)[1]]
    folder = paths[-1].parent if paths else Path()
    return parse_study(config, folder, ", ".join(map(_shown_path, paths)) or "study", faults)


def parse_study(raw: Any, folder: Path | None = None, source: str = "study", known: Iterable[str] = ()) -> Study:
    """Check the mapping that a study file holds; raises one error with its faults and those known before.

    folder : contains the tables of discs, if the file may name any
    """
    before = [*known]
    if folder is not None:
        raw = _with_discs(raw, folder, before)
    document, faults = _checked(raw)
    study = None if document is None else Study(document, raw, faults)
    if study is None or before or faults:
        raise StudyError(*before, *faults, source=source)
    return study


def _with_discs(raw: Any, folder: Path, faults: list[str], place: tuple[str, ...] = ()) -> Any:
    """A file's content in which the names of disc tables, relative to the folder, are replaced by the discs.

    Recomputation thus depends on a table's content and not on its name.
    """
    if not isinstance(raw, Mapping):
        return raw
    if not place:  # names along an axis of discs are tables too
        axes = [mapping(group).get("disc") for group in _groups(raw)]
        varied = [name for axis in axes if isinstance(axis, list) for name in axis if isinstance(name, str)]
        if varied:
            raw = {**raw, "discs": {**{name: name for name in varied}, **mapping(raw.get("discs"))}}
    made = {}
    for key, value in raw.items():
        here = (*place, str(key))
        if isinstance(value, str) and (place == ("discs",) or here[-2:] in (("base", "disc"), ("parameters", "disc"))):
            try:
                made[key] = read_disc(folder / value).model_dump(mode="json", exclude_none=True)
            except ParameterError as error:
                faults += [Fault(here, "", str(fault)).in_file for fault in error.faults]
        else:
            made[key] = _with_discs(value, folder, faults, here)
    return made


def _groups(raw: Mapping[str, Any]) -> list[Any]:
    """What a file gives as axes, and as each zip."""
    zips = raw.get("zip")
    return [raw.get("axes"), *(zips if isinstance(zips, list) else [zips])]


def _shown_path(path: Path) -> str:
    """The shortest form of a path, relative to the current folder if possible."""
    whole, here = path.resolve(), Path.cwd()
    return str(whole.relative_to(here) if whole.is_relative_to(here) else path)


def _found(pattern: str, folders: Sequence[Path]) -> list[Path]:
    """Files that match a pattern, in the first folder that has any; the pattern itself if there are none."""
    found = (sorted(glob(str(folder / pattern))) for folder in folders)
    return [Path(path) for path in next(filter(None, found), [pattern])]


def _misfits(
    where: str, plot: Plot, study: GridStudy, grids: Mapping[str, GridStudy], known: Collection[str]
) -> Iterator[str]:
    """Faults of the further studies that a figure of a study shows."""
    for role, other in plot.overlays.items():
        if other not in known:
            yield f"{where}.overlays.{role} = {other!r}: no such study{suggestion(other, sorted(known))}"
        elif other in grids:
            misfits = misfits_of(plot, role, study, grids[other])
            yield from (f"{where}.overlays.{role} = {other!r}: {rule}" for rule in misfits)


def misfits_of(plot: Plot, role: str, study: GridStudy, other: GridStudy) -> Iterator[str]:
    """Rules that a further study breaks in a role of a study's figure."""
    wanted = plot.roles[role]
    if other.quantity not in (wanted.quantity, wanted.instead):
        good = " or ".join(filter(None, (wanted.quantity, wanted.instead)))
        yield f"must be a study of the quantity {good}, and not {other.quantity}"
        return
    for name, value in wanted.options.items():
        if (found := getattr(other.options, name)) != value:
            yield f"must have options.{name} = {value!r}, and not {found!r}"
    needs = plot.dims if wanted.dims is None else wanted.dims
    if (dims := other.values.keys() - {NORM}) != set(needs):
        needed, found = (", ".join(sorted(names)) or "nothing" for names in (needs, dims))
        yield f"must vary {needed} beside {NORM}, and not {found}"
    elif absent := _normalizations(study) - _normalizations(other):
        yield f"must be computed for the same {NORM}: {', '.join(sorted(absent))}"


def _normalizations(study: GridStudy) -> set[str]:
    return {str(value) for (value,) in study.values.get(NORM, [(study.base.get(NORM),)])}


# ----------------------------------------------------------------------------------------------------
# The document, or its valid parts


def _checked(raw: Any) -> tuple[Document | None, list[Fault]]:
    """The document without its faulty parts, and the faults at their places in the file."""
    if not isinstance(raw, Mapping):
        return None, [Fault.of(("study",), raw, "must be a mapping")]
    whole = dict(raw)
    if isinstance(raw.get("cases"), Mapping):
        whole["cases"] = {
            name: {"parameters": {}} | inherit(_inherited(raw), own) if isinstance(own, Mapping) else own
            for name, own in raw["cases"].items()
        }
    if raw.get("quantity") is not None:
        whole.setdefault("options", {})
    faults: list[Fault] = []
    try:
        return Document.model_validate(whole), faults
    except ParameterError as error:
        found = error.faults
    places = {fault.path for fault in found}
    faults += [there for fault in found if (there := _locate(fault, raw)) is fault or there.path not in places]
    for fault in found:
        _drop(whole, fault.path)
    try:
        return Document.model_validate({"study": "nameless"} | whole), faults
    except ParameterError:
        return None, faults


def _inherited(raw: Mapping[str, Any]) -> dict[str, Any]:
    """The values that the file gives for all of its cases."""
    stated = {"parameters": raw.get("base"), "record": raw.get("record"), "tol": raw.get("tol")}
    return {key: value for key, value in stated.items() if value is not None}


def _locate(fault: Fault, raw: Mapping[str, Any]) -> Fault:
    """A fault of an expanded case, moved to where the file gives the value: in the case, or in what it inherits."""
    if fault.path[0] != "cases" or len(fault.path) < 3 or not isinstance(raw.get("cases"), Mapping):
        return fault
    place = fault.path[2:]
    own = next(value for name, value in raw["cases"].items() if str(name) == fault.path[1])
    if _depth(own, place) >= _depth(_inherited(raw), place):
        return fault
    return Fault(("base" if place[0] == "parameters" else place[0], *place[1:]), fault.value, fault.rule)


def _depth(stated: Any, place: tuple[str, ...]) -> int:
    """Number of steps of a path that exist in nested mappings."""
    if not place or not isinstance(stated, Mapping) or place[0] not in stated:
        return 0
    return 1 + _depth(stated[place[0]], place[1:])


def _drop(whole: dict[str, Any], path: tuple[str, ...]) -> None:
    """Remove the faulty part of a document: a case, a figure, an axis, a start, or a key."""
    key = next((key for key in whole if str(key) == path[0]), "")
    part = whole.pop(key, None)
    if path[0] in ("cases", "figures", "axes", "starts") and isinstance(part, Mapping) and len(path) > 1:
        left = {name: value for name, value in part.items() if str(name) != path[1]}
        if left:
            whole[key] = left


# ----------------------------------------------------------------------------------------------------
# Dimensions of a grid: axes, one parameter each, and zips, several parameters that vary together


@dataclass(frozen=True)
class Dimension:
    """One dimension of a grid: the parameters that vary along it, and their values in blocks of sorted tuples."""

    names: tuple[str, ...]
    blocks: tuple[tuple[tuple[Value, ...], ...], ...]

    @classmethod
    def of(cls, names: Sequence[str], blocks: Iterable[Iterable[tuple[Value, ...]]]) -> Dimension:
        """A dimension from blocks in any order; a value belongs to the first block that has it."""
        seen: set[Any] = set()
        kept = []
        for block in blocks:
            if new := sorted(set(block) - seen):
                seen.update(new)
                kept.append(tuple(new))
        return cls(tuple(names), tuple(kept))

    @property
    def name(self) -> str:
        """The parameter, or the parameters of a zip, joined by _."""
        return "_".join(self.names)

    @property
    def values(self) -> tuple[tuple[Value, ...], ...]:
        """All values, sorted."""
        return tuple(sorted(value for block in self.blocks for value in block))

    def thinned(self, most: int) -> Dimension:
        """A dimension of at most `most` values, evenly spaced by place and including both ends; words are all kept."""
        values = self.values
        if len(values) > most and not any(isinstance(part, str) for value in values for part in value):
            last = len(values) - 1
            values = tuple(values[round(i * last / max(most - 1, 1))] for i in range(most))
        return Dimension(self.names, (values,))


def points(
    dims: Sequence[Dimension], where: Sequence[str] = (), base: Mapping[str, Any] | None = None
) -> Iterator[dict[str, Value]]:
    """The varying values, by name, at every point of a grid that satisfies the rules."""
    names = [name for dim in dims for name in dim.names]
    for point in product(*(dim.values for dim in dims)):
        found = dict(zip(names, chain.from_iterable(point), strict=True))
        if not where or holds(where, {**(base or {}), **found}):
            yield found


def n_points(dims: Sequence[Dimension]) -> int:
    """Number of points of a grid."""
    return math.prod(len(dim.values) for dim in dims)


def first_of_each(found: Iterable[str]) -> list[Fault]:
    """The first fault of each parameter."""
    first: dict[str, Fault] = {}
    for fault in found:
        if isinstance(fault, Fault):
            first.setdefault(fault.path[0], fault)
    return list(first.values())


# ----------------------------------------------------------------------------------------------------
# Grids

MOST_POINTS = 1_000_000
"""Greatest number of points of a grid: Snakemake takes hours over so many jobs; many more do not fit into memory."""
_OTHERS: dict[str, Any] = dict.fromkeys(PERTURBATIONS, (Finite, 0.0)) | dict.fromkeys(RATIOS, (Positive, 1.0))
_Varied = create_model("_Varied", __base__=SomeParameters, **_OTHERS)


class GridStudy:
    """A grid study. What is wrong with it is added to a list of faults as it is made.

    document, raw : content of the file
    quantity, options : name of the quantity, and its options
    scanned : parameters that the quantity varies by itself
    wanted : names that are to vary, even if the file describes them incorrectly
    base : values that do not vary
    dims : in the order of `VARIED`; varied : names along them
    starts : starts of motions, by name
    plots : figures, by name
    """

    def __init__(
        self, document: Document, raw: Mapping[str, Any], plots: Mapping[str, Plot], faults: list[Fault]
    ) -> None:
        self.document, self.raw, self.plots, self.faults = document, raw, plots, faults
        self.name, self.title, self.quantity = document.study, document.title, str(document.quantity)
        self.where, self.discs, self.starts = document.where, document.discs, {STATIC: Start(), **document.starts}
        self.options: Any = document.options if isinstance(document.options, Quantity) else None
        self.scanned: tuple[str, ...] = self.options.scanned if self.options else ()
        self.wanted = {str(name) for group in _groups(raw) for name in mapping(group)}
        self.base, self.asked = self._base()
        self.dims = (*sorted(self._dimensions(), key=lambda dim: VARIED.index(dim.names[0])), *self._samples())
        self.varied = [name for dim in self.dims for name in dim.names]
        self._check()

    @cached_property
    def batches(self) -> dict[str, str]:
        """JSON text of each batch by its name, 12 hexadecimal digits."""
        batch = self.document.batch
        if self.options.tiled:
            maps = [plot for plot in self.plots.values() if isinstance(plot, RegionMap)]
            marked = [{plot.x: mark.x, plot.y: mark.y} for plot in maps for mark in plot.marks.values()]
            return self._texts(self.dims, _tiles(self.dims, batch, marked))
        size = batch.size or self.options.batch_size
        return self._texts(self.dims, ({"points": cut} for cut in _chunks(self.dims, batch.over, size)))

    @cached_property
    def motions(self) -> dict[str, str]:
        """JSON text, by its name, of the batch of points whose motions are stored; empty for some quantities."""
        most = self.options.motions
        if not most:
            return {}
        few = [dim.thinned(most) for dim in self.dims]
        return self._texts(few, [{"points": [[*point.values()] for point in points(few)]}])

    def _texts(self, dims: Sequence[Dimension], parts: Iterable[dict[str, Any]]) -> dict[str, str]:
        """Parts of the grid that have points left, each as a text with everything that its result depends on."""
        names = [name for dim in dims for name in dim.names]
        options = self.options.model_dump()
        shared = {"quantity": self.quantity, "options": options, "base": self.base, "names": names}
        texts = []
        for part in parts:
            every = [dict(zip(names, point, strict=True)) for point in part["points"]]
            kept = [point for point in every if not self.where or holds(self.where, {**self.base, **point})]
            stated = {}
            for key, kind, known in ((START, "starts", self.starts), ("disc", "discs", self.discs)):
                if key in names:
                    stated[kind] = {name: known[name].model_dump() for name in {str(point[key]) for point in kept}}
            if kept:
                texts.append(canonical_json(shared | stated | part | {"points": [[*point.values()] for point in kept]}))
        return {content_key(text): text for text in texts}

    @property
    def sources(self) -> tuple[str, ...]:
        """Modules by which its points are computed and that are loaded by name, as `disc_model.sources` has them."""
        by_motion = self.asked is not None and self.asked.quantity != FREQUENCIES
        return f"studies.quantities.{self.quantity}", *["mode_choice"] * by_motion

    @property
    def grid(self) -> list[dict[str, Any]]:
        """Dimensions with their values, for `disc_model.studies.merge`."""
        return [{"names": dim.names, "values": dim.values} for dim in self.dims]

    @property
    def values(self) -> dict[str, tuple[tuple[Value, ...], ...]]:
        """Values along each dimension, by its name."""
        return {dim.name: dim.values for dim in self.dims}

    @property
    def kernels(self) -> list[str]:
        """Kinds of kernels that its points need, named as in `disc_model.kernels`."""
        deciding = [dim for dim in self.dims if not DECIDING.isdisjoint(dim.names)]
        cases = [case_of({**self.base, **point}, self.discs) for point in points(deciding)]
        return kinds_of(cases, self.options.tasks)

    @property
    def n_points(self) -> int:
        """Number of points of the grid that are not excluded."""
        return sum(1 for _ in points(self.dims, self.where, self.base)) if self.where else n_points(self.dims)

    @property
    def attrs(self) -> dict[str, str]:
        """Attributes of the merged dataset that describe the study."""
        where = {"where": " and ".join(f"({rule})" for rule in self.where)} if self.where else {}
        return {"study": self.name, "title": self.title} | where

    @property
    def doubts(self) -> Iterator[str]:
        """Warnings about implausible points, each with their number."""
        base = {name: value for name, value in self.base.items() if name not in CHOOSING and value != AUTO}
        base |= next(points(self.dims, self.where, base))
        for rule in RULES.values():
            dims = [dim for dim in self.dims if not set(rule.names).isdisjoint(dim.names)]
            looked_at = [dim.thinned(round(300 ** (1 / len(dims)))) for dim in dims]  # about 300 points
            cases = [base | point for point in points(looked_at, self.where, base)] or [base]
            found = [text for case in cases if (text := rule.doubt(Parameters(**case_of(case, self.discs))))]
            if found:
                about = "about " * (n_points(looked_at) < n_points(dims))
                yield f"{found[0]} ({about}{len(found) * self.n_points // len(cases)} of {self.n_points} points)"

    # ---- its check

    def _add(self, path: tuple[str, ...], rule: str, *value: Any) -> None:
        self.faults.append(Fault(path, as_text(value[0]) if value else "", rule))

    def _check(self) -> None:
        """Check all rules between the parts; those between values only if the parts are right."""
        if self.raw.get("quantity") is None:
            self._add(("quantity",), "is required")
        self._check_names()
        self._check_starts()
        for check in (self._check_where, self._check_points, self._check_distributions):
            if not self.faults:
                check()
        if (size := n_points(self.dims)) > MOST_POINTS:
            self._add(("axes",), f"must make at most {MOST_POINTS} points, and not {size}")
        self._check_plots()
        if not self.faults:
            self._complete_base()

    def _complete_base(self) -> None:
        """Give `base` all values that do not vary, as one point has them."""
        point = next(points(self.dims, self.where, self.base))
        first = case_of({**self.base, **point}, self.discs)
        unused = {name: 0.0 for name in self.scanned if name in REQUIRED}
        try:
            whole = Parameters(**{**unused, **first}).canonical
        except ParameterError as error:  # faults of varying and fixed values together
            self.faults += [fault.inside(("base",)) for fault in error.faults]
            return
        dropped = {*point, *(RATIOS[name][0] for name in point.keys() & RATIOS)}
        if self.asked is not None:
            dropped.add("n_circles")
            whole |= self.asked.given
        self.base = {name: value for name, value in whole.items() if name not in dropped}

    # ---- what the file says

    def _base(self) -> tuple[dict[str, Any], ModeRequest | None]:
        """The base values, which need not include N and Omega, and the choice of modes that is made at each point."""
        fixed, asked, more = asked_modes(given_values(self.document.base))
        self.faults += [fault.inside(("base",)) for fault in more if isinstance(fault, Fault)]
        if asked is None:
            return fixed, None
        # chosen numbers of modes cannot be given as well
        also = [("axes", name) for name in ("n_diameters", "n_circles") if name in self.wanted]
        for path in [*also, *[("base", "n_circles")] * ("n_circles" in fixed)]:
            self._add(path, f"is chosen for each point, since base.n_diameters is {AUTO!r}")
        return fixed, asked

    def _dimensions(self) -> Iterator[Dimension]:
        """The valid dimensions of the file."""
        resolution = self.document.resolution
        for name, blocks in self._columns(given_values(self.document.axes), ("axes",), resolution).items():
            yield Dimension.of((name,), [[(value,) for value in block] for block in blocks])
        for i, group in enumerate(self.document.zip):
            place = ("zip", str(i)) if isinstance(self.raw["zip"], list) else ("zip",)
            columns = {name: [*chain(*blocks)] for name, blocks in self._columns(given_values(group), place).items()}
            if len({len(column) for column in columns.values()}) > 1:
                lengths = ", ".join(f"{name}: {len(column)}" for name, column in columns.items())
                self._add(place, f"must have columns of equal length, not {lengths}")
            elif columns and len(columns) == len(group.model_fields_set):
                yield Dimension.of([*columns], [list(zip(*columns.values(), strict=True))])

    def _columns(self, given: Mapping[str, Any], path: tuple[str, ...], resolution: int = 1) -> dict[str, Blocks]:
        """Valid blocks of values by name, converted to floats, whole numbers or words."""
        found = {}
        for name, axis in given.items():
            place, before = (*path, name), len(self.faults)
            try:
                blocks = blocks_of(axis, resolution)
            except ValueError as error:
                blocks = ()
                self._add(place, str(error))
            checked = tuple(tuple(self._value(name, value, place) for value in block) for block in blocks)
            if len(self.faults) == before:
                found[name] = checked
        return found

    def _value(self, name: str, value: Value, place: tuple[str, ...]) -> Value:
        """Convert and check one value by itself; `_check_points` checks them together."""
        known = {**self.starts, **mapping(self.raw.get("starts"))}
        if name == START and not (isinstance(value, str) and value in known):
            self._add(place, f"no such start{suggestion(value, known)}", value)
        elif name == "disc" and not (isinstance(value, str) and value in mapping(self.raw.get("discs"))):
            self._add(place, "must be the table of a disc", value)
        elif name == "n_diameters" and value == AUTO:
            self._add(place, "cannot be varied: give it in base, for all points", value)
        elif name == "contact_compliance" and value == RESIDUAL:
            self._add(place, "must be a number along an axis: give it in base, for all points", value)
        elif name not in (START, "disc"):
            try:
                return getattr(_Varied.model_validate({name: value}), name)  # type: ignore[no-any-return]
            except ParameterError as error:
                self.faults += [Fault(place, fault.value, fault.rule) for fault in error.faults]
        return value

    def _samples(self) -> tuple[Dimension, ...]:
        """The dimension of samples, the last one: a block of 64, and blocks that each double their number."""
        if not isinstance(self.options, Sensitivity):
            return ()
        ends = [0, min(64, self.options.samples)]
        while ends[-1] < self.options.samples:
            ends.append(2 * ends[-1])
        return (Dimension((SAMPLE,), tuple(tuple((number,) for number in range(a, b)) for a, b in pairwise(ends))),)

    # ---- rules between its parts

    def _check_names(self) -> None:
        """Check which names vary, which are given, and which are lacking."""
        base, wanted, scanned, over = mapping(self.raw.get("base")), self.wanted, self.scanned, self.document.batch.over
        asked, names = f"the quantity {self.quantity}", [dim.name for dim in self.dims]
        for name in sorted({name for name in self.varied if self.varied.count(name) > 1}):
            self._add(("axes", name), "varies along two dimensions")
        if not self.dims and not self.faults:
            self._add(("axes",), "is required: at least one axis or zip")
        for name in scanned:
            if name in wanted or name in base:
                self._add(("axes" if name in wanted else "base", name), f"is varied by {asked}")
        for name in sorted(wanted):
            stands_for, other = RATIOS.get(name, ("", ""))
            others = [RATIOS.get(one, (one,))[0] for one in (*wanted - {name}, *base, *scanned)]
            if "disc" in {*wanted, *base} and not {name, stands_for, other}.isdisjoint((*PLATE, "damping_ratio")):
                self._add(("axes", name), "must be left out where a disc is given: it is a parameter of the plate")
            if stands_for in others:
                self._add(("axes", name), f"stands for {stands_for}, which is given as well")
            elif other in scanned:
                self._add(("axes", name), f"needs {other}, which {asked} varies")
            if name in base:
                self._add(("base", name), "varies as well: give it in base or as an axis, not both", base[name])
        if self.options is None:
            return
        for name in REQUIRED:
            if name not in {*wanted, *base, *scanned}:
                self._add(("axes", name), "is required, here, in a zip or in base")
        if self.options.over not in ("", SAMPLE, *names, *wanted):
            self._add(("axes", self.options.over), f"is required: {asked} looks along it")
        if self.faults:
            return
        for name in over or ():
            if name not in names:
                self._add(("batch", "over"), f"must name dimensions (known: {', '.join(names)})", name)
        if self.options.tiled and not self.faults and len(_plane(self.dims, over)) != 2:
            rule = f"must name the two dimensions, single numbers, of {self.quantity}'s plane first"
            self._add(("batch", "over"), rule, over and list(over))

    def _check_starts(self) -> None:
        """Only some quantities accept another start, and the file must give it in one place only."""
        options = mapping(self.raw.get("options"))
        for name in (START, *PERTURBATIONS):
            coordinate = name.removeprefix("perturbation_")
            if name not in self.wanted:
                continue
            if self.options is not None and not isinstance(self.options, Start):
                self._add(("axes", name), f"the quantity {self.quantity} follows no motion from a start")
            if coordinate in mapping(options.get("perturbation")):
                self._add(("options", "perturbation", coordinate), f"is given, and varies as axes.{name}")
            for key in options.keys() & {"prerun", "perturbation"} if name == START else ():
                self._add(("options", key), "must not be given where the start varies: say it under starts")

    def _check_where(self) -> None:
        """Check the file's own rules: they must compare known values and leave some points."""
        known = {**Parameters.model_fields, **dict.fromkeys(self.varied)}
        for rule in self.where:
            for name in sorted(names_in(rule) - known.keys()):
                more = suggestion(name, [*known], all_of_them=False)
                self._add(("where",), f"{name} is no value of a point{more}", rule)
        if self.where and not self.faults and next(self._points(()), None) is None:
            self._add(("where",), "leaves no point")

    def _points(self, names: Iterable[str]) -> Iterator[dict[str, Value]]:
        """Points that keep the file's rules, along the dimensions of some names and those that the rules compare."""
        wanted = {*names, *chain(*map(names_in, self.where))}
        ratios = [(name, *RATIOS[name]) for name in self.wanted & RATIOS.keys()]
        wanted |= {*chain(*(related for related in ratios if not wanted.isdisjoint(related)))}
        return points([dim for dim in self.dims if not wanted.isdisjoint(dim.names)], self.where, self.base)

    def _check_points(self) -> None:
        """Check the rules between parameters of which some vary; each is reported where it is broken first."""
        found = [cross_faults(DEFAULTS | with_ratios({**self.base, **point})) for point in self._points(RELATED)]
        ratios = {RATIOS[name][0]: name for name in self.varied if name in RATIOS}
        for fault in first_of_each(chain(*found)):
            name, hint = fault.path[0], ""
            if (rule := re.match(r"must be (<=?) (\w+)=", fault.rule)) and not all(found):
                hint = f"; where: {name} {rule[1]} {rule[2]} leaves out the points that break this"
            if name in ratios:
                self._add(("axes", ratios[name]), f"{fault}{hint}")
            else:
                self.faults.append(
                    Fault(("axes" if name in self.varied else "base", name), fault.value, fault.rule + hint)
                )

    def _check_distributions(self) -> None:
        """Check distributions: of numbers only, of no parameter that varies otherwise, and within valid values.

        Each rule is reported where it is broken first.
        """
        if not isinstance(options := self.options, Sensitivity):
            return
        place, numbers = ("options", "distributions"), self._numbers()
        varied = {*self.varied, *({*numbers}.difference(NUMBERS) if "disc" in self.varied else ())}
        for name, given in options.distributions.items():
            own = _own(name, self.base)
            if name not in numbers:
                known = ", ".join(numbers)
                self._add((*place, name), f"must be of a parameter that is a number (known: {known})")
            elif not given.relative and name in varied:
                self._add((*place, name), "must be relative, since it varies along an axis as well")
            elif given.relative and name not in varied and (not is_number(own) or own == 0):
                self._add((*place, name), f"must not be relative to {as_text(own)}")
        if self.faults:
            return
        for fault in first_of_each(self._out_of_reach(options)):
            at = place if fault.path[0] in options.distributions else ("base",)
            self.faults.append(Fault((*at, *fault.path), fault.value, f"{fault.rule}; distributions reach that far"))

    def _numbers(self) -> list[str]:
        """Names that can be distributed: parameters that are numbers, and those of the modes that all discs have."""
        discs: list[Disc] = [*self.discs.values()] if "disc" in self.wanted else []
        discs += [disc] if (disc := self.base.get("disc")) is not None else []
        if not discs:
            return [*NUMBERS]
        common = [name for name in discs[0].numbers if all(name in disc.numbers for disc in discs)]
        return [*(name for name in NUMBERS if name not in (*PLATE, "damping_ratio")), *common]

    def _out_of_reach(self, options: Sensitivity) -> Iterator[str]:
        """Rules broken by an end of a distribution at any point; rules between parameters are tested at all corners."""
        related = [name for name in sorted(options.distributions) if name in RELATED]
        every = (point.items() for point in self._points([*options.distributions, *RELATED]))
        for point in dict.fromkeys(tuple((name, at) for name, at in items if name != SAMPLE) for items in every):
            here = case_of({**self.base, **dict(point)}, self.discs)
            ends: dict[str, list[float]] = {}
            for name, given in options.distributions.items():
                scale = _own(name, here) if given.relative else 1.0
                ends[name] = [scale * end for end in given.ends]
                for end in ends[name]:
                    try:
                        if name in NUMBERS:
                            SomeParameters.model_validate({name: end})
                        else:
                            here["disc"].with_numbers(**{name: end})
                    except ParameterError as error:
                        yield from (Fault((name,), fault.value, fault.rule) for fault in error.faults)
            for corner in product(*(ends[name] for name in related)):
                yield from cross_faults(DEFAULTS | here | dict(zip(related, corner, strict=True)))

    def _check_plots(self) -> None:
        for name, plot in self.plots.items():
            self.faults += [fault.inside(("figures", name)) for fault in self.faults_of(plot)]

    def faults_of(self, plot: Plot) -> Iterable[Fault]:
        """Faults that keep a figure from showing this grid."""
        # a faulty dimension counts as one without values
        meant = sorted(self.wanted.difference(self.varied))
        values: Values = {**dict.fromkeys(meant, ()), **self.values}
        if isinstance(plot, General):
            return () if self.options is None else _general(plot, self.options, values)
        if self.quantity in plot.quantities:
            return plot.faults(values)
        return [Fault.of(("kind",), plot.kind, f"needs the quantity {plot.quantities[0]}")]

    def entry_of(self, name: str, plot: Plot) -> FigureEntry:
        """A figure of this grid, as lists and reports show it."""
        inputs = {"study": self.name, **dict(sorted(plot.overlays.items()))}
        category = "Figures" if plot.section else "Maps and curves"
        title = plot.title or f"{self.title or self.name}: {name}"
        stated = f"{plot.caption} From the grid study {self.name}.".strip()
        return FigureEntry(plot, inputs, category, plot.section, title, stated)


def _own(name: str, values: Mapping[str, Any]) -> Any:
    """A point's own value of a parameter, if it has one."""
    if isinstance(disc := values.get("disc"), Disc) and name in disc.numbers:
        return disc.numbers[name]
    return values[name] if name in values else getattr(Parameters.model_fields.get(name), "default", None)


def _general(plot: General, quantity: Quantity, values: Values) -> Iterator[Fault]:
    """Faults of a general figure, checked against the variables and dimensions of the quantity."""
    # reads xarray, which other figures do not need
    from disc_model.studies.run import coordinates_of

    grid = {name: [one[0] if len(one) == 1 else one for one in along] for name, along in values.items()}
    own: dict[str, list[Any]] = {}
    variables: dict[str, Any] = {}
    others = [name for name in grid if name != quantity.over]
    for columns, coordinates, dims in (
        (quantity.COLUMNS, quantity.COORDINATES, [*grid]),
        (quantity.SUMMARY_COLUMNS, quantity.SUMMARY_COORDINATES, others),
    ):
        variables |= {name: (*dims, *column.dims) for name, column in columns.items()}
        own |= {name: along.values.tolist() for name, along in coordinates_of(coordinates, quantity).items()}
    return plot.faults_among(grid | own, variables)


# ----------------------------------------------------------------------------------------------------
# Batches


def _chunks(dims: Sequence[Dimension], over: Sequence[str] | None, size: int) -> Iterator[list[list[Value]]]:
    """Points of each batch, a list of values in the order of the dimensions."""
    # an uncut dimension is taken as blocks of one value each
    blocks = [dim.blocks if over is None or dim.name in over else [(value,) for value in dim.values] for dim in dims]
    for chosen in product(*blocks):
        for part in _parts(chosen, size):
            yield [[*chain.from_iterable(point)] for point in part]


def _parts(blocks: Sequence[Sequence[Any]], size: int) -> Iterator[list[tuple[Any, ...]]]:
    """The product of blocks in parts of at most `size`; each holds whole values of a block, and all of later blocks.

    Thus a further value of a dimension that is cut into single values adds parts and keeps the others.
    """
    first, *others = blocks
    within = math.prod(map(len, others))
    if within > size:
        yield from ([(value, *rest) for rest in part] for value in first for part in _parts(others, size))
    else:
        count = size // within
        yield from ([*product(first[i : i + count], *others)] for i in range(0, len(first), count))


def _tiles(
    dims: Sequence[Dimension], batch: BatchSpec, sampled: Collection[Mapping[str, float]]
) -> Iterator[dict[str, Any]]:
    """Points of each tile, and the values along its sides, with those of the next tiles that bound its last cells."""
    plane = _plane(dims, batch.over)
    others = [dim for dim in dims if dim not in plane]
    names = [dim.name for dim in plane]
    gathered = batch.over or [dim.name for dim in others]
    shares = [[dim.values] if dim.name in gathered else [(value,) for value in dim.values] for dim in others]
    for chosen, tile in product(product(*shares), product(*(_cuts(dim.values, batch.tile) for dim in plane))):
        along, kept = zip(*tile, strict=True)
        own = dict(zip([dim.name for dim in (*others, *plane)], [*chosen, *kept], strict=True))
        points = [[*chain.from_iterable(point)] for point in product(*(own[dim.name] for dim in dims))]
        within = [[_at(mark[name], values) for name, values in zip(names, along, strict=True)] for mark in sampled]
        inside = sorted(places for places in within if None not in places)
        yield {"points": points, "tile": {"names": names, "along": along, "sampled": inside}}


def _plane(dims: Sequence[Dimension], over: Sequence[str] | None) -> list[Dimension]:
    """The dimensions of a plane of tiles: those that are named first, or else all numeric ones."""
    numbers = [dim for dim in dims if len(dim.names) == 1 and is_number(dim.values[0][0])]
    return [dim for dim in numbers if over is None or dim.name in over[:2]]


def _at(value: float, along: Sequence[Value]) -> int | None:
    """Index of a value along the side of a tile."""
    return next((i for i, one in enumerate(along) if math.isclose(value, float(one), rel_tol=1e-12)), None)


def _cuts(values: Sequence[tuple[Value, ...]], size: int) -> list[tuple[list[Value], Sequence[tuple[Value, ...]]]]:
    """Stretches of about `size` intervals, and the part of each that no later stretch contains."""
    n = len(values) - 1
    count = max(1, round(n / size))
    edges = [round(i * n / count) for i in range(count + 1)]
    return [([value for (value,) in values[a : b + 1]], values[a : b + (b == n)]) for a, b in pairwise(edges)]
