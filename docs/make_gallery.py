"""Make the gallery of docs/ from finished figures: small pictures and the page that shows them."""

import re
from contextlib import chdir
from doctest import DocTestParser
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import xarray as xr
import yaml
from matplotlib.animation import PillowWriter
from matplotlib.figure import Figure
from PIL import Image

import disc_model as dm
from disc_model.data.dataset import load_cases, samples
from disc_model.errors import script
from disc_model.figures.disc import film
from disc_model.figures.drawing import styled
from disc_model.paper.figures.instants import motion_of
from disc_model.studies.study import load_study

SHOWN = (
    "composite",
    *(
        f"fig{n}"
        for n in ("13", "02", "03", "05", "09", "10", "14", "25", "27", "28", "A1", "A2", "B1")
    ),
)
OF_GRIDS = (
    "branches",
    "figB2",
    "fig15",
    "basins",
    "map_N",
    "survival_growth",
    "sensitivity",
    "campbell",
    "sliding_modes",
    "sliding_coalescence",
    "sliding_outcome",
    "ramps",
    "brake_range",
    "brake_growth",
    "map_couple",
)
"""Figures of grid studies; where they are not there, the pictures of an earlier run stay."""
OF_BENCHMARK = {
    "overview": "Cost against accuracy: computing time of a simulated second against the error of event times, one "
    "core, medians of repeats.",
    "failure_maps": "Failures of methods, over step or tolerance and number of modes: (a) in stick-slip, the others in "
    "the second with separations.",
}
"""Figures of the benchmark, and their captions."""
FILM = "Disc and slider in the 35 ms of Fig. 2b, slowed down about 170 times"
COLUMNS = 3
"""Pictures in a row of the page."""
WIDTH = 900
"""Pixels of a figure as wide as a page; narrower ones are as much smaller."""
PAGE = 2055
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


def write_film(case: xr.DataTree, path: Path, frames: int = 70) -> None:
    """Write the motion of disc and slider as an animated picture, with at most `frames` frames.

    Raises `Missing` if the case does not hold the windows `around0`, ...
    """
    whole, window = motion_of(case), samples(case, "around0")
    part = slice(None, None, max(1, whole.time.size // frames))
    arrays = {
        name: getattr(whole, name)[..., part]
        for name in ("time", "amplitudes", "slider", "u", "phase")
    }
    with styled():
        figure = Figure(figsize=(6.4, 2.7))
        animation = film(
            figure, whole._replace(**arrays), window["time"].values, window["P"].values
        )
        path.parent.mkdir(parents=True, exist_ok=True)
        animation.save(path, writer=PillowWriter(fps=12), dpi=100)


def figure_of_page(page: Path) -> Figure:
    """The figure that the examples of a page draw, without the files that they write."""
    examples = DocTestParser().get_examples(page.read_text(encoding="utf-8"))
    source = "".join(example.source for example in examples)
    names: dict[str, Any] = {}
    with TemporaryDirectory() as folder, chdir(folder):
        exec(compile(source, page.name, "exec"), names)
    figure: Figure = names["figure"]
    return figure


def page_of(shown: list[tuple[str, str]]) -> str:
    """The page: small pictures with their titles, each a link to the picture itself."""
    lines = ["# Gallery", "", "From `make reproduce`, `make bench` and `make survival`.", ""]
    cells = [
        f"[![{Path(name).stem}](gallery/{name})](gallery/{name})<br>{title}"
        for name, title in shown
    ]
    cells += [""] * (-len(shown) % COLUMNS)
    rows = ["| " + " | ".join(cells[i : i + COLUMNS]) + " |" for i in range(0, len(cells), COLUMNS)]
    return "\n".join([*lines, "| " * COLUMNS + "|", "| --- " * COLUMNS + "|", *rows, ""])


@script
def main() -> None:
    results, docs = Path("results"), Path("docs")
    axes: Any = dm.simulate(
        dm.Parameters(N=385, Omega=15.1), 60
    ).plot()  # the first picture of README
    axes.flat[0].figure.savefig(docs / "gallery" / "first_run.png", dpi=120)
    first_study = (
        (docs / "studies.md").read_text(encoding="utf-8").split("```yaml\n")[1].split("```")[0]
    )
    axes = dm.plot_sweep(dm.run_study(yaml.safe_load(first_study)))
    axes.figure.savefig(docs / "gallery" / "my_growth.png", dpi=120)
    figure = figure_of_page(docs / "howto" / "figures.md")
    figure.savefig(docs / "gallery" / "own_figure.png", dpi=120)
    studies = [load_study(path) for path in ("config/paper.yaml", "config/survival.yaml")]
    entries = {
        name: (study, entry)
        for one in studies
        for (study, name), entry in one.entries(one.grids()[0]).items()
    }
    shown: list[tuple[str, str]] = []  # picture and title
    for name in SHOWN:
        _, entry = entries[name]
        small = shrink(
            results / "paper" / "figures" / f"{name}.png", docs / "gallery" / f"{name}.png"
        )
        shown.append((small.name, " ".join(entry.title.split())))
    (case,) = load_cases([results / "paper" / "cases" / "F02.nc"]).values()
    write_film(case, docs / "gallery" / "film.webp")
    shown.append(("film.webp", FILM))
    texts = {name: (entries[name][0], entries[name][1].plot.caption) for name in OF_GRIDS}
    texts |= {name: ("bench", text) for name, text in OF_BENCHMARK.items()}
    for name, (study, text) in texts.items():
        source, small = (
            results / study / "figures" / f"{name}.png",
            docs / "gallery" / f"{name}.png",
        )
        if source.is_file():
            shrink(source, small)
        if small.is_file():
            shown.append((small.name, re.split(r"(?<!Eq)[.:] ", text)[0].rstrip(".")))
    (docs / "gallery.md").write_text(page_of(shown), encoding="utf-8")
