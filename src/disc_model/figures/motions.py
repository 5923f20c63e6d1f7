"""Motions against one parameter: bifurcation and continuation diagrams, ramps of the speed, and basins."""

from collections.abc import Mapping
from itertools import chain
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.legend_handler import HandlerTuple
from matplotlib.lines import Line2D

from disc_model.data.variables import flag_names, stated_in
from disc_model.figures import drawing
from disc_model.figures.cells import OUTCOME_LOOKS, Look, patches
from disc_model.figures.drawing import BLACK, GREY, PAGE, PHASE_COLOURS, SEPARATED, panels
from disc_model.figures.growth_map import crossings, curves_of
from disc_model.figures.kinds import BasinShares, Bifurcation, Branches, RampedSpeeds

# ----------------------------------------------------------------------------------------------------
# Bifurcation diagrams, with the largest Lyapunov exponents below

DOT: dict[str, Any] = {"marker": ".", "markersize": 1.5}
MARKS: dict[str, dict[str, Any]] = {"stick": {"marker": "x", "markersize": 2.0, "markeredgewidth": 0.4}}
"""Looks of samples, and those other than dots by phase: in grey print, green and vermilion are alike."""
EXPONENTS = (BLACK, drawing.BLUE, drawing.BROWN, GREY)
"""Colours of the exponents, the largest first; none is that of a phase."""
ERRORS = 4
"""Half-width of the band about an exponent, in standard errors."""


def draw_bifurcation(study: xr.Dataset, overlays: Mapping[str, xr.Dataset], plot: Bifurcation) -> Figure:
    """Draw samples against a parameter, coloured by phase, grey where it is not shown that the motion has settled.

    A cross marks a failed point or a missing largest exponent, a dash a motion without samples, such as one without
    events.  Periods are below, and the further study ``lyapunov``, if it is given.
    """
    study = study.transpose(plot.x, "sample", ...)
    events = {"stick": "at release of stick", "separation": "at loss of contact"}
    names = events if stated_in(study, "options")["section"] == "event" else {}
    heights = [2.4, 0.9, *[1.4] * ("lyapunov" in overlays)]  # inch
    figure, axes = panels(PAGE, sum(heights) + 0.7, len(heights), sharex=True, height_ratios=heights)
    ax = axes[0]
    xlabel, factor = drawing.axis_of(plot.x)
    ylabel, scale = drawing.axis_of(plot.variable)
    if plot.variable == "psi":  # some hundredths of a radian
        ylabel, scale = ylabel.replace("rad", "mrad"), 1e3
    along, values = study[plot.x].values * factor, study[plot.variable].values * scale
    position = np.broadcast_to(along[:, None], values.shape)
    lost = drawing.failed(study).values
    phase = np.where(lost[:, None], -1, study["phase"].values.astype(int) - 1)
    settled = (flag_names(study["settled"]) == "settled")[:, None]
    dots = [("not settled, or undecided", ~settled & (phase >= 0), DOT | {"color": GREY, "alpha": 0.5})]
    for code, (name, color) in enumerate(PHASE_COLOURS.items()):
        dots.append((names.get(name, name), settled & (phase == code), DOT | {"color": color} | MARKS.get(name, {})))
    for label, there, look in dots:
        if there.any():
            ax.plot(position[there], values[there], linestyle="", label=label, **look)
    drawing.mark_failed(ax, along[lost])
    moving = (phase >= 0).any(axis=1)
    slides = flag_names(study["kind"]) == "steady_sliding"
    at_edge: dict[str, Any] = {"color": GREY, "markersize": 4, "transform": ax.get_xaxis_transform()}
    for label, marker, here in (("steady sliding", "_", slides), ("no event while sampled", "|", ~slides)):
        if (idle := along[here & ~moving & ~lost]).size:
            ax.plot(idle, np.full(idle.size, 0.02), marker, label=label, **at_edge)
    axes[-1].set_xlabel(xlabel)
    ax.set_ylabel(ylabel)
    _period(axes[1], along[moving], study["period_events"].values[moving])
    if "lyapunov" in overlays:
        _exponents(axes[2], overlays["lyapunov"], plot.x)
    drawing.letters(axes)
    for one in axes:
        one.margins(x=0.01)  # no dot is cut at the edge
    drawing.mark_cases(axes, {case: value * factor for case, value in plot.paper_cases.items()})
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


# ----------------------------------------------------------------------------------------------------
# Continuation diagrams: the range of motion on all cycles, and where a sweep jumps

LOWEST = 1e-3
"""Least range that is distinguished from rest, mm."""
THIN = 0.7
"""Width of lines of unstable motions; dashes of two branches that nearly meet would look like a whole line."""
MARK: dict[str, Any] = {"markersize": 2.5, "markerfacecolor": "white", "markeredgewidth": 0.5}
"""Look of the marks of a sweep."""
UNSETTLED = "#aaaaaa"
"""Colour of its marks where it is not shown that the motion has settled."""


def draw_branches(study: xr.Dataset, overlays: Mapping[str, xr.Dataset], plot: Branches) -> Figure:
    """Draw one point: a line for each branch, thick where it is stable, and triangles for the sweep up and down."""
    study = study.squeeze()
    name = str(stated_in(study, "options")["parameter"])
    label, factor = drawing.axis_of(name)
    figure, [ax] = panels(PAGE, 3.6)
    ax.set_yscale("log")
    for i in range(int(study["n_branches"])):
        one = study.isel(branch=i)
        _branch(ax, one["value"].values * factor, 1e3 * one["range"].values, one["growth_rate"].values < 0,
                SEPARATED if one["separations"] > 0 else BLACK)  # fmt: skip
    along = study["sweep_value"].values * factor
    for way, mark in enumerate("^v"):
        settled = flag_names(study["sweep_settled"])[way] == "settled"
        _swept(
            ax, along, 1e3 * study["sweep_range"].values[way],
            study["sweep_separation_rate"].values[way] > 0, settled, mark,
        )  # fmt: skip
    unstable = study["sliding_growth_rate"].values > 0
    phrase = "unstable" if unstable.all() else "stable" if not unstable.any() else "stable where the line is thick"
    _branch(ax, along, np.full(along.size, LOWEST), ~unstable, GREY)
    drawing.say(ax, f"steady sliding: {phrase}", (along[-1], LOWEST), (-4, 3), fontsize=7, color=GREY)
    drawing.mark_cases([ax], {case: value * factor for case, value in plot.paper_cases.items()}, 0.05)
    ax.set(
        xlabel=label, ylabel="Range of the slider's height (mm)", xlim=(along[0], along[-1]), ylim=(LOWEST * 0.8, None)
    )
    for color, text in ((BLACK, "in contact"), (SEPARATED, "separating")):
        ax.plot([], [], color=color, linewidth=2, label=f"stable cycle, {text}")
    ax.plot([], [], color=BLACK, linewidth=THIN, label="unstable cycle")
    handles, labels = ax.get_legend_handles_labels()
    (rising, falling), both, pale = (
        [Line2D([], [], linestyle="", marker=way, color=color, **MARK) for way in "^v"]
        for color in (BLACK, SEPARATED, UNSETTLED)
    )
    simulated: dict[str, Any] = {"rising": rising, "falling": falling, "separating": tuple(both)}
    if (flag_names(study["sweep_settled"]) != "settled").any():
        simulated["not settled, or undecided"] = tuple(pale)
    handles += simulated.values()
    labels += [f"simulated, {text}" for text in simulated]
    figure.legend(handles, labels, loc="outside lower center", ncols=3, handler_map={tuple: HandlerTuple(None)})
    return figure


def _branch(ax: Axes, x: np.ndarray, y: np.ndarray, stable: np.ndarray, color: str) -> None:
    there = np.isfinite(x)
    x, y, stable = x[there], y[there], stable[there]
    # over larger factors the branch may bend
    along, height = drawing.broken(x, np.log(y), np.log(2.5))
    ax.plot(along, np.exp(height), color=color, linewidth=THIN)
    # a segment is stable where both its ends are
    for first, last in drawing.stretches(stable[:-1] & stable[1:]):
        ax.plot(x[first : last + 1], y[first : last + 1], color=color, linewidth=2.0, solid_capstyle="butt")


def _swept(ax: Axes, x: np.ndarray, y: np.ndarray, separates: np.ndarray, settled: np.ndarray, mark: str) -> None:
    """Draw the marks of a sweep, and an arrow at each jump, by a factor of more than 10."""
    shown = np.maximum(y, LOWEST)
    for there, color in ((settled & ~separates, BLACK), (settled & separates, SEPARATED), (~settled, UNSETTLED)):
        ax.plot(x[there], shown[there], mark, color=color, clip_on=False, **MARK)
    order = slice(None) if mark == "^" else slice(None, None, -1)
    x, y = x[order], shown[order]
    for i in np.flatnonzero(np.abs(np.log(y[1:] / y[:-1])) > np.log(10)):
        ax.annotate("", (x[i + 1], y[i + 1]), (x[i], y[i]), arrowprops={"arrowstyle": "->", "color": GREY, "lw": 1.0})


# ----------------------------------------------------------------------------------------------------
# Onset of separation on the way up and its end on the way down, against the ramp rate of the speed


def draw_ramps(study: xr.Dataset, overlays: Mapping[str, xr.Dataset], plot: RampedSpeeds) -> Figure:
    """Draw one point; with the further study ``curves``, also the speed at which the cycle ends at this load.

    This is the limit of the onset for slow ramps: the highest such speed below all onsets. Other ends belong to other
    cycles.
    """
    study = study.squeeze()
    options, load = stated_in(study, "options"), float(stated_in(study, "base")["N"])
    rates, onset, end = (study[name].values for name in ("rate", "onset_speed", "offset_speed"))
    gone = study["rate_status"].values != 0
    figure, [ax] = panels(drawing.COLUMN, 3.4)
    ax.plot(rates, onset, "^-", color=drawing.ONSET, markersize=4, linewidth=0.8, label="onset, rising ramp")
    ax.plot(rates, end, "v-", color=drawing.END, markersize=4, linewidth=0.8, label="end, falling ramp")
    late = rates[np.isnan(onset) & ~gone]
    if late.size:
        look: dict[str, Any] = {"color": drawing.ONSET, "markersize": 4, "markerfacecolor": "white", "clip_on": False}
        ax.plot(late, np.full(late.size, options["high"]), "^", label="none up to the highest speed", **look)
    if "curves" in overlays:
        folds = [crossings(curve, load) for curve in curves_of(overlays["curves"]) if curve.kind == "fold"]
        if below := [speed for speed in chain(*folds) if speed <= np.fmin.reduce(onset)]:
            ax.axhline(max(below), **drawing.BORDERS["fold"], zorder=0)
            drawing.say_beside(ax, max(below), f"{max(below):.2f}")
    drawing.mark_failed(ax, rates[gone])
    ax.set_xscale("log")
    ax.margins(x=0.04)
    ax.set(xlabel="Ramp rate (rad/s²)", ylabel=drawing.axis_of("Omega")[0], ylim=(options["low"], options["high"]))
    figure.legend(loc="outside lower center", ncols=1)
    return figure


# ----------------------------------------------------------------------------------------------------
# Basins of attraction: fractions with intervals, the attractors, and the critical energy of separation

LOOKS = {
    "quiet": OUTCOME_LOOKS["quiet"],
    "other_cycle": OUTCOME_LOOKS["other_cycle"],
    "separating": OUTCOME_LOOKS["separation"]._replace(label="separating"),
    "quasi_periodic": Look("quasi-periodic", "#b5dcf2", 4 * "\\"),
    "irregular": Look("irregular", drawing.BROWN, 4 * "/"),
    **{name: OUTCOME_LOOKS[name] for name in ("steady_sliding", "at_rest", "undecided", "failed")},
}
"""Looks of the outcomes, as in maps; a hatch where another one is as dark in grey print."""
LARGEST = 36.0
"""Area of the mark of an attractor that all starts reach, square points."""


def draw_basins(study: xr.Dataset, overlays: Mapping[str, xr.Dataset], plot: BasinShares) -> Figure:
    """Draw the fractions of starts of each energy above, and the range of each attractor and the energies below. The
    size of an attractor's mark is its fraction of all starts.
    """
    study = study.transpose(plot.x, ...)
    label, factor = drawing.label_of(study[plot.x])
    along, energies = study[plot.x].values * factor, study["energy"].values
    figure = drawing.new_figure(PAGE, 4.6)
    above, below = np.asarray(figure.subfigures(2, 1))
    axes = [*above.subplots(1, len(energies), sharey=True, squeeze=False)[0], *below.subplots(1, 2)]
    classes = [class_ for class_ in LOOKS if (study["basin_fraction"].sel(attractor_class=class_) > 0).any()]
    width = 0.9 * np.diff(along).min(initial=1.0)
    for ax, energy in zip(axes, energies, strict=False):
        shares = study["basin_fraction_by_energy"].sel(energy=energy, attractor_class=classes)
        low = shares.cumsum("attractor_class") - shares.fillna(0)
        for class_ in classes:
            one = {"attractor_class": class_}
            bars = {"edgecolor": BLACK, "linewidth": 0.4, "facecolor": LOOKS[class_].face, "hatch": LOOKS[class_].hatch}
            ax.bar(along, shares.sel(one), width, low.sel(one), **bars)
        ax.set(ylim=(0, 1))
    axes[0].set_ylabel(f"Fraction of {study.sizes['start']} starts")
    _attractors(axes[-2], study, along)
    _kicks(axes[-1], study, along)
    drawing.letters(axes, [f"{energy:g} J" for energy in energies])
    for ax in axes:
        ax.margins(x=0.04)
        ax.set_xlabel(label)
        drawing.mark_failed(ax, along[drawing.failed(study).values])
    options = stated_in(study, "options")
    undecided = LOOKS["undecided"]._replace(label=f"undecided after {options['horizon']:g} s")
    handles = patches(LOOKS | {"undecided": undecided}, classes)
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
    return figure


def _attractors(ax: Axes, study: xr.Dataset, along: np.ndarray) -> None:
    kinds = flag_names(study["attractor_kind"].transpose(..., "attractor"))
    starts = study["attractor_starts"].transpose(..., "attractor").values
    ranges = 1e3 * study["attractor_range"].transpose(..., "attractor").values
    total = study.sizes["energy"] * study.sizes["start"]
    for class_, look in LOOKS.items():
        point, number = np.nonzero((kinds == class_) & (starts > 0))
        area = LARGEST * starts[point, number] / total
        ax.scatter(along[point], ranges[point, number], area, color=look.face, edgecolor=BLACK, linewidth=0.4, zorder=3)
    for part, text in ((0.1, "10 %"), (0.5, "50 %"), (1.0, "all starts")):
        ax.scatter([], [], LARGEST * part, facecolor="none", edgecolor=BLACK, linewidth=0.4, label=text)
    drawing.legend_above(ax)
    ax.set(ylabel="Slider range (mm)")
    if np.any(ranges > 0):
        ax.set_yscale("log")


def _kicks(ax: Axes, study: xr.Dataset, along: np.ndarray) -> None:
    """Draw the critical energy by bisection, the lowest separating energy of the starts, and all their energies."""
    for i, energy in enumerate(study["energy"].values):
        label = "energies sampled" if i == 0 else "_nolegend_"
        ax.axhline(energy, color=GREY, linestyle=":", linewidth=0.6, zorder=0, label=label)
    sample, found = study["critical_energy_sampled"].values, study["critical_energy"].values
    ax.plot(along, sample, "_", color=BLACK, markersize=6, label="lowest sampled")
    ax.plot(along, np.where(found > 0, found, np.nan), "v-", color=SEPARATED, markersize=3.5, label="by bisection")
    ax.set(ylabel="Critical energy (J)")
    if np.any(sample > 0):
        ax.set_yscale("log")
        # energy 0 has no place on this logarithmic scale
        for place in along[found == 0]:
            drawing.say(ax, "0", (place, 0), (0, 2), xycoords=("data", "axes fraction"), color=SEPARATED, fontsize=7)
    drawing.legend_above(ax, columnspacing=0.7, handlelength=1.0, handletextpad=0.4)
