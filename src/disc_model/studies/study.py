"""Studies: their files are read and checked, and yield named cases and grids.

`load_study` reads files, `study_from_config` takes what Snakemake read from one or more files, and `parse_study` takes
the mapping itself. All raise one `StudyError` that lists every fault with its path: those of single values first, and
those between values once these are right. The keys of a file are defined in `disc_model.studies.document`. Each case
inherits the study's base values and default records.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import partial, reduce
from glob import glob
from itertools import chain
from pathlib import Path
from typing import Any

import yaml

from disc_model.data.variables import values_text
from disc_model.disc.plausibility import RULES
from disc_model.disc.tables import read_disc
from disc_model.errors import DiscModelError, Fault, ParameterError, suggestion
from disc_model.figures.kind import NORM, CasePlot, Plot
from disc_model.simulation.case import CaseSpec
from disc_model.studies.document import Document
from disc_model.studies.grid import GRID_KEYS, FigureEntry, GridStudy

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


MODES = {
    "as_published": "modes scaled as in the published results",
    "orthonormal": "modes normalised as Eq. (17) says",
}
"""Normalizations in captions."""


class Study:
    """A study. `faults` lists what is wrong with it.

    document : content of the file; the study has its name, title, claims, cases, and files of further grid studies
    specs : what is simulated of each case, in the order of the file
    figures : figures of cases and of grids, by name
    grid : the file's own grid, if it has one
    """

    def __init__(self, document: Document) -> None:
        self.document, self.name, self.title, self.claims = document, document.study, document.title, document.claims
        self.cases, self.studies, self.figures = document.cases, document.studies, document.figures
        self.faults: list[Fault] = []
        self.specs: dict[str, CaseSpec] = {}
        for name, case in self.cases.items():
            try:
                self.specs[name] = case.spec()
            except ParameterError as error:
                self.faults += [fault.inside(("cases", name)) for fault in error.faults]
        keys = document.model_fields_set
        own = {name: plot for name, plot in self._plots if plot.study in ("", self.name)}
        self.grid = GridStudy(document, own) if document.options is not None else None
        if self.name in ("compiled", "bench"):  # folders beside those of studies
            self.faults.append(Fault.of(("study",), self.name, "is the name of another folder of results"))
        if self.grid is not None:
            self.faults += self.grid.faults
        elif keys & GRID_KEYS:
            self.faults.append(Fault(("quantity",), "", "is required"))
        elif not keys & {"cases", "studies"}:
            rule = "must say what to compute: cases, or quantity and axes, or studies"
            self.faults.append(Fault(("study",), "", rule))
        self.faults += self._wrong_figures()

    @property
    def _plots(self) -> Iterator[tuple[str, Plot]]:
        """The figures of grids, with their names."""
        return ((name, plot) for name, plot in self.figures.items() if isinstance(plot, Plot))

    def _wrong_figures(self) -> Iterator[Fault]:
        """Faults of the figures of cases, and of those of a grid that the file lacks."""
        cases = {name: self.specs[name].sections if name in self.specs else None for name in self.cases}
        for name, plot in self.figures.items():
            if isinstance(plot, CasePlot):
                yield from (fault.inside(("figures", name)) for fault in plot.faults(cases))
            elif isinstance(plot, Plot) and not plot.study and self.grid is None:
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
    faults: list[str] = [*known]
    if folder is not None:
        raw = _with_discs(raw, folder, faults)
    try:
        study = Study(_document(raw))
        faults += study.faults
    except ParameterError as error:
        # what is wrong in the values for all cases is wrong in each
        faults += [fault for fault in error.faults if fault.path[:1] != ("cases",)] or error.faults
    if faults:
        raise StudyError(*faults, source=source)
    return study


def _document(raw: Any) -> Document:
    """The content of a file, in which each case has what it inherits; raises `ParameterError`."""
    if not isinstance(raw, Mapping):
        raise ParameterError(Fault.of(("study",), raw, "must be a mapping"))
    content = dict(raw)
    if isinstance(raw.get("cases"), Mapping):
        shared = {"parameters": raw.get("base"), "record": raw.get("record"), "tol": raw.get("tol")}
        shared = {key: value for key, value in shared.items() if value is not None}
        content["cases"] = {
            name: {"parameters": {}} | inherit(shared, case) if isinstance(case, Mapping) else case
            for name, case in raw["cases"].items()
        }
    if raw.get("quantity") is not None:
        content.setdefault("options", {})
    return Document.model_validate(content)


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
