"""Write speed against accuracy as CSV."""

from pathlib import Path

from disc_model.benchmarks.work_precision import table
from disc_model.data.dataset import load_inputs
from disc_model.errors import script


@script
def main(csv: str, path: str) -> None:
    (tree,) = load_inputs([Path(path)])
    table(tree.to_dataset()).to_csv(csv, index=False)
