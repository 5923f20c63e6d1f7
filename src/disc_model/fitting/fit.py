"""`fit`: parameters of a case from measurements, by weighted least squares.

With the measured values y_i, their standard deviations s_i and the predictions f_i(q), the fit
minimises the sum of ((f_i(q) - y_i) / s_i)^2 over the parameters q. Near the minimum the estimates
scatter with the covariance (J^T J)^-1, where J is the Jacobian of the weighted deviations: as far
as f is linear in q over this scatter, errors are normal and independent, and s_i are right.

Derivatives are central differences: predictions of modes and cycles are accurate to 1e-12 or
better, so that a relative step of 1e-4 leaves errors of some 1e-8 of a derivative.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np

from disc_model.arrays import Array, EqualByValue, Mask
from disc_model.disc.plausibility import trial_cases, warn_of_doubts, warn_of_measured
from disc_model.display import Drawn, Summarised, html_table, number_text
from disc_model.errors import (
    DiscModelError,
    Fault,
    ParameterError,
    raise_faults,
    suggestion,
    violations,
)
from disc_model.fitting.limits import limit_beyond
from disc_model.fitting.prediction import (
    Prediction,
    Unpredicted,
    is_of_modes,
    unit_of,
    unknown_quantity,
)
from disc_model.parameters import Parameters, foreign_case
from disc_model.units import in_si, is_number

Interval = tuple[float, float]

STEP = 1e-4
"""Step of central differences, relative to a parameter's scale."""
SHORTER = (1.0, 0.1, 0.01)
"""Steps over that one, the first with predictions on a side: cycles exist in narrow intervals where
several resonances meet. Those of the last still leave errors of 1e-6 of a derivative."""
TOLERANCE = 1e-10
"""Relative change of parameters, cost and gradient at which the search ends."""
MARGIN = 0.01
"""Distance of the first step from limits, relative to a parameter's scale."""
SINGULAR = 1e-7
"""Least ratio of singular values of a Jacobian with columns of length 1; below it, differences no
longer tell parameters apart."""
ROUNDING = 1e-12
"""Effect of a parameter over that of the one with the largest, up to which it has none."""
PARABOLA = (0.3, 3.0)
"""Increase of chi squared over a standard deviation of the least known combination of parameters,
which is 1 where predictions are linear; beyond these, intervals would mislead."""
WEAK = 0.3
"""Part of a parameter in that combination from which it belongs to it, of 1 in all."""
TANGLED = 30.0
"""Standard deviation of a parameter over that which it had if the others were known, from which its
effects are those of others."""
LOOSE = 0.1
"""Standard deviation of a parameter over its size from which such a parameter counts as not
determined."""
UNLIKELY = 0.05
"""Share of fits of the right model with as large a chi squared, below which a fit is doubtful,"""
ALL_BUT_IMPOSSIBLE = 1e-3
"""and below which something is wrong."""
WRONG = "model or uncertainties"


@dataclass(frozen=True)
class Measurement:
    """A measured value of a quantity, with its uncertainty, and what was set when it was measured.

    Parameters
    ----------
    quantity : name of a quantity of a case: ``period``, ``growth_rate``, ``stick_fraction``, ``stick_time``,
        ``slip_time``, ``slip_length``, ``sliding_growth_rate``, ``sliding_frequency``; of the disc's mode with two
        nodal diameters and no circle ``frequency_2_0`` (Hz) and ``damping_ratio_2_0``; of disc and attached slider
        ``coupled_frequency_1`` (Hz), the lowest; or a function of a case that returns a number
    value : what was measured, in SI units (frequencies in Hz), or a text with a unit
    uncertainty : its standard deviation, > 0
    at : values of parameters that differ from those of the fitted case, such as ``{"Omega": 12}``

    Examples
    --------
    >>> import disc_model as dm
    >>> dm.Measurement("period", "14.8 ms", 1e-5, at={"Omega": 15}).value
    0.0148
    """

    quantity: str | Callable[[Parameters], float]
    value: float
    uncertainty: float
    at: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        faults: list[str] = []
        if not callable(self.quantity) and not self.unit:
            faults.append(Fault.of(("quantity",), self.quantity, unknown_quantity(self.quantity)))
        value = _number(self.value, self.unit, "value", faults)
        uncertainty = _number(self.uncertainty, self.unit, "uncertainty", faults)
        named = isinstance(self.at, Mapping) and all(isinstance(name, str) for name in self.at)
        faults += violations(
            (not uncertainty <= 0, "uncertainty", uncertainty, "must be a standard deviation > 0"),
            (named, "at", self.at, "must give values by names of parameters"),
        )
        raise_faults(faults)
        # the class is frozen, and texts become numbers
        object.__setattr__(self, "value", value)
        object.__setattr__(self, "uncertainty", uncertainty)

    @property
    def name(self) -> str:
        """The quantity's name, and what was set."""
        quantity = self.quantity
        name = quantity if isinstance(quantity, str) else getattr(quantity, "__name__", "quantity")
        settings = ", ".join(f"{key}={_short(value)}" for key, value in self.at.items())
        return f"{name} ({settings})" if settings else name

    @property
    def unit(self) -> str:
        """Unit of the value; "" for a quantity of one's own."""
        return unit_of(self.quantity) if isinstance(self.quantity, str) else ""


def _number(value: object, unit: str, name: str, faults: list[str]) -> float:
    """Return a finite number in a unit; nan for anything else, which becomes a fault."""
    wrong: list[Fault] = []
    number = in_si(value, unit, wrong, (name,))
    if not wrong and not _is_finite(number):
        rule = "must be a finite number"
        if isinstance(value, str) and unit:
            rule = f"must be a number with its unit, such as '3 {unit}'"
        wrong.append(Fault.of((name,), value, rule))
    faults += wrong
    return math.nan if wrong else float(number)


def _is_finite(value: object) -> bool:
    """Return whether a value is a finite number."""
    return is_number(value) and math.isfinite(value)  # type: ignore[arg-type]


def _short(value: object) -> str:
    """Return a value for a name: a number with six digits."""
    return f"{value:.6g}" if is_number(value) else str(value)


class Fitted(NamedTuple):
    """A fitted parameter: its value, standard deviation and confidence interval, in its unit. All but
    the value are nan if the measurements do not determine it or a bound holds it, and an end of the
    interval also if they have no prediction there."""

    value: float
    deviation: float
    low: float
    high: float


@dataclass(frozen=True, eq=False, repr=False)
class Fit(Summarised, Drawn, EqualByValue):
    """Parameters fitted to measurements; `plot` draws the deviations of computed values.

    Attributes
    ----------
    case : the given case with the fitted values
    parameters : `Fitted` by name: value, deviation (standard), low and high end of the confidence interval
    covariance : of the fitted values, in the order of `parameters`, (n, n)
    confidence : probability of the intervals
    measurements : the measurements
    computed : what the fitted case predicts of each, (m,)
    deviations : computed minus measured values, in standard deviations, (m,)
    chi_squared : sum of the squared deviations
    converged, message : whether and why the search ended at a minimum
    indistinct : names of parameters that the measurements do not determine, or not apart from each other: they act
        alike and are known to 10 % at best, or a standard deviation away chi squared does not rise as linear
        predictions would have it
    unpredicted : by name of a parameter, the ends of its interval at which a measured quantity does not exist, as
        beyond a fold of the cycle; `Fitted` has nan there
    at_bounds : by name of a parameter, the bound at which it lies, or beyond which its interval would go; `Fitted` has
        no interval then
    limits : by name of a parameter at a bound that no case can pass, such as `c_p` at 0, the value that it is below, or
        above, with that confidence; nan if predictions are not linear up to there, or the search, chi squared or
        another parameter is in doubt
    doubt : all reasons why values and intervals mean nothing: a search that has not converged, a bound in the way,
        parameters that are not determined, an interval in which the motion ends, too large a chi squared, with the
        measurement that deviates most; "" where there is none
    consistent : whether there is no `doubt`

    Examples
    --------
    >>> import disc_model as dm
    >>> p = dm.Parameters(N=385, Omega=15, normalization="orthonormal")
    >>> found = dm.fit(p, ["E"], {"frequency_2_0": (295, 1)})
    >>> found.parameters["E"].value / 1e9, found.predict("frequency_0_0")
    (154.9..., (241.3..., 0.81...))
    >>> found.plot()[1].get_xlabel()
    'Deviation (standard deviations)'
    """

    _picture = "plot_fit"
    case: Parameters
    parameters: Mapping[str, Fitted]
    covariance: Array
    confidence: float
    measurements: tuple[Measurement, ...]
    computed: Array
    deviations: Array
    chi_squared: float
    converged: bool
    message: str
    indistinct: tuple[str, ...] = ()
    unpredicted: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    at_bounds: Mapping[str, float] = field(default_factory=dict)
    limits: Mapping[str, float] = field(default_factory=dict)

    def __repr__(self) -> str:
        doubt = self.doubt
        values = []
        for name, fitted in self.parameters.items():
            spread = "" if doubt else f" ± {fitted.deviation:.2g}"
            values.append(f"{name}={fitted.value:.6g}{spread}")
        meaning = "" if doubt else "± one standard deviation"
        cost = f"chi squared {self.chi_squared:.3g} with {self.freedom} degrees of freedom"
        parts = [f"Fit({', '.join(values)}", meaning, cost, doubt]
        return "; ".join(filter(None, parts)) + ")"

    @property
    def freedom(self) -> int:
        """Degrees of freedom: measurements without as many as there are parameters."""
        return len(self.measurements) - len(self.parameters)

    @property
    def consistent(self) -> bool:
        """Whether values and intervals can be relied on, as far as the measurements tell: the search
        has converged, the measurements determine every parameter, what was measured exists at both
        ends of every interval, and chi squared is as small as it
        is in 95 % of fits if the model and the uncertainties are right (without degrees of freedom,
        where it is 0 unless a bound is in the way, as with one). Otherwise `doubt` says why not."""
        return not self.doubt

    @property
    def doubt(self) -> str:
        """All reasons why values and intervals mean nothing; "" where the fit is consistent."""
        reasons = []
        if not self.converged:
            reasons.append("the search has not converged")
        for name, bound in self.at_bounds.items():
            reasons.append(_is_held(name, bound, name in self.limits))
            reasons += self._limit_texts(name)
        if self.converged and self._misses:
            reasons.append(self._misfit)
        if self.indistinct:
            reasons.append(_undetermined(self.indistinct))
        for name, ends in self.unpredicted.items():
            reasons += [_ends_within(name, end) for end in ends]
        return "; ".join(reasons)

    def _limit_texts(self, name: str) -> Iterator[str]:
        """Yield in words the limit of a parameter, if it has one."""
        limit = self.limits.get(name, math.nan)
        if math.isnan(limit):
            return
        side = "below" if limit > self.parameters[name].value else "above"
        value = number_text(limit, _unit_of_parameter(name), 3)
        yield f"{name} is {side} {value} at {100 * self.confidence:.3g} % confidence"

    @property
    def _misses(self) -> bool:
        """Whether chi squared is larger than in 95 % of fits of the right model."""
        return self._chance < UNLIKELY

    @property
    def _chance(self) -> float:
        """Share of fits of the right model whose chi squared is at least as large."""
        from scipy import stats

        return float(stats.chi2.sf(self.chi_squared, max(self.freedom, 1)))

    @property
    def _misfit(self) -> str:
        """How large chi squared is, in words."""
        wrong = f"a bound, {WRONG}" if self.at_bounds else WRONG
        if self.freedom == 0:
            return f"{wrong} are wrong, chi squared is {self.chi_squared:.3g} and should be 0"
        reduced = self.chi_squared / self.freedom
        size = f"chi squared is {reduced:.3g} times its degrees of freedom"
        worst = int(np.argmax(np.abs(self.deviations)))
        most = f"{self.measurements[worst].name} deviates most"
        if self._chance < ALL_BUT_IMPOSSIBLE:
            return f"{wrong} are wrong, {size}, and {most}"
        share = f"{100 * self._chance:.2g} % of right ones have as much"
        return f"{wrong} may be wrong, {size}: {share}, and {most}"

    @property
    def correlation(self) -> Array:
        """Correlations of the fitted values, (n, n)."""
        deviation = np.sqrt(np.diag(self.covariance))
        return np.asarray(self.covariance / np.outer(deviation, deviation))

    def predict(
        self, quantity: str | Callable[[Parameters], float], at: Mapping[str, Any] | None = None
    ) -> tuple[float, float]:
        """Return a quantity of the fitted case, and its standard deviation from that of the
        parameters.

        Parameters
        ----------
        quantity : name, or function of a case, as in `Measurement`
        at : values of parameters that differ from those of the fitted case

        Raises
        ------
        ParameterError
            If an argument breaks a rule, or the fitted case has no such quantity.
        """
        wanted = Measurement(quantity, 0.0, 1.0, at or {})
        names = tuple(self.parameters)
        problem = _Problem(self.case, names, (wanted,), {})
        start = np.array([self.parameters[name].value for name in names])
        value = problem.predictions(start)[0]
        gradient = problem.jacobian(start)[0]
        return float(value), math.sqrt(float(gradient @ self.covariance @ gradient))

    def _summary(self) -> Iterator[tuple[str, object]]:
        doubt = self.doubt
        for name, fitted in self.parameters.items():
            text = number_text(fitted.value, _unit_of_parameter(name))
            if not doubt:
                text += f" ({fitted.low:.6g} to {fitted.high:.6g})"
            yield name, text
        intervals = f"{self.confidence:.0%}, if the model and the uncertainties are right"
        yield "intervals", f"none: {doubt}" if doubt else intervals
        yield "chi squared", f"{self.chi_squared:.4g} with {self.freedom} degrees of freedom"
        yield "consistent", f"no: {doubt}" if doubt else "yes"
        yield "search", self.message

    def _repr_html_(self) -> str:
        """The parameters, and the measurements beside what is computed, in a notebook."""
        head = ("measurement", "measured", "uncertainty", "computed", "deviation", "unit")
        rows = (
            (
                each.name,
                f"{each.value:.6g}",
                f"{each.uncertainty:.2g}",
                f"{computed:.6g}",
                f"{deviation:+.2f}",
                "" if each.unit == "1" else each.unit,
            )
            for each, computed, deviation in zip(
                self.measurements, self.computed, self.deviations, strict=True
            )
        )
        return html_table(("fit", ""), self.summary()) + html_table(head, rows)


def _undetermined(names: Sequence[str]) -> str:
    """Return that the measurements do not determine some parameters, and what helps."""
    if len(names) == 1:
        return f"the measurements do not determine {names[0]}: measure more"
    together = ", ".join(names[:-1]) + f" and {names[-1]}"
    return f"the measurements do not determine {together} apart: fix one of them, or measure more"


def _is_held(name: str, bound: float, is_last: bool) -> str:
    """Return that a parameter is at a bound, which may be the last value of any case, or so near that
    its interval would pass it."""
    if is_last:
        passed = f"the interval of {name} passes {bound:.6g}, beyond which there is no case"
        return f"{passed}: fix it, or measure more"
    return f"{name} is held by its bound {bound:.6g}, which its interval passes: widen the bound, or fix it"


def _ends_within(name: str, end: float) -> str:
    """Return that what was measured does not exist at an end of a parameter's interval."""
    place = f"{name}={end:.6g}"
    return f"no such motion was found at {place}: a fold, or another end of the cycle, lies within the interval"


def _unit_of_parameter(name: str) -> str:
    """Return the unit of a parameter or of a number of a disc's table; "" without one."""
    table = {"omega": "rad/s", "amplitude": "kg^-1/2", "damping_ratio": ""}
    unit = Parameters.unit(name) or table.get(name.rsplit("_", 2)[0], "")
    return "" if unit == "1" else unit


class _Problem:
    """Predictions and their derivatives over the values of the varied parameters.

    Parameters
    ----------
    case : the case, whose other values are kept
    names : names of the varied parameters
    measurements : whose quantities are predicted
    scales : by name, sizes of parameters whose value is 0
    """

    def __init__(
        self,
        case: Parameters,
        names: Sequence[str],
        measurements: Sequence[Measurement],
        scales: Mapping[str, float],
    ) -> None:
        self.case = case
        self.names = tuple(names)
        self.measurements = tuple(measurements)
        start = [case.numbers[name] for name in names]
        self.scale = np.array(
            [scales.get(name, abs(value)) or 1.0 for name, value in zip(names, start, strict=True)]
        )

    def predictions(self, values: Array) -> Array:
        """Return the predicted quantities, (m,).

        Raises
        ------
        ParameterError
            If a case breaks a rule, or has no such quantity; the message names it.
        """
        fitted = dict(zip(self.names, map(float, values), strict=True))
        known: dict[str, Prediction] = {}
        found = np.empty(len(self.measurements))
        for i, each in enumerate(self.measurements):
            case = self.case.replace(**fitted, **each.at)
            prediction = known.setdefault(case.canonical_json, Prediction(case))
            try:
                if callable(each.quantity):
                    found[i] = float(each.quantity(case))
                else:
                    found[i] = prediction.of(each.quantity)
            except (Unpredicted, DiscModelError, ArithmeticError) as reason:
                text = f"cannot be computed: {reason}"
                raise ParameterError(Fault(("measured", each.name), "", text)) from None
        if not np.isfinite(found).all():
            wrong = self.measurements[int(np.argmin(np.isfinite(found)))]
            raise ParameterError(Fault(("measured", wrong.name), "", "is not finite"))
        return found

    def first_predictions(self, values: Array) -> Array:
        """Return the predicted quantities at the start of the search, (m,). Raises `ParameterError`
        without one; of a motion that the case does not have, it says that another start may."""
        try:
            return self.predictions(values)
        except ParameterError as error:
            wrong = [each for each in self.measurements if each.name == error.faults[0].path[-1]]
            if not wrong or is_of_modes(wrong[0].quantity):
                raise
            starts = []
            for name, value in zip(self.names, values, strict=True):
                starts.append(f"{name}={value:.6g}")
            remedy = f"; start the search from a case with other values than {', '.join(starts)}"
            fault = error.faults[0]
            raise ParameterError(Fault(fault.path, "", fault.rule + remedy)) from None

    def trial(self, values: Array) -> Array:
        """Return the predictions, nan where there are none: the search then makes a shorter
        step."""
        try:
            return self.predictions(values)
        except ParameterError:
            return np.full(len(self.measurements), math.nan)

    def is_missing(self, values: Array) -> bool:
        """Whether a valid case has no such quantity, as where its cycle has ended at a fold."""
        try:
            self.predictions(values)
        except ParameterError as error:
            return error.faults[0].path[0] == "measured"
        return False

    def is_last(self, i: int, bound: float, side: int) -> bool:
        """Whether no case has a value of a parameter beyond a bound, on the other side than this."""
        try:
            self.case.replace(**{self.names[i]: bound - side * STEP * float(self.scale[i])})
        except ParameterError:
            return True
        return False

    def jacobian(self, values: Array) -> Array:
        """Return derivatives of the predictions, (m, n)."""
        here: list[Array] = []  # computed where it is needed

        def at_values() -> Array:
            if not here:
                here.append(self.predictions(values))
            return here[0]

        return np.stack([self._column(values, i, at_values) for i in range(len(values))], axis=1)

    def _column(self, values: Array, i: int, at_values: Callable[[], Array]) -> Array:
        """Return derivatives by one parameter, (m,): central differences, or one-sided ones where the
        case on one side breaks a rule or has no such quantity, over shorter steps where neither has.

        Raises
        ------
        ParameterError
            If no step has predictions; the message names the measurement that is missing.
        """
        for factor in SHORTER:
            step = np.zeros(len(values))
            step[i] = factor * STEP * self.scale[i]
            above = self.trial(values + step)
            below = self.trial(values - step)
            is_above = not np.isnan(above).any()
            is_below = not np.isnan(below).any()
            if is_above and is_below:
                return (above - below) / (2 * step[i])
            if is_below:
                return (at_values() - below) / step[i]
            if is_above:
                return (above - at_values()) / step[i]
        raise ParameterError(self._fault_beside(values, step))

    def _fault_beside(self, values: Array, step: Array) -> Fault:
        """What is missing on both sides of a value, and what helps."""
        reason = "the case breaks a rule there"
        try:
            self.predictions(values + step)
        except ParameterError as error:
            fault = error.faults[0]
            if fault.path[0] == "measured":
                reason = f"{fault.path[-1]} {fault.rule}"
        [i] = np.flatnonzero(step)
        rule = (
            f"cannot be varied here, as on both sides {reason}; leave out this measurement, or start"
            " the search from a case with other values"
        )
        return Fault.of(("vary", self.names[i]), float(values[i]), rule)


def fit(
    case: Parameters,
    vary: Sequence[str],
    measured: Mapping[str, tuple[Any, Any]] | Sequence[Measurement],
    *,
    bounds: Mapping[str, tuple[Any, Any]] | None = None,
    confidence: float = 0.95,
) -> Fit:
    """Fit parameters of a case to measurements by weighted least squares.

    Parameters
    ----------
    case : the case; its values of the varied parameters are the start of the search
    vary : names of the parameters that are fitted, each one of `Parameters.numbers`, such as ``mu_s``, the ratio
        ``mu_k_over_mu_s``, or ``omega_2_0`` of a disc given by its modes
    measured : values with their standard deviations by the names of their quantities, all for it; or
        `Measurement` objects, which may differ in what was set, such as the speed
    bounds : least and greatest value of varied parameters, by name; needed where the start is 0
    confidence : probability of the confidence intervals

    Returns
    -------
    Fit
        Its intervals hold as far as the predictions are linear in the parameters over their uncertainties, and the
        model and the stated uncertainties are right; `Fit.consistent` tests the latter.

    Raises
    ------
    ParameterError
        If an argument breaks a rule, the case has no such quantity at the start of the search, or parameters have no
        effect at all, or exactly that of others. Of those that are hardly determined `Fit.doubt` tells.

    Notes
    -----
    Derivatives are central differences of relative step 1e-4. A trial case that breaks a rule, such as mu_k <= mu_s,
    or has no such quantity, makes the next step shorter. A time, length or frequency that is a hundred times what the
    case gives at the start, or a hundredth, is an `ImplausibleValue`, since its unit is probably another one.

    Examples
    --------
    >>> import disc_model as dm
    >>> p = dm.Parameters(N=385, Omega=15, normalization="orthonormal")
    >>> measured = {"frequency_0_0": (239.0, 0.5), "frequency_2_0": (292.5, 0.5)}
    >>> found = dm.fit(p, vary=["E", "nu"], measured=measured)
    >>> found
    Fit(E=1.52256e+11 ± 4.5e+08, nu=0.208709 ± 0.0056; ± one standard deviation; chi squared ...)
    """
    from scipy import optimize

    measurements = _checked(case, vary, measured, bounds, confidence)
    limits = _limits(vary, bounds or {})
    scales = {name: high - low for name, (low, high) in limits.items() if case.numbers[name] == 0}
    problem = _Problem(case, vary, measurements, scales)
    values = np.array([each.value for each in measurements])
    weights = 1 / np.array([each.uncertainty for each in measurements])
    start = np.array([case.numbers[name] for name in vary])
    begin = _inside(problem, start, limits)
    warn_of_doubts(case)
    jacobians: list[Array] = []

    def deviations(x: Array) -> Array:
        return (problem.trial(x * problem.scale) - values) * weights

    def slopes(x: Array) -> Array:
        jacobian = problem.jacobian(x * problem.scale) * weights[:, None] * problem.scale
        jacobians.append(jacobian)
        return jacobian

    def searched(begin: Array, limits: Mapping[str, Interval]) -> Any:
        ends = np.array([limits.get(name, (-math.inf, math.inf)) for name in vary]).T
        return optimize.least_squares(
            deviations,
            begin / problem.scale,
            jac=slopes,
            bounds=ends / problem.scale,
            xtol=TOLERANCE,
            ftol=TOLERANCE,
            gtol=TOLERANCE,
        )

    # the start and the result are doubted, not what is tried on the way
    with trial_cases():
        computed = problem.first_predictions(begin)
        named = [(each.name, each.value, each.unit) for each in measurements]
        warn_of_measured(named, computed.tolist())
        search = searched(begin, limits)
        indistinct = _indistinct(problem, search, jacobians[0], deviations)
        at_zero = _limits_at_zero(problem, search, limits)
        if at_zero and {*indistinct} <= {*at_zero}:
            limits = {**limits, **at_zero}
            search = searched(_inside(problem, search.x * problem.scale, limits), limits)
            indistinct = _indistinct(problem, search, jacobians[0], deviations)
        if len(indistinct) == 1 and _passes_zero(problem, search, indistinct[0], confidence):
            limits = {indistinct[0]: (0.0, math.inf), **limits}
        found = _result(problem, search, confidence, indistinct, limits)
        found = _with_limits(found, problem, search, deviations)
    warn_of_doubts(found.case)
    return found


def _limits_at_zero(
    problem: _Problem, search: Any, limits: Mapping[str, Interval]
) -> dict[str, Interval]:
    """Return limits for parameters without any that a search has led to 0, and that cannot be
    negative: against the rules of cases it does not converge."""
    found = {}
    for i, name in enumerate(problem.names):
        if name not in limits and abs(search.x[i]) <= STEP and problem.is_last(i, 0.0, 1):
            found[name] = (0.0, math.inf)
    return found


def _passes_zero(problem: _Problem, search: Any, name: str, confidence: float) -> bool:
    """Whether the confidence interval of a parameter that cannot be negative passes 0."""
    from scipy import stats

    i = problem.names.index(name)
    deviation = float(np.linalg.norm(_sensitivity(search.jac).inverse[i]))
    reach = float(stats.norm.ppf((1 + confidence) / 2)) * deviation
    return bool(search.x[i] <= reach) and problem.is_last(i, 0.0, 1)


def _with_limits(
    found: Fit, problem: _Problem, search: Any, deviations: Callable[[Array], Array]
) -> Fit:
    """Return the fit with the limits of parameters at bounds that no case can pass."""
    limits = {}
    for name, bound in found.at_bounds.items():
        i = problem.names.index(name)
        side = 1 if found.parameters[name].value >= bound else -1
        if not problem.is_last(i, bound, side):
            continue
        limits[name] = math.nan
        if found.converged and not found._misses and len(found.at_bounds) == 1:
            covariance = found.covariance / np.outer(problem.scale, problem.scale)
            beyond = limit_beyond(search, covariance, i, side, found.confidence, deviations)
            limits[name] = beyond * float(problem.scale[i])
    return replace(found, limits=limits)


def _inside(problem: _Problem, start: Array, limits: Mapping[str, Interval]) -> Array:
    """Return the start of the search, (n,), away from its limits: the first steps of the search are
    as long as the way to a limit, and the effect of one that short may be lost in rounding."""
    moved = start.copy()
    for i, name in enumerate(problem.names):
        if name in limits:
            low, high = limits[name]
            margin = min(MARGIN * problem.scale[i], 0.5 * (high - low))
            moved[i] = min(max(start[i], low + margin), high - margin)
    return moved


class _Sensitivity(NamedTuple):
    """What a Jacobian of weighted deviations over scaled parameters says of these.

    directions, sizes : right singular vectors in rows, (n, n), and singular values, (n,), both by descending value
    singular : whether differences no longer tell parameters apart, whatever their scales; small singular values are
        then raised, so that covariances are finite
    weakest : absolute parts of parameters in the combination that has the least effect for its parts' effects, (n,)
    inverse : whose product with its transpose is the covariance of the scaled parameters, (n, n)
    """

    directions: Array
    sizes: Array
    singular: bool
    weakest: Array
    inverse: Array


def _sensitivity(jacobian: Array) -> _Sensitivity:
    """Return what a Jacobian says."""
    effects = np.linalg.norm(jacobian, axis=0)
    without = effects <= ROUNDING * effects.max()
    comparable = np.where(without, 0.0, jacobian) / np.where(without, 1.0, effects)
    _, shares, combinations = np.linalg.svd(comparable, full_matrices=False)
    singular = bool(shares[-1] <= SINGULAR * shares[0])

    _, sizes, directions = np.linalg.svd(jacobian, full_matrices=False)
    if singular:
        sizes = np.maximum(sizes, SINGULAR * sizes[0] or 1.0)
    weakest = np.abs(combinations[-1])
    return _Sensitivity(directions, sizes, singular, weakest, directions.T / sizes)


def _indistinct(
    problem: _Problem, search: Any, first: Array, deviations: Callable[[Array], Array]
) -> tuple[str, ...]:
    """Return the names of parameters that the measurements do not determine.

    Parameters
    ----------
    problem : whose parameters these are
    search : at its end, over scaled parameters
    first : Jacobian at the start. Where predictions have kinks or peaks, as at a limit of a parameter, it says more on
        what acts alike than that of the end
    deviations : over the scaled parameters

    Raises
    ------
    ParameterError
        If the Jacobian is singular at both ends of the search.
    """
    names = problem.names
    at_start = _sensitivity(first)
    at_end = _sensitivity(search.jac)
    if at_start.singular and at_end.singular:
        weak = _chosen(names, at_end.weakest > WEAK)
        rule = "cannot be determined by these measurements: fewer parameters, or others"
        raise ParameterError(Fault.of(("vary",), list(weak), rule))

    # what acts alike, where deviations may be larger than the uncertainties say
    freedom = max(len(search.fun) - len(names), 1)
    scatter = math.sqrt(max(2 * search.cost / freedom, 1.0))
    extent = np.maximum(np.abs(search.x), 1.0) / scatter
    alike = _alike(search.jac, at_end, extent)
    if alike.any():
        return _chosen(names, alike)
    if at_end.singular:
        return _chosen(names, at_end.weakest > WEAK)

    # what is known least at the start, where derivatives at the end hold for very short steps only
    direction = at_start.directions[-1]
    step = LOOSE * direction / np.max(np.abs(direction) / extent)
    if _is_flat(search, step, deviations):
        return _chosen(names, np.abs(direction) > WEAK)

    # what is known least at the end
    direction = at_end.directions[-1]
    if _is_parabola(problem, search, direction / at_end.sizes[-1], deviations):
        return ()
    return _chosen(names, np.abs(direction) > WEAK)


def _alike(jacobian: Array, sensitivity: _Sensitivity, extent: Array) -> Mask:
    """Return which parameters act alike at the end, (n,), if one of them is known badly.

    Parameters
    ----------
    jacobian, sensitivity : of weighted deviations over scaled parameters, and what it says
    extent : sizes of the scaled parameters, (n,), smaller by the factor by which deviations exceed the uncertainties
    """
    deviation = np.linalg.norm(sensitivity.inverse, axis=1)
    others_known = 1 / np.maximum(np.linalg.norm(jacobian, axis=0), np.finfo(float).tiny)
    tangled = deviation > TANGLED * others_known
    loose = deviation > LOOSE * extent
    return np.asarray(tangled & bool((tangled & loose).any()))


def _chosen(names: Sequence[str], mask: Mask) -> tuple[str, ...]:
    """Return the names where a mask holds."""
    return tuple(name for name, chosen in zip(names, mask, strict=True) if chosen)


def _result(
    problem: _Problem,
    search: Any,
    confidence: float,
    indistinct: tuple[str, ...],
    limits: Mapping[str, Interval],
) -> Fit:
    """Return the fit at the end of a search over scaled parameters within limits, of which some may be
    indistinct."""
    from scipy import stats

    names = problem.names
    scale = problem.scale
    inverse = _sensitivity(search.jac).inverse
    covariance = inverse @ inverse.T * np.outer(scale, scale)

    fitted = search.x * scale
    deviation = np.sqrt(np.diag(covariance))
    reach = float(stats.norm.ppf((1 + confidence) / 2)) * deviation
    low = fitted - reach
    high = fitted + reach
    unpredicted: dict[str, tuple[float, ...]] = {}
    at_bounds = {}
    for i, name in enumerate(names):
        for bound in limits.get(name, ()):
            if low[i] <= bound <= high[i]:
                at_bounds[name] = float(bound)
    if at_bounds:  # what holds one of them moves the others
        indistinct = ()
    for i, name in enumerate(names):
        if name in indistinct:
            deviation[i] = low[i] = high[i] = math.nan
            continue
        # the others change with it as the covariance says
        move = reach[i] * covariance[:, i] / covariance[i, i]
        gone = [
            end for end, side in ((low, -1), (high, 1)) if problem.is_missing(fitted + side * move)
        ]
        if gone:
            unpredicted[name] = tuple(float(end[i]) for end in gone)
        for end in gone:
            end[i] = math.nan
        if name in at_bounds:
            deviation[i] = low[i] = high[i] = math.nan
    rows = np.stack([fitted, deviation, low, high], axis=1).tolist()
    parameters = {name: Fitted(*row) for name, row in zip(names, rows, strict=True)}
    case = problem.case.replace(**{name: each.value for name, each in parameters.items()})
    computed = problem.predictions(fitted)
    return Fit(
        case=case,
        parameters=parameters,
        covariance=covariance,
        confidence=confidence,
        measurements=problem.measurements,
        computed=computed,
        deviations=np.asarray(search.fun),
        chi_squared=float(search.fun @ search.fun),
        converged=bool(search.success),
        message=str(search.message).strip("`. ").replace("`", "") + ".",
        indistinct=indistinct,
        unpredicted=unpredicted,
        at_bounds=at_bounds,
    )


def _is_flat(search: Any, step: Array, deviations: Callable[[Array], Array]) -> bool:
    """Whether chi squared rises by no more than over a standard deviation on one side of the end,
    although derivatives there have it rise more."""
    least = float(search.fun @ search.fun)
    expected = float(np.sum((search.jac @ step) ** 2))
    for side in (1, -1):
        moved = deviations(search.x + side * step)
        rise = float(moved @ moved) - least
        if rise <= min(PARABOLA[1], PARABOLA[0] * expected):
            return True
    return False


def _is_parabola(
    problem: _Problem, search: Any, step: Array, deviations: Callable[[Array], Array]
) -> bool:
    """Whether chi squared rises by about 1 over a standard deviation of the least known combination
    of parameters on both sides of a minimum, or on the one where the measured quantities exist; at a
    limit of a parameter that is not asked."""
    if np.any(search.active_mask):
        return True
    least = float(search.fun @ search.fun)
    there = [side for side in (1, -1) if not _is_gone(problem, search.x + side * step)]
    for side in there:
        moved = deviations(search.x + side * step)
        rise = float(moved @ moved) - least
        if not PARABOLA[0] <= rise <= PARABOLA[1]:
            return False
    return bool(there)


def _is_gone(problem: _Problem, x: Array) -> bool:
    """Whether the measured quantities are missing at scaled values of the parameters."""
    return problem.is_missing(x * problem.scale)


# ---- Checks of the arguments


def _checked(
    p: object, vary: object, measured: object, bounds: object, confidence: object
) -> tuple[Measurement, ...]:
    """Return the measurements, after all checks that need no computation."""
    raise_faults(foreign_case(p))
    assert isinstance(p, Parameters)
    faults = _vary_faults(p, vary)
    good = is_number(confidence) and 0 < confidence < 1  # type: ignore[operator]
    faults += violations((good, "confidence", confidence, "must lie between 0 and 1"))
    measurements = _measurements(measured, faults)
    if not faults:
        assert isinstance(vary, Sequence)
        faults += _settings_faults(p, vary, measurements)
        faults += _bounds_faults(p, vary, bounds)
        enough = len(measurements) >= len(vary)
        rule = f"must be at least as many as the varied parameters, {len(vary)}"
        faults += violations((enough, "measured", f"{len(measurements)} values", rule))
    raise_faults(faults)
    return measurements


def _vary_faults(p: Parameters, vary: object) -> list[str]:
    """Return faults of the names of varied parameters."""
    if isinstance(vary, str) or not isinstance(vary, Sequence) or not vary:
        rule = "must be a list of names of parameters"
        return [Fault.of(("vary",), vary, rule)]
    faults: list[str] = []
    for i, name in enumerate(vary):
        if not isinstance(name, str) or name not in p.numbers:
            rule = "is no number of this case" + suggestion(name, list(p.numbers))
            faults.append(Fault.of(("vary", str(i)), name, rule))
        elif name in vary[:i]:
            faults.append(Fault.of(("vary", str(i)), name, "must not be given twice"))
    return faults


def _measurements(measured: object, faults: list[str]) -> tuple[Measurement, ...]:
    """Return what was measured as objects; wrong input becomes a fault."""
    if isinstance(measured, Mapping):
        found = []
        for name, pair in measured.items():
            if not (isinstance(pair, tuple | list) and len(pair) == 2):
                rule = "must be a value and its standard deviation"
                faults.append(Fault.of(("measured", str(name)), pair, rule))
                continue
            try:
                found.append(Measurement(name, *pair))
            except ParameterError as error:
                faults += [
                    fault.inside(("measured", str(name)))
                    for fault in error.faults
                    if isinstance(fault, Fault)
                ]
        return tuple(found)
    good = isinstance(measured, Sequence) and not isinstance(measured, str)
    if good and all(isinstance(each, Measurement) for each in measured):  # type: ignore[attr-defined]
        return tuple(measured)  # type: ignore[arg-type]
    rule = "must be values with standard deviations by quantity, or a list of Measurement"
    faults.append(Fault.of(("measured",), measured, rule))
    return ()


def _settings_faults(
    p: Parameters, vary: Sequence[str], measurements: Sequence[Measurement]
) -> list[str]:
    """Return faults of what was set at measurements: values of varied parameters, and wrong
    ones."""
    faults: list[str] = []
    for i, each in enumerate(measurements):
        path = ("measured", str(i), "at")
        both = [name for name in each.at if name in vary]
        if both:
            value = {name: each.at[name] for name in both}
            faults.append(Fault.of(path, value, "must not set what is varied"))
            continue
        try:
            p.replace(**each.at)
        except ParameterError as error:
            faults += [fault.inside(path) for fault in error.faults if isinstance(fault, Fault)]
    return faults


def _bounds_faults(p: Parameters, vary: Sequence[str], bounds: object) -> list[str]:
    """Return faults of bounds: of unknown names, in a wrong order, or without the start."""
    if bounds is None:
        bounds = {}
    if not isinstance(bounds, Mapping):
        return [Fault.of(("bounds",), bounds, "must give two values by parameter")]
    faults: list[str] = []
    for name, pair in bounds.items():
        path = ("bounds", str(name))
        if name not in vary:
            faults.append(Fault.of(path, pair, "must be of a parameter that is varied"))
            continue
        value = p.numbers[name]
        ends = in_si(pair, _unit_of_parameter(name), [], path)
        good = isinstance(ends, tuple | list) and len(ends) == 2 and all(map(_is_finite, ends))
        if not (good and ends[0] < ends[1] and ends[0] <= value <= ends[1]):
            rule = f"must be two ascending values around the start, {value:.6g}"
            faults.append(Fault.of(path, pair, rule))
    for name in vary:
        if p.numbers[name] == 0 and name not in bounds:
            rule = "must have bounds, because its start is 0, which gives it no scale"
            faults.append(Fault.of(("vary", name), 0.0, rule))
    return faults


def _limits(vary: Sequence[str], bounds: Mapping[str, tuple[Any, Any]]) -> dict[str, Interval]:
    """Return the bounds in SI units."""
    found = {}
    for name in vary:
        if name in bounds:
            low, high = in_si(bounds[name], _unit_of_parameter(name), [], ("bounds", name))
            found[name] = (float(low), float(high))
    return found
