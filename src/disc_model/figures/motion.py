"""Histories, phase portraits, Poincaré sections, spectra and spectrograms: of a study's cases, and
of a `Result`; and pictures of the whole disc."""

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import Annotated, Any, Literal, NamedTuple, Self

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from pydantic import Field

from disc_model.analysis.classify import first_settled, settling, stages
from disc_model.analysis.spectra import (
    RESOLVED,
    TimeFrequency,
    amplitude_spectrum,
    highest_line,
    lines,
    time_frequency,
)
from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.data.variables import PHASES, flag_names, values_text
from disc_model.disc.plate import mode_arrays, mode_shapes, radial_range
from disc_model.errors import Fault
from disc_model.figures import drawing
from disc_model.figures.drawing import (
    BLACK,
    GREY,
    PAGE,
    SEPARATED,
    Artist,
    Axes,
    Figure,
    Normalize,
    cm,
    mpl,
    panels,
)
from disc_model.figures.kind import HIGHEST, CasePlot, Need, Recorded, Sampled, Samples, as_spectrum
from disc_model.figures.legends import figure_legend
from disc_model.figures.phases import spans_in
from disc_model.parameters import Parameters
from disc_model.simulation.case import Window
from disc_model.units import Positive, Unit

Array = NDArray[np.float64]

# ---- Histories
RANGES = (
    "P",
    "u",
    "w",
    "w_point",
    "psi",
    "psi_velocity",
)  # variables that a window with an envelope stores
MOST_SHADED = (
    60  # largest number of stretches of one phase that are shaded; more would be as dense as a fill
)
SHADES: dict[
    str, dict[str, Any]
] = {  # behind a history, told apart by darkness in grey print; slip is left white
    "stick": {"color": drawing.PHASE_COLOURS["stick"], "alpha": 0.22},
    "separation": {"color": SEPARATED, "alpha": 0.5},
}


def draw_history(
    axes: Sequence[Axes], case: xr.DataTree, window: xr.Dataset, variables: Sequence[str]
) -> list[Artist]:
    """Draw variables against time, over shaded phases unless these are too dense; returns entries
    of a legend."""
    for ax, name in zip(axes, variables, strict=True):
        drawing.show(ax, case, window, name, named=ax is axes[0])
        ax.label_outer()
    axes[-1].locator_params(axis="x", nbins=6)
    axes[-1].ticklabel_format(axis="x", useOffset=False)
    spans = spans_in(case, window)
    if not 0 < max(len(spans[name]) for name in SHADES) <= MOST_SHADED:
        return []
    for name in SHADES:
        bars = [(start, stop - start) for start, stop in spans[name]]
        for ax in axes:
            ax.broken_barh(
                bars,
                (0, 1),
                transform=ax.get_xaxis_transform(),
                linewidth=0,
                zorder=0,
                **SHADES[name],
            )
    looks = SHADES | {"slip": {"facecolor": "white", "edgecolor": GREY, "linewidth": 0.5}}
    return [mpl.patches.Patch(label=name, **looks[name]) for name in PHASES if spans[name]]


def _as_either(window: Window) -> str:
    enough = window.count >= 2 * (window.envelope or 1)
    return "" if enough else "must be two samples, or two envelopes, long or more"


class History(CasePlot):
    """Variables against time, one above the other; a window with an envelope as ranges."""

    kind: Literal["history"] = "history"
    window: Annotated[str, _as_either]
    variables: Annotated[tuple[Sampled, ...], Field(min_length=1)] = ("P", "w")
    until: Annotated[Positive, Unit("s")] | None = (
        None  # end of the part of the window that is shown
    )

    def faults(self, cases: Mapping[str, Recorded | None]) -> Iterator[Fault]:
        yield from super().faults(cases)
        window = (cases.get(self.case) or {}).get(self.window)
        if isinstance(window, Window) and window.envelope is not None:
            for i, name in enumerate(self.variables):
                if name not in RANGES:
                    yield Fault.of(
                        ("variables", str(i)),
                        name,
                        f"is not kept as ranges (known: {', '.join(RANGES)})",
                    )

    def draw(self, *cases: xr.DataTree) -> Figure:
        [case] = cases
        figure, axes = panels(
            drawing.COLUMN, 0.8 + 1.3 * len(self.variables), len(self.variables), sharex=True
        )
        shown = dataset.group(case, self.window).sel(time=slice(None, self.until or math.inf))
        if shown.sizes["time"] < 2:  # the run ended before it
            raise Missing(
                f"has {shown.sizes['time']} samples in {self.window}, at least 2 are needed"
            )
        drawing.letters(axes)
        figure_legend(figure, draw_history(axes, case, shown, self.variables))
        figure.align_ylabels()
        return figure


LINES = {"stick": 0.5, "slip": 0.5, "separation": 1.5}
"""Widths of the lines of phases in a portrait, distinct in grey print, points."""


def draw_portrait(ax: Axes, samples: xr.Dataset, x: str, y: str) -> list[Artist]:
    """Draw one variable over another, coloured by phase; returns entries of a legend."""
    (across, in_x, _), (up, in_y, _) = (drawing.sampled(name, samples) for name in (x, y))
    words = flag_names(samples["phase"])
    inside = {name: words == name for name in PHASES}
    for name, mask in inside.items():
        if mask.any():
            # broken where the phase changes, so that no chord is drawn across others
            height = np.where(mask, samples[y].values * in_y, np.nan)
            ax.plot(
                samples[x].values * in_x,
                height,
                color=drawing.PHASE_COLOURS[name],
                linewidth=LINES[name],
                label=name,
                rasterized=True,
            )
    ax.margins(0.04)
    ax.set(xlabel=across, ylabel=up)
    return [
        drawing.sample(color=drawing.PHASE_COLOURS[name], linewidth=LINES[name] + 0.5, label=name)
        for name, mask in inside.items()
        if mask.any()
    ]


class Portrait(CasePlot):
    """One variable over another, coloured by phase."""

    kind: Literal["portrait"] = "portrait"
    window: Samples
    x: Sampled = "psi"
    y: Sampled = "psi_velocity"

    def draw(self, *cases: xr.DataTree) -> Figure:
        figure, [ax] = panels(drawing.COLUMN, 2.7)
        samples = dataset.samples(cases[0], self.window)
        figure_legend(figure, draw_portrait(ax, samples, self.x, self.y))
        return figure


# ---- Poincaré sections
MARKS: dict[str, dict[str, Any]] = {  # by stage, told apart by shape as well as by colour
    "early": {"marker": "x", "color": drawing.SKY, "s": 9, "linewidths": 0.5},
    "later": {"marker": "o", "color": BLACK, "s": 3.5, "linewidths": 0},
    "separated": {"marker": "^", "color": SEPARATED, "s": 8, "linewidths": 0},
}
SMALL = 0.2  # share of both axes below which a section has an inset
BY_SEPARATION = ("in contact, before the first separation", "in contact, after it", "separated")
BY_SETTLING = ("not shown to have settled", "settled", "separated")
BY_HALVES = ("first half of the run", "second half, not shown to have settled", "separated")


def draw_sections(
    axes: Sequence[Axes],
    case: xr.DataTree,
    samples: xr.Dataset,
    compared: Any = (),
    heading: str = "",
) -> list[Artist]:
    """Draw velocity over displacement, what is small in insets too, on axes for all sections, and
    what the motion does after a heading; returns entries of a legend."""
    first, time, since = (
        float(case["first_separation"]),
        samples["time"].values,
        _settled_since(case, samples),
    )
    settled = math.isfinite(since)
    divided = stages(time, samples["phase"].values, first, since if settled else time.mean())
    masks = dict(zip(MARKS, divided, strict=True))
    for ax, name in zip(axes, ("psi", "w_point"), strict=True):
        coordinates, shares, units = [], [], []
        for axis, variable in (("x", name), ("y", f"{name}_velocity")):
            label, factor, _ = drawing.sampled(variable, samples)
            coordinates.append(samples[variable].values * factor)
            units.append(label.rpartition("(")[2].rstrip(")"))
            shown = np.concatenate([section[variable] for section in (samples, *compared)]) * factor
            low, high = float(shown.min()), float(shown.max())
            margin = 0.05 * (high - low) or 1e-6 * max(abs(high), 1e-6)  # room for the marks
            ax.set(**{f"{axis}label": label, f"{axis}lim": (low - margin, high + margin)})
            shares.append(np.ptp(coordinates[-1]) / (high - low + 2 * margin))
        # away from the bar of the thickness, which has the scale of the panel
        closer = [ax.inset_axes((0.66, 0.2, 0.34, 0.32))] if max(shares) < SMALL else []
        for order, (stage, mask) in enumerate(
            masks.items()
        ):  # later stages are drawn over earlier ones
            look = MARKS[stage] | {"zorder": 2 + 0.1 * order, "rasterized": bool(mask.sum() > 2000)}
            for panel in (ax, *closer):
                panel.scatter(*(values[mask] for values in coordinates), **look)
        for panel in closer:
            panel.set_xlabel(units[0], fontsize=7, labelpad=1)
            panel.set_ylabel(units[1], fontsize=7, labelpad=1)
            panel.margins(0.08)
            ax.indicate_inset(panel.viewLim.bounds, edgecolor=drawing.GREY, linewidth=0.6)
    drawing.show_thickness(ax, case, "x")
    bonded = Parameters.model_validate_json(case.attrs["parameters"]).contact == "bilateral"
    title, names = (
        "separation ignored" if bonded else "no separation",
        BY_SETTLING if settled else BY_HALVES,
    )
    if math.isfinite(first):
        title, names = f"first separation at {first:.2f} s", BY_SEPARATION
    axes[0].set_title(", ".join(filter(None, [heading, title])), loc="right")
    present = [
        (MARKS[stage], name) for stage, name in zip(MARKS, names, strict=True) if masks[stage].any()
    ]
    return [ax.scatter([], [], label=name, **(look | {"s": 14})) for look, name in present]


def _settled_since(case: xr.DataTree, samples: xr.Dataset) -> float:
    """Time from which all points of a motion's section lie on its end, s; by a window's ranges
    where it shows none."""
    window = next(
        (node.to_dataset() for node in case.children.values() if "w_point_min" in node), None
    )
    since = []
    for name in ("psi", "w_point"):
        answer = settling(samples["time"], samples[name])
        if math.isnan(answer.since) and window is not None and f"{name}_min" in window:
            ranges = window.isel(time=slice(None, -1))  # the last bin is cut
            answer = settling(
                ranges["time"], ranges[f"{name}_max"] - ranges[f"{name}_min"], still=1.0
            )
        since.append(answer.since)
    latest, time = float(np.max(since)), samples["time"].values
    if not math.isfinite(latest):
        return latest
    section = [
        samples[f"{name}{of}"].values for name in ("psi", "w_point") for of in ("", "_velocity")
    ]
    start = min(int(np.searchsorted(time, latest)), len(time) - 1)
    return float(time[first_settled(np.column_stack(section), start)])


class PoincareSections(CasePlot):
    """The Poincaré sections of slider and disc: psi' over psi, and velocity over displacement of
    the disc at r_0."""

    further = ("below",)
    kind: Literal["poincare"] = "poincare"
    below: tuple[str, ...] = ()  # further cases, each in a row of its own on the same axes

    def needs(self) -> Iterator[Need]:
        for case in self.cases:
            yield Need("case", case, "poincare")

    def draw(self, *cases: xr.DataTree) -> Figure:
        figure = drawing.new_figure(PAGE, 2.75 * len(cases))
        rows = np.atleast_1d(np.asarray(figure.subfigures(len(cases), 1)))
        sections = [dataset.samples(case, "poincare", at_least=1) for case in cases]
        parameters = [json.loads(case.attrs["parameters"]) for case in cases]
        for row, case, samples, p in zip(rows, cases, sections, parameters, strict=True):
            differing = {
                name: value
                for name, value in p.items()
                if any(other[name] != value for other in parameters)
            }
            handles = draw_sections(
                row.subplots(1, 2), case, samples, sections, values_text(differing)
            )
            figure_legend(row, handles, handletextpad=0.2)
        drawing.letters(figure.axes)
        return figure


# ---- Spectra, and spectrograms
FLOOR = -100.0  # least power shown, dB below the reference
WEAKEST = 0.01  # amplitude over that of the strongest line, of lines that have to be on the axis
ROOM_BEYOND = 1.15  # highest frequency shown over that of the highest such line
HEADROOM = 6.0  # upper end of the axis over the greatest amplitude: room for its name
MOST_NAMED = 5  # lines whose frequencies are written


def draw_spectrum(
    ax: Axes, samples: xr.Dataset, variable: str, highest: float | None = None
) -> None:
    """Draw the amplitude of a variable over the frequency, up to one in Hz, or to where its lines
    end; raises `Missing` if it does not vibrate."""
    label, factor, colour = drawing.sampled(variable, samples)
    time, values, least = samples["time"].values, samples[variable].values, 4 * RESOLVED
    if time.size < least:
        raise Missing(
            f"recorded {time.size} samples, and a spectrum takes {least}: a line is {least // 2} bins wide"
        )
    frequency, amplitude = amplitude_spectrum(time, values)
    if highest is None:
        highest = min(ROOM_BEYOND * highest_line(time, values, WEAKEST), float(frequency[-1]))
    shown = (frequency > 0) & (frequency <= highest)
    frequency, amplitude = frequency[shown], factor * amplitude[shown]
    if not amplitude.any():
        raise Missing(f"did not vibrate at up to {highest:g} Hz")
    ax.semilogy(frequency, amplitude, color=colour, linewidth=0.7)
    name, _, unit = label.rpartition(" (")
    title = f"{name}, amplitude ({unit}" if name else f"{label}, amplitude"
    largest = amplitude.max()
    ax.set(xlabel="Frequency (Hz)", ylabel=title, xlim=(0, frequency[-1]))
    ax.set_ylim(max(amplitude.min(), 10 ** (FLOOR / 20) * largest) / 2, HEADROOM * largest)
    found = lines(time, values, below=highest)
    name_lines(ax, [(line.frequency, factor * line.amplitude) for line in found])


def name_lines(ax: Axes, peaks: Sequence[tuple[float, float]]) -> None:
    """Write the frequencies, Hz, of the strongest lines beside their peaks: inside the axes, and
    where one does not cover another."""
    page: Any = ax.get_figure(root=True)
    page.draw_without_rendering()  # sets the size of the axes
    frame = ax.get_window_extent()
    taken: list[Any] = []
    for frequency, height in sorted(peaks, key=lambda peak: -peak[1]):
        if len(taken) == MOST_NAMED:
            return
        for offset in ((3, 2), (-3, 2)):
            name = drawing.say(ax, f"{frequency:.1f} Hz", (frequency, height), offset, fontsize=7)
            box = name.get_window_extent().padded(1)
            inside = frame.x0 <= box.x0 and box.x1 <= frame.x1 and box.y1 <= frame.y1
            if inside and not any(box.overlaps(other) for other in taken):
                taken.append(box)
                break
            name.remove()


class Spectrum(CasePlot):
    """Amplitude of a variable over the frequency, in the whole of a window."""

    kind: Literal["spectrum"] = "spectrum"
    window: Samples
    variable: Sampled = "w_point"
    highest: Annotated[Positive, Unit("Hz")] | None = None  # up to where its lines end

    def draw(self, *cases: xr.DataTree) -> Figure:
        figure, [ax] = panels(drawing.COLUMN, 2.4)
        draw_spectrum(ax, dataset.samples(cases[0], self.window), self.variable, self.highest)
        return figure


class Spectrogram(CasePlot):
    """Power of a variable over time and frequency, in dB below its strongest line."""

    kind: Literal["spectrogram"] = "spectrogram"
    window: str
    variable: Sampled = "w_point"
    highest: Annotated[Positive, Unit("Hz")] = HIGHEST

    def needs(self) -> Iterator[Need]:
        yield Need("window", self.case, self.window, partial(as_spectrum, highest=self.highest))

    def draw(self, *cases: xr.DataTree) -> Figure:
        figure, [ax] = panels(PAGE / 2, 2.7)
        spectrum = spectrum_of(cases[0], self.window, self.variable)
        draw_scale(
            figure,
            draw_power(ax, cases[0], spectrum, float(spectrum.power.max()), self.highest),
            ax,
        )
        ax.set(xlabel="Time (s)", ylabel="Frequency (Hz)")
        ax.set_title(
            drawing.sampled(self.variable, dataset.group(cases[0], self.window))[0].partition(" (")[
                0
            ]
        )
        return figure


def spectrum_of(case: xr.DataTree, window: str, variable: str) -> TimeFrequency:
    """Short-time Fourier transform of a window's variable, see `disc_model.analysis.spectra`;
    raises `Missing`."""
    samples = dataset.samples(case, window)
    try:
        spectrum = time_frequency(samples["time"].values, samples[variable].values)
    except ValueError as error:
        raise Missing(f"recorded too little in {window}: {error}") from None
    if not spectrum.power.any():
        raise Missing(f"did not vibrate in {window}")
    return spectrum


def draw_power(
    ax: Axes, case: xr.DataTree, spectrum: TimeFrequency, reference: float, highest: float
) -> Any:
    """Draw power in dB relative to a reference, up to a frequency in Hz; the first separation is
    marked."""
    shown = spectrum.frequency <= highest
    power = 10 * np.log10(np.maximum(spectrum.power[shown] / reference, 10 ** (FLOOR / 10 - 2)))
    look = {"cmap": cm.lipari, "vmin": FLOOR, "vmax": 0, "shading": "nearest", "rasterized": True}
    mesh = ax.pcolormesh(spectrum.time, spectrum.frequency[shown], power, **look)
    ax.set_facecolor(cm.lipari(0.0))
    ax.set(xlim=span_of(spectrum), ylim=(0, highest))
    drawing.mark_first_separation(ax, case, named=False, color="white", linewidth=0.9)
    return mesh


def span_of(spectrum: TimeFrequency) -> tuple[float, float]:
    """The span of time that a panel represents, s; one at the start of a run begins at 0."""
    start, stop = round(float(spectrum.time[0]), 1), round(float(spectrum.time[-1]), 1)
    return (0.0 if start < 1 else start), stop


def draw_scale(figure: drawing.FigureBase, mesh: Any, axes: Axes | Sequence[Axes]) -> None:
    """Draw the colour scale of power beside the panels that share it."""
    look: dict[str, Any] = {"pad": 0.02, "aspect": 30, "fraction": 0.06}
    figure.colorbar(
        mesh, ax=axes, label="Power (dB re strongest line)", **look
    ).outline.set_visible(False)


# ---- The whole disc: its deflection from above and along the slider's circle, a film, and its
# modes
RADII, ANGLES = 25, 181  # points across and around the disc at which it is drawn


class Motion(NamedTuple):
    """Motion of the disc and the slider through n states."""

    parameters: Parameters
    time: Array  # s
    amplitudes: NDArray[
        np.complex128
    ]  # m sqrt(kg), cosine + i sine of the angle fixed to the disc, (n_modes, n)
    slider: Array  # rad, its angle on the disc
    u: Array  # m, its height
    phase: NDArray[np.str_]

    @classmethod
    def of(cls, p: Parameters, states: Sequence[Any]) -> Self:
        """The motion through states such as those of `disc_model.snapshots`."""
        time, psi, u = (
            np.array([getattr(state, name) for state in states]) for name in ("time", "psi", "u")
        )
        slider = p.Omega * time - psi
        shapes = np.transpose([state.a + 1j * state.b for state in states])
        turned = shapes * np.exp(1j * np.multiply.outer(mode_arrays(p).diameters, slider))
        return cls(p, time, turned, slider, u, np.array([state.phase for state in states]))

    def deflection(self, i: int, r: Array | None, theta: Array) -> Array:
        """Displacement at sample i, m, at radii (k,) and angles (m,): (k, m); without radii on the
        slider's circle."""
        modes = mode_arrays(self.parameters)
        shapes = modes.psi[:, None] if r is None else mode_shapes(self.parameters, r)
        turns = modes.diameters[:, None] * theta
        return np.asarray(shapes.T @ (self.amplitudes[:, i, None].conj() * np.exp(1j * turns)).real)


def scale_of(motion: Motion) -> Normalize:
    """Colour scale of the deflection, mm, equal at all times and centred on 0."""
    edge, theta = np.array([radial_range(motion.parameters)[1]]), np.linspace(0, 2 * np.pi, ANGLES)
    step = max(1, motion.time.size // 50)
    largest = max(
        float(np.abs(motion.deflection(i, edge, theta)).max())
        for i in range(0, motion.time.size, step)
    )
    if not largest > 0:
        raise Missing("did not move the disc")
    return mpl.colors.Normalize(-1e3 * largest, 1e3 * largest)


def colour_of(motion: Motion, i: int, otherwise: str = drawing.SLIDER) -> str:
    """Colour of the slider, or of words on it."""
    return SEPARATED if motion.phase[i] == "separation" else otherwise


def _plane(p: Parameters) -> tuple[Array, Array, Array, Array]:
    """Radii and angles of points of the disc, and their coordinates in mm, shape (radii,
    angles)."""
    r, theta = np.linspace(*radial_range(p), RADII), np.linspace(0, 2 * np.pi, ANGLES)
    return r, theta, 1e3 * r[:, None] * np.cos(theta), 1e3 * r[:, None] * np.sin(theta)


def _draw_plane(ax: Axes, p: Parameters, values: Array, scale: Normalize) -> Any:
    """Draw values over the disc from above, in mm; blue below the plane of the disc at rest, red
    above it."""
    r, _, x, y = _plane(p)
    mesh = ax.pcolormesh(x, y, values, cmap=cm.vik, norm=scale, shading="gouraud", rasterized=True)
    for radius, colour in ((r[0], "0.85"), (r[-1], "none")):
        ax.add_patch(
            mpl.patches.Circle(
                (0, 0), 1e3 * radius, fc=colour, ec=GREY, lw=0.6, clip_on=radius == r[0]
            )
        )
    ax.set_aspect("equal")
    ax.axis("off")
    return mesh


def draw_disc(
    ax: Axes, motion: Motion, i: int, scale: Normalize, levels: Sequence[float] = ()
) -> Any:
    """Draw the disc from above, in mm, with the slider on it, and lines at levels in mm, dashed
    below zero."""
    p = motion.parameters
    r, theta, x, y = _plane(p)
    values = 1e3 * motion.deflection(i, r, theta)
    mesh = _draw_plane(ax, p, values, scale)
    if levels:
        ax.contour(x, y, values, levels, colors=BLACK, linewidths=0.5)
    angle = motion.slider[i]
    point = 1e3 * p.r_0 * np.array([np.cos(angle), np.sin(angle)])
    ax.plot(*point, "o", ms=5, mfc=colour_of(motion, i), mec=BLACK, mew=0.6)
    # a tick at theta = 0, and an arrow in the direction of theta, in which the slider is dragged
    edge, middle = 1e3 * r[-1], 0.6 * 1e3 * r[0]
    ax.plot([edge, 1.07 * edge], [0, 0], color=BLACK, lw=0.8)
    arc = np.radians(np.linspace(-60, 60, 30))
    ax.plot(middle * np.cos(arc), middle * np.sin(arc), color=BLACK, lw=0.8)
    start, end = [
        (middle * np.cos(angle), middle * np.sin(angle)) for angle in np.radians([60, 75])
    ]
    ax.annotate(
        "",
        end,
        start,
        arrowprops={"arrowstyle": "-|>", "lw": 0.8, "shrinkA": 0, "shrinkB": 0, "fc": BLACK},
    )
    return mesh


def draw_circle(ax: Axes, motion: Motion, i: int, size: float, **look: Any) -> None:
    """Draw the disc along the circle of radius r_0 at an instant, with the slider as a mark of a
    size in points."""
    theta = np.linspace(0, 2 * np.pi, ANGLES)
    ax.plot(theta, 1e3 * motion.deflection(i, None, theta)[0], color=drawing.DISC, **look)
    angle, height = motion.slider[i] % (2 * np.pi), 1e3 * motion.u[i]
    ax.plot(angle, height, "s", ms=size, mfc=colour_of(motion, i), mec=BLACK, mew=0.6)
    ax.set(xlabel="Angle θ (rad)", ylabel="Deflection at $r_0$ (mm)", xlim=(0, 2 * np.pi))


def draw_modes(axes: Sequence[Axes], p: Parameters) -> None:
    """Draw the shape of each mode from above, its nodal lines in black, and its frequency, by
    ascending frequency."""
    modes = mode_arrays(p)
    r, theta, x, y = _plane(p)
    shapes = mode_shapes(p, r)
    inside = r > r[0] + 0.02 * (r[-1] - r[0])  # a clamped edge is no nodal line
    for ax, i in zip(axes, np.argsort(modes.omega), strict=False):
        values = shapes[i, :, None] * np.cos(modes.diameters[i] * theta)
        largest = float(np.abs(values).max()) or 1.0
        _draw_plane(ax, p, values, mpl.colors.Normalize(-1.6 * largest, 1.6 * largest))
        if values[inside].min() < 0 < values[inside].max():
            ax.contour(
                x[inside], y[inside], values[inside], levels=[0.0], colors=BLACK, linewidths=0.9
            )
        ax.plot(1e3 * p.r_0, 0, "o", ms=3.5, mfc=drawing.SLIDER, mec=BLACK, mew=0.5)
        ax.set_title(
            f"({modes.diameters[i]}, {modes.circles[i]})  {modes.omega[i] / (2 * np.pi):.0f} Hz",
            loc="center",
        )


def film(figure: Figure, motion: Motion, time: Array, force: Array) -> Any:
    """Make the film of disc, circle under the slider, and contact force (N) over the time (s) of
    the whole stretch."""
    boxes = ((0.01, 0.05, 0.38, 0.9), (0.48, 0.62, 0.5, 0.29), (0.48, 0.13, 0.5, 0.29))
    disc, circle, trace = (figure.add_axes(box) for box in boxes)
    scale, begin = scale_of(motion), motion.time[0]

    def draw(i: int) -> list[Axes]:
        for ax in (disc, circle, trace):
            ax.cla()
        draw_disc(disc, motion, i, scale)
        draw_circle(circle, motion, i, 6)
        circle.set_ylim(scale.vmin, scale.vmax)
        now = motion.time[i]
        circle.set_title(
            f"{1e3 * (now - begin):.1f} ms, {motion.phase[i]}", color=colour_of(motion, i, BLACK)
        )
        trace.plot(1e3 * (time - begin), force, color=GREY, lw=0.7)
        trace.plot(
            1e3 * (now - begin),
            np.interp(now, time, force),
            "o",
            ms=4,
            mfc=colour_of(motion, i),
            mec=BLACK,
        )
        trace.set(
            xlabel="Time (ms)", ylabel="Contact force P (N)", xlim=1e3 * (time[[0, -1]] - begin)
        )
        return [disc, circle, trace]

    return mpl.animation.FuncAnimation(figure, draw, frames=motion.time.size, blit=False)
