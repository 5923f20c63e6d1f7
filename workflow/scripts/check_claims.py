"""Check the paper's claims against the merged cases and grid studies: a table as CSV, Markdown and a page."""

from pathlib import Path

from disc_model.data.dataset import load_cases
from disc_model.errors import script
from disc_model.paper.ledger import check_claims
from disc_model.paper.pages import ledger, to_markdown


@script
def main(csv: str, md: str, html: str, *inputs: str) -> None:
    scans = load_cases([*map(Path, inputs)])
    cases = scans.pop("cases")
    table = check_claims(cases, {name: scan.to_dataset() for name, scan in scans.items()})
    table.to_csv(csv, index=False)
    Path(md).write_text(to_markdown(table), encoding="utf-8")
    Path(html).write_text(ledger(table), encoding="utf-8")
