"""The page: contents, pictures, style and script in one file."""

import base64
import io
import json
from collections.abc import Mapping, Sequence
from html import escape
from importlib.resources import files
from itertools import groupby
from operator import attrgetter
from pathlib import Path
from string import Template
from typing import Any, NamedTuple

from cmcrameri import cm
from matplotlib.colors import to_hex
from PIL import Image, ImageOps

from disc_model.figures.drawing import BLACK, BLUE, BROWN, GREEN, GREY, ORANGE, PHASE_COLOURS, PURPLE, SKY, VERMILION

PICTURE_WIDTH = 1100
"""Width of a page-wide figure, pixels; narrower ones are scaled alike."""
PAGE_WIDTH = 2161
"""Width of such a figure as drawn, pixels."""
QUALITY = 80
SCRIPTS = ("contents", "view", "drawing", "map", "point", "motion", "start")
"""Scripts, in the order of their dependence."""
PALETTE = (BLUE, ORANGE, SKY, GREEN, PURPLE, BROWN, GREY, VERMILION)
"""Colours of flags whose words have none of their own, distinct to colour-blind readers too."""
WORDS = {
    **PHASE_COLOURS,
    "ok": SKY,
    "quiet": BLUE,
    "stable": BLUE,
    "growing": ORANGE,
    "unstable": ORANGE,
    "failed": BLACK,
}


class Picture(NamedTuple):
    """A figure of the report."""

    heading: str
    title: str
    caption: str
    file: Path


def page(title: str, studies: Sequence[Mapping[str, Any]], pictures: Sequence[Picture]) -> str:
    """The whole page.

    Parameters
    ----------
    studies : as from `disc_model.explorer.contents.study_contents`
    pictures : grouped by heading
    """
    contents = {
        "studies": studies,
        "maps": {"sequential": _colours("batlow"), "diverging": _colours("vik")},
        "palette": PALETTE,
        "words": WORDS,
    }
    texts = json.dumps(contents, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    parts = {
        "title": escape(title),
        "style": _part("page.css"),
        "figures": gallery(pictures),
        "contents": texts.replace("<", "\\u003c"),  # so that none of them ends the enclosing HTML element
        "script": "\n".join(['"use strict";', *(_part(f"{name}.js") for name in SCRIPTS)]),
    }
    return Template(_part("page.html")).substitute(parts)


def gallery(pictures: Sequence[Picture]) -> str:
    """Figures below their headings; each is a button that enlarges it."""
    lines: list[str] = []
    for heading, below in groupby(pictures, key=attrgetter("heading")):
        lines += [f"<h3>{escape(heading)}</h3>", '<div class="pictures">']
        lines += [
            f'<figure><button type="button"><span class="paper"><img loading="lazy" alt="{escape(picture.title)}" '
            f'src="{embedded(picture.file)}"></span>{escape(picture.title)}</button>'
            f"<figcaption>{escape(picture.caption)}</figcaption></figure>"
            for picture in below
        ]
        lines.append("</div>")
    return "\n".join(lines or ["<p>None were made.</p>"])


def embedded(file: Path) -> str:
    """A picture, reduced in size, as a data URL."""
    with Image.open(file) as picture:
        small = ImageOps.scale(picture.convert("RGB"), PICTURE_WIDTH / PAGE_WIDTH, Image.Resampling.LANCZOS)
    buffer = io.BytesIO()
    small.save(buffer, "WEBP", quality=QUALITY, method=6)
    return f"data:image/webp;base64,{base64.b64encode(buffer.getvalue()).decode('ascii')}"


def _colours(name: str) -> list[str]:
    return [to_hex(colour) for colour in getattr(cm, name)(range(256))]


def _part(name: str) -> str:
    return files(__package__).joinpath("static", name).read_text(encoding="utf-8")
