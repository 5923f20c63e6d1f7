"""Heat maps: any variable of a grid study over two of its dimensions."""

from collections.abc import Mapping, Sequence
from textwrap import fill
from typing import Any, Literal

import numpy as np
import xarray as xr

from disc_model.data.variables import EXCLUDED
from disc_model.figures import drawing
from disc_model.figures.cells import CYCLE_LOOKS, edges_of, growth_panels, patches
from disc_model.figures.drawing import (
    BLUE,
    COLUMN,
    GREEN,
    GREY,
    ORANGE,
    PAGE,
    PURPLE,
    SKY,
    VERMILION,
    Axes,
    Figure,
    Patch,
    ScalarMappable,
    panels,
)
from disc_model.figures.general import General, colour_bar, in_steps, remaining, scale

WORDS = (BLUE, ORANGE, GREEN, VERMILION, SKY, PURPLE, GREY)
"""Colours of the values of a flag."""
HATCH: dict[str, Any] = {"facecolor": "white", "hatch": "//////", "edgecolor": GREY}
"""Look of missing values."""


class HeatMap(General):
    """A variable in colour over two dimensions; a panel for each value of a third, if wanted."""

    kind: Literal["heat_map"] = "heat_map"
    y: str

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw panels with a common colour scale; missing values are hatched.

        Growth rates have the colours of all growth maps; variables of both signs are centred on 0.
        """
        from matplotlib.colors import ListedColormap
        from matplotlib.patches import Patch

        study = drawing.picked(study, self.at)
        ruled = EXCLUDED in study["status"].attrs["flag_meanings"]
        left_out = drawing.statuses(study) == EXCLUDED
        found = study[self.variable].where(~left_out) if ruled else study[self.variable]
        by = remaining(found, self)
        shown = drawing.slices(found, by)
        figure, axes = panels(PAGE if len(shown) > 1 else COLUMN * 1.2, 2.9, 1, len(shown), sharex=True, sharey=True)
        handles: list[Patch] = []
        if self.variable == "growth_rate" and not self.log:
            handles = _growth(figure, axes, study, self, by)
        else:
            words, colours = drawing.flags_of(found), _colours(found, self)
            for ax, (_, panel) in zip(axes, shown, strict=True):
                ax.patch.set(linewidth=0, **HATCH)
                mesh = _cells(ax, panel, self, **colours)
            if ruled:
                for ax, (_, panel) in zip(axes, drawing.slices(left_out, by), strict=False):
                    _cells(ax, panel.where(panel), self, cmap=ListedColormap(["white"]))
                handles += patches(CYCLE_LOOKS, {EXCLUDED})
            colour_bar(figure, axes, mesh, drawing.label_of(found)[0], words)
            if not words and (gaps := drawing.gaps(study, found)):
                handles.append(Patch(label=", ".join(gaps), **HATCH))
        for axis, name in self.axes.items():  # axes are shared
            axes[0].set(**{f"{axis}scale": scale(name, study[name].values)})
        width = round(figure.get_figwidth() / len(axes) / 0.08)
        # a value stays on the line of its name
        names = [
            fill(f"({letter}) " + text.replace(" = ", "\u00a0=\u00a0"), width)
            for letter, (text, _) in zip("abcd", shown, strict=False)
        ]
        for ax, name in zip(axes, names, strict=True):
            ax.set_title(name if len(axes) > 1 else "", loc="left")
            ax.set(xlabel=drawing.label_of(found[self.x])[0], ylabel=drawing.label_of(found[self.y])[0])
            ax.label_outer()
        if handles:
            figure.legend(handles=handles, loc="outside lower right", ncols=len(handles))
        return figure


def _growth(figure: Figure, axes: Sequence[Axes], study: xr.Dataset, plot: HeatMap, by: str | None) -> list[Patch]:
    """Draw growth rates, or the status without a cycle, as in all growth maps."""
    names = [name for name in ("growth_rate", "cycle", "status", "sliding_growth_rate") if name in study]
    shown = [one.transpose(plot.y, plot.x) for _, one in drawing.slices(study[names], by)]
    return patches(CYCLE_LOOKS, growth_panels(figure, axes, shown))


def _cells(ax: Axes, panel: xr.DataArray, plot: HeatMap, **colours: Any) -> ScalarMappable:
    """Draw the values of a panel in colour, where there are any."""
    from matplotlib.colors import LogNorm

    plane = panel.transpose(plot.y, plot.x)
    values = np.ma.masked_invalid(plane.values.astype(float))
    if isinstance(colours.get("norm"), LogNorm):
        values = np.ma.masked_where(values <= 0, values)
    return ax.pcolormesh(*edges_of(plane, scale), values, rasterized=True, **colours)


def _colours(found: xr.DataArray, plot: HeatMap) -> dict[str, Any]:
    """Colour map and scale for matplotlib."""
    from cmcrameri import cm
    from matplotlib.colors import LogNorm, Normalize

    if words := drawing.flags_of(found):
        return in_steps([WORDS[i % len(WORDS)] for i in range(len(words))])
    values = found.values[np.isfinite(found.values)]
    if plot.log:
        above = values[values > 0]
        low, high = (above.min(), above.max()) if above.size else (1.0, 10.0)
        return {"cmap": cm.batlow, "norm": LogNorm(low, high if high > low else 10 * low)}
    low, high = (float(values.min()), float(values.max())) if values.size else (0.0, 1.0)
    if low < 0 < high:
        most = max(-low, high)
        return {"cmap": cm.vik, "norm": Normalize(-most, most)}
    return {"cmap": cm.batlow, "norm": Normalize(low, high)}
