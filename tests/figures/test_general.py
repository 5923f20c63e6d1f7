"""Heat maps and curves of any variable: what is shown where, and on what scale."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from disc_model.figures.drawing import PAGE, panels
from disc_model.figures.gap_rows import rows_above
from disc_model.figures.kinds import kind_of
from disc_model.figures.outside_limits import note_outside
from disc_model.figures.style import save
from tests.figures.reading import draw, labels, lines
from tests.refusals import refusal


@pytest.fixture
def study() -> xr.Dataset:
    """Three variables over friction, damping and normalization: of both signs, of one, and
    words."""
    mu_k = np.array([0.1, 0.2, 0.3])
    c_p = np.array([0.01, 0.1, 1.0, 10.0])
    both = np.subtract.outer(mu_k, 0.2)[:, None, None] * np.ones((1, 4, 2)) + np.arange(2) * 0.01
    both[0, 0, 0] = np.nan
    dims = ("mu_k", "c_p", "normalization")
    words = {"flag_meanings": "ok no_cycle"}
    lost = np.isnan(both)
    return xr.Dataset(
        {
            "growth_rate": (
                dims,
                both,
                {"long_name": "growth rate of disturbances", "units": "s-1"},
            ),
            "drift": (dims, both, {"long_name": "drift", "units": "m s-1"}),
            "period": (dims, np.abs(both) + 1, {"long_name": "period", "units": "s"}),
            "status": (dims, ((both > 0) | lost).astype(np.int8), words),
        },
        {"mu_k": mu_k, "c_p": c_p, "normalization": ["as_published", "orthonormal"]},
    )


def mapped(study: xr.Dataset, variable: str, **phrase: Any) -> Figure:
    return draw("heat_map", study, variable=variable, x="c_p", y="mu_k", **phrase)


def test_axes_and_titles_have_the_units_of_the_reader(study: xr.Dataset) -> None:
    speeds = study.rename(mu_k="Omega", c_p="N").assign_coords(
        Omega=[10.0, 11.0, 12.0], N=[1e3, 2e3, 3e3, 4e3]
    )
    speeds = speeds.assign_attrs(
        base=json.dumps({"E": 7e10, "k": 6e4, "normalization": "orthonormal"})
    )
    plain, other = (
        draw("heat_map", speeds, variable="drift", x="Omega", y="N", **units)
        for units in ({}, {"units": {"Omega": "rpm", "N": "kN", "k": "N/mm"}})
    )
    assert all(text in plain.get_suptitle() for text in ("E = 70 GPa", "k = 60 kN/m"))
    assert "k = 60 N/mm" in other.get_suptitle()
    ax = other.axes[0]
    assert ax.get_xlabel() == "Speed Ω (rpm)"
    assert ax.get_ylabel() == "Preload N (kN)"
    assert ax.get_xlim() == plain.axes[0].get_xlim(), "what is drawn stays"
    other.canvas.draw()
    low, high = ax.get_xlim()
    for place, text in zip(ax.get_xticks(), ax.get_xticklabels(), strict=True):
        if low <= place <= high:
            turn = 2 * np.pi
            expected = place * 60 / turn
            shown = float(text.get_text())
            assert shown == pytest.approx(expected, rel=1e-5)
            assert float(text.get_text()) % 2.5 == pytest.approx(0, abs=1e-6), "round numbers"
    with refusal(r"units.N='1 rpm': must be a number in N"):
        draw("heat_map", speeds, variable="drift", x="Omega", y="N", units={"N": "rpm"})


def mesh(figure: Figure) -> Any:
    return figure.axes[0].collections[0]


def test_limits_end_the_scale_of_a_map(study: xr.Dataset) -> None:
    """In the unit of the bar: periods in ms."""
    figure = mapped(study, "period", limits=[1000.0, 1050.0])
    norm = mesh(figure).norm
    assert (norm.vmin, norm.vmax) == (1000.0, 1050.0)
    [bar] = [each.colorbar for ax in figure.axes for each in ax.collections if each.colorbar]
    assert bar.extend == "max"
    rates = mesh(mapped(study, "growth_rate", limits=[-0.2, -0.1])).norm
    assert (rates.vmin, rates.vmax) == (-0.2, -0.1)
    with refusal(r"limits=.*: is for numbers"):
        mapped(study, "status", limits=[0.0, 1.0])


@pytest.mark.parametrize("kind", ["heat_map", "curve"])
def test_limits_that_do_not_ascend_are_a_fault(kind: str) -> None:
    asked = {"kind": kind, "variable": "v", "x": "N", "limits": [1.0, 0.5]}
    dims = {"N": [1.0, 2.0]}
    if kind == "heat_map":
        asked["y"] = "Omega"
        dims["Omega"] = [1.0, 2.0]
    plot = kind_of(kind).model_validate(asked)
    [fault] = plot.faults_among(dims, {"v": tuple(dims)})
    assert "limits" in str(fault)
    assert "two ascending values" in str(fault)


def test_a_curve_has_a_line_for_each_value(study: xr.Dataset, tmp_path: Path) -> None:
    figure = draw(
        "curve",
        study,
        variable="growth_rate",
        x="mu_k",
        by="c_p",
        at={"normalization": "as_published"},
    )
    ax = figure.axes[0]
    names = [f"In-plane damper $c_p$ = {value} N s/m" for value in ("0.01", "0.1", "1", "10")]
    values = [name.partition(" = ")[2] for name in names]
    assert labels(figure) == [names[0], *values[1:]], "the dimension is named once"
    assert np.allclose(lines(ax)[values[2]].get_ydata(), [-0.1, 0, 0.1])
    assert [text.get_text() for text in ax.texts] == ["no cycle found"]
    [row] = rows_above(ax)
    [gone] = row.rows
    assert row.words is ax.texts[0], "named above its row"
    assert (gone.get_xdata(), gone.get_marker()) == ([0.1], lines(ax)[names[0]].get_marker()), (
        "that has no value there"
    )
    assert " ".join(ax.get_ylabel().split()) == "Growth rate of disturbances (1/s)"
    path = tmp_path / "curve.png"
    save(figure, path)
    ends = {"at": {"normalization": "as_published"}, "panels": [[0.1, 10], [1.0, 10]]}
    study["drift"] = study["drift"] + study["c_p"]
    axes = draw("curve", study, variable="drift", x="mu_k", by="c_p", **ends).axes
    assert [{text.get_text() for text in ax.texts} for ax in axes] == [
        {names[1], values[3]},
        {names[2], values[3]},
    ]
    legend = {"legend": True, **ends}
    axes = draw("curve", study, variable="drift", x="mu_k", by="c_p", **legend).axes
    shared, again = (lines(ax)[values[3]].get_color() for ax in axes)
    assert shared == again, "it had the colour of its place in each panel"
    axes = draw(
        "curve", study, variable="drift", x="mu_k", by="c_p", **ends | {"panels": "each"}
    ).axes
    titles = [" ".join(ax.get_title("left").split()) for ax in axes]
    assert titles[0] == "(a) In-plane damper $c_p$ = 0.01 N s/m"
    assert titles[1:] == ["(b) 0.1 N s/m", "(c) 1 N s/m", "(d) 10 N s/m"], "named once"


def test_lines_of_a_dimension_of_one_value_are_drawn(study: xr.Dataset) -> None:
    """Names for its value, or panels of it, ended in an error."""
    single = study.isel(normalization=slice(1), c_p=slice(1))
    for more in ({"names": {"0.01": "little"}}, {"panels": [[0.01]]}):
        ax = draw("curve", single, variable="period", x="mu_k", by="c_p", **more).axes[0]
        assert np.allclose(ax.lines[0].get_ydata()[1:], [1000.0, 1100.0])  # ms


def panel_of_levels(*levels: float) -> Axes:
    """A panel with level lines that are named by their heights."""
    _figure, [ax] = panels(PAGE, 2.4)
    for level in levels:
        ax.plot([0, 1], [level, level], label=str(level))
    return ax


def names_for_legend(ax: Axes) -> list[str]:
    """What a legend of a panel would say."""
    _, names = ax.get_legend_handles_labels()
    return [" ".join(name.split()) for name in names]


@pytest.mark.parametrize(
    ("limits", "named"),
    [
        ((0, 25), ["10", "20", "outside the limits: 30"]),
        ((1e3, 2e3), ["outside the limits: 10, 20, 30"]),
        ((0, 40), ["10", "20", "30"]),
    ],
)
def test_the_legend_says_which_lines_the_limits_leave_out(
    limits: tuple[float, float], named: list[str]
) -> None:
    """It listed a line of which nothing was drawn."""
    ax = panel_of_levels(10, 20, 30)
    ax.plot([0, 1], [90, 90], label="_nolegend_")
    is_noted = note_outside([ax], limits)
    is_outside = "outside" in named[-1]
    assert names_for_legend(ax) == named
    assert is_noted is is_outside


def exponents(points: int) -> xr.Dataset:
    """Two exponents at some speeds with errors of 0.1/s, which are not known at the last speed."""
    axes = ["Omega", "exponent_number"]
    ascending = np.linspace(-0.3, -0.1, 2 * points)
    errors = np.full((points, 2), 0.1)
    errors[-1] = np.nan
    status = np.zeros(points, dtype=np.int8)
    of_exponents = {"units": "s-1", "long_name": "Lyapunov exponent"}
    of_errors = {"units": "s-1", "long_name": "its error"}
    return xr.Dataset(
        {
            "status": ("Omega", status, {"flag_meanings": "ok failed"}),
            "exponent": (axes, ascending.reshape(points, 2), of_exponents),
            "exponent_error": (axes, errors, of_errors),
        },
        {"Omega": np.linspace(10.0, 20.0, points), "exponent_number": [0, 1]},
    )


@pytest.mark.parametrize("points", [4, 60])
def test_curves_of_exponents_show_their_errors(points: int) -> None:
    """An exponent of -0.16/s with an error of 0.53/s looked as certain as any."""
    study = exponents(points)
    figure = draw("curve", study, variable="exponent", x="Omega", by="exponent_number")
    [ax] = figure.axes
    tops = []
    for bars_or_band in ax.collections:
        for path in bars_or_band.get_paths():
            heights = path.vertices[:, 1]
            tops.append(heights.max())
    largest_with_error = study["exponent"][-2].max().item()
    assert max(tops) == pytest.approx(largest_with_error + 0.1)
