"""Write the page that lists a study's cases, and the sources and versions they come from."""

import json
from pathlib import Path

import pandas as pd
import xarray as xr

from disc_model.data.dataset import load_inputs
from disc_model.data.texts import write_page
from disc_model.data.variables import STATUSES, values_text
from disc_model.errors import script
from disc_model.parameters import Parameters

WORDS = (
    "The full specification of every case has a hash, and so have the sources that made the results: a result and the "
    "code it comes from can be told to belong together."
)


def sources(tree: xr.DataTree) -> pd.DataFrame:
    """Commit, hash of the solver's sources, and versions."""
    text = {"commit": tree.attrs.get("git_commit", ""), "hash of the solver": tree.attrs.get("source_hash", "")}
    versions = tree.attrs.get("versions", "{}")
    listed = json.loads(versions)
    text |= listed if isinstance(listed, dict) else {"versions": versions}
    return pd.DataFrame(list(text.items()), columns=["What", "Value"])


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
                "Parameters": f"{values_text(dict(p))}, {p.contact}, {p.normalization}",
                "Length (s)": float(row["time_reached"]),
                "First separation (s)": float(row["first_separation"]),
                "Separations": int(row["n_separations"]),
                "Outcome": STATUSES[int(row["status"])],
                "Specification": node.attrs["specification_key"],
            }
        )
    return pd.DataFrame(found)


@script
def main(title: str, cases: str, output: str) -> None:
    (tree,) = load_inputs([Path(cases)])
    sections = (("Sources", WORDS, sources(tree)), ("Cases", "", rows(tree)))
    write_page(output, json.loads(title) or "Provenance", *sections)
