"""Lyapunov exponents of a motion through all its events, in particular after a loss of contact.

Columns of the variational equations are orthonormalised at equal intervals (Benettin's method).
The exponent along the motion, which is zero unless it comes to rest, is left out: the first column is
the motion's velocity, which stays so, and the others are kept orthogonal to it.
"""

import math
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from pydantic import Field, InstanceOf

from disc_model.arrays import Array, EqualByValue, Indices, Mask
from disc_model.display import drawings
from disc_model.engine import columns, loop, model, saltation, section, transitions
from disc_model.engine import state as motion
from disc_model.engine.jit.cache import compiling
from disc_model.engine.series import build_series
from disc_model.errors import Status, require
from disc_model.parameters import Parameters
from disc_model.simulation.states import (
    State,
    engine_case,
    read_state,
    series_order,
    series_tolerance,
    write_state,
)
from disc_model.stability.return_map import ENDS, longest_step
from disc_model.units import Count, Seconds, Tolerance, checked

_BLOCKS = 16  # segments of the averaging time
# orthonormalisations in the averaging time: hours of work, and 600 MB of logarithms
MOST_INTERVALS = 10_000_000
CLEAR = 4.0  # an exponent differs from zero if it exceeds this many of its errors
# share of an exponent, or difference in 1/s, to which both halves of the time agree
CONVERGED = (0.05, 0.002)


@dataclass(frozen=True, eq=False, repr=False)
class Lyapunov(EqualByValue):
    """The largest Lyapunov exponents but the one along the motion, which is zero.

    Attributes
    ----------
    status : how the computation ended; if it ended early, the exponents are those of the time covered
    exponents : 1/s, shape (count,), largest first. -inf stands for a direction in which disturbances vanish in finite
        time: stick resets f, and rigid contact resets u and u'. It also stands for a direction in which they fall
        below the tolerance within one interval; a shorter `interval` resolves it
    errors : 1/s, shape (count,): the standard error from the scatter of 16 segments of the time covered. The
        difference between its two halves replaces it if that is larger. nan for -inf
    duration : s, time covered, without that in which the columns converged
    converged : whether both halves of the time give the same finite exponent, shape (count,); see `CONVERGED`
    final_state : state at the end of the motion
    parameters : as given to `lyapunov_exponents`
    """

    status: Status
    exponents: Array
    errors: Array
    duration: float
    converged: Mask
    final_state: State
    parameters: Parameters

    def __repr__(self) -> str:
        exponents = " and ".join(f"{exponent:.3g}" for exponent in self.exponents)
        return f"Lyapunov({self.status}, over {self.duration:g} s: {exponents} 1/s)"

    def plot(self, ax: Any = None, **look: Any) -> Any:
        """Draw the exponents with their errors, hollow where they have not converged, on axes or in a
        new figure; returns the axes. `look` is as in `FloquetResult.plot`."""
        return drawings().exponents(ax, self, **look)


@checked
@compiling()
def lyapunov_exponents(
    case: Parameters,
    duration: Seconds,
    *,
    count: Annotated[Count, Field(ge=1)] = 2,
    interval: Seconds = 0.01,
    initial_state: InstanceOf[State] | None = None,
    tol: Tolerance = 1e-10,
) -> Lyapunov:
    """The `count` largest Lyapunov exponents of the motion, without the one along it, which is zero; it
    does not exist without events, as in steady sliding.

    Parameters
    ----------
    case : the case
    duration : s, averaging time. It follows an equal time in which the columns converge to their directions: with
        rates that differ by 0.05/s that takes tens of seconds
    count : 1 to 7, and fewer than the state has coordinates: 4 per pair of modes, 2 per axisymmetric one, and psi, f,
        u, u'
    interval : s, between orthonormalisations; the duration holds at most `MOST_INTERVALS` of them
    initial_state : state at the start, such as that after a transient; None is the static start
    tol : tolerance, as in `simulate`

    Returns
    -------
    Lyapunov
        It is also returned if the motion ends early: `status` then says why.

    Raises
    ------
    ParameterError
        If an argument breaks a rule; the message names each such argument, its value and the rule.

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=15)
    >>> dm.lyapunov_exponents(case, 5, initial_state=dm.floquet(case).state)
    Lyapunov(ok, over 5 s: -0.143 and -0.166 1/s)
    """
    computed = engine_case(case)
    coordinates = len(columns.coordinate_rows(computed.model))
    most = min(columns.COLUMNS_AT_ONCE, coordinates) - 1
    require(
        (count <= most, "count", count, f"must be a whole number from 1 to {most}"),
        (interval * MOST_INTERVALS >= duration, "interval", interval, "is too short"),
    )
    order = series_order(tol)
    tolerance = series_tolerance(tol, compliant=case.contact_compliance != 0)
    series = build_series(computed.model, order)
    state = model.build_state(computed.model)
    if initial_state is not None:
        write_state(computed, initial_state, state)

    # components of a column below its tolerance, or below rounding, count as zero
    vanished = max(10 * tolerance, 1e-12)
    frame = _Frame(computed.model, order, vanished)
    frame.fill(state, 1 + count)

    # the same number of intervals for convergence, counted below zero, and for the averages
    steps = max(_BLOCKS, math.ceil(duration / interval))
    length = duration / steps
    longest = longest_step(computed.model, order, 10 * tolerance)
    limits = loop.FlightLimits(
        order, tolerance, longest, length, 0, may_separate=True, tangent=True
    )
    logs = np.full((steps, 1 + count), -math.inf)
    status = Status.OK
    done = 0
    for i in range(-steps, steps):
        if i == 0:
            frame.tangent.log[:] = 0.0
        code = section.integrate(computed.model, series, state, frame.tangent, limits)
        if code != transitions.TIME_OVER:
            status = Status(ENDS[code])
            break
        if not np.all(np.isfinite(frame.columns)):
            status = Status.NON_FINITE
            break
        growth = frame.orthonormalise(state)
        if i >= 0:
            logs[i, frame.remaining] = growth
            done = i + 1

    exponents, errors, converged = averages(logs[:done], length)
    ranked = np.argsort(-exponents, kind="stable")
    # a motion at rest or in steady sliding has no exponent along it
    log = frame.tangent.log
    if log[columns.RELEASES] + log[columns.STICKS] + log[columns.SEPARATIONS] > 0:
        ranked = ranked[ranked != 0]
    ranked = ranked[:count]
    return Lyapunov(
        status=status,
        exponents=exponents[ranked],
        errors=errors[ranked],
        duration=done * length,
        converged=converged[ranked],
        final_state=read_state(computed, state),
        parameters=case,
    )


def averages(logs: Array, interval: float) -> tuple[Array, Array, Mask]:
    """Exponents, their errors, and whether they have converged, (m,) each, from logarithms of growth
    over equal times, (n, m); nan of less than 16 of them."""
    if len(logs) < _BLOCKS:
        nan = np.full(logs.shape[1], math.nan)
        return nan, nan, np.zeros(logs.shape[1], bool)
    exponents = np.sum(logs, axis=0) / (len(logs) * interval)
    blocks = np.array_split(logs, _BLOCKS)
    history = np.array([np.mean(block, axis=0) / interval for block in blocks])
    with np.errstate(invalid="ignore"):  # of -inf
        first_half, second_half = np.split(history, 2)
        drift = np.abs(np.mean(first_half, axis=0) - np.mean(second_half, axis=0))
        scatter = np.std(history, axis=0, ddof=1) / math.sqrt(_BLOCKS)
        errors = np.maximum(scatter, drift)
    share, least = CONVERGED
    converged = np.isfinite(exponents) & (drift <= np.maximum(share * np.abs(exponents), least))
    return exponents, errors, converged


class _Frame:
    """Columns of the variational equations, orthonormal in the energy norm after each interval.

    tangent, columns : the engine's arrays, and the columns in them, (rows of a column, columns)
    rows, metric : (n,) independent rows of a column, and (n, 1) factors that give their norm
    vanished : length of a column's orthogonal part, over its own, that counts as zero
    remaining : indices of the columns that have not vanished
    """

    def __init__(self, engine_model: model.Model, order: int, vanished: float) -> None:
        self.model = engine_model
        self.vanished = vanished
        self.tangent = columns.build_tangent(engine_model, columns.COLUMNS_AT_ONCE, order)
        self.columns = columns.block_of_columns(self.tangent)
        self.rows = columns.coordinate_rows(engine_model)
        self.metric = columns.energy_scale(engine_model)[self.rows, None]
        self.remaining: Indices = np.arange(0)

    def fill(self, state: motion.EngineState, count: int) -> None:
        """Set `count` columns to orthonormal ones in random directions, always the same, but the first
        to the motion's velocity, unless it is at rest."""
        drawn = np.random.default_rng(1).standard_normal((len(self.rows), count))
        self.columns[:] = 0.0
        self.columns[self.rows, :count] = drawn / self.metric
        self.remaining = np.arange(count)
        self.orthonormalise(state)
        rates = self.tangent.before
        saltation.rates(self.model, state, rates)
        velocity = rates.reshape(self.columns.shape)[:, 0]
        if np.any(velocity):
            self.columns[:, 0] = velocity

    def orthonormalise(self, state: motion.EngineState) -> Array:
        """Orthonormalise the remaining columns, and set those to zero that have vanished;
        logarithms of growth of those that remain then."""
        if motion.phase_of(state) != motion.SEPARATION:  # in contact some rows follow from others
            saltation.slider_rows(self.model, state, self.tangent)
        while True:
            places = np.ix_(self.rows, self.remaining)
            q, r = np.linalg.qr(self.columns[places] * self.metric)
            lengths = np.abs(np.diag(r))
            dependent = np.flatnonzero(lengths <= self.vanished * np.linalg.norm(r, axis=0))
            if not dependent.size:
                self.columns[places] = q / self.metric
                return np.asarray(np.log(lengths), dtype=float)
            # one at a time, because later columns were made orthogonal to a direction that is mere
            # rounding
            first = dependent[0]
            self.columns[:, self.remaining[first]] = 0.0
            self.remaining = np.delete(self.remaining, first)
