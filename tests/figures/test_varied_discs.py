"""Titles of what is computed over a frequency of a disc given by its modes."""

from pathlib import Path

import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.data.variables import axis_of, unit_of_parameter
from disc_model.figures.head_texts import what_case
from disc_model.figures.stated_case import stated
from disc_model.figures.sweep_titles import values_of
from disc_model.mode_units import si_unit_of_mode
from disc_model.studies.registry import quantity_of
from tests.figures.reading import draw

DISC = dm.Disc.from_csv("config/discs/brake_3_modes.csv")
PAD = {"r_0": 0.1, "k": 1e6, "k_p": 1e6, "m": 0.5}
CASE = dm.Parameters(N=8000, Omega=10, disc=DISC, **PAD)
RANGE = "a disc given by 3 modes of 550.8 to 1212 Hz"


def swept_title(**axes: object) -> str:
    """What a title says of a sweep of some numbers of the disc."""
    study = dm.sweep(dm.steady_sliding, CASE, **axes)
    return what_case(values_of(study))


def test_a_title_does_not_state_the_frequency_that_varies() -> None:
    """It gave 550.8 Hz, while this went from 500 to 600 Hz along the axis."""
    title = swept_title(omega_1_0=["500 Hz", "600 Hz"])
    assert "a disc given by 3 modes" in title
    assert "Hz" not in title
    branch = stated(CASE, "omega_1_0")
    assert "a disc given by 3 modes," in branch
    assert RANGE in swept_title(amplitude_1_0=[0.5, 0.6])
    assert RANGE in stated(CASE, "N")


def test_a_line_of_the_plate_beside_one_of_a_disc_is_named() -> None:
    """The picture ended with a TypeError."""
    swept = dm.sweep(dm.steady_sliding, CASE, disc=[None, DISC], Omega=[10.0, 20.0])
    [legend] = dm.plot_sweep(swept, "growth_rate", lines="disc").figure.legends
    plate, disc = (text.get_text() for text in legend.get_texts())
    assert plate == "plate"
    assert disc.startswith("disc 2: 3 modes")
    pyplot.close("all")


def test_a_study_states_the_only_disc_of_an_axis(tmp_path: Path) -> None:
    """Its figures and a picture of the dataset left it out."""
    table = Path("config/discs/brake_3_modes.csv").resolve()
    base = "{N: 8000, r_0: 0.1, k: 1e6, k_p: 1e6, m: 0.5}"
    axes = f"{{disc: [{table}], Omega: [10, 20]}}"
    file = tmp_path / "one.yaml"
    file.write_text(f"study: one\nquantity: floquet\nbase: {base}\naxes: {axes}\n")
    study = dm.run_study(file)
    assert RANGE in dm.plot_sweep(study).figure.get_suptitle()
    figure = draw("curve", study, variable="growth_rate", x="Omega", width="page")
    assert "3 modes of 550.8 to 1212 Hz" in figure.get_suptitle().replace("\n", " ")
    pyplot.close("all")


@pytest.mark.parametrize("name", ["tangential_2_0", "amplitude_2_0", "omega_2_0"])
def test_numbers_of_modes_have_one_unit_in_pictures_and_texts(name: str) -> None:
    """Pictures and fits had 1/√kg where branches and critical values had kg^-1/2."""
    label, _ = axis_of(name)
    assert label.endswith(f"({unit_of_parameter(name)})")
    assert unit_of_parameter(name) == si_unit_of_mode(name)


def test_kinds_of_motion_along_an_axis_have_names() -> None:
    """They were "stick_slip" there, and "stick-slip cycle" in a legend."""
    axes = {"kind": ["stick_slip", "sliding"], "N": [100.0, 200.0]}
    study = xr.Dataset({"value": ([*axes], [[1.0, 2.0], [3.0, 4.0]])}, axes)
    ax = dm.plot_sweep(study, "value", x="kind")
    ax.figure.canvas.draw()
    names = [label.get_text() for label in ax.get_xticklabels()]
    assert names == ["stick-slip cycle", "steady sliding"]
    pyplot.close("all")


def test_tangential_amplitudes_are_numbers_of_studies_too() -> None:
    """Studies of steady sliding along one were refused."""
    scan = {"start": -0.2, "stop": 0.2, "count": 3}
    quantity = quantity_of("sliding")(parameter="tangential_1_0", scan=scan)
    assert quantity.units == "kg^-1/2"
