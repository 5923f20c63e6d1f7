"""Check the paper's claims against the merged cases and grid studies: a table as CSV, Markdown and a page."""

from pathlib import Path

from disc_model.claims.ledger import check_claims
from disc_model.claims.pages import ledger, to_markdown
from disc_model.data.dataset import load_inputs
from disc_model.errors import script


@script
def main(csv: str, md: str, html: str, *inputs: str) -> None:
    files = [Path(file) for file in inputs]
    cases, *scans = load_inputs(files)
    table = check_claims(cases, {file.stem: scan.to_dataset() for file, scan in zip(files[1:], scans, strict=True)})
    table.to_csv(csv, index=False)
    Path(md).write_text(to_markdown(table), encoding="utf-8")
    Path(html).write_text(ledger(table), encoding="utf-8")
