"""Tables with both halves of pairs of modes, and what a report of them says."""

import math
from pathlib import Path
from typing import Literal

import pytest

import disc_model as dm
from tests.refusals import refusal

HEADS = "diameters,frequency_Hz,amplitude_per_sqrt_kg"
AMPLITUDE = 0.543  # kg^-1/2, at an antinode


def read(folder: Path, text: str, pairs: Literal["given", "mean", "test"] = "given") -> dm.Disc:
    """The disc of the text of a table."""
    file = folder / "disc.csv"
    file.write_text(text)
    return dm.Disc.from_csv(file, pairs=pairs)


def of_test(degrees: float) -> str:
    """A table of the two halves of a pair at a point some degrees of the wave from an antinode."""
    angle = math.radians(degrees)
    first = AMPLITUDE * math.cos(angle)
    second = -AMPLITUDE * math.sin(angle)
    heads = f"{HEADS},shape_at_0.08_m,shape_at_0.1_m"
    rows = []
    for frequency, amplitude in ((1212, first), (1220, second)):
        rows.append(f"2,{frequency},{amplitude},{-amplitude / 2},{amplitude}")
    return "\n".join([heads, *rows, ""])


@pytest.mark.parametrize("degrees", [0, 20, 45, 80])
def test_halves_at_one_point_give_the_amplitude_at_an_antinode(
    degrees: float, tmp_path: Path
) -> None:
    """Their mean lost up to 29 % of it, without a word."""
    disc = read(tmp_path, of_test(degrees), pairs="test")
    assert disc.amplitude == pytest.approx([AMPLITUDE])
    assert disc.shapes[0] == pytest.approx([-AMPLITUDE / 2, AMPLITUDE])
    assert disc.omega == pytest.approx([2 * math.pi * 1216])
    assert "roots of the sums of squares" in str(disc.report)


def test_a_report_says_that_amplitudes_are_means(tmp_path: Path) -> None:
    disc = read(tmp_path, of_test(45), pairs="mean")
    assert disc.amplitude == pytest.approx([AMPLITUDE / math.sqrt(2)])
    assert "means of their halves; if both were measured at one point" in str(disc.report)


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
def test_tangential_motion_of_halves_at_one_point_is_refused(tmp_path: Path) -> None:
    text = f"{HEADS},tangential_per_sqrt_kg\n2,1212,0.384,-0.1\n2,1220,0.384,-0.1\n"
    with refusal(r"tangential=-0\.1: must be 0 with pairs='test'"):
        read(tmp_path, text, pairs="test")


# ---- Reports of tables that were written


def test_a_report_of_a_written_table_does_not_invent_zeros(tmp_path: Path) -> None:
    """The split of amplitudes became 0, and the doubt of it was gone."""
    text = f"{HEADS},damping_ratio\n2,1212,0.3,0.001\n2,1220,0.6,0.0012\n"
    with pytest.warns(dm.ImplausibleValue, match="67 % apart"):
        disc = read(tmp_path, text, pairs="mean")
    file = tmp_path / "again.csv"
    disc.to_csv(file)
    with pytest.warns(dm.ImplausibleValue, match="67 % apart"):
        again = dm.Disc.from_csv(file)
    assert again.report is not None
    assert disc.report is not None
    assert again.report.doubts == disc.report.doubts
    assert math.isnan(again.report.modes[0].amplitude_split)
    assert math.isnan(again.report.modes[0].damping_split)
    assert again.report.split == pytest.approx(disc.report.split)


def test_a_split_of_a_mode_without_nodal_diameters_is_refused(tmp_path: Path) -> None:
    text = f"{HEADS},frequency_split\n0,551,0.556,0.004\n"
    with refusal(r"frequency_split=0\.004: must be 0 for a mode without nodal diameters"):
        read(tmp_path, text)
