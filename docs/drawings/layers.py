"""Draw the layers of docs/architecture.md from the layers in pyproject.toml and the files in src/.

python docs/drawings/layers.py    writes layers.svg beside this file
"""

from __future__ import annotations

import textwrap
import tomllib
from html import escape
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "src" / "disc_model"
WHAT = {
    "cli": "commands: text to and from the functions below",
    "benchmarks": "speed against accuracy, other integrators included",
    "paper": "what the paper says, checked against datasets",
    "explorer": "one page to look at datasets, motions, figures",
    "attached": "methods of discs and results that need the rooms below",
    "studies": "YAML to jobs, jobs to results, results to one dataset",
    "fit": "parameters of a case from measurements",
    "mode_choice": "number of modes for a quantity of the motion",
    "mode_measures": "quantities of the motion that tell it",
    "figures": "datasets to pictures; never simulates",
    "stability": "cycles, their growth rates, curves, exponents",
    "analysis": "spectra, Poincaré sections, kinds of motion",
    "simulation": "from a case to a result: the engine behind one function",
    "data": "variables, datasets, files, provenance",
    "disc": "modes by theory, tables or finite elements; flexibility",
    "parameters": "one case of disc and slider",
    "modal_disc": "a disc by its modes, instead of the plate",
    "mode_units": "numbers of single modes, with units",
    "units": "kinds of numbers, units, strict bases",
    "engine": "equations, series, roots, events: numbers and arrays only",
    "errors": "statuses, exceptions and their messages",
    "display": "summaries, pictures, progress",
    "attachable": "the bases that have these methods",
    "arrays": "types of arrays",
    "hashing": "one text for equal values, and its hash",
    "sources": "files on which a result depends",
    "without_reader": "what a command does when nobody reads on",
}
"""A few words for each part of a layer."""
COLOURS = ("#e8f1f8", "#d3e4f2")
WIDTH, MARGIN, LINE = 760, 14, 17
CHARACTERS = 112
"""Of small type, across the whole width."""


def layers() -> list[list[str]]:
    """Names of the parts of each layer, from top to bottom, as `lint-imports` holds them."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"][
        "importlinter"
    ]["contracts"]
    listed = next(contract["layers"] for contract in contracts if contract["type"] == "layers")
    named = [[name.strip() for name in layer.replace(":", "|").split("|")] for layer in listed]
    return [
        [name for name in layer if name != "__main__"] for layer in named if layer != ["__main__"]
    ]


def modules(folder: Path, prefix: str = "") -> list[str]:
    """The modules of a package, and those of each package within it behind its name."""
    names = ", ".join(
        path.stem for path in sorted(folder.glob("*.py")) if not path.stem.startswith("__")
    )
    inner = [path.parent for path in sorted(folder.glob("*/__init__.py"))]
    own = [prefix + names] if names else []
    return own + [
        line for part in inner for line in modules(part, f"{prefix.rstrip()}{part.name}/ ")
    ]


def box(part: str, width: float) -> list[tuple[str, str]]:
    """The lines of text of a part, each with its class."""
    characters = int(CHARACTERS * width / WIDTH)
    small = [
        line
        for text in modules(PACKAGE / part)
        for line in textwrap.wrap(text, characters, subsequent_indent="  ")
    ]
    what = [("what", line) for line in textwrap.wrap(WHAT[part], int(0.86 * characters))]
    return [("name", part), *what, *(("modules", line) for line in small)]


def draw() -> str:
    """The picture as SVG."""
    body, top, gap = [], MARGIN, 8
    for number, layer in enumerate(layers()):
        weights = [3 if (PACKAGE / part).is_dir() else 1 for part in layer]
        space = (WIDTH - 2 * MARGIN - gap * (len(layer) - 1)) / sum(weights)
        boxes = [box(part, weight * space) for part, weight in zip(layer, weights, strict=True)]
        height, left = LINE * max(map(len, boxes)) + 12, MARGIN
        for lines, weight in zip(boxes, weights, strict=True):
            width = weight * space
            body.append(
                f'<rect x="{left:g}" y="{top}" width="{width:g}" height="{height}" rx="4" '
                f'fill="{COLOURS[number % 2]}" stroke="#0072B2"/>'
            )
            for i, (kind, text) in enumerate(lines):
                body.append(
                    f'<text class="{kind}" x="{left + 9:g}" y="{top + 19 + LINE * i}">{escape(text)}</text>'
                )
            left += width + gap
        top += height + 6
    style = (
        "text { font-family: 'DejaVu Sans', Verdana, Arial, sans-serif; fill: #111 } .name { font-weight: bold; "
        "font-size: 14px } .what { font-size: 13px } .modules { font-size: 11.5px; fill: #555 }"
    )
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {top + MARGIN - 6}" width="{WIDTH}">'
    return "\n".join(
        [
            head,
            f"<style>{style}</style>",
            '<rect width="100%" height="100%" fill="white"/>',
            *body,
            "</svg>",
            "",
        ]
    )


if __name__ == "__main__":
    Path(__file__).with_suffix(".svg").write_text(draw(), encoding="utf-8")
