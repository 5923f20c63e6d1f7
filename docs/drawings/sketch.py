"""Draw the sketch of docs/model.md, which is Figure 1 with the radii of Table 1.

python docs/drawings/sketch.py    writes sketch.svg beside this file
"""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt

from disc_model import Parameters
from workflow.paper.figures.schematic import sketch

WIDTH = 518.740157 / 72  # inches: 183 mm
FONT = {
    "font.size": 11,
    "mathtext.fontset": "cm",
    "svg.hashsalt": "sketch",
    "font.family": "DejaVu Sans",
}


def main():
    with plt.rc_context(FONT):
        figure = sketch(Parameters(N=200, Omega=20), WIDTH)
        figure.savefig(
            Path(__file__).with_suffix(".svg"), metadata={"Date": None}, facecolor="white"
        )


if __name__ == "__main__":
    main()
