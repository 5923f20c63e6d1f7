"""How cost grows with points, modes and horizon."""

import os
import time
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import xarray as xr

from benchmarks import study
from benchmarks.study import Row
from disc_model.mode_choice import real_modes
from disc_model.studies.whole_study import run_study

Model = tuple[int, int]
"""Highest number of nodal diameters, and number of nodal circles."""

CORES = 2
SPEEDS = (5.0, 50.0)
"""Speeds of the map over speed and preload, rad/s."""
PRELOADS = (50.0, 600.0)
"""Preloads of this map, N."""
GRIDS = ((2, 5), (10, 10), (25, 40), (100, 100), (250, 400))
"""Numbers of speeds and preloads: 10 to 100,000 points."""
SEVERAL = (10, 10)
"""Points over which the cost of a point is averaged."""
HORIZON = 500.0
"""Horizon of the outcome, s."""
SHORT = 50.0
"""Horizon where the number of modes varies, s."""
MODELS: tuple[Model, ...] = ((0, 0), (1, 0), (2, 0), (4, 0), (8, 0), (8, 1))
"""1 to 34 modes."""
HORIZONS = (5.0, 15.0, 50.0, 150.0, 500.0, 1500.0)
"""Horizons whose cost is measured, s."""


def scaling(
    grids: Sequence[tuple[int, int]] = GRIDS,
    models: Sequence[Model] = MODELS,
    horizons: Sequence[float] = HORIZONS,
    several: tuple[int, int] = SEVERAL,
) -> xr.Dataset:
    """Measure the cost of studies, a row for each.

    Parameters
    ----------
    grids : numbers of speeds and preloads; growth rates leave out the first, outcomes the last
    models : numbers of modes
    horizons : of outcomes, s
    several : speeds and preloads where something else varies
    """
    points: list[Row] = []
    for grid in grids[1:]:
        points.append({"varies": "points", "quantity": "floquet", "grid": grid})
    for grid in grids[:-1]:
        points.append({"varies": "points", "quantity": "outcome", "grid": grid})
    for quantity in ("floquet", "outcome"):
        common: Row = {"varies": "modes", "quantity": quantity, "grid": several, "horizon": SHORT}
        points += [{**common, "model": model} for model in models]
    common = {"varies": "horizon", "quantity": "outcome", "grid": several}
    points += [{**common, "horizon": horizon} for horizon in horizons]
    return study.run("scaling", points, measure, title="How cost grows", Conventions="CF-1.11")


def measure(
    varies: str,
    quantity: str,
    grid: tuple[int, int],
    model: Model = (4, 0),
    horizon: float = HORIZON,
) -> Iterator[Row]:
    """Yield the cost of a study in `CORES` processes.

    Coarse and fine grids have the same mix of motions.

    Parameters
    ----------
    varies : what varies with other studies; it names the row only
    quantity : of the study
    grid : numbers of speeds and preloads
    model : modes
    horizon : of outcomes, s
    """
    options: dict[str, float] = {}
    if quantity == "outcome":
        options = {"horizon": horizon, "extrapolate": True}
    diameters, circles = model
    speeds, preloads = grid
    axes = {"Omega": _centres(*SPEEDS, speeds), "N": _centres(*PRELOADS, preloads)}
    definition: dict[str, Any] = {
        "study": "scaling",
        "quantity": quantity,
        "options": options,
        "base": {"n_diameters": diameters, "n_circles": circles},
        "axes": axes,
    }
    single = {name: values[:1] for name, values in axes.items()}
    run_study({**definition, "axes": single})  # compiles

    wall = time.perf_counter()
    began = _processor_time()
    run_study(definition, workers=CORES, processes=True)
    yield {
        "points": speeds * preloads,
        "modes": real_modes(diameters, circles),
        "horizon": options.get("horizon", 0.0),
        "seconds": _processor_time() - began,
        "wall": time.perf_counter() - wall,
    }


def _centres(low: float, high: float, count: int) -> list[float]:
    """Return the centres of equal intervals between two values."""
    places = (np.arange(count) + 0.5) / count
    return (low + (high - low) * places).tolist()


def _processor_time() -> float:
    """Return user and system time of this process and of its children that have ended, s."""
    return sum(os.times()[:4])
