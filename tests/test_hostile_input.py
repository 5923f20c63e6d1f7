"""Malformed, huge, hostile and contradictory input ends in one of the package's own errors, never in anything else."""

from __future__ import annotations

import contextlib
import math
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from disc_model import ParameterError, Parameters
from disc_model.cli import main
from disc_model.studies.faults import StudyError, read_yaml
from disc_model.studies.grid import parse_grid
from disc_model.studies.study import parse_study

ROOT = Path(__file__).parents[1]
NAMES = [*Parameters.model_fields, "n", "Ω", "", "__class__", "N ", "omega"]
HOSTILE = [
    math.nan,
    math.inf,
    -math.inf,
    -0.0,
    10**400,
    -1,
    1e-320,
    True,
    None,
    "nan",
    "1e-3",
    "1e999",
    "__import__('os').system('true')",
    "../../etc/passwd",
    "\x00",
    "x" * 10_000,
    b"bytes",
    [],
    {},
    [1, [2, [3]]],
    {"N": {"N": 1}},
]
QUICK = settings(max_examples=200, deadline=None, suppress_health_check=list(HealthCheck))
LONG = settings(QUICK, max_examples=5000)

values = st.one_of(st.sampled_from(HOSTILE), st.floats(), st.integers(), st.text(max_size=20), st.booleans())
fields = st.dictionaries(st.sampled_from(NAMES), values, max_size=8)
trees = st.recursive(
    values,
    lambda inner: st.one_of(st.lists(inner, max_size=4), st.dictionaries(st.text(max_size=8), inner, max_size=4)),
    max_leaves=12,
)


def try_parameters(given_fields: dict[str, Any]) -> None:
    with contextlib.suppress(ParameterError):
        p = Parameters(**given_fields)
        assert len(p.key) == 12
        assert all(math.isfinite(value) for value in p.model_dump().values() if isinstance(value, float))


def leaves(tree: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Paths of all nodes of a study, leaves and branches."""
    children = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    return [path, *(p for key, child in children for p in leaves(child, (*path, key)))]


def planted(tree: Any, path: tuple[Any, ...], what: Any) -> Any:
    """The tree with one node replaced."""
    if not path:
        return what
    copy = dict(tree) if isinstance(tree, dict) else list(tree)
    copy[path[0]] = planted(tree[path[0]], path[1:], what)
    return copy


STUDY = yaml.safe_load((ROOT / "config/test.yaml").read_text())
GRIDS = [yaml.safe_load(path.read_text()) for path in sorted((ROOT / "config/studies").glob("*.yaml"))]


def try_study(parse: Any, tree: Any) -> None:
    with contextlib.suppress(StudyError):
        parse(tree)


@QUICK
@given(fields)
def test_parameters(given_fields: dict[str, Any]) -> None:
    try_parameters(given_fields)


@QUICK
@given(st.sampled_from(leaves(STUDY)), trees)
def test_study_with_one_hostile_node(path: tuple[Any, ...], what: Any) -> None:
    try_study(parse_study, planted(STUDY, path, what))


@QUICK
@given(st.data())
def test_grid_with_one_hostile_node(data: st.DataObject) -> None:
    grid = data.draw(st.sampled_from(GRIDS))
    path = data.draw(st.sampled_from(leaves(grid)))
    try_study(parse_grid, planted(grid, path, data.draw(trees)))


@QUICK
@given(trees)
def test_anything_for_a_study(tree: Any) -> None:
    try_study(parse_study, tree)
    try_study(parse_grid, tree)


@QUICK
@given(st.text(max_size=200))
def test_any_text_as_yaml(text: str) -> None:
    with contextlib.suppress(StudyError):
        tree, _ = read_yaml(text)
        parse_study(tree)


@pytest.mark.slow
@LONG
@given(fields, st.sampled_from(leaves(STUDY)), trees)
def test_at_length(given_fields: dict[str, Any], path: tuple[Any, ...], what: Any) -> None:
    try_parameters(given_fields)
    try_study(parse_study, planted(STUDY, path, what))


@pytest.mark.parametrize(
    "arguments",
    [
        ["run"],
        ["run", "--N", "-5", "--Omega", "15", "--t-end", "1"],
        ["run", "--N", "nan", "--Omega", "15", "--t-end", "1"],
        ["run", "--N", "5", "--Omega", "15", "--t-end", "-1"],
        ["run", "--N", "5", "--Omega", "15", "--t-end", "1", "--tol", "1"],
        ["run", "--N", "5", "--Omega", "15", "--t-end", "1", "--mu-k", "0.9"],
        ["run", "--N", "5", "--Omega", "15", "--t-end", "1", "--a", "0.2"],
        ["run", "--N", "5", "--Omega", "15", "--t-end", "1", "--frobnicate", "2"],
        ["run", "--N", "5", "--Omega", "15", "--t-end", "1", "--plot", "/no/such/folder/x.png"],
        ["modes", "--n-diameters", "-3"],
        ["no-such-command"],
    ],
)
def test_command_line_says_what_is_wrong(arguments: list[str], capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main(arguments)
    assert stop.value.code not in (0, None)
    said = capfd.readouterr()
    assert "Traceback" not in said.err
    assert said.err.strip()
