"""A name that many modules could use means one thing in the package."""

import ast
from collections import defaultdict
from pathlib import Path

import disc_model

PACKAGE = Path(disc_model.__file__).parent
ONE_THING = {"OUTCOMES", "CYCLES", "QUANTITIES", "Fault", "EngineCase", "State", "Status", "Verdict", "Window", "Span"}
BELOW = PACKAGE / "engine"
"""Its arrays and tuples bear the names of what they hold."""


def defined(tree: ast.Module) -> set[str]:
    """Names of classes and constants of a module."""
    names = {node.name for node in tree.body if isinstance(node, ast.ClassDef)}
    assigned = [node.targets[0] for node in tree.body if isinstance(node, ast.Assign)]
    assigned += [node.target for node in tree.body if isinstance(node, ast.AnnAssign)]
    return names | {target.id for target in assigned if isinstance(target, ast.Name)}


def test_each_of_these_names_is_defined_once() -> None:
    places = defaultdict(list)
    for path in PACKAGE.rglob("*.py"):
        if BELOW not in path.parents and not {"workflow", "config"} & {*path.relative_to(PACKAGE).parts[:1]}:
            for name in ONE_THING & defined(ast.parse(path.read_text(encoding="utf-8"))):
                places[name].append(path.relative_to(PACKAGE).as_posix())
    assert {name: where for name, where in places.items() if len(where) > 1} == {}
    assert places["Fault"] == ["errors.py"]
