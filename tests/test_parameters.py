"""Parameters: validation, one error for all faults, hashing, copies."""

import copy
import json
import math
import pickle
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from disc_model import Disc, ParameterError, Parameters
from disc_model.data.columns import scalars_dataset
from disc_model.parameters import PLATE
from tests.processes import python
from tests.refusals import refusal


def test_key_depends_on_values_not_on_spelling() -> None:
    key = Parameters(N=20, Omega=0.0).key
    assert key == Parameters(Omega=-0.0, N="20.0").key
    assert len(key) == 12
    assert int(key, 16) >= 0
    assert key != Parameters(N=20.000000000000004, Omega=0).key
    assert math.copysign(1, Parameters(N=20, Omega=-0.0).Omega) == 1


@given(st.sampled_from(sorted(Parameters.model_fields)))
def test_key_changes_with_every_field(name: str) -> None:
    n_circles = 2
    if name == "disc":
        n_circles = 0
    p = Parameters(N=385, Omega=15.1, c=1, c_p=1, n_circles=n_circles)
    other = {
        "normalization": "orthonormal",
        "contact": "bilateral",
        "n_diameters": 3,
        "n_circles": 1,
    }
    other |= {
        "contact_compliance": 1e-7,
        "contact_force": "normal",
        "damping_ratio": 1e-3,
        "friction_offset": 1e-3,
    }
    other["contact_arc"] = 0.4
    other["friction_decay"] = 2.0
    other["friction_law"] = "exponential"
    other["viscous_friction"] = 0.1
    other["stretching"] = "clamped"
    other["disc"] = Disc(diameters=[1], omega=[1500.0], amplitude=[2.0])
    assert p.replace(**{name: other.get(name) or getattr(p, name) * 0.999}).key != p.key


def test_laws_of_contact_change_the_key_and_defaults_that_are_given_do_not() -> None:
    p = Parameters(N=385, Omega=15.1)
    assert p.replace(contact_compliance="0", contact_force="vertical").key == p.key
    others = [
        {"contact_compliance": 1e-7},
        {"contact_compliance": "residual"},
        {"contact_force": "normal"},
    ]
    cases = [p.replace(**other) for other in others]
    assert len({case.key for case in cases} | {p.key}) == 4
    for case, other in zip(cases, others, strict=True):
        assert Parameters(**json.loads(case.canonical_json)) == case
        assert {name: getattr(case, name) for name in other} == other


def test_a_second_damping_is_refused_even_if_it_is_zero() -> None:
    with refusal(r"^D_star=0: must be left out where damping_ratio is"):
        Parameters(N=1, Omega=2, damping_ratio=1e-3, D_star=0)
    assert Parameters(N=1, Omega=2, damping_ratio=1e-3, D_star=1e-5).D_star == 1e-5


def test_immutable_hashable_picklable() -> None:
    p = Parameters(N=385, Omega=15.1)
    with refusal(r"^Parameters.N: is frozen: use replace\(N=3\)"):
        p.N = 3
    with refusal(r"^Parameters: has no Omga, did you mean Omega\?"):
        p.Omga = 3
    assert pickle.loads(pickle.dumps(p)) == p
    assert {p: 1}[Parameters(N=385.0, Omega=15.1)] == 1


WRONG = ("()", "(N=1, Omega=2, Omga=3)", "(N=1, Omega=2, k=[1])")
RIGHT = (
    "(N='0.2 kN', Omega=2, E='150 GPa', disc=None).replace(E='1 GPa')",
    "(N=1, Omega=2, disc=disc_model.Disc(diameters=[1], omega=[1.5e3], amplitude=[2]))",
)


@pytest.mark.slow
def test_a_type_checker_knows_the_parameters(tmp_path: Path) -> None:
    mypy_path = tmp_path / "mypy.ini"
    mypy_path.write_text("[mypy]\nfollow_imports = silent\nignore_missing_imports = true\n")
    lines = [f"disc_model.Parameters{arguments}" for arguments in (*WRONG, *RIGHT)]
    case_path = tmp_path / "case.py"
    case_path.write_text("\n".join(["import disc_model", *lines]))
    shown = subprocess.run(
        [sys.executable, "-m", "mypy", "case.py"], cwd=tmp_path, capture_output=True, text=True
    )
    assert {int(line.split(":")[1]) for line in shown.stdout.splitlines() if "error:" in line} == {
        2,
        3,
        4,
    }


def test_import_is_light() -> None:
    """The library for units is loaded where one is met only: it takes a second."""
    heavy = "{'numba', 'xarray', 'pandas', 'matplotlib', 'pint'}"
    code = f"import sys, disc_model; disc_model.Parameters(N='1e2', Omega=1); print({heavy} & set(sys.modules))"
    assert python(code).stdout.strip() == "set()"


def test_a_ratio_stands_for_its_first_one_and_stays() -> None:
    p = Parameters(N=1, Omega=2, mu_s="0.5", mu_k_over_mu_s=0.6)
    assert p.mu_k == 0.3
    assert p.replace(mu_s=0.4).mu_k == 0.24
    assert eval(repr(p)) == p
    assert repr(p) == "Parameters(N=1.0, Omega=2.0, mu_s=0.5, mu_k_over_mu_s=0.6)"
    assert p.replace(mu_s=0.4, mu_k=0.1).replace(mu_s=0.2).mu_k == 0.1, (
        "forgotten once its first one is given"
    )
    assert (
        p.replace(mu_k_over_mu_s=0.5).mu_k
        == p.replace(N=3).replace(mu_k_over_mu_s=0.5).mu_k
        == 0.25
    )
    assert Parameters(N=1, Omega=2, b="240 mm", r_0_over_b=0.5).r_0 == 0.12
    assert p.canonical == Parameters(N=1, Omega=2, mu_s=0.5, mu_k=0.3).canonical
    for wrong, rule in (
        ({"mu_k_over_mu_s": 1.2}, "mu_k=0.48: must be <= mu_s=0.4"),
        ({"mu_k_over_mu_s": 0.5, "mu_k": 0.1}, "mu_k_over_mu_s=0.5: must not be given beside mu_k"),
        ({"mu_k_over_mu_s": "half"}, "mu_k_over_mu_s='half': must be a finite number >= 0"),
    ):
        with refusal(rule):
            Parameters(N=1, Omega=2, **wrong)


RATIOS = Parameters(N=385, Omega=15, mu_s=0.5, mu_k_over_mu_s=0.6, r_0_over_b=0.8)


@pytest.mark.parametrize(
    "p",
    [
        Parameters(N=385, Omega=15),
        Parameters(N=385, Omega=15, friction_decay=0.1 + 0.2, contact_compliance="residual"),
        Parameters(N=1, Omega=2, disc=Disc(diameters=[1], omega=[1500.0], amplitude=[2.0])),
        RATIOS,
    ],
    ids=["paper", "laws", "disc", "ratios"],
)
def test_a_case_survives_json(p: Parameters) -> None:
    """The infinite friction_decay became null, and a ratio a number."""
    again = Parameters.model_validate_json(p.model_dump_json())
    assert again == p
    assert again.key == p.key
    assert repr(again) == repr(p)
    assert Parameters.model_validate(json.loads(p.model_dump_json())) == p


@pytest.mark.parametrize(
    "copied",
    [
        lambda p: Parameters.model_validate_json(p.model_dump_json()),
        lambda p: Parameters.model_validate(p.model_dump(mode="json")),
        lambda p: pickle.loads(pickle.dumps(p)),
        copy.deepcopy,
        Parameters.replace,
        Parameters.model_copy,
    ],
)
def test_a_ratio_stays_a_ratio_in_a_copy(copied: Callable[[Parameters], Parameters]) -> None:
    again = copied(RATIOS)
    assert again == RATIOS
    changed = again.replace(mu_s=0.4, b=0.13)
    assert changed.mu_k == 0.24
    assert changed.r_0 == pytest.approx(0.104)


@pytest.mark.parametrize(
    ("name", "value", "fault"),
    [
        ("friction_offset", "none", "friction_offset='none': must be a number or 'surface'"),
        (
            "contact_compliance",
            -1,
            "contact_compliance=-1: must be a finite number >= 0 or 'residual'",
        ),
    ],
)
def test_a_value_of_no_kind_is_one_fault(name: str, value: object, fault: str) -> None:
    with pytest.raises(ParameterError) as error:
        Parameters(N=1, Omega=2, **{name: value})  # type: ignore[arg-type]
    assert [str(each) for each in error.value.faults] == [fault]


def test_a_disc_of_ones_own_stores_nothing_of_the_plate() -> None:
    disc = Disc(diameters=[0, 3], omega=[1490, 1515], amplitude=[1.53, 2.16])
    case = Parameters(N=385, Omega=15.1, disc=disc, r_0=0.1)
    assert not {*PLATE} & {*json.loads(case.canonical_json)}
    assert Parameters.model_validate_json(case.canonical_json) == case
    values = scalars_dataset(case, {}, "ok", "")
    assert values["n_diameters"] == 3
    assert values["E"].isnull()


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ('{"N": 1}', "Omega: is required"),
        ('{"N": 1, "Omega": -1}', "Omega=-1: must be >= 0"),
        ("[1]", "must be a mapping"),
        ('{"N": 1,', "Invalid JSON: EOF while parsing a value at line 1 column 8"),
    ],
)
def test_json_of_no_case_is_an_error_of_this_package(text: str, fault: str) -> None:
    with refusal(f"^{re.escape(fault)}"):
        Parameters.model_validate_json(text)


@pytest.mark.parametrize("name", ["N", "E", "nu", "mu_s", "damping_ratio"])
def test_a_value_that_is_not_a_number_is_told_so(name: str) -> None:
    """It was told the bound that a comparison with it breaks, such as >= 0."""
    values = {"N": 385, "Omega": 15, name: math.nan}
    with pytest.raises(ParameterError) as error:
        Parameters(**values)
    assert str(error.value) == f"{name}=nan: must be a finite number"
