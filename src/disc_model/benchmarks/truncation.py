"""Effect of truncation on the results of a study, against nodal diameters and circles: docs/truncation.md.

`truncation_study` compares normalisations; `contact_study` measures the effect of residual flexibility.
"""

import json
import math
import time
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np
import xarray as xr

from disc_model.benchmarks.study import TABLES, Row, run
from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import coupled_frequencies, mode_arrays
from disc_model.mode_choice import BAND, RICH, frequency_error, real_modes
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Window
from disc_model.simulation.states import State
from disc_model.stability.cycle import floquet

CASES: dict[str, dict[str, dict[str, Any]]] = TABLES["truncation_cases"]
"""Cases by normalisation: an unstable cycle, a motion in contact, and one that separates within a minute."""
AFTER = 1.0
"""Time after the first separation over which impacts are counted, s."""
WINDOW = (5.0, 7.0)
"""Stretch over which the range of the contact force is taken, s."""
ABOUT: dict[str, Any] = {"Conventions": "CF-1.11", "band": BAND, "compared_with": json.dumps(RICH)}
"""Attributes of both studies."""


def truncation_study(
    diameters: Sequence[int] = (1, 2, 3, 4, 6, 8, 12),
    circles: Sequence[int] = (0, 1, 2),
    normalizations: Sequence[str] = tuple(CASES),
    *,
    horizon: float = 120.0,
    growth: bool = True,
) -> xr.Dataset:
    """Measure the variables ``truncation`` along (normalization, circles, diameters); nan where there is none.

    horizon : s, of the first separation
    """

    def measure(normalization: str, circles: int, diameters: int) -> Iterator[Row]:
        size: dict[str, Any] = {"n_diameters": diameters, "n_circles": circles, "normalization": normalization}
        cases = {name: Parameters(**case, **size) for name, case in CASES[normalization].items()}
        p, modes = cases["separation"], mode_arrays(cases["separation"])
        compliance = float(np.sum(modes.psi**2))
        row = _of_the_modes(p, cases["growth"] if growth else None) | _separating(p, horizon, (0.0, AFTER))
        row |= {"omega_max": float(modes.omega.max()), "compliance": compliance}
        row |= {"impact_share": 1.0 / (1.0 + p.m * compliance)} | _contact_range(cases["range"])
        if "separations" in row:
            row["separations"] += 1 / AFTER  # the first one
        yield row

    axes = {"normalization": normalizations, "circles": circles, "diameters": diameters}
    cases = json.dumps({name: CASES[name] for name in normalizations}, sort_keys=True)
    title = "What a study needs of the modes"
    return run("truncation", _grid(axes), measure, [*axes], cases=cases, title=title, **ABOUT)


MODELS = ((0, 0), (1, 0), (2, 0), (3, 0), (4, 0), (6, 0), (8, 0), (8, 1), (8, 2), (12, 2))
"""Diameters and circles: 1 to 75 modes; (16, 4), with 165 modes, costs five times as much as 75."""
SEPARATING: dict[str, dict[str, Any]] = TABLES["contact_truncation_cases"]
CONTACTS: dict[str, dict[str, Any]] = {"rigid": {}, "residual": {"contact_compliance": "residual"}}
LATE = (20.0, 10.0)
"""Time from the first separation to the late stretch, and its length, s."""
TOLERANCES = (1e-10, 1e-12, 1e-13)
"""Tolerances of the motion after the first separation; the next one is used if the last fails to reach the end."""
MOST_GROWTH = 80
"""Greatest number of real modes for growth rates, which need a column for each of four coordinates of every pair."""


def contact_study(
    models: Sequence[tuple[int, int]] = MODELS,
    cases: Mapping[str, Mapping[str, Any]] = SEPARATING,
    *,
    horizon: float = 200.0,
) -> xr.Dataset:
    """Measure the variables ``contact_truncation`` along (case, contact, model); nan where there is none."""

    def measure(case: str, contact: str, model: str) -> Iterator[Row]:
        diameters, circles = map(int, model.split(","))
        p = Parameters(**cases[case], **CONTACTS[contact], n_diameters=diameters, n_circles=circles)
        few = real_modes(diameters, circles) <= MOST_GROWTH
        row = _of_the_modes(p, p if few else None) | _separating(p, horizon, LATE)
        yield row | {"contact_compliance": contact_compliance(p)}

    sizes = [f"{diameters},{circles}" for diameters, circles in models]
    axes = {"case": [*cases], "contact": [*CONTACTS], "model": sizes}
    about = ABOUT | {"late": json.dumps(LATE), "most_growth": MOST_GROWTH, "horizon": horizon}
    about |= {"title": "What residual flexibility changes", "cases": json.dumps(dict(cases), sort_keys=True)}
    return run("contact_truncation", _grid(axes), measure, [*axes], **about)


def _grid(axes: Mapping[str, Sequence[Any]]) -> list[Row]:
    return [dict(zip(axes, values, strict=True)) for values in product(*axes.values())]


def _of_the_modes(p: Parameters, growing: Parameters | None) -> dict[str, float]:
    """Quantities that follow from the modes alone, and the growth rate of a cycle, if it is given."""
    return {
        "modes": float(real_modes(p.n_diameters, p.n_circles)),
        "lowest_coupled": float(coupled_frequencies(p, contact_compliance(p))[0]),
        "frequency_error": frequency_error(p, p.replace(n_diameters=RICH[0], n_circles=RICH[1])),
        "growth_rate": math.nan if growing is None else float(floquet(growing).growth_rate),
    }


def _separating(p: Parameters, horizon: float, late: tuple[float, float]) -> dict[str, float]:
    """Cost of the motion up to the first separation, its time, and the motion after it, as of `_late`."""
    simulate(p, 1e-3)  # compiles
    began = time.process_time()
    first = simulate(p, horizon, events=False, stop_at="first_separation")
    row = {"cost": (time.process_time() - began) / first.final_state.time}
    if not math.isfinite(first.first_separation):
        return row
    row["first_separation"] = first.first_separation
    return row | next(filter(None, (_late(p, first.final_state, *late, tol) for tol in TOLERANCES)), {})


def _late(p: Parameters, start: State, wait: float, length: float, tol: float) -> dict[str, float]:
    """Motion for ``length`` s, from ``wait`` s after a state on; empty if it cannot be followed so far."""
    row = {"tol_late": tol}
    if wait:
        began = time.process_time()
        run = simulate(p, start.time + wait, tol=tol, initial_state=start, events=False)
        row["cost_separating"], start = (time.process_time() - began) / wait, run.final_state
        if not run.status.complete:
            return {}
    window = Window(start=start.time, stop=start.time + length, rate=20_000.0, envelope=100)
    run = simulate(p, window.stop, {"late": window}, events=False, tol=tol, initial_state=start)
    if not run.status.complete:
        return {}
    seen = run.samples["late"]
    return row | {
        "separations": run.statistics["separations"] / length,
        "separated_share": run.statistics["time_separation"] / length,
        "u_range": float(seen["u_max"].max() - seen["u_min"].min()),
        "force_max_separating": float(seen["P_max"].max()),
    }


def _contact_range(p: Parameters) -> dict[str, float]:
    """Range of the contact force in the window, and the cost of a simulated second."""
    late = Window(start=WINDOW[0], stop=WINDOW[1], rate=20_000.0, envelope=100)
    window = simulate(p, WINDOW[1], {"late": late}).samples["late"]
    cost = float(np.median([simulate(p, 1.0).statistics["wall_time"] for _ in range(11)]))
    return {"force_min": float(window["P_min"].min()), "force_max": float(window["P_max"].max()), "cost": cost}
