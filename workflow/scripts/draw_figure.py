"""Draw one figure from the files of the cases it shows, each named after its case."""

from __future__ import annotations

import argparse
import importlib
from pathlib import Path

from disc_model.dataset import load
from disc_model.figures.catalogue import CATALOGUE, module_of
from disc_model.figures.style import save


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("figure", choices=list(CATALOGUE))
    parser.add_argument("cases", nargs="+", type=Path, help="netCDF files of the cases")
    parser.add_argument("--out", action="append", required=True, help="file to write, .pdf or .png; may be repeated")
    args = parser.parse_args()
    module = importlib.import_module(module_of(args.figure))
    figure = module.draw({path.stem: load(path) for path in args.cases})
    for path in args.out:
        save(figure, path)


if __name__ == "__main__":
    main()
