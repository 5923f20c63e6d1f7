"""Bifurcation diagrams: the motion after a transient, sampled once a turn of the drive, against one parameter."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from disc_model.data.variables import SERIES, Variable
from disc_model.errors import Status, raise_faults, violations
from disc_model.parameters import Parameters, foreign_case, is_number, is_whole
from disc_model.progress import compiling
from disc_model.simulation.api import simulate, transfer_state
from disc_model.simulation.case import Poincare, Record
from disc_model.simulation.result import State, is_finite_array

if TYPE_CHECKING:
    import xarray as xr

SAMPLED = ("psi", "psi_velocity", "P", "u", "w_point")
MOST_SAMPLES = 1_000_000
"""Largest number of samples for one value of the parameter: hours of work, and 40 MB."""
STATUS_NAMES = tuple(status.value for status in Status)


@compiling()
def bifurcation_samples(
    p: Parameters,
    name: str,
    values: Iterable[float],
    *,
    transient: float,
    samples: int,
    initial_state: State | Literal["previous"] | None = None,
    theta: float = 1.0,
    tol: float = 1e-10,
) -> xr.Dataset:
    """Samples of the motion at t = i 2 pi / Omega, after a transient, for each value of a parameter.

    Parameters
    ----------
    p : the case
    name : a numeric parameter, such as Omega, N, c_p or k_p
    values : values of the parameter in SI units, in the order of simulation
    transient : s, duration before the samples, at every value
    samples : number of turns sampled after the transient
    initial_state : state at the start of each value; None is the static start. With "previous" the first value has the
        static start, and each further one the end of the one before: values that rise and then fall show hysteresis
    theta : rad, angle at which `w_point` is taken
    tol : as in `simulate`

    Returns
    -------
    Dataset with dimensions (the parameter, sample): psi, psi_velocity, P, u, w_point, phase; for each value
    first_separation (s), separations, stick_fraction and status of its run.  Samples that a run did not reach are nan
    (phase -1), and its status gives the reason.

    Raises
    ------
    ParameterError
        If an argument breaks a rule; the message names each such argument, its value and the rule.
    """
    import xarray as xr

    values = list(values) if np.iterable(values) and not isinstance(values, str | bytes | Mapping) else values
    _check(p, name, values, transient, samples, initial_state)
    values = list(map(float, values))
    cases = [p.replace(**{name: value}) for value in values]
    shape = (len(values), samples)
    data = {variable: np.full(shape, math.nan) for variable in SAMPLED}
    phase = np.full(shape, -1, np.int8)
    first, stick = np.full(len(values), math.nan), np.full(len(values), math.nan)
    separations, status = np.zeros(len(values), np.int64), np.zeros(len(values), np.int8)
    given, follow = (None, True) if isinstance(initial_state, str) else (initial_state, False)
    for i, case in enumerate(cases):
        start = None if given is None else transfer_state(case, given)
        turn = 2 * math.pi / case.Omega
        begin = math.ceil(transient / turn)
        end = (begin + samples - 0.5) * turn
        record = Record(poincare=Poincare(start=(begin - 0.25) * turn if begin else 0.0, stop=end, theta=theta))
        run = simulate(case, end, tol=tol, initial_state=start, record=record)
        taken = run.poincare or {}
        count = min(samples, len(taken["time"]))
        for variable, array in (data | {"phase": phase}).items():
            array[i, :count] = taken[variable][:count]
        first[i], separations[i] = run.first_separation, int(run.statistics["separations"])
        reached = run.final_state.time
        stick[i] = run.statistics["time_stick"] / reached if reached else math.nan
        status[i] = STATUS_NAMES.index(run.status.value)
        if follow and run.status.complete:
            given = run.final_state
    both, one = (name, "sample"), (name,)
    variables = {key: (both, array, SERIES[key].attributes) for key, array in data.items()}
    flags = {"flag_values": np.array([-1, 0, 1, 2], np.int8), "flag_meanings": "none stick slip separation"}
    codes = np.arange(len(STATUS_NAMES), dtype=np.int8)
    return xr.Dataset(
        {
            **variables,
            "phase": (both, phase, flags),
            "first_separation": (one, first, Variable("s", "first loss of contact of the run").attributes),
            "separations": (one, separations, Variable("1", "losses of contact in the run").attributes),
            "stick_fraction": (one, stick, Variable("1", "share of the run in stick").attributes),
            "status": (one, status, {"flag_values": codes, "flag_meanings": " ".join(STATUS_NAMES)}),
        },
        coords={name: (one, values, {"units": Parameters.unit(name)}), "sample": np.arange(samples)},
        attrs={"parameters": p.canonical_json, "transient": transient, "tol": tol, "follow": int(follow)},
    )


def _check(p: object, name: str, values: Any, transient: float, samples: int, initial_state: object) -> None:
    wrong = foreign_case(p)
    known = isinstance(name, str) and name in Parameters.model_fields
    real = known and (wrong or isinstance(getattr(p, name), float))
    numbers = is_finite_array(values) and len(values) > 0
    speeds = [getattr(p, "Omega", 1.0)] if not known or name != "Omega" else values if numbers else [1.0]
    counts = is_whole(samples) and 1 <= samples <= MOST_SAMPLES
    lasts = is_number(transient) and 0 <= transient < math.inf
    starts = isinstance(initial_state, State | None) or (isinstance(initial_state, str) and initial_state == "previous")
    wrong += violations(
        (real, "name", name, "must be a parameter that is a real number"),
        (numbers, "values", values, "must be finite numbers, one or more"),
        (lasts, "transient", transient, "must be finite and >= 0"),
        (counts, "samples", samples, f"must be a whole number from 1 to {MOST_SAMPLES}"),
        (starts, "initial_state", initial_state, "must be a State or 'previous'"),
        (min(speeds) > 0, "Omega", min(speeds), "must be > 0, because samples are taken once a turn"),
    )
    raise_faults(wrong)
