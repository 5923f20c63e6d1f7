"""A grid study: its axes, their points and batches, and the rules between its parts.

The hash of a batch's text is its name. Blocks of values are cut into batches of so many points, only
inside a block: a finer axis adds batches and keeps the others.
"""

import math
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import chain, pairwise, product
from types import MappingProxyType
from typing import Annotated, Any, ClassVar, NamedTuple

import pydantic
from pydantic import Field, Tag, WithJsonSchema, create_model

from disc_model.data.variables import PERTURBATIONS, attributes, values_text
from disc_model.errors import Fault, ParameterError, raise_faults, suggestion
from disc_model.figures.schema import Kind, Plot
from disc_model.figures.shown import factors_of
from disc_model.parameters import NUMBER_OR_WORD, PLATE, RATIOS, RELATED, Parameters, case_of
from disc_model.simulation.case import SomeParameters
from disc_model.studies.batch import Batch, GridAxis, MergePlan, TileSides
from disc_model.studies.quantity import Blocks, Quantity, Range, Value, compiled_rule, holds
from disc_model.units import Count, Finite, Positive, Strict, given_values, is_number

GRID_KEYS = frozenset({"quantity", "options", "axes", "zip", "where", "batch", "discs"})
REQUIRED = ("N", "Omega")  # parameters without a base value
MOST_POINTS = 1_000_000  # Snakemake takes hours over so many jobs; many more do not fit into memory
ALL_MOTIONS = (
    100  # points of a grid up to which a motion of each is stored, some 3 kB of the explorer each
)
FEW_PARTS = 3  # of a block; so many are equal

# ---- Values along an axis: lists, linear and logarithmic ranges, and blocks of them
NumberOrUnit = Annotated[Any, WithJsonSchema({"type": ["number", "string"]})]
"""A value as given in the file; its parameter determines its meaning."""


class AxisRange(Range):
    """Evenly spaced values along an axis, and `extra` ones, whose batches leave those of the range
    unchanged."""

    extra: list[NumberOrUnit] = Field([])


def _axis_kind(raw: Any) -> str | None:
    if isinstance(raw, Mapping):
        return "BlocksOf" if "blocks" in raw else "AxisRange"
    return "a list" if isinstance(raw, list) and raw else None


_NO_AXIS = "must be a list of values, or a range {start, stop, count or step}"
_BY_KIND = pydantic.Discriminator(
    _axis_kind, custom_error_type="axis", custom_error_message=_NO_AXIS
)
Listed = Annotated[list[NumberOrUnit], Field(min_length=1), Tag("a list")]
Block = Annotated[Listed | Annotated[AxisRange, Tag("AxisRange")], _BY_KIND]


class BlocksOf(Strict):
    """Values in blocks, each with batches of its own; a value in several blocks belongs to the
    first."""

    blocks: Annotated[list[Block], Field(min_length=1)]


Axis = Annotated[
    Listed | Annotated[AxisRange, Tag("AxisRange")] | Annotated[BlocksOf, Tag("BlocksOf")], _BY_KIND
]


VARIED = (*Parameters.model_fields, *RATIOS, *PERTURBATIONS)  # what a grid may vary, in this order


class _Columns(Strict):
    _unknown: ClassVar[str] = "cannot be an axis"


def described(name: str) -> dict[str, Any]:
    """Description and unit of a value in the schema of files."""
    stated = attributes(name)
    meaning, unit = stated["long_name"], stated.get("units", "")
    if name in Parameters.model_fields:
        meaning, unit = Parameters.model_fields[name].description, Parameters.unit(name)
    return {"description": meaning, "json_schema_extra": {"unit": unit}}


_columns: dict[str, Any] = {name: (Axis, Field(None, **described(name))) for name in VARIED}
Columns = create_model(
    "Columns", __base__=_Columns, **_columns
)  # an axis for each of several names of `VARIED`


class BatchSpec(Strict):
    """Division of the points of a grid into jobs."""

    # dimensions that are cut, where each value of the others has batches of its own; if not given,
    # the first ones are, as far as `size` requires. For a plane at once: its two, by default the
    # only ones that are numbers, then those whose values share a batch, by default none
    over: Annotated[tuple[str, ...], Field(min_length=1)] | None = None
    size: Annotated[Count, Field(ge=1)] | None = (
        None  # most points in a batch, of a plane about; if not given, the quantity's `points_per_job`
    )


# ---- The grid

_OTHERS: dict[str, Any] = {
    **dict.fromkeys(PERTURBATIONS, (Finite, 0.0)),
    **dict.fromkeys(RATIOS, (Positive, 1.0)),
}
_Varied = create_model("_Varied", __base__=SomeParameters, **_OTHERS)


class Dimension:
    """One dimension of a grid: an axis, or a zip, along which several parameters vary together."""

    def __init__(self, names: Sequence[str], blocks: Iterable[Iterable[tuple[Value, ...]]]) -> None:
        self.names = tuple(names)
        self.name = "_".join(names)
        self.blocks: list[list[tuple[Value, ...]]] = []
        known: set[tuple[Value, ...]] = set()
        for block in blocks:  # a value belongs to the first block that has it
            new = sorted({*block} - known)
            if new:
                self.blocks.append(new)
                known.update(new)
        self.values = tuple(sorted(known))

    @property
    def single_values(self) -> list[list[tuple[Value, ...]]]:
        """Blocks of one value each."""
        return [[value] for value in self.values]

    def thinned(self, most: int) -> "Dimension":
        """A dimension of at most `most` values, evenly spaced by place and including both ends;
        words are all kept."""
        words = any(isinstance(part, str) for part in chain.from_iterable(self.values))
        if words or len(self.values) <= most:
            return Dimension(self.names, [self.values])
        step = (len(self.values) - 1) / max(most - 1, 1)
        return Dimension(self.names, [[self.values[round(i * step)] for i in range(most)]])


class FigureEntry(NamedTuple):
    """A figure as lists and reports show it, and what it is drawn from."""

    plot: Kind
    inputs: Mapping[str, str]  # names of cases, or of grid studies by their roles
    category: str
    section: str
    title: str
    caption: str
    titles: Mapping[str, str] = MappingProxyType({})  # of the cases that have one, by their names


def _in_words(blocks: Blocks) -> Blocks:
    """Values of which one is a word, all as texts, as a dimension has them; numbers alone as they
    are."""
    if not any(isinstance(value, str) for value in chain.from_iterable(blocks)):
        return blocks
    return tuple(tuple(map(str, block)) for block in blocks)


def _given_twice(path: tuple[str, ...], blocks: Blocks) -> list[Fault]:
    """Faults of values that a block of an axis has twice, as one of them may be a slip."""
    rule = "must not be given twice along an axis"
    faults = []
    for block in blocks:
        twice = [value for value, count in Counter(block).items() if count > 1]
        faults += [Fault.of(path, value, rule) for value in twice]
    return faults


class Part(NamedTuple):
    """Some points of a grid that are computed together.

    Attributes
    ----------
    points : for each, the values along the dimensions in their order
    tile : sides of the tile, of a plane whose points are refined together
    """

    points: Iterable[Any]
    tile: TileSides | None = None


class Cut(NamedTuple):
    """A stretch of the values along one side of a plane: all of them, and those of them, as values
    of the dimension, that no later stretch contains."""

    along: tuple[Value, ...]
    within: Sequence[tuple[Value, ...]]


class GridStudy:
    """A grid study; raises `ParameterError` with the faults between the parts of its file."""

    def __init__(self, file: Any, plots: Mapping[str, Plot]) -> None:
        # the file is a `disc_model.studies.study.Study`
        self.file = file
        self.plots = plots
        self.name = file.name
        self.title = file.title
        self.quantity = str(file.quantity)
        self.where = file.where
        self.discs = file.discs
        self.options: Quantity = file.options
        self.given: dict[str, Any] = given_values(file.base)  # values of base, as in the file
        self.dims = self._dimensions()
        self.varied = [name for dim in self.dims for name in dim.names]
        self._check()

    def _dimensions(self) -> tuple[Dimension, ...]:
        """Return the dimensions in the order of `VARIED`, and those that the options add."""
        own = sorted(self._read_dimensions(), key=lambda dim: VARIED.index(dim.names[0]))
        added = []
        for name, blocks in self.options.dimensions.items():
            added.append(Dimension([name], map(zip, blocks)))
        return (*own, *added)

    def _check(self) -> None:
        """Raise `ParameterError` with the faults between the parts of the file; what the later ones
        need is checked first."""
        raise_faults([*self._wrong_names(), *self._wrong_starts()])
        raise_faults([*self._wrong_extent()])
        self.base  # noqa: B018
        faults = [*self.options.faults(self)]
        for name, plot in self.plots.items():
            faults += (fault.inside(("figures", name)) for fault in self.faults_of(plot))
        raise_faults(faults)

    @cached_property
    def base(self) -> dict[str, Any]:
        """All values that do not vary; raises `ParameterError` with the rules that the first point
        breaks that breaks any."""
        return self._base_of_points()

    @cached_property
    def batches(self) -> dict[str, str]:
        """JSON text of each batch by its name, 12 hexadecimal digits."""
        parts = self._tiles() if self.options.tiled else self._pieces()
        return {batch.key: batch.text for batch in map(self._batch, parts) if batch.points}

    @cached_property
    def motions(self) -> dict[str, str]:
        """JSON text, by its name, of the batch of points whose motions are stored: all of a small
        grid, few of a large one; empty for some quantities."""
        if not self.options.motions:
            return {}
        few: Sequence[Dimension] = self.dims
        if math.prod(len(dim.values) for dim in self.dims) > ALL_MOTIONS:
            few = [dim.thinned(self.options.motions) for dim in self.dims]
        batch = self._batch(Part(product(*(dim.values for dim in few))))
        if not batch.points:
            return {}
        return {batch.key: batch.text}

    @property
    def _batch_size(self) -> int:
        """Most points of a batch."""
        return self.file.batch.size or self.options.points_per_job

    def _pieces(self) -> Iterator[Part]:
        """Parts of blocks of the grid."""
        cut = self.file.batch.over or self.values
        # a dimension that is not cut is taken as blocks of one value each
        blocks = []
        for dim in self.dims:
            blocks.append(dim.blocks if dim.name in cut else dim.single_values)
        for chosen in product(*blocks):
            yield from map(Part, _parts(chosen, self._batch_size))

    def _tiles(self) -> Iterator[Part]:
        """Tiles of a plane, for each combination of the other dimensions' values, or for those
        together that the file names."""
        over = self.file.batch.over
        plane = _plane(self.dims, over)
        others = [dim for dim in self.dims if dim not in plane]
        shares: list[Sequence[Sequence[Any]]] = []
        for dim in others:
            together = over is not None and dim.name in over
            shares.append([dim.values] if together else dim.single_values)
        for chosen in product(*shares):
            values = dict(zip([dim.name for dim in others], chosen, strict=True))
            planes = math.prod(map(len, chosen))
            side = max(1, round(math.sqrt(self._batch_size / planes)))
            for tile in product(*(_cuts(dim.values, side) for dim in plane)):
                yield self._tile(plane, tile, values)

    def _tile(
        self, plane: Sequence[Dimension], cuts: Sequence[Cut], others: Mapping[str, Any]
    ) -> Part:
        """A tile: its points, and the values along its sides, with those of the next tiles that
        bound its last cells; `cuts` are those of both sides by `_cuts`."""
        (first, rows), (second, columns) = zip(plane, cuts, strict=True)
        sampled = []
        for mark in self._marked():
            row = _index_of(mark[first.name], rows.along)
            column = _index_of(mark[second.name], columns.along)
            if row is not None and column is not None:
                sampled.append((row, column))
        values = {**others, first.name: rows.within, second.name: columns.within}
        points = product(*(values[dim.name] for dim in self.dims))
        sides = TileSides(
            names=(first.name, second.name),
            along=(rows.along, columns.along),
            sampled=tuple(sorted(sampled)),
        )
        return Part(points, sides)

    def _marked(self) -> list[dict[str, float]]:
        """Points of the plane that figures mark, by the names of its dimensions."""
        maps: list[Any] = [plot for plot in self.plots.values() if hasattr(plot, "marks")]
        return [{plot.x: mark.x, plot.y: mark.y} for plot in maps for mark in plot.marks.values()]

    def _case_at(self, point: Mapping[str, Value]) -> Parameters:
        """The case of a point."""
        return Parameters(**case_of({**self.base, **point}, self.discs))

    def _batch(self, part: Part) -> Batch:
        """A part of the grid as a text with everything that its result depends on."""
        points = [*self.points_along(self.dims, part.points)]
        discs = {str(point["disc"]) for point in points if "disc" in point}
        return Batch(
            quantity=self.quantity,
            options=self.options.model_dump(),
            base=self.base,
            names=tuple(self.varied),
            points=tuple(tuple(point.values()) for point in points),
            discs={name: self.discs[name] for name in sorted(discs)},
            tile=part.tile,
        )

    def points_along(
        self, dims: Sequence[Dimension], every: Iterable[Any] | None = None
    ) -> Iterator[dict[str, Any]]:
        """The varying values, by name, at every point along some dimensions that keeps the file's
        rules."""
        names = [name for dim in dims for name in dim.names]
        if every is None:
            every = product(*(dim.values for dim in dims))
        for point in every:
            values = dict(zip(names, chain.from_iterable(point), strict=True))
            if not self.where or holds(self.where, {**self.given, **values}):
                yield values

    def points_of(self, names: Iterable[str]) -> Iterator[dict[str, Value]]:
        """Points that keep the file's rules, along the dimensions of some names and those that the
        rules compare."""
        wanted = {*names, *chain(*(compiled_rule(rule).co_names for rule in self.where))}
        for ratio in RATIOS.keys() & self.varied:
            related = {ratio, *RATIOS[ratio]}
            if not wanted.isdisjoint(related):
                wanted.update(related)
        return self.points_along([dim for dim in self.dims if not wanted.isdisjoint(dim.names)])

    @property
    def grid(self) -> tuple[GridAxis, ...]:
        """Dimensions with their values, for `disc_model.studies.merge`."""
        return tuple(GridAxis(names=dim.names, values=dim.values) for dim in self.dims)

    @property
    def merge_plan(self) -> MergePlan:
        """What merging the batches needs beside their files."""
        return MergePlan(batches=tuple(sorted(self.batches)), grid=self.grid, attrs=self.attrs)

    @property
    def values(self) -> dict[str, tuple[tuple[Value, ...], ...]]:
        return {dim.name: dim.values for dim in self.dims}

    @property
    def n_points(self) -> int:
        return sum(1 for _ in self.points_along(self.dims))

    @property
    def attrs(self) -> dict[str, str]:
        """Attributes of the merged dataset that describe the study."""
        attrs = {"study": self.name, "title": self.title}
        if self.where:
            attrs["where"] = " and ".join(f"({rule})" for rule in self.where)
        return attrs

    # ---- what the file says

    def _read_dimensions(self) -> list[Dimension]:
        faults: list[Fault] = []
        dims = []
        for name, blocks in self._columns(self.file.axes, ("axes",), faults).items():
            faults += _given_twice(("axes", name), blocks)
            dims.append(Dimension([name], map(zip, blocks)))
        for i, group in enumerate(self.file.zip):
            path = ("zip", str(i))
            blocks_by_name = self._columns(group, path, faults)
            columns = {name: [*chain(*blocks)] for name, blocks in blocks_by_name.items()}
            if len({len(column) for column in columns.values()}) > 1:
                lengths = ", ".join(f"{name}: {len(column)}" for name, column in columns.items())
                faults.append(Fault(path, "", f"must have columns of equal length, not {lengths}"))
            elif columns:
                dims.append(Dimension([*columns], [zip(*columns.values(), strict=True)]))
        raise_faults(faults)
        return dims

    def _columns(self, axes: Any, path: tuple[str, ...], faults: list[Fault]) -> dict[str, Blocks]:
        """Valid blocks of values by name, converted to floats, whole numbers or words."""
        columns = {}
        for name, axis in given_values(axes).items():
            try:
                blocks = tuple(self._block(name, block) for block in _blocks_of(axis))
                columns[name] = _in_words(blocks) if name in NUMBER_OR_WORD else blocks
            except ParameterError as error:
                faults += [Fault((*path, name), fault.value, fault.rule) for fault in error.faults]
        return columns

    def _block(self, name: str, block: Sequence[Value]) -> tuple[Value, ...]:
        """Convert and check the values of a block."""
        return tuple(self._value(name, value) for value in block)

    def _value(self, name: str, value: Value) -> Value:
        """Convert and check one value by itself; `_base_of_points` checks them together."""
        if name == "disc":
            if value not in self.discs:
                rule = f"no such disc{suggestion(value, [*self.discs])}"
                raise ParameterError(Fault.of((), value, rule))
            return value
        return getattr(_Varied.model_validate({name: value}), name)  # type: ignore[no-any-return]

    # ---- rules between its parts

    def _wrong_names(self) -> Iterator[Fault]:
        """Each parameter must be given once: along an axis, in base, by a ratio, or by the
        quantity."""
        quantity = f"quantity {self.quantity}"
        given = self._places_of_names()
        for path, *others in given.values():
            for other in others:
                rule = f"is given by {' '.join(other)} as well, and must be given once"
                yield Fault(path, "", rule)
        if "disc" in given:
            for name in self.varied:
                if not {name, *RATIOS.get(name, ())}.isdisjoint((*PLATE, "damping_ratio")):
                    yield Fault(("axes", name), "", "must be left out where a disc is given")
        for name in sorted({*REQUIRED}.difference(given)):
            yield Fault(("axes", name), "", "is required, here, in a zip or in base")
        if not self.dims:
            yield Fault(("axes",), "", "is required: at least one axis or zip")
        over = self.options.over
        if over and over not in self.values:
            yield Fault(("axes", over), "", f"is required: the {quantity} looks along it")
        for name in sorted({*(self.file.batch.over or ())}.difference(self.values)):
            yield Fault.of(
                ("batch", "over"), name, f"must name dimensions (known: {', '.join(self.values)})"
            )

    def _places_of_names(self) -> dict[str, list[tuple[str, str]]]:
        """Return, by parameter, the parts of the file that give it, with the name there; a ratio
        gives its first parameter."""
        parts = {
            "axes": self.varied,
            "base": sorted(self.file.base.model_fields_set),
            f"quantity {self.quantity}": self.options.scanned,
        }
        given = defaultdict[str, list[tuple[str, str]]](list)
        for part, names in parts.items():
            for name in names:
                parameter, *_ = RATIOS.get(name, (name,))
                given[parameter].append((part, name))
        return given

    def _wrong_starts(self) -> Iterator[Fault]:
        """Only some quantities accept another start, and the file must give it in one place
        only."""
        for name in sorted(PERTURBATIONS.keys() & {*self.varied}):
            coordinate = name.removeprefix("perturbation_")
            if "perturbation" not in type(self.options).model_fields:
                yield Fault(
                    ("axes", name),
                    "",
                    f"the quantity {self.quantity} follows no motion from a start",
                )
            elif coordinate in self.options.perturbation:  # type: ignore[attr-defined]
                yield Fault(
                    ("options", "perturbation", coordinate),
                    "",
                    f"is given, and varies as axes.{name}",
                )

    def _wrong_extent(self) -> Iterator[Fault]:
        over = self.file.batch.over
        if self.options.tiled and len(_plane(self.dims, over)) != 2:
            rule = f"must name the two dimensions, single numbers, of {self.quantity}'s plane first"
            yield Fault.of(("batch", "over"), over and list(over), rule)
        size = math.prod(len(dim.values) for dim in self.dims)
        if size > MOST_POINTS:
            yield Fault(("axes",), "", f"must make at most {MOST_POINTS} points, and not {size}")
        wrong_rules = [*self._wrong_rules()]
        yield from wrong_rules
        if self.where and not wrong_rules and next(self.points_of(()), None) is None:
            yield Fault(("where",), "", "leaves no point")

    def _wrong_rules(self) -> Iterator[Fault]:
        """Rules of the file may compare values of points only: what the quantity varies, what a
        disc makes meaningless, and numbers of modes that are chosen later are none."""
        unknown = self._unknown_at_points()
        ratios = self.file.base.model_fields_set & RATIOS.keys()
        fields = [*Parameters.model_fields, *self.varied, *sorted(ratios)]
        known = [name for name in dict.fromkeys(fields) if name not in unknown]
        for rule in self.where:
            for name in compiled_rule(rule).co_names:
                if name in unknown:
                    yield Fault.of(("where",), rule, f"{name} is {unknown[name]}")
                elif name not in known:
                    told = suggestion(name, known, all_of_them=False)
                    yield Fault.of(("where",), rule, f"{name} is no value of a point{told}")

    def _unknown_at_points(self) -> dict[str, str]:
        """Parameters without a value of their own at a point, and why they have none."""
        reasons: dict[str, str] = {}
        if "disc" in {*self.varied, *self.file.base.model_fields_set}:
            reasons.update(dict.fromkeys((*PLATE, "damping_ratio"), "no parameter of a given disc"))
        by_quantity = f"varied by the quantity {self.quantity}"
        for name in self.options.scanned:
            reasons[name] = by_quantity
            if name in RATIOS:
                reasons[RATIOS[name][0]] = by_quantity
        given = {*self.varied, *self.file.base.model_fields_set}
        for ratio in RATIOS.keys() & given:
            upper, lower = RATIOS[ratio]
            if lower in reasons:
                reasons[upper] = reasons[lower]
        return reasons

    def _base_of_points(self) -> dict[str, Any]:
        """All values that do not vary; raises `ParameterError` with the rules that the first such
        point breaks."""
        unused = {name: 0.0 for name in self.options.scanned if name in REQUIRED}
        first = next(self.points_along(self.dims))
        ratios = {RATIOS[name][0]: name for name in self.varied if name in RATIOS}
        for point in self.points_of((*RELATED, *NUMBER_OR_WORD)):
            values = case_of({**self.given, **first, **point}, self.discs)
            try:
                whole = Parameters(**{**unused, **values}).model_dump()
            except ParameterError as error:
                raise_faults([self._located(fault, ratios) for fault in error.faults])

        # a ratio stands in place of its first parameter
        given_ratios = {name: value for name, value in self.given.items() if name in RATIOS}
        dropped = {*first}
        dropped.update(RATIOS[name][0] for name in (*first, *given_ratios) if name in RATIOS)
        base = {**whole, **given_ratios}
        return {name: value for name, value in base.items() if name not in dropped}

    def _located(self, fault: Fault, ratios: Mapping[str, str]) -> Fault:
        """A fault of a point where the file gives the value."""
        name, *rest = fault.path
        if name not in ratios and name not in self.varied:
            return fault.inside(("base",))
        path = ("axes", ratios.get(name, name), *rest)
        return Fault(path, fault.value, f"{fault.rule}, or `where` must exclude it")

    # ---- its figures

    def faults_of(self, plot: Plot) -> Iterable[Fault]:
        """What keeps a figure from showing this study."""
        values = self._values_of_figures()
        for field in ("x", "y"):
            name = getattr(plot, field, None)
            if math.inf in values.get(name, ()):
                return [Fault.of((field,), name, "has the value inf, which no axis can show")]
        quantities = plot.shows.quantities
        if quantities and self.quantity not in quantities:
            return [Fault.of(("kind",), plot.kind, f"needs the quantity {quantities[0]}")]
        columns = {**self.options.COLUMNS, **self.options.SUMMARY_COLUMNS}
        classes = [name for name, column in columns.items() if column.flags]
        return plot.faults(values, self._variables(values), classes)

    def _values_of_figures(self) -> dict[Any, list[Any]]:
        """Return the values along each dimension, those of a zip as tuples."""
        values: dict[Any, list[Any]] = {}
        for dim in self.dims:
            values[dim.name] = [value[0] if len(value) == 1 else value for value in dim.values]
        return values

    def _variables(self, along: Mapping[str, list[Any]]) -> dict[str, dict[str, list[Any]]]:
        """Values along the dimensions of each variable of the quantity."""
        quantity = self.options
        values = dict(along)
        for coordinates in (quantity.COORDINATES, quantity.SUMMARY_COORDINATES):
            for name, coordinate in coordinates.items():
                values[name] = [*coordinate.values(quantity)]
        summed = [name for name in along if name != quantity.over]
        dims = {name: (*along, *column.dims) for name, column in quantity.COLUMNS.items()}
        for name, column in quantity.SUMMARY_COLUMNS.items():
            dims[name] = (*summed, *column.dims)
        return {name: {dim: values[dim] for dim in of} for name, of in dims.items()}

    def entry_of(self, name: str, plot: Plot) -> FigureEntry:
        """A figure of the grid, whose caption states the values that differ from Table 1 and do not
        vary."""
        inputs = {"study": self.name, **dict(sorted(plot.overlays.items()))}
        category = "Figures" if plot.section else "Maps and curves"
        title = plot.title or f"{self.title or self.name}: {name}"
        stated = {name: value for name, value in self.base.items() if value or name not in REQUIRED}
        values = values_text(stated, factors_of(plot.units))
        source = f"the grid study {self.name}"
        if values:
            source += f", with {values}"
        caption = f"{plot.caption} From {source}.".strip()
        return FigureEntry(plot, inputs, category, plot.section, title, caption)


# ---- Batches


def _parts(blocks: Sequence[Sequence[Any]], size: int) -> Iterator[list[tuple[Any, ...]]]:
    """The product of blocks in parts of at most `size`; each holds whole values of a block, and all
    of later blocks. Thus a further value of a dimension that is cut into single values adds parts
    and keeps the others. Few parts are made equal, so that no core waits; of many, all but the last
    have the full size, so that a value that is added at the end changes the last alone."""
    first, *others = blocks
    within = math.prod(map(len, others))
    if within > size:
        for value, part in product(first, [*_parts(others, size)]):
            yield [(value, *rest) for rest in part]
    else:
        count = size // within
        parts = math.ceil(len(first) / count)
        if parts <= FEW_PARTS:
            count = math.ceil(len(first) / parts)
        for i in range(0, len(first), count):
            yield [*product(first[i : i + count], *others)]


def _index_of(value: float, side: Sequence[Value]) -> int | None:
    """Place of a value along the side of a tile, None if it is not there."""
    for i, other in enumerate(side):
        if math.isclose(value, float(other), rel_tol=1e-12):
            return i
    return None


def _plane(dims: Sequence[Dimension], over: Sequence[str] | None) -> list[Dimension]:
    """The dimensions of a plane of tiles: those that are named first, or else all numeric ones."""
    numbers = [dim for dim in dims if len(dim.names) == 1 and is_number(dim.values[0][0])]
    return [dim for dim in numbers if over is None or dim.name in over[:2]]


def _blocks_of(axis: Any) -> list[list[Any]]:
    """Return the blocks of values of an axis of a file."""
    blocks: list[list[Any]] = []
    for part in axis.blocks if isinstance(axis, BlocksOf) else [axis]:
        if isinstance(part, AxisRange):
            blocks += [part.values, part.extra]
        else:
            blocks.append(part)
    return blocks


def _cuts(values: Sequence[tuple[Value, ...]], size: int) -> list[Cut]:
    """Return stretches of about `size` intervals."""
    last = len(values) - 1
    count = max(1, round(last / size))
    edges = [round(i * last / count) for i in range(count + 1)]
    cuts = []
    for start, stop in pairwise(edges):
        along = tuple(value for (value,) in values[start : stop + 1])
        own = stop + 1 if stop == last else stop
        cuts.append(Cut(along, values[start:own]))
    return cuts
