"""Statuses: words that carry their sentence."""

from __future__ import annotations

import pickle

import pytest

from disc_model import Status
from disc_model.status import StatusBase


@pytest.mark.parametrize("status", Status)
def test_each_word_has_a_sentence(status: Status) -> None:
    assert status == status.value == str(status)
    assert Status(status.value) is status
    assert status.advice[0].isupper()
    assert status.advice.endswith(".")


def test_words_come_back_from_a_pickle_as_they_were() -> None:
    assert pickle.loads(pickle.dumps(Status.STALLED)) is Status.STALLED


def test_a_status_without_a_sentence_is_refused() -> None:
    with pytest.raises(TypeError, match="advice"):
        StatusBase("Mute", {"OK": "ok"})  # type: ignore[call-overload]
