"""Write what the number of modes changes as a page of tables, and what of it has settled."""

from __future__ import annotations

import argparse
from pathlib import Path

from disc_model.benchmarks.truncation_pages import text
from disc_model.data.dataset import load


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("study", type=Path, help="netCDF file of contact_truncation")
    parser.add_argument("output", type=Path, help="Markdown file to write")
    args = parser.parse_args()
    args.output.write_text(text(load(args.study).to_dataset()), encoding="utf-8")


if __name__ == "__main__":
    main()
