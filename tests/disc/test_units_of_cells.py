"""Tables whose cells have units, each its own."""

import math
from pathlib import Path

import pytest

import disc_model as dm
from tests.refusals import refusal


def read(folder: Path, *lines: str) -> dm.Disc:
    """The disc of a table of some lines."""
    file = folder / "disc.csv"
    file.write_text("\n".join([*lines, ""]))
    return dm.Disc.from_csv(file)


def test_each_cell_may_have_a_unit_of_its_own(tmp_path: Path) -> None:
    """Cells in Hz and in kHz were refused: "must give its unit"."""
    heads = "diameters,frequency,amplitude (kg^-1/2)"
    disc = read(tmp_path, heads, "0,929 Hz,0.431", "1,0.551 kHz,0.556", "2,7615 rad/s,0.543")
    frequencies = [omega / math.tau for omega in disc.omega]
    assert frequencies == pytest.approx([929, 551, 7615 / math.tau])


@pytest.mark.parametrize("head", ["damping_ratio", "damping", "zeta"])
def test_a_ratio_may_be_beside_one_in_per_cent(head: str, tmp_path: Path) -> None:
    heads = f"diameters,frequency_Hz,amplitude_per_sqrt_kg,{head}"
    disc = read(tmp_path, heads, "0,929,0.431,0.002", "1,551,0.556,0.1 %", "2,1212,0.5,0.3%")
    assert disc.damping_ratio == pytest.approx([0.002, 0.001, 0.003])


def test_a_cell_may_repeat_the_unit_of_its_head(tmp_path: Path) -> None:
    heads = "diameters,frequency_Hz,amplitude_per_sqrt_kg"
    disc = read(tmp_path, heads, "0,929,0.431", "1,551 Hz,0.556")
    assert [omega / math.tau for omega in disc.omega] == pytest.approx([929, 551])


def test_a_cell_without_any_unit_is_refused(tmp_path: Path) -> None:
    heads = "diameters,frequency,amplitude (kg^-1/2)"
    with refusal("columns='frequency': must give its unit"):
        read(tmp_path, heads, "0,929 Hz,0.431", "1,551,0.556")
