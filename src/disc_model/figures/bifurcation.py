"""Bifurcation diagrams: samples of motions against a parameter, their periods, and Lyapunov exponents."""

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from disc_model.data.variables import flag_names, stated_in
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, GREY, PAGE, PHASE_COLOURS, Axes, Figure, panels
from disc_model.figures.kind import Plot, Role, Roles
from disc_model.units import Finite, Unit

DOT: dict[str, Any] = {"marker": ".", "markersize": 1.5}
MARKS: dict[str, dict[str, Any]] = {"stick": {"marker": "x", "markersize": 2.0, "markeredgewidth": 0.4}}
"""Looks of samples, and those other than dots by phase: in grey print, green and vermilion are alike."""
EXPONENTS = (BLACK, drawing.BLUE, drawing.BROWN, GREY)
"""Colours of the exponents, the largest first; none is that of a phase."""
ERRORS = 4
"""Half-width of the band about an exponent, in standard errors."""


class Bifurcation(Plot):
    """Samples once a turn against a parameter, and after how many switches the motion repeats.

    paper_cases : cases of the paper by name, each with its value of x
    """

    quantities = ("bifurcation",)
    roles: ClassVar[Roles] = {"lyapunov": Role("lyapunov")}

    kind: Literal["bifurcation"] = "bifurcation"
    x: str
    variable: Literal["psi", "psi_velocity", "P", "u", "w_point"] = "psi"
    paper_cases: Annotated[dict[str, Finite], Unit(of="x")] = Field({})

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw samples against a parameter, coloured by phase, grey where it is not shown that the motion has settled.

        A cross marks a failed point or a missing largest exponent, a dash a motion without samples, such as one without
        events.  Periods are below, and the further study ``lyapunov``, if it is given.
        """
        from matplotlib.lines import Line2D

        study = study.transpose(self.x, "sample", ...)
        events = {"stick": "at release of stick", "separation": "at loss of contact"}
        names = events if stated_in(study, "options")["section"] == "event" else {}
        heights = [2.4, 0.9, *[1.4] * ("lyapunov" in overlays)]  # inch
        figure, axes = panels(PAGE, sum(heights) + 0.7, len(heights), sharex=True, height_ratios=heights)
        ax = axes[0]
        xlabel, factor = drawing.axis_of(self.x)
        ylabel, scale = drawing.axis_of(self.variable)
        if self.variable == "psi":  # some hundredths of a radian
            ylabel, scale = ylabel.replace("rad", "mrad"), 1e3
        along, values = study[self.x].values * factor, study[self.variable].values * scale
        position = np.broadcast_to(along[:, None], values.shape)
        lost = drawing.failed(study).values
        phase = np.where(lost[:, None], -1, study["phase"].values.astype(int) - 1)
        settled = (flag_names(study["settled"]) == "settled")[:, None]
        dots = [("not settled, or undecided", ~settled & (phase >= 0), DOT | {"color": GREY, "alpha": 0.5})]
        for code, (name, color) in enumerate(PHASE_COLOURS.items()):
            dots.append(
                (names.get(name, name), settled & (phase == code), DOT | {"color": color} | MARKS.get(name, {}))
            )
        for label, mask, look in dots:
            if mask.any():
                ax.plot(position[mask], values[mask], linestyle="", label=label, **look)
        drawing.mark_failed(ax, along[lost])
        moving = (phase >= 0).any(axis=1)
        slides = flag_names(study["kind"]) == "steady_sliding"
        at_edge: dict[str, Any] = {"color": GREY, "markersize": 4, "transform": ax.get_xaxis_transform()}
        for label, marker, mask in (("steady sliding", "_", slides), ("no event while sampled", "|", ~slides)):
            if (idle := along[mask & ~moving & ~lost]).size:
                ax.plot(idle, np.full(idle.size, 0.02), marker, label=label, **at_edge)
        axes[-1].set_xlabel(xlabel)
        ax.set_ylabel(ylabel)
        _period(axes[1], along[moving], study["period_events"].values[moving])
        if "lyapunov" in overlays:
            _exponents(axes[2], overlays["lyapunov"], self.x)
        drawing.letters(axes)
        for panel in axes:
            panel.margins(x=0.01)  # no dot is cut at the edge
        drawing.mark_cases(axes, {case: value * factor for case, value in self.paper_cases.items()})
        for handle in drawing.legend_above(ax).legend_handles:  # the diagram's dots are too small for a legend
            if isinstance(handle, Line2D):
                handle.set_markersize(6)
        return figure


def _period(ax: Axes, along: np.ndarray, period: np.ndarray) -> None:
    """Draw the number of events after which the motion repeats; crosses at the foot where it is unknown."""
    repeats = period > 0
    ax.plot(along[repeats], period[repeats], ".", color=BLACK, markersize=3)
    ax.set(yscale="log", ylim=(0.4, None), ylabel="Period\n(events)")  # room for crosses below period 1
    ax.yaxis.set_major_formatter("{x:g}")
    drawing.mark_failed(ax, along[~repeats], name="not shown to repeat")
    if not repeats.all():
        drawing.legend_above(ax)


def _exponents(ax: Axes, lyapunov: xr.Dataset, name: str) -> None:
    """Draw the largest exponents with their errors; rings of their colours where they have not converged."""
    lyapunov, known = lyapunov.transpose("exponent_number", name, ...), ~drawing.failed(lyapunov)
    exponent, error = (lyapunov[each].where(known) for each in ("exponent", "exponent_error"))
    moving = flag_names(lyapunov["converged"])[: len(EXPONENTS)] == "no"
    along = exponent[name].values * drawing.axis_of(name)[1]
    ax.axhline(0, color=GREY, linewidth=0.8)
    ring: dict[str, Any] = {"color": GREY, "markerfacecolor": "none", "markersize": 4, "markeredgewidth": 0.6}
    for i, color in zip(range(len(exponent)), EXPONENTS, strict=False):
        label = "largest exponent" if i == 0 else f"exponent {i + 1}"
        shown = drawing.broken(along, exponent[i].values, 0.05)  # 1/s, beyond which another motion begins
        ax.plot(*shown, ".-", color=color, markersize=3, linewidth=0.8, label=label)
        band = ERRORS * np.interp(shown[0], along, error[i].values)
        ax.fill_between(shown[0], shown[1] - band, shown[1] + band, color=color, alpha=0.15, linewidth=0)
        ax.plot(along[moving[i]], exponent[i][moving[i]], "o", label="_nolegend_", **ring | {"color": color})
    ax.fill_between([], [], [], color=GREY, alpha=0.3, linewidth=0, label=f"± {ERRORS} standard errors")
    if moving.any():
        ax.plot([], [], "o", label="not converged", **ring)
    drawing.mark_failed(ax, along[np.isnan(exponent[0].values)])
    ax.set_ylabel("Lyapunov\nexponents,\nwithout the\ntrivial one (1/s)")
    drawing.legend_above(ax)
