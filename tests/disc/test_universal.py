"""Normal modes of universal files: a disc whose modes are known, written and read back."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import disc_model as dm
from tests.disc.universal import MODES, write_modes
from tests.refusals import refusal
from tests.test_cli import Command

PLACE: dict[str, Any] = {"axis": (0, 0, 1), "centre": (0, 0, 0), "units": ("m", "N")}
DIGITS = 2e-5  # a file has six
UNITS = {"type": 164, "units_code": 9, "length": 1e3, "force": 1e3, "temp": 1.0, "temp_offset": 0.0}
CYLINDER = {
    "type": 2420, "CS_sys_labels": [7], "CS_types": [1], "CS_names": ["disc"], "CS_matrices": [np.eye(4, 3)],
}  # fmt: skip


def assert_known(disc: dm.Disc, tangential: float = 1.0) -> None:
    """Assert that a disc has the known modes, with tangential amplitudes of this sign."""
    diameters, frequencies, amplitudes, along = (np.array(x) for x in zip(*MODES, strict=True))
    assert disc.diameters == tuple(diameters)
    np.testing.assert_allclose(disc.omega, 2 * np.pi * frequencies, rtol=DIGITS)
    np.testing.assert_allclose(disc.amplitude, amplitudes, rtol=DIGITS)
    np.testing.assert_allclose(disc.damping_ratio, 2e-3, rtol=DIGITS)
    np.testing.assert_allclose(disc.tangential, tangential * along, atol=DIGITS)


@pytest.mark.parametrize("sets", [(15, 55), (2411, 55), (15, 2414), (2411, 2414)])
@pytest.mark.parametrize(
    "written",
    [
        {},
        {"mass": 2.5},
        {"angles": np.array([0, 1.5, 2.5, 4, 5.5, 6.5, 8, 9.5, 11]) * np.pi / 6},
        {"heights": (-0.006, 0.006)},
    ],
    ids=str,
)
def test_known_modes_are_found(
    sets: tuple[int, int], written: dict[str, Any], tmp_path: Path
) -> None:
    """From datasets of each kind, of any modal mass, of nodes at unequal angles, and of two faces."""
    file = write_modes(tmp_path / "modes.unv", sets=sets, **written)
    assert_known(dm.Disc.from_uff(file, "100 mm", **PLACE))


def test_axis_centre_and_units_are_those_given(tmp_path: Path) -> None:
    """Seen from the other side, the same nodes move the other way along the path."""
    file = write_modes(tmp_path / "modes.unv")
    below = PLACE | {"axis": (0, 0, -2), "centre": (0, 0, "300 mm")}
    assert_known(dm.Disc.from_uff(file, 0.1, **below), tangential=-1)
    # mm and mN: kg
    file = write_modes(tmp_path / "mm.unv", size=1e3, first=[UNITS])
    assert_known(dm.Disc.from_uff(file, 0.1, **PLACE | {"units": ("mm", "mN")}))
    # mm and N: t
    modes = [(l, frequency, *(1e3**0.5 * x for x in motion)) for l, frequency, *motion in MODES]
    file = write_modes(tmp_path / "mm.unv", modes, size=1e3, mass=1e-3)
    assert_known(dm.Disc.from_uff(file, 0.1, **PLACE | {"units": ("mm", "N")}))


def test_motion_along_the_axis_alone_gives_no_tangential_amplitudes(tmp_path: Path) -> None:
    modes = [(l, frequency, amplitude, 0.0) for l, frequency, amplitude, _ in MODES]
    file = write_modes(tmp_path / "modes.unv", modes)
    assert dm.Disc.from_uff(file, 0.1, **PLACE).tangential == ()


def test_modes_in_the_plane_are_left_out(tmp_path: Path) -> None:
    file = write_modes(tmp_path / "modes.unv", [*MODES, (2, 1800.0, 0.0, 0.9)])
    assert_known(dm.Disc.from_uff(file, 0.1, **PLACE))


@pytest.mark.parametrize(
    ("written", "given", "words"),
    [
        (
            {"analysis_type": 3, "eig": 1j, "modal_a": 1j, "modal_b": 0j},
            {},
            "datasets='15, 55': must be nodes",
        ),
        ({"spec_data_type": 11}, {}, "datasets='15, 55': must be nodes"),
        ({"modal_m": 0.0}, {}, r"modal mass=0: must be > 0 \(mode at 550\.7.* Hz\)"),
        ({"first": [CYLINDER], "system": 7}, {}, r"coordinate systems=\[1\]: must be Cartesian"),
        ({"first": [UNITS]}, {}, r"units=\('m', 'N'\): dataset 164 has \(1000\.0, 1000\.0\)"),
        (
            {"angles": np.arange(6) * np.pi / 3},
            {},
            r"1919.* Hz': must have half .* 6 nodes tell up to 2",
        ),
        ({"angles": np.arange(9) * np.pi / 9}, {}, "9 leave 200 degrees free"),
        ({"half_apart": 0.0}, {}, "mode='551.* Hz': must not be within 5 % of another"),
        ({"modes": [(2, 1800.0, 0.0, 0.9)]}, {}, "modes=2: must move the slider's circle along"),
        ({"modes": [(0, 900.0, 0.4, 0.0), (0, 910.0, 0.4, 0.0)]}, {}, "no half of a pair"),
        ({}, {"r_0": 0.09}, r"r_0=0\.09: must be a radius of nodes .* nearest are at 0\.[18]"),
        ({}, {"axis": (0, 1, 0)}, r"r_0=0\.1"),
        ({}, {"axis": (0, 0, 0)}, "axis=.*: must not be 0"),
        ({}, {"axis": "z"}, "axis='z': must be"),
        (
            {},
            {"units": ("mm", "kg")},
            r"units=\('mm', 'kg'\): must be units of length and of force",
        ),
        ({}, {"r_0": "10 kg"}, "r_0='10 kg': must be a number in m"),
    ],
)
def test_what_is_no_disc_is_refused_in_one_line(
    written: dict[str, Any], given: dict[str, Any], words: str, tmp_path: Path
) -> None:
    file = write_modes(tmp_path / "modes.unv", **written)
    with refusal(words):
        dm.Disc.from_uff(file, **{"r_0": 0.1} | PLACE | given)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda text: text[:-200], "end=.*: must be a line -1"),
        (
            lambda text: text.replace("E+00", "D+00").replace("e+00", "D+00"),
            "dataset .* cannot be read",
        ),
        (lambda _: "diameters,frequency_Hz\n1,2\n", "end=.*: must be a line -1"),
        (lambda _: "    -1\n", "datasets='': must be nodes"),
    ],
)
def test_a_file_that_cannot_be_read_is_refused(change: Any, words: str, tmp_path: Path) -> None:
    file = write_modes(tmp_path / "modes.unv")
    file.write_text(change(file.read_text()))
    with refusal(rf"modes\.unv.*{words}"):
        dm.Disc.from_uff(file, 0.1, **PLACE)


def test_the_command_line_makes_a_table_of_a_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = write_modes(tmp_path / "modes.unv")
    table = tmp_path / "disc.csv"
    place = ("--axis", "0,0,1", "--centre", "0,0,0", "--units", "m,N")
    command = Command(capsys)
    shown = command.out("modes", "r_0=0.1", "--from", str(file), *place, "--save", str(table))
    assert "Disc alone" in shown
    assert_known(dm.Disc.from_csv(table))
    said = command.error("modes", "r_0=0.1", "--from", str(file), *place[:-2])
    assert "units" in said
