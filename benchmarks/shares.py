"""Where the time of quantities goes: simulation, Newton's method, return maps, and the rest."""

import cProfile
import inspect
import pstats
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any
from unittest import mock

import numpy as np
import xarray as xr

from benchmarks import study
from disc_model.simulation.api import simulate
from disc_model.simulation.run import Run
from disc_model.stability import return_map
from disc_model.studies.whole_study import run_study

Definition = Mapping[str, Any]

_PLANE = {
    "Omega": {"start": 5, "stop": 50, "count": 13},
    "N": {"start": 50, "stop": 600, "count": 13},
}
_SEPARATED = {"start": {"prerun": {"parameters": {"N": 385, "Omega": 15.1}, "time": 70}}}
_SCATTER = {"distribution": "uniform", "low": 0.95, "high": 1.05, "relative": True}
SAMPLES: dict[str, Definition] = {
    "sliding_modes": {
        "options": {"name": "c_p", "bounds": [0, 1], "step": 0.0625},
        "base": {"Omega": 15},
        "axes": {"N": [200, 385]},
    },
    "campbell": {"options": {"bounds": [5, 25], "step": 0.5}, "axes": {"N": [385]}},
    "floquet": {"axes": _PLANE},
    "regions": {"options": {"horizon": 500}, "axes": _PLANE},
    "outcome": {"options": {"horizon": 500}, "axes": _PLANE},
    "critical_speed": {
        "options": {"horizon": [500, 1000], "bounds": [5, 24], "step": 1},
        "axes": {"N": [150, 200, 385]},
    },
    "sensitivity": {
        "options": {
            "samples": 64,
            "simulated_samples": 16,
            "horizon": 1000,
            "distributions": {"E": _SCATTER, "k": _SCATTER},
        },
        "axes": {"N": [385], "Omega": [15]},
    },
    "bifurcation": {
        "options": {**_SEPARATED, "transient": 15},
        "base": {"N": 385},
        "axes": {"Omega": [8, 12, 16, 20]},
    },
    "lyapunov_exponents": {
        "options": {**_SEPARATED, "transient": 15, "duration": 30},
        "base": {"N": 385},
        "axes": {"Omega": [8, 12, 16, 20]},
    },
    "locking": {
        "options": {"start": {"prerun": {"parameters": {"Omega": 20}, "time": 560}}},
        "base": {"N": 200},
        "axes": {"Omega": {"start": 19.8, "stop": 20.2, "count": 5}},
    },
    "range_law": {"axes": {"N": [200, 385], "Omega": [20, 30]}},
    "hysteresis": {
        "options": {"bounds": [12, 16], "step": 0.5, "dwell": 60, "max_dwell": 480, "tol": 1e-8},
        "axes": {"N": [250]},
    },
    "ramps": {
        "options": {"bounds": [8, 23], "rates": {"start": 0.04, "stop": 0.4, "count": 3}},
        "axes": {"N": [385]},
    },
    "basins": {
        "options": {"energies": [0.1, 1], "n_starts": 4, "horizon": 500, "tol": 1e-8},
        "base": {"N": 385},
        "axes": {"Omega": [12, 15]},
    },
    "branches": {
        "options": {"bounds": [9, 17], "step": 1, "sweep_from": 11.5, "dwell": 40},
        "axes": {"N": [385]},
    },
    "neutral_curves": {
        "options": {
            "x": "Omega",
            "y": "N",
            "bounds": [10, 25],
            "lines": {"start": 275, "stop": 475, "count": 3},
        },
        "axes": {"normalization": ["as_published"]},
    },
}
"""Studies of the paper's disc of some seconds each, by quantity."""
_OF_NEWTON = (return_map.newton, return_map._search_along_step)
"""What follows orbits for Newton's method."""


def shares(samples: Mapping[str, Definition] = SAMPLES) -> xr.Dataset:
    """Measure where the processor time of quantities goes, a row for each.

    Parameters
    ----------
    samples : options, base and axes of a study of each quantity
    """
    points: list[study.Row] = [{"quantity": quantity} for quantity in samples]

    def measure(quantity: str) -> Iterator[study.Row]:
        yield measured_shares({"study": "shares", "quantity": quantity, **samples[quantity]})

    title = "Where the time of quantities goes"
    return study.run("shares", points, measure, title=title, Conventions="CF-1.11")


def measured_shares(definition: Definition) -> study.Row:
    """Return processor times (s) and simulated time (s) of a study, which is run twice: kernels are
    compiled first.

    What simulation, Newton's method and return maps take includes the Python that calls their
    kernels; what Newton's method takes includes its return maps.
    """
    run_study(definition)
    with _simulated_times() as simulated:
        profile = cProfile.Profile()
        profile.enable()
        result = run_study(definition)
        profile.disable()
    stats = pstats.Stats(profile)
    whole = stats.total_tt  # type: ignore[attr-defined]
    simulation = _time_in(stats, simulate)
    by_newton = _time_in(stats, return_map.newton)
    maps = _time_in(stats, return_map.ReturnMap._follow_to_release)
    maps += _time_in(stats, return_map.ReturnMap.evaluate, but_for=_OF_NEWTON)
    return {
        "points": int(np.size(result["status"])),
        "seconds": whole,
        "simulation": simulation,
        "newton": by_newton,
        "return_maps": maps,
        "rest": whole - simulation - by_newton - maps,
        "simulated": sum(simulated),
    }


@contextmanager
def _simulated_times() -> Iterator[list[float]]:
    """Collect how long each motion is that is simulated in the block, s."""
    times = []
    complete = Run.complete

    def noted(run: Run) -> Any:
        result = complete(run)
        times.append(result.final_state.time - run.request.start)
        return result

    with mock.patch.object(Run, "complete", noted):
        yield times


def _time_in(
    stats: pstats.Stats, function: Callable[..., Any], but_for: tuple[Callable[..., Any], ...] = ()
) -> float:
    """Return the time spent in a function and what it calls, s, without calls by some others."""
    timings = stats.stats  # type: ignore[attr-defined]
    key = _key(function)
    if key not in timings:
        return 0.0
    _, _, _, whole, callers = timings[key]
    for caller in map(_key, but_for):
        if caller in callers:
            whole -= callers[caller][3]
    return float(whole)


def _key(function: Callable[..., Any]) -> tuple[str, int, str]:
    """Return the name of a function in a profile, without what wraps it."""
    code = inspect.unwrap(function).__code__
    return code.co_filename, code.co_firstlineno, code.co_name
