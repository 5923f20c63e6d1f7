"""Sensitivity: the stick-slip cycle at samples of distributed parameters, from one scrambled Sobol'
sequence.

Wilson intervals assume independent samples. A failed one counts as stable at the lower end, as
unstable at the upper.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field
from xarray import Dataset

from disc_model.analysis.classify import share
from disc_model.data.variables import OF_QUANTITIES, with_advice
from disc_model.errors import require
from disc_model.parameters import Parameters
from disc_model.studies.quantity import Row, Ruled, attempted, found, quantity, with_ends
from disc_model.units import CycleTolerance, Finite, Natural, Seconds, Several, Unit, is_number

UNSTABLE = ("unstable", "no_cycle", "separates", "unstable_sliding")
FAILED = "failed"


class Uniform(Ruled):
    """A uniform distribution: all values from `low` to `high` are equally likely; `relative`: as multiples
    of the parameter's own value at the point."""

    distribution: Literal["uniform"]
    relative: bool = False
    low: Finite
    high: Finite

    _rules = ((lambda d: d.low < d.high, "low={0.low:g} must be < high={0.high:g}"),)


Distributions = Annotated[
    dict[str, Uniform],
    Field(min_length=1),
    Unit({name: Parameters.unit(name) for name in Parameters.model_fields}),
]


@quantity(
    rules=(
        (lambda o: o.samples & (o.samples - 1) == 0, "samples={0.samples} must be a power of two"),
    )
)
def sensitivity(
    case: Parameters,
    *,
    distributions: Distributions,
    samples: Several = 64,
    seed: Natural = 0,
    simulated_samples: Natural = 0,
    horizon: Seconds = 500.0,
    tol: CycleTolerance = 1e-12,
) -> Dataset:
    """The stick-slip cycle at samples of uncertain parameters, and the outcome of the static start: how likely is
    instability? Slow departures from cycles are extrapolated; separations after them are not timed.

    Parameters
    ----------
    distributions : distributions by parameter
    samples : number of samples, a power of two; more of them keep the first ones
    seed : whole number that determines the samples
    simulated_samples : number of the first samples whose motion is simulated as well
    horizon : longest simulated time of a sample
    tol : tolerance of cycles: relative residual of the return map

    Examples
    --------
    >>> import disc_model as dm
    >>> friction = {"distribution": "uniform", "low": 0.38, "high": 0.42}
    >>> found = dm.sensitivity(dm.Parameters(N=385, Omega=15), distributions={"mu_s": friction}, samples=4)
    >>> found["cycle"].values.tolist()
    ['no_cycle', 'stable', 'stable', 'unstable']
    """
    names = sorted(distributions)
    rows: list[Row] = []
    for values in _draws(case, distributions, samples, seed):
        rows.append({"parameter_values": values, "status": "ok", "cycle": FAILED})
    for i, row in enumerate(rows):
        row["outcome"] = FAILED if i < simulated_samples else "not_simulated"

    def fill(row: Row) -> Iterator[str]:
        own = dict(zip(names, row["parameter_values"].tolist(), strict=True))
        sample = case.replace(**own)
        yield evaluate_cycle(sample, tol, row)
        if row["outcome"] == FAILED:
            yield _outcome(sample, horizon, row)

    columns: Row = attempted(rows, fill)
    for words, hits, kind, asked in (
        (columns["cycle"], UNSTABLE, "cycles", "unstable"),
        (columns["outcome"][:simulated_samples], ("separation",), "outcomes", "separation"),
    ):
        lost = words.count(FAILED)
        known = len(words) - lost
        columns |= {f"n_known_{kind}": known, f"n_failed_{kind}": lost}
        probability = share(sum(word in hits for word in words), known, lost)
        columns |= with_ends(f"probability_{asked}", probability)
    return found("sensitivity", columns, sample=range(samples), parameter=names)


def _draws(
    case: Parameters, distributions: Mapping[str, Any], samples: int, seed: int
) -> np.ndarray:
    """Values of the distributed parameters, shape (samples, parameters)."""
    from scipy.stats import qmc

    numbers = case.numbers
    sequence = qmc.Sobol(len(distributions), scramble=True, rng=np.random.default_rng(seed))
    columns = []
    for (name, distribution), shares in zip(
        sorted(distributions.items()), sequence.random(samples).T, strict=True
    ):
        own = numbers.get(name)
        path = f"distributions.{name}"
        require((is_number(own), path, own, "must be of a parameter that is a number"))
        width = distribution.high - distribution.low
        column = distribution.low + shares * width
        if distribution.relative:
            column *= own
        columns.append(column)
    return np.transpose(columns)


def evaluate_cycle(case: Parameters, tol: float, row: Row) -> str:
    """Add the cycle of a sample; returns a message."""
    from disc_model.stability.cycle import find_cycle

    cycle = find_cycle(case, tol)
    row["growth_rate"] = cycle.growth_rate
    if cycle.motion not in OF_QUANTITIES["sensitivity"]["columns"]["cycle"].flags:
        return with_advice(cycle.message, cycle.status)
    row["cycle"] = cycle.motion
    return ""


def _outcome(case: Parameters, horizon: float, row: Row) -> str:
    """Add what the static start of a sample comes to; returns a message."""
    from disc_model.stability.follower import find_outcome

    result = find_outcome(case, horizon, compared_with=(horizon,))
    row["outcome"] = result.word
    row["first_separation"] = result.timed_separation
    return result.message
