"""What many starts come to: columns of each start, shares of outcomes, and what attractors are."""

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from disc_model.analysis.classify import share
from disc_model.data.variables import UNKNOWN_OUTCOMES, WORDS
from disc_model.display import counted
from disc_model.studies.quantity import OutcomeResult, with_ends

CLASSES = (*WORDS["long_term"][1:], WORDS["long_term"][0])  # outcomes of a start
SHOWN = (
    "range",
    "separation_rate",
    "stick_fraction",
    "separation_fraction",
)  # statistics of a stretch on an attractor


def columns_of_starts(
    results: Sequence[Sequence[OutcomeResult]], attractors: Sequence[tuple[Any, int]]
) -> dict[str, Any]:
    """Columns by energy and start; attractors are numbered from 1 in their order, 0 is none."""
    numbers: dict[Any, int] = {None: 0}
    for i, (attractor, _) in enumerate(attractors, start=1):
        numbers[attractor] = i
    columns: dict[str, Any] = {
        "kind": [],
        "attractor_index": [],
        "simulated_time": [],
        "lost_contact": [],
    }
    for row in results:
        columns["kind"].append([reached.word for reached in row])
        columns["attractor_index"].append([numbers[reached.attractor] for reached in row])
        columns["simulated_time"].append([reached.simulated for reached in row])
        columns["lost_contact"].append([_lost_contact(reached) for reached in row])
    return columns


def _lost_contact(reached: OutcomeResult) -> str:
    """Whether a motion lost contact while it was followed; "not_yet" if it only comes to an
    attractor on which contact is lost."""
    if not np.isnan(reached.first_separation):
        return "yes"
    return "not_yet" if reached.separates else "no"


def remarks_of_undecided(every: Sequence[OutcomeResult]) -> list[str]:
    """How many starts are undecided, and how many of these have lost contact; nothing without one."""
    undecided = [reached for reached in every if reached.word == "undecided"]
    if not undecided:
        return []
    lost = sum(not np.isnan(reached.first_separation) for reached in undecided)
    starts = f"{len(undecided)} of {counted(len(every), 'start')}"
    if lost:
        starts = f"{starts} ({lost} after contact was lost)"
    return [f"{starts} undecided within the horizon: raise it"]


def columns_of_attractor(attractor: Any, count: int) -> dict[str, Any]:
    """Columns of an attractor that `count` starts reach."""
    described: dict[str, Any] = {"attractor_starts": count}
    for name in ("kind", "releases", "period", "growth_rate"):
        described[f"attractor_{name}"] = getattr(attractor, name)
    for name in SHOWN:
        described[f"attractor_{name}"] = getattr(attractor.segment, name)
    return described


def fractions_of(
    results: Sequence[Sequence[OutcomeResult]], every: Sequence[OutcomeResult], confidence: float
) -> dict[str, Any]:
    """Fractions of the outcomes by energy and of all starts, with confidence intervals."""
    values = _shares("basin_fraction_by_energy", results, confidence)
    for name, (fractions,) in _shares("basin_fraction", [every], confidence).items():
        values[name] = fractions
    decided = [reached for reached in every if reached.attractor is not None]
    separating = sum(reached.separates for reached in decided)
    unknown = len(every) - len(decided)
    shown = share(separating, len(decided), unknown, confidence)
    values.update(with_ends("separating_fraction", shown))
    return values


def _shares(
    name: str, results: Sequence[Sequence[OutcomeResult]], confidence: float
) -> dict[str, Any]:
    """Fractions of the outcomes in each row, with Wilson intervals: shape (rows, classes)."""
    shares = []
    for row in results:
        counts = Counter(reached.word for reached in row)
        shares.append([_share_of(word, counts, confidence) for word in CLASSES])
    return with_ends(name, np.moveaxis(np.array(shares), -1, 0))


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
