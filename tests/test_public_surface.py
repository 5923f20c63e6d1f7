"""Wrong numbers, for each argument of every public function that is one: each is named."""

import inspect
import math
import re
from collections.abc import Callable
from typing import Any

import pytest
import xarray as xr

import disc_model as dm

P = dm.Parameters(N=200, Omega=20, n_diameters=1)
WRONG: dict[str, Any] = {"nan": math.nan, "negative": -1.5, "huge": math.inf}
NUMBER = r"\b(float|int|Seconds|Tolerance|CycleTolerance|Count|Finite|Positive)\b"
SLIPPING = dm.simulate(P, 2.5e-3).final_state
RUN = dm.simulate(P, 1e-4, {"all": dm.Window(rate=1e5)})
GRID = xr.Dataset({"growth_rate": ("Omega", [0.1, 0.2])}, {"Omega": [1.0, 2.0]})
DISC = dm.Disc(diameters=[0], omega=[1e3], amplitude=[1.0])
FREQUENCY = [{"quantity": "frequency_0_0", "value": 239.0, "uncertainty": 1.0}]
PLANE = {"case": P, "bounds": {"Omega": (10.0, 30.0), "N": (100, 300)}, "lines": (200.0,)}


def start(**changes: Any) -> None:
    dm.simulate(P, 1.0, initial_state=SLIPPING.replace(**{"time_low": SLIPPING.time_low} | changes))


def run(**options: Any) -> None:
    dm.simulate(P, 1.0, execution=dm.Execution(**options))


start.__signature__ = inspect.signature(dm.State)  # type: ignore[attr-defined]
run.__signature__ = inspect.signature(dm.Execution)  # type: ignore[attr-defined]
PICTURE = {"ax": "None", "units": "None"}
CALLS = {"workers": "huge", "processes": "True", "executor": "None", "progress": "True"}
SHAPES = {"case": P, "states": RUN.final_state, "r": 0.1, "theta": 0.0}
#: Functions, right arguments, and by argument those of `WRONG` that are right as well.
SURFACE: list[tuple[Any, dict[str, Any], dict[str, str]]] = [
    *(
        (function, {}, {})
        for function in (dm.plate_modes, dm.coupled_natural_frequencies, dm.residual_flexibility)
    ),
    (dm.steady_sliding, {}, {}),
    (dm.squeal, {"case": P, "bounds": (10, 12), "points": 2}, {}),
    (dm.choose_modes, {"case": P, "quantity": "sliding_growth"}, {"tolerance": "None"}),
    (
        dm.simulate,
        {"case": P, "t_end": 1.0},
        dict.fromkeys(("initial_state", "windows", "stop_at", "duration"), "None")
        | {"events": "True"},
    ),
    (dm.initial_state, {"case": P}, {"start": "None", "prerun": "None"}),
    (dm.outcome, {"case": P}, {"start": "None", "early_end": "True", "extrapolate": "True"}),
    (
        dm.critical_speed,
        {"case": P},
        {"early_end": "True", "extrapolate": "True", "progress": "True", "precision": "None"},
    ),
    (dm.basins, {"case": P}, {"start": "None", "seed": "huge", "progress": "True"}),
    (dm.hysteresis, {"case": P, "bounds": (10, 12), "dwell": 5}, {}),
    (
        dm.sweep,
        {"function": dm.floquet, "case": P, "N": [9]},
        CALLS | {"over": "None", "zip": "None", "named": WRONG},
    ),
    (
        dm.run_study,
        {
            "source": {
                "study": "s",
                "quantity": "floquet",
                "base": {"N": 200},
                "axes": {"Omega": [20]},
            }
        },
        CALLS | {"source": "text dict"},
    ),
    (dm.plot_modes, {"case": P}, {"most": "huge"}),
    (dm.fit, {"case": P, "vary": ["E"], "data": FREQUENCY}, {"bounds": "None"}),
    (dm.plot_sweep, {"study": GRID}, PICTURE),
    (RUN.plot, {"windows": "all"}, PICTURE | {"windows": "None"}),
    (RUN.plot_phase_portrait, {"window": "all"}, PICTURE | {"window": "None"}),
    (
        RUN.plot_spectrum,
        {"window": "all", "highest": 2e4},
        PICTURE | {"window": "None", "highest": "None"},
    ),
    (RUN.plot_poincare, {}, PICTURE | {"window": "None"}),
    *((found.plot, {}, PICTURE) for found in (dm.floquet(P), dm.steady_sliding(P))),
    (dm.continue_cycle(P, "Omega", (19.9, 20.1)).plot, {}, PICTURE),
    (RUN.__getitem__, {}, {}),
    (DISC.to_csv, {}, {"path": "text"}),
    (dm.Disc.from_csv, {"path": "none.csv"}, {"path": "text"}),
    (
        dm.Disc.from_uff,
        {
            "path": "none.uff",
            "r_0": 0.1,
            "axis": (0, 0, 1),
            "centre": (0, 0, 0),
            "units": ("m", "N"),
        },
        {"path": "text"},
    ),
    (
        RUN.animate,
        {"window": "all", "frames": 2},
        {"window": "None", "path": "None", "frames": "huge", "fps": "huge"},
    ),
    (run, {}, {"progress": "None", "max_steps": "None huge", "audit_every_step": "True"}),
    (
        start,
        {},
        dict.fromkeys(("time", "psi", "u_velocity", "surface_turn"), "negative")
        | {"mode_amplitudes": "None", "case_key": [*WRONG], "drive_angle": "None negative"},
    ),
    (RUN.final_state.material_angle, {}, {}),
    (dm.snapshots, {"case": P, "times": 1e-4}, {"initial_state": "None", "times": "nothing"}),
    (dm.deflection, SHAPES, {"theta": "negative nothing", "states": "nothing"}),
    (dm.floquet, {"case": P}, {"guess": "None"}),
    (
        dm.continue_cycle,
        {"case": P, "name": "Omega", "bounds": (10.0, 30.0)},
        {
            "guess": "None",
            "direction": "True",
            "values": "nothing",
            "stop_at": "None nothing",
            "progress": "True",
        },
    ),
    (dm.StepControl, {}, {"max_points": "huge", "step": "True"}),
    (dm.critical, {"case": P, "name": "N", "bounds": (1, 2), "points": 2}, {"progress": "True"}),
    (dm.neutral_curves, PLANE, {"max_points": "huge", "lines": "nothing"}),
    (dm.lyapunov_exponents, {"case": P, "duration": 0.1}, {"initial_state": "None"}),
    (
        dm.Window,
        {"rate": 1.0},
        {"last": "None", "envelope": "None", "stop": "huge", "theta": "negative"},
    ),
    (dm.Poincare, {}, {"stop": "huge", "theta": "negative"}),
    (dm.Ramp, {"parameter": "N", "to": 1.0, "start": 0.0, "end": 2.0}, {}),
    (RUN.save, {}, {}),
    (RUN.to_csv, {}, {"path": "text"}),
    (dm.save, {"data": GRID, "path": "x.nc"}, {}),
    (dm.words, {"data": GRID}, {}),
    *((function, {}, {"path": "text"}) for function in (dm.load, dm.Result.load)),
]
ARGUMENTS = [
    pytest.param(function, others, name, right.get(name, ""), id=f"{function.__qualname__}-{name}")
    for function, others, right in SURFACE
    for name, argument in inspect.signature(function).parameters.items()
    if re.search(NUMBER, str(argument.annotation)) and name not in ("start", "_roots")
]


@pytest.mark.parametrize(("function", "others", "name", "right"), ARGUMENTS)
def test_a_wrong_number_is_named(function, others, name, right, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for label, value in WRONG.items():
        if label not in right:
            with pytest.raises(dm.ParameterError) as error:
                function(**others | {name: value})
            assert any(name in re.findall(r"\w+", str(fault)) for fault in error.value.faults), (
                label
            )


RESULTS: tuple[Callable[[dm.Parameters], Any], ...] = (
    dm.floquet,
    dm.steady_sliding,
    dm.residual_flexibility,
    lambda case: dm.critical(case, "Omega", (20, 21), points=3),
    lambda case: dm.lyapunov_exponents(case, 0.2, count=1),
    lambda case: dm.simulate(case, 0.01),
)


@pytest.mark.parametrize("compute", RESULTS)
def test_results_are_equal_if_their_numbers_are(compute: Callable[[dm.Parameters], Any]) -> None:
    """They were equal only to themselves."""
    case = P.replace(normalization="orthonormal")
    first = compute(case)
    assert first == compute(case)
    assert hash(first) == hash(compute(case))
    assert first != compute(case.replace(E=1.01 * case.E))
    assert first != 3
