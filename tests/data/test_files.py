"""Files with a checksum: whole, or noticed."""

from __future__ import annotations

import os
import random
import resource
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from disc_model.data.dataset import DamagedFile, WriteError, check_whole, load, save, write_whole
from disc_model.data.inputs import InputsError, load_inputs
from tests.tally import tried

TREE = xr.DataTree.from_dict(
    {
        "/": xr.Dataset({"first_separation": ((), 54.4), "n_events": ((), 12)}, attrs={"status": "ok"}),
        "/history": xr.Dataset({"P": ("time", np.sin(np.arange(3000.0)))}),
    }
)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    save(TREE, tmp_path / "case.nc")
    return tmp_path / "case.nc"


def test_other_readers_pass_over_the_checksum(path: Path) -> None:
    with xr.open_datatree(path) as tree:
        xr.testing.assert_equal(tree.load(), TREE)


@pytest.mark.parametrize(("umask", "mode"), [(0o022, 0o644), (0o077, 0o600), (0o002, 0o664)])
def test_the_umask_says_who_may_read(umask: int, mode: int, tmp_path: Path) -> None:
    """Every file was readable to all, whatever the umask."""
    before = os.umask(umask)
    try:
        save(TREE, tmp_path / "case.nc")
        save(TREE, tmp_path / "case.nc")  # over the old one as well
    finally:
        os.umask(before)
    assert (tmp_path / "case.nc").stat().st_mode & 0o777 == mode
    assert list(tmp_path.iterdir()) == [tmp_path / "case.nc"]


def test_every_changed_bit_is_noticed(path: Path) -> None:
    whole, chance, count = path.read_bytes(), random.Random(1), 500
    for _ in range(count):
        content = bytearray(whole)
        content[chance.randrange(len(whole))] ^= 1 << chance.randrange(8)
        path.write_bytes(content)
        with pytest.raises(DamagedFile, match=r"case\.nc: damaged"):
            check_whole(path)
    tried("damaged files noticed", "with a changed bit", count)
    path.write_bytes(whole)
    xr.testing.assert_equal(load(path), TREE)


def test_every_cut_is_noticed(path: Path) -> None:
    whole = path.read_bytes()
    lengths = [*range(0, len(whole), 97), *range(len(whole) - 200, len(whole))]
    for length in lengths:
        path.write_bytes(whole[:length])
        with pytest.raises(DamagedFile):
            check_whole(path)
    tried("damaged files noticed", "cut short", len(lengths))


def test_why_a_file_cannot_be_written_is_said(path: Path) -> None:
    before = path.read_bytes()
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    larger = xr.DataTree(xr.Dataset({"x": ("t", np.random.default_rng(1).random(20_000))}))
    resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, limits[1]))
    try:
        with pytest.raises(WriteError, match=r"case\.nc: cannot be written: File too large \(0\.4 MB needed\)"):
            save(larger, path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert path.read_bytes() == before
    assert os.listdir(path.parent) == ["case.nc"]


def test_what_is_no_matter_of_space_is_handed_on(tmp_path: Path) -> None:
    def fail(_: str) -> None:
        raise RuntimeError("of another kind")

    with pytest.raises(RuntimeError, match="of another kind"):
        write_whole(tmp_path / "a", fail, 10)
    assert not list(tmp_path.iterdir())


def test_all_damaged_inputs_are_named_and_set_aside(path: Path) -> None:
    other, intact = path.with_name("other.nc"), path.with_name("intact.nc")
    intact.write_bytes(path.read_bytes())
    other.write_bytes(b"")
    os.truncate(path, 100)
    with pytest.raises(InputsError) as stop:
        load_inputs([path, intact, other, path.with_name("gone.nc")])
    lines = str(stop.value).splitlines()
    assert [line.split(":")[0] for line in lines[:3]] == [str(path), str(other), str(path.with_name("gone.nc"))]
    assert lines[3] == "Run snakemake again: it computes them anew."
    assert sorted(os.listdir(path.parent)) == ["case.nc.damaged", "intact.nc", "other.nc.damaged"]
