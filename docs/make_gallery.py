"""Make the gallery of docs/ from finished figures: small pictures and the page that shows them."""

import re
from contextlib import chdir
from doctest import DocTestParser
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import xarray as xr
import yaml
from matplotlib.animation import PillowWriter
from matplotlib.figure import Figure
from PIL import Image

import disc_model as dm
from disc_model.data.dataset import load_cases, samples
from disc_model.errors import script
from disc_model.figures.film import film
from disc_model.figures.style import styled
from disc_model.studies.study import load_study
from workflow.paper.figures.motion_around import motion_of

RESULTS = Path("results")
DOCS = Path("docs")
GALLERY = DOCS / "gallery"

SHOWN = (
    "composite",
    "fig13",
    "fig02",
    "fig03",
    "fig05",
    "fig09",
    "fig10",
    "fig14",
    "fig25",
    "fig27",
    "fig28",
    "figA1",
    "figA2",
    "figB1",
)
"""Figures of the paper's study."""
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
    "range_law",
    "locking",
    "locking_map",
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
FRAMES = 70
"""Greatest number of frames of the film."""
COLUMNS = 3
"""Pictures in a row of the page."""
WIDTH = 900
"""Pixels of a figure as wide as a page; narrower ones are as much smaller."""
PAGE = 2055
"""Pixels of such a figure as it was drawn."""


class Shown(NamedTuple):
    """A picture of the page."""

    name: str
    title: str


# ---- Pictures


def shrink(source: Path, target: Path) -> Path:
    """Write a small copy of a picture, in true colour; equal ones give equal bytes."""
    target.parent.mkdir(parents=True, exist_ok=True)
    scale = WIDTH / PAGE
    with Image.open(source) as picture:
        size = (round(picture.width * scale), round(picture.height * scale))
        small = picture.convert("RGB").resize(size, Image.Resampling.LANCZOS)
    small.save(target, optimize=True)
    return target


def write_film(case: xr.DataTree, path: Path, frames: int = FRAMES) -> None:
    """Write the motion of disc and slider as an animated picture.

    Parameters
    ----------
    case : with the windows ``around0``, ...
    path : of the picture
    frames : greatest number of frames

    Raises
    ------
    disc_model.data.dataset.Missing
        If the case does not hold these windows.
    """
    whole = motion_of(case)
    window = samples(case, "around0")
    every = slice(None, None, max(1, whole.time.size // frames))
    shown = whole._replace(
        time=whole.time[..., every],
        amplitudes=whole.amplitudes[..., every],
        slider=whole.slider[..., every],
        u=whole.u[..., every],
        phase=whole.phase[..., every],
    )
    with styled():
        figure = Figure(figsize=(6.4, 2.7))
        animation = film(figure, shown, window["time"].values, window["P"].values)
        path.parent.mkdir(parents=True, exist_ok=True)
        animation.save(path, writer=PillowWriter(fps=12), dpi=100)


def draw_first_run() -> None:
    """Draw the first picture of README."""
    axes: Any = dm.simulate(dm.Parameters(N=385, Omega=15.1), 60).plot()
    axes.flat[0].figure.savefig(GALLERY / "first_run.png", dpi=120)


def draw_first_study() -> None:
    """Draw the picture of the first study of docs/studies.md."""
    page = (DOCS / "studies.md").read_text(encoding="utf-8")
    study = page.split("```yaml\n")[1].split("```")[0]
    axes: Any = dm.plot_sweep(dm.run_study(yaml.safe_load(study)))
    axes.figure.savefig(GALLERY / "my_growth.png", dpi=120)


def names_of_page(page: Path) -> dict[str, Any]:
    """Return what the examples of a page name, without the files that they write."""
    examples = DocTestParser().get_examples(page.read_text(encoding="utf-8"))
    source = "".join(example.source for example in examples)
    names: dict[str, Any] = {}
    with TemporaryDirectory() as folder, chdir(folder):
        exec(compile(source, page.name, "exec"), names)
    return names


def draw_own_figure() -> None:
    """Draw the pictures of the page on figures for a paper."""
    names = names_of_page(DOCS / "howto" / "figures.md")
    names["figure"].savefig(GALLERY / "own_figure.png", dpi=120)
    names["panel"].figure.savefig(GALLERY / "two_runs.png", dpi=120)


# ---- The page


def page_of(shown: list[Shown]) -> str:
    """Return the page: small pictures with their titles, each a link to the picture itself."""
    cells = []
    for name, title in shown:
        picture = f"![{Path(name).stem}](gallery/{name})"
        cells.append(f"[{picture}](gallery/{name})<br>{title}")
    cells += [""] * (-len(shown) % COLUMNS)
    lines = [
        "# Gallery",
        "",
        "From `make reproduce`, `make bench` and `make survival`.",
        "",
        "| " * COLUMNS + "|",
        "| --- " * COLUMNS + "|",
    ]
    for start in range(0, len(cells), COLUMNS):
        lines.append("| " + " | ".join(cells[start : start + COLUMNS]) + " |")
    lines.append("")
    return "\n".join(lines)


def first_sentence(caption: str) -> str:
    """Return the beginning of a caption as a title."""
    return re.split(r"(?<!Eq)[.:;] ", caption)[0].rstrip(".")


def entries() -> dict[str, tuple[str, Any]]:
    """Return the figures of the paper's study and of its variants, each with its study."""
    found = {}
    for path in ("config/paper.yaml", "config/survival.yaml"):
        study = load_study(path)
        grids, *_ = study.grids()
        for (owner, name), entry in study.entries(grids).items():
            found[name] = (owner, entry)
    return found


@script
def main() -> None:
    """Draw, shrink and list all pictures."""
    draw_first_run()
    draw_first_study()
    draw_own_figure()

    known = entries()
    shown = []
    for name in SHOWN:
        _, entry = known[name]
        small = shrink(RESULTS / "paper" / "figures" / f"{name}.png", GALLERY / f"{name}.png")
        shown.append(Shown(small.name, " ".join(entry.title.split())))

    (case,) = load_cases([RESULTS / "paper" / "cases" / "F02.nc"]).values()
    write_film(case, GALLERY / "film.webp")
    shown.append(Shown("film.webp", FILM))

    captions = {}
    for name in OF_GRIDS:
        study, entry = known[name]
        captions[name] = (study, entry.plot.caption)
    for name, caption in OF_BENCHMARK.items():
        captions[name] = ("bench", caption)
    for name, (study, caption) in captions.items():
        source = RESULTS / study / "figures" / f"{name}.png"
        small = GALLERY / f"{name}.png"
        if source.is_file():
            shrink(source, small)
        if small.is_file():
            shown.append(Shown(small.name, first_sentence(caption)))
    (DOCS / "gallery.md").write_text(page_of(shown), encoding="utf-8")
