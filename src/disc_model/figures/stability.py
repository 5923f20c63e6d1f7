"""Pictures of stability: branches, multipliers, eigenvalues, exponents, critical values and neutral
curves."""

from textwrap import fill
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle
from xarray import DataArray, Dataset

from disc_model.arrays import Array, Mask
from disc_model.data.variables import OF_RESULTS, attributes, typeset, values_text
from disc_model.figures.draw import BELOW_ANY, lines, mark_missing, mark_points, rate_axis, wished
from disc_model.figures.looks import BLACK, GREY, RED
from disc_model.figures.shown import label, placed, shown
from disc_model.parameters import Parameters

# ---- Results of one case: what their methods `plot` draw on axes. The first line has the next
# ---- colour and a reader's look; what belongs to it has its colour

THIN = 0.8  # width of lines, points
THICK = 2.4  # where they are stable
SPECIAL = {
    "fold": ("s", "fold"),
    "period_doubling": ("D", "period doubling"),
    "neimark_sacker": ("o", "Neimark-Sacker bifurcation"),
    "branch_point": ("*", "branch point"),
    "grazing": ("X", "grazing"),
    "hopf": ("^", "Hopf point"),
    "max_points": ("P", "continued no further: max_points"),
    "lost": ("p", "continued no further: no step succeeds"),
}
"""Marks and names of special points of branches."""


def case_text(case: Parameters | None, *varied: str) -> str:
    """N, Omega and what differs from the paper's case, without what varies in a picture."""
    values = {name: x for name, x in dict(case or {}).items() if name not in varied}
    return fill(values_text(values), 40)


def column(name: str, values: Any, attrs: Any = None, units: Any = None) -> DataArray:
    """Values of a number of a case, or of what has these attributes, SI units, as readers see them,
    shape (point,)."""
    held = Dataset({name: ("point", values, attrs or attributes(name))})
    return shown(held, units)[name]


def draw_branch(ax: Axes, branch: Any, y: str, units: Any, **look: Any) -> None:
    """Draw a variable of the cycles along a branch over its parameter: thick where they are stable,
    with the special points."""
    x = column(branch.name, branch.values, units=units)
    known = OF_RESULTS["Branch"][y].attributes
    up = column(y, getattr(branch, y), known, units)
    up.attrs["long_name"] = known["long_name"].capitalize()
    own = {"linewidth": THIN, "label": case_text(branch.case, branch.name)}
    [line] = ax.plot(x, up.where(np.isfinite(up)), **wished(look, **own))
    colour = line.get_color()
    stable = stable_between(branch.growth_rate)
    thicken(ax, x, up, stable, "thick: stable", color=colour)
    mark_missing(ax, x[np.isneginf(up)], BELOW_ANY, colour, marker="v")
    for kind, (marker, name) in SPECIAL.items():
        found = branch.kind == kind
        marks = {"marker": marker, "markerfacecolor": colour, "markersize": 5}
        mark_points(ax, x[found], up[found], name, color=colour, **marks)
    ax.set(xlabel=label(x), ylabel=label(up))
    if y == "growth_rate":
        rate_axis(ax)


def stable_between(growth: Array) -> Mask:
    """Whether a branch is stable between each point and the next one, shape (n - 1,), from growth
    rates at n points, which are 0 where stability changes."""
    stable = np.maximum(growth[:-1], growth[1:]) <= 0
    for i in np.flatnonzero((growth[:-1] == 0) & (growth[1:] == 0)):
        stable[i] = i > 0 and not stable[i - 1]
    return stable


def thicken(ax: Axes, x: Any, y: Any, between: Any, why: str, **look: Any) -> None:
    """Draw a line once more, thick, between some of its n points and the next ones.

    between : bool, shape (n - 1,)
    """
    if np.any(between):
        cut = np.flatnonzero(~between) + 1
        points = [np.insert(np.asarray(each, dtype=float), cut, np.nan) for each in (x, y)]
        ax.plot(*points, lw=THICK, solid_capstyle="round", label=why, **look)


def draw_multipliers(ax: Axes, cycle: Any, **look: Any) -> None:
    """Draw Floquet multipliers in the complex plane, with rings around those that grow."""
    ax.add_patch(Circle((0, 0), 1, fill=False, ec=GREY, lw=THIN))
    values = cycle.multipliers
    own = {"marker": "o", "linestyle": "", "label": case_text(cycle.parameters)}
    ax.plot(values.real, values.imag, **wished(look, **own))
    _ring(ax, values[np.abs(values) > 1])
    ax.set(xlabel="Re κ", ylabel="Im κ", aspect="equal")


def draw_eigenvalues(ax: Axes, sliding: Any, **look: Any) -> None:
    """Draw frequencies over growth rates of the modes of steady sliding, with rings around those that
    grow, and their frequencies."""
    upper = sliding.eigenvalues[sliding.eigenvalues.imag >= 0]
    grows = np.isin(upper, sliding.growing)
    places = upper.real + 1j * upper.imag / (2 * np.pi)
    ax.axvline(0, color=BLACK, lw=0.6)
    own = {"marker": "o", "linestyle": "", "label": case_text(sliding.parameters)}
    ax.plot(places.real, places.imag, **wished(look, **own))
    _ring(ax, places[grows])
    for x, y in zip(places[grows].real, places[grows].imag, strict=True):
        ax.annotate(f"{y:.0f} Hz", (x, y), (6, 3), textcoords="offset points")
    ax.set(xlabel="Growth rate (1/s)", ylabel="Frequency (Hz)")


def _ring(ax: Axes, places: Any) -> None:
    """Rings around what grows, in the complex plane."""
    look = {"marker": "o", "markersize": 9, "color": RED, "markerfacecolor": "none"}
    mark_points(ax, places.real, places.imag, "grows", **look)


def draw_exponents(ax: Axes, found: Any, **look: Any) -> None:
    """Draw Lyapunov exponents with their errors, hollow where they have not converged."""
    attributes = {"long_name": "Lyapunov exponent", "units": "1/s"}
    number = {"Number": np.arange(1, len(found.exponents) + 1)}
    values = DataArray(found.exponents, number, attrs=attributes)
    own = wished(look, linestyle="", label=case_text(found.parameters))
    unsure = values.copy(data=~found.converged)
    lines(ax, values, "Number", doubtful=unsure, doubt="not converged", **own)
    x = values["Number"]
    finite = values.where(np.isfinite(values))
    colour = ax.lines[-1].get_color()
    ax.errorbar(x, finite, found.errors, fmt="none", capsize=3, ecolor=colour)
    ax.axhline(0, color=GREY, lw=0.6, zorder=0)
    ax.locator_params("x", integer=True)


def draw_critical(ax: Axes, found: Any, **look: Any) -> None:
    """Draw the growth rate of a motion over a parameter, shaded where it is unstable."""
    data = shown(found.to_dataset())
    x = data[found.name]
    rate = data["growth_rate"]
    sliding = data["sliding_growth_rate"]
    own = wished(look, label=case_text(found.parameters, found.name), marker=".")
    lines(ax, rate, found.name, missing="", **own)
    colour = ax.lines[-1].get_color()
    if sliding.notnull().any():
        name = "steady sliding, where there is no cycle"
        ax.plot(x, sliding, "--", label=name, color=colour)
    mark_missing(ax, x[rate.isnull() & sliding.isnull()], "nothing found", colour)
    for low, high in found.unstable:
        ends = placed(x, low), placed(x, high)
        ax.axvspan(*ends, alpha=0.2, lw=0, color=colour, label="shaded: unstable")
    rate_axis(ax)
    ax.set_ylabel("Growth rate (1/s)")


def draw_curves(ax: Axes, curves: Any, **look: Any) -> None:
    """Draw neutral curves and folds with their resonances: thick beside a stable cycle, folds
    dashed."""
    [named] = ax.plot([], [], **wished(look, label=case_text(curves.parameters, *curves.bounds)))
    colour = named.get_color()
    for curve in curves:
        x, y = map(column, curves.bounds, curve.values.T)
        dashes = "-"
        name = "_nolegend_"
        if curve.kind == "fold":
            dashes = "--"
            name = "dashed: the cycle ends in a fold"
        ax.plot(x, y, color=colour, lw=THIN, ls=dashes, label=name)
        stable = curve.adjoins_stable_cycle[:-1] & curve.adjoins_stable_cycle[1:]
        thicken(ax, x, y, stable, "thick: a stable cycle adjoins", color=colour, ls=dashes)
        _name_curve(ax, x, y, typeset(curve.resonance.label))
    ax.set(xlabel=label(x), ylabel=label(y))


def _name_curve(ax: Axes, x: DataArray, y: DataArray, name: str) -> None:
    """Write a name beside the middle of a curve, unless the axes have it already."""
    if name not in [text.get_text() for text in ax.texts]:
        middle = (x[x.size // 2], y[x.size // 2])
        ax.annotate(name, middle, (4, 2), textcoords="offset points", fontsize="small")
