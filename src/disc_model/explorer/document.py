"""The explorer's page: contents of studies with pictures, style and script in one file."""

import json
from collections.abc import Mapping, Sequence
from importlib.resources import files
from itertools import groupby
from pathlib import Path
from typing import Any, NamedTuple

import jinja2
from cmcrameri import cm
from matplotlib.colors import Colormap, to_hex

from disc_model.explorer.call_names import names_of_calls
from disc_model.explorer.embedding import embedded
from disc_model.figures.classes import WEIGHTS
from disc_model.figures.colours import COMMON, LINEAR_OF_MEDIAN, LINEAR_SHARE, NEAR_END, ROUNDING
from disc_model.figures.drawing import PHASE_COLOURS
from disc_model.figures.selection import WITHOUT_CYCLE

SCRIPTS = (
    "contents",
    "view",
    "drawing",
    "lines",
    "samples",
    "empty",
    "modes",
    "map",
    "point",
    "motion",
    "link",
    "start",
)  # in the order of their dependence


class Picture(NamedTuple):
    heading: str
    title: str
    caption: str
    file: Path


def page(title: str, studies: Sequence[Mapping[str, Any]], pictures: Sequence[Picture]) -> str:
    """The whole page, for studies as from `study_contents`, and pictures grouped by heading."""
    contents = {
        "studies": studies,
        "maps": {"sequential": _colours(cm.batlow), "diverging": _colours(cm.vik)},
        "rates": {
            "rounding": ROUNDING,
            "common": COMMON,
            "linear_share": LINEAR_SHARE,
            "linear_of_median": LINEAR_OF_MEDIAN,
            "near_end": NEAR_END,
        },
        "phases": PHASE_COLOURS,
        "weights": WEIGHTS,
        "computed": ["ok", *WITHOUT_CYCLE],
        **names_of_calls(),
    }
    texts = json.dumps(contents, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    template = jinja2.Template(
        _part("page.html"), autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True
    )
    return template.render(
        title=title,
        embedded=embedded,
        style=_part("page.css"),
        figures=[
            (heading, [*group])
            for heading, group in groupby(pictures, key=lambda picture: picture.heading)
        ],
        contents=texts.replace(
            "<", "\\u003c"
        ),  # so that none of them ends the enclosing HTML element
        script="\n".join(['"use strict";', *(_part(f"{name}.js") for name in SCRIPTS)]),
    )


def _colours(scale: Colormap) -> list[str]:
    """Return the colours of a scale as texts, in equal steps."""
    return [to_hex(colour) for colour in scale(range(256))]


def _part(name: str) -> str:
    return files(__package__).joinpath("static", name).read_text(encoding="utf-8")
