"""Draw the powers of docs/findings.md on the brake-like disc: what friction on its surface
supplies, and what takes it.

python docs/drawings/brake_energy.py    writes brake_energy.svg beside this file, after some seconds of simulation
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

import disc_model as dm
from disc_model.disc.plate import modal_damping, mode_arrays, tangential_amplitudes
from disc_model.simulation.api import snapshots

ROOT = Path(__file__).parents[2]
FONT: Any = {"font.size": 9, "svg.hashsalt": "brake_energy", "font.family": "DejaVu Sans"}
CASES = [(Omega, contact) for Omega in (80, 120) for contact in ("unilateral", "bilateral")]
"""Speeds in rad/s at 8 kN, and contacts."""
BEGIN, LENGTH, RATE = 8.0, 0.5, 20000
"""s, from when and how long powers are averaged; samples per s."""
PARTS = {
    "friction on the surface": "#0072B2",
    "slope under the slider": "#56B4E9",
    "damping of the disc": "#767676",
    "impacts": "#D55E00",
}


@cache
def powers(Omega: float, contact: str) -> dict[str, float]:
    """Mean powers at 8 kN from the static start, W, negative where the vibration loses; and others,
    which are named.

    The impacts' is the rest of the balance of the disc and of the slider's vertical motion
    (docs/model.md, Energy).
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
    damping = -np.mean((alpha**2 + beta**2) @ modal_damping(p))
    impacts = (energy[-1] - energy[0]) / (times[P.size - 1] - times[0]) - surface - slope - damping
    named = dict(zip(PARTS, map(float, (surface, slope, damping, impacts)), strict=True))
    drive = p.Omega * p.r_0**2 * np.mean(F)
    heat = p.r_0 * np.mean(friction * rate)
    return named | {
        "drive": float(drive),
        "heat": float(heat),
        "surface speed": float(run.scalars()["surface_speed"]),
    }


def main() -> None:
    with plt.rc_context(FONT):
        figure, ax = plt.subplots(figsize=(7.2, 3.2), layout="constrained")
        width = 0.8 / len(PARTS)
        for i, (name, colour) in enumerate(PARTS.items()):
            heights = [powers(*case)[name] / 1e3 for case in CASES]
            ax.bar(
                np.arange(len(CASES)) + (i - 1.5) * width, heights, width, color=colour, label=name
            )
        ax.axhline(0, color="black", linewidth=0.8)
        words = {"unilateral": "with separation", "bilateral": "bilateral contact"}
        ax.set_xticks(
            range(len(CASES)), [f"{Omega} rad/s\n{words[contact]}" for Omega, contact in CASES]
        )
        ax.set_ylabel("Power into the vibration (kW)")
        figure.legend(loc="outside right center", frameon=False)
        figure.savefig(
            Path(__file__).with_suffix(".svg"), metadata={"Date": None}, facecolor="white"
        )
        for case in CASES:
            print(*case, *(f"{name} {value:.4g};" for name, value in powers(*case).items()))


if __name__ == "__main__":
    main()
