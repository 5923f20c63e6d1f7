"""Tables that notebooks show of results whose line of text is long."""

import math
import re
import time

import numpy as np
import pytest

from disc_model import Parameters, Ramp, Window, display, initial_state, simulate
from disc_model.display import html_table, progress_bar, rounded_text
from disc_model.errors import Status
from disc_model.mode_choice import ModeChoice
from disc_model.stability.critical_values import Critical
from disc_model.stability.lyapunov import Lyapunov

P = Parameters(N=385, Omega=15)


def cells(html: str) -> list[list[str]]:
    """The texts of a table, row by row."""
    rows = re.findall("<tr>(.*?)</tr>", html)
    return [re.findall("<t[hd]>(.*?)</t[hd]>", row) for row in rows]


def test_what_takes_long_names_its_bar_once(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A choice of modes ran for minutes without a sign of life."""
    monkeypatch.setattr(display, "PATIENCE", 0.01)
    monkeypatch.setattr(display, "_SAID", set())
    for _ in range(2):
        with progress_bar("choose_modes", None, shown=False):
            time.sleep(0.1)
    said = capsys.readouterr().err
    assert said == "choose_modes is computing; progress=True shows how far it is\n"
    monkeypatch.setattr(display, "PATIENCE", 10.0)
    with progress_bar("critical", None, shown=False):
        pass
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("shown", [True, False])
def test_a_part_of_what_takes_long_does_not_name_its_bar(
    shown: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Within a sweep with a bar, its function would have asked for one."""
    monkeypatch.setattr(display, "PATIENCE", 0.01)
    monkeypatch.setattr(display, "_SAID", set())
    with progress_bar("sweep", 1, shown=shown), progress_bar("critical", None, shown=False):
        time.sleep(0.1)
    said = capsys.readouterr().err
    assert "critical is computing" not in said
    assert ("sweep is computing" in said) is not shown


def test_a_table_escapes_what_it_shows() -> None:
    assert cells(html_table(("a", "<b>"), [(1, "&")])) == [["a", "&lt;b&gt;"], ["1", "&amp;"]]


def test_critical_shows_the_intervals_of_one_stability() -> None:
    found = Critical(
        parameters=P,
        name="Omega",
        value=12.0,
        crossings=np.array([12.0, 15.5]),
        unstable_above=np.array([True, False]),
        values=np.array([10.0, 12.0, 15.5, 20.0]),
        growth_rate=np.zeros(4),
        resolution=0.025,
    )
    assert cells(found._repr_html_()) == [
        ["Omega from", "to (rad/s)", "motion near the static start"],
        ["10", "12", "stable"],
        ["12", "15.5", "unstable"],
        ["15.5", "20", "stable"],
        ["tongues missed", "narrower than 0.025 rad/s", ""],
    ]


def test_exponents_are_shown_with_their_errors() -> None:
    found = Lyapunov(
        status=Status.OK,
        exponents=np.array([1.25, -math.inf]),
        errors=np.array([0.031, math.nan]),
        duration=20.0,
        separations=1,
        converged=np.array([True, False]),
        final_state=simulate(P, 1e-3).final_state,
    )
    assert cells(found._repr_html_()) == [
        ["exponent (1/s)", "standard error (1/s)", "converged"],
        ["1.25", "0.031", "yes"],
        ["-inf", "", "no"],
        ["ok", "over 20 s", "1 separation"],
    ]


def test_a_choice_of_modes_is_shown_with_what_it_was_compared_with() -> None:
    found = ModeChoice(
        parameters=P.replace(n_diameters=6, n_circles=1),
        tolerance=1e-2,
        error=0.004,
        modes=26,
        rich=(8, 1),
        quantity="growth",
        values={(4, 0): -0.1, (8, 1): -0.125},
    )
    assert repr(found).startswith("ModeChoice(6 diameters, 1 circle (26 real modes), by growth")
    shown = cells(found._repr_html_())
    assert shown[0] == ["ModeChoice", ""]
    assert shown[1:] == [[*row] for row in found.summary()]
    assert dict(found.summary()) == {
        "n_diameters": "6",
        "n_circles": "1",
        "modes": "26, a pair counts as two",
        "chosen by": "growth",
        "at": "15 rad/s, 385 N; other speeds may need more modes",
        "error": "0.004, relative; 0.01 was asked for",
        "largest model compared": "8 diameters, 1 circle",
        "highest mode": "waves of 33.4 thicknesses, frequency of a thin plate 0.6 % too high",
        "growth with 4 diameters, 0 circles": "-0.1",
        "growth with 8 diameters, 1 circle": "-0.125",
    }


def test_a_state_is_shown_without_its_modes() -> None:
    state = initial_state(Parameters(N=385, Omega=15), {"u": 1e-3, "u_velocity": -0.25, "f": 2.0})
    found = cells(state._repr_html_())
    assert found[:6] == [
        ["State", "value", "unit"],
        ["time", "0", "s"],
        ["phase", "slip", ""],
        ["psi", "0", "rad"],
        ["f", "2", "rad/s"],
        ["u", f"{state.u:.6g}", "m"],
    ]
    assert found[6:] == [["u_velocity", "-0.25", "m/s"], ["modes", "5", ""]]


def test_windows_and_ramps_are_shown_with_their_units() -> None:
    assert cells(Window(last=0.5, rate="10 kHz")._repr_html_()) == [
        ["Window", "value", "unit"],
        ["last", "0.5", "s"],
        ["rate", "10000.0", "Hz"],
    ]
    assert cells(Ramp(parameter="N", to="0.2 kN", start=1, end=4)._repr_html_()) == [
        ["Ramp", "value", "unit"],
        ["parameter", "N", ""],
        ["to", "200.0", "N"],
        ["start", "1.0", "s"],
        ["end", "4.0", "s"],
    ]


def test_numbers_below_a_million_are_written_out() -> None:
    """A standard deviation of 120 was "1.2e+02"."""
    assert [rounded_text(each, 2) for each in (123.4, 0.0123, -98765.0, 4.5e8)] == [
        "120",
        "0.012",
        "-99000",
        "4.5e+08",
    ]
