"""The script that cleans up results, on files of every kind."""

import io
import os
import runpy
import time
from pathlib import Path

import pytest
import xarray as xr

from disc_model.data.dataset import save
from tests.processes import ROOT

SCRIPT = ROOT / "workflow" / "scripts" / "check.py"
TOMORROW = time.time() + 86400


def put_tomorrow(path: Path) -> None:
    """Give a file, or a symbolic link itself, a time in the future."""
    os.utime(path, (TOMORROW, TOMORROW), follow_symlinks=not path.is_symlink())


def test_links_are_not_followed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A link to nothing ended the check, and times of files outside of the results were set."""
    results = tmp_path / "results"
    outside = tmp_path / "outside"
    for folder in (results / "s", outside):
        folder.mkdir(parents=True)
    good = results / "s" / "good.nc"
    save(xr.DataTree(xr.Dataset({"x": 1.0})), good)
    damaged = outside / "damaged.nc"
    damaged.write_bytes(b"no netCDF file")
    (outside / "late.txt").write_text("")
    (results / "s" / ".x.nc.1.tmp").write_text("left by a killed job")
    file = tmp_path / "missing"
    links = {
        "nowhere": file,
        "nowhere.nc": file,
        "damaged.nc": damaged,
        "late.txt": outside / "late.txt",
        "outside": outside,
    }
    for name, target in links.items():
        (results / name).symlink_to(target)
    for path in (good, outside / "late.txt", results / "late.txt", results / "nowhere"):
        put_tomorrow(path)
    monkeypatch.setattr("sys.stdin", io.StringIO('["results/s/unknown.nc"]'))
    monkeypatch.setattr("sys.argv", [str(SCRIPT)])
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(SCRIPT), run_name="__main__")
    shown = capsys.readouterr().out
    assert "results/nowhere.nc: there is no such file; removed" in shown
    assert "results/damaged.nc: cannot be read" in shown
    assert "3 datasets, 2 damaged; 1 left-overs" in shown
    assert "3 files had times in the future" in shown
    left = {str(path.relative_to(results)) for path in results.rglob("*")}
    assert left == {"s", "s/good.nc", "nowhere", "late.txt", "outside"}
    assert damaged.exists()
    assert (outside / "late.txt").stat().st_mtime == pytest.approx(TOMORROW)
    now = time.time()
    assert all((results / name).lstat().st_mtime <= now for name in left)
