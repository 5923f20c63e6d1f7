"""The cost of each answer."""

import json
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.ticker import NullFormatter

from benchmarks.figures.looks import (
    LINES,
    OUTLINE,
    SETTINGS,
    TEXTS,
    Look,
    letter,
    panels,
    row_panels,
)
from disc_model.figures.draw import PAGE
from disc_model.figures.looks import BLACK

ANSWERS: dict[str, str] = TEXTS["answers"]
HEADS: dict[str, str] = TEXTS["heads"]
RIGHT, WRONG = range(2)
"""Verdicts on answers."""
MODELS = ("rigid", "residual")
"""Lines on which the number of modes varies."""
_RED = "#B2182B"
_GREEN = "#E4F1E4"
_PALE = "#F4F4F4"
_DARK = "#595959"
_PLATE = {"facecolor": "white", "linewidth": 0, "pad": 1.0}
"""Behind red words, which are hardly seen on blue and green."""


def answers(dataset: xr.Dataset) -> Figure:
    """Draw time against the error of each answer.

    Models are marked with their numbers of nodal diameters. Shaded: correct. At the right edge,
    hollow: no result, wrongly. At the left edge: errors below all others, exact zeros among them.
    """
    questions = json.loads(dataset.attrs["questions"])
    parts = {str(name): part for name, part in dataset.to_dataframe().groupby("answer")}
    names = [name for name in ANSWERS if name in parts]
    figure, axes = row_panels(
        len(names), "Time on one core (s)", columns=min(3, len(names)), row=2.1, more=0.7
    )
    handles: dict[str, Line2D] = {}
    for ax, name, text in zip(axes, names, "abcdef", strict=False):
        part = parts[name]
        enough = questions[name]["enough"]
        ax.set(xscale="log", yscale="log", xlabel=ANSWERS[name])
        ax.margins(0.06)  # no marker cut at the edge
        letter(ax, text)

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
            path_effects=OUTLINE,
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
    figure, [ax] = panels(PAGE, 0.9 + 0.4 * len(lines))
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
        return _Cell(_PALE, [_Words("no answer", 6.5, _DARK)])

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
            bbox=_PLATE if words.color == _RED else None,
        )
