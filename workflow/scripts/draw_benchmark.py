"""Draw a figure of the benchmark from its datasets."""

from __future__ import annotations

import argparse
from pathlib import Path

from matplotlib.figure import Figure

from disc_model.data.dataset import load_inputs
from disc_model.errors import exit_on_error
from disc_model.figures import benchmark
from disc_model.figures.parts import save

PREFIX = "work_precision_"
OF_ONE = {
    "overview": benchmark.overview,
    "answers": benchmark.answers,
    "prices": benchmark.prices,
    "truncation": benchmark.truncation,
    "contact_truncation": benchmark.contact_truncation,
}
OF_MAPS = {"failure_maps": benchmark.failure_maps, "answer_maps": benchmark.answer_maps}


def draw(name: str, paths: list[Path]) -> Figure:
    datasets = [tree.to_dataset() for tree in load_inputs(paths)]
    if name.startswith(PREFIX):
        return benchmark.work_precision(datasets[0], name.removeprefix(PREFIX))
    if name in OF_ONE:
        return OF_ONE[name](datasets[0])
    return OF_MAPS[name](datasets)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("name", help=f"work_precision_<scene>, {', '.join([*OF_ONE, *OF_MAPS])}")
    parser.add_argument("inputs", nargs="+", type=Path, help="netCDF files")
    parser.add_argument("--out", action="append", required=True, help="file to write, .pdf or .png; may be repeated")
    args = parser.parse_args()
    figure = draw(args.name, args.inputs)
    for path in args.out:
        save(figure, path)


if __name__ == "__main__":
    exit_on_error(main)
