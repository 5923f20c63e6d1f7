"""Judge the paper's conclusions under four models of disc and contact; write the page as Markdown and as HTML."""

from __future__ import annotations

import argparse
from pathlib import Path

from disc_model.claims.survival import judge, page_of
from disc_model.data.dataset import load_inputs
from disc_model.errors import exit_on_error


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cases", type=Path, help="netCDF file of the merged cases of config/survival.yaml")
    parser.add_argument("grids", type=Path, nargs="+", help="netCDF files of its grid studies, named after them")
    parser.add_argument("--md", type=Path, required=True)
    parser.add_argument("--html", type=Path, required=True)
    args = parser.parse_args()
    cases, *grids = load_inputs([args.cases, *args.grids])
    names = [path.stem for path in args.grids]
    found = page_of(judge(cases, {name: grid.to_dataset() for name, grid in zip(names, grids, strict=True)}))
    args.md.write_text(found.markdown(), encoding="utf-8")
    args.html.write_text(found.html(), encoding="utf-8")


if __name__ == "__main__":
    exit_on_error(main)
