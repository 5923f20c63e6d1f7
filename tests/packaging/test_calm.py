"""What a reader of the code spends: ideas on a line, branches of a function, width, and imports.

The limits are those of calm code, between today's and what libraries of the field have: diffrax,
hapsira, PyBaMM and ROSS have 3 to 4 syntax nodes on a line, and 2 to 5 conditional expressions and
at most 2.5 packed tuples in 1000 lines. They keep several statements from being folded into one.
"""

from __future__ import annotations

import ast
import statistics
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SOURCES = ROOT / "src"
TESTS = ROOT / "tests"
PACKAGE = "disc_model"

WIDEST = 100  # columns
DENSE = 20  # syntax nodes on a line that a reader must take apart
MOST_COMPLEX = 15  # cyclomatic complexity of a function that can be followed at once
LONGEST = 100  # lines of a function
MOST_IMPORTS = 15  # modules that a module imports

COMPREHENSIONS = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)
BRANCHES = (ast.If, ast.For, ast.While, ast.IfExp, ast.ExceptHandler, ast.match_case)


@dataclass
class Measured:
    """Counts over the files of a folder; what is listed says where."""

    code_lines: int = 0
    nodes: list[int] = field(default_factory=list)  # on each line of code
    dense: list[str] = field(default_factory=list)
    wide: list[str] = field(default_factory=list)
    packed: list[str] = field(default_factory=list)
    conditional: list[str] = field(default_factory=list)
    nested: list[str] = field(default_factory=list)
    unions: list[str] = field(default_factory=list)
    complex: list[str] = field(default_factory=list)
    long: list[str] = field(default_factory=list)
    many_imports: list[str] = field(default_factory=list)
    by_name: list[str] = field(default_factory=list)  # imports of a module by its name as a text

    def per_thousand(self, places: list[str]) -> float:
        """Number of places in 1000 lines of code."""
        return 1000.0 * len(places) / self.code_lines

    def percent(self, places: list[str]) -> float:
        """Share of the lines of code, in percent."""
        return 100.0 * len(places) / self.code_lines


def measured(*texts: tuple[str, str]) -> Measured:
    """Measure modules, given as pairs of a name and a source text."""
    result = Measured()
    for name, text in texts:
        tree = ast.parse(text)
        _measure_lines(result, name, text, tree)
        _measure_statements(result, name, tree)
        _measure_functions(result, name, tree)
        if len(set(_imported_names(tree))) > MOST_IMPORTS:
            result.many_imports.append(name)
    return result


def _measure_lines(result: Measured, name: str, text: str, tree: ast.Module) -> None:
    """Count the lines of code, their syntax nodes, and those that are dense or wide."""
    docstrings = _docstring_lines(tree)
    code: dict[int, str] = {}
    for number, line in enumerate(text.splitlines(), 1):
        is_comment = line.lstrip().startswith("#")
        if line.strip() and not is_comment and number not in docstrings:
            code[number] = line

    nodes = Counter(getattr(node, "lineno", 0) for node in ast.walk(tree))
    on_code = {number: count for number, count in nodes.items() if number in code}
    result.code_lines += len(code)
    result.nodes += on_code.values()
    result.dense += [f"{name}:{number}" for number, count in on_code.items() if count > DENSE]
    result.wide += [f"{name}:{number}" for number, line in code.items() if len(line) > WIDEST]


def _docstring_lines(tree: ast.Module) -> set[int]:
    """Return the numbers of the lines of texts that are statements by themselves."""
    lines: set[int] = set()
    for node in ast.walk(tree):
        if not isinstance(node, ast.Expr) or not isinstance(node.value, ast.Constant):
            continue
        if isinstance(node.value.value, str):
            lines.update(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    return lines


def _measure_statements(result: Measured, name: str, tree: ast.Module) -> None:
    """Collect what puts several ideas into one statement, and imports by a text."""
    for node in ast.walk(tree):
        place = f"{name}:{getattr(node, 'lineno', 0)}"
        if isinstance(node, ast.Assign) and _packs(node):
            result.packed.append(place)
        elif isinstance(node, ast.IfExp):
            result.conditional.append(place)
        elif isinstance(node, COMPREHENSIONS) and _holds_comprehension(node):
            result.nested.append(place)
        elif isinstance(node, ast.BinOp) and _joins_dicts(node):
            result.unions.append(place)
        elif isinstance(node, ast.Call) and _called(node) == "import_module":
            result.by_name.append(place)


def _packs(assign: ast.Assign) -> bool:
    """Whether an assignment packs values that do not depend on its targets, unlike a swap."""
    target = assign.targets[0]
    if not isinstance(target, ast.Tuple) or not isinstance(assign.value, ast.Tuple):
        return False
    return not _names_in(target) & _names_in(assign.value)


def _names_in(node: ast.AST) -> set[str]:
    return {part.id for part in ast.walk(node) if isinstance(part, ast.Name)}


def _holds_comprehension(node: ast.AST) -> bool:
    return sum(isinstance(part, COMPREHENSIONS) for part in ast.walk(node)) > 1


def _joins_dicts(node: ast.BinOp) -> bool:
    sides = (node.left, node.right)
    return isinstance(node.op, ast.BitOr) and any(
        isinstance(side, ast.Dict | ast.DictComp) for side in sides
    )


def _called(call: ast.Call) -> str:
    """Return the last name of a function that is called."""
    if isinstance(call.func, ast.Attribute):
        return call.func.attr
    return getattr(call.func, "id", "")


def _measure_functions(result: Measured, name: str, tree: ast.Module) -> None:
    """Collect the functions that are too complex or too long."""
    for node in ast.walk(tree):
        if not isinstance(node, FUNCTIONS):
            continue
        place = f"{name}:{node.name}:{node.lineno}"
        if complexity(node) > MOST_COMPLEX:
            result.complex.append(place)
        if (node.end_lineno or node.lineno) - node.lineno + 1 > LONGEST:
            result.long.append(place)


def complexity(function: ast.AST) -> int:
    """Return the cyclomatic complexity of a function: one more than its decisions."""
    count = 1
    for part in ast.walk(function):
        if isinstance(part, BRANCHES):
            count += 1
        elif isinstance(part, ast.BoolOp):
            count += len(part.values) - 1
        elif isinstance(part, ast.comprehension):
            count += 1 + len(part.ifs)
    return count


def _imported_names(tree: ast.AST) -> Iterator[str]:
    """Yield the modules of the import statements, as they are written."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield "." * node.level + (node.module or "")


def _texts(folder: Path) -> list[tuple[str, str]]:
    """Return names and texts of the Python files of a folder, without links to files elsewhere."""
    texts = []
    for path in sorted(folder.rglob("*.py")):
        inside = path.resolve().is_relative_to(folder.resolve())
        if inside and not path.is_symlink():
            texts.append((str(path.relative_to(folder)), path.read_text(encoding="utf-8")))
    return texts


@pytest.fixture(scope="module")
def source() -> Measured:
    return measured(*_texts(SOURCES))


@pytest.fixture(scope="module")
def of_tests() -> Measured:
    return measured(*_texts(TESTS))


# ---- The package


def test_a_line_of_the_package_holds_five_syntax_nodes_in_the_median(source):
    assert statistics.median(source.nodes) <= 5


def test_few_lines_of_the_package_are_dense(source):
    share = 100.0 * len(source.dense) / len(source.nodes)
    assert share <= 1.5, source.dense


def test_few_tuples_of_the_package_pack_independent_values(source):
    assert source.per_thousand(source.packed) <= 5, source.packed


def test_few_expressions_of_the_package_are_conditional(source):
    assert source.per_thousand(source.conditional) <= 15, source.conditional


def test_few_comprehensions_of_the_package_are_nested(source):
    assert source.per_thousand(source.nested) < 1, source.nested


def test_few_dicts_of_the_package_are_joined_by_a_bar(source):
    assert source.per_thousand(source.unions) < 1, source.unions


def test_few_lines_of_the_package_are_wide(source):
    assert source.percent(source.wide) <= 0.6, source.wide


def test_few_functions_of_the_package_are_complex(source):
    assert len(source.complex) <= 15, source.complex


def test_no_function_of_the_package_is_long(source):
    assert not source.long


def test_few_modules_of_the_package_import_many(source):
    """Those that name all parts of something: the command line, the package, a table of parts."""
    assert len(source.many_imports) <= 18, source.many_imports


def test_hardly_a_module_of_the_package_is_imported_by_a_text(source):
    assert len(source.by_name) <= 3, source.by_name


# ---- The tests


def test_a_line_of_the_tests_holds_six_syntax_nodes_in_the_median(of_tests):
    assert statistics.median(of_tests.nodes) <= 6


def test_few_lines_of_the_tests_are_dense(of_tests):
    share = 100.0 * len(of_tests.dense) / len(of_tests.nodes)
    assert share <= 3, of_tests.dense


def test_few_lines_of_the_tests_are_wide(of_tests):
    assert of_tests.percent(of_tests.wide) <= 1, of_tests.wide


# ---- The measure itself


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("a, b = 1, 2", "packed"),
        ("a = 1 if b else 2", "conditional"),
        ("a = [[x for x in y] for y in z]", "nested"),
        ("a = b | {}", "unions"),
        ("a = import_module('b')", "by_name"),
        ("a = importlib.import_module('b')", "by_name"),
        ("a = (" + "1 + " * 11 + "1)", "dense"),
        ("a = '" + "x" * 100 + "'", "wide"),
        ("def f(x):\n" + "    if x: pass\n" * 15, "complex"),
        ("def f(x):\n" + "    pass\n" * 100, "long"),
        ("import " + ", ".join(f"m{i}" for i in range(16)), "many_imports"),
    ],
)
def test_the_measure_finds_each_kind(text, kind):
    assert len(getattr(measured(("module", text)), kind)) == 1


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("a, b = b, a", "packed"),
        ("a, b = f()", "packed"),
        ("a = [x for x in y]", "nested"),
        ("a = b | c", "unions"),
        ("def f(x):\n" + "    if x: pass\n" * 14, "complex"),
        ("def f(x):\n" + "    pass\n" * 99, "long"),
        ('"""' + "x" * 120 + '"""', "wide"),
    ],
)
def test_the_measure_passes_what_is_calm(text, kind):
    assert not getattr(measured(("module", text)), kind)
