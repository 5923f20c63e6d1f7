"""`fit`: parameters of a case from measurements, by the least squares of lmfit."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import numpy as np
import pandas as pd
from pydantic import ConfigDict, Field

from disc_model.arrays import Array
from disc_model.disc.modes import plate_modes
from disc_model.disc.plate import modal_damping
from disc_model.display import brought
from disc_model.errors import DiscModelError, Fault, ParameterError, raise_faults, suggestion
from disc_model.parameters import Parameters, require_case
from disc_model.stability.cycle import FloquetResult, floquet
from disc_model.stability.sliding import steady_sliding
from disc_model.units import Finite, Positive, Real, Strict

if TYPE_CHECKING:
    from lmfit.minimizer import MinimizerResult

OF_CYCLES = ("period", "growth_rate", "stick_fraction", "stick_time", "slip_time")
"""Quantities that are attributes of what `floquet` returns,"""
OF_SLIDING = "sliding_growth_rate"
"""the growth rate of `steady_sliding`,"""
OF_MODES = r"(frequency|damping_ratio)_(\d+)_(\d+)"
"""and those of modes of the disc, with the numbers of nodal diameters and circles."""
QUANTITY = "|".join((*OF_CYCLES, OF_SLIDING, OF_MODES))
STEP = 1e-4
"""Step of derivatives over the start: cycles are accurate to 1e-12."""
NOT_THERE = 1e9
"""Standard deviations by which a case deviates that does not have what was measured: the next step
of the search is shorter."""


def fit(
    case: Parameters,
    vary: Sequence[str],
    data: pd.DataFrame | Sequence[Mapping[str, Any]],
    bounds: Mapping[str, tuple[float, float]] | None = None,
) -> MinimizerResult:
    """Fit parameters of a case to measurements, by weighted least squares with lmfit.

    Parameters
    ----------
    case : the case; its values of the varied parameters are the start of the search
    vary : names of the parameters that are fitted, each one of ``case.numbers``, such as ``mu_s``
    data : table with a row for each measurement, or what `pandas.DataFrame` makes one of: ``quantity``, its measured
        ``value`` and ``uncertainty``, one standard deviation, both in SI units; and a column for each parameter that
        was set at the measurement, such as ``Omega``, where an empty cell stands for the value of the case.
        Quantities are ``period``, ``growth_rate``, ``stick_fraction``, ``stick_time`` and ``slip_time`` of the
        stick-slip cycle (s, 1/s), as of `floquet`; ``sliding_growth_rate``, 1/s, as of `steady_sliding`; and
        ``frequency_2_0``, Hz, and ``damping_ratio_2_0`` of the disc's mode with 2 nodal diameters and 0 circles
    bounds : least and greatest value of varied parameters, by name, in SI units; the start is between them

    Returns
    -------
    lmfit.minimizer.MinimizerResult
        ``params`` has values, standard deviations (``stderr``) and correlations (``correl``), ``residual`` is
        (computed - measured value) / uncertainty of each row, and ``chisqr`` the sum of its squares. The fitted case is
        ``case.replace(**result.params.valuesdict())``.

    Raises
    ------
    ParameterError
        If an argument breaks a rule, or the case does not have at the start what was measured, as a stick-slip cycle
        at one of the speeds; the message names the row, counted from 0.
    ModuleNotFoundError
        If lmfit is missing, which the extra ``fit`` brings.

    Notes
    -----
    Standard deviations follow from the covariance (J^T J)^-1, where J has the derivatives of the residuals by the
    parameters [1]_: they hold as far as the residuals are linear over them, errors are independent and normal, and
    the uncertainties are right. Derivatives are central differences over 1e-4 of the start.

    References
    ----------
    .. [1] W. H. Press et al., Numerical Recipes, 3rd ed., Cambridge University Press, 2007, Section 15.6.

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=15, normalization="orthonormal")
    >>> measured = [
    ...     {"quantity": "frequency_0_0", "value": 239.0, "uncertainty": 0.5},
    ...     {"quantity": "frequency_2_0", "value": 292.5, "uncertainty": 0.5},
    ... ]
    >>> result = dm.fit(case, ["E", "nu"], measured, bounds={"nu": (0.1, 0.4)})
    >>> nu = result.params["nu"]
    >>> print(f"{nu.value:.3f} ± {nu.stderr:.3f}")
    0.209 ± 0.006
    """
    request = _Request(vary=vary, data=_records(data), bounds={} if bounds is None else bounds)
    require_case(case)
    raise_faults([*_faults(case, request)])
    lmfit = brought("lmfit", "fit")
    raise_faults([*_faults_of_start(case, request.data)])
    params = lmfit.Parameters()
    for name in request.vary:
        low, high = request.bounds.get(name, (-math.inf, math.inf))
        params.add(name, case.numbers[name], min=low, max=high)
    search = _Search(case, request.data, [abs(each.value) or 1.0 for each in params.values()])
    # scipy's other tests of convergence depend on the parameters' units
    tests = {"ftol": 1e-10, "xtol": 1e-15, "gtol": None}
    return lmfit.minimize(
        search.residuals,
        params,
        method="least_squares",
        scale_covar=False,
        jac=search.jacobian,
        x_scale=search.scales,
        **tests,
    )


class _Measurement(Strict):
    """A measured value, and what was set when it was measured as further values."""

    model_config = ConfigDict(extra="allow")
    quantity: Annotated[str, Field(pattern=f"^({QUANTITY})$")]
    value: Finite
    uncertainty: Positive

    @property
    def settings(self) -> dict[str, Any]:
        return self.model_extra or {}


class _Request(Strict):
    """What is fitted, and to what."""

    vary: Annotated[tuple[str, ...], Field(min_length=1)]
    data: Annotated[tuple[_Measurement, ...], Field(min_length=1)]
    bounds: dict[str, tuple[Real, Real]]


def _records(data: Any) -> Any:
    """The rows of a table without its empty cells; what is no table as it is."""
    try:
        table = pd.DataFrame(data)
    except (ValueError, TypeError, OverflowError):
        return data
    return [row.dropna().to_dict() for _, row in table.iterrows()]


def _faults(case: Parameters, request: _Request) -> Iterator[Fault]:
    """Yield the faults of names, starts and settings of a case."""
    for name in request.vary:
        if name not in case.numbers:
            rule = f"is no number of the case{suggestion(name, case.numbers)}"
            yield Fault.of(("vary",), name, rule)
    for name, (low, high) in request.bounds.items():
        start = case.numbers.get(name, math.nan)
        if name not in request.vary:
            yield Fault.of(("bounds",), name, "is not varied")
        elif not low < start < high:
            yield Fault.of((name,), start, f"must be between its bounds, {low:g} and {high:g}")
    for i, measurement in enumerate(request.data):
        try:
            case.replace(**measurement.settings)
        except ParameterError as error:
            yield from (Fault.inside(fault, ("data", str(i))) for fault in error.faults)


def _faults_of_start(case: Parameters, data: Sequence[_Measurement]) -> Iterator[Fault]:
    """Yield a fault of each measured quantity that the case does not have."""
    for i, deviation in enumerate(_deviations(case, data)):
        if math.isnan(deviation):
            settings = {"Omega": case.Omega, **data[i].settings}
            at = ", ".join(f"{name}={value}" for name, value in settings.items())
            path = ("data", str(i), "quantity")
            yield Fault.of(path, data[i].quantity, f"is not there at the start with {at}")


class _Search(NamedTuple):
    """What lmfit calls: a case at the start, measurements, and scales of the varied parameters."""

    case: Parameters
    data: Sequence[_Measurement]
    scales: Sequence[float]

    def residuals(self, params: Any) -> Array:
        return np.nan_to_num(self.deviations(params.valuesdict()), nan=NOT_THERE)

    def jacobian(self, params: Any) -> Array:
        values = params.valuesdict()
        here = self.deviations(values)
        columns = []
        for name, scale in zip(values, self.scales, strict=True):
            step = STEP * scale
            ahead = self.deviations({**values, name: values[name] + step}) - here
            behind = here - self.deviations({**values, name: values[name] - step})
            # their mean, or the one in whose direction there is a case
            slope = np.ma.masked_invalid([ahead, behind]).mean(axis=0) / step
            columns.append(slope.filled(0.0))
        return np.transpose(columns)

    def deviations(self, values: Mapping[str, float]) -> Array:
        """Deviations of the case with these values of its parameters."""
        try:
            return _deviations(self.case.replace(**values), self.data)
        except DiscModelError:  # such as mu_k > mu_s
            return np.full(len(self.data), math.nan)


def _deviations(case: Parameters, data: Sequence[_Measurement]) -> Array:
    """Deviations of a case from measurements in standard deviations, nan where it does not have
    what was measured."""
    cycle_of = cache(floquet)
    deviations = []
    for each in data:
        computed = _computed(each.quantity, case.replace(**each.settings), cycle_of)
        deviations.append((computed - each.value) / each.uncertainty)
    return np.array(deviations)


def _computed(
    quantity: str, case: Parameters, cycle_of: Callable[[Parameters], FloquetResult]
) -> float:
    """A quantity of a case, nan if it does not have it."""
    if quantity in OF_CYCLES:
        return getattr(cycle_of(case), quantity)
    if quantity == OF_SLIDING:
        return steady_sliding(case).growth_rate
    kind, diameters, circles = re.findall(OF_MODES, quantity)[0]
    modes = plate_modes(case).set_index(["diameters", "circles"])
    modes["frequency"] = modes["omega"] / math.tau
    modes["damping_ratio"] = modal_damping(case) / (2 * modes["omega"])
    return modes[kind].get((int(diameters), int(circles)), math.nan)
