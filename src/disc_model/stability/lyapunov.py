"""Lyapunov exponents of a motion through all its events, in particular after a loss of contact.

Columns of the variational equations are orthonormalised at equal intervals (Benettin's method).
Columns turn slowly towards the motion, whose exponent is zero unless it comes to rest.  To leave it
out, the first column is the motion's velocity, which stays so, and the others are kept orthogonal
to it.
"""

import math
import sys
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from disc_model.display import Drawn, counted, html_table, number_text
from disc_model.engine import columns as column_arrays
from disc_model.engine import transitions
from disc_model.engine.columns import coordinate_rows, energy_scale
from disc_model.engine.jit.cache import compiling
from disc_model.engine.loop import FlightLimits
from disc_model.engine.model import build_state
from disc_model.engine.saltation import rates, slider_rows
from disc_model.engine.series import build_series
from disc_model.engine.state import SEPARATION, phase_of
from disc_model.errors import Status, as_text, raise_faults, violations
from disc_model.parameters import Parameters
from disc_model.simulation.states import (
    State,
    engine_case,
    read_state,
    series_order,
    series_tolerance,
    write_state,
)
from disc_model.stability.return_map import (
    ENDS,
    Array,
    case_faults,
    integrate_in_pieces,
    longest_step,
)
from disc_model.units import TOLERANCES, is_number, is_whole, limits_faults

_BLOCKS = 16
MOST_INTERVALS = (
    10_000_000  # orthonormalisations in the averaging time: hours of work, and 600 MB of logarithms
)
CLEAR = 4.0  # an exponent differs from zero if it exceeds this many of its errors
CONVERGED = (
    0.05,
    0.002,
)  # share of an exponent, or difference in 1/s, to which both halves of the time agree


@dataclass(frozen=True, eq=False, repr=False)
class Lyapunov(Drawn):
    """The largest Lyapunov exponents; `plot` draws them with their errors.

    Attributes
    ----------
    status : how the computation ended; if it ended early, the exponents are those of the time covered
    exponents : 1/s, shape (count,), largest first. -inf stands for a direction in which disturbances vanish in finite
        time: stick resets f, and rigid contact resets u and u'. It also stands for a direction in which they fall
        below the tolerance within one interval; a shorter `interval` resolves it
    errors : 1/s, shape (count,): the standard error from the scatter of 16 segments of the time covered. The
        difference between its two halves replaces it if that is larger. nan for -inf
    duration : s, time covered, without that in which the columns converged
    separations : losses of contact in that time
    converged : whether both halves of the time give the same finite exponent, shape (count,); see `CONVERGED`
    trivial_exponent : 1/s, the exponent along the motion that was left out; nan if none was
    final_state : state at the end of the motion
    """

    _picture = "plot_exponents"
    status: Status
    exponents: Array
    errors: Array
    duration: float
    separations: int
    converged: NDArray[np.bool_]
    final_state: State
    trivial_exponent: float = math.nan

    def __repr__(self) -> str:
        exponents = " and ".join(f"{exponent:.3g}" for exponent in self.exponents)
        return f"Lyapunov({self.status}, over {self.duration:g} s: {exponents} 1/s)"

    def _repr_html_(self) -> str:
        """The exponents in a notebook, with their errors, and what they are of."""
        rows = [
            (f"{exponent:.4g}", number_text(float(error), digits=2), "yes" if settled else "no")
            for exponent, error, settled in zip(
                self.exponents, self.errors, self.converged, strict=True
            )
        ]
        trivial = number_text(self.trivial_exponent, digits=2)
        if trivial:
            rows.append((trivial, "", "left out: along the motion"))
        lost = counted(self.separations, "separation")
        rows.append((str(self.status), f"over {self.duration:g} s", lost))
        return html_table(("exponent (1/s)", "standard error (1/s)", "converged"), rows)


@compiling()
def lyapunov_exponents(
    p: Parameters,
    duration: float,
    *,
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
    duration : s, averaging time. It follows an equal time in which the columns converge to their directions: with
        rates that differ by 0.05/s that takes tens of seconds
    count : 1 to 8, and no more than the state has coordinates: 4 per pair of modes, 2 per axisymmetric one, and psi, f,
        u, u'; one less if the trivial one is left out
    interval : s, between orthonormalisations; the duration holds at most `MOST_INTERVALS` of them
    initial_state : state at the start, such as that after a transient; None is the static start
    tol : tolerance, as in `simulate`
    leave_out_trivial : whether to leave out the exponent along the motion, which is zero; it does not exist without
        events, as in steady sliding

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
    >>> dm.lyapunov_exponents(case, 5, initial_state=dm.floquet(case).state, leave_out_trivial=True)
    Lyapunov(ok, over 5 s: -0.143 and -0.166 1/s)
    """
    raise_faults(case_faults(p, "lyapunov_exponents"))
    leaves_out = isinstance(leave_out_trivial, bool | np.bool_)
    most = min(column_arrays.COLUMNS_AT_ONCE, len(coordinate_rows(engine_case(p).model))) - (
        leaves_out and bool(leave_out_trivial)
    )
    lasts = is_number(duration) and sys.float_info.min <= duration < math.inf
    shortest = max(duration / MOST_INTERVALS if lasts else 0.0, sys.float_info.min)
    fits = is_number(interval) and shortest <= interval < math.inf
    faults = limits_faults("tol", tol, TOLERANCES) + violations(
        (lasts, "duration", duration, "must be finite and > 0"),
        (
            is_whole(count) and 1 <= count <= most,
            "count",
            count,
            f"must be a whole number from 1 to {most}",
        ),
        (fits, "interval", interval, f"must be finite and >= {as_text(shortest)}"),
        (
            isinstance(initial_state, State | None),
            "initial_state",
            initial_state,
            "must be a State",
        ),
        (leaves_out, "leave_out_trivial", leave_out_trivial, "must be True or False"),
    )
    raise_faults(faults)
    duration, interval, tol = float(duration), float(interval), float(tol)
    case, order = engine_case(p), series_order(tol)
    model, tolerance = case.model, series_tolerance(tol, compliant=p.contact_compliance != 0)
    series, state = build_series(model, order), build_state(model)
    if initial_state is not None:
        write_state(case, initial_state, state)
    t = column_arrays.build_tangent(model, column_arrays.COLUMNS_AT_ONCE, order)
    columns, rows = column_arrays.block_of_columns(t), coordinate_rows(model)
    metric = energy_scale(model)[rows, None]
    columns[:] = 0.0
    wanted, count = count, count + leave_out_trivial
    columns[rows, :count] = np.random.default_rng(1).standard_normal((len(rows), count)) / metric
    # components of a column below its tolerance, or below rounding, count as zero
    vanished = max(10 * tolerance, 1e-12)
    if phase_of(state) != SEPARATION:  # in contact some rows follow from others
        slider_rows(model, state, t)
    _, remaining = _orthonormalise(columns, rows, metric, np.arange(count), vanished)
    if leave_out_trivial:
        rates(model, state, t.before)
        along = t.before.reshape(columns.shape)[:, 0]
        if np.any(along):
            columns[:, 0] = along
    steps = max(_BLOCKS, math.ceil(duration / interval))
    longest, length = longest_step(model, order, 10 * tolerance), duration / steps
    course = FlightLimits(order, tolerance, longest, length, 0, may_separate=True, tangent=True)
    logs, status, done = np.full((steps, count), -math.inf), Status.OK, 0
    for i in range(-steps, steps):
        if i == 0:
            t.log[:] = 0.0
        code = integrate_in_pieces(model, series, state, t, course)
        if code != transitions.TIME_OVER or not np.all(np.isfinite(columns)):
            status = Status.NON_FINITE if code == transitions.TIME_OVER else Status(ENDS[code])
            break
        if phase_of(state) != SEPARATION:
            slider_rows(model, state, t)
        growth, remaining = _orthonormalise(columns, rows, metric, remaining, vanished)
        if i >= 0:
            logs[i, remaining] = growth
            done = i + 1
    return _averaged(
        status, logs[:done], length, wanted, t.log, read_state(case, state), leave_out_trivial
    )


def _orthonormalise(
    columns: Array,
    rows: NDArray[np.intp],
    metric: Array,
    remaining: NDArray[np.intp],
    vanished: float,
) -> tuple[Array, NDArray[np.intp]]:
    """Orthonormalise the columns of indices `remaining`, whose `rows` (n,) have the `metric` (n,
    1), and set those to zero whose orthogonal part is shorter than `vanished` of their own;
    logarithms of growth, and what remains."""
    while True:
        q, r = np.linalg.qr(columns[np.ix_(rows, remaining)] * metric)
        lengths = np.abs(np.diag(r))
        dependent = np.flatnonzero(lengths <= vanished * np.linalg.norm(r, axis=0))
        if not dependent.size:
            columns[np.ix_(rows, remaining)] = q / metric
            return np.log(lengths), remaining
        # one at a time, because later columns were made orthogonal to a direction that is mere
        # rounding
        columns[:, remaining[dependent[0]]] = 0.0
        remaining = np.delete(remaining, dependent[0])


def _averaged(
    status: Status,
    logs: Array,
    interval: float,
    count: int,
    log: Array,
    end: State,
    leave_out_trivial: bool,
) -> Lyapunov:
    """The `count` largest exponents from logarithms of growth over equal times, shape (n, count or
    one more)."""
    covered = len(logs) * interval
    if len(logs) < _BLOCKS:  # too little time was covered
        nan = np.full(count, math.nan)
        return Lyapunov(status, nan, nan, covered, 0, np.zeros(count, bool), end)
    history = np.array(
        [np.mean(block, axis=0) / interval for block in np.array_split(logs, _BLOCKS)]
    )
    exponents, trivial = np.sum(logs, axis=0) / covered, math.nan
    with np.errstate(invalid="ignore"):  # of -inf
        drift = np.abs(np.subtract(*(np.mean(half, axis=0) for half in np.split(history, 2))))
        errors = np.maximum(np.std(history, axis=0, ddof=1) / math.sqrt(_BLOCKS), drift)
    share, least = CONVERGED
    converged = np.isfinite(exponents) & (drift <= np.maximum(share * np.abs(exponents), least))
    order = np.argsort(-exponents, kind="stable")
    # a motion at rest or in steady sliding has no trivial exponent
    if (
        leave_out_trivial
        and log[column_arrays.RELEASES] + log[column_arrays.STICKS] + log[column_arrays.SEPARATIONS]
        > 0
    ):
        trivial = float(np.sum(logs[:, 0]) / covered)
        order = order[order != 0]
    order, separations = order[:count], int(log[column_arrays.SEPARATIONS])
    return Lyapunov(
        status,
        exponents[order],
        errors[order],
        covered,
        separations,
        converged[order],
        end,
        trivial,
    )
