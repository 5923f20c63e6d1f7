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
from disc_model.simulation.case import Window
from disc_model.studies.study import (
    StudyError,
    load_study,
    parse_study,
    read_file,
    study_from_config,
)
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


def test_a_figure_may_show_the_grid_of_another_file(tmp_path: Path) -> None:
    other = GRID | {"study": "other"}
    (tmp_path / "other.yaml").write_text(yaml.safe_dump(other))
    growth = GRID["figures"]["growth"] | {"study": "other", "section": "1 First"}
    study = parse_study(CASES | {"figures": {"f": growth}})
    grids, asked = study.grids([tmp_path])
    assert (list(grids), asked) == (["other"], ())
    entries = study.entries(grids)
    assert entries[CASES["study"], "f"].inputs == {"study": "other"}
    assert list(entries) == [(CASES["study"], "f"), ("other", "growth")]
    with pytest.raises(StudyError, match=r"figures\.f\.study='elsewhere': no such study"):
        parse_study(CASES | {"figures": {"f": growth | {"study": "elsewhere"}}}).grids([tmp_path])
    with pytest.raises(StudyError, match=r"figures\.growth\.study='small': no such study"):
        parse_study(CASES | {"figures": GRID["figures"]}).grids()


# ---- cases


def test_cases_inherit_and_override() -> None:
    a, b = parse_study(CASES).specs.values()
    assert a.parameters == Parameters(N=385, Omega=15, c=0.1)
    assert b.parameters == Parameters(N=50, Omega=15.1, c=0.1)
    assert (a.tol, b.tol) == (1e-10, 1e-8)
    assert a.events == (8.0, 10.0)
    assert b.events == (0.0, 1.0), "the last 2 s of a run of 1 s are all of it"
    assert a.windows == (("history", Window(start=0, stop=10, rate=100)),)


# ---- files


def test_keys_given_twice(tmp_path: Path) -> None:
    text = "study: x\ncases:\n  A: {title: a, t_end: 1, parameters: {N: 1, Omega: 2, N: -3}}\n"
    (path := tmp_path / "twice.yaml").write_text(text)
    for load in (
        load_study,
        lambda file: study_from_config({"study": "x", "cases": {"A": CASE}}, [file]),
    ):
        assert re.search(r"N is given twice\n.* line 3, column 56", faults_of(load, path)[0])


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("010000", "010000 for a number in base 8: leave the zero"),
        ("-017", "-017 for a number in base 8: leave the zero"),
        ("1:30", "1:30 for a number in base 60: write a number without a colon"),
        ("1:30:15.5", "1:30:15.5 for a number in base 60: write a number without a colon"),
    ],
)
def test_numbers_that_yaml_takes_in_another_base_are_refused(
    text: str, shown: str, tmp_path: Path
) -> None:
    """k: 010000 was 4096 N/m, and N: 1:30 was 90 N."""
    (path := tmp_path / "base.yaml").write_text(f"study: x\nbase: {{N: {text}, Omega: 2}}\n")
    (fault,) = faults_of(load_study, path)
    assert f"YAML takes {shown}" in fault
    assert "line 2, column 11" in fault
    for right in ("0", "10000", "1e6", "0x10", "'010000'", "0.5", "010.5", "100_000", "12 rpm"):
        path.write_text(f"N: {right}\n")
        assert read_file(path) == yaml.safe_load(path.read_text())


def test_aliases_that_repeat_too_much_are_refused_at_once(tmp_path: Path) -> None:
    """300 bytes took minutes and gigabytes in a message."""
    lines = ["a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]"]
    for i in range(1, 12):
        lines.append(f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]")
    (path := tmp_path / "deep.yaml").write_text("\n".join([*lines, "study: *a11"]))
    assert "repeat more than 1000000 values" in faults_of(load_study, path)[0]
    path.write_text("study: &a [*a]\n")
    assert "or a part within itself" in faults_of(load_study, path)[0]
    path.write_text("\n".join(lines[:3]))
    assert len(read_file(path)["a2"]) == 10


@pytest.mark.parametrize("read", [load_study, lambda path: study_from_config({}, [path])])
def test_a_file_that_cannot_be_read_is_told_in_one_line(
    read: Callable[[Path], object], tmp_path: Path
) -> None:
    with pytest.raises(MissingFile, match=r"^[^\n]*none\.yaml: there is no such file$"):
        read(tmp_path / "none.yaml")
    with pytest.raises(UnreadableFile, match=r"^[^\n]*: cannot be read: Is a directory$"):
        read(tmp_path)
    (path := tmp_path / "x.yaml").write_bytes(b"study: \xff\xfe")
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
    (tmp_path / "three.yaml").write_text(json.dumps(plane | {"figures": figure}))
    study = parse_study({"study": "all", "studies": ["*.yaml"], "overrides": {"six": {}}})
    found = faults_of(study.grids, [tmp_path])
    for fault in (
        "three: figures.f.overlays.curves='elsewhere': no such study (known: three)",
        "overrides.six: no such study (known: three)",
    ):
        assert fault in found, found


@pytest.mark.parametrize(
    ("name", "content", "fault"),
    [
        ("one", {"study": "one", "quantity": "outcome"}, "options.horizon: is required"),
        ("all", GRID | {"study": "all"}, "study = 'all': is the name of another folder of results"),
        ("five", {"study": "five", "cases": {"A": CASE}}, "study = 'five': must be a grid alone"),
    ],
)
def test_a_fault_of_another_file_is_named(
    name: str, content: Any, fault: str, tmp_path: Path
) -> None:
    (tmp_path / f"{name}.yaml").write_text(json.dumps(content))
    study = parse_study({"study": "all", "studies": ["*.yaml"]})
    assert faults_of(study.grids, [tmp_path]) == [fault]


def test_overrides_are_laid_over_the_file(tmp_path: Path) -> None:
    axes = {"N": [100, 200], "Omega": {"start": 10, "stop": 20, "count": 3}}
    small = {"study": "small", "quantity": "outcome", "options": {"horizon": 2}, "axes": axes}
    (tmp_path / "small.yaml").write_text(json.dumps(small))
    over = {"small": {"axes": {"N": [50]}, "options": {"horizon": 7}}}
    study = parse_study({"study": "all", "studies": ["small.yaml"], "overrides": over})
    grids, asked = study.grids([tmp_path])
    assert asked == ("small",)
    assert grids["small"].n_points == 3
    assert grids["small"].options.horizon == 7  # type: ignore[attr-defined]
