"""Figures of motions over one parameter: bifurcation diagrams, basins, ramps."""

import re

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_rgb
from matplotlib.text import Annotation

from disc_model.figures import ramps as drawn
from disc_model.figures.basins import LARGEST
from disc_model.figures.borders import Curve
from disc_model.figures.classes import LOOKS
from disc_model.figures.drawing import BLACK, GREY, SEPARATED
from disc_model.studies.quantities.branches import Branches
from disc_model.studies.quantities.ramps import Ramps
from disc_model.studies.quantity import STATUSES
from tests.figures.reading import crosses, draw, labels, lines
from tests.studies.conftest import computed, made_up_samples, with_failed
from tests.studies.quantities.test_basins import Made, made

__all__ = ["made"]

# ---- bifurcation diagrams


def test_diagrams_mark_points_that_failed_and_not_those_that_slide() -> None:
    samples, exponents = made_up_samples()
    axes = draw(
        "bifurcation", with_failed(samples, N=2), {"lyapunov": with_failed(exponents, N=3)}, x="N"
    ).axes
    assert [crosses(ax) for ax in axes] == [[[2]], [], [[3]]]
    assert axes[0].lines[0].get_xdata().tolist() == [1, 1, 3, 3]
    samples["phase"][{"N": slice(1, None)}] = 0  # not reached
    samples["kind"][1] = samples["kind"].attrs["flag_meanings"].split().index("steady_sliding")
    ax = draw("bifurcation", samples, x="N").axes[0]
    assert not crosses(ax)
    assert lines(ax)["steady sliding"].get_xdata() == [2]
    assert lines(ax)["no event while sampled"].get_xdata() == [3]


def test_bands_of_exponents_are_as_wide_as_the_legend_says() -> None:
    samples, exponents = made_up_samples()
    exponents["exponent_error"] = 0.2 * exponents["exponent_error"]
    ax = draw("bifurcation", samples, {"lyapunov": exponents}, x="N").axes[2]
    [errors] = re.findall(r"± (\d+) standard errors", " ".join(labels(ax)))
    heights = ax.collections[0].get_paths()[0].vertices[:, 1]
    half_width = 0.2 * int(errors)
    assert (heights.min(), heights.max()) == pytest.approx((1 - half_width, 1 + half_width))


def test_stable_stretches_are_thick_and_jumps_have_arrows(monkeypatch: pytest.MonkeyPatch) -> None:
    """A quiet branch with a fold at 13, and one that separates above it."""
    values = {
        "status": "ok",
        "n_branches": 2,
        "separations": [0, 2],
        "value": [[10.0, 12.0, 13.0, 12.0], [11.0, 14.0]],
        "range": [[1e-5, 2e-5, 3e-5, 1e-4], [2e-2, 3e-2]],
        "growth_rate": [[-0.1, -0.1, -0.01, 0.2], [-0.1, -0.1]],
        "sweep_range": np.array([[1e-5, 1e-5, 2e-5, 2e-5, 3e-2], [1e-5, 2e-2, 2e-2, 2e-2, 3e-2]]),
        "sweep_separation_rate": np.array([[0, 0, 0, 0, 135.0], [0, 135.0, 135.0, 135.0, 135.0]]),
        "sweep_settled": np.full((2, 5), 2),
        "sliding_growth_rate": [0.1, 0.1, -0.1, -0.1, -0.1],
    }
    monkeypatch.setattr(Branches, "compute_point", lambda *_, **__: (values, ""))
    options = {"scan": {"start": 10, "stop": 14, "step": 1}, "dwell": 1, "evaluation_time": 1}
    study = computed(
        quantity="branches",
        options=options,
        base={"N": 385},
        axes={"normalization": ["as_published"]},
    )
    figure = draw("branches", study, paper_cases={"F11": 12}, title="t")
    (ax,) = figure.axes
    thick = [line for line in ax.lines if line.get_linewidth() == 2 and len(line.get_xdata())]
    assert [(line.get_color(), [*line.get_xdata()]) for line in thick] == [
        (BLACK, [10, 12, 13]),
        (SEPARATED, [11, 14]),
        (GREY, [12, 13, 14]),  # steady sliding, which the text called thick and was not
    ]
    arrows = [
        text for text in ax.texts if isinstance(text, Annotation) and text.arrow_patch is not None
    ]
    assert [(arrow.xyann[0], arrow.xy[0]) for arrow in arrows] == [(13, 14), (11, 10)]


# ---- basins


@pytest.fixture
def shares(made: None, monkeypatch: pytest.MonkeyPatch) -> xr.Dataset:
    """All quiet at 12 rad/s, some at 13 and 14, none at 15."""
    monkeypatch.setattr(
        Made, "least", lambda _, p, i: {12: 9.0, 13: 0.5, 14: 0.05, 15: -1.0}[p.Omega]
    )
    options = {"energies": [0.01, 0.1, 1], "n_starts": 4}
    return computed(
        quantity="basins", options=options, base={"N": 385}, axes={"Omega": [12, 13, 14, 15]}
    )


def test_shares_attractors_and_kicks_are_drawn(shares: xr.Dataset) -> None:
    figure = draw("basins", shares, x="Omega")
    assert labels(figure) == ["quiet", "separating"]
    shown = [
        [bar.get_height() for bar in ax.patches] for ax in figure.axes[:3]
    ]  # quiet, then separating
    assert shown == [[1, 1, 1, 0, 0, 0, 0, 1], [1, 1, 0, 0, 0, 0, 1, 1], [1, 0, 0, 0, 0, 1, 1, 1]]
    starts = 12  # at three energies, each with four
    quiet = [*to_rgb(LOOKS["quiet"].face), 1.0]
    [marks] = [
        marks
        for marks in figure.axes[-2].collections
        if marks.get_offsets().size and np.allclose(marks.get_facecolor(), quiet)
    ]
    areas = zip(marks.get_offsets()[:, 0], marks.get_sizes(), strict=True)
    by_share = {float(x): float(area) / LARGEST for x, area in areas}
    assert by_share == pytest.approx({12.0: 1.0, 13.0: 8 / starts, 14.0: 4 / starts})
    kicks = lines(figure.axes[-1])["by bisection"].get_ydata()
    np.testing.assert_allclose(kicks, [np.nan, 0.5, 0.05, np.nan], rtol=0.06)
    # what separates without a kick has no place on a logarithmic scale, and is not left out
    assert [(text.xy[0], text.get_text()) for text in figure.axes[-1].texts] == [(15, "0")]
    assert crosses(draw("basins", with_failed(shares, Omega=13.0), x="Omega").axes[0]) == [[13]]


# ---- ramps


def test_onset_and_end_are_drawn_and_what_has_none_is_marked(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    values = {
        "status": "ok",
        "rate_status": np.array([0, 0, STATUSES.index("stalled")]),
        "onset_speed": np.array([15.3, np.nan, np.nan]),
        "top_separation_rate": np.array([135.0, 0.0, np.nan]),
        "offset_speed": np.array([9.7, 9.3, np.nan]),
    }
    monkeypatch.setattr(Ramps, "compute_point", lambda *_, **__: (values, ""))
    options = {
        "low": 8,
        "high": 20,
        "rates": {"start": 0.01, "stop": 1, "count": 3, "scale": "log"},
    }
    study = computed(
        quantity="ramps", options=options, base={"N": 385}, axes={"normalization": ["as_published"]}
    )
    folds = [
        Curve(np.array([15.0, 15.2]), np.array([380.0, 390.0]), "fold"),
        Curve(np.array([12.0, 12.5]), np.array([380.0, 390.0]), "neutral"),
        Curve(
            np.array([11.0, 11.2, np.nan, 30.0, 31.0]),
            np.array([380.0, 390.0, np.nan, 380.0, 390.0]),
            "fold",
        ),
    ]
    monkeypatch.setattr(drawn, "curves_of", lambda _: folds)
    ax = draw("ramps", study, {"curves": xr.Dataset()}, title="t").axes[0]
    shown = lines(ax)
    np.testing.assert_allclose(shown["onset, rising ramp"].get_ydata(), [15.3, np.nan, np.nan])
    np.testing.assert_allclose(shown["end, falling ramp"].get_ydata(), [9.7, 9.3, np.nan])
    assert list(shown["none up to the highest speed"].get_xdata()) == [0.1]
    assert list(shown["stable cycle ends (fold)"].get_ydata()) == pytest.approx([15.1, 15.1])
    assert [text.get_text() for text in ax.texts] == ["15.10"], (
        "the fold of another cycle, at 11 rad/s, was drawn too"
    )
