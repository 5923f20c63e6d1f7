"""Wrong signs, factors and comparisons in the modules that hold the equations, one at a time; and
which tests notice.

    NUMBA_DISABLE_JIT=1 python -m tests.validation.mutants engine/laws.py ...    # of these modules; without any, of all

What is changed is read from the syntax tree, so that no formatting and no new function needs
attention here:

    a + b, a - b, a += b, a -= b    the other sign
    -a                              a
    a**b                            a
    2.0 in a sum or product         4.0 (any float)
    a < b, a == b, ...              the opposite

Left alone are elements' numbers, messages of errors, and sizes (sums of moduli, by which rounding
is judged).

Tests are collected once, without compilation. Each change is put into a fork of that process, which
runs them until one fails: first those that noticed other changes of the function, then the
quickest.
"""

import ast
import contextlib
import functools
import gc
import io
import json
import os
import resource
import sys
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator
from itertools import accumulate, chain
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any, NamedTuple

import pytest
import yaml

import disc_model

PACKAGE = Path(disc_model.__file__).parent
TABLES = yaml.safe_load(Path(__file__).with_suffix(".yaml").read_text(encoding="utf-8"))


def _files(name: str) -> list[str]:
    """Files of a group of tests, or one below tests."""
    found: list[str] = TABLES["groups"].get(name) or [f"tests/{name}"]
    return found


#: The modules, and the tests that have to notice.
MODULES = {
    module: (*chain.from_iterable(map(_files, names)),)
    for module, names in TABLES["modules"].items()
}
NO_EQUATION: dict[str, dict[str, str]] = TABLES["no_equation"]
"""Functions that are left out, with the reason."""
EQUIVALENT: dict[str, str] = TABLES["equivalent"]
"""By the name of a mutant (as `Mutant` prints it): why it makes no difference."""
PATIENCE = 60
"""s of the processor, after which a mutant counts as an endless loop; `BUDGET` is less."""
BUDGET = 40.0
"""s of the processor; as many of a module's tests as take this together are tried, the quickest."""


class Mutant(NamedTuple):
    """One change: the ``place``-th of a module, in the order of the syntax tree."""

    module: str
    function: str
    place: int
    change: str

    def __str__(self) -> str:
        return f"{self.module}:{self.function}: {self.change}"

    @property
    def name(self) -> str:
        """Of the function, dotted."""
        return f"disc_model.{self.module.removesuffix('.py').replace('/', '.')}.{self.function}"

    def code(self) -> CodeType:
        """The changed function's, compiled."""
        tree = ast.parse((PACKAGE / self.module).read_text(encoding="utf-8"))
        flip([node for _, node in places(tree)][self.place])
        ast.fix_missing_locations(tree)
        return next(
            code
            for code in codes(compile(tree, self.module, "exec"))
            if code.co_qualname == self.function
        )


def mutants(module: str) -> Iterator[Mutant]:
    """The changes of a module; equal ones are numbered."""
    seen: Counter[tuple[str, str]] = Counter()
    tree = ast.parse((PACKAGE / module).read_text(encoding="utf-8"))
    unused = {name for modules in NO_EQUATION.values() for name in modules.get(module, "").split()}
    for place, (function, node) in enumerate(list(places(tree))):
        if function in unused:
            continue
        change = flip(node)
        seen[function, change] += 1
        count = seen[function, change]
        yield Mutant(module, function, place, change + (f" ({count})" if count > 1 else ""))


def codes(code: CodeType) -> Iterator[CodeType]:
    """A module's code and that of all functions in it."""
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from codes(constant)


# ------------------------------------------------------------------------------------ where to
# change, and what
STORAGE = ("load", "store", "spread", "item", "put", "entry", "put_entry")
NUMBERS_OF_ELEMENTS = ("range", "len")
OTHER = {ast.Add: ast.Sub, ast.Sub: ast.Add}
OPPOSITE = {
    ast.Lt: ast.GtE,
    ast.GtE: ast.Lt,
    ast.Gt: ast.LtE,
    ast.LtE: ast.Gt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
}


def places(node: ast.AST, inside: str = "") -> Iterator[tuple[str, ast.AST]]:
    """Function and place of all that can be changed in a module."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.FunctionDef):
            for statement in child.body:
                yield from ((inside + child.name, place) for place in _changeable(statement))
        elif isinstance(child, ast.ClassDef):
            yield from places(child, f"{inside}{child.name}.")


def _changeable(node: ast.AST) -> Iterator[ast.AST]:
    if isinstance(node, ast.Raise | ast.JoinedStr):
        return
    if isinstance(node, ast.Subscript):  # what is taken, not from where
        yield from _changeable(node.value)
        return
    called = ""
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
        called = node.func.id
    if called in NUMBERS_OF_ELEMENTS:
        return
    if _is_changeable(node):
        yield node
    if isinstance(node, ast.BinOp):
        yield from (side for side in (node.left, node.right) if _is_factor(side))
    for child in ast.iter_child_nodes(node):
        if not (called in STORAGE or called.startswith("_")) or not _is_index(child):
            yield from _changeable(child)


def _is_changeable(node: ast.AST) -> bool:
    match node:
        case (
            ast.BinOp(op=ast.Add() | ast.Sub(), right=other)
            | ast.AugAssign(op=ast.Add() | ast.Sub(), value=other)
        ):
            return not _is_size(other)
        case ast.BinOp(op=ast.Pow()):
            return True
        case ast.UnaryOp(op=ast.USub()):
            return True
        case ast.Compare():
            return type(node.ops[0]) in OPPOSITE
    return False


def _is_factor(side: ast.AST) -> bool:
    return isinstance(side, ast.Constant) and isinstance(side.value, float) and side.value != 0.0


def _is_size(term: ast.AST) -> bool:
    return any(
        isinstance(part, ast.Call) and getattr(part.func, "id", "") in ("abs", "absolute")
        for part in ast.walk(term)
    )


def _is_index(argument: ast.AST) -> bool:
    """Whether an argument is made of bare names and whole numbers."""
    return isinstance(argument, ast.BinOp) and all(
        isinstance(part, ast.BinOp | ast.operator | ast.Name | ast.expr_context)
        or (isinstance(part, ast.Constant) and isinstance(part.value, int))
        for part in ast.walk(argument)
    )


def flip(node: ast.AST) -> str:
    """Change a node in place; says what is changed, in a line."""
    before = ast.unparse(node)
    match node:
        case ast.BinOp(op=ast.Pow()):
            node.right = ast.Constant(1)
            return f"{before} -> {ast.unparse(node.left)}"
        case ast.BinOp(right=other) | ast.AugAssign(value=other):
            sign = "-"
            opposite = "+"
            if isinstance(node.op, ast.Add):
                sign = "+"
                opposite = "-"
            node.op = OTHER[type(node.op)]()
            return f"{sign} {ast.unparse(other)} -> {opposite}"
        case ast.UnaryOp():
            node.op = ast.UAdd()
        case ast.Compare():
            node.ops[0] = OPPOSITE[type(node.ops[0])]()
        case ast.Constant():
            node.value = 2 * node.value
    return f"{before} -> {ast.unparse(node)}"


# ------------------------------------------------------------------------------------ trials
class Trials:
    """A plugin of pytest that runs what is collected against each mutant of some modules, each in a
    fork.

    Attributes
    ----------
    survivors, tried : mutants that no test noticed, and all that were tried but those of `EQUIVALENT`
    """

    def __init__(self, modules: Iterable[str]) -> None:
        self.modules = tuple(modules)
        self.survivors = list[str]()
        self.tried = list[str]()
        self._noticed: defaultdict[str, list[str]] = defaultdict(list)
        self._spent: Counter[str] = Counter()
        self._until = 0.0
        self._pipe = 0

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """A failure ends the fork; seconds are the processor's, so that other work beside it leaves
        no test out."""
        until = time.process_time()
        self._spent[report.nodeid] += until - self._until
        self._until = until
        if report.failed:
            os.write(self._pipe, report.nodeid.encode())
            os._exit(1)

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        functions = {}
        caches = []
        for found in gc.get_objects():
            if isinstance(found, FunctionType) and (found.__module__ or "").startswith(
                "disc_model."
            ):
                functions[f"{found.__module__}.{found.__qualname__}"] = found
            elif isinstance(found, functools._lru_cache_wrapper):
                caches.append(found)
        gc.freeze()
        code, text = self._fork(session.items, lambda: None)
        assert code == 0, f"fails without any change: {text}"
        spent = json.loads(text)
        session.items.sort(key=lambda item: spent[item.nodeid])
        for module in self.modules:
            here = [item for item in session.items if item.nodeid.split("::")[0] in MODULES[module]]
            all_of_it = accumulate(spent[item.nodeid] for item in here)
            items = {
                item.nodeid: item
                for item, so_far in zip(here, all_of_it, strict=True)
                if so_far < BUDGET
            }
            for mutant in mutants(module):
                if str(mutant) not in EQUIVALENT:
                    self._try(mutant, items, functions[mutant.name], caches)
        return True

    def _try(
        self,
        mutant: Mutant,
        items: dict[str, pytest.Item],
        function: FunctionType,
        caches: list[Any],
    ) -> None:
        def change() -> None:
            # an endless loop is ended by a signal
            resource.setrlimit(resource.RLIMIT_CPU, (PATIENCE, PATIENCE + 1))
            function.__code__ = mutant.code()
            for cache in caches:
                cache.cache_clear()

        first = self._noticed[mutant.name] + self._noticed[mutant.module]
        code, killer = self._fork([items[name] for name in dict.fromkeys([*first, *items])], change)
        self.tried.append(str(mutant))
        if code == 0:
            self.survivors.append(str(mutant))
        elif killer:
            self._noticed[mutant.name].insert(0, killer)
            self._noticed[mutant.module].insert(0, killer)
        print(
            f"survives: {mutant}" if code == 0 else f"{mutant}, by {killer}",
            file=sys.__stderr__,
            flush=True,
        )

    def _fork(self, items: list[pytest.Item], prepare: Callable[[], None]) -> tuple[int, str]:
        """Exit code or the signal that ended it, and what it said: which test failed, or how long
        each took."""
        read, self._pipe = os.pipe()
        child = os.fork()
        if child == 0:
            prepare()
            for item, following in zip(items, [*items[1:], None], strict=True):
                item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
            with os.fdopen(self._pipe, "w") as pipe:
                json.dump(self._spent, pipe)
            os._exit(0)
        os.close(self._pipe)
        with os.fdopen(read) as pipe:
            text = pipe.read()
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), text


def try_all(modules: Iterable[str]) -> Trials:
    """Try all mutants of some modules; in a process that has numba's compilation switched off."""
    trials = Trials(modules)
    tests = sorted({file for module in trials.modules for file in MODULES[module]})
    options = ("-qq", "-p", "no:cacheprovider", "-m", "not slow and not compiled")
    with contextlib.redirect_stdout(io.StringIO()) as text:
        code = pytest.main([*options, *tests], plugins=[trials])
    if code != pytest.ExitCode.OK:
        raise SystemExit(text.getvalue())
    return trials


if __name__ == "__main__":
    trials = try_all(sys.argv[1:] or MODULES)
    used = [resource.getrusage(whose) for whose in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    print(
        f"{len(trials.tried)} tried in {sum(each.ru_utime + each.ru_stime for each in used):.0f} s"
    )
    print(*trials.survivors, sep="\n")
    sys.exit(len(trials.survivors) > 0)
