"""Pictures that a reader asks for by public names: what they show, on which axes, and what is
refused."""

import functools
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot
from matplotlib.animation import AbstractMovieWriter
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image

import disc_model as dm
from disc_model.analysis.spectra import amplitude_spectrum
from disc_model.stability.cycle import CycleError
from tests.figures.examples import EXAMPLES, GROWTH, LOAD, SPEED, SPEEDS
from tests.figures.measured import Shown, assert_shows, label_along, parts_of
from tests.refusals import refusal

CASE = dm.Parameters(N=385, Omega=15)
WEAKER = CASE.replace(Omega=12)
ALONG = [10.0, 12.0, 14.0]  # rad/s
LOADS = [300.0, 385.0]  # N
FRICTION = "Static friction μ_s"


# ---- Results, each made once


@functools.cache
def run() -> dm.Result:
    """A run with windows of samples, of too few of them, of ranges, and of a section."""
    windows = {
        "late": dm.Window(last=0.05, rate=2e4, theta=0.5),
        "few": dm.Window(last=0.02, rate=100),
        "ranges": dm.Window(rate=1e3, envelope=100),
        "vibration": dm.Window(start=7, rate=4e3),
        "turns": dm.Poincare(theta=0.5),
    }
    return dm.simulate(CASE.replace(Omega=15.1), 10, windows)


@functools.cache
def line() -> xr.Dataset:
    return dm.sweep(dm.floquet, CASE, Omega=ALONG)


@functools.cache
def plane() -> xr.Dataset:
    """Cycles over speed and preload; there is none at 12 rad/s and 300 N."""
    return dm.sweep(dm.floquet, CASE, Omega=ALONG, N=LOADS)


@functools.cache
def cycle() -> Any:
    return dm.floquet(CASE)


@functools.cache
def sliding() -> Any:
    return dm.steady_sliding(CASE)


@functools.cache
def exponents() -> Any:
    return dm.lyapunov_exponents(CASE, 0.5, count=2)


@functools.cache
def critical() -> Any:
    return dm.critical(WEAKER, "mu_s", (0.3, 0.42), points=7)


@functools.cache
def curves() -> Any:
    bounds = {"Omega": (14, 15.5), "mu_s": (0.38, 0.42)}
    return dm.neutral_curves(WEAKER, bounds, [0.4], points=5)


@functools.cache
def branch() -> dm.Branch:
    """A branch with a fold."""
    return dm.continue_cycle(CASE.replace(Omega=14.9), "Omega", (14.8, 15.2))


def study(kind: str) -> xr.Dataset:
    """The study of an example."""
    return EXAMPLES[kind]().inputs["study"]


# ---- Pictures


class Picture(NamedTuple):
    """A picture, and what its axes have to show.

    draw : with the options of its function
    """

    draw: Callable[..., Any]
    shown: tuple[Shown, ...]


def sampled(name: str) -> np.ndarray:
    return np.asarray(run()["late"][name].values)[::20]


def sweep_line() -> Picture:
    rates = Shown(0, "y", GROWTH, line()["growth_rate"], "1/s")
    shown = (Shown(0, "x", SPEED, ALONG, "rad/s", "linear"), rates)
    return Picture(functools.partial(dm.plot_sweep, line()), shown)


def sweep_lines() -> Picture:
    heights = Shown(0, "y", "Period of the cycle", plane()["period"], "s", "linear")
    shown = (Shown(0, "x", LOAD, LOADS, "N", "linear"), heights)
    return Picture(functools.partial(dm.plot_sweep, plane(), "period", x="N"), shown)


def sweep_map() -> Picture:
    shown = (
        Shown(0, "x", SPEED, [10, 14], "rad/s", "linear"),
        Shown(0, "y", LOAD, LOADS, "N", "linear"),
        Shown(-1, "bar", "Period of the cycle", plane()["period"], "s"),
    )
    return Picture(functools.partial(dm.plot_sweep, plane(), "period"), shown)


def sweep_of_words() -> Picture:
    ends = Shown(0, "x", SPEED, [10, 14], "rad/s", "linear")
    shown = (ends, Shown(0, "y", LOAD, LOADS, "N", "linear"))
    return Picture(functools.partial(dm.plot_sweep, plane(), "status"), shown)


def sweep_of_samples() -> Picture:
    psi = study("bifurcation")["psi"]
    shown = (Shown(0, "x", SPEED, SPEEDS, "rad/s"), Shown(0, "y", "Angle ψ", psi, "rad"))
    return Picture(functools.partial(dm.plot_sweep, study("bifurcation")), shown)


def sweep_of_shares() -> Picture:
    heights = Shown(0, "y", "Share of the starts", [1, 0.625, 0.375, 0.125, 0.875])
    shown = (Shown(0, "x", SPEED, [SPEEDS[0], SPEEDS[-1]], "rad/s"), heights)
    return Picture(functools.partial(dm.plot_sweep, study("basins"), "basin_fraction"), shown)


def campbell() -> Picture:
    found = study("campbell")
    multiple = (2.5 * found["stick_slip_frequency"]).values
    frequencies = [*found["sliding_frequency"].values.ravel(), *multiple]
    shown = (
        Shown(0, "y", "Frequency in steady sliding", frequencies, "Hz", "linear"),
        Shown(1, "x", SPEED, found["Omega"], "rad/s", "linear"),
        Shown(1, "y", GROWTH, found["growth_rate"], "1/s"),
    )
    return Picture(functools.partial(dm.plot_campbell, found, multiples=[2.5]), shown)


def history() -> Picture:
    shown = (
        Shown(0, "y", "Contact force P", sampled("P"), "N"),
        Shown(1, "y", "Disc at r_0, θ = 0.5 rad", sampled("w_point"), "m"),
        Shown(1, "x", "Time", sampled("time"), "s"),
    )
    draw = functools.partial(run().plot, "late", variables=["P", "w_point"])
    return Picture(draw, shown)


def portrait() -> Picture:
    shown = (
        Shown(0, "x", "Disc under the slider w", sampled("w"), "m"),
        Shown(0, "y", "Slider du/dt", sampled("u_velocity"), "m/s"),
    )
    draw = functools.partial(run().plot_phase_portrait, "late", x="w", y="u_velocity")
    return Picture(draw, shown)


def section() -> Picture:
    turns = run()["turns"]
    shown = (
        Shown(0, "x", "Angle ψ", turns["psi"], "rad"),
        Shown(1, "y", "Disc velocity at r_0, θ = 0.5 rad", turns["w_point_velocity"], "m/s"),
    )
    return Picture(functools.partial(run().plot_poincare, "turns"), shown)


def spectrum() -> Picture:
    samples = run()["vibration"]
    frequency, amplitude = amplitude_spectrum(samples["time"].values, samples["w"].values)
    inside = frequency < 300
    shown = (
        Shown(0, "x", "Frequency", frequency[inside], "Hz", "linear"),
        Shown(0, "y", "Disc under the slider w, amplitude", amplitude[inside], "m", "log"),
    )
    draw = functools.partial(run().plot_spectrum, "vibration", variable="w", highest=300)
    return Picture(draw, shown)


def multipliers() -> Picture:
    values = cycle().multipliers
    shown = (Shown(0, "x", "Re κ", values.real), Shown(0, "y", "Im κ", values.imag))
    return Picture(cycle().plot, shown)


def eigenvalues() -> Picture:
    upper = sliding().eigenvalues[sliding().eigenvalues.imag >= 0]
    shown = (
        Shown(0, "x", "Growth rate", upper.real, "1/s"),
        Shown(0, "y", "Frequency", upper.imag / (2 * np.pi), "Hz"),
    )
    return Picture(sliding().plot, shown)


def lyapunov() -> Picture:
    found = exponents()
    ends = [*(found.exponents - found.errors), *(found.exponents + found.errors)]
    heights = Shown(0, "y", "Lyapunov exponent", [*found.exponents, *ends], "1/s")
    return Picture(found.plot, (Shown(0, "x", "Number", [1, 2]), heights))


def critical_values() -> Picture:
    found = critical()
    shown = (
        Shown(0, "x", FRICTION, [*found.values, *found.unstable.ravel()]),
        Shown(0, "y", "Growth rate", found.growth_rate, "1/s"),
    )
    return Picture(found.plot, shown)


def neutral() -> Picture:
    speeds, friction = curves().curves[0].values.T
    shown = (Shown(0, "x", SPEED, speeds, "rad/s"), Shown(0, "y", FRICTION, friction))
    return Picture(curves().plot, shown)


def periods() -> Picture:
    shown = (
        Shown(0, "x", SPEED, branch().values, "rad/s"),
        Shown(0, "y", "Period of the cycle", branch().period, "s"),
    )
    return Picture(functools.partial(branch().plot, "period"), shown)


LINES = (
    sweep_line,
    sweep_lines,
    portrait,
    spectrum,
    multipliers,
    eigenvalues,
    lyapunov,
    critical_values,
    neutral,
    periods,
)
"""Pictures on one panel, with a look of lines."""
ON_AXES = (*LINES, sweep_map, sweep_of_words, sweep_of_samples, sweep_of_shares)
PICTURES = (*ON_AXES, campbell, history, section)


def named(function: Callable[..., Any]) -> str:
    return function.__name__


def figure_of(drawn: Any) -> Figure:
    """The figure of axes, or of the first of several."""
    return np.ravel(np.asarray(drawn, dtype=object))[0].figure


def entries(ax: Axes) -> list[str]:
    """What the legend of axes, or of their figure, says."""
    legends = [ax.get_legend(), *ax.figure.legends]
    return [text.get_text() for legend in legends if legend for text in legend.get_texts()]


@pytest.mark.parametrize("picture", PICTURES, ids=named)
def test_label_unit_and_values_are_those_of_the_data(picture: Callable[[], Picture]) -> None:
    draw, shown = picture()
    figure = figure_of(draw())
    figure.draw_without_rendering()
    for expected in shown:
        assert_shows(figure, expected)


@pytest.mark.parametrize("picture", ON_AXES, ids=named)
def test_a_picture_is_drawn_on_the_axes_of_a_reader(picture: Callable[[], Picture]) -> None:
    draw, shown = picture()
    figure, (ax, other) = pyplot.subplots(2)
    assert draw(ax=ax) is ax
    assert pyplot.get_fignums() == [figure.number]
    assert not other.has_data()
    for expected in shown:
        assert_shows(figure, expected)


@pytest.mark.parametrize("picture", LINES, ids=named)
def test_a_second_picture_lies_beside_the_first_in_the_next_colour(
    picture: Callable[[], Picture],
) -> None:
    draw, shown = picture()
    _, ax = pyplot.subplots()
    draw(ax=ax, label="first")
    draw(ax=ax, label="second")
    colours = {drawn.get_label(): drawn.get_color() for drawn in ax.lines}
    assert colours["first"] != colours["second"]
    assert {"first", "second"} <= {*entries(ax)}
    for expected in shown:
        assert_shows(ax.figure, expected)


@pytest.mark.parametrize("picture", LINES, ids=named)
@pytest.mark.parametrize("look", [{"color": "teal", "linewidth": 3.5}, {"c": "teal", "lw": 3.5}])
def test_options_of_matplotlib_reach_the_line(
    picture: Callable[[], Picture], look: Mapping[str, Any]
) -> None:
    looks = {(drawn.get_color(), drawn.get_linewidth()) for drawn in picture().draw(**look).lines}
    assert ("teal", 3.5) in looks


def test_options_of_matplotlib_reach_the_colours_of_a_map() -> None:
    norm = pyplot.Normalize(0, 0.02)
    [mesh] = sweep_map().draw(cmap="viridis", norm=norm).collections
    assert mesh.get_cmap().name == "viridis"
    assert mesh.norm is norm


UNITS = [
    (sweep_line, {"Omega": "rpm"}, 0, "x", "rpm"),
    (sweep_map, {"N": "kN"}, 0, "y", "kN"),
    (sweep_of_samples, {"psi": "mrad"}, 0, "y", "mrad"),
    (campbell, {"Omega": "rpm"}, 1, "x", "rpm"),
    (history, {"P": "kN", "w_point": "um"}, 0, "y", "kN"),
    (portrait, {"w": "um"}, 0, "x", "um"),
    (section, {"psi": "mrad"}, 0, "x", "mrad"),
    (spectrum, {"w": "um"}, 0, "y", "um"),
    (periods, {"Omega": "rpm"}, 0, "x", "rpm"),
]


@pytest.mark.parametrize(("picture", "units", "panel", "axis", "unit"), UNITS)
def test_values_are_in_the_units_of_the_reader(
    picture: Callable[[], Picture], units: dict[str, str], panel: int, axis: str, unit: str
) -> None:
    draw, shown = picture()
    figure = figure_of(draw(units=units))
    assert parts_of(label_along(figure.axes[panel], axis))[1] == unit
    for expected in shown:
        assert_shows(figure, expected)


# ---- What legends say


def test_lines_over_a_second_dimension_are_named_by_its_values() -> None:
    said = entries(dm.plot_sweep(plane(), "period", x="Omega"))
    assert said == ["N = 300 N", "N = 385 N", "no value: there is no cycle"]


def test_a_map_of_words_has_a_legend_of_those_that_occur() -> None:
    """Also on a reader's axes, and in words of their own."""
    words = [["stick_slip", "separation"], ["growing", "my_class"]]
    axes = {"Omega": ALONG[:2], "N": LOADS}
    data = xr.Dataset({"outcome": (("Omega", "N"), words)}, axes)
    expected = ["stick-slip, small", "growing, in contact", "separation", "my class"]
    assert entries(dm.plot_sweep(data)) == expected
    assert entries(dm.plot_sweep(data, ax=pyplot.subplots()[1])) == expected


def test_a_branch_is_thick_where_it_is_stable_up_to_its_fold() -> None:
    ax = branch().plot()
    [thick] = [drawn for drawn in ax.lines if drawn.get_label() == "thick: stable"]
    places = thick.get_xdata()
    assert [places[0], places[np.isfinite(places)].max()] == [14.8, branch().folds[0]]
    assert {"thick: stable", "fold"} <= {*entries(ax)}


def test_a_special_point_is_marked_in_the_units_of_both_axes() -> None:
    fold = branch().special_points.loc[1]
    ax = branch().plot("period", units={"Omega": "rpm"})
    [mark] = [drawn for drawn in ax.lines if drawn.get_label() == "fold"]
    assert mark.get_xdata() == pytest.approx([fold.Omega * 30 / np.pi], rel=1e-12)
    assert mark.get_ydata() == pytest.approx([1e3 * fold.period], rel=1e-12)


def test_a_critical_value_bounds_the_shaded_part() -> None:
    band, *_ = critical().plot().patches
    assert band.get_x() == 0.3
    assert band.get_x() + band.get_width() == pytest.approx(critical().crossings[0])


def test_what_grows_has_a_ring() -> None:
    growing = sliding().growing[sliding().growing.imag >= 0]
    [rings] = [drawn for drawn in sliding().plot().lines if drawn.get_label() == "grows"]
    np.testing.assert_allclose(rings.get_xdata(), growing.real)
    values = np.array([0.9 + 0.9j, 0.9 - 0.9j, -1.2, 0.99, -0.3])
    ax = replace(cycle(), multipliers=values).plot()
    [rings] = [drawn for drawn in ax.lines if drawn.get_label() == "grows"]
    assert rings.get_xdata().tolist() == [0.9, 0.9, -1.2]


def test_a_run_without_a_window_shows_all_of_it_and_four_cycles() -> None:
    axes = run().plot()
    assert axes.shape == (3, 2)
    releases = run().events["time"][run().events["kind"] == "stick_to_slip"]
    for column, (start, end) in zip(axes.T, ((0, 10), (releases.iloc[-5], 10)), strict=True):
        times = column[0].dataLim.intervalx
        assert times == pytest.approx([start, end], abs=0.01)


def test_phases_of_a_run_are_told_apart() -> None:
    assert entries(run().plot_phase_portrait()) == ["slip", "stick"]
    assert entries(run().plot()[0, 0]) == ["stick"]


# ---- Modes, and films


def test_modes_are_drawn_with_their_nodal_lines_and_frequencies() -> None:
    axes = dm.plot_modes(CASE, 3)
    found = dm.plate_modes(CASE)
    order = np.argsort(found["omega"].values)[:3]
    for ax, i in zip(axes, order, strict=True):
        diameters, circles = int(found["diameters"][i]), int(found["circles"][i])
        hertz = float(found["omega"][i]) / (2 * np.pi)
        assert ax.get_title() == f"({diameters}, {circles})  {hertz:.0f} Hz"
        outer = np.asarray(ax.collections[0].get_array()).reshape(25, 181)[-1]
        assert np.count_nonzero(np.diff(np.sign(outer))) == 2 * diameters
    assert dm.plot_modes(CASE).size == len(found["omega"])


class Seen(AbstractMovieWriter):
    """A writer of films that looks at each picture: its title, and whether its force is the run's."""

    def __init__(self) -> None:
        super().__init__()
        self.titles: list[str] = []

    def setup(self, fig: Figure, outfile: Any, dpi: float | None = None) -> None:
        super().setup(fig, outfile, dpi)

    def grab_frame(self, **_: Any) -> None:
        assert_shows(self.fig, Shown(1, "y", "Contact force P", sampled("P"), "N"))
        self.titles.append(self.fig.axes[1].get_title())

    def finish(self) -> None:
        pass


def test_a_film_has_the_disc_and_the_force_at_each_of_its_times(tmp_path: Path) -> None:
    seen = Seen()
    run().animate(window="late", frames=3).save("film", writer=seen)
    assert [title.split(",")[0] for title in seen.titles] == ["9.9500 s", "9.9750 s", "10.0000 s"]
    run().animate(tmp_path / "film.gif", "late", frames=2)
    with Image.open(tmp_path / "film.gif") as film:
        assert film.n_frames == 2


# ---- Points without a value


def failed(data: xr.Dataset) -> xr.Dataset:
    """A sweep of which all points have failed."""
    changed = {name: x.where(False) for name, x in data.data_vars.items() if x.dtype.kind == "f"}
    return data.assign({**changed, "status": xr.full_like(data["status"], "failed")})


def first(data: xr.Dataset) -> xr.Dataset:
    """A sweep of one speed."""
    return data.isel(Omega=slice(1))


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("variable", ["growth_rate", "period", "status"])
@pytest.mark.parametrize("data", [line, plane], ids=named)
@pytest.mark.parametrize(("change", "x"), [(failed, ""), (failed, "Omega"), (first, "Omega")])
def test_failed_points_and_single_ones_are_drawn(
    data: Callable[[], xr.Dataset], variable: str, change: Callable[..., xr.Dataset], x: str
) -> None:
    ax = dm.plot_sweep(change(data()), variable, x)
    assert ax.get_xlabel() == "Speed Ω (rad/s)"
    ax.figure.draw_without_rendering()


def test_a_failed_point_is_told_from_others() -> None:
    """Along a line by a cross, and in a map by its class."""
    status = xr.full_like(line()["status"], "ok").astype(object)
    status[1] = "failed"
    gap = line().assign(status=status, period=line()["period"].fillna(0.015).where(status == "ok"))
    ax = dm.plot_sweep(gap, "period")
    crosses = [drawn.get_xdata().tolist() for drawn in ax.lines if drawn.get_marker() == "x"]
    assert crosses == [[12.0]]
    whole = plane().assign(status=xr.full_like(plane()["status"], "failed"))
    said = entries(dm.plot_sweep(whole.assign(period=whole["period"].where(False)), "period"))
    assert said == ["failed"]


@pytest.mark.filterwarnings("error")
def test_results_without_numbers_are_drawn() -> None:
    nothing = np.full(2, np.nan)
    unknown = replace(exponents(), exponents=np.array([-np.inf, np.nan]), errors=nothing)
    assert "−∞, below any number" in entries(unknown.plot())
    size = critical().values.size
    none = {"growth_rate": np.full(size, np.nan), "stable": np.zeros(size, bool)}
    found = replace(critical(), **none)
    found.plot().figure.draw_without_rendering()


# ---- What is refused

THIRD = {"c": [0.0, 0.1]}
DISC = dm.Disc(diameters=[0], omega=[1e3], amplitude=[1.0])
REFUSED = {
    "study=3: must be an xarray.Dataset": lambda: dm.plot_sweep(3),
    "variable='perod': unknown variable, did you mean period": lambda: dm.plot_sweep(
        plane(), "perod"
    ),
    r"variable='period': varies along c, Omega, N, but must .* study\.sel": lambda: dm.plot_sweep(
        plane().expand_dims(THIRD), "period"
    ),
    "x='k': must be one of its dimensions": lambda: dm.plot_sweep(line(), x="k"),
    "units.Omega='1 m'": lambda: dm.plot_sweep(line(), units={"Omega": "m"}),
    "units.speed='rpm': no parameter": lambda: dm.plot_sweep(line(), units={"speed": "rpm"}),
    "ax=3: must be axes of matplotlib": lambda: dm.plot_sweep(line(), ax=3),
    "study=.*: must be a study of the quantity campbell": lambda: dm.plot_campbell(line()),
    "highest=-3: must be > 0": lambda: campbell().draw(highest="-3 Hz"),
    r"multiples.*-1.*must be": lambda: dm.plot_campbell(study("campbell"), multiples=[-1]),
    "study='c': must vary along Omega alone": lambda: dm.plot_campbell(
        study("campbell").expand_dims(THIRD)
    ),
    "most=0: must be": lambda: dm.plot_modes(CASE, 0),
    "n_diameters=-1: must be >= 0": lambda: dm.plot_modes(CASE.replace(n_diameters=-1)),
    "disc.*radii": lambda: dm.plot_modes(CASE.replace(disc=DISC)),
    "windows='lat': the run did not record": lambda: run().plot("lat"),
    r"variables=.*\['v'\].*did not record v": lambda: run().plot("late", variables=["v"]),
    "x='v': is not among the samples": lambda: run().plot_phase_portrait("late", x="v"),
    "x='psi': is not among the samples of the window ranges": lambda: run().plot_phase_portrait(
        "ranges"
    ),
    "variable='w_point': is not among": lambda: run().plot_spectrum("ranges"),
    "window='few': the run": lambda: run().plot_spectrum("few"),
    "highest=0.*: must be": lambda: run().plot_spectrum(highest=0),
    r"window='late': must be a recorded Poincare .*turns": lambda: run().plot_poincare("late"),
    "frames=0: must be": lambda: run().animate(frames=0),
    "path='film.txt': must end in": lambda: run().animate("film.txt"),
    "window='lat': the run did not record": lambda: run().animate(window="lat"),
    "y='speed': must be one of": lambda: branch().plot("speed"),
    "ax=.*: must be axes": lambda: branch().plot(ax="axes"),
    "status='at_rest'.*no eigenvalues": lambda: dm.steady_sliding(CASE.replace(Omega=0)).plot(),
    "curves=0: there is nothing to draw": lambda: replace(curves(), curves=()).plot(),
}


@pytest.mark.parametrize("message", REFUSED)
def test_wrong_arguments_are_refused_by_name_value_and_rule(message: str) -> None:
    with refusal(message):
        REFUSED[message]()


def test_a_search_without_a_cycle_has_no_picture() -> None:
    with pytest.raises(CycleError):
        dm.floquet(CASE.replace(Omega=15.1)).plot()
