"""Draw the energy per cycle of docs/findings.md: work of the contact force on the slope, damping
and impacts.

python docs/drawings/energy.py    writes energy.svg beside this file, after some seconds of simulation
"""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from disc_model import Parameters
from disc_model.paper.energy import in_the_end, power_history

FONT = {
    "font.size": 9,
    "mathtext.fontset": "cm",
    "svg.hashsalt": "energy",
    "font.family": "DejaVu Sans",
}
PAIRS = {(200, 20): (800, 1000), (300, 20): (480, 400), (200, 50): (400, 240)}
"""Preload and speed of Figs. 4 to 9, with times in s by which motions with separation and without are steady."""
CYCLE = 1e3 / 135.42
"""mJ per cycle of the coupled mode for a W."""
BLUE, GREY, ORANGE = "#0072B2", "#767676", "#D55E00"


def draw(ax: plt.Axes, p: Parameters, free: float, bonded: float) -> None:
    """Energy per cycle over the range of the slider's height."""
    found = np.array(
        [
            (each.width, each.supplied, each.damped)
            for each in power_history(p.replace(contact="bilateral"), bonded)
        ]
    )
    width, supplied, damped = found[np.argmax(found[:, 0] > 3e-3) :].T * [[1e3], [CYCLE], [CYCLE]]
    ax.plot(width, supplied, color=BLUE, label="supplied by the contact force, bilateral contact")
    ax.plot(width, damped, color=GREY, linestyle="--", label="taken by damping, bilateral contact")
    end = in_the_end(power_history(p, free))
    at = 1e3 * end.width
    ax.plot(at, CYCLE * end.supplied, "o", color=ORANGE, label="supplied, with separation")
    ax.plot(
        at,
        CYCLE * end.damped,
        "s",
        color=ORANGE,
        mfc="none",
        label="taken by damping, with separation",
    )
    ax.plot(
        [at, at], [CYCLE * end.damped, CYCLE * end.supplied], color=ORANGE, label="taken by impacts"
    )
    ax.set(
        xscale="log",
        yscale="log",
        title=f"{p.N:g} N, {p.Omega:g} rad/s",
        xlabel="Range of the height (mm)",
    )
    ax.set_xticks([5, 10, 20, 50, 100, 200], labels=["5", "10", "20", "50", "100", "200"])
    ax.set_xticks([], minor=True)
    ax.set_xlim(3, 200)


def main() -> None:
    with plt.rc_context(FONT):
        figure, axes = plt.subplots(1, len(PAIRS), figsize=(9, 3.4), layout="constrained")
        for ax, ((N, Omega), times) in zip(axes, PAIRS.items(), strict=True):
            draw(ax, Parameters(N=N, Omega=Omega), *times)
        axes[0].set_ylabel("Energy per cycle (mJ)")
        figure.legend(
            *axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False
        )
        figure.savefig(
            Path(__file__).with_suffix(".svg"), metadata={"Date": None}, facecolor="white"
        )


if __name__ == "__main__":
    main()
