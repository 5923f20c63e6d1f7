"""Figures of single runs: time histories, phase portraits, Poincaré sections, spectra, and films.

What they draw on axes are windows of a `shown` case, see `window_of`.
"""

from collections.abc import Iterable, Sequence
from operator import itemgetter
from typing import Annotated, Any

import numpy as np
from cmcrameri import cm
from matplotlib.animation import FuncAnimation
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from pydantic import Field
from xarray import DataArray, Dataset, DataTree

from disc_model.analysis.classify import FEWEST, first_settled
from disc_model.analysis.spectra import amplitude_spectrum, lines, time_frequency
from disc_model.data.dataset import Missing
from disc_model.disc.plate import radial_range
from disc_model.figures.draw import COLUMN, PAGE, compare, edges, frame, mark_points, panels
from disc_model.figures.looks import BLACK, GREY, OF_PHASE, OF_VARIABLE, RED, SKY, Options
from disc_model.figures.schema import Cases, Either, Recorded, Sampled, Samples, case_figure
from disc_model.figures.shown import label, value_text, window_of, words
from disc_model.parameters import Parameters
from disc_model.units import Positive, Unit

Hertz = Annotated[Positive, Unit("Hz")]


# ---- Windows of a case


def number_of(case: DataTree, name: str) -> float:
    """A number of a whole run, nan if it does not have it."""
    return float(case.dataset.get(name, np.nan))


def mark_first_separation(axes: Iterable[Axes], case: DataTree) -> None:
    """Mark the first separation on axes of time that show it."""
    first = number_of(case, "first_separation")
    for ax in axes:
        low, high = ax.get_xlim()
        if low < first < high:
            ax.axvline(
                first, color=RED, linestyle="dashed", label=f"first separation, {first:.2f} s"
            )


# ---- Histories

MOST_CHANGES = 120  # of a phase that is shaded; more would be as dense as a fill
OPACITY = {"stick": 0.22, "separation": 0.5}  # of phases behind a history


@case_figure()
def history(
    case: DataTree,
    window: Either,
    variables: Annotated[tuple[Sampled, ...], Field(min_length=1)] = ("P", "w"),
) -> Figure:
    """Variables against time, one above the other; a window with an envelope as ranges."""
    figure, axes = panels([[name] for name in variables], COLUMN, 1.2, sharex=True)
    draw_history([*axes.values()], window_of(case, window), variables)
    mark_first_separation(axes.values(), case)
    return figure


def draw_history(axes: Sequence[Axes], samples: Dataset, variables: Sequence[str]) -> None:
    """Draw variables against time, a panel for each, or their ranges, over stick and separation.
    Raises `Missing` if the window lacks one."""
    time = samples["time"]
    for ax, name in zip(axes, variables, strict=True):
        colour = OF_VARIABLE.get(name.removesuffix("_velocity"), BLACK)
        if name in samples:
            x = samples[name]
            ax.plot(time, x, color=colour)
        elif f"{name}_max" in samples:
            x = samples[f"{name}_max"]
            draw_range(ax, samples, name, color=colour)
        else:
            raise Missing(f"did not record {name} in this window")
        ax.set_ylabel(label(x))
        shade_phases(ax, samples)
    axes[-1].set_xlabel(label(time))


def draw_range(ax: Axes, samples: Dataset, name: str, **look: Any) -> None:
    """Draw the range of a variable against time, as a band that is seen where it is thin."""
    ax.fill_between(
        samples["time"], samples[f"{name}_min"], samples[f"{name}_max"], linewidth=0.5, **look
    )


def shade_phases(ax: Axes, samples: Dataset, phases: Iterable[str] = OPACITY) -> None:
    """Shade stick and separation behind a history of samples, unless they alternate too often; slip
    is left white."""
    if "phase" not in samples:
        return
    said = words(samples["phase"])
    for phase in phases:
        inside = said == phase
        if not 0 < np.diff(inside, prepend=False).sum() <= MOST_CHANGES:
            continue
        inside[1:] |= inside[:-1]  # a phase lasts up to the next sample
        ax.fill_between(
            samples["time"],
            0,
            1,
            inside,
            transform=ax.get_xaxis_transform(),
            label=phase,
            color=OF_PHASE[phase],
            alpha=OPACITY[phase],
            lw=0,
            zorder=0,
        )


# ---- Phase portraits

# of the lines of phases, which are so told apart in grey print
WIDTHS = {"slip": 0.5, "stick": 2.5, "separation": 1.2}


@case_figure()
def portrait(
    case: DataTree, window: Samples, x: Sampled = "psi", y: Sampled = "psi_velocity"
) -> Figure:
    """One variable over another, coloured by phase."""
    figure, axes = panels([["a"]], COLUMN, 2.5)
    draw_portrait(axes["a"], window_of(case, window), x, y)
    return figure


def draw_portrait(ax: Axes, samples: Dataset, x: str, y: str) -> None:
    """Draw one variable over another, coloured by phase, open where this changes."""
    for phase, width in WIDTHS.items():
        part = samples.where(samples["phase"] == phase)
        if part[x].notnull().any():
            ax.plot(
                part[x],
                part[y],
                color=OF_PHASE[phase],
                linewidth=width,
                label=phase,
                rasterized=True,
            )
    ax.set(xlabel=label(samples[x]), ylabel=label(samples[y]))


# ---- Poincaré sections

POINTS: dict[str, Options] = {
    "before the first separation": {"marker": "x", "color": SKY},
    "separated, on the way to the final motion": {"marker": "^", "color": RED, "mfc": "none"},
    "in contact, on the way to the final motion": {"marker": "o", "color": GREY, "mfc": "none"},
    "separated": {"marker": "^", "color": RED, "mfc": RED},
    "in contact": {"marker": ".", "color": BLACK, "mfc": BLACK},
}
"""Marks of the stages of a run; those of the way are light."""
SMALL: Options = {"ms": 2.5, "mew": 0.4, "rasterized": True}


@case_figure({"poincare": Recorded()})
def poincare(case: DataTree, below: Cases = ()) -> Figure:
    """The Poincaré sections of slider and disc: velocity over displacement, of the disc at r_0.

    below : further cases, each in a row of its own on the same axes
    """
    cases = [case, *dict(below).values()]
    layout = np.arange(2 * len(cases)).reshape(-1, 2)
    figure, axes = panels(layout.tolist(), PAGE, 2.4)
    rows: Any = np.reshape([*axes.values()], layout.shape)
    for row, each in zip(rows, cases, strict=True):
        draw_sections(row, each)
        values = [value_text(each[name]) for name in ("N", "Omega")]
        row[0].set_title(", ".join([*values, *fate_of(each)]))
        if "h" in each:  # of a plate
            row[1].set_title(f"disc of thickness {value_text(each['h'])}")
    for column in rows.T:
        compare(column)
    return figure


def draw_sections(axes: Sequence[Axes], case: DataTree, name: str = "poincare") -> None:
    """Draw the section of the slider and that of the disc, in marks of the stages of a run.

    Light: before the first separation, and on the way to the final motion, if its start is known.
    """
    samples = window_of(case, name)
    first = number_of(case, "first_separation")
    final = final_since(case, samples)
    separated = samples["phase"] == "separation"
    on_the_way = samples["time"] < final
    conditions = [samples["time"] < first, separated & on_the_way, on_the_way, separated]
    *stages, usual = POINTS
    stage = np.select(conditions, stages, usual)
    known = {"final motion": final, "after the first separation": first}
    said = next((f", {text}" for text, time in known.items() if np.isfinite(time)), "")
    for ax, variable in zip(axes, ("psi", "w_point"), strict=True):
        x = samples[variable]
        y = samples[f"{variable}_velocity"]
        for text, look in POINTS.items():
            name = text + said * (text == usual)
            mark_points(ax, x, y.where(stage == text), name, **look, **SMALL)
        ax.set(xlabel=label(x), ylabel=label(y))


def final_since(case: DataTree, section: Dataset) -> float:
    """Time since when all points of a section lie on the motion on which a run ends, s: since when it
    is shown to have settled or, after a first separation, since when they lie on the set of the later
    half of those after it; nan if the last quarter does not cover this set, or nothing is known."""
    settled = number_of(case, "settled_since")
    after = section.sel(time=section["time"] >= number_of(case, "first_separation"))
    if np.isfinite(settled) or after.sizes["time"] < FEWEST:
        return settled
    names = [f"{name}{of}" for name in ("psi", "w_point") for of in ("", "_velocity")]
    points = after[names].to_array().values.T
    half = len(points) // 2
    if first_settled(points, half) > half:
        return np.nan
    return float(after["time"][first_settled(points)])


def fate_of(case: DataTree, name: str = "poincare") -> list[str]:
    """What a run comes to, in words: its first separation, and since when its section, by its name,
    shows the final motion."""
    first = number_of(case, "first_separation")
    since = final_since(case, window_of(case, name))
    fate = f"first separation at {first:.2f}\u00a0s"
    if np.isnan(first):
        fate = "no separation"
        if Parameters.model_validate_json(case.attrs["parameters"]).contact == "bilateral":
            fate = "separation ignored"
    if np.isnan(since):
        return [fate, "settling not shown here"]
    return [fate, f"final motion since {since:.0f}\u00a0s"]


# ---- Spectra


@case_figure()
def spectrum(
    case: DataTree, window: Samples, variable: Sampled = "w_point", highest: Hertz | None = None
) -> Figure:
    """Amplitude of a variable over the frequency, in the whole of a window.

    highest : highest frequency shown, Hz; without it up to where the lines end
    """
    figure, axes = panels([["a"]], COLUMN, 2.4)
    draw_spectrum(axes["a"], window_of(case, window), variable, highest, color=BLACK)
    return figure


def draw_spectrum(
    ax: Axes, samples: Dataset, variable: str, highest: float | None = None, **look: Any
) -> None:
    """Draw amplitudes up to a frequency (Hz), or to where the lines end, with the frequencies of the
    strongest; raises `Missing` if there are none."""
    x = samples[variable]
    signal = samples["time"].values, x.values
    found = lines(*signal, below=highest or np.inf, floor=0.01)
    if not found:
        raise Missing("did not vibrate, or too briefly to tell")
    end = highest or 1.15 * found[-1].frequency
    apart = lines(*signal, below=end, apart=end / 12)
    for line in sorted(apart, key=itemgetter(1))[-5:]:
        ax.text(*line, f"{line.frequency:.1f}", ha="center", va="bottom", fontsize=6)
    ax.semilogy(*amplitude_spectrum(*signal), **look)
    x.attrs["long_name"] += ", amplitude"
    ax.set(xlabel="Frequency (Hz)", ylabel=label(x))
    ax.set(xlim=(0, end), ylim=(1e-5 * line.amplitude, 4 * line.amplitude))


def levels_of(windows: Sequence[Dataset], variable: str) -> list[DataArray]:
    """Power of a variable in windows over frequency (Hz) and time, in dB below the strongest line of
    all; raises `Missing` if one is too short."""
    try:
        found = [time_frequency(each["time"].values, each[variable].values) for each in windows]
    except ValueError as error:
        raise Missing(f"recorded too little: {error}") from None
    strongest = max(float(each.power.max()) for each in found) or 1.0
    return [
        DataArray(
            10 * np.log10(each.power / strongest + 1e-30),
            {
                "frequency": (
                    "frequency",
                    each.frequency,
                    {"long_name": "Frequency", "units": "Hz"},
                ),
                "time": ("time", each.time, {"long_name": "Time", "units": "s"}),
            },
            attrs={"long_name": "Power", "units": "dB re strongest line"},
        )
        for each in found
    ]


def draw_spectrogram(ax: Axes, level: DataArray, highest: float) -> Any:
    """Draw levels of power up to a frequency, Hz; returns the mesh, for a bar."""
    part = level.sel(frequency=slice(0, highest))
    ends = [*edges(part["time"])[[0, -1]], *edges(part["frequency"])[[0, -1]]]
    look: Options = {"extent": ends, "origin": "lower", "interpolation": "nearest"}
    mesh = ax.imshow(part, cm.lipari, Normalize(-100, 0), aspect="auto", **look)
    frame(ax, part)
    return mesh


# ---- The whole disc


def draw_disc(ax: Any, w: DataArray, norm: Any, levels: Any = ()) -> Any:
    """Draw the disc from above on polar axes: blue below its plane at rest, where lines of equal
    deflection are dashed, and red above it. Returns the mesh, for a bar.

    w : deflection over r (m) and theta (rad), in the unit of `norm`
    levels : of these lines; if not given, twelfths of the scale
    """
    grid = w["theta"], w["r"]
    mesh = ax.pcolormesh(*grid, w, cmap=cm.vik, norm=norm, shading="gouraud", rasterized=True)
    levels = levels or np.linspace(norm.vmin, norm.vmax, 13)
    ax.contour(*grid, w, levels, colors=BLACK, linewidths=0.5)
    ax.set(ylim=(0, w["r"].max()), yticks=[], xticks=[0], xticklabels=["θ = 0"])
    return mesh


def mark_slider(ax: Axes, x: float, y: float, phase: str) -> None:
    """Mark the slider in the colour of its phase."""
    ax.plot(
        x,
        y,
        "s",
        markersize=5,
        markerfacecolor=OF_PHASE[phase],
        markeredgecolor=BLACK,
        label=f"slider, {phase}",
    )


def animate(case: Parameters, states: Sequence[Any], samples: Dataset) -> FuncAnimation:
    """A film of the disc from above, in mm, and of the contact force.

    states : of the pictures, in time
    samples : shown window that covers them
    """
    from disc_model.simulation.states import deflection

    r = np.linspace(*radial_range(case), 25)
    w = 1e3 * deflection(case, states, r, np.linspace(0, 2 * np.pi, 181))
    end = float(abs(w).max()) or 1.0
    figure, axes = panels(
        [["disc", "force"]], PAGE, 2.6, per_subplot_kw={"disc": {"projection": "polar"}}
    )
    disc, force = axes.values()

    def draw(i: int) -> list[Axes]:
        state = states[i]
        disc.cla()
        draw_disc(disc, w[i], Normalize(-end, end))
        mark_slider(disc, state.material_angle(case), case.r_0, state.phase)
        force.cla()
        draw_history([force], samples, ["P"])
        force.axvline(state.time, color=RED)
        force.set_title(f"{state.time:.4f} s, {state.phase}")
        return []

    return FuncAnimation(figure, draw, frames=len(states))
