"""The common style of all figures, and their files."""

import logging
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.style

from disc_model.figures.types import Figure

# the reports of fontTools on fonts would fill the logs of figures
logging.getLogger("fontTools").setLevel(logging.WARNING)

STYLE = Path(__file__).with_name("drawing.mplstyle")


def styled() -> AbstractContextManager[None]:
    """The common style instead of the user's settings, as a context."""
    return mpl.style.context(STYLE, after_reset=True)


def readers_style() -> AbstractContextManager[None]:
    """The common style where the reader's settings are those of matplotlib, as a context: what the
    reader has set stays."""
    style = mpl.rc_params_from_file(STYLE, use_default_template=False)
    free = {
        name: value
        for name, value in style.items()
        if mpl.rcParams[name] == mpl.rcParamsDefault[name]
    }
    return mpl.rc_context(free)


def save(figure: Figure, path: str | Path, title: str = "") -> None:
    """Write a figure with its title; equal figures give equal bytes. Further files have the layout
    of the first."""
    stamps = {".pdf": "CreationDate"}
    metadata: dict[str, Any] = {stamps.get(Path(path).suffix, "Software"): None}
    if title:
        metadata["Title"] = title
    with styled():
        figure.savefig(path, metadata=metadata)
        figure.set_layout_engine(None)  # not "none", with which all is drawn twice
