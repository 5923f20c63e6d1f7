"""A branch among those of a sweep, as the dataset that it had before the sweep gave all of them one length."""

from __future__ import annotations

import numpy as np
import xarray as xr

from disc_model.data.variables import OF_RESULTS
from disc_model.errors import Fault, ParameterError

WORDS = ("ended", "not_reached", "free_parameters", "branch_parameters")
"""Attributes of a branch that are variables of a sweep, by their names there."""
ATTRIBUTES = {"branch_parameters": "parameters"}
"""Attributes whose names are others in a sweep, whose own attribute tells the case of all."""
BESIDE = "branch_"
"""What stands before the names of variables of a branch, such as direction, that a sweep varies by the
same name."""
COUNTS = ("separations", "releases", "diameters", "special_after", "direction", "special_direction")
"""Variables of whole numbers, which a sweep makes real ones, as these have a nan,"""
VERDICTS = ("stable", "special_changes_stability")
"""and those of True and False."""
OF_SWEEPS = {"status", "message"}
"""Variables that every sweep has,"""
NEEDED = {*OF_SWEEPS, *WORDS, *COUNTS, *VERDICTS, "period", "special_kind", "multipliers", "a"}
"""and those without which a sweep has no whole branches."""


def variables_of_branch(branch: xr.Dataset) -> xr.Dataset:
    """The dataset of a branch with its attributes as variables, and without the numbers of its
    points, of which other branches have more; that of another result with all of its attributes."""
    if "point" not in branch.variables:
        own = {str(name): ((), value) for name, value in branch.attrs.items()}
        own.pop("versions", None)  # the sweep tells them itself
        return branch.assign(own)
    said = {}
    for name in WORDS:
        text = branch.attrs.get(ATTRIBUTES.get(name, name), "")
        said[name] = xr.DataArray(text, attrs=OF_RESULTS["Branch"][name].attributes)
    return branch.drop_vars(["point", "special"]).assign(said)


def is_of_sweep(data: object) -> bool:
    """Whether these are branches of a sweep, or one of them."""
    return isinstance(data, xr.Dataset) and NEEDED.issubset(data.variables)


def selected_text(data: xr.Dataset, name: str) -> str:
    """How one of the branches of a sweep is selected of the dataset of a name, as "study.isel(N=0)"."""
    dims = data["status"].dims
    chosen = ", ".join(f"{dim}=0" for dim in dims)
    return f"{name}.isel({chosen})" if dims else name


def refuse_failed(data: object) -> None:
    """Raise `ParameterError` for a point of a sweep that has failed, with its message."""
    if not isinstance(data, xr.Dataset) or not OF_SWEEPS.issubset(data.variables):
        return
    if data["status"].size == 1 and data["status"].item() == "failed":
        rule = f"must be a branch, but this point of the sweep failed: {data['message'].item()}"
        raise ParameterError(Fault(("data",), "", rule))


def branch_of_sweep(data: xr.Dataset) -> xr.Dataset:
    """The dataset of the one branch that is selected of a sweep; raises `ParameterError` if there are
    several."""
    if data["status"].size != 1:
        rule = f"must be one branch of the sweep: select it, as by {selected_text(data, 'data')}"
        raise ParameterError(Fault(("data",), "", rule))
    row = data.isel(dict.fromkeys(data["status"].dims, 0))
    names = {name: ATTRIBUTES.get(name, name) for name in WORDS}
    attrs = {attribute: row[name].item() for name, attribute in names.items()}
    single = [name for name, values in row.variables.items() if not values.ndim]
    own = _with_own_names(row.drop_vars(single))
    return _of_own_types(_without_padding(own)).assign_attrs(attrs)


def name_beside(name: str) -> str:
    """The name that a variable of a branch has in a sweep over something of its own name."""
    return f"{BESIDE}{name}"


def _with_own_names(row: xr.Dataset) -> xr.Dataset:
    """A branch whose variables have their own names."""
    beside = [str(name) for name in row.variables if str(name).startswith(BESIDE)]
    return row.rename({name: name.removeprefix(BESIDE) for name in beside})


def _without_padding(row: xr.Dataset) -> xr.Dataset:
    """The points, special points, multipliers and modes that the branch has itself."""
    present = {
        "point": row["period"].notnull(),
        "special": row["special_kind"] != "",
        "multiplier": row["multipliers"].notnull().any("point"),
        "mode": row["a"].notnull().any("point"),
    }
    return row.isel({dim: np.flatnonzero(there) for dim, there in present.items()})


def _of_own_types(row: xr.Dataset) -> xr.Dataset:
    """The variables of a branch with the types that they have in its dataset."""
    types = {**dict.fromkeys(COUNTS, int), **dict.fromkeys(VERDICTS, bool)}
    return row.assign({name: row[name].astype(kind) for name, kind in types.items()})
