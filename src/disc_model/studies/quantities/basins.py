"""Basins of attraction at one point, from many starts: attractors, basin fractions and the critical
energy.

The first starts of all energies come first, then all second ones: further starts leave the earlier
ones unchanged.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from operator import attrgetter
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from xarray import Dataset

from disc_model.analysis.classify import share
from disc_model.data.variables import UNKNOWN_OUTCOMES, WORDS
from disc_model.errors import require
from disc_model.parameters import Parameters
from disc_model.studies.quantity import Row, found, quantity, with_ends
from disc_model.units import Natural, NotNegative, Seconds, Size, Tolerance, Unit

if TYPE_CHECKING:
    from disc_model.stability.follower import OutcomeResult

Objects = np.ndarray[Any, np.dtype[np.object_]]
Energy = Annotated[NotNegative, Unit("J")]
PRECISION = 1.05
"""Ratio of energies between which the critical one lies."""
SMALLEST = 2.0**-40
"""Fraction of the least separating energy of the sample, below which the bisection gives up."""
MOST_ATTRACTORS = 12
CLASSES = (*WORDS["long_term"][1:], WORDS["long_term"][0])
"""Outcomes of a start."""
OF_ATTRACTORS = (
    *("kind", "releases", "period", "segment.range"),
    *("segment.separation_rate", "segment.stick_fraction", "segment.separation_fraction"),
)
"""What is stored of an attractor, and of a stretch on it."""


@quantity(
    points_per_job=5,
    rules=(
        (
            lambda o: [*o.energies] == sorted({*o.energies}) != [],
            "energies={0.energies} must ascend",
        ),
        (
            lambda o: o.n_starts == 1 or 0.0 not in o.energies,
            "n_starts={0.n_starts} must be 1 where an energy is 0, since no direction tells them apart",
        ),
    ),
)
def basins(
    case: Parameters,
    energies: tuple[Energy, ...] = (0.0,),
    n_starts: Size = 1,
    *,
    horizon: Seconds = 200.0,
    seed: Natural = 1,
    tol: Tolerance = 1e-10,
) -> Dataset:
    """Attractors of a case, the share of starts that comes to each, and the least energy found that leads to
    separation.

    This critical energy is an upper bound: it depends on the directions that are tried, and is lower with more
    `energies` or `n_starts`.

    Parameters
    ----------
    energies : of perturbations of the start in random directions, ascending; 0 adds nothing
    n_starts : number of starts at each energy
    horizon : longest simulated time of a motion
    seed : whole number that determines the directions
    tol : tolerance of simulations: error of event times after a second of motion

    Returns
    -------
    xarray.Dataset
        `basin_fraction` by class of attractor with its interval of 95 %, `critical_energy` (J), and the attractors.
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
    from disc_model.simulation.states import static_start
    from disc_model.stability.attractors import Basins, random_perturbation

    modes_or_none = case.n_diameters >= 0 or not any(energies)
    rule = "must be 0 on a rigid disc, which has no modes to perturb"
    require((modes_or_none, "energies", energies, rule))
    state = static_start(case)
    known = Basins(case, horizon, tol=tol)

    def follow(energy: float, i: int, j: int) -> OutcomeResult:
        """The outcome of a perturbation of any energy in the direction of start i of the j-th energy."""
        return known.follow(random_perturbation(case, state, energy, (seed, j, i)))

    results = np.empty((len(energies), n_starts), dtype=object)
    # the first starts of all energies come first
    for i, j in np.ndindex(n_starts, len(energies)):
        results[j, i] = follow(energies[j], i, j)
    every = results.ravel().tolist()
    decided = [reached.separates for reached in every if reached.attractor is not None]
    separating = share(sum(decided), len(decided), len(every) - len(decided))
    by_energy = np.array([_shares(row) for row in results.tolist()])
    values: Row = {
        "kind": _each(results, lambda reached: reached.word),
        "simulated_time": _each(results, lambda reached: reached.simulated),
        "lost_contact": _each(results, _lost_contact),
        **with_ends("basin_fraction_by_energy", np.moveaxis(by_energy, -1, 0)),
        **with_ends("basin_fraction", np.transpose(_shares(every))),
        **with_ends("separating_fraction", separating),
        **_attractors(results),
    }
    each = np.ndenumerate(results)
    apart = [(energies[j], i, j) for (j, i), reached in each if reached.separates]
    if apart:
        values |= _critical_energy(*min(apart), lambda *start: follow(*start).separates)
    own = {"energy": energies, "start": range(n_starts), "attractor_class": CLASSES}
    own["attractor"] = range(1, MOST_ATTRACTORS + 1)
    if all(reached.outcome is None for reached in every):
        values["status"] = every[0].status
    return found("basins", values, *_remarks(every), **own)


def _remarks(every: Sequence[OutcomeResult]) -> Iterator[str]:
    """Yield how many starts failed or stayed undecided, if any."""
    failed = [reached for reached in every if reached.outcome is None]
    if failed:
        yield f"{len(failed)} of {len(every)} starts failed, such as {failed[0].message}"
    undecided = sum(reached.word == "undecided" for reached in every)
    if undecided:
        yield f"{undecided} of {len(every)} starts undecided within the horizon: raise it"


def _each(results: Objects, value: Callable[[OutcomeResult], Any]) -> Any:
    """A value of each start, by energies and starts."""
    return np.vectorize(value, otypes=[object])(results).tolist()


def _attractors(results: Objects) -> Row:
    """Columns of the attractors by decreasing number of starts; of equal numbers the one reached first
    comes first."""
    counts = Counter(reached.attractor for reached in results.ravel() if reached.attractor)
    order = counts.most_common()
    numbers = {attractor: 1 + i for i, (attractor, _) in enumerate(order)}
    columns = {
        "attractor_index": _each(results, lambda reached: numbers.get(reached.attractor, 0)),
        "attractor_starts": [starts for _, starts in order],
    }
    for path in OF_ATTRACTORS:
        name = path.removeprefix("segment.")
        columns[f"attractor_{name}"] = [attrgetter(path)(attractor) for attractor in numbers]
    return columns


def _lost_contact(reached: OutcomeResult) -> str:
    """Whether a motion lost contact while it was followed; "not_yet" if it only comes to an
    attractor on which contact is lost."""
    if not np.isnan(reached.first_separation):
        return "yes"
    return "not_yet" if reached.separates else "no"


def _critical_energy(
    first: float, i: int, j: int, separates: Callable[[float, int, int], bool]
) -> dict[str, float]:
    """Bisect the logarithm of the energy, in the direction of the separating start with the lowest energy."""
    least = {"critical_energy_sampled": first}
    if first == 0:
        return least
    if separates(0.0, 0, 0):
        return {**least, "critical_energy": 0.0}
    low = first / 4
    high = first
    while separates(low, i, j):
        high = low
        low = low / 4
        if low < SMALLEST * first:
            return {**least, "critical_energy": high}
    while high > low * PRECISION:
        middle = float(np.sqrt(low * high))
        if separates(middle, i, j):
            high = middle
        else:
            low = middle
    return {**least, "critical_energy_lower": low, "critical_energy": high}


def _shares(row: Sequence[OutcomeResult]) -> list[tuple[float, float, float]]:
    """Fractions of some starts that come to each class, with Wilson intervals, at whose upper ends the starts
    of unknown outcome come to it as well."""
    shares = []
    counts = Counter(reached.word for reached in row)
    for word in CLASSES:
        unknown = 0
        if word not in UNKNOWN_OUTCOMES:
            unknown = sum(counts[other] for other in UNKNOWN_OUTCOMES)
        _, low, high = share(counts[word], len(row) - unknown, unknown)
        shares.append((counts[word] / len(row), low, high))
    return shares
