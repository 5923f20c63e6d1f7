"""Cases that hold less than the study of the paper asks for: what the schema lets through, or a failure."""

from collections.abc import Callable, Mapping

import pytest
import xarray as xr

from disc_model.data.dataset import scalars_dataset
from disc_model.parameters import Parameters

Groups = dict[str, xr.Dataset]
Damage = Callable[[Groups], Groups]


def damaged(case: xr.DataTree, damage: Damage) -> xr.DataTree:
    """A copy of a case, changed."""
    groups = {"": case.to_dataset()} | {str(n): node.to_dataset(inherit=False) for n, node in case.children.items()}
    return xr.DataTree.from_dict({f"/{name}": group for name, group in damage(groups).items()})


def _failed(groups: Groups) -> Groups:
    p = Parameters.model_validate_json(groups[""].attrs["parameters"])
    return {"": scalars_dataset(p, {"t_end": 100.0, "tol": 1e-10}, "failed", "NonFinite: overflow")}


def _without_events(groups: Groups) -> Groups:
    events = {"events": groups["events"].isel(event=slice(0)).drop_attrs(deep=False)} if "events" in groups else {}
    return groups | events


def _is_range(group: xr.Dataset) -> bool:
    return any(str(key).endswith("_min") for key in group)


def _as_samples(group: xr.Dataset) -> xr.Dataset:
    return group.rename({key: str(key)[:-4] for key in group if str(key).endswith("_min")})


def _as_ranges(group: xr.Dataset) -> xr.Dataset:
    if _is_range(group):
        return group
    plain = group.drop_vars("phase", errors="ignore")
    return xr.Dataset({f"{key}_{end}": plain[key] for key in plain for end in ("min", "max")}, attrs=group.attrs)


def _each(change: Callable[[xr.Dataset], xr.Dataset], *but: str) -> Damage:
    return lambda groups: {
        name: group if name in ("", "events", *but) else change(group) for name, group in groups.items()
    }


def _separates_at(share: float) -> Damage:
    def change(groups: Groups) -> Groups:
        time = share * groups[""]["time_reached"]
        return groups | {"": groups[""].assign(first_separation=time, n_separations=((), 1))}

    return change


DAMAGES: Mapping[str, Damage] = {
    "failed": _failed,
    "nothing recorded": lambda groups: {"": groups[""]},
    "no events": _without_events,
    "three events": lambda groups: (
        groups | ({"events": groups["events"].isel(event=slice(3))} if "events" in groups else {})
    ),
    "no envelopes": _each(_as_samples),
    "only envelopes": _each(_as_ranges, "poincare"),
    "empty windows": _each(lambda group: group.isel(time=slice(0))),
    "single samples": _each(lambda group: group.isel(time=slice(1))),
    "two samples": _each(lambda group: group.isel(time=slice(2))),
    "separates at once": _separates_at(1e-3),
    "separates in the end": _separates_at(1.0),
    "nothing moves": _each(lambda group: group.map(xr.zeros_like, keep_attrs=True)),
}
QUICK = {"no events", "no envelopes", "only envelopes", "two samples", "nothing moves"}
EACH_DAMAGE = [pytest.param(name, marks=() if name in QUICK else pytest.mark.slow) for name in DAMAGES]
"""A few of them in the quick tests."""
