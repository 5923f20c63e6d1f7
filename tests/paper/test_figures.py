"""The paper's figures, as config/paper.yaml describes them: values in the units of their labels."""

import functools
import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

from disc_model import Parameters, Poincare, Window, simulate
from disc_model.figures.kinds import render
from disc_model.figures.schema import CasePlot
from disc_model.figures.shown import shown_case, window_of
from disc_model.studies.study import load_study
from tests.damages import DAMAGES, damaged
from tests.paper import evidence
from workflow.paper import figures

ROOT = Path(__file__).parents[2]
MOVED = {
    "fig26": {"zooms": (("spectrum_c", 54.0), ("spectrum_d", 57.0))},
    "fig28": {"zooms": (("spectrum_d", 56.5), ("spectrum_d", 57.0))},
    "composite": {"force": ("spectrum_d", 57.0)},
}
"""Closer looks at times that the case has."""
FIGURES = {
    name: plot.model_copy(update=MOVED.get(name, {}))
    for name, plot in load_study(ROOT / "config" / "paper.yaml").figures.items()
}
OF_CASES = {name: plot for name, plot in FIGURES.items() if isinstance(plot, CasePlot)}


@functools.cache
def case() -> xr.DataTree:
    """A minute with the windows that the figures look for; contact is first lost at 54.4 s."""
    starts = {"a": 0.0, "b": 20.0, "c": 53.0, "d": 56.0}
    windows = {
        "history": Window(stop=60, rate=200, envelope=100),
        "zoom": Window(start=56, stop=56.035, rate=1e5),
        "orbit": Window(start=59, rate=5e3),
        "poincare": Poincare(),
        **{f"spectrum_{x}": Window(start=t, stop=t + 3, rate=4e3) for x, t in starts.items()},
        **{f"around{j}": Window(start=56, stop=56.035, rate=1e4, theta=0.7 * j) for j in range(9)},
    }
    return simulate(Parameters(N=385, Omega=15.1), 60, windows).to_tree()


def drawn(name: str, tree: xr.DataTree | None = None) -> Figure:
    plot = OF_CASES[name]
    figure = render(plot, dict.fromkeys(plot.cases, case() if tree is None else tree))
    figure.draw_without_rendering()
    return figure


@pytest.mark.parametrize("name", OF_CASES)
def test_axes_have_names_and_units(name: str) -> None:
    for ax in drawn(name).axes:
        if ax.axison and ax.name != "polar":
            assert re.search(r"\(\w.*\)$|^Power", ax.get_ylabel() or "(b)"), ax.get_ylabel()
            assert re.search(r"\(\w.*\)$", ax.get_xlabel() or "(b)"), ax.get_xlabel()


@pytest.mark.parametrize("damage", DAMAGES)
@pytest.mark.parametrize("name", {plot.kind: name for name, plot in OF_CASES.items()}.values())
def test_a_case_that_lacks_what_is_shown_says_so(name: str, damage: str) -> None:
    figure = drawn(name, damaged(case(), DAMAGES[damage]))
    said = [text.get_text().replace("\n", " ") for ax in figure.axes for text in ax.texts]
    if damage == "failed":
        assert said == ["not shown: the case failed"]
    elif damage in ("nothing recorded", "empty windows"):
        assert said[0].startswith("not shown: the case ")


# ---- Values


def test_one_separation_is_in_millimetres_micrometres_and_milliseconds() -> None:
    both, gap = drawn("fig03").axes
    start, stop = figures.first_complete(window_of(shown_case(case()), "zoom")) or (0, 0)
    assert f"Time after {start:.9g} s (ms)" == gap.get_xlabel()
    samples = case()["zoom"].to_dataset().sel(time=slice(start, stop))
    slider = both.lines[1].get_ydata()
    highest = float(samples["u"].max() - case()["u_0"])
    assert slider.max() == pytest.approx(1e3 * highest)
    largest = 1e6 * float((samples["u"] - samples["w"]).max())
    assert gap.lines[0].get_ydata().max() == pytest.approx(largest)


def test_spectra_in_time_show_the_stick_slip_frequency() -> None:
    figure = drawn("fig25")
    panels = [ax for ax in figure.axes if ax.get_ylim() == (0, 300) and ax.images]
    image = panels[0].images[0]
    level = np.asarray(image.get_array()).mean(axis=1)
    *_, low, high = image.get_extent()
    frequency = low + (high - low) * (np.arange(level.size) + 0.5) / level.size
    peak = frequency[frequency > 20][int(np.argmax(level[frequency > 20]))]
    # a cycle lasts 14.8 ms, 67.7 Hz; a multiple of it, or beside it by a turn
    assert min(abs(peak - n * 67.7) for n in (1, 2, 3, 4)) < 4


def test_the_disc_between_the_angles_is_the_disc() -> None:
    """At the angle of a window that it is not made from, and clamped inside."""
    p = Parameters(N=300, Omega=50, n_diameters=2, normalization="orthonormal")
    angles = {f"around{j}": 1.2 * j for j in range(5)} | {"elsewhere": 2 * np.pi / 3}
    windows = {
        name: Window(start=0.5, stop=0.52, rate=2e4, theta=angle) for name, angle in angles.items()
    }
    tree = shown_case(simulate(p, 0.52, windows).to_tree())
    there = window_of(tree, "elsewhere")["w_point"]
    w = figures.deflection_around(tree, p, there["time"])
    assert w.attrs["units"] == "mm"
    found = w.sel(r=p.r_0).sel(theta=2 * np.pi / 3, method="nearest")
    np.testing.assert_allclose(found, there, atol=1e-10 * float(abs(there).max()))
    assert float(abs(w.isel(r=0)).max()) < 1e-9 * float(abs(w).max())


# ---- Separations in a window


@pytest.mark.parametrize(
    ("marks", "spans", "complete"),
    [
        ("x..xxx..x", [(2.0, 2.0), (2.3, 2.5), (2.8, 2.8)], (2.3, 2.5)),
        ("xx..xx.", [(2.0, 2.1), (2.4, 2.5)], (2.4, 2.5)),
        ("xx...xx", [(2.0, 2.1), (2.5, 2.6)], None),  # both are cut off
        ("....", [], None),
    ],
)
def test_separations_are_from_their_first_to_their_last_sample(
    marks: str, spans: list[tuple[float, float]], complete: tuple[float, float] | None
) -> None:
    words = np.where([mark == "x" for mark in marks], "separation", "slip")
    time = 2 + 0.1 * np.arange(len(marks))
    samples = xr.Dataset({"phase": ("time", words)}, {"time": time})
    np.testing.assert_allclose(np.ravel(figures.separations(samples)), np.ravel(spans))
    assert figures.first_complete(samples) == (complete and pytest.approx(complete))


# ---- Both normalisations


def test_the_figure_on_both_scales_counts_what_vanishes() -> None:
    """Of nine motions that separate with the published scale two do not with the other."""
    changes = {name: {"first_separation": [[[90]], [[np.nan]]]} for name in ("map_m", "map_D_star")}
    maps = evidence.scans(**changes)
    plot = FIGURES["figB2"]
    inputs = {"study": maps["map_N"], **{name: maps[name] for name in plot.overlays}}
    done = {name: each.assign(status=0 * each["outcome"]) for name, each in inputs.items()}
    figure = render(plot, {name: xr.DataTree(each) for name, each in done.items()})
    *_, times = figure.axes
    counts = {str(line.get_label()) for line in times.lines if "horizon" in str(line.get_label())}
    assert counts == {"none by Eq. (17) up to the horizon, 2 of 9"}
