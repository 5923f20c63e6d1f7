"""Scripts of the workflow and of the docs, which the quick tests do not run, import what there is."""

import ast
from collections.abc import Iterator
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SCRIPTS = sorted(
    [
        *ROOT.glob("workflow/schemas/*.py"),
        *ROOT.glob("docs/*.py"),
        *ROOT.glob("docs/measurements/*.py"),
    ]
)


def missing_names(text: str) -> Iterator[str]:
    """Names that a script imports from the package and that its modules do not have."""
    for node in ast.walk(ast.parse(text)):
        if not isinstance(node, ast.ImportFrom) or not node.module:
            continue
        if node.module.split(".")[0] != "disc_model":
            continue
        module = import_module(node.module)
        for imported in node.names:
            name = f"{node.module}.{imported.name}"
            if not hasattr(module, imported.name) and not _is_module(name):
                yield name


def _is_module(name: str) -> bool:
    """Whether there is a module of this name, which its package may not have imported yet."""
    try:
        return find_spec(name) is not None
    except ModuleNotFoundError:
        return False


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.name)
def test_a_script_imports_what_there_is(script: Path) -> None:
    """A function had moved to another module, and no figure could be drawn."""
    assert list(missing_names(script.read_text(encoding="utf-8"))) == []
