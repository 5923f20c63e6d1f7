"""Write what README and docs say about speed and the number of modes, from the datasets of one run of the benchmark.

What was not measured is left as it was.
"""

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from docs.make_gallery import shrink

from disc_model.benchmarks import pages, truncation_pages
from disc_model.data.dataset import load
from disc_model.errors import DiscModelError, script

PAGES = ("README.md", "docs/method.md")
"""Those that hold passages on speed."""
MODES_PAGE = "docs/truncation.md"
"""The one that holds those on the number of modes."""


def keep(run: Mapping[str, Any], path: Path) -> None:
    """The numbers that pages are made of."""
    path.write_text(json.dumps(run, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


def fill(path: Path, run: Mapping[str, Any], passages: Callable[[Mapping[str, Any]], Mapping[str, str]]) -> None:
    """Write a page's passages anew."""
    path.write_text(pages.fill(path.read_text(encoding="utf-8"), passages(run)), encoding="utf-8")


@script
def main(bench: str = "results/bench", root: str = "") -> None:
    folder, top = Path(bench), Path(root)
    measured = {
        name: folder / f"{name}.nc"
        for name in ("work_precision", "work_precision_avx2", "answers", "contact_truncation")
    }
    there = {name: load(path).to_dataset() for name, path in measured.items() if path.is_file()}
    if not there:
        raise DiscModelError(f"{bench} holds no measurements: make bench")
    docs = top / "docs"
    if {"work_precision", "work_precision_avx2", "answers"} <= there.keys():
        run = pages.summary(there["work_precision"], there["work_precision_avx2"], there["answers"])
        keep(run, docs / "benchmark.json")
        (docs / "benchmark.md").write_text(pages.page(run), encoding="utf-8")
        for name in PAGES:
            fill(top / name, run, pages.passages)
    if "contact_truncation" in there:
        run = truncation_pages.summary(there["contact_truncation"])
        keep(run, docs / "contact_truncation.json")
        fill(top / MODES_PAGE, run, truncation_pages.passages)
    for name in pages.FIGURES:
        source = folder / "figures" / f"{name}.png"
        if source.is_file():  # else the picture stays as it was
            shrink(source, docs / "gallery" / f"{name}.png")
