"""The named cases of a study, each simulated by a job of its own, as one tree."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from disc_model.data.dataset import CONVENTIONS, common_provenance


def merge_cases(cases: Mapping[str, xr.DataTree], labels: Mapping[str, Mapping[str, str]]) -> xr.DataTree:
    """Put cases into one tree.

    The root is a table with one row per case along the coordinate `case`: parameters, status, first separation and
    statistics, each a variable with units. Below it every case has a group of its own, laid out as in its file: the
    recorded variables and their lengths differ between cases:

        table = xarray.open_dataset("cases.nc")                                  # first_separation by case
        history = xarray.open_dataset("cases.nc", group="F13/history")           # one window of one case
        tree = xarray.open_datatree("cases.nc")                                  # everything

    cases : by id, the dataset of each case's file; failed cases have scalars only
    labels : by id, texts that become variables of the table, such as title and reference
    """
    rows = [tree.to_dataset() for tree in cases.values()]
    table = xr.concat(rows, dim="case", join="exact", combine_attrs="override", data_vars="all", coords="minimal")
    table = table.assign_coords(case=("case", list(cases), {"long_name": "name of the case"}))
    texts = [{"message": row.attrs["message"], **labels.get(case, {})} for case, row in zip(cases, rows, strict=True)]
    for name, meaning in _TEXTS.items():
        table[name] = ("case", np.array([text.get(name, "") for text in texts], dtype=str), {"long_name": meaning})
    table.attrs = {"Conventions": CONVENTIONS, **common_provenance(rows)}
    tree = xr.DataTree(table)
    for name, case in cases.items():
        tree[name] = case
    return tree


_TEXTS = {
    "message": "what ended the simulation early",
    "reference": "place in the paper",
    "title": "what the case is",
}
