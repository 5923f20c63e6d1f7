"""Studies: their files are read and checked, and yield named cases and grids.

One `StudyError` lists all faults: those of single values, or those between values once these are right.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial, reduce
from glob import glob
from pathlib import Path
from typing import Any

import yaml
from yaml.composer import ComposerError

from disc_model.data.variables import values_text
from disc_model.disc.given import read_disc
from disc_model.disc.plausibility import RULES
from disc_model.display import counted
from disc_model.errors import DiscModelError, Fault, ParameterError, raise_faults, suggestion
from disc_model.figures.kind import NORM, CasePlot, Plot
from disc_model.simulation.case import CaseSpec
from disc_model.studies.document import Document
from disc_model.studies.grid import GRID_KEYS, FigureEntry, GridStudy

# ---- Reading


class StudyError(DiscModelError, ValueError):
    """A study file that breaks rules; lists every fault once, as ``path = value: rule``."""

    def __init__(self, *faults: str, source: str = "study") -> None:
        texts = (fault.in_file if isinstance(fault, Fault) and fault.path else str(fault) for fault in faults)
        self.faults, self.source = tuple(dict.fromkeys(texts)), source
        super().__init__("\n  ".join([f"{source}: {counted(len(self.faults), 'fault')}", *self.faults]))

    def __reduce__(self) -> tuple[Any, ...]:
        return (partial(type(self), source=self.source), self.faults)


def read_file(path: Path) -> Any:
    """A YAML file's content; raises `StudyError` if it cannot be read or gives a key twice."""
    try:
        return read_yaml(path.read_text(encoding="utf-8"), str(path))
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else f"byte {error.start} is no UTF-8"
        raise StudyError(f"cannot be read: {reason}", source=str(path)) from None


def read_yaml(text: str, source: str = "study") -> Any:
    """A YAML document; raises `StudyError` if the text is none or gives a key twice."""
    try:
        return yaml.load(text, _Loader)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = f"line {mark.line + 1}, column {mark.column + 1}: " if mark else ""
        fault = line + ", ".join(part for part in (error.context, error.problem) if part)
    except (yaml.YAMLError, ValueError, RecursionError, AttributeError, KeyError, TypeError) as error:
        # ValueError and what follows: a value looks like a number or date, or has a tag, that it does not fit
        fault = f"a value does not fit its form or tag ({' '.join(str(error).split())})"
    raise StudyError(fault, source=source)


class _Loader(yaml.SafeLoader):
    """Refuses a key that is given twice, of which YAML itself would take the last value."""

    def compose_mapping_node(self, anchor: Any) -> yaml.MappingNode:
        node = super().compose_mapping_node(anchor)
        known = set[str]()
        for key, _ in node.value:
            if key.value in known and key.value != "<<":
                raise ComposerError(None, None, f"{key.value} is given twice", key.start_mark)
            known.add(key.value)
        return node


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


# ---- Studies

OTHER_FOLDERS = ("compiled", "bench")  # in results/, beside those of studies
MODES = {"as_published": "modes scaled as in the published results", "orthonormal": "modes normalised as Eq. (17) says"}


class Study:
    """A study; raises `ParameterError` with the faults between the parts of its file."""

    def __init__(self, document: Document) -> None:
        self.document, self.name, self.title, self.claims = document, document.study, document.title, document.claims
        self.cases, self.studies, self.figures = document.cases, document.studies, document.figures
        self.specs: dict[str, CaseSpec] = {}  # what is simulated of each case
        self.grid: GridStudy | None = None  # the file's own
        self._grid_plots = [(name, plot) for name, plot in self.figures.items() if isinstance(plot, Plot)]
        faults: list[Fault] = []
        for name, case in self.cases.items():
            try:
                self.specs[name] = case.spec()
            except ParameterError as error:
                faults += [fault.inside(("cases", name)) for fault in error.faults]
        keys = document.model_fields_set
        if self.name in OTHER_FOLDERS:
            faults.append(Fault.of(("study",), self.name, "is the name of another folder of results"))
        if document.quantity is not None:
            try:
                plots = {name: plot for name, plot in self._grid_plots if plot.study in ("", self.name)}
                self.grid = GridStudy(document, plots)
            except ParameterError as error:
                faults += error.faults
        elif keys & GRID_KEYS:
            faults.append(Fault(("quantity",), "", "is required"))
        elif not keys & {"cases", "studies"}:
            faults.append(Fault(("study",), "", "must say what to compute: cases, or quantity and axes, or studies"))
        recorded = {name: self.specs[name].sections if name in self.specs else None for name in self.cases}
        for name, plot in self.figures.items():
            if isinstance(plot, CasePlot):
                faults += (fault.inside(("figures", name)) for fault in plot.faults(recorded))
            elif isinstance(plot, Plot) and not plot.study and document.quantity is None:
                rule = "shows a grid: this study has none, and no other one is named as its study"
                faults.append(Fault.of(("figures", name, "kind"), plot.kind, rule))
        raise_faults(faults)

    @property
    def labels(self) -> dict[str, dict[str, str]]:
        """Texts about the cases, which do not change their results."""
        return {name: {"title": case.title or name, "reference": case.reference} for name, case in self.cases.items()}

    def entries(self, grids: Mapping[str, GridStudy]) -> dict[tuple[str, str], FigureEntry]:
        """All figures of the file and of grids, by the study in whose folder they are and their names."""
        figures = {}
        for name, plot in self.figures.items():
            if isinstance(plot, Plot):
                figures[self.name, name] = grids[plot.study or self.name].entry_of(name, plot)
            elif isinstance(plot, CasePlot):
                parameters = [self.specs[case].parameters for case in plot.cases]
                values = "; ".join(dict.fromkeys(values_text(dict(p)) for p in parameters))
                modes = " and ".join(MODES[mode] for mode in sorted({p.normalization for p in parameters}))
                title, inputs = plot.title or name, {case: case for case in plot.cases}
                caption = f"{plot.caption or f'{title}:'} {values}; everything else as in Table 1; {modes}."
                section = plot.section or plot.case
                figures[self.name, name] = FigureEntry(plot, inputs, "Figures", section, title, caption)
        for grid in grids.values():
            for name, grid_plot in grid.plots.items():
                figures.setdefault((grid.name, name), grid.entry_of(name, grid_plot))
        return figures

    @property
    def doubts(self) -> Iterator[str]:
        """Warnings about implausible cases, each with their number."""
        for rule in RULES.values():
            if texts := [text for spec in self.specs.values() if (text := rule.doubt(spec.parameters))]:
                yield f"{texts[0]} ({len(texts)} of {len(self.specs)} cases)"

    def grids(self, folders: Sequence[Path] = (Path(),)) -> tuple[dict[str, GridStudy], tuple[str, ...]]:
        """All grids, also those that only figures show, and the names of those of this file and the files it names."""
        grids = {} if self.grid is None else {self.name: self.grid}
        paths = [path for pattern in self.studies for path in _matching(pattern, folders)]
        requested = (*grids, *(path.stem for path in paths))
        shown = {name for _, plot in self._grid_plots for name in (plot.study, *plot.overlays.values()) if name}
        further = [path for name in sorted(shown.difference(requested)) for path in _matching(f"{name}.yaml", folders)]
        paths += (path for path in further if path.is_file())
        known = {*requested, *(path.stem for path in paths)}
        faults: list[str] = []
        for path in paths:
            self._add_grid(path, grids, faults)
        for name in self.document.overrides.keys() - known:
            faults.append(f"overrides.{name}: no such study{suggestion(name, sorted(known))}")
        plots = [(grids[name], figure, plot) for name in sorted({*grids} & {*requested})
                 for figure, plot in grids[name].plots.items()]  # fmt: skip
        for figure, plot in self._grid_plots:
            if plot.study in grids and plot.study != self.name:
                plots.append((grids[plot.study], figure, plot))
                misfits = grids[plot.study].faults_of(plot)
                faults += [fault.inside(("figures", figure)).in_file for fault in misfits]
            elif plot.study and plot.study not in known:
                rule = f"no such study{suggestion(plot.study, sorted(known))}"
                faults.append(Fault.of(("figures", figure, "study"), plot.study, rule).in_file)
        for grid, figure, plot in plots:
            owner = grid.name if figure in grid.plots else self.name
            for role, other in plot.overlays.items():
                rules = [f"no such study{suggestion(other, sorted(known))}"] if other not in known else []
                rules += _misfits(plot, role, grid, grids[other]) if other in grids else []
                faults += [f"{owner}: figures.{figure}.overlays.{role} = {other!r}: {rule}" for rule in rules]
        if faults:
            raise StudyError(*faults, source="grid studies")
        return grids, requested

    def _add_grid(self, path: Path, grids: dict[str, GridStudy], faults: list[str]) -> None:
        try:
            content = inherit(mapping(read_file(path)), self.document.overrides.get(path.stem, {}))
            study = parse_study({"resolution": self.document.resolution, **content}, path.parent, _shown_path(path))
        except StudyError as error:
            faults += [f"{error.source}: {fault}" for fault in error.faults]
            return
        wrong = {
            "must be the name of the file": study.name != path.stem,
            "is another file's study": path.stem in grids,
            "is the name of another folder of results": study.name == self.name and self.grid is None,
            "must be a grid alone": study.grid is None or study.cases or study.studies,
            "must have no figures of other studies": any(p.study not in ("", study.name) for _, p in study._grid_plots),
        }
        faults += [f"{path}: study = {study.name!r}: {rule}" for rule, broken in wrong.items() if broken]
        if study.grid is not None:
            grids[path.stem] = study.grid


def load_study(*paths: str | Path) -> Study:
    """Read and check study files, later ones laid over earlier ones, but not the files that they name."""
    return study_from_config(read_files(*paths), paths)


def read_files(*paths: str | Path) -> Any:
    return reduce(lambda below, changes: inherit(mapping(below), mapping(changes)), map(read_file, map(Path, paths)))


def study_from_config(config: Any, files: Iterable[str | Path]) -> Study:
    """The study from Snakemake's merged configuration files, and its command line."""
    paths = [Path(file) for file in files]
    for path in paths:
        read_file(path)  # finds duplicate keys, which the mapping no longer shows
    return parse_study(config, paths[-1].parent if paths else Path(), ", ".join(map(_shown_path, paths)) or "study")


def parse_study(raw: Any, folder: Path | None = None, source: str = "study") -> Study:
    """The study of the mapping that a file holds, with tables of discs from a folder, if it may name any."""
    try:
        return Study(_document(raw if folder is None else _with_discs(raw, folder)))
    except ParameterError as error:
        # what is wrong in the values for all cases is wrong in each
        faults = [fault for fault in error.faults if fault.path[:1] != ("cases",)] or error.faults
        raise StudyError(*faults, source=source) from None


def _document(raw: Any) -> Document:
    """The content of a file, in which each case has what it inherits."""
    if not isinstance(raw, Mapping):
        raise ParameterError(Fault.of(("study",), raw, "must be a mapping"))
    content = dict(raw)
    if isinstance(raw.get("cases"), Mapping):
        keys = {"base": "parameters", "record": "record", "tol": "tol"}
        shared = {inner: raw[key] for key, inner in keys.items() if raw.get(key) is not None}
        content["cases"] = {
            name: {"parameters": {}} | inherit(shared, case) if isinstance(case, Mapping) else case
            for name, case in raw["cases"].items()
        }
    if raw.get("quantity") is not None:
        content.setdefault("options", {})
    return Document.model_validate(content)


def _with_discs(raw: Any, folder: Path, path: tuple[str, ...] = ()) -> Any:
    """A file's content with discs in place of the names of their tables: recomputation depends on a table's content."""
    if not isinstance(raw, Mapping):
        return raw
    if not path:  # names along an axis of discs are tables too
        zips = raw.get("zip")
        groups = [raw.get("axes"), *(zips if isinstance(zips, list) else [zips])]
        axes = [mapping(group).get("disc") for group in groups]
        varied = [name for axis in axes if isinstance(axis, list) for name in axis if isinstance(name, str)]
        if varied:
            raw = {**raw, "discs": {**dict(zip(varied, varied, strict=True)), **mapping(raw.get("discs"))}}
    content = {}
    for key, value in raw.items():
        inner = (*path, str(key))
        if isinstance(value, str) and (path == ("discs",) or inner[-2:] in (("base", "disc"), ("parameters", "disc"))):
            try:
                content[key] = read_disc(folder / value).model_dump(mode="json", exclude_none=True)
            except ParameterError as error:
                raise ParameterError(*(Fault(inner, "", str(fault)) for fault in error.faults)) from None
        else:
            content[key] = _with_discs(value, folder, inner)
    return content


def _shown_path(path: Path) -> str:
    whole, current = path.resolve(), Path.cwd()
    return str(whole.relative_to(current) if whole.is_relative_to(current) else path)


def _matching(pattern: str, folders: Sequence[Path]) -> list[Path]:
    """Files that match a pattern, in the first folder that has any; the pattern itself if there are none."""
    matches = (sorted(glob(str(folder / pattern))) for folder in folders)
    return [Path(path) for path in next(filter(None, matches), [pattern])]


def _misfits(plot: Plot, role: str, study: GridStudy, other: GridStudy) -> Iterator[str]:
    """Rules that a further study breaks in a role of a study's figure."""
    wanted = plot.roles[role]
    if other.quantity not in (wanted.quantity, wanted.instead):
        good = " or ".join(filter(None, (wanted.quantity, wanted.instead)))
        yield f"must be a study of the quantity {good}, and not {other.quantity}"
        return
    for name, value in wanted.options.items():
        if (option := getattr(other.options, name)) != value:
            yield f"must have options.{name} = {value!r}, and not {option!r}"
    needs = plot.dims if wanted.dims is None else wanted.dims
    if (dims := other.values.keys() - {NORM}) != set(needs):
        needed, varied = (", ".join(sorted(names)) or "nothing" for names in (needs, dims))
        yield f"must vary {needed} beside {NORM}, and not {varied}"
        return
    norms = [{str(value) for (value,) in grid.values.get(NORM, [(grid.base.get(NORM),)])} for grid in (study, other)]
    if absent := norms[0] - norms[1]:
        yield f"must be computed for the same {NORM}: {', '.join(sorted(absent))}"


# ---- Whose results a folder holds, and what a finished run says


def check_owner(name: str, results: str, files: list[str], owner: Path) -> None:
    """Raise DiscModelError if other study files of this name, listed by the file `owner`, have made the results."""
    former = owner.read_text(encoding="utf-8").splitlines() if owner.exists() else files
    # further files laid over the same ones are the same study in other detail
    differ = any(file != before for file, before in zip(files, former, strict=False))
    exist = all(Path(file).is_file() for file in former)
    if exist and differ and mapping(read_files(*former)).get("study") == name:
        raise DiscModelError(
            f"study = {name!r}: is also the name of the study in {', '.join(former)}, whose results are in {results}"
            " and would be overwritten; give one of them another name, or another folder with --directory"
        )


def closing_lines(study: Study, figures: Sequence[Path], grids: Mapping[str, GridStudy]) -> Iterator[str]:
    if figures:
        folders = {str(figure.parent) for figure in figures}
        folder = folders.pop() if len(folders) == 1 else "results/*/figures"
        yield f"{study.name}: {counted(len(figures), 'figure')} in {folder}"
    if grids:
        lists = [Path(f"results/{name}/{name}.failed.txt") for name in grids]
        failed = {file: len(file.read_text(encoding="utf-8").splitlines()) for file in lists}
        points, lacking = sum(grid.n_points for grid in grids.values()), ", ".join(str(x) for x in lists if failed[x])
        others = f", for others see {lacking}" if lacking else ""
        yield f"{points - sum(failed.values())} of {points} points have a result{others}"
        page = f"results/{study.name}/explorer.html"
        yield f"The same command with the target `explorer` makes a page of every point: {page}"
        yield "(disc-model study ... --target explorer, or snakemake ... explorer)"
