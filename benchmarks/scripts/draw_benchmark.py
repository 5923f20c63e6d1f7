"""Draw one figure of the benchmark from its datasets."""

from benchmarks.figures import draw
from disc_model.data.dataset import load_tree
from disc_model.errors import script
from disc_model.figures.kinds import save


@script
def main(name: str, pdf: str, png: str, *inputs: str) -> None:
    figure = draw(name, [tree.to_dataset() for tree in map(load_tree, inputs)])
    for path in (png, pdf):
        save(figure, path)
