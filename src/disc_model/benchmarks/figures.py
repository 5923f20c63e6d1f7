"""Figures of the benchmark, from its datasets.

They show speed against accuracy, failures of methods, costs of answers, and effects of truncation.
"""

import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import cycle
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr
import yaml
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import NullFormatter, NullLocator

from disc_model.data.variables import values_text
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE
from disc_model.figures.sizes import PAGE

Look = dict[str, Any]
"""Arguments of matplotlib on how something looks."""

_FILE = Path(__file__).with_suffix(".yaml")
_TEXTS = yaml.safe_load(_FILE.read_text(encoding="utf-8"))


def _looks() -> dict[str, Look]:
    """Return the looks of lines, with colours of `drawing` instead of their names."""
    looks = {}
    for name, look in _TEXTS["lines"].items():
        looks[name] = {**look, "color": getattr(drawing, look["color"])}
    return looks


class Setting(NamedTuple):
    """Words of a method's setting."""

    axis: str
    phrase: str
    """How a cell of prices says its value."""


SETTINGS = {name: Setting(*words) for name, words in _TEXTS["settings"].items()}
LINES = _looks()
"""Colour, marker and line style of each method and map, and of lines that belong to no method."""
_HALO = drawing.halo()


def draw(name: str, datasets: Iterable[xr.Dataset]) -> Figure:
    """Draw a figure by its name, in the common style."""
    with drawing.styled():
        return FIGURES[name](*datasets)


def _panels(
    count: int, ylabel: str, columns: int, row: float, more: float = 0.0, **shared: Any
) -> tuple[Figure, list[Axes]]:
    """Create panels.

    Parameters
    ----------
    count : number of panels
    ylabel : of the first in each row
    columns : number of columns
    row : height of a row, inches
    more : height that is left for the legend, inches
    shared : as `Figure.subplots` has it
    """
    rows = -(-count // columns)
    figure, axes = drawing.panels(PAGE, row * rows + more, rows, columns, **shared)
    for ax in axes[count:]:
        ax.set_axis_off()
    for ax in axes[::columns]:
        ax.set_ylabel(ylabel)
    return figure, axes[:count]


# ---- Speed against accuracy

WRONG_AT = 25.0
"""Place of points with wrong events on the axis of errors, s."""
EDGE = 3.0
"""Border between errors and wrong events, s."""
RIGHT_EVENTS = (0, 1)
"""Verdicts on runs whose events are right."""
WRONG_EVENTS = 2


def overview(dataset: xr.Dataset) -> Figure:
    """Draw cost against event-time error, a panel for each scene.

    The legend names the methods with a point in any. Dotted: without the time in Python; hollow at
    the right edge: wrong events.
    """
    scenes = dataset["scene"].values.tolist()
    figure, axes = _panels(
        len(scenes), "Time per simulated second (s)", columns=2, row=2.3, sharey=True
    )
    handles: dict[str, list[Line2D]] = {}
    for ax, scene, letter in zip(axes, scenes, "abcd", strict=False):
        ax.set(xscale="log", yscale="log")
        for method in map(str, dataset["solver"].values):
            entries = _draw_method(ax, method, dataset.sel(scene=scene, solver=method))
            if entries:
                handles[method] = entries
        ax.set(xlim=(1e-18, 300.0), xticks=10.0 ** np.arange(-15, 1, 3))
        ax.xaxis.set_minor_locator(NullLocator())
        ax.axvline(EDGE, color=GREY, linewidth=0.5)
        if (dataset["verdict"].sel(scene=scene) == WRONG_EVENTS).any():
            _name_wrong_events(ax)
        drawing.letter(ax, letter, _TEXTS["titles"][scene])
    for ax in figure.axes[-2:]:  # the lower row
        ax.set_xlabel("Event-time error (s)")
    shown = [handle for method in LINES for handle in handles.get(method, ())]
    figure.legend(handles=shown, loc="outside right center")
    return figure


def _draw_method(ax: Axes, method: str, line: xr.Dataset) -> list[Line2D]:
    """Draw the points of a method on a scene.

    Parameters
    ----------
    ax : the panel
    method : its name
    line : its points

    Returns
    -------
    list of matplotlib.lines.Line2D
        Entries of the legend, none if nothing is drawn.
    """
    look: Look = {**LINES[method], "markersize": 3.5}
    if look["marker"] == "*":
        look["markersize"] = 4.5
    error = line["event_error"].values
    cost = line["cost"].values
    verdict = line["verdict"].values
    right = np.isin(verdict, RIGHT_EVENTS)
    wrong = verdict == WRONG_EVENTS

    width: Look = {"linewidth": 0.9, "zorder": 2}
    if method == "series":
        width = {"linewidth": 1.6, "zorder": 3}
    ax.plot(error[right], cost[right], **width, **look)
    label = line["label"].item()
    entries = [Line2D([], [], **{**look, "markersize": 4, "label": label})]

    glue = line["glue"].values
    if np.isfinite(glue).any():
        without = (cost * (1.0 - glue))[right]
        dotted: Look = {"linewidth": 0.7, "linestyle": ":", "color": look["color"]}
        entries += ax.plot(error[right], without, label=f"{label}, without Python", **dotted)

    hollow = {**look, "linestyle": "", "markerfacecolor": "white", "markeredgewidth": 0.8}
    ax.plot(np.full(np.count_nonzero(wrong), WRONG_AT), cost[wrong], **hollow)
    return entries if (right | wrong).any() else []


def _name_wrong_events(ax: Axes) -> None:
    """Write what points at the right edge of a panel are."""
    ax.text(
        WRONG_AT,
        1.01,
        "wrong\nevents",
        transform=ax.get_xaxis_transform(),
        ha="center",
        va="bottom",
        fontsize=6,
        color=GREY,
        linespacing=0.9,
    )


# ---- Cost of each answer

ANSWERS: dict[str, str] = _TEXTS["answers"]
HEADS: dict[str, str] = _TEXTS["heads"]
RIGHT, WRONG = range(2)
"""Verdicts on answers."""
MODELS = ("rigid", "residual")
"""Lines on which the number of modes varies."""
_RED = "#B2182B"
_GREEN = "#E4F1E4"
_PALE = "#F4F4F4"


def answers(dataset: xr.Dataset) -> Figure:
    """Draw time against the error of each answer.

    Models are marked with their numbers of nodal diameters. Shaded: correct. At the right edge,
    hollow: no result, wrongly. At the left edge: errors below all others, exact zeros among them.
    """
    questions = json.loads(dataset.attrs["questions"])
    parts = {str(name): part for name, part in dataset.to_dataframe().groupby("answer")}
    names = [name for name in ANSWERS if name in parts]
    figure, axes = _panels(
        len(names), "Time on one core (s)", columns=min(3, len(names)), row=2.1, more=0.7
    )
    handles: dict[str, Line2D] = {}
    for ax, name, letter in zip(axes, names, "abcdef", strict=False):
        part = parts[name]
        enough = questions[name]["enough"]
        ax.set(xscale="log", yscale="log", xlabel=ANSWERS[name])
        ax.margins(0.06)  # no marker cut at the edge
        drawing.letter(ax, letter)

        least_error = part["error"][part["error"] > 0].min()
        least = min(0.1 * enough, 0.3 * least_error)
        part = part.assign(error=part["error"].clip(lower=least))
        for line, points in part.groupby("line", sort=False):
            handle = _draw_line(ax, str(line), points)
            if handle is not None:
                handles[str(line)] = handle
        low, _ = ax.get_xlim()
        ax.axvspan(low, enough, color=_GREEN, zorder=0)
        ax.set_xlim(left=low)
        ax.xaxis.set_minor_formatter(NullFormatter())
        _number_models(ax, part[part["line"].isin(MODELS) & part["error"].notna()])
    figure.legend(handles=list(handles.values()), loc="outside lower center", ncols=4)
    return figure


def _draw_line(ax: Axes, line: str, points: pd.DataFrame) -> Line2D | None:
    """Draw the replies of a line to a question.

    Parameters
    ----------
    ax : the panel
    line : its name
    points : the replies

    Returns
    -------
    matplotlib.lines.Line2D or None
        Its entry of the legend, if something is drawn.
    """
    look: Look = {**LINES[line], "markersize": 4.0}
    if line in MODELS:
        look["marker"] = ""
    answered = points[points["error"].notna()]
    wrongly_none = points["error"].isna() & (points["verdict"] == WRONG)
    denied = points["seconds"][wrongly_none].dropna()
    ax.plot(answered["error"], answered["seconds"], linewidth=0.9, **look)
    if len(denied) and line not in MODELS:
        at_edge = {**look, "transform": ax.get_yaxis_transform()}
        at_edge |= {"linestyle": "", "markerfacecolor": "white"}
        ax.plot(np.full(len(denied), 0.97), denied, **at_edge)
    if not len(answered) and not len(denied):
        return None
    return Line2D([], [], label=points["label"].iloc[0], **look)


def _number_models(ax: Axes, points: pd.DataFrame) -> None:
    """Label models with their numbers of nodal diameters, the largest first.

    A model is a dot where there is no room.
    """
    room = 0.045  # of a panel's side
    to_panel = ax.transScale + ax.transLimits
    numbered: list[np.ndarray] = []
    points = points.sort_values("setting", ascending=False, kind="stable")
    for count, error, seconds in points[["setting", "error", "seconds"]].values:
        place = np.asarray(to_panel.transform((error, seconds)))
        if any(np.abs(place - other).max() < room for other in numbered):
            ax.plot(error, seconds, ".", color=BLACK, markersize=2)
            continue
        numbered.append(place)
        ax.annotate(
            f"{count:.0f}",
            (error, seconds),
            ha="center",
            va="center",
            fontsize=6,
            path_effects=_HALO,
        )


class _Words(NamedTuple):
    """A line of a cell of prices."""

    text: str
    size: float
    color: str


class _Cell(NamedTuple):
    """A cell of prices."""

    face: Any
    """Its colour."""
    lines: list[_Words]


def prices(dataset: xr.Dataset) -> Figure:
    """Draw the time of each method for each answer, at its cheapest correct setting.

    The setting stands below the time; red is the number of settings that give a wrong answer
    without a warning.
    """
    answered = dataset.to_dataframe().query("line not in @MODELS")
    names = [name for name in HEADS if name in dataset["answer"].values]
    labels = answered.drop_duplicates("line")["label"]
    lines = [*answered["line"].unique()]
    figure, [ax] = drawing.panels(PAGE, 0.9 + 0.4 * len(lines))
    colors = ScalarMappable(LogNorm(1e-3, 1e3), colormaps["YlGnBu"])
    for (line, name), part in answered.groupby(["line", "answer"], sort=False):
        place = (names.index(str(name)), lines.index(line))
        _draw_cell(ax, place, _price(part, colors))
    ax.set_xticks(range(len(names)), [HEADS[name] for name in names], fontsize=7)
    ax.set_yticks(range(len(lines)), labels, fontsize=7)
    ax.set(xlim=(-0.5, len(names) - 0.5), ylim=(len(lines) - 0.5, -0.5))
    ax.tick_params(length=0, top=False, labeltop=True, bottom=False, labelbottom=False)
    ax.spines[:].set_visible(False)
    figure.colorbar(colors, ax=ax, shrink=0.7, pad=0.01, label="Time on one core (s)")
    return figure


def _price(part: pd.DataFrame, colors: ScalarMappable) -> _Cell:
    """Return the cell of a method's replies to a question, coloured by time."""
    wrong = (part["verdict"] == WRONG).sum()
    right = part[part["verdict"] == RIGHT].nsmallest(1, "seconds")
    if right.empty and wrong:
        return _Cell(_PALE, [_Words("wrong", 6.5, _RED)])
    if right.empty:
        return _Cell(_PALE, [_Words("no answer", 6.5, GREY)])

    best = right.iloc[0]
    seconds = best["seconds"]
    ink = "white" if seconds > 3.0 else BLACK
    value = f"{best['setting']:.0e}".replace("e-0", "e-").replace("e+00", "")
    setting = SETTINGS[best["varies"]].phrase.format(value)
    lines = [_Words(_seconds_text(seconds), 6.5, ink), _Words(setting, 6.0, ink)]
    if wrong:
        lines.append(_Words(f"wrong at {wrong}", 6.0, _RED))
    return _Cell(colors.to_rgba(seconds), lines)


def _seconds_text(seconds: float) -> str:
    """Return a time in s as text, with two digits."""
    if seconds < 0.1:
        return f"{1e3 * seconds:.2g} ms"
    if seconds < 100.0:
        return f"{seconds:.2g} s"
    return f"{seconds:.0f} s"


def _draw_cell(ax: Axes, place: tuple[int, int], cell: _Cell) -> None:
    """Draw a cell of prices in a column and a row."""
    column, row = place
    corner = (column - 0.5, row - 0.5)
    ax.add_patch(Rectangle(corner, 1, 1, facecolor=cell.face, edgecolor="white", linewidth=1.5))
    for i, words in enumerate(cell.lines):
        ax.text(
            column,
            row + 0.3 * (i - 0.5 * (len(cell.lines) - 1)),
            words.text,
            ha="center",
            va="center",
            fontsize=words.size,
            color=words.color,
            path_effects=_HALO if words.color == _RED else None,
        )


# ---- How cost grows


def scaling(dataset: xr.Dataset) -> Figure:
    """Draw processor time of maps over their points, and of a point over modes and horizon."""
    rows = dataset.to_dataframe()
    rows["each"] = 1e3 * rows["seconds"] / rows["points"]
    figure, axes = drawing.panels(PAGE, 2.4, 1, 3)
    for ax, panel, letter in zip(axes, _TEXTS["scaling"], "abc", strict=True):
        varies, xlabel, shown, ylabel = panel
        for quantity, part in rows[rows["varies"] == varies].groupby("quantity"):
            name, offset = _TEXTS["maps"][quantity]
            look = LINES[str(quantity)]
            x = part[varies]
            y = part[shown]
            ax.plot(x, y, markersize=3.5, **look)
            named = 2 * len(part) // 3
            drawing.say(ax, name, (x.iloc[named], y.iloc[named]), offset, color=look["color"])
        ax.margins(0.08)
        ax.set(xscale="log", yscale="log", xlabel=xlabel, ylabel=ylabel)
        low, _ = ax.get_ylim()
        ax.set_ylim(bottom=10.0 ** math.floor(math.log10(low)))
        ax.yaxis.set_minor_formatter(NullFormatter())
        drawing.letter(ax, letter)
    return figure


# ---- Where methods fail


def failure_maps(*maps: xr.Dataset) -> Figure:
    """Draw the verdict over setting and number of modes, a panel for each method.

    Lines explain the borders.
    """
    return _map_panels(maps, _TEXTS["verdicts"], _TEXTS["borders"], row=1.45, more=0.75)


def answer_maps(*maps: xr.Dataset) -> Figure:
    """Draw whether methods find the first separation, over setting and number of modes."""
    return _map_panels(maps, _TEXTS["answered"], {}, row=1.35, more=0.4)


def _map_panels(
    maps: Sequence[xr.Dataset],
    verdicts: Mapping[str, tuple[str, str]],
    borders: Mapping[str, str],
    **size: float,
) -> Figure:
    """Draw maps with a legend of what occurs in them.

    Parameters
    ----------
    maps : of the methods
    verdicts : word and shade of each, by name
    borders : what lines of a style mean
    size : heights of a row and of the legend, inches
    """
    figure, axes = _panels(len(maps), "Real modes", columns=4, **size)
    shades = np.array([to_rgb(shade) for _, shade in verdicts.values()])
    for ax, dataset, letter in zip(axes, maps, "abcdefghijklmnop", strict=False):
        _draw_map(ax, dataset.sortby("value"), shades, with_borders=bool(borders))
        title = dataset.attrs["label"]
        if dataset.attrs.get("scene") == "stick_slip":
            title = f"{title}, contact"
        drawing.letter(ax, letter, title, fontsize=7)

    occurring = {int(number) for dataset in maps for number in np.unique(dataset["verdict"])}
    handles: list[Any] = []
    for number, (word, shade) in enumerate(verdicts.values()):
        if number in occurring:
            handles.append(Patch(facecolor=shade, edgecolor=GREY, label=word))
    for style, word in borders.items():
        look: Look = {"color": BLACK, "linewidth": 1.4, "linestyle": style}
        handles.append(Line2D([], [], label=word, **look))
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    return figure


def _draw_map(ax: Axes, dataset: xr.Dataset, shades: np.ndarray, *, with_borders: bool) -> None:
    """Draw the map of a method, with fine settings on the right.

    Parameters
    ----------
    ax : the panel
    dataset : the map, by rising values of the setting
    shades : by the number of a verdict
    with_borders : whether to draw lines that explain where the method fails
    """
    # edges are halfway between values in the logarithm
    values = np.pad(np.log(dataset["value"].values), 1, "reflect", reflect_type="odd")
    edges = np.exp(0.5 * (values[1:] + values[:-1]))
    rows = np.arange(dataset.sizes["diameters"] + 1) - 0.5
    ax.pcolormesh(edges, rows, shades[dataset["verdict"].values])
    ax.set(xscale="log", xlim=(edges[-1], edges[0]))
    ax.set_yticks(rows[:-1] + 0.5, [f"{int(n)}" for n in dataset["modes"].values])
    ax.set_xlabel(SETTINGS[dataset.attrs["setting"]].axis, labelpad=1)
    if not with_borders:
        return
    heights = np.repeat(rows, 2)[1:-1]
    for style, border in _borders(dataset):
        stairs = np.repeat(np.clip(border, edges[0], edges[-1]), 2)
        ax.plot(stairs, heights, color="white", linestyle="-", linewidth=2.4)
        ax.plot(stairs, heights, color=BLACK, linestyle=style, linewidth=1.4)


def _borders(dataset: xr.Dataset) -> Iterator[tuple[str, np.ndarray]]:
    """Yield lines that explain where a method fails: their style, and a setting for each row."""
    setting = dataset.attrs["setting"]
    if setting == "step":
        yield "-", dataset["step_limit"].values
        if dataset.attrs["scene"] == "separating":
            yield ":", dataset["shortest_phase"].values
    elif setting == "epsilon":
        yield "--", dataset["stiff_epsilon"].values
    elif np.isfinite(dataset["longest_step"].values).any():
        yield ":", _fine_enough(dataset)


def _fine_enough(dataset: xr.Dataset) -> np.ndarray:
    """Return for each row where steps become longer than the shortest phase.

    It is zero, beyond the axis, where they are longer at all settings.
    """
    values = dataset["value"].values
    borders = np.zeros(dataset.sizes["diameters"])
    shortest = dataset["shortest_phase"].values
    for row, steps in enumerate(dataset["longest_step"].values):
        fine = np.flatnonzero(steps <= shortest[row])
        if fine.size:
            coarsest = values[fine[-1]]
            next_value = values[fine[-1] : fine[-1] + 2][-1]
            borders[row] = math.sqrt(coarsest * next_value)
    return borders


# ---- How many modes

_CASES: list[Look] = [
    {"color": BLUE, "marker": "o"},
    {"color": GREEN, "marker": "s"},
    {"color": ORANGE, "marker": "^"},
    {"color": PURPLE, "marker": "D"},
]
_CONTACTS: dict[str, Look] = {
    "residual": {"linestyle": "-"},
    "rigid": {"linestyle": "--", "markerfacecolor": "white"},
}
"""Filled or hollow."""
FAR = 25.0
"""Greatest difference of first separations to that of the largest model, per cent, that is shown
to scale."""


class _Line(NamedTuple):
    """A line of a case with a contact over the number of modes."""

    data: xr.Dataset
    look: Look


def contact_truncation(dataset: xr.Dataset) -> Figure:
    """Draw the effect of residual flexibility against the number of real modes.

    Filled: residual flexibility; hollow: rigid contact; one colour for each case. Arrows at the
    edge mark values far outside the panel, crosses at the foot models without a cycle.
    """
    lines = _truncation_lines(dataset)
    figure, shown = drawing.panels(PAGE, 3.9, 2, 4, sharex=True)
    axes = {}
    for ax, panel, letter in zip(shown, _TEXTS["contact_truncation"], "abcdefgh", strict=True):
        variable, label, logarithmic = panel
        axes[variable] = ax
        for line in lines:
            y = line.data[variable].values
            good = np.isfinite(y)
            if logarithmic:
                good = good & (y > 0)
            ax.plot(line.data["modes"].values[good], y[good], **line.look)
        ax.set(xscale="log", yscale="log" if logarithmic else "linear")
        ax.margins(x=0.06)
        drawing.letter(ax, letter, label, fontsize=7)
        ax.set_xticks((1, 3, 10, 30, 100), ["1", "3", "10", "30", "100"])
        ax.xaxis.set_minor_formatter(NullFormatter())
        ax.yaxis.set_minor_formatter(NullFormatter())
    for ax in shown[4:]:
        ax.set_xlabel("Real modes")
    for ax in shown:
        ax.autoscale(False)
    axes["late"].set_ylim(-FAR, FAR)
    axes["late"].axhline(0, color=GREY, linewidth=0.6, linestyle=":", zorder=0)
    for line in lines:
        _mark_extremes(axes, line)

    handles = _truncation_legend(dataset)
    columns = 6 if len(handles) < 7 else 3
    figure.legend(handles=handles, loc="outside lower center", ncols=columns)
    return figure


def _truncation_lines(dataset: xr.Dataset) -> list[_Line]:
    """Return the lines of all cases and contacts, with the first separations compared.

    The variable ``late`` is how much later they come than that of the largest model, per cent.
    """
    first = dataset["first_separation"]
    converged = first.sel(contact="residual").isel(model=-1)
    compared = dataset.assign(u_range=1e3 * dataset["u_range"], late=100 * (first / converged - 1))
    common: Look = {"markersize": 3, "linewidth": 0.8, "markeredgewidth": 0.7}
    lines = []
    for i, of_case in zip(range(dataset.sizes["case"]), cycle(_CASES)):
        for contact, of_contact in _CONTACTS.items():
            data = compared.isel(case=i).sel(contact=contact)
            lines.append(_Line(data, {**of_case, **of_contact, **common}))
    return lines


def _mark_extremes(axes: Mapping[str, Axes], line: _Line) -> None:
    """Mark values far outside a panel, and models without a cycle.

    Parameters
    ----------
    axes : panels by variable
    line : whose values are marked
    """
    arrow: Look = {"markersize": 3, "alpha": 0.7}
    cross: Look = {"markersize": 3.5, "zorder": 4}
    late = line.data["late"].values
    no_cycle = ~np.isfinite(line.data["growth_rate"].values)
    for name, extreme, height, mark, look in (
        ("late", late > FAR, 0.98, "^", arrow),
        ("late", late < -FAR, 0.02, "v", arrow),
        ("growth_rate", no_cycle, 0, "x", cross),
    ):
        if extreme.any():
            ax = axes[name]
            x = line.data["modes"].values[extreme]
            edge: Look = {"transform": ax.get_xaxis_transform(), "clip_on": False}
            color = line.look["color"]
            ax.plot(x, np.full(x.size, height), mark, color=color, **edge, **look)


def _truncation_legend(dataset: xr.Dataset) -> list[Line2D]:
    """Return entries of the legend: cases, contacts, and models without a cycle."""
    cases = json.loads(dataset.attrs["cases"])
    looks = []
    for name, look in zip(dataset["case"].values, cycle(_CASES)):
        case = {"normalization": "as_published", **cases[name]}
        label = f"{case['normalization'].replace('_', ' ')}, {values_text(case)}"
        looks.append({**look, "linestyle": "-", "label": label})
    for contact, look in _CONTACTS.items():
        looks.append({**look, "color": BLACK, "marker": "o", "label": contact})
    looks.append({"linestyle": "", "color": BLACK, "marker": "x", "label": "no cycle found"})
    return [Line2D([], [], markersize=4, **look) for look in looks]


FIGURES: dict[str, Callable[..., Figure]] = {
    "overview": overview,
    "answers": answers,
    "prices": prices,
    "scaling": scaling,
    "failure_maps": failure_maps,
    "answer_maps": answer_maps,
    "contact_truncation": contact_truncation,
}
"""Functions that draw figures, by their names."""
