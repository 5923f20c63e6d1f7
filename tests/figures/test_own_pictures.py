"""Pictures that results draw of themselves name their quantities and units, and show their values in
them."""

import functools
import re
from typing import Any

import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.figure import Figure

import disc_model as dm
from disc_model.data.variables import CycleStatus
from disc_model.figures.disc import Motion
from disc_model.figures.film import film as film_of
from disc_model.simulation.api import snapshots
from disc_model.stability.cycle import FloquetResult
from tests.figures.measured import Shown, assert_shows, drawn_values
from tests.figures.reading import labels, lines

P = dm.Parameters(N=385, Omega=15.1)


@functools.cache
def run() -> dm.Result:
    windows = {"late": dm.Window(last=0.05, rate=2e4, theta=0.5)}
    return dm.simulate(P, 56, windows)


@pytest.fixture(autouse=True)
def _closed() -> object:
    yield
    pyplot.close("all")


def figure_of(drawn: object) -> Figure:
    return np.ravel(np.asarray(drawn, dtype=object))[0].get_figure()


def test_a_run_has_its_windows_in_seconds_newtons_and_millimetres() -> None:
    late = run()["late"]
    figure = figure_of(run().plot("late", variables=["P", "w_point"]))
    shown = [
        Shown(0, "y", "Contact force P", late["P"][::20], "N"),
        Shown(1, "y", r"Disc at r_0, \theta = 0.5 rad", late["w_point"][::20], "m"),
        Shown(1, "x", "Time", late["time"][::20], "s"),
    ]
    for expected in shown:
        assert_shows(figure, expected)


def test_a_portrait_and_a_section_have_the_units_of_their_variables() -> None:
    late = run()["late"]
    figure = figure_of(run().plot_phase_portrait("late", x="w", y="u_velocity"))
    assert_shows(figure, Shown(0, "x", "Disc under the slider w", late["w"][::20], "m"))
    assert_shows(figure, Shown(0, "y", "Slider du/dt", late["u_velocity"][::20], "m/s"))
    section = figure_of(run().plot_poincare())
    assert [ax.get_xlabel().split()[-1] for ax in section.axes[:2]] == ["(rad)", "(mm)"]
    assert [ax.get_ylabel().split()[-1] for ax in section.axes[:2]] == ["(rad/s)", "(m/s)"]


def test_multipliers_come_with_growth_per_second_and_the_period_in_milliseconds() -> None:
    cycle = dm.floquet(P.replace(Omega=15))
    figure = figure_of(cycle.plot())
    title = " ".join(figure.axes[0].get_title(loc="left").split())
    growth = re.search(r"growth rate (-?[\d.]+)/s", title)
    period = re.search(r"period ([\d.]+) (m?s)", title)
    assert float(growth[1]) == pytest.approx(cycle.growth_rate, rel=5e-3)
    assert period[2] == "ms"
    assert float(period[1]) == pytest.approx(1e3 * cycle.period, rel=5e-4)
    assert_shows(figure, Shown(0, "x", "Re κ", cycle.multipliers.real))
    assert_shows(figure, Shown(0, "y", "Im κ", cycle.multipliers.imag))


def test_multipliers_outside_the_unit_circle_grow_whatever_their_angle() -> None:
    values = np.array([0.9 + 0.9j, 0.9 - 0.9j, -1.2, 0.99, -0.3])
    cycle = FloquetResult(P, 1e-12, CycleStatus.OK, "made up", 0.015, values, growth_rate=16.1)
    [ax] = figure_of(cycle.plot()).axes
    shown = lines(ax)
    assert not ax.texts, "multipliers may lie anywhere in the panel"
    assert labels(ax.figure) == ["decays", "grows", "largest |κ| = 1.2728"]
    assert shown["grows"].get_xdata().tolist() == [0.9, 0.9, -1.2]
    assert shown["decays"].get_xdata().tolist() == [0.99, -0.3]


def test_eigenvalues_are_in_hertz_and_per_second() -> None:
    sliding = dm.steady_sliding(P)
    values = sliding.eigenvalues[sliding.eigenvalues.imag >= 0]
    figure = figure_of(sliding.plot())
    assert_shows(figure, Shown(0, "x", "Growth rate", values.real, "1/s"))
    assert_shows(figure, Shown(0, "y", "Frequency", values.imag / (2 * np.pi), "Hz"))


@functools.cache
def branch() -> Any:
    return dm.continue_cycle(P.replace(Omega=14.9), "Omega", (14.8, 15.0))


@pytest.mark.parametrize(
    ("y", "words", "unit"),
    [
        ("growth_rate", "Growth rate of the cycle", "1/s"),
        ("period", "Period", "s"),
        ("stick_fraction", "Share of the period spent sticking", ""),
    ],
)
def test_a_branch_has_the_variable_that_is_asked_for(y: str, words: str, unit: str) -> None:
    figure = figure_of(branch().plot(y))
    label = figure.axes[0].get_ylabel()
    assert label.startswith(words)
    assert_shows(figure, Shown(0, "x", "Speed Ω", branch().values[:, 0], "rad/s"))
    known = label.rpartition(" (")[0] or label
    assert_shows(figure, Shown(0, "y", known, getattr(branch(), y), unit))


def test_critical_values_are_over_the_parameter_and_growth_per_second() -> None:
    critical = dm.critical(P.replace(Omega=12), "k_p", (1.8e4, 2.2e4), points=5)
    figure = figure_of(critical.plot())
    assert_shows(figure, Shown(0, "x", "In-plane spring k_p", critical.values, "N/m"))
    assert_shows(figure, Shown(0, "y", "Growth rate of the cycle", critical.growth_rate, "1/s"))


def test_neutral_curves_have_both_parameters_in_their_units() -> None:
    curves = dm.neutral_curves(P, {"Omega": (14, 15.5), "k_p": (1.9e4, 2.1e4)}, [2e4], points=5)
    figure = figure_of(curves.plot())
    points = np.concatenate([curve.values for curve in curves])
    assert_shows(figure, Shown(0, "x", "Speed Ω", points[:, 0], "rad/s"))
    assert_shows(figure, Shown(0, "y", "In-plane spring k_p", points[:, 1], "N/m"))


def test_exponents_are_per_second() -> None:
    exponents = dm.lyapunov_exponents(P, 0.5, count=2)
    figure = figure_of(exponents.plot())
    assert_shows(figure, Shown(0, "y", "Lyapunov exponent", exponents.exponents, "1/s"))
    assert figure.axes[0].get_title(loc="left").startswith("over 0.5 s")


def test_modes_have_their_frequencies_in_hertz() -> None:
    modes = dm.plate_modes(P).sort_values("omega")
    titles = [ax.get_title(loc="center") for ax in dm.plot_modes(P)]
    shown = [float(re.search(r"([\d.]+) Hz", title)[1]) for title in titles]
    assert shown == pytest.approx((modes["omega"] / (2 * np.pi)).tolist(), abs=0.5)


def test_a_film_is_in_milliseconds_newtons_and_millimetres() -> None:
    late = run()["late"]
    times = np.linspace(float(late["time"][0]), float(late["time"][-1]), 4)
    states = snapshots(P, times)
    figure = pyplot.figure()
    film = film_of(figure, Motion.of(P, states), late["time"].values, late["P"].values)
    film._draw_frame(3)
    _, circle, trace = figure.axes
    assert trace.get_xlabel() == "Time (ms)"
    duration = times[-1] - times[0]
    last = drawn_values(trace, "x").max()
    assert last == pytest.approx(1e3 * duration)
    assert_shows(figure, Shown(2, "y", "Contact force P", late["P"][::50], "N"))
    assert_shows(figure, Shown(1, "y", "Deflection at r_0", [states[3].u], "m"))
    assert circle.get_title().startswith("50.0 ms")
