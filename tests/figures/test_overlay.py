"""Pictures of several cases on the same axes: all are seen, told apart and named."""

import functools
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.colors import to_hex

import disc_model as dm
from tests.figures.test_wishes import legend_texts
from tests.refusals import refusal

CASE = dm.Parameters(N=385, Omega=15, n_diameters=2)
WINDOWS = {
    "late": dm.Window(last=0.5, rate=1e4),
    "all": dm.Window(rate=2000, envelope=100),
    "turns": dm.Poincare(start=2),
}


@functools.cache
def run(speed: float) -> dm.Result:
    return dm.simulate(CASE.replace(Omega=speed), 8, WINDOWS)


def _exponents(speed: float) -> Any:
    return dm.lyapunov_exponents(CASE.replace(Omega=speed), 0.5, count=2)


DRAWN: dict[str, Callable[..., Any]] = {
    "run": lambda speed, **wishes: run(speed).plot("late", variables=["u"], **wishes),
    "rows": lambda speed, **wishes: run(speed).plot("late", **wishes),
    "ranges": lambda speed, **wishes: run(speed).plot("all", variables=["u"], **wishes),
    "portrait": lambda speed, **wishes: run(speed).plot_phase_portrait("late", **wishes),
    "spectrum": lambda speed, **wishes: run(speed).plot_spectrum("late", **wishes),
    "sections": lambda speed, **wishes: run(speed).plot_poincare("turns", **wishes),
    "multipliers": lambda speed, **wishes: dm.floquet(CASE.replace(Omega=speed)).plot(**wishes),
    "eigenvalues": lambda speed, **wishes: dm.steady_sliding(CASE.replace(Omega=speed)).plot(
        **wishes
    ),
    "exponents": lambda speed, **wishes: _exponents(speed).plot(**wishes),
}
SPEEDS = (15.0, 25.0)
NAMES = ["Ω = 15 rad/s", "Ω = 25 rad/s"]
OF_RUNS = [NAMES[0], f"{NAMES[1]}, still growing"]
"""Names of the runs of these cases where a picture shows them along the time, or as a portrait."""


def colours(ax: Any) -> set[str]:
    """Colours of the lines and marks that show values."""
    shown = [line for line in ax.lines if np.size(line.get_xdata()) > 2]
    return {to_hex(line.get_color()) for line in shown}


class Alone(NamedTuple):
    """Pictures of each case alone: how many panels they have, and the ends of the axes of the first."""

    panels: int
    across: list[tuple[float, float]]
    upwards: list[tuple[float, float]]


@functools.cache
def alone(name: str) -> Alone:
    pictures = [np.ravel(DRAWN[name](speed)) for speed in SPEEDS]
    across = [panels[0].get_xlim() for panels in pictures]
    upwards = [panels[0].get_ylim() for panels in pictures]
    return Alone(len(pictures[0]), across, upwards)


QUICK = ("run", "sections", "multipliers", "exponents")
"""Pictures that are also drawn quickly on figures of this package, which the others share."""


@pytest.mark.parametrize(
    ("name", "own"),
    [(name, False) for name in DRAWN]
    + [pytest.param(name, True, marks=[] if name in QUICK else pytest.mark.slow) for name in DRAWN],
)
def test_cases_have_looks_names_and_common_limits(name: str, own: bool) -> None:
    """The second was cut off, in the colours of the first, and only its phases were in the legend."""
    panels, across, ends = alone(name)
    if own:
        axes: Any = DRAWN[name](SPEEDS[0])
    else:
        axes = pyplot.figure(layout="constrained").subplots(panels, 1, squeeze=False)[:, 0]
        DRAWN[name](SPEEDS[0], ax=axes)
    first = np.ravel(axes)[0]
    DRAWN[name](SPEEDS[1], ax=axes)
    places = [text for ax in np.ravel(axes) for text in legend_texts(ax)]
    common = ["filled: not converged; ± standard error"] if name == "exponents" else []
    names = OF_RUNS if name in ("run", "rows", "ranges", "portrait") else NAMES
    assert [*dict.fromkeys(text.replace("\n", " ") for text in places)] == [*names, *common]
    slack = 0.16 * np.ptp(ends)  # an axis alone has room for names
    assert first.get_ylim()[0] <= min(low for low, _ in ends) + slack
    assert first.get_ylim()[1] >= max(high for _, high in ends) - slack
    assert first.get_xlim()[0] == pytest.approx(min(low for low, _ in across), rel=0.16, abs=1e-2)
    assert first.get_xlim()[1] == pytest.approx(max(high for _, high in across), rel=0.16)
    found = colours(first) - {"#8a8a8a"}
    assert {"#000000", "#009e73"} <= found or name == "exponents"
    assert first.get_title(loc="left") == first.get_title(loc="right") == ""
    if own:
        assert first.figure.get_suptitle().startswith("N = 385 N")
        assert "15 rad/s" not in first.figure.get_suptitle()


def test_a_reader_names_cases() -> None:
    _, ax = pyplot.subplots(layout="constrained")
    run(15.0).plot("late", variables=["u"], ax=ax, labels={"case": "slow"})
    assert legend_texts(ax) == ["slow"]
    run(25.0).plot("late", variables=["u"], ax=ax)
    run(15.0).plot("all", variables=["u"], ax=ax, labels={"case": "its range"})
    assert legend_texts(ax)[::2] == ["slow", "its range"]
    assert "25 rad/s" in legend_texts(ax)[1]
    with refusal(r"labels\.case"):
        run(25.0).plot("late", variables=["u"], ax=ax, labels={"case": 3})  # type: ignore[dict-item]


def test_runs_are_told_apart_by_their_ramps() -> None:
    windows = {"all": dm.Window(rate=2000, envelope=100)}
    ax = None
    for end in (16.0, 17.0):
        ramp = dm.Ramp(parameter="Omega", to=end, start=1, end=2)
        ax = dm.simulate(CASE, 3, windows, ramps=ramp).plot("all", variables=["u"], ax=ax)
    assert legend_texts(ax) == ["Ω = 15 to 16 rad/s", "Ω = 15 to 17 rad/s"]  # type: ignore[arg-type]
    assert ax.figure.get_suptitle().startswith("N = 385 N")  # type: ignore[attr-defined]
    assert "15 to" not in ax.figure.get_suptitle()  # type: ignore[attr-defined]


def test_curves_of_several_cases_are_told_apart() -> None:
    """Both were black, and those of the second case covered names of the first."""
    bounds = {"Omega": (14.0, 15.5), "k_p": (1.9e4, 2.1e4)}
    ax = None
    for load in (385.0, 380.0):
        curves = dm.neutral_curves(dm.Parameters(N=load, Omega=15), bounds, [2e4], points=5)
        ax = curves.plot(ax=ax)
    texts = legend_texts(ax)  # type: ignore[arg-type]
    assert texts[:2] == ["N = 385 N", "N = 380 N"]
    assert "solid: cycle loses stability" in texts, "grey ones were those of a case in grey print"
    assert {"#000000", "#009e73"} <= {to_hex(line.get_color()) for line in ax.lines}  # type: ignore[attr-defined]


def test_cases_of_one_name_are_told_apart() -> None:
    """Both had one entry in the legend, in the look of the first."""
    slow, fast = SPEEDS
    name = {"case": "A"}
    _, ax = pyplot.subplots(layout="constrained")
    for speed in (slow, fast, slow):
        DRAWN["run"](speed, ax=ax, labels=name)
    assert legend_texts(ax) == [
        f"A, {NAMES[0]}, case 1",
        f"A, {NAMES[1]}, case 2, still growing",
        f"A, {NAMES[0]}, case 3",
    ]
