"""Write the page that lists a study's cases, and the sources and versions they come from."""

from __future__ import annotations

import argparse
import json
from html import escape
from pathlib import Path

import pandas as pd
import xarray as xr

from disc_model.claims.pages import page, table_html
from disc_model.data.dataset import load_inputs
from disc_model.data.variables import STATUSES
from disc_model.errors import exit_on_error
from disc_model.figures.paper.catalogue import said_parameters
from disc_model.parameters import Parameters


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cases", type=Path, help="netCDF file of the merged cases")
    parser.add_argument("output", type=Path, help="HTML file to write")
    parser.add_argument("--title", default="", help="of the study")
    args = parser.parse_args()
    (tree,) = load_inputs([args.cases])
    found = f"<h2>Sources</h2>{table_html(sources(tree))}"
    cases = f"<h2>Cases</h2>{table_html(rows(tree))}"
    args.output.write_text(page(args.title or "Provenance", f"<p>{escape(SAID)}</p>", found, cases), encoding="utf-8")


SAID = (
    "The full specification of every case has a hash, and so have the sources that made the results: a result and the "
    "code it comes from can be told to belong together."
)


def sources(tree: xr.DataTree) -> pd.DataFrame:
    """Commit, hash of the solver's sources, and versions."""
    said = {"commit": tree.attrs.get("git_commit", ""), "hash of the solver": tree.attrs.get("source_hash", "")}
    versions = tree.attrs.get("versions", "{}")
    listed = json.loads(versions)
    said |= listed if isinstance(listed, dict) else {"versions": versions}
    return pd.DataFrame(list(said.items()), columns=["What", "Value"])


def rows(tree: xr.DataTree) -> pd.DataFrame:
    """One row a case."""
    table = tree.to_dataset()
    found = []
    for name, node in tree.children.items():
        row = table.sel(case=name)
        p = Parameters.model_validate_json(node.attrs["parameters"])
        found.append(
            {
                "Case": name,
                "Title": str(row["title"].item()),
                "Place in the paper": str(row["reference"].item()),
                "Parameters": f"{said_parameters(p)}, {p.contact}, {p.normalization}",
                "Length (s)": float(row["time_reached"]),
                "First separation (s)": float(row["first_separation"]),
                "Separations": int(row["n_separations"]),
                "Outcome": STATUSES[int(row["status"])],
                "Specification": node.attrs["specification_key"],
            }
        )
    return pd.DataFrame(found)


if __name__ == "__main__":
    exit_on_error(main)
