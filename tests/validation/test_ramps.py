"""`simulate` on ramps of Omega and of N, against references that know nothing of the engine."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from disc_model import Parameters, Ramp, Record, Window, plate_modes, simulate
from tests.contact_laws import COMPILES, LAWS, compare_series
from tests.references import stored, taylor
from tests.references.printed import MOTIONS, literal_events

#: s, what is promised. The literal run is as good as 1e-14 s; motion that separates makes ten times that of it.
EVENT_TIMES = 1e-12

#: Rates of Omega (rad/s^2) and of N (N/s) large enough for any wrong term to show within the spans below.
FALLING, RISING = {"Omega": -128.0, "N": -2048.0}, {"Omega": 128.0, "N": 512.0}
EVERY_LAW = ["default", *(pytest.param(name, marks=COMPILES) for name in LAWS)]


def _ramp(p, parameter, rate, end=0.0625):
    """From time 0 on; powers of two keep the rate what was said."""
    return Ramp(parameter=parameter, to=getattr(p, parameter) + rate * end, start=0.0, end=end)


def _rates(p, ramps):
    """As the ramps' numbers give them, rounding included."""
    found = {ramp.parameter: (ramp.to - getattr(p, ramp.parameter)) / ramp.end for ramp in ramps}
    return found.get("Omega", 0.0), found.get("N", 0.0)


@functools.cache
def _separating():
    """A case, and a state in contact that soon separates: the stored one, a tenth farther from equilibrium."""
    data = stored.load("C")
    p = stored.parameters_of(data)
    start, modes = stored.engine_state(data["start"], p), plate_modes(p)
    rest = -p.N * modes["psi"].to_numpy() / modes["omega"].to_numpy() ** 2
    modal = {name: 1.1 * getattr(start, name) for name in ("b", "alpha", "beta")}
    a = rest + 1.1 * (start.a - rest)
    return p, start.replace(time=0.0, a=a, u=float(modes["psi"] @ a), known=0, **modal)


# ------------------------------------------------------------------------ the paper's equations, literally
def _compare_with_literal(p, start, span, ramps):
    wanted = literal_events(p, start, span, rates=_rates(p, ramps))
    found = simulate(p, span, tol=1e-14, initial_state=start, ramps=ramps, record=Record(energy=True))
    assert list(found.events["kind"]) == [kind for _, kind in wanted]
    np.testing.assert_allclose(found.events["time"], [t for t, _ in wanted], atol=EVENT_TIMES, rtol=0)
    assert found.statistics["energy_residual"] < 1e-13
    return {kind for _, kind in wanted}


@pytest.mark.parametrize("parameter", ["Omega", "N"])
@pytest.mark.parametrize("rates", [FALLING, RISING], ids=["falling", "rising"])
def test_literal_with_separation_and_impact(parameter, rates):
    p, start = _separating()
    kinds = _compare_with_literal(p, start, 0.04, (_ramp(p, parameter, rates[parameter]),))
    assert {"separation", "reattachment", "stick_to_slip", "slip_to_stick"} <= kinds


def test_literal_with_both_and_dampers():
    p, start = _separating()
    p = p.replace(c=5.0, c_p=0.5)
    kinds = _compare_with_literal(p, start, 0.03, (_ramp(p, "Omega", -128.0), _ramp(p, "N", 2048.0)))
    assert {"separation", "reattachment", "stick_to_slip"} <= kinds


# ------------------------------------------------------------------------ every law, coefficient by coefficient
@pytest.mark.parametrize("name", EVERY_LAW)
@pytest.mark.parametrize(("phase", "direction"), MOTIONS)
@pytest.mark.parametrize("n_diameters", [2, pytest.param(5, marks=COMPILES)])
def test_series_against_the_reference(name, phase, direction, n_diameters):
    """One block of lanes and two."""
    compare_series(LAWS.get(name, {}), phase, direction, n_diameters, rates=(-9e3, 7e5))


@pytest.mark.parametrize("name", EVERY_LAW)
def test_every_law_against_long_double(name):
    """All switches of a motion that separates, ramps of both."""
    p = Parameters(N=385.0, Omega=15.1, **LAWS.get(name, {}))
    ramps = (_ramp(p, "Omega", -128.0), _ramp(p, "N", -2048.0))
    start = taylor.violent_start(1.0 if p.contact_compliance else 1.3)
    reference = taylor.Reference(taylor.problem_of(p, _rates(p, ramps)), start, audit=True).run(0.02)
    found = simulate(p, 0.02, tol=1e-15, initial_state=stored.engine_state(start, p), ramps=ramps)
    assert reference.defect < 1e-16
    assert list(found.events["kind"]) == [event["kind"] for event in reference.events]
    assert {"separation", "reattachment"} <= set(found.events["kind"])
    wanted = np.array([event["time"] for event in reference.events])
    assert np.abs(found.events["time"].to_numpy() - wanted).max() <= EVENT_TIMES


# ------------------------------------------------------------------------ begins and ends within the run
BLOCK = Parameters(N=400.0, Omega=15.0, n_diameters=-1)
"""On a rigid disc P is N(t), and stick and slip are textbook motions of one mass."""


class Belt:
    """A block on a belt, stick and slip, by DOP853 and its events; `ramps` in order of time."""

    def __init__(self, p, ramps):
        self.p, self.ramps = p, ramps

    def value(self, name, t):
        """Omega or N."""
        times, values = [0.0], [getattr(self.p, name)]
        for ramp in self.ramps:
            if ramp.parameter == name:
                times, values = [*times, ramp.start, ramp.end], [*values, values[-1], ramp.to]
        return np.interp(t, times, values)

    def pull(self, t, psi, f):
        return self.p.k_p * psi + self.p.c_p * (self.value("Omega", t) - f)

    def rates(self, sticks):
        p = self.p

        def slip(t, y):
            return [self.value("Omega", t) - y[1], (self.pull(t, *y) - p.mu_k * self.value("N", t) / p.r_0) / p.m]

        return (lambda t, y: [self.value("Omega", t), 0.0]) if sticks else slip

    def margin(self, sticks, t, y):
        """Positive while the phase lasts."""
        return self.p.mu_s * self.value("N", t) - self.p.r_0 * abs(self.pull(t, *y)) if sticks else y[1]

    def switch(self, sticks, t, y, end):
        """First switch in (t, end], else end; the state there; whether it was a switch.  Rates are constant within."""

        def end_of_phase(t, y):
            return self.margin(sticks, t, y)

        end_of_phase.terminal, end_of_phase.direction = True, -1
        how = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-15, "max_step": 2e-4}
        found = solve_ivp(self.rates(sticks), (t, end), y, events=end_of_phase, **how)
        return found.t[-1], found.y[:, -1], found.status == 1

    def events(self, t_end):
        """Times of releases and rests, s."""
        corners = sorted({t_end, *(t for ramp in self.ramps for t in (ramp.start, ramp.end) if t < t_end)})
        t, y, sticks, found = 0.0, np.zeros(2), True, []
        while t < t_end:
            end = next(corner for corner in corners if corner > t)
            t, y, switched = self.switch(sticks, t, y, end)
            if switched:
                sticks = not sticks
                y = np.array([y[0], 0.0 if sticks else y[1]])
                found.append(t)
        return np.array(found)


@pytest.mark.parametrize(
    "ramps",
    [
        (Ramp(parameter="Omega", to=5.0, start=0.013, end=0.041),),
        (Ramp(parameter="N", to=150.0, start=0.013, end=0.041),),
        (
            Ramp(parameter="Omega", to=25.0, start=0.01, end=0.03),
            Ramp(parameter="N", to=600.0, start=0.02, end=0.05),
            Ramp(parameter="Omega", to=10.0, start=0.03, end=0.045),
        ),
    ],
    ids=["Omega", "N", "both"],
)
def test_a_block_on_a_belt(ramps):
    p, t_end = BLOCK.replace(c_p=1.0), 0.07
    wanted = Belt(p, ramps).events(t_end)
    found = simulate(p, t_end, tol=1e-14, ramps=ramps)
    assert len(wanted) > 5
    assert len(found.events) == len(wanted)
    np.testing.assert_allclose(found.events["time"], wanted, atol=EVENT_TIMES, rtol=0)


def test_a_ramp_that_slows_down_turns_the_pull():
    """A damper pulls forward, a spring backward; the drive slows down, and the slider is released backward."""
    p = Parameters(N=385.0, Omega=20.0, n_diameters=-1, mu_s=0.1, mu_k=0.05, k_p=200.0, c_p=100.0)
    start = simulate(p, 1e-12).final_state
    start = start.replace(time=0.0, phase="stick", direction=0, f=0.0, psi=-8.5, known=0)
    ramp = Ramp(parameter="Omega", to=1.0, start=0.0, end=0.38)

    def pull(t):
        return p.k_p * (-8.5 + 20.0 * t - 25.0 * t**2) + p.c_p * (20.0 - 50.0 * t)

    assert pull(0.0) == pytest.approx(300.0)
    limit = p.mu_s * p.N / p.r_0
    wanted = brentq(lambda t: pull(t) + limit, 0.0, 0.38, xtol=1e-16)
    events = simulate(p, 0.38, tol=1e-14, initial_state=start, ramps=ramp).events
    assert events["kind"].iloc[0] == "stick_to_slip"
    assert events["time"].iloc[0] == pytest.approx(wanted, abs=EVENT_TIMES)
    assert simulate(p, events["time"].iloc[0] + 1e-4, initial_state=start, ramps=ramp).final_state.direction == -1
    # without the ramp the spring pulls ever harder forward
    assert simulate(p, 0.1, initial_state=start).final_state.direction == 1


# ------------------------------------------------------------------------ limits and continuity
def test_a_slow_ramp_is_near_no_ramp():
    """The kernels of ramps against those of constant parameters."""
    p, start = _separating()
    constant = simulate(p, 0.03, tol=1e-14, initial_state=start)
    ramps = (
        Ramp(parameter="Omega", to=p.Omega + 1e-9, start=0.0, end=1e3),
        Ramp(parameter="N", to=386.0, start=1.0, end=2.0),
    )
    ramped = simulate(p, 0.03, tol=1e-14, initial_state=start, ramps=ramps)
    assert list(constant.events["kind"]) == list(ramped.events["kind"])
    np.testing.assert_allclose(ramped.events["time"], constant.events["time"], rtol=0, atol=EVENT_TIMES)
    np.testing.assert_allclose(ramped.final_state.a, constant.final_state.a, rtol=1e-10)


def test_the_drive_goes_on_turning():
    """Points fixed to the disc see the slider pass where the integral of Omega says, on the ramp and after it."""
    p = Parameters(N=385.0, Omega=15.0)
    ramp = Ramp(parameter="Omega", to=5.0, start=0.02, end=0.04)
    record = Record(windows=tuple(Window(rate=1e3, theta=theta) for theta in (0.0, 0.7)))
    result = simulate(p, 0.06, ramps=ramp, record=record)
    sample, other = result.samples
    t = sample["time"]
    turned = (
        15 * t - np.where(t > 0.02, 250 * (np.clip(t, 0.02, 0.04) - 0.02) ** 2, 0) - 10 * np.clip(t - 0.04, 0, None)
    )
    phi = turned - sample["psi"]
    np.testing.assert_allclose(
        sample["psi_velocity"][sample["phase"] == 0], result.value_at("Omega", t[sample["phase"] == 0])
    )
    states = [simulate(p, time, ramps=ramp).final_state for time in (0.033, 0.059)]
    modes = plate_modes(p)
    for state in states:
        i = int(np.argmin(np.abs(t - state.time)))
        for window, theta in ((sample, 0.0), (other, 0.7)):
            turn = modes["diameters"].to_numpy() * (theta - phi[i])
            w = float(modes["psi"] @ (state.a * np.cos(turn) + state.b * np.sin(turn)))
            assert window["w_point"][i] == pytest.approx(w, abs=1e-12)


def test_energy_balance_of_every_step():
    p, start = _separating()
    p = p.replace(c=5.0, c_p=0.5)
    ramps = (_ramp(p, "Omega", -128.0), _ramp(p, "N", 512.0))
    statistics = simulate(p, 0.01, tol=1e-14, initial_state=start, ramps=ramps, record=Record(energy=True)).statistics
    assert statistics["audited_steps"] == statistics["steps"]
    assert statistics["energy_residual"] < 1e-13


@pytest.mark.compiled
def test_energy_balances_over_a_brake_stop():
    p, start = _separating()
    ramps = (Ramp(parameter="Omega", to=5.0, start=1.0, end=8.0), Ramp(parameter="N", to=150.0, start=3.0, end=9.0))
    found = simulate(p, 10.0, tol=1e-14, initial_state=start, ramps=ramps, record=Record(energy=True, events=False))
    statistics = found.statistics
    assert statistics["audited_steps"] == statistics["steps"]
    assert statistics["separations"] > 100
    assert max(statistics["energy_transverse"], statistics["energy_inplane"]) < 1e-12
