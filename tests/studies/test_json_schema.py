"""The schema for editors: the shipped one is that of the models, takes every shipped file, and refuses what they do."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import yaml

from disc_model.studies.files import StudyError
from disc_model.studies.json_schema import study_schema, text
from disc_model.studies.schema import parse_study

ROOT = Path(__file__).parents[2]
SHIPPED = ROOT / "workflow" / "schemas" / "study.schema.json"
FILES = sorted((ROOT / "config").rglob("*.yaml"))
CHECK = jsonschema.Draft202012Validator(json.loads(SHIPPED.read_text(encoding="utf-8")))


def test_what_is_shipped_is_made_from_the_models() -> None:
    """After a change of the models: make schema."""
    assert SHIPPED.read_text(encoding="utf-8") == text()
    jsonschema.Draft202012Validator.check_schema(study_schema())


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_shipped_file_fits_and_names_the_schema(path: Path) -> None:
    said = path.read_text(encoding="utf-8")
    assert [error.message for error in CHECK.iter_errors(yaml.safe_load(said))] == []
    named = re.match(r"# yaml-language-server: \$schema=(\S+)\n", said)
    assert named
    assert (path.parent / named[1]).resolve() == SHIPPED


def grid(**changes: Any) -> dict[str, Any]:
    said = {"study": "s", "quantity": "outcome", "options": {"horizon": 10}, "axes": {"N": [1], "Omega": [2, 3]}}
    return said | changes


def cases(**changes: Any) -> dict[str, Any]:
    case = {"title": "", "parameters": {"N": 1, "Omega": 1}, "t_end": 5}
    return {"study": "s", "cases": {"A": case | changes}}


@pytest.mark.parametrize(
    "right",
    [
        grid(),
        grid(axes={"N": {"start": 1, "stop": 2, "count": 3, "extra": [1.7]}, "Omega": {"blocks": [[1], [2]]}}),
        {"study": "s", "quantity": "floquet", "zip": {"N": [1, 2], "Omega": [1, 2]}},
        grid(base={"n_diameters": "auto", "truncation_tolerance": 1e-3}),
        grid(starts={"k": {"kick": {"u": 1e-4}}}, axes={"N": [1], "Omega": [1], "start": ["published", "k"]}),
        grid(figures={"f": {"kind": "heat_map", "x": "N", "y": "Omega", "variable": "outcome"}}),
        cases(record={"windows": {"w": {"rate": 10}}, "poincare": None, "events": {"last": 2}}),
        cases(start={"prepare": {"parameters": {"N": 3}, "time": 1}}),
    ],
)
def test_what_a_study_may_say_fits(right: dict[str, Any]) -> None:
    assert [error.message for error in CHECK.iter_errors(right)] == []


@pytest.mark.parametrize(
    "wrong",
    [
        grid(axis={}),
        grid(quantity="outcomes"),
        grid(options={"horizn": 10}),
        grid(options={}),
        grid(axes={"N": [1], "Omga": [1]}),
        grid(axes={"N": [1], "Omega": {"start": 1, "stop": 2, "size": 3}}),
        grid(base={"m": -1}),
        grid(batch={"sise": 2}),
        grid(figures={"f": {"kind": "heat"}}),
        grid(figures={"f": {"kind": "heat_map", "x": "N", "variable": "outcome"}}),
        grid(figures=["fig99"]),
        cases(t_end=0),
        cases(record={"windows": {"w": {"rate": 10, "stopp": 3}}}),
        cases(stop_at="never"),
        {"study": "s"},
        {"study": "1s", "cases": cases()["cases"]},
    ],
)
def test_what_is_refused_does_not_fit(wrong: dict[str, Any]) -> None:
    assert not CHECK.is_valid(wrong)
    with pytest.raises(StudyError):
        parse_study(wrong)
