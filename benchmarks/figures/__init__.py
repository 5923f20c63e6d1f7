"""Figures of the benchmark, from its datasets.

They show speed against accuracy, failures of methods, costs of answers, and effects of truncation.
"""

from collections.abc import Callable, Iterable

import xarray as xr
from matplotlib.figure import Figure

from benchmarks.figures.maps import answer_maps, failure_maps
from benchmarks.figures.replies import answers, prices
from benchmarks.figures.speed import overview, scaling
from benchmarks.figures.truncation import contact_truncation
from disc_model.figures.draw import styled

FIGURES: dict[str, Callable[..., Figure]] = {
    "overview": overview,
    "answers": answers,
    "prices": prices,
    "scaling": scaling,
    "failure_maps": failure_maps,
    "answer_maps": answer_maps,
    "contact_truncation": contact_truncation,
}
"""Functions that draw figures, by their names."""


def draw(name: str, datasets: Iterable[xr.Dataset]) -> Figure:
    """Draw a figure by its name, in the common style."""
    with styled():
        return FIGURES[name](*datasets)
