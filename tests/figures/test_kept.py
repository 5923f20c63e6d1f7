"""Figures that are closed leave nothing behind, whatever was known of their axes."""

import gc
import weakref
from collections.abc import Callable
from typing import Any

import pytest
from matplotlib import pyplot
from matplotlib.figure import Figure

import disc_model as dm
from tests.figures.test_wishes import DRAWN, branch


def with_gap(**wishes: Any) -> Any:
    """A line with points that have no value, which are marked in rows above it."""
    case = dm.Parameters(N=300, Omega=18)
    study = dm.sweep(dm.floquet, case, mu_k=[0.1, 0.15, 0.2, 0.25, 0.3, 0.35])
    return dm.plot_sweep(study, "growth_rate", **wishes)


def without_legend(**wishes: Any) -> Any:
    """A picture with entries for the legend of its reader."""
    return branch().plot("period", legend=False, **wishes)


PICTURES: dict[str, Callable[..., Any]] = {
    "gap": with_gap,
    "branch": DRAWN["branch"],
    "without legend": without_legend,
    "portrait": DRAWN["portrait"],
}


def drawn_twice(name: str) -> Figure:
    """Two pictures of a kind on the same axes."""
    figure, ax = pyplot.subplots()
    for _ in range(2):
        PICTURES[name](ax=ax)
    return figure


@pytest.mark.parametrize("name", PICTURES)
def test_a_closed_figure_is_forgotten(name: str) -> None:
    """Lines and texts that were known of axes kept these for ever, a megabyte or more for a figure."""
    known = weakref.ref(drawn_twice(name))
    pyplot.close("all")
    gc.collect()
    assert known() is None
