"""What study files amount to: cases, grids, figures of either, and the files that they name."""

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

from disc_model import Parameters
from disc_model.data.files import MissingFile, UnreadableFile
from disc_model.simulation.case import CaseSpec, Start, Window
from disc_model.simulation.named_case import run_case
from disc_model.studies.reading import StudyError
from disc_model.studies.study import inherit, load_study, parse_study, study_from_config
from tests.studies.refused import faults_of

CASE = {"title": "", "parameters": {"N": 1, "Omega": 1}, "t_end": 1}
GRID: dict[str, Any] = {
    "study": "mine",
    "quantity": "floquet",
    "base": {"N": 200, "Omega": 20},
    "axes": {"mu_s": [0.3, 0.4], "mu_k": [0.1, 0.2, 0.3]},
    "figures": {
        "growth": {"kind": "heat_map", "variable": "growth_rate", "x": "mu_s", "y": "mu_k"}
    },
}
OTHER_S = GRID | {"study": "six", "figures": {"f": GRID["figures"]["growth"] | {"study": "mine"}}}
CASES: dict[str, Any] = {
    "study": "small",
    "base": {"N": 385, "c": 0.1},
    "record": {"windows": {"history": {"rate": 100}}, "events": {"last": 2}},
    "cases": {
        "A": {"parameters": {"Omega": 15}, "t_end": 10},
        "B": {"title": "b", "parameters": {"Omega": 15.1, "N": 50}, "t_end": 1, "tol": "1e-8"},
    },
}


# ---- kinds of studies


def test_a_file_can_say_both_and_figures_of_both() -> None:
    both = GRID["figures"] | {"seen": {"kind": "history", "case": "A", "window": "history"}}
    study = parse_study(CASES | GRID | {"base": {"N": 200, "Omega": 20}, "figures": both})
    assert [text["title"] for text in study.labels.values()] == ["A", "b"]
    assert list(study.grids()[0][study.name].plots) == ["growth"]
    entries = study.entries(study.grids()[0])
    assert [(name, [*entry.inputs]) for (_, name), entry in entries.items()] == [
        ("growth", ["study"]),
        ("seen", ["A"]),
    ]


def test_captions_of_grids_have_all_values_that_do_not_vary() -> None:
    """The figure itself has two lines of them."""
    place = {"N": 200, "Omega": 20}
    for more, told in (
        ({}, "N = 200 N, Ω = 20 rad/s"),
        ({"k": 4e5, "n_diameters": 2}, "N = 200 N, Ω = 20 rad/s, k = 400 kN/m, n_diameters = 2"),
        ({"k_p": 0}, "N = 200 N, Ω = 20 rad/s, k_p = 0 kN/m"),
    ):
        study = parse_study(GRID | {"base": place | more})
        [entry] = study.entries(study.grids()[0]).values()
        assert entry.caption == f"From the grid study {study.name}, with {told}."


def test_a_figure_may_show_the_grid_of_another_file(tmp_path: Path) -> None:
    other = GRID | {"study": "other"}
    path = tmp_path / "other.yaml"
    path.write_text(yaml.safe_dump(other))
    growth = GRID["figures"]["growth"] | {"study": "other", "section": "1 First"}
    study = parse_study(CASES | {"figures": {"f": growth}})
    grids, asked = study.grids([tmp_path])
    assert list(grids) == ["other"]
    assert asked == ()
    entries = study.entries(grids)
    assert entries[CASES["study"], "f"].inputs == {"study": "other"}
    assert list(entries) == [(CASES["study"], "f"), ("other", "growth")]
    # a figure of a section is one of the report's, any other a map or curve
    assert [entry.category for entry in entries.values()] == ["Figures", "Maps and curves"]
    with pytest.raises(StudyError, match=r"figures\.f\.study='elsewhere': no such study"):
        parse_study(CASES | {"figures": {"f": growth | {"study": "elsewhere"}}}).grids([tmp_path])
    with pytest.raises(StudyError, match=r"figures\.growth\.study='small': no such study"):
        parse_study(CASES | {"figures": GRID["figures"]}).grids()


# ---- cases


def test_cases_inherit_and_override() -> None:
    a, b = parse_study(CASES).specs.values()
    assert a.parameters == Parameters(N=385, Omega=15, c=0.1)
    assert b.parameters == Parameters(N=50, Omega=15.1, c=0.1)
    assert a.tol == 1e-10
    assert b.tol == 1e-8
    assert a.events == (8.0, 10.0)
    assert b.events == (0.0, 1.0), "the last 2 s of a run of 1 s are all of it"
    assert a.windows == (("history", Window(start=0, stop=10, rate=100)),)


def test_a_value_of_null_drops_what_is_inherited() -> None:
    below = {"windows": {"late": {"rate": 1}, "whole": {"rate": 2}}, "title": "t"}
    changes = {"windows": {"late": None}, "title": None, "new": None, "more": 3}
    expected = {"windows": {"whole": {"rate": 2}}, "new": None, "more": 3}
    assert inherit(below, changes) == expected
    assert below["title"] == "t"


def test_a_tolerance_is_that_of_all_cases_but_those_with_their_own() -> None:
    a, b = parse_study(CASES | {"tol": 1e-7}).specs.values()
    assert a.tol == 1e-7
    assert b.tol == 1e-8


def test_a_case_may_have_a_disc_of_its_own(tmp_path: Path) -> None:
    table = "diameters,frequency_Hz,amplitude_per_sqrt_kg\n0,240,1.5\n1,250,2.1\n"
    disc_path = tmp_path / "disc.csv"
    disc_path.write_text(table)
    own = {"A": CASE | {"parameters": {"N": 1, "Omega": 1, "disc": "disc.csv", "r_0": 0.11}}}
    p = parse_study({"study": "s", "cases": own | {"B": CASE}}, tmp_path).specs["A"].parameters
    assert p.disc is not None
    assert p.disc.diameters == (0, 1)
    elsewhere_path = tmp_path / "elsewhere"
    [fault] = faults_of(parse_study, {"study": "s", "cases": own}, elsewhere_path)
    assert fault.startswith("cases.A.parameters.disc: ")


# ---- files


def test_keys_given_twice(tmp_path: Path) -> None:
    text = "study: x\ncases:\n  A: {title: a, t_end: 1, parameters: {N: 1, Omega: 2, N: -3}}\n"
    path = tmp_path / "twice.yaml"
    path.write_text(text)
    for load in (
        load_study,
        lambda file: study_from_config({"study": "x", "cases": {"A": CASE}}, [file]),
    ):
        assert re.search(r"N is given twice\n.* line 3, column 56", faults_of(load, path)[0])


@pytest.mark.parametrize("read", [load_study, lambda path: study_from_config({}, [path])])
def test_a_file_that_cannot_be_read_is_told_in_one_line(
    read: Callable[[Path], object], tmp_path: Path
) -> None:
    file = tmp_path / "none.yaml"
    with pytest.raises(MissingFile, match=r"^[^\n]*none\.yaml: there is no such file$"):
        read(file)
    with pytest.raises(UnreadableFile, match=r"^[^\n]*: cannot be read: Is a directory$"):
        read(tmp_path)
    path = tmp_path / "x.yaml"
    path.write_bytes(b"study: \xff\xfe")
    with pytest.raises(UnreadableFile, match=r"^[^\n]*x\.yaml: cannot be read: 'utf-8' codec"):
        read(path)


def test_faults_between_studies_are_reported_together(tmp_path: Path) -> None:
    figure = {
        "f": {"kind": "region_map", "x": "Omega", "y": "N", "overlays": {"curves": "elsewhere"}}
    }
    plane = {
        "study": "three",
        "quantity": "regions",
        "options": {"horizon": 1},
        "axes": {"N": [1], "Omega": [1]},
    }
    path = tmp_path / "three.yaml"
    path.write_text(json.dumps(plane | {"figures": figure}))
    study = parse_study({"study": "all", "studies": ["*.yaml"]})
    found = faults_of(study.grids, [tmp_path])
    for fault in (
        "three: figures.f.overlays.curves='elsewhere': no such study (known: three); "
        "name the file of another study by the key studies: [elsewhere.yaml]",
    ):
        assert fault in found, found


@pytest.mark.parametrize(
    ("name", "content", "fault"),
    [
        (
            "one",
            {"study": "one", "quantity": "outcome"},
            "options.horizon: is required: number > 0 (s), longest simulated time",
        ),
        ("all", GRID | {"study": "all"}, "study = 'all': is the name of another folder of results"),
        ("five", {"study": "five", "cases": {"A": CASE}}, "study = 'five': must be a grid alone"),
        ("six", OTHER_S, "study = 'six': must have no figures of other studies"),
    ],
)
def test_a_fault_of_another_file_is_named(
    name: str, content: Any, fault: str, tmp_path: Path
) -> None:
    (tmp_path / f"{name}.yaml").write_text(json.dumps(content))
    study = parse_study({"study": "all", "studies": ["*.yaml"]})
    assert faults_of(study.grids, [tmp_path]) == [fault]


@pytest.mark.parametrize(
    ("count", "last"), [(50, "fault 49"), (51, "and 1 more"), (60, "and 10 more")]
)
def test_faults_beyond_fifty_are_only_counted(count: int, last: str) -> None:
    faults = [f"fault {i}" for i in range(count)]
    error = StudyError(*faults, source="mine.yaml")
    first, *lines = str(error).splitlines()
    assert first == f"mine.yaml: {count} faults"
    shown = [line.strip() for line in lines]
    assert shown[49] == "fault 49"
    assert shown[-1] == last


RECORDS = {"windows": {"late": {"last": 0.5, "rate": 1000}}, "events": {"last": 0.25}}
WHOLE = {"parameters": {"N": 385, "Omega": 15.1}, "t_end": 2, "start": {"perturbation": {"u": 0.2}}}
STOPPING = {**WHOLE, "stop_at": "first_separation"}


def spec_of(case: dict[str, Any]) -> CaseSpec:
    """The only case of a study that records the end of its runs."""
    raw = {"study": "s", "record": RECORDS, "cases": {"A": case}}
    [spec] = parse_study(raw).specs.values()
    return spec


def test_windows_of_a_case_count_back_from_where_it_stops() -> None:
    """They counted back from the time at which the case would have ended, and had no samples."""
    spec = spec_of(STOPPING)
    tree = run_case(spec.replace(t_end=100.0, start=Start()))
    stopped = float(tree["first_separation"])
    window = tree["late"]["time"].values
    events = tree["events"]
    assert len(window) == 501
    assert window[0] == pytest.approx(stopped - 0.5)
    assert events.attrs["kept_from"] == stopped - 0.25
    assert float(events["time"][0]) >= stopped - 0.25


def test_a_case_that_may_stop_states_the_windows_of_a_whole_run() -> None:
    spec = spec_of(STOPPING)
    read_again = CaseSpec.model_validate_json(spec.canonical)
    late = spec.longest_sections["late"]
    assert late == Window(start=1.5, stop=2.0, rate=1000)
    assert read_again == spec


def test_all_of_a_run_that_is_shorter_than_its_window_is_recorded() -> None:
    longer = {"late": {"last": 5, "rate": 1000}}
    spec = spec_of({**STOPPING, "record": {"windows": longer}})
    late = spec.sections["late"]
    assert late == Window(start=0.0, stop=2.0, rate=1000)


def test_windows_of_a_case_that_does_not_stop_count_back_from_its_end() -> None:
    spec = spec_of(WHOLE)
    late = spec.sections["late"]
    assert late == Window(start=1.5, stop=2.0, rate=1000)


def over_speeds(speeds: Any) -> dict[str, Any]:
    """A study of cycles along an axis of speeds."""
    return {"study": "s", "quantity": "floquet", "base": {"N": 385}, "axes": {"Omega": speeds}}


def test_a_value_that_an_axis_has_twice_is_refused() -> None:
    """A study had one value there without a word, where a sweep refuses it."""
    [fault] = faults_of(parse_study, over_speeds([10, 12, "10.0"]))
    assert str(fault) == "axes.Omega=10: must not be given twice along an axis"


def test_a_value_at_which_two_blocks_of_an_axis_meet_is_taken_once() -> None:
    blocks = {"blocks": [[10, 12], [12, 14]]}
    grid = parse_study(over_speeds(blocks)).grid
    assert grid is not None
    assert grid.values["Omega"] == ((10.0,), (12.0,), (14.0,))


def test_tables_of_discs_are_named_without_steps_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A call had the path "studies/../discs/brake.csv"."""
    monkeypatch.chdir(tmp_path)
    Path("discs").mkdir()
    Path("studies").mkdir()
    table = "diameters,frequency_Hz,amplitude_per_sqrt_kg\n2,1200,0.5\n"
    Path("discs/brake.csv").write_text(table)
    base = {"N": 200, "r_0": 0.1, "Omega": 15, "disc": "../discs/brake.csv"}
    path = Path("studies/mine.yaml")
    path.write_text(yaml.safe_dump(GRID | {"base": base, "figures": {}}))
    assert load_study(path).tables == {"": "discs/brake.csv"}
    assert load_study(path.resolve()).tables == {"": "discs/brake.csv"}
    monkeypatch.chdir("studies")
    assert load_study("mine.yaml").tables == {"": "../discs/brake.csv"}
