"""Write speed against accuracy as CSV."""

from benchmarks.work_precision import table
from disc_model.data.dataset import load_result
from disc_model.errors import script


@script
def main(csv: str, path: str) -> None:
    table(load_result(path).to_dataset()).to_csv(csv, index=False)
