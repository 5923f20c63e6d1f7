"""Write a page of tables on the effect of the number of modes and on convergence."""

from pathlib import Path

from disc_model.benchmarks.truncation_pages import text
from disc_model.data.dataset import load
from disc_model.errors import script


@script
def main(study: str, output: str) -> None:
    Path(output).write_text(text(load(study).to_dataset()), encoding="utf-8")
