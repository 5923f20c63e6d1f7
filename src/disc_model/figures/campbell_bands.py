"""Stretches of speeds without a stick-slip cycle in Campbell diagrams: what there is in its place."""

from collections.abc import Iterator, Sequence
from typing import Any

import xarray as xr
from matplotlib.patches import Patch

from disc_model.figures.classes import LOOKS, name_of
from disc_model.figures.drawing import GREY
from disc_model.figures.selection import NO_VALUE, classes_of_gaps, spans
from disc_model.figures.types import Artist, Axes, Words

SLIDING = ("steady_sliding", "unstable_sliding")
"""What has a look of its own, as in maps."""
PLAIN: dict[str, Any] = {"color": GREY, "alpha": 0.25, "linewidth": 0}
"""Look of all else."""
BEHIND = -2  # zorder, below lines of multiples and of peaks
WITHOUT = "no growth rate"


def draw_bands(top: Axes, bottom: Axes, study: xr.Dataset) -> None:
    """Shade the speeds without a cycle in both panels; only the lower one is hatched, as lines are
    close to each other in the upper one."""
    speeds = study["Omega"].values
    words = _words_of(study)
    for word in _words_in(words):
        for start, end in spans(speeds, words == word):
            top.axvspan(start, end, zorder=BEHIND, **_look_of(word, hatched=False))
            bottom.axvspan(start, end, zorder=BEHIND, **_look_of(word))


def entries_of_bands(studies: Sequence[xr.Dataset]) -> list[Artist]:
    """Entries of a legend for such speeds: of kinds of sliding, and of all else, with what was found."""
    found = dict.fromkeys(word for study in studies for word in _words_in(_words_of(study)))
    handles: list[Artist] = [
        Patch(label=LOOKS[word].label, **_look_of(word)) for word in SLIDING if word in found
    ]
    others = [word for word in found if word not in SLIDING]
    if others:
        reasons = [name_of(word) for word in others if word != NO_VALUE]
        label = ",\n".join(reasons) or WITHOUT
        handles.append(Patch(label=label, **PLAIN))
    return handles


def _words_of(study: xr.Dataset) -> Words:
    """What there is at each speed without a cycle, as a word; "" where there is one."""
    return classes_of_gaps(study, study["growth_rate"])


def _words_in(words: Words) -> Iterator[str]:
    """Yield each word once, in the order of speeds."""
    yield from dict.fromkeys(str(word) for word in words if word)


def _look_of(word: str, *, hatched: bool = True) -> dict[str, Any]:
    """Look of the band of a word, as in maps, with a hatch that lines stand out from."""
    if word not in SLIDING:
        return PLAIN
    look = LOOKS[word]
    band: dict[str, Any] = {"facecolor": look.face, "edgecolor": GREY, "linewidth": 0}
    if hatched:
        band["hatch"] = look.hatch
    return band
