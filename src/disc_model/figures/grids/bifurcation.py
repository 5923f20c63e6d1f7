"""Bifurcation diagrams, with the largest Lyapunov exponent below."""

import json
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from disc_model.data.variables import flag_names, values_text
from disc_model.figures import parts
from disc_model.figures.kinds import Bifurcation
from disc_model.figures.parts import BLACK, BLUE, BROWN, GREY, PAGE, PHASE_COLOURS, new_figure

SWITCHES = {"stick": "at release of stick", "separation": "at loss of contact"}
"""Names of samples at events, by the phase that ends or begins there."""
MARKS: dict[str, dict[str, Any]] = {"stick": {"marker": "x", "markersize": 2.0, "markeredgewidth": 0.4}}
"""Looks of samples by phase, other than dots: in grey print, green and vermilion are alike."""
EXPONENTS = (BLACK, BLUE, BROWN, GREY)
"""Colours of the exponents, the largest first; none is that of a phase."""
HEIGHTS = {"samples": 2.4, "period": 0.9, "lyapunov": 1.4}
"""Heights of the panels, inch."""
ERRORS = 4
"""Half-width of the band about an exponent, in standard errors."""
JUMP = 0.05
"""Change of an exponent, 1/s, at which another motion begins and a line is broken."""


def draw(study: xr.Dataset, overlays: Mapping[str, xr.Dataset], plot: Bifurcation) -> Figure:
    """Draw samples against a parameter: stick and other phases in different colours, grey where the motion was not
    steady yet.

    A cross marks a failed point or a missing largest exponent, a dash a motion without samples, such as one without
    events.  The further study ``lyapunov``, if given, has a panel below.
    """
    study = study.transpose(plot.x, "sample", ...)
    options = json.loads(study.attrs.get("options", "{}"))
    names = SWITCHES if options.get("section") == "event" else {}
    below = ["period"] * ("period_events" in study) + ["lyapunov"] * ("lyapunov" in overlays)
    heights = [HEIGHTS[name] for name in ("samples", *below)]
    figure = new_figure(PAGE, sum(heights) + 0.7)
    axes = figure.subplots(len(heights), 1, sharex=True, squeeze=False, height_ratios=heights)[:, 0]
    ax = axes[0]
    xlabel, factor = parts.axis_of(plot.x)
    along, values = study[plot.x].values * factor, study[plot.variable].values * plot.scale
    position = np.broadcast_to(along[:, None], values.shape)
    lost = parts.failed(study).values
    phase = np.where(lost[:, None], -1, study["phase"].values.astype(int) - 1)
    unsteady = np.zeros(phase.shape, dtype=bool)
    if "stationary" in study:
        unsteady[:] = (flag_names(study["stationary"]) == "no")[:, None]
    if (there := unsteady & (phase >= 0)).any():
        ax.plot(position[there], values[there], ".", color=GREY, markersize=1.5, alpha=0.5, label="not stationary")
    for code, (name_of_phase, color) in enumerate(PHASE_COLOURS.items()):
        here = (phase == code) & ~unsteady
        if np.any(here):
            label = names.get(name_of_phase, name_of_phase)
            look = {"marker": ".", "markersize": 1.5} | MARKS.get(name_of_phase, {})
            ax.plot(position[here], values[here], linestyle="", color=color, label=label, **look)
    parts.mark_failed(ax, along[lost])
    moving = (phase >= 0).any(axis=1)
    idle = along[~moving & ~lost]
    if idle.size:
        low = np.full(idle.size, 0.02)
        ax.plot(idle, low, "|", color=GREY, markersize=4, transform=ax.get_xaxis_transform(), label="steady sliding")
    unit = study[plot.variable].attrs.get("units", "")
    prefix = {1e3: "m", 1.0: "", 1e6: "µ"}.get(plot.scale, f"{1 / plot.scale:g} ")
    axes[-1].set_xlabel(xlabel)
    ax.set_ylabel(f"{parts.axis_of(plot.variable)[0].rpartition(' (')[0]} ({prefix}{unit.replace(' s-1', '/s')})")
    for one, name in zip(axes[1:], below, strict=True):
        if name == "period":
            _period(one, along[moving], study["period_events"].values[moving])
        else:
            _exponents(one, parts.without_failed(overlays["lyapunov"], "exponent", "exponent_error"), plot.x)
    parts.letters(axes)
    for one in axes:
        one.margins(x=0.01)  # no dot is cut at the edge
        for i, (case, value) in enumerate(plot.paper_cases.items()):
            one.axvline(value * factor, color=BLACK, linewidth=0.6, linestyle=(0, (1, 2)), zorder=0)
            if one is ax:  # labels alternate: left of the first line, right of the next
                side = 2 * (-1) ** (i + 1)
                parts.say(ax, case, (value * factor, 0), (side, 2), xycoords=("data", "axes fraction"), fontsize=7)
    for handle in parts.legend_above(ax).legend_handles:  # the diagram's dots are too small for a legend
        if isinstance(handle, Line2D):
            handle.set_markersize(6)
    parts.note(figure, plot, _start(options))
    return figure


def _period(ax: Axes, along: np.ndarray, period: np.ndarray) -> None:
    """Draw the number of events after which the motion repeats; crosses at the foot where it is unknown."""
    repeats = period > 0
    ax.plot(along[repeats], period[repeats], ".", color=BLACK, markersize=3)
    ax.set(yscale="log", ylim=(0.4, None))  # room for crosses below period 1
    ax.yaxis.set_major_formatter("{x:g}")
    ax.set_ylabel("Period\n(events)")
    parts.mark_failed(ax, along[~repeats], name="not shown to repeat")
    if not repeats.all():
        parts.legend_above(ax)


def _start(options: Mapping[str, Any]) -> str:
    """Description of the start that all points share."""
    prerun = options.get("prerun")
    if not prerun:
        return "Each point from the static start; other motions may exist beside."
    text = values_text(prerun.get("parameters", {}))
    return f"Each point from the state of {text} after {prerun['time']:g} s; other motions may exist beside."


def _exponents(ax: Axes, lyapunov: xr.Dataset, name: str) -> None:
    """Draw the largest exponents with their errors; rings of their colours where they have not converged."""
    exponent = lyapunov["exponent"].transpose("exponent_number", name)
    error = lyapunov["exponent_error"].transpose("exponent_number", name)
    along = exponent[name].values * parts.axis_of(name)[1]
    ax.axhline(0, color=GREY, linewidth=0.8)
    look = {"linestyle": "", "marker": "o", "markerfacecolor": "none", "markersize": 4, "markeredgewidth": 0.6}
    ring: dict[str, Any] = {"color": GREY, **look}
    unsure = False
    for i, color in zip(range(len(exponent)), EXPONENTS, strict=False):
        label = "largest exponent" if i == 0 else f"exponent {i + 1}"
        shown = parts.broken(along, exponent[i].values, JUMP)
        ax.plot(*shown, ".-", color=color, markersize=3, linewidth=0.8, label=label)
        band = ERRORS * np.interp(shown[0], along, error[i].values)
        ax.fill_between(shown[0], shown[1] - band, shown[1] + band, color=color, alpha=0.15, linewidth=0)
        if "converged" in lyapunov:
            moving = flag_names(lyapunov["converged"].transpose("exponent_number", name)[i]) == "no"
            ax.plot(along[moving], exponent[i][moving], label="_nolegend_", **ring | {"color": color})
            unsure |= bool(moving.any())
    ax.fill_between([], [], [], color=GREY, alpha=0.3, linewidth=0, label=f"± {ERRORS} standard errors")
    if unsure:
        ax.plot([], [], label="not converged", **ring)
    parts.mark_failed(ax, along[np.isnan(exponent[0].values)])
    others = ",\nwithout the\ntrivial one" if "trivial_exponent" in lyapunov else ""
    ax.set_ylabel(f"Lyapunov\nexponents{others} (1/s)")
    parts.legend_above(ax)
