"""What the size of a problem decides.

Cost grows with points, modes and horizon, and few modes change the answer.
"""

import json
import math
import os
import time
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model import mode_choice
from disc_model.benchmarks import study
from disc_model.benchmarks.study import CONTACTS, TABLES, Row
from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import coupled_frequencies
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Window
from disc_model.simulation.states import State
from disc_model.stability.cycle import floquet
from disc_model.studies.functions import run_study

Model = tuple[int, int]
"""Highest number of nodal diameters, and number of nodal circles."""

# ---- Cost of maps and of their points

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
        options["horizon"] = horizon
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
        "modes": mode_choice.real_modes(diameters, circles),
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


# ---- Effect of truncation, with rigid contact and residual flexibility: docs/options.md

TRUNCATED: tuple[Model, ...] = (
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
)
CASES: dict[str, dict[str, Any]] = TABLES["contact_truncation_cases"]
LATE = (20.0, 10.0)
"""Time from the first separation to the late stretch, and its length, s."""
TOLERANCES = (1e-10, 1e-12, 1e-13)
"""Of the motion after the first separation, until one reaches the end."""
MOST_GROWTH = 80
"""Greatest number of real modes for growth rates, which need four columns for every pair."""


def contact_study(
    models: Sequence[Model] = TRUNCATED, cases: Mapping[str, Row] = CASES, *, horizon: float = 200.0
) -> xr.Dataset:
    """Measure the variables ``contact_truncation`` along (case, contact, model); nan where there is
    none.

    Parameters
    ----------
    models : numbers of modes
    cases : parameters by name
    horizon : simulated time for the first separation, s
    """

    def measure(case: str, contact: str, model: str) -> Iterator[Row]:
        diameters, circles = map(int, model.split(","))
        p = Parameters(**cases[case], **CONTACTS[contact], n_diameters=diameters, n_circles=circles)
        yield _truncated(p, horizon)

    axes = {
        "case": [*cases],
        "contact": [*CONTACTS],
        "model": [f"{diameters},{circles}" for diameters, circles in models],
    }
    return study.run(
        "contact_truncation",
        axes,
        measure,
        title="What residual flexibility changes",
        cases=json.dumps(dict(cases), sort_keys=True),
        late=json.dumps(LATE),
        most_growth=MOST_GROWTH,
        horizon=horizon,
        Conventions="CF-1.11",
        band=mode_choice.BAND,
        compared_with=json.dumps(mode_choice.RICH),
    )


def _truncated(p: Parameters, horizon: float) -> Row:
    """Return what the modes of a case make of it, simulated up to a horizon in s."""
    compliance = contact_compliance(p)
    modes = mode_choice.real_modes(p.n_diameters, p.n_circles)
    diameters, circles = mode_choice.RICH
    rich = p.replace(n_diameters=diameters, n_circles=circles)

    simulate(p, 1e-3)  # compiles
    began = time.process_time()
    first = simulate(p, horizon, events=False, stop_at="first_separation")
    cost = (time.process_time() - began) / first.final_state.time

    late: dict[str, float] = {}
    if math.isfinite(first.first_separation):
        for tol in TOLERANCES:
            late = late or _late(p, first.final_state, tol)
    rate = math.nan
    if modes <= MOST_GROWTH:
        rate = float(floquet(p).growth_rate)
    return {
        **late,
        "cost": cost,
        "first_separation": first.first_separation,
        "modes": float(modes),
        "contact_compliance": compliance,
        "lowest_coupled": float(coupled_frequencies(p, compliance)[0]),
        "frequency_error": mode_choice.frequency_error(p, rich),
        "growth_rate": rate,
    }


def _late(p: Parameters, start: State, tol: float) -> dict[str, float]:
    """Return what the late stretch of the motion after a state is like.

    It is empty if the motion cannot be followed so far with this tolerance.
    """
    wait, length = LATE
    began = time.process_time()
    settling = simulate(p, start.time + wait, tol=tol, initial_state=start, events=False)
    cost = (time.process_time() - began) / wait
    if not settling.status.complete:
        return {}
    state = settling.final_state
    window = Window(start=state.time, stop=state.time + length, rate=20_000.0, envelope=100)
    run = simulate(p, window.stop, {"late": window}, events=False, tol=tol, initial_state=state)
    if not run.status.complete:
        return {}
    seen = run.samples["late"]
    return {
        "tol_late": tol,
        "cost_separating": cost,
        "separations": run.statistics["separations"] / length,
        "separated_share": run.statistics["time_separation"] / length,
        "u_range": float(seen["u_max"].max() - seen["u_min"].min()),
        "force_max_separating": float(seen["P_max"].max()),
    }
