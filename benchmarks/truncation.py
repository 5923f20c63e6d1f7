"""What few modes change, with rigid contact and residual flexibility: docs/options.md."""

import json
import math
import time
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import xarray as xr

from benchmarks.study import CONTACTS, TABLES, Row, run
from disc_model import mode_choice
from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import coupled_frequencies
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Window
from disc_model.simulation.states import State
from disc_model.stability.floquet import floquet

Model = tuple[int, int]
"""Highest number of nodal diameters, and number of nodal circles."""

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
    return run(
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
        "separations": run.statistics["n_separations"] / length,
        "separated_share": run.statistics["time_separation"] / length,
        "u_range": float(seen["u_max"].max() - seen["u_min"].min()),
        "force_max_separating": float(seen["P_max"].max()),
    }
