"""Files that are written in one piece."""

from pathlib import Path

import pytest

from disc_model.data.files import WriteError, regular_file, write_atomically
from tests.refusals import refusal


def test_a_failure_to_write_leaves_nothing_behind(tmp_path: Path) -> None:
    def fail(name: str) -> None:
        Path(name).write_text("half")
        raise OSError("no space left")

    with pytest.raises(WriteError, match=r"a\.nc: cannot be written: no space left"):
        write_atomically(tmp_path / "a.nc", fail)
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize("name", ["x" * 252 + ".nc", "ü" * 126 + ".nc"])
def test_the_longest_names_are_written(name: str, tmp_path: Path) -> None:
    """The name of the temporary file was longer still."""
    write_atomically(regular_file(tmp_path / name, ".nc"), lambda new: Path(new).write_text("all"))
    assert [path.name for path in tmp_path.iterdir()] == [name]


@pytest.mark.parametrize("path", [3, None, "."])
def test_what_is_no_name_of_a_file_is_refused(path: object) -> None:
    with refusal("^path=.*: must be the name of a file"):
        regular_file(path)  # type: ignore[arg-type]
