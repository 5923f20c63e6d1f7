"""The kinds of figures, by the names that study files use."""

from importlib import import_module
from typing import Any

from disc_model.errors import Fault, ParameterError, suggestion
from disc_model.figures.kinds.base import NORM, CasePlot, Compared, Kind, Plot, si_unit
from disc_model.figures.kinds.cases import (
    History,
    PoincareSections,
    Portrait,
    Spectrogram,
    Spectrum,
)
from disc_model.figures.kinds.general import CurvePlot, General, HeatMap
from disc_model.figures.kinds.maps import CriticalSpeed, RampedSpeeds, RegionMap, SlidingOutcome
from disc_model.figures.kinds.motions import (
    BasinShares,
    Bifurcation,
    Branches,
    Campbell,
    EscapeShares,
    LateRange,
    PhaseMap,
    RangeLawPlot,
    Sensitivity,
    SlidingModes,
    Staircase,
)

__all__ = [
    "KINDS",
    "NORM",
    "CasePlot",
    "Compared",
    "General",
    "Kind",
    "Plot",
    "RegionMap",
    "kind_of",
    "kinds_in",
    "si_unit",
    "table_of",
]

KINDS: dict[str, type[Kind]] = {
    "basins": BasinShares,
    "bifurcation": Bifurcation,
    "branches": Branches,
    "campbell": Campbell,
    "critical_speed": CriticalSpeed,
    "curve": CurvePlot,
    "escape": EscapeShares,
    "heat_map": HeatMap,
    "history": History,
    "late_range": LateRange,
    "phase_map": PhaseMap,
    "poincare": PoincareSections,
    "portrait": Portrait,
    "ramps": RampedSpeeds,
    "range_law": RangeLawPlot,
    "region_map": RegionMap,
    "sensitivity": Sensitivity,
    "sliding_modes": SlidingModes,
    "sliding_outcome": SlidingOutcome,
    "spectrogram": Spectrogram,
    "spectrum": Spectrum,
    "staircase": Staircase,
}
"""Kinds of this package."""


def table_of(part: str, module: str, name: str) -> Any:
    """A table of a part of the workflow that has figures of its own, such as ``paper``.

    Such a part lies beside the package, and may be absent: only a file that asks for a kind such as
    ``paper.light_slider`` brings it in. Its module ``figures.kinds`` lists kinds as `KINDS`, and
    ``figures.drawings`` what draws them as `DRAWINGS`. Raises `ModuleNotFoundError` without it.
    """
    return getattr(import_module(f"workflow.{part}.figures.{module}"), name)


def kinds_in(part: str) -> dict[str, type[Kind]]:
    """All kinds by their names: those of a part of the workflow such as ``paper``, or of this package,
    whose name is ""."""
    kinds: dict[str, type[Kind]] = table_of(part, "kinds", "KINDS") if part else KINDS
    return kinds


def kind_of(name: Any) -> type[Kind]:
    """The kind of a name, such as ``heat_map``, or ``paper.light_slider``; raises
    `ParameterError`."""
    part = str(name).rpartition(".")[0]
    try:
        return kinds_in(part)[name]
    except (ModuleNotFoundError, AttributeError, KeyError, TypeError) as error:
        fault = Fault.of(("kind",), name, f"unknown kind of figure{suggestion(name, KINDS)}")
        raise ParameterError(fault) from error
