"""Doubts about the number of modes of a study's cases."""

from collections.abc import Iterator, Sequence

from disc_model.parameters import Parameters
from disc_model.stability.few_modes import may_have_few_modes


def doubts_of_modes(cases: Sequence[Parameters]) -> Iterator[str]:
    """Yield what is said of cases that have too few modes for friction on the surface."""
    doubted = [case for case in cases if may_have_few_modes(case)]
    if not doubted:
        return
    from disc_model.stability.sliding import modes_in_doubt  # slow to import, and seldom needed

    yield from filter(None, map(modes_in_doubt, doubted))
