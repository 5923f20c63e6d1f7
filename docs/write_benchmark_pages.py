"""Write what README and docs say about speed and the number of modes, from the datasets of one run of the benchmark.

What was not measured is left as it was.
"""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from docs.make_gallery import shrink

from disc_model.benchmarks import pages, truncation_pages
from disc_model.data.dataset import load
from disc_model.errors import DiscModelError, script

SPEED = {"work_precision", "work_precision_avx2", "answers"}
"""Measurements for the passages on speed."""


def store(run: Mapping[str, Any], path: Path) -> None:
    """Write the numbers of passages."""
    path.write_text(json.dumps(run, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


@script
def main(bench: str = "results/bench", root: str = "") -> None:
    folder, top = Path(bench), Path(root)
    measured = {name: folder / f"{name}.nc" for name in (*sorted(SPEED), "contact_truncation")}
    there = {name: load(path).to_dataset() for name, path in measured.items() if path.is_file()}
    if not there:
        raise DiscModelError(f"{bench} holds no measurements: make bench")
    docs = top / "docs"
    if there.keys() >= SPEED:
        run = pages.summary(there["work_precision"], there["work_precision_avx2"], there["answers"])
        store(run, docs / "benchmark.json")
    if "contact_truncation" in there:
        store(truncation_pages.summary(there["contact_truncation"]), docs / "contact_truncation.json")
    known = pages.stored_passages(docs)
    for page in (top / name for name in pages.PAGES):
        page.write_text(pages.fill(page.read_text(encoding="utf-8"), known), encoding="utf-8")
    for name in pages.FIGURES:
        source = folder / "figures" / f"{name}.png"
        if source.is_file():  # else the picture stays as it was
            shrink(source, docs / "gallery" / f"{name}.png")
