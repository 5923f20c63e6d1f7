"""Make Table 1 or 2 of the paper beside ours, or a table of what results rest on: as CSV, as
Markdown and as a page."""

from disc_model.data.dataset import Missing, load_cases
from disc_model.data.texts import write_page
from disc_model.errors import script
from workflow.paper.measures import CaseView
from workflow.paper.paper_tables import COLUMNS, TABLE_2, TABLES, TEXTS


@script
def main(name: str, csv: str, md: str, html: str, *paths: str) -> None:
    cases = {case: CaseView(case, tree) for case, tree in load_cases(paths).items()}
    page = TEXTS["pages"][name]
    note = page["note"]
    try:
        table = TABLES[name](cases)
    except Missing as reason:  # of Table 2 alone
        table = TABLE_2.reindex(columns=COLUMNS)
        note = f"Not computed: {reason}."
    # the ledger reads this file, people read the pages
    table.to_csv(csv, index=False)
    shown = table.rename(columns=TEXTS["names"])
    if "digits" in page:
        shown = shown.round(page["digits"])
    for file in (md, html):
        write_page(file, page["title"], ("", note, shown))
