"""Merge the files of cases into one, and list them on a page with what they come from. The title of
the page and, by case, its labels are JSON."""

import json

import pandas as pd
import xarray as xr

from disc_model.data.dataset import load_cases, save
from disc_model.data.texts import write_page
from disc_model.data.variables import STATUSES, values_text
from disc_model.errors import script
from disc_model.parameters import Parameters
from disc_model.studies.merge import merge_cases

WORDS = (
    "The full specification of every case has a hash, and so have the sources that made the results: a result and the "
    "code it comes from can be told to belong together."
)


def sources(attributes: dict[str, str]) -> pd.DataFrame:
    """Commit, hash of the solver's sources, and versions."""
    versions = attributes.get("versions", "{}")
    listed = json.loads(versions)
    text = {
        "commit": attributes.get("git_commit", ""),
        "hash of the solver": attributes.get("source_hash", ""),
    }
    text |= listed if isinstance(listed, dict) else {"versions": versions}
    return pd.DataFrame(list(text.items()), columns=["What", "Value"])


def row(name: str, case: xr.DataTree, label: dict[str, str]) -> dict[str, object]:
    """What the page says of a case."""
    p, values = Parameters.model_validate_json(case.attrs["parameters"]), case.to_dataset()
    return {
        "Case": name,
        "Title": label.get("title", ""),
        "Place in the paper": label.get("reference", ""),
        "Parameters": f"{values_text(dict(p))}, {p.contact}, {p.normalization}",
        "Length (s)": float(values["time_reached"]),
        "First separation (s)": float(values["first_separation"]),
        "Separations": int(values["n_separations"]),
        "Outcome": STATUSES[int(values["status"])],
        "Specification": case.attrs["specification_key"],
    }


@script
def main(title: str, labels: str, output: str, page: str, *paths: str) -> None:
    cases, texts = load_cases(paths), json.loads(labels)
    merged = merge_cases(cases, texts)
    save(merged, output, compressed=False)  # half the time, for half as many bytes again
    rows = pd.DataFrame([row(name, case, texts.get(name, {})) for name, case in cases.items()])
    write_page(
        page, json.loads(title), ("Sources", WORDS, sources(merged.attrs)), ("Cases", "", rows)
    )
