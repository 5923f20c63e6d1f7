"""Whether a slider whose drive stands still is at rest: friction holds it for good.

A sticking slider is held by the spring in the plane, whose pull no longer changes, against a limit of
friction that changes with the contact force, because the disc still vibrates.  The energy of that
vibration does not grow.  It bounds the contact force, and the slope of the disc under the slider.
"""

import math

import numpy as np

from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import Modes, modal_damping, mode_arrays, tangential_amplitudes
from disc_model.parameters import Parameters
from disc_model.simulation.states import Array, State


def spring_pull(p: Parameters, state: State) -> float:
    """Pull of the spring in the plane, N, where neither its ends move; positive ahead."""
    return p.r_0 * p.k_p * state.psi


def holds_for_good(p: Parameters, state: State, N: float) -> bool:
    """Whether friction holds the slider from now on, under a drive that stands still and the preload
    `N` (N), whatever vibration of the disc is left.

    It is sufficient, and False if it cannot be shown, as where friction acts on the disc's surface,
    whose motion moves the slider.
    """
    if state.phase != "stick" or np.any(tangential_amplitudes(p)):
        return False
    modes = mode_arrays(p)
    compliance = contact_compliance(p)
    flexibility = float(np.sum((modes.psi / modes.omega) ** 2)) + compliance
    force = (N + p.k * p.N * flexibility) / (1 + p.k * flexibility)
    swing = _swing_of_force(p, modes, compliance, state, force)
    press = force - swing
    pull = abs(spring_pull(p, state))
    if p.contact_force == "normal":
        slope = _largest_slope(modes, state) / p.r_0
        press -= pull * slope
        pull += slope * (force + swing)
    return pull < p.mu_s * press


def _swing_of_force(
    p: Parameters, modes: Modes, compliance: float, state: State, force: float
) -> float:
    """Largest deviation of the vertical contact force from its value `force` at equilibrium that
    the energy of the vibration along the slider's direction allows, N."""
    damping = modal_damping(p)
    psi = modes.psi
    stiffness = np.diag(modes.omega**2)
    mass = np.eye(len(psi))
    away = state.a + force * psi / modes.omega**2
    velocity = state.alpha
    if compliance:
        # the slider's u is one more coordinate
        stretch = np.append(psi, -1.0)
        u = float(-np.sum(psi**2 / modes.omega**2) * force - compliance * force)
        stiffness = (
            np.diag(np.append(modes.omega**2, p.k)) + np.outer(stretch, stretch) / compliance
        )
        mass = np.diag(np.append(np.ones(len(psi)), p.m))
        away = np.append(away, state.u - u)
        velocity = np.append(velocity, state.u_velocity)
        by_displacement = stretch / compliance
        by_velocity = np.zeros(len(stretch))
    else:
        inertia = 1 + p.m * float(psi @ psi)
        stiffness += p.k * np.outer(psi, psi)
        mass += p.m * np.outer(psi, psi)
        by_displacement = psi * (p.k - p.m * modes.omega**2) / inertia
        by_velocity = psi * (p.c - p.m * damping) / inertia
    energy = away @ stiffness @ away + velocity @ mass @ velocity
    response = _quadratic(stiffness, by_displacement) + _quadratic(mass, by_velocity)
    return math.sqrt(float(energy) * response)


def _quadratic(matrix: Array, vector: Array) -> float:
    """vector^T matrix^-1 vector of a positive matrix."""
    return float(vector @ np.linalg.solve(matrix, vector))


def _largest_slope(modes: Modes, state: State) -> float:
    """Largest slope B = dw/dtheta of the disc under the slider that the energy of the vibration
    across the slider's direction allows, m."""
    bent = modes.diameters * modes.psi / modes.omega
    energy = np.sum(state.beta**2 + (modes.omega * state.b) ** 2)
    return math.sqrt(float(energy * np.sum(bent**2)))
