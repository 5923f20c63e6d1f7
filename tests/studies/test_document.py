"""What a study file may say: the schema for editors, YAML that is refused, values along an axis."""

import json
import re
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import yaml

from disc_model.studies.reading import StudyError
from disc_model.studies.study import load_study, parse_study
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
        "figures.f.at.k required",
        "figures.f.at.c required by: c",
        "figures.f.at.Omega is required",
        "figures.f.at.normalization required as_published",
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
