"""Tables of modes as laboratories and spreadsheets write them."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import disc_model as dm
from disc_model.disc.given import DiscReport, ModeOrigin
from tests.refusals import refusal

DIAMETERS = (1, 0, 2)
FREQUENCIES = (551.0, 929.0, 1212.5)
AMPLITUDES = (0.556, 0.431, 0.543)
RATIOS = (0.001, 0.002, 0.0015)
OMEGA = 2 * np.pi * np.array(FREQUENCIES)


def read(path: Path, text: str, pairs: Any = "given") -> dm.Disc:
    """The disc of a table with this text; warnings are errors."""
    (path / "disc.csv").write_text(text, encoding="utf-8")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return dm.Disc.from_csv(path / "disc.csv", pairs)


def assert_right(disc: dm.Disc, damped: bool = True) -> None:
    """That a disc has the known modes."""
    assert disc.diameters == DIAMETERS
    np.testing.assert_allclose(disc.omega, OMEGA, rtol=1e-12)
    np.testing.assert_allclose(disc.amplitude, AMPLITUDES, rtol=1e-12)
    ratios = (0, 0, 0)
    if damped:
        ratios = RATIOS
    np.testing.assert_allclose(disc.damping_ratio, ratios, rtol=1e-9)


def rows(*columns: Any, separator: str = ",") -> str:
    """Lines of a table from its columns."""
    return "".join(separator.join(map(str, row)) + "\n" for row in zip(*columns, strict=True))


@pytest.mark.parametrize("label", ["Mode", "mode no.", "No.", "Mode-Nr."])
@pytest.mark.parametrize("separator", [",", ";"])
def test_a_first_column_that_labels_modes_is_left_aside(
    label: str, separator: str, tmp_path: Path
) -> None:
    """Software of modal tests numbers modes; it was an unknown column."""
    heads = [label, "diameters", "frequency (Hz)", "amplitude (1/sqrt(kg))", "damping (1)"]
    text = rows((1, 2, 5), DIAMETERS, FREQUENCIES, AMPLITUDES, RATIOS, separator=separator)
    assert_right(read(tmp_path, separator.join(heads) + "\n" + text))
    units = separator.join(["", "-", "Hz", "1/sqrt(kg)", "-"]) + "\n"
    heads = [label, "diameters", "frequency", "amplitude", "damping"]
    assert_right(read(tmp_path, separator.join(heads) + "\n" + units + text))


@pytest.mark.parametrize(
    ("heads", "factors"),
    [
        ("diameters,frequency_Hz,amplitude_per_sqrt_kg,damping_ratio", (1, 1, 1)),
        ("diameters,frequency (kHz),amplitude (kg^-1/2),damping (%)", (1e-3, 1, 100)),
        ("Nodal diameters,f [Hz],Amplitude [1/sqrt(kg)],zeta [-]", (1, 1, 1)),
        ("nodal diameters,natural frequency in Hz,amplitude in kg^-0.5,damping in %", (1, 1, 100)),
        ("l,omega (rad/s),amplitude (g^-1/2),xi", (2 * np.pi, 1000**-0.5, 1)),
        ("l,frequency_kHz,amplitude (t^-1/2),loss factor", (1e-3, 1000**0.5, 2)),
        ("n_diameters,omega (rpm),amplitude_per_sqrt_kg,modal damping (1)", (60, 1, 1)),
    ],
)  # fmt: skip
def test_heads_have_names_and_units(
    heads: str, factors: tuple[float, float, float], tmp_path: Path
) -> None:
    frequency, amplitude, damping = factors
    text = rows(
        DIAMETERS,
        np.array(FREQUENCIES) * frequency,
        np.array(AMPLITUDES) * amplitude,
        np.array(RATIOS) * damping,
    )
    assert_right(read(tmp_path, f"{heads}\n{text}"))


@pytest.mark.parametrize("separator", [",", ";", "\t"])
@pytest.mark.parametrize("decimal", [".", ","])
@pytest.mark.parametrize("tail", ["", "trailing", "head", "blank"])
def test_spreadsheets_separate_and_end_columns_as_they_like(
    separator: str, decimal: str, tail: str, tmp_path: Path
) -> None:
    """With decimal commas where columns are separated otherwise; with empty columns and rows."""
    if separator == decimal:
        return
    heads = ["diameters", "frequency (Hz)", "amplitude (kg^-1/2)", "damping ratio"]
    text = rows(DIAMETERS, FREQUENCIES, AMPLITUDES, RATIOS, separator=separator)
    text = text.replace(".", decimal)
    head = separator.join(heads)
    if tail == "trailing":
        head += separator
        text = text.replace("\n", f"{separator}\n")
    if tail == "head":
        text = text.replace("\n", f"{separator}{separator}\n")
    if tail == "blank":
        text += 3 * separator + "\n\n"
    begin = ""
    if separator == ";":
        begin = "sep=;\n"
    assert_right(read(tmp_path, f"{begin}{head}\n{text}"))


def test_units_may_have_a_row_of_their_own(tmp_path: Path) -> None:
    text = "diameters;f;amplitude;damping\n-;kHz;1/sqrt(kg);%\n"
    table = rows(
        DIAMETERS, np.array(FREQUENCIES) / 1e3, AMPLITUDES, np.array(RATIOS) * 100, separator=";"
    )
    assert_right(read(tmp_path, text + table))


@pytest.mark.parametrize(
    ("names", "units"),
    [
        ("f;amplitude;damping", "[kHz];(1/sqrt(kg));(%)"),
        ("f_kHz;Amplitude_per_sqrt_kg;damping in %", "kHz;1/sqrt(kg);%"),
    ],
    ids=["in brackets", "in the heads as well"],
)
def test_a_unit_stands_once_in_a_head(names: str, units: str, tmp_path: Path) -> None:
    """The heads were "f ([kHz])" and "f_kHz (kHz)", which were refused, and so said messages about rows."""
    table = rows(
        DIAMETERS, np.array(FREQUENCIES) / 1e3, AMPLITUDES, np.array(RATIOS) * 100, separator=";"
    )
    assert_right(read(tmp_path, f"diameters;{names}\n-;{units}\n{table}"))


def test_a_report_says_how_each_column_was_understood(tmp_path: Path) -> None:
    """There was none of a table of single modes, so that a percentage could be one of a hundred."""
    text = "diameters;f (kHz);amplitude (kg^-1/2);damping in %\n2;1,5;0,54;0,1\n3;2;0,43;0,3\n"
    disc = read(tmp_path, text)
    assert str(disc.report).splitlines() == [
        "disc.csv: 2 modes",
        "read: 'diameters' as nodal diameters, 2 to 3",
        "read: 'f (kHz)' as frequency, 1500 to 2000 Hz",
        "read: 'amplitude (kg^-1/2)' as amplitude, 0.43 to 0.54 kg^-1/2",
        "read: 'damping in %' as damping ratio, 0.001 to 0.003",
    ]
    poles = read(tmp_path, "diameters,amplitude_per_sqrt_kg,pole (rad/s)\n2,0.5,-3+400i\n")
    assert "'pole (rad/s)' as damping ratio, 0.0074998" in str(poles.report)


DAMPED = np.array(RATIOS)
OSCILLATING = np.sqrt(1 - DAMPED**2)
POLES = OMEGA * (-DAMPED + 1j * OSCILLATING)


@pytest.mark.parametrize("factor", [1.0, 1 / (2 * np.pi)])
def test_poles_stand_for_frequencies_and_damping(factor: float, tmp_path: Path) -> None:
    unit = "Hz"
    if factor == 1:
        unit = "rad/s"
    poles = [f"{factor * pole.real!r}{factor * pole.imag:+}i" for pole in POLES.tolist()]
    heads = f"diameters,amplitude_per_sqrt_kg,pole ({unit})\n"
    assert_right(read(tmp_path, heads + rows(DIAMETERS, AMPLITUDES, poles)))
    heads = f"diameters,amplitude_per_sqrt_kg,pole real ({unit}),pole imag [{unit}]\n"
    parts = rows(DIAMETERS, AMPLITUDES, factor * POLES.real, factor * POLES.imag)
    assert_right(read(tmp_path, heads + parts))


def test_shapes_may_be_at_radii_in_mm(tmp_path: Path) -> None:
    text = "diameters,frequency_Hz,amplitude_per_sqrt_kg,shape at 80 mm,shape_at_0.1_m\n"
    disc = read(
        tmp_path, text + rows(DIAMETERS, FREQUENCIES, AMPLITUDES, (0.3, 0.2, 0.1), AMPLITUDES)
    )
    assert disc.radii == (0.08, 0.1)
    assert disc.shapes == ((0.3, 0.556), (0.2, 0.431), (0.1, 0.543))


def test_both_halves_of_pairs_become_their_mean(tmp_path: Path) -> None:
    """Signs follow the amplitude, and a mode without diameters has no other half."""
    heads = "diameters,frequency_Hz,amplitude_per_sqrt_kg,damping_ratio,tangential_per_sqrt_kg,"
    heads += "shape_at_0.08_m,shape_at_0.1_m\n"
    table = "2,1215,-0.55,0.0018,0.14,-0.3,-0.55\n0,929,0.43,0.001,0,0.2,0.43\n"
    table += "2,1209,0.53,0.0012,-0.12,0.2,0.53\n0,980,0.1,0.001,0,0.1,0.1\n3,1900,0.5,0.001,-0.1,0.2,0.5\n"
    with refusal(r"modes 1 and 3 .* 0.49 % apart"):
        read(tmp_path, heads + table)
    with refusal(r"pairs='Mean': must be 'given', 'mean' or 'test'"):
        read(tmp_path, heads + table, pairs="Mean")
    table = table.replace("0,980,0.1,", "0,1980,0.1,")
    disc = read(tmp_path, heads + table, pairs="mean")
    assert disc.diameters == (2, 0, 0, 3)
    turn = 2 * np.pi
    frequencies = np.array(disc.omega) / turn
    np.testing.assert_allclose(frequencies, [1212, 929, 1980, 1900])
    np.testing.assert_allclose(disc.amplitude, [0.54, 0.43, 0.1, 0.5])
    np.testing.assert_allclose(disc.damping_ratio, [0.0015, 0.001, 0.001, 0.001])
    np.testing.assert_allclose(disc.tangential, [-0.13, 0, 0, -0.1])
    np.testing.assert_allclose(disc.shapes[0], [0.25, 0.54])
    assert disc.report is not None
    np.testing.assert_allclose(disc.report.split, [6 / 1212, 0, 0, 0])
    assert [mode.shapes for mode in disc.report.modes] == [2, 1, 1, 1]
    assert disc.first(1).report is None
    first = disc.report.modes[0]
    assert first.amplitude_split == pytest.approx(0.02 / 0.54)
    assert first.damping_split == pytest.approx(0.0006 / 0.0015)
    row = disc.report.table.loc[0]
    assert row["amplitude split (%)"] == pytest.approx(2 / 0.54)
    assert row["damping split (%)"] == pytest.approx(40)
    assert "1209        1215    0.49505" in str(disc.report)


def test_halves_that_differ_by_rounding_are_alike() -> None:
    """A report said "amplitude split 2.2204e-14 %"."""
    origin = ModeOrigin(2, 7600.0, 7600.0 * (1 + 1e-15), 2, 1.0, 1.0, 2.2e-16, 1e-15)
    report = DiscReport("disc.unv", (origin,))
    row = report.table.loc[0]
    assert (row["split (%)"], row["amplitude split (%)"], row["damping split (%)"]) == (0, 0, 0)
    assert "e-1" not in str(report)


def test_a_table_with_circles_has_its_pairs_by_them(tmp_path: Path) -> None:
    text = "diameters,circles,frequency_Hz,amplitude_per_sqrt_kg\n2,0,1200,1.8\n2,1,1210,2\n2,0,1204,2.2\n"
    disc = read(tmp_path, text, pairs="mean")
    assert disc.diameters == (2, 2)
    assert disc.circles == (0, 1)
    assert disc.amplitude == (2, 2)


BARE = "diameters,frequency_Hz,amplitude_per_sqrt_kg\n"
CIRCLES = "diameters,circles,frequency_Hz,amplitude_per_sqrt_kg\n"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (BARE + "2,300,1\n2,301,1\n2,302,1\n", "'302': modes 1, 2 and 3 .* has two halves"),
        (CIRCLES + "2,0,300,1\n2,0,301,1\n2,0,302,1\n", "'302': modes 1, 2 and 3 .* two halves"),
        (
            # rows keep their numbers behind a pair that became one mode
            BARE + "2,300,1\n2,301,1\n0,500,1\n0,501,1\n",
            "'501': modes 3 and 4 have 0 nodal diameters, and .* no half .* given once",
        ),
        (
            CIRCLES + "2,0,300,1\n2,0,340,1\n",
            "'340': modes 1 and 2 .* 12 % apart: .* less than 5 %",
        ),
    ],
)
def test_rows_that_are_no_pair_are_told_by_themselves(
    text: str, words: str, tmp_path: Path
) -> None:
    """The advice was `pairs='mean'`, which had been given, with the distance of a mean."""
    with refusal(words) as caught:
        read(tmp_path, text, pairs="mean")
    assert "pairs='mean'" not in str(caught.value)


def test_a_mode_without_diameters_is_advised_no_pair(tmp_path: Path) -> None:
    with refusal("no half of a pair") as caught:
        read(tmp_path, BARE + "0,300,1\n0,301,1\n")
    assert "pairs='mean'" not in str(caught.value)


@pytest.mark.parametrize(
    ("amplitude", "damping", "words"),
    [
        (3.0, 0.001, "amplitudes 100 % apart"),
        (1.0, 0.01, "damping ratios 164 % apart"),
        (1.4, 0.0019, ""),
    ],
)
def test_halves_that_differ_more_than_tests_err_are_doubted(
    amplitude: float, damping: float, words: str, tmp_path: Path
) -> None:
    text = "diameters,frequency_Hz,amplitude_per_sqrt_kg,damping_ratio\n"
    text += f"2,300,1,0.001\n2,301,{amplitude},{damping}\n"
    (tmp_path / "disc.csv").write_text(text)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        dm.Disc.from_csv(tmp_path / "disc.csv", "mean")
    said = [str(each.message) for each in caught]
    if words:
        assert len(said) == 1
        assert words in said[0]
    else:
        assert not said


@pytest.mark.parametrize(
    ("comment", "value"),
    [
        ("# static_compliance_m_per_N: 4.2e-8", 4.2e-8),
        ("# static_compliance_m_per_N = 42 nm/N", 4.2e-8),
        ("# static compliance: 0.042 mm/kN", 4.2e-8),
        ("# Static compliance (mm/kN): 0.042", 4.2e-8),
        ("# the disc of Monday: it squeals", None),
        ("# compliance of the fixture: not measured", None),
    ],
)
def test_a_comment_states_the_static_compliance(
    comment: str, value: float | None, tmp_path: Path
) -> None:
    text = "diameters,frequency_Hz,amplitude_per_sqrt_kg\n1,551,0.5\n"
    found = read(tmp_path, f"{comment}\n{text}").static_compliance
    if value:
        assert found == pytest.approx(value, rel=1e-12)
    else:
        assert found is None


@pytest.mark.parametrize(
    ("text", "phrase"),
    [
        ("# static_compliance_m_per_N: 42 nm", "static_compliance_m_per_N='42 nm': must be a number in m/N"),
        ("# static_compliance_m_per_N: much", "static_compliance_m_per_N='much': must be a number in m/N"),
        ("# static_complience_m_per_N: 4.2e-8", "comment='static_complience_m_per_N': must be named"),
        ("# Static compliance: 4.2e-8", "Static compliance='4.2e-8': must have a unit, such as 42 nm/N"),
        ("# compliance: 4.2e-8 m/N", "comment='compliance': must be named static_compliance_m_per_N"),
        ("# static_compliance_m_per_N: 1e-8", "must not be less than what the modes give at the slider"),
        ("# static_compliance_m_per_N: 1e-6\n# static compliance: 1 um/N", "must be given once, and not 2"),
    ],
)  # fmt: skip
def test_a_static_compliance_is_never_ignored(text: str, phrase: str, tmp_path: Path) -> None:
    table = "diameters,frequency_Hz,amplitude_per_sqrt_kg\n1,551,0.5\n"
    with pytest.raises(dm.ParameterError) as error:
        read(tmp_path, f"{text}\n{table}")
    assert f"disc.csv.{phrase}" in str(error.value) or phrase in str(error.value)


@pytest.mark.parametrize(
    ("text", "phrase"),
    [
        ("diameters,frequency,amplitude (kg^-1/2)\n", "columns='frequency': must give its unit, Hz, kHz"),
        ("diameters,f (Hz),amplitude\n", "columns='amplitude': must give its unit, kg^-1/2"),
        ("diameters,f (mm),amplitude (kg^-1/2)\n", "must be Hz, kHz or rad/s, not mm"),
        ("diameters,f (Hz),amplitude (mm)\n", "the unit of amplitude must be kg^-1/2, not mm"),
        ("diameters,f (Hz),amplitude (sqrt(kg))\n", "must be kg^-1/2, not sqrt(kg)"),
        ("diameters,f (Hz),amplitude (kg^-1/2),damping (1/s)\n", "must be none or %, not 1/s"),
        ("diameters,f (Hz),amplitude (kg^-1/2),colour\n", "columns='colour': unknown column"),
        ("n,f (Hz),amplitude (kg^-1/2)\n", "columns='n': unknown column, did you mean diameters?"),
        ("l,f (Hz),m [kg]\n", "columns='m [kg]': unknown column, did you mean modal_mass (kg)?"),
        ("diameters,f (Hz),omega (rad/s),amplitude (kg^-1/2)\n", "must have one column frequency_Hz or"),
        ("diameters,amplitude (kg^-1/2)\n", "must have one column frequency_Hz or omega_rad_per_s"),
        ("l,f (Hz),pole (rad/s),amplitude (kg^-1/2)\n", "must not have both pole and omega"),
        ("l,f (Hz),amplitude (kg^-1/2),zeta,loss factor\n", "one column damping_ratio, and not 2"),
        ("l,pole (Hz),amplitude (kg^-1/2),zeta\n", "must not have both pole and damping_ratio"),
        ("l,f (Hz),amplitude (kg^-1/2),shape at 8 cm,shape_at_0.08_m\n1,551,1,1,1\n", "radii"),
        ("l,pole (rad/s),amplitude (kg^-1/2)\n1,3000,0.5\n", "pole='3000': must be a complex number"),
        ("l,pole (rad/s),amplitude (kg^-1/2)\n1,4+3000j,0.5\n", "with a real part of at most 0"),
        ("l,pole (rad/s),amplitude (kg^-1/2)\n1,what,0.5\n", "pole='what': must be a complex number"),
        ("l;f (Hz);amplitude (kg^-1/2)\n1;1.212,5;0,5\n", "for thousands: not 1.212,5"),
        ("l;f (Hz);amplitude (kg^-1/2)\n1;1212,5;0.5\n", "decimals: not 1212,5 and 0.5"),
        ('l,f (Hz),amplitude (kg^-1/2)\n1,"1,212",0.5\n', "'1,212': must be a number (mode 1)"),
        ("l,f (Hz),amplitude (kg^-1/2)\n1,551,2,0,556\n", "mode 1 has 5 values: must be as many"),
        ("l,f (Hz),amplitude (kg^-1/2)\n1,551\n", "mode 1 has 2 values: must be as many as columns, 3"),
        ("l,f (kHz),amplitude (kg^-1/2)\n1,1e9,1\n", "f (kHz)='1e9': must be within 0.001 and 1e+07 rad/s"),
        ("l,shape at 8 km,f (Hz),amplitude (kg^-1/2)\n", "must give the radius in m, cm or mm"),
    ],
)  # fmt: skip
def test_what_cannot_be_understood_is_said(text: str, phrase: str, tmp_path: Path) -> None:
    with pytest.raises(dm.ParameterError) as error:
        read(tmp_path, text)
    assert phrase in str(error.value)
