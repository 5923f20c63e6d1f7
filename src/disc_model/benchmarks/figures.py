"""Figures of the benchmark, from its datasets: speed against accuracy, failures of methods, effect
of truncation."""

import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import cycle
from pathlib import Path
from typing import Any

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
from disc_model.figures.drawing import BLACK, BLUE, GREEN, GREY, ORANGE, PAGE, PURPLE, halo, panels

_TEXTS = yaml.safe_load(Path(__file__).with_suffix(".yaml").read_text(encoding="utf-8"))
SETTINGS: dict[str, tuple[str, str]] = _TEXTS["settings"]
LINES = {
    name: look | {"color": getattr(drawing, look["color"])}
    for name, look in _TEXTS["lines"].items()
}
"""Colour, marker and line style of each method and map, and of lines that belong to no method."""
_HALO = halo()
Look = dict[str, Any]


# ---- Speed against accuracy
def overview(dataset: xr.Dataset) -> Figure:
    """Cost against event-time error, a panel for each scene; the legend names the methods with a
    point in any. Dotted: without the time in Python; hollow at the right edge: wrong events."""
    scenes, wrong_at = dataset["scene"].values.tolist(), 25.0
    figure, axes = _panels(
        len(scenes), "Time per simulated second (s)", columns=2, row=2.3, sharey=True
    )
    handles: dict[str, list[Line2D]] = {}
    for ax, scene, letter in zip(axes, scenes, "abcd", strict=False):
        ax.set(xscale="log", yscale="log")
        for method in map(str, dataset["solver"].values):
            line = dataset.sel(scene=scene, solver=method)
            look = LINES[method] | {"markersize": 4.5 if LINES[method]["marker"] == "*" else 3.5}
            name = {"color": look["color"], "label": line["label"].item()}
            entries = [Line2D([], [], **look | name | {"markersize": 4})]
            x, cost, verdict = (line[each].values for each in ("event_error", "cost", "verdict"))
            right, wrong = np.isin(verdict, (0, 1)), verdict == 2
            bold = method == "series"
            ax.plot(
                x[right],
                cost[right],
                linewidth=1.6 if bold else 0.9,
                zorder=3 if bold else 2,
                **look,
            )
            if np.isfinite(glue := line["glue"].values).any():
                name["label"] += ", without Python"
                entries += ax.plot(
                    x[right], (cost * (1.0 - glue))[right], linewidth=0.7, linestyle=":", **name
                )
            if (right | wrong).any():
                handles[method] = entries
            hollow = look | {"linestyle": "", "markerfacecolor": "white", "markeredgewidth": 0.8}
            ax.plot(np.full(np.count_nonzero(wrong), wrong_at), cost[wrong], **hollow)
        ax.set(xlim=(1e-18, 300.0), xticks=10.0 ** np.arange(-15, 1, 3))
        ax.xaxis.set_minor_locator(NullLocator())
        ax.axvline(3.0, color=GREY, linewidth=0.5)
        if (dataset["verdict"].sel(scene=scene) == 2).any():
            text: Look = {
                "ha": "center",
                "va": "bottom",
                "fontsize": 6,
                "color": GREY,
                "linespacing": 0.9,
            }
            ax.text(wrong_at, 1.01, "wrong\nevents", transform=ax.get_xaxis_transform(), **text)
        drawing.letter(ax, letter, _TEXTS["titles"][scene])
    for ax in figure.axes[-2:]:  # the lower row
        ax.set_xlabel("Event-time error (s)")
    shown = [handle for method in LINES for handle in handles.get(method, ())]
    figure.legend(handles=shown, loc="outside right center")
    return figure


def _panels(
    count: int, ylabel: str, columns: int, row: float, more: float = 0.0, **shared: Any
) -> tuple[Figure, list[Axes]]:
    """Create `count` panels; a row is `row` inches high, and `more` inches are left for the
    legend."""
    rows = -(-count // columns)
    figure, axes = panels(PAGE, row * rows + more, rows, columns, **shared)
    for ax in axes[count:]:
        ax.set_axis_off()
    for ax in axes[::columns]:
        ax.set_ylabel(ylabel)
    return figure, axes[:count]


# ---- Cost of each answer
ANSWERS: dict[str, str] = _TEXTS["answers"]
HEADS: dict[str, str] = _TEXTS["heads"]
RIGHT, WRONG = range(2)  # verdicts
MODELS = ("rigid", "residual")
_RED = "#B2182B"


def answers(dataset: xr.Dataset) -> Figure:
    """Time against the error of each answer; models are marked with their numbers of nodal
    diameters. Shaded: correct. At the right edge, hollow: no result, wrongly. At the left edge:
    errors below all others, exact zeros among them."""
    enough = {
        name: question["enough"]
        for name, question in json.loads(dataset.attrs["questions"]).items()
    }
    answers = {str(name): part for name, part in dataset.to_dataframe().groupby("answer")}
    names = [name for name in ANSWERS if name in answers]
    figure, axes = _panels(
        len(names), "Time on one core (s)", columns=min(3, len(names)), row=2.1, more=0.7
    )
    handles: dict[str, Line2D] = {}
    for ax, name, letter in zip(axes, names, "abcdef", strict=False):
        part = answers[name]
        ax.set(xscale="log", yscale="log", xlabel=ANSWERS[name])
        ax.margins(0.06)  # no marker cut at the edge
        drawing.letter(ax, letter)
        least = min(0.1 * enough[name], 0.3 * part["error"][part["error"] > 0].min())
        part = part.assign(error=part["error"].clip(lower=least))
        for line, points in part.groupby("line", sort=False):
            look = (
                LINES[str(line)] | {"markersize": 4.0} | ({"marker": ""} if line in MODELS else {})
            )
            answered = points[points["error"].notna()]
            denied = points["seconds"][
                points["error"].isna() & (points["verdict"] == WRONG)
            ].dropna()
            ax.plot(answered["error"], answered["seconds"], linewidth=0.9, **look)
            if len(denied) and line not in MODELS:
                edge = {
                    "transform": ax.get_yaxis_transform(),
                    "linestyle": "",
                    "markerfacecolor": "white",
                }
                ax.plot(np.full(len(denied), 0.97), denied, **look | edge)
            if len(answered) or len(denied):
                handles[str(line)] = Line2D([], [], label=points["label"].iloc[0], **look)
        low, _ = ax.get_xlim()
        ax.axvspan(low, enough[name], color="#E4F1E4", zorder=0)
        ax.set_xlim(left=low)
        ax.xaxis.set_minor_formatter(NullFormatter())
        _number_models(ax, part[part["line"].isin(MODELS) & part["error"].notna()])
    figure.legend(handles=list(handles.values()), loc="outside lower center", ncols=4)
    return figure


def _number_models(ax: Axes, points: pd.DataFrame) -> None:
    """Label models with their numbers of nodal diameters, the largest first; a dot where there is
    no room."""
    to_panel = ax.transScale + ax.transLimits
    numbered: list[np.ndarray] = []
    points = points.sort_values("setting", ascending=False, kind="stable")
    for count, *point in points[["setting", "error", "seconds"]].values:
        panel_point = np.asarray(to_panel.transform(point))
        if any(
            np.abs(panel_point - other).max() < 0.045 for other in numbered
        ):  # of a panel's side
            ax.plot(*point, ".", color=BLACK, markersize=2)
        else:
            numbered.append(panel_point)
            ax.annotate(
                f"{count:.0f}",
                (point[0], point[1]),
                ha="center",
                va="center",
                fontsize=6,
                path_effects=_HALO,
            )


def prices(dataset: xr.Dataset) -> Figure:
    """Time of each method for each answer, at its cheapest correct setting, which stands below;
    red: the number of settings that give a wrong answer without a warning."""
    answered = dataset.to_dataframe().query("line not in @MODELS")
    names = [name for name in HEADS if name in dataset["answer"].values]
    labels = answered.drop_duplicates("line")["label"]
    lines = [*answered["line"].unique()]
    figure, [ax] = panels(PAGE, 0.9 + 0.4 * len(lines))
    colors = ScalarMappable(LogNorm(1e-3, 1e3), colormaps["YlGnBu"])
    for (line, name), part in answered.groupby(["line", "answer"], sort=False):
        column, row = names.index(str(name)), lines.index(line)
        wrong = (part["verdict"] == WRONG).sum()
        face: Any = "#F4F4F4"
        texts = [("wrong", 6.5, _RED) if wrong else ("no answer", 6.5, GREY)]
        for _, best in part[part["verdict"] == RIGHT].nsmallest(1, "seconds").iterrows():
            seconds = best["seconds"]
            face, ink = colors.to_rgba(seconds), "white" if seconds > 3.0 else BLACK
            price = (
                f"{1e3 * seconds:.2g} ms"
                if seconds < 0.1
                else f"{seconds:.{'2g' if seconds < 100.0 else '0f'}} s"
            )
            setting = f"{best['setting']:.0e}".replace("e-0", "e-").replace("e+00", "")
            phrase = SETTINGS[best["varies"]][1].format(setting)
            texts = [(price, 6.5, ink), (phrase, 6.0, ink)]
            texts += [(f"wrong at {wrong}", 6.0, _RED)] if wrong else []
        ax.add_patch(
            Rectangle(
                (column - 0.5, row - 0.5), 1, 1, facecolor=face, edgecolor="white", linewidth=1.5
            )
        )
        for i, (text, size, ink) in enumerate(texts):
            height = row + 0.3 * (i - 0.5 * (len(texts) - 1))
            halo = _HALO if ink == _RED else None
            ax.text(
                column,
                height,
                text,
                ha="center",
                va="center",
                fontsize=size,
                color=ink,
                path_effects=halo,
            )
    ax.set_xticks(range(len(names)), [HEADS[name] for name in names], fontsize=7)
    ax.set_yticks(range(len(lines)), labels, fontsize=7)
    ax.set(xlim=(-0.5, len(names) - 0.5), ylim=(len(lines) - 0.5, -0.5))
    ax.tick_params(length=0, top=False, labeltop=True, bottom=False, labelbottom=False)
    ax.spines[:].set_visible(False)
    figure.colorbar(colors, ax=ax, shrink=0.7, pad=0.01, label="Time on one core (s)")
    return figure


# ---- How cost grows
def scaling(dataset: xr.Dataset) -> Figure:
    """Processor time of maps over their number of points, and of a point over the number of modes
    and the horizon."""
    rows = dataset.to_dataframe()
    rows["each"] = 1e3 * rows["seconds"] / rows["points"]
    figure, axes = panels(PAGE, 2.4, 1, 3)
    for ax, (varies, xlabel, shown, ylabel), letter in zip(
        axes, _TEXTS["scaling"], "abc", strict=True
    ):
        for quantity, part in rows[rows["varies"] == varies].groupby("quantity"):
            (name, offset), look = _TEXTS["maps"][quantity], LINES[str(quantity)]
            ax.plot(part[varies], part[shown], markersize=3.5, **look)
            x, y = (part[column].iloc[2 * len(part) // 3] for column in (varies, shown))
            drawing.say(ax, name, (x, y), offset, color=look["color"])
        ax.margins(0.08)
        ax.set(xscale="log", yscale="log", xlabel=xlabel, ylabel=ylabel)
        ax.set_ylim(bottom=10.0 ** math.floor(math.log10(ax.get_ylim()[0])))
        ax.yaxis.set_minor_formatter(NullFormatter())
        drawing.letter(ax, letter)
    return figure


# ---- Where methods fail
def failure_maps(*maps: xr.Dataset) -> Figure:
    """One panel per method: verdict over setting and number of modes, with lines that explain the
    borders."""
    return _map_panels(maps, _TEXTS["verdicts"], _TEXTS["borders"], row=1.45, more=0.75)


def answer_maps(*maps: xr.Dataset) -> Figure:
    """One panel per method: whether it finds the first separation, over setting and number of
    modes."""
    return _map_panels(maps, _TEXTS["answered"], {}, row=1.35, more=0.4)


def _map_panels(
    maps: Sequence[xr.Dataset],
    verdicts: Mapping[str, tuple[str, str]],
    borders: Mapping[Any, str],
    **size: float,
) -> Figure:
    """Panels with the shades of verdicts, fine settings on the right, and a legend of what occurs
    and of borders."""
    figure, axes = _panels(len(maps), "Real modes", columns=4, **size)
    shades = np.array([to_rgb(shade) for _, shade in verdicts.values()])
    for ax, dataset_of_map, letter in zip(axes, maps, "abcdefghijklmnop", strict=False):
        dataset = dataset_of_map.sortby("value")
        x, rows = np.log(dataset["value"].values), np.arange(dataset.sizes["diameters"] + 1) - 0.5
        whole = np.pad(x, 1, "reflect", reflect_type="odd")
        edges = np.exp(0.5 * (whole[1:] + whole[:-1]))  # halfway between values in the logarithm
        ax.pcolormesh(edges, rows, shades[dataset["verdict"].values])
        ax.set(xscale="log", xlim=(edges[-1], edges[0]))
        ax.set_yticks(rows[:-1] + 0.5, [f"{int(n)}" for n in dataset["modes"].values])
        ax.set_xlabel(SETTINGS[dataset.attrs["setting"]][0], labelpad=1)
        suffix = ", contact" if dataset.attrs.get("scene") == "stick_slip" else ""
        drawing.letter(ax, letter, f"{dataset.attrs['label']}{suffix}", fontsize=7)
        for style, values in _borders(dataset) if borders else ():
            stairs = np.repeat(np.clip(values, edges[0], edges[-1]), 2)
            for color, dashes, width in (("white", "-", 2.4), (BLACK, style, 1.4)):
                ax.plot(
                    stairs, np.repeat(rows, 2)[1:-1], color=color, linestyle=dashes, linewidth=width
                )
    used = np.unique(np.concatenate([dataset["verdict"].values.ravel() for dataset in maps]))
    named = [verdict for number, verdict in enumerate(verdicts.values()) if number in used]
    shaded = [Patch(facecolor=shade, edgecolor=GREY, label=word) for word, shade in named]
    lines = [
        Line2D([], [], color=BLACK, linewidth=1.4, linestyle=style, label=word)
        for style, word in borders.items()
    ]
    figure.legend(handles=[*shaded, *lines], loc="outside lower center", ncols=3)
    return figure


def _borders(dataset: xr.Dataset) -> Iterator[tuple[str, np.ndarray]]:
    """Line style and values, one per row, of the lines that explain where a method fails."""
    setting = dataset.attrs["setting"]
    if setting == "step":
        yield "-", dataset["step_limit"].values
        if dataset.attrs["scene"] == "separating":
            yield ":", dataset["shortest_phase"].values
    elif setting == "epsilon":
        yield "--", dataset["stiff_epsilon"].values
    elif np.isfinite(dataset["longest_step"].values).any():
        # the coarsest setting whose steps are no longer than the shortest phase; beyond the axis
        # without one
        value, crossings = dataset["value"].values, []
        for row, shortest in zip(
            dataset["longest_step"].values, dataset["shortest_phase"].values, strict=True
        ):
            fine = np.flatnonzero(row <= shortest)
            pair = value[fine[-1] : fine[-1] + 2] if fine.size else np.zeros(1)
            crossings.append(math.sqrt(pair[0] * pair[-1]))
        yield ":", np.array(crossings)


# ---- How many modes
_CASES = [
    Look(color=color, marker=mark)
    for color, mark in zip((BLUE, GREEN, ORANGE, PURPLE), "os^D", strict=True)
]
_CONTACTS: dict[str, Look] = {
    "residual": {"linestyle": "-"},
    "rigid": {"linestyle": "--", "markerfacecolor": "white"},
}  # filled or hollow
FAR = 25.0  # greatest difference of first separations to that of the largest model that is shown to scale, per cent


def contact_truncation(dataset: xr.Dataset) -> Figure:
    """Effect of residual flexibility (filled; hollow: rigid contact) against the number of real
    modes; one colour per case. Arrows at the edge mark values far outside the panel, crosses at the
    foot models without a cycle."""
    first = dataset["first_separation"]
    late = 100 * (first / first.sel(contact="residual").isel(model=-1) - 1)
    part = dataset.assign(u_range=1e3 * dataset["u_range"], late=late)
    lines = [
        (
            part.isel(case=i).sel(contact=contact),
            look | {"markersize": 3, "linewidth": 0.8, "markeredgewidth": 0.7},
        )
        for i, of_case in zip(range(part.sizes["case"]), cycle(_CASES))
        for contact, of_contact in _CONTACTS.items()
        for look in [of_case | of_contact]
    ]
    figure, shown = panels(PAGE, 3.9, 2, 4, sharex=True)
    axes = {}
    for ax, (variable, label, log), letter in zip(
        shown, _TEXTS["contact_truncation"], "abcdefgh", strict=True
    ):
        axes[variable] = ax
        for line, look in lines:
            y = line[variable].values
            good = np.isfinite(y) & ((y > 0) | (not log))
            ax.plot(line["modes"].values[good], y[good], **look)
        ax.set(xscale="log", yscale="log" if log else "linear")
        ax.margins(x=0.06)
        drawing.letter(ax, letter, label, fontsize=7)
        ax.set_xticks((1, 3, 10, 30, 100), ["1", "3", "10", "30", "100"])
        for axis in (ax.xaxis, ax.yaxis):
            axis.set_minor_formatter(NullFormatter())
    for ax in shown[4:]:
        ax.set_xlabel("Real modes")
    for ax in shown:
        ax.autoscale(False)
    axes["late"].set_ylim(-FAR, FAR)
    axes["late"].axhline(0, color=GREY, linewidth=0.6, linestyle=":", zorder=0)
    arrow: Look = {"markersize": 3, "alpha": 0.7}
    for line, look in lines:
        behind = line["late"].values
        for name, extreme, height, mark, size in (
            ("late", behind > FAR, 0.98, "^", arrow),
            ("late", behind < -FAR, 0.02, "v", arrow),
            (
                "growth_rate",
                ~np.isfinite(line["growth_rate"].values),
                0,
                "x",
                {"markersize": 3.5, "zorder": 4},
            ),
        ):
            if extreme.any():
                x, edge = line["modes"].values[extreme], axes[name].get_xaxis_transform()
                style = size | {"color": look["color"], "transform": edge, "clip_on": False}
                axes[name].plot(x, np.full(x.size, height), mark, **style)
    cases = json.loads(dataset.attrs["cases"])
    described = [{"normalization": "as_published"} | cases[name] for name in dataset["case"].values]
    labels = [
        f"{case['normalization'].replace('_', ' ')}, {values_text(case)}" for case in described
    ]
    named = [
        look | {"linestyle": "-", "label": label} for label, look in zip(labels, cycle(_CASES))
    ]
    named += [
        look | {"color": BLACK, "marker": "o", "label": contact}
        for contact, look in _CONTACTS.items()
    ]
    named += [{"linestyle": "", "color": BLACK, "marker": "x", "label": "no cycle found"}]
    handles = [Line2D([], [], markersize=4, **look) for look in named]
    figure.legend(handles=handles, loc="outside lower center", ncols=6 if len(handles) < 7 else 3)
    return figure


def draw(name: str, datasets: Iterable[xr.Dataset]) -> Figure:
    """Draw a figure by its name, in the common style."""
    with drawing.styled():
        figure: Figure = globals()[name](*datasets)
    return figure
