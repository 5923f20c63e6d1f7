"""Check the paper's claims against the merged cases; write the table as CSV, as Markdown and as a page."""

from __future__ import annotations

import argparse
from pathlib import Path

from disc_model.claims.ledger import check_claims
from disc_model.claims.pages import ledger, to_markdown
from disc_model.data.dataset import load_inputs
from disc_model.errors import exit_on_error


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cases", type=Path, help="netCDF file of the merged cases")
    parser.add_argument("--scan", action="append", default=[], help="NAME=FILE, a merged grid study; may be repeated")
    parser.add_argument("--csv", type=Path, required=True)
    parser.add_argument("--md", type=Path, required=True)
    parser.add_argument("--html", type=Path, required=True)
    args = parser.parse_args()
    names, files = zip(*(scan.split("=", 1) for scan in args.scan), strict=True) if args.scan else ((), ())
    cases, *scans = load_inputs([args.cases, *map(Path, files)])
    table = check_claims(cases, {name: scan.to_dataset() for name, scan in zip(names, scans, strict=True)})
    table.to_csv(args.csv, index=False)
    args.md.write_text(to_markdown(table), encoding="utf-8")
    args.html.write_text(ledger(table), encoding="utf-8")


if __name__ == "__main__":
    exit_on_error(main)
