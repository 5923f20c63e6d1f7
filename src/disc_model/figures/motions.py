"""Figures of motions over a parameter: what they come to, from where, and after how long they
repeat."""

from typing import Annotated

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from xarray import DataArray, Dataset

from disc_model.data.dataset import Missing
from disc_model.data.variables import stated_in
from disc_model.figures.draw import (
    NOTE,
    PAGE,
    UPPER,
    each_value,
    lines,
    mark_missing,
    mark_points,
    panels,
    rate_axis,
    shares,
    strip,
    threshold,
)
from disc_model.figures.looks import BLACK, BLUE, GREY, LOOKS, OF_PHASE, ORANGE, RED, Options
from disc_model.figures.schema import NOTHING, Role, grid_figure
from disc_model.figures.shown import label, placed
from disc_model.figures.stability import stable_between, thicken
from disc_model.units import Finite, Unit

Named = Annotated[dict[str, Finite], Unit(of="x")]
"""Values of x by names."""


def _places(along: DataArray, values: dict[str, float]) -> dict[str, float]:
    """Named values in the unit of an axis."""
    return {name: placed(along, value) for name, value in values.items()}


# ---- Bifurcation diagrams

EVENTS = {"stick": "at release of stick", "separation": "at loss of contact"}
"""Names of events by the phases there."""
MARKS = {"stick": "s", "slip": "o", "separation": "^"}
"""Marks of phases, whose colours are alike in grey print."""
MOST_HOLLOW = 12  # number of samples of a motion that has not settled: more marks would merge
ERRORS = 4  # half length of bars of exponents, in standard errors


@grid_figure("bifurcation")
def bifurcation(
    study: Dataset,
    x: str,
    paper_cases: Named = NOTHING,
    lyapunov: Annotated[Dataset | None, Role("lyapunov_exponents")] = None,
) -> Figure:
    """Samples of motions over a parameter, their classes and periods, and exponents.

    paper_cases : values of x by the paper's names of cases
    """
    heights = (2.4, 1.0, 1.4)[: 2 if lyapunov is None else 3]
    layout = [[i] for i, _ in enumerate(heights)]
    figure, axes = panels(layout, PAGE, 1.7, sharex=True, height_ratios=heights)
    above, below, *others = axes.values()
    _samples(above, study, x)
    events = study["period_events"].where(study["period_events"] > 0)
    lines(below, events, x, missing="not shown to repeat", color=BLACK, ls="", ms=1.5)
    below.set(yscale="log", ylabel="Events in a period")
    below.label_outer()
    if lyapunov is not None:
        _exponents(others[0], lyapunov, x)
    threshold(above, _places(study[x], paper_cases), [below, *others])
    return figure


def _samples(ax: Axes, study: Dataset, x: str) -> None:
    """Samples by phase, hollow where motions have not settled, below the classes of motion."""
    options = stated_in(study, "options")
    psi = study["psi"].transpose(x, ...)
    late = study["settled"] != "settled"
    few = late & (study["sample"] <= MOST_HOLLOW)
    doubt = f"hollow: not settled in {options['max_transient']:g} s"
    for phase, marker in MARKS.items():
        look: Options = {"color": OF_PHASE[phase], "mfc": OF_PHASE[phase], "ms": 2.0, "mew": 0}
        here = psi.where(study["phase"] == phase)
        mark_points(
            ax, study[x], here.where(~late), EVENTS.get(phase, phase), marker=marker, **look
        )
        mark_points(ax, study[x], here.where(few), doubt, color=GREY, marker=marker, mew=0.5)
    ax.margins(y=0.12)  # room for the classes
    strip(ax, study["kind"], (0, 0.93, 1, 0.07))
    ax.set_ylabel(label(psi))


def _exponents(ax: Axes, lyapunov: Dataset, x: str) -> None:
    """Exponents with their errors; points of different motions are not joined, so none are."""
    numbers = lyapunov["exponent_number"]
    numbers.attrs["names"] = {f"{i}": f"exponent {i + 1}" for i in range(numbers.size)}
    ax.set_prop_cycle(color=[BLACK, BLUE, ORANGE, GREY])
    moving = lyapunov["converged"] != "yes"
    lines(ax, lyapunov["exponent"], x, doubtful=moving, doubt="not converged", ls="")
    bars = f"± {ERRORS} standard errors"
    for _, one in each_value(lyapunov, "exponent_number"):
        errors = ERRORS * one["exponent_error"]
        ax.errorbar(one[x], one["exponent"], errors, fmt="none", ecolor=GREY, label=bars)
    rate_axis(ax)


# ---- Branches

REST = 1e-3  # range up to which the axis is linear, mm


@grid_figure("branches")
def branches(study: Dataset, paper_cases: dict[str, Finite] = NOTHING) -> Figure:
    """Ranges of cycles along branches, and of sweeps that stay at each value until the motion
    settles.

    paper_cases : values of the parameter by the paper's names of cases
    """
    figure, axes = panels([["a"]], PAGE, 3.2)
    ax = axes["a"]
    along = study["sweep_value"]
    _branch(ax, along, 0 * along, study["sliding_growth_rate"], "steady sliding", GREY)
    for i in range(int(study["n_branches"])):
        branch = study.isel(branch=i).dropna("branch_point", subset=["value"])
        drawn = branch["value"], branch["range"], branch["growth_rate"]
        if branch["separations"] > 0:
            _branch(ax, *drawn, "separating cycle", RED)
        else:
            _branch(ax, *drawn, "cycle in contact", BLACK)
    _sweep(ax, study.sel(direction="up"), "simulated, rising", "^")
    _sweep(ax, study.sel(direction="down"), "simulated, falling", "v")
    ax.set_yscale("symlog", linthresh=REST, linscale=0.4)
    ax.set(
        xlim=along.values[[0, -1]],
        ylim=(-REST, None),
        xlabel=label(along),
        ylabel=label(study["range"]),
    )
    threshold(ax, _places(along, paper_cases))
    return figure


def _branch(ax: Axes, x: DataArray, y: DataArray, rate: DataArray, name: str, colour: str) -> None:
    """A branch of motions, thick where it is stable.

    rate : growth rate of disturbances, 0 where stability changes
    """
    ax.plot(x, y, color=colour, label=f"{name}: unstable")
    thicken(ax, x, y, stable_between(rate.values), f"{name}: stable", color=colour)


def _sweep(ax: Axes, sweep: Dataset, name: str, marker: str) -> None:
    """Marks of a sweep, filled where motions have not settled."""
    apart = sweep["sweep_separation_rate"] > 0
    late = sweep["sweep_settled"] != "settled"
    for text, here, colour, face in (
        (name, ~apart, BLACK, "white"),
        ("simulated, separating", apart, RED, "white"),
        ("filled: not settled", late, GREY, GREY),
    ):
        mark_points(
            ax,
            sweep["sweep_value"],
            sweep["sweep_range"].where(here),
            text,
            marker=marker,
            color=colour,
            mfc=face,
            ms=2.5,
            mew=0.5,
            clip_on=False,
        )


# ---- Basins of attraction

STACKED = [
    "separating",
    "stick_slip",
    "other_cycle",
    "quasi_periodic",
    "irregular",
    "steady_sliding",
    "at_rest",
    "undecided",
    "failed",
]
"""Classes from below: those that separate begin at zero, as their intervals do."""
LARGEST = 36.0  # area of the mark of an attractor that all starts reach, square points


@grid_figure("basins")
def basins(study: Dataset, x: str) -> Figure:
    """Outcomes of random starts of each energy, attractors, and the critical energy of separation over
    a parameter."""
    study["energy"].attrs["long_name"] = "Energy"
    options = stated_in(study, "options")
    parts = each_value(study, "energy")
    names = [f"{i // 2}" for i in range(2 * len(parts))]
    below = ["attractors"] * len(parts) + ["critical"] * len(parts)
    figure, axes = panels([names, below], PAGE, 2.2)
    interval = "95 % interval: separating"
    for i, (title, part) in enumerate(parts):
        axes[f"{i}"].set_title(title)
        _shares(axes[f"{i}"], part, x, interval)
    within = f"within {options['horizon']:g}\u00a0s"
    axes["0"].set_ylabel(f"Share of {study.sizes['start']} starts, {within}")
    _attractors(axes["attractors"], study, x)
    _critical(axes["critical"], study, x)
    return figure


def _shares(ax: Axes, part: Dataset, x: str, interval: str) -> None:
    """Stacked shares of what starts come to, with the interval of those that separate."""
    kinds = DataArray(STACKED, dims="word", coords={"word": STACKED})
    shares(ax, part[x], (part["kind"] == kinds).mean("start"), "word")
    separating = part.sel(attractor_class="separating")
    low = separating["basin_fraction_by_energy_low"]
    high = separating["basin_fraction_by_energy_high"]
    ax.vlines(part[x], low, high, color=BLACK, lw=1.2, label=interval)


def _attractors(ax: Axes, study: Dataset, x: str) -> None:
    """Attractors by range, with areas as their shares of all starts; diamonds for classes with a
    pattern."""
    starts = study["attractor_starts"]
    at = study[x].broadcast_like(starts)
    ax.set_yscale("log")
    for word in STACKED:
        look = LOOKS[word]
        ax.scatter(
            at,
            study["attractor_range"].where(study["attractor_kind"] == word),
            LARGEST * starts / (study["kind"].size / study[x].size),
            color=look.face,
            marker="D" if look.hatch else "o",
            ec=BLACK,
            lw=0.4,
        )
    ax.set(xlabel=label(study[x]), ylabel=label(study["attractor_range"]))


def _critical(ax: Axes, study: Dataset, x: str) -> None:
    """The least energy that leads to separation, sampled and by bisection, from zero on."""
    lines(
        ax,
        study["critical_energy"],
        x,
        missing="no start is known to separate: larger than any",
        edge=UPPER,
        label="least energy, by bisection",
        color=RED,
        marker="v",
    )
    mark_points(
        ax,
        study[x],
        study["critical_energy_sampled"],
        "least energy of the starts",
        color=BLACK,
        marker="_",
        ms=6,
    )
    ax.set_yscale("symlog", linthresh=1e-3 * float(study["energy"].max()))


# ---- Locking

Zooms = Annotated[tuple[tuple[Finite, Finite], ...], Unit(of="x")]
SAME_HEIGHT = 1e-6  # change of asinh(10 height) up to which a step goes on
APART = 0.04  # least distance of numbers of releases over the width of a panel


@grid_figure("locking")
def staircase(
    study: Dataset,
    x: str,
    zooms: Zooms = (),
    paper_cases: Named = NOTHING,
    fine: Annotated[Dataset | None, Role("locking")] = None,
    slipping: Annotated[Dataset | None, Role("locking")] = None,
) -> Figure:
    """Separations per release of stick, a step for each period, with its number of releases.

    zooms : ends of parts of the axis that are shown enlarged, each within the one before
    paper_cases : values of x by the paper's names of cases
    """
    figure, axes = panels([[i] for i in range(1 + len(zooms))], PAGE, 1.9)
    whole, *zoomed = axes.values()
    parts = [part for part in (study, fine) if part is not None]
    data = xr.concat(parts, x, combine_attrs="override").sortby(x)
    _steps(whole, data, x)
    if slipping is not None:
        places = slipping[x][(slipping["motion"] == "without_stick").values]
        mark_missing(whole, places, "a motion that never sticks exists beside", BLUE, "D", 1.0)
    cases = {}
    for name, value in _places(study[x], paper_cases).items():
        releases = study["period_releases"].sel({x: value}, method="nearest").item()
        cases[f"{name}: {releases} releases"] = value
    threshold(whole, cases, zoomed)
    for before, ax, ends in zip(axes.values(), zoomed, zooms, strict=False):
        low, high = (placed(study[x], end) for end in ends)
        _steps(ax, data.sel({x: slice(low, high)}), x)
        ax.set_xlim(low, high)
        before.axvspan(low, high, color="0.9", zorder=-1)
    return figure


def _steps(ax: Axes, data: Dataset, x: str) -> None:
    """Steps of separations per release, and their numbers of releases, the longest first."""
    along = data[x].values
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
    ax.locator_params(axis="x", nbins=5)
    releases = data["period_releases"].values
    steps = np.split(np.arange(releases.size), np.flatnonzero(np.diff(releases)) + 1)
    taken = [np.inf]
    for step in sorted(steps, key=len, reverse=True):
        at = along[step[[0, -1]]].mean()
        if releases[step[0]] and np.abs(np.subtract(taken, at)).min() > APART * np.ptp(along):
            taken.append(at)
            place = at, heights[step[0]]
            ax.annotate(f"{releases[step[0]]}", place, (0, 3), ha="center", **NOTE)


@grid_figure("locking")
def phase_map(study: Dataset) -> Figure:
    """The phase of a release of stick against that of the one before: of releases for which the
    slider was held once, and near those of the motion itself."""
    figure, axes = panels([["whole", "near"]], PAGE, 3.0)
    whole, near = axes.values()
    own = study["release_phase"].dropna("release").values
    if not own.size:
        raise Missing("has no release of stick")
    period = study["period_releases"].item()
    said = "motion itself" + f": repeats after {period} releases" * bool(period)
    mark_points(near, own[:-1], own[1:], said, color=BLUE, marker="o", mfc="none")
    near.margins(0.25)
    whole.indicate_inset(near.viewLim.bounds, edgecolor=BLUE, linewidth=0.8)
    near.autoscale(False)
    pieces = study.dropna("probe", subset=["map_separations"]).groupby("map_separations")
    for i, (number, piece) in enumerate(pieces):
        at = piece["map_phase"]
        after = piece["map_next_phase"]
        for ax in axes.values():
            ax.plot(at, after, ".", color=(BLACK, RED)[i % 2], ms=2, label="slider held once")
        text = f"{number:g} separations,\nslope {piece['map_slope'].mean():.2f}"
        near.annotate(text, (at[0], after[0]), (4, -2), va="top", **NOTE)
    for ax in axes.values():
        ax.axline((1, 1), slope=1, color=GREY, zorder=0)
        ax.set(xlabel="Phase of a release", ylabel="Phase of the next one")
    return figure
