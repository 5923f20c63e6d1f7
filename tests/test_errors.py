"""Faults are texts that know their parts, in other processes too; and how a script ends."""

import pickle

import pytest

from disc_model import ParameterError
from disc_model.errors import DiscModelError, Fault, script
from disc_model.studies.study import StudyError


def test_a_fault_is_its_text_and_knows_its_parts() -> None:
    fault = Fault(("N",), "-1", "must be >= 0")
    copy = pickle.loads(pickle.dumps(fault))
    assert fault == copy == "N=-1: must be >= 0"
    assert (copy.path, copy.value, copy.rule) == (("N",), "-1", "must be >= 0")
    for error in (
        ParameterError(fault, "k=nan: must be finite"),
        StudyError("a: b", "c: d", source="x.yaml"),
    ):
        again = pickle.loads(pickle.dumps(error))
        assert (str(again), again.faults) == (str(error), error.faults)


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
