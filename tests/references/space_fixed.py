"""Every law of contact in coordinates fixed in space, by DOP853 with a search for switches of its own.

The disc stands still and the slider moves round it, as in `tests.references.literal`; Omega and N may go on ramps.
Vertical force V, normal force R, friction T and the slider's angular acceleration follow at each instant from the laws
of docs/model.md, as four linear equations: nothing is eliminated by hand.  They are compiled: a run takes 1e5 of them.
"""

import numba
import numpy as np
from scipy.integrate import DOP853
from scipy.optimize import brentq, minimize_scalar

from disc_model.flexibility import contact_compliance
from tests.references.literal import Literal

#: Of a phase: whether there is contact, whether the slider sticks, and the direction of slip.
PHASES = {
    "stick": (True, True, 0.0),
    "slip+": (True, False, 1.0),
    "slip-": (True, False, -1.0),
    "separation": (False, False, 0.0),
}
SAMPLES = 16
"""Places in a step at which switches are looked for, and where a parabola through three of them dips below zero."""
FIRST_STEP = 1e-7
"""s, after a switch: another may follow at once."""


@numba.njit
def evaluate(t, y, piece, phase, modes, c, out):
    """Rates of a state, into ``out``.  Returns V, R, T, w, its velocity, slope, psi, and the second rate of u - w.

    y : q and q' (real and imaginary parts by turns), phi, phi', u, u'; phase : as in `PHASES`; piece : a time, then the
    drive point's angle, Omega and N at it, and their rates; modes : rows l, omega, Psi, damping; c : m, k, c, k_p, c_p,
    mu_k, r_0, u_0, C, and 1 if the force is normal, else 0
    """
    touches, sticks, side = phase
    m, k, damper, k_p, c_p, mu_k, r_0, u_0, C, normal = c
    n, since = modes.shape[1], t - piece[0]
    drive, N = piece[2] + piece[4] * since, piece[3] + piece[5] * since
    phi, f, u, v = y[4 * n], y[4 * n + 1], y[4 * n + 2], y[4 * n + 3]
    psi = piece[1] + (piece[2] + drive) / 2 * since - phi
    w, velocity, slope, A, S = 0.0, 0.0, 0.0, 0.0, 0.0
    for j in range(n):
        l, omega, Psi, damping = modes[0, j], modes[1, j], modes[2, j], modes[3, j]
        e = Psi * complex(np.cos(l * phi), np.sin(l * phi))
        q, rate = complex(y[2 * j], y[2 * j + 1]), complex(y[2 * (n + j)], y[2 * (n + j) + 1])
        free = -damping * rate - omega**2 * q
        w += (e * q).real
        velocity += (e * (rate + 1j * l * f * q)).real
        slope += (1j * l * e * q).real
        A += (e * (free + 2j * l * f * rate - (l * f) ** 2 * q)).real
        S += Psi**2
        out[2 * j], out[2 * j + 1] = rate.real, rate.imag
        out[2 * (n + j)], out[2 * (n + j) + 1] = free.real, free.imag
    rigid = touches and C == 0.0
    height, climb = (w, velocity) if rigid else (u, v)
    load, beta = N + k * (height - u_0) + damper * climb, normal * slope / r_0
    # unknown: V, R, T, phi''.  V = R - beta T;  m r_0 phi'' + T + beta R = r_0 F
    a, b = np.zeros((4, 4)), np.zeros(4)
    a[0, 0], a[0, 1], a[0, 2] = 1.0, -1.0, beta
    a[1, 1], a[1, 2], a[1, 3], b[1] = beta, 1.0, m * r_0, r_0 * (k_p * psi + c_p * (drive - f))
    if sticks:
        a[2, 3] = 1.0
    else:
        a[2, 1], a[2, 2] = -side * mu_k, 1.0
    a[3, 0] = 1.0
    if rigid:
        # V - load = m u'' of the disc's point
        a[3, 0], a[3, 3], b[3] = 1.0 + m * S, -m * slope, load + m * A
    elif touches:
        b[3] = (w - u) / C
    V, R, T, turning = np.linalg.solve(a, b)
    for j in range(n):
        pushed = modes[2, j] * V
        out[2 * (n + j)] -= pushed * np.cos(modes[0, j] * phi)
        out[2 * (n + j) + 1] += pushed * np.sin(modes[0, j] * phi)
    out[4 * n], out[4 * n + 1], out[4 * n + 2], out[4 * n + 3] = f, turning, v, (V - load) / m
    return V, R, T, w, velocity, slope, psi, (V - load) / m - A - turning * slope + S * V


@numba.njit
def watch(times, states, piece, phase, modes, c, mu_s, order):
    """What is positive while a phase lasts, (times, 2): what presses, and what is left of friction or of the speed.

    Out of contact: the gap, or its rate of this ``order``, twice.
    """
    out, found = np.empty(states.shape[1]), np.empty((len(times), 2))
    touches, sticks, side = phase
    n = modes.shape[1]
    for i in range(len(times)):
        V, R, T, w, velocity, _, _, opening = evaluate(times[i], states[i], piece, phase, modes, c, out)
        if touches:
            found[i, 0] = V if c[8] > 0.0 else R
            found[i, 1] = mu_s * R - abs(T) if sticks else side * states[i, 4 * n + 1]
        else:
            found[i, :] = (states[i, 4 * n + 2] - w, states[i, 4 * n + 3] - velocity, opening)[order]
    return found


def pieces_of(course, drive):
    """Rows for `evaluate`, from `Motion`'s ``course``."""
    rows, angle = [], drive
    for (t, Omega, N), (end, to, N_to) in zip(course, [*course[1:], (np.inf, *course[-1][1:])], strict=True):
        rows.append((t, angle, Omega, N, (to - Omega) / (end - t), (N_to - N) / (end - t)))
        angle += (Omega + to) / 2 * (end - t)
    return np.array(rows)


class Motion:
    """A motion of a case, from a `literal.Start` at the time 0 on.

    course : where Omega and N change their rates, (time, Omega, N), from 0 on; drive : the drive point's angle at 0.
    ``phase`` is one of `PHASES`, ``events`` has (time, kind).
    """

    def __init__(self, p, start, drive=0.0, course=(), rtol=1e-13):
        case, C, normal = Literal(p), contact_compliance(p), float(p.contact_force == "normal")
        self.mu_s, self.bonded, self.rigid, self.rtol = p.mu_s, p.contact == "bonded", C == 0, rtol
        self.modes, self.S = np.array([case.l, case.omega, case.Psi, case.damping], float), (case.Psi**2).sum()
        u_0 = case.w_0 - C * p.N
        self.c = np.array([p.m, p.k, p.c, p.k_p, p.c_p, p.mu_k, p.r_0, u_0, C, normal])
        self.pieces = pieces_of(course or [(0.0, p.Omega, p.N)], drive)
        self.t, self.y, self.phase, self.events = 0.0, start.vector, start.phase, []
        # the gap's rate that is awaited; whether functions that begin at zero have risen; the last step
        self.order, self.risen, self.h = 0, [True, True], FIRST_STEP
        fastest = max(case.omega.max(initial=1.0), np.sqrt(max(p.k_p, p.k) / p.m))
        self.longest, q, u = 0.5 / fastest, np.repeat(p.N * case.Psi / case.omega**2, 2), max(abs(u_0), 1e-6)
        self.atol = 1e-3 * rtol * np.concatenate([q, q * np.repeat(case.omega, 2), [1e-3, 1.0, u, u * fastest]])

    @property
    def piece(self):
        return self.pieces[np.searchsorted(self.pieces[:, 0], self.t, side="right") - 1]

    def evaluate(self, phase=None):
        """As `evaluate`, now."""
        phase = PHASES[phase or self.phase]
        return evaluate(self.t, self.y, self.piece, phase, self.modes, self.c, np.empty_like(self.y))

    def sample(self, theta):
        """P, u, u', w, w and its velocity at the angle theta, psi and its rate."""
        (_, R, _, w, velocity, _, psi, _), n, y = self.evaluate(), self.modes.shape[1], self.y
        touches = self.phase != "separation"
        u, v = (w, velocity) if touches and self.rigid else y[-2:]
        point = self.modes[2] * np.exp(1j * self.modes[0] * theta)
        q, rate = y[: 4 * n].view(complex).reshape(2, n)
        turning = self.piece[2] + self.piece[4] * (self.t - self.piece[0]) - y[4 * n + 1]
        return R * touches, u, v, w, (point * q).sum().real, (point * rate).sum().real, psi, turning

    def energies(self):
        """Of transverse motion and of that in the plane, J."""
        (V, _, _, w, velocity, _, psi, _), n, y = self.evaluate(), self.modes.shape[1], self.y
        u, v = (w, velocity) if self.phase != "separation" and self.rigid else y[-2:]
        m, k, _, k_p, _, _, r_0, u_0, C, _ = self.c
        N = self.piece[3] + self.piece[5] * (self.t - self.piece[0])
        q, rate = abs(y[: 4 * n].view(complex).reshape(2, n)) ** 2
        disc = (rate + self.modes[1] ** 2 * q).sum() + C * V**2
        return (disc + m * v**2 + k * (u - u_0) ** 2) / 2 + N * (u - u_0), r_0**2 * (m * y[-3] ** 2 + k_p * psi**2) / 2

    # ---- integration
    def run(self, t_end):
        """Advance to a time.  Returns self."""
        for end in [*(t for t in self.pieces[:, 0] if self.t < t < t_end), t_end]:
            while self.t < end:
                if kind := self._follow(end):
                    self._switch(kind)
        return self

    def _solver(self, t, y, t_end, first_step):
        piece, phase, modes, c = self.piece, PHASES[self.phase], self.modes, self.c

        def rates(t, y):
            out = np.empty_like(y)
            evaluate(t, y, piece, phase, modes, c, out)
            return out

        return DOP853(rates, t, y, t_end, rtol=self.rtol, atol=self.atol, max_step=self.longest, first_step=first_step)

    def _fresh(self, t0, y0, t):
        """y(t) from within a step that began at t0: no dense output."""
        if t <= t0:
            return y0.copy()
        solver = self._solver(t0, y0, t, t - t0)
        while solver.status == "running":
            solver.step()
        return solver.y.copy()

    def _follow(self, end):
        """To the first switch or to ``end``; the switch's kind."""
        kinds = {"stick": ("separation", "stick_to_slip"), "separation": ("reattachment",) * 2}
        solver = self._solver(self.t, self.y, end, min(self.h, end - self.t))
        while solver.status == "running":
            t0, y0 = solver.t, solver.y.copy()
            solver.step()
            self.h = max(self.h, solver.t - t0)
            if found := self._crossings(solver, t0, y0):
                t, which = min(found)
                self.y, self.t = self._fresh(t0, y0, t), t
                if self.phase == "separation" and self.order:
                    self.order -= 1
                    return None
                return kinds.get(self.phase, ("separation", "rest"))[which]
        assert solver.status == "finished", solver.t
        self.t, self.y = solver.t, solver.y.copy()
        return None

    def _crossings(self, solver, t0, y0):
        """Where functions fall through zero in the step just made, and which."""
        how = self.piece, PHASES[self.phase], self.modes, self.c, self.mu_s, self.order
        dense, times, found = solver.dense_output(), np.linspace(t0, solver.t, SAMPLES + 1), []
        values = watch(times, np.ascontiguousarray(dense(times).T), *how)
        for which in range(int(self.bonded), 2 if self.phase != "separation" else 1):

            def near(t, which=which):
                return watch(np.array([t]), dense(t)[None], *how)[0, which]

            def at(t, which=which):
                return watch(np.array([t]), self._fresh(t0, y0, t)[None], *how)[0, which]

            root = self._first(near, times, values[:, which], which)
            if root is not None:
                found.append((polished(near, at, root, t0), which))
        return found

    def _first(self, near, times, v, which):
        """First fall below zero, in the dense output; a function that begins at zero has to rise first."""
        for i in range(1, len(times)):
            if not self.risen[which]:
                self.risen[which] = bool(v[i] > 0)
                continue
            low = times[i] if v[i] < 0 else None
            bend = v[i - 1] - 2 * v[i] + v[i + 1] if low is None and i < SAMPLES else 0.0
            if bend > 0 and v[i] < min(v[i - 1], v[i + 1]) and 8 * v[i] * bend < (v[i + 1] - v[i - 1]) ** 2:
                dip = minimize_scalar(near, bounds=(times[i - 1], times[i + 1]), method="bounded")
                low = dip.x if dip.fun < 0 else None
            if low is not None:
                return times[i - 1] if near(times[i - 1]) <= 0 else brentq(near, times[i - 1], low, xtol=1e-15)
        return None

    # ---- switching
    def _switch(self, kind):
        self.h, speed = FIRST_STEP, 4 * self.modes.shape[1] + 1
        if kind == "separation":
            self._separate(2 if self.rigid else 1)
        elif kind == "reattachment":
            self._hit()
            self._enter(kind, "slip+" if self.y[speed] > 0 else "slip-", [self.rigid, True])
        else:
            self.y[speed] = 0.0
            _, R, T, *_ = self.evaluate("stick")
            if kind == "rest" and abs(T) < self.mu_s * R:
                self._enter("slip_to_stick", "stick", [True, True])
            else:
                kind = "slip_reversal" if kind == "rest" else kind
                self._enter(kind, "slip+" if T > 0 else "slip-", [True, False])

    def _hit(self):
        """The impact of a rigid contact."""
        if self.rigid:
            (_, _, _, _, velocity, slope, _, _), n, y = self.evaluate(), self.modes.shape[1], self.y
            lever = self.c[9] * slope / (self.c[0] * self.c[6] ** 2)
            p = (velocity - y[-1]) / (self.S + 1 / self.c[0] + slope * lever)
            y[2 * n : 4 * n].view(complex)[:] -= p * self.modes[2] * np.exp(-1j * self.modes[0] * y[4 * n])
            y[4 * n + 1] -= p * lever

    def _enter(self, kind, phase, risen):
        """A phase of contact; it is lost at once where nothing presses."""
        came_from, self.phase, self.risen = self.phase, phase, risen
        V, R, *_ = self.evaluate()
        lost = not self.bonded and risen[0] and (R if self.rigid else V) < 0
        if kind != "slip_reversal" or (phase != came_from and not lost):
            self.events.append((self.t, kind))
        if lost:
            self._separate(2 if self.rigid else 0)

    def _separate(self, order):
        """The gap and its first ``order`` rates begin at zero: by Rolle's theorem they return one after another."""
        self.events.append((self.t, "separation"))
        if self.rigid:
            _, _, _, self.y[-2], self.y[-1], *_ = self.evaluate()
        self.phase, self.order, self.risen = "separation", order, [order == 0] * 2


def polished(near, at, t, t0):
    """A root of the dense output made one of the motion, by its slope."""
    width = 1e-3 * (t - t0) + 1e-12
    for _ in range(8):
        step = at(t) * 2 * width / (near(t + width) - near(t - width))
        t = max(t - step, t0)
        if abs(step) <= 2e-16 * (t + 1e-3):
            break
    return t
