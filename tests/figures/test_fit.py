"""Measurements beside what a fitted case computes of them, in percent and in standard deviations."""

from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib import pyplot

from disc_model.figures.fit import plot_fit
from disc_model.figures.sizes import COLUMN, PAGE
from disc_model.figures.symbols import without_font
from disc_model.fitting.result import Combined, Fitted

FRICTION = Fitted(0.419988, 0.00055, 0.4189, 0.4211)
STIFFNESS = Fitted(19000.7, 21.0, 18959.5, 19041.9)


def made_up(**changes: Any) -> Any:
    """Three measurements: one exceeded by 10 %, one of which 4 standard deviations are missing, and
    one of zero, of which there is no percentage."""
    measurements = [
        SimpleNamespace(quantity="first", at={}, value=200.0, uncertainty=4.0),
        SimpleNamespace(quantity="second", at={}, value=-50.0, uncertainty=2.0),
        SimpleNamespace(quantity="third", at={}, value=0.0, uncertainty=0.5),
    ]
    computed = np.array([220.0, -58.0, 0.25])
    fit = {"measurements": measurements, "computed": computed, "chi_squared": 41.25}
    fit |= {"parameters": {"mu_s": FRICTION, "k_p": STIFFNESS}, "limits": {}, "at_bounds": {}}
    fit |= {
        "doubt": "",
        "gap": None,
        "converged": True,
        "misses": False,
        "share_text": "0.07 % of fits of the right model are this bad",
        "confidence": 0.95,
    }
    fit |= {"indistinct": (), "determined": {}, "unpredicted": {}, "outside": {}, "reached": ()}
    fit |= {"freedom": 1, "deviations": np.array([5.0, -4.0, 0.5])}
    return SimpleNamespace(**{**fit, **changes})


@pytest.fixture
def panels() -> Any:
    yield plot_fit(made_up())
    pyplot.close("all")


def computed_of(ax: Any) -> tuple[list[float], list[float]]:
    [line] = [line for line in ax.lines if line.get_marker() == "D"]
    return line.get_xdata().tolist(), line.get_ydata().tolist()


def test_differences_are_in_percent_of_what_was_measured(panels: Any) -> None:
    left, _ = panels
    shift, rows = computed_of(left)
    assert shift == pytest.approx([10.0, -16.0])
    assert rows == [2, 1], "the first on top"
    [bars] = left.containers
    segments = bars[2][0].get_segments()
    half = [segment[1, 0] for segment in segments]
    assert half == pytest.approx([2.0, 4.0])
    [said] = left.texts
    assert (said.get_text(), said.get_position()[1]) == ("measured 0, which has no %", 0)
    assert [text.get_text() for text in left.get_yticklabels()] == ["first", "second", "third"]
    assert left.get_xlabel() == "Difference from the measured value (%)"


def test_deviations_are_in_standard_deviations_of_which_two_are_expected(panels: Any) -> None:
    _, right = panels
    deviations, rows = computed_of(right)
    assert deviations == [5.0, -4.0, 0.5]
    assert rows == [2, 1, 0]
    assert right.get_xlim() == pytest.approx((-5.5, 5.5))
    [band] = right.patches
    assert (band.get_x(), band.get_x() + band.get_width()) == (-2.0, 2.0)
    assert right.get_title(loc="left") == "chi squared 41.2, 1 degree of freedom"
    assert right.get_xlabel() == "Deviation (standard deviations)"


def test_the_legend_says_what_the_band_is(panels: Any) -> None:
    """It was said on a page of the documentation only."""
    legend = panels[0].figure.legends or [ax.get_legend() for ax in panels if ax.get_legend()]
    said = [text.get_text() for text in legend[0].get_texts()]
    assert "95 % if the fit is right" in said


@pytest.mark.parametrize("beside", [True, False])
def test_rows_of_readers_panels_are_level_and_named_once(beside: bool) -> None:
    """Panels that share no axis had other limits, and numbers for names."""
    _, axes = pyplot.subplots(*((1, 2) if beside else (2, 1)), figsize=(7, 4))
    left, right = plot_fit(made_up(), ax=axes)
    assert right.get_ylim() == left.get_ylim()
    assert right.get_yticks().tolist() == left.get_yticks().tolist() == [2, 1, 0]
    named = [text.get_text() for text in right.get_yticklabels() if text.get_visible()]
    shown = right.yaxis.get_tick_params()["labelleft"]
    assert shown is not beside
    if shown:
        assert named == ["first", "second", "third"]
    pyplot.close("all")


@pytest.mark.parametrize("shared", [True, False])
@pytest.mark.parametrize("layout", ["constrained", None])
def test_panels_beside_each_other_are_stacked_in_a_column(layout: Any, shared: bool) -> None:
    """In 84 mm they were 10 mm wide each, and their labels lay over each other."""
    size = (COLUMN, 60 / 25.4)
    figure, axes = pyplot.subplots(1, 2, figsize=size, layout=layout, sharey=shared)
    upper, lower = plot_fit(made_up(), ax=axes)
    figure.draw_without_rendering()
    assert figure.get_figwidth() == COLUMN
    assert lower.bbox.y1 < upper.bbox.y0
    labels = upper.xaxis.get_tightbbox()
    title = lower.title.get_window_extent()
    for ax in (upper, lower):
        assert ax.bbox.width > 0.4 * figure.bbox.width
        assert ax.yaxis.get_tick_params()["labelleft"], "each names its rows"
        boxes = [text.get_window_extent() for text in ax.get_yticklabels()]
        assert all(above.y0 >= below.y1 for above, below in pairwise(boxes))
    assert labels.y0 >= title.y1 - 1
    assert lower.get_legend().get_window_extent().y0 >= 0
    pyplot.close("all")


@pytest.mark.parametrize(
    ("quantity", "at", "said"),
    [
        ("period", {"Omega": 12.0}, "period, Ω = 12 rad/s"),
        ("slip_time", {"Omega": "100 rpm"}, "duration of slip, Ω = 100 rpm"),
        ("growth_rate", {}, "growth rate"),
        ("frequency_2_0", {}, "frequency of mode (2, 0)"),
        ("damping_ratio_3_1", {"k_p": 8000.0}, "damping ratio of mode (3, 1), $k_p$ = 8 kN/m"),
        ("coupled_frequency_1", {}, "frequency 1 of disc and slider"),
    ],
)
def test_rows_name_measurements_by_words_symbols_and_units(
    quantity: str, at: dict[str, Any], said: str
) -> None:
    """They were names of arguments, such as slip_time (Omega=12)."""
    fit = made_up()
    fit.measurements[0] = SimpleNamespace(quantity=quantity, at=at, value=200.0, uncertainty=4.0)
    left, _ = plot_fit(fit)
    assert without_font(left.get_yticklabels()[0].get_text()) == said
    pyplot.close("all")


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({}, "$μ_s$ = 0.41999 ± 0.00055, $k_p$ = 19.001 ± 0.021 kN/m"),
        (
            {"doubt": "not apart", "indistinct": ("mu_s", "k_p")},
            "$μ_s$ = 0.42, $k_p$ = 19 kN/m, $μ_s$ and $k_p$ not determined apart",
        ),
        (
            {"doubt": "at 0", "at_bounds": {"mu_s": 0.0}, "limits": {"mu_s": 0.45}},
            "$μ_s$ < 0.45 at 95 % confidence, $k_p$ = 19 kN/m",
        ),
        (
            {
                "doubt": "not converged",
                "converged": False,
                "at_bounds": {"k_p": 20000.0},
                "reached": ("k_p",),
            },
            "$μ_s$ = 0.42, $k_p$ = 20 kN/m at its bound, the search has not converged",
        ),
        (
            {"doubt": "near 0", "at_bounds": {"mu_s": 0.0, "k_p": 0.0}},
            "$μ_s$ = 0.42 (interval passes 0), $k_p$ = 19 kN/m (interval passes 0 kN/m)",
        ),
        (
            {"doubt": "no case", "outside": {"mu_s": (0.3,)}},
            "$μ_s$ = 0.42, $k_p$ = 19 kN/m, no case at an end of the interval of $μ_s$",
        ),
        (
            {"doubt": "wrong", "misses": True},
            "$μ_s$ = 0.42, $k_p$ = 19 kN/m, model or uncertainties may be wrong "
            "(0.07 % of fits of the right model are this bad)",
        ),
        (
            {"doubt": "wrong", "misses": True, "freedom": 0},
            "$μ_s$ = 0.42, $k_p$ = 19 kN/m, model or uncertainties are wrong",
        ),
        (
            {"determined": {"mu_s * k_p^2": Combined(400.0, 3.0, "in SI units")}, "doubt": "doubt"},
            "$μ_s$ = 0.42, $k_p$ = 19 kN/m, $μ_s$ · $k_p$² = 400 ± 3 in SI units",
        ),
    ],
)
def test_the_title_states_fitted_values_and_doubts(changes: dict[str, Any], said: str) -> None:
    """The picture named none."""
    left, _ = plot_fit(made_up(**changes))
    title = without_font(left.figure.get_suptitle())
    assert " ".join(title.split()) == said
    pyplot.close("all")


def test_a_legend_below_two_panels_is_below_the_labels_of_both() -> None:
    """It lay on the label of the first panel if this had more lines than that of the last."""
    figure, axes = pyplot.subplots(1, 2, figsize=(PAGE, 2.8), layout="constrained")
    fit = made_up()
    fit.measurements[0].quantity = "duration of stick, with 14.8 rad/s"
    left, right = plot_fit(fit, ax=axes)
    figure.draw_without_rendering()
    assert left.get_xlabel().count("\n") > right.get_xlabel().count("\n")
    top = right.get_legend().get_window_extent().y1
    assert top <= left.xaxis.get_tightbbox().y0
    pyplot.close("all")


def test_a_narrow_panel_has_no_title_of_many_lines() -> None:
    """How good the fit is took six lines above a panel of a grid in a column."""
    figure, axes = pyplot.subplots(2, 2, figsize=(COLUMN, COLUMN), layout="constrained")
    _, right = plot_fit(made_up(), ax=axes[0])
    assert right.get_title(loc="left") == ""
    [legend] = [ax.get_legend() for ax in axes[0] if ax.get_legend()]
    assert legend.get_title().get_text() == "chi squared 41.2, 1 degree of freedom"
    pyplot.close(figure)
