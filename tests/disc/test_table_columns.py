"""Columns of tables of modes beside those of the package: splits, remarks, damping by other names, and
cells with units."""

import math
from pathlib import Path

import numpy as np
import pytest

from disc_model import Disc
from tests.disc.test_uff import MODES, R_0
from tests.disc.universal import Dialect, halves
from tests.refusals import refusal

HEADS = "diameters,frequency_Hz,amplitude_per_sqrt_kg"
IN_HERTZ = 2 * math.pi  # rad/s


def table(path: Path, *lines: str) -> Disc:
    """The disc of a table of some lines."""
    file = path / "disc.csv"
    file.write_text("\n".join([*lines, ""]))
    return Disc.from_csv(file)


# ---- Splits


@pytest.fixture
def pairs(tmp_path: Path) -> Disc:
    """A disc whose pairs of modes have slightly different halves."""
    shapes = halves(MODES, split=0.004)
    file = Dialect().write(tmp_path / "modes.unv", shapes)
    return Disc.from_uff(file, R_0)


def written_and_read(disc: Disc, folder: Path) -> Disc:
    """A disc as it returns from a table."""
    file = folder / "disc.csv"
    disc.to_csv(file)
    return Disc.from_csv(file)


def splits_of(disc: Disc) -> tuple[float, ...]:
    """The relative distances of the halves of pairs."""
    assert disc.report is not None
    return disc.report.split


def test_splits_are_kept_in_a_table(pairs: Disc, tmp_path: Path) -> None:
    """Both halves of pairs are in the report alone."""
    again = written_and_read(pairs, tmp_path)
    splits = splits_of(pairs)
    assert np.nanmax(splits) == pytest.approx(0.004, rel=0.1)
    assert splits_of(again) == pytest.approx(splits, rel=1e-9, nan_ok=True)
    assert again == pairs


def test_a_split_that_is_no_number_is_refused(tmp_path: Path) -> None:
    with refusal("frequency_split='much': must be a number from 0 to 0.1"):
        table(tmp_path, f"{HEADS},frequency_split", "2,1212,0.54,much")


def test_an_unpaired_mode_has_no_split_in_the_report(tmp_path: Path) -> None:
    file = Dialect().write(tmp_path / "modes.unv", halves(MODES))
    report = Disc.from_uff(file, R_0).report
    assert report is not None
    rows = [line.split() for line in str(report).splitlines()]
    [unpaired] = [row for row in rows if row[0] == "0"]
    assert unpaired[3:6] == ["-", "-", "-"]
    assert math.isnan(report.table["split (%)"][1])


# ---- Remarks


@pytest.mark.parametrize("head", ["comment", "Name", "Remarks"])
def test_columns_for_readers_are_passed_over(head: str, tmp_path: Path) -> None:
    heads = f"{head},{HEADS}"
    disc = table(tmp_path, heads, "first,2,1212,0.54", "second,0,929,0.43")
    assert disc.amplitude == (0.54, 0.43)


# ---- Damping


@pytest.mark.parametrize(
    ("head", "cell", "ratio"),
    [
        ("Q factor", "250", 0.002),
        ("decay rate (1/s)", "15.2304", 15.2304 / (1212 * IN_HERTZ)),
        ("logarithmic decrement", "0.01", 0.01 / math.hypot(math.tau, 0.01)),
        ("damping", "0.1%", 1e-3),
        ("damping_ratio", "0.1 %", 1e-3),
        ("damping in %", "0.1 %", 1e-3),
        ("loss factor", "0.2 %", 1e-3),
    ],
)
def test_damping_is_known_by_other_names(
    head: str, cell: str, ratio: float, tmp_path: Path
) -> None:
    heads = f"{HEADS},{head}"
    disc = table(tmp_path, heads, f"2,1212,0.54,{cell}")
    assert disc.damping_ratio == pytest.approx([ratio])


def test_damping_said_twice_is_refused(tmp_path: Path) -> None:
    with refusal("must not have both damping_ratio and q_factor"):
        table(tmp_path, f"{HEADS},damping,Q", "2,1212,0.54,0.001,500")


def test_a_zero_quality_factor_is_refused(tmp_path: Path) -> None:
    with refusal(r"q_factor=0.*: must be a number > 0 \(mode 1\)"):
        table(tmp_path, f"{HEADS},Q", "2,1212,0.54,0")


# ---- Cells


@pytest.mark.parametrize("head", ["frequency", "frequency_Hz", "frequency (Hz)"])
def test_cells_may_have_units(head: str, tmp_path: Path) -> None:
    heads = f"diameters,{head},modal mass"
    disc = table(tmp_path, heads, "2,1212 Hz,4 kg", "0,929 Hz,1 kg")
    frequencies = [omega / IN_HERTZ for omega in disc.omega]
    assert frequencies == pytest.approx([1212, 929])
    assert disc.amplitude == (0.5, 1.0)


def test_cells_of_another_unit_than_the_head_are_refused(tmp_path: Path) -> None:
    with refusal("frequency_Hz='1.2 kHz': must be a number"):
        table(tmp_path, HEADS, "2,1.2 kHz,0.54")


@pytest.mark.parametrize("known", ["pole", "loss_factor", "shape_at_0.08_m", "q_factor", "comment"])
def test_known_columns_are_all_named(known: str, tmp_path: Path) -> None:
    heads = f"{HEADS},colour"
    with refusal(f"colour.*{known}"):
        table(tmp_path, heads, "2,1212,0.54,red")


def test_a_cell_with_points_and_commas_is_named_once(tmp_path: Path) -> None:
    heads = HEADS.replace(",", ";")
    with refusal(
        "must have commas or points for decimals, and nothing for thousands: not 1.210,5$"
    ):
        table(tmp_path, heads, "2;1.210,5;0,54")


def test_the_report_says_which_columns_were_passed_over(tmp_path: Path) -> None:
    """It said nothing of a column Mode, though it says how each column was understood."""
    heads = "Mode;diameters;frequency_Hz;amplitude_per_sqrt_kg;Remarks"
    disc = table(tmp_path, heads, "1;2;1210;0.5;loud", "2;3;1900;0.4;")
    assert disc.report is not None
    assert disc.report.notes[-2:] == ("'Mode' passed over", "'Remarks' passed over")
    assert "read: 'Mode' passed over" in str(disc.report)
