"""Common style and parts of several figures: labels, envelopes of long histories, points of
grids."""

from __future__ import annotations

import json
import logging
import re
from collections.abc import Iterable, Mapping, Sequence
from contextlib import AbstractContextManager
from contextvars import ContextVar
from itertools import chain, repeat
from pathlib import Path
from pkgutil import resolve_name
from textwrap import fill
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
import xarray as xr

from disc_model.data import dataset, variables
from disc_model.data.variables import EXCLUDED, SHOWN, axis_of, flag_names, stated_in, typeset
from disc_model.figures.classes import name_of

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure, FigureBase
else:  # names for annotations
    Artist = Axes = Figure = FigureBase = Normalize = Any


class _Deferred(NamedTuple):
    """A library that is imported where something is drawn, see `disc_model.figures.kind`."""

    library: str

    def __getattr__(self, name: str) -> Any:
        return resolve_name(f"{self.library}.{name}")


mpl, cm = _Deferred("matplotlib"), _Deferred("cmcrameri.cm")

logging.getLogger("fontTools").setLevel(
    logging.WARNING
)  # its reports on fonts would fill the logs of figures

WITHOUT_CYCLE = {"no_cycle", "separates", "no_stick_slip", "steady_sliding"}
WITHOUT_CYCLE |= {"unstable_sliding", "at_rest"}
"""Statuses of points that were computed, and have no stick-slip cycle."""

COLUMN = 84 / 25.4  # width of one column, inch
PAGE = 174 / 25.4  # width of both columns, inch

BLUE, SKY = "#0072B2", "#56B4E9"
VERMILION, ORANGE, BROWN = "#D55E00", "#E69F00", "#7A4B12"
GREEN, PURPLE = "#009E73", "#CC79A7"
BLACK, GREY = "#000000", "#8a8a8a"

# One colour per quantity in the whole set; loss of contact is always vermilion.
DISC, SLIDER, FORCE = BLUE, ORANGE, "#4d4d4d"
STICK, SLIP, SEPARATED = GREEN, PURPLE, VERMILION
PHASE_COLOURS = {"stick": STICK, "slip": SLIP, "separation": SEPARATED}
PAPER = "#F0E442"  # the paper's results, always with a black edge: no other mark and no map has it

BORDERS: dict[
    str, dict[str, Any]
] = {  # lines of all stability charts; corners of cells stay visible in short dashes
    "neutral": {
        "color": BLACK,
        "linewidth": 1.0,
        "linestyle": "-",
        "label": "cycle loses stability",
    },
    "fold": {
        "color": BLACK,
        "linewidth": 1.0,
        "linestyle": (0, (1.2, 0.8)),
        "label": "stable cycle ends (fold)",
    },
}


def styled() -> AbstractContextManager[None]:
    """The common style instead of the user's settings, as a context."""
    return mpl.style.context(Path(__file__).with_name("drawing.mplstyle"), after_reset=True)


def new_figure(width: float, height: float) -> Figure:
    """An empty figure of a size in inches, outside pyplot's state."""
    return mpl.figure.Figure(figsize=(width, height), layout="constrained")


def panels(
    width: float, height: float, rows: int = 1, columns: int = 1, **shared: Any
) -> tuple[Figure, list[Axes]]:
    """A figure of a size in inches with panels, row by row; `shared` as `Figure.subplots` has
    it."""
    figure = new_figure(width, height)
    return figure, list(figure.subplots(rows, columns, squeeze=False, **shared).flat)


def save(figure: Figure, path: str | Path, title: str = "") -> None:
    """Write a figure with its title; equal figures give equal bytes. Further files have the layout
    of the first."""
    metadata: dict[str, Any] = (
        {"CreationDate": None} if Path(path).suffix == ".pdf" else {"Software": None}
    )
    metadata |= {"Title": title} if title else {}
    with styled():
        figure.savefig(path, metadata=metadata)
        figure.set_layout_engine(None)  # not "none", with which all is drawn twice


def history(case: xr.DataTree, window: str = "history", until: float | None = None) -> xr.Dataset:
    """Ranges in a window, up to a time in s; two bins define the bin width."""
    ranges = dataset.samples(case, window, envelope=True)
    shown = ranges.sel(time=slice(until))
    return shown if shown.sizes["time"] > 1 else ranges


MODES = {
    "as_published": "modes as published",
    "orthonormal": "orthonormal modes",
    "given": "modes of a table",
}
WORDS = {
    **MODES,
    "vertical": "vertical contact force",
    "normal": "normal contact force",
}  # those of the paper first
MODELS = {
    "normal": WORDS["normal"],
    "residual": "residual flexibility",
    "surface": "friction on the surface",
}
MODELS |= dict.fromkeys(
    ("bilateral", "bonded"), "bilateral contact"
)  # the second in files of results


def sample(**look: Any) -> Artist:
    """A line or mark for a legend."""
    return mpl.lines.Line2D([], [], **look)


def halo(width: float = 1.5, colour: str = "white") -> list[Any]:
    """An outline of text, lines or marks; width in points, that of what it surrounds included."""
    return [mpl.patheffects.withStroke(linewidth=width, foreground=colour)]


DECADES = np.outer(10.0 ** np.arange(-9, 13), (1, 2, 5)).ravel()  # ticks of a logarithmic axis
UNITS: ContextVar[Mapping[str, tuple[str, float]]] = ContextVar("units", default={})  # noqa: B039
"""Units of the reader and the factors from SI to them, by parameter or sampled variable, while a figure is drawn."""


def restate_axes(figure: Figure) -> None:
    """Give axes in the units of the reader: their labels and ticks; what is drawn stays."""
    for axis in [axis for ax in figure.axes for axis in (ax.xaxis, ax.yaxis)]:
        text = axis.get_label_text()
        for name, (unit, factor) in UNITS.get().items():
            shown = SHOWN[name]
            if text.startswith(typeset(f"{shown.name} {shown.symbol}".strip())) and text.endswith(
                f"({shown.unit})"
            ):
                ratio, ends = factor / shown.factor, axis.get_view_interval()
                linear = mpl.ticker.MaxNLocator(7, steps=[1, 2, 2.5, 5, 10]).tick_values(
                    *np.multiply(ratio, ends)
                )
                ticks = linear if axis.get_scale() == "linear" else DECADES
                axis.set_label_text(text.removesuffix(f"({shown.unit})") + f"({unit})")
                axis.set_major_locator(mpl.ticker.FixedLocator(np.divide(ticks, ratio)))
                axis.set_major_formatter(
                    mpl.ticker.FuncFormatter(lambda value, _, ratio=ratio: f"{value * ratio:.6g}")
                )


def label_of(variable: xr.DataArray) -> tuple[str, float]:
    """Axis label of any variable or coordinate, and the factor from SI to its unit."""
    words = str(variable.attrs.get("long_name", variable.name)).partition(", nan ")[0]
    for name in (
        str(variable.name),
        words,
    ):  # a scanned parameter is the long name of its dimension
        if name in SHOWN:
            return axis_of(name)
    words = words.replace(
        "disturbances of ", ""
    )  # of growth rates, which have one name in all figures
    unit = str(variable.attrs.get("units", "1")).replace("s-1", "/s").replace(" /", "/")
    phrase = fill(words[0].upper() + words[1:], 48)
    return (
        f"{phrase} ({'1' + unit if unit.startswith('/') else unit})"
        if unit not in ("", "1")
        else phrase
    ), 1.0


def along(coordinate: xr.DataArray) -> tuple[str, np.ndarray]:
    """Axis label of a coordinate, and its values in the label's unit."""
    label, factor = label_of(coordinate)
    return label, coordinate.values * factor


def as_numbers(variable: xr.DataArray) -> tuple[list[str], xr.DataArray]:
    """Words of a flag's values, none for other variables; and the variable with numbers for words,
    their places."""
    words = [word for word in variable.attrs.get("flag_meanings", "").split() if word != EXCLUDED]
    if variable.dtype.kind in "UO":
        distinct, places = np.unique(variable.values, return_inverse=True)
        words, variable = (
            distinct.tolist(),
            variable.copy(data=places.reshape(variable.shape).astype(float)),
        )
    return [name_of(word) for word in words], variable


def picked(study: xr.Dataset, values: Mapping[str, float | str]) -> xr.Dataset:
    """A grid study at values of some dimensions; dimensions of one value are dropped."""
    for dim, value in values.items():
        study = study.sel({dim: value}, method=None if isinstance(value, str) else "nearest")
    return study.squeeze()


def gaps(study: xr.Dataset, variable: xr.DataArray) -> dict[str, xr.DataArray]:
    """Points where a variable has no value, by the word of their status; without those that a rule
    excludes."""
    words, gone = statuses(study), variable.isnull()
    masks: dict[str, xr.DataArray] = {}
    for word in map(str, np.unique(words)):
        here = gone & (words == word)
        if word == EXCLUDED or not here.any():
            continue
        name = name_of(class_of_gap(word))
        masks[name] = masks[name] | here if name in masks else here
    return masks


def class_of_gap(status: str) -> str:
    """The class of a point without a value: its status, "failed" for a failure of the computation,
    and "no_value" for a point that was computed."""
    if status == "ok":
        return "no_value"
    return status if status in (*WITHOUT_CYCLE, EXCLUDED) else "failed"


def what_case(values: Mapping[str, Any]) -> str:
    """Values of parameters for titles: N, Omega, and those that differ from Table 1."""
    words = [
        MODELS[value] for value in values.values() if isinstance(value, str) and value in MODELS
    ]
    if values.get("normalization") == "orthonormal":
        words.append(MODES["orthonormal"])
    numbers = {name: value for name, value in values.items() if not isinstance(value, str)}
    return ", ".join(filter(None, [variables.values_text(numbers, UNITS.get()), *words]))


def slices(variable: Any, by: str | None) -> list[tuple[str, Any]]:
    """Label and values of each slice along a dimension; words as in `WORDS`, or by the number they
    begin with."""
    if by is None:
        return [("", variable)]
    names = [str(name) for name, values in variable.coords.items() if values.dims == (by,)]
    ranks = {word: i for i, word in enumerate(WORDS)}

    def rank(value: Any) -> Any:
        leading = re.findall(r"^\d+", str(value)) or ["inf"]
        return (ranks.get(value, 0), float(leading[0])) if isinstance(value, str) else value

    parts = [variable.isel({by: i}) for i in range(variable.sizes[by])]
    parts.sort(key=lambda part: [rank(part[name].item()) for name in names])
    return [(", ".join(coordinate_text(part, name) for name in names), part) for part in parts]


def coordinate_text(data: xr.DataArray | xr.Dataset, by: str) -> str:
    """Label of a panel or a line."""
    value = data[by].item()
    if isinstance(value, str):
        return WORDS.get(value, value)
    label, factor = label_of(data[by])
    name, _, unit = label.rpartition(" (")
    unit, factor = UNITS.get().get(by, (unit.rstrip(")"), factor))
    if by == "contact_compliance":
        return f"compliance {value * factor:.3g} µm/N" if value else "rigid contact"
    if by == "friction_offset":
        return (
            f"friction {value * factor:g} mm above the middle plane"
            if value
            else "friction in the middle plane"
        )
    return f"{name} = {value * factor:g} {unit}" if name else f"{label} = {value * factor:g}"


def sampled(name: str, *windows: xr.Dataset) -> tuple[str, float, str]:
    """Axis label of a sampled variable, with the angle of the disc's fixed point, factor to its
    unit, and colour."""
    angles = sorted({float(window.attrs["theta"]) for window in windows if "theta" in window.attrs})
    at = rf", $\theta$ = {' and '.join(f'{angle:g}' for angle in angles)} rad"
    label, factor = axis_of(name, at if name.startswith("w_point") else "")
    return (
        label,
        factor,
        FORCE if name == "P" else DISC if name.partition("_")[0] == "w" else SLIDER,
    )


def envelope(ax: Axes, ranges: xr.Dataset, name: str, color: str = "", label: str = "") -> None:
    """Draw the range of a variable against time, as a band that stays visible where it is thin."""
    time, (_, factor, usual_color) = ranges["time"].values, sampled(name)
    low, high = (ranges[f"{name}_{end}"].values * factor for end in ("min", "max"))
    ax.fill_between(time, low, high, color=color or usual_color, linewidth=0.5, label=label)
    ax.set_xlim(0, round(time[-1] + (time[-1] - time[-2]) / 2, 2))


def show(ax: Axes, case: xr.DataTree, window: xr.Dataset, name: str, *, named: bool = True) -> None:
    """Draw a variable against time, as a line or as ranges, and mark the first separation, with its
    time if `named`."""
    label, factor, colour = sampled(name, window)
    if f"{name}_min" in window:
        envelope(ax, window, name)
    else:
        ax.plot(window["time"], window[name].values * factor, color=colour, linewidth=0.6)
        ax.set_xlim(*window["time"].values[[0, -1]])
    ax.set(xlabel="Time (s)", ylabel=label)
    mark_first_separation(ax, case, named=named)


def headroom(ax: Axes, share: float) -> None:
    """Leave room above the data, a fraction of their height."""
    low, high = ax.get_ylim()
    ax.set_ylim(top=high + share * (high - low))


def broken(
    x: np.ndarray, y: np.ndarray, jump: float, height: np.ndarray | None = None
) -> list[np.ndarray]:
    """A line with gaps where its height, y unless given, changes by more than `jump`."""
    gaps = np.flatnonzero(np.abs(np.diff(y if height is None else height)) > jump) + 1
    return [np.insert(along.astype(float), gaps, np.nan) for along in (x, y)]


def edges(values: np.ndarray) -> np.ndarray:
    """Edges of cells around ascending values: halfway between neighbours, and the first and last
    value."""
    return np.concatenate([values[:1], 0.5 * (values[1:] + values[:-1]), values[-1:]])


def stretches(mask: np.ndarray) -> list[tuple[int, int]]:
    """Runs of True: index of the first element, and the index after the last."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], mask, [0]])))
    return [(first, after) for first, after in edges.reshape(-1, 2).tolist()]


def spans(along: np.ndarray, mask: np.ndarray) -> list[tuple[float, float]]:
    """Ranges of ascending values in which a mask holds, up to halfway to their neighbours."""
    borders = edges(along).tolist()
    return [(borders[first], borders[after]) for first, after in stretches(mask)]


def mark_cases(axes: Sequence[Axes], places: Mapping[str, float], height: float = 0.0) -> None:
    """Mark the paper's cases by lines, named in the first panel: left of the first line, right of
    the next."""
    for i, (case, x) in enumerate(places.items()):
        for ax in axes:
            ax.axvline(x, color=BLACK, linewidth=0.6, linestyle=(0, (1, 2)), zorder=0)
        side = 2 * (-1) ** (i + 1)
        say(axes[0], case, (x, height), (side, 2), xycoords=("data", "axes fraction"), fontsize=7)


def show_thickness(ax: Axes, case: xr.DataTree, along: Literal["x", "y"]) -> None:
    """Draw a bar as long as the disc is thick, beside a panel whose axis is a displacement in mm,
    if it finds room."""
    h = json.loads(case.attrs.get("parameters", "{}")).get("h")
    low, high = ax.get_xlim() if along == "x" else ax.get_ylim()
    share = 1e3 * h / (high - low) if h else 1.0
    if share > 0.8:
        return
    points = ([1 - share, 1], [1.04, 1.04]) if along == "x" else ([1.02, 1.02], [0, share])
    ax.plot(
        *points,
        color=BLACK,
        linewidth=2.5,
        solid_capstyle="butt",
        transform=ax.transAxes,
        clip_on=False,
    )
    point, offset, turn = (
        ((1 - share, 1.04), (-3, 0), 0) if along == "x" else ((1.02, 0), (3, 1), 90)
    )
    say(
        ax,
        f"thickness {1e3 * h:g} mm",
        point,
        offset,
        xycoords="axes fraction",
        fontsize=6,
        rotation=turn,
    )


def mark_printed(ax: Axes, time: float) -> None:
    """Mark a time that the paper prints, at the lower edge of a panel that shows it, in room made
    for it."""
    (low, high), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    if low <= time <= high:
        ax.set_ylim(bottom - 0.13 * (top - bottom), top)
        across, beside = ax.get_xaxis_transform(), ("data", "axes fraction")
        ax.plot(
            [time],
            [0],
            marker="^",
            c=PAPER,
            mec=BLACK,
            ms=6,
            zorder=6,
            transform=across,
            clip_on=False,
        )
        say(
            ax,
            f"paper: {time:g} s",
            (time, 0),
            (-6, 4),
            xycoords=beside,
            fontsize=6,
            path_effects=halo(),
        )


def mark_first_separation(ax: Axes, case: xr.DataTree, *, named: bool = True, **look: Any) -> None:
    """Mark the first separation by a line with its time above it; nothing if the time shown has
    none."""
    time, (low, high) = float(case["first_separation"]), ax.get_xlim()
    if low <= time <= high:
        ax.axvline(time, **{"color": SEPARATED, "linewidth": 0.8, "linestyle": (0, (4, 2)), **look})
        if named:
            beside = ("data", "axes fraction")
            say(
                ax,
                f"first separation {time:.2f} s",
                (time, 1),
                (0, 2),
                xycoords=beside,
                fontsize=7,
                color=SEPARATED,
            )


def say(
    ax: Axes, text: str, point: tuple[float, float], offset: tuple[float, float], **look: Any
) -> Any:
    """Write a few words beside a point, on the side to which an offset in points leads; returns the
    text."""
    across, up = np.sign(offset)
    ha, va = (
        {-1: "right", 0: "center", 1: "left"}[across],
        {-1: "top", 0: "center", 1: "bottom"}[up],
    )
    return ax.annotate(text, point, xytext=offset, textcoords="offset points", ha=ha, va=va, **look)


def say_beside(ax: Axes, height: float, text: str, gap: float = 2, **look: Any) -> None:
    """Write a line's name at its right end, outside the panel, after a gap in points."""
    say(ax, text, (1, height), (gap, 0), xycoords=("axes fraction", "data"), **look)


def letter(ax: Axes, text: str, title: str = "", **look: Any) -> None:
    """Write a panel's letter above its upper left corner, and its subject."""
    ax.set_title(f"({text}) {title}".strip(), loc="left", **look)


def letters(axes: Sequence[Axes] | np.ndarray, titles: Iterable[str] = (), **look: Any) -> None:
    """Write the letters of panels, and the subjects of the first ones; a single panel has no
    letter."""
    for ax, text, title in zip(axes, "abcdefghijkl", chain(titles, repeat("")), strict=False):
        ax.set_title(f"({text}) {title}".strip() if len(axes) > 1 else title, loc="left", **look)


def normalizations(study: xr.Dataset) -> list[str]:
    """Normalizations for which a grid study has values."""
    if "normalization" in study.coords:
        return [str(name) for name in np.atleast_1d(study["normalization"].values)]
    base = stated_in(study, "base")
    return ["given" if base.get("disc") else base["normalization"]]


def of(study: xr.Dataset, normalization: str) -> xr.Dataset:
    """Values of a grid study for one normalization."""
    return study.sel(normalization=normalization) if "normalization" in study.dims else study


def statuses(study: xr.Dataset) -> xr.DataArray:
    """The status of each point of a grid study, as a word; "ok" without one.

    A motion that never sticks again is "steady_sliding" or "unstable_sliding" where the study knows
    the growth rate of steady sliding.
    """
    if "status" not in study:
        return xr.DataArray("ok")
    words = study["status"].copy(data=flag_names(study["status"]).astype(object))
    if "sliding_growth_rate" in study:
        rate = study["sliding_growth_rate"]
        largest = rate.max([dim for dim in rate.dims if dim not in words.dims])
        slides = words == "no_stick_slip"
        words = words.where(~(slides & (largest < 0)), "steady_sliding")
        words = words.where(~(slides & (largest >= 0)), "unstable_sliding")
    return words.astype(str)


def failed(study: xr.Dataset) -> xr.DataArray:
    """Points of a grid study that failed."""
    return statuses(study) != "ok"


def mark_failed(
    ax: Axes, values: np.ndarray, on: Literal["x", "y"] = "x", name: str = "failed"
) -> None:
    """Mark failed points by crosses beside an axis, as in stability maps; nothing if there are
    none."""
    if values.size:
        points, transform = [values, np.full(values.shape, 0.02)], ax.get_xaxis_transform()
        if on == "y":
            points, transform = points[::-1], ax.get_yaxis_transform()
        ax.plot(
            *points,
            "x",
            color=BLACK,
            markersize=3.5,
            transform=transform,
            clip_on=False,
            label=name,
        )


def head_text(width: float, title: str, values: str) -> str:
    """A title and values of parameters, in lines that fit a width in inches; a value stays on the
    line of its name."""
    joined = ", ".join(value.replace(" ", "\u00a0") for value in typeset(values).split(", "))
    return "\n".join(fill(text, round(width / 0.06)) for text in (title, joined) if text).replace(
        "\u00a0", " "
    )
