"""What a study file may say: the schema for editors, YAML that is refused, values along an axis."""

import json
import re
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import yaml

from disc_model.studies import reading
from disc_model.studies.reading import StudyError, read_file
from disc_model.studies.study import load_study, parse_study
from tests.studies.refused import faults_of
from tests.studies.test_faults import STUDIES
from workflow.schemas.write_schema import schema_text

ROOT = Path(__file__).parents[2]
SHIPPED = ROOT / "workflow" / "schemas" / "study.schema.json"
SCHEMA = json.loads(SHIPPED.read_text(encoding="utf-8"))
CHECK = jsonschema.Draft202012Validator(SCHEMA)


def test_what_is_shipped_is_made_from_the_models() -> None:
    """After a change of the models: make schema."""
    assert SHIPPED.read_text(encoding="utf-8") == schema_text()
    jsonschema.Draft202012Validator.check_schema(SCHEMA)


@pytest.mark.filterwarnings("error::disc_model.ImplausibleValue")
@pytest.mark.parametrize(
    "path", sorted((ROOT / "config").rglob("*.yaml")), ids=lambda path: path.stem
)
def test_a_shipped_file_is_right(path: Path) -> None:
    """It fits the schema that it names, and bears the name of its study."""
    phrase = path.read_text(encoding="utf-8")
    assert [error.message for error in CHECK.iter_errors(yaml.safe_load(phrase))] == []
    named = re.match(r"# yaml-language-server: \$schema=(\S+)\n", phrase)
    assert named
    assert (path.parent / named[1]).resolve() == SHIPPED
    study = load_study(path)
    assert study.name == path.stem
    if study.grid and not study.cases:  # what its figures show besides is found beside it
        grids, names = study.grids([Path(), path.parent])
        assert names == (study.name,)
        assert {
            other for plot in study.grid.plots.values() for other in plot.overlays.values()
        } <= grids.keys()


def test_numbers_that_look_like_what_they_are_are_read(tmp_path: Path) -> None:
    """Zeros, hexadecimal numbers, digits in groups, leading zeros before a point, and texts."""
    text = "a: [0, 00, 0x10, 1_000, 0.5, 007.5, -0, '010', '1:30', 1.5e+3, 12 rpm]"
    path = tmp_path / "numbers.yaml"
    path.write_text(text)
    expected = [0, 0, 16, 1000, 0.5, 7.5, 0, "010", "1:30", 1500.0, "12 rpm"]
    assert read_file(path) == {"a": expected}


def nested(levels: int, aliases: int) -> str:
    """A text in which each level has aliases of the one above."""
    lines = ["a0: &a0 [1]"]
    for i in range(levels):
        lines.append(f"a{i + 1}: &a{i + 1} [{', '.join([f'*a{i}'] * aliases)}]")
    return "\n".join(lines)


def test_aliases_are_read_as_long_as_what_they_stand_for_is_small(tmp_path: Path) -> None:
    """Ten levels of ten in 300 bytes took minutes and gigabytes, in a message about them."""
    path = tmp_path / "aliases.yaml"
    path.write_text("a: &a {x: 1}\nb: *a\nc: {<<: *a, y: 2}")
    assert read_file(path) == {"a": {"x": 1}, "b": {"x": 1}, "c": {"x": 1, "y": 2}}
    path.write_text(nested(3, 10))
    assert len(read_file(path)["a3"]) == 10
    path.write_text(nested(10, 10))
    [fault] = faults_of(load_study, path)
    assert re.search(r"its aliases stand for 2345679\d+ values, .* 50000\n +line 1", fault)
    merged = nested(9, 10).replace("[1]", "{x: 1}").replace("[", "{<<: [").replace("]", "]}")
    path.write_text(merged)
    [fault] = faults_of(load_study, path)
    assert "its aliases stand for" in fault


def test_a_file_is_not_refused_for_being_long(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reading, "MOST_EXPANDED", 5)
    path = tmp_path / "long.yaml"
    path.write_text(f"a: [{'1, ' * 1000}]\nb: [&x 2, *x]")
    assert len(read_file(path)["a"]) == 1000


def test_a_message_shows_the_first_of_many_faults(tmp_path: Path) -> None:
    names = ", ".join(f"z{i}: 1" for i in range(70))
    path = tmp_path / "many.yaml"
    path.write_text(f"{{study: s, {names}}}")
    with pytest.raises(StudyError) as error:
        load_study(path)
    assert len(error.value.faults) == 70
    lines = str(error.value).splitlines()
    assert len(lines) == 52
    assert lines[-1] == "  and 20 more"


GRID = {
    "study": "s",
    "quantity": "outcome",
    "options": {"horizon": 10},
    "axes": {"N": [1], "Omega": [2, 3]},
}


def test_what_is_unknown_or_of_another_kind_does_not_fit() -> None:
    wrong = [
        (raw, words)
        for raw, words in STUDIES
        if re.search("unknown|required|mapping|axes.mus", words)
    ]
    assert len(wrong) > 4
    known = {"axes.Omega required", "axes required one axis"}  # or a zip, or base
    known |= {"figures.f.overlays.sliding required"}  # of that kind
    known |= {
        "figures.f.overlays.growth unknown",
        "figures.f.at.k required by",
        "figures.f.at.Omega is required",
    }  # of that kind, and variable
    assert {words for raw, words in wrong if CHECK.is_valid(raw)} == known


@pytest.mark.parametrize(
    ("given", "values"),
    [
        ([0.3, "1e-1", 0.20], [0.1, 0.2, 0.3]),
        ({"start": 0, "stop": 0.3, "step": 0.1}, [0.0, 0.1, 0.2, 0.3]),
        ({"start": 0.1, "stop": 10, "count": 3, "scale": "log"}, [0.1, 1.0, 10.0]),
        ({"blocks": [[1, 2], {"start": 1, "stop": 3, "count": 5}]}, [1.0, 1.5, 2.0, 2.5, 3.0]),
        ({"blocks": [[1, 2], [2, 1], [3]]}, [1.0, 2.0, 3.0]),
    ],
)
def test_values_of_an_axis(given: Any, values: list[float]) -> None:
    study = parse_study(GRID | {"axes": {"N": [100], "Omega": [10], "c": given}})
    assert study.grid.values["c"] == tuple((value,) for value in values)
