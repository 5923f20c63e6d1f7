"""Two fits have no room on the same axes."""

from matplotlib import pyplot

from disc_model.figures.fit import plot_fit
from tests.figures.test_fit import made_up
from tests.refusals import refusal


def test_a_second_fit_on_the_same_axes_is_refused() -> None:
    """It was drawn over the first one, whose rows and labels were gone."""
    axes = plot_fit(made_up())
    with refusal("shows a fit already: give each its own axes"):
        plot_fit(made_up(), ax=axes)
    pyplot.close("all")
