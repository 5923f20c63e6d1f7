"""Statuses: words that carry their sentence."""

from __future__ import annotations

import pickle

import pytest

from disc_model import Status
from disc_model.errors import StatusBase
from disc_model.stability.cycle import CycleStatus
from disc_model.stability.lyapunov import LyapunovStatus
from disc_model.stability.sliding import SlidingStatus

ALL = [status for kind in (Status, CycleStatus, LyapunovStatus, SlidingStatus) for status in kind]


@pytest.mark.parametrize("status", ALL, ids=repr)
def test_each_word_has_a_sentence(status: StatusBase) -> None:
    assert status == status.value == str(status)
    assert type(status)(status.value) is status
    assert pickle.loads(pickle.dumps(status)) is status
    assert status.advice[0].isupper()
    assert status.advice.endswith(".")


def test_a_status_without_a_sentence_is_refused() -> None:
    with pytest.raises(TypeError, match="advice"):
        StatusBase("Mute", {"OK": "ok"})  # type: ignore[call-overload]
