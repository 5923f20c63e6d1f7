"""Stick in closed form: it is not integrated as long as it cannot end.

In the modes of ``stick_modes`` the contact force stays within |P - N| <= sum gain_i |q_i|.  The growing spring force
reaches the friction limit mu_s P at the earliest where it meets mu_s (N - that sum).  Until then the state follows
without steps, in closed form.  The series then find the release.
"""

import math

from .jit import helper, inlined
from .jit.simd import WIDTH, add, fma, load, mul, splat, spread, store, sub
from .layout import PHASE, PSI, STICK, U_VELOCITY, F, U
from .stick_modes import DEGREE, LONGEST_STICK, QUANTUM

# The closed form saves time from about the length of a usual step (time units).
SHORTEST_STICK = 5.0


@helper
def _enter_modes(model, disc, states, spring, amplitudes):
    """Modal amplitudes of a disc under F = ``spring``, into ``amplitudes``.  Returns the bound on abs(P - N)."""
    modes = model.modes
    n, width, swing = len(modes.gain), len(modes.offset), 0.0
    for b in range(0, width, WIDTH):
        q = load(modes.offset, b)
        if model.coupled:
            q = fma(splat(model.r_0 * spring), load(modes.friction_offset, b), q)
            q = fma(splat(model.r_0 * model.k_p * model.Omega), load(modes.friction_offset, width + b), q)
        for j in range(states):
            q = fma(spread(disc, j), load(modes.enter, j * width + b), q)
        store(amplitudes, b, q)
    for i in range(n):
        swing += modes.gain[i] * math.sqrt(amplitudes[i] ** 2 + amplitudes[n + i] ** 2)
    return swing


@inlined
def _times(ar, ai, br, bi):
    """Product of two complex numbers in every lane."""
    return sub(mul(ar, br), mul(ai, bi)), fma(ar, bi, mul(ai, br))


@helper
def _leave_modes(model, amplitudes, x, spring, disc):
    """The disc at ``x`` (time units) after ``amplitudes``, under F = ``spring`` there.

    exp(lambda x) is taken from its series and tabled powers.
    """
    modes = model.modes
    n, length = len(modes.gain), len(disc)
    quanta = int(x / QUANTUM)
    rest = splat(x - quanta * QUANTUM)
    for b in range(0, n, WIDTH):
        re, im = mul(load(modes.decay, b), rest), mul(load(modes.turn, b), rest)
        er, ei = splat(1.0), splat(0.0)
        for k in range(DEGREE, 0, -1):
            er, ei = _times(mul(splat(1.0 / k), re), mul(splat(1.0 / k), im), er, ei)
            er = add(splat(1.0), er)
        qr, qi = _times(er, ei, load(amplitudes, b), load(amplitudes, n + b))
        at, left = b, quanta
        while left > 0:
            if left % 2 == 1:
                qr, qi = _times(qr, qi, load(modes.powers, at), load(modes.powers, at + n))
            at += 2 * n
            left //= 2
        store(amplitudes, 2 * n + b, qr)
        store(amplitudes, 3 * n + b, qi)
    for b in range(0, length, WIDTH):
        v = load(modes.rest, b)
        if model.coupled:
            v = fma(splat(model.r_0 * spring), load(modes.friction_rest, b), v)
            v = fma(splat(model.r_0 * model.k_p * model.Omega), load(modes.friction_rest, length + b), v)
        for i in range(2 * n):
            v = fma(spread(amplitudes, 2 * n + i), load(modes.leave, i * length + b), v)
        store(disc, b, v)


@inlined
def closed_form_length(model, s, state):
    """Time (time units) for which stick surely lasts, 0 if too short for ``propagate_stick`` to be worth it."""
    if len(model.modes.gain) == 0:
        return 0.0
    states = 2 * (len(model.shift) + len(model.mode_amplitude0))
    if model.compliant:
        state.disc[states], state.disc[states + 1] = state.x[U], state.x[U_VELOCITY]
        states += 2
    spring = model.k_p * state.x[PSI] + model.c_p * model.Omega
    swing = _enter_modes(model, state.disc, states, spring, s.amplitudes)
    s.psi[0] = state.x[PSI]
    friction = model.mu_s * (model.N - swing) / model.r_0
    # the spring force only grows, so that a backward release is impossible if it is impossible now
    if not abs(spring) < friction:
        return 0.0
    growth = model.k_p * model.Omega * model.unit
    if growth * LONGEST_STICK <= friction - spring:
        return LONGEST_STICK
    x = (friction - spring) / growth
    return x if x >= SHORTEST_STICK else 0.0


@inlined
def propagate_stick(model, s, x, state):
    """Fill ``state`` with stick at x (time units) after the state of the call of ``closed_form_length``."""
    psi = s.psi[0] + model.Omega * model.unit * x
    _leave_modes(model, s.amplitudes, x, model.k_p * psi + model.c_p * model.Omega, state.disc)
    if model.compliant:
        states = 2 * (len(model.shift) + len(model.mode_amplitude0))
        state.x[U], state.x[U_VELOCITY] = state.disc[states], state.disc[states + 1]
    state.x[PHASE], state.x[F] = STICK, 0.0
    state.x[PSI] = psi
