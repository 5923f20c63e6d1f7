"""Pictures of bifurcations in which some motions have no events, or had not settled: a figure of a study, a
curve, and a sweep say the same of them."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes

import disc_model as dm
from disc_model.analysis.classify import ANSWER
from disc_model.data.variables import LONG_TERM_OUTCOMES, PHASES
from disc_model.figures.gap_rows import rows_above
from tests.figures.every_kind import column, flag, over, stated
from tests.figures.made_up import status
from tests.figures.reading import draw

NAN = np.nan
SPEEDS = [8.0, 9.0, 10.0, 11.0]
SLIDES = 10.0


def study_of(section: str, settled: list[str], phases: list[str]) -> xr.Dataset:
    """Motions at four speeds, of which one slides steadily."""
    angles = np.array([0.031, 0.035, 0.028, 0.033])
    angles[np.array(phases) == "none"] = NAN
    kinds = ["other_cycle", "separating", "steady_sliding", "undecided"]
    data = {
        "psi": (
            ("Omega", "sample"),
            np.column_stack([angles, angles]),
            column("bifurcation", "psi"),
        ),
        "phase": flag(("Omega", "sample"), [[phase] * 2 for phase in phases], ("none", *PHASES)),
        "settled": flag(("Omega",), settled, ANSWER.flags),
        "kind": flag(("Omega",), kinds, LONG_TERM_OUTCOMES),
        "period_events": ("Omega", [1, 2, 0, 0], column("bifurcation", "period_events")),
        "status": status(("Omega",), ["ok"] * 4),
    }
    words = {**stated(section=section), "quantity": "bifurcation"}
    return xr.Dataset(data, over(Omega=np.array(SPEEDS), sample=np.arange(2)), words)


SETTLED = ["settled", "settled", "settled", "undecided"]
PHASES_AT = {
    "event": ["stick", "separation", "none", "separation"],
    "stroboscopic": ["slip", "slip", "slip", "slip"],
}


@pytest.fixture(params=["event", "stroboscopic"])
def study(request: pytest.FixtureRequest) -> xr.Dataset:
    return study_of(request.param, SETTLED, PHASES_AT[request.param])


def line_called(ax: Axes, name: str) -> Any:
    """The marks that a legend calls by a name."""
    [found] = [line for line in ax.lines if line.get_label() == name]
    return found


def marked(ax: Axes, reason: str) -> list[float]:
    """The places that are marked above a panel for a reason."""
    rows = [each for each in rows_above(ax) if each.words.get_text() == reason]
    return [float(place) for each in rows for row in each.rows for place in row.get_xdata()]


def test_steady_sliding_is_no_motion_that_is_not_shown_to_repeat(study: xr.Dataset) -> None:
    """Of samples once a turn it was marked as such; at events it was left out."""
    _, ax, *_ = draw("bifurcation", study, x="Omega").axes
    assert line_called(ax, "steady sliding").get_xdata().tolist() == [SLIDES]
    assert line_called(ax, "not shown to repeat").get_xdata().tolist() == [11.0]


def test_a_curve_and_a_sweep_say_so_of_periods_above_the_panel(study: xr.Dataset) -> None:
    """A curve joined zeros by a line."""
    curve, *_ = draw("curve", study, x="Omega", variable="period_events").axes
    for ax in (curve, dm.plot_sweep(study, "period_events")):
        assert marked(ax, "steady sliding") == [SLIDES]
        assert marked(ax, "not shown to repeat") == [11.0]


def test_a_sweep_says_so_of_angles_at_events() -> None:
    ax = dm.plot_sweep(study_of("event", SETTLED, PHASES_AT["event"]), "psi")
    assert marked(ax, "steady sliding") == [SLIDES]
    assert SLIDES not in marked(ax, "kind of motion")
    assert len(rows_above(ax)) == 2
