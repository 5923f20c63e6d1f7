"""Compute powers on the brake-like disc: what friction on its surface supplies, and what takes it."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

import disc_model as dm
from disc_model.disc.plate import modal_damping, mode_arrays, tangential_amplitudes
from disc_model.simulation.api import snapshots

ROOT = Path(__file__).parents[2]
BEGIN, LENGTH, RATE = 8.0, 0.5, 20000
"""s, from when and how long powers are averaged; samples per s."""


class Powers(NamedTuple):
    """Mean powers that the vibration loses, W.

    damping : by the frequency in Hz of a mode
    impacts : the rest of the balance of the disc and of the slider's vertical motion (docs/model.md,
        Energy)
    """

    damping: dict[int, float]
    impacts: float


@cache
def powers(Omega: float, contact: str) -> Powers:
    """Return mean powers at 8 kN from the static start.

    Parameters
    ----------
    Omega : speed, rad/s
    contact : ``unilateral`` or ``bilateral``; rigid
    """
    disc = dm.Disc.from_csv(ROOT / "config" / "discs" / "brake.csv")
    p = dm.Parameters(
        N=8000, Omega=Omega, disc=disc, r_0=0.1, k=1e6, k_p=1e6, m=0.5, mu_s=0.45, mu_k=0.35,
        friction_offset="surface", contact=contact,
    )  # fmt: skip
    start = dm.simulate(p, BEGIN, events=False).final_state
    times = start.time + np.arange(int(LENGTH * RATE)) / RATE
    window = dm.Window(start=times[0], stop=times[-1], rate=RATE)
    run = dm.simulate(p, times[-1], {"late": window}, initial_state=start)
    P = run["late"]["P"].values
    states = snapshots(p, times[: P.size], initial_state=start)
    names = ("a", "b", "alpha", "beta", "f", "psi", "u", "u_velocity", "direction")
    columns = (np.array([getattr(state, name) for state in states]) for name in names)
    a, b, alpha, beta, f, psi, u, v, direction = columns
    modes = mode_arrays(p)
    tangential = tangential_amplitudes(p)
    speed = beta @ tangential
    rate = f - speed / p.r_0
    F = p.k_p * psi

    # friction: in stick it accelerates the slider with the surface
    free = -(modal_damping(p) * beta + modes.omega**2 * b) @ tangential
    held = (p.r_0 * F - p.m * free) / (1 + p.m * np.sum(tangential**2))
    sticks = np.array([state.phase == "stick" for state in states])
    friction = np.where(sticks, held, direction * p.mu_k * P)

    # powers into disc and vertical motion; what is missing from their energy, impacts have taken
    energy = 0.5 * np.sum(alpha**2 + beta**2 + modes.omega**2 * (a**2 + b**2), axis=1)
    energy += 0.5 * p.m * v**2 + 0.5 * p.k * (u - run.u_0) ** 2 + p.N * (u - run.u_0)
    surface = np.mean(friction * speed)
    slope = np.mean(P * rate * (b @ (modes.diameters * modes.psi)))
    by_mode = np.mean(alpha**2 + beta**2, axis=0) * modal_damping(p)
    gained = (energy[-1] - energy[0]) / (times[P.size - 1] - times[0])
    impacts = surface + slope - by_mode.sum() - gained
    hertz = [round(omega / (2 * np.pi)) for omega in modes.omega]
    return Powers(dict(zip(hertz, by_mode, strict=True)), float(impacts))
