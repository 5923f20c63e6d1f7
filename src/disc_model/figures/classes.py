"""Looks of classes: one colour, pattern and name for each word of a flag, the same in all figures
and in the explorer."""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from disc_model.data.variables import EXCLUDED


class Look(NamedTuple):
    """Appearance of a class: its name, and the colour and pattern of its areas.

    label : what a legend says
    face : colour as ``#rrggbb``, or "none" for a pattern that lies over other colours
    hatch : pattern in the letters of matplotlib, "" for a plain area
    """

    label: str
    face: str
    hatch: str = ""

    @property
    def ink(self) -> str:
        """Colour of the pattern: white on dark areas, black on light ones."""
        return "#ffffff" if self.face != "none" and lightness(self.face) < 0.5 else "#000000"


WEIGHTS = (0.299, 0.587, 0.114)
"""Weights of red, green and blue in grey print."""


def lightness(colour: str) -> float:
    """Lightness in grey print of a colour ``#rrggbb``, from 0 for black to 1 for white."""
    channels = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    return sum(weight * channel for weight, channel in zip(WEIGHTS, channels, strict=True))


# ---- Marks that lie over classes, and never stand in their place

UNRESOLVED = Look("unresolved", "none", 8 * "/")
"""Of a cell between two that are alike and differ from it. Two lines of its hatch fit into a
fiftieth of a panel."""
STABLE = Look("stable", "none", 3 * ".")
"""Of growth rates below zero, since a grey print does not show the sign of a diverging scale."""
AT_BOUND = Look("at or below the lower bound", "none", 4 * "-")
"""Of a critical value that is the lower bound of its search."""
UNSETTLED = Look("not settled", "none", 4 * "\\")
"""Of a value that rests on a stay of a sweep at whose end the motion had not settled."""
GROWING = Look("still growing, or undecided", "none", 4 * "\\")
"""Of a value late in a motion that has not shown what it comes to."""
UNKNOWN_STARTS = Look("outcome of some starts unknown", "none", 3 * "|")
"""Of a value that rests on starts some of which are undecided or failed."""
NOT_CONVERGED = Look("not converged", "none", 4 * "\\")
"""Of an average over a time that was too short for it."""
DOUBTS = (UNSETTLED, GROWING, UNKNOWN_STARTS, NOT_CONVERGED)
"""Marks of values that may be others than those of all motions, once they have settled."""
FILLED_MARK = "filled: {}"
"""What legends of marks say of one in doubt, where all others are open."""
NO_VALUE = Look("no value", "#ffffff", 3 * "/")
"""Of points of a numeric variable that were computed, and have no number."""

# ---- Classes with a look of their own. Those of one flag differ in colour, and in grey print in
# lightness or pattern; slashes and dots are left to the marks above.

LOOKS: Mapping[str, Look] = {
    # what becomes of a motion
    "quiet": Look("quiet", "#f3f6f8"),
    "growing": Look("growing, in contact", "#c2ccd6"),
    "other_cycle": Look("another cycle in contact", "#86a0b8", 3 * "+"),
    "steady_sliding": Look("steady sliding", "#e3d5ee", 3 * "|"),
    "unstable_sliding": Look("unstable steady sliding", "#b08cc6", 6 * "|"),
    "no_stick_slip": Look("slides without sticking", "#ecd9e6", 3 * "+"),
    "at_rest": Look("permanent stick", "#c4e3cd", 3 * "-"),
    "separation": Look("separation", "#bb5200"),
    "separating": Look("separating", "#d9771f"),
    "quasi_periodic": Look("quasi-periodic", "#b5dcf2", 4 * "\\"),
    "irregular": Look("irregular", "#7a4b12", 2 * "o"),
    "undecided": Look("undecided", "#43372a"),
    "failed": Look("failed", "#000000", 3 * "x"),
    "not_simulated": Look("not simulated", "#ffffff", 2 * "*"),
    # the search for a cycle
    "ok": Look("ok", "#dbe9f4"),
    "followed": Look("cycle followed", "#dbe9f4"),
    "nearby_only": Look("cycle nearby, not followed", "#f2e6a2", 5 * "-"),
    "separates": Look("immediate separation", "#f3c9ae", 6 * "\\"),
    "no_cycle": Look("no cycle found", "#b5b5b5", 4 * "x"),
    "stable": Look("stable", "#dbe9f4"),
    "unstable": Look("unstable", "#b8402f"),
    # phases of the motion
    "stick": Look("stick", "#009e73", 3 * "-"),
    "slip": Look("slip", "#e9c7da"),
    # points that a study's rule or xarray's where leaves out, and those that have no class
    "no_value": NO_VALUE,
    EXCLUDED: Look("left out", "#ffffff", 3 * "x"),
    "none": Look("none", "#ffffff", 2 * "-"),
    "infinite": Look("infinite", "#ffffff", 2 * "O"),
    "minus_infinite": Look("minus infinite", "#ffffff", 3 * "."),
    "vanishing": Look("growth rate −∞", "#ffffff", 3 * "."),
}
IN_FULL = {"neimark_sacker": "Neimark-Sacker"}
"""Names of classes that are no plain words."""
FURTHER_COLOURS = (
    "#56b4e9",
    "#e69f00",
    "#117755",
    "#cc79a7",
    "#332288",
    "#ddcc77",
    "#882255",
    "#88ccaa",
    "#0072b2",
    "#aa7744",
    "#999999",
    "#ee8866",
)
FURTHER_HATCHES = ("", "|||", "---", "\\\\\\", "+++", "xxx", "oo", "**", "||||||")


def looks_of(words: Iterable[str]) -> dict[str, Look]:
    """Looks of all words of a flag, in their order. A word without a look of its own has one by its
    place among those; up to twelve of them differ in colour, and neighbours in pattern."""
    looks = {}
    further = 0
    for word in map(str, words):
        if word in LOOKS:
            looks[word] = LOOKS[word]
            continue
        colour = FURTHER_COLOURS[further % len(FURTHER_COLOURS)]
        hatch = FURTHER_HATCHES[further % len(FURTHER_HATCHES)]
        looks[word] = Look(name_of(word), colour, hatch)
        further += 1
    return looks


def name_of(word: str) -> str:
    """What figures and the explorer call a class."""
    if word in LOOKS:
        return LOOKS[word].label
    return IN_FULL.get(word, word.replace("_", " "))
