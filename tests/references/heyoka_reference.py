"""High-precision reference event times from heyoka (a development dependency only).

The slider-frame equations are advanced by heyoka's Taylor integrator in 64-bit (or 53-bit) mantissa; the
switches are found here as roots of heyoka's own Taylor coefficients, by Bernstein subdivision, so no
crossing inside a step can be missed. The contact force enters as an extra variable J with J' = P, whose
coefficients give those of P. At a separation the known root of the gap (t^3 when it begins at P = 0, t^2
when P was negative after an impact) is divided out of the first step's series, and t out of f where a slip
begins from rest: there is no guard interval.

Regenerate the stored data (about five minutes)::

    python -m tests.references.heyoka_reference
"""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache
from math import comb

import heyoka as hy
import numpy as np
from numpy.polynomial.polynomial import polyval

from tests.references.modes import modes_mpmath
from tests.references.stored import BASE, DATA, Case, State, rounded

LONG = np.longdouble


# -------------------------------------------------------------------------- the model
def equilibrium(case, real=LONG):
    q = case.numbers(real)
    n, o = len(q["omega"]), real(0)
    a = [-q["N"] * s / (w * w) for s, w in zip(q["shape"], q["omega"], strict=True)]
    return State(o, "stick", 0, o, o, q["u_0"], o, a, [o] * n, [o] * n, [o] * n)


def equations(case, phase, real):
    """heyoka system of `phase`; par[0] is the slip direction. Order: a, alpha, b[1:], beta[1:], psi, f, then
    J or u, v.

    In contact u is sum psi a and is no variable. In `stick`, f stays 0.
    """
    q = case.numbers(real)
    n = len(q["omega"])

    def const(x):
        return hy.expression(real(x))

    a = hy.make_vars(*[f"a{i}" for i in range(n)])
    alpha = hy.make_vars(*[f"p{i}" for i in range(n)])
    b = [None, *hy.make_vars(*[f"b{i}" for i in range(1, n)], "unused")[:-1]]
    beta = [None, *hy.make_vars(*[f"q{i}" for i in range(1, n)], "unused")[:-1]]
    psi, f, J, u, v = hy.make_vars("psi", "f", "J", "u", "v")
    rate = f if phase != "stick" else const(0)
    ordinal = [const(l) for l in range(n)]
    s, w2, d = q["shape"], [w * w for w in q["omega"]], q["damping"]
    F = const(q["k_p"]) * psi + const(q["c_p"]) * (const(q["Omega"]) - rate)

    free = [-const(d[i]) * alpha[i] - const(w2[i]) * a[i] for i in range(n)]
    cross = [None] + [ordinal[i] * rate for i in range(1, n)]
    disc_u = hy.sum([const(s[i]) * a[i] for i in range(n)])
    if phase == "separation":
        P = const(0)
        f_rate = F / const(q["m"])
    else:
        B = hy.sum([const(i * s[i]) * b[i] for i in range(1, n)])
        A = hy.sum([const(s[i]) * free[i] for i in range(n)])
        velocity = hy.sum([const(s[i]) * alpha[i] for i in range(n)])
        if phase == "slip":
            A = A + rate * hy.sum([const(2 * i * s[i]) * beta[i] for i in range(1, n)])
            A = A - rate * rate * hy.sum([const(i * i * s[i]) * a[i] for i in range(1, n)])
            velocity = velocity + rate * B
        m = const(q["m"])
        top = const(q["N"]) + const(q["k"]) * (disc_u - const(q["u_0"])) + const(q["c"]) * velocity + m * A
        bottom = const(real(1) + q["m"] * q["S2"])
        if phase == "slip":
            P = (top + B * F) / (bottom + hy.par[0] * const(q["mu_k"] / q["r_0"]) * B)
            f_rate = F / m - hy.par[0] * const(q["mu_k"] / (q["m"] * q["r_0"])) * P
        else:
            P = top / bottom
            f_rate = const(0)

    system = [(a[i], alpha[i] + (cross[i] * b[i] if i else const(0))) for i in range(n)]
    system += [(alpha[i], free[i] + (cross[i] * beta[i] if i else const(0)) - const(s[i]) * P) for i in range(n)]
    system += [(b[i], beta[i] - cross[i] * a[i]) for i in range(1, n)]
    system += [(beta[i], -const(d[i]) * beta[i] - const(w2[i]) * b[i] - cross[i] * alpha[i]) for i in range(1, n)]
    system += [(psi, const(q["Omega"]) - rate), (f, f_rate)]
    if phase == "separation":
        height = const(q["N"]) + const(q["k"]) * (u - const(q["u_0"])) + const(q["c"]) * v
        system += [(u, v), (v, -height / const(q["m"]))]
    else:
        system += [(J, P)]
    return system


# -------------------------------------------------------------------------- roots
@cache
def bernstein_matrix(degree, real):
    rows, columns = range(degree + 1), range(degree + 1)
    return np.array([[real(comb(i, j)) / real(comb(degree, j)) for j in columns] for i in rows])


def first_root(c, h):
    """Smallest t in (0, h] where the polynomial sum c_j t^j, positive at 0, reaches zero, or None."""
    scaled = c * h ** np.arange(len(c))
    if scaled[0] <= 0:
        return h * 0
    if scaled[0] + np.minimum(scaled[1:], 0).sum() > 0:
        return None
    return _leftmost(bernstein_matrix(len(c) - 1, c.dtype.type) @ scaled, h * 0, h, c, 0)


def _leftmost(control, left, right, c, depth):
    if control.min() > 0:
        return None
    changes = int((np.diff(np.signbit(control)) != 0).sum())
    if changes == 1 and control[-1] <= 0:
        return _bisect(c, left, right)
    if depth > 60:  # a touch of zero finer than the numbers resolve
        return right
    rows, left_half, right_half = control.copy(), [control[0]], [control[-1]]
    for _ in range(len(control) - 1):
        rows = (rows[1:] + rows[:-1]) / 2
        left_half.append(rows[0])
        right_half.append(rows[-1])
    middle = (left + right) / 2
    found = _leftmost(np.array(left_half), left, middle, c, depth + 1)
    return found if found is not None else _leftmost(np.array(right_half[::-1]), middle, right, c, depth + 1)


def _bisect(c, left, right):
    for _ in range(80):
        middle = (left + right) / 2
        if middle in (left, right):
            break
        if polyval(middle, c) > 0:
            left = middle
        else:
            right = middle
    return (left + right) / 2


# -------------------------------------------------------------------------- the phase machine
class Reference:
    """Event-driven run from a State; `tol` 1e-21 in long double puts truncation far below rounding."""

    def __init__(self, case, state, real=LONG, tol=1e-21):
        self.real, self.q = real, case.numbers(real)
        self.n = len(case.omega)
        self.shape = np.array(self.q["shape"], dtype=real)
        self.ordinal = np.arange(self.n).astype(real)
        self.lanes = {
            phase: hy.taylor_adaptive(
                equations(case, phase, real),
                [real(0)] * (4 * self.n + (2 if phase == "separation" else 1)),
                tol=real(tol),
                fp_type=real,
            )
            for phase in ("stick", "slip", "separation")
        }
        self.events: list[dict] = []
        self.start_time, self.local = LONG(state.time), self.real(0)
        self.phase, self.direction = state.phase, int(state.direction)
        array = lambda x: np.array([self.real(y) for y in x], dtype=self.real)  # noqa: E731
        self.a, self.b, self.alpha, self.beta = map(array, (state.a, state.b, state.alpha, state.beta))
        self.psi, self.f = self.real(state.psi), self.real(state.f)
        self.u, self.v = self.real(state.u), self.real(state.u_velocity)
        self.divide = {"f": 0, "gap": 0}
        self._load()

    # -- state in and out
    def state(self):
        """The current State."""
        if self.phase != "separation":
            self.u = (self.shape * self.a).sum()
            self.v = self.disc_velocity()
        modal = [list(x) for x in (self.a, self.b, self.alpha, self.beta)]
        return State(self.time, self.phase, self.direction, self.psi, self.f, self.u, self.v, *modal)

    @property
    def time(self):
        return self.start_time + LONG(self.local)

    def _load(self):
        lane = self.lanes[self.phase]
        tail = [self.u, self.v] if self.phase == "separation" else [self.real(0)]
        lane.state[:] = np.concatenate([self.a, self.alpha, self.b[1:], self.beta[1:], [self.psi, self.f], tail])
        if self.phase == "slip":
            lane.pars[0] = self.real(self.direction)
        lane.time = self.real(0)

    def _unload(self, x):
        n, zero = self.n, np.zeros(1, dtype=self.real)
        self.a, self.alpha = x[:n].copy(), x[n : 2 * n].copy()
        self.b = np.concatenate([zero, x[2 * n : 3 * n - 1]])
        self.beta = np.concatenate([zero, x[3 * n - 1 : 4 * n - 2]])
        self.psi, self.f = x[4 * n - 2], x[4 * n - 1]
        if self.phase == "separation":
            self.u, self.v = x[4 * n], x[4 * n + 1]

    # -- formulas at an instant
    def disc_velocity(self):
        return (self.shape * (self.alpha + self.ordinal * self.f * self.b)).sum()

    def spring(self):
        q = self.q
        return q["k_p"] * self.psi + q["c_p"] * (q["Omega"] - self.f)

    def contact_force(self, direction):
        """P with f as it is; direction 0 is stick."""
        q, s, l = self.q, self.shape, self.ordinal
        damping, w2 = np.array(q["damping"], dtype=self.real), np.array(q["omega"], dtype=self.real) ** 2
        A = (s * (-damping * self.alpha - w2 * self.a + 2 * l * self.f * self.beta - l**2 * self.f**2 * self.a)).sum()
        B = (l * s * self.b).sum()
        top = q["N"] + q["k"] * ((s * self.a).sum() - q["u_0"]) + q["c"] * self.disc_velocity() + q["m"] * A
        bottom = 1 + q["m"] * q["S2"]
        if direction:
            return (top + B * self.spring()) / (bottom + direction * q["mu_k"] * B / q["r_0"])
        return top / bottom

    # -- one step
    def advance(self, t_end):
        """One step, cut at the first switch or at local time `t_end`; returns the switch or None."""
        lane = self.lanes[self.phase]
        if self.phase != "separation":
            lane.state[-1] = self.real(0)
        lane.step(max_delta_t=self.real(t_end - self.local), write_tc=True)
        h, tc = self.real(lane.last_h), lane.tc
        found = [(t, kind) for kind, t in self._switches(tc, h) if t is not None]
        if not found:
            self._unload(lane.state)
            self.local += h
            self.divide = {"f": 0, "gap": 0}
            return None
        t, kind = min(found)
        self._unload(polyval(t, tc.T))
        self.local += t
        return kind

    def _switches(self, tc, h):
        q, n = self.q, self.n
        if self.phase == "separation":
            gap = tc[4 * n] - (self.shape[:, None] * tc[:n]).sum(axis=0)
            return [("reattachment", first_root(gap[self.divide["gap"] :], h))]
        P = tc[-1, 1:] * np.arange(1, tc.shape[1]).astype(self.real)
        switches = [("separation", first_root(P, h))]
        if self.phase == "stick":
            pull = q["k_p"] * tc[4 * n - 2, :-1]
            pull[0] += q["c_p"] * q["Omega"]
            for sign in (1, -1):
                margin = q["mu_s"] * P - sign * q["r_0"] * pull
                switches.append(("stick_to_slip", first_root(margin, h)))
        else:
            switches.append(("rest", first_root(self.direction * tc[4 * n - 1][self.divide["f"] :], h)))
        return switches

    # -- switching
    def _enter(self, kind, phase, direction, divide=None):
        self.phase, self.direction = phase, direction
        self.divide = {"f": 0, "gap": 0} | (divide or {})
        P = self.real(0) if phase == "separation" else self.contact_force(direction)
        self.events.append({"time": self.time, "kind": kind, "phase": phase, "psi": self.psi, "f": self.f, "P": P})
        self._load()

    def switch(self, kind):
        if kind == "stick_to_slip":
            self.f = self.real(0)
            self._enter(kind, "slip", 1 if self.spring() > 0 else -1, {"f": 1})
        elif kind == "rest":
            self.f = self.real(0)
            if self.q["r_0"] * abs(self.spring()) < self.q["mu_s"] * self.contact_force(0):
                self._enter("slip_to_stick", "stick", 0)
            else:
                self._enter("slip_reversal", "slip", 1 if self.spring() > 0 else -1, {"f": 1})
        elif kind == "separation":
            self._separate(3)
        else:
            self._reattach()

    def _separate(self, order):
        self.u, self.v = (self.shape * self.a).sum(), self.disc_velocity()
        self._enter("separation", "separation", 0, {"gap": order})

    def _reattach(self):
        p = (self.disc_velocity() - self.v) / (self.q["S2"] + 1 / self.q["m"])
        self.alpha = self.alpha - self.shape * p
        if self.f == 0:
            raise RuntimeError("impact at rest: not met in the stored cases")
        self._enter("reattachment", "slip", 1 if self.f > 0 else -1)
        if self.contact_force(self.direction) < 0:
            self._separate(2)

    # -- runs
    def run(self, t_end, stop_at=None):
        """Advance to absolute time `t_end`, or to the first event of kind `stop_at`. Returns self."""
        local_end = self.real(LONG(t_end) - self.start_time)
        while self.local < local_end:
            kind = self.advance(local_end)
            if kind:
                self.switch(kind)
                if stop_at == self.events[-1]["kind"]:
                    break
        return self


# -------------------------------------------------------------------------- stored data
def published_case(N, Omega):
    omega, psi = modes_mpmath(BASE)
    return Case(N, Omega, [float(x) for x in omega], [float(x) for x in psi])


def decimal(x, digits=20):
    return np.format_float_positional(LONG(x), precision=digits, unique=False)


def repeated(case, start, t_end):
    """A run, and by how many s one of another order and step size differs."""
    run, check = (Reference(case, start, tol=tol).run(t_end) for tol in (1e-21, 1e-23))
    if [e["kind"] for e in run.events] != [e["kind"] for e in check.events]:
        raise RuntimeError("two long-double runs disagree")
    return run, float(max(abs(x["time"] - y["time"]) for x, y in zip(run.events, check.events, strict=True)))


def parameters_of(case):
    return {"N": case.N, "Omega": case.Omega} | case.base


def modes_of(case):
    return {"circles": [0] * 5, "diameters": list(range(5)), "omega": case.omega, "psi": case.psi}


def _record(name, case, start, t_end):
    """Write data/<name>.json."""
    run, difference = repeated(case, start or equilibrium(case), t_end)
    data = {
        "parameters": parameters_of(case),
        "modes": modes_of(case),
        "start": None if start is None else vars(start),
        "t_end": t_end,
        "largest_difference_to_check_run": difference,
        "events": [
            {"time": float(e["time"]), "time_decimal": decimal(e["time"]), "kind": e["kind"], "phase": e["phase"]}
            | {name: float(e[name]) for name in ("psi", "f", "P")}
            for e in run.events
        ],
    }
    DATA.mkdir(exist_ok=True)
    (DATA / f"{name}.json").write_text(json.dumps(data, indent=1) + "\n")
    print(name, len(run.events), difference)


def sensitivity(case, t_guess=60.0):
    """Shift (s) of the first separation when one omega or psi is one unit in the last place larger."""
    base = Reference(case, equilibrium(case)).run(t_guess, stop_at="separation").events[-1]["time"]
    shifts = {}
    for name in ("omega", "psi"):
        for l in range(len(case.omega)):
            values = list(getattr(case, name))
            values[l] = float(np.nextafter(values[l], np.inf))
            other = replace(case, **{name: values})
            last = Reference(other, equilibrium(other)).run(t_guess, stop_at="separation").events[-1]["time"]
            shifts[f"{name}_{l}"] = float(last - base)
    return shifts


def wild_start(case, base, rng):
    """A separated state of violent vibration: crowded switches, impacts with P < 0 after them, reversals."""
    scale, n = rng.uniform(0.2, 3), len(case.omega)
    a, b = np.array(base.a) * scale * rng.normal(1, 0.3, n), np.array(base.b) * scale * rng.normal(1, 5, n)
    alpha, beta = (np.array(x) * scale * rng.normal(0, 4, n) for x in (base.alpha, base.beta))
    height = float(np.dot(case.psi, a)) + 1e-3 * abs(rng.normal())
    psi, f, fall = 0.03 * rng.normal(), 25 * rng.normal(), rng.normal()
    return rounded(
        State(0.0, "separation", 0, float(psi), float(f), height, float(fall), *map(list, (a, b, alpha, beta)))
    )


WILD = {"N": 100.0, "Omega": 3.0, "mu_s": 0.06, "mu_k": 0.04, "c": 2.0, "c_p": 0.3, "D_star": 2e-5}


def regenerate_wild(base, runs=16, t_end=0.2, seed=1):
    """data/wild.json: short runs from violent starts, half of them with little friction and all dampers."""
    rng, groups = np.random.default_rng(seed), []
    published = published_case(385.0, 15.1)
    damped = {k: v for k, v in WILD.items() if k not in ("N", "Omega")}
    slippery = Case(WILD["N"], WILD["Omega"], published.omega, published.psi, BASE | damped)
    for case in (published, slippery):
        stored = []
        for _ in range(runs):
            start = wild_start(case, base, rng)
            run, difference = repeated(case, start, t_end)
            stored.append(
                {
                    "start": vars(start),
                    "largest_difference_to_check_run": difference,
                    "kinds": [e["kind"] for e in run.events],
                    "times": [decimal(e["time"]) for e in run.events],
                }
            )
        groups.append({"parameters": parameters_of(case), "t_end": t_end, "runs": stored})
        worst = max(r["largest_difference_to_check_run"] for r in stored)
        print("wild", sum(len(r["times"]) for r in stored), worst)
    (DATA / "wild.json").write_text(json.dumps({"modes": modes_of(published), "groups": groups}, indent=None) + "\n")


def regenerate():
    """Compute and store everything below data/, each run repeated with another order and step size."""
    _record("A", published_case(385.0, 15.1), None, 1.0)
    _record("B", published_case(300.0, 20.0), None, 1.0)
    case = published_case(385.0, 15.1)
    run, check = (Reference(case, equilibrium(case), tol=tol).run(54.4) for tol in (1e-21, 1e-23))
    start = rounded(run.state())
    _record("C", case, start, 55.4)
    regenerate_wild(start)

    times = {"long_double": run, "long_double_check": check}
    times |= {
        f"double_{tol:g}": Reference(case, equilibrium(case, np.float64), np.float64, tol) for tol in (1e-17, 1e-19)
    }
    found = {name: one.run(60.0, stop_at="separation") for name, one in times.items()}
    data = {
        "parameters": parameters_of(case),
        "modes": modes_of(case),
        "events_before": len(run.events) - 1,
        "time": float(run.events[-1]["time"]),
        "time_decimal": {name: decimal(one.events[-1]["time"]) for name, one in found.items()},
        "shift_per_unit_in_last_place": sensitivity(case),
    }
    (DATA / "first_separation.json").write_text(json.dumps(data, indent=1) + "\n")
    print("first separation", data["time_decimal"], data["shift_per_unit_in_last_place"])


if __name__ == "__main__":
    regenerate()
