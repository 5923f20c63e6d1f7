"""How faults are said, whatever holds the value; and statuses: words that carry their sentence."""

import pickle
from typing import Any

import pytest

from disc_model import ParameterError
from disc_model.errors import DiscModelError, Fault, script
from disc_model.studies.study import StudyError
from disc_model.units import Checked, Real, Strict, Tolerance
from tests.studies.refused import faults_of


class Inner(Strict):
    size: Real = 1.0


class Outer(Checked):
    inner: Inner = Inner()
    choice: bool | Inner | list[Inner] = True
    tol: Tolerance = 1e-10


@pytest.mark.parametrize(
    ("values", "fault"),
    [
        ({"inner": {"sise": 1}}, "inner.sise=1: unknown key, did you mean size? (known: size)"),
        ({"inner": 3}, "inner=3: must be a mapping"),
        ({"tol": 0.1}, "tol=0.1: must be within 1e-15 and 0.01"),
        ({"tol": "x" * 99}, f"tol={repr('x' * 99)[:57]}...: must be a number"),
        ({"choice": [{"size": 1}, {"sise": 1}]}, "choice.1.sise=1: unknown key, did you mean size? (known: size)"),
    ],
)
def test_faults_of_nested_values(values: dict[str, Any], fault: str) -> None:
    assert fault in faults_of(Outer, **values)


def test_a_fault_is_its_text_and_knows_its_parts() -> None:
    fault = Fault(("N",), "-1", "must be >= 0")
    copy = pickle.loads(pickle.dumps(fault))
    assert fault == copy == "N=-1: must be >= 0"
    assert (copy.path, copy.value, copy.rule) == (("N",), "-1", "must be >= 0")
    for error in (ParameterError(fault, "k=nan: must be finite"), StudyError("a: b", "c: d", source="x.yaml")):
        again = pickle.loads(pickle.dumps(error))
        assert (str(again), again.faults) == (str(error), error.faults)


@pytest.mark.parametrize("error", [KeyboardInterrupt(), DiscModelError("no result")])
def test_a_script_ends_without_a_traceback(monkeypatch: pytest.MonkeyPatch, error: BaseException) -> None:
    def main() -> None:
        raise error

    main.__module__ = "__main__"
    monkeypatch.setattr("sys.argv", ["script.py"])
    with pytest.raises(SystemExit) as ended:
        script(main)
    assert ended.value.code == (str(error) or "interrupted")
