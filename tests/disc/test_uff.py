"""Mode shapes of universal files: a disc whose modes are known, written in many dialects and read
back."""

import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import disc_model as dm
from disc_model.disc.plate import mode_shapes
from tests import needs
from tests.disc.bricks import Ring, brick_modes, export
from tests.disc.universal import END, MODES, R_0, RADII, Dialect, Half, begin, halves, whole
from tests.refusals import refusal
from tests.test_cli import Command

RECORDS = ((55, 15), (55, 2411), (2414, 15), (2414, 2411))
DIGITS = 2e-5  # a file has six digits, and its coordinates as well


def read(path: Path, dialect: Dialect, modes: Sequence[Half] = (), **how: Any) -> dm.Disc:
    """The disc of a file in a dialect."""
    file = dialect.write(path / "modes.unv", modes or halves(MODES))
    return dm.Disc.from_uff(file, **{"r_0": R_0} | how)


def assert_right(disc: dm.Disc, tangential: bool = True) -> None:
    """That a disc has the known modes."""
    diameters, frequencies, amplitudes, along = zip(*MODES, strict=True)
    assert disc.diameters == diameters
    omega = np.array(frequencies) * (2 * np.pi)
    np.testing.assert_allclose(disc.omega, omega, rtol=DIGITS)
    np.testing.assert_allclose(disc.amplitude, amplitudes, rtol=DIGITS)
    np.testing.assert_allclose(disc.damping_ratio, 2e-3, rtol=DIGITS)
    np.testing.assert_allclose(disc.radii, RADII, rtol=DIGITS)
    growth = (np.array(RADII) / R_0) ** 2
    shapes = np.outer(amplitudes, growth)
    tolerance = 5 * DIGITS
    np.testing.assert_allclose(disc.shapes, shapes, rtol=tolerance)
    if tangential:
        np.testing.assert_allclose(disc.tangential, along, atol=DIGITS)
    else:
        assert disc.tangential == ()


@pytest.fixture(autouse=True)
def _strict() -> Any:
    """A warning that no test expects is an error."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", dm.ImplausibleValue)
        yield


@pytest.mark.parametrize(("results", "nodes"), RECORDS)
@pytest.mark.parametrize(
    "change",
    [
        {},
        {"exponent": "D"},
        {"values": 6},
        {"newline": "\r\n"},
        {"hysteretic": True},
        {"scale": 2.5},
        {"order": 1, "scale": 1.7},
        {"order": 2},
        {"complex": 3, "order": 1, "scale": np.exp(0.4j)},
        {"complex": 3, "order": 2},
        {"complex": 3, "values": 6, "scale": 3 * np.exp(2j)},
        {"complex": 3, "exponent": "D", "modal_b": True, "scale": 6.2831},
        {"heights": (-0.006, 0.006)},
    ],
    ids=str,
)
def test_every_dialect_gives_the_same_disc(
    results: int, nodes: int, change: dict[str, Any], tmp_path: Path
) -> None:
    dialect = Dialect(results=results, nodes=nodes, **change)
    disc = read(tmp_path, dialect)
    assert_right(disc)


@pytest.mark.parametrize("results", [55, 2414])
@pytest.mark.parametrize("analysis", [3, 7])
@pytest.mark.parametrize("phase", [0.0, 0.5, np.pi / 3, np.pi / 2, np.pi, -2.0])
def test_the_scale_of_a_complex_mode_does_not_matter(
    results: int, analysis: int, phase: float, tmp_path: Path
) -> None:
    """The receptance is the same in all of them; unit modal A is the phase of -90 degrees."""
    for size in (1.0, 1e-5):
        scale = size * np.exp(1j * phase)
        dialect = Dialect(results=results, complex=analysis, scale=scale)
        assert_right(read(tmp_path, dialect))


def test_a_modal_mass_in_the_place_of_modal_a_is_noticed(tmp_path: Path) -> None:
    """Dataset 2414 has it there for equations of the second order; the shapes are then in phase."""
    for phase in (0.0, 1.0):
        scale = 2 * np.exp(1j * phase)
        dialect = Dialect(results=2414, complex=7, mass=True, scale=scale)
        assert_right(read(tmp_path, dialect))


@pytest.mark.parametrize(
    ("length", "force"), [(1e3, 1e3), (1e3, 1.0), (39.37007874, 0.2248089431), (1.0, 1e-3)]
)
@pytest.mark.parametrize("analysis", [0, 3])
def test_units_are_those_of_the_file(
    length: float, force: float, analysis: int, tmp_path: Path
) -> None:
    dialect = Dialect(length=length, force=force, units=True, complex=analysis)
    assert_right(read(tmp_path, dialect, r_0="100 mm"))


def test_a_code_of_units_stands_for_its_factors(tmp_path: Path) -> None:
    """Millimetres and milli-newtons, code 5, in a file that leaves the factors out."""
    path = tmp_path / "modes.unv"
    file = Dialect(length=1e3, force=1e3).write(path, halves(MODES))
    text = file.read_text()
    name = "mm (milli-newton)   "
    unit = whole(5) + name + whole(2)
    lines = [*begin(164), unit, END, ""]
    millimetres = "\n".join(lines)
    file.write_text(millimetres + text)
    assert_right(dm.Disc.from_uff(file, R_0))
    metres = millimetres.replace("         5mm", "         1mm")
    file.write_text(metres + millimetres + text)
    with refusal("must have one system of units"):
        dm.Disc.from_uff(file, R_0)
    file.write_text(millimetres.replace("         5mm", "        77mm") + text)
    with refusal("must have the factors of its units, or a code"):
        dm.Disc.from_uff(file, R_0)


def test_units_may_be_stated_where_the_file_has_none(tmp_path: Path) -> None:
    dialect = Dialect(length=1e3, force=1.0)
    assert_right(read(tmp_path, dialect, units=("mm", "N")))
    hint = r'nodes at 80, 100, 130 m.*; give units=\("mm", "N"\) if the file is in mm$'
    with refusal(hint):
        read(tmp_path, dialect)
    rule = "units=.*: must be left out: the file states its units in dataset 164"
    with refusal(rule):
        read(tmp_path, Dialect(units=True), units=("mm", "N"))


@pytest.mark.parametrize(
    "axis", [(1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, -1), (1, -2, 3)], ids=str
)
@pytest.mark.parametrize("centre", [(0, 0, 0), (0.001, -0.002, 0), (0.1, 0.2, -0.3)], ids=str)
def test_axis_and_centre_are_found_or_given(
    axis: tuple[float, ...], centre: tuple[float, ...], tmp_path: Path
) -> None:
    dialect = Dialect(axis=axis, centre=centre, nodes=2411)
    assert_right(read(tmp_path, dialect))
    assert_right(read(tmp_path, dialect, axis=axis, centre=centre))
    in_words = [f"{1e3 * x} mm" for x in centre]
    disc = read(tmp_path, dialect, centre=in_words)
    assert_right(disc)
    by_word = {(1, 0, 0): "x", (0, 1, 0): "y", (0, -1, 0): "-Y", (0, 0, -1): "-z"}
    if axis in by_word:
        assert_right(read(tmp_path, dialect, axis=by_word[axis]))


def test_the_axis_points_to_the_face_under_the_slider(tmp_path: Path) -> None:
    """Both faces of a plate move alike, seen from outside."""
    both = Dialect(heights=(-0.006, 0.006))
    assert_right(read(tmp_path, both, axis="-z"))
    assert "height 0.006 m" in str(read(tmp_path, both, axis="-z").report)
    one = Dialect(axis=(0, 0, -1))
    with pytest.warns(dm.ImplausibleValue, match="moves as that of a face away from the slider"):
        disc = read(tmp_path, one, axis="z")
    tangential = MODES[0][3]
    assert disc.tangential[0] == pytest.approx(-tangential, rel=DIGITS)


@pytest.mark.parametrize("arc", [1.5 * np.pi, np.pi])
def test_nodes_on_part_of_the_circle_suffice(arc: float, tmp_path: Path) -> None:
    centre = (0.03, -0.01, 0)
    dialect = Dialect(arc=arc, centre=centre)
    disc = read(tmp_path, dialect)
    assert_right(disc)


def test_displacements_in_cylindrical_systems_are_turned(tmp_path: Path) -> None:
    """Whether displacements are global, as the format has them, or in the systems of nodes, is
    decided by what makes waves of them."""
    for axis in ((0, 0, 1), (1, 0, 0), (1, 2, -3)):
        centre = (0.1, 0, 0.2)
        dialect = Dialect(local=True, axis=axis, centre=centre, units=True, length=1e3)
        disc = read(tmp_path, dialect)
        assert_right(disc)
        assert "displacements in systems of nodes" in str(disc.report)
    plain = Dialect(extra=Dialect(local=True).system_lines())
    assert_right(read(tmp_path, plain))


@pytest.mark.parametrize("number", [18, 2420])
def test_nodes_in_systems_of_definition_are_placed(number: int, tmp_path: Path) -> None:
    """Dataset 15 has coordinates in them: here cylindrical, with angles in degrees."""
    dialect = Dialect(axial_only=True)
    path = tmp_path / "modes.unv"
    file = dialect.write(path, halves(MODES))
    r, angle, height = dialect.grid()
    nodes = begin(15)
    for i, place in enumerate(zip(r, np.degrees(angle), height, strict=True), 1):
        nodes.append(whole(i, 5, 0, 8) + dialect.real(*place))
    system = [*begin(18), whole(5, 1, 0, 8, 1), "disc"]
    system += [dialect.real(0, 0, 0, 2, 0, 0), dialect.real(1, 0, 1)]
    if number == 2420:
        axes = np.eye(3)
        origin = np.zeros(3)
        rows = [dialect.real(*row, width=25, digits=16) for row in [*axes, origin]]
        system = [*begin(2420), whole(1), "Part", whole(5, 1, 8), "disc", *rows]
    old = "\n".join(dialect.node_lines(r, angle, height))
    text = file.read_text().replace(old, "\n".join([*system, END, *nodes, END]))
    file.write_text(text)
    assert_right(dm.Disc.from_uff(file, R_0), tangential=False)


def test_only_modes_of_displacement_are_taken_and_the_rest_is_counted(tmp_path: Path) -> None:
    """Stress, scalars, values on elements, and other analyses beside the modes."""
    dialect = Dialect()
    motion = np.full((4, 3), 0.7)
    extra: list[str] = []
    changes = {
        (1, 2, 4, 2, 2, 6): "stress of a normal mode",
        (1, 2, 1, 8, 2, 1): "normal mode without three displacements a node",
        (1, 1, 2, 8, 2, 3): "static analysis",
        (1, 4, 2, 8, 2, 3): "transient analysis",
        (1, 5, 2, 8, 5, 3): "frequency response or deflection shape",
        (1, 6, 2, 8, 2, 3): "buckling",
        (1, 0, 2, 8, 2, 3): "unknown analysis",
    }
    for head in changes:
        lines = dialect.mode_lines(1, halves(MODES)[0], motion)
        lines[7] = whole(*head)
        extra += lines
    on_elements = Dialect(results=2414).mode_lines(1, halves(MODES)[0], motion)
    on_elements[4] = whole(2)
    rigid = dialect.mode_lines(1, Half(0, 0.0, 0.0, 1.0, 0.0), motion)
    disc = read(tmp_path, Dialect(extra=[*extra, *on_elements, *rigid]))
    assert_right(disc)
    assert disc.report is not None
    assert disc.report.left_out == {
        **dict.fromkeys(changes.values(), 1),
        "normal mode on elements": 1,
        "mode at 0 Hz or without oscillation": 1,
    }


@pytest.mark.parametrize("size", [0.0, 1e-4])
def test_modes_in_the_plane_are_left_out(size: float, tmp_path: Path) -> None:
    """A pair of them, whose normal motion is nothing or next to nothing."""
    pair = halves([(2, 1800.0, size, 0.9)], split=5e-4)
    disc = read(tmp_path, Dialect(), [*halves(MODES), *pair])
    assert_right(disc)
    assert disc.report is not None
    assert disc.report.left_out == {"mode in the plane of the disc": 2}


def test_motion_that_follows_no_diameters_is_left_out(tmp_path: Path) -> None:
    noise = np.random.default_rng(1).standard_normal((72, 3)) * 1e-6
    half = Half(0, 5000.0, 0.0, 1.0, 0.0)
    across = noise * [0, 0, 1]
    lines = Dialect().mode_lines(9, half, across)
    disc = read(tmp_path, Dialect(axial_only=True, extra=lines))
    assert_right(disc, tangential=False)
    assert disc.report is not None
    assert sum(disc.report.left_out.values()) == 1


def test_a_mode_that_is_there_several_times_is_one(tmp_path: Path) -> None:
    """As conjugate modes, for several references, and in other combinations of both halves."""
    known = halves(MODES)
    dialect = Dialect(complex=3)
    twice = [*known, *known]
    disc = read(tmp_path, dialect, twice)
    assert_right(disc)
    lines = Dialect(complex=3, conjugate=True).all_mode_lines(known)
    assert_right(read(tmp_path, Dialect(complex=3, extra=lines)))
    turned = [
        Half(**{**vars(half), "turn": half.turn + 0.6 * (half.diameters > 0)}) for half in known
    ]
    disc = read(tmp_path, Dialect(), [*known, *turned])
    assert_right(disc)
    assert disc.report is not None
    shapes = [mode.shapes for mode in disc.report.modes]
    assert shapes == [4, 2, 4, 4]


def test_the_split_of_a_pair_is_reported(tmp_path: Path) -> None:
    disc = read(tmp_path, Dialect(), halves(MODES, split=0.03))
    assert_right(disc)
    assert disc.report is not None
    split = [0.03, 0, 0.03, 0.03]
    np.testing.assert_allclose(disc.report.split, split, rtol=1e-3)
    with pytest.warns(dm.ImplausibleValue, match=r"modes of 2 nodal diameters .* kept as two"):
        apart = read(tmp_path, Dialect(), halves(MODES[1:3], split=0.06))
    assert apart.diameters == (0, 2, 2)


def shapes_of_two(frequencies: Sequence[float], degrees: Sequence[float]) -> list[Half]:
    """Shapes of two nodal diameters, with the angles of their antinodes."""
    found = []
    for frequency, angle in zip(frequencies, degrees, strict=True):
        turn = 2 * np.radians(angle)
        found.append(Half(2, 2 * np.pi * frequency, 2e-3, 0.54, -0.13, turn=turn))
    return found


@pytest.mark.parametrize("apart", [0, 15, 30])
def test_antinodes_of_a_pair_lie_between_each_other(apart: float, tmp_path: Path) -> None:
    """Those of two nodal diameters are 45 degrees apart, give or take what a test may miss."""
    phrase = f"antinodes are {apart} degrees apart: those of the halves of one pair are 45 degrees"
    with pytest.warns(dm.ImplausibleValue, match=phrase):
        disc = read(tmp_path, Dialect(), shapes_of_two((1210, 1214), (10, 10 + apart)))
    assert disc.report is not None
    assert len(disc.report.doubts) == 1
    right = read(tmp_path, Dialect(), shapes_of_two((1210, 1214), (10, 60)))
    assert right.report is not None
    assert right.report.doubts == ()


def test_shapes_of_one_orientation_that_are_kept_as_two_are_told(tmp_path: Path) -> None:
    with pytest.warns(dm.ImplausibleValue, match=r"1250 Hz are kept as two, and their antinodes"):
        disc = read(tmp_path, Dialect(), shapes_of_two((1210, 1250), (10, 10)))
    assert disc.diameters == (2, 2)


@pytest.mark.parametrize(
    "frequencies", [(1210, 1213, 1217), (1210, 1240, 1241), (1210, 1211, 1240)]
)
def test_three_shapes_of_equal_diameters_are_told(
    frequencies: tuple[float, ...], tmp_path: Path
) -> None:
    first, second, third = frequencies
    phrase = f"3 shapes of 2 nodal diameters at {first}, {second} and {third} Hz are within 5 %"
    with pytest.warns(dm.ImplausibleValue, match=phrase):
        disc = read(tmp_path, Dialect(), shapes_of_two(frequencies, (10, 55, 30)))
    assert disc.report is not None
    assert phrase in " ".join(disc.report.doubts)


def test_modes_without_diameters_are_no_pair(tmp_path: Path) -> None:
    twice = [Half(0, 2 * np.pi * frequency, 2e-3, 0.43, 0.0, turn=0.0) for frequency in (929, 933)]
    with pytest.warns(dm.ImplausibleValue, match="2 shapes of 0 nodal diameters at 929 and 933 Hz"):
        read(tmp_path, Dialect(), twice)


def test_measured_functions_are_named_where_a_file_has_no_modes(tmp_path: Path) -> None:
    file = Dialect(extra=[*begin(58), "NONE", END]).write(tmp_path / "frf.unv", [])
    with refusal("dataset 58 has measured functions, such as frequency responses, and is not read"):
        dm.Disc.from_uff(file, R_0)


def test_poles_in_hertz_are_noticed(tmp_path: Path) -> None:
    """By modal B, by frequencies in the texts, or by modal masses of 2 pi."""
    ways: list[dict[str, Any]] = [
        {},
        {"scale": 1.7, "modal_b": True},
        {"scale": 1.7, "texts": "Mode, Frequency: {pole:.3f} Hz"},
    ]
    for way in ways:
        dialect = Dialect(complex=3, in_hertz=True, **way)
        with pytest.warns(dm.ImplausibleValue, match="are taken to be in Hz"):
            disc = read(tmp_path, dialect)
        assert_right(disc)
    two_pi = {"complex": 3, "scale": 2 * np.pi}
    assert_right(read(tmp_path, Dialect(**two_pi, modal_b=True)))
    assert_right(read(tmp_path, Dialect(complex=3, texts="F = {pole:.2f} rad/s")))


def test_shapes_without_a_scale_are_refused_or_taken_as_normalised(tmp_path: Path) -> None:
    for analysis, name in ((0, "modal mass=0: must be > 0"), (3, "modal A=0: must not be 0")):
        dialect = Dialect(complex=analysis, stated=False)
        with refusal(rf"{name} .*modal_mass=1"):
            read(tmp_path, dialect)
        assert_right(read(tmp_path, dialect, modal_mass=1))
        assert_right(read(tmp_path, Dialect(complex=analysis), modal_mass=7))


def test_shapes_that_are_not_in_phase_are_left_out(tmp_path: Path) -> None:
    """A modal A of the wrong sign would mean a negative modal mass; a phase of 0.3 rad is that of a
    slightly complex mode, and the report has it."""
    with refusal(r"7 x mode whose motion is not in phase by its modal A"):
        read(tmp_path, Dialect(complex=3, turned_by=np.pi / 2))
    disc = read(tmp_path, Dialect(complex=3, turned_by=0.3))
    np.testing.assert_allclose(
        disc.amplitude, np.cos(0.3) * np.array([m[2] for m in MODES]), rtol=DIGITS
    )
    assert disc.report is not None
    np.testing.assert_allclose(
        [m.in_phase for m in disc.report.modes], np.cos(0.3) ** 2, rtol=DIGITS
    )


def test_a_disc_that_grows_by_itself_is_refused(tmp_path: Path) -> None:
    for analysis in (0, 3):
        dialect = Dialect(complex=analysis)
        with refusal(r"has a pole with a positive real part, the mode at"):
            read(tmp_path, dialect, halves(MODES, damping=-1e-3))


def test_nodes_that_are_too_few_are_told(tmp_path: Path) -> None:
    """Six nodes cannot have three nodal diameters."""
    with pytest.warns(dm.ImplausibleValue, match=r"modes at 1919, 1921 Hz, .* are left out"):
        disc = read(tmp_path, Dialect(angles=6))
    assert disc.diameters == (1, 0, 2)
    known = halves(MODES[:3])
    with pytest.warns(dm.ImplausibleValue, match=r"modes of more may be taken for modes of fewer"):
        read(tmp_path, Dialect(angles=6), known)


@pytest.mark.parametrize(
    ("change", "how", "phrase"),
    [
        ({"arc": np.pi / 2}, {}, "has 24 on 86 degrees of it (axis z through (0, 0, 0) m)"),
        ({}, {"r_0": 0.09}, "at r_0=0.09 m. Around the axis z through (0, 0, 0) m there are nodes"),
        ({}, {"r_0": 0.09}, "nodes at 0.08, 0.1, 0.13 m. The file has datasets 15, 55 (7)"),
        ({}, {"axis": "x"}, "Around the axis x through (0, 0, 0) m"),
        ({}, {"axis": "w"}, "axis='w': must be"),
        ({}, {"axis": (0, 0, 0)}, "axis=(0, 0, 0): must be"),
        ({}, {"axis": (1, 2)}, "axis=(1, 2): must be"),
        ({}, {"centre": (1, 2)}, "centre=(1, 2): must be three numbers"),
        ({}, {"units": ("mm", "kg")}, "units=('mm', 'kg'): must be units of length and of force"),
        ({}, {"modal_mass": -1}, "modal_mass=-1: must be > 0"),
        ({}, {"r_0": None}, "r_0=None: must be a number"),
        ({}, {"r_0": [0.1]}, "r_0=[0.1]: must be a number"),
        ({}, {"r_0": "10 kg"}, "r_0='10 kg': must be a number in m"),
        ({}, {"r_0": float("nan")}, "r_0=nan: must be"),
        ({}, {"r_0": -0.1}, "r_0=-0.1: must be > 0"),
    ],
)
def test_what_cannot_be_read_is_said_in_one_line(
    change: dict[str, Any], how: dict[str, Any], phrase: str, tmp_path: Path
) -> None:
    with pytest.raises(dm.ParameterError) as error:
        read(tmp_path, Dialect(**change), **how)
    assert phrase in str(error.value)
    assert "\n" not in str(error.value)
    assert len(error.value.faults) == 1


def damaged(path: Path, place: int, change: Callable[[list[str]], None]) -> Path:
    """A file in which the lines of one dataset are changed."""
    dialect = Dialect()
    lines = dialect.all_mode_lines(halves(MODES)[:1])
    nodes = dialect.node_lines(*dialect.grid())
    change((nodes, lines)[place])
    path.write_text("\n".join([*nodes, *lines, ""]))
    return path


def replaced(i: int, text: str) -> Callable[[list[str]], None]:
    """A change of line `i` of a dataset, counted from the mark at its beginning."""

    def change(lines: list[str]) -> None:
        lines[i] = text

    return change


@pytest.mark.parametrize(
    ("place", "change", "phrase"),
    [
        (1, replaced(9, "  ***********  1.00000E+00"), "numbers only in record 8, and not '***"),
        (1, replaced(9, "          NaN  1.00000E+00"), "numbers only in record 8, and not 'NaN'"),
        (1, replaced(8, "         2"), "must have 2 numbers in record 7, and not 1"),
        (1, replaced(7, "         1         2"), "must have 6 numbers in record 6, and not 2"),
        (1, replaced(11, "  0.00000E+00  1.00000E+00"), "must have a number and 3 values for each node"),
        (1, replaced(11, "  0.0  0.0  nan"), "must have a whole number and 3 finite values"),
        (1, replaced(11, "  0.0  0.0  ***"), "must have numbers only in its records, and not '***'"),
        (1, replaced(10, "       1.5"), "must have a whole number and 3 finite values"),
        (1, list.pop, "dataset 55 (no. 2 of the file) must end with a line -1: the file is cut off"),
        (0, list.pop, "dataset 15 (no. 1 of the file) must have a line -1 at its end"),
        (0, replaced(2, "         1         0"), "must have seven numbers for each node"),
        (0, replaced(2, "         1         0         0         8  inf  0.0  0.0"), "finite coordinates"),
    ],
)  # fmt: skip
def test_damaged_records_are_named(
    place: int, change: Callable[[list[str]], None], phrase: str, tmp_path: Path
) -> None:
    path = tmp_path / "m.unv"
    with pytest.raises(dm.ParameterError) as error:
        dm.Disc.from_uff(damaged(path, place, change), R_0)
    assert phrase in str(error.value)
    assert str(error.value).startswith("m.unv: ")


def test_numbers_that_touch_are_read(tmp_path: Path) -> None:
    """Fields of fixed width need no blanks between them, and exponents of three digits have no
    letter."""
    path = tmp_path / "modes.unv"
    file = Dialect(axial_only=True).write(path, halves(MODES))
    lines = file.read_text().splitlines()
    text = "\n".join(
        line.replace("  0.00000E+00  0.00000E+00", "-1.000000E-25 -1.00000-101") for line in lines
    )
    file.write_text(text + "\n")
    assert_right(dm.Disc.from_uff(file, R_0), tangential=False)


@pytest.mark.parametrize(
    "content", [b"", b"a text", bytes(range(256)), b"    -1\n    -1\n", b"    -1\n    55\n    -1\n"]
)
def test_what_is_no_universal_file_is_refused(content: bytes, tmp_path: Path) -> None:
    x_path = tmp_path / "x.uff"
    x_path.write_bytes(content)
    with refusal(r"x\.uff: "):
        dm.Disc.from_uff(x_path, R_0)
    none_path = tmp_path / "none.uff"
    with refusal(r"must be a universal file that can be read"):
        dm.Disc.from_uff(none_path, R_0)


def test_a_comment_between_datasets_and_bytes_of_measurements_are_passed_over(
    tmp_path: Path,
) -> None:
    """A dataset 58b may hold bytes that look like the mark of an end."""
    head = "    58b     1     2          11        40     0     0           0           0"
    mark = "\n    -1\n    55\n"
    padding = "x" * (40 - len(mark))
    data = mark + padding + END
    unused = ["NONE"] * 11
    binary = [END, head, *unused, data]
    disc = read(tmp_path, Dialect(extra=["1 comment", *binary, "another", ""]))
    assert_right(disc)


def test_the_command_line_reads_universal_files(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """It says what was used and left out, and writes the table that studies read."""
    monkeypatch.setenv("COLUMNS", "80")
    command = Command(capsys)
    dialect = Dialect(axis=(0, 1, 0))
    mode = (2, 1800.0, 0.0, 0.9)
    extra = dialect.all_mode_lines(halves([mode]))
    dialect = Dialect(axis=(0, 1, 0), extra=extra)
    path = tmp_path / "modes.unv"
    file = dialect.write(path, halves(MODES))
    table = tmp_path / "disc.csv"
    options = ("--r-0", "100 mm", "--axis", "y", "--centre", "0,0,0", "--save", str(table))
    shown = command.out("modes", "--from", str(file), *options)
    assert "axis of the disc, towards the slider: y through (0, 0, 0) m" in shown
    assert "2 x mode in the plane of the disc" in shown
    for head in ("amplitude", "(kg^-1/2)", "tangent.", "damping", "split", "(rad/s)"):
        assert head in shown
    assert "…" not in shown
    assert_right(dm.Disc.from_csv(table))
    out = command.out("modes", "--from", str(table), "--r-0", "0.1")
    assert out.count("-0.27") == 1 + 1  # of the mode, and the least of its column

    said = command.error("modes", "--from", str(file), "--r-0", "0.09")
    assert said.startswith(
        "error: modes.unv: must have 3 or more nodes at r_0=0.09 m. Around the axis y"
    )
    assert "r_0: is required" in command.error("modes", "--from", str(file))
    both = command.error("modes", "--from", str(file), "--disc", str(table), "--r-0", "0.1")
    assert "disc: must be left out: --from gives the disc" in both
    dialect = Dialect(axis=(0, -1, 0), length=1e3)
    path = tmp_path / "mm.unv"
    turned = dialect.write(path, halves(MODES))
    units = ("--r-0", "0.1", "--axis", "-y", "--units", "mm,N", "--modal-mass", "1")
    assert "-y through (0, 0, 0) m" in command.out("modes", "--from", str(turned), *units)
    assert "axis='w': must be" in command.error(
        "modes", "--from", str(file), "--r-0", "0.1", "--axis", "w"
    )
    assert "save: needs the disc of a file" in command.run("modes", "--save", str(table))[2]
    none_path = tmp_path / "none.uff"
    assert "none.uff" in command.error("modes", "--from", str(none_path), "--r-0", "0.1")


def test_the_command_line_warns_of_doubts(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "six.unv"
    file = Dialect(angles=6).write(path, halves(MODES))
    command = Command(capsys)
    with pytest.warns(dm.ImplausibleValue, match="^6 nodes on the circle tell modes of up to 2"):
        code, shown, _ = command.run("modes", "--from", str(file), "--r-0", "0.1")
    assert code == 0
    assert "a disc of 3 modes" in shown


@needs.FINITE_ELEMENTS.mark
def test_an_export_of_finite_elements_gives_the_disc_of_its_section(tmp_path: Path) -> None:
    """Bricks around the whole ring against the harmonics of its section: amplitudes, and tangential
    amplitudes with their sign, to 1 %. With 24 sectors frequencies are up to 3 % too high."""
    ring = Ring()
    modes = brick_modes(ring, 15)
    inner, *_, outer = ring.radii
    low = -ring.half
    high = ring.half
    rectangles = [(inner, R_0, low, high), (R_0, outer, low, high)]
    path = tmp_path / "ring.unv"
    for face in (1, -1):
        section = dm.Disc.from_section(
            rectangles, size=0.006, E=ring.E, nu=ring.nu, rho=ring.rho,
            clamped=lambda x: x[0] < ring.radii[0] + 1e-9, slider=(R_0, face * ring.half),
            highest_Hz=9000, damping_ratio=1e-3,
        )  # fmt: skip
        known = [*zip(section.diameters, section.circles, strict=True)]
        for results, nodes in RECORDS:
            file = export(path, modes, Dialect(results=results, nodes=nodes))
            axis = "-z"
            if face > 0:
                axis = "z"
            disc = dm.Disc.from_uff(file, R_0, axis=axis)
            order = [known.index(mode) for mode in zip(disc.diameters, disc.circles, strict=True)]
            assert disc.diameters[:6] == (0, 1, 2, 3, 4, 5)
            assert (1, 1) in [known[i] for i in order]  # it moves in the plane above all
            omega = np.array(section.omega)
            np.testing.assert_allclose(disc.omega, omega[order], rtol=0.04)
            for name in ("amplitude", "tangential"):
                expected = np.array(getattr(section, name))[order]
                scale = np.hypot(np.array(section.amplitude), section.tangential)[order]
                found = getattr(disc, name)
                errors = np.abs(found - expected)
                limit = 0.01 * scale
                np.testing.assert_array_less(errors, limit)
                assert np.all(
                    np.abs(getattr(disc, name) - expected)[:6] <= 0.01 * np.abs(expected[:6])
                )


@needs.UNIVERSAL_FILES.mark
def test_a_file_of_another_writer_is_read(tmp_path: Path) -> None:
    """The plate's modes, written by pyuff, both halves of each pair turned by 0.3 rad."""
    import pyuff

    p = dm.Parameters(N=0, Omega=0, normalization="orthonormal")
    radii = np.array([0.06, 0.08, 0.1, 0.12])
    angles = np.arange(24) * np.pi / 12
    mass = 2.5
    r, angle = (grid.ravel() for grid in np.meshgrid(radii, angles, indexing="ij"))
    numbers = np.arange(1, r.size + 1)
    x = r * np.cos(angle)
    y = r * np.sin(angle)
    nodes = {"type": 15, "node_nums": numbers, "x": x, "y": y}
    modes_path = tmp_path / "modes.uff"
    file = pyuff.UFF(str(modes_path))
    plain = dict.fromkeys(("def_cs", "disp_cs", "color"), 0 * numbers)
    file.write_sets({**nodes, **plain, "z": 0 * r}, "overwrite")
    modes = dm.plate_modes(p)
    shapes = mode_shapes(p, radii)
    for l, omega, shape in zip(modes["diameters"], modes["omega"], shapes, strict=True):
        for half in range(1 + (l > 0)):
            turned = angle - 0.3
            quarter = np.pi / 2
            wave = np.cos(l * turned + half * quarter)
            z = -np.sqrt(mass) * np.repeat(shape, angles.size) * wave
            file.write_sets(
                {
                    "type": 55, "model_type": 1, "analysis_type": 2, "data_ch": 2, "spec_data_type": 8,
                    "data_type": 2, "n_data_per_node": 3, "load_case": 0, "mode_n": 1,
                    "freq": omega * (1 + 0.01 * half) / (2 * np.pi), "modal_m": mass, "modal_damp_vis": 0.01,
                    "modal_damp_his": 0.0, "node_nums": numbers, "r1": 0 * z, "r2": 0 * z, "r3": z,
                }, "add",
            )  # fmt: skip
    disc = dm.Disc.from_uff(modes_path, p.r_0)
    assert list(disc.diameters) == modes["diameters"].tolist()
    paired = np.where(modes["diameters"] > 0, 1.005, 1.0)
    omega = modes["omega"] * paired
    np.testing.assert_allclose(disc.omega, omega, rtol=DIGITS)
    amplitude = np.abs(modes["psi"])
    np.testing.assert_allclose(disc.amplitude, amplitude, rtol=1e-4)
    signed = shapes * np.sign(shapes[:, 2:3])
    largest = np.abs(shapes).max()
    tolerance = 1e-4 * largest
    np.testing.assert_allclose(disc.shapes, signed, atol=tolerance)
    disc_path = tmp_path / "disc.csv"
    disc.to_csv(disc_path)
    assert dm.Disc.from_csv(disc_path) == disc
