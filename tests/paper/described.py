"""Figures of the paper's kinds, of one case and of made-up maps, for their descriptions."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

import xarray as xr
from matplotlib.figure import Figure

from disc_model.figures.render import render
from tests.figures.description import write_all
from tests.figures.test_cases import simulated
from tests.paper import evidence
from tests.paper.test_figures import ONE_OF_EACH, STUDY, drawn

FOLDER = Path(__file__).with_name("descriptions")


def of_case(name: str) -> Figure:
    """Return a figure of the paper that is drawn from a case which separates after 54 s."""
    return drawn(name, simulated(True))


def on_both_scales() -> Figure:
    """Return the comparison of both scales of the modes, of made-up maps."""
    plot = STUDY.figures["figB2"]
    maps = evidence.scans()
    inputs = {name: xr.DataTree(maps[name]) for name in plot.overlays}
    return render(plot, {"study": xr.DataTree(maps["map_N"]), **inputs})


DESCRIBED: dict[str, Callable[[], Figure]] = {
    **{name: partial(of_case, name) for name in ONE_OF_EACH},
    "figB2": on_both_scales,
}
"""Figures by their names in the study of the paper."""


if __name__ == "__main__":
    write_all(FOLDER, DESCRIBED)
