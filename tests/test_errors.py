"""Faults name a value and its rule, in other processes too; and how a script ends."""

import pickle
from typing import Any

import pytest

from disc_model import ParameterError, Parameters
from disc_model.errors import DiscModelError, Fault, as_text, script
from tests.refusals import refusal


def test_a_fault_is_its_text_and_knows_its_parts() -> None:
    fault = Fault(("N",), "-1", "must be >= 0")
    copy = pickle.loads(pickle.dumps(ParameterError(fault, "k=nan: must be finite")))
    assert str(copy) == "N=-1: must be >= 0; k=nan: must be finite"
    again, other = copy.faults
    assert (again.path, again.value, again.rule) == (("N",), "-1", "must be >= 0")
    assert str(again.inside(("base",))) == "base.N=-1: must be >= 0"
    assert other.path == ()


@pytest.mark.parametrize("error", [KeyboardInterrupt(), DiscModelError("no result")])
def test_a_script_ends_without_a_traceback(
    monkeypatch: pytest.MonkeyPatch, error: BaseException
) -> None:
    def main() -> None:
        raise error

    main.__module__ = "__main__"
    monkeypatch.setattr("sys.argv", ["script.py"])
    with pytest.raises(SystemExit) as ended:
        script(main)
    assert ended.value.code == (str(error) or "interrupted")


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.1 + 0.2, "0.3"),
        (2.0, "2"),
        (1e-5, "1e-05"),
        ([1, "a", None], "[1, 'a', None]"),
        ("x" * 1000, f"'{'x' * 27}...{'x' * 28}'"),
    ],
)
def test_a_value_in_a_message(value: Any, text: str) -> None:
    assert as_text(value) == text


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"N": -1, "Omga": 3}, "N=-1: must be >= 0; Omega: is required; Omga=3: unknown parameter"),
        ({"N": "x", "Omega": True}, "N='x': must be a number; Omega=True: must be a number"),
        ({"n_diameters": 4.5}, "n_diameters=4.5: must be a whole number"),
        ({"nu": 0.5}, "nu=0.5: must be < 0.5"),
        ({"E": float("inf")}, "E=inf: must be a finite number"),
        ({"contact": "glued"}, "contact='glued': must be 'unilateral' or 'bilateral'"),
        ({"contact_compliance": -1}, "contact_compliance=-1: must be a finite number >= 0 or "),
        ({"friction_offset": "none"}, "friction_offset='none': must be a number or 'surface'"),
        ({"friction_decay": 1e13}, r"friction_decay=10000000000000: must be at most 1e12 s/m"),
        ({"mu_k": 0.5}, "mu_k=0.5: must be <= mu_s=0.4"),
        ({"a": 0.1}, "a=0.1: must be < r_0=0.1"),
        ({"b": 0.05}, "r_0=0.1: must be <= b=0.05"),
        ({"h": 1e200}, "h=1e\\+200: must give a finite, positive E h"),
        ({"damping_ratio": 1e-3, "D_star": 0}, "D_star=0: must be left out where damping_ratio is"),
        ({"disc": 3}, "disc=3: must be a mapping"),
        ({"disc": "x.csv"}, "disc='x.csv': must be a Disc: disc_model.Disc.from_csv reads"),
    ],
)
def test_a_wrong_case_names_parameter_value_and_rule(given: dict[str, Any], message: str) -> None:
    case = {"N": 1, "Omega": 2} | given
    if "Omga" in given:
        del case["Omega"]
    with refusal(f"^{message}"):
        Parameters(**case)
