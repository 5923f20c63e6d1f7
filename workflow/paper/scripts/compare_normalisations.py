"""Set the cases of both normalisations beside each other: all cases as CSV, the page, and all as
HTML."""

from disc_model.data.dataset import load_cases
from disc_model.data.texts import write_page
from disc_model.errors import script
from workflow.paper.ledger import TEXTS, compare
from workflow.paper.measures import views


@script
def main(csv: str, md: str, html: str, *paths: str) -> None:
    half = len(paths) // 2
    parts = compare(*(views(load_cases(files)) for files in (paths[:half], paths[half:])))
    parts["cases"][2].to_csv(csv, index=False)
    write_page(md, TEXTS["title"], parts["brief"], parts["modes"])
    write_page(html, TEXTS["title"], *parts.values())
