"""The common style: widths, colours, and saving without time stamps."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Any, ParamSpec

import matplotlib as mpl
from matplotlib.figure import Figure

from disc_model.figures import STYLE

P = ParamSpec("P")
COLUMN = 89 / 25.4
"""Width of one column, inch."""
PAGE = 183 / 25.4
"""Width of both columns, inch."""

BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, BLACK = (
    "#0072B2",
    "#D55E00",
    "#009E73",
    "#CC79A7",
    "#E69F00",
    "#56B4E9",
    "#000000",
)
GREY, BROWN = "#8a8a8a", "#7A4B12"

# One colour a quantity in the whole set; what is lost with contact is always vermilion.
DISC, SLIDER, FORCE = BLUE, ORANGE, "#4d4d4d"
"""Motion of the disc; of the slider, normal to the disc (u) and in its plane (psi); contact force."""
STICK, SLIP, SEPARATED = GREEN, PURPLE, VERMILION
PHASE_COLOURS = {"stick": STICK, "slip": SLIP, "separation": SEPARATED}
BEFORE, AFTER = SKY, BLACK
"""Stages of a run: in contact before and after the first separation."""


def styled(draw: Callable[P, Figure]) -> Callable[P, Figure]:
    """Let a function draw in the common style, whatever the user's settings are."""

    @wraps(draw)
    def wrapped(*args: P.args, **kwargs: P.kwargs) -> Figure:
        with mpl.rc_context():
            mpl.rcdefaults()
            mpl.style.use(STYLE)
            return draw(*args, **kwargs)

    return wrapped


def new_figure(width: float, height: float) -> Figure:
    """An empty figure of a size in inch, outside of pyplot's state."""
    return Figure(figsize=(width, height), layout="constrained")


def save(figure: Figure, path: str | Path, title: str = "") -> None:
    """Write a figure in the format of the path's suffix, its title within; equal figures give equal bytes."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    metadata: dict[str, Any] = {"CreationDate": None} if path.suffix == ".pdf" else {"Software": None}
    if title:
        metadata["Title"] = title
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.style.use(STYLE)
        figure.savefig(path, metadata=metadata)
