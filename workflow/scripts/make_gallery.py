"""Make the gallery of docs/ from finished figures: small pictures and the page that shows them."""

from __future__ import annotations

import argparse
from pathlib import Path

from PIL import Image

from disc_model.figures.catalogue import CATALOGUE, caption, number_of
from disc_model.studies.study import load_study

SHOWN = ("fig13", "fig02", "fig03", "fig05", "fig09", "fig10", "fig14", "fig25", "fig27", "fig28", "figA1", "figA2")
OTHERS = {
    "results/critical_speed/figures/fig15.png": "Fig. 15. Critical speed for separation against preload.",
}
"""Figures of other studies; left out as long as they are not there."""
WIDTH = 900
"""Pixels of a figure as wide as a page; narrower ones are as much smaller."""
PAGE = 2161
"""Pixels of such a figure as it was drawn."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--study", type=Path, default=Path("config/paper.yaml"))
    parser.add_argument("--results", type=Path, default=Path("results/paper/figures"))
    parser.add_argument("--docs", type=Path, default=Path("docs"))
    args = parser.parse_args()
    parameters = {name: spec.parameters for name, spec in load_study(args.study).specs.items()}
    lines = ["# Gallery", "", "Made by `make gallery` from the figures of `make reproduce`.", ""]
    for name in SHOWN:
        small = shrink(args.results / f"{name}.png", args.docs / "gallery" / f"{name}.png")
        text = f"**{number_of(name)}. {CATALOGUE[name].title}.** {caption(name, parameters)}"
        lines += [f"![{number_of(name)}](gallery/{small.name})", "", text, ""]
    for source, text in OTHERS.items():
        if Path(source).is_file():
            small = shrink(Path(source), args.docs / "gallery" / Path(source).name)
            lines += [f"![{text.partition('.')[0]}](gallery/{small.name})", "", text, ""]
    (args.docs / "gallery.md").write_text("\n".join(lines), encoding="utf-8")


def shrink(source: Path, target: Path) -> Path:
    """Write a small copy of a picture, with a palette of 128 colours; equal pictures give equal bytes."""
    target.parent.mkdir(parents=True, exist_ok=True)
    with Image.open(source) as picture:
        scale = WIDTH / PAGE
        size = (round(picture.width * scale), round(picture.height * scale))
        picture.convert("RGB").resize(size, Image.Resampling.LANCZOS).quantize(128).save(target, optimize=True)
    return target


if __name__ == "__main__":
    main()
