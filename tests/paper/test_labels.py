"""The paper's figures name the quantities on their axes and their units, and show the values of
their cases in these units."""

import re

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

from disc_model.data.variables import flag_names
from disc_model.disc.modes import plate_modes
from disc_model.figures.kinds import kinds_in
from disc_model.figures.render import render
from disc_model.parameters import Parameters
from tests.figures.measured import Shown, assert_shows, drawn_values
from tests.figures.test_cases import simulated
from tests.paper import evidence
from tests.paper.test_figures import FIGURES, STUDY, drawn
from workflow.paper.figures.kinds import STRETCH
from workflow.paper.figures.motion_around import motion_of

# s, of the window of the case
ZOOM_START = 56.0
SPAN = 0.035


def case() -> xr.DataTree:
    return simulated(True)


def window(name: str, variable: str) -> np.ndarray:
    return np.asarray(case()[name][variable].values)


def ranges(variable: str, last: float = 60.0) -> np.ndarray:
    """Least and greatest values in the bins of the history, up to a time in s."""
    shown = case()["history"].to_dataset().sel(time=slice(None, last))
    return np.concatenate([shown[f"{variable}_min"].values, shown[f"{variable}_max"].values])


def first_complete_separation() -> tuple[float, float]:
    """Its begin and end in the closer window, s, by the samples there."""
    time = window("zoom", "time")
    apart = flag_names(case()["zoom"]["phase"]) == "separation"
    starts = np.flatnonzero(~apart[:-1] & apart[1:]) + 1
    ends = np.flatnonzero(apart[:-1] & ~apart[1:])
    first = int(starts[0])
    return float(time[first]), float(time[ends[ends >= first][0]])


def after(label: str, figure: Figure, panel: int) -> float:
    """The time in s after which a panel shows milliseconds, as its label says."""
    found = re.search(r"Time after ([\d.]+) s \(ms\)", figure.axes[panel].get_xlabel())
    assert found is not None, label
    return float(found[1])


DISC = r"Disc at r_0, \theta = 0.5 rad"


def test_the_contact_force_is_in_newtons_and_its_close_look_in_milliseconds() -> None:
    figure = drawn("fig02", case())
    assert_shows(figure, Shown(0, "x", "Time", window("history", "time")[[5, 50]], "s"))
    assert_shows(figure, Shown(0, "y", "Contact force P", ranges("P")[10:20], "N"))
    assert_shows(figure, Shown(1, "y", "Contact force P", window("zoom", "P")[::100], "N"))
    start = after("fig02", figure, 1)
    assert start == pytest.approx(ZOOM_START, abs=1e-5)
    shown = drawn_values(figure.axes[1], "x")
    assert (shown.min(), shown.max()) == pytest.approx((0, 1e3 * SPAN), abs=1e-3)


def test_one_separation_is_in_millimetres_micrometres_and_milliseconds() -> None:
    figure = drawn("fig03", case())
    begin, end = first_complete_separation()
    assert after("fig03", figure, 1) == pytest.approx(begin, abs=1e-5)
    zoom = case()["zoom"].to_dataset().sel(time=slice(begin, end))
    rest = float(case()["u_0"])
    heights = np.concatenate([zoom["u"] - rest, zoom["w"] - rest])
    assert_shows(figure, Shown(0, "y", "Displacement", heights, "m"))
    assert_shows(figure, Shown(1, "y", "Gap", (zoom["u"] - zoom["w"]).values, "m"))
    times = drawn_values(figure.axes[1], "x")
    assert np.abs(times - 1e3 * (end - begin)).min() < 1e-3
    assert times.max() == pytest.approx(1.5e3 * (end - begin), abs=0.02)


def test_the_light_slider_is_in_millimetres_and_milliseconds() -> None:
    figure = drawn("fig23", case())
    start = after("fig23", figure, 0)
    zoom = case()["zoom"].to_dataset().sel(time=slice(start + 1e-3, start + 0.02))
    heights = (zoom["u"] - float(case()["u_0"])).values
    assert_shows(figure, Shown(0, "y", "Displacement", heights[1::50], "m"))
    assert drawn_values(figure.axes[0], "x").max() == pytest.approx(25, abs=0.1)


@pytest.mark.parametrize(("name", "panel"), [("fig10", 0), ("fig13", 2), ("fig25", 0)])
def test_ranges_of_the_disc_are_in_millimetres_over_seconds(name: str, panel: int) -> None:
    figure = drawn(name, case())
    labels = [" ".join(ax.get_ylabel().split()) for ax in figure.axes]
    assert labels[panel].endswith("(mm)")
    assert_shows(figure, Shown(panel, "y", DISC, ranges("w_point")[20:40], "m"))
    assert_shows(figure, Shown(panel, "x", "Time", window("history", "time")[[5, 50]], "s"))


def test_histories_have_the_contact_force_in_newtons() -> None:
    figure = drawn("fig13", case())
    assert_shows(figure, Shown(0, "y", "Contact force P", ranges("P")[10:20], "N"))


def test_spectra_in_time_are_in_hertz_over_seconds() -> None:
    figure = drawn("fig25", case())
    rows = [ax for ax in figure.axes if ax.get_ylabel() == "Frequency (Hz)"]
    assert [ax.get_ylim() for ax in rows] == [(300, 1000), (0, 300), (0, 300)]
    strongest = rows[1].collections[0]
    levels = np.ma.filled(np.ma.asarray(strongest.get_array(), dtype=float), np.nan)
    centre = 0.5 * np.diff(strongest.get_coordinates()[:, 0, 1]).mean()
    frequencies = strongest.get_coordinates()[:-1, 0, 1] + centre
    above = frequencies > 20  # what turns with the disc is below
    peak = frequencies[above][int(np.nanargmax(levels[above].mean(axis=1)))]
    # half the releases of a cycle of 14.8 ms each: 67.7 Hz, or a multiple of it
    assert min(abs(peak - n * 67.7) for n in (1, 2, 3, 4)) < 3  # or beside it, by a turn


def test_a_response_has_its_variable_in_its_unit_and_looks_in_milliseconds() -> None:
    name = next(name for name, plot in FIGURES.items() if name == "fig28")
    figure = drawn(name, case())
    labels = [" ".join(ax.get_ylabel().split()) for ax in figure.axes]
    assert "Angle ψ (rad)" in labels
    panel = labels.index("Angle ψ (rad)")
    assert_shows(figure, Shown(panel, "y", "Angle ψ", ranges("psi")[20:40], "rad"))
    looks = [ax for ax in figure.axes if "(ms)" in ax.get_xlabel()]
    assert not [ax for ax in looks if "Time after" not in ax.get_xlabel()]
    assert len(looks) == 2
    for ax, start in zip(looks, (56.5, 57.0), strict=True):
        low, high = ax.get_ylim()
        assert low < ax.dataLim.y0 < ax.dataLim.y1 < high, "peaks of the second one were cut"
        assert " ".join(ax.get_xlabel().split()) == f"Time after {start:g} s (ms)"
        assert drawn_values(ax, "x").max() == pytest.approx(200, abs=0.3)
        inside = (window("spectrum_d", "time") >= start) & (
            window("spectrum_d", "time") <= start + 0.2
        )
        psi = window("spectrum_d", "psi")[inside]
        assert drawn_values(ax, "y").max() == pytest.approx(psi.max(), rel=1e-9)


def test_instants_are_in_millimetres_and_milliseconds() -> None:
    motion = motion_of(case())
    figure = drawn("figB1", case())
    circle = next(ax for ax in figure.axes if ax.get_xlabel() == "Angle θ (rad)")
    assert circle.get_ylabel() == "Deflection at $r_0$ (mm)"
    edge = np.array([motion.parameters.b])
    largest = max(
        np.abs(motion.deflection(i, edge, np.linspace(0, 2 * np.pi, 181))).max()
        for i in range(0, motion.time.size, 5)
    )
    shown = np.abs(drawn_values(circle, "y")).max()
    # on the circle of the slider and at four instants, it is less than at the edge at any
    assert 0.3 * largest < 1e-3 * shown < largest
    [bar] = [ax for ax in figure.axes if ax.get_label() == "<colorbar>"]
    assert bar.get_ylabel() == "Deflection (mm)"
    assert bar.get_ylim()[1] == pytest.approx(1e3 * largest, rel=0.05)
    losses = np.flatnonzero(np.diff((motion.phase == "separation").astype(int)) == 1) + 1
    between = 1e3 * (motion.time[losses[1]] - motion.time[losses[0]])
    titles = [re.search(r"([\d.]+) ms", ax.get_title(loc="left")) for ax in figure.axes[:4]]
    shown_times = [float(found[1]) for found in titles if found]
    quarter = between / 4
    quarters = [i * quarter for i in range(4)]
    assert shown_times == pytest.approx(quarters, abs=0.15)


def test_the_composite_is_in_newtons_millimetres_and_milliseconds() -> None:
    figure = drawn("composite", case())
    growth, force = figure.axes[1:]
    assert_shows(figure, Shown(1, "y", "Displacement of the disc", ranges("w_point")[20:40], "m"))
    assert growth.get_xlabel() == "Time (s)"
    assert force.get_xlabel() == "Time after 57 s (ms)"
    assert force.get_ylabel() == "Contact force (N)"
    assert force.get_xlim() == pytest.approx((0, 1e3 * STRETCH))
    inside = (window("spectrum_d", "time") >= 57) & (window("spectrum_d", "time") <= 57.04)
    assert drawn_values(force, "y").max() == pytest.approx(window("spectrum_d", "P")[inside].max())


def test_the_schematic_has_radii_in_millimetres() -> None:
    texts = " ".join(text.get_text() for ax in drawn("fig01", case()).axes for text in ax.texts)
    titles = " ".join(ax.get_title(loc="left") for ax in drawn("fig01", case()).axes)
    assert "$a$ = 44 mm" in texts
    assert "$b$ = 120 mm" in texts
    assert "$r_0$ = 100 mm" in titles


def test_the_figure_on_both_scales_has_amplitudes_per_kilogram_and_times_in_seconds() -> None:
    plot = STUDY.figures["figB2"]
    maps = evidence.scans()
    inputs = {"study": xr.DataTree(maps["map_N"])}
    inputs.update((name, xr.DataTree(maps[name])) for name in plot.overlays)
    figure = render(plot, inputs)
    modes = plate_modes(Parameters(N=385, Omega=15, normalization="orthonormal"))
    squares = modes["psi"].to_numpy() ** 2
    assert_shows(
        figure, Shown(0, "y", r"Amplitude under the slider \Psi_l^2", squares, "1/kg", "log")
    )
    speeds, loads = (maps["map_N"][name].values for name in ("Omega", "N"))
    assert_shows(figure, Shown(1, "x", "Speed Ω", speeds[[0, -1]], "rad/s"))
    assert_shows(figure, Shown(1, "y", "Preload N", loads[[0, -1]], "N"))
    first = np.asarray(maps["map_m"]["first_separation"].values, dtype=float)
    assert_shows(
        figure, Shown(2, "x", "First separation", first[np.isfinite(first)][:1], "s", "log")
    )


def test_all_kinds_of_the_paper_are_among_these() -> None:
    compared = {"fig02", "fig03", "fig23", "fig10", "fig13", "fig25", "fig28", "figB1", "composite"}
    compared |= {"fig01", "figB2"}
    assert {STUDY.figures[name].kind for name in compared} == {*kinds_in("paper")}
