"""Faults are texts that know their parts, in other processes too; and how a script ends."""

import pickle

import numpy as np
import pytest
import xarray as xr

from disc_model import ParameterError
from disc_model.errors import LONGEST_VALUE, DiscModelError, Fault, as_text, script
from disc_model.studies.study import StudyError


def test_a_fault_is_its_text_and_knows_its_parts() -> None:
    fault = Fault(("N",), "-1", "must be >= 0")
    copy = pickle.loads(pickle.dumps(fault))
    assert fault == copy
    assert copy == "N=-1: must be >= 0"
    assert copy.path == ("N",)
    assert copy.value == "-1"
    assert copy.rule == "must be >= 0"
    for error in (
        ParameterError(fault, "k=nan: must be finite"),
        StudyError("a: b", "c: d", source="x.yaml"),
    ):
        again = pickle.loads(pickle.dumps(error))
        assert str(again) == str(error)
        assert again.faults == error.faults


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


def test_a_value_in_a_message_is_short_and_stands_in_one_line() -> None:
    """The text of lists that hold a list ten times took minutes and gigabytes."""
    deep: list = [1]
    for _ in range(50):
        deep = [deep] * 10
    endless: list = []
    endless.append(endless)
    for value in (deep, endless, {"a": deep}, "x" * 1000, np.eye(40)):
        text = as_text(value)
        assert len(text) == LONGEST_VALUE
        assert text.endswith("...")
        assert "\n" not in text
    for value in ([], (), (1,), [1, "a", None], {"a": (1, 2), "b": {}}, "x  y", 1 + 2j):
        assert as_text(value) == repr(value)
    assert as_text(0.1 + 0.2) == "0.3"
    assert as_text(xr.Dataset({"N": 1, "k": 2})) == "a dataset of 2 variables", "it was its table"
    assert as_text(2.0) == "2"
