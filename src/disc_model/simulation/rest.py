"""Whether a slider whose drive stands still is at rest: friction holds it for good.

A sticking slider is pulled by the spring in the plane, and by the disc's surface if that moves, against
a limit of friction that changes with the contact force, because the disc still vibrates. Stick is
linear, and no energy comes in: the energy of the vibration, which does not grow, bounds all of these.
"""

import math
from typing import NamedTuple

import numpy as np

from disc_model.arrays import Array
from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import modal_damping, mode_arrays, tangential_amplitudes
from disc_model.parameters import Parameters
from disc_model.simulation.states import State


class Carried(NamedTuple):
    """Modal coordinates in one direction, and what they carry at the point of contact: the slider of
    mass m on a spring and a damper.

    shape : (n,), amplitudes of the modes at the contact in the direction
    omega : (n,), rad/s
    damping : (n,), 2 xi omega, 1/s
    m, k, c : mass, stiffness and damping of the slider in the direction
    """

    shape: Array
    omega: Array
    damping: Array
    m: float
    k: float
    c: float

    @property
    def stiffness(self) -> Array:
        return np.diag(self.omega**2) + self.k * np.outer(self.shape, self.shape)

    @property
    def mass(self) -> Array:
        return np.eye(len(self.shape)) + self.m * np.outer(self.shape, self.shape)

    def energy(self, away: Array, velocity: Array) -> float:
        """Twice the energy of a deviation from the equilibrium, J."""
        return float(away @ self.stiffness @ away + velocity @ self.mass @ velocity)

    def swing_of_force(self, energy: float) -> float:
        """Largest deviation of the force at the contact that an `energy` allows, N."""
        inertia = 1 + self.m * float(self.shape @ self.shape)
        by_displacement = self.shape * (self.k - self.m * self.omega**2) / inertia
        by_velocity = self.shape * (self.c - self.m * self.damping) / inertia
        response = _response(self.stiffness, by_displacement) + _response(self.mass, by_velocity)
        return math.sqrt(energy * response)

    def swing(self, by_displacement: Array, energy: float) -> float:
        """Largest deviation of a sum of displacements that an `energy` allows."""
        return math.sqrt(energy * _response(self.stiffness, by_displacement))


def _response(matrix: Array, vector: Array) -> float:
    """vector^T matrix^-1 vector of a positive matrix."""
    return float(vector @ np.linalg.solve(matrix, vector))


class Range(NamedTuple):
    """A force between its value at equilibrium less, and plus, a largest deviation, N."""

    middle: float
    swing: float


def spring_pull(p: Parameters, state: State) -> float:
    """Pull of the spring in the plane, N, under a drive that stands still; positive ahead."""
    return p.r_0 * (p.k_p * state.psi - p.c_p * state.f)


def holds_for_good(p: Parameters, state: State, N: float) -> bool:
    """Whether friction holds the slider from now on, under a drive that stands still and the preload
    `N` (N), whatever vibration of the disc is left: a condition that is sufficient."""
    if state.phase != "stick":
        return False
    vertical = _vertical_force(p, state, N)
    modes = mode_arrays(p)
    across = Carried(tangential_amplitudes(p), modes.omega, modal_damping(p), p.m, p.k_p, p.c_p)

    # along the path the slider goes with the surface: r_0 psi and t b change alike
    spring = p.r_0 * p.k_p * state.psi + p.k_p * float(across.shape @ state.b)
    rest = np.linalg.solve(across.stiffness, across.shape * spring)
    energy = across.energy(state.b - rest, state.beta)
    hold = spring - p.k_p * float(across.shape @ rest)
    pull = abs(hold) + across.swing_of_force(energy)
    press = vertical.middle - vertical.swing
    if p.contact_force == "normal":
        bend = modes.diameters * modes.psi / p.r_0
        slope = abs(float(bend @ rest)) + across.swing(bend, energy)
        press -= pull * slope
        pull += slope * (vertical.middle + vertical.swing)
    return pull < p.mu_s * press


def _vertical_force(p: Parameters, state: State, N: float) -> Range:
    """The vertical contact force from now on, as far as the energy of the vibration allows."""
    modes = mode_arrays(p)
    compliance = contact_compliance(p)
    flexibility = float(np.sum((modes.psi / modes.omega) ** 2)) + compliance
    force = (N + p.k * p.N * flexibility) / (1 + p.k * flexibility)
    away = state.a + force * modes.psi / modes.omega**2
    damping = modal_damping(p)
    if not compliance:
        along = Carried(modes.psi, modes.omega, damping, p.m, p.k, p.c)
        return Range(force, along.swing_of_force(along.energy(away, state.alpha)))

    # the slider's height is one more coordinate: u sqrt(m), on a contact that is a spring
    frequency = math.sqrt(p.k / p.m)
    stretch = Carried(
        shape=np.append(modes.psi, -1 / math.sqrt(p.m)),
        omega=np.append(modes.omega, frequency),
        damping=np.append(damping, p.c / p.m),
        m=0.0,
        k=1 / compliance,
        c=0.0,
    )
    root = math.sqrt(p.m)
    height = root * (state.u + flexibility * force)
    energy = stretch.energy(
        np.append(away, height), np.append(state.alpha, root * state.u_velocity)
    )
    return Range(force, stretch.swing_of_force(energy))
