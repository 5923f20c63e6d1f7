"""Poincaré sections of slider and disc, in the colours of the stages of a run."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from disc_model.data import dataset
from disc_model.figures.canvas import Wishes, page_for
from disc_model.figures.case_lines import Lines, Style
from disc_model.figures.drawing import BLACK, GREY, PAGE, SEPARATED, SKY, sample
from disc_model.figures.named_axes import Quantities
from disc_model.figures.overlay import Case, draw_case, name_of_case
from disc_model.figures.runs import sampled, show_thickness
from disc_model.figures.stages import ON_THE_WAY, SECTIONS, STAGES, stages_of
from disc_model.figures.stated_case import size_of, stated, told_apart
from disc_model.figures.still_motions import ends_shown
from disc_model.figures.types import Array, Artist, Axes, Mask

HOLLOW = {"s": 8, "linewidths": 0.5}
LOOKS: dict[str, dict[str, Any]] = {
    "early": {"marker": "x", "color": SKY, "s": 9, "linewidths": 0.5},
    ON_THE_WAY["later"]: {"marker": "o", "facecolors": "none", "edgecolors": GREY, **HOLLOW},
    ON_THE_WAY["separated"]: {
        "marker": "^",
        "facecolors": "none",
        "edgecolors": SEPARATED,
        **HOLLOW,
    },
    "later": {"marker": "o", "color": BLACK, "s": 3.5, "linewidths": 0},
    "separated": {"marker": "^", "color": SEPARATED, "s": 8, "linewidths": 0},
}
"""Marks by stage, told apart by shape or filling as well as by colour, in the order in which they are
drawn."""


SMALL = 0.2  # share of both common axes below which a section has axes of its own
BESIDE_LETTER = 0.09  # share of the axes' width
STACKED = 2.3  # inch, height of each of two sections below each other
MANY = 2000  # points from which marks are drawn as pixels


def plot_poincare(
    case: xr.DataTree,
    name: str = "poincare",
    *,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | bool | None = None,
) -> np.ndarray:
    """Draw the sections of a run in a window on two axes, which are returned."""
    called, labels = name_of_case(labels)
    wishes = Wishes(ax, legend, labels, title)
    with page_for(wishes, PAGE, 2.9, 1, 2, title=stated(case), stacked=STACKED) as page:
        samples = dataset.group(case, name)
        page.show(*_quantities(samples))
        fate = stages_of(case, samples).fate
        apart = told_apart(case, called, window=f"window {name}")
        overlaid = Case("sections", apart, stated(case), (fate,))
        panels = [_points(case, samples, of) for of in SECTIONS]
        draw_case(
            page, overlaid, panels, lambda: page.explain(draw_sections(page.axes, case, samples))
        )
    return np.array(page.axes)


def _points(case: xr.DataTree, samples: xr.Dataset, name: str) -> Lines:
    """How a section is drawn beside others: in marks of one kind, whatever the stage."""
    x = _axis(case, name, samples, ())
    y = _axis(case, f"{name}_velocity", samples, ())

    def draw(ax: Axes, style: Style) -> Artist:
        look = style.marks(2.5)
        many = x.values.size > MANY
        ax.plot(x.values, y.values, rasterized=many, markeredgewidth=0.5, **look)
        ax.set_xlabel(x.label)
        ax.set_ylabel(y.label)
        return sample(**style.marks(4))

    return Lines(draw, ((x.low, x.high), (y.low, y.high)))


def _quantities(samples: xr.Dataset) -> list[Quantities]:
    """What the two panels of sections show."""
    names = [(name, f"{name}_velocity") for name in SECTIONS]
    return [Quantities(*(sampled(each, samples)[0] for each in pair)) for pair in names]


# ---- Drawing


class Axis(NamedTuple):
    """One axis of a section: its label, the values of the points in its unit, and its ends."""

    label: str
    values: Array
    low: float
    high: float

    @property
    def share(self) -> float:
        """Part of the axis that the points take."""
        return float(np.ptp(self.values) / (self.high - self.low))


def draw_sections(
    axes: Sequence[Axes],
    case: xr.DataTree,
    samples: xr.Dataset,
    compared: Sequence[xr.Dataset] = (),
    heading: str = "",
) -> list[Artist]:
    """Draw velocity over displacement, and what the motion does after a heading.

    All sections have common axes, but one that is small on them has its own, which its title says.
    Returns entries of a legend.
    """
    found = stages_of(case, samples)
    for ax, name in zip(axes, SECTIONS, strict=True):
        x = _axis(case, name, samples, compared)
        y = _axis(case, f"{name}_velocity", samples, compared)
        if x.share > 0 and max(x.share, y.share) < SMALL:
            own_x = _axis(case, name, samples, ())
            own_y = _axis(case, f"{name}_velocity", samples, ())
            factor = own_x.share / x.share
            if factor > 1:
                note = f"enlarged {factor:.0f} times"
                ax.text(BESIDE_LETTER, 1.03, note, transform=ax.transAxes, color=GREY)
                x = own_x
                y = own_y
        ax.set_xlabel(x.label)
        ax.set_ylabel(y.label)
        ax.set_xlim((x.low, x.high))
        ax.set_ylim((y.low, y.high))
        _draw_points(ax, x, y, found.masks)
    show_thickness(axes[1], case, "x")
    axes[0].set_title(heading_of(heading, found.fate), loc="right")

    handles: list[Artist] = []
    for stage, name in zip(STAGES, found.names, strict=True):
        if found.masks[stage].any():
            look = dict(LOOKS[stage])
            look["s"] = 14
            handles.append(axes[1].scatter([], [], label=name, **look))
    if np.isfinite(found.final_since):
        look = {**LOOKS[ON_THE_WAY["later"]], "s": 14}
        name = f"hollow: up to {found.final_since:.0f} s"
        handles.append(axes[1].scatter([], [], label=name, **look))
    return handles


def heading_of(heading: str, fate: str) -> str:
    """A heading and what the motion does, once if the heading says so."""
    if fate in heading.lower():
        return heading
    return ", ".join(filter(None, [heading, fate]))


def _axis(
    case: xr.DataTree, variable: str, samples: xr.Dataset, compared: Sequence[xr.Dataset]
) -> Axis:
    """The axis of a variable, which shows the points of all sections that are compared."""
    label, factor, _ = sampled(variable, samples)
    every = np.concatenate([section[variable] for section in (samples, *compared)]) * factor
    low, high = ends_shown(every, size_of(variable, case) * factor)
    room = 0.05 * (high - low) or 1e-6 * max(abs(high), 1e-6)  # for the marks
    return Axis(label, samples[variable].values * factor, low - room, high + room)


def _draw_points(ax: Axes, x: Axis, y: Axis, masks: Mapping[str, Mask]) -> None:
    for order, (stage, look) in enumerate(LOOKS.items()):
        if stage not in masks:
            continue
        mask = masks[stage]
        above = 2 + 0.1 * order
        many = bool(mask.sum() > MANY)
        ax.scatter(x.values[mask], y.values[mask], zorder=above, rasterized=many, **look)
