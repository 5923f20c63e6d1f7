"""The drawings of the paper's kinds of figures."""

from collections.abc import Callable, Mapping

from disc_model.figures.types import Figure
from workflow.paper.figures import (
    composite,
    contact_force,
    four_stretches,
    histories,
    instants,
    light_slider,
    one_separation,
    response,
    scales,
    schematic,
    with_and_without,
)

DRAWINGS: Mapping[str, Callable[..., Figure]] = {
    "paper.composite": composite.draw,
    "paper.contact_force": contact_force.draw,
    "paper.four_stretches": four_stretches.draw,
    "paper.histories": histories.draw,
    "paper.instants": instants.draw,
    "paper.light_slider": light_slider.draw,
    "paper.one_separation": one_separation.draw,
    "paper.response": response.draw,
    "paper.scales": scales.draw,
    "paper.schematic": schematic.draw,
    "paper.with_and_without": with_and_without.draw,
}
"""Functions that draw a kind from the figure and its cases, or its studies."""
