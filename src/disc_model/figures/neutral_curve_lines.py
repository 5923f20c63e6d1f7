"""Lines and names of neutral curves, of one case and of several on the same axes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.data.variables import typeset
from disc_model.figures.branch_lines import STABLE, THIN, Look, between, draw_branch
from disc_model.figures.canvas import Page
from disc_model.figures.case_lines import Limits, Style
from disc_model.figures.drawing import BLACK, GREY, SEPARATED, halo, large, sample, wide
from disc_model.figures.names import Names
from disc_model.figures.types import Array, Artist, Axes

if TYPE_CHECKING:
    from disc_model.stability.curves import StabilityCurve

KINDS = {"neutral": (BLACK, "cycle loses stability"), "fold": (SEPARATED, "cycle ends in a fold")}
"""Colours and names of the curves."""
DASHES: dict[str, tuple[float, ...]] = {"neutral": (), "fold": (3, 1.5)}
"""Dashes of the curves where colours tell cases apart."""
UNSTABLE_BESIDE = "thin: unstable cycles on both sides"
APART = (0.1, 0.2, 0.3, 0.4)
"""Shares of a curve from its middle at which its name may stand, too,"""
OFFSETS = ((-4, 4), (4, -4), (4, 4), (-4, -4), (8, 0), (-8, 0))
"""and offsets of the name in points."""


def draw_alone(
    page: Page, curves: Sequence[StabilityCurve], lines: Sequence[Array], limits: Limits
) -> None:
    """Draw curves in the colours of their kinds, with their resonances."""
    axes = page.ax
    axes.set_xlim(limits[0])
    axes.set_ylim(limits[1])
    for curve, line in zip(curves, lines, strict=True):
        colour, _ = KINDS[curve.kind]
        stable = between(curve.adjoins_stable_cycle)
        draw_branch(axes, line[:, 0], line[:, 1], stable, Look(colour))
    _name_curves(axes, curves, lines)

    present = {curve.kind for curve in curves}
    handles = [
        sample(color=colour, linewidth=wide(STABLE), label=text)
        for kind, (colour, text) in KINDS.items()
        if kind in present
    ]
    if not all(curve.adjoins_stable_cycle.all() for curve in curves):
        handles.append(sample(color=BLACK, linewidth=wide(THIN), label=UNSTABLE_BESIDE))
    page.explain(handles)


def draw_beside(
    curves: Sequence[StabilityCurve], lines: Sequence[Array], ax: Axes, style: Style
) -> Artist:
    """Draw curves beside those of other cases: in one colour, folds dashed; returns the entry of a
    legend."""
    colour = style.look.colour
    for curve, line in zip(curves, lines, strict=True):
        stable = between(curve.adjoins_stable_cycle)
        draw_branch(ax, line[:, 0], line[:, 1], stable, Look(colour, DASHES[curve.kind]))
    return sample(color=colour, linewidth=wide(STABLE))


def kinds_beside() -> list[Artist]:
    """Entries of a legend for the kinds of curves of several cases."""
    handles = []
    for kind, (_, text) in KINDS.items():
        look = Look(GREY, DASHES[kind])
        how = "dashed" if DASHES[kind] else "solid"
        handles.append(sample(label=f"{how}: {text}", **look.line(STABLE)))
    return [*handles, sample(color=GREY, linewidth=wide(THIN), label=UNSTABLE_BESIDE)]


def _name_curves(ax: Axes, curves: Sequence[StabilityCurve], lines: Sequence[Array]) -> None:
    """Write the resonance of each kind of curves once, beside the first that has room for it: where it
    covers no curve, and is nearer to its own than to those of other names."""
    dense = [_dense(line, np.ptp([ax.get_xlim(), ax.get_ylim()], axis=1)) for line in lines]
    names = Names(ax, lines=np.concatenate(dense))
    called = [(curve.kind, curve.resonance.label) for curve in curves]
    for name in dict.fromkeys(called):
        kind, label = name
        own = [line for line, other in zip(lines, called, strict=True) if other == name]
        points = [point for line in own for point in _places_along(ax, line)]
        if not points:
            continue
        others = [line for line, other in zip(dense, called, strict=True) if other != name]
        rivals = np.concatenate([np.empty((0, 2)), *others])
        colour, _ = KINDS[kind]
        look: dict[str, Any] = {"fontsize": large(6), "color": colour, "path_effects": halo()}
        names.add_along(typeset(label), points, OFFSETS, rivals, **look)


def _places_along(ax: Axes, line: Array) -> list[tuple[float, float]]:
    """Points of a line beside which its name may stand: about its middle within the panel."""
    low, high = np.transpose([ax.get_xlim(), ax.get_ylim()])
    inside = line[np.all((line > low) & (line < high), axis=1)]
    if not len(inside):
        return []
    shares = 0.5 + np.concatenate([[0.0], *([-apart, apart] for apart in APART)])
    return [(x, y) for x, y in inside[np.round(shares * (len(inside) - 1)).astype(int)].tolist()]


def _dense(line: Array, extent: Array) -> Array:
    """A line with points at hundredths of a panel or less, in the units of its axes."""
    steps = np.diff(line, axis=0) / extent
    lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*steps.T))])
    places = np.linspace(0.0, lengths[-1], 2 + int(100 * lengths[-1]))
    return np.column_stack([np.interp(places, lengths, column) for column in line.T])
