"""Poincaré sections and phase portraits of one case: the slider in the disc's plane, and a point of the disc.

Figures 4 to 9, 12, 14, 16 to 22, A1 and A2 of the paper.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from disc_model.analysis.classify import closure
from disc_model.analysis.poincare import stages
from disc_model.analysis.settling import settling
from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.data.variables import EVENT_KINDS, PHASES
from disc_model.figures import drawing
from disc_model.figures.drawing import AFTER, BEFORE, BLACK, COLUMN, PAGE, PHASE_COLOURS, SEPARATED, panels
from disc_model.parameters import Parameters

MARKS: dict[str, dict[str, Any]] = {
    "early": {"marker": "x", "color": BEFORE, "s": 9, "linewidths": 0.5},
    "later": {"marker": "o", "color": AFTER, "s": 3.5, "linewidths": 0},
    "separated": {"marker": "^", "color": SEPARATED, "s": 8, "linewidths": 0},
}
"""Symbol by stage: told apart by shape as well as by colour."""
BY_SEPARATION = {"early": "in contact, before", "later": "in contact, after", "separated": "separated"}
BY_SETTLING = {"early": "not shown to have settled", "later": "settled", "separated": "separated"}


def sections(case: xr.DataTree, *others: xr.DataTree, window: str = "poincare") -> Figure:
    """Draw (a) psi' over psi of the slider, (b) velocity over displacement of the disc at r_0 and a fixed angle.

    The axes of (a) fit other cases too, so that figures of a pair can be compared.
    """
    figure, [slider, disc] = panels(PAGE, 2.75, 1, 2)
    samples = dataset.samples(case, window, at_least=1)
    first, time = float(case["first_separation"]), samples["time"].values
    since = np.max([settling(time, samples[name].values).since for name in ("psi", "w_point")])
    found = stages(time, samples["phase"].values, first, float(since))
    drawing.letters((slider, disc))
    for ax, name in ((slider, "psi"), (disc, "w_point")):
        room = [samples, *(dataset.samples(other, window, at_least=1) for other in others if ax is slider)]
        at = []
        for axis, one in (("x", name), ("y", f"{name}_velocity")):
            label, factor, _ = drawing.sampled(one, samples)
            at.append(samples[one].values * factor)
            limits = _around(np.concatenate([each[one] for each in room]) * factor)
            ax.set(**{f"{axis}label": label, f"{axis}lim": limits})
        for order, stage in enumerate(MARKS):  # later stages are drawn over earlier ones
            there = getattr(found, stage)
            look = MARKS[stage] | {"zorder": 2 + 0.1 * order, "rasterized": bool(there.sum() > 2000)}
            ax.scatter(*(values[there] for values in at), **look)
    names = BY_SEPARATION if found.divided_by_separation else BY_SETTLING
    names = {stage: name for stage, name in names.items() if getattr(found, stage).any()}
    handles = [disc.scatter([], [], label=name, **(MARKS[stage] | {"s": 14})) for stage, name in names.items()]
    bonded = Parameters.model_validate_json(case.attrs["parameters"]).contact == "bonded"
    title = "Separation ignored:" if bonded else "No separation:"
    if found.divided_by_separation:
        title = f"First separation at {first:.2f} s:"
    handles.insert(0, disc.scatter([], [], s=0, label=title))
    figure.legend(handles=handles, loc="outside lower right", ncols=len(handles), handletextpad=0.2)
    return figure


def _around(values: np.ndarray) -> tuple[float, float]:
    """Limits of an axis with room for the marks."""
    low, high = float(values.min()), float(values.max())
    margin = 0.05 * (high - low) or 1e-6 * max(abs(high), 1e-6)
    return low - margin, high + margin


def portrait(case: xr.DataTree, *, window: str = "orbit", x: str = "psi", y: str = "psi_velocity") -> Figure:
    """Draw one variable over another in a window, coloured by phase."""
    figure, [ax] = panels(COLUMN, 2.7)
    samples = dataset.samples(case, window)
    (across, in_x, _), (up, in_y, _) = (drawing.sampled(name, samples) for name in (x, y))
    for i, name in enumerate(PHASES):
        inside = samples["phase"].values == i
        look: dict[str, Any] = {"color": PHASE_COLOURS[name], "label": name}
        width = 1.5 if name == "separation" else 0.5  # distinct in grey print
        if inside.any():
            # broken where the phase changes, so that no chord is drawn across others
            height = np.where(inside, samples[y].values * in_y, np.nan)
            ax.plot(samples[x].values * in_x, height, linewidth=width, rasterized=True, **look)
    ax.margins(0.04)
    for line in drawing.legend_above(ax).get_lines():
        line.set_linewidth(line.get_linewidth() + 0.5)
    ax.set(xlabel=across, ylabel=up)
    return figure


def closures(*cases: xr.DataTree, titles: Sequence[str]) -> Figure:
    """Draw differences between release intervals and those n later, against n: small where a motion repeats."""
    figure, axes = panels(PAGE, 2.6, 1, len(cases), sharey=True)
    for ax, case in zip(axes, cases, strict=True):
        with drawing.blank_if_missing(ax):
            events = dataset.events(case)
            released = events["time"].values[events["kind"].values == EVENT_KINDS.index("stick_to_slip")]
            counts = np.arange(1, (len(released) - 1) // 2 + 1)
            if not counts.size:
                raise Missing("keeps no two releases of stick")
            rounding = np.spacing(released[-1])  # intervals that agree exactly have no place on a logarithmic scale
            differences = [max(closure(np.diff(released), int(n)), rounding) for n in counts]
            ax.plot(counts, differences, ".", color=BLACK, markersize=3)
            ax.set(xscale="log", yscale="log", xlabel="Releases n")
            ax.margins(0.04)
    drawing.letters(axes, titles)
    axes[0].set_ylabel("Largest difference (s)")
    return figure
