"""The energy of the transverse motion: what the slope supplies, and what damping and impacts take."""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from disc_model.disc.plate import modal_damping, mode_arrays, modes_at_point
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Window
from disc_model.simulation.states import State
from workflow.paper.measures import Absent, Array

STAGES = 60
"""Stages of a run at the ends of which powers are averaged."""
LENGTH = 5.0
"""Greatest time at the end of each over which they are averaged, s."""
RATE = 400.0
"""Samples per second."""
INSTANT = 0.25
"""Time over which powers of a growing motion are averaged where its range is to be known, s."""
INSTANT_RATE = 8000.0
"""Samples per second in such an instant."""
NEAR = 0.05
"""Share within which the range in such an instant is near a width."""
TRANSIENT = 60.0
"""Time for which a motion goes on in a compliant contact before its powers are averaged, s."""
STRETCHES = 5
"""Stretches of that motion over which they are averaged,"""
STRETCH = 20.0
"""and the length of each, s."""


class Powers(NamedTuple):
    """Mean powers over a time, W."""

    width: float
    """Range of the slider's height, m."""
    pushes: float
    """Supplied by the contact force on the slope, P f B, while the force is positive."""
    pulls: float
    """Supplied by it while it is negative."""
    damped: float
    """Taken by the damping of the disc and of the slider."""
    gained: float
    """Rise of the energy of the disc and of the slider's vertical motion."""

    @property
    def supplied(self) -> float:
        return self.pushes + self.pulls

    @property
    def impacts(self) -> float:
        """Taken by impacts: the rest of the balance."""
        return self.supplied - self.damped - self.gained


def powers(p: Parameters, u_0: float, theta: Array, samples: Sequence[Mapping[Any, Any]]) -> Powers:
    """Return mean powers from samples of the disc at as many angles as it has modes.

    These give its whole motion. The power of the contact force is that on the velocity of the
    contact point less that of the disc's material under it, f B.

    Parameters
    ----------
    p : the case
    u_0 : height of the slider at the start, m
    theta : angles at which the disc was sampled, rad
    samples : variables over time by name, at each of these angles
    """
    first = samples[0]
    time, force, drive, u, velocity = (
        np.asarray(first[name]) for name in ("time", "P", "psi", "u", "u_velocity")
    )
    omega = _by_mode(p, mode_arrays(p).omega)
    psi = _by_mode(p, modes_at_point(p).psi)
    modal_speed = _modal(p, theta, samples, "w_point_velocity")

    under_slider = waves(p.Omega * time - drive, p.n_diameters)
    material = np.sum(psi * modal_speed * under_slider, axis=0)
    power = force * (velocity - material)

    # twice the energy: modes of unit modal mass, the slider, its spring and preload
    modal_force = omega * _modal(p, theta, samples, "w_point")
    height = u - u_0
    energy = np.sum(modal_speed**2 + modal_force**2, axis=0)
    energy += p.m * velocity**2 + p.k * height**2 + 2 * p.N * height

    of_modes = np.mean(_by_mode(p, modal_damping(p)) * modal_speed**2, axis=1).sum()
    duration = float(time[-1] - time[0])
    return Powers(
        width=float(np.ptp(u)),
        pushes=float(np.mean(power * (force > 0))),
        pulls=float(np.mean(power * (force < 0))),
        damped=float(of_modes + p.c * np.mean(velocity**2)),
        gained=float(energy[-1] - energy[0]) / 2 / duration,
    )


def _modal(p: Parameters, theta: Array, samples: Sequence[Mapping[Any, Any]], name: str) -> Array:
    """Return modal coordinates of unit modal mass, or their rates, shape (modes, times).

    Parameters
    ----------
    p : the case
    theta : angles at which the disc was sampled, rad
    samples : variables over time by name, at each of these angles
    name : displacement or velocity of the disc at these angles
    """
    coefficients = np.linalg.solve(
        waves(theta, p.n_diameters).T, [np.asarray(each[name]) for each in samples]
    )
    return np.asarray(coefficients / _by_mode(p, modes_at_point(p).psi))


def _by_mode(p: Parameters, values: Array) -> Array:
    """Return values of modes by diameters, then once more those of the second mode of each pair.

    The result has shape (2 n_diameters + 1, 1), in the order of `waves`.
    """
    order = np.argsort(mode_arrays(p).diameters)
    ordered = values[order]
    both = np.concatenate([ordered, ordered[1:]])
    return both[:, None]


def waves(angle: Array, most: int) -> Array:
    """Return 1, then cosines and sines of multiples of angles, shape (2 most + 1, angles)."""
    orders = np.arange(1, most + 1)[:, None]
    multiples = orders * angle
    ones = np.ones((1, angle.size))
    return np.concatenate([ones, np.cos(multiples), np.sin(multiples)])


def powers_between(
    p: Parameters, begin: float, end: float, state: State | None, rate: float = RATE
) -> tuple[Powers, State]:
    """Return mean powers between two times in s of a motion that goes on from a state, or from the
    static start, and the last state.

    rate : samples per second
    """
    count = 2 * p.n_diameters + 1
    theta = 2 * np.pi * np.arange(count) / count
    windows = {
        f"at {angle:g}": Window(start=begin, stop=end, rate=rate, theta=angle)
        for angle in theta.tolist()
    }
    run = simulate(p, end, windows, initial_state=state).raise_for_status()
    return powers(p, run.u_0, theta, [*run.samples.values()]), run.final_state


def power_history(p: Parameters, until: float) -> list[Powers]:
    """Return powers at `STAGES` times of the motion from the static start, up to a time in s."""
    state = None
    history: list[Powers] = []
    times = np.linspace(0.0, until, STAGES + 1).tolist()
    for begin, end in pairwise(times):
        found, state = powers_between(p, max(begin, end - LENGTH), end, state)
        history.append(found)
    return history


def in_the_end(history: Sequence[Powers]) -> Powers:
    """Return means over the last quarter of the stages, for the steady state."""
    late = history[-len(history) // 4 :]
    return Powers(*np.mean(late, axis=0).tolist())


def taken_in_compliant_contact(p: Parameters, state: State) -> Array:
    """Return mean powers in W that damping takes in each of `STRETCHES` stretches of a motion in a
    compliant contact. As that has no impacts, these are what the contact force supplies in the
    steady state.

    Parameters
    ----------
    p : a case with rigid contact; its contact becomes as flexible as the modes that are left out
    state : from which the motion goes on
    """
    compliant = p.replace(contact_compliance="residual")
    end = state.time + TRANSIENT
    run = simulate(compliant, end, initial_state=state, events=False).raise_for_status()
    state = run.final_state
    taken = []
    for _ in range(STRETCHES):
        found, state = powers_between(compliant, state.time, state.time + STRETCH, state)
        taken.append(found.damped)
    return np.array(taken)


def at_range(p: Parameters, until: float, width: float, stages: Sequence[Powers]) -> Powers:
    """Return the powers of a growing motion about where its range has a width.

    A stage of `power_history` has the greatest range of seconds, in which the motion may grow much.
    Powers are therefore means over all instants in which the range is within `NEAR` of the width;
    those of a single instant depend on the releases that fall into it. The motion begins at the
    static start.

    Parameters
    ----------
    p : the case
    until : time to which the motion is followed, s
    width : range of the slider's height, m
    stages : the `power_history` to that time

    Raises
    ------
    Absent
        If the motion stays smaller, or is near that width in no instant.
    """
    wider = [stage.width > width for stage in stages[1:]]
    if not any(wider):
        raise Absent(f"maintained contact comes to {1e3 * stages[-1].width:.3g} mm only")
    begin = until * wider.index(True) / STAGES
    state = None
    if begin > 0:
        state = simulate(p, begin, events=False).final_state
    near: list[Powers] = []
    for end in np.arange(begin + INSTANT, until + INSTANT / 2, INSTANT).tolist():
        found, state = powers_between(p, end - INSTANT, end, state, INSTANT_RATE)
        if found.width > (1 + NEAR) * width:
            break
        if found.width > (1 - NEAR) * width:
            near.append(found)
    if not near:
        raise Absent(f"maintained contact leaps over {1e3 * width:.3g} mm")
    return Powers(*np.mean(near, axis=0).tolist())
