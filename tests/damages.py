"""Cases that hold less than a study asks for: what the schema lets through, or a failure."""

from collections.abc import Callable, Mapping

import xarray as xr

from disc_model.data.columns import scalars_dataset
from disc_model.parameters import Parameters

Groups = dict[str, xr.Dataset]
Damage = Callable[[Groups], Groups]


def groups_of(case: xr.DataTree) -> Groups:
    """Datasets of a case by the names of their groups; that of the case itself is ""."""
    own = {str(name): node.to_dataset(inherit=False) for name, node in case.children.items()}
    return {"": case.to_dataset()} | own


def tree_of(groups: Groups) -> xr.DataTree:
    """A case made of groups."""
    return xr.DataTree.from_dict({f"/{name}": group for name, group in groups.items()})


def damaged(case: xr.DataTree, damage: Damage) -> xr.DataTree:
    """A copy of a case, changed."""
    return tree_of(damage(groups_of(case)))


def _failed(groups: Groups) -> Groups:
    p = Parameters.model_validate_json(groups[""].attrs["parameters"])
    return {"": scalars_dataset(p, {"t_end": 100.0, "tol": 1e-10}, "failed", "NonFinite: overflow")}


def _without_events(groups: Groups) -> Groups:
    events = {}
    if "events" in groups:
        events = {"events": groups["events"].isel(event=slice(0)).drop_attrs(deep=False)}
    return groups | events


def _cut(size: int) -> Damage:
    return lambda groups: {
        name: group if name in ("", "events") else group.isel(time=slice(size))
        for name, group in groups.items()
    }


DAMAGES: Mapping[str, Damage] = {
    "failed": _failed,
    "nothing recorded": lambda groups: {"": groups[""]},
    "no events": _without_events,
    "empty windows": _cut(0),
    "two samples": _cut(2),
}
