"""Study files: what they may say, and the one error that says what is wrong and where."""

import json
import re
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import yaml

import disc_model as dm
from disc_model.studies.study import Study, StudyError, load_study, parse_study
from workflow.schemas.write_schema import schema_text

ROOT = Path(__file__).parents[2]
SHIPPED = ROOT / "workflow" / "schemas" / "study.schema.json"
CHECK = jsonschema.Draft202012Validator(json.loads(SHIPPED.read_text(encoding="utf-8")))
FAULTS = yaml.safe_load(Path(__file__).with_name("faults.yaml").read_text(encoding="utf-8"))
GRID = FAULTS["grid"]
STUDIES = [
    (whole | change, words)
    for whole, name in ((GRID, "grids"), (FAULTS["case"], "cases"))
    for change, words in FAULTS[name]
]
STUDIES.append(({"study": "s"}, "quantity required cases studies"))
CASE = {"parameters": {"N": 300, "Omega": 10}, "t_end": 3}


def parsed(raw: Any, folder: Path = Path()) -> Study:
    study = parse_study(raw, [folder / "s.yaml"])
    study.all_grids([folder])
    return study


@pytest.mark.parametrize(("raw", "words"), STUDIES, ids=[words for _, words in STUDIES])
def test_a_fault_is_named_with_its_place_value_and_rule(raw: dict[str, Any], words: str) -> None:
    with pytest.raises(StudyError) as error:
        parsed(raw)
    faults = [*map(str, error.value.faults)]
    assert any(all(word in fault for word in words.split()) for fault in faults), faults


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a: [", "line 2"),
        ("a: 1\nb: 2\n c: 3", "line 3"),
        ("a: 1\na: 2", "a is given twice"),
        ("study: s\nquantity: floquet\naxes: {N: [1], N: [2]}", "N is given twice"),
    ],
)
def test_a_text_that_is_no_yaml_is_told(text: str, words: str, tmp_path: Path) -> None:
    path = tmp_path / "s.yaml"
    path.write_text(text)
    with pytest.raises(StudyError, match=words):
        load_study(path)


@pytest.mark.parametrize("name", ["no_such.yaml", "."])
def test_a_file_that_cannot_be_read_is_told(name: str, tmp_path: Path) -> None:
    with pytest.raises(dm.DiscModelError, match=re.escape(str(tmp_path / name))):
        load_study(tmp_path / name)


def test_what_is_shipped_is_made_from_the_models() -> None:
    """After a change of the models, `write_schema.py` writes it anew."""
    assert SHIPPED.read_text(encoding="utf-8") == schema_text()


@pytest.mark.filterwarnings("error::disc_model.ImplausibleValue")
@pytest.mark.parametrize(
    "path", sorted((ROOT / "config").rglob("*.yaml")), ids=lambda path: path.stem
)
def test_a_shipped_file_is_right(path: Path) -> None:
    """It fits the schema that it names, bears the name of its study, and finds what its figures show."""
    text = path.read_text(encoding="utf-8")
    assert [error.message for error in CHECK.iter_errors(yaml.safe_load(text))] == []
    study = load_study(path)
    assert study.study == path.stem
    grids, names = study.all_grids([ROOT, path.parent])
    assert {*names} <= {*grids}
    assert len(study.entries(grids)) >= len(study.figures)


def test_cases_inherit_what_they_do_not_say() -> None:
    raw = {
        "study": "s",
        "base": {"N": 385, "k": "5e4 N/m"},
        "tol": 1e-9,
        "record": {"windows": {"late": {"last": 1, "rate": 100}}},
        "cases": {
            "A": {"parameters": {"Omega": 15}, "t_end": 3},
            "B": {**CASE, "tol": 1e-8, "record": {"windows": {"late": None}}},
        },
    }
    specs = parsed(raw).cases
    assert (specs["A"].parameters.N, specs["B"].parameters.N) == (385, 300)
    assert (specs["A"].tol, specs["B"].tol) == (1e-9, 1e-8)
    assert [*specs["A"].record.sections] == ["late"]
    assert not specs["B"].record.sections


def test_a_table_of_a_disc_is_read_beside_the_file(tmp_path: Path) -> None:
    (tmp_path / "d.csv").write_text(
        "diameters,frequency_Hz,amplitude_per_sqrt_kg\n1,200,3\n2,300,3\n"
    )
    axes = {"disc": ["d.csv"], "N": [100]}
    study = parsed({**GRID, "base": {"Omega": 10}, "axes": axes}, tmp_path)
    disc = study.case.disc
    assert disc is not None
    assert disc.diameters == (1, 2)


def test_a_figure_may_show_the_grid_of_another_file(tmp_path: Path) -> None:
    (tmp_path / "other.yaml").write_text(yaml.safe_dump({**GRID, "study": "other"}))
    plot = {"kind": "heat_map", "study": "other", "variable": "outcome", "x": "Omega", "y": "k"}
    study = parse_study({"study": "s", "cases": {"A": CASE}, "figures": {"f": plot}})
    grids, asked = study.all_grids([tmp_path])
    assert ([*grids], asked) == (["other"], ())
    entry = study.entries(grids)["s", "f"]
    assert entry.inputs == {"study": "other"}
    assert "N = 200 N" in entry.caption


@pytest.mark.parametrize(
    ("change", "words"),
    [({"cases": {"A": CASE}}, "grids alone"), ({"quantity": "critical_sped"}, "critical_sped")],
)
def test_a_fault_of_another_file_is_named(change: Any, words: str, tmp_path: Path) -> None:
    (tmp_path / "other.yaml").write_text(yaml.safe_dump({**GRID, "study": "other", **change}))
    with pytest.raises(StudyError, match=words):
        parsed({"study": "s", "studies": ["other.yaml"]}, tmp_path)


def test_an_overlay_in_another_plane_is_refused() -> None:
    root = ROOT / "config" / "studies"
    raw = yaml.safe_load((root / "map_c_p.yaml").read_text(encoding="utf-8"))
    for plot in raw["figures"].values():
        for role, name in plot.get("overlays", {}).items():
            plot["overlays"][role] = name.replace("neutral_c_p", "neutral_N")
    with pytest.raises(StudyError, match="plane of the figure"):
        parsed(raw, root)
