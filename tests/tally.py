"""Counts of what long tests have tried, for the summary at the end of a run."""

from collections import Counter, defaultdict
from collections.abc import Iterator

_COUNTS: defaultdict[str, Counter[str]] = defaultdict(Counter)


def tried(heading: str, what: str, count: int = 1) -> None:
    """Count something under a heading, as in ``tried("faults", "jobs killed")``."""
    _COUNTS[heading][what] += count


def lines() -> Iterator[str]:
    """One line for each heading: its total, and how that is made up."""
    for heading, counts in _COUNTS.items():
        parts = ", ".join(f"{count:,} {what}" for what, count in counts.items())
        yield f"{heading}: {counts.total():,} ({parts})"
