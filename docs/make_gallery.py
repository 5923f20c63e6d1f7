"""Make the gallery of docs/ from finished figures: small pictures and the page that shows them."""

from pathlib import Path

from PIL import Image

from disc_model.data.dataset import load_cases
from disc_model.errors import script
from disc_model.figures.paper import disc
from disc_model.figures.paper.catalogue import CATALOGUE, caption, number_of
from disc_model.studies.study import load_study

SHOWN = tuple(f"fig{n}" for n in ("13", "02", "03", "05", "09", "10", "14", "25", "27", "28", "A1", "A2", "B1", "B2"))
OTHERS = {
    "branches/figures/branches.png": (
        "All cycles at N = 385 N.",
        "Range of the slider's height on cycles found by continuation: thick if stable, dashed if unstable. Triangles: "
        "simulations that stay 40 s at each speed, rising and falling, with arrows at jumps. F11 and F13: the paper's "
        "15 and 15.1 rad/s, on both sides of the fold at which the quiet cycle ends.",
    ),
    "critical_speed/figures/fig15.png": (
        "Fig. 15. Critical speed for separation against preload.",
        "(a) First separation from the static start, by scans: the line is for 2000 s, marks show where 500 or 1000 s "
        "give another speed. Areas: long-term behaviour. Black: the cycle loses stability, or ends. (b) Sweeps of the "
        "speed up and down. The bar marks coexistence, by random perturbations.",
    ),
    "basins/figures/basins.png": (
        "Basins of attraction at N = 385 N.",
        "(a) to (d) Shares of the outcomes of random perturbations of stated energies. (e) The attractors, with marks "
        "as large as their shares of all starts. (f) Critical energy.",
    ),
    "map_N/figures/map_N.png": (
        "Stability over speed and preload.",
        "Above: long-term behaviour from the static start within 1000 s. Below: growth rate of the cycle that it "
        "follows.",
    ),
    "critical_speed/figures/thresholds.png": (
        "Stability limits of the cycle, and separation.",
        "Neutral curves and folds by continuation, named after their resonances n f_s = f ± l f_Ω. Areas: long-term "
        "behaviour from the static start within 1000 s.",
    ),
    "survival_growth/figures/survival_growth.png": (
        "Growth rate under four models.",
        "As published, and orthonormal modes with rigid contact, with residual flexibility, and with that and the "
        "normal force.",
    ),
    "sensitivity/figures/sensitivity.png": (
        "Probability of instability against each uncertain parameter.",
        "As published, in each third of a parameter's range, with intervals of 95 %. Grey: over the whole range.",
    ),
    "campbell/figures/campbell.png": (
        "Campbell diagram at N = 385 N.",
        "(a) Frequencies of steady sliding and of the stick-slip cycle, and multiples of the stick-slip frequency. "
        "Numbers mark peaks of the cycle's growth rate, and gaps without a cycle. (b) Growth rates of the cycle's "
        "modes.",
    ),
    "ramps/figures/ramps.png": (
        "Separation on ramps of the speed.",
        "Onset on a rising ramp, and end on a falling one, at N = 385 N. Dotted: end of the stable cycle.",
    ),
    "bench/figures/overview.png": (
        "Speed against accuracy.",
        "Computing time of a simulated second against the error of event times, one core, medians of repeats.",
    ),
    "bench/figures/failure_maps.png": (
        "Failures of methods.",
        "Over step or tolerance and number of modes: (a) in stick-slip, the others in the second with separations.",
    ),
}
"""Figures of other studies; where they are not there, the pictures of an earlier run stay."""
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
    for name, (title, text) in OTHERS.items():
        source = results.parents[1] / name
        small = docs / "gallery" / source.name
        if source.is_file():
            shrink(source, small)
        if small.is_file():
            lines += [f"![{title}](gallery/{small.name})", "", f"**{title}** {text}", ""]
    (docs / "gallery.md").write_text("\n".join(lines), encoding="utf-8")
