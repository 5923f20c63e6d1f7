"""`fit`: parameters of a case from measurements, by weighted least squares.

With the measured values y_i, their standard deviations s_i and the predictions f_i(q), the fit
minimises the sum of ((f_i(q) - y_i) / s_i)^2 over the parameters q. Near the minimum the estimates
scatter with the covariance (J^T J)^-1, where J is the Jacobian of the weighted deviations: as far
as f is linear in q over this scatter, errors are normal and independent, and s_i are right.

Derivatives are central differences: predictions of modes and cycles are accurate to 1e-12 or
better, so that a relative step of 1e-4 leaves errors of some 1e-8 of a derivative.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from disc_model.arrays import Array
from disc_model.disc.plausibility import trial_cases, warn_of_doubts
from disc_model.fitting.arguments import (
    Interval,
    check_progress,
    checked_measurements,
    doubt_far_measurements,
    limits_in_si,
)
from disc_model.fitting.limits import limits_of_cases, limits_of_interval, with_limits
from disc_model.fitting.measured import Measurement
from disc_model.fitting.outcome import Outcome, fit_of
from disc_model.fitting.problem import Problem
from disc_model.fitting.result import Fit
from disc_model.fitting.search import Search
from disc_model.parameters import Parameters

SHARES_OF_MARGIN = (1.0, 0.1, 0.01)
"""Shares of the way from a limit that are tried."""
MARGIN = 0.01
"""Distance of the first step from limits, relative to a parameter's scale."""


def fit(
    case: Parameters,
    vary: Sequence[str],
    measured: Mapping[str, tuple[Any, Any]] | Sequence[Measurement] | pd.DataFrame,
    *,
    bounds: Mapping[str, tuple[Any, Any]] | None = None,
    confidence: float = 0.95,
    progress: bool = False,
) -> Fit:
    """Fit parameters of a case to measurements by weighted least squares.

    Parameters
    ----------
    case : the case; its values of the varied parameters are the start of the search
    vary : names of the parameters that are fitted, each one of `Parameters.numbers`, such as ``mu_s``, the ratio
        ``mu_k_over_mu_s``, or ``omega_2_0`` of a disc given by its modes
    measured : values with their standard deviations by the names of their quantities, all for it; or
        `Measurement` objects, which may differ in what was set, such as the speed; or a table with the columns
        ``quantity``, ``value``, ``uncertainty`` and numbers of the case that were set, such as ``Omega``, in which an
        empty cell stands for the value of the case, beside columns for readers such as ``comment``
    bounds : least and greatest value of varied parameters, by name; needed where the start is 0
    confidence : probability of the confidence intervals
    progress : whether standard error shows how many sets of values were tried; how many there will be is not known

    Returns
    -------
    Fit
        Its intervals hold as far as the predictions are linear in the parameters over their uncertainties, and the
        model and the stated uncertainties are right; `Fit.consistent` tests the latter.

    Raises
    ------
    ParameterError
        If an argument breaks a rule, the case has no such quantity at the start of the search, or parameters have no
        effect at all, or exactly that of others. Of those that are hardly determined `Fit.doubt` tells. Or if a time or
        length of a cycle is more than a hundred times what the case gives at the start, or less than a hundredth: its
        unit is probably another one, and a search from so far away may take hours.

    Notes
    -----
    Derivatives are central differences of relative step 1e-4. A trial case that breaks a rule, such as mu_k <= mu_s,
    or has no such quantity, makes the next step shorter. A frequency that is a hundred times what the case gives at the
    start, or a hundredth, is an `ImplausibleValue`, since its unit is probably another one.

    Quantities of a cycle are those near the static start. Another of several cycles is measured by a function of the
    case, as with the last `state` of a simulation: ``lambda case: floquet(case, guess=state, releases=2).period``.

    Examples
    --------
    >>> import disc_model as dm
    >>> p = dm.Parameters(N=385, Omega=15, normalization="orthonormal")
    >>> measured = {"frequency_0_0": (239.0, 0.5), "frequency_2_0": (292.5, 0.5)}
    >>> found = dm.fit(p, vary=["E", "nu"], measured=measured)
    >>> found
    Fit(E=1.52256e+11 ± 4.5e+08, nu=0.208709 ± 0.0056; ± one standard deviation; chi squared ...)
    """
    check_progress(progress)
    measurements = checked_measurements(case, vary, measured, bounds, confidence)
    limits = limits_in_si(vary, bounds or {})
    scales = {name: high - low for name, (low, high) in limits.items() if case.numbers[name] == 0}
    problem = Problem(case, vary, measurements, scales)
    start = np.array([case.numbers[name] for name in vary])
    begin = _inside(problem, start, limits)
    begin = _predictable(problem, start, begin)
    warn_of_doubts(case)
    search = Search(problem)

    # the start and the result are doubted, not what is tried on the way
    with problem.counted(progress), trial_cases():
        computed = problem.first_predictions(begin)
        doubt_far_measurements(measurements, computed.tolist())
        outcome = _search(search, begin, limits, confidence)
        found = fit_of(search, outcome, confidence)
        found = with_limits(found, problem, outcome.end, search.deviations)
    warn_of_doubts(found.case)
    return found


def _inside(problem: Problem, start: Array, limits: Mapping[str, Interval]) -> Array:
    """Return the start of the search, (n,), away from its limits: the first steps of the search are
    as long as the way to a limit, and the effect of one that short may be lost in rounding."""
    moved = start.copy()
    for i, name in enumerate(problem.names):
        if name in limits:
            low, high = limits[name]
            margin = min(MARGIN * problem.scale[i], 0.5 * (high - low))
            moved[i] = min(max(start[i], low + margin), high - margin)
    return moved


def _predictable(problem: Problem, start: Array, begin: Array) -> Array:
    """Return the start of the search nearer to the given one if measured quantities do not exist at
    `begin`, away from the limits."""
    for share in SHARES_OF_MARGIN:
        nearer = start + share * (begin - start)
        if not problem.is_missing(nearer):
            return nearer
    return begin


def _search(
    search: Search, begin: Array, limits: Mapping[str, Interval], confidence: float
) -> Outcome:
    """Return the outcome of the search from values of the parameters within limits."""
    problem = search.problem
    start = begin / problem.scale
    end, gap = search.run_across_gaps(start, limits)
    closer = {} if gap else limits_of_cases(problem, end, limits)
    if closer and _is_led_to(closer, search, end, limits):
        limits = {**limits, **closer}
        begin = _inside(problem, end.x * problem.scale, limits)
        end, gap = search.run_across_gaps(begin / problem.scale, limits)
    if gap:
        alike = search.alike(end)
        return Outcome(end, limits, gap, False, alike, search.combinations((end,), alike))
    end, is_minimum = search.to_minimum(end, limits)
    indistinct = search.indistinct(end)
    if len(indistinct) > 1:
        nearer = search.near_start(start, end, indistinct, limits)
        determined = search.combinations((nearer, end), indistinct)
        least = 2 * float(end.cost)
        return Outcome(nearer, limits, None, True, indistinct, determined, least)
    if not is_minimum:
        return Outcome(end, limits, None, False)
    if indistinct:
        limits = {**limits, **limits_of_interval(problem, end, indistinct[0], confidence, limits)}
    return Outcome(end, limits, None, True, indistinct)


def _is_led_to(
    closer: Mapping[str, Interval], search: Search, end: Any, limits: Mapping[str, Interval]
) -> bool:
    """Whether measurements have led a search to limits of cases, and not only by chance, as they do
    where they do not tell other parameters apart."""
    return search.is_held_back(end, limits) or {*search.indistinct(end)} <= {*closer}
