"""The transverse energy of a motion: what the slope supplies, and what damping and impacts take."""

from collections.abc import Mapping, Sequence
from functools import lru_cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from disc_model.disc.plate import modal_damping, mode_arrays
from disc_model.paper.measures import Absent, Array, CaseView
from disc_model.parameters import Parameters

STAGES, LENGTH, RATE = 60, 5.0, 400.0
"""Stages of a run; greatest time in s at the end of each over which powers are averaged, and samples per s there."""


class Powers(NamedTuple):
    """Mean powers, W, over a time in which the range of the slider's height is ``width``, m.

    pushes, pulls : supplied by the contact force on the slope, P f B, while it is positive and negative
    damped : taken by the damping of the disc and of the slider
    gained : rise of the energy of the disc and of the slider's vertical motion
    """

    width: float
    pushes: float
    pulls: float
    damped: float
    gained: float

    @property
    def supplied(self) -> float:
        return self.pushes + self.pulls

    @property
    def impacts(self) -> float:
        """Taken by impacts: the rest of the balance."""
        return self.supplied - self.damped - self.gained


def powers(p: Parameters, u_0: float, theta: Array, samples: Sequence[Mapping[Any, Any]]) -> Powers:
    """Mean powers from samples of the disc at as many angles as it has modes, which give its whole motion.

    f B is the velocity of the contact point less that of the disc's material under it.
    """
    order = np.argsort(mode_arrays(p).diameters)
    omega, psi, damping = (
        np.concatenate([each[order], each[order][1:]])[:, None]
        for each in (mode_arrays(p).omega, mode_arrays(p).psi, modal_damping(p))
    )
    time, force, drive, u, velocity = (np.asarray(samples[0][name]) for name in ("time", "P", "psi", "u", "u_velocity"))
    shapes = _waves(theta, p.n_diameters).T
    angle, speed = (
        np.linalg.solve(shapes, np.stack([np.asarray(each[name]) for each in samples]))
        for name in ("w_point", "w_point_velocity")
    )
    power = force * (velocity - np.sum(speed * _waves(p.Omega * time - drive, p.n_diameters), axis=0))
    energy = np.sum((speed / psi) ** 2 + (omega * angle / psi) ** 2, axis=0)
    energy += p.m * velocity**2 + p.k * (u - u_0) ** 2 + 2 * p.N * (u - u_0)
    damped = np.sum(damping * (speed / psi) ** 2, axis=0) + p.c * velocity**2
    pushes, pulls, taken = (float(np.mean(each)) for each in (power * (force > 0), power * (force < 0), damped))
    gained = float(energy[-1] - energy[0]) / 2 / float(time[-1] - time[0])
    return Powers(float(np.ptp(u)), pushes, pulls, taken, gained)


def of_windows(case: CaseView, prefix: str) -> Powers:
    """Powers in the windows of a case that are named by a prefix and a number, one for each angle."""
    windows = [case.samples(f"{prefix}{i}") for i in range(2 * case.parameters.n_diameters + 1)]
    theta = np.array([window.attrs["theta"] for window in windows])
    return powers(case.parameters, case["u_0"], theta, windows)


def _waves(angle: Array, most: int) -> Array:
    """1, then cosines and sines of multiples of an angle: (2 most + 1, number of angles)."""
    orders = np.arange(1, most + 1)[:, None] * angle
    return np.concatenate([np.ones((1, angle.size)), np.cos(orders), np.sin(orders)])


@lru_cache(maxsize=16)
def course(p: Parameters, until: float) -> tuple[Powers, ...]:
    """Powers at `STAGES` times of the motion from the static start, up to a time in s."""
    from disc_model.simulation.api import simulate
    from disc_model.simulation.case import Window

    theta = 2 * np.pi * np.arange(2 * p.n_diameters + 1) / (2 * p.n_diameters + 1)
    state, courses = None, []
    for begin, end in pairwise(np.linspace(0.0, until, STAGES + 1).tolist()):
        start = max(begin, end - LENGTH)
        windows = {f"at {angle:g}": Window(start=start, stop=end, rate=RATE, theta=angle) for angle in theta.tolist()}
        run = simulate(p, end, windows, initial_state=state).raise_for_status()
        state = run.final_state
        courses.append(powers(p, run.u_0, theta, [*run.samples.values()]))
    return tuple(courses)


def in_the_end(courses: Sequence[Powers]) -> Powers:
    """Means over the last quarter of the stages, for the steady state."""
    return Powers(*np.mean(courses[-len(courses) // 4 :], axis=0).tolist())


def at_width(courses: Sequence[Powers], width: float) -> Powers:
    """Powers of a growing motion where it first has a width, which they follow as its square; raises `Absent`."""
    beyond = next((i for i, each in enumerate(courses) if i and each.width > width), 0)
    if not beyond:
        raise Absent(f"maintained contact comes to {1e3 * courses[-1].width:.3g} mm only")
    low, high = courses[beyond - 1 : beyond + 1]
    share = (width**2 - low.width**2) / (high.width**2 - low.width**2)
    return Powers(*((1 - share) * a + share * b for a, b in zip(low, high, strict=True)))
