"""Friction of PLA on silicone over the load: Coulomb's law makes it constant (E)."""

import numpy as np
import pandas as pd
from docs.measurements.comparison import Comparison, read

CONSTANT = 0.10
"""Part of the friction at the middle load by which that at others may differ."""


def series() -> dict[str, pd.DataFrame]:
    """Return friction over the load in each series, by rising load."""
    groups = read("load.csv").groupby("series")
    return {str(name): rows.sort_values("load_mN") for name, rows in groups}


def loads() -> list[Comparison]:
    """Return for each series the extreme of friction that is farthest from that at the middle
    load, which is the prediction."""
    found = []
    for name, rows in series().items():
        friction = rows["friction"].to_numpy()
        expected = float(friction[len(friction) // 2])
        farthest = int(np.abs(friction - expected).argmax())
        value = float(friction[farthest])
        share = float(np.mean(np.abs(friction - expected) <= CONSTANT * expected))
        what = f"{name}, farthest at {rows['load_mN'].iloc[farthest]:g} mN"
        agrees = share == 1.0
        found.append(Comparison(what, value, expected, "", agrees))
    return found


def ranges() -> dict[str, float]:
    """Return the largest over the least friction of each series.

    A coefficient from which no measured one differs by more than a part c of it exists only if this
    is at most (1 + c) / (1 - c).
    """
    found = {}
    for name, rows in series().items():
        found[name] = float(rows["friction"].max() / rows["friction"].min())
    return found
