"""Predictions of measured quantities over the values of varied parameters, and their derivatives."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager

import numpy as np

from disc_model.arrays import Array
from disc_model.display import progress_bar
from disc_model.errors import DiscModelError, Fault, ParameterError
from disc_model.fitting.block_cycle import Unpredicted, is_rigid
from disc_model.fitting.measured import Measurement
from disc_model.fitting.prediction import Prediction, is_of_modes, is_of_steady_cycle
from disc_model.parameters import Parameters

STEP = 1e-4
"""Step of central differences, relative to a parameter's scale."""
SHORTER = (1.0, 0.1, 0.01)
"""Steps over that one, the first with predictions on a side: cycles exist in narrow intervals where
several resonances meet. Those of the last still leave errors of 1e-6 of a derivative."""
HALVINGS = 60
"""Number of times that the way to a value beyond which there is no case is halved."""
ZERO = 1e-12
"""Size of such a value over that of the parameter, below which it is 0."""
UNSTABLE = 0.01
"""Growth rate (1/s) from which a cycle counts as unstable: below it disturbances grow so slowly that a
measurement of seconds ends first."""


class Problem:
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
        self._tell: Callable[[], object] | None = None
        self.scale = np.array(
            [scales.get(name, abs(value)) or 1.0 for name, value in zip(names, start, strict=True)]
        )

    @contextmanager
    def counted(self, shown: bool) -> Iterator[None]:
        """Count the values of which predictions are computed, and show how many there are."""
        with progress_bar("fit", None, shown) as bar:
            self._tell = bar.advance
            yield
        self._tell = None

    def predictions(self, values: Array) -> Array:
        """Return the predicted quantities, (m,).

        Raises
        ------
        ParameterError
            If a case breaks a rule, or has no such quantity; the message names it.
        """
        known: dict[str, Prediction] = {}
        found = np.array([self._predicted(each, values, known) for each in self.measurements])
        if self._tell is not None:
            self._tell()
        return found

    def _prediction(
        self, each: Measurement, values: Array, known: dict[str, Prediction]
    ) -> Prediction:
        """Return the prediction of the case of a measurement, which is known from then on."""
        fitted = dict(zip(self.names, map(float, values), strict=True))
        case = self.case.replace(**fitted, **each.at)
        return known.setdefault(case.canonical_json, Prediction(case))

    def _predicted(self, each: Measurement, values: Array, known: dict[str, Prediction]) -> float:
        """Return what is predicted of one measurement, by predictions of cases that are known by then.
        Raises `ParameterError` without one."""
        prediction = self._prediction(each, values, known)
        try:
            if callable(each.quantity):
                found = float(each.quantity(prediction.case))
            else:
                found = prediction.of(each.quantity)
        except (Unpredicted, DiscModelError, ArithmeticError) as reason:
            text = f"cannot be computed: {reason}"
            raise ParameterError(Fault(("measured", each.name), "", text)) from None
        if not math.isfinite(found):
            raise ParameterError(Fault(("measured", each.name), "", "is not finite"))
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

    def lacking(self, values: Array) -> str:
        """What is missing at some values: a "case" with these, or a "quantity" of a valid case, as where
        its cycle has ended at a fold; "" where all is there."""
        try:
            self.predictions(values)
        except ParameterError as error:
            return "quantity" if error.faults[0].path[0] == "measured" else "case"
        return ""

    def is_missing(self, values: Array) -> bool:
        """Whether a valid case has no such quantity."""
        return self.lacking(values) == "quantity"

    def missing(self, values: Array) -> tuple[str, ...]:
        """Return the names of measurements whose quantities a valid case does not have."""
        known: dict[str, Prediction] = {}
        names = []
        for each in self.measurements:
            try:
                self._predicted(each, values, known)
            except ParameterError as error:
                if error.faults[0].path[0] != "measured":
                    return ()
                names.append(each.name)
        return tuple(dict.fromkeys(names))

    def unstable(self, values: Array) -> dict[str, float]:
        """Return the growth rates (1/s) of unstable cycles, by names of the measurements made on them;
        of those of a block on a rigid disc nothing is known."""
        known: dict[str, Prediction] = {}
        rates = {}
        for each in self.measurements:
            prediction = self._prediction(each, values, known)
            if is_rigid(prediction.case) or not is_of_steady_cycle(each.quantity):
                continue
            rate = prediction.cycle.growth_rate
            if rate > UNSTABLE:
                rates[each.name] = rate
        return rates

    def elsewhere(self, values: Array, names: Collection[str]) -> tuple[str, ...]:
        """Return those of some names of measurements near whose unstable cycle the motion from the static
        start is not."""
        known: dict[str, Prediction] = {}
        found = []
        for each in self.measurements:
            if each.name not in names:
                continue
            if self._prediction(each, values, known).near_motion is False:
                found.append(each.name)
        return tuple(found)

    def is_case(self, values: Array) -> bool:
        """Whether a case with these values of the parameters keeps all rules."""
        fitted = dict(zip(self.names, map(float, values), strict=True))
        try:
            self.case.replace(**fitted)
        except ParameterError:
            return False
        return True

    def without(self, names: Sequence[str]) -> Problem:
        """Return the problem without the measurements of some names."""
        kept = [each for each in self.measurements if each.name not in names]
        scales = dict(zip(self.names, self.scale.tolist(), strict=True))
        others = Problem(self.case, self.names, kept, scales)
        others._tell = self._tell
        return others

    def is_last(self, values: Array, i: int, bound: float, side: int) -> bool:
        """Whether no case has a value of a parameter beyond a bound, on the other side than this."""
        beyond = values.copy()
        beyond[i] = bound - side * STEP * self.scale[i]
        return not self.is_case(beyond)

    def last_value(self, values: Array, i: int, reach: float) -> float:
        """Return the value of a parameter beyond which there is no case, within a reach, which is
        negative below its value; nan without one.

        Parameters
        ----------
        values : of all parameters, of a case, (n,)
        i : number of the parameter
        reach : in its unit
        """
        tried = values.copy()
        tried[i] = values[i] + reach
        if self.is_case(tried):
            return math.nan
        inside = float(values[i])
        outside = float(tried[i])
        for _ in range(HALVINGS):
            tried[i] = 0.5 * (inside + outside)
            if self.is_case(tried):
                inside = float(tried[i])
            else:
                outside = float(tried[i])
        if abs(inside) < ZERO * self.scale[i]:
            return 0.0
        return float(f"{inside:.12g}")

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
