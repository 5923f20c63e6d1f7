"""Grids: the values along their axes, and their points in one table, a row each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import reduce
from types import MappingProxyType
from typing import Annotated, Any

import pandas as pd
from pydantic import BeforeValidator, Field, create_model

from disc_model.data.variables import PERTURBATIONS
from disc_model.errors import Fault, ParameterError, require
from disc_model.parameters import NUMBER_OR_WORD, Parameters
from disc_model.studies.quantity import Range, Row, listed_values
from disc_model.units import Finite, Strict, Unit

VARIED = (*Parameters.model_fields, *PERTURBATIONS)  # what a grid may vary, in this order
WORDS = [name for name in Parameters.model_fields if not Parameters.unit(name)]  # vary by words
Points = list[dict[Any, Any]]
"""What varies at each point, by name."""
Dims = Mapping[str, pd.DataFrame]
"""What varies along each dimension, in columns, by its name."""


# ---- Axes


class _Columns(Strict):
    _unknown = "cannot be an axis"


def _axis(name: str) -> Any:
    """The type of values along an axis, a list that may mix values and ranges, or a range; and what it is of."""
    unit = Parameters.unit(name)
    if name in PERTURBATIONS:
        kind: Any = Finite
        text = PERTURBATIONS[name].long_name
    else:
        field = Parameters.model_fields[name]
        text = str(field.description)
        kind = Annotated[field.annotation, name, *field.metadata]
        if name == "disc":
            kind = str
    listed = BeforeValidator(listed_values, json_schema_input_type=list[kind | Range] | Range)
    values = Annotated[tuple[kind, ...], listed, Field(min_length=1), Unit(unit)]
    return values, Field(None, description=text, json_schema_extra={"unit": unit})


_axes: Row = {name: _axis(name) for name in VARIED}
Columns: Any = create_model("Columns", __base__=_Columns, **_axes)
"""An axis for each of several names of `VARIED`."""


def dimensions(axes: Any, zips: Sequence[Any]) -> dict[str, pd.DataFrame]:
    """The columns of each dimension by its name, in SI units: an axis, or a zip, along which several
    parameters vary together; raises `ParameterError`."""
    frames = [pd.DataFrame({name: sorted({*x})}) for name, x in _columns_of(axes).items()]
    for i, each in enumerate(zips):
        columns = _columns_of(each)
        try:
            frame = pd.DataFrame(columns).drop_duplicates()
        except ValueError as error:  # of columns whose lengths differ
            raise ParameterError(Fault(("zip", str(i)), "", str(error))) from None
        frames.append(frame.sort_values([*columns], ignore_index=True))
    frames.sort(key=lambda frame: VARIED.index(frame.columns[0]))
    return {"_".join(map(str, frame)): frame for frame in frames}


def _columns_of(group: Any) -> dict[str, Sequence[Any]]:
    """The given columns of a group, each of numbers or of words alone."""
    columns = {}
    for name in sorted(group.model_fields_set, key=VARIED.index):
        values = getattr(group, name)
        if name in NUMBER_OR_WORD and any(isinstance(value, str) for value in values):
            values = [*map(str, values)]
        columns[name] = values
    return columns


def expand(
    dims: Dims, where: str = "", beside: Mapping[str, Any] = MappingProxyType({})
) -> pd.DataFrame:
    """The points of a grid, a row each, from the columns along each dimension, of which the last one varies
    first; the index counts also those that are left out.

    Parameters
    ----------
    dims : what varies along each dimension, by its name
    where : rule that points keep, such as ``mu_k <= mu_s`` (`pandas.DataFrame.eval`)
    beside : values that do not vary, by names that the rule may have

    Raises
    ------
    ParameterError
        If the rule cannot be read, or leaves no point.
    """
    points = reduce(lambda above, below: above.merge(below, how="cross"), dims.values())
    if where:
        constant = {name: x for name, x in beside.items() if name not in points}
        try:
            kept: Any = points.eval(where, resolvers=[constant])
            points = points[kept]
        except Exception as error:  # whatever pandas makes of a text
            rule = f"must compare values of points: {error}"
            raise ParameterError(Fault.of(("where",), where, rule)) from None
    require((len(points), "where", where, "leaves no point"))
    return points


def case_of(base: Row, discs: Row, **own: Any) -> Parameters:
    """A case from the values that do not vary, and from those of a point, discs by the words that stand for
    them; raises `ParameterError`."""
    if "disc" in own:
        own["disc"] = discs[own["disc"]]
    return Parameters(**{**base, **own})
