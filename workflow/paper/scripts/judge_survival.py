"""Judge the paper's conclusions under five models of disc and contact: evidence as CSV, the page,
and both as HTML."""

from disc_model.data.dataset import load_cases
from disc_model.data.texts import write_page
from disc_model.errors import script
from workflow.paper.measures import views
from workflow.paper.model import judge
from workflow.paper.survival import CONCLUSIONS, TEXTS, by_model, evidence_of, page_of


@script
def main(csv: str, md: str, html: str, *inputs: str) -> None:
    table = judge(CONCLUSIONS, by_model(views(load_cases(inputs))))
    table.to_csv(csv, index=False)
    page = page_of(table)
    write_page(md, TEXTS["title"], page)
    write_page(html, TEXTS["title"], page, *evidence_of(table))
