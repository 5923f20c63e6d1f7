"""docs/verification.csv: every number of it is computed here, by the package and in closed
form."""

import re
from math import acos, atan, cos, pi, sin, sqrt
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.optimize import brentq

from disc_model import Disc, Parameters, continue_cycle, plate_modes, simulate, steady_sliding
from disc_model.simulation.states import State, static_start
from tests.references import block

pytestmark = [
    pytest.mark.compiled,
    pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue"),
]
DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "verification.md").read_text(encoding="utf-8")
NUMBERS = pd.read_csv(DOCS / "verification.csv", dtype=str)


def tables():
    """Of each case of the page: its letter and number, its parameters, its rows."""
    for section in re.split(r"^### ", PAGE, flags=re.MULTILINE)[1:]:
        if code := re.search(r"`(Parameters\(.*?\))`", section, flags=re.DOTALL):
            name = section.split(".")[0]
            p = eval(code[1], {"Parameters": Parameters, "Disc": Disc})
            rows = NUMBERS[NUMBERS["case"] == name].drop(columns="case").to_numpy().tolist()
            yield name, p, rows


def edge(holds, low, high):
    """Where a condition that holds at `low` and not at `high` ceases to."""
    assert holds(low)
    assert not holds(high)
    while high - low > 1e-11 * high:
        middle = (low + high) / 2
        if holds(middle):
            low = middle
        else:
            high = middle
    return low


def times(p, t_end, start=None):
    """Of events, s."""
    return simulate(p, t_end, tol=1e-14, initial_state=start).events["time"].tolist()


# Each function gives what is exact and what the package computes, by the labels of the page; None
# where a number is known in print alone.
def annulus(p):
    """Frequencies over sqrt(D / (rho h)) / b^2: squares of lambda; by the formula, one of them in
    Hz."""
    modes = plate_modes(p)
    unit = sqrt(p.D / (p.rho * p.h)) / p.b**2
    rows = zip(modes["diameters"], modes["circles"], modes["omega"], strict=True)
    squares = {f"({l}, {c})": (None, omega / unit) for l, c, omega in rows}
    return squares | {"(2, 1), Hz": (None, float(modes["omega"].iloc[6]) / (2 * pi))}


def centre(p):
    """Frequencies over h sqrt(E / (rho (1 - nu^2))) / (2 b)^2."""
    modes = plate_modes(p)
    density = p.rho * (1 - p.nu**2)
    speed = sqrt(p.E / density)
    diameter = 2 * p.b
    unit = p.h * speed / diameter**2
    return {
        f"(0, {c})": (None, omega / unit)
        for c, omega in zip(modes["circles"], modes["omega"], strict=True)
    }


def shoe(p):
    """Half a period from stop to stop, each nearer by twice the displacement under friction."""
    start = 8.5e-4
    half = pi / sqrt(p.k_p / p.m)
    states = static_start(p).replace(psi=start / p.r_0)
    run = simulate(p, 5 * half, tol=1e-14, initial_state=states)
    stops = [float(t) for t in run.events["time"][1:]]
    found = {f"stop {j}, s": (j * half, stops[j - 1]) for j in (1, 2, 3, 4)}
    rest = abs(start - 8 * p.mu_k * p.N / p.k_p)
    return found | {"rest, mm": (1e3 * rest, 1e3 * abs(run.final_state.psi) * p.r_0)}


def belt(p):
    """The last slip, stick and period of a second."""
    cycle = block.undamped_stick_slip(p)
    *_, begin, end, again = times(p, 1.0)[-4:]
    slip, stick = sorted([end - begin, again - end], reverse=cycle.slip > cycle.stick)
    return {
        "slip, s": (cycle.slip, slip),
        "stick, s": (cycle.stick, stick),
        "period, s": (cycle.period, slip + stick),
    }


def damped_belt(p):
    """The speed at which the slider, after its first swing, is just as fast as the belt: there it
    sticks no more."""
    found = {}
    for c_p in (0.5, 1.0, 2.0, 5.0):

        def least(Omega, c_p=c_p):
            return block.least_slip_speed(p.replace(Omega=Omega, c_p=c_p))

        def sticks(Omega, c_p=c_p):
            kinds = simulate(p.replace(Omega=Omega, c_p=c_p), 1.0, tol=1e-13).events["kind"]
            return "slip_to_stick" in set(kinds)

        # the rule of thumb for small damping
        about = (p.mu_s - p.mu_k) * p.N / sqrt(2 * pi * c_p * sqrt(p.k_p * p.m)) / p.r_0
        exact = brentq(least, about / 2, 2 * about, xtol=1e-13)
        own = edge(sticks, 0.9 * exact, 1.1 * exact)
        found[f"c_p = {c_p:g} N s/m, rad/s"] = exact, own
    return found


def divergence(p):
    """Both ends of the band, for two springs."""
    (omega,) = p.disc.omega
    (l,) = p.disc.diameters
    (psi,) = p.disc.amplitude
    found = {}
    for k in (1e4, 5e4):
        first = omega / l
        last = sqrt(omega**2 + k * psi**2) / l

        def grows(Omega, k=k):
            # a double root of 1e-16 of omega^2 shows as 3e-5 1/s
            return steady_sliding(p.replace(k=k, Omega=Omega)).growth_rate > 1e-3

        middle = (first + last) / 2
        own = (
            edge(lambda Omega: not grows(Omega), 0.999 * first, middle),
            edge(grows, middle, 1.001 * last),
        )
        for name, exact, value in zip(("begins", "ends"), (first, last), own, strict=True):
            found[f"k = {k:g} N/m, {name}, rad/s"] = exact, value
    return found


def dashpot(p):
    """Growth at three speeds of a disc without damping, and the critical speed of a damped one."""
    (omega,) = p.disc.omega
    (l,) = p.disc.diameters
    (psi,) = p.disc.amplitude

    def growth(Omega, damping):
        """By eigenvalues of one pair of modes; a, b, alpha, beta in the slider's frame."""
        turn = l * Omega
        free = np.array(
            [
                [0, turn, 1, 0],
                [-turn, 0, 0, 1],
                [-(omega**2), 0, -damping, turn],
                [0, -(omega**2), -turn, -damping],
            ]
        )
        free[2] -= p.c * psi**2 * free[0]
        return np.linalg.eigvals(free).real.max()

    def own(Omega, damping):
        ratio = damping / (2 * omega)
        return steady_sliding(
            p.replace(Omega=Omega, disc=p.disc.replace(damping_ratio=[ratio]))
        ).growth_rate

    found = {
        f"{Omega:g} rad/s, 1/s": (growth(Omega, 0.0), own(Omega, 0.0))
        for Omega in (900.0, 915.0, 1000.0)
    }
    exact = brentq(lambda x: growth(x, 0.2), 1.1 * omega / l, 9 * omega / l, xtol=1e-11)
    limit = brentq(lambda x: own(x, 0.2), 0.99 * exact, 1.01 * exact, xtol=1e-11)
    return found | {"growth begins, rad/s": (exact, limit)}


def impact(p):
    """Fall, impact, a piece of a harmonic motion together, a flight."""
    (omega,) = p.disc.omega
    (psi,) = p.disc.amplitude
    # masses of the disc's mode, and of both
    g = p.N / p.m
    height = 0.02
    mass = 1 / psi**2
    M = p.m + 1 / psi**2
    t1 = sqrt(2 * height / g)
    impulse = p.m * mass / M * g * t1
    # together: w = (cos - 1) N/K - v/w sin; contact ends where w'' = -g
    K = mass * omega**2
    w = omega * sqrt(mass / M)
    rest = p.N / K
    speed = impulse / mass

    def height_of(t):
        angle = w * t
        size = speed / w
        return rest * (cos(angle) - 1) - size * sin(angle)

    # of height_of(t) + rest, a cosine
    size = np.hypot(rest, speed / w)
    phase = atan(speed / (w * rest))
    t2 = (2 * pi - acos(g / (w**2 * size)) - phase) / w
    x = height_of(t2)
    v = -rest * w * sin(w * t2) - speed * cos(w * t2)

    def gap(t):
        angle = omega * t
        falling = x + v * t - g * t**2 / 2
        size = v / omega
        vibrating = x * np.cos(angle) + size * np.sin(angle)
        return falling - vibrating

    flight = np.arange(1e-4, 1.0, 1e-4)
    back = flight[np.argmax(gap(flight) < 0)]
    t3 = brentq(gap, back - 1e-4, back, xtol=1e-16)
    start = static_start(p)
    still = np.zeros(1)
    fall = start.replace(phase="separation", a=still, alpha=still, u=height, u_velocity=0.0)
    events = simulate(p, 1.01 * (t1 + t2 + t3), tol=1e-14, initial_state=fall).events
    own = [*events["time"][:3], events["P"][0]]
    exact = t1, t1 + t2, t1 + t2 + t3, p.N * mass / M
    names = "impact, s", "contact lost, s", "next impact, s", "force after the impact, N"
    return {name: pair for name, *pair in zip(names, exact, own, strict=True)}


def bounce(p):
    """Fall, contact and flight."""
    w = 1 / sqrt(p.m * p.contact_compliance)
    found = {}
    for height in (1e-3, 1e-2):
        v = sqrt(2 * height * p.N / p.m)
        fall = v * p.m / p.N
        contact = 2 * (pi - atan(v / (w * p.N * p.contact_compliance))) / w
        flight = 2 * v * p.m / p.N
        none = np.zeros(0)
        start = State(0.0, "separation", 0, 0.0, 0.0, height, 0.0, none, none, none, none)
        own = times(p, fall + contact + 1.01 * flight, start)[:3]
        exact = fall, fall + contact, fall + contact + flight
        for name, *pair in zip(("touches", "leaves", "touches again"), exact, own, strict=True):
            found[f"from {1e3 * height:g} mm, {name}, s"] = pair
    return found


def falling_friction(p):
    """A cycle from release to release, of slip by a method of Runge and Kutta."""
    speed = p.r_0 * p.Omega
    release = p.mu_s * p.N / p.k_p
    end, rest, _ = block.slip_until(p, release, 0.0, lambda _, v, __: v, -1)
    turn, largest, _ = block.slip_until(p, release, 0.0, lambda _, v, __: v - speed, 1)
    stick = (release - rest) / speed
    run = simulate(p, release / speed + 1.01 * (end + stick), tol=1e-14)
    start, halt, again = run.events["time"][:3]
    stopped = p.r_0 * run.events["psi"][1]
    # a state at the turn: from there the largest displacement is missed by the square of the turn's
    # error
    near = simulate(p, start + turn, tol=1e-14).final_state
    exact = end, rest, stick, end + stick, largest
    own = halt - start, stopped, again - halt, again - start, p.r_0 * near.psi
    names = (
        "slip, s",
        "displacement at the stop, m",
        "stick, s",
        "period, s",
        "largest displacement, m",
    )
    return {name: pair for name, *pair in zip(names, exact, own, strict=True)}


def hopf(p):
    """Speed, m/s, at which steady sliding becomes stable: where the growth rate vanishes."""
    exact = block.hopf_speed(p)

    def growth(speed):
        return steady_sliding(p.replace(Omega=speed / p.r_0)).growth_rate

    return exact, brentq(growth, 0.9 * exact, 1.1 * exact, xtol=1e-15, rtol=1e-14)


def stribeck(p):
    """Hopf speed, displacement in steady sliding, and the speed at which stick-slip ends: there the
    least slip speed after a release is zero."""
    speed = 0.22
    fast = p.replace(Omega=speed / p.r_0)
    displacement = p.N * block.friction_coefficient(p, speed) / p.k_p
    own = p.r_0 * steady_sliding(fast).psi

    def stops(Omega):
        return block.least_slip_speed(p.replace(Omega=Omega)) < 0

    end = p.r_0 * edge(stops, p.Omega, 2 * p.Omega)
    branch = continue_cycle(p, "Omega", (p.Omega, 2 * p.Omega))
    return {
        "Hopf speed, m/s": hopf(p),
        "displacement at 0.22 m/s, m": (displacement, own),
        "end of stick-slip, m/s": (end, p.r_0 * branch.values.max()),
    }


def basin(p):
    """Hopf speed, and shares of starts from -2 to 2 m and 0 to 2 m/s that come to steady sliding."""
    shares = {}
    for speed in (1.25, 1.4, 1.55, 1.7):
        share = share_of_sliding(p.replace(Omega=speed / p.r_0))
        shares[f"share that slides on, {speed:g} m/s"] = (None, share)
    return {"Hopf speed, m/s": hopf(p)} | shares


def share_of_sliding(p, columns=24, rows=23, t_end=150.0):
    """Share of starts on a grid after which the slider has not stuck in the last fifth."""
    rest = static_start(p)
    sliding = 0
    for stretch in -2 + 4 * (np.arange(columns) + 0.5) / columns:
        for velocity in 2 * (np.arange(rows) + 0.5) / rows:
            f = p.Omega - velocity / p.r_0
            start = rest.replace(psi=stretch / p.r_0, f=f, phase="slip", direction=int(np.sign(f)))
            found = simulate(p, t_end, initial_state=start).events["time"]
            sliding += len(found) == 0 or found.iloc[-1] < 0.8 * t_end
    return sliding / (columns * rows)


COMPUTED = {
    "E1": annulus, "E1b": centre, "E2": shoe, "E3": belt, "E4": damped_belt, "E5": divergence, "E6": dashpot,
    "E7": impact, "E8": bounce, "E9": falling_friction,
    "E9b": stribeck, "E9c": basin,
}  # fmt: skip


def says(text, value):
    """Whether a number of the page is the value, rounded to as many digits, up to noise in the
    last."""
    digits = text.partition("e")[0].partition(".")[2]
    return abs(float(text) - value) <= 0.6 * 10.0 ** -len(digits) * 10.0 ** int(
        text.partition("e")[2] or 0
    )


@pytest.mark.parametrize(
    ("name", "p", "rows"), [pytest.param(*case, id=case[0]) for case in tables()]
)
def test_the_page_says_what_is_computed(name, p, rows):
    """Exact numbers and ours, to the last digit shown; and their relative difference is below what
    the page says."""
    found = COMPUTED[name](p)
    assert [row[0] for row in rows] == list(found)
    for (label, reference, ours, allowed), (exact, own) in zip(rows, found.values(), strict=True):
        assert says(ours, own), (label, own)
        assert exact is None or says(reference.rstrip("*"), exact), (label, exact)
        difference = abs(own / (float(reference.rstrip("*")) if exact is None else exact) - 1)
        assert difference < float(allowed), (label, difference)
        # nor is more allowed than needed, down to the rounding of eigenvalues
        assert float(allowed) <= max(10 * difference, 1e-8), (label, difference)


def test_the_page_has_every_case():
    assert [name for name, *_ in tables()] == list(COMPUTED)
