"""Stick in closed form, as long as it cannot end.

In the modes of `stick_modes` |P - N| <= sum gain_i |q_i|: the growing spring force reaches the
friction limit mu_s P at the earliest where it meets mu_s (N - that sum). A surface that moves with
the slider makes the load of friction swing, too, by at most sum hold_gain_i |q_i|.
"""

import math

from .jit import helper, inlined
from .jit.simd import WIDTH, load, splat, spread, store, total
from .state import PHASE, PHI_RATE, PSI, STICK, SURFACE_TURN, U_VELOCITY, U, slider_place
from .stick_modes import DEGREE, LONGEST_STICK, QUANTUM

SHORTEST_STICK = 5.0  # time units: the closed form saves time from about the length of a usual step


@inlined
def _times(a, b):
    """Product of two complex numbers in every lane, each a pair of real and imaginary parts."""
    a_real, a_imaginary = a
    b_real, b_imaginary = b
    real = a_real * b_real - a_imaginary * b_imaginary
    imaginary = a_imaginary * b_real + a_real * b_imaginary
    return real, imaginary


@helper
def closed_form_length(model, series, state):
    """Time (time units) for which stick surely lasts; 0 if it is too short for `propagate_stick` to
    be worth it. The amplitudes of the modes at ``state`` enter ``series``."""
    modes = model.modes
    amplitudes = series.amplitudes
    n = len(modes.gain)
    width = len(modes.offset)
    if n == 0:
        return 0.0
    entries = slider_place(model, 0)
    disc = state.disc
    if model.has_compliance:
        disc[entries] = state.x[U]
        disc[entries + 1] = state.x[U_VELOCITY]
        entries += 2

    # the drive's pull as if the surface rested, over r_0
    series.psi[0] = state.x[PSI]
    if model.has_moving_surface:
        carried = _surface_angle(model, disc)
        series.psi[0] += carried
        series.turn[0] = state.x[SURFACE_TURN] - carried
    F_now = model.k_p * series.psi[0] + model.c_p * model.Omega
    F_rate = model.k_p * model.Omega

    # amplitudes of the modes
    for b in range(0, width, WIDTH):
        q = load(modes.offset, b)
        if model.has_moving_surface:
            q = q + (model.r_0 * F_now) * load(modes.pull_offset, b)
            q = q + (model.r_0 * F_rate) * load(modes.pull_offset, width + b)
        for j in range(entries):
            q = q + spread(disc, j) * load(modes.enter, j * width + b)
        store(amplitudes, b, q)

    # the pull only grows, so that a backward release is impossible if it is impossible now
    limit = model.mu_s * (model.N - _largest(modes.gain, amplitudes)) / model.r_0
    if model.has_moving_surface:
        limit -= _largest(modes.hold_gain, amplitudes) / model.r_0
        F_now = modes.hold[0] * F_now + modes.hold[1] * F_rate
        F_rate = modes.hold[0] * F_rate
    if not abs(F_now) < limit:
        return 0.0
    growth = F_rate * model.unit
    if growth * LONGEST_STICK <= limit - F_now:
        return LONGEST_STICK
    x = (limit - F_now) / growth
    return x if x >= SHORTEST_STICK else 0.0


@inlined
def _largest(gain, amplitudes):
    """Return a bound on a force that the modes change by ``gain`` times the moduli of amplitudes."""
    n = len(gain)
    swing = 0.0
    for i in range(n):
        swing += gain[i] * math.sqrt(amplitudes[i] ** 2 + amplitudes[n + i] ** 2)
    return swing


@inlined
def _surface_angle(model, disc):
    """Angle by which the disc's surface has turned under the slider since it was at rest, rad, if it
    has not slipped."""
    lanes = splat(0.0)
    for b in range(0, len(model.shift), WIDTH):
        lanes = lanes + load(model.tangential, b) * load(disc, b)
    return total(lanes) / model.r_0


@helper
def propagate_stick(model, series, x, state):
    """Fill ``state`` with stick at x (time units) after the state of the call of
    `closed_form_length`."""
    modes = model.modes
    amplitudes = series.amplitudes
    disc = state.disc
    psi = series.psi[0] + model.Omega * model.unit * x
    _advance_amplitudes(modes, amplitudes, x)

    # the state is the static equilibrium, the response to the pull and the modes
    n = len(modes.gain)
    length = len(disc)
    F_now = model.k_p * psi + model.c_p * model.Omega
    F_rate = model.k_p * model.Omega
    for b in range(0, length, WIDTH):
        v = load(modes.rest, b)
        if model.has_moving_surface:
            v = v + (model.r_0 * F_now) * load(modes.pull_rest, b)
            v = v + (model.r_0 * F_rate) * load(modes.pull_rest, length + b)
        # in two sums: neither waits for its last term
        others = splat(0.0)
        for i in range(0, 2 * n, 2):
            at = i * length + b
            v = v + spread(amplitudes, 2 * n + i) * load(modes.leave, at)
            others = others + spread(amplitudes, 2 * n + i + 1) * load(modes.leave, at + length)
        store(disc, b, v + others)
    if model.has_compliance:
        entries = slider_place(model, 0)
        state.x[U] = disc[entries]
        state.x[U_VELOCITY] = disc[entries + 1]
    state.x[PHASE] = STICK
    state.x[PHI_RATE] = 0.0
    if model.has_moving_surface:
        carried = _surface_angle(model, disc)
        psi -= carried
        state.x[SURFACE_TURN] = series.turn[0] + carried
    state.x[PSI] = psi


@inlined
def _advance_amplitudes(modes, amplitudes, x):
    """Multiply the amplitudes by exp(lambda x), into the second half of their array."""
    n = len(modes.gain)
    quanta = int(x / QUANTUM)
    rest = x - quanta * QUANTUM
    for b in range(0, n, WIDTH):
        # the series of exp for what is left beyond whole quanta
        decay = load(modes.decay, b) * rest
        turn = load(modes.turn, b) * rest
        factor = splat(1.0), splat(0.0)
        for k in range(DEGREE, 0, -1):
            share = 1.0 / k
            real, imaginary = _times((share * decay, share * turn), factor)
            factor = 1.0 + real, imaginary
        q = _times(factor, (load(amplitudes, b), load(amplitudes, n + b)))

        # tabled powers for the quanta, by the binary digits of their number
        at = b
        left = quanta
        while left > 0:
            if left % 2 == 1:
                q = _times(q, (load(modes.powers, at), load(modes.powers, at + n)))
            at += 2 * n
            left //= 2
        store(amplitudes, 2 * n + b, q[0])
        store(amplitudes, 3 * n + b, q[1])
