"""What the tree of one case holds (see `disc_model.data.dataset`), or why not: what claims and figures ask it for."""

from __future__ import annotations

import xarray as xr

from disc_model.data.variables import STATUSES


class Missing(Exception):
    """Evidence that is not there. The text says why; it goes on after "the case"."""


def group(case: xr.DataTree, name: str) -> xr.Dataset:
    """A window, the Poincare section ``poincare`` or ``events``, as recorded."""
    if name not in case.children:
        status = STATUSES[int(case.dataset["status"])] if "status" in case.dataset else "ok"
        raise Missing("failed" if status == "failed" else f"did not record {name}")
    return case.children[name].to_dataset(inherit=False)


def events(case: xr.DataTree) -> xr.Dataset:
    """Switches within the span ``kept_from`` to ``kept_until``."""
    found = group(case, "events")
    if "kept_from" not in found.attrs:
        raise Missing("keeps no events")
    return found


def samples(case: xr.DataTree, name: str, at_least: int = 2) -> xr.Dataset:
    """A window of single samples, no ranges; at least so many of them."""
    found = group(case, name)
    if any(str(key).endswith("_min") for key in found):
        raise Missing(f"recorded {name} as ranges, not as samples: its window has an envelope")
    if found.sizes["time"] < at_least:
        raise Missing(f"has {found.sizes['time']} samples in {name}, at least {at_least} are needed")
    return found


def ranges(case: xr.DataTree, name: str, at_least: int = 1) -> xr.Dataset:
    """A window of ranges, each variable as ``_min`` and ``_max``; at least so many bins."""
    found = group(case, name)
    if not any(str(key).endswith("_min") for key in found):
        raise Missing(f"recorded {name} as samples, not as ranges: its window needs an envelope")
    if found.sizes["time"] < at_least:
        raise Missing(f"has {found.sizes['time']} bins in {name}, at least {at_least} are needed")
    return found
