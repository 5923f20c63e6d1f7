"""Which of the paper's separations survive its own Eq. (17), by what the ledger is judged by, as no
other figure."""

from collections.abc import Mapping
from typing import Any, ClassVar, Literal

import numpy as np
import pandas as pd
import xarray as xr

from disc_model.data.variables import flag_names, stated_in
from disc_model.disc.plate import plate_modes
from disc_model.figures import drawing
from disc_model.figures.cells import edges_of, paint, patches
from disc_model.figures.classes import Look
from disc_model.figures.drawing import BLACK, GREY, PAGE, SEPARATED, Axes, Figure, panels
from disc_model.figures.kind import Plot, Role, Roles
from disc_model.figures.legends import figure_legend
from disc_model.parameters import Parameters

SCALES = ("as_published", "orthonormal")
LOOKS: tuple[dict[str, Any], ...] = (
    {"label": "as published", "marker": "o", "color": SEPARATED, "linestyle": "none"},
    {
        "label": "by Eq. (17)",
        "marker": "o",
        "markerfacecolor": "white",
        "color": drawing.BLUE,
        "linestyle": "none",
    },
)
CELLS = {
    "neither": Look("with neither", "#ffffff"),
    "published": Look("only as published", "#f2b69c"),
    "orthonormal": Look("only by Eq. (17)", "#d5e5f3", 4 * "\\"),
    "both": Look("with both", "#8a8a8a"),
}
"""With which normalization the static start separates. They differ in grey print."""


class Scales(Plot):
    """(a) Squared amplitudes under the slider, (b) where the static start separates on the map over
    speed and preload, (c) first separations on this and further maps."""

    quantities: ClassVar = ("regions",)
    needs: ClassVar = ("N", "Omega")
    several: ClassVar = True
    roles: ClassVar[Roles] = {
        f"map_{name}": Role("regions", (other, name), required=True)
        for name, other in (("D_star", "Omega"), ("c_p", "N"), ("k_p", "Omega"), ("m", "Omega"))
    }
    kind: Literal["paper.scales"] = "paper.scales"

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        from disc_model.paper import section2

        figure, axes = panels(PAGE, 2.9, 1, 3, width_ratios=(0.8, 1.25, 1.2))
        points = section2.separating_points({"map_N": study, **overlays})
        _amplitudes(axes[0], section2.BASE)
        _regions(
            axes[1],
            study,
            {x: point for x, point in points.items() if section2.SEPARATING[x][0] == "map_N"},
        )
        _times(axes[2], points, section2.first_separations(points))
        drawing.letters(axes)
        figure_legend(
            figure,
            patches(CELLS.values()),
            loc="outside lower center",
            title="(b) The static start separates",
        )
        return figure


def _amplitudes(ax: Axes, p: Parameters) -> None:
    squares = [
        plate_modes(p.replace(normalization=scale))["psi"].to_numpy() ** 2 for scale in SCALES
    ]
    for values, look in zip(squares, LOOKS, strict=True):
        ax.plot(range(len(values)), values, markersize=5, **look)
    ratio = squares[0][1] / squares[1][1]
    arrow = {"arrowstyle": "-|>", "color": GREY, "linewidth": 1.0, "shrinkA": 4, "shrinkB": 4}
    ax.annotate("", (1, squares[0][1]), (1, squares[1][1]), arrowprops=arrow)
    drawing.say(ax, f"× {ratio:.0f}", (1, float(np.sqrt(squares[0][1] * squares[1][1]))), (5, 0))
    label = r"Amplitude under the slider $\Psi_l^2$ (1/kg)"
    ax.set(yscale="log", xlabel="Nodal diameters l", ylabel=label, xticks=range(5), ylim=(0.7, 110))
    ax.margins(x=0.12)
    ax.legend(loc="upper right", bbox_to_anchor=(1.04, 0.88))


def _regions(ax: Axes, study: xr.Dataset, points: Mapping[str, xr.Dataset]) -> None:
    outcome = study["outcome"].sel(normalization=[*SCALES]).transpose("normalization", "N", "Omega")
    published, orthonormal = flag_names(outcome) == "separation"
    words = np.where(published, "published", "neither")
    words = np.where(orthonormal, "orthonormal", words)
    words = np.where(published & orthonormal, "both", words)
    paint(ax, edges_of(outcome[0]), words, CELLS)
    for name, point in points.items():
        x, y = float(point["Omega"]), float(point["N"])
        fill = SEPARATED if np.all(flag_names(point["outcome"]) == "separation") else "white"
        ax.plot(x, y, "o", color=BLACK, markerfacecolor=fill, markersize=5, clip_on=False)
        side = (5 if name in ("Fig. 2", "Fig. 7") else -5, 0)
        drawing.say(ax, name, (x, y), side, fontsize=7, path_effects=drawing.halo())
    ax.set(xlabel=drawing.label_of(study["Omega"])[0], ylabel=drawing.label_of(study["N"])[0])


def _times(ax: Axes, points: Mapping[str, xr.Dataset], firsts: pd.DataFrame) -> None:
    horizons = {
        name: float(stated_in(point, "options")["horizon"]) for name, point in points.items()
    }
    times = firsts.sort_values("as_published", ascending=False)
    for height, (name, row) in enumerate(times.iterrows()):
        was, now = (float(row[scale]) for scale in SCALES)
        none = np.isnan(now)
        arrow = {
            "arrowstyle": "-|>" if none else "-",
            "color": GREY,
            "linewidth": 1.0,
            "shrinkA": 0,
            "shrinkB": 0,
        }
        end = max(horizons[str(name)], 1.3 * was) if none else now
        ax.annotate("", (end, height), (was, height), arrowprops=arrow)
        for time, look in zip((was, now), LOOKS, strict=True):
            ax.plot([time], [height], markersize=5, **look)
        drawing.say(
            ax, str(name), (0, height), (-3, 0), xycoords=("axes fraction", "data"), fontsize=7
        )
    lost = int(times["orthonormal"].isna().sum())
    ax.set(xscale="log", xlabel="First separation (s)", xlim=(25, 1.6 * max(horizons.values())))
    ax.set(yticks=[], ylim=(-0.6, len(times) - 0.4), ylabel=" ")
    ax.set_title(f"{lost} of {len(times)}: none by Eq. (17)", loc="right")
