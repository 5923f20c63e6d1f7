"""Judge the paper's statements by cases, grid studies and tables made of cases: the ledger as CSV,
as Markdown and as a page."""

from pathlib import Path

import pandas as pd

from disc_model.data.dataset import load_cases
from disc_model.data.texts import write_page
from disc_model.errors import script
from workflow.paper import ledger
from workflow.paper.ledger import check_claims, summary
from workflow.paper.measures import views


@script
def main(csv: str, md: str, html: str, *inputs: str) -> None:
    tables = {Path(path).stem: pd.read_csv(path) for path in inputs if path.endswith(".csv")}
    cases = [path for path in inputs if not path.endswith(".csv")]
    table = check_claims(views(load_cases(cases)), tables)
    links = {
        name: [", ".join(each.values()) for each in table[name]] for name in ("figures", "data")
    }
    table.assign(**links).to_csv(csv, index=False)
    page = ("", summary(table), table)
    for path in (md, html):
        title = "The paper's statements, judged"
        write_page(path, title, page, template=Path(ledger.__file__))
