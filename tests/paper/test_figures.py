"""The paper's figures, as config/paper.yaml describes them."""

import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

from disc_model import Parameters, Window, simulate
from disc_model.data.variables import flag_names
from disc_model.figures.kinds import CasePlot
from disc_model.figures.render import render
from disc_model.figures.sizes import COLUMN, PAGE
from disc_model.studies.study import load_study
from tests.damages import DAMAGES, damaged
from tests.figures.reading import assert_fit_for_print, labels
from tests.figures.test_cases import RECORDED, said_in, simulated
from tests.paper import evidence
from workflow.paper.figures.motion_around import motion_of

STUDY = load_study(Path(__file__).parents[2] / "config" / "paper.yaml")
FIGURES = {name: plot for name, plot in STUDY.figures.items() if isinstance(plot, CasePlot)}
ONE_OF_EACH = list({plot.kind: name for name, plot in FIGURES.items()}.values())
"""A figure of each kind."""
MOVED = {
    "fig26": {"zooms": (("spectrum_c", 54.0), ("spectrum_d", 57.0))},
    "fig28": {"zooms": (("spectrum_d", 56.5), ("spectrum_d", 57.0))},
    "composite": {"force": ("spectrum_d", 57.0)},
}
"""Closer looks at times that the case has."""


def drawn(name: str, case: xr.DataTree) -> Figure:
    plot = FIGURES[name].model_copy(update=MOVED.get(name, {}))
    return render(plot, dict.fromkeys(plot.cases, case))


@pytest.mark.parametrize(
    ("name", "separates"),
    [*((name, True) for name in FIGURES), *((name, False) for name in ONE_OF_EACH)],
)
def test_figures_are_fit_for_print(name: str, separates: bool) -> None:
    figure = drawn(name, simulated(separates))
    assert figure.get_figwidth() in (COLUMN, PAGE)
    assert figure.get_suptitle() == "", "the caption says it"
    assert_fit_for_print(figure)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("damage", DAMAGES)
@pytest.mark.parametrize("name", ONE_OF_EACH)
def test_what_a_case_does_not_hold_leaves_panels_empty(name: str, damage: str) -> None:
    """A failed case, a window without what a figure needs, a section without points: all ended the
    figure before."""
    figure = drawn(name, damaged(simulated(True), DAMAGES[damage]))
    figure.draw_without_rendering()
    reasons = [text for text in said_in(figure) if text.startswith("not shown: the case ")]
    if damage in ("failed", "nothing recorded"):
        assert all(ax.texts for ax in figure.axes if not ax.has_data())
        lacks = (f"did not record {window}" for window in (*RECORDED, "poincare", "events"))
        if damage == "failed":
            known = {"failed"}
        else:
            known = {*lacks}
        assert set(reasons) <= {f"not shown: the case {reason}" for reason in known}


def test_the_composite_has_phases_from_events() -> None:
    """From samples at 4 kHz sticks of 0.94 and 0.78 ms had 0.7 to 1.1 ms, in no order."""
    case = simulated(True)
    force = drawn("composite", case).axes[2]
    events = case["events"].to_dataset()
    kinds = flag_names(events["kind"])
    times = events["time"].values
    begins = times[(kinds == "separation") & (times > 57) & (times < 57.04)]
    ends = times[(kinds == "reattachment") & (times > 57) & (times < 57.04)]
    shown = {1e3 * (time - 57) for time in (*begins, *ends)}
    bars = {
        x for patch in force.patches for x in (patch.get_x(), patch.get_x() + patch.get_width())
    }
    assert len(shown) >= 8
    for time in shown:
        assert min(abs(time - bar) for bar in bars) < 1e-9


def test_captions_say_nothing_that_a_legend_finds_out() -> None:
    """A caption said "not shown to have settled" of points that the legend called settled."""
    for name, plot in STUDY.figures.items():
        if plot.kind == "poincare":
            assert not re.search(r"settled|in contact|crosses|dots|triangles", plot.caption), name


def test_areas_of_the_figure_on_both_scales_have_names() -> None:
    """Two names stood on white, which was a third area."""
    plot = STUDY.figures["figB2"]
    maps = evidence.scans()
    figure = render(
        plot,
        {"study": xr.DataTree(maps["map_N"]), **{n: xr.DataTree(maps[n]) for n in plot.overlays}},
    )
    named = ["with neither", "only as published", "only by Eq. (17)", "with both"]
    assert labels(figure)[:4] == named
    assert not [text for text in figure.axes[1].texts if "only" in text.get_text()]


# ---- the whole disc


@pytest.fixture(scope="module")
def case() -> xr.DataTree:
    """A light disc that turns and separates soon; three modes, five angles."""
    p = Parameters(N=300, Omega=50, n_diameters=2, normalization="orthonormal")
    windows = [Window(start=0.5, stop=0.52, rate=2e4, theta=1.2 * j) for j in range(5)]
    windows.append(Window(start=0.5, stop=0.52, rate=2e4, theta=2.1))
    names = [*(f"around{j}" for j in range(5)), "elsewhere"]
    return simulate(p, 0.52, dict(zip(names, windows, strict=True))).to_tree()


@pytest.mark.compiled
def test_the_disc_between_the_angles_is_the_disc(case: xr.DataTree) -> None:
    """Under the slider, and at an angle that the shape is not made from; to rounding of the
    displacement itself."""
    motion = motion_of(case)
    r_0 = np.array([motion.parameters.r_0])
    elsewhere = case["elsewhere"].to_dataset()
    size = float(np.abs(elsewhere["w"]).max())
    for i in range(0, motion.time.size, 20):
        under, there = motion.deflection(i, r_0, np.array([motion.slider[i], 2.1]))[0]
        assert under == pytest.approx(float(elsewhere["w"][i]), abs=1e-12 * size)
        assert there == pytest.approx(float(elsewhere["w_point"][i]), abs=1e-12 * size)

    p = motion.parameters
    w = np.abs(
        motion.deflection(10, np.array([p.a, p.a + 1e-3 * (p.b - p.a), p.b]), np.linspace(0, 6, 7))
    ).max(axis=1)
    assert w[0] < 1e-9 * w[2], "it is clamped inside"
    assert 0 < w[1] < 1e-5 * w[2]  # it leaves its plane with the square of the distance


def test_the_figure_on_both_scales_counts_what_vanishes() -> None:
    """In the maps as told all nine separate with both; then two do with the published scale
    only."""
    plot = STUDY.figures["figB2"]
    changes = {name: {"first_separation": [[[90]], [[np.nan]]]} for name in ("map_m", "map_D_star")}
    for lost, maps in ((0, evidence.scans()), (2, evidence.scans(**changes))):
        figure = render(
            plot,
            {
                "study": xr.DataTree(maps["map_N"]),
                **{n: xr.DataTree(maps[n]) for n in plot.overlays},
            },
        )
        notes = [text.get_text() for text in figure.axes[2].texts if "arrows" in text.get_text()]
        assert notes == [f"arrows: no separation\nby Eq. (17), {lost} of 9"][:lost]
