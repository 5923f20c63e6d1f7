"""A branch among those of a sweep, as the dataset that it had before the sweep gave all of them one length."""

from __future__ import annotations

import xarray as xr

from disc_model.data.variables import OF_RESULTS
from disc_model.errors import require

ATTRIBUTES = ("ended", "parameters", "free_parameters")
"""Attributes of a branch, which are variables of a sweep."""
PRESENT = {
    "point": "period",
    "special": "special_period",
    "multiplier": "multipliers_real",
    "mode": "a",
}
"""Dimensions of a branch, and what has a number wherever the branch has a place along them."""
TYPES = {
    **dict.fromkeys(("separations", "releases", "diameters", "direction"), int),
    **dict.fromkeys(("special_after", "special_direction"), int),
    **dict.fromkeys(("stable", "special_changes_stability"), bool),
}
"""Types of variables, which a sweep makes real ones, as these have a nan."""


def is_of_sweep(data: object) -> bool:
    """Whether these are branches of a sweep, or one of them."""
    return isinstance(data, xr.Dataset) and {"status", "ended", "special_kind"} <= {*data.variables}


def branch_of_sweep(data: xr.Dataset) -> xr.Dataset:
    """The dataset of the one branch that is selected of a sweep; raises `ParameterError` if there are
    several, or it has failed."""
    rule = "must be one branch of the sweep: select it, as by data.isel(N=0)"
    require((data["status"].size == 1, "data", "", rule))
    row = data.isel(dict.fromkeys(data["status"].dims, 0))
    rule = f"must be a branch, but this point of the sweep failed: {row['message'].item()}"
    require((row["status"].item() == "ok", "data", "", rule))

    # numbers of places, which a sweep has as variables, and what has no place along a dimension
    unplaced = [name for name, x in row.variables.items() if not x.ndim or name in PRESENT]
    own = row.drop_vars(unplaced)
    padded = [dim for dim in PRESENT if f"{dim}_index" in own.dims]
    own = own.rename_dims({f"{dim}_index": dim for dim in padded})
    for dim, name in PRESENT.items():
        own = own.dropna(dim, how="all", subset=[name])
    own = own.assign({name: own[name].astype(kind) for name, kind in TYPES.items()})
    for name in TYPES:  # of which a sweep says how it stands for truth
        known = OF_RESULTS["Branch"].get(name) or OF_RESULTS["Branch"].get(
            name.removeprefix("special_")
        )
        if known is not None:
            own[name].attrs = dict(known.attributes)
    for dim in ("point", "special"):
        places = (dim, range(own.sizes[dim]), OF_RESULTS["Branch"][dim].attributes)
        own = own.assign_coords({dim: places})
    free = str(row["free_parameters"].item())
    own = own.set_coords([free, f"special_{free}"])
    own.attrs = {name: row[name].item() for name in ATTRIBUTES}
    return own.assign_attrs(versions=data.attrs["versions"])
