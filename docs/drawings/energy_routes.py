"""Draw where the energy of the vibration goes, in bilateral, rigid and compliant contact.

python docs/drawings/energy_routes.py    writes energy_routes.svg beside this file, after a minute of simulation
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from docs.drawings.brake_energy import powers  # noqa: E402

from disc_model import Parameters, simulate  # noqa: E402
from workflow.paper import energy  # noqa: E402

FONT: Any = {
    "font.size": 9,
    "svg.hashsalt": "energy_routes",
    "font.family": "DejaVu Sans",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "hatch.linewidth": 0.6,
}
PAIRS = {(200, 20): (800, 1400), (300, 20): (480, 700), (200, 50): (400, 1200)}
"""Preload and speed of Figs. 4 to 9; ends in s of the runs with separation and without it, as in
config/paper.yaml."""
STRETCH = 20.0
"""Length of the stretch at the end of a run whose powers are averaged, s."""
PERIOD = 1e3 / 135.42
"""mJ per period of the coupled mode for a W."""
COUPLED = 1
"""Nodal diameters of the coupled mode."""
DRIVEN = 1760
"""Frequency of the brake-like disc's mode that friction drives, Hz."""
CONTACTS = ("bilateral", "rigid", "compliant")
ROUTES = {
    "damping of the mode that grows": {"facecolor": "#0072B2"},
    "damping of slower modes": {"facecolor": "#9ecae1"},
    "damping of faster modes": {"facecolor": "#E69F00"},
    "impacts": {"facecolor": "#f4c7b0", "edgecolor": "#D55E00", "hatch": "////"},
    "growth of the vibration": {"facecolor": "white", "edgecolor": "#767676", "linestyle": "--"},
}
Routes = dict[str, float]


def late_damping(
    p: Parameters, end: float, length: float = STRETCH, rate: float = energy.RATE, **options: Any
) -> np.ndarray:
    """Return powers that damping takes over the last stretch of a run, by nodal diameters, W."""
    windows = energy.windows_round(p, end - length, end, rate)
    run = simulate(p, end, windows, **options).raise_for_status()
    return energy.damping_by_diameters(p, energy.angles_round(p), list(run.samples.values()))


def by_route(damped: float, damping: np.ndarray, **others: float) -> Routes:
    """Return energies per period in mJ by routes, from powers in W.

    Parameters
    ----------
    damped : that damping takes in all
    damping : that of the disc takes by nodal diameters, which says how this is shared
    others : of other routes
    """
    coupled = damping[COUPLED] / damping.sum()
    found = {
        "damping of the mode that grows": damped * coupled,
        "damping of faster modes": damped * (1 - coupled),
        **others,
    }
    return {name: PERIOD * float(power) for name, power in found.items()}


def of_paper(N: float, Omega: float) -> dict[str, Routes]:
    """Return routes in mJ per period on the paper's disc, by contact, as row F10e of the ledger.

    Those of bilateral contact are of the growing vibration, where its range is that of the motion
    with separation and rigid contact.
    """
    free, bonded = PAIRS[N, Omega]
    p = Parameters(N=N, Omega=Omega)
    rigid = energy.in_the_end(energy.power_history(p, free))
    damping = late_damping(p, free)
    routes = {"rigid": by_route(rigid.damped, damping, impacts=rigid.impacts)}

    # without impacts, on from the motion with rigid contact
    state = simulate(p, free, events=False).final_state
    compliant = p.replace(contact_compliance="residual")
    length = energy.STRETCHES * energy.STRETCH
    end = free + energy.TRANSIENT + length
    damping = late_damping(compliant, end, length, initial_state=state)
    # the mean of the table of energies: another one of the same irregular motion differs by per cent
    taken = energy.taken_in_compliant_contact(p, state).mean()
    routes["compliant"] = by_route(taken, damping)

    bilateral = p.replace(contact="bilateral")
    growing, end = energy.at_range(bilateral, bonded, rigid.width)
    damping = late_damping(bilateral, end, energy.INSTANT, energy.INSTANT_RATE)
    routes["bilateral"] = by_route(
        growing.damped, damping, **{"growth of the vibration": growing.gained}
    )
    return routes


def of_brake() -> dict[str, Routes]:
    """Return routes in kW on the brake-like disc at 8 kN and 80 rad/s, by contact."""
    motions = {"bilateral": powers(80, "bilateral"), "rigid": powers(80, "unilateral")}
    routes = {}
    for contact, found in motions.items():
        parts = dict.fromkeys(ROUTES, 0.0)
        for hertz, power in found.damping.items():
            if hertz == DRIVEN:
                parts["damping of the mode that grows"] += power
            elif hertz < DRIVEN:
                parts["damping of slower modes"] += power
            else:
                parts["damping of faster modes"] += power
        if contact == "rigid":
            parts["impacts"] = found.impacts
        routes[contact] = {name: power / 1e3 for name, power in parts.items()}
    return routes


def draw(ax: Axes, routes: dict[str, Routes], title: str) -> None:
    """Draw bars of routes, one for each contact."""
    contacts = [contact for contact in CONTACTS if contact in routes]
    for place, contact in enumerate(contacts):
        bottom = 0.0
        for name, look in ROUTES.items():
            height = routes[contact].get(name, 0.0)
            if height:
                ax.bar(place, height, 0.72, bottom, **look)
            bottom += height
    ax.set_title(title, fontsize=9)
    ax.set_xticks(range(len(contacts)), contacts, rotation=25)


def main() -> None:
    with plt.rc_context(FONT):
        figure, axes = plt.subplots(1, len(PAIRS) + 1, figsize=(7.6, 3.3), layout="constrained")
        for ax, (N, Omega) in zip(axes, PAIRS, strict=False):
            routes = of_paper(N, Omega)
            draw(ax, routes, f"{N} N, {Omega} rad/s")
            print(N, Omega, routes)
        axes[0].set_ylabel("Energy per period (mJ)")
        brake = of_brake()
        print("brake", brake)
        draw(axes[-1], brake, "brake-like disc,\n8 kN, 80 rad/s")
        axes[-1].set_ylabel("Power (kW)")
        handles = [plt.Rectangle((0, 0), 1, 1, **look) for look in ROUTES.values()]
        figure.legend(handles, ROUTES, loc="outside lower center", ncols=3, frameon=False)
        figure.suptitle(
            "Rigid contact: impacts take what damping does not. Compliant contact: there are no impacts.",
            fontsize=10,
        )
        target = Path(__file__).with_suffix(".svg")
        figure.savefig(target, metadata={"Date": None}, facecolor="white")


if __name__ == "__main__":
    main()
