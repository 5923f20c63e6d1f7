"""Poincaré sections of a case, once a turn of the drive: the slider in the disc's plane, and a point of the disc."""

from collections.abc import Iterator
from typing import Any, Literal

import numpy as np
import xarray as xr

from disc_model.analysis.poincare import stages
from disc_model.analysis.settling import settling
from disc_model.data import dataset
from disc_model.figures import drawing
from disc_model.figures.drawing import AFTER, BEFORE, PAGE, SEPARATED, Figure, panels
from disc_model.figures.kind import CasePlot, Need
from disc_model.parameters import Parameters

MARKS: dict[str, dict[str, Any]] = {
    "early": {"marker": "x", "color": BEFORE, "s": 9, "linewidths": 0.5},
    "later": {"marker": "o", "color": AFTER, "s": 3.5, "linewidths": 0},
    "separated": {"marker": "^", "color": SEPARATED, "s": 8, "linewidths": 0},
}
"""Symbol by stage: told apart by shape as well as by colour."""
BY_SEPARATION = {"early": "in contact, before", "later": "in contact, after", "separated": "separated"}
BY_SETTLING = {"early": "not shown to have settled", "later": "settled", "separated": "separated"}


class PoincareSections(CasePlot):
    """The Poincaré sections of slider and disc: (a) psi' over psi, (b) velocity over displacement of the disc at r_0.

    compared_with : cases that the axes of (a) fit too, so that figures of a pair can be compared
    """

    kind: Literal["poincare"] = "poincare"
    compared_with: tuple[str, ...] = ()

    @property
    def others(self) -> tuple[str, ...]:
        return self.compared_with

    def needs(self) -> Iterator[Need]:
        for case in self.cases:
            yield Need("case", case, "poincare")

    def draw(self, *cases: xr.DataTree) -> Figure:
        figure, [slider, disc] = panels(PAGE, 2.75, 1, 2)
        case = cases[0]
        samples, *compared = (dataset.samples(one, "poincare", at_least=1) for one in cases)
        first, time = float(case["first_separation"]), samples["time"].values
        since = np.max([settling(time, samples[name].values).since for name in ("psi", "w_point")])
        found = stages(time, samples["phase"].values, first, float(since))
        drawing.letters((slider, disc))
        for ax, name in ((slider, "psi"), (disc, "w_point")):
            fitted = [samples, *compared] if ax is slider else [samples]
            coordinates = []
            for axis, variable in (("x", name), ("y", f"{name}_velocity")):
                label, factor, _ = drawing.sampled(variable, samples)
                coordinates.append(samples[variable].values * factor)
                limits = _limits(np.concatenate([section[variable] for section in fitted]) * factor)
                ax.set(**{f"{axis}label": label, f"{axis}lim": limits})
            for order, stage in enumerate(MARKS):  # later stages are drawn over earlier ones
                there = getattr(found, stage)
                look = MARKS[stage] | {"zorder": 2 + 0.1 * order, "rasterized": bool(there.sum() > 2000)}
                ax.scatter(*(values[there] for values in coordinates), **look)
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


def _limits(values: np.ndarray) -> tuple[float, float]:
    """Limits of an axis with room for the marks."""
    low, high = float(values.min()), float(values.max())
    margin = 0.05 * (high - low) or 1e-6 * max(abs(high), 1e-6)
    return low - margin, high + margin
