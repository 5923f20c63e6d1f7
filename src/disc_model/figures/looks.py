"""The look of each class, the same in all figures: those of one flag differ in lightness or pattern
in grey print."""

from collections.abc import Iterable
from itertools import cycle
from typing import Any, NamedTuple

Options = dict[str, Any]
"""Options of matplotlib by name."""
BLACK = "#000000"
GREY = "#8a8a8a"
BLUE = "#0072B2"
ORANGE = "#E69F00"
GREEN = "#009E73"
PURPLE = "#CC79A7"
RED = "#D55E00"
SKY = "#56B4E9"
OF_VARIABLE = {"P": "#4d4d4d", "w": BLUE, "w_point": BLUE, "psi": ORANGE, "u": ORANGE}
"""Colours of sampled variables, and of their velocities."""
OF_PHASE = {"stick": GREEN, "slip": PURPLE, "separation": RED}
PAPER: Options = {"color": "#F0E442", "markeredgecolor": BLACK, "markeredgewidth": 0.8}
"""The look of what the paper says."""


class Look(NamedTuple):
    """What a legend calls a class, the colour of its areas, and their pattern and its colour."""

    label: str
    face: str = "none"
    hatch: str = ""
    ink: str = BLACK

    @property
    def paint(self) -> Options:
        """What matplotlib calls them."""
        paint = {"label": self.label, "fc": self.face, "hatch": self.hatch, "ec": "none"}
        if self.hatch:
            paint["ec"] = self.ink
        return paint


STABLE = Look("stable", "none", "...")
"""Of growth rates below zero, over their colours: grey print does not show their sign."""
AROUND_DOTS = Look("_nolegend_", "none", "ooo", "#ffffff")
"""Rings in which black dots are seen on dark colours."""
UNRESOLVED = Look("finer than the cells", "none", "////////")
"""Of single cells, over their colours."""

LOOKS = {
    # what becomes of a motion
    "stick_slip": Look("stick-slip, small", "#f3f6f8"),
    "growing": Look("growing, in contact", "#c2ccd6"),
    "other_cycle": Look("another cycle in contact", "#86a0b8", "+++"),
    "steady_sliding": Look("steady sliding", "#e3d5ee", "|||"),
    "unstable_sliding": Look("unstable steady sliding", "#b08cc6", "||||||"),
    "no_stick_slip": Look("slides without sticking", "#ecd9e6", "+++"),
    "at_rest": Look("permanent stick", "#c4e3cd", "---"),
    "separation": Look("separation", "#bb5200"),
    "separating": Look("separating", "#d9771f"),
    "quasi_periodic": Look("quasi-periodic", "#b5dcf2", "\\\\\\\\"),
    "irregular": Look("irregular", "#7a4b12", "oo", "#ffffff"),
    "undecided": Look("undecided", "#43372a"),
    "failed": Look("failed", "#000000", "xxx", "#ffffff"),
    "not_simulated": Look("not simulated", "#ffffff", "**"),
    # the search for a cycle
    "ok": Look("ok", "#dbe9f4"),
    "followed": Look("cycle followed", "#dbe9f4"),
    "nearby_only": Look("cycle nearby, not followed", "#f2e6a2", "-----"),
    "separates": Look("immediate separation", "#f3c9ae", "\\\\\\\\\\\\"),
    "no_cycle": Look("no cycle found", "#b5b5b5", "xxxx"),
    "stable": Look("stable", "#dbe9f4"),
    "unstable": Look("unstable", "#b8402f"),
    # phases of the motion
    "stick": Look("stick", "#009e73", "---"),
    "slip": Look("slip", "#e9c7da"),
    # points without a class
    "no_value": Look("no value", "#ffffff", "///"),
    "excluded": Look("left out", "#ffffff", "xxx"),
    "none": Look("none", "#ffffff", "--"),
}
FURTHER_COLOURS = ("#56b4e9", "#e69f00", "#117755", "#cc79a7", "#332288", "#ddcc77", "#882255")


def looks_of(words: Iterable[str]) -> dict[str, Look]:
    """Looks of words in the order of the table; those that are not in it have further colours."""
    found = {*words}
    looks = {word: look for word, look in LOOKS.items() if word in found}
    for word, colour in zip(sorted(found - {*LOOKS}), cycle(FURTHER_COLOURS), strict=False):
        looks[word] = Look(word.replace("_", " "), colour)
    return looks
