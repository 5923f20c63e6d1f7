"""Malformed, huge, hostile and contradictory input ends in one of the package's own errors, never in anything else.

How many of each kind were tried is said at the end of the tests' output.
"""

import contextlib
import io
import math
import sys
from pathlib import Path
from typing import Any
from unittest import mock

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

import disc_model.simulation.api  # noqa: F401 - replaced by name below
from disc_model import ParameterError, Parameters
from disc_model.cli import main
from disc_model.studies.study import StudyError, parse_study, read_yaml
from tests.tally import tried
from tests.trees import places, planted

ROOT = Path(__file__).parents[2]
NAMES = [*Parameters.model_fields, "n", "Ω", "", "__class__", "N ", "omega"]
HOSTILE = [
    *(math.nan, math.inf, -math.inf, -0.0, 10**400, -1, 1e-320),
    *(True, None, b"bytes", [], {}, [1, [2, [3]]], {"N": {"N": 1}}),
    *("nan", "1e-3", "1e999", "__import__('os').system('true')", "../../etc/passwd", "\x00", "x" * 10_000),
]


def count(what: str) -> None:
    tried("hostile inputs", what)


values = st.one_of(st.sampled_from(HOSTILE), st.floats(), st.integers(), st.text(max_size=20), st.booleans())
fields = st.dictionaries(st.sampled_from(NAMES), values, max_size=8)
trees = st.recursive(
    values,
    lambda inner: st.one_of(st.lists(inner, max_size=4), st.dictionaries(st.text(max_size=8), inner, max_size=4)),
    max_leaves=12,
)


FILES = [ROOT / "config/test.yaml", *sorted((ROOT / "config/studies").glob("*.yaml"))]
TEXTS = [path.read_text() for path in FILES]
STUDIES = [yaml.safe_load(text) for text in TEXTS]


def try_study(tree: Any) -> None:
    count("studies")
    with contextlib.suppress(StudyError):
        parse_study(tree)


@given(fields)
def test_parameters(given_fields: dict[str, Any]) -> None:
    count("parameters")
    with contextlib.suppress(ParameterError):
        p = Parameters(**given_fields)
        assert len(p.key) == 12
        assert all(math.isfinite(value) for value in p.model_dump().values() if isinstance(value, float))


@given(st.data())
def test_study_with_one_hostile_node(data: st.DataObject) -> None:
    study = data.draw(st.sampled_from(STUDIES[:1]) | st.sampled_from(STUDIES[1:]))  # one of cases, or of a grid
    path = data.draw(st.sampled_from(places(study)))
    try_study(planted(study, path, data.draw(trees)))


@given(trees)
def test_anything_for_a_study(tree: Any) -> None:
    try_study(tree)


# ---- YAML as text

LAUGHS = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]\n" for i in range(1, 12)
)
"""Twelve lines that stand for 10^12 values."""
SNIPPETS = [
    *("\t:{}[]'\"|>#\n\x00\x85\ufeffé"),
    *(": ", "- ", "? ", "  "),
    *("~", "yes", "0x1F", "0o17", "1_000", "1:30", "2020-01-01", "2020-99-99", ".nan", "-.inf", "1e999", "9" * 5000),
    *("&a [*a]", "*a", "<<: *a", "<<: [1]", "&a {b: *a}", "!!binary x", "!!set {a}", "!!float x", "!!timestamp x"),
    *("!!python/object/apply:os.system ['true']", "!!python/name:os.system", "%YAML 3.0\n", "---\n", "...\n"),
    *("[" * 200, "{a: " * 200, "[" * 500, "- " * 1500, "!!bool x", "!!int x", "!!omap [a]", "!!pairs x"),
    *(LAUGHS, "x" * 100_000),
]


@st.composite
def edited_texts(draw: st.DrawFn) -> str:
    """A study file with some places overwritten, some text put in, some lines lost or repeated."""
    text = draw(st.sampled_from(TEXTS))
    for _ in range(draw(st.integers(1, 4))):
        lines = text.splitlines(keepends=True)
        kind = draw(st.sampled_from(["insert", "overwrite", "lose", "repeat", "cut"]))
        at = draw(st.integers(0, max(len(text) - 1, 0)))
        line = text[:at].count("\n")
        if kind in ("insert", "overwrite"):
            snippet = draw(st.one_of(st.sampled_from(SNIPPETS), st.text(max_size=10)))
            text = text[:at] + snippet + text[at + (len(snippet) if kind == "overwrite" else 0) :]
        elif kind == "lose":
            text = "".join(lines[:line] + lines[line + 1 :])
        elif kind == "repeat":
            text = "".join(lines[: line + 1] + lines[line:])
        else:
            text = text[:at]
    return text


def try_text(text: str) -> None:
    count("YAML files")
    with contextlib.suppress(StudyError):
        tree, _ = read_yaml(text)
        parse_study(tree)


@given(st.text(max_size=200))
def test_any_text_as_yaml(text: str) -> None:
    try_text(text)


@given(edited_texts())
def test_edited_study_files(text: str) -> None:
    try_text(text)


@pytest.mark.parametrize("snippet", SNIPPETS)
def test_every_snippet(snippet: str) -> None:
    for text in (snippet, f"study: {snippet}", f"study: s\ncases: {snippet}", f"{snippet}\nstudy: s"):
        try_text(text)


# ---- the command line

OPTIONS = [
    *(f"--{name}" for name in Parameters.model_fields),
    *("--t-end", "--tol", "--stop-at", "--plot", "--help", "--no-such", "--N=", "-N", "-", "--", ""),
]
WORDS = [
    *("nan", "inf", "-inf", "-0.0", "1e999", "1e-999", "-1", "0", "1", "3.5", "0x10", "1_0", "١٢", "", " "),
    *("auto", "true"),
    *("first_separation", "bonded", "as_published", "/no/such/folder/x.png", "x.png", ".", "..", "/", "~", "x" * 5000),
    *("a/" * 3000, "\x00", "\n", "$(true)", "`true`", "; true", "%s%n", "{}", "--N", "9" * 5000, "\ud800", "é"),
]
words = st.one_of(st.sampled_from(WORDS), st.text(max_size=12), st.floats().map(str), st.integers().map(str))


@st.composite
def command_lines(draw: st.DrawFn) -> list[str]:
    """Often a good run with something bad in it, else anything."""
    line = [draw(st.sampled_from(["run", "run", "run", "modes", "compile", "", "--help", "ruin"]))]
    if line == ["run"] and draw(st.booleans()):
        line += ["--N", "385", "--Omega", "15", "--t-end", "1"]
    for option, word in draw(st.lists(st.tuples(st.sampled_from(OPTIONS), words), max_size=6)):
        line += draw(st.sampled_from([[option, word], [option], [word], [f"{option}={word}"]]))
    return line


class Simulated(Exception):
    """Input was taken; nothing is simulated here."""


@given(command_lines())
def test_any_command_line(arguments: list[str]) -> None:
    """It ends with a result, with help, or with code 2 and what is wrong on stderr."""
    count("command lines")
    phrase = io.StringIO()
    module = sys.modules["disc_model.simulation.api"]
    with (
        mock.patch.object(module, "simulate", side_effect=Simulated),
        contextlib.redirect_stdout(io.StringIO()),
        contextlib.redirect_stderr(phrase),
        pytest.raises((SystemExit, Simulated)) as stop,
    ):
        main(arguments)
    if isinstance(stop.value, SystemExit):
        assert stop.value.code in (0, 2)
        assert "Traceback" not in phrase.getvalue()
        assert bool(phrase.getvalue().strip()) == (stop.value.code == 2)
