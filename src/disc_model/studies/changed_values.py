"""What has changed in the file of a study since its results were computed."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from disc_model.data.dataset import load
from disc_model.data.variables import stated_in
from disc_model.display import counted
from disc_model.errors import DiscModelError, as_text
from disc_model.studies.grid import GridStudy

NOTHING = "not given"


def changes_since(grid: GridStudy, results: Path) -> list[str]:
    """Values of a grid that differ from those of its results, such as "base.N: 385 -> 400"; none
    where there are no results that can be read."""
    try:
        former = load(results / grid.name / f"{grid.name}.nc").to_dataset()
    except DiscModelError:
        return []
    options = grid.options.model_dump(mode="json")
    found = [*_differences("base", stated_in(former, "base"), grid.base)]
    found += _differences("options", stated_in(former, "options"), options)
    for name, values in grid.values.items():
        if former.sizes.get(name, 0) != len(values):
            before = counted(former.sizes.get(name, 0), "value")
            found.append(f"axes.{name}: {before} -> {counted(len(values), 'value')}")
        elif name in former.coords and _differ(former[name].values.tolist(), values):
            found.append(f"axes.{name}: other values")
    return found


def _differences(part: str, before: Mapping[str, Any], now: Mapping[str, Any]) -> Iterator[str]:
    """Yield what differs between two mappings of values."""
    for name in dict.fromkeys([*before, *now]):
        old = _text(before.get(name, NOTHING))
        new = _text(now.get(name, NOTHING))
        if old != new and name != "disc":  # whose table is too long
            yield f"{part}.{name}: {old} -> {new}"


def _text(value: Any) -> str:
    """A value as a study file has it, shortened."""
    return value if isinstance(value, str) else as_text(value)


def _differ(before: list[Any], values: tuple[tuple[Any, ...], ...]) -> bool:
    """Whether values along an axis of one parameter are others; a zip has none of its own."""
    return all(len(value) == 1 for value in values) and before != [value for (value,) in values]
