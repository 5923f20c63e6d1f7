"""What results draw of themselves."""

import functools
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot
from matplotlib.patches import Rectangle
from PIL import Image

import disc_model as dm
from disc_model.figures.amplitudes import amplitudes
from disc_model.figures.spectrum_lines import draw_spectrum
from disc_model.figures.sweep_study import OF_FUNCTIONS
from tests.figures.reading import as_map, labels
from tests.refusals import refusal

P = dm.Parameters(N=385, Omega=15.1)


@functools.cache
def run() -> dm.Result:
    """A minute at whose end contact is lost twice a cycle; without a window."""
    return dm.simulate(P, 60)


def test_a_run_without_windows_shows_its_range_and_its_last_cycles_with_their_phases() -> None:
    axes = run().plot()
    assert axes.shape == (3, 2)
    whole, close = axes[0]
    (mark,) = (line for line in whole.lines if line.get_linestyle() == "--")
    assert mark.get_xdata()[0] == run().first_separation
    events = run().events
    start, end = close.get_xlim()
    assert np.isclose(
        start, events["time"][events["kind"] == "stick_to_slip"].iloc[-5], atol=1e-9
    ), "four cycles"
    assert end == 60
    separations = events["time"][(events["kind"] == "separation") & (events["time"] > start)]
    shades = {shade.get_label(): shade for shade in axes[0, 0].figure.legends[0].legend_handles}
    assert [*shades] == ["stick", "slip", "separation"]
    bars = close.collections[1].get_paths()
    begins = np.array([bar.vertices[:, 0].min() for bar in bars])
    step = (end - start) / 4000  # borders lie halfway between samples
    for time in separations:
        assert np.abs(begins - time).min() < step
    assert axes[0, 0].figure.get_suptitle() == "N = 385 N, Ω = 15.1 rad/s"


def test_pictures_are_drawn_on_the_axes_that_are_given() -> None:
    figure, axes = pyplot.subplots(2, 2)
    assert run().plot_phase_portrait(ax=axes[0, 0]) is axes[0, 0]
    assert labels(axes[0, 0]) == ["stick", "slip", "separation"]
    axes[0, 0].set_title("Mine")
    run().plot_phase_portrait(ax=axes[0, 0])
    legend = axes[0, 0].get_legend().get_window_extent()
    assert axes[0, 0].get_window_extent().containsy(legend.y1), "the place of a title stays free"
    run().plot_spectrum(ax=axes[0, 1], highest=300)
    assert axes[0, 1].get_xlim()[1] == pytest.approx(300, abs=0.2)
    run().plot_poincare(ax=axes[1])
    assert figure.get_suptitle() == ""
    ranges = dm.simulate(
        P, 0.1, {"all": dm.Window(rate=1e4, envelope=100), "few": dm.Window(last=0.1, rate=100)}
    )
    with refusal("window='few': recorded 11 samples, and a spectrum takes 16"):
        ranges.plot_spectrum("few")
    for draw in (ranges.plot_phase_portrait, ranges.plot_spectrum):
        with refusal("window='all': must hold samples, not their ranges"):
            draw("all")
    with refusal(r"ax=.*: must be 6 axes of matplotlib, one for each panel"):
        run().plot(ax=axes[0])


@pytest.mark.parametrize(
    ("count", "entries"), [(1, ["Ω from 15.1 to 14 rad/s, 0.2 to 0.3 s"]), (5, ["ramps of Ω"])]
)
def test_ramps_are_shaded_with_their_values(count: int, entries: list[str]) -> None:
    """Nothing said where a ramp begins and ends."""
    ramps = []
    for i in range(1, count + 1):
        speed = 14.0 + i % 2 - (count == 1)
        ramps.append(dm.Ramp(parameter="Omega", to=speed, start=0.2 * i, end=0.2 * i + 0.1))
    window = dm.Window(start=0, rate=500)
    ramped = dm.simulate(P.replace(Omega=15.1), 1.2, {"all": window}, ramps=tuple(ramps))
    ax = ramped.plot("all", variables=["P"])
    assert [text for text in labels(ax.figure) if "Ω" in text] == entries
    shades = [patch for patch in ax.patches if isinstance(patch, Rectangle)]
    begins = [round(patch.get_x(), 6) for patch in shades]
    ends = [round(patch.get_x() + patch.get_width(), 6) for patch in shades]
    assert begins == [round(ramp.start, 6) for ramp in ramps]
    assert ends == [round(ramp.end, 6) for ramp in ramps]
    assert ax.get_xlim()[0] == 0
    pyplot.close("all")


def test_a_film_has_its_frames(tmp_path: Path) -> None:
    path = tmp_path / "film.gif"
    run().animate(path, frames=3)
    with Image.open(path) as film:
        assert film.n_frames == 3


def test_a_film_takes_its_window_by_position_as_plots_do() -> None:
    with refusal("window='late': was not recorded"):
        run().animate(None, "late", frames=2)


def test_multipliers_eigenvalues_and_a_branch_show_their_stability() -> None:
    cycle = dm.floquet(P.replace(Omega=15))
    words = " ".join(cycle.plot().get_title(loc="left").split())
    assert "stable, growth rate -0.105/s" in words
    sliding = dm.steady_sliding(P)
    neutral = dm.steady_sliding(P.replace(mu_s=0, mu_k=0, D_star=0))
    assert labels(neutral.plot().figure) == ["neutral"]
    assert labels(sliding.plot().figure) == ["decays", "grows"]
    unstable = sliding.eigenvalues[(sliding.eigenvalues.real > 0) & (sliding.eigenvalues.imag >= 0)]
    axes = sliding.plot()
    axes.figure.draw_without_rendering()  # chooses the places of names
    named = [text.get_text() for text in axes.texts if text.get_visible()]
    frequencies = unstable.imag / 2 / np.pi
    count = len(unstable)
    expected = [f"{x:.0f} Hz" for x in frequencies]
    assert named[:count] == expected
    branch = dm.continue_cycle(P.replace(Omega=14.9), "Omega", (14.8, 15.2))
    assert "fold at 15.095 rad/s" in labels(branch.plot().figure)


def test_critical_values_neutral_curves_and_exponents_are_drawn_with_their_case() -> None:
    case = P.replace(mu_k_over_mu_s=0.6)
    slower = case.replace(Omega=12)
    critical = dm.critical(slower, "mu_s", (0.3, 0.42), points=7, precision=1e-3)
    assert critical.unstable[0, 0] == 0.3
    [band] = critical.plot().patches
    assert band.get_xy()[0] + band.get_width() == pytest.approx(critical.crossings[0])
    assert "μ" in pyplot.gcf().get_suptitle(), "the ratio of friction is stated"
    sliding = dm.critical(slower, "mu_s", (0.3, 0.42), points=3, kind="sliding")
    assert sliding.plot().get_ylabel() == "Growth rate of steady sliding (1/s)"
    assert labels(pyplot.gcf()) == ["unstable steady sliding", "values computed"]
    curves = dm.neutral_curves(case, {"Omega": (14, 15.5), "mu_s": (0.38, 0.42)}, [0.4], points=5)
    axes = curves.plot()
    assert labels(axes.figure) == ["cycle ends in a fold"]
    assert axes.get_xlim() == (14, 15.5)
    assert axes.get_ylim() == (0.38, 0.42)
    exponents = dm.lyapunov_exponents(P, 0.5, count=2)
    assert exponents.plot().get_title(loc="left") == "over 0.5 s, 0 separations"


@pytest.mark.parametrize(
    ("name", "options", "label"),
    [
        ("lyapunov_exponents", {"duration": 0.2, "count": 2}, "Largest Lyapunov exponent (1/s)"),
        ("simulate", {"t_end": 0.1}, "Number of separations within 0.1 s"),
        (
            "coupled_natural_frequencies",
            {},
            "Lowest natural frequency of disc\nand attached slider (rad/s)",
        ),
        ("choose_modes", {}, "Number of real-valued modes"),
    ],
)
def test_a_sweep_shows_first_what_a_reader_looks_for(
    name: str, options: dict[str, Any], label: str
) -> None:
    """It showed the time of averaging, the steps of the simulation, or the status."""
    swept = dm.sweep(getattr(dm, name), P, k=[4e4, 5e4, 6e4], **options)
    ax = dm.plot_sweep(swept)
    shown = swept[OF_FUNCTIONS[name]]
    first = shown.isel(dict.fromkeys({*shown.dims} - {"k"}, 0))
    np.testing.assert_allclose(ax.lines[0].get_ydata(), first)
    assert " ".join(ax.get_ylabel().split()) == " ".join(label.split())


def test_a_sweep_is_drawn_as_a_line_or_as_a_map() -> None:
    line = dm.sweep(dm.floquet, P, Omega=[10, 12, 14, 15])
    ax = as_map(line)
    np.testing.assert_allclose(ax.lines[0].get_ydata(), line["growth_rate"])
    assert ax.get_xlabel() == "Speed Ω (rad/s)"
    plane = dm.sweep(dm.floquet, P, Omega=[10, 12, 14], N=[300, 385])
    ax = as_map(plane, "period", x="N")
    np.testing.assert_allclose(ax.collections[0].get_array(), 1e3 * plane["period"])
    assert ax.get_ylabel() == "Speed Ω (rad/s)"
    assert ax.figure.axes[1].get_ylabel() == "Period of the stick-slip cycle (ms)"
    outcomes = plane.assign(
        outcome=(("Omega", "N"), [["quiet", "quiet"], ["separation", "quiet"], ["quiet", "quiet"]])
    )
    named = labels(as_map(outcomes, "outcome").figure)
    assert named == ["quiet", "separation", "unresolved", "Outcome"]
    with refusal("variable='perod': must be one over the grid, did you mean period"):
        as_map(plane, "perod")
    with refusal("study='c, Omega, N': must vary along at most two"):
        as_map(plane.expand_dims(c=[0.0, 0.1]), "period")
    counted = {
        "growth_rate": (("branch", "branch_point"), np.ones((2, 3))),
        "reached": ("sweep_value", [1.0, 2.0]),
    }
    branches = xr.Dataset(
        counted, {"branch": [0, 1], "branch_point": [0, 1, 2], "sweep_value": [10.0, 11.0]}
    )
    np.testing.assert_allclose(as_map(branches).lines[0].get_ydata(), [1, 2])


def test_a_sweep_of_sliding_is_not_called_a_cycle() -> None:
    """The growth of steady sliding was that of the stick-slip cycle, and its dots a stable cycle."""
    axes = {"Omega": [10.0, 20.0, 40.0], "N": [50.0, 300.0]}
    sliding = dm.sweep(dm.steady_sliding, P.replace(c_p=0.5), **axes)
    assert (sliding["growth_rate"] < 0).sel(N=50).all()
    assert (sliding["growth_rate"] > 0).sel(N=300).all()
    figure = as_map(sliding).figure
    assert " ".join(figure.axes[1].get_ylabel().split()) == "Growth rate of steady sliding (1/s)"
    assert "stable" in labels(figure)
    assert "stable cycle" not in labels(figure)
    [line] = as_map(sliding.sel(N=300)).lines[:1]
    assert " ".join(line.axes.get_ylabel().split()) == "Growth rate of steady sliding (1/s)"


def test_sliding_that_grows_is_not_painted_as_steady() -> None:
    case = P.replace(friction_offset="surface", normalization="orthonormal")
    plane = dm.sweep(dm.floquet, case, Omega=[10.0, 60.0], N=[300.0, 2000.0])
    plane["status"] = plane["status"].where(plane["Omega"] < 60, "no_stick_slip")
    plane["growth_rate"] = plane["growth_rate"].where(plane["Omega"] < 60)
    plane["sliding_growth_rate"].loc[{"Omega": 60.0}] = [-0.1, 1.2]
    assert {"steady sliding", "unstable steady sliding"} <= set(labels(as_map(plane).figure))
    assert "slides without sticking" in labels(
        as_map(plane.drop_vars("sliding_growth_rate")).figure
    )


def test_shares_of_starts_are_bars_of_the_outcomes_that_occur() -> None:
    sweep = dm.sweep(dm.basins, P, Omega=[14, 15], energies=[1e-4, 0.1], horizon=60)
    for study, low, high in (
        (sweep.sel(Omega=14), [1, 0], [0, 1]),
        (sweep, [0.5, 0.5], [0.5, 0.5]),
    ):
        ax = dm.plot_sweep(study)
        interval = "95 % interval of the share that separates"
        assert labels(ax.figure) == ["quiet", "separating", interval]
        assert [bar.get_height() for bar in ax.patches] == high + low  # those that separate first


def test_undecided_starts_that_have_lost_contact_are_counted() -> None:
    """It could not be told whether an undecided motion had separated."""
    found = dm.basins(P.replace(Omega=14), [0.1, 1000.0], 2, horizon=0.5)
    assert found["kind"].values.tolist() == [["undecided"] * 2] * 2
    assert found["lost_contact"].values.tolist() == [["no"] * 2, ["yes"] * 2]
    said = "4 of 4 starts (2 after contact was lost) undecided within the horizon: raise it"
    assert found.attrs["message"] == said


def test_a_disc_shows_its_modes_and_what_is_not_there_is_said() -> None:
    shapes = [[0.0, 1.0], [0.0, 4.0]]
    disc = dm.Disc(
        diameters=[0, 1], omega=[1e3, 2e3], amplitude=[1.0, 4.0], radii=[0.05, 0.12], shapes=shapes
    )
    assert repr(disc) == "Disc(2 modes, 159.15 to 318.31 Hz)"
    assert repr(disc.first(1)) == "Disc(1 mode, 159.15 Hz)"
    assert len(dm.plot_modes(P.replace(disc=disc))) == 2
    with refusal("no eigenvalues: The disc is not driven"):
        dm.steady_sliding(P.replace(Omega=0)).plot()
    with pytest.raises(dm.DiscModelError, match=r"no cycle of .* by disc_model\.continue_cycle\."):
        dm.floquet(P).plot()


@pytest.mark.parametrize(
    ("last", "named", "label"),
    [
        (0.1, {"140 Hz"}, "Frequency (Hz), resolution 10 Hz"),
        (8, {"2.4 Hz", "137.8 Hz"}, "Frequency (Hz)"),
    ],
)
def test_frequencies_of_peaks_have_the_digits_of_the_window(
    last: float, named: set[str], label: str
) -> None:
    """Of lines at 2.4 and 137.8 Hz, 0.1 s gave "11.4 Hz" and "135.5 Hz"."""
    time = np.arange(round(last * 4000) + 1) / 4000
    signal = 1e-3 * np.sin(math.tau * 2.4 * time) + 1e-3 * np.sin(math.tau * 137.8 * time)
    samples = xr.Dataset({"w_point": ("time", signal)}, {"time": time})
    figure, ax = pyplot.subplots()
    draw_spectrum(ax, samples, "w_point", amplitudes(samples, "w_point", 400))
    figure.draw_without_rendering()
    assert {text.get_text() for text in ax.texts if text.get_visible()} == named
    assert ax.get_xlabel() == label
    pyplot.close(figure)
