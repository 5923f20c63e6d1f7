"""Sensitivity: the stick-slip cycle at samples of distributed parameters.

Each sample is drawn twice, as A and as B, from one scrambled Sobol' sequence. The sequence has twice as many dimensions
as there are distributed parameters. For each parameter, a variant of A takes this parameter from B: the design of
Saltelli et al. (2010) for first-order and total indices, see `disc_model.analysis.sobol`. A sample depends only on the
seed and its own number.
"""

from collections.abc import Mapping
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr, ndtri
from scipy.stats import qmc

from disc_model.data.variables import SCALARS, Variable
from disc_model.parameters import Parameters
from disc_model.stability.attractor.outcome import find_outcome
from disc_model.stability.cycle import CycleStatus, FloquetResult, floquet
from disc_model.studies.document import Distribution, SensitivityOptions
from disc_model.studies.grids.points import (
    DRAWS,
    SAMPLE_CYCLES,
    SAMPLE_OUTCOMES,
    STATUS,
    Coordinate,
    Point,
    Row,
    listed,
    tried,
)

Array = NDArray[np.float64]

COLUMNS = {
    "status": STATUS,
    "parameter_values": Variable(
        "", "values of the distributed parameters, SI units", dims=("sample_matrix", "parameter")
    ),
    "cycle": Variable("1", "class of the cycle near the static start", SAMPLE_CYCLES, dims=("variant",)),
    "growth_rate": Variable(
        "s-1", "growth rate of disturbances of the stick-slip cycle, nan without one", dims=("variant",)
    ),
    "outcome": Variable("1", "what becomes of the static start of A within the horizon", SAMPLE_OUTCOMES),
    "first_separation": SCALARS["first_separation"],
}
COORDINATES = {
    "sample_matrix": Coordinate("", "one of the two draws of a sample", lambda o: DRAWS),
    "parameter": Coordinate("", "distributed parameter", lambda o: sorted(o.distributions)),
    "variant": Coordinate(
        "", "draw A, draw B, or A with this parameter taken from B", lambda o: (*DRAWS, *sorted(o.distributions))
    ),
}


def compute_point(point: Point, options: SensitivityOptions) -> tuple[dict[str, Any], str]:
    """Compute one sample about the point's own parameters."""
    p, names = point.parameters, sorted(options.distributions)
    shares = unit_draws(options.seed, len(names), point.sample)
    own = dict(p) | ({} if p.disc is None else p.disc.numbers)
    given = [(options.distributions[name], float(own[name])) for name in names]
    drawn = np.array([[quantile(*one, part) for one, part in zip(given, row, strict=True)] for row in shares])
    rows = [dict(zip(names, row, strict=True)) for row in variants(drawn).tolist()]
    cycles, messages = zip(*(tried("cycle", evaluate, p, row, options.tol) for row in rows), strict=True)
    values = listed(cycles) | {"status": "ok", "parameter_values": drawn, "outcome": "not_simulated"}
    if point.sample < options.simulated_samples:
        more, message = tried("outcome", _followed, p.replace(**rows[0]), options)
        values |= more
        messages += (message,)
    return values, "; ".join(dict.fromkeys(filter(None, messages)))


# ----------------------------------------------------------------------------------------------------
# Samples

BLOCK = 64
"""Number of samples that are drawn at once."""
EDGE = 1e-10
"""Fraction of a normal distribution that is cut off, in both tails together."""


def unit_draws(seed: int, count: int, number: int) -> Array:
    """A and B of one sample, shape (2, count), in the unit cube."""
    block, row = divmod(number, BLOCK)
    return _block(seed, count, block)[row].reshape(2, count)


@lru_cache(maxsize=8)
def _block(seed: int, count: int, block: int) -> Array:
    sequence = qmc.Sobol(2 * count, scramble=True, rng=np.random.default_rng(seed))
    if block:  # scipy rejects 0
        sequence.fast_forward(block * BLOCK)
    return np.asarray(sequence.random(BLOCK), dtype=float)


def quantile(given: Distribution, own: float, share: float) -> float:
    """Quantile of a parameter's distribution, which may be relative to the point's own value."""
    scale = own if given.relative else 1.0
    low, high = given.ends
    if given.distribution == "uniform":
        return float(scale * (low + share * (high - low)))
    first, last = EDGE / 2, 1 - EDGE / 2
    if given.distribution == "truncated_normal":
        first, last = (ndtr((end - given.mean) / given.deviation) for end in (low, high))
    value = given.mean + given.deviation * float(ndtri(first + share * (last - first)))
    # rounding must not exceed the ends
    return float(scale * min(max(value, low), high))


def variants(drawn: Array) -> Array:
    """A, B, and A with each parameter in turn taken from B: shape (2 + n, n), of draws of shape (2, n)."""
    a, b = drawn
    return np.vstack([a, b, np.where(np.eye(len(a), dtype=bool), b, a)])


# ----------------------------------------------------------------------------------------------------
# Results of one sample


def evaluate(p: Parameters, values: Mapping[str, float], tol: float) -> tuple[Row, str]:
    """Compute the cycle of a case with some parameters replaced: its class and growth rate (1/s), and a message."""
    found = floquet(p.replace(**values), tol=tol)
    cycle = cycle_word(found)
    return {"cycle": cycle, "growth_rate": found.growth_rate}, found.message if cycle == "failed" else ""


def cycle_word(found: FloquetResult) -> str:
    """The class of a cycle in `SAMPLE_CYCLES`."""
    if found.status is CycleStatus.OK:
        return "stable" if found.stable else "unstable"
    if found.status is CycleStatus.NO_STICK_SLIP:
        return "steady_sliding" if found.sliding.stable else "unstable_sliding"
    return found.status.value if found.status.value in SAMPLE_CYCLES else "failed"


def _followed(p: Parameters, options: SensitivityOptions) -> tuple[Row, str]:
    """Simulate the static start and return its outcome."""
    found = find_outcome(p, options.horizon, tol=options.motion_tol)
    return {"outcome": found.word, "first_separation": found.first_separation}, found.message
