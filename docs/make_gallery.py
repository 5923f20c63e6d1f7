"""Make the gallery of docs/ from finished figures: small pictures and the page that shows them."""

from pathlib import Path

from PIL import Image

from disc_model.data.dataset import load_cases
from disc_model.errors import script
from disc_model.figures.paper import disc
from disc_model.figures.paper.catalogue import CATALOGUE, caption, number_of
from disc_model.studies.study import load_study

SHOWN = tuple(f"fig{n}" for n in ("13", "02", "03", "05", "09", "10", "14", "25", "27", "28", "A1", "A2", "B1", "B2"))
OF_GRIDS = (
    "branches", "fig15", "basins", "map_N", "thresholds", "survival_growth", "sensitivity", "campbell", "ramps",
)  # fmt: skip
"""Figures of grid studies; where they are not there, the pictures of an earlier run stay."""
OF_BENCHMARK = {
    "overview": "Speed against accuracy: computing time of a simulated second against the error of event times, one "
    "core, medians of repeats.",
    "failure_maps": "Failures of methods, over step or tolerance and number of modes: (a) in stick-slip, the others in "
    "the second with separations.",
}
"""Figures of the benchmark, and their captions."""
FILM = (
    "The 35 ms of Fig. 2b, slowed down about 170 times. Left: deflection of the disc from above, colours as "
    "in Fig. B1. Right: the disc along the circle of radius r_0, and the slider. It is vermilion during separation."
)
WIDTH = 900
"""Pixels of a figure as wide as a page; narrower ones are as much smaller."""
PAGE = 2161
"""Pixels of such a figure as it was drawn."""


def shrink(source: Path, target: Path) -> Path:
    """Write a small copy of a picture, in true colour; equal ones give equal bytes."""
    target.parent.mkdir(parents=True, exist_ok=True)
    with Image.open(source) as picture:
        scale = WIDTH / PAGE
        size = (round(picture.width * scale), round(picture.height * scale))
        small = picture.convert("RGB").resize(size, Image.Resampling.LANCZOS)
    small.save(target, optimize=True)
    return target


@script
def main() -> None:
    results, docs = Path("results/paper/figures"), Path("docs")
    specs = load_study("config/paper.yaml").specs
    parameters = {name: spec.parameters for name, spec in specs.items()}
    windows = {name: spec.sections for name, spec in specs.items()}
    lines = ["# Gallery", "", "Made by `make gallery` from the figures of `make reproduce`.", ""]
    for name in SHOWN:
        small = shrink(results / f"{name}.png", docs / "gallery" / f"{name}.png")
        text = f"**{number_of(name)}. {CATALOGUE[name].title}.** {caption(name, parameters, windows)}"
        lines += [f"![{number_of(name)}](gallery/{small.name})", "", text, ""]
    (case,) = load_cases([results.parent / "cases" / "F02.nc"]).values()
    disc.film(case, docs / "gallery" / "film.webp")
    lines += ["![Disc and slider in motion](gallery/film.webp)", "", f"**Disc and slider in motion.** {FILM}", ""]
    asked = [load_study(path).grids()[0] for path in ("config/paper.yaml", "config/survival.yaml")]
    texts = {
        name: (study, plot.caption)
        for grids in asked
        for study, grid in grids.items()
        for name, plot in grid.plots.items()
    } | {name: ("bench", text) for name, text in OF_BENCHMARK.items()}
    for name in (*OF_GRIDS, *OF_BENCHMARK):
        folder, text = texts[name]
        source, small = results.parents[1] / folder / "figures" / f"{name}.png", docs / "gallery" / f"{name}.png"
        if source.is_file():
            shrink(source, small)
        if small.is_file():
            lines += [f"![{text.partition('. ')[0]}](gallery/{small.name})", "", text, ""]
    (docs / "gallery.md").write_text("\n".join(lines), encoding="utf-8")
