"""Constants of a case, states as vectors and the compiled equations of motion.

No code is shared with the engine. The state is y = (a, b, alpha, beta, psi, f, u, u'), of shape
(4 n + 4,) with the number n of modes (docs: model, Disc in the slider's frame); u and u' are used in
separation only. All is in one file because of numba's cache, which sees no other.
"""

# mypy: disable-error-code="no-untyped-def"
from typing import Any

import numba
import numpy as np

from disc_model.arrays import Array
from disc_model.disc.plate import modal_damping, mode_arrays
from disc_model.errors import Fault, as_text, raise_faults
from disc_model.parameters import DEFAULTS, Parameters
from disc_model.simulation.states import State

OTHER_LAWS = (
    "contact_compliance",
    "contact_arc",
    "contact_force",
    "friction_decay",
    "friction_offset",
    "viscous_friction",
)
"""Parameters of laws of contact that only the engine has."""


class Physics:
    """Constants of a case in SI units, and the places of the state's parts in a vector.

    Attributes
    ----------
    p : the case
    n : number of modes
    l : nodal diameters of the modes, (n,)
    shape : their amplitudes psi_l under the slider, kg^-1/2, (n,)
    omega, stiffness, damping : their frequencies, rad/s, the squares of these, and 2 xi omega, (n,)
    slope : l psi_l, (n,)
    compliance : S2, the sum of the squares of psi_l, 1/kg
    u_0 : height of the slider in static equilibrium, m
    a, b, alpha, beta, psi, f, u, v : places of the parts
    c : scalars for the kernels, (`SCALARS`,)
    modes : the table of modes for the kernels, (rows of `ROWS`, n)
    """

    def __init__(self, p: Parameters) -> None:
        _refuse_other_laws(p)
        self.p = p
        modes = mode_arrays(p)
        self.n = len(modes.omega)
        self.l = modes.diameters.astype(float)
        self.shape = modes.psi.copy()
        self.omega = modes.omega.copy()
        self.stiffness = modes.omega**2
        self.damping = modal_damping(p)
        self.slope = self.l * self.shape
        self.compliance = float(np.sum(self.shape**2))
        self.u_0 = -p.N * float(np.sum(self.shape**2 / self.stiffness))

        n = self.n
        self.a = slice(0, n)
        self.b = slice(n, 2 * n)
        self.alpha = slice(2 * n, 3 * n)
        self.beta = slice(3 * n, 4 * n)
        self.psi, self.f, self.u, self.v = range(4 * n, 4 * n + 4)

        self.c = self._scalars()
        self.modes = self._table_of_modes()

    def _scalars(self) -> Array:
        """Return the scalars of the kernels, in the order of their places there."""
        p = self.p
        bilateral = float(p.contact == "bilateral")
        drive = (p.N, p.Omega, p.k, p.c, p.m, p.k_p, p.c_p, p.mu_s, p.mu_k, p.r_0)
        return np.array([*drive, self.u_0, self.compliance, bilateral])

    def _table_of_modes(self) -> Array:
        """Return the table of modes of the kernels, in the order of `ROWS`."""
        p = self.p
        by_a = (p.k - p.m * self.stiffness) * self.shape
        by_alpha = (p.c - p.m * self.damping) * self.shape
        by_beta = 2.0 * p.m * self.l * self.shape
        bent = p.m * self.l**2 * self.shape
        own = (self.l, self.shape, self.stiffness, self.damping, self.slope)
        return np.array([*own, by_a, by_alpha, by_beta, bent])

    def pack(self, state: State) -> Array:
        """Return the vector of a state."""
        modal = [state.a, state.b, state.alpha, state.beta]
        slider = [state.psi, state.f, state.u, state.u_velocity]
        return np.hstack([*modal, *slider])

    def unpack(self, time: float, phase: str, direction: int, y: Array) -> State:
        """Return the state of a vector; in contact, u and u' are the disc's.

        Parameters
        ----------
        time : s
        phase : name of the phase
        direction : sign of f in slip, otherwise 0
        y : the vector
        """
        u, v = self.disc_point(y)
        if phase == "separation":
            u = float(y[self.u])
            v = float(y[self.v])
        return State(
            time=time,
            phase=phase,
            direction=direction,
            psi=float(y[self.psi]),
            f=float(y[self.f]),
            u=u,
            u_velocity=v,
            a=y[self.a].copy(),
            b=y[self.b].copy(),
            alpha=y[self.alpha].copy(),
            beta=y[self.beta].copy(),
        )

    def disc_point(self, y: Array) -> tuple[float, float]:
        """Return w and dw/dt of the disc under the moving slider, m and m/s."""
        slope = self.slope @ y[self.b]
        velocity = self.shape @ y[self.alpha] + y[self.f] * slope
        return float(self.shape @ y[self.a]), float(velocity)

    def scale(self) -> Array:
        """Return the scale of each entry of the vector, for absolute tolerances.

        It is the static deflection or its velocity.
        """
        p = self.p
        deflection = p.N * np.abs(self.shape) / self.stiffness
        velocity = deflection * self.omega
        angle = max(p.mu_s * p.N / (p.k_p * p.r_0), 1e-9)
        speed = max(p.Omega, 1e-3)
        height = max(abs(self.u_0), 1e-12)
        slider = (angle, speed, height, height * float(self.omega.min()))
        return np.concatenate([deflection, deflection, velocity, velocity, slider])

    def distance(self, state: State, other: State) -> float:
        """Return the energy norm of the difference of two states over that of the other.

        The energy includes that of the slider's height.
        """
        right = self.pack(other)
        difference = self.pack(state) - right
        return float(np.sqrt(self._energy(difference) / self._energy(right)))

    def _energy(self, y: Array) -> float:
        """Return the energy of a vector, J."""
        p = self.p
        squares = y**2
        kinetic = squares[self.alpha] + squares[self.beta]
        elastic = self.stiffness * (squares[self.a] + squares[self.b])
        disc = np.sum(kinetic + elastic)
        plane = p.r_0**2 * (p.m * squares[self.f] + p.k_p * squares[self.psi])
        height = p.m * squares[self.v] + p.k * squares[self.u]
        return 0.5 * float(disc + plane + height)


def _refuse_other_laws(p: Parameters) -> None:
    """Raise `ParameterError` for a case with another law of contact than the paper's."""
    rule = "must be {}, because only the engine has other laws of contact than the paper's"
    faults = []
    for name in OTHER_LAWS:
        value = getattr(p, name)
        default = DEFAULTS[name]
        if value != default:
            faults.append(Fault.of((name,), value, rule.format(as_text(default))))
    raise_faults(faults)


SCALARS = 13
"""Number of scalars for the kernels."""
_N, _OMEGA, _K, _C, _M, _KP, _CP, _MUS, _MUK, _R0, _U0, _S2, _BILATERAL = range(SCALARS)

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
"""Rows of the table of modes.

The last four are coefficients of the contact force over its denominator, one for each state.
"""
_L, _PSI, _W2, _D, _SLOPE, _BY_A, _BY_ALPHA, _BY_BETA, _BENT = range(len(ROWS))

# phases
STICK, SLIP, SEPARATION = range(3)
# kinds of events
STICK_TO_SLIP, SLIP_TO_STICK, SLIP_REVERSAL, LOSS_OF_CONTACT, REATTACHMENT = range(5)
# how `rk4_run` ends
FINISHED, NON_FINITE, STALLED, STEP_LIMIT = range(4)

HUGE = 10.0
"""Displacement of the disc, m, beyond which it counts as overflow: thousands of static ones."""
SHIFT = 1e-16
"""Offset of the gap, m.

A separation begins at a triple root of the gap, where general event detection reports a false
return or none. The offset is below all gaps and above their rounding, and shifts a reattachment by
less than 1e-12 s.
"""
ROOT_TRIES = 60
"""Greatest number of secants by which `rk4_run` locates an event."""
ROOT_FOUND = 1e-12
"""Change of an event's place, in steps, below which it is found."""

# division by zero gives inf, as in numpy; sums may be taken several at a time
_FAST = {"reassoc", "contract", "arcp", "nsz"}
_OPTIONS: Any = {"cache": True, "error_model": "numpy", "fastmath": _FAST}
_kernel = numba.njit(**_OPTIONS)
# a third faster where it is called four times a step
_part = numba.njit(**_OPTIONS, forceinline=True)


@_part
def disc_point(modes, y):
    """Return w and w' under the slider."""
    n = modes.shape[1]
    w = 0.0
    velocity = 0.0
    slope = 0.0
    for i in range(n):
        w += modes[_PSI, i] * y[i]
        velocity += modes[_PSI, i] * y[2 * n + i]
        slope += modes[_SLOPE, i] * y[n + i]
    return w, velocity + y[4 * n + 1] * slope


@_part
def contact(modes, c, direction, y):
    """Return the contact force P and the force F in the plane; ``direction`` 0 is stick."""
    n = modes.shape[1]
    f = y[4 * n + 1]
    held = 0.0
    turned = 0.0
    bent = 0.0
    slope = 0.0
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
    """Fill ``dy`` with dy/dt; return P and F, of which P is 0 in separation."""
    n = modes.shape[1]
    f = y[4 * n + 1]
    P = 0.0
    dy[4 * n] = c[_OMEGA] - f
    if phase == SEPARATION:
        u = y[4 * n + 2]
        v = y[4 * n + 3]
        F = c[_KP] * y[4 * n] + c[_CP] * (c[_OMEGA] - f)
        dy[4 * n + 1] = F / c[_M]
        dy[4 * n + 2] = v
        dy[4 * n + 3] = -(c[_N] + c[_K] * (u - c[_U0]) + c[_C] * v) / c[_M]
    else:
        P, F = contact(modes, c, direction, y)
        dy[4 * n + 1] = 0.0
        if phase == SLIP:
            dy[4 * n + 1] = F / c[_M] - direction * c[_MUK] * P / (c[_M] * c[_R0])
        dy[4 * n + 2] = 0.0
        dy[4 * n + 3] = 0.0
    for i in range(n):
        turn = modes[_L, i] * f
        a = y[i]
        b = y[n + i]
        alpha = y[2 * n + i]
        beta = y[3 * n + i]
        dy[i] = alpha + turn * b
        dy[n + i] = beta - turn * a
        dy[2 * n + i] = -modes[_D, i] * alpha - modes[_W2, i] * a + turn * beta - modes[_PSI, i] * P
        dy[3 * n + i] = -modes[_D, i] * beta - modes[_W2, i] * b - turn * alpha
    return P, F


@_kernel
def jacobian(modes, c, phase, direction, y, J):
    """Fill ``J`` (size, size) with the derivatives of `rate`, a row each.

    They are found by complex steps, exact but for rounding.
    """
    z = y.astype(np.complex128)
    dz = np.empty(len(y), np.complex128)
    for j in range(len(y)):
        z[j] += 1e-30j
        rate(modes, c, phase, direction, z, dz)
        z[j] = y[j]
        for i in range(len(y)):
            J[i, j] = dz[i].imag * 1e30


# ---- Events


@_kernel
def _margins(c, phase, direction, y, n, P, F, w, out):
    """Compute `switch_values` of a state whose P, F and w are known."""
    if phase == SEPARATION:
        out[0] = y[4 * n + 2] - w + SHIFT
        return 1
    out[0] = P
    if c[_BILATERAL] != 0.0:
        out[0] = 1.0
    if phase == SLIP:
        out[1] = direction * y[4 * n + 1]
        return 2
    out[1] = c[_MUS] * P - c[_R0] * F
    out[2] = c[_MUS] * P + c[_R0] * F
    return 3


@_kernel
def switch_values(modes, c, phase, direction, y, out):
    """Fill ``out`` with the functions whose fall through zero ends a phase; return how many.

    `phases.ENDS` says which they are.
    """
    n = modes.shape[1]
    P, F = contact(modes, c, direction, y)
    w, _ = disc_point(modes, y)
    return _margins(c, phase, direction, y, n, P, F, w, out)


@_kernel
def violated(values, count):
    """Return the index of the first of ``count`` values that is negative, or -1."""
    for index in range(count):
        if values[index] < 0.0:
            return index
    return -1


@_kernel
def switch(modes, c, phase, cause, y, kinds):
    """Carry out an event in place.

    phase : that ends
    cause : index of the event's function in `switch_values`
    y : state
    kinds : array to fill with the kinds of the events, (2,)

    Returns the new phase, its direction, and the number of events, which is -1 if the state is not
    finite.
    """
    n = modes.shape[1]
    if not abs(np.sum(y)) < np.inf:
        return phase, 0, -1

    # what ends the phase, and the direction of slip after it
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

    # the slip may lose contact at once
    P, _ = contact(modes, c, direction, y)
    if P < 0.0 and c[_BILATERAL] == 0.0:
        y[4 * n + 2], y[4 * n + 3] = disc_point(modes, y)
        # a slider that neither sticks nor slips back keeps its direction
        count = 0 if kinds[0] == SLIP_REVERSAL else 1
        kinds[count] = LOSS_OF_CONTACT
        return SEPARATION, 0, count + 1
    return SLIP, direction, 1


# ---- Classical Runge-Kutta with a fixed step


@_part
def rk4_step(modes, c, phase, direction, y, first, h, out, k, z):
    """Take one step of the classical fourth-order method.

    y, first : state and its rate
    h : step, s
    out : array to fill with the new state
    k, z : work arrays, (3, size) and (size,)
    """
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
def _dip(before, current, after):
    """Return the place of a minimum in the last of two equal steps, in steps.

    It is that of the parabola through three values; 0 unless the parabola is below half of both
    ends there.
    """
    bend = after - 2.0 * current + before
    rise = 0.5 * (after - before)
    if not bend > 0.0:
        return 0.0
    place = -rise / bend
    if not 0.0 < place < 1.0:
        return 0.0
    least = current + 0.5 * place * rise
    if least < 0.5 * min(current, after):
        return place
    return 0.0


@_kernel
def _first_dip(before, current, after, count):
    """Return which of ``count`` event functions dips first within the last of two steps, or -1.

    The first is that of the lowest index.
    """
    for index in range(count):
        if _dip(before[index], current[index], after[index]) > 0.0:
            return index
    return -1


@_kernel
def _search_dips(modes, c, phase, direction, step, before, current, after, count):
    """Look for an event within a step over which no event function changes its sign.

    step : state and rate at its begin, its length, s, and whether a phase begins with it
    before, current, after : event functions a step before, at the begin and at the end; the last
        become those at the place that is returned
    count : number of event functions

    Returns the index of the function of an event, or -1, and the place in the step by which it has
    fallen below zero, s.
    """
    y, first, length, _ = step
    k, z, probe = np.empty((3, len(y))), np.empty(len(y)), np.empty(len(y))
    trial = np.empty(3)
    for index in range(count):
        share = _dip(before[index], current[index], after[index])
        if share > 0.0:
            place = share * length
            rk4_step(modes, c, phase, direction, y, first, place, probe, k, z)
            switch_values(modes, c, phase, direction, probe, trial)
            cause = violated(trial, count)
            if cause >= 0:
                after[:] = trial
                return cause, place
    return -1, length


@_kernel
def _locate(modes, c, phase, direction, step, cause, high, current, after, count, end):
    """Locate the first event within a step by secants, an end that stays twice counting half.

    step : as in `_search_dips`; where a phase begins, there may be a root of an event function
    cause, high : index of the function of an event, and a place by which it has fallen below zero
    current, after : event functions at the begin and there
    count : number of event functions
    end : array to fill with the state at the event

    Returns the index of the event's function and its place, s.
    """
    y, first, length, at_root = step
    k, z = np.empty((3, len(y))), np.empty(len(y))
    trial = np.empty(3)
    low = 0.0
    at_low = current[cause]
    at_high = after[cause]
    side = 0
    middle = 0.0
    lows = current.copy()
    for _ in range(ROOT_TRIES):
        middle = low + (high - low) * at_low / (at_low - at_high)
        if not low < middle < high or (low == 0.0 and at_root):
            middle = 0.5 * (low + high)
        rk4_step(modes, c, phase, direction, y, first, middle, end, k, z)
        switch_values(modes, c, phase, direction, end, trial)
        other = violated(trial, count)
        if other >= 0:
            if other != cause:
                cause = other
                at_low = lows[other]
                side = 0
            if side == 1:
                at_low *= 0.5
            moved = high - middle
            high = middle
            at_high = trial[cause]
            side = 1
        else:
            if side == -1:
                at_high *= 0.5
            moved = middle - low
            low = middle
            at_low = trial[cause]
            side = -1
            lows[:] = trial
        if moved < ROOT_FOUND * length or trial[cause] == 0.0:
            break
    return cause, middle


@_kernel
def _record(times, kinds, events, time, new, added):
    """Append the first ``added`` kinds of ``new`` at a time; return the number of events.

    times, kinds : arrays to fill, of which the first ``events`` are filled

    Returns -1, and appends nothing, where the arrays are too short.
    """
    if events + added > len(times):
        return -1
    for j in range(added):
        times[events + j] = time
        kinds[events + j] = new[j]
    return events + added


@_kernel
def rk4_run(modes, c, phase, direction, y, limits, track):
    """Take fixed steps from event to event, from local time 0 to an end.

    A step is searched for an event if an event function changes its sign over it or dips within it.

    y : state, which is changed in place
    limits : end and step, s, greatest number of steps, whether to stop at the first separation
    track : arrays to fill: times and kinds of events

    Returns how it ended, local time, phase, direction, and the number of events.
    """
    t_end, h, max_steps, stop = limits
    times, kinds = track
    size = len(y)
    n = modes.shape[1]
    final = y

    # states and rates at both ends of a step, and event functions there and a step before
    end = np.empty(size)
    first = np.empty(size)
    following_rate = np.empty(size)
    before = np.empty(3)
    current = np.empty(3)
    after = np.empty(3)
    k = np.empty((3, size))
    z = np.empty(size)
    new = np.empty(2, np.int64)

    why = FINISHED
    origin = 0.0
    count = 0
    local = 0.0
    events = 0
    steps = 0
    while local < t_end:
        if steps >= max_steps:
            why = STEP_LIMIT
            break
        if count == 0:
            rate(modes, c, phase, direction, y, first)
            switch_values(modes, c, phase, direction, y, current)

        # a step; its time is that of the last event plus a whole number of steps, because summing h
        # would lose digits of the event times
        following = origin + (count + 1) * h
        length = following - local
        if following >= t_end:
            following = t_end
            length = t_end - local
        rk4_step(modes, c, phase, direction, y, first, length, end, k, z)
        steps += 1
        P, F = rate(modes, c, phase, direction, end, following_rate)
        w, _ = disc_point(modes, end)
        if not abs(w) < HUGE:
            why = NON_FINITE
            break

        # whether there is an event in it
        conditions = _margins(c, phase, direction, end, n, P, F, w, after)
        cause = violated(after, conditions)
        high = length
        # a call with many arrays in each step would take a third of its time
        if cause < 0 < count and _first_dip(before, current, after, conditions) >= 0:
            step = (y, first, length, count == 0)
            cause, high = _search_dips(
                modes, c, phase, direction, step, before, current, after, conditions
            )
        if cause < 0:
            y, end = end, y
            first, following_rate = following_rate, first
            before, current, after = current, after, before
            local = following
            count += 1
            continue

        # the event
        step = (y, first, length, count == 0)
        cause, place = _locate(
            modes, c, phase, direction, step, cause, high, current, after, conditions, end
        )
        y[:] = end
        local += place
        origin = local
        count = 0
        phase, direction, added = switch(modes, c, phase, cause, y, new)
        recorded = _record(times, kinds, events, local, new, added)
        if recorded < 0:
            why = STALLED
            break
        events = recorded
        if stop and phase == SEPARATION:
            break
    final[:] = y
    return why, local, phase, direction, events
