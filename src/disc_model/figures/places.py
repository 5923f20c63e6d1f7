"""Places of axes on their page, without a picture of all that is on it, which takes longer."""

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
