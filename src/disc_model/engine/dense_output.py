"""State and contact force anywhere in a step: from the series or, in stick, in closed form; uniform
samples of both.

Stick is not integrated as long as it cannot end.  In the modes of ``stick_modes`` |P - N| <= sum
gain_i |q_i|: the growing spring force reaches the friction limit mu_s P at the earliest where it
meets mu_s (N - that sum).

A sample at an event shows the side before it. Its time is rounded, and differently on another way
to the same event: a sample is "at" an event up to `SAME_INSTANT` of the clock after it.
"""

import math

from . import layout
from .jit import helper, inlined
from .jit.simd import WIDTH, add, fma, load, mul, splat, spread, store, sub
from .layout import PHASE, PSI, ROWS, STICK, U_VELOCITY, F, U
from .polynomial import dot, set_powers
from .series import DRIVE_SERIES, LOAD_SERIES, E, lane_count
from .stick_modes import DEGREE, LONGEST_STICK, QUANTUM
from .transitions import disc_point, force_in_stick, stick_force

CLOSED_FORM = 0  # in place of a series' order where stick has a closed form instead
SHORTEST_STICK = 5.0  # time units: the closed form saves time from about the length of a usual step
# Columns of a row of samples.
ROW = (
    "sampler",
    "time",
    "P",
    "u",
    "u_velocity",
    "w",
    "w_point",
    "w_point_velocity",
    "psi",
    "psi_velocity",
    "phase",
)
# A release found by the series is rounded at each step, and deviates by up to 80 units of rounding
# within 400 steps.
SAME_INSTANT = 256 * 2.0**-52


@inlined
def _times(ar, ai, br, bi):
    """Product of two complex numbers in every lane."""
    return sub(mul(ar, br), mul(ai, bi)), fma(ar, bi, mul(ai, br))


@helper
def propagate_stick(model, s, x, state):
    """Fill ``state`` with stick at x (time units) after the state of the call of
    ``closed_form_length``."""
    modes, amplitudes, disc, psi = (
        model.modes,
        s.amplitudes,
        state.disc,
        s.psi[0] + model.Omega * model.unit * x,
    )
    n, length, spring = len(modes.gain), len(disc), model.k_p * psi + model.c_p * model.Omega
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
            v = fma(
                splat(model.r_0 * model.k_p * model.Omega), load(modes.friction_rest, length + b), v
            )
        for i in range(2 * n):
            v = fma(spread(amplitudes, 2 * n + i), load(modes.leave, i * length + b), v)
        store(disc, b, v)
    if model.compliant:
        states = 2 * (len(model.shift) + len(model.mode_amplitude0))
        state.x[U], state.x[U_VELOCITY] = disc[states], disc[states + 1]
    state.x[PHASE], state.x[F], state.x[PSI] = STICK, 0.0, psi


@helper
def closed_form_length(model, s, state):
    """Time (time units) for which stick surely lasts, 0 if too short for ``propagate_stick`` to be
    worth it."""
    modes = model.modes
    n, width, swing = len(modes.gain), len(modes.offset), 0.0
    if n == 0:
        return 0.0
    states = 2 * (len(model.shift) + len(model.mode_amplitude0))
    if model.compliant:
        state.disc[states], state.disc[states + 1] = state.x[U], state.x[U_VELOCITY]
        states += 2
    spring = model.k_p * state.x[PSI] + model.c_p * model.Omega
    for b in range(0, width, WIDTH):
        q = load(modes.offset, b)
        if model.coupled:
            q = fma(splat(model.r_0 * spring), load(modes.friction_offset, b), q)
            q = fma(
                splat(model.r_0 * model.k_p * model.Omega),
                load(modes.friction_offset, width + b),
                q,
            )
        for j in range(states):
            q = fma(spread(state.disc, j), load(modes.enter, j * width + b), q)
        store(s.amplitudes, b, q)
    for i in range(n):
        swing += modes.gain[i] * math.sqrt(s.amplitudes[i] ** 2 + s.amplitudes[n + i] ** 2)
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
def _pairs_at(model, s, order, x, state):
    """Displacements and velocities of the pairs at x; even and odd powers do not wait for each
    other."""
    width, at, square = lane_count(model), splat(x), splat(x * x)
    for b in range(0, width, WIDTH):
        i = order * width + b
        z, e = load(s.modes, i), load(s.modes, E * width + i)
        z_odd, e_odd = load(s.modes, i - width), load(s.modes, E * width + i - width)
        for _ in range(order // 2 - 1):
            i -= 2 * width
            z, e = fma(z, square, load(s.modes, i)), fma(e, square, load(s.modes, E * width + i))
            z_odd = fma(z_odd, square, load(s.modes, i - width))
            e_odd = fma(e_odd, square, load(s.modes, E * width + i - width))
        store(state.z, b, fma(z_odd, at, fma(z, square, load(s.modes, b))))
        store(state.e, b, fma(e_odd, at, fma(e, square, load(s.modes, E * width + b))))


@inlined
def state_at(model, s, order, x, phase, state):
    """Fill ``state`` with the series' value, of even order, at x; u, u' only where they are not the
    disc's."""
    set_powers(s.powers, x, order)
    psi, f = dot(s.psi, 0, s.powers, order), dot(s.f, 0, s.powers, order)
    _pairs_at(model, s, order, x, state)
    for j in range(len(model.mode_amplitude0)):
        state.y[j], state.g[j] = (
            dot(s.y, j * ROWS, s.powers, order),
            dot(s.g, j * ROWS, s.powers, order),
        )
    if model.compliant or phase == layout.SEPARATION:
        state.x[U], state.x[U_VELOCITY] = dot(s.u, 0, s.powers, order), dot(s.v, 0, s.powers, order)
    state.x[PHASE], state.x[PSI], state.x[F] = phase, psi, 0.0 if phase == STICK else f
    if model.ramped:
        state.x[layout.DRIVE] = s.slider[DRIVE_SERIES] + x * s.slider[DRIVE_SERIES + 1]
        state.x[layout.LOAD] = s.slider[LOAD_SERIES] + x * s.slider[LOAD_SERIES + 1]


@inlined
def move_to(model, s, order, x, phase, state):
    """Fill ``state`` with the dense output at x: the series of this order, or the closed form of
    stick."""
    if order == CLOSED_FORM:
        propagate_stick(model, s, x, state)
    else:
        state_at(model, s, order, x, phase, state)


@inlined
def force_at(model, s, order, phase, state):
    """Contact force where ``move_to`` has put ``state``, which leaves the powers of that place in
    ``s.powers``."""
    if order == CLOSED_FORM:
        return stick_force(model, state)
    if phase == layout.SEPARATION:
        return 0.0
    P = dot(s.P, 0, s.powers, order)
    return force_in_stick(model, state, P) if model.normal and phase == layout.STICK else P


@inlined
def load_state(model, s, state):
    """The series' coefficients 0 from ``state``."""
    for b in range(0, len(state.z), WIDTH):
        store(s.z, b, load(state.z, b))
        store(s.e, b, load(state.e, b))
    for j in range(len(state.y)):
        s.y[j * ROWS], s.g[j * ROWS] = state.y[j], state.g[j]
    s.psi[0], s.f[0], s.u[0], s.v[0] = state.x[PSI], state.x[F], state.x[U], state.x[U_VELOCITY]
    if model.ramped:
        s.slider[DRIVE_SERIES], s.slider[DRIVE_SERIES + 1] = (
            state.x[layout.DRIVE],
            model.Omega_rate * model.unit,
        )
        s.slider[LOAD_SERIES], s.slider[LOAD_SERIES + 1] = (
            state.x[layout.LOAD],
            model.N_rate * model.unit,
        )


@helper
def point_motion(model, state, angle):
    """Displacement and velocity of the disc's point (r_0, slider's angle + ``angle``)."""
    w, velocity = 0.0, 0.0
    for j in range(len(model.shift)):
        if j % layout.WIDTH < layout.HALF:
            turn = model.shift[j] * angle
            cosine, sine = math.cos(turn), math.sin(turn)
            w += model.mode_amplitude[j] * (state.z[j] * cosine + state.z[j + layout.HALF] * sine)
            velocity += model.mode_amplitude[j] * (
                state.e[j] * cosine + state.e[j + layout.HALF] * sine
            )
    for j in range(len(model.mode_amplitude0)):
        w += model.mode_amplitude0[j] * state.y[j]
        velocity += model.mode_amplitude0[j] * state.g[j]
    return w, velocity


@helper
def sample_step(model, s, order, state, x_end, samplers, progress, probe, rows, filled):
    """Append to ``rows`` one for every sample time within the step that starts at ``state`` and
    lasts ``x_end`` units, its end included, to rounding.  Returns the number of rows filled.
    ``samplers``: shape (n, 5), columns first time, interval, number of samples, theta, end of run;
    ``progress``: shape (n,), samples taken so far."""
    start, low, phase = state.x[layout.TIME], state.x[layout.TIME_LOW], state.x[PHASE]
    last = x_end + SAME_INSTANT * (start / model.unit + x_end + 1.0)
    for i in range(len(samplers)):
        while progress[i] < samplers[i, 2]:
            # the last sample may lie a rounding error behind the end of the run
            time = min(samplers[i, 0] + progress[i] * samplers[i, 1], samplers[i, 4])
            x = ((time - start) - low) / model.unit
            if x > last:
                break
            move_to(model, s, order, max(x, 0.0), phase, probe)
            row, (w, velocity, _) = rows[filled], disc_point(model, probe)
            angle = samplers[i, 3] - (layout.drive_angle(model, time) - probe.x[PSI])
            row[0], row[1], row[2] = i, time, force_at(model, s, order, phase, probe)
            row[3], row[4], row[5] = w, velocity, w
            if model.compliant or phase == layout.SEPARATION:
                row[3], row[4] = probe.x[U], probe.x[U_VELOCITY]
            row[6], row[7] = point_motion(model, probe, angle)
            row[8], row[9], row[10] = (
                probe.x[PSI],
                layout.drive_now(model, probe) - probe.x[F],
                phase,
            )
            filled += 1
            progress[i] += 1
    return filled
