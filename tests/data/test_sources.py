"""The lists of sources against what is imported."""

import ast
from collections.abc import Iterable
from importlib import import_module
from pathlib import Path

import grimp
import pytest

from disc_model.data.provenance import PACKAGE, source_files
from disc_model.data.sources import KINDS
from disc_model.figures.kinds import KINDS as FIGURES
from disc_model.figures.kinds import OwnFigure
from disc_model.figures.paper.catalogue import CATALOGUE
from disc_model.studies.document import QUANTITIES
from disc_model.studies.grids.merge import summary_of

SCRIPTS = Path(__file__).parents[2] / "workflow" / "scripts"
GRAPH = grimp.build_graph("disc_model", exclude_type_checking_imports=True)
DATA = {".yaml", ".toml", ".json", ".html", ".css", ".js", ".mplstyle"}
"""Endings of files that are read and not imported."""
PAPER = PACKAGE / "config" / "paper.yaml"
MESSAGES = PACKAGE / "renamed.toml"
BESIDES = {
    "": "names only",
    "bytecode": "says what made a result",
    "data.provenance": "says what made a result",
    "data.sources": "says what made a result",
    "explorer": "a name only",
    "figures": "a name only",
    "figures.kinds": "says what a file may ask for",
    "figures.paper": "a name only",
    "figures.paper.catalogue": "says what a file may ask for",
    "kernels": "decides when kernels are compiled",
    "plausibility": "warns",
    "mode_choice": "a kind of its own, where it is asked",
    "progress": "shows progress",
    "renamed": "words of messages only",
    "simulation.quicklook": "draws for a reader",
    "studies.grids": "a name only",
    "studies.document": "a batch's text holds the values of all options",
    "studies.grids.quantities": "a name only",
}
"""Modules that are imported but do not affect results, with the reason."""
ROOTS = {
    "case": ["simulation.api"],
    "modes_by_motion": ["mode_choice"],
    **{name: ["studies.grids.run", f"studies.grids.quantities.{name}"] for name in QUANTITIES},
}
"""Where results begin that are no script's."""
DRAWN = {
    ("draw_figure", plot.module.removeprefix("disc_model.")) for plot in (entry.plot for entry in CATALOGUE.values())
} | {
    ("draw_figure", kind.model_construct().module.removeprefix("disc_model."))
    for kind in FIGURES.values()
    if kind is not OwnFigure
}
JOBS = sorted({*((name,) for name in ROOTS), *((name,) for name in KINDS if (SCRIPTS / f"{name}.py").exists()), *DRAWN})


def imported_by(script: Path) -> set[str]:
    """Modules of the package that a script imports."""
    nodes = [node for node in ast.walk(ast.parse(script.read_text())) if isinstance(node, ast.ImportFrom)]
    assert not {node.module for node in nodes} & {"disc_model"}, "names that are looked up on first use"
    named = {f"{node.module}.{alias.name}" for node in nodes for alias in node.names} | {node.module for node in nodes}
    return {str(name).removeprefix("disc_model.") for name in named & GRAPH.modules} - {"disc_model"}


def reached(roots: Iterable[str], stop: Iterable[str]) -> set[str]:
    """Modules that are imported from some, at any depth, and not through those at which to stop."""
    found, waiting = set(), {*roots}
    while waiting:
        name = waiting.pop()
        found.add(name)
        if name not in stop:
            direct = GRAPH.find_modules_directly_imported_by(f"disc_model.{name}")
            waiting |= {one.removeprefix("disc_model.") for one in direct if one != "disc_model"} - found
    return found


def listed(*names: str) -> set[str]:
    files = [path.relative_to(PACKAGE) for path in source_files(*names) if path.suffix == ".py"]
    return {".".join(path.with_suffix("").parts).removesuffix(".__init__") for path in files}


@pytest.mark.parametrize("names", JOBS, ids="-".join)
def test_the_sources_of_a_result_are_what_it_imports(names: tuple[str, ...]) -> None:
    kind, *modules = names
    roots = ROOTS.get(kind) or imported_by(SCRIPTS / f"{kind}.py")
    own = listed(*names)
    found = reached([*roots, *modules], BESIDES.keys() - own)
    assert not found - own - BESIDES.keys(), "imported, and not listed"
    if not modules:  # of whole packages not all need be used
        single = {name for name in KINDS[kind].split() if (PACKAGE / f"{name.replace('.', '/')}.py").is_file()}
        drawn = reached([module for job, module in DRAWN if job == kind], ())
        assert not single - KINDS.keys() - found - drawn, "listed, and not imported"


def test_all_that_is_listed_is_there() -> None:
    for name in KINDS:
        assert source_files(name)
    assert all(import_module(f"disc_model.{name}".rstrip(".")) for name in BESIDES)
    data = {path for path in PACKAGE.rglob("*") if path.suffix in DATA and not path.is_relative_to(PACKAGE / "engine")}
    assert data - {MESSAGES} == {
        path for name in KINDS for path in source_files(name) if path.suffix in DATA and path != PAPER
    }
    assert {name for name in QUANTITIES if summary_of(name)} == {"campbell", "sensitivity"}
