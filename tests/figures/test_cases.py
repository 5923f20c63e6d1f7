"""Figures of named cases: from data alone, in one style, with units, and where a case holds
less."""

import functools
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from disc_model import Parameters, Poincare, Window, simulate
from disc_model.data.variables import PHASES, flag_names
from disc_model.figures.drawing import PHASE_COLOURS
from disc_model.figures.kinds import kind_of
from disc_model.figures.render import render
from disc_model.figures.stages import SECTIONS, stages_of
from disc_model.figures.style import save
from tests.damages import damaged

SPECTRA = {"a": 0.0, "b": 20.0, "c": 53.0, "d": 56.0}  # contact is first lost at 54.4 s
RECORDED = {
    "history": Window(stop=60, rate=200, envelope=100, theta=0.5),
    "zoom": Window(start=56, stop=56.035, rate=1e5, theta=0.5),
    **{
        f"spectrum_{x}": Window(start=at, stop=at + 3, rate=4e3, theta=0.5)
        for x, at in SPECTRA.items()
    },
    "orbit": Window(start=59, rate=5e3, theta=0.5),
    **{f"around{j}": Window(start=56, stop=56.035, rate=1e4, theta=0.7 * j) for j in range(9)},
}


@functools.cache
def simulated(separates: bool) -> xr.DataTree:
    """A minute with the windows that figures look for."""
    windows = RECORDED | {"poincare": Poincare(theta=0.5)}
    Omega = 15.0
    if separates:
        Omega = 15.1
    p = Parameters(N=385, Omega=Omega)
    result = simulate(p, 60, windows)
    return result.to_tree()


def asked(kind: str, case: xr.DataTree | None = None, **phrase: Any) -> Figure:
    """A figure of a case as a file asks for it; fit for print."""
    plot = kind_of(kind).model_validate({"kind": kind, "case": "A", **phrase})
    if case is None:
        case = simulated(True)
    return render(plot, {"A": case})


def said_in(figure: Figure) -> list[str]:
    texts = [text for text in figure.findobj(mpl.text.Text) if text.get_visible()]
    return [text.get_text().replace("\n", " ") for text in texts]


@pytest.mark.parametrize("suffix", ["pdf", "png"])
def test_equal_figures_give_equal_bytes_whatever_the_users_settings(
    suffix: str, tmp_path: Path
) -> None:
    save(asked("history", window="history"), tmp_path / f"a.{suffix}")
    before = dict(mpl.rcParams)
    with mpl.rc_context({"axes.labelsize": 30, "lines.linewidth": 9}):
        save(asked("history", window="history"), tmp_path / f"b.{suffix}")
    assert dict(mpl.rcParams) == before
    content = (tmp_path / f"a.{suffix}").read_bytes()
    assert content == (tmp_path / f"b.{suffix}").read_bytes()
    assert b"CreationDate" not in content
    assert b"/Type3" not in content, "fonts are embedded as TrueType"


def test_a_history_has_a_panel_for_each_variable() -> None:
    figure = asked("history", window="spectrum_c", variables=["w_point", "psi"], title="Seen")
    assert figure.get_suptitle() == "Seen\nN = 385 N, Ω = 15.1 rad/s"
    top, bottom = figure.axes
    np.testing.assert_allclose(
        top.lines[0].get_ydata(), 1e3 * simulated(True)["spectrum_c/w_point"].values
    )  # mm
    label = " ".join(top.get_ylabel().split())
    assert label == r"Disc at $r_0$, $\theta$ = 0.5 rad (mm)", "at the angle that was recorded"
    assert top.get_ylabel().count("\n") == 1, "no longer than the axis"

    assert bottom.get_ylabel() == "Angle ψ (rad)"
    assert "first separation 54.42 s" in said_in(figure)
    ranges = asked("history", window="history", variables=["P", "psi"], until=30)
    assert all(len(ax.collections) == 1 for ax in ranges.axes), "as bands"
    assert ranges.axes[0].get_xlim() == (0, 30)


@pytest.mark.parametrize(("window", "phase"), [("spectrum_a", "stick"), ("zoom", "separation")])
def test_phases_are_shaded_in_their_colours_while_they_last(window: str, phase: str) -> None:
    samples = simulated(True)[window].to_dataset()
    samples = samples.isel(time=samples["time"] < samples["time"][0] + 0.1)
    case = damaged(simulated(True), lambda groups: groups | {window: samples})
    [ax] = asked("history", case, window=window, variables=["u"]).axes
    colour = to_rgb(PHASE_COLOURS[phase])
    [shade] = [each for each in ax.collections if tuple(each.get_facecolor()[0, :3]) == colour]
    time = samples["time"].values
    inside = np.zeros(time.size, dtype=bool)
    for bar in shade.get_paths():
        begin, end = bar.get_extents().intervalx
        inside |= (time >= begin) & (time < end)
    np.testing.assert_array_equal(inside, flag_names(samples["phase"]) == phase)


def section_of(size: np.ndarray) -> xr.Dataset:
    """A section of circles of so many units, 2.4 rad from point to point and a second each; every
    fifth point from 100 s on is apart."""
    time = np.arange(float(size.size))
    is_apart = (time % 5 == 0) & (time > 99)
    phase = np.where(is_apart, PHASES.index("separation"), PHASES.index("slip"))
    columns = {"phase": ("time", phase.astype(np.int8))}
    for name in SECTIONS:
        columns[name] = ("time", size * np.cos(2.4 * time))
        columns[f"{name}_velocity"] = ("time", size * np.sin(2.4 * time))
    return xr.Dataset(columns, {"time": time})


def test_points_on_the_way_to_the_final_motion_are_told_from_those_on_it() -> None:
    """Both were black, in contact and after the first separation."""
    case = xr.DataTree(xr.Dataset({"first_separation": 99.5}))
    time = np.arange(600.0)
    samples = section_of(1 + 4 * np.exp(-(time - 100) / 20) * (time > 99))
    found = stages_of(case, samples)
    # the circle is 2 wide, and 1 % of this is left of the 4 units after 20 ln(200) s
    assert 150 < found.final_since <= 100 + 20 * np.log(200) + 1
    on_the_way = found.masks["later on the way"] | found.masks["separated on the way"]
    assert np.flatnonzero(on_the_way).tolist() == [*range(100, int(found.final_since))]
    assert sum(mask.astype(int) for mask in found.masks.values()).tolist() == [1] * 600


@pytest.mark.parametrize(
    "size",
    [np.ones(600), np.linspace(5, 1, 600), np.where(np.arange(600) < 590, 1.0, 3.0)],
    ids=["on it at once", "still on the way at the end", "few points"],
)
def test_no_point_is_on_the_way_where_none_is_shown_to_be(size: np.ndarray) -> None:
    first = 99.5 if size[-1] < 3 else 589.5
    case = xr.DataTree(xr.Dataset({"first_separation": first}))
    found = stages_of(case, section_of(size))
    assert np.isnan(found.final_since)
    assert not found.masks["later on the way"].any()
    assert not found.masks["separated on the way"].any()


def test_a_spectrogram_shows_the_frequency_that_is_there() -> None:
    (mesh,) = (
        asked("spectrogram", window="spectrum_a", variable="psi", highest=400).axes[0].collections
    )
    corners = mesh.get_coordinates()
    heights = corners[:, 0, 1]
    centre = (heights[:-1] + heights[1:]) / 2
    strongest = centre[int(np.argmax(mesh.get_array().sum(axis=1)))]
    assert strongest == pytest.approx(70, abs=2)  # two steps of the transform


def test_a_spectrum_shows_the_frequency_that_is_there() -> None:
    (line,) = asked("spectrum", window="spectrum_a", variable="psi", highest=400).axes[0].lines
    # the rate of releases, within the width of the window's line
    frequencies = line.get_xdata()
    powers = line.get_ydata()
    highest = int(np.argmax(powers))
    assert frequencies[highest] == pytest.approx(67.7, abs=0.7)


@pytest.mark.parametrize("kind", ["history", "poincare", "portrait", "spectrogram", "spectrum"])
def test_what_a_case_lacks_is_said(kind: str) -> None:
    if kind == "poincare":
        phrase = {}
    else:
        phrase = {"window": "orbit"}
    empty = xr.DataTree(xr.Dataset({"first_separation": np.nan, "time_reached": 0.0}))
    assert any("did not record" in text for text in said_in(asked(kind, empty, **phrase)))
    if kind != "poincare":
        early = damaged(
            simulated(True), lambda groups: groups | {"orbit": groups["orbit"].isel(time=slice(0))}
        )
        assert any(
            "has 0 samples in orbit" in text for text in said_in(asked(kind, early, **phrase))
        )
