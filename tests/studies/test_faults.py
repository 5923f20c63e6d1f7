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
from disc_model.studies.closing import closing_lines
from disc_model.studies.point_lists import listed_in, point_list
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


def test_the_faults_of_a_study_come_in_one_error() -> None:
    faults = faults_of(
        parse_study,
        GRID | {"base": {"N": -1, "m": "x", "mu": 1}, "figures": {"f": {"kind": "heat"}}},
    )
    for words in ("base.N -1", "base.m 'x' number", "base.mu mu_s", "figures.f.kind"):
        assert_named(faults, words)


TYPO_OF_AN_AXIS = {
    "study": "q",
    "quantity": "floquet",
    "base": {"damping_ratio": 0.001},
    "axes": {"Omega": {"strat": 20, "stop": 30, "count": 3}, "N": [200, 300]},
}


def test_a_typo_in_an_axis_adds_no_fault_of_what_was_never_written() -> None:
    """The third fault was of a D_star, which stood for the start."""
    faults = faults_of(parse_study, TYPO_OF_AN_AXIS)
    assert [fault.split(":")[0] for fault in faults] == ["axes.Omega.start", "axes.Omega.strat=20"]


@pytest.mark.parametrize("part", ["start", "stop"])
def test_without_a_part_of_an_axis_the_rest_is_still_checked(part: str) -> None:
    axis = {"start": 20, "stop": 30, "count": 3}
    del axis[part]
    changes = {"axes": {"Omega": axis, "N": [200], "k": [4e4]}, "base": {"k": 5e4}}
    faults = faults_of(parse_study, TYPO_OF_AN_AXIS | changes)
    assert [fault.split(":")[0] for fault in faults] == [f"axes.Omega.{part}", "axes.k"]


def test_a_typo_of_the_step_of_an_axis_is_one_fault() -> None:
    axes = {"Omega": {"start": 20, "stop": 30, "setp": 5}, "N": [200]}
    [fault] = faults_of(parse_study, TYPO_OF_AN_AXIS | {"axes": axes})
    assert fault.startswith("axes.Omega.setp=5: unknown key")


@pytest.mark.parametrize("record", ["every second", {"windows": "late"}])
def test_a_figure_of_a_window_is_not_at_fault_where_the_record_is(record: Any) -> None:
    case = {"t_end": 3, "parameters": {"N": 300, "Omega": 10}}
    figure = {"kind": "history", "case": "A", "window": "late"}
    raw = {"study": "q", "cases": {"A": case}, "figures": {"f": figure}, "record": record}
    [fault] = faults_of(parse_study, raw)
    assert fault.startswith("record")


MANY = """
study: many
quantity: floquet
base: {N: -5, mu_k: abc, friction_ofset: surface, E: 150 kg}
axes:
  Omga: {start: 10, stop: 20, count: 5}
  normalization: [as_publised, orthonormal]
  mu_s: [0.4, 0.5]
options: {tool: 1.0e-12}
figures:
  growth: {kind: curve, variable: growth_rat, x: Omega, by: mu_s, at: {normalization: orthonormal}}
  map: {kind: heat_mp, variable: period, x: Omega, y: mu_s}
  last: {kind: heat_map, variable: period, x: mu_z, y: Omega, foo: 1}
"""
ALL_OF_THEM = (
    "base.N -5",
    "base.mu_k 'abc'",
    "base.friction_ofset friction_offset",
    "base.E '150 kg'",
    "axes.Omga Omega",
    "axes.normalization 'as_publised'",
    "options.tool tol",
    "figures.growth.variable 'growth_rat' growth_rate",
    "figures.map.kind 'heat_mp' heat_map",
    "figures.last.foo",
    "figures.last.x 'mu_z' mu_s",
)


def test_faults_of_all_kinds_come_in_one_round() -> None:
    """They came in four: of the second, the first ones had to be mended to see them."""
    faults = faults_of(parse_study, yaml.safe_load(MANY))
    for words in ALL_OF_THEM:
        assert_named(faults, words)
    assert len(faults) == len(ALL_OF_THEM), "and none that only what was left out makes"


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


def test_the_name_of_a_study_hides_no_other_fault() -> None:
    """With a wrong name the rules between values were not checked."""
    faults = faults_of(
        parse_study, GRID | {"study": "b 6", "axes": {"Omega": [10, 20], "mu_k": [1.0]}}
    )
    assert_named(faults, "study 'b pattern")
    assert_named(faults, "axes.mu_k 1 <= mu_s")
    assert len(faults) == 2


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
    (lambda: p(n_diameters="auto"), "n_diameters='auto' choose_modes"),
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


# ---- what a run says in the end


def test_a_run_says_in_the_end_what_has_no_result(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    grids = parse_study(GRID).grids()[0]
    folder = tmp_path / "results" / "s"
    folder.mkdir(parents=True)
    (folder / "s.failed.txt").write_text("Omega = 10: paradox\nOmega = 20: paradox\n")
    (folder / "s.remarks.txt").write_text(point_list([]))
    file = Path("results/s/s.failed.txt")
    assert list(closing_lines(grids)) == [f"s: 2 of 4 points have no result, see {file}"]
    # a motion that has not settled has its samples all the same
    (folder / "s.failed.txt").write_text("Omega = 10: paradox\n")
    remarked = Path("results/s/s.remarks.txt")
    remarked.write_text("Omega = 20: not settled after 80 s: changing at 0.1/s\n")
    assert list(closing_lines(grids)) == [
        f"s: 1 of 4 points have no result, see {file}",
        f"s: 1 of 4 points have a remark, see {remarked}",
    ]


def test_a_file_that_lists_no_point_says_so(tmp_path: Path) -> None:
    """Each folder of results had two empty files."""
    file = tmp_path / "s.failed.txt"
    file.write_text(point_list([]))
    assert file.read_text() == "no point\n"
    assert listed_in(file) == []
    lines = ["Omega = 10: paradox", "Omega = 20: paradox"]
    file.write_text(point_list(lines))
    assert listed_in(file) == lines


def test_no_cycle_is_an_answer_and_no_failure(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """500 points of a Campbell diagram had "no result" though frequencies were there."""
    monkeypatch.chdir(tmp_path)
    grids = parse_study(GRID).grids()[0]
    file = Path("results/s/s.failed.txt")
    file.parent.mkdir(parents=True)
    file.with_name("s.remarks.txt").write_text(point_list([]))
    file.write_text(
        "Omega = 10: no cycle found: The slider moves on\nOmega = 15: no cycle found\n"
        "Omega = 20: steady sliding: it does not stick\nOmega = 25: failed: no cycle found\n"
    )
    assert list(closing_lines(grids)) == [
        f"s: 1 of 4 points have no result, see {file}",
        "s: 3 of 4 points have no stick-slip cycle (2 no cycle found, 1 steady sliding), see"
        f" {file}",
    ]


def test_a_name_with_ok_in_it_is_no_remark(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    grids = parse_study(GRID).grids()[0]
    folder = tmp_path / "results" / "s"
    folder.mkdir(parents=True)
    (folder / "s.remarks.txt").write_text(point_list([]))
    file = folder / "s.failed.txt"
    file.write_text("start = broken: paradox\nstart = smoke: failed: no steps\n")
    [line] = closing_lines(grids)
    assert line.startswith("s: 2 of 4 points have no result")


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
