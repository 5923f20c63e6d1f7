"""Set the cases and verdicts of both normalisations beside each other: the cases as CSV, and the
page."""

from disc_model.data.dataset import load_cases
from disc_model.data.texts import write_page
from disc_model.errors import script
from workflow.paper.ledger import NAMES, TEXTS, compare
from workflow.paper.measures import views


@script
def main(csv: str, md: str, html: str, *paths: str) -> None:
    half = len(paths) // 2
    results = [views(load_cases(files)) for files in (paths[:half], paths[half:])]
    sections = compare(dict(zip(NAMES, results, strict=True)))
    sections[1][2].to_csv(csv, index=False)
    for path in (md, html):
        write_page(path, TEXTS["title"], *sections)
