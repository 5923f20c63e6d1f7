"""How cost grows: of maps with the number of points, and of a point with the number of modes and the horizon."""

import os
import time
from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr

from disc_model.benchmarks.study import Row, run
from disc_model.mode_choice import real_modes
from disc_model.studies.functions import run_study

CORES = 2
SPEEDS, PRELOADS = (5.0, 50.0), (50.0, 600.0)  # rad/s, N: the area of the map over speed and preload
GRIDS = ((2, 5), (10, 10), (25, 40), (100, 100), (250, 400))  # numbers of speeds and preloads: 10 to 100,000 points
SEVERAL = (10, 10)  # points over which the cost of a point is averaged
HORIZON, SHORT = 500.0, 50.0  # s, of the outcome, and where the number of modes varies
MODELS = ((0, 0), (1, 0), (2, 0), (4, 0), (8, 0), (8, 1))  # diameters and circles: 1 to 34 modes
HORIZONS = (5.0, 15.0, 50.0, 150.0, 500.0, 1500.0)  # s


def scaling(
    grids: Sequence[tuple[int, int]] = GRIDS,
    models: Sequence[tuple[int, int]] = MODELS,
    horizons: Sequence[float] = HORIZONS,
    several: tuple[int, int] = SEVERAL,
) -> xr.Dataset:
    """A row for each study; of ``grids``, growth rates leave out the first, outcomes the last."""
    points: list[Row] = [{"varies": "points", "quantity": "floquet", "grid": grid} for grid in grids[1:]]
    points += [{"varies": "points", "quantity": "outcome", "grid": grid} for grid in grids[:-1]]
    for quantity in ("floquet", "outcome"):
        common = {"varies": "modes", "quantity": quantity, "grid": several, "horizon": SHORT}
        points += [common | {"model": model} for model in models]
    common = {"varies": "horizon", "quantity": "outcome", "grid": several}
    points += [common | {"horizon": horizon} for horizon in horizons]
    return run("scaling", points, measure, cores=CORES, title="How cost grows", Conventions="CF-1.11")


def measure(
    varies: str, quantity: str, grid: tuple[int, int], model: tuple[int, int] = (4, 0), horizon: float = HORIZON
) -> Iterator[Row]:
    """The cost of a study in `CORES` processes as a row; coarse and fine grids have the same mix of motions."""
    options = {"horizon": horizon} if quantity == "outcome" else {}
    base = dict(zip(("n_diameters", "n_circles"), model, strict=True))
    axes = {"Omega": _centres(*SPEEDS, grid[0]), "N": _centres(*PRELOADS, grid[1])}
    study = {"study": "scaling", "quantity": quantity, "options": options, "base": base, "axes": axes}
    few = study | {"axes": {name: values[:1] for name, values in axes.items()}}
    run_study(few)  # compiles
    wall, began = time.perf_counter(), _processor_time()
    run_study(study, workers=CORES, processes=True)
    yield {
        "points": grid[0] * grid[1], "modes": real_modes(*model), "horizon": horizon if options else 0.0,
        "seconds": _processor_time() - began, "wall": time.perf_counter() - wall,
    }  # fmt: skip


def _centres(low: float, high: float, count: int) -> list[float]:
    return (low + (high - low) * (np.arange(count) + 0.5) / count).tolist()


def _processor_time() -> float:
    return sum(os.times()[:4])  # user and system time of this process and of its children that have ended, s
