"""Spectra in time, and the vibrations that they are taken from; figures 24 to 29 of the paper."""

from collections.abc import Sequence

import cmcrameri.cm as cmc
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure, FigureBase
from matplotlib.ticker import MaxNLocator

from disc_model.analysis.spectra import TimeFrequency, time_frequency
from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, PAGE, SKY, new_figure, panels
from disc_model.figures.kinds import HIGHEST
from disc_model.figures.paper.catalogue import ZOOM
from disc_model.parameters import Parameters
from disc_model.plate import plate_modes

FLOOR = -100.0
"""Least power shown, dB below the reference."""
POWERS = cmc.lipari


def spectrum_in_time(case: xr.DataTree, window: str, variable: str, **options: float) -> TimeFrequency:
    """Short-time Fourier transform of a window's variable, see `disc_model.analysis.spectra`."""
    samples = dataset.samples(case, window)
    try:
        found = time_frequency(samples["time"].values, samples[variable].values, **options)
    except ValueError as error:
        raise Missing(f"recorded too little in {window}: {error}") from None
    if not found.power.any():
        raise Missing(f"did not vibrate in {window}")
    return found


def spectrogram(ax: Axes, case: xr.DataTree, found: TimeFrequency, reference: float, highest: float) -> QuadMesh:
    """Draw power in dB relative to a reference, up to a frequency in Hz; the first separation is marked."""
    shown = found.frequency <= highest
    power = 10 * np.log10(np.maximum(found.power[shown] / reference, 10 ** (FLOOR / 10 - 2)))
    mesh = ax.pcolormesh(
        found.time, found.frequency[shown], power, cmap=POWERS, vmin=FLOOR, vmax=0, shading="nearest", rasterized=True
    )
    ax.set_facecolor(POWERS(0.0))
    ax.set(xlim=stretch(found), ylim=(0, highest))
    drawing.mark_first_separation(ax, case, named=False, color="white", linewidth=0.9)
    return mesh


def stretch(found: TimeFrequency) -> tuple[float, float]:
    """The stretch of time that a panel represents, s; one at the start of a run begins at 0."""
    start, stop = round(float(found.time[0]), 1), round(float(found.time[-1]), 1)
    return (0.0 if start < 1 else start), stop


def colour_bar(figure: FigureBase, mesh: QuadMesh, axes: Axes | Sequence[Axes]) -> None:
    """Draw the colour scale of power beside the panels that share it."""
    label = "Power (dB re strongest line)"
    bar = figure.colorbar(mesh, ax=axes, pad=0.02, aspect=30, fraction=0.06, label=label)
    bar.outline.set_visible(False)


def spectrum(figure: FigureBase, ax: Axes, case: xr.DataTree, found: TimeFrequency, highest: float) -> None:
    """Draw power in dB below the strongest line, up to a frequency in Hz, with its scale."""
    mesh = spectrogram(ax, case, found, float(found.power.max()), highest)
    ax.set(xlabel="Time (s)", ylabel="Frequency (Hz)")
    colour_bar(figure, mesh, ax)


def spectrogram_of(case: xr.DataTree, *, window: str, variable: str, highest: float) -> Figure:
    """Draw the spectrum in time of a variable of any case."""
    figure, [ax] = panels(PAGE / 2, 2.7)
    spectrum(figure, ax, case, spectrum_in_time(case, window, variable), highest)
    ax.set_title(drawing.sampled(variable, dataset.group(case, window))[0].partition(" (")[0])
    return figure


WINDOWS = ("spectrum_a", "spectrum_b", "spectrum_c", "spectrum_d")


def with_stretches(case: xr.DataTree, *, until: float = np.inf) -> Figure:
    """Figure 24: range of the disc's displacement at r_0 and a fixed angle, with the stretches of figure 25."""
    figure, [ax] = panels(PAGE, 2.2)
    for name in WINDOWS:
        start, stop = stretch(spectrum_in_time(case, name, "w_point", hop=0.5))
        ax.axvspan(start, stop, color=SKY, alpha=0.3, linewidth=0)
        ax.text(start + 0.4, 0.97, f"({name[-1]})", transform=ax.get_xaxis_transform(), ha="left", va="top")
    drawing.show(ax, case, drawing.history(case, until), "w_point")
    drawing.headroom(ax, 0.15)
    return figure


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


def four_stretches(case: xr.DataTree) -> Figure:
    """Figure 25: power of the disc's displacement at r_0 and a fixed angle over time and frequency, four stretches.

    The lower row is the same up to `CLOSE` Hz, with the lines of Table 2 named.
    """
    figure = new_figure(PAGE, 4.6)
    axes = figure.subplots(2, len(WINDOWS), sharex="col", sharey="row")
    found: dict[str, TimeFrequency] = {}
    for name, column in zip(WINDOWS, axes.T, strict=True):
        with drawing.blank_if_missing(*column):
            found[name] = spectrum_in_time(case, name, "w_point")
    reference = max((float(each.power.max()) for each in found.values()), default=1.0)
    for name, each in found.items():
        column = axes[:, WINDOWS.index(name)]
        for ax, highest in zip(column, (HIGHEST, CLOSE), strict=True):
            mesh = spectrogram(ax, case, each, reference, highest)
        drawing.letter(column[0], name[-1])
        column[1].set_xlabel("Time (s)")
        column[1].xaxis.set_major_locator(MaxNLocator(3))
    for ax in axes[:, 0]:
        ax.set_ylabel("Frequency (Hz)")
    if found:
        _name_lines(axes[1, -1])
        colour_bar(figure, mesh, list(axes.flat))
    return figure


def _name_lines(ax: Axes) -> None:
    """Draw ticks at the frequencies of Table 2, with the paper's symbols."""
    right = ax.secondary_yaxis("right")
    right.set_yticks([float(np.mean(pair)) for pair in TABLE_2.values()], labels=list(TABLE_2))
    right.set_yticks([line for pair in TABLE_2.values() for line in pair], minor=True)
    right.tick_params(length=0, pad=7)  # names keep clear of the ticks of single lines
    right.tick_params(which="minor", length=3, width=0.6)
    right.spines["right"].set_visible(False)


def response(
    case: xr.DataTree,
    *,
    variable: str,
    window: str,
    zooms: Sequence[tuple[str, float]] = (),
    highest: bool = False,
    until: float = np.inf,
) -> Figure:
    """Figures 26 to 29: (a) range over the run, with details beside it if requested, (b) spectrum in a window.

    Parameters
    ----------
    zooms : windows, and times in s at which their details begin
    highest : mark the disc's highest natural frequency
    until : s, end of the part of the run that (a) shows
    """
    figure = new_figure(PAGE, 2.7)
    left, right = np.asarray(figure.subfigures(1, 2, width_ratios=(1, 1.08)))
    letters = "cd"[: len(zooms)]
    axes = left.subplot_mosaic(";".join(filter(None, ["a" * max(len(zooms), 1), letters])))
    shown = right.subplots()
    marked = None
    with drawing.blank_if_missing(shown):
        found = spectrum_in_time(case, window, variable)
        marked = stretch(found)
        spectrum(right, shown, case, found, HIGHEST)
        drawing.letter(shown, "b")
        if highest:
            p = Parameters.model_validate_json(case.attrs["parameters"])
            natural = float(np.max(plate_modes(p)["omega"])) / (2 * np.pi)
            shown.axhline(natural, color="white", linewidth=0.9, linestyle=(0, (1, 2)))
    with drawing.blank_if_missing(axes["a"]):
        drawing.show(axes["a"], case, drawing.history(case, until), variable)
        if marked is not None:
            _mark(axes["a"], *marked)
        drawing.letter(axes["a"], "a")
    for letter, (name, start) in zip(letters, zooms, strict=True):
        ax = axes[letter]
        if letter != "c":
            ax.sharey(axes["c"])
            ax.tick_params(labelleft=False)
        with drawing.blank_if_missing(ax):
            label = _closer(ax, dataset.samples(case, name), variable, start)
            ax.set_ylabel(label if letter == "c" else "")
            drawing.letter(ax, letter)
    return figure


def _mark(ax: Axes, start: float, stop: float) -> None:
    """Shade the stretch of (b), with a line where it is too narrow to be seen."""
    ax.axvspan(start, stop, color=SKY, alpha=0.3, linewidth=0, zorder=0)
    if stop - start < 0.02 * ax.get_xlim()[1]:
        ax.axvline((start + stop) / 2, color=BLACK, linewidth=0.8, zorder=0)
        drawing.say_above(ax, (start + stop) / 2, "(b)")


def _closer(ax: Axes, window: xr.Dataset, variable: str, start: float) -> str:
    """Draw a closer look; returns the label of the variable's axis."""
    part = window.sel(time=slice(start, start + ZOOM))
    if part.sizes["time"] < 2:
        raise Missing(f"has no samples from {start:g} to {start + ZOOM:g} s")
    label, scale, colour = drawing.sampled(variable, window)
    ax.plot((part["time"].values - start) * 1e3, part[variable].values * scale, color=colour, linewidth=0.6)
    ax.set(xlabel=f"Time after {start:g} s (ms)", xlim=(0, ZOOM * 1e3))
    return label
