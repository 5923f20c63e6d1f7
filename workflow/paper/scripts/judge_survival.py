"""Judge the paper's conclusions under seven models of disc and contact: evidence as CSV, and the
page."""

from disc_model.data.dataset import load_cases
from disc_model.data.texts import write_page
from disc_model.errors import script
from workflow.paper.measures import views
from workflow.paper.survival import TEXTS, judged, pages_of


@script
def main(csv: str, md: str, html: str, *inputs: str) -> None:
    table = judged(views(load_cases(inputs)))
    table.to_csv(csv, index=False)
    sections = pages_of(table)
    write_page(md, TEXTS["title"], sections[0])
    write_page(html, TEXTS["title"], *sections)
