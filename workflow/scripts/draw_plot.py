"""Draw one figure of a grid study from its merged dataset and those of the further studies it shows."""

from __future__ import annotations

import argparse
import importlib
import json
from pathlib import Path

from disc_model.data.dataset import load_inputs
from disc_model.errors import exit_on_error
from disc_model.figures.grids.kinds import PLOTS
from disc_model.figures.parts import save


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("plot", type=json.loads, help="JSON: what the study file says about the figure")
    parser.add_argument("study", type=Path, help="netCDF file of the merged study")
    parser.add_argument("others", nargs="*", help="role=netCDF file of a further study")
    parser.add_argument("--out", action="append", required=True, help="file to write, .pdf or .png; may be repeated")
    args = parser.parse_args()
    plot = PLOTS[args.plot["kind"]].model_validate(args.plot)
    others = dict(pair.split("=", 1) for pair in args.others)
    study, *shown = [tree.to_dataset() for tree in load_inputs([args.study, *map(Path, others.values())])]
    figure = importlib.import_module(plot.module).draw(study, dict(zip(others, shown, strict=True)), plot)
    for path in args.out:
        save(figure, path)


if __name__ == "__main__":
    exit_on_error(main)
