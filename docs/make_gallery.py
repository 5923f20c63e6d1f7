"""Make the pictures of docs/gallery: small ones of finished figures, and of first examples."""

from pathlib import Path
from typing import Any

import yaml
from PIL import Image, ImageOps

import disc_model as dm
from disc_model.errors import script

RESULTS = Path("results")
DOCS = Path("docs")
GALLERY = DOCS / "gallery"

SHOWN = {
    "composite": "paper",
    "stretching": "paper",
    "branches": "branches",
    "map_N": "map_N",
    "range_law": "range_law",
    "overview": "bench",
}
"""Figures with their studies, and one of the benchmark."""
WIDTH = 900
"""Pixels of a figure as wide as a page; narrower ones are as much smaller."""
PAGE = 2055
"""Pixels of such a figure as it was drawn."""


def shrink(source: Path, target: Path) -> None:
    """Write a small copy of a picture, in true colour; equal ones give equal bytes."""
    with Image.open(source) as picture:
        small = ImageOps.scale(picture.convert("RGB"), WIDTH / PAGE, Image.Resampling.LANCZOS)
    small.save(target, optimize=True)


def draw_first_study() -> None:
    """Draw the picture of the first study of docs/studies.md."""
    page = (DOCS / "studies.md").read_text(encoding="utf-8")
    study = page.split("```yaml\n")[1].split("```")[0]
    axes: Any = dm.plot_sweep(dm.run_study(yaml.safe_load(study)))
    axes.figure.savefig(GALLERY / "my_growth.png", dpi=120)


@script
def main() -> None:
    """Draw and shrink all pictures."""
    draw_first_study()
    for name, study in SHOWN.items():
        shrink(RESULTS / study / "figures" / f"{name}.png", GALLERY / f"{name}.png")
