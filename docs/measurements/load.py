"""Friction of PLA on silicone over the load: Coulomb's law makes it constant (E)."""

import numpy as np
from docs.measurements.comparison import Comparison, read

CONSTANT = 0.10
"""Part of the friction at the middle load by which that at others may differ."""


def loads() -> list[Comparison]:
    """Return for each series the extreme of friction that is farthest from that at the middle
    load, which is the prediction."""
    found = []
    for series, rows in read("load.csv").groupby("series"):
        ordered = rows.sort_values("load_mN")
        friction = ordered["friction"].to_numpy()
        expected = float(friction[len(friction) // 2])
        farthest = int(np.abs(friction - expected).argmax())
        value = float(friction[farthest])
        share = float(np.mean(np.abs(friction - expected) <= CONSTANT * expected))
        what = f"{series}, farthest at {ordered['load_mN'].iloc[farthest]:g} mN"
        agrees = share == 1.0
        found.append(Comparison(what, value, expected, "", agrees))
    return found
