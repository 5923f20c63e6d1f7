"""The laws of contact beside the paper's, as tests name them; and what of them is left to the long tests."""

import math
from typing import Any

import numba
import numpy as np
import pytest

from disc_model import Ramp, plate_modes
from disc_model.engine import event_loop, laws, layout, transitions
from disc_model.flexibility import contact_compliance
from disc_model.simulation.result import engine_case, write_state
from tests.references import stored, taylor
from tests.references.printed import P, lively

LAWS: dict[str, dict[str, Any]] = {
    "compliant": {"contact_compliance": taylor.COMPLIANCE},
    "normal": {"contact_force": "normal"},
    "compliant_normal": {"contact_compliance": taylor.COMPLIANCE, "contact_force": "normal"},
}

COMPILES = () if numba.config.DISABLE_JIT else (pytest.mark.slow,)
"""Marks of what has kernels of its own, which compile for a minute; without compilation it is quick."""

# Kernels of each law take minutes to compile: the quick tests try the law that has both, the long ones all.
EACH_LAW = [pytest.param(name, marks=() if name == "compliant_normal" else pytest.mark.slow, id=name) for name in LAWS]


def classical_events(p, count):
    """Releases and rests of a block on a belt under the constant load N, in closed form."""
    rate = math.sqrt(p.k_p / p.m)
    static, kinetic = (mu * p.N / (p.k_p * p.r_0) for mu in (p.mu_s, p.mu_k))
    slip = 2 * (math.pi - math.atan(rate * (static - kinetic) / p.Omega)) / rate
    stick = 2 * (static - kinetic) / p.Omega
    first = static / p.Omega
    return np.array([first + i // 2 * (slip + stick) + (slip if i % 2 else 0) for i in range(count)])


def by_series(p):
    """A ramp of one unit in the last place of N: on ramps stick is followed by its series, and not in closed form."""
    return Ramp(parameter="N", to=math.nextafter(p.N, math.inf), start=0.0, end=1e3)


def course_of(p, ramps):
    """Corners of Omega and N on ramps, (time, Omega, N), from 0 on."""
    lines = {name: ([0.0], [getattr(p, name)]) for name in ("Omega", "N")}
    for ramp in ramps:
        times, values = lines[ramp.parameter]
        lines[ramp.parameter] = [*times, ramp.start, ramp.end], [*values, values[-1], ramp.to]
    corners = sorted({time for times, _ in lines.values() for time in times})
    return [(t, *(float(np.interp(t, *line)) for line in lines.values())) for t in corners]


def turned(course, t):
    """Angle, rad, by which the drive has turned since the time 0."""
    times, speeds, _ = zip(*course, strict=True)
    corners = [*(time for time in times if time < t), t]
    return np.trapezoid(np.interp(corners, times, speeds), corners)


def compare_series(law, phase, direction, n_diameters, rates=None):
    """The engine's coefficients beside the reference's, in units of the largest: all dampers work.

    rates : those of Omega (rad/s^2) and N (N/s), some way up the ramps
    """
    p = P.replace(n_diameters=n_diameters, **law)
    start, order = lively(phase, direction, p).replace(time=1e-3 if rates else 0.0), 16
    if p.contact_compliance:
        start = start.replace(u=start.u - 500 * contact_compliance(p), u_velocity=start.u_velocity + 0.01)
    step = taylor.Step(taylor.problem_of(p, rates or (0.0, 0.0)), phase, direction, stored.reference_state(start, p))
    model = engine_case(p).model
    if rates:
        model = layout.on_ramp(model, 0.0, 0.0, Omega=p.Omega, Omega_rate=rates[0], N=p.N, N_rate=rates[1])
    s, state = layout.build_series(model, order), layout.build_state(model)
    write_state(engine_case(p), start, state)
    if rates:
        event_loop.set_course(model, state)
    event_loop.expand(model, s, state, order)
    powers = np.array([float(model.unit) ** k for k in range(order + 1)])

    def compare(own, wanted, rtol=1e-10, degree=order):
        wanted = np.array(wanted[:degree], float) * powers[:degree]
        np.testing.assert_allclose(own[:degree], wanted, atol=1e-12 * np.abs(wanted).max(), rtol=rtol)

    case, sign, width, n0 = (
        engine_case(p),
        np.sign(plate_modes(p)["psi"].to_numpy()),
        len(model.mode_amplitude),
        len(model.mode_amplitude0),
    )
    pairs = [x.reshape(-1, width)[: order + 1] for x in (s.z, s.e)]
    single = [x.reshape(n0, layout.ROWS).T[: order + 1] for x in (s.y, s.g)]
    own = np.concatenate(pairs + single, axis=1)[:, case.places]
    for i, name in enumerate(("a", "b", "alpha", "beta")):
        here = case.present // len(sign) == i
        wanted = np.array(sign * getattr(step, name)[: order + 1], float)[:, case.present[here] % len(sign)]
        wanted *= powers[:, None]
        sizes = np.abs(wanted).max(axis=1, keepdims=True)
        assert np.all(np.abs(own[:, here] - wanted) <= 1e-10 * sizes), name
    compare(s.f, step.f, degree=order + 1)
    compare(s.psi, step.psi, degree=order + 1)
    if phase != "separation":
        compare(s.P, step.V if phase == "stick" else step.R)
    if phase != "stick":
        compare(s.switch, direction * step.f if direction else step.u - step.a @ step.q.s, 1e-9, order + 1)
    if p.contact_compliance or phase == "separation":
        compare(s.u, step.u, degree=order + 1)
        compare(s.v, step.v, degree=order + 1)
    if phase == "stick":
        press, pull = step.V[:order], p.r_0 * step.F[:order]
        if p.contact_force == "normal":  # over the denominator that both have
            press = press + np.convolve(step.F, step.B)[:order]
            pull = pull - np.convolve(step.V, step.B)[:order] / p.r_0
        compare(s.switch, p.mu_s * press - pull, 1e-9)
        compare(s.switch2, p.mu_s * press + pull, 1e-9)
        held = np.array([pull[0], press[0]], float)
        i, _ = transitions.instant(model, state)
        np.testing.assert_allclose(laws.stick_loads(model, i, laws.vertical_in_stick(model, i)), held, rtol=1e-10)
        force = transitions.force_in_stick(model, state, transitions.stick_force(model, state))
        assert force == pytest.approx(float(step.R[0]), rel=1e-10)
