"""Random admissible cases with ramps, from any start: against the long-double reference."""

import math

import numpy as np
import pytest

from disc_model import Execution, Parameters, Ramp, Window, plate_modes, simulate
from disc_model.disc.flexibility import contact_compliance
from disc_model.simulation.states import static_start, surface_rate
from tests.contact_laws import course_of, turned
from tests.references import stored, taylor

pytestmark = [pytest.mark.slow, pytest.mark.compiled]

CASES = 200
RADIANS = 400
"""Of the fastest oscillation: how long a case is followed."""
SAMPLES = 48
ROUGH = 1e-13
"""Truncation of a second run of the reference, which shows what becomes of errors as small as the engine's."""


def spread(rng, low, high):
    """Evenly over the logarithm."""
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def drawn_case(rng):
    """All fields of `Parameters`; many are sometimes zero."""

    def sometimes(share, value, otherwise=0.0):
        if rng.random() < share:
            return value
        return otherwise

    a = rng.uniform(0.03, 0.06)
    mu_k = sometimes(0.9, rng.uniform(0, 0.6))
    b = a + rng.uniform(0.03, 0.1)
    mu_s = mu_k + sometimes(0.8, rng.uniform(0.01, 0.6))
    give = str(rng.choice(["rigid", "number", "residual"], p=[0.5, 0.3, 0.2]))
    # as published the residual flexibility is a sum of a thousand modes, which takes seconds
    if give == "residual":
        normalization = "orthonormal"
    else:
        normalization = str(rng.choice(["as_published", "orthonormal"]))
    p = Parameters(
        N=spread(rng, 20, 1000), Omega=spread(rng, 2, 60), c=sometimes(0.5, spread(rng, 1e-2, 10)),
        # without kinetic friction an undamped slider comes to rest where stick is just not
        # possible, or just possible; with equal coefficients it swings back to rest where it has
        # just begun to slip
        c_p=sometimes(0.5 if 0 < mu_k < mu_s else 1.0, spread(rng, 1e-2, 10)),
        k=sometimes(0.8, spread(rng, 5e3, 5e5)), k_p=spread(rng, 2e3, 2e5), E=spread(rng, 30e9, 300e9),
        m=spread(rng, 0.01, 1), mu_k=mu_k, mu_s=mu_s, a=a, b=b, r_0=a + rng.uniform(0.3, 1) * (b - a),
        h=spread(rng, 1e-3, 5e-3), nu=rng.uniform(-0.2, 0.45), rho=spread(rng, 2000, 9000),
        n_diameters=int(rng.choice([-1, 0, 1, 1, 1, 2, 2, 3, 4, 5])), n_circles=int(rng.choice([0, 0, 0, 0, 1, 2])),
        normalization=normalization, contact=str(rng.choice(["unilateral", "unilateral", "unilateral", "bilateral"])),
        contact_compliance={"rigid": 0.0, "number": spread(rng, 1e-7, 1e-5), "residual": "residual"}[give],
        contact_force=str(rng.choice(["vertical", "normal"])), contact_arc=sometimes(0.3, rng.uniform(0.02, 1.0)),
        friction_offset=rng.choice(np.array([0.0, spread(rng, 1e-4, 1e-2), "surface"], object), p=[0.6, 0.25, 0.15]),
    )  # fmt: skip
    if blocks(p) == 1:  # see `drawn_ramps`
        p = p.replace(
            friction_law=str(rng.choice(["hyperbolic", "exponential"])),
            friction_decay=sometimes(0.4, spread(rng, 0.3, 100), math.inf),
            viscous_friction=sometimes(0.3, spread(rng, 1e-4, 3e-2)),
        )
    # damping ratio of the fastest mode: beyond, an explicit integrator takes ever smaller steps
    ratio = sometimes(0.8, spread(rng, 1e-5, 0.3))
    return p.replace(
        D_star=2 * ratio * p.D / (plate_modes(p)["omega"].max() if p.n_diameters >= 0 else 1.0)
    )


def blocks(p):
    """Blocks of lanes that the pairs of modes fill."""
    return 1 if p.n_diameters * (p.n_circles + 1) <= 4 else 2


def varies(p):
    """Whether friction depends on the slip speed."""
    return p.viscous_friction > 0 or (math.isfinite(p.friction_decay) and p.mu_s > p.mu_k)


def fastest(p):
    """Fastest oscillation, rad/s."""
    modes = plate_modes(p)
    found = max(modes["omega"].max() if len(modes) else 0.0, math.sqrt(max(p.k, p.k_p) / p.m))
    give = contact_compliance(p)
    if give:
        return max(found, math.sqrt((1 / p.m + float(modes["psi"] @ modes["psi"])) / give))
    return found


def drawn_ramps(rng, p, span):
    """None, or one or two."""
    names = [str(name) for name in rng.permutation(["Omega", "N"])[: rng.choice([0, 0, 1, 2])]]
    other_contact = p.contact_compliance != 0 or p.contact_force == "normal"
    if varies(p) or (blocks(p) > 1 and other_contact):
        names = []  # kernels more that would be compiled for a minute each
    ramps = []
    for name in names:
        begin = span * rng.uniform(0, 0.6)
        end = begin + span * rng.uniform(0.1, 0.6)
        ramps.append(
            Ramp(parameter=name, to=getattr(p, name) * rng.uniform(0.5, 1.5), start=begin, end=end)
        )
    return tuple(ramps)


def drawn_start(rng, p, time):
    """The static start, or any motion in any phase, in the slider's frame; contact is as its law
    says."""
    rest = static_start(p).replace(time=time)
    phase = str(rng.choice(["rest", "stick", "slip", "slip", "separation"]))
    if phase == "rest" or (phase == "separation" and p.contact == "bilateral"):
        return rest
    modes = plate_modes(p)
    direction = 0
    if phase == "slip":
        direction = int(rng.choice([-1, 1]))
    psi, omega, l = (modes[name].to_numpy() for name in ("psi", "omega", "diameters"))
    pair = l > 0
    size = np.abs(p.N * psi / omega**2)
    # over the material under the slider
    rate = {
        "stick": 0.0,
        "slip": direction * spread(rng, 0.1, 3) * p.Omega,
        "separation": rng.normal() * 2 * p.Omega,
    }[phase]
    angle = rng.uniform(-1.2, 1.2) * p.mu_s * p.N / (p.r_0 * p.k_p)
    lively = spread(rng, 0.03, 3)
    give = contact_compliance(p)
    for _ in range(20):
        a, b, alpha, beta = (lively * size * rng.normal(size=len(psi)) for _ in range(4))
        a = rest.a + a
        b = b * pair
        alpha = omega * alpha
        beta = omega * beta * pair
        w = float(psi @ a)
        velocity = float(psi @ (alpha + l * rate * b))
        u = w
        u_velocity = velocity
        if phase == "separation":
            u = w + spread(rng, 1e-7, 1e-3)
            u_velocity = velocity + 0.3 * rng.normal()
        elif give:
            u = w - give * p.N * spread(rng, 0.1, 3)
            u_velocity = velocity + 0.03 * rng.normal()
        start = rest.replace(
            phase=phase, direction=direction, psi=angle, f=rate, u=u, u_velocity=u_velocity, a=a, b=b, alpha=alpha,
            beta=beta,
        )  # fmt: skip
        start = start.replace(f=rate + surface_rate(p, start))
        R, T = reference(p, start).forces(phase, direction)
        # on a steeper slope slip may have no solution, or two
        steep = p.contact_force == "normal" and p.mu_s * abs(np.sum(l * psi * b)) > 0.5 * p.r_0
        if phase == "separation" or (
            R > 0 and not steep and (phase == "slip" or abs(T) < p.mu_s * R)
        ):
            return start
        lively = lively / 2
        angle = angle / 2
    return rest


def delay(events):
    """s, by which the engine may be off after so many events: each may shift those after it by its
    own error."""
    return 1e-12 + 1e-14 * events  # 4e-13 was found where friction reaches its limit slowly


def reference(p, start, **how):
    """A run from this state at the time 0."""
    return taylor.Reference(
        taylor.problem_of(p), stored.reference_state(start.replace(time=0.0), p), **how
    )


class Compared:
    """A random case, followed by the engine and twice by the reference, whose runs part where
    errors grow."""

    def __init__(self, seed, number):
        rng = np.random.default_rng([seed, number])
        self.p = p = drawn_case(rng)
        self.span = RADIANS / fastest(p)
        self.ramps = drawn_ramps(rng, p, self.span)
        course = course_of(p, self.ramps)
        if self.ramps or rng.random() < 0.5:
            self.begin = 0.0
        else:
            self.begin = rng.uniform(0, 50)
        self.start, self.theta, end = (
            drawn_start(rng, p, self.begin),
            rng.uniform(0, 6),
            self.begin + self.span,
        )
        window = Window(
            start=self.begin, stop=end, rate=(SAMPLES - 0.5) / self.span, theta=self.theta
        )
        windows = {"fine": window}
        how = {"ramps": self.ramps, "execution": Execution(audit_every_step=True)}
        self.result = simulate(p, end, windows, tol=1e-14, initial_state=self.start, **how)
        self.times = self.result.samples["fine"]["time"] - self.begin
        self.runs = [
            reference(p, self.start, course=course, truncation=size)
            for size in (taylor.TRUNCATION, ROUGH)
        ]
        drives = [p.Omega * self.begin + turned(course, t) for t in self.times]
        at = list(zip(self.times, drives, strict=True))
        self.samples = [
            np.array([run.run(t).sample(drive, self.theta) for t, drive in at]) for run in self.runs
        ]
        self.events = [
            [(float(e["time"]), e["kind"]) for e in run.run(self.span).events] for run in self.runs
        ]

    def check(self):
        """Switches, samples and end, as long as the reference is sure; how many switches
        those were."""
        statistics = self.result.statistics
        events = self.result.events
        assert self.result.status.complete, self.result.message
        names = ("residual", "residual_transverse", "residual_inplane")
        assert max(statistics[f"energy_{name}"] for name in names) < 1e-11
        sure, horizon, error = self.sure()
        times = events["time"].to_numpy() - self.begin
        kinds = list(events["kind"])
        wanted = self.events[0][:sure]
        assert kinds[:sure] == [kind for _, kind in wanted]
        off = np.abs(times[:sure] - [t for t, _ in wanted])
        assert np.all(off <= delay(np.arange(sure)) + 10 * error), (off.max(), error.max())
        # nor may it have found more
        assert np.all(times[sure:] > horizon - 1e-9)
        self.check_samples(horizon)
        return sure

    def sure(self):
        """How many switches both runs of the reference agree on, up to when no other is, and errors
        of their times."""
        error = [0.0]
        same = 0
        for (t, kind), (u, other) in zip(*self.events, strict=False):
            if kind != other or abs(t - u) > 1e-7:
                break
            error.append(max(error[-1], abs(t - u)))
            same += 1
        others = [events[same][0] for events in self.events if len(events) > same]
        return same, min(others, default=math.inf), np.array(error[1:])

    def check_samples(self, horizon):
        """Against the reference, where none is near a switch."""
        fine, rough = self.samples
        switches = np.array([t for t, _ in [*self.events[0], (math.inf, "")]])
        clear = np.abs(self.times[:, None] - switches).min(axis=1) > 1e-8
        scale = np.abs(fine).max(axis=0) + 1e-300
        # near rest a velocity is the rounding of its displacement, 1e-16 of it at the fastest
        # oscillation
        scale[[2, 5, 7]] = np.maximum(scale[[2, 5, 7]], 1e-4 * fastest(self.p) * scale[[1, 4, 6]])
        error = np.maximum.accumulate(
            np.where(clear[:, None], np.abs(fine - rough) / scale, 0), axis=0
        )
        good = clear & (self.times < horizon) & (error.max(axis=1) < 1e-4)
        # errors are relative to static deflection, which a ramp alone moves much less
        allowed = (
            1e-10
            + delay(np.searchsorted(switches, self.times)[:, None]) * fastest(self.p)
            + 10 * error
        ) * scale
        give = contact_compliance(self.p)
        if give:  # the force is a difference of heights over it
            allowed[:, 0] += 4e-16 * np.abs(fine[:, 1]).max() / give
        sample = self.result.samples["fine"]
        for i, name in enumerate(taylor.SAMPLED):
            off = np.abs(sample[name] - fine[:, i])
            assert np.all(off[good] <= allowed[good, i]), (
                name,
                (off / scale[i])[good].max(),
                error[good, i].max(),
            )


def test_random_cases(seed):
    """One of them again: ``Compared(seed, number).check()``."""
    failed = []
    counts = []
    for number in range(CASES):
        try:
            counts.append(Compared(seed, number).check())
        except Exception as error:  # all of them are looked at, whatever one ends in
            failed.append(f"case {number}: {error!r}")
    assert sum(counts) > CASES
    assert not failed, "\n".join(failed)
