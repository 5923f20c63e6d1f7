"""Places of axes on their page, without a picture of all that is on it, which takes longer."""

import warnings
from typing import Any


def set_places(figure: Any) -> None:
    """Set the places of axes and of bars of colours, as drawing the page would."""
    page = figure.get_figure(root=True)
    engine = page.get_layout_engine()
    if engine is not None:
        engine.execute(page)
    for ax in page.axes:
        locate = ax.get_axes_locator()
        ax.apply_aspect(locate(ax, None) if locate else None)


def collapses(figure: Any) -> bool:
    """Set the places of axes; returns whether the layout gives up, since nothing would be left of a
    panel."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        set_places(figure)
    return any("collapsed to zero" in str(each.message) for each in caught)
