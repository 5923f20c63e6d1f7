"""Set the cases of both normalisations beside each other, as Markdown and as a page."""

from __future__ import annotations

import argparse
from pathlib import Path

from disc_model.claims.ledger import compare
from disc_model.data.dataset import load_inputs
from disc_model.errors import exit_on_error


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("published", type=Path, help="netCDF file of the merged cases, modes as published")
    parser.add_argument("orthonormal", type=Path, help="netCDF file of the merged cases, modes as Eq. (17) says")
    parser.add_argument("--md", type=Path, required=True)
    parser.add_argument("--html", type=Path, required=True)
    args = parser.parse_args()
    found = compare(*load_inputs([args.published, args.orthonormal]))
    args.md.write_text(found.markdown(), encoding="utf-8")
    args.html.write_text(found.html(), encoding="utf-8")


if __name__ == "__main__":
    exit_on_error(main)
