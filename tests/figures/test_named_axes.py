"""Several pictures on the same axes: what they may have in common, and what they are called."""

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from tests.figures.test_wishes import DRAWN, branch, legend_texts
from tests.refusals import refusal

SPEED = {"units": "rad s-1"}
ANOTHER = {
    "portrait": ("run", "along x"),
    "run": ("portrait", "along x"),
    "spectrum": ("run", "along x"),
    "multipliers": ("eigenvalues", "along x"),
    "eigenvalues": ("multipliers", "along x"),
    "exponents": ("branch", "along x"),
    "branch": ("line", "along y"),
    "line": ("branch", "along y"),
    "map": ("words", "by colour"),
    "words": ("map", "by colour"),
}
"""For each picture, one of something else, and the axis along which it is."""


def speeds() -> xr.Dataset:
    """Speeds of a hysteresis over the load."""
    onset = ("N", [14.0, 15.0, 16.0], {**SPEED, "long_name": "speed at which it begins"})
    offset = ("N", [11.0, 12.0, np.nan], {**SPEED, "long_name": "lowest speed to which it lasts"})
    period = ("N", [0.01, 0.02, 0.03], {"units": "s", "long_name": "period"})
    return xr.Dataset(
        {"begin": onset, "end": offset, "time": period},
        {"N": [300.0, 350.0, 400.0]},
        {"base": '{"Omega": 14}'},
    )


TELLING = ("run", "multipliers", "branch", "line", "map", "words")
"""Pictures of each kind of axes; the others are tried by slow tests."""


@pytest.mark.parametrize(
    "name",
    [name if name in TELLING else pytest.param(name, marks=pytest.mark.slow) for name in DRAWN],
)
def test_a_picture_of_something_else_is_refused_and_leaves_axes_as_they_are(name: str) -> None:
    """The label of the second picture stood beside the values of the first."""
    figure, ax = pyplot.subplots(layout="constrained")
    other, along = ANOTHER[name]
    DRAWN[other](ax=ax)
    before = (ax.get_xlabel(), ax.get_ylabel(), len(ax.get_children()), len(figure.axes))
    with refusal(rf"^ax: shows “.*” {along}, and “.*” is something"):
        DRAWN[name](ax=ax)
    assert (ax.get_xlabel(), ax.get_ylabel(), len(ax.get_children()), len(figure.axes)) == before
    if along != "by colour":  # which would cover the first
        DRAWN[other](ax=ax)  # the same again
    ax.clear()
    DRAWN[name](ax=ax)


@pytest.mark.parametrize(
    ("own", "refused"), [("ω (rpm)", True), ("ω (rad/s)", False), ("ω", False)]
)
def test_a_label_that_a_reader_has_written_stays_in_its_unit(own: str, refused: bool) -> None:
    _, ax = pyplot.subplots()
    ax.plot([14.6, 15.0], [1.0, 2.0], label="measured")
    ax.set_xlabel(own)
    if refused:
        with refusal(r"label “ω \(rpm\)” along x.*another unit"):
            branch().plot("range", ax=ax)
    else:
        branch().plot("range", ax=ax)
    assert ax.get_xlabel() == own


@pytest.mark.parametrize("listed", [True, False])
def test_variables_of_one_unit_have_looks_names_and_a_common_axis(listed: bool) -> None:
    """Both were black lines without a name, under the label of the second."""
    _, ax = pyplot.subplots(layout="constrained")
    if listed:
        dm.plot_sweep(speeds(), ["begin", "end"], ax=ax)
    else:
        dm.plot_sweep(speeds(), "begin", ax=ax)
        dm.plot_sweep(speeds(), "end", ax=ax)
    assert ax.get_ylabel() == "Speed (rad/s)"
    said = [text.replace("\n", " ") for text in legend_texts(ax)]
    assert said == ["Speed at which it begins", "Lowest speed to which it lasts"]
    begin, end = [line for line in ax.lines if len(line.get_xdata()) == 3]
    assert begin.get_color() != end.get_color()
    assert begin.get_linestyle() != end.get_linestyle()
    assert begin.get_marker() != end.get_marker()
    for wrong in ("time", ["begin", "time"]):
        with refusal(r"“Speed.*\(rad/s\)” along y, and “Period"):
            dm.plot_sweep(speeds(), wrong, ax=ax if wrong == "time" else None)


def test_lines_are_named_by_their_reader() -> None:
    called = {"begin": "up", "end": "down"}
    ax = dm.plot_sweep(speeds(), ["begin", "end"], labels=called)
    assert legend_texts(ax) == ["up", "down"]
    assert legend_texts(dm.plot_sweep(speeds(), "begin", labels={"begin": "up"})) == ["up"]


def test_sweeps_of_several_cases_are_named_by_what_differs() -> None:
    worn = speeds().assign_attrs(base='{"Omega": 14, "mu_k": 0.2}')
    new = speeds().assign_attrs(base='{"Omega": 14, "mu_k": 0.3}')
    ax = dm.plot_sweep(worn, "begin")
    dm.plot_sweep(new, "begin", ax=ax)
    assert [text[-3:] for text in legend_texts(ax)] == ["0.2", "0.3"]
    assert ax.figure.get_suptitle() == "Ω = 14 rad/s"
    assert ax.get_ylabel() == "Speed at which it begins (rad/s)"


def test_a_single_horizon_has_its_unit() -> None:
    ax = dm.plot_sweep(speeds(), "begin")
    within = speeds().assign_coords(horizon=((), 60.0, {"units": "s"}))
    dm.plot_sweep(within, "end", ax=ax)
    assert legend_texts(ax)[1].endswith("horizon 60 s")


def test_lines_of_several_sweeps_keep_the_names_of_their_values() -> None:
    """Directions of two cases."""
    attrs = {"units": "mm", "long_name": "reach"}
    axes = {"direction": ["up", "down"], "Omega": [1.0, 2.0]}
    study = xr.Dataset({"reach": ([*axes], np.eye(2), attrs)}, axes)
    ax = dm.plot_sweep(study.assign_attrs(base='{"mu_k": 0.2}'), "reach")
    dm.plot_sweep(study.assign_attrs(base='{"mu_k": 0.3}'), "reach", ax=ax)
    said = legend_texts(ax)
    assert len(set(said)) == 4
    assert [text.split(",")[0] for text in said] == ["up", "down", "up", "down"]
