"""Files that are whole, or noticed not to be, and their names."""

from collections.abc import Callable
from pathlib import Path

import pytest

from disc_model import Parameters, Result, Window, simulate
from disc_model.data import files
from disc_model.data.dataset import UnreadableFile, WriteError, load, save
from tests.refusals import refusal

P = Parameters(N=200, Omega=50, n_diameters=1)
RUN = simulate(P, 0.02, {"all": Window(rate=2000)})


def test_a_tree_that_is_cut_is_unreadable_or_whole(tmp_path: Path) -> None:
    path = tmp_path / "tree.nc"
    RUN.save(path)
    whole = path.read_bytes()
    tree = load(path)
    assert load(path).identical(tree)
    for left in (0, 1, 100, len(whole) // 2):
        path.write_bytes(whole[:left])
        with pytest.raises(UnreadableFile):
            load(path)


LONG = "x" * 252 + ".nc"  # 255 bytes: the most that file systems take


@pytest.mark.parametrize("name", [LONG, "x" * 240 + ".nc", "ü" * 126 + ".nc"])
def test_the_longest_names_are_written(name: str, tmp_path: Path) -> None:
    """The name of the temporary file was longer still."""
    RUN.save(tmp_path / name)
    assert [path.name for path in tmp_path.iterdir()] == [name]
    assert load(tmp_path / name)["N"] == 200


@pytest.mark.parametrize(
    "name", ["x" * 253 + ".nc", "x" * 5000 + ".nc", "a\0b.nc", "ü" * 127 + ".nc"]
)
@pytest.mark.parametrize(
    "use", [lambda path: RUN.save(path), lambda path: save(RUN.to_tree(), path), Result.load, load]
)
def test_a_name_that_no_file_can_have_is_one_clear_error(
    use: Callable[[str], object], name: str, tmp_path: Path
) -> None:
    with refusal(r"^path=.*: must be the name of a file"):
        use(f"{tmp_path}/{name}")
    assert not [*tmp_path.iterdir()]


def test_a_failure_to_write_leaves_nothing_behind(tmp_path: Path) -> None:
    def fail(name: str) -> None:
        Path(name).write_text("half")
        raise OSError("no space left")

    a_path = tmp_path / "a.nc"
    with pytest.raises(WriteError, match=r"a\.nc: cannot be written: no space left"):
        files.write_atomically(a_path, fail)
    a_file = tmp_path / "no" / "a.nc"
    with pytest.raises(WriteError, match=r"a\.nc: must be in a folder that exists"):
        files.write_atomically(a_file, fail)
    assert not [*tmp_path.iterdir()]
