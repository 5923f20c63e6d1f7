"""Figures of named cases and of the paper: from data alone, in one style, with units, and where a case holds less."""

import functools
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
import pytest
import xarray as xr
from matplotlib.figure import Figure
from PIL import Image

from disc_model import Parameters, Poincare, Record, Window, simulate
from disc_model.data.dataset import Missing, events_dataset
from disc_model.data.variables import PERTURBATIONS, SHOWN, values_text
from disc_model.figures import drawing
from disc_model.figures.drawing import COLUMN, PAGE, save
from disc_model.figures.kinds import CASE_PLOTS, OwnFigure
from disc_model.figures.paper.catalogue import CATALOGUE, caption, label, number_of
from disc_model.figures.paper.disc import film, motion_of
from tests.damages import DAMAGES, EACH_DAMAGE, damaged
from tests.figures.reading import labels

SPECTRA = {"a": 0.0, "b": 20.0, "c": 53.0, "d": 56.0}  # contact is first lost at 54.4 s
RECORDED = {
    "history": Window(stop=60, rate=200, envelope=100, theta=0.5),
    "zoom": Window(start=56, stop=56.035, rate=1e5, theta=0.5),
    **{f"spectrum_{x}": Window(start=at, stop=at + 3, rate=4e3, theta=0.5) for x, at in SPECTRA.items()},
    "orbit": Window(start=59, rate=5e3, theta=0.5),
    **{f"around{j}": Window(start=56, stop=56.035, rate=1e4, theta=0.7 * j) for j in range(9)},
}


@functools.cache
def simulated(separates: bool) -> xr.DataTree:
    """A minute with the windows that figures look for."""
    record = Record(windows=tuple(RECORDED.values()), poincare=Poincare(theta=0.5))
    return simulate(Parameters(N=385, Omega=15.1 if separates else 15), 60, record=record).to_tree(list(RECORDED))


@functools.cache
def holding_less(damage: str) -> xr.DataTree:
    """The same, damaged."""
    return damaged(simulated(True), DAMAGES[damage])


def whole_case() -> xr.DataTree:
    """To be changed."""
    return simulated(True).copy(deep=True)


OPTIONS = {
    "fig26": {"zooms": [["spectrum_c", 54.0], ["spectrum_d", 57.0]]},
    "fig28": {"zooms": [["spectrum_d", 56.5], ["spectrum_d", 57.0]]},
}
"""Closer looks at times that the case has."""


def drawn(name: str, cases: dict[str, xr.DataTree]) -> Figure:
    plot = CATALOGUE[name].plot
    return drawing.draw(OwnFigure(by=plot.by, options=plot.options | OPTIONS.get(name, {})), cases)


def draw(name: str, *, separates: bool = True) -> Figure:
    return drawn(name, dict.fromkeys(CATALOGUE[name].cases, simulated(separates)))


def said_in(figure: Figure) -> list[str]:
    return [text.get_text().replace("\n", " ") for text in figure.findobj(mpl.text.Text)]


ONE_OF_EACH = list({entry.plot.by: name for name, entry in CATALOGUE.items()}.values())
"""A figure for each function that draws some."""


@pytest.mark.parametrize(
    ("name", "separates"), [*((name, True) for name in CATALOGUE), *((name, False) for name in ONE_OF_EACH)]
)
def test_figures_name_their_quantities_and_units_legibly_at_print_size(name: str, separates: bool) -> None:
    figure = draw(name, separates=separates)
    assert figure.get_figwidth() in (COLUMN, PAGE)
    for ax in figure.axes:
        if not ax.axison:  # an empty panel says why
            continue
        shared = [ax.get_ylabel(), *(one.get_ylabel() for one in ax.get_shared_y_axes().get_siblings(ax))]
        assert any(text.endswith(")") for text in shared), "a unit in brackets"
        assert ax.has_data() or not separates
    assert figure.get_suptitle() == ""
    assert min(text.get_fontsize() for text in figure.findobj(mpl.text.Text) if text.get_text()) >= 7
    names = {text for ax in figure.axes for text in (ax.get_xlabel(), ax.get_ylabel()) if text.startswith("Disc at")}
    assert names <= {r"Disc at $r_0$, $\theta$ = 0.5 rad (mm)"}, "at the angle that was recorded"
    assert names or "{theta}" not in CATALOGUE[name].caption or name == "fig25" or not separates


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("damage", EACH_DAMAGE)
@pytest.mark.parametrize("name", ONE_OF_EACH)
def test_what_a_case_does_not_hold_leaves_panels_empty(name: str, damage: str) -> None:
    """A failed case, a window without what a figure needs, a section without points: all ended the figure before."""
    figure = drawn(name, dict.fromkeys(CATALOGUE[name].cases, holding_less(damage)))
    figure.draw_without_rendering()
    reasons = [text for text in said_in(figure) if text.startswith("not shown: the case ")]
    if damage in ("failed", "nothing recorded"):
        assert len(reasons) == len([ax for ax in figure.axes if not ax.has_data()])
        lacks = (f"did not record {window}" for window in (*RECORDED, "poincare", "events"))
        known = {"failed"} if damage == "failed" else {*lacks}
        assert set(reasons) <= {f"not shown: the case {reason}" for reason in known}


@pytest.mark.parametrize("suffix", ["pdf", "png"])
def test_equal_figures_give_equal_bytes_whatever_the_users_settings(suffix: str, tmp_path: Path) -> None:
    save(draw("fig13"), tmp_path / f"a.{suffix}")
    before = dict(mpl.rcParams)
    with mpl.rc_context({"axes.labelsize": 30, "lines.linewidth": 9}):
        save(draw("fig13"), tmp_path / f"b.{suffix}")
    assert dict(mpl.rcParams) == before
    content = (tmp_path / f"a.{suffix}").read_bytes()
    assert content == (tmp_path / f"b.{suffix}").read_bytes()
    assert b"CreationDate" not in content
    assert b"/Type3" not in content, "fonts are embedded as TrueType"


def test_a_closer_look_began_inside_a_separation() -> None:
    """What the window cuts off looked like a jump of the force at its start."""
    case = whole_case()
    zoom = case["zoom"].to_dataset()
    apart = np.flatnonzero(zoom["phase"].values == 2)
    case["zoom"] = xr.DataTree(zoom.isel(time=slice(int(apart[5]), None)))
    line = drawn("fig02", {"F02": case}).axes[1].lines[0]
    assert line.get_xdata()[0] == 0
    assert line.get_ydata()[0] > 0


def test_two_angles_are_both_named() -> None:
    cases = {name: whole_case() for name in ("F02", "F04")}
    cases["F04"]["history"].attrs["theta"] = 2.0
    assert drawn("fig10", cases).axes[0].get_ylabel() == r"Disc at $r_0$, $\theta$ = 0.5 and 2 rad (mm)"


# ---- kinds that a file may ask for


def asked(kind: str, case: xr.DataTree | None = None, **phrase: Any) -> Figure:
    plot = CASE_PLOTS[kind].model_validate({"kind": kind, "case": "A", **phrase})
    return drawing.draw(plot, {"A": simulated(True) if case is None else case})


def test_a_history_has_a_panel_for_each_variable() -> None:
    figure = asked("history", window="spectrum_c", variables=["w_point", "psi"], title="Seen")
    assert figure.get_suptitle() == "Seen\nN = 385 N, Ω = 15.1 rad/s"
    top, bottom = figure.axes
    np.testing.assert_allclose(top.lines[0].get_ydata(), 1e3 * simulated(True)["spectrum_c/w_point"].values)  # mm
    assert bottom.get_ylabel() == "Angle ψ (rad)"
    assert "first separation 54.42 s" in said_in(figure)
    ranges = asked("history", window="history", variables=["P", "psi"])
    assert all(len(ax.collections) == 1 for ax in ranges.axes), "as bands"


def test_a_spectrogram_shows_the_frequency_that_is_there() -> None:
    (mesh,) = asked("spectrogram", window="spectrum_a", variable="psi", highest=400).axes[0].collections
    corners = mesh.get_coordinates()[:, 0, 1]
    centre = (corners[:-1] + corners[1:]) / 2
    assert centre[int(np.argmax(mesh.get_array().sum(axis=1)))] == pytest.approx(
        70, abs=2
    )  # two steps of the transform


def test_portraits_and_sections_show_all_samples() -> None:
    (ax,) = asked("portrait", window="orbit").axes
    assert labels(ax) == ["stick", "slip", "separation"]
    slider, disc = asked("poincare").axes
    shown = sum(len(collection.get_offsets()) for collection in slider.collections)
    assert shown == simulated(True)["poincare"].sizes["time"]
    assert disc.get_xlabel().startswith("Disc at")


def test_the_title_of_a_section_lay_over_its_legend(tmp_path: Path) -> None:
    figure = asked("poincare", title="Above the critical speed")
    save(figure, tmp_path / "section.png")
    [legend] = figure.legends
    assert not legend.get_window_extent().overlaps(figure._suptitle.get_window_extent())


@pytest.mark.parametrize("kind", CASE_PLOTS)
def test_what_a_case_lacks_is_said(kind: str) -> None:
    """A case that stops at its first separation ended the job of a history in an IndexError."""
    phrase = {} if kind == "poincare" else {"window": "orbit"}
    empty = xr.DataTree(xr.Dataset({"first_separation": np.nan, "time_reached": 0.0}))
    assert any("did not record" in text for text in said_in(asked(kind, empty, **phrase)))
    if kind != "poincare":
        early = damaged(simulated(True), lambda groups: groups | {"orbit": groups["orbit"].isel(time=slice(0))})
        assert any("has 0 samples in orbit" in text for text in said_in(asked(kind, early, **phrase)))


# ---- the catalogue


def test_numbers_of_figures() -> None:
    assert [number_of(name) for name in ("fig02", "fig29", "figA1")] == ["Fig. 2", "Fig. 29", "Fig. A1"]
    assert sorted(["fig10", "fig02", "fig29"], key=label) == ["fig02", "fig10", "fig29"]


@pytest.mark.parametrize("name", CATALOGUE)
def test_captions_name_the_parameters_and_the_modes(name: str) -> None:
    p = Parameters(N=385, Omega=15.1, c_p=0.5)
    for normalization, words in (("as_published", "as in the published results"), ("orthonormal", "Eq. (17)")):
        text = caption(name, dict.fromkeys(CATALOGUE[name].cases, p.replace(normalization=normalization)))
        assert "N = 385 N, Ω = 15.1 rad/s, c_p = 0.5 N s/m" in text
        assert words in text
        assert "{" not in text


def test_parameters_that_are_words_are_said_as_words() -> None:
    """A case with another law of contact ended the whole study: words have no format of numbers."""
    p = Parameters(N=200, Omega=20, contact_compliance="residual", contact_force="normal")
    assert values_text(dict(p)) == "N = 200 N, Ω = 20 rad/s, contact_compliance = residual, contact_force = normal"
    assert values_text(dict(p.replace(contact_compliance=1e-7, contact_force="vertical"))).endswith("= 1e-07 m/N")


def test_every_number_that_varies_has_a_symbol() -> None:
    """A map over the compliance of the contact passed the check of its file and ended in a KeyError."""
    numbers = [name for name in Parameters.model_fields if Parameters.unit(name)]
    assert {*numbers, *PERTURBATIONS} <= SHOWN.keys()


def test_captions_say_times_and_angles_of_the_windows() -> None:
    p = Parameters(N=200, Omega=20)
    windows = {
        "history": Window(start=0, stop=9, rate=10, theta=0.5, envelope=2),
        "zoom": Window(start=3, stop=3.05, rate=1e3),
        "orbit": Window(start=7.5, stop=9, rate=1e3),
        "poincare": Poincare(theta=-0.25),
    }

    def phrase(name: str) -> str:
        return caption(name, {"F02": p, "F04": p}, {"F02": windows, "F04": windows | {"history": windows["zoom"]}})

    assert "(b) 50 ms of it" in phrase("fig02")
    assert "r_0 and θ = -0.25 rad." in phrase("fig05")
    assert "r_0 and θ = 0.5 and 1 rad, with" in phrase("fig10")
    assert "drive point, 7.5 to 9 s, coloured by phase" in phrase("figA2")
    # without a section, as if nothing had been said of it
    assert "r_0 and a fixed θ." in caption("fig05", {"F02": p, "F04": p}, {"F02": {"poincare": None}})


def test_sections_of_a_pair_share_the_axes_of_the_slider() -> None:
    """Figs. 4 to 9 are compared, and each had axes of its own."""
    small, large = whole_case(), whole_case()
    for name in ("psi", "psi_velocity", "w_point"):
        large["poincare"][name] = 3 * large["poincare"][name]
    (first, second), (slider, disc) = (
        drawn("fig05", dict(zip(("F02", "F04"), pair, strict=True))).axes for pair in ((small, large), (large, small))
    )
    assert (first.get_xlim(), first.get_ylim()) == (slider.get_xlim(), slider.get_ylim())
    assert second.get_xlim() != disc.get_xlim()


def test_spans_side_by_side_share_their_axis() -> None:
    """Figs. 26 and 28 showed two spans on axes of their own, of which only the left one had a name."""
    left, right = (ax for ax in draw("fig26").axes if ax.get_xlabel().endswith("(ms)"))
    assert left.get_ylim() == right.get_ylim()


def test_closures_fall_to_rounding_at_the_period_only() -> None:
    """Releases that repeat after three: nothing showed that motions of long periods are periodic."""
    times = np.cumsum(np.tile([0.01, 0.02, 0.04], 10))
    frame = pd.DataFrame({"time": times, "kind": "stick_to_slip", "phase": "slip"})
    events = events_dataset(frame).assign_attrs(kept_from=0.0, kept_until=2.0)
    case = xr.DataTree.from_dict({"/": xr.Dataset(), "/events": events})
    (ax,) = drawn("figB2", {"F02": case}).axes
    counts, differences = ax.lines[0].get_data()
    np.testing.assert_array_equal(counts[np.asarray(differences) < 1e-9], [3, 6, 9, 12])


# ---- the whole disc


@pytest.fixture(scope="module")
def case() -> xr.DataTree:
    """A light disc that turns and separates soon; three modes, five angles."""
    p = Parameters(N=300, Omega=50, n_diameters=2, normalization="orthonormal")
    windows = [Window(start=0.5, stop=0.52, rate=2e4, theta=1.2 * j) for j in range(5)]
    windows.append(Window(start=0.5, stop=0.52, rate=2e4, theta=2.1))
    names = [*(f"around{j}" for j in range(5)), "elsewhere"]
    return simulate(p, 0.52, record=Record(windows=tuple(windows))).to_tree(names)


@pytest.mark.compiled
def test_the_disc_between_the_angles_is_the_disc(case: xr.DataTree) -> None:
    """Under the slider, and at an angle that the shape is not made from; to rounding of the displacement itself."""
    motion = motion_of(case)
    r_0 = np.array([motion.parameters.r_0])
    elsewhere = case["elsewhere"].to_dataset()
    size = float(np.abs(elsewhere["w"]).max())
    for i in range(0, motion.time.size, 20):
        under, there = motion.deflection(i, r_0, np.array([motion.slider[i], 2.1]))[0]
        assert under == pytest.approx(float(elsewhere["w"][i]), abs=1e-12 * size)
        assert there == pytest.approx(float(elsewhere["w_point"][i]), abs=1e-12 * size)

    p = motion.parameters
    w = np.abs(motion.deflection(10, np.array([p.a, p.a + 1e-3 * (p.b - p.a), p.b]), np.linspace(0, 6, 7))).max(axis=1)
    assert w[0] < 1e-9 * w[2], "it is clamped inside"
    assert 0 < w[1] < 1e-5 * w[2]  # it leaves its plane with the square of the distance


@pytest.mark.compiled
def test_what_does_not_determine_the_disc_is_said(case: xr.DataTree) -> None:
    with pytest.raises(Missing, match="recorded the disc at 4 angles, 5 are needed"):
        motion_of(case.drop_nodes("around4"))
    late = case["around1"].to_dataset().assign_coords(time=case["around1"]["time"] + 1.0)
    with pytest.raises(Missing, match="at other times at other angles"):
        motion_of(case.assign(around1=xr.DataTree(late)))
    circles, p = case.copy(), Parameters.model_validate_json(case.attrs["parameters"])
    circles.attrs["parameters"] = p.replace(n_circles=1).canonical_json
    with pytest.raises(Missing, match="nodal circles"):
        motion_of(circles)


def test_a_film_moves(tmp_path: Path) -> None:
    path = tmp_path / "film.webp"
    film(simulated(True), path, frames=3)
    with Image.open(path) as picture:
        assert picture.n_frames >= 3
    assert path.stat().st_size < 100_000
