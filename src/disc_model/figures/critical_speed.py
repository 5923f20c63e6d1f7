"""Charts over speed and preload: onset and end of separation, loss of stability of the cycle, sweeps and ramps."""

from collections.abc import Iterable, Mapping, Sequence
from itertools import chain, pairwise
from typing import Any, ClassVar, Literal

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from pydantic import Field

from disc_model.data.variables import flag_names, stated_in
from disc_model.figures import drawing, maps
from disc_model.figures.drawing import BLACK, BLUE, COLUMN, ORANGE, PAGE, PAPER, SEPARATED, Artist, Axes, Figure, panels
from disc_model.figures.kind import CURVES, CYCLE, Plot, Role, Roles
from disc_model.figures.maps import LOAD, OUTCOME_LOOKS, SPEED, crossings, curves_of, draw_curves, patches
from disc_model.units import Finite

Array = NDArray[np.float64]

ONSET, END = SEPARATED, BLUE  # speeds at which separation begins, and at which it ends
STABLE = OUTCOME_LOOKS["quiet"]._replace(label="stable stick-slip cycle\n(white: none)")
CONTACT = OUTCOME_LOOKS["growing"]._replace(label="oscillations grow, or another\ncycle is reached, in contact")
EDGE: dict[str, Any] = {"markersize": 2.4, "markeredgecolor": BLACK, "markeredgewidth": 0.5, "zorder": 1.9}
ONSETS = EDGE | {"color": "white", "marker": "o"}  # seen on any area by their black edges, below the curves


class CriticalSpeed(Plot):
    """Speeds at which separation begins or ends against the preload, for several horizons."""

    quantities = ("critical_speed",)
    needs = ("N",)
    roles: ClassVar[Roles] = {
        "hysteresis": Role("hysteresis", ("N",)),
        "cycle": CYCLE,
        "curves": CURVES,
        "basins": Role("basins", ("Omega",)),
    }
    kind: Literal["critical_speed"] = "critical_speed"
    paper_points: dict[str, tuple[Finite, Finite]] = Field({})

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw (a) where separation begins from the static start, over a map, and (b) sweeps of the speed."""
        lost = drawing.failed(study).values
        sweep, cycle = overlays.get("hysteresis"), overlays.get("cycle")
        speeds, loads = study["scan_Omega"].values, study["N"].values
        if cycle is not None:
            # separation is unknown beyond the scan
            cycle = cycle.sel(Omega=slice(speeds.min(), speeds.max())).transpose("N", "Omega", ...)
            cycle = cycle if min(cycle["growth_rate"].shape) > 1 else None
        if cycle is not None:
            speeds = cycle["Omega"].values
        figure, axes = panels(*((COLUMN, 3.8, 1, 1) if sweep is None else (PAGE, 3.8, 1, 2)), sharex=True, sharey=True)
        axes[0].set_xlim(speeds.min(), speeds.max())
        axes[0].set_ylim(0.95 * loads.min(), 1.02 * loads.max())
        drawing.mark_failed(axes[0], loads[lost], on="y")
        study = study.isel(N=~lost).sortby("N")
        handles: list[Artist] = [] if cycle is None else _behind(axes[0], cycle)
        if "curves" in overlays:
            curves = curves_of(overlays["curves"])
            if cycle is not None:
                curves = maps.parted(curves, cycle)[0]
            if cycle is not None and "outcome" in cycle:  # what passes no cell with separation has no name
                apart = cycle["outcome"].copy(data=flag_names(cycle["outcome"]) == "separation")
                curves = [x if maps.passes(x, apart).any() else x._replace(label="") for x in curves]
            handles += draw_curves(axes[0], curves)
        horizon = float(study["horizon"].max())
        _onsets(axes[0], study, horizon, label=f"separation begins, within {horizon:g} s", **ONSETS)
        if self.paper_points:
            load, speed = np.transpose([*self.paper_points.values()])
            axes[0].plot(speed, load, "*", c=PAPER, ms=9, mec=BLACK, mew=0.6, zorder=5, clip_on=False, label="paper")
        titles = ["from the static start"]
        if sweep is not None:
            _onsets(axes[1], study, horizon, label="_nolegend_", **ONSETS)
            titles.append(_beside(axes[1], sweep, cycle, overlays.get("basins")))
        drawing.letters(axes, titles, pad=12)
        for ax in axes:
            ax.set_xlabel(SPEED)
            handles += ax.get_legend_handles_labels()[0]
        axes[0].set_ylabel(LOAD)
        figure.legend(handles=handles, loc="outside lower center", ncols=3 if len(axes) > 1 else 1, columnspacing=1.0)
        return figure


def speeds_of(study: xr.Dataset, horizon: float, kind: str = "begins") -> list[Array]:
    """Rising speeds, rad/s, at which separation begins (or the scan begins with it), or ends, for each load."""
    of_horizon = study.sel(horizon=horizon).transpose("N", ..., "crossing_number")
    speeds = np.where(flag_names(of_horizon["crossing_kind"]) == kind, of_horizon["crossing"].values, np.nan)
    rows = np.column_stack([of_horizon["critical_speed"].where(kind == "begins"), speeds])
    return [np.unique(row[np.isfinite(row)]) for row in rows]


def branches(speeds: Sequence[Array], ends: Sequence[Iterable[float]]) -> list[tuple[int, float, float]]:
    """Nearest crossings at neighbouring loads, if no end is between: index of the lower load, speed there, and next."""
    links = []
    for i, (current, ahead) in enumerate(pairwise(speeds)):
        if current.size and ahead.size:
            apart = np.abs(current[:, None] - ahead[None, :])
            # speeds are rounded, so that two may be as near
            nearest = np.isclose(apart, apart.min(0), rtol=1e-9) & np.isclose(apart, apart.min(1)[:, None], rtol=1e-9)
            pairs = [(float(current[j]), float(ahead[k])) for j, k in np.argwhere(nearest)]
            links += [(i, a, b) for a, b in pairs if not any((end - a) * (end - b) < 0 for end in ends[i + (a > b)])]
    return links


def _onsets(ax: Axes, study: xr.Dataset, horizon: float, **look: Any) -> None:
    """Draw onsets of separation, joined along their branches."""
    loads, speeds, ends = study["N"].values, speeds_of(study, horizon), speeds_of(study, horizon, "ends")
    # a greater change with the load, in rad/s per N, leads to another range of speeds
    links = [(i, a, b) for i, a, b in branches(speeds, ends) if abs(a - b) < 0.2 * (loads[i + 1] - loads[i])]
    gap = (np.nan, np.nan)
    points = [point for i, a, b in links for point in ((a, loads[i]), (b, loads[i + 1]), gap)]
    points += [at for load, row in zip(loads, speeds, strict=True) for speed in row for at in ((speed, load), gap)]
    ax.plot(*np.reshape(points, (-1, 2)).T, path_effects=drawing.halo(1.3, BLACK), **look)


def _behind(ax: Axes, cycle: xr.Dataset) -> list[Artist]:
    """Draw outcomes of the static start, or at least where the cycle is stable; returns entries of a legend."""
    words, looks = np.where(cycle["growth_rate"].values < 0, "quiet", ""), {"quiet": STABLE}
    if "outcome" in cycle:
        words = flag_names(cycle["outcome"])
        words = np.where(words == "other_cycle", "growing", words)
        horizon = stated_in(cycle, "options")["horizon"]
        apart = OUTCOME_LOOKS["separation"]._replace(label=f"separation within {horizon:g} s")
        looks = OUTCOME_LOOKS | {"growing": CONTACT, "separation": apart}
    maps.fill(ax, maps.edges_of(cycle["growth_rate"]), words, looks)
    return patches(looks, words)


def _beside(ax: Axes, sweep: xr.Dataset, cycle: xr.Dataset | None, basins: xr.Dataset | None) -> str:
    """Draw sweeps of the speed, and shade where some motions stay quiet and others separate; returns a title."""
    N, lost = sweep["N"].values, drawing.failed(sweep).values
    look: dict[str, Any] = {"markersize": 4, "markerfacecolor": "none", "linestyle": "", "clip_on": False}
    onset, end = (np.where(lost, np.nan, sweep[name].values) for name in ("onset_speed", "offset_speed"))
    ax.plot(onset, N, color=ONSET, marker="^", label="sweep up: separation begins", **look)
    ax.plot(end, N, color=END, marker="v", label="sweep down: separation ends", **look)
    drawing.mark_failed(ax, N[lost], on="y")
    if basins is not None:
        # by the starts: both fractions exceed zero with their intervals; a single speed is a line
        load, speeds = stated_in(basins, "base")["N"], basins["Omega"].values
        quiet, apart = basins["basin_fraction_low"].sel(attractor_class="quiet"), basins["separating_fraction_low"]
        # its height is well within a step of the sweeps, N
        bar: dict[str, Any] = {"height": 20.0, "color": ORANGE, "alpha": 0.6, "linewidth": 0.8, "edgecolor": ORANGE}
        for i, (first, after) in enumerate(drawing.stretches(((quiet > 0) & (apart > 0)).values)):
            label = "_nolegend_" if i else f"quiet or separating,\ncomputed at {load:g} N"
            width = speeds[after - 1] - speeds[first]
            ax.barh(load, width, left=speeds[first], label=label, **bar)
    elif cycle is not None:
        # by the multipliers, as short dwells only delay a sweep up; without loads between whose neighbours of the sweep
        # one never separates
        speeds, loads = cycle["Omega"].values, cycle["N"].values
        lowest = np.interp(loads, N, sweep["offset_speed"].values, left=np.nan, right=np.nan)
        within = (speeds >= lowest[:, None]) & (speeds <= float(sweep["sweep_Omega"].max()))
        stable = (cycle["growth_rate"].values < 0) & within
        cmap, shown = drawing.mpl.colors.ListedColormap([ORANGE]), np.ma.masked_where(~stable, stable)
        ax.pcolormesh(speeds, loads, shown, cmap=cmap, alpha=0.25, shading="nearest", rasterized=True)
        label = "the cycle is stable where the\nsweep down still separates"
        ax.fill_between([], [], [], color=ORANGE, alpha=0.25, label=label)
    return f"sweeps in steps of {float(np.diff(sweep['sweep_Omega'].values[:2])[0]):g} rad/s"


class RampedSpeeds(Plot):
    """Where separation begins on the way up and ends on the way down, against the rate of the speed's ramps."""

    quantities = ("ramps",)
    roles: ClassVar[Roles] = {"curves": CURVES}
    kind: Literal["ramps"] = "ramps"

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw one point; by ``curves``, the highest end of the cycle below all onsets, their limit for slow ramps."""
        study = study.squeeze()
        options, load = stated_in(study, "options"), float(stated_in(study, "base")["N"])
        rates, onset, end = (study[name].values for name in ("rate", "onset_speed", "offset_speed"))
        gone = study["rate_status"].values != 0
        figure, [ax] = panels(COLUMN, 3.4)
        ax.plot(rates, onset, "^-", color=ONSET, markersize=4, linewidth=0.8, label="onset, rising ramp")
        ax.plot(rates, end, "v-", color=END, markersize=4, linewidth=0.8, label="end, falling ramp")
        if (late := rates[np.isnan(onset) & ~gone]).size:
            look: dict[str, Any] = {"color": ONSET, "markersize": 4, "markerfacecolor": "white", "clip_on": False}
            ax.plot(late, np.full(late.size, options["high"]), "^", label="none up to the highest speed", **look)
        if "curves" in overlays:
            folds = [crossings(curve, load) for curve in curves_of(overlays["curves"]) if curve.kind == "fold"]
            if below := [speed for speed in chain(*folds) if speed <= np.fmin.reduce(onset)]:
                ax.axhline(max(below), **drawing.BORDERS["fold"], zorder=0)
                drawing.say_beside(ax, max(below), f"{max(below):.2f}", fontsize=6, color=drawing.GREY)
        drawing.mark_failed(ax, rates[gone])
        ax.set_xscale("log")
        ax.margins(x=0.04)
        ax.set(xlabel="Ramp rate (rad/s²)", ylabel=SPEED, ylim=(options["low"], options["high"]))
        figure.legend(loc="outside lower center", ncols=1)
        return figure
