"""Figures of studies over parameters: each a few lines over `draw`."""

from collections.abc import Sequence
from typing import Annotated, Any, Literal

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from xarray import DataArray, Dataset

from disc_model.analysis.classify import share
from disc_model.analysis.contact_loss import excess_of_flights, pinned_range
from disc_model.data.variables import SHOWN, stated_in, typeset
from disc_model.figures.draw import (
    COLUMN,
    LOWER,
    NOTE,
    PAGE,
    UPPER,
    around,
    bar_of,
    cells,
    class_map,
    colours_of,
    each_value,
    is_rate,
    is_words,
    lines,
    mark_missing,
    mark_points,
    number_map,
    one_line,
    panels,
    rate_axis,
    sign_changes,
    unresolved,
    wished,
)
from disc_model.figures.looks import (
    AROUND_DOTS,
    BLACK,
    BLUE,
    GREEN,
    GREY,
    LOOKS,
    ORANGE,
    PAPER,
    RED,
    STABLE,
    Look,
    Options,
)
from disc_model.figures.schema import MOST_VALUES, NORM, NOTHING, Role, grid_figure
from disc_model.figures.shown import label, parameter_of, placed, value_text
from disc_model.parameters import Parameters
from disc_model.units import Finite, Positive, Strict

Curves = Annotated[Dataset | None, Role("neutral_curves")]
BORDERS = {"neutral": ("cycle loses stability", "-"), "fold": ("stable cycle ends (fold)", "--")}
"""What curves are, and their lines."""
OF_CYCLES = ("growth_rate", "cycle_growth_rate")  # whose neighbours may be of another cycle
SIGN = "growth rate changes its sign"
THIN = "thin: narrow, or of another cycle"
MERGED = "growing, or another cycle"
LINE_COLOURS = (BLACK, ORANGE, BLUE, GREEN)
MARKS: list[Any] = [
    {"marker": marker, "color": colour, "ls": ""}
    for marker, colour in zip("o^sD", LINE_COLOURS, strict=True)
]
DASHES = ("-", "--", ":")
LIMIT = "Range at which contact is lost, R = 2N/|k − mω²|"
HOLLOW = "hollow: no frequency carries 95 % of height and contact force"
BAND = 0.05  # excess of a range up to which a motion counts as limited by loss of contact
ENLARGED = (-0.25, 0.35)  # excess that the enlarged panel shows; what is beyond stands at its edge
RING: Options = {"marker": "o", "ms": 7, "mew": 0.6, "mfc": "none", "color": BLACK}
BOX: Options = {"fc": "white", "alpha": 0.8, "lw": 0, "pad": 0.5}  # behind names
SHADE = "#e4e4e4"


def row(count: int, height: float) -> tuple[Figure, list[Axes]]:
    """A figure with a row of panels that have the same scales."""
    width = COLUMN if count == 1 else PAGE
    figure, axes = panels([[*range(count)]], width, height, sharex=True, sharey=True)
    return figure, [*axes.values()]


# ---- Any variable


@grid_figure()
def heat_map(study: Dataset, variable: str, x: str, y: str, by: str = NORM) -> Figure:
    """Any variable in colour over two dimensions, with a panel for each value of a third."""
    figure, _ = draw_maps(study, [variable], x, y, by)
    return figure


def draw_maps(
    study: Dataset, variables: Sequence[str], x: str, y: str, by: str, curves: Dataset | None = None
) -> tuple[Figure, Any]:
    """A row of maps for each variable, with a panel for each value of a third dimension.

    curves : neutral curves, borders of the cycle whose growth rate is the last variable

    Returns the figure, and its axes, shape (variable, value).
    """
    parts = each_value(study, by)
    layout = np.arange(len(variables) * len(parts)).reshape(-1, len(parts))
    width = COLUMN if layout.size == 1 else PAGE
    figure, axes = panels(layout.tolist(), width, 2.4, sharex=True, sharey=True)
    rows = np.array([*axes.values()]).reshape(layout.shape)
    for row, variable in zip(rows, variables, strict=True):
        colours = colours_of(study[variable])
        for ax, (title, part) in zip(row, parts, strict=True):
            ax.set_title(title)
            plane = part.transpose(y, x, ...)
            mesh = draw_map(ax, plane, variable, **colours)
            rate = plane[variables[-1]]
            beside = curves
            if curves is not None and by in curves.dims:
                beside = curves.sel({by: part[by].item()})
            if is_rate(rate):
                borders(ax, beside, rate)
        if mesh is not None:
            bar_of(figure, row, mesh, study[variable])
    return figure, rows


def draw_map(ax: Axes, data: Dataset, variable: str, **colours: Any) -> Any:
    """Draw classes, or numbers in colours, over two dimensions (up, across), with circles where they
    are in doubt; returns the mesh of numbers, for a bar."""
    plane = data[variable]
    doubt = in_doubt(data, variable)
    if is_words(plane):
        class_map(ax, plane)
        unresolved(ax, plane)
        return None
    why = why_missing(data, variable)
    mesh = number_map(ax, plane, why, **colours)
    if is_rate(plane):
        mark_stable(ax, plane, why)
    cells(ax, plane, doubt, Look(f"circles: {doubt.attrs['long_name']}", "none", "oo"))
    return mesh


def mark_stable(ax: Axes, rate: DataArray, why: DataArray | None) -> None:
    """Dots where growth rates, of dimensions (up, across), are negative; single cells that differ from
    those beside them are hatched.

    why : classes of the points without a rate
    """
    negative = rate < 0
    cells(ax, rate, negative, AROUND_DOTS)
    cells(ax, rate, negative, STABLE)
    signs = rate.copy(data=np.where(negative, "stable", "unstable").astype(object))
    unresolved(ax, signs if why is None else signs.where(rate.notnull(), why))


@grid_figure()
def curve(
    study: Dataset, variable: str, x: str, by: str = NORM, highest: Finite | None = None
) -> Figure:
    """Any variable against one dimension, with a line for each value of another.

    highest : upper end of the axis of the variable, in the unit of the figure, such as for two figures side by side
    """
    figure, [ax] = row(1, 2.6)
    draw_lines(ax, study, variable, x)
    ax.set_ylim(top=highest)
    return figure


def draw_lines(
    ax: Axes, data: Dataset, variable: str, x: str, *, joined: bool = True, **look: Any
) -> None:
    """Draw a line for each value of a second dimension, or points where there are many of these.

    joined : whether lines join the points, which are not paired values
    """
    array = data[variable]
    doubt = in_doubt(data, variable)
    by = next((str(dim) for dim in array.dims if dim != x), "")
    usual: Options = {"doubt": doubt.attrs["long_name"]}
    if not joined:
        usual["linestyle"] = ""
    if not by:
        chosen = [each for each in array.coords.values() if each.ndim == 0 and parameter_of(each)]
        usual["label"] = ", ".join(map(value_text, chosen))
    elif by not in array.coords or array.sizes[by] > MOST_VALUES:
        array = flattened(array, x)
        doubt = flattened(doubt, x)
        usual |= {"marker": ".", "linestyle": "", "missing": ""}
    of_cycle = variable in OF_CYCLES and data.attrs.get("function") != "steady_sliding"
    if of_cycle:
        usual["jump"] = 1.0
    lines(ax, array, x, doubtful=doubt, **wished(look, **usual))
    if of_cycle:
        rate_axis(ax)
    elif is_rate(array):
        ax.axhline(0, color=GREY, zorder=0)


def flattened(array: DataArray, x: str) -> DataArray:
    """All values at each place along a dimension, in one line."""
    points = array.stack(point=array.dims, create_index=False)
    places = points[x].variable.values
    along = DataArray(places, dims=x, attrs=array[x].attrs)
    return DataArray(points.values, {x: along}, name=array.name, attrs=array.attrs)


def why_missing(data: Dataset, variable: str) -> DataArray | None:
    """Words for the points of a variable without a number: what there is in place of a cycle, or a
    status that is not "ok"."""
    x = data[variable]
    if is_rate(x) and "cycle" in data and data["cycle"].dims == x.dims:
        return data["cycle"]
    if "status" in data and {*data["status"].dims} <= {*x.dims}:
        status = data["status"].broadcast_like(x).transpose(*x.dims)
        return status.where(status != "ok", "no_value")
    return None


LATE = ("_min", "_max", "_fraction", "separation_rate", "surface_speed")
"""Ends of names of what `outcome` says of the late motion."""
NO = ("undecided", "changing", "unknown", "no", "growing", "False", "0.0")
DOUBTS: Options = {
    "settled": ("", NO, "not settled"),
    "sweep_settled": ("", NO, "not settled"),
    "converged": ("", NO, "not converged"),
    "at_lower_bound": (("value", "critical_speed"), ("True", "1"), "at the lower bound, or below"),
    "outcome": (LATE, NO, "still growing, or undecided"),
}
"""Variables that say whether others are sure: the ends of their names, words of doubt, and its
reason."""


def in_doubt(data: Dataset, variable: str) -> DataArray:
    """Where a value is not known to be final, with the reason as `long_name`, "" if there is none."""
    x = data[variable]
    unsure = xr.zeros_like(x, dtype=bool)
    why = ""
    for name, (ends, doubts, reason) in DOUBTS.items():
        known = name in data and name != variable and {*data[name].dims} <= {*x.dims}
        if known and not why and variable.endswith(ends):
            unsure = unsure | data[name].astype(str).isin(doubts)
            why = reason
    return unsure.transpose(*x.dims).assign_attrs(long_name=why)


# ---- Maps of outcomes


class Mark(Strict):
    """A case of the paper: where it lies, in SI units, and what the paper says of it."""

    x: Finite
    y: Finite
    paper_outcome: Literal["stick_slip", "growing", "separation"]


SHAPES: Options = {
    "stick_slip": ("o", 4, -6, "top"),
    "growing": ("^", 6, -6, "top"),
    "separation": ("s", 8, 6, "bottom"),
}
"""Marks of cases by what the paper says, their sizes, and the places of names: above or below."""


@grid_figure("regions")
def region_map(
    study: Dataset,
    x: str,
    y: str,
    by: str = NORM,
    marks: dict[str, Mark] = NOTHING,
    curves: Curves = None,
) -> Figure:
    """Outcomes over two parameters, with cases of the paper, and the growth rate of the cycle below,
    for each value of a third one."""
    figure, rows = draw_maps(study, ["outcome", "growth_rate"], x, y, by, curves)
    for ax in rows[0]:
        ax.set_title(titled(ax.get_title(loc="left"), study))
    for name, mark in marks.items():
        draw_mark(rows[0, 0], name, mark, study[x], study[y])
    return figure


def titled(title: str, study: Dataset) -> str:
    """A title of outcomes, with their horizon."""
    horizon = stated_in(study, "options")["horizon"]
    return f"{title}: outcome within {horizon:g} s".removeprefix(": ")


def borders(ax: Axes, curves: Dataset | None, rate: DataArray) -> None:
    """Where the cycle of a map loses stability or ends: continued curves beside a stable cycle, thin where
    they do not pass between an area in which the map's is stable and one beyond, both two cells wide or
    more. Without curves, the line at which the rate changes its sign.

    rate : of dimensions (up, across)
    """
    beside = around(rate < 0) & around(~(rate < 0))
    if curves is None:
        sign_changes(ax, rate.where(beside), SIGN)
        return
    up, across = (along(curves)[str(dim)] for dim in rate.dims)
    places = zip(rate.dims, (up.fillna(0.0), across.fillna(0.0)), strict=True)
    wide = beside.sel(dict(places), method="nearest")
    stable = curves["adjoins_stable_cycle"] == "yes"
    for kind, (name, style) in BORDERS.items():
        of_kind = up.where(stable & (curves["kind"] == kind)).transpose(..., "curve_point")
        for part, width, text in (
            (of_kind.where(wide), 1.0, name),
            (of_kind.where(~wide), 0.4, THIN),
        ):
            if part.notnull().any():
                ax.plot(*one_line(across, part), style, color=BLACK, lw=width, label=text)


def along(curves: Dataset) -> dict[str, DataArray]:
    """Places on curves by their parameters."""
    return {curves[axis].attrs["parameter"]: curves[axis] for axis in "xy"}


def draw_mark(ax: Axes, name: str, mark: Mark, x: DataArray, y: DataArray) -> None:
    """A case of the paper, in the colour and the shape of what the paper says, with its name within the
    panel: that of a separation above, and others below, as several may be at one place."""
    at = placed(x, mark.x), placed(y, mark.y)
    shape, size, up, end = SHAPES[mark.paper_outcome]
    look = LOOKS[mark.paper_outcome]
    said: Options = {"mfc": look.face, "mec": BLACK, "clip_on": False}
    ax.plot(*at, shape, ms=size, zorder=20 - size, label=f"paper: {look.label}", **said)
    if at[1] < y.quantile(0.1):
        up = 6
        end = "bottom"
    right = 6
    side = "left"
    if at[0] > x.mean():
        right = -6
        side = "right"
    ax.annotate(name, at, (right, up), ha=side, va=end, bbox=BOX, zorder=20, **NOTE)


FATES = {
    "small": ("stick_slip", "steady_sliding", "at_rest"),
    "growing": ("growing", "other_cycle"),
    "separating": ("separation",),
}
"""Motions, and outcomes that are these; the first has their colour."""
NEUTRAL = 1e-9  # growth rate of steady sliding that is zero but for rounding, 1/s


@grid_figure("regions", "outcome")
def sliding_outcome(
    study: Dataset,
    x: str,
    y: str,
    sliding: Annotated[Dataset, Role("sliding_modes", required=True)],
    by: str = NORM,
) -> Figure:
    """What linear analysis of steady sliding says, and what the motion does, over two parameters; the
    legend has shares of the points of each panel."""
    motion, linear = xr.align(study, sliding.rename(value=x), join="inner")
    outcome = motion["outcome"]
    stable = linear["largest_growth_rate"] <= NEUTRAL
    both = xr.full_like(outcome, "undecided", dtype=object)
    looks = {}
    for fate, outcomes in FATES.items():
        for word, sign, hatch in (("stable", stable, STABLE.hatch), ("unstable", ~stable, "")):
            here = outcome.isin(outcomes) & sign
            said = f"sliding {word}, {fate}"
            both = both.where(~here, said)
            shares = [f"{100 * float(part.mean()):.0f} %" for _, part in each_value(here, by)]
            name = f"{said}: {', '.join(shares)}"
            looks[said] = LOOKS[outcomes[0]]._replace(label=name, hatch=hatch)
    parts = each_value(both, by)
    figure, axes = row(len(parts), 2.6)
    for ax, (title, part) in zip(axes, parts, strict=True):
        ax.set_title(titled(title, study))
        class_map(ax, part.transpose(y, x), looks)
    return figure


def counted(chosen: Any) -> str:
    """How many of some are chosen, of a mask."""
    return f"{int(chosen.sum())} of {chosen.size}"


# ---- Where separation begins


@grid_figure("critical_speed", needs=("N",))
def critical_speed(
    study: Dataset,
    paper_points: dict[str, tuple[Finite, Finite]] = NOTHING,
    hysteresis: Annotated[Dataset | None, Role("hysteresis")] = None,
    cycle: Annotated[Dataset | None, Role("regions")] = None,
    curves: Curves = None,
    basins: Annotated[Dataset | None, Role("basins")] = None,
) -> Figure:
    """Speeds at which separation begins, against the preload: from the static start, over a map of
    outcomes with its borders, and in sweeps, over the map's stable cycles.

    paper_points : preloads and critical speeds of the paper, N and rad/s
    """
    if "horizon" in study.dims:
        study = study.sel(horizon=study["horizon"].max())
    speeds = study["scan_Omega"]
    loads = study["N"]
    figure, axes = row(1 if hysteresis is None else 2, 3.0)
    first = axes[0]
    last = axes[-1]
    if cycle is not None:
        plane = cycle.sel(Omega=slice(*speeds[[0, -1]].values)).transpose("N", "Omega", ...)
        behind(first, plane, curves)
        stable = plane["growth_rate"] < 0
        for ax in axes[1:]:
            cells(ax, stable, stable, Look("cycle stable", LOOKS["stable"].face))
    for ax in axes:
        onsets(ax, study)
        ax.set(xlabel=label(speeds), ylabel=label(loads), xlim=speeds[[0, -1]])
        ax.label_outer()
    first.set_title(f"from the static start, within {study['horizon']:g} s")
    for load, speed in paper_points.values():
        at = placed(speeds, speed), placed(loads, load)
        first.plot(*at, "*", ms=9, zorder=5, label="paper's critical speed", **PAPER)
    if hysteresis is not None:
        step = float(hysteresis["sweep_Omega"].diff("sweep_Omega")[0])
        last.set_title(f"sweeps in steps of {step:g} {speeds.units}")
        sweeps(last, hysteresis)
    if basins is not None:
        load = placed(loads, stated_in(basins, "base")["N"])
        coexistence(last, basins, load)
    return figure


def behind(ax: Axes, plane: Dataset, curves: Dataset | None) -> None:
    """Outcomes of a map and the borders of its cycle, with the multiples of the stick-slip frequency of
    folds of a stable cycle that leave the panel through its upper edge."""
    merged = plane["outcome"].where(plane["outcome"] != "other_cycle", "growing")
    class_map(ax, merged, {"growing": LOOKS["growing"]._replace(label=MERGED)})
    borders(ax, curves, plane["growth_rate"])
    if curves is None:
        return
    speeds, loads = folds(curves)
    top = ax.get_ylim()[1]
    for i in np.flatnonzero(loads.max("curve_point") > 0.98 * top):
        at = speeds[i, int(np.nanargmax(loads[i]))], top
        name = f"{curves['resonance_harmonic'][i]:g} $f_s$"
        ax.annotate(name, at, (-2, -2), ha="right", va="top", bbox=BOX, **NOTE)


def folds(curves: Dataset) -> tuple[DataArray, DataArray]:
    """Speeds and preloads of folds of a stable cycle, nan at other points."""
    beside = (curves["kind"] == "fold") & (curves["adjoins_stable_cycle"] == "yes")
    places = along(curves)
    return places["Omega"].where(beside), places["N"].where(beside)


def onsets(ax: Axes, study: Dataset) -> None:
    """All speeds of a scan at which separation begins, and crosses beyond the right edge without one."""
    found = study["crossing"].where(study["crossing_kind"] == "begins").transpose("N", ...)
    look: Options = {"color": BLACK, "mew": 0.6}
    mark_points(ax, *xr.broadcast(found, study["N"]), "separation begins", marker="o", **look)
    none = study["N"][study["critical_speed"].isnull().values]
    edge = {"transform": ax.get_yaxis_transform(), "clip_on": False, "marker": "x"}
    low, high = study["scan_Omega"].values[[0, -1]]
    name = f"none found from {low:g} to {high:g} {study['scan_Omega'].units}"
    mark_points(ax, 0 * none + 1.02, none, name, **edge, **look)


def sweeps(ax: Axes, sweep: Dataset) -> None:
    """Speeds at which separation begins on the way up and ends on the way down, at each preload; hollow
    where a stay in contact ended before the motion had settled, so that the speed is in doubt."""
    along = sweep["sweep_Omega"]
    up = sweep["onset_speed"]
    down = sweep["offset_speed"]
    kept = sweep["separation_rate"] == 0
    unsure = kept & (sweep["sweep_settled"] != "settled")
    last_kept = along.where(kept.sel(direction="down")).max("sweep_Omega")
    ends = down.fillna(along.min())  # without one, separation goes on at the lowest speed
    ax.hlines(sweep["N"], ends, up, color=BLACK, label="sweeps")
    for way, speeds, before, name, marker, colour in (
        ("up", up, along < up, "separation begins", "^", RED),
        ("down", down, along == last_kept, "separation ends", "v", BLUE),
    ):
        look: Options = {"marker": marker, "color": colour, "ms": 5}
        ax.plot(speeds, sweep["N"], ls="", label=f"going {way}: {name}", **look)
        doubtful = (unsure.sel(direction=way) & before).any("sweep_Omega")
        mark_points(ax, speeds.where(doubtful), sweep["N"], "hollow: not settled", **look)


def coexistence(ax: Axes, basins: Dataset, load: float) -> None:
    """A bar over the speeds at which some random starts come to small stick-slip and others keep
    separating: the intervals of both shares exclude zero."""
    small = basins["basin_fraction_low"].sel(attractor_class="stick_slip") > 0
    both = basins["Omega"].where(small & (basins["separating_fraction_low"] > 0))
    name = "random starts: small or separating"
    ax.plot(both, both * 0 + load, "-|", color=ORANGE, lw=2, ms=7, mew=1.5, label=name)


@grid_figure("ramps")
def ramps(study: Dataset, curves: Curves = None) -> Figure:
    """Speeds at which separation begins and ends on ramps of the speed, against their rate; a line where
    the stable cycle ends, the limit of slow ramps."""
    figure, [ax] = row(1, 2.4)
    bounds = stated_in(study, "options")["bounds"]
    low, high = (placed(study["onset_speed"], end) for end in bounds)
    for name, way, end, edge, marker, colour in (
        ("onset_speed", "rising", "begins", UPPER, "^", RED),
        ("offset_speed", "falling", "ends", LOWER, "v", BLUE),
    ):
        speeds = study[name].assign_attrs(long_name="Speed Ω")
        why = speeds.attrs.get("missing", "no value")
        missing = f"{way}, {low:g} to {high:g} {speeds.units}: {why}"
        look: Options = {"marker": marker, "color": colour, "ms": 4, "edge": edge}
        lines(ax, speeds, "rate", label=f"{way}: separation {end}", missing=missing, **look)
    mark_missing(ax, study["rate"][(study["rate_status"] != "ok").values], "failed")
    if curves is not None:
        ends = fold_speeds(curves, stated_in(study, "base")["N"])
        limit = float(ends.where(ends <= study["onset_speed"].min()).max())
        if np.isfinite(limit):
            name = f"stable cycle ends (fold), {limit:.2f}"
            ax.axhline(limit, color=BLACK, ls="--", label=name)
    return figure


def fold_speeds(curves: Dataset, load: float) -> DataArray:
    """Speeds at which folds of the stable cycle cross a preload (N), nan between other points."""
    speed, loads = folds(curves)
    above = loads - placed(loads, load)
    ahead = above.shift(curve_point=-1)
    crossing = speed + above / (above - ahead) * (speed.shift(curve_point=-1) - speed)
    return crossing.where(above * ahead <= 0)


# ---- Motions with separation


@grid_figure("outcome")
def escape(study: Dataset, starts: str = "perturbation_u", by: str = "N") -> Figure:
    """Share of starts that have separated, against time, with a line for each value of a parameter, and
    bars of 95 % confidence at its end."""
    horizon = stated_in(study, "options")["horizon"]
    figure, [ax] = row(1, 2.6)
    for i, (title, part) in enumerate(each_value(study, by)):
        known = part["first_separation"][(part["status"] == "ok").values]
        times = np.sort(known.dropna(starts).values)
        shares = np.arange(times.size + 1) / max(1, known.size)
        colour = LINE_COLOURS[i % 4]
        name = f"{title}: {counted(known.notnull())} starts"
        look: Options = {"color": colour, "label": name, "where": "post"}
        ax.step([0, *times, horizon], [*shares, shares[-1]], DASHES[i % 3], **look)
        end = horizon * (1.02 + 0.02 * i)
        _, low, high = share(times.size, known.size)
        ax.vlines(end, low, high, colour, lw=3, label="95 % confidence")
    ax.set(xlabel="Time (s)", ylabel="Share of starts that separated", ylim=(-0.02, 1.02))
    ax.set_xlim(0, None)
    return figure


UNSETTLED = "still growing, or undecided"
SURE = ("stick_slip", "other_cycle", "steady_sliding", "at_rest", "separation")
"""Outcomes that a longer time would not change."""


@grid_figure("outcome", needs=("Omega", "N", "contact"))
def late_range(study: Dataset, thickness: Positive) -> Figure:
    """Late range of the slider's height, and speed of the disc's surface under it, against the speed,
    with separation and with it ignored.

    thickness : of the disc, m: plate theory is not linear for larger ranges
    """
    height = study["u_max"].assign_attrs(long_name="Range of the slider's height")
    late = height.copy(data=height - study["u_min"])
    limits = lost_contact(study)
    apart = late.where(study["outcome"] == "separation").sel(contact="unilateral")
    lost = f"R, at which contact is lost; separating: {extent(apart / limits)} R"
    data = study.assign(late=late, unsure=~study["outcome"].isin(SURE))

    names = [name for name in ("late", "surface_speed") if name in data]
    figure, axes = panels([names], PAGE, 2.8, sharex=True)
    for name, ax in axes.items():
        ax.set_prop_cycle(color=LINE_COLOURS[: study.sizes["N"]])
        for contact, style in (("unilateral", "-"), ("bilateral", "--")):
            one = data.sel(contact=contact)
            lines(ax, one[name], "Omega", doubtful=one["unsure"], doubt=UNSETTLED, ls=style)
            apart_too = one[name].where(one["outcome"] == "separation").transpose("Omega", ...)
            mark_points(ax, one["Omega"], apart_too, "ringed: separating", **RING)
    for limit, colour in zip(limits.dropna("N").values, LINE_COLOURS, strict=False):
        axes["late"].axhline(limit, color=colour, ls=":", label=lost)
    beyond = placed(height, thickness)
    axes["late"].axhspan(beyond, 10 * beyond, color=SHADE, label="beyond linear plate theory")
    larger = extent(late.sel(contact="bilateral") / apart)
    ignored = f"dashed: separation ignored, {larger} times the range"
    axes["late"].plot([], [], "--", color=BLACK, label=ignored)
    axes["late"].set_yscale("log")
    if "surface_speed" in axes:
        axes["surface_speed"].set_title("above 1, friction reverses")
        axes["surface_speed"].axhline(1, color=GREY, zorder=0)
    return figure


def extent(ratios: DataArray) -> str:
    """Least and greatest of some ratios, in two digits."""
    return f"{float(ratios.min()):.2g} to {float(ratios.max()):.2g}"


def lost_contact(study: Dataset) -> DataArray:
    """Range at which vibration loses contact at the frequency of the mode with the largest tangential
    motion, which friction feeds, along the preload, in the unit of heights; nan for another disc."""
    name = study["disc"].item() if "disc" in study else ""
    disc = stated_in(study, "discs").get(name, {})
    if "tangential" not in disc:
        return study["N"] * np.nan
    frequency = disc["omega"][np.argmax(np.abs(disc["tangential"]))] / (2 * np.pi)
    base = stated_in(study, "base")
    slider = Parameters(N=1.0, Omega=1.0, k=base["k"], m=base["m"], c=base["c"])
    of_newton = placed(study["u_max"], pinned_range(slider, frequency))
    return study["N"] * of_newton / study["N"].attrs["factor"]


@grid_figure("range_law", takes=True)
def range_law(study: Dataset, set_apart: dict[str, Finite] = NOTHING) -> Figure:
    """Excess of the range of motions with separation over the range R at which vibration at their
    frequency loses contact, against R, and enlarged against the share of time apart; hollow where no
    frequency carries most of the motion.

    set_apart : value of a parameter whose motions have marks of their own
    """
    data = study.stack(motion=[*study["deviation"].dims], create_index=False)
    data = data.isel(motion=data["deviation"].notnull().values)
    excess = data["deviation"]
    apart = data["separation_fraction"]
    range_ = data["pinned_range"]
    single = np.minimum(data["vibration_share"], data["force_share"]) >= 0.95
    inside = abs(excess) <= BAND
    band = f"within 5 %: {counted(inside[single])} filled, {counted(inside[~single])} hollow"
    model = data.coords.get(NORM, DataArray("motions")).broadcast_like(excess)
    group = model.copy(data=np.array([*map(value_text, model)], dtype=object))
    for name, value in set_apart.items():
        chosen = np.isclose(data[name], placed(data[name], value))
        group[chosen] = value_text(data[name][chosen][0])

    figure, axes = panels([["all", "apart"]], PAGE, 2.6)
    points = ((range_, excess), (apart, excess.clip(*ENLARGED)))
    for ax, (x, y) in zip(axes.values(), points, strict=True):
        for name, look in zip(np.unique(group), MARKS, strict=False):
            here = y.where(group == name)
            ax.plot(x, here.where(single), label=name, **look)
            mark_points(ax, x, here.where(~single), HOLLOW, **look)
        ax.axhspan(-BAND, BAND, color=SHADE, zorder=0, label=band)
        ax.yaxis.set_major_formatter("{x:.0%}")
        ax.set_ylabel("Excess of the range over R")
    times = np.linspace(0, np.max(apart.values, initial=0.01))
    flights = np.vectorize(excess_of_flights)(times)
    axes["apart"].plot(times, flights, color=BLACK, label="by flights: (π · time apart)²/8")
    axes["apart"].set_xlabel("Share of time apart")
    axes["all"].set(xscale="log", xlabel=f"{LIMIT} ({range_.units})")
    return figure


# ---- Uncertain parameters


@grid_figure("sensitivity", takes=True)
def sensitivity(study: Dataset) -> Figure:
    """Probability of instability in the lowest and the highest third of each parameter's values, with
    intervals of 95 %, for each point of the study; the parameters that change it most stand above."""
    points = [str(dim) for dim in study["status"].dims if dim != "sample"]
    cases = study.expand_dims("one").stack(case=["one", *points], create_index=False)
    thirds = thirds_of(cases)
    thirds = thirds.sortby(abs(thirds["share"].diff("third")).max(["case", "third"]))
    rows = np.arange(thirds.sizes["parameter"])
    failed = int((cases["cycle"] == "failed").sum())
    name = f"all {cases.sizes['sample']} samples"
    if failed:
        name += f"; {failed} in all panels failed, and do not count"
    figure, axes = row(cases.sizes["case"], 0.8 + 0.2 * rows.size)
    for i, ax in enumerate(axes):
        draw_thirds(ax, thirds.isel(case=i), rows)
        overall = float(cases["probability_unstable"][i])
        ax.axvline(overall, color=BLACK, ls="--", label=name)
        along = [each[i] for each in cases.coords.values() if each.dims == ("case",)]
        ax.set_title(", ".join(map(value_text, along)))
        ax.set(xlabel="Probability of instability", xlim=(-0.03, 1.03))
    symbols = [SHOWN[name].symbol for name in thirds["parameter"].values]
    axes[0].set_yticks(rows, [typeset(symbol) for symbol in symbols])
    return figure


def thirds_of(cases: Dataset) -> Dataset:
    """Shares of unstable samples with a parameter in its lowest and in its highest third, and the ends of
    their intervals, shape (third, case, parameter)."""
    values = cases["parameter_values"]
    low, high = (values.quantile(end, "sample", skipna=False) for end in (1 / 3, 2 / 3))
    inside = xr.concat([values <= low, values >= high], "third")
    inside &= cases["cycle"] != "failed"
    stable = cases["cycle"].isin(["stable", "steady_sliding", "at_rest"])
    counts = (inside & ~stable).sum("sample"), inside.sum("sample")
    ends = xr.apply_ufunc(np.vectorize(share), *counts, output_core_dims=[()] * 3)
    return Dataset(dict(zip(("share", "low", "high"), ends, strict=True)))


def draw_thirds(ax: Axes, thirds: Dataset, rows: Any) -> None:
    """A row for each parameter, with both shares, their intervals, and a line between them."""
    ax.hlines(rows, *thirds["share"].values, color=GREY)
    for i, (name, face) in enumerate((("lowest", "white"), ("highest", BLUE))):
        one = thirds.isel(third=i)
        up = rows + 0.24 * i - 0.12
        ax.hlines(up, one["low"], one["high"], color=BLUE, label="95 % interval")
        ax.plot(one["share"], up, "o", color=BLUE, mfc=face, label=f"{name} third of its values")
