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
from disc_model.analysis.spectra import TimeFrequency
from disc_model.data.variables import PHASES, flag_names
from disc_model.figures import stages
from disc_model.figures.drawing import PHASE_COLOURS
from disc_model.figures.kinds import kind_of
from disc_model.figures.render import render
from disc_model.figures.spectrogram import span_of
from disc_model.figures.stages import SECTIONS, stages_of
from disc_model.figures.style import save
from tests.damages import damaged
from tests.figures.reading import assert_fit_for_print, labels

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
    figure = render(plot, {"A": case})
    assert_fit_for_print(figure)
    return figure


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


def test_ramps_of_a_case_are_shaded_and_said() -> None:
    """The title gave the speed at the start for that of the whole run."""
    ramp = '[{"parameter": "Omega", "to": 20.0, "start": 10.0, "end": 30.0}]'
    case = simulated(True).copy()
    case.attrs["ramps"] = ramp
    figure = asked("history", case, window="history", variables=["P", "psi"])
    assert figure.get_suptitle() == "N = 385 N, Ω = 15.1 to 20 rad/s"
    assert "Ω from 15.1 to 20 rad/s, 10 to 30 s" in labels(figure)
    for ax in figure.axes:
        [shade] = ax.patches
        assert (shade.get_x(), shade.get_width()) == (10.0, 20.0)


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


def test_a_section_small_in_one_direction_only_is_not_enlarged() -> None:
    """A narrow column of points says that it is narrow."""
    large = simulated(True)
    samples = large["poincare"].to_dataset()
    narrow = 0.01 * samples["w_point"]
    samples = samples.assign(w_point=narrow)
    small = damaged(large, lambda groups: groups | {"poincare": samples})
    plot = kind_of("poincare")(case="A", below=("B",))
    figure = render(plot, {"A": large, "B": small})
    said = [text.get_text() for ax in figure.axes for text in ax.texts]
    assert not any("enlarged" in text for text in said)


def test_sections_of_several_cases_share_their_axes() -> None:
    """Contact is kept in one, whose points take a small part of the axes of the other."""
    plot = kind_of("poincare")(case="A", below=("B",))
    figure = render(plot, {"A": simulated(True), "B": simulated(False)})
    left, right, left_below, right_below = [ax for ax in figure.axes if ax.get_title(loc="left")]
    assert left.get_xlim() == left_below.get_xlim()
    assert left.get_ylim() == left_below.get_ylim()
    # the points of the second take a small part of the axes of the first
    (note,) = [text.get_text() for text in right_below.texts if "enlarged" in text.get_text()]
    factor = np.ptp(right.get_xlim()) / np.ptp(right_below.get_xlim())
    assert note == f"enlarged {factor:.0f} times"
    assert not [text for text in right.texts if "enlarged" in text.get_text()]


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


@pytest.mark.parametrize(("of_disc", "since"), [(250.0, 250.0), (np.inf, np.nan)])
def test_a_motion_has_settled_when_both_its_sections_have(
    monkeypatch: pytest.MonkeyPatch, of_disc: float, since: float
) -> None:
    times = {"psi": 3.0, "w_point": of_disc}
    monkeypatch.setattr(stages, "_since", lambda samples, window, name: times[name])
    circles = section_of(np.ones(600))
    found = stages.settled_since(xr.DataTree(), circles)
    assert found == pytest.approx(since, nan_ok=True)


def test_points_of_a_motion_that_may_have_settled_are_divided_at_a_stated_time() -> None:
    """They were "first half of the run" up to their mean time, wherever the window was; and a settled
    cycle was called "not shown to have settled"."""
    p = Parameters(N=385, Omega=14, n_diameters=1)
    section = Poincare(start=5)
    result = simulate(p, 15, windows={"poincare": section})
    case = result.to_tree()
    samples = case["poincare"].to_dataset()
    found = stages_of(case, samples)

    time = samples["time"].values
    middle = round((time[0] + time[-1]) / 2, 1)
    early_name, later_name, *_ = found.names
    assert middle == pytest.approx(10, abs=0.5)
    assert early_name == f"up to {middle:g} s"
    assert later_name == f"after {middle:g} s, undecided whether settled"

    early = time[found.masks["early"]]
    later = time[found.masks["later"]]
    assert early.max() < middle
    assert later.min() >= middle


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


@pytest.mark.parametrize(
    ("first", "last", "span"),
    [(0.5, 9.5, (0.0, 9.5)), (0.96, 9.5, (1.0, 9.5)), (38.52, 47.48, (38.5, 47.5))],
)
def test_a_spectrum_in_time_at_the_start_of_a_run_begins_at_zero(
    first: float, last: float, span: tuple[float, float]
) -> None:
    time = np.linspace(first, last, 50)
    frequency = np.zeros(0)
    spectrum = TimeFrequency(time, frequency, np.zeros((0, 50)))
    assert span_of(spectrum) == pytest.approx(span)


def titled(separates: bool, title: str) -> xr.DataTree:
    """A case with a title."""
    case = simulated(separates).copy()
    case.attrs = dict(case.attrs)
    case.attrs["title"] = title
    return case


def test_the_title_of_a_case_stands_above_its_figure_before_its_parameters() -> None:
    """No figure had it, and two cases that stop at different times had the same heading."""
    case = titled(True, "Until contact is lost")
    figure = asked("history", case, window="history")
    first, *further = figure.get_suptitle().splitlines()
    assert first == "Until contact is lost"
    assert "385 N" in " ".join(further)


def test_the_title_that_a_figure_is_given_stands_in_place_of_that_of_its_case() -> None:
    case = titled(True, "Until contact is lost")
    figure = asked("history", case, window="history", title="Seen")
    first, *further = figure.get_suptitle().splitlines()
    assert first == "Seen"
    assert "contact" not in " ".join(further)


@pytest.mark.parametrize("alike", [True, False])
def test_rows_of_cases_with_equal_parameters_have_their_titles(alike: bool) -> None:
    cases = {"A": titled(True, "Case A"), "B": titled(alike, "Case B")}
    wish = {"kind": "poincare", "case": "A", "below": ["B"]}
    plot = kind_of("poincare").model_validate(wish)
    figure = render(plot, cases)
    said = " ".join(said_in(figure))
    assert ("Case B" in said) is alike
