"""Effect of truncation on the results of a study, with rigid contact and residual flexibility: docs/options.md."""

import json
import math
import time
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import xarray as xr

from disc_model.benchmarks.study import TABLES, Row, run
from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import coupled_frequencies
from disc_model.mode_choice import BAND, RICH, frequency_error, real_modes
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Window
from disc_model.simulation.states import State
from disc_model.stability.cycle import floquet

MODELS = ((0, 0), (1, 0), (2, 0), (3, 0), (4, 0), (6, 0), (8, 0), (8, 1), (8, 2), (12, 2))  # diameters, circles
SEPARATING: dict[str, dict[str, Any]] = TABLES["contact_truncation_cases"]
CONTACTS: dict[str, dict[str, Any]] = {"rigid": {}, "residual": {"contact_compliance": "residual"}}
LATE = (20.0, 10.0)  # time from the first separation to the late stretch, and its length, s
TOLERANCES = (1e-10, 1e-12, 1e-13)  # of the motion after the first separation, until one reaches the end
MOST_GROWTH = 80  # greatest number of real modes for growth rates, which need four columns for every pair


def contact_study(
    models: Sequence[tuple[int, int]] = MODELS, cases: Mapping[str, Row] = SEPARATING, *, horizon: float = 200.0
) -> xr.Dataset:
    """Measure the variables ``contact_truncation`` along (case, contact, model); nan where there is none."""

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
