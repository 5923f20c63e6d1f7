"""Cases that hold less than the study of the paper asks for: every way that the schema lets through, or a failure."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import xarray as xr

from disc_model.data.dataset import failed_groups
from disc_model.parameters import Parameters

Groups = dict[str, xr.Dataset]
Damage = Callable[[Groups], Groups]


def groups_of(case: xr.DataTree) -> Groups:
    return {"": case.to_dataset()} | {str(name): node.to_dataset(inherit=False) for name, node in case.children.items()}


def damaged(case: xr.DataTree, damage: Damage) -> xr.DataTree:
    """A copy of a case, changed."""
    return xr.DataTree.from_dict({f"/{name}": found for name, found in damage(groups_of(case)).items()})


def _failed(groups: Groups) -> Groups:
    p = Parameters.model_validate_json(groups[""].attrs["parameters"])
    return failed_groups(p, 100.0, 1e-10, "NonFinite: overflow")


def _without_events(groups: Groups) -> Groups:
    if "events" not in groups:
        return groups
    empty = groups["events"].isel(event=slice(0))
    empty.attrs = {}
    return groups | {"events": empty}


def _few_events(groups: Groups) -> Groups:
    return groups | ({"events": groups["events"].isel(event=slice(3))} if "events" in groups else {})


def _samples_for_ranges(name: str, group: xr.Dataset) -> xr.Dataset:
    if not any(str(key).endswith("_min") for key in group):
        return group
    return group.rename({key: str(key)[:-4] for key in group if str(key).endswith("_min")})


def _ranges_for_samples(name: str, group: xr.Dataset) -> xr.Dataset:
    if name in ("", "events", "poincare") or any(str(key).endswith("_min") for key in group):
        return group
    plain = group.drop_vars("phase", errors="ignore")
    return xr.Dataset({f"{key}_{end}": plain[key] for key in plain for end in ("min", "max")}, attrs=group.attrs)


def _first(count: int) -> Callable[[str, xr.Dataset], xr.Dataset]:
    return lambda name, group: group if name in ("", "events") else group.isel(time=slice(count))


def _each(change: Callable[[str, xr.Dataset], xr.Dataset]) -> Damage:
    return lambda groups: {name: change(name, group) for name, group in groups.items()}


def _separates_at(share: float) -> Damage:
    def damage(groups: Groups) -> Groups:
        root = groups[""]
        return groups | {"": root.assign(first_separation=share * root["time_reached"], n_separations=((), 1))}

    return damage


def _still(groups: Groups) -> Groups:
    """Nothing moves: spectra without a line, sections of one point."""
    return {
        name: group if name in ("", "events") else group.map(lambda x: xr.zeros_like(x), keep_attrs=True)
        for name, group in groups.items()
    }


def growing_in_the_end(groups: Groups) -> Groups:
    """Ranges of the last 20 s a twentieth wider: no motion that has come to rest in a steady state."""
    if "history" not in groups or "P_max" not in groups["history"]:
        return groups
    history = groups["history"]
    last = history["time"] > float(history["time"][-1]) - 20
    wider = {
        f"{name}_max": history[f"{name}_max"] + 0.05 * last * (history[f"{name}_max"] - history[f"{name}_min"])
        for name in ("P", "w_point")
    }
    return groups | {"history": history.assign(wider)}


DAMAGES: Mapping[str, Damage] = {
    "failed": _failed,
    "nothing recorded": lambda groups: {"": groups[""]},
    "no events": _without_events,
    "three events": _few_events,
    "no envelopes": _each(_samples_for_ranges),
    "only envelopes": _each(_ranges_for_samples),
    "empty windows": _each(_first(0)),
    "single samples": _each(_first(1)),
    "two samples": _each(_first(2)),
    "separates at once": _separates_at(1e-3),
    "separates in the end": _separates_at(1.0),
    "nothing moves": _still,
}
