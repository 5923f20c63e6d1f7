"""Pictures of runs that still grow say so."""

import functools

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.figures.growing_runs import growth_note
from tests.figures.test_wishes import legend_texts

CASE = dm.Parameters(N=385, Omega=25, n_diameters=2)
TIMES = np.arange(0.0, 10.0, 0.01)
NOTE = "still growing"


@functools.cache
def growing_run() -> dm.Result:
    return dm.simulate(CASE, 8, {"late": dm.Window(last=0.05, rate=1e4)})


def noted(sizes: np.ndarray, end: float = 10.0, separation: float = np.nan) -> str:
    """What is said of a run of some sizes at its events in a window that ends at a time, which has first
    separated at another."""
    heights = sizes * (-1.0) ** np.arange(sizes.size)
    events = xr.Dataset({"u": ("event", heights), "time": ("event", TIMES)})
    numbers = xr.Dataset({"first_separation": separation})
    case = xr.DataTree.from_dict({"/": numbers, "/events": events})
    return growth_note(case, [xr.Dataset(coords={"time": [end - 0.1, end]})])


@pytest.mark.parametrize(
    ("sizes", "said"),
    [
        (np.exp(0.2 * TIMES), NOTE),
        (np.exp(-0.2 * TIMES), ""),
        (np.ones(TIMES.size), ""),
        (np.minimum(np.exp(TIMES), 10.0), ""),
        (np.random.default_rng(1).uniform(0.5, 1.5, TIMES.size), ""),
    ],
    ids=["grows", "decays", "stays", "has grown", "is irregular"],
)
def test_a_run_that_grows_is_told_from_others(sizes: np.ndarray, said: str) -> None:
    assert noted(sizes) == said


def test_the_motion_is_judged_at_the_end_of_the_window() -> None:
    sizes = np.minimum(np.exp(TIMES), np.exp(5.0))
    assert noted(sizes, end=5.0) == NOTE
    assert noted(sizes) == ""


def test_the_motion_after_the_first_separation_is_judged_by_itself() -> None:
    """Its events are at other heights: the change looked like growth."""
    sizes = np.where(TIMES < 9, 1.0, 1.6)
    assert noted(sizes) == NOTE
    assert noted(sizes, separation=9.0) == ""
    later = np.exp(0.5 * TIMES)
    assert noted(later, separation=4.0) == NOTE


def test_few_events_say_nothing() -> None:
    """Over a few cycles, beats look like growth."""
    assert noted(np.exp(0.2 * TIMES), end=1.0) == ""


@pytest.mark.parametrize("kind", ["plot", "plot_phase_portrait"])
def test_the_legend_says_that_a_run_still_grows(kind: str) -> None:
    """A window late in such a run looked like that of a settled motion."""
    draw = getattr(growing_run(), kind)
    ax = np.ravel(draw("late"))[0]
    handles = ax.figure.legends[0].get_texts()
    assert handles[-1].get_text() == NOTE
    pyplot.close("all")


def test_the_name_of_a_run_beside_others_says_it() -> None:
    _, ax = pyplot.subplots()
    for name in ("contact kept", "again"):
        growing_run().plot("late", variables=["u"], ax=ax, labels={"case": name})
    assert legend_texts(ax) == [f"contact kept, {NOTE}", f"again, {NOTE}"]
    pyplot.close("all")
