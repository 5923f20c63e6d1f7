"""Typical faults of study files, arguments and command lines: each error names what is wrong, its
value and the rule.

Only the words that carry the meaning are checked, so that sentences may change.
"""

import contextlib
import io
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest.mock import patch

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

import disc_model as dm
from disc_model import cli
from disc_model.stability.lyapunov import lyapunov_exponents
from disc_model.studies.study import StudyError, parse_study, read_file
from tests.studies.refused import faults_of

ROOT = Path(__file__).parents[2]
FAULTS = yaml.safe_load(Path(__file__).with_name("faults.yaml").read_text(encoding="utf-8"))
GRID = FAULTS["grid"]
CASE = FAULTS["case"]
STUDIES = [
    (whole | change, words)
    for whole, name in ((GRID, "grids"), (CASE, "cases"))
    for change, words in FAULTS[name]
]
STUDIES.append(({"study": "s"}, "quantity required cases studies"))


def assert_named(faults: list[str], words: str) -> None:
    """One of the faults has all the words."""
    assert any(all(word in fault for word in words.split()) for fault in faults), faults


@pytest.mark.parametrize(("raw", "words"), STUDIES, ids=[words for _, words in STUDIES])
def test_a_fault_of_a_study_is_named(raw: dict[str, Any], words: str) -> None:
    assert_named(faults_of(lambda: parse_study(raw).grids()), words)


@pytest.mark.parametrize("record", ["every second", {"windows": "late"}])
def test_a_figure_of_a_window_is_not_at_fault_where_the_record_is(record: Any) -> None:
    case = {"t_end": 3, "parameters": {"N": 300, "Omega": 10}}
    figure = {"kind": "history", "case": "A", "window": "late"}
    raw = {"study": "q", "cases": {"A": case}, "figures": {"f": figure}, "record": record}
    [fault] = faults_of(parse_study, raw)
    assert fault.startswith("record")


SAMPLED = {"distributions": {"mu_s": {"mean": 0.4, "deviation": 0.01}}, "samples": 8}


@pytest.mark.parametrize(
    ("change", "count"),
    [
        ({"base": {"N": -1}}, 1),  # not also required
        ({"axes": {"Omega": [10, 20], "mus": [0.4, 0.5]}}, 1),
        ({"base": {"N": 200, "mu_k": -1}, "quantity": "outcom"}, 2),
        ({"figures": {"f": {"kind": "heat", "x": "k"}}}, 1),
        ({"study": "b 6"}, 1),
        ({"quantity": "sensitivity", "options": SAMPLED}, 1),  # not also empty distributions
    ],
)
def test_a_fault_makes_no_other_ones(change: dict[str, Any], count: int) -> None:
    faults = faults_of(parse_study, GRID | change)
    assert len(faults) == count, faults


def test_cases_with_wrong_names_are_not_missed_elsewhere() -> None:
    """Cases were said to be empty, and to be unknown to figures, once those were left out."""
    case = {"parameters": {"N": 385, "Omega": 15}, "t_end": 10}
    window = {"late": {"last": 4, "rate": 1000}}
    figure = {"kind": "history", "window": "late", "variables": ["u"]}
    raw = {
        "study": "s",
        "record": {"windows": window},
        "cases": {"a": case, "steps": case},
        "figures": {"one": figure | {"case": "a"}, "other": figure | {"case": "slow"}},
    }
    faults = faults_of(parse_study, raw)
    assert len(faults) == 2, faults
    assert_named(faults, "cases.a parameter inner radius case_a")
    assert_named(faults, "cases.steps variable of results case_steps")


@pytest.mark.parametrize(("text", "words"), FAULTS["texts"])
def test_text_that_is_no_study_is_located(text: str, words: str, tmp_path: Path) -> None:
    path = tmp_path / "text.yaml"
    path.write_text(text, encoding="utf-8")
    assert_named(faults_of(lambda: parse_study(read_file(path))), words)


def p(**changes: Any) -> dm.Parameters:
    return dm.Parameters(**{"N": 200, "Omega": 50, "n_diameters": 1} | changes)


def disc(**changes: Any) -> dm.Disc:
    return dm.Disc(
        **{"diameters": [0, 1, 1], "omega": [1490.0, 1515.0, 1820.0], "amplitude": [1.5, 2.2, 2.1]}
        | changes
    )


RESIDUAL = dm.Parameters(
    N=200, Omega=50, disc=disc(diameters=[0, 1, 2]), contact_compliance="residual"
)


def ramp(**changes: Any) -> dm.Ramp:
    return dm.Ramp(**{"parameter": "Omega", "to": 20, "start": 0.01, "end": 0.03} | changes)


def from_state(**changes: Any) -> None:
    dm.simulate(p(), 1.0, initial_state=dm.simulate(p(), 0.0371).final_state.replace(**changes))


ARGUMENTS: list[tuple[Callable[[], object], str]] = [
    (lambda: p(mu_k=0.5), "mu_k=0.5 <= mu_s=0.4"),
    (lambda: p(contact_compliance="soft"), "contact_compliance='soft' 'residual'"),
    (lambda: disc(diameters=[0, 1, 2], omega=[1490.0, 0.0, 1820.0]), "omega.1=0 0.001"),
    (lambda: disc(amplitude=[0, 0, 0]), "largest amplitude 0"),
    (lambda: disc(radii=[0.1, 0.05], shapes=[[1, 1]] * 3), "radii ascend"),
    (
        lambda: p(disc=disc(diameters=[0, 1, 2]), friction_offset="surface"),
        "friction_offset='surface' tangential",
    ),
    (lambda: dm.Window(rate=1, stop=2, last=1), "last=1 stop"),
    (lambda: from_state(phase="flight"), "initial_state.phase='flight' stick slip separation"),
    (lambda: from_state(psy=0.1), "psy=0.1 psi"),
    (lambda: dm.deflection(p(), dm.snapshots(p(), 0.1), 0.2, 0.0), "r=0.2 0.12"),
    (lambda: p(omega=3), "omega=3 unknown Omega"),
    (lambda: p(Omega="3 Hz"), "Omega='3 Hz' rad/s rpm"),
    (lambda: p(disc=disc(diameters=[0, 1, 2]), E=2e11), "E=200000000000 disc"),
    (lambda: disc(circles=[0, 0, 0]), "omega.2=1820 axisymmetric"),
    (lambda: dm.simulate(p(), 1.0, ramps=(ramp(), ramp(start=0.02))), "ramps.1.start=0.02 0.03"),
    (lambda: from_state(phase="stick", f=1.0), "initial_state.f=1 0 stick"),
    (lambda: dm.basins(p(n_diameters=-1), [1e-3]), "energies rigid"),
    (lambda: lyapunov_exponents(p(), 1.0, count=9), "count=9 8"),
    (lambda: dm.Window(rate=1, start=2, stop=1), "start=2 < stop=1"),
    (lambda: ramp(start=3, end=2), "start=3 < end=2"),
    (lambda: dm.simulate(p(N=0), 1.0, ramps=(ramp(),)), "N=0 ramps"),
    (lambda: disc(radii=[0.1], shapes=[[1]] * 3), "radii two or more"),
    (lambda: p(h=1e120), "h=1e+120 E h^3/12/(1-nu^2)"),
    (lambda: dm.simulate(RESIDUAL, 1.0), "disc.static_compliance None"),
    (lambda: dm.sweep(dm.floquet, p(), Omega=[]), "Omega one value"),
    (lambda: dm.sweep(dm.floquet, p(), Omega=["x"]), "Omega 'x' number"),
    (
        lambda: dm.deflection(p(), [dm.snapshots(p(n_diameters=2), 0.1)[0]], 0.1, 0.0),
        "states.0 modes",
    ),
    (lambda: dm.continue_cycle(p(N=0), "Omega", (1, 60)), "p cycle"),
]


@pytest.mark.parametrize(("call", "words"), ARGUMENTS, ids=[words for _, words in ARGUMENTS])
def test_a_wrong_argument_is_named(call: Callable[[], object], words: str) -> None:
    assert_named(faults_of(call), words)


@pytest.mark.parametrize(("text", "words"), FAULTS["tables"])
def test_a_fault_of_a_table_is_named(text: str, words: str, tmp_path: Path) -> None:
    path = tmp_path / "disc.csv"
    path.write_text(text)
    assert_named(faults_of(dm.Disc.from_csv, path), words)


@pytest.mark.parametrize(("arguments", "words"), FAULTS["commands"])
def test_a_wrong_command_line_is_named(
    arguments: str, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        cli.main(arguments.split())
    assert ended.value.code == 2
    assert_named([capsys.readouterr().err], f"error: {words}")


# ---- whatever is given, errors are those of the package

HOSTILE = [
    math.nan,
    math.inf,
    -0.0,
    10**400,
    -1,
    True,
    None,
    b"x",
    [],
    {},
    [1, [2]],
    {"N": {"N": 1}},
    "nan",
    "\0",
]
VALUES = st.one_of(st.sampled_from(HOSTILE), st.floats(), st.integers(), st.text(max_size=20))
FILES = [ROOT / "config/test.yaml", *sorted((ROOT / "config/studies").glob("*.yaml"))]
TEXTS = [path.read_text(encoding="utf-8") for path in FILES]
OPTIONS = [f"--{name}" for name in dm.Parameters.model_fields]
WORDS = st.one_of(st.sampled_from(["--t-end", "--help", *OPTIONS]), st.text(max_size=12))


def plant(tree: Any, value: Any, data: st.DataObject) -> Any:
    """The tree with another value somewhere."""
    keys = (
        list(tree)
        if isinstance(tree, dict)
        else list(range(len(tree)))
        if isinstance(tree, list)
        else []
    )
    if not keys or data.draw(st.integers(0, 5)) == 0:
        return value
    key = data.draw(st.sampled_from(keys))
    copy = tree.copy()
    copy[key] = plant(tree[key], value, data)
    return copy


@given(st.dictionaries(st.sampled_from([*dm.Parameters.model_fields, "n", ""]), VALUES, max_size=8))
def test_any_parameters(values: dict[str, Any]) -> None:
    with contextlib.suppress(dm.ParameterError):
        numbers = dm.Parameters(**values).model_dump(
            exclude={"friction_decay"}
        )  # which is infinite if friction drops
        assert all(math.isfinite(x) for x in numbers.values() if isinstance(x, float))


@given(st.data())
def test_a_study_with_any_value_somewhere(data: st.DataObject) -> None:
    study = yaml.safe_load(data.draw(st.sampled_from(TEXTS)))
    with contextlib.suppress(StudyError):
        parse_study(plant(study, data.draw(VALUES), data))


@given(st.sampled_from(TEXTS), st.integers(0, 2000), st.text(max_size=20), st.integers(0, 20))
def test_any_text_in_a_study_file(text: str, position: int, inserted: str, removed: int) -> None:
    changed = text[:position] + inserted + text[position + removed :]
    with contextlib.suppress(StudyError), patch.object(Path, "read_text", return_value=changed):
        parse_study(read_file(Path("any.yaml")))


@settings(max_examples=settings().max_examples // 5)  # each builds the parser anew
@given(st.lists(WORDS, max_size=6))
def test_any_command_line_ends_with_help_or_code_2(arguments: list[str]) -> None:
    stderr = io.StringIO()
    with (
        contextlib.redirect_stdout(io.StringIO()),
        contextlib.redirect_stderr(stderr),
        pytest.raises(SystemExit) as ended,
    ):
        cli.main(["run", *arguments, "--t-end", "-1"])  # nothing is computed
    assert ended.value.code in (0, 2)
    assert "Traceback" not in stderr.getvalue()
    assert re.search(r"\S", stderr.getvalue()) or ended.value.code == 0


@pytest.mark.parametrize(
    ("quantity", "fault"),
    [
        ("outcome", "options.horizon: is required: number > 0 (s), longest simulated time"),
        (
            "bifurcation",
            "options.transient: is required: number > 0 (s), time left out at the beginning; at"
            " events it is doubled until the motion has settled",
        ),
    ],
)
def test_a_missing_option_is_told_with_its_unit_and_meaning(quantity: str, fault: str) -> None:
    raw = {
        "study": "s",
        "quantity": quantity,
        "base": {"N": 200, "Omega": 20},
        "axes": {"c": [0.0]},
    }
    assert faults_of(parse_study, raw) == [fault]
