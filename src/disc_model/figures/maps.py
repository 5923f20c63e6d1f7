"""Maps: cells in flat colours, growth rates of the stick-slip cycle, neutral curves and folds,
regions of outcomes; and charts over speed and preload: onset and end of separation, sweeps and
ramps."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import fields
from itertools import chain, pairwise
from typing import Any, ClassVar, Literal, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from pydantic import Field

from disc_model.analysis.spectra import Resonance
from disc_model.data.variables import axis_of, flag_names, stated_in, typeset
from disc_model.errors import Fault
from disc_model.figures import drawing
from disc_model.figures.cells import class_cells, edges_of, entries, paint, scale_of, unresolved
from disc_model.figures.classes import LOOKS, UNRESOLVED
from disc_model.figures.drawing import (
    BLACK,
    GREY,
    ORANGE,
    PAGE,
    PAPER,
    SEPARATED,
    Artist,
    Axes,
    Figure,
    mpl,
    panels,
)
from disc_model.figures.growth import growth_panels, stability_of
from disc_model.figures.kind import CURVES, Plot, Role, Roles, Values
from disc_model.figures.legends import figure_legend
from disc_model.parameters import Parameters
from disc_model.units import Finite, Strict, Units

Array = NDArray[np.float64]

# ---- Neutral curves and folds of the cycle over speed and preload
SPEED, LOAD = axis_of("Omega")[0], axis_of("N")[0]


class Curve(NamedTuple):
    """A line on a stability chart; "neutral" or "fold", with a label such as "2 f_s = 135.42
    Hz"."""

    Omega: Array
    N: Array
    kind: str
    label: str = ""


def curves_of(data: xr.Dataset) -> list[Curve]:
    """Curves with a stable cycle beside them, from the quantity `stability_curves`; x is Omega and
    y is N."""
    kinds = flag_names(data["kind"])
    curves = []
    for i in np.flatnonzero(kinds != "none"):
        curve_data = data.isel(curve=int(i))
        border = (flag_names(curve_data["adjoins_stable_cycle"]) == "yes") & np.isfinite(
            curve_data["x"].values
        )
        x, y = (np.where(border, curve_data[name].values, np.nan) for name in ("x", "y"))
        label = ""
        # a resonance farther away, in Hz, is not named
        if kinds[i] == "fold" and abs(float(curve_data["resonance_detuning"])) < 3.0:
            values = (curve_data[f"resonance_{field.name}"].item() for field in fields(Resonance))
            label = Resonance(*values).label.replace(" - ", " − ").replace("Ω/2π", "f_Ω")
        if border.sum() > 1:
            curves.append(Curve(x, y, str(kinds[i]), label))
    return curves


def passes(curve: Curve, cells: xr.DataArray) -> NDArray[np.bool_]:
    """Whether each point of a curve lies in one of these cells over N and Omega, or in one of the
    eight around it."""
    from scipy.ndimage import binary_dilation

    points = (("N", curve.N), ("Omega", curve.Omega))
    i, j = (
        np.abs(cells[name].values - np.nan_to_num(x)[:, None]).argmin(axis=1) for name, x in points
    )
    return np.asarray(np.isfinite(curve.Omega) & binary_dilation(cells, np.ones((3, 3)))[i, j])


def parts_of(curves: Sequence[Curve], cycle: xr.Dataset) -> list[Curve]:
    """The parts of curves that bound the cycle of a map over N and Omega, without those of another
    cycle."""
    rate = cycle["growth_rate"]
    beyond = {"neutral": rate > 0, "fold": ~(rate < 0)}
    parts = []
    for curve in curves:
        bounding = passes(curve, rate < 0) & passes(curve, beyond[curve.kind])
        within = slice(bounding.argmax(), bounding.size - bounding[::-1].argmax())
        if bounding[within].mean() >= 0.5:  # cells are coarser than the curve
            bounding[within] = np.isfinite(curve.Omega)[within]
        if bounding.any():
            bounding[1:] |= bounding[:-1].copy()  # up to the point beyond
            Omega, N = (np.where(bounding, along, np.nan) for along in (curve.Omega, curve.N))
            parts.append(curve._replace(Omega=Omega, N=N))
    return parts


def crossings(curve: Curve, load: float) -> Array:
    """Speeds at which a curve crosses a load, rad/s."""
    side = curve.N - load
    indices = np.flatnonzero(side[:-1] * side[1:] <= 0)
    step = side[indices] - side[indices + 1]
    share = np.where(step == 0, 0.0, side[indices] / np.where(step == 0, 1.0, step))
    return np.unique(
        curve.Omega[indices] + share * (curve.Omega[indices + 1] - curve.Omega[indices])
    )


def draw_curves(ax: Axes, curves: Sequence[Curve]) -> list[Artist]:
    """Draw curves, with a number beyond the upper end by label and speed; returns entries of a
    legend."""
    labelled = sorted(
        (x for x in curves if x.label), key=lambda curve: float(np.nanmax(curve.Omega))
    )
    numbers = {
        label: i for i, label in enumerate(dict.fromkeys(curve.label for curve in labelled), 1)
    }
    for curve in curves:
        ax.plot(curve.Omega, curve.N, **drawing.BORDERS[curve.kind] | {"label": "_nolegend_"})
        if curve.label and np.isfinite(curve.N).any():
            i = int(np.nanargmax(curve.N))
            end = (curve.Omega[i], min(float(curve.N[i]), ax.get_ylim()[1]))
            text, beside = str(numbers[curve.label]), drawing.halo()
            drawing.say(
                ax, text, end, (0, 2), fontsize=6, annotation_clip=False, path_effects=beside
            )
    kinds = {curve.kind for curve in curves}
    handles = [drawing.sample(**drawing.BORDERS[kind]) for kind in drawing.BORDERS if kind in kinds]
    numbered = [(f"${i}$", typeset(label)) for label, i in numbers.items()]
    return handles + [
        drawing.sample(marker=mark, label=text, ls="", c=BLACK, ms=4, mew=0)
        for mark, text in numbered
    ]


# ---- Regions of outcomes, and below them the growth rates of the cycle
PAPER_MARKERS = {
    "quiet": "o",
    "growing": "^",
    "separation": "s",
}  # the marker of each outcome of the paper


class Mark(Strict):
    """A case of the paper: where it lies, and what the paper says of it."""

    x: Finite
    y: Finite
    paper_outcome: Literal["quiet", "growing", "separation"]
    assumed: bool = (
        False  # whether the paper does not state where, so that nothing is said of its start
    )


class RegionMap(Plot):
    """Regions of outcomes over two parameters, and the growth rate of the cycle below."""

    quantities = ("regions",)
    several = True
    roles: ClassVar[Roles] = {"curves": CURVES}
    kind: Literal["region_map"] = "region_map"
    x: str
    y: str
    marks: dict[str, Mark] = Field({})

    @classmethod
    def _units(cls, data: Mapping[str, Any]) -> dict[str, Units]:
        axes = {axis: Parameters.unit(str(data.get(axis))) for axis in ("x", "y")}
        marks = data.get("marks")
        return super()._units(data) | {
            "marks": dict.fromkeys(marks, axes) if isinstance(marks, dict) else ""
        }

    def place_title(self, figure: Figure, text: str) -> None:
        figure.legends[0].set_title(text)

    def faults(self, values: Values) -> Iterator[Fault]:
        yield from super().faults(values)
        for name, mark in self.marks.items():
            for axis, dim, value in (("x", self.x, mark.x), ("y", self.y, mark.y)):
                along = [x for x in values.get(dim, ()) if isinstance(x, float)]
                if along and not any(math.isclose(value, x, rel_tol=1e-12) for x in along):
                    yield Fault.of(
                        ("marks", name, axis),
                        value,
                        f"must be a value of {dim}, such as an extra one",
                    )
        if "curves" in self.overlays and (self.x, self.y) != ("Omega", "N"):
            yield Fault.of(
                ("overlays", "curves"), self.overlays["curves"], "needs x: Omega and y: N"
            )

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw two panels for each normalization; lines are those of the study ``curves``, or lie
        between cells."""
        norms = drawing.normalizations(study)
        shown = [drawing.of(study, norm).transpose(self.y, self.x, ...) for norm in norms]
        figure, axes = panels(PAGE, 5.6, 2, len(norms), sharex=True, sharey=True)
        above, below = axes[: len(norms)], axes[len(norms) :]
        # one alone stands in the figure's title
        drawing.letters(axes, [drawing.MODES[norm] for norm in norms] if len(norms) > 1 else [])
        growth = growth_panels(figure, below, shown)
        # branches are continued along the study's first dimension, which may be either axis
        upward = [name for name in study["outcome"].dims if name in (self.x, self.y)] == [
            self.y,
            self.x,
        ]
        outcomes: set[str] = set()
        lines: list[Artist] = []
        for upper, lower, plane in zip(above, below, shown, strict=True):
            outcomes |= class_cells(upper, plane["outcome"], LOOKS)
            for ax in (upper, lower):
                lines += (
                    _curves(ax, plane, overlays["curves"])
                    if "curves" in overlays
                    else _borders(ax, plane, upward)
                )
        _set_scales(axes, study, self.axes)
        named = {line.get_label(): line for line in lines}.values()
        marks = _marks(axes[0], self) if norms[0] == "as_published" else []
        handles = [*entries(outcomes, {**LOOKS, UNRESOLVED.label: UNRESOLVED}), *named, *marks]
        figure_legend(figure, handles, loc="outside upper center", columns=4, title_fontsize=8)
        said = "\n".join(_captions(study, self))
        unresolved_too = UNRESOLVED.label in outcomes  # named above
        below_said = [
            x for x in growth if not (unresolved_too and x.get_label() == UNRESOLVED.label)
        ]
        figure_legend(figure, below_said, loc="outside lower center", title=said)
        return figure


def _curves(ax: Axes, data: xr.Dataset, curves: xr.Dataset) -> list[Artist]:
    """Draw continued curves of the map's cycle, within its points."""
    paths = []
    for curve in parts_of(curves_of(drawing.of(curves, drawing.normalizations(data)[0])), data):
        along = ((curve.Omega, data["Omega"].values), (curve.N, data["N"].values))
        inside = [values == np.clip(values, points.min(), points.max()) for values, points in along]
        paths.append(curve._replace(N=np.where(np.all(inside, axis=0), curve.N, np.nan), label=""))
    return draw_curves(ax, paths)


def _borders(ax: Axes, data: xr.Dataset, upward: bool) -> list[Artist]:
    """Draw borders between resolved cells: where one cycle changes its stability, and where a
    stable one ends: the next cell has none and does not stay quiet. Upward: the study's first
    dimension is the vertical one."""
    x, y = edges_of(data["outcome"])
    state = stability_of(data)
    state[unresolved(state)] = "unresolved"
    stable, unstable = state == "stable", state == "unstable"
    gone = (flag_names(data["cycle"]) == "no_cycle") & (flag_names(data["outcome"]) != "quiet")
    names = ("branch_continues_first", "branch_continues_second")
    up, right = names if upward else names[::-1]
    segments: dict[str, list[list[tuple[float, float]]]] = {"neutral": [], "fold": []}
    for joined, ahead, current, ends in (
        (up, np.s_[1:, :], np.s_[:-1, :], lambda i, j: [(x[j], y[i + 1]), (x[j + 1], y[i + 1])]),
        (right, np.s_[:, 1:], np.s_[:, :-1], lambda i, j: [(x[j + 1], y[i]), (x[j + 1], y[i + 1])]),
    ):
        same = flag_names(data[joined])[current] == "yes"
        changes = (stable[current] & unstable[ahead]) | (unstable[current] & stable[ahead])
        stops = (stable[current] & gone[ahead]) | (gone[current] & stable[ahead])
        segments["neutral"] += [ends(i, j) for i, j in np.argwhere(changes & same)]
        segments["fold"] += [ends(i, j) for i, j in np.argwhere(stops)]
    for kind, lines in segments.items():
        capstyle = "projecting" if kind == "neutral" else None
        ax.add_collection(
            mpl.collections.LineCollection(lines, capstyle=capstyle, **drawing.BORDERS[kind])
        )
    return [drawing.sample(**drawing.BORDERS[kind]) for kind, lines in segments.items() if lines]


def _captions(study: xr.Dataset, plot: RegionMap) -> Iterator[str]:
    """The horizon, and where the static start does otherwise than the paper."""
    horizon = stated_in(study, "options")["horizon"]
    yield f"Within {horizon:g} s of the static start."
    if "as_published" not in drawing.normalizations(study):
        return
    outcomes = drawing.of(study, "as_published")["outcome"]
    for name, mark in plot.marks.items():
        outcome = str(flag_names(outcomes.sel({plot.x: mark.x, plot.y: mark.y}, method="nearest")))
        label, of_paper = LOOKS[outcome].label, LOOKS[mark.paper_outcome].label
        if label != of_paper and not mark.assumed:
            still = f"still growing at {horizon:g} s" if outcome == "growing" else label
            yield f"{name}: paper: “{of_paper}”, static start: {still}."


def _marks(ax: Axes, plot: RegionMap) -> list[Artist]:
    """Mark cases by the shape of the paper's outcome, with names towards the middle; returns
    entries of a legend."""
    edge: dict[str, Any] = {
        "edgecolor": PAPER,
        "linewidth": 1.4,
        "path_effects": drawing.halo(2.4, BLACK),
    }
    look: dict[str, Any] = {
        "fontsize": 7,
        "zorder": 5,
        "annotation_clip": False,
        "path_effects": drawing.halo(2.0),
    }
    outcomes, marked = {mark.paper_outcome for mark in plot.marks.values()}, list[Any]()
    for name, mark in plot.marks.items():
        point = (mark.x * drawing.axis_of(plot.x)[1], mark.y * drawing.axis_of(plot.y)[1])
        shape = PAPER_MARKERS[mark.paper_outcome]
        across, up = position = (ax.transData + ax.transAxes.inverted()).transform(point)
        around = any(
            math.dist(position, other) < 0.02 for other in marked
        )  # another mark, which stays visible
        marked.append(position)
        ax.scatter(
            *point,
            140.0 if around else 55.0,
            marker=shape,
            facecolor="none",
            zorder=4,
            clip_on=False,
            **edge,
        )
        aside = (-8, 6) if around else (-6 if across > 0.85 else 6, -5 if up > 0.15 else 5)
        drawing.say(ax, name, point, aside, **look)
    ring = {
        "ls": "",
        "mfc": "none",
        "ms": 6,
        "mew": 1.4,
        "mec": PAPER,
        "path_effects": edge["path_effects"],
    }
    said = [
        (f"paper: {LOOKS[name].label}", shape)
        for name, shape in PAPER_MARKERS.items()
        if name in outcomes
    ]
    return [drawing.sample(marker=shape, label=label, **ring) for label, shape in said]


def _set_scales(axes: Sequence[Axes], study: xr.Dataset, names: Mapping[str, str]) -> None:
    """Set limits, labels and scales of shared axes; a logarithmic scale with a 0 is linear up to
    the second value."""
    for which, name in names.items():
        label, factor = drawing.axis_of(name)
        values = study[name].values * factor
        axis = getattr(axes[0], f"{which}axis")
        if (scale := scale_of(name, values)) != "linear":
            start = {"linthresh": values[1], "linscale": 0.4} if scale == "symlog" else {}
            getattr(axes[0], f"set_{which}scale")(scale, **start)
            ticks = [
                x
                for x in drawing.DECADES
                if 0.999 * values[values > 0][0] <= x <= 1.001 * values[-1]
            ]
            axis.set_major_locator(mpl.ticker.FixedLocator([0.0] * (scale == "symlog") + ticks))
            axis.set_major_formatter("{x:g}")
            axis.set_minor_formatter(mpl.ticker.NullFormatter())
            if scale == "symlog":
                axis.set_minor_locator(mpl.ticker.NullLocator())
        to_axis = axis.get_transform()
        low, high = to_axis.transform(values[[0, -1]])
        margin = 0.02 * (high - low) or 0.02 * abs(high) or 1.0
        axes[0].set(**{f"{which}lim": to_axis.inverted().transform([low - margin, high + margin])})
        for ax in axes:
            ax.set(**{f"{which}label": label})
            ax.label_outer()


# ---- Onset and end of separation over speed and preload
CYCLE, BASINS = Role("regions", ("N", "Omega")), Role("basins", ("Omega",))
ONSET, END = SEPARATED, drawing.BLUE  # speeds at which separation begins, and at which it ends
CONTACT = LOOKS["growing"]._replace(
    label="oscillations grow, or another\ncycle is reached, in contact"
)
ONSETS: dict[str, Any] = {
    "c": "white",
    "marker": "o",
    "ms": 2.4,
    "mec": BLACK,
    "mew": 0.5,
    "zorder": 1.9,
}
"""Look of onsets, seen on any area by their black edges, below the curves."""


class CriticalSpeed(Plot):
    """Speeds at which separation begins or ends against the preload, for several horizons."""

    needs = ("N",)
    roles: ClassVar[Roles] = {
        "hysteresis": Role("hysteresis"),
        "cycle": CYCLE,
        "curves": CURVES,
        "basins": BASINS,
    }
    kind: Literal["critical_speed"] = "critical_speed"
    paper_points: dict[str, tuple[Finite, Finite]] = Field({})

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw (a) where separation begins from the static start, over a map, and (b) sweeps of the
        speed."""
        lost = drawing.failed(study).values
        sweep, cycle = overlays.get("hysteresis"), overlays.get("cycle")
        speeds, loads = study["scan_Omega"].values, study["N"].values
        if cycle is not None:
            # separation is unknown beyond the scan
            cycle = cycle.sel(Omega=slice(speeds.min(), speeds.max())).transpose("N", "Omega", ...)
            speeds = cycle["Omega"].values
        width, columns = (drawing.COLUMN, 1) if sweep is None else (PAGE, 2)
        figure, axes = panels(width, 3.8, 1, columns, sharex=True, sharey=True)
        axes[0].set_xlim(speeds.min(), speeds.max())
        axes[0].set_ylim(0.95 * loads.min(), 1.02 * loads.max())
        drawing.mark_failed(axes[0], loads[lost], on="y")
        study = study.isel(N=~lost).sortby("N")
        handles: list[Artist] = [] if cycle is None else _behind(axes[0], cycle)
        if "curves" in overlays:
            curves = curves_of(overlays["curves"])
            if cycle is not None:  # what passes no cell with separation has no name
                apart = cycle["outcome"].copy(data=flag_names(cycle["outcome"]) == "separation")
                parts = parts_of(curves, cycle)
                curves = [x if passes(x, apart).any() else x._replace(label="") for x in parts]
            handles += draw_curves(axes[0], curves)
        horizon = float(study["horizon"].max())
        _onsets(axes[0], study, horizon, label=f"separation begins, within {horizon:g} s", **ONSETS)
        if self.paper_points:
            load, speed = np.transpose([*self.paper_points.values()])
            # hollow, as marks lie below
            hollow: dict[str, Any] = {
                "mfc": "none",
                "mec": PAPER,
                "path_effects": drawing.halo(2.1, BLACK),
            }
            axes[0].plot(
                speed, load, "*", ms=10, mew=1.1, zorder=5, clip_on=False, label="paper", **hollow
            )
        titles = ["from the static start"]
        if sweep is not None:
            _onsets(axes[1], study, horizon, label="_nolegend_", **ONSETS)
            titles.append(_beside(axes[1], sweep, cycle, overlays.get("basins")))
        drawing.letters(axes, titles, pad=12)
        for ax in axes:
            ax.set_xlabel(SPEED)
            handles += ax.get_legend_handles_labels()[0]
        axes[0].set_ylabel(LOAD)
        figure_legend(figure, handles, loc="outside lower center", columns=3, columnspacing=1.0)
        return figure


def speeds_of(study: xr.Dataset, horizon: float, kind: str = "begins") -> list[Array]:
    """Rising speeds, rad/s, at which separation begins (or the scan begins with it), or ends, for
    each load."""
    of_horizon = study.sel(horizon=horizon).transpose("N", ..., "crossing_number")
    speeds = np.where(
        flag_names(of_horizon["crossing_kind"]) == kind, of_horizon["crossing"].values, np.nan
    )
    rows = np.column_stack([of_horizon["critical_speed"].where(kind == "begins"), speeds])
    return [np.unique(row[np.isfinite(row)]) for row in rows]


def branches(
    speeds: Sequence[Array], ends: Sequence[Iterable[float]]
) -> list[tuple[int, float, float]]:
    """Nearest crossings at neighbouring loads, if no end is between: index of the lower load, speed
    there, and next."""
    links = []
    for i, (current, ahead) in enumerate(pairwise(speeds)):
        if current.size and ahead.size:
            apart = np.abs(current[:, None] - ahead[None, :])
            # speeds are rounded, so that two may be as near
            nearest = np.isclose(apart, apart.min(0), rtol=1e-9) & np.isclose(
                apart, apart.min(1)[:, None], rtol=1e-9
            )
            pairs = [(float(current[j]), float(ahead[k])) for j, k in np.argwhere(nearest)]
            links += [
                (i, a, b)
                for a, b in pairs
                if not any((end - a) * (end - b) < 0 for end in ends[i + (a > b)])
            ]
    return links


def _onsets(ax: Axes, study: xr.Dataset, horizon: float, **look: Any) -> None:
    """Draw onsets of separation, joined along their branches."""
    loads, speeds, ends = (
        study["N"].values,
        speeds_of(study, horizon),
        speeds_of(study, horizon, "ends"),
    )
    gap = (np.nan, np.nan)
    points = [
        point
        for i, a, b in branches(speeds, ends)
        for point in ((a, loads[i]), (b, loads[i + 1]), gap)
    ]
    points += [
        at
        for load, row in zip(loads, speeds, strict=True)
        for speed in row
        for at in ((speed, load), gap)
    ]
    ax.plot(*np.reshape(points, (-1, 2)).T, path_effects=drawing.halo(1.3, BLACK), **look)


def _behind(ax: Axes, cycle: xr.Dataset) -> list[Artist]:
    """Draw outcomes of the static start; returns entries of a legend."""
    words = flag_names(cycle["outcome"])
    words = np.where(words == "other_cycle", "growing", words)
    horizon = stated_in(cycle, "options")["horizon"]
    apart = LOOKS["separation"]._replace(label=f"separation within {horizon:g} s")
    looks = {**LOOKS, "growing": CONTACT, "separation": apart}
    paint(ax, edges_of(cycle["growth_rate"]), words, looks)
    return entries(words.flat, looks)


def _beside(
    ax: Axes, sweep: xr.Dataset, cycle: xr.Dataset | None, basins: xr.Dataset | None
) -> str:
    """Draw sweeps of the speed, and shade where some motions stay quiet and others separate;
    returns a title."""
    N, lost = sweep["N"].values, drawing.failed(sweep).values
    look: dict[str, Any] = {
        "markersize": 4,
        "markerfacecolor": "none",
        "linestyle": "",
        "clip_on": False,
    }
    onset, end = (
        np.where(lost, np.nan, sweep[name].values) for name in ("onset_speed", "offset_speed")
    )
    ax.plot(onset, N, color=ONSET, marker="^", label="sweep up: separation begins", **look)
    ax.plot(end, N, color=END, marker="v", label="sweep down: separation ends", **look)
    drawing.mark_failed(ax, N[lost], on="y")
    if basins is not None:
        # by the starts: both fractions exceed zero with their intervals; a single speed is a line
        load, speeds = stated_in(basins, "base")["N"], basins["Omega"].values
        quiet, apart = (
            basins["basin_fraction_low"].sel(attractor_class="quiet"),
            basins["separating_fraction_low"],
        )
        height = 20.0  # N, well within a step of the sweeps
        for i, (first, after) in enumerate(drawing.stretches(((quiet > 0) & (apart > 0)).values)):
            label = "_nolegend_" if i else f"quiet or separating,\ncomputed at {load:g} N"
            width = speeds[after - 1] - speeds[first]
            ax.barh(
                load,
                width,
                height,
                speeds[first],
                label=label,
                color=ORANGE,
                ec=ORANGE,
                alpha=0.6,
                lw=0.8,
            )
    elif cycle is not None:
        # by the multipliers, as short dwells only delay a sweep up; without loads between whose
        # neighbours of the sweep one never separates
        speeds, loads = cycle["Omega"].values, cycle["N"].values
        lowest = np.interp(loads, N, sweep["offset_speed"].values, left=np.nan, right=np.nan)
        within = (speeds >= lowest[:, None]) & (speeds <= float(sweep["sweep_Omega"].max()))
        stable = (cycle["growth_rate"].values < 0) & within
        cmap, shown = mpl.colors.ListedColormap([ORANGE]), np.ma.masked_where(~stable, stable)
        ax.pcolormesh(
            speeds, loads, shown, cmap=cmap, alpha=0.25, shading="nearest", rasterized=True
        )
        label = "the cycle is stable where the\nsweep down still separates"
        ax.fill_between([], [], [], color=ORANGE, alpha=0.25, label=label)
    return f"sweeps in steps of {float(np.diff(sweep['sweep_Omega'].values[:2])[0]):g} rad/s"


class RampedSpeeds(Plot):
    """Where separation begins on the way up and ends on the way down, against the rate of the
    speed's ramps."""

    roles: ClassVar[Roles] = {"curves": CURVES}
    kind: Literal["ramps"] = "ramps"

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw one point; by ``curves``, the highest end of the cycle below all onsets, their limit
        for slow ramps."""
        study = study.squeeze()
        options, load = stated_in(study, "options"), float(stated_in(study, "base")["N"])
        rates, onset, end = (study[name].values for name in ("rate", "onset_speed", "offset_speed"))
        gone = study["rate_status"].values != 0
        figure, [ax] = panels(drawing.COLUMN, 3.4)
        ax.plot(
            rates, onset, "^-", color=ONSET, markersize=4, linewidth=0.8, label="onset, rising ramp"
        )
        ax.plot(rates, end, "v-", color=END, markersize=4, linewidth=0.8, label="end, falling ramp")
        if (late := rates[np.isnan(onset) & ~gone]).size:
            look: dict[str, Any] = {
                "color": ONSET,
                "markersize": 4,
                "markerfacecolor": "white",
                "clip_on": False,
            }
            ax.plot(
                late,
                np.full(late.size, options["high"]),
                "^",
                label="none up to the highest speed",
                **look,
            )
        if "curves" in overlays:
            folds = [
                crossings(curve, load)
                for curve in curves_of(overlays["curves"])
                if curve.kind == "fold"
            ]
            if below := [speed for speed in chain(*folds) if speed <= np.fmin.reduce(onset)]:
                ax.axhline(max(below), **drawing.BORDERS["fold"], zorder=0)
                drawing.say_beside(ax, max(below), f"{max(below):.2f}", fontsize=6, color=GREY)
        drawing.mark_failed(ax, rates[gone])
        ax.set_xscale("log")
        ax.margins(x=0.04)
        ax.set(xlabel="Ramp rate (rad/s²)", ylabel=SPEED, ylim=(options["low"], options["high"]))
        figure_legend(
            figure, ax.get_legend_handles_labels()[0], loc="outside lower center", columns=1
        )
        return figure
