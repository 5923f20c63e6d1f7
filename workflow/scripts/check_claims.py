"""Check the paper's claims against the merged cases and grid studies: a table as CSV, Markdown and a page."""

from pathlib import Path

from disc_model.data.dataset import load_cases
from disc_model.data.texts import write_page
from disc_model.errors import script
from disc_model.paper.ledger import check_claims, verdict_counts
from disc_model.paper.measures import views


@script
def main(csv: str, md: str, html: str, *inputs: str) -> None:
    table = check_claims(views(load_cases([*map(Path, inputs)])))
    counts = verdict_counts(table)
    table.to_csv(csv, index=False)
    named = table.rename(columns=lambda name: name.replace("_", " ").replace("ours", "computed"))
    write_page(md, "The paper's claims", ("", f"{len(table)} claims; {counts}.", named))
    summary = f"{len(table)} statements; {counts}."
    write_page(html, "The paper's claims, checked", ("", summary, table), template="paper/ledger")
