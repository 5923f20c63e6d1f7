"""Figures of uncertain parameters and Campbell diagrams: what is drawn, and that no name covers another."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr
from matplotlib.collections import PathCollection
from matplotlib.colors import to_hex

from disc_model.figures.grids import sensitivity
from disc_model.figures.grids.campbell import gaps, noted, spread
from disc_model.figures.parts import GREY, SKY
from disc_model.studies.grids.summaries.campbell import EFFECTS
from disc_model.studies.study import StudyError
from tests.figures.grids.reading import draw
from tests.studies.grids.conftest import SMALL, computed
from tests.studies.grids.quantities import test_sensitivity as uncertain
from tests.studies.refused import parse_grid


def test_bars_and_probabilities_are_those_of_the_study() -> None:
    study = uncertain.made_up()
    figure = draw("sensitivity", study)
    assert len(figure.axes) == 1 + 2 * study.sizes["N"]
    first = figure.axes[1]
    widths = [bar.get_width() for bar in first.patches]
    cell = study.isel(N=0).sel(output="instability")
    np.testing.assert_allclose(widths, [*cell["first_index"].values, *cell["total_index"].values])
    assert [label.get_text() for label in first.get_yticklabels()] == ["k", "$μ_s$"]
    assert "N = 200 N" in first.get_title(loc="left")
    assert "k, $μ_s$ ± 10 %" in figure.get_suptitle()


def test_what_lies_beyond_a_panel_of_indices_is_marked_and_what_is_not_known_grey() -> None:
    study = uncertain.made_up()
    shape = study["total_index"].isel(N=0).sel(output="instability").shape
    assert shape == (2,)
    for name, value in (("total_index", 1.91), ("total_index_low", 0.5), ("total_index_high", 4.0)):
        study[name][:] = value
    for name in ("first_index", "first_index_low", "first_index_high"):
        study[name][:] = 0.2
    panel = draw("sensitivity", study).axes[1]
    assert [text.get_text() for text in panel.texts] == ["1.9", "1.9"]
    arrows = [len(one.get_offsets()) for one in panel.collections if isinstance(one, PathCollection)]
    assert arrows == [0, 0, 0, 2]
    known, unknown = (to_hex(panel.patches[place].get_facecolor()) for place in (0, 2))
    assert (known, unknown) == (to_hex(SKY), to_hex(GREY))


@pytest.mark.parametrize(
    ("distribution", "relative", "numbers", "said"),
    [
        ("uniform", True, {"low": 0.9, "high": 1.1}, "± 10 %"),
        ("uniform", False, {"low": 4e4, "high": 6e4}, "40 to 60 kN/m"),
        ("normal", True, {"mean": 1, "deviation": 0.1}, "normal, 1 ± 0.1 times its value"),
        (
            "truncated_normal",
            False,
            {"mean": 5e4, "deviation": 1e3, "low": 4e4, "high": 6e4},
            "40 to 60 kN/m, normal, 50 ± 1 kN/m",
        ),
    ],
)
def test_distributions_are_said(distribution: str, relative: bool, numbers: dict[str, float], said: str) -> None:
    how = {"distribution": distribution, "relative": relative, **numbers}
    assert sensitivity.spreads({"k": how}) == f"k {said}"


@pytest.mark.compiled
def test_a_campbell_diagram_numbers_what_matters() -> None:
    study = computed(
        quantity="campbell",
        options={"window": 20},
        base={"N": 200, "normalization": "as_published", **SMALL},
        axes={"Omega": {"start": 9, "stop": 13, "step": 0.25}},
    )
    figure = draw("campbell", study)
    numbers = [text.get_text() for text in figure.axes[0].texts if text.get_text().isdigit()]
    assert numbers == [str(i) for i in range(1, len(noted(study)) + 1)]


def made_up_crossings() -> xr.Dataset:
    """One mode drifts upward through zero before 11 rad/s, another peaks there; no cycle at 9 and from 13 to 14."""
    speeds = np.linspace(8, 15, 71)
    first = -0.09 + 0.1 * (speeds - 10)
    second = -1 + 0.5 / (1 + ((speeds - 11) / 0.05) ** 2)
    gone = (np.abs(speeds - 9) < 0.01) | ((speeds > 12.99) & (speeds < 14.01))
    growth = np.where(gone[:, None], np.nan, np.stack([first, second], axis=1))
    at_11 = growth[30, 0]
    by_mode, same = ("Omega", "mode"), np.ones((71, 2))
    effects = [EFFECTS.index(effect) for effect in ("no_cycle", "rises", "destabilises")]
    values = {
        "stick_slip_frequency": ("Omega", np.where(gone, np.nan, 10 * speeds)),
        "rotation_frequency": ("Omega", speeds / (2 * np.pi)),
        "growth_rate": ("Omega", np.where(gone, np.nan, growth.max(axis=1))),
        "mode_kind": (by_mode, same.astype(int), {"flag_meanings": "none disc slider"}),
        "diameters": (by_mode, same.astype(int)),
        "sliding_frequency": (by_mode, same * [100, 220]),
        "cycle_frequency": (by_mode, same * [100, 220]),
        "cycle_growth_rate": (by_mode, growth),
        "crossing_Omega": ("crossing", [9.0, 11.0, 11.04]),
        "crossing_frequency": ("crossing", [180.0, 220.0, 100.0]),
        "crossing_multiple": ("crossing", [2.0, 2.0, 1.0]),
        "crossing_growth_rate": ("crossing", [np.nan, at_11, at_11]),
        "crossing_effect": ("crossing", effects, {"flag_meanings": " ".join(EFFECTS)}),
        "crossing_line": ("crossing", [1, 1, 1], {"flag_meanings": "none stick_slip rotation"}),
    }
    attrs = {"base": json.dumps({"N": 385, "normalization": "as_published"}), "title": "made up"}
    return xr.Dataset(values, {"Omega": speeds, "mode": [1, 2]}, attrs)


def test_a_campbell_diagram_named_a_mode_that_stays_stable() -> None:
    """The mode whose rate rises most is not the one that makes the cycle unstable; two crossings, one peak."""
    found = noted(made_up_crossings())
    assert [one.said for one in found] == [
        "11.00 rad/s, 2 $f_s$ = 220 Hz, 1 $f_s$ = 100 Hz: 100 Hz mode, 0.01/s",
        "12.95 to 14.05 rad/s: no cycle found",
    ]
    assert found[0].crossings == (1, 2)


def test_a_campbell_diagram_numbers_gaps_of_several_speeds_and_draws_all() -> None:
    study = made_up_crossings()
    assert [(round(low, 9), round(high, 9), count) for low, high, count in gaps(study)] == [
        (8.95, 9.05, 1),
        (12.95, 14.05, 11),
    ]
    above, below, _ = draw("campbell", study).axes
    for ax in (above, below):
        assert [round(bar.get_width(), 9) for bar in ax.patches] == [0.1, 1.1]
    # nothing is cut off
    low, high = below.get_ylim()
    growth = study["cycle_growth_rate"]
    assert low <= float(growth.min())
    assert float(growth.max()) <= high


def test_all_crossings_lie_on_lines_that_are_drawn() -> None:
    study = made_up_crossings()
    ax = draw("campbell", study).axes[0]
    drawn = [
        np.asarray(line.get_ydata(), dtype=float) / study["stick_slip_frequency"].values
        for line in ax.lines
        if len(line.get_xdata()) == 71
    ]
    multiples = {float(np.round(np.nanmean(ratio), 6)) for ratio in drawn if np.nanstd(ratio) < 1e-9}
    assert multiples >= set(study["crossing_multiple"].values.tolist())


@pytest.mark.parametrize("places", [[1.0, 1.01, 1.02], [0.0, 0.0, 10.0], [10.0, 10.0], [5.0], [], list(np.zeros(30))])
def test_names_are_spread(places: list[float]) -> None:
    found = np.array(spread(places, 0.5, 0.0, 10.0))
    assert len(found) == len(places)
    if len(places) > 1:
        assert np.diff(found).min() >= min(0.5, 10 / (len(places) - 1)) * (1 - 1e-12)
    if len(places):
        assert found.min() >= -1e-12
        assert found.max() <= 10 + 1e-12


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"axes": {"N": [1, 2, 3, 4, 5]}}, "'sensitivity': has room for 4 points beside their samples"),
        ({"figures": {"f": {"kind": "campbell"}}}, "'campbell': needs the quantity campbell"),
    ],
)
def test_what_a_figure_cannot_show_is_said(change, said) -> None:
    raw = {"study": "s", **uncertain.study({"k": uncertain.UNIFORM}, figures={"f": {"kind": "sensitivity"}}), **change}
    with pytest.raises(StudyError) as error:
        parse_grid(raw)
    assert f"figures.f.kind = {said}" in str(error.value)


def test_a_campbell_diagram_shows_one_normalization() -> None:
    raw = {"study": "s", "quantity": "campbell", "base": {"N": 200}, "figures": {"f": {"kind": "campbell"}}}
    axes = {"Omega": [1, 2], "normalization": ["as_published", "orthonormal"]}
    with pytest.raises(StudyError, match=r"can show one normalization only"):
        parse_grid(raw | {"axes": axes})
    raw["figures"]["f"]["normalization"] = "orthonormal"
    assert parse_grid(raw | {"axes": axes}).plots
    with pytest.raises(StudyError, match=r"is not computed"):
        parse_grid(raw | {"axes": axes | {"normalization": ["as_published"]}})
