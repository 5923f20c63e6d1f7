"""Lyapunov exponents below bifurcation diagrams, joined along one motion."""

from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.variables import axis_of, flag_names
from disc_model.figures.drawing import BLACK, BLUE, BROWN, GREY, mark, mark_failed, open_line, wide
from disc_model.figures.legends import legend_above
from disc_model.figures.selection import failed, opened
from disc_model.figures.types import Array, Axes, Mask

EXPONENTS = (BLACK, BLUE, BROWN, GREY)
"""Colours of exponents, the largest first; none is the colour of a phase."""
ERRORS = 4  # half-width of the band about an exponent, in standard errors
ANOTHER = 0.05  # 1/s, step of an exponent beyond which another motion begins
SAME_PLACE = 1e-6  # of a step of the parameter, within which points of two studies are one
LONE_BAND = 3.0  # points, width of the band about a point that is joined to none


def draw_exponents(ax: Axes, lyapunov: xr.Dataset, study: xr.Dataset, name: str) -> None:
    """Draw the largest exponents with their errors, joined along one motion; rings of their colours
    where they have not converged."""
    lyapunov = lyapunov.transpose("exponent_number", name, ...)
    known = ~failed(lyapunov)
    exponent = lyapunov["exponent"].where(known).values
    error = lyapunov["exponent_error"].where(known).values
    moving = flag_names(lyapunov["converged"])[: len(EXPONENTS)] == "no"
    factor = axis_of(name)[1]
    along = lyapunov[name].values * factor
    changes = motion_changes(study, study[name].values * factor, along)
    changes |= (np.abs(np.diff(exponent, axis=1)) > ANOTHER).any(axis=0)
    alone = np.concatenate([[True], changes]) & np.concatenate([changes, [True]])

    ax.axhline(0, color=GREY, linewidth=wide(0.8))
    ring: dict[str, Any] = {
        "markerfacecolor": "none",
        "markersize": mark(4),
        "markeredgewidth": wide(0.6),
    }
    for i, colour in zip(range(len(exponent)), EXPONENTS, strict=False):
        label = f"exponent {i + 1}" if i else "largest exponent"
        x, y = opened(along, exponent[i], changes)
        ax.plot(x, y, ".-", color=colour, markersize=mark(3), linewidth=wide(0.8), label=label)
        band = ERRORS * np.interp(x, along, error[i])
        ax.fill_between(x, y - band, y + band, color=colour, alpha=0.15, linewidth=0)
        # a band of one point has no width
        low, high = exponent[i] + ERRORS * np.array([[-1], [1]]) * error[i]
        bar: dict[str, Any] = {"color": colour, "alpha": 0.15, "linewidth": wide(LONE_BAND)}
        ax.vlines(along[alone], low[alone], high[alone], **bar)
        late = moving[i]
        ax.plot(along[late], exponent[i][late], "o", label="_nolegend_", color=colour, **ring)
    # samples for the legend
    errors = f"± {ERRORS} standard errors"
    ax.fill_between([], [], [], color=GREY, alpha=0.3, linewidth=0, label=errors)
    if moving.any():
        ax.plot([], [], "o", label="not converged", color=GREY, **ring)
    if changes.any():
        ax.add_line(open_line("line open: another motion", BLACK, wide(0.8)))
    mark_failed(ax, along[np.isnan(exponent[0])])
    ax.set_ylabel("Lyapunov\nexponents,\nwithout the\ntrivial one (1/s)")
    legend_above(ax)


def motion_changes(study: xr.Dataset, along: Array, places: Array) -> Mask:
    """Whether the motion has another class or another number of events between each of some places
    and the next one, (n - 1,).

    along : (m,), ascending, the points of the study
    places : (n,), ascending
    """
    kind = flag_names(study["kind"])
    events = study["period_events"].values
    changed = (kind[1:] != kind[:-1]) | (events[1:] != events[:-1])
    so_far = np.concatenate([[0], np.cumsum(changed)])
    # a place between two points may have the motion of either
    position = np.interp(places, along, np.arange(along.size))
    before = np.floor(position + SAME_PLACE).astype(int)
    after = np.ceil(position - SAME_PLACE).astype(int)
    return so_far[after[1:]] > so_far[before[:-1]]
