"""Figures of the benchmark: speed against accuracy, failures of methods, and costs of answers."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from benchmarks.answers import QUESTIONS
from benchmarks.methods import METHODS
from disc_model.figures import looks
from disc_model.figures.draw import PAGE, styled

Look = dict[str, Any]
"""Arguments of matplotlib on how something looks."""

LOOKS: Mapping[str, Look] = {
    "series": {"color": looks.RED, "marker": "o"},
    "RK4": {"color": looks.BLACK, "marker": "s"},
    "RK45": {"color": looks.SKY, "marker": "v"},
    "DOP853": {"color": looks.BLUE, "marker": "^"},
    "LSODA": {"color": looks.GREEN, "marker": "D"},
    "Radau": {"color": looks.PURPLE, "marker": "p"},
    "heyoka": {"color": "#7A4B12", "marker": "*"},
    "CVODE": {"color": looks.GREY, "marker": "<"},
    "CVODE-BDF": {"color": looks.GREY, "marker": ">", "linestyle": "--"},
    "cycle": {"color": looks.RED, "marker": "P", "linestyle": "--"},
}
"""Colour, marker and line style of each method, and of the cycle itself."""
TITLES = {
    "stick_slip": "Stick-slip, first second",
    "separating": "Separating, 54.4 to 55.4 s",
    "many_modes": "Many modes, l up to 12",
    "rigid": "Rigid disc, $E = 10^{20}$ Pa",
}
# shades are told apart in grey print
VERDICTS = {
    "converged": ("converged", "#08519C"),
    "inaccurate": ("inaccurate (> 1 μs)", "#6BAED6"),
    "wrong_events": ("events missed or invented", "#FDD27A"),
    "unstable": ("unstable", "#D7402F"),
    "gave_up": ("gave up", "#1A1A1A"),
}
"""Verdicts on methods, in words, and their shades."""
BORDERS = {"-": r"RK4: $h\,\omega_{max} = 2\sqrt{2}$", ":": "longest step = shortest phase"}
"""Lines in maps of failures, and what they mean."""
SETTINGS = {"tol": "Tolerance", "step": "Step (s)"}
WRONG_AT = 25.0
"""Place of points with wrong events on the axis of errors, s."""
EDGE = 3.0
"""Border between errors and wrong events, s."""


def overview(points: pd.DataFrame) -> Figure:
    """Draw cost against event-time error, a panel for each scene.

    Dotted: without the time in Python; hollow at the right edge: wrong events.
    """
    figure, axes = _panels([*TITLES], columns=2, height=2.3, ylabel="Time per simulated second (s)")
    for ax, (scene, title) in zip(axes, TITLES.items(), strict=True):
        ax.set(xscale="log", yscale="log", title=title, xlim=(1e-18, 300.0))
        ax.set_xlabel("Event-time error (s)")
        ax.axvline(EDGE, color=looks.GREY, linewidth=0.5)
        for method, line in points[points["scene"] == scene].groupby("method", sort=False):
            _draw_line(ax, str(method), line)
    _legend(figure, axes)
    return figure


def _draw_line(ax: Axes, method: str, line: pd.DataFrame) -> None:
    """Draw the points of a method on a scene."""
    look = {"linestyle": "-", "linewidth": 0.9, "markersize": 3.5, **LOOKS[method]}
    label = METHODS[method].label
    right = line[line["verdict"].isin(["converged", "inaccurate"])]
    ax.plot(right["event_error"], right["cost"], label=label, **look)
    compiled = right["cost"] * (1 - right["python"])
    dotted = {"linestyle": ":", "linewidth": 0.7, "color": look["color"]}
    if compiled.notna().any():
        ax.plot(right["event_error"], compiled, label=f"{label}, without Python", **dotted)
    wrong = line.loc[line["verdict"] == "wrong_events", "cost"]
    hollow = {**look, "linestyle": "", "markerfacecolor": "white"}
    ax.plot(np.full(len(wrong), WRONG_AT), wrong, **hollow)


def failure_maps(cells: pd.DataFrame) -> Figure:
    """Draw the verdict over setting and number of modes, a panel for each method and scene.

    A line is the step up to which RK4 is stable; dots mark the shortest phase, or where the longest
    step of a method is as long.
    """
    maps = [*cells.groupby(["method", "scene"], sort=False)]
    figure, axes = _panels(maps, columns=4, height=1.5, ylabel="Real modes")
    for ax, ((method, scene), part) in zip(axes, maps, strict=True):
        of_contact = ", contact" if scene == "stick_slip" else ""
        ax.set_title(f"{METHODS[method].label}{of_contact}", fontsize=7)
        _draw_map(ax, METHODS[method].setting, part)
    present = {*cells["verdict"]}
    handles: list[Any] = [
        Patch(facecolor=shade, label=word)
        for name, (word, shade) in VERDICTS.items()
        if name in present
    ]
    for style, word in BORDERS.items():
        look: Look = {"color": "black", "linestyle": style}
        handles.append(Line2D([], [], label=word, **look))
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    return figure


def _draw_map(ax: Axes, setting: str, part: pd.DataFrame) -> None:
    """Draw the map of a method, with fine settings on the right."""
    verdicts = part.pivot(index="modes", columns="setting", values="verdict")
    shades = np.array([[to_rgb(VERDICTS[name][1]) for name in row] for row in verdicts.to_numpy()])
    # edges are halfway between values in the logarithm
    values = np.pad(np.log(verdicts.columns.to_numpy()), 1, "reflect", reflect_type="odd")
    edges = np.exp(0.5 * (values[1:] + values[:-1]))
    rows = np.arange(len(verdicts) + 1) - 0.5
    ax.pcolormesh(edges, rows, shades)
    ax.set(xscale="log", xlim=(edges[-1], edges[0]), xlabel=SETTINGS[setting])
    ax.set_yticks(rows[:-1] + 0.5, [f"{count:.0f}" for count in verdicts.index])

    facts = part.groupby("modes").first()
    borders = {}
    if setting == "step":
        borders = {"-": facts["step_limit"], ":": facts["shortest_phase"]}
    elif part["longest_step"].notna().any():
        fine = part[part["longest_step"] <= part["shortest_phase"]]
        borders = {":": fine.groupby("modes")["setting"].max().reindex(facts.index)}
    for style, border in borders.items():
        stairs = np.repeat(np.clip(border, edges[0], edges[-1]), 2)
        ax.plot(stairs, np.repeat(rows, 2)[1:-1], color="black", linestyle=style, linewidth=1.4)


def answers(replies: pd.DataFrame) -> Figure:
    """Draw time against the error of each answer.

    Shaded: correct. At the right edge, hollow: no result, wrongly. At the left edge: errors below all
    others, exact zeros among them.
    """
    names = [name for name in QUESTIONS if name != "period"]
    figure, axes = _panels(names, columns=3, height=2.1, ylabel="Time on one core (s)")
    for ax, name in zip(axes, names, strict=True):
        question = QUESTIONS[name]
        part = replies[replies["question"] == name]
        least = min(0.1 * question.enough, 0.3 * part["error"][part["error"] > 0].min())
        title = f"{question.title[0].upper()}{question.title[1:]}, error ({question.unit})"
        ax.set(xscale="log", yscale="log", xlabel=title)
        for line, of_line in part.groupby("line", sort=False):
            look = {"linestyle": "-", "linewidth": 0.9, "markersize": 4, **LOOKS[str(line)]}
            label = METHODS[str(line)].label if line in METHODS else "series, from the cycle itself"
            found = of_line.dropna(subset="error")
            ax.plot(found["error"].clip(lower=least), found["seconds"], label=label, **look)
            denied = of_line[of_line["error"].isna() & (of_line["verdict"] == "wrong")]
            hollow: Look = {**look, "linestyle": "", "markerfacecolor": "white"}
            hollow["transform"] = ax.get_yaxis_transform()
            ax.plot(np.full(len(denied), 0.97), denied["seconds"], **hollow)
        low, _ = ax.get_xlim()
        ax.axvspan(low, question.enough, color="#E4F1E4", zorder=0)
        ax.set_xlim(left=low)
    _legend(figure, axes)
    return figure


def _panels(
    of: Sequence[Any], columns: int, height: float, ylabel: str
) -> tuple[Figure, list[Axes]]:
    """Create as many panels as there are subjects, with the rows' height in inches."""
    rows = math.ceil(len(of) / columns)
    figure = Figure(figsize=(PAGE, height * rows + 0.8), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False)
    for ax in axes[:, 0]:
        ax.set_ylabel(ylabel)
    for ax in axes.flat[len(of) :]:
        ax.set_axis_off()
    return figure, list(axes.flat[: len(of)])


def _legend(figure: Figure, axes: Sequence[Axes]) -> None:
    """Name all lines of the panels below them, each once."""
    named: dict[str, Any] = {}
    for ax in axes:
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True):
            named.setdefault(label, handle)
    figure.legend([*named.values()], [*named], loc="outside lower center", ncols=4)


FIGURES: Mapping[str, Callable[[pd.DataFrame], Figure]] = {
    "overview": overview,
    "failure_maps": failure_maps,
    "answers": answers,
}
"""Functions that draw figures from tables, by their names."""


def draw(name: str, table: pd.DataFrame) -> Figure:
    """Draw a figure by its name, in the common style."""
    with styled():
        return FIGURES[name](table)
