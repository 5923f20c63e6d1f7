"""Files that are whole, or noticed not to be: checksums, names, and what other programs have
changed."""

import random
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
import xarray as xr
from netCDF4 import Dataset

import disc_model as dm
from disc_model import Parameters, Result, State, Window, simulate
from disc_model.data import files
from disc_model.data.dataset import UnreadableFile, WriteError, load, save
from tests.refusals import refusal

P = Parameters(N=200, Omega=50, n_diameters=1)
RUN = simulate(P, 0.02, {"all": Window(rate=2000)})
LOADERS: dict[str, tuple[Callable[[Path], object], Callable[[Any], Any]]] = {
    "result.nc": (RUN.save, Result.load),
    "result.mat": (RUN.save, Result.load),
    "state.nc": (RUN.final_state.save, State.load),
    "state.mat": (RUN.final_state.save, State.load),
    "tree.nc": (RUN.save, load),
    "dataset.mat": (partial(dm.save, RUN.to_tree()), dm.load),
}


@pytest.mark.parametrize("kind", LOADERS)
def test_no_damaged_file_is_read(
    kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of .mat files 13 % were read with wrong numbers, or scipy ended Python. So that nothing can
    end it here, no library sees any of these files."""
    path = tmp_path / kind
    write, read = LOADERS[kind]
    write(path)
    read(path)
    whole = path.read_bytes()
    for library in ("scipy.io.loadmat", "xarray.open_datatree"):
        monkeypatch.setattr(library, lambda *_, **__: pytest.fail("a library sees a damaged file"))
    for damaged in damages(whole, cut=kind != "tree.nc"):
        path.write_bytes(damaged)
        with pytest.raises(UnreadableFile, match=f"{kind}: cannot be read: it "):
            read(path)


def damages(whole: bytes, cut: bool) -> Iterator[bytes]:
    """Files with one or three bits changed, and shortened ones if they are to be `cut`: what is
    left of a tree may be taken for the file of another program, without a checksum."""
    rng = random.Random(1)
    for i in range(300):
        data = bytearray(whole)
        if cut and i % 5 == 0:
            del data[rng.randrange(len(data)) :]
        else:
            for at in rng.sample(range(len(data)), rng.choice((1, 1, 3))):
                data[at] ^= 1 << rng.randrange(8)
        yield bytes(data)


def test_a_tree_that_is_cut_is_unreadable_or_whole(tmp_path: Path) -> None:
    path = tmp_path / "tree.nc"
    RUN.save(path)
    whole = path.read_bytes()
    tree = load(path)
    for left in (0, 1, 100, len(whole) // 2, len(whole) - 500, len(whole) - 60, len(whole) - 1):
        path.write_bytes(whole[:left])
        with pytest.raises(UnreadableFile):
            load(path)
    path.write_bytes(whole[: -files._SEAL])
    assert load(path).identical(tree)


@pytest.mark.parametrize("at", [0, 5, 60, 115, 116, 128, -1])
def test_every_part_of_a_file_counts(at: int, tmp_path: Path) -> None:
    for name in ("r.mat", "r.nc"):
        path = tmp_path / name
        RUN.save(path)
        data = bytearray(path.read_bytes())
        data[at] ^= 1
        path.write_bytes(data)
        with pytest.raises(UnreadableFile):
            Result.load(path)


def test_other_programs_read_what_is_sealed(tmp_path: Path) -> None:
    r_path = tmp_path / "r.mat"
    RUN.save(r_path)
    s_path = tmp_path / "s.mat"
    RUN.save(s_path)
    assert r_path.read_bytes() == s_path.read_bytes()
    text = r_path.read_bytes()[:128]
    # as the format says: a text, 8 bytes for a subsystem, the version, and the order of bytes
    assert text.startswith(b"MATLAB 5.0 MAT-file")
    assert text[116:] == b"\x00" * 8 + b"\x00\x01IM"
    content = scipy.io.loadmat(r_path, simplify_cells=True)
    events = content["events"]
    meanings = content["meanings"]
    words = [meanings["kind"][int(kind)] for kind in events["kind"]]
    assert words == RUN.events["kind"].tolist()
    phases = [meanings["phase"][int(phase)] for phase in content["all"]["phase"]]
    assert {*phases} == {"stick", "slip"}
    assert phases[0] == "stick"
    assert content["units"]["P"] == "N"
    r_file = tmp_path / "r.nc"
    RUN.save(r_file)
    with xr.open_dataset(r_file, group="all") as opened:
        np.testing.assert_array_equal(opened["P"], RUN["all"]["P"])
    with xr.open_dataset(r_file) as opened:
        assert opened["tol"].attrs["units"] == "s"


def test_a_netcdf_file_of_another_program_is_read_but_is_no_result(tmp_path: Path) -> None:
    path = tmp_path / "other.nc"
    xr.Dataset({"x": ("t", [1.0, 2.0])}).to_netcdf(path)
    assert load(path)["x"].values.tolist() == [1.0, 2.0]
    RUN.save(path)
    with Dataset(path, "a") as root:
        root.setncattr("title", "mine")
    with pytest.raises(UnreadableFile, match=r"other\.nc: cannot be read: it "):
        Result.load(path)


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
    "use",
    [
        lambda path: RUN.save(path),
        lambda path: RUN.final_state.save(path),
        lambda path: save(RUN.to_tree(), path),
        Result.load,
        State.load,
        load,
    ],
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
