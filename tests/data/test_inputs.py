"""Files that a job reads."""

from __future__ import annotations

from pathlib import Path

import pytest

from disc_model.data.inputs import InputsError, each_intact


def test_inputs_are_read_in_their_order(tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / name).write_text(name)
    assert each_intact(lambda path: path.read_text(), [tmp_path / "b", tmp_path / "a"]) == ["b", "a"]
    with pytest.raises(InputsError, match="not there"):
        each_intact(lambda path: path.read_text(), [tmp_path / "c"])
