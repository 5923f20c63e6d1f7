"""Grids: the values along their axes, their points in one table, and the jobs that compute them.

A point is a row of a table of pandas. The name of a job's file is the hash of what it computes.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property, reduce
from typing import Annotated, Any

import numpy as np
import pandas as pd
from pydantic import (
    BeforeValidator,
    Field,
    TypeAdapter,
    ValidationError,
    WithJsonSchema,
    create_model,
)

from disc_model.data.variables import CHOICES, PERTURBATIONS, attributes
from disc_model.errors import Fault, ParameterError, raise_faults, suggestion
from disc_model.parameters import NUMBER_OR_WORD, PLATE, Disc, Parameters
from disc_model.provenance import canonical_json, content_key, physics_hash
from disc_model.studies.quantity import Quantity, Range
from disc_model.units import UNITS, Finite, Strict, in_si

REQUIRED = ("N", "Omega")  # parameters without a base value
ALL_MOTIONS = 100  # points of a grid up to which a motion of each is stored, some 3 kB each
MOST_POINTS = 1_000_000  # Snakemake takes hours over so many jobs
VARIED = (*Parameters.model_fields, *PERTURBATIONS)  # what a grid may vary, in this order
WORDS = (*CHOICES, "disc")  # what varies by words


# ---- Axes


def _parts(given: Any) -> Any:
    """An axis as a list of values and ranges."""
    parts = [given] if isinstance(given, Mapping) else given
    if not isinstance(parts, list | tuple) or not parts:
        raise ValueError(
            "must be a list of values and ranges, or a range {start, stop, count or step}"
        )
    return [Range.model_validate(part) if isinstance(part, Mapping) else part for part in parts]


NumberOrUnit = Annotated[Any, WithJsonSchema({"type": ["number", "string"]})]
"""A value as given in the file; its parameter determines its meaning."""
Axis = Annotated[
    list[Range | NumberOrUnit],
    BeforeValidator(_parts, json_schema_input_type=list[Range | NumberOrUnit] | Range),
]
"""Values along an axis: a list, which may mix values and ranges, or a range."""


class _Columns(Strict):
    _unknown = "cannot be an axis"


def stated(name: str) -> dict[str, Any]:
    """Description and unit of a value in the schema of files."""
    if name in Parameters.model_fields:
        return {
            "description": Parameters.model_fields[name].description,
            "json_schema_extra": {"unit": Parameters.unit(name)},
        }
    return {"description": attributes(name)["long_name"]}


_columns: dict[str, Any] = {name: (Axis, Field(None, **stated(name))) for name in VARIED}
Columns: Any = create_model("Columns", __base__=_Columns, **_columns)
"""An axis for each of several names of `VARIED`."""


@cache
def _adapter(name: str) -> TypeAdapter[Any]:
    """The type of the values of a parameter or perturbation."""
    if name in PERTURBATIONS:
        return TypeAdapter(Finite)
    info = Parameters.model_fields[name]
    kind: Any = Annotated[info.annotation, info]
    return TypeAdapter(kind)


def checked_value(name: str, value: Any) -> Any:
    """A value of a parameter in SI units, by itself; raises `ParameterError`."""
    faults: list[Fault] = []
    plain = (
        in_si(value, UNITS.get(name, "1"), faults, ())
        if isinstance(value, str) and name not in WORDS
        else value
    )
    raise_faults(faults)
    try:
        return _adapter(name).validate_python(plain)
    except ValidationError as error:
        raise ParameterError(Fault.of((), value, error.errors()[0]["msg"])) from None


def values_along(name: str, axis: Iterable[Any], discs: Mapping[str, Any]) -> list[Any]:
    """The values of an axis in SI units, floats, whole numbers or words; raises `ParameterError` for what
    its parameter cannot be."""
    values: list[Any] = []
    for part in axis:
        values += part.values if isinstance(part, Range) else [part]
    if name == "disc":
        wrong = [value for value in values if value not in discs]
        raise_faults(
            [Fault.of((), each, f"no such disc{suggestion(each, [*discs])}") for each in wrong]
        )
        return values
    checked = [checked_value(name, value) for value in values]
    if name in NUMBER_OR_WORD and any(isinstance(value, str) for value in checked):
        return [*map(str, checked)]
    return checked


def expand(
    dims: Mapping[str, pd.DataFrame],
    rules: Sequence[str] = (),
    beside: Mapping[str, Any] | None = None,
) -> pd.DataFrame:
    """All points of a grid, a row each; their places along its dimensions are the index.

    Parameters
    ----------
    dims : columns that vary together, by the name of their dimension
    rules : such as ``mu_k <= mu_s``, which all points keep (`pandas.DataFrame.query`)
    beside : values that do not vary, which rules may use
    """
    frames = []
    for name, columns in dims.items():
        frames.append(columns.assign(**{f"place of {name}": range(len(columns))}))
    points = reduce(lambda above, below: above.merge(below, how="cross"), frames)
    points = points.set_index([f"place of {name}" for name in dims])
    for rule in rules:
        constant = {name: x for name, x in (beside or {}).items() if name not in points}
        try:
            points = points[points.assign(**constant).eval(rule).to_numpy(bool)]  # type: ignore[union-attr]
        except Exception as error:  # whatever pandas makes of a text
            raise ParameterError(
                Fault.of(("where",), rule, f"must compare values of points: {error}")
            ) from None
    return points


def records(points: pd.DataFrame) -> list[dict[str, Any]]:
    """The rows of a table of points, each by name."""
    return [{str(name): x for name, x in row.items()} for row in points.to_dict("records")]


# ---- Grids


@dataclass(frozen=True)
class Grid:
    """A grid of points at which a quantity is computed; `grid_of` makes and checks it.

    Attributes
    ----------
    quantity, options : and what the file says of it
    case, first : the first possible one, and what of it varies
    dims : columns by dimension, in the order of `VARIED`
    points : a row each
    discs : tables by the words that stand for them
    plane : names of the two dimensions that the quantity takes whole, or none
    size : most points of a job
    """

    quantity: Quantity
    options: Any
    case: Parameters
    first: Mapping[str, Any]
    dims: Mapping[str, pd.DataFrame]
    points: pd.DataFrame
    discs: Mapping[str, Disc]
    plane: tuple[str, ...]
    size: int
    rules: tuple[str, ...]

    @property
    def names(self) -> list[str]:
        """All that varies."""
        return [*self.points.columns]

    @cached_property
    def jobs(self) -> dict[str, str]:
        """What each job computes, as JSON, by the name of its file: a hash of what all have in common,
        and one of their own points."""
        codes = {name: column.flags for name, column in self.quantity.columns.items()}
        common = {"code": physics_hash(), "codes": codes, **self.layout, "axes": {}}
        for dim in self.plane:
            common["axes"][dim] = self.dims[dim][dim].tolist()
        common.pop("dims")
        points = self.rows
        jobs = {}
        for part in np.array_split(np.arange(len(points)), math.ceil(len(points) / self.size)):
            of_part = [points[i] for i in part]
            key = f"{content_key(canonical_json(common))}-{content_key(canonical_json(of_part))}"
            jobs[key] = canonical_json({**common, "points": of_part})
        return jobs

    @property
    def motions(self) -> dict[str, str]:
        """The job of the points whose motions are stored, by the name of its file: all of a small grid, few
        of a large one; none for some quantities."""
        if self.quantity.motion is None:
            return {}
        few = dict(self.dims)
        if len(self.points) > ALL_MOTIONS:
            few = {
                dim: _thinned(frame, self.quantity.motion.number)
                for dim, frame in self.dims.items()
            }
        points = records(expand(few, self.rules, self.fixed))
        text = canonical_json({"code": physics_hash(), **self.layout, "points": points})
        return {content_key(text): text} if points else {}

    @property
    def rows(self) -> list[dict[str, Any]]:
        """What varies at each point, by name, but along the plane."""
        others = self.points.drop(columns=[*self.plane]).drop_duplicates()
        return records(others) if len(others.columns) else [{}]

    @property
    def layout(self) -> dict[str, Any]:
        """What all points have in common, and the dimensions, for JSON."""
        return {
            "quantity": self.quantity.name,
            "options": self.options.model_dump(mode="json"),
            "base": self.fixed,
            "discs": {name: disc.model_dump(mode="json") for name, disc in self.discs.items()},
            "dims": {dim: frame.to_dict("list") for dim, frame in self.dims.items()},
        }

    @property
    def fixed(self) -> dict[str, Any]:
        """The values of the case that all points have: not of what varies or what the quantity varies
        by itself, nor those that something else replaces."""
        without = {*self.names, *self.quantity.varied(self.options)}
        if "damping_ratio" in self.names or self.case.damping_ratio is not None:
            without.add("D_star")
        if "disc" in self.names or self.case.disc is not None:
            without.update((*PLATE, "damping_ratio"))
        return {name: x for name, x in self.case.model_dump().items() if name not in without}


def _thinned(frame: pd.DataFrame, most: int) -> pd.DataFrame:
    """At most so many values of a dimension, evenly spaced by place and including both ends; words are all
    kept."""
    if len(frame) <= most or any(isinstance(value, str) for value in frame.iloc[0]):
        return frame
    return frame.iloc[np.round(np.linspace(0, len(frame) - 1, most)).astype(int)].reset_index(
        drop=True
    )


def dimensions(axes: Any, zips: Sequence[Any], discs: Mapping[str, Any]) -> dict[str, pd.DataFrame]:
    """The columns of each dimension by its name: an axis, or a zip, along which several parameters vary
    together; raises `ParameterError`."""
    faults: list[Fault] = []
    dims: dict[str, pd.DataFrame] = {}
    for path, group in (
        (("axes",), axes),
        *((("zip", str(i)), each) for i, each in enumerate(zips)),
    ):
        columns: dict[str, list[Any]] = {}
        for name in sorted(group.model_fields_set, key=VARIED.index):
            try:
                columns[name] = values_along(name, getattr(group, name), discs)
            except ParameterError as error:
                faults += [Fault((*path, name), each.value, each.rule) for each in error.faults]
        if path == ("axes",):
            dims |= {
                name: pd.DataFrame({name: sorted(set(values))}) for name, values in columns.items()
            }
        elif len({*map(len, columns.values())}) > 1:
            lengths = ", ".join(f"{name}: {len(values)}" for name, values in columns.items())
            faults.append(Fault(path, "", f"must have columns of equal length, not {lengths}"))
        elif columns:
            frame = pd.DataFrame(columns).drop_duplicates().sort_values([*columns])
            dims["_".join(columns)] = frame.reset_index(drop=True)
    raise_faults(faults)
    return dict(sorted(dims.items(), key=lambda dim: VARIED.index(dim[1].columns[0])))


def grid_of(
    quantity: Quantity,
    options: Any,
    base: Mapping[str, Any],
    dims: Mapping[str, pd.DataFrame],
    rules: Sequence[str],
    discs: Mapping[str, Disc],
    size: int | None,
) -> Grid:
    """A grid; raises `ParameterError` with the faults between its parts."""
    names = [name for frame in dims.values() for name in frame]
    own = quantity.varied(options)
    raise_faults([*_wrong_names(quantity, own, base, names), *_wrong_starts(options, names)])
    number = math.prod(map(len, dims.values()))
    if number > MOST_POINTS:
        raise_faults(
            [Fault(("axes",), "", f"must make at most {MOST_POINTS} points, and not {number}")]
        )
    beside = {**dict(Parameters(N=0, Omega=0)), **base} if rules else {}
    points = expand(dims, rules, beside)
    if points.empty:
        raise_faults([Fault(("where",), "", "leaves no point")])
    plane: tuple[str, ...] = ()
    if quantity.plane:
        plane = tuple(dim for dim, frame in dims.items() if [*frame] == [dim] and dim not in WORDS)
        if len(plane) != 2 or rules:
            rule = f"must be two numbers, and no rule: {quantity.name} takes whole planes"
            raise_faults([Fault(("axes",), "", rule)])
    used: Iterable[Any] = points["disc"].unique() if "disc" in points else []
    known = {str(name): discs[name] for name in used}
    case, first = _first_case(points, {**dict.fromkeys({*own} & {*REQUIRED}, 0.0), **base}, known)
    return Grid(
        quantity,
        options,
        case,
        first,
        dims,
        points,
        known,
        plane,
        size or quantity.points_per_job,
        tuple(rules),
    )


def _first_case(
    points: pd.DataFrame, base: Mapping[str, Any], discs: Mapping[str, Disc]
) -> tuple[Parameters, dict[str, Any]]:
    """The case of the first point that is possible, and what of it varies; raises `ParameterError`,
    with what is wrong at the first point, if none is."""
    faults: list[Fault] = []
    for point in records(points):
        given = {**base, **point}
        values: dict[str, Any] = {
            name: x for name, x in given.items() if name in Parameters.model_fields
        }
        if isinstance(values.get("disc"), str):
            values["disc"] = discs[values["disc"]]
        try:
            return Parameters(**values), {name: values[name] for name in point if name in values}
        except ParameterError as error:
            faults = faults or [
                each.inside(("axes",) if each.path[0] in points else ("base",))
                for each in error.faults
            ]
    raise ParameterError(*faults)


def _wrong_names(
    quantity: Quantity, own: Sequence[str], base: Mapping[str, Any], names: Sequence[Any]
) -> Iterator[Fault]:
    """Each parameter must be given once: along an axis, in base, or by the quantity."""
    if not names:
        yield Fault(("axes",), "", "is required: at least one axis or zip")
    for name in VARIED:
        places = {
            "axes": name in names,
            "base": name in base,
            f"quantity {quantity.name}": name in own,
        }
        given = [place for place, holds in places.items() if holds]
        if len(given) > 1 or names.count(name) > 1:
            rule = f"is given by {given[-1]} {name} as well, and must be given once"
            yield Fault((given[0].split()[0], name), "", rule)
        if name in REQUIRED and not given:
            yield Fault(("axes", name), "", "is required, here, in a zip or in base")
        if name in names and name in (*PLATE, "damping_ratio") and "disc" in {*names, *base}:
            yield Fault(("axes", name), "", "must be left out where a disc is given")


def _wrong_starts(options: Any, names: Sequence[Any]) -> Iterator[Fault]:
    """Only some quantities take another start, which must be given in one place only."""
    for name in names:
        if name not in PERTURBATIONS:
            continue
        if not hasattr(options, "start"):
            yield Fault(("axes", name), "", "the quantity follows no motion from a start")
        elif name.removeprefix("perturbation_") in options.start.perturbation:
            yield Fault(("options", "start"), "", f"varies as axes.{name} as well")
