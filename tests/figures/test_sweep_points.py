"""Sweeps with several values at each point are points over what varies, and two dimensions of which one
has few values are lines."""

import json
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot
from matplotlib.axes import Axes

import disc_model as dm
from disc_model.figures.gap_rows import rows_above
from disc_model.figures.labels import words_of
from tests.figures.reading import as_map, labels

CASE = dm.Parameters(N=385, Omega=15, n_diameters=2)
SPEEDS = np.array([10.0, 12.0, 14.0, 16.0])  # rad/s
SAMPLES = 5


def sections() -> xr.Dataset:
    """Angles of the slider once a turn; at the last speed the motion had not settled."""
    angles = 0.01 * np.arange(20.0).reshape(4, SAMPLES)
    settled = ["settled", "settled", "settled", "unsettled"]
    return xr.Dataset(
        {
            "psi": (("Omega", "sample"), angles, {"units": "rad", "long_name": "angle"}),
            "settled": ("Omega", settled),
        },
        {
            "Omega": SPEEDS,
            "sample": ("sample", range(SAMPLES), {"long_name": "number of the turn"}),
        },
    )


def points_on(ax: Axes) -> list[Any]:
    """The points of each look, which no line joins."""
    assert not ax.collections, "no map"
    return [line for line in ax.lines if line.get_linestyle() == "None"]


def words_above(ax: Axes) -> list[str]:
    """The words of the rows above a panel."""
    words = [row.words.get_text() for row in rows_above(ax)]
    return [" ".join(each.split()) for each in words]


def test_samples_of_a_section_are_points_over_what_varies() -> None:
    """They were a map over the number of the sample, or a named line for each number."""
    study = sections()
    ax = dm.plot_sweep(study, "psi")
    assert ax.get_xlabel() == "Speed Ω (rad/s)"
    dots, rings = points_on(ax)
    np.testing.assert_array_equal(dots.get_xdata(), np.repeat(SPEEDS[:3], SAMPLES))
    np.testing.assert_allclose(dots.get_ydata(), study["psi"][:3].values.ravel())
    np.testing.assert_array_equal(rings.get_xdata(), np.repeat(SPEEDS[3:], SAMPLES))
    assert labels(ax.figure) == ["not settled, or undecided"]


def sampled(section: str) -> xr.Dataset:
    """A study of bifurcations, whose motions at the two highest speeds lose contact; the last had not
    settled."""
    study = sections().assign_attrs(quantity="bifurcation")
    study.attrs["options"] = json.dumps({"section": section})
    study.attrs["base"] = json.dumps({"N": 385.0})
    phases = np.array(["stick", "stick", "separation", "separation"])
    study["phase"] = (("Omega", "sample"), np.repeat(phases[:, None], SAMPLES, axis=1))
    return study


def test_samples_at_releases_and_at_separations_have_marks_and_names_of_their_own() -> None:
    """They had one mark and no legend, although they are of two sections."""
    ax = dm.plot_sweep(sampled("event"), "psi")
    releases, separations, _ = points_on(ax)
    assert {*releases.get_xdata()} == {*SPEEDS[:2]}
    assert {*separations.get_xdata()} == {SPEEDS[2]}
    assert releases.get_marker() != separations.get_marker()
    events = ["at release of stick", "at loss of contact"]
    assert labels(ax.figure) == [*events, "at loss of contact, not settled"]
    assert ax.get_ylabel() == "Angle (rad)"


def test_samples_once_per_turn_say_so_along_their_axis() -> None:
    """Motions of one period looked like bands of chaos without a word on the section."""
    ax = dm.plot_sweep(sampled("stroboscopic"), "psi")
    assert words_of(ax.yaxis.label) == "Angle once per turn of the drive (rad)"
    assert labels(ax.figure) == ["not settled, or undecided"]


def test_samples_of_a_section_are_a_map_or_lines_on_request() -> None:
    assert as_map(sections(), "psi").get_ylabel() == "Number of the turn"
    ax = dm.plot_sweep(sections(), "psi", lines="sample")
    places = [line.get_xdata().tolist() for line in points_on(ax)]
    filled = [place for place in places if place]
    assert filled == SAMPLES * [[16.0]], "only marks of the motion that had not settled"


def test_arrays_of_a_function_are_points() -> None:
    """They were refused, with the advice to select one number of each."""

    def turns(case: dm.Parameters) -> dict[str, Any]:
        return {"psi": case.Omega * np.array([1.0, 2.0, 3.0]), "mean": case.Omega}

    swept = dm.sweep(turns, CASE, Omega=[10.0, 12.0])
    _, ax = pyplot.subplots()
    [dots] = points_on(dm.plot_sweep(swept, "psi", ax=ax))
    np.testing.assert_array_equal(dots.get_ydata(), [10, 20, 30, 12, 24, 36])
    assert dm.plot_sweep(swept).get_ylabel() == "Mean", "one number at each point comes first"


def test_a_point_without_any_sample_is_marked_above_the_panel() -> None:
    study = sections()
    study["psi"][1] = np.nan
    study["psi"][2, 3:] = np.nan
    ax = dm.plot_sweep(study, "psi")
    [above] = rows_above(ax)
    assert above.reason == "no value"
    assert [list(row.get_xdata()) for row in above.rows] == [[12.0]]


def grid(speeds: int, loads: int, first: str = "Omega") -> xr.Dataset:
    """Numbers over speeds and preloads."""
    axes = {"Omega": np.linspace(10, 16, speeds), "N": np.linspace(300, 400, loads)}
    values = np.arange(float(speeds * loads)).reshape(speeds, loads)
    attrs = {"units": "s", "long_name": "time"}
    study = xr.Dataset({"time": (("Omega", "N"), values, attrs)}, axes)
    return study.transpose(first, ...)


@pytest.mark.parametrize(
    ("speeds", "loads", "first", "x", "label", "lines"),
    [
        (5, 2, "Omega", "", "Speed Ω (rad/s)", 2),
        (5, 3, "N", "", "Speed Ω (rad/s)", 3),
        (2, 5, "Omega", "", "Preload N (N)", 2),
        (2, 3, "N", "N", "Preload N (N)", 2),
        (5, 4, "Omega", "", "Speed Ω (rad/s)", 0),
        (5, 2, "Omega", "N", "Preload N (N)", 0),
    ],
)
def test_a_dimension_of_few_values_gives_lines(
    speeds: int, loads: int, first: str, x: str, label: str, lines: int
) -> None:
    """Two values of an option were a map of two rows, whose border lay halfway between them."""
    ax = dm.plot_sweep(grid(speeds, loads, first), "time", x)
    assert ax.get_xlabel() == label
    assert len(ax.lines) == lines
    assert bool(ax.collections) == (not lines), "a map in place of lines"


@pytest.mark.parametrize("wish", [{"lines": False}, {"cmap": "viridis"}])
def test_few_values_are_a_map_on_request(wish: dict[str, Any]) -> None:
    ax = dm.plot_sweep(grid(5, 2), "time", **wish)
    assert ax.collections
    assert ax.get_ylabel() == "Preload N (N)"


def test_a_motion_without_samples_that_had_not_settled_is_named_so() -> None:
    """It was said to have no further sample, as if it had come to an end, and lost contact later."""
    study = sections().assign_attrs(quantity="bifurcation")
    study["psi"][3] = np.nan
    ax = dm.plot_sweep(study, "psi")
    assert words_above(ax) == ["no event while sampled, not settled"]
