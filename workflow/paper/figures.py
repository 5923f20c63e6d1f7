"""The paper's figures, from named cases, and some from studies: kinds such as ``paper.response``."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.image import imread
from matplotlib.patheffects import withStroke
from pydantic import Field
from xarray import DataArray, Dataset, DataTree

from disc_model.data.dataset import Missing
from disc_model.data.variables import stated_in, values_text
from disc_model.disc.modes import plate_modes
from disc_model.disc.plate import mode_shapes, modes_at_point
from disc_model.figures.draw import COLUMN, PAGE, bar_of, class_map, compare, panels
from disc_model.figures.looks import BLACK, BLUE, GREY, ORANGE, PAPER, RED, SKY, Look
from disc_model.figures.runs import (
    draw_disc,
    draw_history,
    draw_range,
    draw_spectrogram,
    levels_of,
    mark_first_separation,
    mark_slider,
    number_of,
    shade_phases,
)
from disc_model.figures.schema import (
    IN_FULL,
    IN_TIME,
    Case,
    Cases,
    InTime,
    Ranges,
    Role,
    Sampled,
    Samples,
    case_figure,
    grid_figure,
)
from disc_model.figures.shown import label, placed, value_text, window_of, words
from disc_model.parameters import Parameters
from disc_model.units import Finite, Positive, Unit

Seconds = Annotated[Positive, Unit("s")]
Span = tuple[float, float]
HIGHEST = 1000.0  # frequency shown, Hz
MODEL = Path(__file__).with_name("figures_model.png")


# ---- Parts of figures


def ranges_of(case: DataTree, name: str, until: float | None = None) -> Dataset:
    """Ranges in a window, up to a time in s; raises `Missing` without two."""
    shown = window_of(case, name).sel(time=slice(None, until))
    if shown.sizes["time"] < 2:
        raise Missing(f"has no ranges in {name} up to {until:g} s")
    return shown


def after(samples: Dataset, start: float) -> Dataset:
    """A window with times in ms after one in s."""
    changed = samples.assign_coords(time=1e3 * (samples["time"] - start))
    changed["time"].attrs = {"long_name": f"Time after {start:.9g} s", "units": "ms"}
    return changed


def separations(samples: Dataset) -> list[Span]:
    """Times of the first and the last sample of each separation in a window, s, with those that the
    window cuts off."""
    time = samples["time"].values.tolist()
    apart = words(samples["phase"]) == "separation"
    changes = np.diff(apart.astype(int), prepend=0, append=0)
    firsts, ends = np.flatnonzero(changes == 1), np.flatnonzero(changes == -1)
    return [(time[first], time[end - 1]) for first, end in zip(firsts, ends, strict=True)]


def first_complete(samples: Dataset) -> Span | None:
    """The first separation that begins and ends inside a window."""
    first, last = samples["time"].values[[0, -1]]
    inside = [span for span in separations(samples) if first < span[0] and span[1] < last]
    return next(iter(inside), None)


def name_of_case(case: DataTree) -> str:
    """Preload and speed of a case."""
    return ", ".join(value_text(case.dataset[name]) for name in ("N", "Omega"))


def draw_displacements(ax: Axes, case: DataTree, samples: Dataset) -> None:
    """Draw displacements of disc and slider from static equilibrium."""
    rest = placed(samples["u"], number_of(case, "u_0"))
    for name, x, colour, style in (
        ("disc", "w", BLUE, "-"),
        ("slider", "u", ORANGE, (0, (4, 1.5))),
    ):
        ax.plot(samples["time"], samples[x] - rest, color=colour, ls=style, label=name)
    ax.set_ylabel(f"Displacement ({samples['u'].attrs['units']})")
    shade_phases(ax, samples, ["separation"])
    mark_thickness(ax, case, samples["w"])


def mark_thickness(ax: Axes, case: DataTree, w: DataArray) -> None:
    """Draw a bar as long as the disc is thick beside an axis of its displacement, if it finds room:
    plate theory is linear for less only."""
    h = case["h"]
    thickness = placed(w, float(h) / h.attrs["factor"])
    low, high = ax.get_ylim()
    if not thickness < 0.8 * (high - low):
        return
    look: dict[str, Any] = {"color": BLACK, "lw": 2.5, "solid_capstyle": "butt", "clip_on": False}
    text = f"thickness {thickness:g} {w.attrs['units']}"
    beside = ax.get_yaxis_transform()
    ax.plot([1.02, 1.02], [low, low + thickness], transform=beside, **look)
    ax.text(1.03, low, text, transform=beside, rotation="vertical", fontsize=6)


def mark_printed(ax: Axes, time: float | None) -> None:
    """Mark a time that the paper prints at the lower edge of a panel."""
    low, high = ax.get_xlim()
    if time is None or not low <= time <= high:
        return
    look: dict[str, Any] = {"ls": "", "marker": "^", "ms": 6, "clip_on": False, **PAPER}
    ax.plot(time, 0, transform=ax.get_xaxis_transform(), label=f"paper: {time:g} s", **look)


# ---- Contact force and displacements


@case_figure()
def contact_force(case: DataTree, history: Ranges = "history", zoom: Samples = "zoom") -> Figure:
    """(a) Range of the contact force over the run, (b) the contact force in a window of samples."""
    figure, axes = panels([["run", "zoom"]], PAGE, 2.3)
    draw_history([axes["run"]], ranges_of(case, history), ["P"])
    mark_first_separation([axes["run"]], case)
    samples = window_of(case, zoom)
    draw_history([axes["zoom"]], after(samples, float(samples["time"][0])), ["P"])
    return figure


@case_figure()
def one_separation(
    case: DataTree, zoom: Samples = "zoom", lasting: Seconds | None = None
) -> Figure:
    """(a) Displacements from static equilibrium around the first complete separation of a window,
    (b) the gap.

    lasting : length of what is shown, from a tenth of it before the separation; if not given, half of the
        separation before and after it
    """
    layout = [["both"], ["gap"]]
    figure, axes = panels(layout, COLUMN, 1.5, sharex=True, height_ratios=(2, 1))
    samples = window_of(case, zoom)
    complete = first_complete(samples)
    if complete is None:
        raise Missing(f"has no complete separation in {zoom}")
    start, stop = complete
    margin = 0.5 * (stop - start)
    ends = (start - margin, stop + margin)
    if lasting is not None:
        ends = (start - 0.1 * lasting, start + 0.9 * lasting)
    part = after(samples.sel(time=slice(*ends)), start)
    draw_displacements(axes["both"], case, part)
    gap = 1e6 * (part["u"] - part["w"]) / part["u"].attrs["factor"]
    axes["gap"].plot(part["time"], gap, color=BLACK)
    shade_phases(axes["gap"], part, ["separation"])
    axes["gap"].set(xlabel=label(part["time"]), ylabel="Gap (μm)")
    return figure


# ---- Whole runs

WITH_AND_WITHOUT = ("with separation", "separation ignored")
"""Labels of a case and of the one in which separation is ignored."""


@case_figure()
def with_and_without(case: DataTree, ignored: Case, history: Ranges = "history") -> Figure:
    """Range of the disc at r_0 and a fixed angle over the run, with separation and, in the case
    `ignored`, without."""
    figure, axes = panels([["a"]], COLUMN, 2.4)
    draw_both(axes["a"], case, ignored, history)
    return figure


def draw_both(
    ax: Axes,
    case: DataTree,
    ignored: DataTree,
    name: str,
    until: float | None = None,
    labels: tuple[str, str] = WITH_AND_WITHOUT,
) -> None:
    """Draw the range of the disc in a case over that in another."""
    followed = ranges_of(case, name, until)
    without = ranges_of(ignored, name, float(followed["time"][-1]))
    draw_range(ax, without, "w_point", color="0.6", label=labels[1])
    draw_range(ax, followed, "w_point", color=BLUE, label=labels[0])
    shown = followed["w_point_max"]
    ax.set(xlabel=label(followed["time"]), ylabel=label(shown))
    mark_first_separation([ax], case)
    mark_thickness(ax, case, shown)


@case_figure()
def histories(
    case: DataTree,
    beside: Cases = (),
    history: Ranges = "history",
    until: Seconds | None = None,
    printed: Seconds | None = None,
) -> Figure:
    """Ranges of the contact force and of the disc at r_0 and a fixed angle, a column for each case,
    on common axes.

    until : end of the part of the runs that is shown
    printed : first separation of the last case that the paper prints
    """
    cases = [case, *dict(beside).values()]
    rows = [[f"{name} {i}" for i in range(len(cases))] for name in ("P", "w_point")]
    figure, axes = panels(rows, PAGE, 1.7, sharex=True)
    for column, each in zip(zip(*rows, strict=True), cases, strict=True):
        samples = ranges_of(each, history, until)
        force, disc = (axes[name] for name in column)
        draw_history([force, disc], samples, ["P", "w_point"])
        low, high = float(samples["P_min"].min()), float(samples["P_max"].max())
        force.set_title(f"{name_of_case(each)}, P from {low:.0f} to {high:.0f} N")
        mark_first_separation([force, disc], each)
    for row in rows:
        compare([axes[name] for name in row])
    for name, each in zip(rows[1], cases, strict=True):
        mark_thickness(axes[name], each, samples["w_point_max"])
    mark_printed(force, printed)
    for ax in axes.values():
        ax.label_outer()
    return figure


@case_figure()
def composite(
    case: DataTree,
    ignored: Case,
    force: tuple[str, Finite],
    until: Seconds,
    history: Ranges = "history",
    labels: tuple[str, str] = WITH_AND_WITHOUT,
) -> Figure:
    """(a) The model, (b) the disc's vibration and that in the case `ignored`, by their labels,
    (c) the contact force in 40 ms.

    force : window of the contact force, and the time at which the stretch shown begins, s
    until : end of the part of the runs that (b) shows
    """
    layout = [["model", "growth", "force"]]
    figure, axes = panels(layout, PAGE, 2.5, width_ratios=(1, 1.15, 1.3))
    axes["model"].imshow(imread(MODEL))
    axes["model"].set_axis_off()
    draw_both(axes["growth"], case, ignored, history, until, labels)
    draw_look(axes["force"], case, force, 0.04, "P")
    axes["force"].set_ylim(bottom=0)
    return figure


def draw_look(ax: Axes, case: DataTree, place: tuple[str, float], length: float, name: str) -> None:
    """Draw a variable in a stretch of a window that begins at a place, with a length in s; raises
    `Missing` without samples there."""
    window, start = place
    part = window_of(case, window).sel(time=slice(start, start + length))
    if part.sizes["time"] < 2:
        raise Missing(f"has no samples from {start:g} s on")
    draw_history([ax], after(part, start), [name])
    ax.set_xlim(0, 1e3 * length)


# ---- The whole disc

AROUND = 9
"""Windows at as many angles, from which the whole disc is made."""
STYLES = ("-", "--", "-.", ":")


@case_figure({f"around{i}": IN_FULL for i in range(AROUND)})
def instants(case: DataTree) -> Figure:
    """The disc from above, and along its circle of radius r_0, at four instants from the first loss
    of contact to the next, or over the whole stretch without two losses, by nine windows `around0`,
    ..."""
    names = [*"abcd"]
    polar: dict[str, Any] = {"per_subplot_kw": {tuple(names): {"projection": "polar"}}}
    figure, axes = panels([names, ["circle"] * 4], PAGE, 2.0, height_ratios=(1.1, 1), **polar)
    p = Parameters.model_validate_json(case.attrs["parameters"])
    samples = window_of(case, "around0")
    time = samples["time"].values
    losses = [first for first, _ in separations(samples) if first > time[0]]
    first, last = losses[:2] if len(losses) > 1 else time[[0, -1]]
    moments = samples.sel(time=first + 0.25 * (last - first) * np.arange(4), method="nearest")
    w = deflection_around(case, p, moments["time"])
    end = float(abs(w).max())
    for i, (name, style) in enumerate(zip(names, STYLES, strict=True)):
        state = moments.isel(time=i)
        angle = float(p.Omega * state["time"] - state["psi"])
        phase = str(state["phase"].item())
        mesh = draw_disc(axes[name], w[i], Normalize(-end, end))
        mark_slider(axes[name], angle, p.r_0, phase)
        text = f"{1e3 * float(state['time'] - first):.1f} ms"
        axes[name].set_title(f"{text}, {phase}")
        around = w[i].sel(r=p.r_0).assign_attrs(long_name="Deflection at $r_0$")
        axes["circle"].plot(w["theta"], around, color=BLUE, ls=style, label=f"disc, {text}")
        mark_slider(axes["circle"], angle % (2 * np.pi), float(state["u"]), phase)
    bar_of(figure, [axes[name] for name in names], mesh, w)
    axes["circle"].set(xlabel="Angle θ (rad)", ylabel=label(around), xlim=(0, 2 * np.pi))
    axes["circle"].set_title(name_of_case(case))
    mark_thickness(axes["circle"], case, samples["w_point"])
    return figure


def deflection_around(case: DataTree, p: Parameters, time: DataArray) -> DataArray:
    """Deflection of the disc over time, r and theta, by windows at as many angles as determine the
    harmonics that modes without nodal circles are, in the unit of these; raises `Missing` if they do
    not."""
    from workflow.paper.energy import waves  # with what simulates, which other figures do without

    windows = [window_of(case, f"around{i}") for i in range(2 * p.n_diameters + 1)]
    if p.n_circles:
        raise Missing("has modes with nodal circles, which a circle of points does not tell apart")
    angles = np.array([window.attrs["theta"] for window in windows])
    values = np.array([window["w_point"].sel(time=time).values for window in windows])
    amplitudes = np.linalg.solve(waves(angles, p.n_diameters).T, values)

    radii = np.sort([*np.linspace(p.a, p.b, 25), p.r_0])
    theta = np.linspace(0, 2 * np.pi, 181)
    shapes = mode_shapes(p, radii) / modes_at_point(p).psi[:, None]
    both = np.vstack([shapes, shapes[1:]])  # cosines, and sines without that of order 0
    w = np.einsum("jt,jr,ja->tra", amplitudes, both, waves(theta, p.n_diameters))
    unit = {"long_name": "Deflection", "units": windows[0]["w_point"].attrs["units"]}
    coordinates = {"time": time.values, "r": radii, "theta": theta}
    return DataArray(w, coordinates, ("time", "r", "theta"), attrs=unit)


# ---- Spectra in time

STRETCHES = ("spectrum_a", "spectrum_b", "spectrum_c", "spectrum_d")
CLOSE = 300.0
"""Highest frequency of the closer view, Hz."""
TABLE_2 = {
    r"$f_\Omega$": (2.4,),
    "$f_{h1}$, $f_{h2}$:\n$f_s ∓ f_\\Omega$": (65.5, 70.0),
    "$f_1$, $f_2$:\n$2f_s ∓ f_\\Omega$": (133.0, 138.0),
    "$f_3$, $f_4$:\n$3f_s ∓ f_\\Omega$": (200.0, 206.0),
    "$f_5$, $f_6$:\n$4f_s ∓ f_\\Omega$": (269.0, 273.0),
}
"""Lines of the paper, Hz, by their components; pairs are too close for separate names."""


@case_figure(dict.fromkeys(STRETCHES[1:], IN_TIME))
def four_stretches(
    case: DataTree, ignored: Case, history: Ranges = "history", until: Seconds | None = None
) -> Figure:
    """Range of the disc at r_0 and a fixed angle, and its power over time and frequency in four
    stretches, with the lines of Table 2. The last row is the bilateral case `ignored`, which has
    the same windows but the first, as separation comes later.

    until : end of the part of the run that is shown
    """
    high, low = ([f"{row} {name}" for name in STRETCHES] for row in ("high", "low"))
    below = [f"ignored {name}" for name in STRETCHES[1:]]
    layout = [["run"] * 4, high, low, [".", *below]]
    figure, axes = panels(layout, PAGE, 1.5, height_ratios=(1.2, 1, 1.5, 1.5))
    draw_history([axes["run"]], ranges_of(case, history, until), ["w_point"])
    recorded = [window_of(case, name) for name in STRETCHES]
    recorded += [window_of(ignored, name) for name in STRETCHES[1:]]
    levels = levels_of(recorded, "w_point")
    rows = (
        (high, case, levels[:4], (CLOSE, HIGHEST), "with separation"),
        (low, case, levels[:4], (0.0, CLOSE), "with separation"),
        (below, ignored, levels[4:], (0.0, CLOSE), "separation ignored"),
    )
    for names, each, shown, limits, text in rows:
        for name, level in zip(names, shown, strict=True):
            mesh = draw_spectrogram(axes[name], level, HIGHEST)
            axes[name].set_ylim(limits)
            mark_first_separation([axes[name]], each)
        axes[names[0]].set_title(text)
    for level, letter in zip(levels, "bcde", strict=False):
        mark_interval(axes["run"], level, letter)
    mark_first_separation([axes["run"]], case)
    mark_thickness(axes["run"], case, recorded[0]["w_point"])
    name_lines(axes[low[-1]])
    spectra = [axes[name] for name in (*high, *low, *below)]
    for name in (*high, *low[1:], *below[1:]):
        axes[name].label_outer()
    bar_of(figure, spectra, mesh, levels[0])
    return figure


def mark_interval(ax: Axes, level: DataArray, letter: str = "b") -> None:
    """Mark the interval of a spectrum in time on the history of its run, with the letter of its
    panel."""
    ends = level["time"].values[[0, -1]]
    ax.text(ends.mean(), 1, f"({letter})", transform=ax.get_xaxis_transform(), ha="center")
    ax.axvspan(*ends, color=SKY, alpha=0.4, lw=1, zorder=3, label="intervals of the spectra")


def name_lines(ax: Axes) -> None:
    """Name the lines of Table 2 beside a panel; names keep clear of the ticks of single lines."""
    names = ax.secondary_yaxis("right")
    names.set_yticks([float(np.mean(pair)) for pair in TABLE_2.values()], labels=list(TABLE_2))
    names.set_yticks([line for pair in TABLE_2.values() for line in pair], minor=True)
    names.tick_params(length=0, pad=7)
    names.tick_params(which="minor", length=3, width=0.6)


@case_figure()
def response(  # noqa: PLR0913
    case: DataTree,
    variable: Sampled,
    window: InTime,
    ignored: Case = None,
    history: Ranges = "history",
    zooms: Annotated[tuple[tuple[str, Finite], ...], Field(max_length=2)] = (),
    highest: bool = False,
    until: Seconds | None = None,
    printed: Seconds | None = None,
) -> Figure:
    """(a) Range over the run, with closer looks below it if there are any, (b) spectrum in time in
    a window.

    ignored : the case with bilateral contact, whose spectrum is drawn below
    zooms : windows, and where looks of 0.2 s begin, s
    highest : whether the disc's highest natural frequency is marked
    until : end of the part of the run that (a) shows
    printed : time of the first separation that the paper prints
    """
    cases = {"with separation": case}
    if ignored is not None:
        cases["separation ignored"] = ignored
    looks = {0: ["run", "run"], 1: ["c", "c"], 2: ["c", "d"]}[len(zooms)]
    layout = [["run"] * 2 + ["with separation"] * 2, looks + [[*cases][-1]] * 2]
    height = 1.9 if zooms or ignored is not None else 1.3
    figure, axes = panels(layout, PAGE, height)
    samples = ranges_of(case, history, until)
    draw_history([axes["run"]], samples, [variable])
    interval = draw_spectra(figure, axes, cases, window, variable)
    for name, place in zip("cd", zooms, strict=False):
        draw_look(axes[name], case, place, 0.2, variable)
    if len(zooms) > 1:
        compare([axes["c"], axes["d"]])
        axes["d"].label_outer()
    if highest:
        mark_highest(axes["with separation"], case)
    mark_interval(axes["run"], interval)
    mark_first_separation([axes["run"]], case)
    mark_printed(axes["run"], printed)
    if variable == "w_point":
        mark_thickness(axes["run"], case, samples["w_point_max"])
    return figure


def draw_spectra(
    figure: Figure,
    axes: Mapping[str, Axes],
    cases: Mapping[str, DataTree],
    window: str,
    variable: str,
) -> DataArray:
    """Draw the spectra in time of cases in panels of their names, with a bar; returns the first."""
    levels = levels_of([window_of(each, window) for each in cases.values()], variable)
    for (name, case), level in zip(cases.items(), levels, strict=True):
        mesh = draw_spectrogram(axes[name], level, HIGHEST)
        mark_first_separation([axes[name]], case)
        if len(cases) > 1:
            axes[name].set_title(name)
    bar_of(figure, [axes[name] for name in cases], mesh, levels[0])
    return levels[0]


def mark_highest(ax: Axes, case: DataTree) -> None:
    """Mark the disc's highest natural frequency."""
    p = Parameters.model_validate_json(case.attrs["parameters"])
    natural = float(np.max(plate_modes(p)["omega"])) / (2 * np.pi)
    text = f"highest natural frequency, {natural:.0f}\u00a0Hz"
    ax.axhline(natural, color=SKY, lw=1.0, ls=(0, (1, 1)), label=text)


# ---- Both normalisations

SCALES = ("as_published", "orthonormal")
MARKS: dict[str, dict[str, Any]] = {
    "as_published": {"label": "as published", "color": RED},
    "orthonormal": {"label": "by Eq. (17)", "color": BLUE, "mfc": "white"},
}
CELLS = {
    "neither": Look("separates with neither", "#ffffff"),
    "published": Look("separates only as published", "#f2b69c"),
    "orthonormal": Look("separates only by Eq. (17)", "#d5e5f3", 4 * "\\"),
    "both": Look("separates with both", "#8a8a8a"),
}
"""With which normalization the static start separates. They differ in grey print."""
RIGHT_OF = ("Fig. 2", "Fig. 7")
"""Marks whose names stand on their right."""
Regions = Annotated[Dataset, Role("regions", required=True)]


@grid_figure("regions", needs=("N", "Omega"), takes=True)
def scales(
    study: Dataset, map_D_star: Regions, map_c_p: Regions, map_k_p: Regions, map_m: Regions
) -> Figure:
    """(a) Squared amplitudes under the slider, (b) where the static start separates on the map over
    speed and preload, (c) first separations on this and further maps."""
    from workflow.paper import section2  # with all measures, which other figures do without

    layout = [["amplitudes", "regions", "times"]]
    figure, axes = panels(layout, PAGE, 2.6, width_ratios=(0.8, 1.25, 1.2))
    maps = {"map_N": study, "map_D_star": map_D_star, "map_c_p": map_c_p, "map_k_p": map_k_p}
    points = section2.separating_points({**maps, "map_m": map_m})
    draw_amplitudes(axes["amplitudes"], section2.BASE)
    draw_regions(axes["regions"], study, points)
    draw_times(axes["times"], points, section2.first_separations(points))
    return figure


def draw_amplitudes(ax: Axes, base: Parameters) -> None:
    """Draw the squared amplitudes of the modes with both normalizations."""
    squares = {}
    for scale, look in MARKS.items():
        modes = plate_modes(base.replace(normalization=scale))
        squares[scale] = modes["psi"].to_numpy() ** 2
        ax.plot(modes["diameters"], squares[scale], "o", ms=5, **look)
    published, orthonormal = (float(squares[scale][1]) for scale in SCALES)
    ax.set_title(f"ratio {published / orthonormal:.0f} at l = 1")
    ax.set(yscale="log", xlabel="Nodal diameters l", xticks=range(5))
    ax.set_ylabel(r"Amplitude under the slider $\Psi_l^2$ (1/kg)")
    ax.margins(x=0.12)


def draw_regions(ax: Axes, study: Dataset, points: Mapping[str, Dataset]) -> None:
    """Draw with which normalization the static start separates, and the paper's cases, each in the
    colour of its own outcome."""
    outcome = study["outcome"].sel(normalization=[*SCALES]).transpose("normalization", "N", "Omega")
    class_map(ax, outcome[0].copy(data=separates_with(outcome)), CELLS)
    for name, point in points.items():
        if not {"N", "Omega"} <= {*point.coords}:  # on another map
            continue
        place = (float(point["Omega"]), float(point["N"]))
        face = CELLS[str(separates_with(point["outcome"]))].face
        ax.plot(*place, "o", ms=5, mfc=face, color=BLACK, clip_on=False)
        sides = {True: (5, "left"), False: (-5, "right")}
        shift, side = sides[name in RIGHT_OF]
        halo = {"path_effects": [withStroke(linewidth=1.5, foreground="white")]}
        at: dict[str, Any] = {"textcoords": "offset points", "ha": side, "va": "center", **halo}
        ax.annotate(name, place, (shift, 0), fontsize=7, **at)


def separates_with(outcome: DataArray) -> np.ndarray:
    """The class, see `CELLS`, of each point of outcomes whose first dimension is `SCALES`."""
    published, orthonormal = words(outcome.sel(normalization=[*SCALES])) == "separation"
    said = np.where(published, "published", "neither")
    said = np.where(orthonormal, "orthonormal", said)
    return np.where(published & orthonormal, "both", said)


def draw_times(ax: Axes, points: Mapping[str, Dataset], firsts: Any) -> None:
    """Draw the first separation with both normalizations, a row for each figure of the paper; an
    arrow up to the horizon of the map where there is none by Eq. (17)."""
    firsts = firsts.sort_values("as_published", ascending=False)
    lost = int(firsts["orthonormal"].isna().sum())
    text = f"none by Eq. (17) up to the horizon, {lost} of {len(firsts)}"
    for height, (name, row) in enumerate(firsts.iterrows()):
        was, now = (float(row[scale]) for scale in SCALES)
        for time, look in zip((was, now), MARKS.values(), strict=True):
            ax.plot([time], [height], "o", ms=5, **look)
        if np.isnan(now):
            now = max(float(stated_in(points[str(name)], "options")["horizon"]), 1.2 * was)
            ax.plot([now], [height], ">", ms=4, color=GREY, label=text)
        ax.plot([was, now], [height, height], color=GREY, lw=1, zorder=0)
    ax.set(xscale="log", xlabel="First separation (s)")
    ax.set_yticks(range(len(firsts)), [*firsts.index])
    ax.margins(x=0.06)


# ---- Motions of a plate that stretches

MOTIONS: dict[tuple[str, str], tuple[str, float, dict[str, Any]]] = {
    ("none", "static"): ("linear, from rest", -0.15, {"marker": "s", "color": ORANGE}),
    ("none", "displaced"): ("linear, after a blow", 0.15, {"marker": "D", "color": ORANGE}),
    ("clamped", "static"): ("stretches, from rest", -0.15, {"marker": "o", "color": BLUE}),
    ("clamped", "displaced"): ("stretches, after a blow", 0.15, {"marker": "^", "color": BLUE}),
}
"""Plates and starts: their names, places in a row, and marks."""


@grid_figure("range_law", takes=True)
def stretched_ranges(study: Dataset) -> Figure:
    """Range of motions over the range R at which vibration at their frequency loses contact, on the
    linear plate and on one that stretches, from rest and after a blow: one row for each case, one
    panel for each normalisation; filled where contact is lost."""
    (along,) = study["N"].dims
    panel_names = dict.fromkeys(study["normalization"].values.tolist())
    figure, axes = panels([[*panel_names]], PAGE, 2.6)
    for name, ax in axes.items():
        part = study.isel({along: (study["normalization"] == name).values})
        rows = np.arange(part.sizes[along])
        for (stretching, begin), (text, shift, look) in MOTIONS.items():
            motion = part.sel(stretching=stretching, begin=begin)
            ratio = (motion["range"] / motion["pinned_range"]).values
            lost = (motion["separation_rate"] > 0).values
            ax.plot(ratio[lost], rows[lost] + shift, label=text, ls="", **look)
            ax.plot(ratio[~lost], rows[~lost] + shift, mfc="white", ls="", **look)
        ax.axvline(1, color=BLACK, lw=0.8, ls="--", label="range R at which contact is lost")
        ax.set(
            xscale="log", xlabel="Range / R", title=value_text(part[along][:1]["normalization"][0])
        )
        ax.set_yticks(rows, [_row_name(part.isel({along: i})) for i in rows])
        ax.invert_yaxis()
    return figure


def _row_name(point: Dataset) -> str:
    """Preload and speed of a motion, and what differs from Table 1."""
    values = {}
    for name in ("D_star", "c_p", "k_p", "m"):
        values[name] = round(point[name].item() / point[name].attrs["factor"], 12)
    text = f"{point['N'].item():g} N, {point['Omega'].item():g} rad/s, {values_text(values)}"
    return text.removesuffix(", ")
