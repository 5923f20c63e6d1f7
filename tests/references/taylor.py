"""Reference runs of every contact law, in long double: a Taylor integrator with an event search of
its own.

Nothing here is shared with the engine.  The equations stand as in the model's text: rigid contact
or a contact of compliance ``C`` (m/N), contact force ``vertical`` or ``normal``; quotients are
quotients of series.  A switch is looked for by exclusion: on an interval of middle m and half width
r a polynomial has no root if |p(m)| > sum |p_j(m)| r^j, and at most one if the same holds for its
derivative; else the interval is halved.  Omega and N may change at constant rates, from corner to
corner of a course; u_0 stays that of the first N.

Friction acts on the disc's surface, where a mode has the tangential amplitude t.  The contact
travels over the material at the rate g, the slip speed v = r_0 g is the slider's speed less the
surface's, v_s = sum t beta, and the modes are resolved about the material point of contact, which
lies ``shift`` (rad) behind the slider.  The coefficient of friction falls with v by a hyperbola or an exponential, or
at once, and may grow by a viscous part.

A plate that stretches has the membrane energy V4 of `Stretching`, in products of complex harmonics.
"""

from functools import cache
from itertools import pairwise
from math import comb

import numpy as np
from numpy.polynomial.polynomial import polyval

from disc_model import plate_modes
from disc_model.disc.flexibility import contact_compliance
from tests.references.membrane import Membrane
from tests.references.stored import State, load

LONG = np.longdouble
SAMPLED = ("P", "u", "u_velocity", "w", "w_point", "w_point_velocity", "psi", "psi_velocity")
ORDER = 32
#: Size of the last terms of a step, relative to the motion: below the rounding of 64 bits.
TRUNCATION = 1e-21
#: m/N, of cases with a compliant contact; about the residual flexibility of the nine published modes.
COMPLIANCE = 2.656e-7


class Stretching:
    """Membrane energy sum_n Re(conj(S)^T G^n S), S = z_p z_q for the pairs of the harmonic n, with
    z_0 = a_0, z_l = (a_l - i b_l)/2 and z_-l its conjugate.

    coefficients : pairs (p, q) and the matrix G^n for every n
    l : nodal diameters of the modes, one mode each
    """

    def __init__(self, coefficients, l):
        self.of = {int(x): i for i, x in enumerate(l)}
        self.parts = [(pairs, np.array(G, LONG)) for pairs, G in coefficients]

    def waves(self, a, b):
        """z_p of each harmonic p, of arrays whose last axis is that of the modes."""
        z = {}
        for l, i in self.of.items():
            z[l] = (a[..., i] - 1j * b[..., i]) / 2 if l else a[..., i] + 0j * b[..., i]
            z[-l] = z[l].conj()
        return z

    def forces(self, step, k):
        """Order k of dV4/da and dV4/db; products of lower orders are kept in ``step``."""
        z = self.waves(step.a[: k + 1], step.b[: k + 1])
        along = np.zeros_like(step.a[0])
        across = np.zeros_like(along)
        for i, (pairs, G) in enumerate(self.parts):
            S = np.array([product(z[p], z[q], k) for p, q in pairs])
            kept = step.products.setdefault(i, np.zeros((len(step.a), len(pairs)), np.clongdouble))
            kept[k] = G @ S
            for j, (p, q) in enumerate(pairs):
                W = kept[: k + 1, j].conj()
                for one, other in ((p, q), (q, p)):
                    by_z = 2 * product(W, z[other], k)
                    at = self.of[abs(one)]
                    if one == 0:
                        along[at] += by_z.real
                    else:
                        along[at] += by_z.real / 2
                        # dz/db is -i/2, or i/2 of the conjugate
                        across[at] += np.sign(one) * by_z.imag / 2
        return along, across

    def rest(self, N, s, w2):
        """a of the static start: Newton's method in steps of N, derivatives by differences of a
        cubic, which are exact."""
        a = np.zeros(len(s), LONG)
        for preload in np.linspace(0, 1, 11, dtype=LONG)[1:] * N:
            for _ in range(60):
                left = w2 * a + self._pull(a) + preload * s
                h = LONG(2) ** -30 * max(abs(a).max(), LONG(1e-9))
                slopes = np.diag(w2)
                for i, row in enumerate(np.eye(len(s), dtype=LONG) * h):
                    near = self._pull(a + row) - self._pull(a - row)
                    far = self._pull(a + 2 * row) - self._pull(a - 2 * row)
                    slopes[:, i] += (8 * near - far) / (12 * h)
                change = _solved(slopes, left)
                a = a - change
                if abs(change).max() <= 1e-18 * abs(a).max():
                    break
        return a

    def _pull(self, a):
        step = type("One", (), {"a": a[None], "b": 0 * a[None], "products": {}})
        return self.forces(step, 0)[0]


def _solved(matrix, right):
    """Solution of a linear system in long double, refined from one in double."""
    inverse = np.linalg.inv(matrix.astype(float)).astype(LONG)
    x = inverse @ right
    for _ in range(4):
        x = x + inverse @ (right - matrix @ x)
    return x


class Problem:
    """A case's numbers in long double, from values by the names of `Parameters`, its modes and
    their nodal diameters.

    Omega and N change at rates (rad/s^2, N/s) from the time ``since`` on; ``offset`` is that of
    the friction surface (m), and ``tangential`` the modes' amplitudes there (1/sqrt(kg)) if they do
    not follow from it; ``membrane`` : `Stretching.coefficients`.  A pad's arc is in the
    amplitudes already; ``point`` has those of a single point.
    """

    since = Omega_rate = N_rate = LONG(0)

    def __init__(self, values, omega, psi, l, offset=0.0, tangential=None, membrane=()):
        for name in ("N", "Omega", "m", "k", "c", "k_p", "c_p", "mu_s", "mu_k", "r_0"):
            setattr(self, name, LONG(values[name]))
        self.C = LONG(values.get("contact_compliance", 0))
        self.rigid = self.C == 0
        self.normal = values.get("contact_force") == "normal"
        self.bonded = values.get("contact") in ("bonded", "bilateral")
        self.decay = LONG(values.get("friction_decay", np.inf))
        self.falls = bool(np.isfinite(self.decay)) and self.mu_s > self.mu_k
        self.exponential = values.get("friction_law") == "exponential"
        self.mu_v = LONG(values.get("viscous_friction", 0))

        w = np.array([LONG(x) for x in omega], LONG)
        self.s = np.array([LONG(x) for x in psi], LONG)
        self.l = np.array([LONG(x) for x in l], LONG)
        self.w2 = w * w
        self.d = self._damping(values, w)
        # a pad's amplitudes are means, sin(x) / x of a point's
        half = self.l * LONG(values.get("contact_arc", 0)) / 2
        mean = np.ones_like(half)
        mean[half > 0] = np.sin(half[half > 0]) / half[half > 0]
        self.point = self.s / mean
        if tangential is None:
            self.t = -LONG(offset) / self.r_0 * self.l * self.s
        else:
            self.t = np.array([LONG(x) for x in tangential], LONG)

        self.S2 = (self.s**2).sum()
        self.St = (self.t**2).sum()
        self.stretching = Stretching(membrane, l) if membrane else None
        self.a_0 = -self.N * self.s / self.w2
        if membrane:
            self.a_0 = self.stretching.rest(self.N, self.s, self.w2)
        self.w_0 = (self.s * self.a_0).sum()
        self.u_0 = self.w_0 - self.C * self.N

    def _damping(self, values, w):
        """2 xi omega of each mode, 1/s."""
        disc = values.get("disc")
        ratio = values.get("damping_ratio")
        if disc is not None:
            ratio = [LONG(x) for x in disc["damping_ratio"]]
        if ratio is not None:
            return 2 * np.array(ratio, LONG) * w
        D_star, E, h, nu = (LONG(values[name]) for name in ("D_star", "E", "h", "nu"))
        return D_star / (E * h**3 / 12 / (1 - nu**2)) * self.w2

    def surface_speed(self, beta):
        """v_s, m/s, of modal velocities beta across the path."""
        return (self.t * beta).sum()

    def equilibrium(self):
        """The static start."""
        zero = np.zeros(len(self.s), LONG)
        o = LONG(0)
        return State(o, "stick", 0, o, o, self.u_0, o, self.a_0, zero, zero, zero)


def problem_of(p):
    """`Problem` of disc_model `Parameters`, with the modes of `plate_modes` (amplitudes made
    positive)."""
    modes = plate_modes(p)
    values = p.model_dump() | {"contact_compliance": contact_compliance(p)}
    sign = np.sign(modes["psi"].to_numpy())
    offset, tangential = surface_of(p)
    if tangential is not None:
        tangential = sign * np.array(tangential)
    membrane = stretching_of(p) if p.stretching != "none" else ()
    amplitudes = sign * modes["psi"]
    return Problem(
        values, modes["omega"], amplitudes, modes["diameters"], offset, tangential, membrane
    )


def stretching_of(p):
    """`Stretching.coefficients` of a case without nodal circles, by an own computation."""
    found = Membrane(p, p.stretching)
    parts = []
    for n in range(2 * p.n_diameters + 1):
        pairs, G = found.coefficients(n)
        parts.append((pairs, (G + G.T) / 2))
    return parts


def surface_of(p):
    """Height of friction above the middle plane (m), and amplitudes along the path if the modes'
    table has them."""
    if p.friction_offset != "surface":
        return p.friction_offset, None
    if p.disc is None:
        return (p.h / 2, None)
    return (0.0, p.disc.tangential)


def stored_problem(data):
    """`Problem` of a stored reference, with its own modes or the nine published ones."""
    modes = data.get("modes") or load("C")["modes"]
    return Problem(data["parameters"], modes["omega"], modes["psi"], range(len(modes["omega"])))


# ------------------------------------------------------------------------------------- series
def product(x, y, k):
    """Coefficient k of the product of two series; y may have columns."""
    return x[k::-1] @ y[: k + 1]


class Step:
    """Series of all quantities about one instant.

    a, b, alpha, beta: (ORDER + 1, n); the others (ORDER + 1,): psi, f, g, shift, u, v, and in
    contact V (vertical force on slider and disc), H (horizontal force), R (normal force), T
    (friction); forces are known up to ORDER - 1.  slope is B/r_0.
    """

    def __init__(self, q, phase, direction, state, order=ORDER):
        n = len(q.s)
        K = order
        self.q = q
        self.phase = phase
        self.direction = direction
        self.products = {}
        for name in ("a", "b", "alpha", "beta", "ga"):
            setattr(self, name, np.zeros((K + 1, n), LONG))
        for name in ("a", "b", "alpha", "beta"):
            getattr(self, name)[0] = getattr(state, name)
        scalars = ("psi", "f", "g", "shift", "u", "v", "V", "H", "R", "T", "F", "slope")
        for name in (*scalars, "squared", "fall", "mu", "steep", "pull", "below"):
            setattr(self, name, np.zeros(K + 1, LONG))
        # Omega and N of each order
        self.drive = np.zeros(K + 1, LONG)
        self.load = np.zeros(K + 1, LONG)
        time = LONG(state.time) - q.since
        self.drive[:2] = q.Omega + q.Omega_rate * time, q.Omega_rate
        self.load[:2] = q.N + q.N_rate * time, q.N_rate
        self.psi[0] = state.psi
        self.f[0] = state.f
        self.u[0] = state.u
        self.v[0] = state.u_velocity
        for k in range(K):
            self._order(k)
        self._kinematics(K)

    def _kinematics(self, k):
        """g, B and, where they follow from the disc, f, u and v of order k."""
        q = self.q
        surface = q.surface_speed(self.beta[k])
        if self.phase == "stick":
            self.f[k] = surface / q.r_0
        else:
            self.g[k] = self.f[k] - surface / q.r_0
        self.slope[k] = (q.l * q.s * self.b[k]).sum() / q.r_0
        if q.rigid and self.phase != "separation":
            self.u[k] = (q.s * self.a[k]).sum()
            self.v[k] = (q.s * (self.alpha[k] + q.l * product(self.g, self.b, k))).sum()

    def _order(self, k):
        q = self.q
        self._kinematics(k)
        ga, gb, gp, gq = (product(self.g, x, k) for x in (self.a, self.b, self.alpha, self.beta))
        self.ga[k] = ga
        self.F[k] = q.k_p * self.psi[k] + q.c_p * (self.drive[k] - self.f[k])
        # accelerations without forces, along and across
        along = -q.d * self.alpha[k] - q.w2 * self.a[k] + q.l * gq
        across = -q.d * self.beta[k] - q.w2 * self.b[k] - q.l * gp
        if q.stretching:
            pull_along, pull_across = q.stretching.forces(self, k)
            along = along - pull_along
            across = across - pull_across
        height = q.k * self.u[k] + q.c * self.v[k] + self.load[k] - (q.k * q.u_0 if k == 0 else 0)
        if self.phase != "separation":
            carried = q.l * (gq - q.l * product(self.g, self.ga, k))
            self._forces(k, (q.s * (along + carried)).sum(), q.surface_speed(across), height)

        j = k + 1
        self.a[j] = (self.alpha[k] + q.l * gb) / j
        self.b[j] = (self.beta[k] - q.l * ga) / j
        self.alpha[j] = (along - q.s * self.V[k]) / j
        self.beta[j] = (across + q.t * self.H[k]) / j
        self.psi[j] = (self.drive[k] - self.f[k]) / j
        self.shift[j] = (self.f[k] - self.g[k]) / j
        if self.phase != "stick":
            self.f[j] = (self.F[k] - self.H[k] / q.r_0) / q.m / j
        if not q.rigid or self.phase == "separation":
            self.u[j], self.v[j] = self.v[k] / j, (self.V[k] - height) / q.m / j

    def _forces(self, k, A, G, height):
        """V, H, R and T of order k; A and G: accelerations of the disc's point up and along the
        path, without forces."""
        q = self.q
        vertical = 1 + q.m * q.S2
        horizontal = 1 + q.m * q.St
        self.squared[k] = product(self.slope, self.slope, k)
        one = LONG(k == 0)
        if not q.rigid:
            self.V[k] = ((q.s * self.a[k]).sum() - self.u[k]) / q.C
        if self.phase == "stick":
            self.H[k] = (q.r_0 * self.F[k] - q.m * G) / horizontal
            if q.rigid:
                self.V[k] = (height + q.m * A) / vertical
            if q.normal:
                self.below[k] = one + self.squared[k]
                self._divide(k, self.V[k] + product(self.slope, self.H, k))
                self.T[k] = self.H[k] - product(self.slope, self.R, k)
            else:
                self.R[k], self.T[k] = self.V[k], self.H[k]
            return

        self._friction(k)
        self.steep[k] = product(self.mu, self.slope, k)
        if q.rigid:
            self.pull[k] = q.r_0 * self.F[k] - q.m * G
            top = height + q.m * A + product(self.slope, self.pull, k)
            if q.normal:
                self.below[k] = vertical * (one - self.steep[k])
                self.below[k] += horizontal * (self.steep[k] + self.squared[k])
            else:
                self.below[k] = one * vertical + horizontal * self.steep[k]
        else:
            top = self.V[k]
            self.below[k] = one - (self.steep[k] if q.normal else 0)
        self._divide(k, top)
        self.T[k] = product(self.mu, self.R, k)
        self.V[k], self.H[k] = self.R[k], self.T[k]
        if q.normal:
            self.V[k] -= product(self.slope, self.T, k)
            self.H[k] += product(self.slope, self.R, k)

    def _friction(self, k):
        """Signed coefficient of order k: mu_k + (mu_s - mu_k) fall + mu_v abs(v)."""
        q = self.q
        s = self.direction
        speed = s * q.r_0 * self.g
        if q.falls and q.exponential:
            # fall' = -decay speed' fall
            if k == 0:
                self.fall[0] = np.exp(-q.decay * speed[0])
            else:
                terms = [j * speed[j] * self.fall[k - j] for j in range(1, k + 1)]
                self.fall[k] = -q.decay * sum(terms) / k
        elif q.falls:
            # (1 + decay speed) fall = 1; order k of fall is still zero
            rest = (1 if k == 0 else 0) - q.decay * product(speed, self.fall, k)
            self.fall[k] = rest / (1 + q.decay * speed[0])
        coefficient = (q.mu_s - q.mu_k) * self.fall[k] + q.mu_v * speed[k]
        if k == 0:
            coefficient += q.mu_k
        self.mu[k] = s * coefficient

    def _divide(self, k, top):
        """R of order k from (below R)_k = top; R_k is still zero."""
        self.R[k] = (top - product(self.below, self.R, k)) / self.below[0]

    # -- what a run needs
    def length(self, truncation):
        """Step at which the last terms are below ``truncation`` of the motion."""
        q = self.q
        h = LONG(np.inf)
        groups = [
            (self.alpha, 0),
            (self.beta, 0),
            (self.f, abs(q.Omega)),
            (self.g, abs(q.Omega)),
            (self.a, 0),
            (self.b, 0),
            (self.R, q.N),
        ]
        if not q.rigid or self.phase == "separation":
            groups.append((self.v, 0))
        modal = abs(np.append(self.alpha[0], self.beta[0])).max(initial=0) + (
            q.N * q.s / np.sqrt(q.w2)
        ).max(initial=0)
        for x, usual in groups:
            last = len(x) - (2 if x is self.R else 1)
            scale = max(abs(x[0]).max(initial=0), usual)
            if x is self.alpha or x is self.beta:
                scale = modal
            elif x is self.v:
                scale = max(scale, q.N * ((q.s**2 / np.sqrt(q.w2)).sum() + np.sqrt(q.C / q.m)))
            elif x is self.a or x is self.b:
                scale = modal / np.sqrt(q.w2.max(initial=1))
            for k in (last, last - 1):
                size = abs(x[k]).max(initial=0)
                if size > 0:
                    h = min(h, (LONG(truncation) * scale / size) ** (LONG(1) / k))
        if self.phase == "slip" and q.falls and q.exponential:
            h = self._before_friction_rises(h)
        return h

    def _before_friction_rises(self, h):
        """A step, up to h, in which the slip speed does not fall by more than half where friction has
        fallen: terms of an exponential that rises from almost nothing are all but zero."""
        if self.q.decay * self.q.r_0 * abs(self.g[0]) < 10:
            return h
        changes = abs(self.g[1:])
        orders = np.arange(1, len(self.g))
        while (changes * h**orders).sum() > abs(self.g[0]) / 2:
            h = LONG(0.75) * h
        return h

    def at(self, h):
        """State values at h as a dict."""
        names = ["a", "b", "alpha", "beta", "psi", "f", "shift", "u", "v"]
        return {name: polyval(h, getattr(self, name)) for name in names}


# ------------------------------------------------------------------------------------- roots
@cache
def _pascal(n):
    return np.array([[LONG(comb(j, i)) if j >= i else LONG(0) for j in range(n)] for i in range(n)])


def _about(c, m):
    """Coefficients about m."""
    powers = m ** np.arange(len(c))
    with np.errstate(divide="ignore"):
        return (_pascal(len(c)) @ (c * powers)) / powers


def first_zero(c, h):
    """Smallest t in (0, h] where the polynomial falls below zero, or None; it has to be positive
    just after 0."""
    c = c * h ** np.arange(len(c))
    if c[0] > abs(c[1:]).sum():
        return None
    if c[0] <= 0:
        return LONG(0)
    found = _search(c, LONG(0), LONG(1), 0)
    if found is None:
        return None
    return found * h


def _search(c, left, right, depth):
    m = (left + right) / 2
    r = (right - left) / 2
    here = _about(c, m)
    width = r ** np.arange(len(c))
    if abs(here[0]) > (abs(here[1:]) * width[1:]).sum():
        if here[0] > 0:
            return None
        return left
    slope = here[1:] * np.arange(1, len(c))
    single = abs(slope[0]) > (abs(slope[1:]) * width[1:-1]).sum()
    if single:
        if polyval(left, c) <= 0:
            return left
        if polyval(right, c) > 0:
            return None
        return _bisect(c, left, right)
    if depth > 60:
        if polyval(right, c) <= 0:
            return right
        return None
    found = _search(c, left, m, depth + 1)
    if found is not None:
        return found
    return _search(c, m, right, depth + 1)


def _bisect(c, left, right):
    while True:
        m = (left + right) / 2
        if m in (left, right):
            return m
        if polyval(m, c) > 0:
            left = m
        else:
            right = m


# ------------------------------------------------------------------------------------- the run
class Reference:
    """Event-driven run of a `Problem` from a `State`.

    ``course`` has the corners of Omega and N, (time, Omega, N), from the start on.
    """

    def __init__(self, q, state, truncation=TRUNCATION, course=()):
        self.q = q
        self.truncation = truncation
        self.course = course
        self.events = []
        self.phase = state.phase
        self.direction = int(state.direction)
        self.start = LONG(state.time)
        self.local = LONG(0)
        for name in ("a", "b", "alpha", "beta"):
            setattr(self, name, np.array([LONG(x) for x in getattr(state, name)]))
        self.psi = LONG(state.psi)
        self.f = LONG(state.f)
        self.u = LONG(state.u)
        self.v = LONG(state.u_velocity)
        # known zeros of the slip speed, the gap and the contact force at the start of a phase
        self.divide = {"g": 0, "gap": 0, "R": 0}
        self.shift = LONG(0)

    @property
    def time(self):
        return self.start + self.local

    def state(self):
        modal = [list(x) for x in (self.a, self.b, self.alpha, self.beta)]
        return State(
            self.time, self.phase, self.direction, self.psi, self.f, self.u, self.v, *modal
        )

    def disc(self):
        """w, w' and the slope under the slider."""
        q = self.q
        B = (q.l * q.s * self.b).sum()
        return (q.s * self.a).sum(), (q.s * self.alpha).sum() + self.rate() * B, B

    def rate(self):
        """g, rad/s, at which the contact travels over the material."""
        if self.phase == "stick":
            return LONG(0)
        return self.f - self.q.surface_speed(self.beta) / self.q.r_0

    def forces(self, phase, direction=0):
        """R and T if the phase were this one."""
        step = Step(self.q, phase, direction, self.state(), order=1)
        return step.R[0], step.T[0]

    def sample(self, drive, theta):
        """The quantities `SAMPLED`, now; ``drive`` : angle of the drive point, ``theta`` : of a
        point of the disc."""
        q = self.q
        w, velocity, _ = self.disc()
        turn = q.l * (theta - drive + self.psi + self.shift)
        R, _ = self.forces(self.phase, self.direction)
        held = self.phase != "separation" and q.rigid
        u, u_velocity = (w, velocity) if held else (self.u, self.v)
        along = q.point * np.cos(turn)
        across = q.point * np.sin(turn)
        point = along @ self.a + across @ self.b
        point_velocity = along @ self.alpha + across @ self.beta
        turning = q.Omega + q.Omega_rate * (self.time - q.since) - self.f
        return np.array([R, u, u_velocity, w, point, point_velocity, self.psi, turning], float)

    def run(self, t_end):
        """Advance to the absolute time `t_end`.  Returns self."""
        if not self.course:
            return self._advance(t_end)
        q = self.q
        last = (np.inf, *self.course[-1][1:])
        for corner, following in pairwise([*self.course, last]):
            if self.time < min(following[0], t_end):
                here, there = (np.array(one, LONG) for one in (corner, following))
                q.since, q.Omega, q.N = here
                q.Omega_rate, q.N_rate = (there[1:] - here[1:]) / (there[0] - here[0])
                self._advance(min(following[0], t_end))
        return self

    def _advance(self, t_end):
        end = LONG(t_end) - self.start
        while self.local < end:
            step = Step(self.q, self.phase, self.direction, self.state())
            h = min(step.length(self.truncation), end - self.local)
            found = [
                (t, kind) for kind, c in self._switches(step) if (t := first_zero(c, h)) is not None
            ]
            t, kind = min(found) if found else (h, None)
            shift = self.shift
            for name, value in step.at(t).items():
                setattr(self, name, value)
            self.shift += shift
            self.local += t
            self.divide = {"g": 0, "gap": 0, "R": 0}
            if kind:
                self._switch(kind)
        return self

    def _switches(self, step):
        K = ORDER
        if self.phase == "separation":
            gap = step.u - step.a @ self.q.s
            return [("reattachment", gap[self.divide["gap"] :])]
        R = step.R[self.divide["R"] : K]
        if self.phase == "slip":
            ends = [("rest", self.direction * step.g[self.divide["g"] :])]
        else:
            ends = [
                ("stick_to_slip", self.q.mu_s * step.R[:K] - side * step.T[:K]) for side in (1, -1)
            ]
            # a compliant contact does not pull, though friction may hold where it would
            if not self.q.rigid:
                R = step.V[self.divide["R"] : K]
        if self.q.bonded:
            return ends
        return [("separation", R), *ends]

    # -- switching
    def _enter(self, kind, phase, direction, **divide):
        self.phase = phase
        self.direction = direction
        self.divide = {"g": 0, "gap": 0, "R": 0} | divide
        if phase == "separation":
            P = LONG(0)
        else:
            P = self.forces(phase, direction)[0]
        self.events.append(
            {"time": self.time, "kind": kind, "phase": phase, "psi": self.psi, "f": self.f, "P": P}
        )
        if P < 0 and self.q.rigid and not self.q.bonded:
            self._separate(2)

    def _switch(self, kind):
        if kind in ("stick_to_slip", "rest"):
            self.f = self.q.surface_speed(self.beta) / self.q.r_0
            R, T = self.forces("stick")
            if kind == "rest" and abs(T) < self.q.mu_s * R:
                self._enter("slip_to_stick", "stick", 0)
            else:
                # the slip speed begins at zero; at a release so does its rate if friction does not
                # jump
                steady = self.q.falls or self.q.mu_s == self.q.mu_k
                zeros = 1
                if kind == "stick_to_slip" and steady:
                    zeros = 2
                if kind == "rest":
                    kind = "slip_reversal"
                self._enter(kind, "slip", 1 if T > 0 else -1, g=zeros)
        elif kind == "separation":
            self._separate(3 if self.q.rigid else 1)
        else:
            self._reattach()

    def _separate(self, order):
        if self.q.rigid:
            self.u, self.v, _ = self.disc()
        self._enter("separation", "separation", 0, gap=order)

    def _reattach(self):
        q = self.q
        if q.rigid:
            self._impact()
        if self.rate() == 0:
            raise RuntimeError("a slider that hits the disc at rest is not met in the stored cases")
        if q.rigid:
            zeros = {}
        else:
            zeros = {"R": 1}
        self._enter("reattachment", "slip", 1 if self.rate() > 0 else -1, **zeros)

    def _impact(self):
        """Plastic: the impulse p is vertical, or that of a normal force without friction."""
        q = self.q
        _, velocity, B = self.disc()
        slope = B / q.r_0
        give = q.S2 + 1 / q.m
        if q.normal:
            give += slope**2 * (1 / q.m + q.St)
        p = (velocity - self.v) / give
        self.alpha = self.alpha - q.s * p
        if q.normal:
            self.f = self.f - p * slope / (q.m * q.r_0)
            self.beta = self.beta + q.t * p * slope
        self.u, self.v, _ = self.disc()


def violent_start(scale):
    """The stored state C, its distance from equilibrium times ``scale``, the slider 10 micrometres
    above the disc."""
    given = load("C")["start"]
    modes = load("C")["modes"]
    s = np.array(modes["psi"])
    rest = -385.0 * s / np.array(modes["omega"]) ** 2
    a, b, alpha, beta = (
        scale * np.array(getattr(given, name)) for name in ("a", "b", "alpha", "beta")
    )
    a = a + (1 - scale) * rest
    f = float(given.f)
    velocity = float(s @ alpha + f * (np.arange(len(s)) * s) @ b)
    modal = [x.tolist() for x in (a, b, alpha, beta)]
    return State(0.0, "separation", 0, float(given.psi), f, float(s @ a) + 1e-5, velocity, *modal)
