"""Complex eigenvalues: lines of modes, and linear analysis beside the motion."""

import json

import numpy as np
import pytest
import xarray as xr

from disc_model.data.variables import OUTCOMES_TO_HORIZON
from disc_model.figures.drawing import BLACK
from disc_model.figures.growing_parts import growing_part
from disc_model.figures.kinds import kind_of
from disc_model.figures.render import render
from disc_model.figures.selection import common_points
from disc_model.figures.sliding_modes import lines_of
from disc_model.figures.sliding_outcome import AGREEMENTS, ROUNDING, agreement
from tests.figures.made_up import sliding_modes
from tests.figures.reading import labels
from tests.studies.conftest import SMALL, computed

SCAN = {"start": 0, "stop": 0.4, "count": 5}


@pytest.fixture(scope="module")
def over_mu() -> xr.Dataset:
    options = {"parameter": "mu_k", "scan": SCAN}
    return computed(
        quantity="sliding", options=options, base={"Omega": 20, **SMALL}, axes={"N": [200]}
    )


def test_modes_are_drawn_along_the_parameter(over_mu: xr.Dataset) -> None:
    figure = render(kind_of("sliding_modes")(highest=900.0), {"study": xr.DataTree(over_mu)})
    assert figure.axes[0].get_ylim()[1] == 900
    assert len(figure.axes[1].lines) >= 4
    assert "Kinetic friction $μ_k$" in [
        label for ax in figure.axes for label in (ax.get_xlabel(), ax.get_ylabel())
    ]


def test_modes_have_thick_lines_where_they_grow(over_mu: xr.Dataset) -> None:
    figure = render(kind_of("sliding_modes")(), {"study": xr.DataTree(over_mu)})
    shown = [line for line in figure.axes[1].lines if line.get_marker() == "."]
    thickest = max(line.get_linewidth() for line in shown)
    heights = [line.get_ydata() for line in shown if line.get_linewidth() == thickest]
    thick = np.concatenate(heights)
    rates = over_mu["mode_growth_rate"].values
    growing = rates[rates > ROUNDING]
    assert growing.size
    np.testing.assert_array_equal(np.sort(thick[np.isfinite(thick)]), np.sort(growing))


def test_thick_lines_begin_where_the_growth_rate_is_zero() -> None:
    """They began at the next value of the parameter, where the mode had grown for long."""
    figure = sliding_modes()
    for ax, height in zip(figure.axes, (131 + 1 / 3, 0.0), strict=True):
        lines = [line for line in ax.lines if line.get_color() == BLACK]
        thick = max(lines, key=lambda line: line.get_linewidth())
        at = np.flatnonzero(np.isfinite(thick.get_ydata()))[0]
        assert thick.get_xdata()[at] == pytest.approx(0.2 + 0.1 / 3)
        assert thick.get_ydata()[at] == pytest.approx(height)


@pytest.mark.parametrize(
    ("rates", "ends"),
    [
        ([-1.0, 1.0, -3.0], [0.5, 1.25]),
        ([3.0, -1.0, 1.0], [0.75, 1.5]),
        ([np.nan, 1.0, 1.0], []),
        ([0.0, 1.0, 1.0], [0.0]),
    ],
)
def test_a_mode_grows_from_the_zeros_of_its_rate_on(rates: list[float], ends: list[float]) -> None:
    along = np.arange(3.0)
    x, y = growing_part(along, np.array(rates), 10 * along)
    assert x[np.isfinite(y)].tolist() == sorted([*ends, *along[np.array(rates) > 0]])
    np.testing.assert_allclose(y[np.isfinite(y)], 10 * x[np.isfinite(y)])


def test_modes_below_the_axis_of_growth_are_named(over_mu: xr.Dataset) -> None:
    """A mode that decays fast was among the frequencies and missing among the growth rates."""
    rates = over_mu["mode_growth_rate"]
    in_plane = over_mu["diameters"] == -1
    assert in_plane.any()
    fast = over_mu.assign(mode_growth_rate=rates.where(~in_plane, -50.0))
    kept = over_mu.assign(mode_growth_rate=rates.where(rates > 0, 1e-3 * rates))
    figure = render(kind_of("sliding_modes")(), {"study": xr.DataTree(fast)})
    lowest = -figure.axes[1].get_ylim()[0]
    [entry] = [text for text in labels(figure) if text.startswith("decays faster")]
    assert entry.startswith(f"decays faster than {lowest:.3g}/s: in-plane")
    assert [line for line in figure.axes[1].lines if line.get_marker() == "v"]
    figure = render(kind_of("sliding_modes")(), {"study": xr.DataTree(kept)})
    assert not [text for text in labels(figure) if text.startswith("decays faster")]
    assert not [line for line in figure.axes[1].lines if line.get_marker() == "v"]


def test_linear_analysis_beside_the_motion() -> None:
    """Each word of the figure, and what no word describes."""
    rate = np.array([-1.0, -1, -1, 1, 1, 1, 1, np.nan])
    outcome = np.array(
        [
            "quiet",
            "other_cycle",
            "separation",
            "at_rest",
            "growing",
            "separation",
            "undecided",
            "quiet",
        ]
    )
    assert [*agreement(rate, outcome)] == [*[*AGREEMENTS][:6], "unknown", "unknown"]
    # without a damper sliding is neutral, and its rate is nothing but rounding
    neutral = np.array([ROUNDING / 2, 2 * ROUNDING])
    words = agreement(neutral, np.array(["quiet", "quiet"]))
    assert [*words] == ["stable_quiet", "unstable_quiet"]


def test_the_comparison_is_drawn_where_both_studies_have_points() -> None:
    options = {"parameter": "c_p", "scan": SCAN}
    sliding = computed(
        quantity="sliding", options=options, base={"Omega": 20, **SMALL}, axes={"N": [200, 400]}
    )
    flags = {"flag_meanings": " ".join(OUTCOMES_TO_HORIZON)}
    values = {"N": [200.0, 300, 400], "c_p": np.linspace(0, 0.4, 9)}
    outcome = np.full((3, 9), OUTCOMES_TO_HORIZON.index("separation"))
    attrs = sliding.attrs | {"options": json.dumps({"horizon": 600})}
    plane = xr.Dataset({"outcome": (("N", "c_p"), outcome, flags)}, values, attrs)
    shared, other = common_points(plane, sliding.rename(value="c_p"), ("N", "c_p"))
    assert dict(shared.sizes) == {"N": 2, "c_p": 5}
    assert other.sizes["c_p"] == 5
    plot = kind_of("sliding_outcome")(x="c_p", y="N", overlays={"sliding": "s"})
    figure = render(plot, {"study": xr.DataTree(plane), "sliding": xr.DataTree(sliding)})
    growing = float((sliding["largest_growth_rate"] > 0).mean())
    texts = [text.get_text() for text in figure.legends[0].get_texts()]
    assert (
        figure.legends[0].get_title().get_text()
        == "Motions of 600 s, in % of points. Steady sliding is"
    )
    assert f"{AGREEMENTS['unstable_separates'].label}: {100 * growing:.0f}\u00a0%" in texts


@pytest.mark.parametrize(
    ("rate", "outcome", "word"),
    [
        (-1.0, "quiet", "stable_quiet"),
        (1e-12, "at_rest", "stable_quiet"),
        (1.0, "at_rest", "unstable_quiet"),
        (1.0, "steady_sliding", "unstable_quiet"),
        (-1.0, "other_cycle", "stable_grows"),
        (1.0, "growing", "unstable_grows"),
        (-1.0, "separation", "stable_separates"),
        (1.0, "undecided", "unknown"),
        (np.nan, "quiet", "unknown"),
    ],
)
def test_sliding_is_compared_with_what_the_motion_does(
    rate: float, outcome: str, word: str
) -> None:
    """Growth of undamped modes by rounding is none."""
    rates = np.array([rate])
    outcomes = np.array([outcome])
    [found] = agreement(rates, outcomes)
    assert found == word


def two_of_modes(count: int, study: xr.Dataset) -> xr.Dataset:
    """A study with room for two of its modes, and a larger growth rate than theirs."""
    few = study.isel(mode=[0, 1])
    largest = few["mode_growth_rate"].max("mode")
    few["largest_growth_rate"] = largest + 1.0
    few["n_modes"] = count
    return few


def test_modes_without_room_are_told_from_growth_at_rest(over_mu: xr.Dataset) -> None:
    """The line of the most unstable mode was called "0 Hz" where the study had no room for it."""
    drawn = lines_of(two_of_modes(4, over_mu).isel(N=0))
    known = [line for line in drawn if np.isfinite(line.rate).all()]
    most_unstable = known[-1]
    assert most_unstable.name == "not computed"
    assert np.isnan(most_unstable.frequency).all()


def test_growth_of_no_frequency_is_at_rest_where_all_modes_have_room(over_mu: xr.Dataset) -> None:
    drawn = lines_of(two_of_modes(2, over_mu).isel(N=0))
    most_unstable = drawn[-1]
    assert most_unstable.name == "0 Hz"
