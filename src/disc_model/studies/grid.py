"""A grid study: its axes, their points and batches, and the rules between its parts.

The hash of a batch's text is its name. Blocks of values are cut into batches of similar cost, only
inside a block: a finer axis adds batches and keeps the others.
"""

import math
from collections import ChainMap, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import chain, pairwise, product
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, NamedTuple

import pydantic
from pydantic import Field, Tag, WithJsonSchema, create_model

from disc_model import parameters
from disc_model.data.variables import PERTURBATIONS, START, attributes
from disc_model.disc.plausibility import doubts
from disc_model.errors import Fault, ParameterError, raise_faults, suggestion
from disc_model.figures.kinds import General, Kind, Plot, RegionMap
from disc_model.mode_choice import asked_modes
from disc_model.parameters import (
    AUTO,
    PLATE,
    RATIOS,
    RELATED,
    RESIDUAL,
    SURFACE,
    Parameters,
    case_of,
)
from disc_model.simulation.case import SomeParameters, Start
from disc_model.studies.costs import unit_costs
from disc_model.studies.quantity import WORK, Blocks, Quantity, Range, Value, compiled_rule, holds
from disc_model.units import (
    Count,
    Finite,
    Positive,
    Strict,
    canonical_json,
    content_key,
    given_values,
    is_number,
)

if TYPE_CHECKING:
    from disc_model.studies.study import Study

GRID_KEYS = frozenset({"quantity", "options", "axes", "zip", "where", "batch", "starts", "discs"})
REQUIRED = ("N", "Omega")  # parameters without a base value
STATIC = "static"  # name of the default start
MOST_POINTS = 1_000_000  # Snakemake takes hours over so many jobs; many more do not fit into memory
FEW_PARTS = 3  # of a block; so many are equal
# intervals along the side of a tile of a plane, whose cells are refined together
SMALLEST_TILE = 8
LARGEST_TILE = 32

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


VARIED = (
    *Parameters.model_fields,
    *RATIOS,
    START,
    *PERTURBATIONS,
)  # what a grid may vary, in this order


class _Columns(Strict):
    _unknown: ClassVar[str] = "cannot be an axis"


def described(name: str) -> dict[str, Any]:
    """Description and unit of a value in the schema of files."""
    stated = attributes(name)
    unit = Parameters.unit(name) if name in Parameters.model_fields else stated.get("units", "")
    return {"description": stated["long_name"], "json_schema_extra": {"unit": unit}}


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
        None  # most points in a batch; if not given, about 20 s of work
    )


# ---- The grid

_OTHERS: dict[str, Any] = dict.fromkeys(PERTURBATIONS, (Finite, 0.0)) | dict.fromkeys(
    RATIOS, (Positive, 1.0)
)
_Varied = create_model("_Varied", __base__=SomeParameters, **_OTHERS)


class Dimension:
    """One dimension of a grid: an axis, or a zip, along which several parameters vary together."""

    def __init__(self, names: Sequence[str], blocks: Iterable[Iterable[tuple[Value, ...]]]) -> None:
        self.names, self.name = tuple(names), "_".join(names)
        self.blocks: list[list[tuple[Value, ...]]] = []
        known: set[tuple[Value, ...]] = set()
        for block in blocks:  # a value belongs to the first block that has it
            if new := sorted({*block} - known):
                self.blocks.append(new)
                known.update(new)
        self.values = tuple(sorted(known))

    def thinned(self, most: int) -> "Dimension":
        """A dimension of at most `most` values, evenly spaced by place and including both ends;
        words are all kept."""
        values = self.values
        if len(values) > most and not any(
            isinstance(part, str) for value in values for part in value
        ):
            last = len(values) - 1
            values = tuple(values[round(i * last / max(most - 1, 1))] for i in range(most))
        return Dimension(self.names, [values])


class FigureEntry(NamedTuple):
    """A figure as lists and reports show it, and what it is drawn from."""

    plot: Kind
    inputs: Mapping[str, str]  # names of cases, or of grid studies by their roles
    category: str
    section: str
    title: str
    caption: str


class Part(NamedTuple):
    """Some points of a grid that are computed together.

    Attributes
    ----------
    points : for each, the values along the dimensions in their order
    cost : estimated processor time of a point, s
    tile : of a plane: names of its dimensions, values along its sides, and places that are marked
    """

    points: Iterable[Any]
    cost: float
    tile: dict[str, Any] | None = None


class Batch(NamedTuple):
    """A batch: its name, its text, how many points it has, and its estimated processor time, s."""

    name: str
    text: str
    points: int
    seconds: float


class GridStudy:
    """A grid study; raises `ParameterError` with the faults between the parts of its file."""

    def __init__(self, file: "Study", plots: Mapping[str, Plot]) -> None:
        self.file, self.plots = file, plots
        self.name, self.title, self.quantity = file.name, file.title, str(file.quantity)
        self.where, self.discs, self.starts = (
            file.where,
            file.discs,
            {STATIC: Start(), **file.starts},
        )
        self.options: Quantity = file.options
        try:  # what does not vary, and a choice of modes at each point
            self.base, self.mode_request = asked_modes(given_values(file.base))
        except ParameterError as error:
            raise ParameterError(*(fault.inside(("base",)) for fault in error.faults)) from None
        of_options = [
            Dimension([name], map(zip, blocks)) for name, blocks in self.options.dimensions.items()
        ]
        self.dims = (
            *sorted(self._read_dimensions(), key=lambda dim: VARIED.index(dim.names[0])),
            *of_options,
        )
        self.varied = [name for dim in self.dims for name in dim.names]
        raise_faults([*self._wrong_names(), *self._wrong_starts()])
        raise_faults([*self._wrong_extent()])
        whole_base, faults = self._base_of_points(), [*self.options.faults(self)]
        for name, plot in plots.items():
            faults += (fault.inside(("figures", name)) for fault in self.faults_of(plot))
        raise_faults(faults)
        self.base = whole_base

    @property
    def batches(self) -> dict[str, str]:
        """JSON text of each batch by its name, 12 hexadecimal digits."""
        return {name: batch.text for name, batch in self._batches.items()}

    @property
    def work(self) -> dict[str, float]:
        """Estimated processor time of each batch by its name, s, on the machine of
        `disc_model.studies.costs`."""
        return {name: batch.seconds for name, batch in self._batches.items()}

    @cached_property
    def _batches(self) -> dict[str, "Batch"]:
        """The batches by name."""
        parts = self._tiles() if self.options.tiled else self._pieces()
        return {batch.name: batch for batch in map(self._batch, parts) if batch.points}

    @cached_property
    def motions(self) -> dict[str, str]:
        """JSON text, by its name, of the batch of points whose motions are stored; empty for some
        quantities."""
        if not self.options.motions:
            return {}
        few = [dim.thinned(self.options.motions) for dim in self.dims]
        batch = self._batch(Part(product(*(dim.values for dim in few)), 0.0))
        return {batch.name: batch.text} if batch.points else {}

    def _pieces(self) -> Iterator["Part"]:
        """Parts of blocks of the grid, of about equal cost or of the size that the file says."""
        spec = self.file.batch
        cut = spec.over or self.values
        # a dimension that is not cut is taken as blocks of one value each
        blocks = [
            dim.blocks if dim.name in cut else [(value,) for value in dim.values]
            for dim in self.dims
        ]
        for chosen in product(*blocks):
            cost = self._cost_of(product(*chosen))
            size = spec.size or max(1, round(WORK / cost))
            for points in _parts(chosen, size):
                yield Part(points, cost)

    def _tiles(self) -> Iterator["Part"]:
        """Tiles of a plane, for each combination of the other dimensions' values, or for those
        together that the file names."""
        over = self.file.batch.over
        plane = _plane(self.dims, over)
        others = [dim for dim in self.dims if dim not in plane]
        shares = [
            [dim.values] if over and dim.name in over else [(value,) for value in dim.values]
            for dim in others
        ]
        for chosen in product(*shares):
            values = dict(zip([dim.name for dim in others], chosen, strict=True))
            first = [values.get(dim.name, dim.values) for dim in self.dims]
            cost = self._cost_of(product(*first))
            together = math.prod(map(len, chosen))
            side = math.sqrt(WORK / (cost * together))
            size = round(min(max(side, SMALLEST_TILE), LARGEST_TILE))
            for tile in product(*(_cuts(dim.values, size) for dim in plane)):
                yield self._tile(plane, tile, values, cost)

    def _tile(
        self,
        plane: Sequence[Dimension],
        cuts: Sequence[Any],
        others: Mapping[str, Any],
        cost: float,
    ) -> "Part":
        """A tile: its points, and the values along its sides, with those of the next tiles that
        bound its last cells; `cuts` are those of both sides by `_cuts`."""
        along, within = zip(*cuts, strict=True)
        names = [dim.name for dim in plane]
        values = {**others, **dict(zip(names, within, strict=True))}
        sampled = []
        for mark in self._marked():
            place = [_index_of(mark[name], side) for name, side in zip(names, along, strict=True)]
            if None not in place:
                sampled.append(place)
        points = product(*(values[dim.name] for dim in self.dims))
        return Part(points, cost, {"names": names, "along": along, "sampled": sorted(sampled)})

    def _marked(self) -> list[dict[str, float]]:
        """Points of the plane that figures mark, by the names of its dimensions."""
        maps = [plot for plot in self.plots.values() if isinstance(plot, RegionMap)]
        return [{plot.x: mark.x, plot.y: mark.y} for plot in maps for mark in plot.marks.values()]

    def _cost_of(self, points: Iterable[Any]) -> float:
        """Estimated processor time (s) of the first point that keeps the file's rules: the cost of
        others differs little, and a value that is added elsewhere does not change it."""
        first = next(self.points_along(self.dims, points), None)
        if first is None:
            return WORK
        return self.options.cost(unit_costs(self._case_at(first)))

    def _case_at(self, point: Mapping[str, Value]) -> Parameters:
        """The case of a point; where modes are chosen there, with the usual ones."""
        base = {
            name: value
            for name, value in self.base.items()
            if name not in parameters.CHOOSING and value != AUTO
        }
        return Parameters(**case_of(base | dict(point), self.discs))

    def _batch(self, part: "Part") -> "Batch":
        """A part of the grid as a text with everything that its result depends on."""
        points = [*self.points_along(self.dims, part.points)]
        content: dict[str, Any] = {
            "quantity": self.quantity,
            "options": self.options.model_dump(),
            "base": self.base,
            "names": self.varied,
        }
        if part.tile is not None:
            content["tile"] = part.tile
        for name, kind, known in ((START, "starts", self.starts), ("disc", "discs", self.discs)):
            if name in self.varied:
                words = sorted({str(point[name]) for point in points})
                content[kind] = {word: known[word].model_dump() for word in words}
        content["points"] = [
            [*parameters.in_words(point, parameters.IDENTITIES).values()] for point in points
        ]
        text = canonical_json(content)
        return Batch(content_key(text), text, len(points), len(points) * part.cost)

    def points_along(
        self, dims: Sequence[Dimension], every: Iterable[Any] | None = None
    ) -> Iterator[dict[str, Any]]:
        """The varying values, by name, at every point along some dimensions that keeps the file's
        rules."""
        names = [name for dim in dims for name in dim.names]
        for point in product(*(dim.values for dim in dims)) if every is None else every:
            values = dict(zip(names, chain.from_iterable(point), strict=True))
            if not self.where or holds(self.where, {**self.base, **values}):
                yield values

    def points_of(self, names: Iterable[str]) -> Iterator[dict[str, Value]]:
        """Points that keep the file's rules, along the dimensions of some names and those that the
        rules compare."""
        wanted = {*names, *chain(*(compiled_rule(rule).co_names for rule in self.where))}
        ratios = [(name, *RATIOS[name]) for name in RATIOS.keys() & self.varied]
        wanted |= {*chain(*(related for related in ratios if not wanted.isdisjoint(related)))}
        return self.points_along([dim for dim in self.dims if not wanted.isdisjoint(dim.names)])

    @property
    def sources(self) -> tuple[str, ...]:
        """Modules by which its points are computed and that are loaded by name, as
        `disc_model.sources` has them."""
        return f"studies.quantities.{self.quantity}", *["mode_choice"] * (
            self.mode_request is not None
        )

    @property
    def grid(self) -> list[dict[str, Any]]:
        """Dimensions with their values, for `disc_model.studies.merge`."""
        return [{"names": dim.names, "values": dim.values} for dim in self.dims]

    @property
    def values(self) -> dict[str, tuple[tuple[Value, ...], ...]]:
        return {dim.name: dim.values for dim in self.dims}

    @property
    def n_points(self) -> int:
        return sum(1 for _ in self.points_along(self.dims))

    @property
    def attrs(self) -> dict[str, str]:
        """Attributes of the merged dataset that describe the study."""
        where = {"where": " and ".join(f"({rule})" for rule in self.where)} if self.where else {}
        return {"study": self.name, "title": self.title} | where

    @property
    def doubts(self) -> Iterator[str]:
        """Warnings about implausible corners of the grid, one by each rule."""
        corners = self.points_along([dim.thinned(2) for dim in self.dims])
        cases = map(self._case_at, corners)
        yield from ChainMap(*map(doubts, cases)).values()

    # ---- what the file says

    def _read_dimensions(self) -> list[Dimension]:
        faults: list[Fault] = []
        dims = []
        for name, blocks in self._columns(self.file.axes, ("axes",), faults).items():
            dims.append(Dimension([name], map(zip, blocks)))
        for i, group in enumerate(self.file.zip):
            path = ("zip", str(i))
            columns = {
                name: [*chain(*blocks)]
                for name, blocks in self._columns(group, path, faults).items()
            }
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
            blocks: list[list[Any]] = []
            for part in axis.blocks if isinstance(axis, BlocksOf) else [axis]:
                blocks += [part.values, part.extra] if isinstance(part, AxisRange) else [part]
            try:
                columns[name] = tuple(
                    tuple(self._value(name, value) for value in block) for block in blocks
                )
            except ParameterError as error:
                faults += [Fault((*path, name), fault.value, fault.rule) for fault in error.faults]
        return columns

    def _value(self, name: str, value: Value) -> Value:
        """Convert and check one value by itself; `_base_of_points` checks them together."""
        if name in (START, "disc"):
            known = [*(self.starts if name == START else self.discs)]
            if value not in known:
                raise ParameterError(
                    Fault.of((), value, f"no such {name}{suggestion(value, known)}")
                )
            return value
        if (name, value) in (("contact_compliance", RESIDUAL), ("friction_offset", SURFACE)):
            raise ParameterError(
                Fault.of(
                    (), value, "must be a number along an axis: give it in base, for all points"
                )
            )
        return getattr(_Varied.model_validate({name: value}), name)  # type: ignore[no-any-return]

    # ---- rules between its parts

    def _wrong_names(self) -> Iterator[Fault]:
        """Each parameter must be given once: along an axis, in base, by a ratio, or by the
        quantity."""
        in_base, scanned, quantity = (
            self.file.base.model_fields_set,
            self.options.scanned,
            f"quantity {self.quantity}",
        )
        given = defaultdict[str, list[tuple[str, ...]]](list)
        for part, names in (("axes", self.varied), ("base", sorted(in_base)), (quantity, scanned)):
            for name in names:
                given[RATIOS.get(name, (name,))[0]].append((part, name))
        if self.mode_request is not None:
            given["n_circles"].append(("base", "n_diameters"))
        for path, *others in given.values():
            for other in others:
                yield Fault(
                    path, "", f"is given by {' '.join(other)} as well, and must be given once"
                )
        for name in self.varied:
            upper, lower = RATIOS.get(name, (name, ""))
            if "disc" in given and not {upper, lower}.isdisjoint((*PLATE, "damping_ratio")):
                yield Fault(("axes", name), "", "must be left out where a disc is given")
        for name in sorted({*REQUIRED}.difference(given)):
            yield Fault(("axes", name), "", "is required, here, in a zip or in base")
        if not self.dims:
            yield Fault(("axes",), "", "is required: at least one axis or zip")
        if self.options.over and self.options.over not in self.values:
            yield Fault(
                ("axes", self.options.over), "", f"is required: the {quantity} looks along it"
            )
        for name in sorted({*(self.file.batch.over or ())}.difference(self.values)):
            yield Fault.of(
                ("batch", "over"), name, f"must name dimensions (known: {', '.join(self.values)})"
            )

    def _wrong_starts(self) -> Iterator[Fault]:
        """Only some quantities accept another start, and the file must give it in one place
        only."""
        for name in {START, *PERTURBATIONS}.intersection(self.varied):
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
            elif name == START:
                for key in self.options.model_fields_set & {"prerun", "perturbation"}:
                    yield Fault(
                        ("options", key),
                        "",
                        "must not be given where the start varies: say it under starts",
                    )

    def _wrong_extent(self) -> Iterator[Fault]:
        over = self.file.batch.over
        if self.options.tiled and len(_plane(self.dims, over)) != 2:
            rule = f"must name the two dimensions, single numbers, of {self.quantity}'s plane first"
            yield Fault.of(("batch", "over"), over and list(over), rule)
        if (size := math.prod(len(dim.values) for dim in self.dims)) > MOST_POINTS:
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
            reasons |= dict.fromkeys((*PLATE, "damping_ratio"), "no parameter of a given disc")
        if self.mode_request is not None:
            reasons |= dict.fromkeys(("n_diameters", "n_circles"), "chosen at each point")
        by_quantity = f"varied by the quantity {self.quantity}"
        for name in self.options.scanned:
            reasons |= {name: by_quantity, RATIOS.get(name, (name,))[0]: by_quantity}
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
        for point in self.points_of(RELATED):
            try:
                whole = Parameters(
                    **unused | case_of({**self.base, **first, **point}, self.discs)
                ).canonical
            except ParameterError as error:
                raise_faults([self._located(fault, ratios) for fault in error.faults])
        dropped = {*first, *(RATIOS[name][0] for name in (first | self.base).keys() & RATIOS)}
        whole |= {name: value for name, value in self.base.items() if name in RATIOS}
        if self.mode_request is not None:
            dropped.add("n_circles")
            whole |= self.mode_request.given
        return {name: value for name, value in whole.items() if name not in dropped}

    def _located(self, fault: Fault, ratios: Mapping[str, str]) -> Fault:
        """A fault of a point where the file gives the value."""
        name, *rest = fault.path
        if name not in ratios and name not in self.varied:
            return fault.inside(("base",))
        return Fault(
            ("axes", ratios.get(name, name), *rest),
            fault.value,
            f"{fault.rule}, or `where` must exclude it",
        )

    # ---- its figures

    def faults_of(self, plot: Plot) -> Iterable[Fault]:
        """What keeps a figure from showing this study; general ones look at the quantity's
        variables and dimensions."""
        values: dict[str, list[Any]] = {
            name: [value[0] if len(value) == 1 else value for value in along]
            for name, along in self.values.items()
        }
        endless = [name for name, along in values.items() if math.inf in along]
        for field in ("x", "y"):
            if (name := getattr(plot, field, None)) in endless:
                return [Fault.of((field,), name, "has the value inf, which no axis can show")]
        if not isinstance(plot, General):
            quantities = plot.quantities or (plot.kind,)
            if self.quantity in quantities:
                return plot.faults(values)
            return [Fault.of(("kind",), plot.kind, f"needs the quantity {quantities[0]}")]
        quantity, variables = self.options, dict[str, Any]()
        of_points = quantity.COLUMNS, quantity.COORDINATES, [*values]
        others = [name for name in values if name != quantity.over]
        for columns, coordinates, dims in (
            of_points,
            (quantity.SUMMARY_COLUMNS, quantity.SUMMARY_COORDINATES, others),
        ):
            variables |= {name: (*dims, *column.dims) for name, column in columns.items()}
            values |= {
                name: [*coordinate.values(quantity)] for name, coordinate in coordinates.items()
            }
        return plot.faults_among(values, variables)

    def entry_of(self, name: str, plot: Plot) -> FigureEntry:
        inputs = {"study": self.name, **dict(sorted(plot.overlays.items()))}
        category = "Figures" if plot.section else "Maps and curves"
        title = plot.title or f"{self.title or self.name}: {name}"
        caption = f"{plot.caption} From the grid study {self.name}.".strip()
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
        yield from (
            [(value, *rest) for rest in part] for value in first for part in _parts(others, size)
        )
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


def _cuts(
    values: Sequence[tuple[Value, ...]], size: int
) -> list[tuple[list[Value], Sequence[tuple[Value, ...]]]]:
    """Stretches of about `size` intervals, and the part of each that no later stretch contains."""
    n = len(values) - 1
    count = max(1, round(n / size))
    edges = [round(i * n / count) for i in range(count + 1)]
    return [
        ([value for (value,) in values[a : b + 1]], values[a : b + (b == n)])
        for a, b in pairwise(edges)
    ]
