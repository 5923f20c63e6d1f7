"""Words in place of the numbers by which datasets of studies and of files stand for them, and datasets as
tables of text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar

import pandas as pd
import xarray as xr
from xarray import Dataset

from disc_model.data.variables import flag_names
from disc_model.errors import require

Data = TypeVar("Data", xr.DataArray, Dataset, xr.DataTree)

CODED = "flag_meanings"
"""Attribute of a variable of numbers that stand for words: these words."""
OF_NUMBERS = ("units", "flag_values", CODED)
"""Attributes that words do not have."""


def words(data: Data) -> Data:
    """Return data with words, such as "ok" and "separation", where numbers stand for them.

    `run_study`, the files of studies and of runs, and windows of a run have numbers for the words of a `status`,
    `outcome` or `phase`; `sweep` has the words themselves, which stay as they are.

    Parameters
    ----------
    data : a variable, such as ``study["status"]``, or a whole dataset or tree, of which all other variables stay

    Returns
    -------
    xarray.DataArray or xarray.Dataset or xarray.DataTree
        Of the kind of `data`. A missing number, as after `where` of xarray, is the word "".

    Raises
    ------
    ParameterError
        If `data` is none of the three.

    Examples
    --------
    >>> import disc_model as dm
    >>> axes = {"mu_s": [0.35, 0.4], "mu_k": [0.2]}
    >>> study = dm.run_study({"study": "s", "quantity": "floquet", "base": {"N": 385, "Omega": 12}, "axes": axes})
    >>> study["status"].values.tolist(), dm.words(study["status"]).values.tolist()
    ([[0], [0]], [['ok'], ['ok']])
    """
    if isinstance(data, xr.DataTree):
        return data.map_over_datasets(words)
    if isinstance(data, Dataset):
        return data.assign({name: words(x) for name, x in data.items() if CODED in x.attrs})
    rule = "must be a DataArray, Dataset or DataTree of xarray; tables such as events have words already"
    require((isinstance(data, xr.DataArray), "data", data, rule))
    if CODED not in data.attrs:
        return data
    worded = data.copy(data=flag_names(data))
    worded.attrs = {key: x for key, x in data.attrs.items() if key not in OF_NUMBERS}
    return worded


# ---- Tables of text


def table_of(data: Dataset) -> pd.DataFrame:
    """A dataset as one table: a row for each point of all its dimensions, words in place of numbers that
    stand for them, and units in the heads, such as "P (N)"."""
    points = words(data)
    heads = {name: head_of(str(name), x.attrs) for name, x in points.variables.items()}
    if points.dims:
        return points.to_dataframe().reset_index().rename(columns=heads)
    row = {heads[name]: points[name].item() for name in heads}
    return pd.DataFrame([row])


def head_of(name: str, attributes: Mapping[Any, Any]) -> str:
    """The head of a column: a name, and the unit of its numbers."""
    unit = attributes.get("units", "1")
    if unit in ("", "1"):
        return name
    return f"{name} ({unit})"
