"""Basins of attraction at one point, from many starts: attractors, basin fractions and the critical
energy.

The first starts of all energies come first, then all second ones: further starts leave the earlier
ones unchanged.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import xarray as xr
from pydantic import Field

from disc_model.analysis.classify import share
from disc_model.data.variables import UNKNOWN_OUTCOMES, WORDS
from disc_model.display import counted
from disc_model.errors import require
from disc_model.parameters import Parameters
from disc_model.studies.quantity import MOST, STATIC, Starting, found, listed, quantity, with_ends
from disc_model.units import Count, Real, Seconds, Tolerance, Unit

if TYPE_CHECKING:
    from disc_model.stability.follower import OutcomeResult

Energy = Annotated[Real, Field(ge=0, allow_inf_nan=False), Unit("J")]
SMALLEST = 2.0**-40
"""Fraction of the least separating energy of the sample, below which the bisection gives up."""
CLASSES = (*WORDS["long_term"][1:], WORDS["long_term"][0])
"""Outcomes of a start."""
SHOWN = ("range", "separation_rate", "stick_fraction", "separation_fraction")
"""Statistics of a stretch on an attractor."""
Separates = Callable[[float, int, int], bool]


@quantity(
    points_per_job=5,
    rules=(
        (lambda o: [*o.energies] == sorted({*o.energies}), "energies={0.energies} must ascend"),
        (
            lambda o: o.n_starts == 1 or 0.0 not in o.energies,
            "n_starts={0.n_starts} must be 1 where an energy is 0, since no direction tells them apart",
        ),
    ),
)
def basins(
    case: Parameters,
    energies: Annotated[tuple[Energy, ...], Field(min_length=1)] = (0.0,),
    n_starts: Annotated[Count, Field(ge=1, le=MOST)] = 1,
    *,
    start: Starting = STATIC,
    horizon: Seconds = 200.0,
    seed: Annotated[Count, Field(ge=0)] = 1,
    attractor_tol: Annotated[Real, Field(ge=0, le=0.25)] = 0.1,
    n_bisection_directions: Annotated[Count, Field(ge=0, le=1000)] = 1,
    precision: Annotated[Real, Field(gt=1e-6, le=1)] = 0.05,
    confidence: Annotated[Real, Field(gt=0, lt=1)] = 0.95,
    max_attractors: Annotated[Count, Field(ge=1, le=1000)] = 12,
    tol: Tolerance = 1e-10,
) -> xr.Dataset:
    """Attractors of a case, the share of starts that comes to each, and the least energy found that leads to
    separation.

    This critical energy is an upper bound: it depends on the directions that are tried, and is lower with more
    `energies`, `n_starts` or `n_bisection_directions`. Which directions these are depends on the seed and on the
    number of starts at lower energies.

    Parameters
    ----------
    energies : of perturbations of the start in random directions, ascending; 0 adds nothing
    n_starts : number of starts at each energy
    start : what is perturbed
    horizon : longest simulated time of a motion
    seed : whole number that determines the directions
    attractor_tol : relative difference of ranges at which a motion that approaches a known attractor has come to it; 0:
        all motions are followed to the horizon
    n_bisection_directions : number of directions, those of the least separating energies, in which the critical energy
        is bisected
    precision : relative precision of the critical energy
    confidence : level of the confidence intervals of fractions
    max_attractors : room for that many attractors, those of most starts first
    tol : tolerance of simulations: error of event times after a second of motion

    Returns
    -------
    xarray.Dataset
        `basin_fraction` by class of attractor with its confidence interval, `critical_energy` (J), and the attractors.
        Of each start `kind` says what it comes to, and `lost_contact` whether contact was lost on the way, also where
        the outcome is undecided: "yes", "no", or "not_yet" if the motion was followed only until it was known to come
        to an attractor on which contact is lost. Undecided starts count as separating at the upper ends of intervals,
        as not separating at the lower ones, and `separating_fraction` is of the other starts; `message` counts the
        starts that are undecided within the horizon

    Examples
    --------
    >>> import disc_model as dm
    >>> found = dm.basins(dm.Parameters(N=385, Omega=14), [1e-4, 0.1], 3, horizon=60)
    >>> found["kind"].values.tolist()
    [['stick_slip', 'stick_slip', 'stick_slip'], ['separating', 'separating', 'separating']]
    """
    from disc_model.simulation.starts import make_initial_state
    from disc_model.simulation.states import static_start
    from disc_model.stability.attractors import Basins, random_perturbation

    modes_or_none = case.n_diameters >= 0 or not any(energies)
    rule = "must be 0 on a rigid disc, which has no modes to perturb; perturb f of the start"
    require((modes_or_none, "energies", energies, rule))
    state = make_initial_state(case, start, tol) or static_start(case)
    known = Basins(case, horizon, near=attractor_tol, tol=tol)

    def follow(energy: float, i: int, j: int) -> OutcomeResult:
        """The outcome of a perturbation of any energy in the direction of start i of the j-th energy."""
        return known.follow(random_perturbation(case, state, energy, (seed, j, i)))

    # the first starts of all energies come first
    by_start = []
    for i in range(n_starts):
        by_start.append([follow(energy, i, j) for j, energy in enumerate(energies)])
    results = [*zip(*by_start, strict=True)]
    every = [reached for row in results for reached in row]

    # by decreasing number of starts; of equal numbers the one reached first comes first
    counts = Counter(reached.attractor for reached in every if reached.attractor is not None)
    attractors = counts.most_common()
    failed = [reached for reached in every if reached.outcome is None]
    bisected = _critical_energy(
        energies,
        results,
        lambda *direction: follow(*direction).separates,
        n_bisection_directions,
        precision,
    )
    values: dict[str, Any] = {
        "status": failed[0].status if len(failed) == len(every) else "ok",
        **_columns_of_starts(results, [attractor for attractor, _ in attractors]),
        **_fractions(results, confidence),
        **bisected,
        **listed([_columns_of_attractor(each, count) for each, count in attractors]),
    }
    remarks = []
    if failed:
        remarks.append(f"{len(failed)} of {len(every)} starts failed, such as {failed[0].message}")
    own = {"energy": energies, "start": range(n_starts), "attractor_class": CLASSES}
    own["attractor"] = range(1, max_attractors + 1)
    message = "; ".join([*remarks, *_remarks_of_undecided(every)])
    return found("basins", values, message, **own)


# ---- The critical energy


def _critical_energy(
    energies: Sequence[float],
    results: Sequence[Sequence[OutcomeResult]],
    separates: Separates,
    directions: int,
    precision: float,
) -> dict[str, float]:
    """Bisect the logarithm of the energy in the directions of the separating starts with the lowest
    energies."""
    separating = []
    for j, row in enumerate(results):
        separating += [(energies[j], i, j) for i, result in enumerate(row) if result.separates]
    if not separating:
        return {}
    separating.sort()
    least = {"critical_energy_sampled": separating[0][0]}
    if separating[0][0] == 0 or not directions:
        return least
    if separates(0.0, 0, 0):
        return {**least, "critical_energy": 0.0}
    ends = [_bisected(*first, separates, precision) for first in separating[:directions]]
    low, high = min(ends, key=lambda pair: pair[1])
    return {**least, "critical_energy_lower": low, "critical_energy": high}


def _bisected(
    first: float, i: int, j: int, separates: Separates, precision: float
) -> tuple[float, float]:
    """Energies without and with lasting separation, closer to each other than the required precision."""
    low = first / 4
    high = first
    while separates(low, i, j):
        high = low
        low = low / 4
        if low < SMALLEST * first:
            return np.nan, high
    while high > low * (1 + precision):
        middle = float(np.sqrt(low * high))
        if separates(middle, i, j):
            high = middle
        else:
            low = middle
    return low, high


# ---- Columns of starts and attractors, and shares of outcomes


def _columns_of_starts(
    results: Sequence[Sequence[OutcomeResult]], attractors: Sequence[Any]
) -> dict[str, Any]:
    """Columns by energy and start; attractors are numbered from 1 in their order, 0 is none."""
    numbers = {None: 0, **{attractor: i for i, attractor in enumerate(attractors, start=1)}}

    def by_start(value: Callable[[OutcomeResult], Any]) -> list[list[Any]]:
        return [[value(reached) for reached in row] for row in results]

    return {
        "kind": by_start(lambda reached: reached.word),
        "attractor_index": by_start(lambda reached: numbers[reached.attractor]),
        "simulated_time": by_start(lambda reached: reached.simulated),
        "lost_contact": by_start(_lost_contact),
    }


def _lost_contact(reached: OutcomeResult) -> str:
    """Whether a motion lost contact while it was followed; "not_yet" if it only comes to an
    attractor on which contact is lost."""
    if not np.isnan(reached.first_separation):
        return "yes"
    return "not_yet" if reached.separates else "no"


def _remarks_of_undecided(every: Sequence[OutcomeResult]) -> Iterable[str]:
    """How many starts are undecided, and how many of these have lost contact; nothing without one."""
    undecided = [reached for reached in every if reached.word == "undecided"]
    lost = sum(not np.isnan(reached.first_separation) for reached in undecided)
    if undecided:
        after = f" ({lost} after contact was lost)" if lost else ""
        starts = f"{len(undecided)} of {counted(len(every), 'start')}{after}"
        yield f"{starts} undecided within the horizon: raise it"


def _columns_of_attractor(attractor: Any, count: int) -> dict[str, Any]:
    """Columns of an attractor that `count` starts reach."""
    described: dict[str, Any] = {"attractor_starts": count}
    for name in ("kind", "releases", "period", "growth_rate"):
        described[f"attractor_{name}"] = getattr(attractor, name)
    for name in SHOWN:
        described[f"attractor_{name}"] = getattr(attractor.segment, name)
    return described


def _fractions(results: Sequence[Sequence[OutcomeResult]], confidence: float) -> dict[str, Any]:
    """Fractions of the outcomes by energy and of all starts, with confidence intervals."""
    every = [reached for row in results for reached in row]
    by_energy = [_shares(row, confidence) for row in results]
    values = with_ends("basin_fraction_by_energy", np.moveaxis(np.array(by_energy), -1, 0))
    values |= with_ends("basin_fraction", np.transpose(_shares(every, confidence)))
    decided = [reached for reached in every if reached.attractor is not None]
    separating = sum(reached.separates for reached in decided)
    unknown = len(every) - len(decided)
    shown = share(separating, len(decided), unknown, confidence)
    return values | with_ends("separating_fraction", shown)


def _shares(row: Sequence[OutcomeResult], confidence: float) -> list[tuple[float, float, float]]:
    """Fractions of the outcomes of some starts, with Wilson intervals, by class."""
    counts = Counter(reached.word for reached in row)
    return [_share_of(word, counts, confidence) for word in CLASSES]


def _share_of(
    word: str, counts: Mapping[str, int], confidence: float
) -> tuple[float, float, float]:
    """Fraction of the starts that come to an outcome, and its Wilson interval, at whose upper end
    the starts of unknown outcome come to it as well."""
    starts = sum(counts.values())
    unknown = 0
    if word not in UNKNOWN_OUTCOMES:
        unknown = sum(counts[other] for other in UNKNOWN_OUTCOMES)
    _, low, high = share(counts[word], starts - unknown, unknown, confidence)
    return counts[word] / starts, low, high
