"""Write what README and docs say about speed, from the datasets of one run of the benchmark."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from workflow.scripts.make_gallery import shrink

from disc_model.benchmarks.pages import FIGURES, filled, page, summary
from disc_model.data.dataset import load
from disc_model.errors import exit_on_error

PAGES = ("README.md", "docs/method.md")
"""Those that hold passages."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bench", type=Path, default=Path("results/bench"))
    parser.add_argument("--root", type=Path, default=Path())
    args = parser.parse_args()
    datasets = [load(args.bench / f"{name}.nc").to_dataset() for name in ("work_precision", "answers")]
    run = summary(*datasets)
    docs = args.root / "docs"
    (docs / "benchmark.json").write_text(json.dumps(run, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    (docs / "benchmark.md").write_text(page(run), encoding="utf-8")
    for name in PAGES:
        path = args.root / name
        path.write_text(filled(path.read_text(encoding="utf-8"), run), encoding="utf-8")
    for name in FIGURES:
        source = args.bench / "figures" / f"{name}.png"
        if source.is_file():  # else the picture stays as it was
            shrink(source, docs / "gallery" / f"{name}.png")


if __name__ == "__main__":
    exit_on_error(main)
