"""Draw one figure from the files of the cases it shows, each named after its case."""

from __future__ import annotations

import argparse
import importlib
import json
from pathlib import Path

from disc_model.data.dataset import load_cases
from disc_model.errors import exit_on_error
from disc_model.figures.parts import save


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("module", help="module that draws it, such as disc_model.figures.paper.separations")
    parser.add_argument("function", help="function of that module, such as one_separation")
    parser.add_argument("cases", nargs="+", type=Path, help="netCDF files of the cases")
    parser.add_argument("--options", type=json.loads, default={}, help="JSON: keyword arguments of the function")
    parser.add_argument("--title", default="", help="written into the files")
    parser.add_argument("--out", action="append", required=True, help="file to write, .pdf or .png; may be repeated")
    args = parser.parse_args()
    draw = getattr(importlib.import_module(args.module), args.function)
    figure = draw(load_cases(args.cases), **args.options)
    for path in args.out:
        save(figure, path, title=args.title)


if __name__ == "__main__":
    exit_on_error(main)
