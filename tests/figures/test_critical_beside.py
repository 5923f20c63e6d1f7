"""Pictures of critical values: several on the same axes, and steady sliding in the place of a cycle."""

from typing import Any

import numpy as np

import disc_model as dm
from disc_model.figures.critical_beside import UNSTABLE
from disc_model.figures.critical_curve import MISSING
from disc_model.stability.critical_values import Critical
from tests.figures.test_wishes import legend_texts

CASE = dm.Parameters(N=385, Omega=12)


def made(case: dm.Parameters = CASE, **further: Any) -> Critical:
    """Critical speeds as of a search that finds the motion unstable from 11 rad/s on."""
    values: dict[str, Any] = {
        "parameters": case,
        "name": "Omega",
        "value": 11.0,
        "crossings": np.array([11.0]),
        "unstable_above": np.array([True]),
        "values": np.array([10.0, 11.0, 12.0]),
        "growth_rate": np.array([-0.1, 0.1, 0.2]),
        "resolution": 1.0,
    }
    return Critical(**{**values, **further})


def in_sliding() -> Critical:
    rates = np.array([-0.1, np.nan, np.nan])
    sliding = np.array([np.nan, 0.02, 0.03])
    return made(growth_rate=rates, _sliding_growth_rate=sliding)


def lines_with(ax: Any, group: str) -> list[Any]:
    return [line for line in ax.lines if line.get_gid() == group]


def test_each_of_two_has_a_name_a_look_and_a_mark() -> None:
    ax = made().plot()
    made(CASE.replace(N=450)).plot(ax=ax)
    assert legend_texts(ax) == ["N = 385 N", "N = 450 N", "bar: unstable near the static start"]
    one, other = lines_with(ax, UNSTABLE)
    assert one.get_color() != other.get_color()
    assert one.get_marker() != other.get_marker()
    assert one.get_ydata()[0] != other.get_ydata()[0]


def test_values_without_a_cycle_stay_in_the_legend() -> None:
    ax = made(growth_rate=np.array([-0.1, np.nan, 0.2])).plot()
    made(CASE.replace(N=450)).plot(ax=ax)
    assert "no cycle found" in legend_texts(ax)
    assert len(lines_with(ax, MISSING)) == 1


def test_steady_sliding_is_drawn_where_it_takes_the_place_of_a_cycle() -> None:
    ax = in_sliding().plot()
    texts = [text.get_text() for legend in ax.figure.legends for text in legend.get_texts()]
    assert "steady sliding, where no cycle exists" in texts
    assert "no cycle found" not in texts
    assert ax.get_ylabel().replace("\n", " ") == "Growth rate of the cycle, or of sliding (1/s)"
