"""Draw one figure from the files of what it shows."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from disc_model.data.dataset import load_inputs
from disc_model.errors import exit_on_error
from disc_model.figures.kinds import KINDS
from disc_model.figures.parts import draw, save


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("plot", type=json.loads, help="JSON: the figure, as its kind describes it")
    parser.add_argument("inputs", nargs="+", help="name=netCDF file, as disc_model.figures.parts.draw has it")
    parser.add_argument("--title", default="", help="written into the files")
    parser.add_argument("--out", action="append", required=True, help="file to write, .pdf or .png; may be repeated")
    args = parser.parse_args()
    names, _, files = zip(*(pair.partition("=") for pair in args.inputs), strict=True)
    inputs = dict(zip(names, load_inputs([*map(Path, files)]), strict=True))
    figure = draw(KINDS[args.plot["kind"]].model_validate(args.plot), inputs)
    for path in args.out:
        save(figure, path, title=args.title)


if __name__ == "__main__":
    exit_on_error(main)
