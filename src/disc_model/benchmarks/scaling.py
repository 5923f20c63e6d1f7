"""What the size of a problem decides: how cost grows with points, modes and horizon, and what few
modes change."""

import json
import math
import os
import time
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.benchmarks.study import CONTACTS, TABLES, Row, run
from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import coupled_frequencies
from disc_model.mode_choice import BAND, RICH, frequency_error, real_modes
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Window
from disc_model.simulation.states import State
from disc_model.stability.cycle import floquet
from disc_model.studies.functions import run_study

# ---- Cost of maps and of their points
CORES = 2
SPEEDS, PRELOADS = (
    (5.0, 50.0),
    (50.0, 600.0),
)  # rad/s, N: the area of the map over speed and preload
GRIDS = (
    (2, 5),
    (10, 10),
    (25, 40),
    (100, 100),
    (250, 400),
)  # numbers of speeds and preloads: 10 to 100,000 points
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
    points: list[Row] = [
        {"varies": "points", "quantity": "floquet", "grid": grid} for grid in grids[1:]
    ]
    points += [{"varies": "points", "quantity": "outcome", "grid": grid} for grid in grids[:-1]]
    for quantity in ("floquet", "outcome"):
        common = {"varies": "modes", "quantity": quantity, "grid": several, "horizon": SHORT}
        points += [common | {"model": model} for model in models]
    common = {"varies": "horizon", "quantity": "outcome", "grid": several}
    points += [common | {"horizon": horizon} for horizon in horizons]
    return run("scaling", points, measure, title="How cost grows", Conventions="CF-1.11")


def measure(
    varies: str,
    quantity: str,
    grid: tuple[int, int],
    model: tuple[int, int] = (4, 0),
    horizon: float = HORIZON,
) -> Iterator[Row]:
    """The cost of a study in `CORES` processes as a row; coarse and fine grids have the same mix of
    motions."""
    options = {"horizon": horizon} if quantity == "outcome" else {}
    base = dict(zip(("n_diameters", "n_circles"), model, strict=True))
    axes = {"Omega": _centres(*SPEEDS, grid[0]), "N": _centres(*PRELOADS, grid[1])}
    study = {
        "study": "scaling",
        "quantity": quantity,
        "options": options,
        "base": base,
        "axes": axes,
    }
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
    return sum(
        os.times()[:4]
    )  # user and system time of this process and of its children that have ended, s


# ---- Effect of truncation, with rigid contact and residual flexibility: docs/options.md
TRUNCATED = (
    (0, 0),
    (1, 0),
    (2, 0),
    (3, 0),
    (4, 0),
    (6, 0),
    (8, 0),
    (8, 1),
    (8, 2),
    (12, 2),
)  # diameters, circles
CASES: dict[str, dict[str, Any]] = TABLES["contact_truncation_cases"]
LATE = (20.0, 10.0)  # time from the first separation to the late stretch, and its length, s
TOLERANCES = (
    1e-10,
    1e-12,
    1e-13,
)  # of the motion after the first separation, until one reaches the end
MOST_GROWTH = (
    80  # greatest number of real modes for growth rates, which need four columns for every pair
)


def contact_study(
    models: Sequence[tuple[int, int]] = TRUNCATED,
    cases: Mapping[str, Row] = CASES,
    *,
    horizon: float = 200.0,
) -> xr.Dataset:
    """Measure the variables ``contact_truncation`` along (case, contact, model); nan where there is
    none."""

    def measure(case: str, contact: str, model: str) -> Iterator[Row]:
        diameters, circles = map(int, model.split(","))
        p = Parameters(**cases[case], **CONTACTS[contact], n_diameters=diameters, n_circles=circles)
        modes, compliance = real_modes(diameters, circles), contact_compliance(p)
        simulate(p, 1e-3)  # compiles
        began = time.process_time()
        first = simulate(p, horizon, events=False, stop_at="first_separation")
        cost = (time.process_time() - began) / first.final_state.time
        separates = math.isfinite(first.first_separation)
        late = (_late(p, first.final_state, tol) for tol in TOLERANCES if separates)
        yield next(filter(None, late), {}) | {
            "cost": cost, "first_separation": first.first_separation,
            "modes": float(modes), "contact_compliance": compliance,
            "lowest_coupled": float(coupled_frequencies(p, compliance)[0]),
            "frequency_error": frequency_error(p, p.replace(n_diameters=RICH[0], n_circles=RICH[1])),
            "growth_rate": float(floquet(p).growth_rate) if modes <= MOST_GROWTH else math.nan,
        }  # fmt: skip

    sizes = [f"{diameters},{circles}" for diameters, circles in models]
    axes = {"case": [*cases], "contact": [*CONTACTS], "model": sizes}
    return run(
        "contact_truncation", axes, measure, title="What residual flexibility changes",
        cases=json.dumps(dict(cases), sort_keys=True), late=json.dumps(LATE), most_growth=MOST_GROWTH, horizon=horizon,
        Conventions="CF-1.11", band=BAND, compared_with=json.dumps(RICH),
    )  # fmt: skip


def _late(p: Parameters, start: State, tol: float) -> dict[str, float]:
    """The late stretch of the motion after a state; empty if it cannot be followed so far."""
    wait, length = LATE
    began = time.process_time()
    run = simulate(p, start.time + wait, tol=tol, initial_state=start, events=False)
    cost, start = (time.process_time() - began) / wait, run.final_state
    if not run.status.complete:
        return {}
    window = Window(start=start.time, stop=start.time + length, rate=20_000.0, envelope=100)
    run = simulate(p, window.stop, {"late": window}, events=False, tol=tol, initial_state=start)
    if not run.status.complete:
        return {}
    seen = run.samples["late"]
    return {
        "tol_late": tol, "cost_separating": cost, "separations": run.statistics["separations"] / length,
        "separated_share": run.statistics["time_separation"] / length,
        "u_range": float(seen["u_max"].max() - seen["u_min"].min()),
        "force_max_separating": float(seen["P_max"].max()),
    }  # fmt: skip
