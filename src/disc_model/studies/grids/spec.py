"""Batches of a grid's points, each one text, and their content addresses. A workflow job is given one text.

Dimensions named in ``batch.over`` are cut into batches, by position and only inside a block; of the others, every value
has batches of its own. The text of a batch holds all that its result depends on, and the batch is named by the text's
hash, so that a batch whose content is the same is not computed again, wherever and however the file now says it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Annotated, Any

from pydantic import Field

from disc_model.data.provenance import source_hash
from disc_model.schema import Count, Strict
from disc_model.studies.cases.spec import canonical_json, content_key
from disc_model.studies.grids.axes import Value
from disc_model.studies.grids.dimensions import Dimension
from disc_model.studies.grids.quantities.schema import module_of
from disc_model.studies.start import START, Start

RUNNER = "disc_model.studies.grids.run"


class BatchSpec(Strict):
    """How points are gathered into jobs.

    over : dimensions that are cut; of the others every value has batches of its own. The last dimension if not given
    size : points in a batch, at most; 20 to 60 s of work keep the cost of starting a job below a few per cent
    """

    over: Annotated[tuple[str, ...], Field(min_length=1)] | None = None
    size: Annotated[Count, Field(ge=1)] = 20


def batch_texts(
    quantity: str,
    options: Strict,
    base: Mapping[str, Any],
    starts: Mapping[str, Start],
    dims: Sequence[Dimension],
    batch: BatchSpec,
) -> dict[str, str]:
    """The text of each batch by its name, 12 hexadecimal digits."""
    shared: dict[str, Any] = {
        "quantity": quantity,
        "options": options.model_dump(),
        "base": base,
        "names": [name for dim in dims for name in dim.names],
        "sources": source_hash(module_of(quantity), RUNNER),
    }
    texts = [
        canonical_json({**shared, **_used(starts, shared["names"], points), "points": points})
        for points in _chunks(dims, batch)
    ]
    return {content_key(text): text for text in texts}


def _used(starts: Mapping[str, Start], names: Sequence[str], points: Sequence[Sequence[Value]]) -> dict[str, Any]:
    """The starts that points name, if they do."""
    if START not in names:
        return {}
    used = {str(point[names.index(START)]) for point in points}
    return {"starts": {name: starts[name].model_dump() for name in sorted(used)}}


def _chunks(dims: Sequence[Dimension], batch: BatchSpec) -> Iterator[list[list[Value]]]:
    """Points of each batch, a list of values in the order of the dimensions."""
    over = set(batch.over or [dims[-1].name])
    # a dimension that is not cut is taken as blocks of one value each
    blocks = [dim.blocks if dim.name in over else tuple((value,) for value in dim.values) for dim in dims]
    for chosen in product(*blocks):
        points = [[value for part in point for value in part] for point in product(*chosen)]
        for i in range(0, len(points), batch.size):
            yield points[i : i + batch.size]
