"""The same equations as `physics`, compiled, and the fixed-step Runge-Kutta loop on them.

One file on purpose: numba's cache notices a change in the file of the function that is called, and in no other.
State vector as in `physics`; ``c`` holds the scalars in the order of `CONSTANTS`.
"""

# mypy: disable-error-code="no-untyped-def"
from __future__ import annotations

import math

import numba
import numpy as np

from disc_model.benchmarks.methods.physics import Physics

CONSTANTS = ("N", "Omega", "k", "c", "m", "k_p", "c_p", "mu_s", "mu_k", "r_0", "u_0", "compliance", "bonded")
_N, _OMEGA, _K, _C, _M, _KP, _CP, _MUS, _MUK, _R0, _U0, _S2, _BONDED = range(len(CONSTANTS))

STICK, SLIP, SEPARATION = 0, 1, 2
STICK_TO_SLIP, SLIP_TO_STICK, SLIP_REVERSAL, LOSS_OF_CONTACT, REATTACHMENT = range(5)
FINISHED, NON_FINITE, STALLED, STEP_LIMIT = range(4)
HUGE = 10.0
"""m sqrt(kg); a modal displacement beyond this, thousands of static deflections, is counted as overflow."""
BISECTIONS = 60

_kernel = numba.njit(cache=True, error_model="numpy")  # division by zero gives inf, as in numpy


def tables(physics: Physics) -> tuple[np.ndarray, np.ndarray]:
    """(modes, c): rows l, psi_l, omega^2, 2 xi omega of shape (4, n), and the scalars."""
    p = physics.p
    own = {"u_0": physics.u_0, "compliance": physics.compliance, "bonded": float(p.contact == "bonded")}
    modes = np.array([physics.l, physics.shape, physics.stiffness, physics.damping])
    return modes, np.array([own[name] if name in own else getattr(p, name) for name in CONSTANTS])


@_kernel
def contact(modes, c, direction, y):
    """P, F, w, w' under the slider; ``direction`` 0 is stick."""
    n = modes.shape[1]
    f = y[4 * n + 1]
    w, velocity, slope, A = 0.0, 0.0, 0.0, 0.0
    for i in range(n):
        l, psi = modes[0, i], modes[1, i]
        a, alpha = y[i], y[2 * n + i]
        w += psi * a
        velocity += psi * alpha
        slope += l * psi * y[n + i]
        A += psi * (-modes[3, i] * alpha - (modes[2, i] + (l * f) ** 2) * a + 2.0 * l * f * y[3 * n + i])
    velocity += f * slope
    F = c[_KP] * y[4 * n] + c[_CP] * (c[_OMEGA] - f)
    top = c[_N] + c[_K] * (w - c[_U0]) + c[_C] * velocity + c[_M] * A
    below = 1.0 + c[_M] * c[_S2]
    if direction == 0:
        return top / below, F, w, velocity
    return (top + slope * F) / (below + direction * c[_MUK] * slope / c[_R0]), F, w, velocity


@_kernel
def rate(modes, c, phase, direction, y, dy):
    """Fill ``dy`` with dy/dt."""
    n = modes.shape[1]
    f, P = y[4 * n + 1], 0.0
    dy[4 * n] = c[_OMEGA] - f
    if phase == SEPARATION:
        u, v = y[4 * n + 2], y[4 * n + 3]
        dy[4 * n + 1] = (c[_KP] * y[4 * n] + c[_CP] * (c[_OMEGA] - f)) / c[_M]
        dy[4 * n + 2] = v
        dy[4 * n + 3] = -(c[_N] + c[_K] * (u - c[_U0]) + c[_C] * v) / c[_M]
    else:
        P, F, _, _ = contact(modes, c, direction, y)
        dy[4 * n + 1] = F / c[_M] - direction * c[_MUK] * P / (c[_M] * c[_R0]) if phase == SLIP else 0.0
        dy[4 * n + 2] = 0.0
        dy[4 * n + 3] = 0.0
    for i in range(n):
        turn = modes[0, i] * f
        a, b, alpha, beta = y[i], y[n + i], y[2 * n + i], y[3 * n + i]
        dy[i] = alpha + turn * b
        dy[n + i] = beta - turn * a
        dy[2 * n + i] = -modes[3, i] * alpha - modes[2, i] * a + turn * beta - modes[1, i] * P
        dy[3 * n + i] = -modes[3, i] * beta - modes[2, i] * b - turn * alpha


STRIBECK = 30.0
"""f/eps at which static friction has fallen to kinetic."""


@_kernel
def smooth_friction(c, law, f):
    """Coefficient of friction with the sign of f; ``law`` is `regularised.Law.constants`."""
    x = f / law[0]
    return math.tanh(x) * (c[_MUK] + law[1] * math.exp(-min((x / STRIBECK) ** 2, 700.0)))


@_kernel
def smooth_force(modes, c, law, y):
    """Signed penalty force; contact where it is positive."""
    n = modes.shape[1]
    _, _, w, velocity = contact(modes, c, 0, y)
    return law[2] * (w - y[4 * n + 2]) + law[3] * (velocity - y[4 * n + 3])


@_kernel
def smooth_rate(modes, c, law, y, dy):
    """Fill ``dy`` with dy/dt of the regularised model: separation's equations plus whatever force there is."""
    n = modes.shape[1]
    rate(modes, c, SEPARATION, 0, y, dy)
    P = smooth_force(modes, c, law, y)
    if P > 0.0:
        for i in range(n):
            dy[2 * n + i] -= modes[1, i] * P
        dy[4 * n + 3] += P / c[_M]
        dy[4 * n + 1] -= smooth_friction(c, law, y[4 * n + 1]) * P / (c[_M] * c[_R0])


@_kernel
def rk4_step(modes, c, phase, direction, y, h, out, k, z):
    """One step of the classical fourth-order method from ``y`` to ``out``; ``k`` (4, size), ``z`` (size,) are work."""
    size = len(y)
    rate(modes, c, phase, direction, y, k[0])
    for stage in range(1, 4):
        part = h if stage == 3 else 0.5 * h
        for j in range(size):
            z[j] = y[j] + part * k[stage - 1, j]
        rate(modes, c, phase, direction, z, k[stage])
    for j in range(size):
        out[j] = y[j] + h / 6.0 * (k[0, j] + 2.0 * k[1, j] + 2.0 * k[2, j] + k[3, j])


@_kernel
def switch_values(modes, c, phase, direction, y, out):
    """Fill ``out`` with what falls through zero at the phase's end, see `phases.ENDS`; returns how many there are."""
    n = modes.shape[1]
    P, F, w, _ = contact(modes, c, direction, y)
    if phase == SEPARATION:
        out[0] = y[4 * n + 2] - w
        return 1
    out[0] = P if c[_BONDED] == 0.0 else 1.0
    if phase == SLIP:
        out[1] = direction * y[4 * n + 1]
        return 2
    out[1] = c[_MUS] * P - c[_R0] * F
    out[2] = c[_MUS] * P + c[_R0] * F
    return 3


@_kernel
def violated(modes, c, phase, direction, y, values):
    """Place of the first of the `switch_values` that is negative at ``y``, or -1; ``values`` (3,) is work."""
    for place in range(switch_values(modes, c, phase, direction, y, values)):
        if values[place] < 0.0:
            return place
    return -1


@_kernel
def _leave(modes, c, y):
    n = modes.shape[1]
    _, _, y[4 * n + 2], y[4 * n + 3] = contact(modes, c, 0, y)


@_kernel
def switch(modes, c, phase, cause, y, kinds):
    """Carry out a switch in place, ``cause`` being the place of its function in `switch_values`.

    Returns (phase, direction, number of events written to ``kinds``).
    """
    n = modes.shape[1]
    if phase == SEPARATION:
        _, _, _, velocity = contact(modes, c, 0, y)
        impulse = (velocity - y[4 * n + 3]) / (c[_S2] + 1.0 / c[_M])
        for i in range(n):
            y[2 * n + i] -= modes[1, i] * impulse
        kinds[0] = REATTACHMENT
        direction = 1 if y[4 * n + 1] > 0.0 else -1
    elif cause == 0:
        _leave(modes, c, y)
        kinds[0] = LOSS_OF_CONTACT
        return SEPARATION, 0, 1
    elif phase == STICK:
        kinds[0] = STICK_TO_SLIP
        _, F, _, _ = contact(modes, c, 0, y)
        direction = 1 if F > 0.0 else -1
    else:
        y[4 * n + 1] = 0.0
        P, F, _, _ = contact(modes, c, 0, y)
        if c[_R0] * abs(F) < c[_MUS] * P:
            kinds[0] = SLIP_TO_STICK
            return STICK, 0, 1
        direction = 1 if F > 0.0 else -1
        kinds[0] = SLIP_REVERSAL
    P, _, _, _ = contact(modes, c, direction, y)
    if P < 0.0 and c[_BONDED] == 0.0:
        _leave(modes, c, y)
        # a slider that neither sticks nor slips back has not turned round
        count = 0 if kinds[0] == SLIP_REVERSAL else 1
        kinds[count] = LOSS_OF_CONTACT
        return SEPARATION, 0, count + 1
    return SLIP, direction, 1


@_kernel
def rk4_run(modes, c, phase, direction, y, t_end, h, max_steps, stop, times, kinds, heights):
    """Fixed steps ``h`` from local time 0; conditions checked at step ends, the offending step bisected.

    ``stop``: whether to end at the first separation.  Returns (why, time, phase, direction, events, steps); ``y`` is
    overwritten, ``times`` and ``kinds`` are filled, and ``heights`` with the least and greatest w at step ends.
    """
    size, n = len(y), modes.shape[1]
    k, z, values = np.empty((4, size)), np.empty(size), np.empty(3)
    new, found = np.empty(2, np.int64), np.empty(size)
    origin, count, local, events, steps = 0.0, 0, 0.0, 0, 0
    while local < t_end:
        if steps >= max_steps:
            return STEP_LIMIT, local, phase, direction, events, steps
        # time is event time plus a whole number of steps: adding up h would lose the event times' digits
        following = origin + (count + 1) * h
        length = following - local
        if following >= t_end:
            following, length = t_end, t_end - local
        rk4_step(modes, c, phase, direction, y, length, found, k, z)
        steps += 1
        for j in range(2 * n):
            if not abs(found[j]) < HUGE:
                return NON_FINITE, local, phase, direction, events, steps
        cause = violated(modes, c, phase, direction, found, values)
        w = 0.0
        for j in range(n):
            w += modes[1, j] * found[j]
        heights[0], heights[1] = min(heights[0], w), max(heights[1], w)
        if cause < 0:
            y[:] = found
            local = following
            count += 1
            continue
        low, high = 0.0, length
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + high)
            if middle in (low, high):
                break
            rk4_step(modes, c, phase, direction, y, middle, found, k, z)
            steps += 1
            here = violated(modes, c, phase, direction, found, values)
            if here < 0:
                low = middle
            else:
                high, cause = middle, here
        rk4_step(modes, c, phase, direction, y, high, found, k, z)
        y[:] = found
        local += high
        origin, count = local, 0
        phase, direction, added = switch(modes, c, phase, cause, y, new)
        if events + added > len(times):
            return STALLED, local, phase, direction, events, steps
        for j in range(added):
            times[events + j], kinds[events + j] = local, new[j]
        events += added
        if stop and phase == SEPARATION:
            break
    return FINISHED, local, phase, direction, events, steps
