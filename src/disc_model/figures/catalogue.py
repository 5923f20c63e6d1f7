"""Which figures there are and what each needs. Imports nothing heavy: studies are checked against it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

STYLE = Path(__file__).with_name("disc_model.mplstyle")
"""The one style of all figures."""


class Entry(NamedTuple):
    """A figure: its caption and the windows it needs, by case."""

    caption: str
    needs: Mapping[str, tuple[str, ...]]

    @property
    def cases(self) -> tuple[str, ...]:
        return tuple(self.needs)


CATALOGUE: Mapping[str, Entry] = {
    "fig02": Entry(
        "Contact force, N = 200 N, Omega = 20 rad/s: (a) the whole run, (b) 35 ms of it, separations shaded.",
        {"F02": ("history", "zoom")},
    ),
    "fig03": Entry(
        "Disc and slider during one separation and reattachment, N = 200 N, Omega = 20 rad/s.",
        {"F02": ("zoom",)},
    ),
    "fig10": Entry(
        "Disc at r_0 and theta = 1, with contact enforced and with separation, N = 200 N, Omega = 20 rad/s.",
        {"F02": ("history",), "F04": ("history",)},
    ),
    "fig11": Entry(
        "N = 385 N, Omega = 15 rad/s: (a) contact force, (b) disc at r_0 and theta = 1.",
        {"F11": ("history",)},
    ),
    "fig13": Entry(
        "N = 385 N, Omega = 15.1 rad/s: (a) contact force, (b) disc at r_0 and theta = 1.",
        {"F13": ("history",)},
    ),
}


def module_of(name: str) -> str:
    """Module that draws a figure: its ``draw(cases)`` takes trees of `disc_model.dataset.load` by case."""
    return f"disc_model.figures.{name}"
