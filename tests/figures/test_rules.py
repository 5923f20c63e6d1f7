"""Figures of studies whose rule leaves points out."""

import numpy as np
import pytest
from matplotlib.figure import Figure

import disc_model as dm
from disc_model.figures.sliding_outcome import agreement
from tests.explorer.left_out import ruled
from tests.figures.reading import draw
from tests.refusals import refusal

OVER = {"x": "Omega", "y": "N"}


def panels_of(figure: Figure) -> list[str]:
    """The titles of the panels of a figure, without its bar of colours."""
    panels = [ax for ax in figure.axes if ax.get_xlabel()]
    return [ax.get_title(loc="left") for ax in panels]


@pytest.mark.parametrize("variable", ["outcome", "P_max"])
def test_a_map_has_no_panel_where_all_is_left_out(variable: str) -> None:
    """It had an empty one beside the other."""
    figure = draw("heat_map", ruled(), variable=variable, by="mu_s", **OVER)
    assert panels_of(figure) == ["Static friction $μ_s$\xa0=\xa00.4"]


def test_what_is_left_out_is_not_undecided() -> None:
    """It was counted among the undecided motions."""
    words = agreement(np.array([-1.0, np.nan]), np.array(["quiet", "excluded"]))
    assert words.tolist() == ["stable_quiet", "excluded"]


# ---- Scales of classes


def test_limits_of_a_logarithmic_axis_lie_above_zero() -> None:
    """They were ignored, with a warning of matplotlib."""
    study = ruled().isel(mu_s=1)
    with refusal("limits=.*: must lie above 0 on a logarithmic axis"):
        dm.plot_sweep(study, "P_max", "Omega", lines="N", log=True, limits=(0, 1))
