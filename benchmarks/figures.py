"""Figures of the benchmark: speed against accuracy, failures of methods, and costs of answers."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.answers import QUESTIONS
from benchmarks.methods import METHODS
from disc_model.figures import looks
from disc_model.figures.draw import PAGE, class_map, edges, explain, panels, styled
from disc_model.figures.looks import BLACK, Look, Options

LOOKS: Mapping[str, Options] = {
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
    "converged": Look("converged", "#08519C"),
    "inaccurate": Look("inaccurate (> 1 μs)", "#6BAED6"),
    "wrong_events": Look("events missed or invented", "#FDD27A"),
    "unstable": Look("unstable", "#D7402F"),
    "gave_up": Look("gave up", "#1A1A1A"),
}
"""Verdicts on methods, in words, and their shades."""
BORDERS = {"-": r"RK4: $h\,\omega_{max} = 2\sqrt{2}$", ":": "longest step = shortest phase"}
"""Lines in maps of failures, and what they mean."""
SETTINGS = {"tol": {"long_name": "Tolerance"}, "step": {"long_name": "Step", "units": "s"}}
WRONG_AT = 25.0
"""Place of points with wrong events on the axis of errors, s."""
EDGE = 3.0
"""Border between errors and wrong events, s."""


def overview(points: pd.DataFrame) -> Figure:
    """Draw cost against event-time error, a panel for each scene.

    Dotted: without the time in Python; hollow at the right edge: wrong events.
    """
    figure, axes = _panels([*TITLES], columns=2, height=2.3)
    for ax, (scene, title) in zip(axes, TITLES.items(), strict=True):
        ax.set(xscale="log", yscale="log", title=title, xlim=(1e-18, 300.0))
        ax.set(xlabel="Event-time error (s)", ylabel="Time per simulated second (s)")
        ax.axvline(EDGE, color=looks.GREY, linewidth=0.5)
        for method, line in points[points["scene"] == scene].groupby("method", sort=False):
            _draw_line(ax, str(method), line)
    explain(figure, axes)
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
    figure, axes = _panels(maps, columns=4, height=1.9)
    for ax, ((method, scene), part) in zip(axes, maps, strict=True):
        of_contact = ", contact" if scene == "stick_slip" else ""
        ax.set_title(f"{METHODS[method].label}{of_contact}", fontsize=7)
        _draw_map(ax, METHODS[method].setting, part)
    explain(figure, axes)
    return figure


def _draw_map(ax: Axes, setting: str, part: pd.DataFrame) -> None:
    """Draw the map of a method, with fine settings on the right."""
    plane = part.set_index(["modes", "setting"])["verdict"].to_xarray()
    plane["modes"].attrs = {"long_name": "Real modes"}
    plane["setting"].attrs = SETTINGS[setting]
    class_map(ax, plane, VERDICTS)
    ax.set(xscale="log", yticks=plane["modes"])
    ax.invert_xaxis()

    facts = part.groupby("modes").first()
    borders = {}
    if setting == "step":
        borders = {"-": facts["step_limit"], ":": facts["shortest_phase"]}
    elif part["longest_step"].notna().any():
        fine = part[part["longest_step"] <= part["shortest_phase"]]
        borders = {":": fine.groupby("modes")["setting"].max().reindex(facts.index)}
    up, across = edges(plane["modes"]), edges(plane["setting"])
    for style, border in borders.items():
        places = np.clip(border, across[0], across[-1])
        ax.stairs(
            places,
            up,
            baseline=None,
            orientation="horizontal",
            ls=style,
            lw=1.4,
            color=BLACK,
            label=BORDERS[style],
        )


def answers(replies: pd.DataFrame) -> Figure:
    """Draw time against the error of each answer.

    Shaded: correct. At the right edge, hollow: no result, wrongly. At the left edge: errors below all
    others, exact zeros among them.
    """
    names = [name for name in QUESTIONS if name != "period"]
    figure, axes = _panels(names, columns=2, height=2.1)
    for ax, name in zip(axes, names, strict=True):
        question = QUESTIONS[name]
        part = replies[replies["question"] == name]
        least = min(0.1 * question.enough, 0.3 * part["error"][part["error"] > 0].min())
        title = f"{question.title[0].upper()}{question.title[1:]}, error ({question.unit})"
        ax.set(xscale="log", yscale="log", xlabel=title, ylabel="Time on one core (s)")
        for line, of_line in part.groupby("line", sort=False):
            look = {"linestyle": "-", "linewidth": 0.9, "markersize": 4, **LOOKS[str(line)]}
            label = METHODS[str(line)].label if line in METHODS else "series, from the cycle itself"
            found = of_line.dropna(subset="error")
            ax.plot(found["error"].clip(lower=least), found["seconds"], label=label, **look)
            denied = of_line[of_line["error"].isna() & (of_line["verdict"] == "wrong")]
            hollow: Options = {**look, "linestyle": "", "markerfacecolor": "white"}
            hollow["transform"] = ax.get_yaxis_transform()
            ax.plot(np.full(len(denied), 0.97), denied["seconds"], **hollow)
        low, _ = ax.get_xlim()
        ax.axvspan(low, question.enough, color="#E4F1E4", zorder=0)
        ax.set_xlim(left=low)
    explain(figure, axes)
    return figure


def _panels(of: Sequence[Any], columns: int, height: float) -> tuple[Figure, list[Axes]]:
    """Create as many panels as there are subjects, with the rows' height in inches."""
    names = [str(i) for i in range(len(of))]
    spare = -len(names) % columns
    layout = np.reshape([*names, *["."] * spare], (-1, columns))
    figure, axes = panels(layout.tolist(), PAGE, height)
    return figure, [*axes.values()]


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
