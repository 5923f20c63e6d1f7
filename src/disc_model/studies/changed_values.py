"""What has changed in the file of a study since its results were computed."""

import json
import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import xarray as xr

from disc_model.data.dataset import json_attribute, load
from disc_model.data.variables import stated_in
from disc_model.display import counted
from disc_model.errors import DiscModelError, as_text
from disc_model.parameters import PLATE
from disc_model.studies.grid import GridStudy
from disc_model.studies.merge import fixed_base

NOTHING = "not given"


def changes_since(grid: GridStudy, results: Path) -> list[str]:
    """Values of a grid that differ from those of its results, such as "base.N: 385 -> 400"; none
    where there are no results that can be read."""
    try:
        former = load(results / grid.name / f"{grid.name}.nc").to_dataset()
    except DiscModelError:
        return []
    base = stated_in(former, "base")
    now = fixed_base(grid.base, grid.varied, grid.options)
    found = [*_differences("base", *_comparable(base, now))]
    options = grid.options.model_dump(mode="json")
    found += _differences("options", stated_in(former, "options"), options)
    found += _other_discs(grid, stated_in(former, "discs"))
    for name, values in grid.values.items():
        if former.sizes.get(name, 0) != len(values):
            before = counted(former.sizes.get(name, 0), "value")
            found.append(f"axes.{name}: {before} -> {counted(len(values), 'value')}")
        elif _has_other_values(former, name, values):
            found.append(f"axes.{name}: other values")
    return found


def _comparable(
    before: Mapping[str, Any], now: Mapping[str, Any]
) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
    """Two bases without what only one of them can have: the values of a plate, where the other has a
    disc that is given by its modes."""
    replaced = {*PLATE, "damping_ratio"} - (before.keys() & now.keys())
    if bool(before.get("disc")) == bool(now.get("disc")):
        return before, now
    return _without(before, replaced), _without(now, replaced)


def _without(values: Mapping[str, Any], names: set[str]) -> dict[str, Any]:
    """Values by name, but some."""
    return {name: value for name, value in values.items() if name not in names}


def _differences(part: str, before: Mapping[str, Any], now: Mapping[str, Any]) -> Iterator[str]:
    """Yield what differs between two mappings of values, those of mappings within them by
    themselves."""
    now = json.loads(json_attribute(now))
    for name in dict.fromkeys([*before, *now]):
        old = before.get(name, NOTHING)
        new = now.get(name, NOTHING)
        if _are_equal(old, new):
            continue
        if name == "disc":
            yield from _difference_of_discs(f"{part}.{name}", old, new)
        elif isinstance(old, dict) and isinstance(new, dict):
            yield from _differences(f"{part}.{name}", old, new)
        else:
            yield f"{part}.{name}: {_text(old)} -> {_text(new)}"


def _are_equal(old: Any, new: Any) -> bool:
    """Whether two values are equal; files of results have an infinite number as a text."""
    endless = isinstance(new, float) and math.isinf(new)
    return bool(old == new) or (endless and old == _text(new))


def _difference_of_discs(place: str, old: Any, new: Any) -> Iterator[str]:
    """Yield what differs between two discs, whose tables are too long to be shown."""
    texts = [_text_of_disc(disc) for disc in (old, new)]
    if texts[0] == texts[1]:
        yield f"{place}: other numbers in its table"
    else:
        yield f"{place}: {texts[0]} -> {texts[1]}"


def _text_of_disc(disc: Any) -> str:
    """A disc as far as a line can show it."""
    if not isinstance(disc, dict):
        return NOTHING
    return f"a disc given by {counted(len(disc['omega']), 'mode')}"


def _other_discs(grid: GridStudy, before: Mapping[str, Any]) -> Iterator[str]:
    """Yield which discs along an axis, of those that were computed, have another table."""
    for name, disc in grid.discs.items():
        new = json.loads(json_attribute(disc.model_dump()))
        if name in before and before[name] != new:
            yield from _difference_of_discs(f"discs.{name}", before[name], new)


def _text(value: Any) -> str:
    """A value as a study file has it, shortened."""
    return value if isinstance(value, str) else as_text(value)


def _has_other_values(former: xr.Dataset, name: str, values: tuple[tuple[Any, ...], ...]) -> bool:
    """Whether an axis of one parameter had other values; a zip has none of its own."""
    if name not in former.coords or any(len(value) > 1 for value in values):
        return False
    return bool(former[name].values.tolist() != [value for (value,) in values])
