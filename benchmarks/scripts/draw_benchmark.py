"""Draw one figure of the benchmark from its tables, and write them as one."""

import pandas as pd

from benchmarks.figures import draw
from disc_model.errors import script
from disc_model.figures.kinds import save


@script
def main(name: str, pdf: str, png: str, csv: str, *tables: str) -> None:
    table = pd.concat([pd.read_csv(path) for path in tables], ignore_index=True)
    table.to_csv(csv, index=False)
    figure = draw(name, table)
    for path in (png, pdf):
        save(figure, path)
