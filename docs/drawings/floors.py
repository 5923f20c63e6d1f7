"""Draw the floors of docs/architecture.md from the layers in pyproject.toml and the files in src/.

python docs/drawings/floors.py    writes floors.svg beside this file
"""

from __future__ import annotations

import textwrap
import tomllib
from html import escape
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "src" / "disc_model"
WHAT = {
    "cli": "commands: words to and from the functions below",
    "benchmarks": "speed against accuracy, rivals included",
    "claims": "what the paper says, checked against datasets",
    "explorer": "one page to look at datasets, motions, figures",
    "studies": "YAML to jobs, jobs to results, results to one dataset",
    "kernels": "what is compiled before jobs need it",
    "mode_choice": "how many modes, by what they are to get right",
    "figures": "datasets to pictures; never simulates",
    "stability": "cycles, their growth rates, curves, exponents",
    "analysis": "spectra, Poincaré sections, words for motions",
    "simulation": "a case to a result: the engine behind one function",
    "data": "variables, datasets, whole files, provenance",
    "disc": "discs given by a table of modes",
    "finite_elements": "modes of a solid disc from its section",
    "truncation": "how many modes frequencies need",
    "flexibility": "how far the disc gives way under the slider",
    "plate": "modes of the disc",
    "parameters": "one case: a plain value; kinds of numbers, strict bases",
    "engine": "equations, series, roots, switches: numbers and arrays only",
    "plausibility": "values that can hardly be meant",
    "progress": "what is shown while one waits",
    "errors": "how a computation may end, what is raised on purpose, how faults are said",
}
"""A few words for each part of a floor."""
COLOURS = ("#e8f1f8", "#d3e4f2")
WIDTH, MARGIN, LINE = 760, 14, 17
CHARACTERS = 112
"""Of small type, across the whole width."""


def floors() -> list[list[str]]:
    """Names of the parts of each floor, from top to bottom, as `lint-imports` holds them."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"][
        "contracts"
    ]
    layers = next(contract["layers"] for contract in contracts if contract["type"] == "layers")
    named = [[name.strip() for name in layer.replace(":", "|").split("|")] for layer in layers]
    return [[name for name in floor if name != "__main__"] for floor in named if floor != ["__main__"]]


def rooms(folder: Path, prefix: str = "") -> list[str]:
    """The modules of a package, and those of each package within it behind its name."""
    modules = ", ".join(path.stem for path in sorted(folder.glob("*.py")) if not path.stem.startswith("__"))
    inner = [path.parent for path in sorted(folder.glob("*/__init__.py"))]
    own = [prefix + modules] if modules else []
    return own + [line for room in inner for line in rooms(room, f"{prefix.rstrip()}{room.name}/ ")]


def box(part: str, width: float) -> list[tuple[str, str]]:
    """The lines of text of a part, each with its class."""
    characters = int(CHARACTERS * width / WIDTH)
    small = [line for text in rooms(PACKAGE / part) for line in textwrap.wrap(text, characters, subsequent_indent="  ")]
    what = [("what", line) for line in textwrap.wrap(WHAT[part], int(0.86 * characters))]
    return [("name", part), *what, *(("rooms", line) for line in small)]


def draw() -> str:
    """The picture as SVG."""
    body, top, gap = [], MARGIN, 8
    for number, floor in enumerate(floors()):
        weights = [3 if (PACKAGE / part).is_dir() else 1 for part in floor]
        space = (WIDTH - 2 * MARGIN - gap * (len(floor) - 1)) / sum(weights)
        boxes = [box(part, weight * space) for part, weight in zip(floor, weights, strict=True)]
        height, left = LINE * max(map(len, boxes)) + 12, MARGIN
        for lines, weight in zip(boxes, weights, strict=True):
            width = weight * space
            body.append(
                f'<rect x="{left:g}" y="{top}" width="{width:g}" height="{height}" rx="4" '
                f'fill="{COLOURS[number % 2]}" stroke="#0072B2"/>'
            )
            for i, (kind, text) in enumerate(lines):
                body.append(f'<text class="{kind}" x="{left + 9:g}" y="{top + 19 + LINE * i}">{escape(text)}</text>')
            left += width + gap
        top += height + 6
    style = (
        "text { font-family: 'DejaVu Sans', Verdana, Arial, sans-serif; fill: #111 } .name { font-weight: bold; "
        "font-size: 14px } .what { font-size: 13px } .rooms { font-size: 11.5px; fill: #555 }"
    )
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {top + MARGIN - 6}" width="{WIDTH}">'
    return "\n".join(
        [head, f"<style>{style}</style>", '<rect width="100%" height="100%" fill="white"/>', *body, "</svg>", ""]
    )


if __name__ == "__main__":
    Path(__file__).with_suffix(".svg").write_text(draw(), encoding="utf-8")
