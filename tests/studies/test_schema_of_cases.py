"""Study files: what they expand to, and that every fault is named, with its path, in one error."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import pytest

from disc_model import Parameters
from disc_model.simulation.case import CaseSpec
from disc_model.studies.files import StudyError
from disc_model.studies.schema import load_study, parse_study, study_from_config
from tests.studies.refused import faults_of

ROOT = Path(__file__).parents[2]
CASE = {"title": "", "parameters": {"N": 1, "Omega": 1}, "t_end": 1}
CONFIGS = sorted((ROOT / "config").glob("*.yaml"))


def raw_study() -> dict[str, Any]:
    return {
        "study": "small",
        "base": {"N": 385, "c": 0.1},
        "record": {"windows": {"history": {"rate": 100}}, "events": {"last": 2}},
        "cases": {
            "A": {"title": "a", "parameters": {"Omega": 15}, "t_end": 10},
            "B": {"title": "b", "parameters": {"Omega": 15.1, "N": 50}, "t_end": 1, "tol": "1e-8"},
        },
    }


@pytest.mark.parametrize("path", CONFIGS, ids=lambda path: path.stem)
def test_shipped_files_are_valid_and_named_after_their_study(path: Path) -> None:
    assert load_study(path).name == path.stem


def test_cases_inherit_and_override() -> None:
    study = parse_study(raw_study())
    a, b = study.specs["A"], study.specs["B"]
    assert a.parameters == Parameters(N=385, Omega=15, c=0.1)
    assert b.parameters == Parameters(N=50, Omega=15.1, c=0.1)
    assert (a.tol, b.tol) == (1e-10, 1e-8)
    assert a.events == (8.0, 10.0)
    assert b.events == (0.0, 1.0), "the last 2 s of a run of 1 s are all of it"
    [(name, window)] = a.windows
    assert (name, window.start, window.stop) == ("history", 0.0, 10.0)


def test_null_drops_what_is_inherited() -> None:
    raw = raw_study()
    raw["cases"]["A"]["record"] = {"windows": {"history": None}, "events": False}
    spec = parse_study(raw).specs["A"]
    assert spec.windows == ()
    assert spec.events is None
    assert not spec.record.events


def test_envelope_has_no_bin_of_its_own_for_the_last_instant() -> None:
    raw = raw_study()
    raw["record"]["windows"]["history"]["envelope"] = 100
    window = parse_study(raw).specs["A"].windows[0][1]
    assert window.count == 1000


def test_specification_survives_its_text() -> None:
    raw = raw_study()
    raw["record"]["poincare"] = {"theta": 0.5}
    for spec in parse_study(raw).specs.values():
        assert CaseSpec.from_canonical(spec.canonical) == spec


def test_key_depends_on_content_alone() -> None:
    def key(change: dict[str, Any]) -> str:
        raw = raw_study()
        raw["cases"]["A"] |= change
        return parse_study(raw).specs["A"].key

    same = key({})
    assert key({"title": "other", "reference": "elsewhere"}) == same
    assert key({"t_end": "1e1"}) == same
    assert key({"parameters": {"c": "0.10", "Omega": 15.0}}) == same
    assert key({"t_end": 11}) != same
    assert key({"tol": 1e-9}) != same
    assert key({"parameters": {"Omega": 15, "m": 0.2}}) != same
    assert key({"record": {"windows": {"history": {"rate": 200}}}}) != same


def test_every_fault_is_listed_with_its_path() -> None:
    raw = raw_study()
    raw["extra"] = 1
    raw["cases"]["A"]["parameters"] = {"Omega": "fast", "N": -5, "Omga": 3}
    raw["cases"]["A"]["record"] = {"windows": {"zoom": {"start": 11, "rate": 10}, "late": {"rate": -1}}}
    raw["cases"]["B"] |= {"t_end": 0, "tol": 0.1, "stop_at": "never"}
    raw["cases"] |= {"1st": CASE, "N": CASE}
    raw["figures"] = ["fig11", "fig99"]
    listed = "\n".join(faults_of(parse_study, raw))
    for wanted in (
        "extra = 1: unknown key",
        "cases.A.parameters.N = -5: must be >= 0",
        "cases.A.parameters.Omega = 'fast': must be a number",
        "cases.A.parameters.Omga = 3",
        "cases.A.record.windows.late.rate = -1: must be > 0",
        "cases.B.t_end = 0: must be > 0",
        "cases.B.tol = 0.1: must be within 1e-15 and 0.01",
        "cases.B.stop_at = 'never'",
        "cases.1st: a case's name must be",
        "cases.N: a case must not be called so",
        "figures.0 = 'fig11': needs a case F11",
        "figures.1 = 'fig99': unknown figure",
    ):
        assert wanted in listed


def test_what_a_figure_needs_of_a_window_is_checked_with_the_study() -> None:
    """A window that a figure could not be drawn from used to pass, and to end the figure hours later."""
    windows = {
        "history": {"start": 0, "rate": 100},
        "spectrum_a": {"start": 0, "stop": 1, "rate": 4000},
        "spectrum_b": {"start": 1, "stop": 5, "rate": 1999},
        "spectrum_c": {"start": 53, "stop": 55, "rate": 4000, "envelope": 5},
        "spectrum_d": {"start": 100, "stop": 110, "rate": 4000},
    }
    case = {"title": "", "parameters": {"N": 385, "Omega": 15.1}, "t_end": 120, "record": {"windows": windows}}
    raw = {"study": "x", "cases": {"F13": case}, "figures": ["fig13", "fig25", "fig26"]}
    place = "cases.F13.record.windows"
    assert set(faults_of(parse_study, raw)) == {
        f"figures.0 = 'fig13': {place}.history needs an envelope",
        f"figures.1 = 'fig25': {place}.spectrum_a must be 1.1 s long or more",
        f"figures.1 = 'fig25': {place}.spectrum_b needs a rate of 2000 Hz or more",
        f"figures.1 = 'fig25': {place}.spectrum_c must have no envelope",
        f"figures.2 = 'fig26': {place}.history needs an envelope",
        f"figures.2 = 'fig26': {place}.spectrum_c must have no envelope",
        f"figures.2 = 'fig26': {place}.spectrum_c must contain 52 to 52.2 s",
    }
    short = f"figures.0 = 'fig13': {place}.history must be two envelopes long or more"
    for envelope in (6000, 6001):
        windows["history"]["envelope"] = envelope
        assert (short in faults_of(parse_study, raw)) == (envelope > 6000)


def test_inherited_faults_are_listed_once_and_where_they_stand() -> None:
    raw = raw_study()
    raw["base"]["m"] = 0
    raw["record"]["windows"]["history"]["rate"] = 0
    raw["tol"] = 1
    assert faults_of(parse_study, raw) == [
        "tol = 1: must be within 1e-15 and 0.01",
        "record.windows.history.rate = 0: must be > 0",
        "base.m = 0: must be > 0",
    ]


@pytest.mark.parametrize("raw", [None, [], "text", {}, {"study": "x", "cases": None}, {"study": "x", "cases": {}}])
def test_what_is_no_study_at_all(raw: Any) -> None:
    assert faults_of(parse_study, raw)


@pytest.mark.parametrize("value", [float("nan"), float("inf"), True, None, "x", [1]])
def test_bad_end_times(value: Any) -> None:
    raw = raw_study()
    raw["cases"]["A"]["t_end"] = value
    assert any(fault.startswith("cases.A.t_end") for fault in faults_of(parse_study, raw))


def test_keys_given_twice(tmp_path: Path) -> None:
    text = "study: x\ncases:\n  A: {title: a, t_end: 1, parameters: {N: 1, Omega: 2, N: -3}}\nstudy: y\n"
    path = tmp_path / "twice.yaml"
    path.write_text(text)
    valid = {"study": "x", "cases": {"A": CASE}}
    for load in (
        load_study,
        lambda file: study_from_config({"study": "x", "cases": {}}, [file]),
        lambda file: study_from_config(valid, [file]),
    ):
        with pytest.raises(StudyError, match=r"twice\.yaml") as caught:
            load(path)
        assert "study: given twice, in lines 1 and 4" in caught.value.faults
        assert "N: given twice, in lines 3 and 3" in caught.value.faults


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"a: [1", r"broken\.yaml"),
        (b"a: b: c", r"broken\.yaml"),
        (b"study: \xff", r"broken\.yaml: .*\n.*cannot be read: byte 7 is no UTF-8"),
        (None, "cannot be read"),
    ],
)
def test_a_file_that_cannot_be_read(tmp_path: Path, content: bytes | None, said: str) -> None:
    path = tmp_path / "broken.yaml"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(StudyError, match=said):
        load_study(path)


def test_overlay_of_two_files_is_checked_as_merged() -> None:
    assert list(study_from_config(raw_study(), []).labels) == ["A", "B"]


def test_error_survives_pickling() -> None:
    error = StudyError("a: b", "c: d", source="x.yaml")
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.faults) == (str(error), error.faults)


def recording(**record: Any) -> dict[str, Any]:
    return {"A": CASE | {"record": record}}


@pytest.mark.parametrize(
    ("changes", "fault"),
    [
        ({"cases": {"A": 3}}, "cases.A = 3: must be a mapping"),
        ({"cases": {"A": CASE | {"parameters": 3}}}, "cases.A.parameters"),
        ({"cases": recording(events={"last": 1, "start": 0})}, "must give either last, or start and stop"),
        ({"cases": recording(events={"start": 2})}, "cases.A.record.events: must be within the run"),
        ({"cases": recording(windows={"zoom": {"start": 11, "rate": 10}})}, "windows.zoom: must be within the run"),
        ({"cases": recording(windows={"events": {"start": 0, "rate": 1}})}, "a window must not be called so"),
        ({"cases": {"A": CASE}, "figures": 3}, "figures"),
        ({"cases": {"F13": CASE}, "figures": ["fig13", "fig11", "fig99"]}, "figures.2 = 'fig99': unknown figure"),
        ({"cases": {"F13": CASE}, "figures": ["fig13", "fig11"]}, "figures.1 = 'fig11': needs a case F11"),
        ({"cases": {"F13": CASE}, "figures": ["fig13"]}, "figures.0 = 'fig13': needs a window"),
        ({"cases": {"F04": CASE}, "figures": ["fig04"]}, "figures.0 = 'fig04': needs cases.F04.record.poincare"),
        ({"cases": {"1A": CASE}}, "a case's name must be letters"),
        ({"cases": {"status": CASE}}, "the name is taken by a variable"),
    ],
)  # fmt: skip
def test_rules_of_studies_of_cases(changes: dict[str, Any], fault: str) -> None:
    assert fault in "\n".join(faults_of(parse_study, {"study": "x"} | changes))


def test_ramps_of_a_case() -> None:
    raw = raw_study()
    raw["cases"]["A"]["ramps"] = [{"parameter": "Omega", "to": "5", "start": 2, "end": 8}]
    spec = parse_study(raw).specs["A"]
    assert [ramp.to for ramp in spec.ramps] == [5.0]
    assert CaseSpec.from_canonical(spec.canonical) == spec
    raw["cases"]["A"]["ramps"] *= 2
    raw["cases"]["A"]["record"] = {"poincare": {}}
    raw["cases"]["B"]["ramps"] = [{"parameter": "c", "to": -1, "start": 2, "end": 8}]
    faults = "\n".join(faults_of(parse_study, raw))
    assert "cases.A.ramps" in faults
    assert "must be >= 8, where the ramp of Omega before it ends" in faults
    assert "cases.A.record: must not be asked for on ramps of Omega" in faults
    assert "cases.B.ramps.0.parameter = 'c'" in faults
    assert "cases.B.ramps.0.to = -1: must be > 0" in faults
