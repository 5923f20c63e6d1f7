"""Figures of motions over a parameter: what they come to, from where, and after how long they
repeat."""

from typing import Annotated, Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from pydantic import Field

from disc_model.data.dataset import Missing
from disc_model.data.variables import stated_in
from disc_model.figures.draw import (
    PAGE,
    each_value,
    lines,
    mark_points,
    panels,
    shares,
    strip,
    threshold,
)
from disc_model.figures.looks import BLACK, BLUE, GREY, LOOKS, OF_PHASE, ORANGE, RED
from disc_model.figures.schema import Role, grid_figure
from disc_model.figures.shown import label, placed, value_text
from disc_model.units import Finite, Unit

Named = Annotated[dict[str, Finite] | None, Unit(of="x")]
"""Values of x by names."""


# ---- Bifurcation diagrams

MARKS: dict[str, dict[str, Any]] = {
    "stick": {"marker": "4", "ms": 4.0, "mew": 0.6},
    "slip": {"marker": ".", "ms": 1.5},
    "separation": {"marker": "^", "ms": 2.2, "mew": 0},
}
"""Marks of phases, whose colours are alike in grey print."""
RINGS = {"stick": "o", "slip": "s", "separation": "^"}
MOST_RINGS = 12  # number of samples of a motion that has not settled: more rings would merge
EVENTS = {"stick": "at release of stick", "separation": "at loss of contact"}
"""Names of events by the phases there."""
CLASSES = 0.07  # share of the panel of samples for classes of motion
ERRORS = 4  # half length of bars of exponents, in standard errors


@grid_figure("bifurcation")
def bifurcation(
    study: xr.Dataset,
    x: str,
    paper_cases: Named = None,
    lyapunov: Annotated[xr.Dataset | None, Role("lyapunov")] = None,
) -> Figure:
    """Samples of motions over a parameter, their classes and periods, and exponents.

    paper_cases : values of x by the paper's names of cases
    """
    heights = {"samples": 2.4, "period": 1.0, "exponents": 1.4}
    if lyapunov is None:
        del heights["exponents"]
    ratios = [*heights.values()]
    figure, axes = panels([[n] for n in heights], PAGE, 1.7, sharex=True, height_ratios=ratios)
    _samples(axes["samples"], study, x)
    events = study["period_events"]
    lines(
        axes["period"],
        events.where(events > 0),
        x,
        missing="not shown to repeat",
        color=BLACK,
        marker="o",
        ls="",
        ms=1.5,
    )
    axes["period"].set(yscale="log", ylabel="Events in a period", ylim=(0.7, None), xlabel="")
    if lyapunov is not None:
        _exponents(axes["exponents"], lyapunov, x)
    first, *others = axes.values()
    others[-1].set_xlabel(label(study[x]))
    threshold(first, _places(study[x], paper_cases), others)
    return figure


def _places(along: xr.DataArray, values: dict[str, float] | None) -> dict[str, float]:
    """Named values in the unit of an axis."""
    return {name: placed(along, value) for name, value in (values or {}).items()}


def _samples(ax: Axes, study: xr.Dataset, x: str) -> None:
    """Samples by phase, hollow where motions have not settled, below the classes of motion."""
    options = stated_in(study, "options")
    names = EVENTS
    said = ""
    if options["section"] != "event":
        names = {}
        said = ", once per turn of the drive"
    doubt = f"hollow: not settled in {options['max_transient']:g} s"
    samples = study[["psi", "phase", "settled"]].stack(point=[x, "sample"])
    settled = samples["settled"] == "settled"
    first = samples["sample"] <= MOST_RINGS
    for word, look in MARKS.items():
        heights = samples["psi"].where(samples["phase"] == word)
        colour = OF_PHASE[word]
        named = {"name": names.get(word, word), "color": colour, "mfc": colour}
        mark_points(ax, samples[x], heights.where(settled), **named, **look)
        late = heights.where(~settled & first)
        mark_points(ax, samples[x], late, doubt, marker=RINGS[word], color=GREY, mew=0.5)
    low, high = ax.get_ylim()
    ax.set_ylim(low, high + 1.5 * CLASSES * (high - low))
    strip(ax, study["kind"], 1 - CLASSES)
    study["psi"].attrs["long_name"] += said
    ax.set_ylabel(label(study["psi"]))


def _exponents(ax: Axes, lyapunov: xr.Dataset, x: str) -> None:
    """Exponents with their errors; points of different motions are not joined, so none are."""
    numbers = lyapunov["exponent_number"]
    numbers.attrs["names"] = {f"{i}": f"exponent {i + 1}" for i in numbers.values}
    ax.set_prop_cycle(color=[BLACK, BLUE, ORANGE, GREY])
    moving = lyapunov["converged"] != "yes"
    exponents = lyapunov["exponent"]
    lines(ax, exponents, x, doubtful=moving, doubt="not converged", ls="", ms=2.5)
    bars = f"± {ERRORS} standard errors"
    for number in numbers:
        one = lyapunov.sel(exponent_number=number)
        errors = ERRORS * one["exponent_error"]
        ax.errorbar(one[x], one["exponent"], errors, fmt="none", ecolor=GREY, label=bars)
    ax.axhline(0, color=GREY, lw=0.5, zorder=0)


# ---- Branches

REST = 1e-3  # range up to which the axis is linear, mm
NOISE = 1e-4  # range that counts as none in a sweep, mm
JUMP = 10.0  # ratio of ranges from which a sweep jumps


@grid_figure("branches")
def branches(study: xr.Dataset, paper_cases: dict[str, Finite] | None = None) -> Figure:
    """Ranges of cycles along branches, and of sweeps that stay at each value until the motion
    settles.

    paper_cases : values of the parameter by the paper's names of cases
    """
    figure, axes = panels([["a"]], PAGE, 3.2)
    ax = axes["a"]
    along = study["sweep_value"]
    branch_line(ax, along, 0 * along, study["sliding_growth_rate"], GREY, "steady sliding")
    for i in range(int(study["n_branches"])):
        branch = study.isel(branch=i).dropna("branch_point", subset=["value"])
        drawn = branch["value"], branch["range"], branch["growth_rate"]
        if branch["separations"] > 0:
            branch_line(ax, *drawn, RED, "separating cycle")
        else:
            branch_line(ax, *drawn, BLACK, "cycle in contact")
    _sweep(ax, study.sel(direction="up"), "^", "simulated, rising")
    _sweep(
        ax,
        study.sel(direction="down").isel(sweep_value=slice(None, None, -1)),
        "v",
        "simulated, falling",
    )
    if ax.texts:
        ax.plot([], [], color=GREY, ls="", marker=r"$\rightarrow$", ms=8, label="jump")
    ax.set_yscale("symlog", linthresh=REST, linscale=0.4, subs=range(2, 10))
    ax.set(
        xlim=along.values[[0, -1]],
        ylim=(-REST, None),
        xlabel=label(along),
        ylabel=label(study["range"]),
    )
    threshold(ax, _places(along, paper_cases))
    return figure


def branch_line(
    ax: Axes, x: xr.DataArray, y: xr.DataArray, rate: xr.DataArray, colour: str, name: str
) -> None:
    """A branch of motions, thick where it is stable.

    rate : growth rate of disturbances, 0 where stability changes
    """
    points = np.column_stack([x, y])
    parts = np.stack([points[:-1], points[1:]], axis=1)
    stable = stable_between(rate.values)
    for text, kept, width in (("unstable", ~stable, 0.7), ("stable", stable, 2.0)):
        if kept.any():
            line = LineCollection(
                parts[kept], colors=colour, lw=width, capstyle="round", label=f"{name}: {text}"
            )
            ax.add_collection(line)


def stable_between(rate: Any) -> Any:
    """Whether a branch is stable between each point and the next one, shape (n - 1,), from growth
    rates, which are 0 where stability changes."""
    stable = np.maximum(rate[:-1], rate[1:]) <= 0
    for i in np.flatnonzero((rate[:-1] == 0) & (rate[1:] == 0)):
        stable[i] = i > 0 and not stable[i - 1]
    return stable


def _sweep(ax: Axes, sweep: xr.Dataset, marker: str, name: str) -> None:
    """Marks of a sweep in its order, filled where motions have not settled, and arrows where it
    jumps."""
    x = sweep["sweep_value"].values
    heights = sweep["sweep_range"]
    apart = sweep["sweep_separation_rate"] > 0
    late = sweep["sweep_settled"] != "settled"
    for text, here, colour, face in (
        (name, ~apart, BLACK, "white"),
        ("simulated, separating", apart, RED, "white"),
        ("filled: not settled", late, GREY, GREY),
    ):
        mark_points(
            ax,
            x,
            heights.where(here),
            text,
            marker=marker,
            color=colour,
            mfc=face,
            ms=2.5,
            mew=0.5,
            clip_on=False,
        )
    ratio = np.diff(np.log(heights.clip(NOISE)))
    for i in np.flatnonzero(np.abs(ratio) > np.log(JUMP)):
        arrow = {"arrowstyle": "->", "color": GREY, "lw": 1.0}
        ax.annotate("", (x[i + 1], heights[i + 1]), (x[i], heights[i]), arrowprops=arrow)


# ---- Basins of attraction

ENERGY = "energy"
LOST = "undecided_lost"
STACKED = (
    "separating stick_slip other_cycle quasi_periodic irregular steady_sliding at_rest "
    f"undecided {LOST} failed"
).split()
"""Classes from below: those that separate begin at zero, as their intervals do."""
LARGEST = 36.0  # area of the mark of an attractor that all starts reach, square points


@grid_figure("basins", inner=[ENERGY])
def basins(study: xr.Dataset, x: str, by: str = "") -> Figure:
    """Outcomes of random starts, attractors, and the critical energy of separation over a parameter;
    or the outcomes over the energy.

    x : the parameter, or "energy"
    by : over the energy, the parameter with a panel for each value
    """
    study[ENERGY].attrs["long_name"] = "Energy"
    over_energy = x == ENERGY
    across = by if over_energy else ENERGY
    parts = each_value(study, across)
    names = [str(i) for i in range(len(parts))]
    rows = [np.repeat(names, 2).tolist()]
    if not over_energy:
        rows.append(["attractors"] * len(parts) + ["critical"] * len(parts))
    figure, axes = panels(rows, PAGE, 2.2, sharex=True)
    for name, (_, part) in zip(names, parts, strict=True):
        if across:
            axes[name].set_title(value_text(part[across]))
        _shares(axes[name], part, x)
    if not over_energy:
        _attractors(axes["attractors"], study, x)
        _critical(axes["critical"], study, x)
    for ax in axes.values():
        ax.tick_params(labelbottom=True)
    for name in names[1:]:
        axes[name].set(ylabel="", yticklabels=[])
    return figure


def _shares(ax: Axes, part: xr.Dataset, x: str) -> None:
    """Stacked shares of what starts come to, with the interval of those that separate; energies at
    equal distances, since one may be 0."""
    along = part[x]
    if x == ENERGY:
        along = along.copy(data=np.arange(along.size))
    lost = (part["kind"] == "undecided") & (part["lost_contact"] == "yes")
    kind = part["kind"].where(~lost, LOST)
    found = [word for word in STACKED if (kind == word).any()]
    each = [(kind == word).mean("start") for word in found]
    shares(ax, along, xr.concat(each, pd.Index(found, name="word")).T, "word")
    if x == ENERGY:
        ax.set_xticks(along, [f"{energy:g}" for energy in part[x].values])
    options = stated_in(part, "options")
    separating = part.sel(attractor_class="separating")
    low, high = (separating[f"basin_fraction_by_energy_{end}"] for end in ("low", "high"))
    name = f"{100 * options['confidence']:g} % interval: separating"
    around = [withStroke(linewidth=2.5, foreground="white")]
    ax.vlines(along, low, high, color=BLACK, lw=0.9, path_effects=around, label=name)
    ax.set_ylabel(f"Share of {part.sizes['start']} starts, within {options['horizon']:g}\u00a0s")


def _attractors(ax: Axes, study: xr.Dataset, x: str) -> None:
    """Attractors by range, with areas as their shares of all starts; diamonds for classes with a
    pattern."""
    starts = study["attractor_starts"]
    areas = LARGEST * starts / (study["kind"].size / study.sizes[x])
    at = study[x].broadcast_like(areas)
    ax.set_yscale("log")
    for word in STACKED:
        ranges = study["attractor_range"].where(study["attractor_kind"] == word)
        look = LOOKS[word]
        shape = "D" if look.hatch else "o"
        ax.scatter(at, ranges, areas, color=look.face, marker=shape, ec=BLACK, lw=0.4)
    ax.set_title("attractors; area: share of starts")
    ax.set(xlabel=label(study[x]), ylabel=label(study["attractor_range"]))


def _critical(ax: Axes, study: xr.Dataset, x: str) -> None:
    """The least energy that leads to separation, sampled and by bisection, from zero on."""
    lines(
        ax,
        study["critical_energy"],
        x,
        missing="no start is known to separate",
        label="least energy, by bisection",
        color=RED,
        marker="v",
    )
    sampled = study["critical_energy_sampled"]
    ax.plot(study[x], sampled, "_", color=BLACK, ms=6, label="least energy of the starts")
    energies = study[ENERGY]
    ax.set_yscale("symlog", linthresh=float(energies.where(energies > 0).min()) / 10)
    ax.set_title("critical energy of separation")
    ax.set_ylabel(label(study[ENERGY]))


# ---- Locking

Zooms = Annotated[tuple[tuple[Finite, Finite], ...], Field(max_length=3), Unit(of="x")]
SAME_HEIGHT = 1e-6  # change of asinh(10 height) up to which a step goes on
APART = 0.04  # least distance of numbers of releases over the width of the page


@grid_figure("locking")
def staircase(
    study: xr.Dataset,
    x: str,
    zooms: Zooms = (),
    fine: Annotated[xr.Dataset | None, Role("locking")] = None,
    slipping: Annotated[xr.Dataset | None, Role("locking")] = None,
) -> Figure:
    """Separations per release of stick, a step for each period, with its number of releases.

    zooms : ends of parts of the axis that are shown enlarged, each within the one before
    """
    names = [f"zoom {i}" for i in range(len(zooms))]
    rows = [["whole"] * max(1, len(names)), names]
    figure, axes = panels([row for row in rows if row], PAGE, 2.4)
    before, *zoomed = axes.values()
    parts = [part for part in (study, fine) if part is not None]
    data = xr.concat(parts, x, combine_attrs="override").sortby(x)
    _steps(before, data, x, APART)
    if slipping is not None:
        places = slipping[x].where(slipping["motion"] == "without_stick")
        before.plot(
            places,
            0 * places + 1,
            "D",
            color=BLUE,
            transform=before.get_xaxis_transform(),
            clip_on=False,
            label="a motion that never sticks exists beside",
        )
    for ax, ends in zip(zoomed, zooms, strict=True):
        low, high = (placed(study[x], end) for end in ends)
        _steps(ax, data.sel({x: slice(low, high)}), x, APART * len(names))
        ax.set_xlim(low, high)
        before.axvspan(low, high, color="0.9", zorder=0)
        before = ax
    return figure


def _steps(ax: Axes, data: xr.Dataset, x: str, apart: float) -> None:
    """Steps of separations per release, and their numbers of releases, the widest first.

    apart : least distance of numbers, share of the panel
    """
    heights = data["separations_per_release"]
    lines(
        ax,
        heights,
        x,
        doubtful=data["motion"] == "undecided",
        doubt="not shown to repeat",
        missing="",
        jump=SAME_HEIGHT,
        label="numbers: releases in a period",
        color=BLACK,
        marker="o",
        ms=2.2,
        mew=0,
        lw=1.4,
    )
    ax.margins(y=0.15)
    ax.xaxis.set_major_formatter("{x:.6g}")
    ax.locator_params(axis="x", nbins=5)
    at = data[x].values
    releases = data["period_releases"].values
    begins = np.flatnonzero(np.diff(releases, prepend=0))
    middles = (at[begins] + at[np.append(begins[1:], at.size) - 1]) / 2
    taken: list[float] = []
    for i in np.argsort(at[begins] - middles, kind="stable"):
        middle = middles[i]
        number = releases[begins[i]]
        if number and all(abs(middle - other) > apart * np.ptp(at) for other in taken):
            taken.append(middle)
            place = (middle, heights[begins[i]])
            ax.annotate(number, place, (0, 3), textcoords="offset points", ha="center", fontsize=7)


@grid_figure("locking")
def phase_map(study: xr.Dataset) -> Figure:
    """The phase of a release of stick against that of the one before: of releases for which the
    slider was held once, and near those of the motion itself."""
    figure, axes = panels([["whole", "near"]], PAGE, 3.0)
    whole, near = axes.values()
    own = study["release_phase"].dropna("release").values
    if not own.size or study["map_phase"].isnull().all():
        raise Missing("has no release of stick")
    margin = 0.15 * np.ptp(own)
    low = own.min() - margin
    high = own.max() + margin
    for i, (number, part) in enumerate(study.groupby("map_separations")):
        at = part["map_phase"].values
        after = part["map_next_phase"].values
        for ax in (whole, near):
            ax.plot(at, after, ".", color=(BLACK, RED)[i % 2], ms=2, label="slider held once")
        inside = np.flatnonzero((low < np.minimum(at, after)) & (np.maximum(at, after) < high))
        if inside.size > 2:
            slope = part["map_slope"].values[inside].mean()
            text = f"{number:g} separations,\nslope {slope:.2f}"
            place = (at[inside[-1]], after[inside[-1]])
            near.annotate(text, place, (6, 0), textcoords="offset points", va="center")
    for ax, start, end in ((whole, float(study["map_phase"].min()), 1.0), (near, low, high)):
        ax.axline((0, 0), slope=1, color=GREY, lw=0.6, zorder=0)
        ax.set(
            xlim=(start, end),
            ylim=(start, end),
            aspect="equal",
            xlabel="Phase of a release",
            ylabel="Phase of the next one",
        )
    window = (low, low, high - low, high - low)
    whole.indicate_inset(window, edgecolor=BLUE, linewidth=0.8)
    period = study["period_releases"].item()
    said = "motion itself"
    if period:
        said += f": repeats after {period} releases"
    mark_points(near, own[:-1], own[1:], said, color=BLUE, marker="o", mfc="none")
    return figure
