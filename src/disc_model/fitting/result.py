"""`Fit`: what `fit` has found, and the reasons to doubt it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from disc_model.arrays import Array, EqualByValue
from disc_model.data.variables import unit_of_parameter
from disc_model.display import (
    DEVIATION_DIGITS,
    Drawn,
    Summarised,
    aligned,
    counted,
    number_text,
    rounded_text,
)
from disc_model.fitting.data import dataset_of
from disc_model.fitting.measured import Measurement, sign_pattern
from disc_model.fitting.problem import Problem
from disc_model.parameters import Parameters

UNLIKELY = 0.05
"""Share of fits of the right model with as large a chi squared, below which a fit is doubtful,"""
LEAST_SHARE = 1e-6
"""and below which only this bound of it is said."""
VALUE_DIGITS = 6
NAMED = 3
"""Largest number of unstable cycles that a note names before others that it counts."""
WRONG = "model, fixed parameters or uncertainties"
UNTESTED = "yes, but nothing tests it: there are no more measurements than fitted parameters"
STILL_FALLING = "Chi squared still falls from where the search has ended."
"""Message of a search that has not ended at a minimum."""


class Fitted(NamedTuple):
    """A fitted parameter: its value, standard deviation and confidence interval, in its unit. All but
    the value are nan if the measurements do not determine it or a bound holds it, and an end of the
    interval also if they have no prediction there, or it lies beyond a bound."""

    value: float
    deviation: float
    low: float
    high: float


class Combined(NamedTuple):
    """A combination of parameters: its value, standard deviation and unit, or the words "in SI units"."""

    value: float
    deviation: float
    unit: str


class Gap(NamedTuple):
    """Where a search has stopped because measured quantities do not exist: values of the fitted
    parameters there, in their units, and names of the measurements."""

    values: Mapping[str, float]
    measurements: tuple[str, ...]


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
        alike and are known to 10 % at best, or up to some standard deviations away chi squared rises less than linear
        predictions would have it. If there are several, their values are the nearest to the start with which chi
        squared is at most 3.84 above its minimum, or more where deviations exceed the uncertainties
    excess : how much `chi_squared` is above its minimum, by which the fit is judged, as with these nearest values
    determined : combinations of these that the measurements determine, such as "mu_s - mu_k" or "m * k_p^2": by its
        formula, the value, standard deviation and unit of each. Products hold near the fitted values
    unpredicted : by name of a parameter, the ends of its interval at which a measured quantity does not exist, as
        beyond a fold of the cycle; `Fitted` has nan there. At an end of the interval of one parameter the others have
        changed as the covariance says, but not along directions that are not determined
    outside : by name of a parameter, the ends of its interval at which there is no case, since another parameter has
        changed beyond what cases have; `Fitted` has nan there
    at_bounds : by name of a parameter, the bound at which it lies, or that no case can pass, such as 0, but its
        interval would; `Fitted` has no interval then
    reached : names of those of these parameters that lie at the bound
    passed_bounds : by name of a parameter that lies within its bounds, those that its interval passes; `Fitted` has nan
        at these ends. The standard deviation and the other end hold, and there is no `doubt`
    limits : by name of a parameter at a bound that no case can pass, such as `c_p` at 0, the value that it is below, or
        above, with that confidence, while the other varied parameters are fitted again as for linear predictions; nan
        if predictions are not linear up to there, or the search, chi squared or another parameter is in doubt
    unlimited : by name of such a parameter without a limit, why it has none
    gap : values of the parameters in front of which the search has stopped, since measured quantities do not exist
        there, as where a case has no cycle, and the names of these measurements; None where it has not
    doubt : all reasons why values and intervals mean nothing: a search that has stopped in front of a gap, which is
        then the only one said but for parameters that act alike there, or has not converged, a value at a bound,
        parameters that are not determined, an interval in which the motion or the model ends, too large a chi squared,
        with the share of fits of the right model that are as bad and the measurement that deviates most; "" where
        there is none
    consistent : whether there is no `doubt`
    unstable : by name of a measurement of a cycle that is unstable in the fitted case, its growth rate (1/s) if above
        0.01/s; a period, for example, cannot be measured for long there
    elsewhere : names of those of these measurements near whose cycle the motion from the static start is not
    note : says so, what is `determined`, and where the signs of deviations follow a pattern over what was set, such as
        the speed: scatter makes hardly any like it; "" where there is nothing of this

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
    excess: float = 0.0
    determined: Mapping[str, Combined] = field(default_factory=dict)
    unpredicted: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    outside: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    at_bounds: Mapping[str, float] = field(default_factory=dict)
    reached: tuple[str, ...] = ()
    passed_bounds: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    limits: Mapping[str, float] = field(default_factory=dict)
    unlimited: Mapping[str, str] = field(default_factory=dict)
    gap: Gap | None = None
    unstable: Mapping[str, float] = field(default_factory=dict)
    elsewhere: tuple[str, ...] = ()
    _changes: Array = field(default_factory=lambda: np.eye(0))

    def __repr__(self) -> str:
        values = []
        for name, fitted in self.parameters.items():
            spread = ""
            if name in self._relied_on:
                spread = f" ± {rounded_text(fitted.deviation, DEVIATION_DIGITS)}"
            values.append(f"{name}={self._value_text(name)}{spread}")
        meaning = "± one standard deviation" if self._relied_on else ""
        cost = f"chi squared {self.chi_squared:.3g} with {self.freedom} degrees of freedom"
        parts = [f"Fit({', '.join(values)}", meaning, cost, self.doubt, self.note]
        return "; ".join(filter(None, parts)) + ")"

    def __str__(self) -> str:
        """The fit as a short table."""
        rows = [("fitted", "value", "deviation", "unit")]
        for name, fitted in self.parameters.items():
            deviation = "-"
            if name in self._relied_on and not math.isnan(fitted.deviation):
                deviation = rounded_text(fitted.deviation, DEVIATION_DIGITS)
            rows.append((name, self._value_text(name), deviation, unit_of_parameter(name)))
        cost = f"chi squared {self.chi_squared:.3g}, {counted(self.freedom, 'degree')} of freedom"
        doubts = [f"doubt: {reason}" for reason in self.doubt.split("; ") if reason]
        notes = [f"note: {text}" for text in self.note.split("; ") if text]
        return "\n".join([*aligned(rows), cost, *doubts, *notes])

    @property
    def _relied_on(self) -> tuple[str, ...]:
        """Names of the parameters whose intervals can be relied on: all of a consistent fit, and where others
        not being determined is the only doubt, those that are."""
        if self.gap or self._doubts_of_search() or self._doubts_of_intervals():
            return ()
        return tuple(name for name in self.parameters if name not in self.indistinct)

    def _value_text(self, name: str) -> str:
        """The value of a parameter, that of its bound if it lies there."""
        value = self.parameters[name].value
        if name in self.reached:
            value = self.at_bounds[name]
        return rounded_text(value, VALUE_DIGITS)

    @property
    def freedom(self) -> int:
        """Degrees of freedom: measurements without as many as there are parameters."""
        return len(self.measurements) - len(self.parameters)

    @property
    def consistent(self) -> bool:
        """Whether values and intervals can be relied on, as far as the measurements tell: the search
        has converged, the measurements determine every parameter, what was measured exists at both
        ends of every interval within the bounds, no bound holds a parameter, and chi squared is as small
        as it is in 95 % of fits if the model and the uncertainties are right (without degrees of freedom,
        where it is 0 unless a bound is in the way, as with one). Otherwise `doubt` says why not."""
        return not self.doubt

    @property
    def doubt(self) -> str:
        """All reasons why values and intervals mean nothing; "" where the fit is consistent."""
        if self.gap:
            return "; ".join([_stopped(self.gap), *self._alike_at_gap()])
        undetermined = [_undetermined(self.indistinct)] if self.indistinct else []
        reasons = [*self._doubts_of_search(), *undetermined, *self._doubts_of_intervals()]
        return "; ".join(reasons)

    def _doubts_of_search(self) -> list[str]:
        """Reasons why no value can be relied on: the search has not converged, a bound holds a parameter,
        or chi squared is too large."""
        reasons = []
        if not self.converged:
            reasons.append(_unconverged(self.message))
        for name, bound in self.at_bounds.items():
            reasons.append(_is_held(name, bound, name in self.limits))
            reasons += self._limit_texts(name)
        if self.converged and self.misses:
            reasons.append(self._misfit)
        return reasons

    def _doubts_of_intervals(self) -> list[str]:
        """Reasons why no interval can be relied on: what was measured does not exist at its ends, or they
        lie outside of the bounds."""
        reasons = []
        for name, ends in self.unpredicted.items():
            reasons += [_ends_within(name, self._place_of(name, end)) for end in ends]
        for name, ends in self.outside.items():
            reasons += [_ends_outside(name, self._place_of(name, end)) for end in ends]
        return reasons

    def _alike_at_gap(self) -> Iterator[str]:
        """Yield in words which parameters act alike where a search has stopped in front of a gap, as it may
        because of them."""
        if len(self.indistinct) > 1:
            known = f", only {_listed([*self.determined])}" if self.determined else ""
            names = _listed(self.indistinct)
            remedy = "fix one of them, or measure more"
            apart = f"the measurements do not determine {names} apart{known}"
            yield f"judged by derivatives, {apart}: {remedy}"

    def _place_of(self, name: str, end: float) -> list[str]:
        """The values of all parameters at an end of the interval of one, which comes first, in words."""
        names = list(self.parameters)
        i = names.index(name)
        way = end - self.parameters[name].value
        place = [f"{name}={end:.6g}"]
        for j, other in enumerate(names):
            if j != i and self._changes[j, i]:
                change = way * float(self._changes[j, i])
                place.append(f"{other}={self.parameters[other].value + change:.6g}")
        return place

    @property
    def note(self) -> str:
        """Which combinations of indistinct parameters the measurements determine, and which measured cycles
        are unstable, with their growth rates, and whether signs of deviations follow a pattern; "" where
        there are none. The fit may be consistent although cycles are unstable: the values are right if the
        motion was still on these."""
        said = [*self._combination_texts(), self._pattern_of_signs, self._instability]
        if not self._none_is_near:
            said.append(self._distance)
        return "; ".join(filter(None, said))

    def _combination_texts(self) -> Iterator[str]:
        """Yield in words each combination that the measurements determine; none in front of a gap, where
        its value is not that of a minimum."""
        if self.gap:
            return
        for formula, known in self.determined.items():
            value = number_text(known.value, "")
            deviation = rounded_text(known.deviation, DEVIATION_DIGITS)
            text = f"the measurements determine {formula} = {value} ± {deviation}"
            yield text if known.unit in ("", "1") else f"{text} {known.unit}"

    @property
    def _pattern_of_signs(self) -> str:
        """That deviations keep their sign over long stretches, in words."""
        found = sign_pattern(self.measurements, self.deviations)
        if self.gap or not self.converged or not found.is_systematic:
            return ""
        changes = counted(found.changes, "time") if found.changes else "never"
        share = f"{100 * found.chance:.2g} % of fits of the right model"
        steps = (
            f"deviations change sign {changes} in {found.steps} steps from one setting to the next"
        )
        return f"{steps}, as rarely as in {share}: the model or a fixed parameter may be wrong"

    @property
    def _instability(self) -> str:
        """Which measured cycles are unstable, in words."""
        if not self.unstable:
            return ""
        cycles = [f"{name} ({rate:.2g}/s)" for name, rate in self.unstable.items()]
        near = ", and none from the static start comes near" if self._none_is_near else ""
        if len(cycles) == 1:
            unstable = f"in the fitted case the cycle of {cycles[0]} is unstable"
            return f"{unstable}: a motion does not stay on it{near}"
        unstable = f"in the fitted case the cycles of {_listed(cycles)} are unstable"
        return f"{unstable}: a motion does not stay on them{near}"

    @property
    def _none_is_near(self) -> bool:
        """Whether the motion is near none of the unstable cycles."""
        return bool(self.unstable) and set(self.elsewhere) == set(self.unstable)

    @property
    def _distance(self) -> str:
        """Which of these cycles the motion is not near, in words."""
        if not self.elsewhere:
            return ""
        cycles = "cycle" if len(self.elsewhere) == 1 else "cycles"
        which = _listed(self.elsewhere)
        return f"the motion from the static start is not near the {cycles} of {which}"

    def _limit_texts(self, name: str) -> Iterator[str]:
        """Yield in words the limit of a parameter, if it has one."""
        limit = self.limits.get(name, math.nan)
        if name in self.unlimited:
            yield f"no limit of {name} is known, since {self.unlimited[name]}"
        if math.isnan(limit):
            return
        side = "below" if limit > self.parameters[name].value else "above"
        value = number_text(limit, unit_of_parameter(name), 3)
        yield f"{name} is {side} {value} at {100 * self.confidence:.3g} % confidence"

    def _interval_text(self, name: str) -> str:
        """The interval of a parameter in words."""
        fitted = self.parameters[name]
        low = f"{fitted.low:.6g}"
        high = f"{fitted.high:.6g}"
        for bound in self.passed_bounds.get(name, ()):
            if bound < fitted.value:
                low = f"less than {bound:.6g}"
            else:
                high = f"more than {bound:.6g}"
        return f"{low} to {high}"

    def _passed_texts(self) -> Iterator[str]:
        """Yield in words each bound that an interval passes."""
        for name, bounds in self.passed_bounds.items():
            for bound in bounds:
                passed = f"the interval of {name} passes its bound {bound:.6g}"
                yield f"{passed}, beyond which its end is not known"

    @property
    def _least(self) -> float:
        """The least chi squared."""
        return self.chi_squared - self.excess

    @property
    def misses(self) -> bool:
        """Whether chi squared is larger than in 95 % of fits of the right model."""
        return is_unlikely(self._least, self.freedom)

    @property
    def share_as_bad(self) -> float:
        """Share of fits of the right model whose chi squared is at least as large; nan without degrees of
        freedom."""
        return _chance_of(self._least, self.freedom) if self.freedom else math.nan

    @property
    def share_text(self) -> str:
        """This share in words."""
        if self.share_as_bad < LEAST_SHARE:
            return f"less than {100 * LEAST_SHARE:g} % of fits of the right model are this bad"
        return f"{100 * self.share_as_bad:.2g} % of fits of the right model are this bad"

    @property
    def _misfit(self) -> str:
        """How large chi squared is, in words."""
        wrong = f"a bound, {WRONG}" if self.at_bounds else WRONG
        cost = "the least chi squared" if self.excess else "chi squared"
        if self.freedom == 0:
            return f"{wrong} are wrong, {cost} is {self._least:.3g} and should be 0"
        size = f"{cost} is {self._least / self.freedom:.3g} times its degrees of freedom"
        worst = int(np.argmax(np.abs(self.deviations)))
        most = f"{self.measurements[worst].name} deviates most"
        return f"{wrong} may be wrong, {size}: {self.share_text}, and {most}"

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
        problem = Problem(self.case, names, (wanted,), {})
        start = np.array([self.parameters[name].value for name in names])
        value = problem.predictions(start)[0]
        gradient = problem.jacobian(start)[0]
        return float(value), math.sqrt(float(gradient @ self.covariance @ gradient))

    def to_dataset(self) -> xr.Dataset:
        """The fit as a dataset, to save, or to handle by xarray and pandas; `disc_model.save` makes one by itself.

        Along `parameter`, each in its `unit`: `value`, `deviation`, `low`, `high`, `at_bound`, `passed_low` and
        `passed_high` (bounds that the interval passes), `limit`, `indistinct` and `gap`, and with `other_parameter`
        also `covariance` and `correlation`. Along `measurement`: `quantity`, and in its `measured_unit` what was
        `measured`, its `uncertainty` and what is `predicted`; the growth rate of its cycle if that is `unstable`; and
        what was set at each, such as `Omega`. Attributes: `chi_squared`, `freedom`, `confidence`, `converged` (0 or 1),
        `message`, `doubt`, `note`, and the fitted `case` in JSON.

        Examples
        --------
        >>> import disc_model as dm
        >>> p = dm.Parameters(N=385, Omega=15, normalization="orthonormal")
        >>> found = dm.fit(p, ["E"], {"frequency_2_0": (295, 1)})
        >>> data = found.to_dataset()
        >>> float(data["value"].sel(parameter="E")) == found.case.E
        True
        >>> dm.save(found, "fit.nc")
        >>> dm.load("fit.nc").identical(data)
        True
        """
        return dataset_of(self)

    def _summary(self) -> Iterator[tuple[str, object]]:
        doubt = self.doubt
        for name in self.parameters:
            text = f"{self._value_text(name)} {unit_of_parameter(name)}".strip()
            if name in self._relied_on:
                text += f" ({self._interval_text(name)})"
            yield name, text
        confidence = f"{self.confidence:.0%}, if the model and the uncertainties are right"
        intervals = "; ".join([confidence, *self._passed_texts()])
        if not self._relied_on:
            intervals = f"none: {doubt}"
        elif doubt:
            intervals = f"{intervals}; none of {_listed(self.indistinct)}"
        yield "intervals", intervals
        yield "chi squared", f"{self.chi_squared:.4g} with {self.freedom} degrees of freedom"
        tested = "yes" if self.freedom else UNTESTED
        yield "consistent", f"no: {doubt}" if doubt else tested
        if self.note:
            yield "note", self.note
        yield "search", self.message


def _listed(names: Sequence[str]) -> str:
    """Names in a sentence, of which further ones are only counted."""
    if len(names) == 1:
        return names[0]
    first = names[: min(NAMED, len(names) - 1)]
    rest = names[len(first) :]
    last = rest[0] if len(rest) == 1 else f"{len(rest)} others"
    return f"{', '.join(first)} and {last}"


def is_unlikely(chi_squared: float, freedom: int) -> bool:
    """Whether chi squared is larger than in 95 % of fits of the right model."""
    return _chance_of(chi_squared, freedom) < UNLIKELY


def _chance_of(chi_squared: float, freedom: int) -> float:
    """Share of fits of the right model whose chi squared is at least as large."""
    from scipy import stats

    return float(stats.chi2.sf(chi_squared, max(freedom, 1)))


def _unconverged(message: str) -> str:
    """Return that a search has not converged, and what helps if it has ended before a minimum."""
    said = "the search has not converged"
    if message != STILL_FALLING:
        return said
    return (
        f"{said}: chi squared still falls where it has ended, so start again from the fitted case"
    )


def _stopped(gap: Gap) -> str:
    """Return that a search has stopped in front of a gap, and what helps."""
    place = []
    for name, value in gap.values.items():
        place.append(f"{name} = {number_text(value, unit_of_parameter(name), 3)}")
    missing = " and ".join(gap.measurements)
    several = len(gap.measurements) > 1
    verb, which = ("do", "these measurements") if several else ("does", "this measurement")
    where = f"the search stopped near {', '.join(place)}, where {missing} {verb} not exist"
    return f"{where}: start from the other side of this gap, or leave out {which}"


def _undetermined(names: Sequence[str]) -> str:
    """Return that the measurements do not determine some parameters, and what helps."""
    if len(names) == 1:
        return f"the measurements do not determine {names[0]}: measure more"
    together = ", ".join(names[:-1]) + f" and {names[-1]}"
    return f"the measurements do not determine {together} apart: fix one of them, or measure more"


def _is_held(name: str, bound: float, is_last: bool) -> str:
    """Return that a parameter is at a bound, or so near the last value of any case that its interval
    would pass it."""
    if is_last:
        passed = f"the interval of {name} passes {bound:.6g}, beyond which there is no case"
        return f"{passed}: fix it, or measure more"
    return f"{name} is held by its bound {bound:.6g}: widen the bound, or fix it"


def _ends_within(name: str, place: Sequence[str]) -> str:
    """Return that what was measured does not exist at an end of a parameter's interval, and at which
    values of all."""
    within = (
        "lies within the interval" if len(place) == 1 else f"lies within the interval of {name}"
    )
    return f"no such motion was found at {', '.join(place)}: a fold, or another end of the cycle, {within}"


def _ends_outside(name: str, place: Sequence[str]) -> str:
    """Return that there is no case at an end of a parameter's interval."""
    return f"the interval of {name} ends where there is no case: {', '.join(place)}"
