"""Lyapunov exponents of a motion through all its switches, for what follows a loss of contact.

Columns of the variational equations travel with the motion and are made orthonormal again at equal times (Benettin's
method); the mean rates at which they grow are the largest exponents.  One of them is zero, along the motion, unless
it comes to rest.  It says nothing, and a column turns towards the motion slowly; so that it can be left out: the first
column is then the motion's own rate, which stays that, and the others are kept orthogonal to it.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from disc_model.engine import exit_codes, layout, saltation, tangent, variational
from disc_model.errors import StatusBase, broken, refuse, shown
from disc_model.parameters import TOLERANCES, Parameters, is_number, limits_faults
from disc_model.progress import compiling
from disc_model.simulation.api import simulate
from disc_model.simulation.result import State, engine_case, read_state, series_order, series_tolerance, write_state
from disc_model.stability.return_map import ENDS, Array, case_faults, longest_step


class LyapunovStatus(StatusBase):
    """How the computation ended; `advice` says what to do."""

    OK = "ok", "All of the time asked for was covered."
    PARADOX = "paradox", "Painleve's paradox ended the motion: lower mu_k or N."
    STALLED = "stalled", "Switches followed each other without the clock moving: perturb the start."
    NON_FINITE = "non_finite", "The motion overflowed: check the parameters' magnitudes."
    STEP_LIMIT = "step_limit", "The transient took more steps than any motion should: check the magnitudes."


_BLOCKS = 16
MOST_INTERVALS = 10_000_000
"""Orthonormalisations in the time over which rates are averaged: hours of work, and 600 MB of logarithms."""
CLEAR = 4.0
"""An exponent is not zero if it differs from it by so many of its errors."""
CONVERGED = 0.05, 0.002
"""An exponent has converged if the first half of the time gives the same as the second, to this share or this much in
1/s."""


@dataclass(frozen=True, eq=False)
class Lyapunov:
    """The largest exponents.

    Attributes
    ----------
    status : how the computation ended; otherwise the exponents are those of the time covered
    exponents : 1/s, shape (count,), largest first. -inf stands for a direction in which small changes vanish in
        finite time: stick forgets f, and rigid contact u and u'. It also stands for one in which they fall below the
        tolerance within one interval, which a shorter `interval` resolves
    errors : 1/s, shape (count,): the standard error from the scatter between 16 stretches of the time covered, or the
        difference between its two halves if that is larger, as while the columns still turn; nan for -inf
    duration : s, time covered after the transient
    separations : losses of contact in that time
    history : 1/s, shape (16, count), the exponents of the stretches
    trivial_exponent : 1/s, the exponent along the motion that was left out; nan if none was
    final_state : where the motion ended, to go on from
    """

    status: LyapunovStatus
    exponents: Array
    errors: Array
    duration: float
    separations: int
    history: Array = field(repr=False)
    final_state: State
    trivial_exponent: float = math.nan

    @property
    def converged(self) -> NDArray[np.bool_]:
        """Whether both halves of the time give the same finite exponent, shape (count,); see `CONVERGED`."""
        share, least = CONVERGED
        same = _drift(self.history) <= np.maximum(share * np.abs(self.exponents), least)
        return np.asarray(same & np.isfinite(self.exponents))

    @property
    def chaotic(self) -> bool:
        """Whether the largest exponent is positive by more than four of its errors."""
        return bool(self.exponents[0] > CLEAR * self.errors[0] and self.exponents[0] > 0)


@compiling()
def lyapunov_exponents(
    p: Parameters,
    duration: float,
    *,
    transient: float = 0.0,
    count: int = 2,
    interval: float = 0.01,
    initial_state: State | None = None,
    tol: float = 1e-10,
    leave_out_trivial: bool = False,
) -> Lyapunov:
    """The `count` largest Lyapunov exponents of the motion.

    Parameters
    ----------
    p : the case
    duration : s, over which rates are averaged, after the transient and after as much time again, in which the columns
        turn into their directions: with rates that differ by 0.05/s that takes tens of seconds
    transient : s, simulated first and left out
    count : 1 to 8, and no more than the state has coordinates: 4 per pair of modes, 2 per axisymmetric one, and psi, f,
        u, u'; one less if the trivial one is left out
    interval : s, between orthonormalisations; at most `MOST_INTERVALS` of them make the duration
    initial_state : None is the static start
    tol : of the series
    leave_out_trivial : leave out the exponent along the motion, which is zero; there is none if no switch occurs, as in
        steady sliding

    Raises
    ------
    ParameterError
        Bad input; the message names each argument, its value and the rule.
    """
    _check(p, duration, transient, count, interval, initial_state, tol, leave_out_trivial)
    duration, transient, interval, tol = float(duration), float(transient), float(interval), float(tol)
    start = initial_state
    if transient > 0:
        begin = 0.0 if initial_state is None else initial_state.time
        run = simulate(p, begin + transient, tol=tol, initial_state=initial_state)
        start = run.final_state
        if not run.status.complete:
            return _nothing(LyapunovStatus(run.status.value), count, 0.0, start)
    case, order = engine_case(p), series_order(tol)
    model, tolerance = case.model, series_tolerance(tol, compliant=p.contact_compliance != 0)
    series, state = layout.build_series(model, order), layout.build_state(model)
    if start is not None:
        write_state(case, start, state)
    t = tangent.build_tangent(model, layout.WIDTH, order)
    columns, rows = t.now.reshape(-1, layout.WIDTH), _coordinates(model)
    metric = _metric(model)[rows, None]
    columns[:] = 0.0
    asked, count = count, count + leave_out_trivial
    columns[rows, :count] = np.random.default_rng(1).standard_normal((len(rows), count)) / metric
    if state.x[layout.PHASE] == layout.STICK:
        columns[tangent.F_ROW - tangent.N_SLIDER_ROWS] = 0.0
    # what a column has below its own tolerance, or rounding, it does not have
    vanished = max(10 * tolerance, 1e-12)
    _bind(model, state, t)
    _, left = _orthonormalise(columns, rows, metric, np.arange(count), vanished)
    if leave_out_trivial:
        saltation.rates(model, state, t.before)
        along = t.before.reshape(columns.shape)[:, 0]
        if np.any(along):
            columns[:, 0] = along
    steps = max(_BLOCKS, math.ceil(duration / interval))
    longest = longest_step(model, order, 10 * tolerance)
    length = duration / steps
    course = variational.IntegrationLimits(order, tolerance, longest, length, 0, may_separate=True, tangent=True)
    logs, status = np.full((steps, count), -math.inf), LyapunovStatus.OK
    done = 0
    for i in range(-steps, steps):
        if i == 0:
            t.log[:] = 0.0
        code = variational.integrate(model, series, state, t, course)
        if code != exit_codes.TIME_OVER or not np.all(np.isfinite(columns)):
            status = LyapunovStatus.NON_FINITE if code == exit_codes.TIME_OVER else LyapunovStatus(ENDS[code])
            break
        _bind(model, state, t)
        growth, left = _orthonormalise(columns, rows, metric, left, vanished)
        if i >= 0:
            logs[i, left] = growth
            done = i + 1
    return _summary(status, logs[:done], duration / steps, asked, t.log, read_state(case, state), leave_out_trivial)


def _orthonormalise(
    columns: Array, rows: NDArray[np.intp], metric: Array, left: NDArray[np.intp], vanished: float
) -> tuple[Array, NDArray[np.intp]]:
    """Make those columns orthonormal that are left, and zero those that depend on the others.

    rows, metric : of the coordinates, (n,); see `_metric`, (n, 1)
    left : numbers of columns
    vanished : length, relative to a column's own, of a rest that counts as none

    Returns
    -------
    logarithms of growth and numbers of the columns that are still left, one shape (at most as many as before,)
    """
    while True:
        q, r = np.linalg.qr(columns[np.ix_(rows, left)] * metric)
        lengths = np.abs(np.diag(r))
        dependent = np.flatnonzero(lengths <= vanished * np.linalg.norm(r, axis=0))
        if not dependent.size:
            columns[np.ix_(rows, left)] = q / metric
            return np.log(lengths), left
        # one at a time: those behind it were made orthogonal to a direction that means nothing
        columns[:, left[dependent[0]]] = 0.0
        left = np.delete(left, dependent[0])


def _summary(
    status: LyapunovStatus, logs: Array, interval: float, count: int, log: Array, end: State, leave_out_trivial: bool
) -> Lyapunov:
    """The `count` largest exponents of logarithms of growth over equal times, shape (n, count or one more)."""
    covered = len(logs) * interval
    if len(logs) < _BLOCKS:
        return _nothing(status, count, covered, end)
    history = np.array([np.mean(block, axis=0) / interval for block in np.array_split(logs, _BLOCKS)])
    with np.errstate(invalid="ignore"):  # of -inf
        errors = np.maximum(np.std(history, axis=0, ddof=1) / math.sqrt(_BLOCKS), _drift(history))
    exponents, trivial = np.sum(logs, axis=0) / covered, math.nan
    order = np.argsort(-exponents, kind="stable")
    # a motion that has come to rest, or slides, has no trivial one
    if leave_out_trivial and log[variational.RELEASES] + log[variational.STICKS] + log[variational.SEPARATIONS] > 0:
        trivial = float(np.sum(logs[:, 0]) / covered)
        order = order[order != 0]
    order, separations = order[:count], int(log[variational.SEPARATIONS])
    return Lyapunov(status, exponents[order], errors[order], covered, separations, history[:, order], end, trivial)


def _drift(history: Array) -> Array:
    """Difference between the means of the first stretches and of the last: (count,)."""
    one, two = np.split(history, 2)
    with np.errstate(invalid="ignore"):  # of -inf
        return np.asarray(np.abs(np.mean(one, axis=0) - np.mean(two, axis=0)))


def _nothing(status: LyapunovStatus, count: int, covered: float, state: State) -> Lyapunov:
    """No exponents: too little time was covered."""
    nan = np.full(count, math.nan)
    return Lyapunov(status, nan, nan, covered, 0, np.full((_BLOCKS, count), math.nan), state)


def _check(
    p: Parameters,
    duration: float,
    transient: float,
    count: int,
    interval: float,
    initial_state: State | None,
    tol: float,
    leave_out_trivial: bool,
) -> None:
    """Raise one ParameterError that lists every fault."""
    faults = case_faults(p, "lyapunov_exponents")
    lasts = _is_within(duration, sys.float_info.min)
    most = layout.WIDTH if faults else min(layout.WIDTH, len(_coordinates(engine_case(p).model)))
    leaves_out = isinstance(leave_out_trivial, bool | np.bool_)
    most -= leaves_out and bool(leave_out_trivial)
    counts = isinstance(count, int | np.integer) and not isinstance(count, bool) and 1 <= count <= most
    shortest = max(duration / MOST_INTERVALS if lasts else 0.0, sys.float_info.min)
    starts = initial_state is None or isinstance(initial_state, State)
    faults += broken(
        (lasts, "duration", duration, "must be finite and > 0"),
        (_is_within(transient, 0), "transient", transient, "must be finite and >= 0"),
        (counts, "count", count, f"must be a whole number from 1 to {most}"),
        (_is_within(interval, shortest), "interval", interval, f"must be finite and >= {shown(shortest)}"),
        (starts, "initial_state", initial_state, "must be a State"),
        (leaves_out, "leave_out_trivial", leave_out_trivial, "must be True or False"),
    )
    refuse([*faults, *limits_faults("tol", tol, TOLERANCES)])


def _is_within(value: object, least: float) -> bool:
    """Whether a value is a finite number, and not too small."""
    return is_number(value) and least <= value <= sys.float_info.max  # type: ignore[operator]


def _coordinates(model: layout.Model) -> NDArray[np.intp]:
    """Rows of a column but for those of lanes that hold no mode, in which rounding would stay for ever."""
    lanes, width = np.flatnonzero(model.shift), len(model.mode_amplitude)
    return np.concatenate([lanes, width + lanes, np.arange(2 * width, tangent.n_rows(model))])


def _metric(model: layout.Model) -> Array:
    """Square roots of twice the energy of a unit of each row of a column: (rows,)."""
    one, one0 = np.ones(len(model.mode_amplitude)), np.ones(len(model.mode_amplitude0))
    slider = [model.r_0 * math.sqrt(model.k_p or model.m), model.r_0 * math.sqrt(model.m)]
    contact = 1 / model.compliance[0] if len(model.compliance) == 1 else 0.0
    height = [math.sqrt(model.k + contact or model.m), math.sqrt(model.m)]
    stiffness = np.where(model.stiffness > 0, model.stiffness, 1.0)
    return np.concatenate([np.sqrt(stiffness), one, np.sqrt(model.stiffness0), one0, slider, height])


def _bind(model: layout.Model, state: layout.EngineState, t: tangent.Tangent) -> None:
    """Set u, u' of columns to those of the disc in rigid contact; between switches they are not carried along there."""
    if state.x[layout.PHASE] != layout.SEPARATION:
        saltation.slider_rows(model, state, t)
