"""Pictures of runs that still grow say so."""

import numpy as np
import pytest
import xarray as xr

from disc_model.figures.growing_runs import growth_note

TIMES = np.arange(0.0, 10.0, 0.01)
NOTE = "still growing"


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


def test_few_events_say_nothing() -> None:
    """Over a few cycles, beats look like growth."""
    assert noted(np.exp(0.2 * TIMES), end=1.0) == ""
