"""Study files: one kind of YAML, which says a grid, named cases, or both, and is checked all at once.

`load_study` reads such a file, `study_from_config` takes what Snakemake read from one or several, `parse_study` the
mapping itself. All raise one `StudyError` that lists every fault with its path.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from glob import glob
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field

from disc_model.figures.cases.kinds import CASE_PLOTS, CasePlot
from disc_model.figures.grids.kinds import PLOTS
from disc_model.figures.paper.catalogue import CATALOGUE, faults_of
from disc_model.schema import Strict
from disc_model.simulation.case import CaseSpec
from disc_model.studies.cases.schema import Case, Name, parse_cases
from disc_model.studies.files import Faults, StudyError, mapping, read_file, shown_path, validated
from disc_model.studies.grids.schema import GRID_KEYS, GridStudy, load_grids, parse_grid

TAKEN = ("compiled", "bench")
"""Folders of results that no study may have."""


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
    overrides: Mapping[str, Any] = field(default_factory=dict)
    resolution: Any = 1

    @property
    def labels(self) -> dict[str, dict[str, str]]:
        """What is written about the cases and does not change their results."""
        return {name: {"title": case.title, "reference": case.reference} for name, case in self.cases.items()}

    @property
    def drawable(self) -> tuple[str, ...]:
        """Figures that these cases have all that is needed for: of the paper, and of cases."""
        return (*(name for name in CATALOGUE if not list(_lacking(name, self.specs))), *self.plots)

    def grids(self, folders: Sequence[Path] = (Path(),)) -> tuple[dict[str, GridStudy], tuple[str, ...]]:
        """Its own grid and those of its files, and the names of those that are asked for.

        Besides them there are those that a figure of its own grid shows as well, read from files beside it.

        Parameters
        ----------
        folders : where files are looked for, the first that has one counts

        Raises
        ------
        StudyError
        """
        paths = [path for pattern in self.studies for path in _found(pattern, folders)]
        own = {} if self.grid is None else {self.name: self.grid}
        asked = (*own, *(Path(path).stem for path in paths))
        helpers = _shown_besides(self.grid, asked, folders)
        taken = {*TAKEN} if self.grid is not None else {self.name, *TAKEN}
        grids = load_grids([*paths, *helpers], self.overrides, self.resolution, taken=taken, own=own, asked=asked)
        return grids, asked


def load_study(path: str | Path) -> Study:
    """Read and check a study file, but for the files that it names.

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
    return _with_more_faults(config, faults, ", ".join(map(shown_path, paths)) or "study")


def parse_study(raw: Any) -> Study:
    """Check the mapping a study file holds; raises `StudyError` listing every fault."""
    faults = Faults()
    header = validated(Document, raw, (), faults)
    raw = mapping(raw)
    if header is not None and header.study in TAKEN:
        faults.add(("study",), header.study, "is the name of another folder of results")
    if not raw.keys() & {"cases", "studies", *GRID_KEYS}:
        faults.add((), "", "must say what to compute: cases, or quantity and axes, or studies")
    cases, specs = parse_cases(raw, faults)
    listed, plots, of_grid = _figures(raw, specs, faults)
    grid = None
    if raw.keys() & GRID_KEYS:
        grid = _grid(raw, of_grid, faults)
    if faults or header is None:
        raise StudyError(*faults)
    return Study(
        header.study, header.title, cases, specs, listed, plots, header.claims, grid, header.studies,
        header.overrides, header.resolution,
    )  # fmt: skip


# ----------------------------------------------------------------------------------------------------
# Parts


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
            if isinstance(kind, str) and kind in CASE_PLOTS:
                plot = _case_plot(str(name), kind, said, raw, specs, faults)
                if plot is not None:
                    plots[str(name)] = plot
            elif isinstance(kind, str) and kind in PLOTS and raw.keys() & GRID_KEYS:
                of_grid[name] = said
            elif isinstance(kind, str) and kind in PLOTS:
                faults.add(("figures", str(name), "kind"), kind, "shows a grid, and this study has none")
            else:
                rule = f"unknown kind of figure (known: {', '.join((*CASE_PLOTS, *PLOTS))})"
                faults.add(("figures", str(name), "kind"), kind, rule)
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
    if not isinstance(name, str) or not name.isidentifier() or name in CATALOGUE:
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
            faults.add(path, name, f"unknown figure (known: {', '.join(CATALOGUE)})")
            continue
        for case, fault in _lacking(name, specs):
            if case in specs or case not in known:  # else the case has faults of its own
                faults.add(path, name, fault)


def _lacking(figure: str, specs: Mapping[str, CaseSpec]) -> Iterable[tuple[str, str]]:
    """What keeps one of the paper's figures from being drawn: the case that it is about, and why."""
    for case, windows in CATALOGUE[figure].needs.items():
        if case not in specs:
            yield case, f"needs a case {case}"
            continue
        recorded = dict(specs[case].windows)
        for window in windows:
            if window == "poincare":
                if specs[case].poincare is None:
                    yield case, f"needs cases.{case}.record.poincare"
                continue
            if window not in recorded:
                yield case, f"needs a window {window} in cases.{case}.record.windows"
                continue
            for fault in faults_of(figure, window, recorded[window]):
                yield case, f"cases.{case}.record.windows.{window} {fault}"


# ----------------------------------------------------------------------------------------------------
# Files


def _found(pattern: str, folders: Sequence[Path]) -> list[str]:
    """Files that a pattern stands for, in the first folder that has any; the pattern itself if none has."""
    for folder in folders:
        if matches := sorted(glob(str(folder / pattern))):
            return matches
    return [pattern]


def _shown_besides(grid: GridStudy | None, asked: Sequence[str], folders: Sequence[Path]) -> list[str]:
    """Files of studies that figures of a grid show as well, and that nothing else asks for."""
    if grid is None:
        return []
    wanted = {name for plot in grid.plots.values() for name in plot.others.values()} - set(asked)
    return [path for name in sorted(wanted) for path in _found(f"{name}.yaml", folders) if Path(path).is_file()]


def _with_more_faults(raw: Any, more: list[str], source: str) -> Study:
    """`parse_study`, with faults found already and the name of the file in the error."""
    try:
        study = parse_study(raw)
    except StudyError as error:
        raise StudyError(*more, *error.faults, source=source) from None
    if more:
        raise StudyError(*more, source=source)
    return study
