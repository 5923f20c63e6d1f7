"""The functions that draw each kind of figure."""

from collections.abc import Callable, Mapping

from disc_model.figures import (
    basins,
    bifurcation,
    branches,
    campbell,
    case_figures,
    case_sections,
    critical_speed,
    curve,
    escape,
    heat_map,
    late_range,
    locking,
    ramps,
    range_law,
    region_map,
    sensitivity,
    sliding_modes,
    sliding_outcome,
    spectrogram,
)
from disc_model.figures.kinds import table_of
from disc_model.figures.types import Figure

Drawings = Mapping[str, Callable[..., Figure]]
DRAWINGS: Drawings = {
    "basins": basins.draw,
    "bifurcation": bifurcation.draw,
    "branches": branches.draw,
    "campbell": campbell.draw,
    "critical_speed": critical_speed.draw,
    "curve": curve.draw,
    "escape": escape.draw,
    "heat_map": heat_map.draw,
    "history": case_figures.history,
    "late_range": late_range.draw,
    "phase_map": locking.draw_map,
    "poincare": case_sections.sections_of_cases,
    "portrait": case_figures.portrait,
    "ramps": ramps.draw,
    "range_law": range_law.draw,
    "region_map": region_map.draw,
    "sensitivity": sensitivity.draw,
    "sliding_modes": sliding_modes.draw,
    "sliding_outcome": sliding_outcome.draw,
    "spectrogram": spectrogram.draw,
    "spectrum": case_figures.spectrum,
    "staircase": locking.draw_staircase,
}
"""Functions that draw a kind: from the figure, its study and further ones by their roles, or from the
figure and its cases."""


def drawing_of(kind: str) -> Callable[..., Figure]:
    """The function that draws a kind, such as ``heat_map`` or ``paper.light_slider``."""
    part = kind.rpartition(".")[0]
    drawings: Drawings = table_of(part, "drawings", "DRAWINGS") if part else DRAWINGS
    return drawings[kind]
