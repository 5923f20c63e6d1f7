"""Constants of a case, states as vectors and the compiled equations of motion; no code is shared
with the engine.

The state is y = (a, b, alpha, beta, psi, f, u, u'), shape (4 n + 4,), n = number of modes (docs:
model, Disc in the slider's frame); u and u' are used in separation only. All is in one file because
of numba's cache, which sees no other.
"""

# mypy: disable-error-code="no-untyped-def"
import math
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from disc_model.disc.plate import modal_damping, mode_arrays
from disc_model.errors import Fault, as_text, raise_faults
from disc_model.parameters import DEFAULTS, Parameters
from disc_model.simulation.states import State

Array = NDArray[np.float64]
OTHER_LAWS = (
    "contact_compliance",
    "contact_force",
    "friction_decay",
    "friction_offset",
)  # parameters of such


class Physics:
    """Constants of a case, in SI units, and as kernels take them: ``c`` and ``modes`` (`ROWS`, a
    column per mode)."""

    def __init__(self, p: Parameters) -> None:
        rule = "must be {}, because only the engine has other laws of contact than the paper's"
        changed = [name for name in OTHER_LAWS if getattr(p, name) != DEFAULTS[name]]
        raise_faults(
            [
                Fault.of((name,), getattr(p, name), rule.format(as_text(DEFAULTS[name])))
                for name in changed
            ]
        )
        modes = mode_arrays(p)
        self.p = p
        self.n = n = len(modes.omega)
        self.l = modes.diameters.astype(float)
        self.shape, self.omega = modes.psi.copy(), modes.omega.copy()  # psi_l, kg^-1/2
        self.stiffness = modes.omega**2
        self.damping = modal_damping(p)
        self.slope = self.l * self.shape
        self.compliance = float(np.sum(self.shape**2))  # S2, 1/kg
        self.u_0 = -p.N * float(np.sum(self.shape**2 / self.stiffness))
        self.a, self.b = slice(0, n), slice(n, 2 * n)
        self.alpha, self.beta = slice(2 * n, 3 * n), slice(3 * n, 4 * n)
        self.psi, self.f, self.u, self.v = range(4 * n, 4 * n + 4)
        scalars = (p.N, p.Omega, p.k, p.c, p.m, p.k_p, p.c_p, p.mu_s, p.mu_k, p.r_0)
        self.c = np.array([*scalars, self.u_0, self.compliance, float(p.contact == "bilateral")])
        by_a, by_alpha = (
            (p.k - p.m * self.stiffness) * self.shape,
            (p.c - p.m * self.damping) * self.shape,
        )
        by_beta, bent = 2.0 * p.m * self.l * self.shape, p.m * self.l**2 * self.shape
        rows = (
            self.l,
            self.shape,
            self.stiffness,
            self.damping,
            self.slope,
            by_a,
            by_alpha,
            by_beta,
            bent,
        )
        self.modes = np.array(rows)

    def pack(self, state: State) -> Array:
        return np.hstack(
            [
                state.a,
                state.b,
                state.alpha,
                state.beta,
                state.psi,
                state.f,
                state.u,
                state.u_velocity,
            ]
        )

    def unpack(self, time: float, phase: str, direction: int, y: Array) -> State:
        """The `State` of a vector; in contact u and u' are the disc's."""
        u, v = (y[self.u], y[self.v]) if phase == "separation" else self.disc_point(y)
        modal = {name: y[getattr(self, name)].copy() for name in ("a", "b", "alpha", "beta")}
        return State(
            time,
            phase,
            direction,
            float(y[self.psi]),
            float(y[self.f]),
            float(u),
            float(v),
            **modal,
        )

    def disc_point(self, y: Array) -> tuple[float, float]:
        """w and dw/dt of the disc under the moving slider."""
        slope = self.slope @ y[self.b]
        return float(self.shape @ y[self.a]), float(self.shape @ y[self.alpha] + y[self.f] * slope)

    def scale(self) -> Array:
        """Scale of each entry of the vector for absolute tolerances: static deflection, and its
        velocity."""
        p, deflection = self.p, self.p.N * np.abs(self.shape) / self.stiffness
        velocity, angle = deflection * self.omega, p.mu_s * p.N / (p.k_p * p.r_0)
        height = max(abs(self.u_0), 1e-12)
        tail = (max(angle, 1e-9), max(p.Omega, 1e-3), height, height * float(self.omega.min()))
        return np.concatenate([deflection, deflection, velocity, velocity, tail])

    def distance(self, state: State, other: State) -> float:
        """Energy norm of the difference of two states, that of the slider's height included, over
        that of ``other``."""
        right = self.pack(other)
        return float(np.sqrt(self._energy(self.pack(state) - right) / self._energy(right)))

    def _energy(self, y: Array) -> float:
        p, squares = self.p, y**2
        disc = np.sum(
            squares[self.alpha]
            + squares[self.beta]
            + self.stiffness * (squares[self.a] + squares[self.b])
        )
        plane = p.r_0**2 * (p.m * squares[self.f] + p.k_p * squares[self.psi])
        height = p.m * squares[self.v] + p.k * squares[self.u]
        return 0.5 * float(disc + plane + height)


SCALARS = 13  # length of ``c``
_N, _OMEGA, _K, _C, _M, _KP, _CP, _MUS, _MUK, _R0, _U0, _S2, _BONDED = range(SCALARS)

ROWS = (
    "l",
    "psi",
    "omega^2",
    "2 xi omega",
    "l psi",
    "P by a",
    "P by alpha",
    "P by f beta",
    "P by -f^2 a",
)
"""Rows of the table of modes; the last four: coefficients of the contact force over its denominator, one per state."""
_L, _PSI, _W2, _D, _SLOPE, _BY_A, _BY_ALPHA, _BY_BETA, _BENT = range(len(ROWS))

STICK, SLIP, SEPARATION = 0, 1, 2
STICK_TO_SLIP, SLIP_TO_STICK, SLIP_REVERSAL, LOSS_OF_CONTACT, REATTACHMENT = range(5)
FINISHED, NON_FINITE, STALLED, STEP_LIMIT = range(4)
HUGE = 10.0  # m sqrt(kg); a modal displacement beyond this, thousands of static deflections, is counted as overflow
SHIFT = 1e-16
"""Offset of the gap, m: a separation begins at a triple root of the gap, where general event detection reports a false
return or none. It is below all gaps and above their rounding, and shifts a reattachment by less than 1e-12 s."""
ROOT_TRIES = 60

# division by zero gives inf, as in numpy; sums may be taken several at a time
_OPTIONS: Any = {
    "cache": True,
    "error_model": "numpy",
    "fastmath": {"reassoc", "contract", "arcp", "nsz"},
}
_kernel = numba.njit(**_OPTIONS)
_part = numba.njit(
    **_OPTIONS, forceinline=True
)  # a third faster where it is called four times a step


@_part
def disc_point(modes, y):
    """w and w' under the slider."""
    n = modes.shape[1]
    w, velocity, slope = 0.0, 0.0, 0.0
    for i in range(n):
        w += modes[_PSI, i] * y[i]
        velocity += modes[_PSI, i] * y[2 * n + i]
        slope += modes[_SLOPE, i] * y[n + i]
    return w, velocity + y[4 * n + 1] * slope


@_part
def contact(modes, c, direction, y):
    """P and F; ``direction`` 0 is stick."""
    n = modes.shape[1]
    f = y[4 * n + 1]
    held, turned, bent, slope = 0.0, 0.0, 0.0, 0.0
    for i in range(n):
        held += modes[_BY_A, i] * y[i] + modes[_BY_ALPHA, i] * y[2 * n + i]
        turned += modes[_BY_BETA, i] * y[3 * n + i]
        bent += modes[_BENT, i] * y[i]
        slope += modes[_SLOPE, i] * y[n + i]
    F = c[_KP] * y[4 * n] + c[_CP] * (c[_OMEGA] - f)
    top = c[_N] - c[_K] * c[_U0] + held + f * (c[_C] * slope + turned - f * bent)
    below = 1.0 + c[_M] * c[_S2]
    if direction == 0:
        return top / below, F
    return (top + slope * F) / (below + direction * c[_MUK] / c[_R0] * slope), F


@_part
def rate(modes, c, phase, direction, y, dy):
    """Fill ``dy`` with dy/dt; returns P and F, in separation 0 and F."""
    n = modes.shape[1]
    f, P = y[4 * n + 1], 0.0
    dy[4 * n] = c[_OMEGA] - f
    if phase == SEPARATION:
        u, v = y[4 * n + 2], y[4 * n + 3]
        F = c[_KP] * y[4 * n] + c[_CP] * (c[_OMEGA] - f)
        dy[4 * n + 1] = F / c[_M]
        dy[4 * n + 2] = v
        dy[4 * n + 3] = -(c[_N] + c[_K] * (u - c[_U0]) + c[_C] * v) / c[_M]
    else:
        P, F = contact(modes, c, direction, y)
        dy[4 * n + 1] = (
            F / c[_M] - direction * c[_MUK] * P / (c[_M] * c[_R0]) if phase == SLIP else 0.0
        )
        dy[4 * n + 2] = 0.0
        dy[4 * n + 3] = 0.0
    for i in range(n):
        turn = modes[_L, i] * f
        a, b, alpha, beta = y[i], y[n + i], y[2 * n + i], y[3 * n + i]
        dy[i] = alpha + turn * b
        dy[n + i] = beta - turn * a
        dy[2 * n + i] = -modes[_D, i] * alpha - modes[_W2, i] * a + turn * beta - modes[_PSI, i] * P
        dy[3 * n + i] = -modes[_D, i] * beta - modes[_W2, i] * b - turn * alpha
    return P, F


@_kernel
def jacobian(modes, c, phase, direction, y, J):
    """Fill ``J`` (size, size) with the derivatives of `rate`, a row each; by complex steps, exact
    but for rounding."""
    z, dz = y.astype(np.complex128), np.empty(len(y), np.complex128)
    for j in range(len(y)):
        z[j] += 1e-30j
        rate(modes, c, phase, direction, z, dz)
        z[j] = y[j]
        for i in range(len(y)):
            J[i, j] = dz[i].imag * 1e30


STRIBECK = 30.0  # f/eps at which static friction has fallen to kinetic


@_kernel
def smooth_friction(c, law, f):
    """Coefficient of friction with the sign of f; ``law`` is (eps, dmu, K, C), with dmu for a
    maximum of mu_s."""
    x = f / law[0]
    return math.tanh(x) * (c[_MUK] + law[1] * math.exp(-min((x / STRIBECK) ** 2, 700.0)))


@_kernel
def smooth_force(modes, c, law, y):
    """Signed penalty force; contact where it is positive."""
    n = modes.shape[1]
    w, velocity = disc_point(modes, y)
    return law[2] * (w - y[4 * n + 2]) + law[3] * (velocity - y[4 * n + 3])


@_kernel
def smooth_rate(modes, c, law, y, dy):
    """Fill ``dy`` with dy/dt of the regularised model: separation's equations plus whatever force
    there is."""
    n = modes.shape[1]
    rate(modes, c, SEPARATION, 0, y, dy)
    P = smooth_force(modes, c, law, y)
    if P > 0.0:
        for i in range(n):
            dy[2 * n + i] -= modes[_PSI, i] * P
        dy[4 * n + 3] += P / c[_M]
        dy[4 * n + 1] -= smooth_friction(c, law, y[4 * n + 1]) * P / (c[_M] * c[_R0])


@_part
def rk4_step(modes, c, phase, direction, y, first, h, out, k, z):
    """One step of the classical fourth-order method from ``y``, whose rate is ``first``, to
    ``out``."""
    size = len(y)
    for j in range(size):
        z[j] = y[j] + 0.5 * h * first[j]
    rate(modes, c, phase, direction, z, k[0])
    for j in range(size):
        z[j] = y[j] + 0.5 * h * k[0, j]
    rate(modes, c, phase, direction, z, k[1])
    for j in range(size):
        z[j] = y[j] + h * k[1, j]
    rate(modes, c, phase, direction, z, k[2])
    for j in range(size):
        out[j] = y[j] + h / 6.0 * (first[j] + 2.0 * k[0, j] + 2.0 * k[1, j] + k[2, j])


@_kernel
def _margins(c, phase, direction, y, n, P, F, w, out):
    """Compute `switch_values` of a state whose P, F and w are known."""
    if phase == SEPARATION:
        out[0] = y[4 * n + 2] - w + SHIFT
        return 1
    out[0] = P if c[_BONDED] == 0.0 else 1.0
    if phase == SLIP:
        out[1] = direction * y[4 * n + 1]
        return 2
    out[1] = c[_MUS] * P - c[_R0] * F
    out[2] = c[_MUS] * P + c[_R0] * F
    return 3


@_kernel
def switch_values(modes, c, phase, direction, y, out):
    """Fill ``out`` with the functions whose fall through zero ends the phase (`integrators.ENDS`);
    returns how many."""
    n = modes.shape[1]
    P, F = contact(modes, c, direction, y)
    return _margins(c, phase, direction, y, n, P, F, disc_point(modes, y)[0], out)


@_kernel
def violated(values, count):
    """Index of the first of ``count`` values that is negative, or -1."""
    for index in range(count):
        if values[index] < 0.0:
            return index
    return -1


@_kernel
def switch(modes, c, phase, cause, y, kinds):
    """Carry out an event in place; ``cause`` is the index of its function in `switch_values`.
    Returns (phase, direction, number of events written to ``kinds``); -1 events if the state is not
    finite."""
    n = modes.shape[1]
    if not abs(np.sum(y)) < np.inf:
        return phase, 0, -1
    if phase == SEPARATION:
        _, velocity = disc_point(modes, y)
        impulse = (velocity - y[4 * n + 3]) / (c[_S2] + 1.0 / c[_M])
        for i in range(n):
            y[2 * n + i] -= modes[_PSI, i] * impulse
        kinds[0] = REATTACHMENT
        direction = 1 if y[4 * n + 1] > 0.0 else -1
    elif cause == 0:
        y[4 * n + 2], y[4 * n + 3] = disc_point(modes, y)
        kinds[0] = LOSS_OF_CONTACT
        return SEPARATION, 0, 1
    elif phase == STICK:
        kinds[0] = STICK_TO_SLIP
        _, F = contact(modes, c, 0, y)
        direction = 1 if F > 0.0 else -1
    else:
        y[4 * n + 1] = 0.0
        P, F = contact(modes, c, 0, y)
        if c[_R0] * abs(F) < c[_MUS] * P:
            kinds[0] = SLIP_TO_STICK
            return STICK, 0, 1
        direction = 1 if F > 0.0 else -1
        kinds[0] = SLIP_REVERSAL
    P, _ = contact(modes, c, direction, y)
    if P < 0.0 and c[_BONDED] == 0.0:
        y[4 * n + 2], y[4 * n + 3] = disc_point(modes, y)
        # a slider that neither sticks nor slips back keeps its direction
        count = 0 if kinds[0] == SLIP_REVERSAL else 1
        kinds[count] = LOSS_OF_CONTACT
        return SEPARATION, 0, count + 1
    return SLIP, direction, 1


@_kernel
def _dip(before, current, after):
    """Place of the minimum, in the last of two equal steps, of the parabola through three values; 0
    unless it is below half of both ends there."""
    bend, rise = after - 2.0 * current + before, 0.5 * (after - before)
    s = -rise / bend if bend > 0.0 else 0.0
    return s if 0.0 < s < 1.0 and current + 0.5 * s * rise < 0.5 * min(current, after) else 0.0


@_kernel
def rk4_run(modes, c, phase, direction, y, limits, track):
    """Take fixed steps of ``y``, in place, from local time 0 to an event, which secants locate
    within its step, and so on to the end. A step is searched if an event function changes sign over
    it or dips within it.

    limits : end and step (s), greatest number of steps, whether to stop at the first separation
    track : arrays to fill: times and kinds of events, and (2,) the least and greatest w at step ends
    """
    t_end, h, max_steps, stop = limits
    times, kinds, heights = track
    size, n = len(y), modes.shape[1]
    k, z, trial = np.empty((3, size)), np.empty(size), np.empty(3)
    new, end, first, following_rate = (
        np.empty(2, np.int64),
        np.empty(size),
        np.empty(size),
        np.empty(size),
    )
    before, current, after = np.empty(3), np.empty(3), np.empty(3)
    lows, probe, final = np.empty(3), np.empty(size), y
    why, origin, count, local, events, steps = FINISHED, 0.0, 0, 0.0, 0, 0
    while local < t_end:
        if steps >= max_steps:
            why = STEP_LIMIT
            break
        if count == 0:
            rate(modes, c, phase, direction, y, first)
            switch_values(modes, c, phase, direction, y, current)
        # time is event time plus a whole number of steps: summing h would lose digits of the event
        # times
        following = origin + (count + 1) * h
        length = following - local
        if following >= t_end:
            following, length = t_end, t_end - local
        rk4_step(modes, c, phase, direction, y, first, length, end, k, z)
        steps += 1
        P, F = rate(modes, c, phase, direction, end, following_rate)
        w, _ = disc_point(modes, end)
        if not abs(w) < HUGE:
            why = NON_FINITE
            break
        heights[0], heights[1] = min(heights[0], w), max(heights[1], w)
        conditions = _margins(c, phase, direction, end, n, P, F, w, after)
        cause, high = violated(after, conditions), length
        for index in range(conditions if cause < 0 < count else 0):
            s = _dip(before[index], current[index], after[index])
            if s > 0.0:
                rk4_step(modes, c, phase, direction, y, first, s * length, probe, k, z)
                steps += 1
                switch_values(modes, c, phase, direction, probe, trial)
                cause = violated(trial, conditions)
                if cause >= 0:
                    high, after[:] = s * length, trial
                    break
        if cause < 0:
            y, end = end, y
            first, following_rate = following_rate, first
            before, current, after = current, after, before
            local = following
            count += 1
            continue
        low, at_low, at_high, side = 0.0, current[cause], after[cause], 0
        lows[:] = current
        for _ in range(ROOT_TRIES):
            middle = low + (high - low) * at_low / (at_low - at_high)
            if not low < middle < high or (
                low == 0.0 and count == 0
            ):  # a phase may begin at a root
                middle = 0.5 * (low + high)
            rk4_step(modes, c, phase, direction, y, first, middle, end, k, z)
            steps += 1
            switch_values(modes, c, phase, direction, end, trial)
            other = violated(trial, conditions)
            # an end that stays twice counts half (Illinois)
            if other >= 0:
                if other != cause:
                    cause, at_low, side = other, lows[other], 0
                at_low *= 0.5 if side == 1 else 1.0
                moved, high, at_high, side = high - middle, middle, trial[cause], 1
            else:
                at_high *= 0.5 if side == -1 else 1.0
                moved, low, at_low, side = middle - low, middle, trial[cause], -1
                lows[:] = trial
            if moved < 1e-12 * length or trial[cause] == 0.0:
                break
        y[:] = end
        local += middle
        origin, count = local, 0
        phase, direction, added = switch(modes, c, phase, cause, y, new)
        if events + added > len(times):
            why = STALLED
            break
        for j in range(added):
            times[events + j], kinds[events + j] = local, new[j]
        events += added
        if stop and phase == SEPARATION:
            break
    final[:] = y
    return why, local, phase, direction, events, steps
