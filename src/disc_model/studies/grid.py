"""A grid study: its points, their batches, and the rules between its parts.

A workflow job receives one batch as a text. Blocks of values are cut into batches of similar cost, by position and only
inside a block. A finer axis therefore adds batches and keeps the others. Quantities that need a plane at once are cut
into tiles. The text holds everything that its result depends on, and its hash is the name of the batch. A batch with
equal content is therefore not computed again, however the file describes it.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, pairwise, product
from typing import Any, NamedTuple

from pydantic import create_model

from disc_model.data.variables import PERTURBATIONS, START
from disc_model.disc.plausibility import RULES
from disc_model.disc.truncation import FREQUENCIES, ModeRequest, asked_modes
from disc_model.errors import Fault, ParameterError, as_text, suggestion
from disc_model.figures.general import General
from disc_model.figures.kind import Kind, Plot, Values
from disc_model.figures.region_map import RegionMap
from disc_model.parameters import (
    AUTO,
    CHOOSING,
    DEFAULTS,
    PLATE,
    RATIOS,
    RELATED,
    RESIDUAL,
    Parameters,
    case_of,
    cross_faults,
    with_ratios,
)
from disc_model.simulation.case import SomeParameters, Start
from disc_model.studies.document import STATIC, VARIED, BatchSpec, Document, blocks_of
from disc_model.studies.quantity import Quantity
from disc_model.studies.ranges import Blocks, Value
from disc_model.studies.rules import holds, names_in
from disc_model.units import Finite, Positive, canonical_json, content_key, given_values, is_number

GRID_KEYS = frozenset({"quantity", "options", "axes", "zip", "where", "batch", "starts", "discs"})
"""Keys of a study file that concern the grid alone."""
REQUIRED = ("N", "Omega")
"""Parameters without a base value."""
MOST_POINTS = 1_000_000
"""Greatest number of points of a grid: Snakemake takes hours over so many jobs; many more do not fit into memory."""
_OTHERS: dict[str, Any] = dict.fromkeys(PERTURBATIONS, (Finite, 0.0)) | dict.fromkeys(RATIOS, (Positive, 1.0))
_Varied = create_model("_Varied", __base__=SomeParameters, **_OTHERS)

# ----------------------------------------------------------------------------------------------------
# Dimensions of a grid: axes, one parameter each, and zips, several parameters that vary together


@dataclass(frozen=True)
class Dimension:
    """One dimension of a grid: the parameters that vary along it, and their values in blocks of sorted tuples."""

    names: tuple[str, ...]
    blocks: tuple[tuple[tuple[Value, ...], ...], ...]

    @classmethod
    def of(cls, names: Sequence[str], blocks: Iterable[Iterable[tuple[Value, ...]]]) -> Dimension:
        """A dimension from blocks in any order; a value belongs to the first block that has it."""
        seen: set[Any] = set()
        kept = []
        for block in blocks:
            if new := sorted(set(block) - seen):
                seen.update(new)
                kept.append(tuple(new))
        return cls(tuple(names), tuple(kept))

    @property
    def name(self) -> str:
        """The parameter, or the parameters of a zip, joined by _."""
        return "_".join(self.names)

    @property
    def values(self) -> tuple[tuple[Value, ...], ...]:
        """All values, sorted."""
        return tuple(sorted(value for block in self.blocks for value in block))

    def thinned(self, most: int) -> Dimension:
        """A dimension of at most `most` values, evenly spaced by place and including both ends; words are all kept."""
        values = self.values
        if len(values) > most and not any(isinstance(part, str) for value in values for part in value):
            last = len(values) - 1
            values = tuple(values[round(i * last / max(most - 1, 1))] for i in range(most))
        return Dimension(self.names, (values,))


def points(
    dims: Sequence[Dimension], where: Sequence[str] = (), base: Mapping[str, Any] | None = None
) -> Iterator[dict[str, Value]]:
    """The varying values, by name, at every point of a grid that satisfies the rules."""
    names = [name for dim in dims for name in dim.names]
    for point in product(*(dim.values for dim in dims)):
        found = dict(zip(names, chain.from_iterable(point), strict=True))
        if not where or holds(where, {**(base or {}), **found}):
            yield found


# ----------------------------------------------------------------------------------------------------
# Grids


class FigureEntry(NamedTuple):
    """A figure as lists and reports show it, and what it is drawn from.

    inputs : names of cases, or of grid studies by their roles
    """

    plot: Kind
    inputs: Mapping[str, str]
    category: str
    section: str
    title: str
    caption: str


class GridStudy:
    """A grid study. `faults` lists what is wrong with it.

    document : content of the file
    quantity, options : name of the quantity, and the quantity with its options
    base : values that do not vary
    dims : in the order of `VARIED`; varied : names along them
    starts : starts of motions, by name
    plots : figures, by name
    """

    def __init__(self, document: Document, plots: Mapping[str, Plot]) -> None:
        self.document, self.plots, self.faults = document, plots, list[Fault]()
        self.name, self.title, self.quantity = document.study, document.title, str(document.quantity)
        self.where, self.discs, self.starts = document.where, document.discs, {STATIC: Start(), **document.starts}
        self.options: Quantity = document.options
        self.base, self.asked = self._base()
        own = [Dimension((name,), _tupled(blocks)) for name, blocks in self.options.dimensions.items()]
        self.dims = (*sorted(self._dimensions(), key=lambda dim: VARIED.index(dim.names[0])), *own)
        self.varied = [name for dim in self.dims for name in dim.names]
        self._check()

    @cached_property
    def batches(self) -> dict[str, str]:
        """JSON text of each batch by its name, 12 hexadecimal digits."""
        batch = self.document.batch
        if self.options.tiled:
            maps = [plot for plot in self.plots.values() if isinstance(plot, RegionMap)]
            marked = [{plot.x: mark.x, plot.y: mark.y} for plot in maps for mark in plot.marks.values()]
            return self._texts(self.dims, _tiles(self.dims, batch, marked))
        size = batch.size or self.options.batch_size
        return self._texts(self.dims, ({"points": cut} for cut in _chunks(self.dims, batch.over, size)))

    @cached_property
    def motions(self) -> dict[str, str]:
        """JSON text, by its name, of the batch of points whose motions are stored; empty for some quantities."""
        most = self.options.motions
        if not most:
            return {}
        few = [dim.thinned(most) for dim in self.dims]
        return self._texts(few, [{"points": [[*point.values()] for point in points(few)]}])

    def _texts(self, dims: Sequence[Dimension], parts: Iterable[dict[str, Any]]) -> dict[str, str]:
        """Parts of the grid that have points left, each as a text with everything that its result depends on."""
        names = [name for dim in dims for name in dim.names]
        options = self.options.model_dump()
        shared = {"quantity": self.quantity, "options": options, "base": self.base, "names": names}
        texts = []
        for part in parts:
            every = [dict(zip(names, point, strict=True)) for point in part["points"]]
            kept = [point for point in every if not self.where or holds(self.where, {**self.base, **point})]
            stated = {}
            for key, kind, known in ((START, "starts", self.starts), ("disc", "discs", self.discs)):
                if key in names:
                    stated[kind] = {name: known[name].model_dump() for name in {str(point[key]) for point in kept}}
            if kept:
                texts.append(canonical_json(shared | stated | part | {"points": [[*point.values()] for point in kept]}))
        return {content_key(text): text for text in texts}

    @property
    def sources(self) -> tuple[str, ...]:
        """Modules by which its points are computed and that are loaded by name, as `disc_model.sources` has them."""
        by_motion = self.asked is not None and self.asked.quantity != FREQUENCIES
        return f"studies.quantities.{self.quantity}", *["mode_choice"] * by_motion

    @property
    def grid(self) -> list[dict[str, Any]]:
        """Dimensions with their values, for `disc_model.studies.merge`."""
        return [{"names": dim.names, "values": dim.values} for dim in self.dims]

    @property
    def values(self) -> dict[str, tuple[tuple[Value, ...], ...]]:
        """Values along each dimension, by its name."""
        return {dim.name: dim.values for dim in self.dims}

    @property
    def n_points(self) -> int:
        """Number of points of the grid that are not excluded."""
        return (
            sum(1 for _ in points(self.dims, self.where, self.base))
            if self.where
            else math.prod(len(dim.values) for dim in self.dims)
        )

    @property
    def attrs(self) -> dict[str, str]:
        """Attributes of the merged dataset that describe the study."""
        where = {"where": " and ".join(f"({rule})" for rule in self.where)} if self.where else {}
        return {"study": self.name, "title": self.title} | where

    @property
    def doubts(self) -> Iterator[str]:
        """Warnings about implausible points, each with their number."""
        base = {name: value for name, value in self.base.items() if name not in CHOOSING and value != AUTO}
        base |= next(points(self.dims, self.where, base))
        for rule in RULES.values():
            dims = [dim for dim in self.dims if not set(rule.names).isdisjoint(dim.names)]
            looked_at = [dim.thinned(round(300 ** (1 / len(dims)))) for dim in dims]  # about 300 points
            cases = [base | point for point in points(looked_at, self.where, base)] or [base]
            found = [text for case in cases if (text := rule.doubt(Parameters(**case_of(case, self.discs))))]
            if found:
                about = "about " * any(
                    len(few.values) < len(dim.values) for few, dim in zip(looked_at, dims, strict=True)
                )
                yield f"{found[0]} ({about}{len(found) * self.n_points // len(cases)} of {self.n_points} points)"

    # ---- its check

    def _add(self, path: tuple[str, ...], rule: str, *value: Any) -> None:
        self.faults.append(Fault(path, as_text(value[0]) if value else "", rule))

    def _check(self) -> None:
        """Check the rules between the parts; those between values only if the parts are right."""
        if not self.faults:
            self._check_names()
            self._check_starts()
            self._check_where()
        if not self.faults:
            self._check_points()
            self.faults += self.options.faults(self)
            for name, plot in self.plots.items():
                self.faults += [fault.inside(("figures", name)) for fault in self.faults_of(plot)]
        if not self.faults:
            self._complete_base()

    def _complete_base(self) -> None:
        """Give `base` all values that do not vary, as one point has them."""
        point = next(points(self.dims, self.where, self.base))
        unused = {name: 0.0 for name in self.options.scanned if name in REQUIRED}
        try:
            whole = Parameters(**{**unused, **case_of({**self.base, **point}, self.discs)}).canonical
        except ParameterError as error:  # faults of varying and fixed values together
            self.faults += [fault.inside(("base",)) for fault in error.faults]
            return
        dropped = {*point, *(RATIOS[name][0] for name in point.keys() & RATIOS)}
        if self.asked is not None:
            dropped.add("n_circles")
            whole |= self.asked.given
        self.base = {name: value for name, value in whole.items() if name not in dropped}

    # ---- what the file says

    def _base(self) -> tuple[dict[str, Any], ModeRequest | None]:
        """The base values, which need not include N and Omega, and the choice of modes that is made at each point."""
        fixed, asked, faults = asked_modes(given_values(self.document.base))
        self.faults += [fault.inside(("base",)) for fault in faults if isinstance(fault, Fault)]
        if asked is not None and "n_circles" in fixed:
            self._add(("base", "n_circles"), f"is chosen for each point, since base.n_diameters is {AUTO!r}")
        return fixed, asked

    def _dimensions(self) -> Iterator[Dimension]:
        """The valid dimensions of the file."""
        axes = given_values(self.document.axes)
        for name, blocks in self._columns(axes, ("axes",), self.document.resolution).items():
            yield Dimension.of((name,), _tupled(blocks))
        for i, group in enumerate(self.document.zip):
            path = ("zip", str(i))
            columns = {name: [*chain(*blocks)] for name, blocks in self._columns(given_values(group), path).items()}
            if len({len(column) for column in columns.values()}) > 1:
                lengths = ", ".join(f"{name}: {len(column)}" for name, column in columns.items())
                self._add(path, f"must have columns of equal length, not {lengths}")
            elif columns:
                yield Dimension.of([*columns], [list(zip(*columns.values(), strict=True))])

    def _columns(self, given: Mapping[str, Any], path: tuple[str, ...], resolution: int = 1) -> dict[str, Blocks]:
        """Valid blocks of values by name, converted to floats, whole numbers or words."""
        columns = {}
        for name, axis in given.items():
            try:
                blocks = blocks_of(axis, resolution)
                columns[name] = tuple(tuple(self._value(name, value) for value in block) for block in blocks)
            except ParameterError as error:
                self.faults += [Fault((*path, name), fault.value, fault.rule) for fault in error.faults]
            except ValueError as error:
                self._add((*path, name), str(error))
        return columns

    def _value(self, name: str, value: Value) -> Value:
        """Convert and check one value by itself; `_check_points` checks them together."""
        if name == START and not (isinstance(value, str) and value in self.starts):
            raise ParameterError(Fault.of((), value, f"no such start{suggestion(value, self.starts)}"))
        if name == "disc" and not (isinstance(value, str) and value in self.discs):
            raise ParameterError(Fault.of((), value, "must be the table of a disc"))
        if (name, value) in (("n_diameters", AUTO), ("contact_compliance", RESIDUAL)):
            raise ParameterError(Fault.of((), value, "must be a number along an axis: give it in base, for all points"))
        if name in (START, "disc"):
            return value
        return getattr(_Varied.model_validate({name: value}), name)  # type: ignore[no-any-return]

    # ---- rules between its parts

    def _check_names(self) -> None:
        """Check which names vary, which are given, and which are lacking."""
        base, scanned, over = self.document.base.model_fields_set, self.options.scanned, self.document.batch.over
        quantity, names, wanted = f"the quantity {self.quantity}", [dim.name for dim in self.dims], {*self.varied}
        for name in sorted(name for name in wanted if self.varied.count(name) > 1):
            self._add(("axes", name), "varies along two dimensions")
        if not self.dims:
            self._add(("axes",), "is required: at least one axis or zip")
        for name in scanned:
            if name in wanted or name in base:
                self._add(("axes" if name in wanted else "base", name), f"is varied by {quantity}")
        for name in sorted(wanted):
            stands_for, other = RATIOS.get(name, ("", ""))
            others = [RATIOS.get(one, (one,))[0] for one in (*wanted - {name}, *base, *scanned)]
            if "disc" in {*wanted, *base} and not {name, stands_for, other}.isdisjoint((*PLATE, "damping_ratio")):
                self._add(("axes", name), "must be left out where a disc is given: it is a parameter of the plate")
            if stands_for in others:
                self._add(("axes", name), f"stands for {stands_for}, which is given as well")
            elif other in scanned:
                self._add(("axes", name), f"needs {other}, which {quantity} varies")
            if name in base:
                value = getattr(self.document.base, name)
                self._add(("base", name), "varies as well: give it in base or as an axis, not both", value)
            if self.asked is not None and name in ("n_diameters", "n_circles"):
                self._add(("axes", name), f"is chosen for each point, since base.n_diameters is {AUTO!r}")
        for name in REQUIRED:
            if name not in {*wanted, *base, *scanned}:
                self._add(("axes", name), "is required, here, in a zip or in base")
        if self.options.over and self.options.over not in names:
            self._add(("axes", self.options.over), f"is required: {quantity} looks along it")
        for name in over or ():
            if name not in names:
                self._add(("batch", "over"), f"must name dimensions (known: {', '.join(names)})", name)
        if self.options.tiled and not self.faults and len(_plane(self.dims, over)) != 2:
            rule = f"must name the two dimensions, single numbers, of {self.quantity}'s plane first"
            self._add(("batch", "over"), rule, over and list(over))
        if (size := math.prod(len(dim.values) for dim in self.dims)) > MOST_POINTS:
            self._add(("axes",), f"must make at most {MOST_POINTS} points, and not {size}")

    def _check_starts(self) -> None:
        """Only some quantities accept another start, and the file must give it in one place only."""
        for name in {START, *PERTURBATIONS}.intersection(self.varied):
            coordinate = name.removeprefix("perturbation_")
            if "perturbation" not in type(self.options).model_fields:
                self._add(("axes", name), f"the quantity {self.quantity} follows no motion from a start")
                continue
            if coordinate in self.options.perturbation:  # type: ignore[attr-defined]
                self._add(("options", "perturbation", coordinate), f"is given, and varies as axes.{name}")
            for key in self.options.model_fields_set & {"prerun", "perturbation"} if name == START else ():
                self._add(("options", key), "must not be given where the start varies: say it under starts")

    def _check_where(self) -> None:
        """Check the file's own rules: they must compare known values and leave some points."""
        known = {**Parameters.model_fields, **dict.fromkeys(self.varied)}
        for rule in self.where:
            for name in sorted(names_in(rule) - known.keys()):
                more = suggestion(name, [*known], all_of_them=False)
                self._add(("where",), f"{name} is no value of a point{more}", rule)
        if self.where and not self.faults and next(self.points_of(()), None) is None:
            self._add(("where",), "leaves no point")

    def points_of(self, names: Iterable[str]) -> Iterator[dict[str, Value]]:
        """Points that keep the file's rules, along the dimensions of some names and those that the rules compare."""
        wanted = {*names, *chain(*map(names_in, self.where))}
        ratios = [(name, *RATIOS[name]) for name in RATIOS.keys() & self.varied]
        wanted |= {*chain(*(related for related in ratios if not wanted.isdisjoint(related)))}
        return points([dim for dim in self.dims if not wanted.isdisjoint(dim.names)], self.where, self.base)

    def _check_points(self) -> None:
        """Check the rules between parameters of which some vary; each is reported where it is broken first."""
        found = [cross_faults(DEFAULTS | with_ratios({**self.base, **point})) for point in self.points_of(RELATED)]
        ratios = {RATIOS[name][0]: name for name in self.varied if name in RATIOS}
        for fault in first_of_each(chain(*found)):
            name, hint = fault.path[0], ""
            if (rule := re.match(r"must be (<=?) (\w+)=", fault.rule)) and not all(found):
                hint = f"; where: {name} {rule[1]} {rule[2]} leaves out the points that break this"
            if name in ratios:
                self._add(("axes", ratios[name]), f"{fault}{hint}")
            else:
                path = ("axes" if name in self.varied else "base", name)
                self.faults.append(Fault(path, fault.value, fault.rule + hint))

    def faults_of(self, plot: Plot) -> Iterable[Fault]:
        """Faults that keep a figure from showing this grid."""
        if isinstance(plot, General):
            return _general(plot, self.options, self.values)
        if self.quantity in plot.quantities:
            return plot.faults(self.values)
        return [Fault.of(("kind",), plot.kind, f"needs the quantity {plot.quantities[0]}")]

    def entry_of(self, name: str, plot: Plot) -> FigureEntry:
        """A figure of this grid, as lists and reports show it."""
        inputs = {"study": self.name, **dict(sorted(plot.overlays.items()))}
        category = "Figures" if plot.section else "Maps and curves"
        title = plot.title or f"{self.title or self.name}: {name}"
        stated = f"{plot.caption} From the grid study {self.name}.".strip()
        return FigureEntry(plot, inputs, category, plot.section, title, stated)


def _general(plot: General, quantity: Quantity, values: Values) -> Iterator[Fault]:
    """Faults of a general figure, checked against the variables and dimensions of the quantity."""
    # reads xarray, which other figures do not need
    from disc_model.studies.run import coordinates_of

    grid = {name: [one[0] if len(one) == 1 else one for one in along] for name, along in values.items()}
    own: dict[str, list[Any]] = {}
    variables: dict[str, Any] = {}
    others = [name for name in grid if name != quantity.over]
    for columns, coordinates, dims in (
        (quantity.COLUMNS, quantity.COORDINATES, [*grid]),
        (quantity.SUMMARY_COLUMNS, quantity.SUMMARY_COORDINATES, others),
    ):
        variables |= {name: (*dims, *column.dims) for name, column in columns.items()}
        own |= {name: along.values.tolist() for name, along in coordinates_of(coordinates, quantity).items()}
    return plot.faults_among(grid | own, variables)


def _tupled(blocks: Blocks) -> tuple[tuple[tuple[Value], ...], ...]:
    """Blocks of values as those of a dimension of one parameter."""
    return tuple(tuple((value,) for value in block) for block in blocks)


def first_of_each(faults: Iterable[Fault]) -> list[Fault]:
    """The first fault of each parameter."""
    return list({fault.path[0]: fault for fault in reversed([*faults])}.values())[::-1]


# ----------------------------------------------------------------------------------------------------
# Batches


def _chunks(dims: Sequence[Dimension], over: Sequence[str] | None, size: int) -> Iterator[list[list[Value]]]:
    """Points of each batch, a list of values in the order of the dimensions."""
    # an uncut dimension is taken as blocks of one value each
    blocks = [dim.blocks if over is None or dim.name in over else [(value,) for value in dim.values] for dim in dims]
    for chosen in product(*blocks):
        for part in _parts(chosen, size):
            yield [[*chain.from_iterable(point)] for point in part]


def _parts(blocks: Sequence[Sequence[Any]], size: int) -> Iterator[list[tuple[Any, ...]]]:
    """The product of blocks in parts of at most `size`; each holds whole values of a block, and all of later blocks.

    Thus a further value of a dimension that is cut into single values adds parts and keeps the others.
    """
    first, *others = blocks
    within = math.prod(map(len, others))
    if within > size:
        yield from ([(value, *rest) for rest in part] for value in first for part in _parts(others, size))
    else:
        count = size // within
        yield from ([*product(first[i : i + count], *others)] for i in range(0, len(first), count))


def _tiles(
    dims: Sequence[Dimension], batch: BatchSpec, sampled: Collection[Mapping[str, float]]
) -> Iterator[dict[str, Any]]:
    """Points of each tile, and the values along its sides, with those of the next tiles that bound its last cells."""
    plane = _plane(dims, batch.over)
    others = [dim for dim in dims if dim not in plane]
    names = [dim.name for dim in plane]
    gathered = batch.over or [dim.name for dim in others]
    shares = [[dim.values] if dim.name in gathered else [(value,) for value in dim.values] for dim in others]
    for chosen, tile in product(product(*shares), product(*(_cuts(dim.values, batch.tile) for dim in plane))):
        along, kept = zip(*tile, strict=True)
        own = dict(zip([dim.name for dim in (*others, *plane)], [*chosen, *kept], strict=True))
        points = [[*chain.from_iterable(point)] for point in product(*(own[dim.name] for dim in dims))]
        within = [[_at(mark[name], values) for name, values in zip(names, along, strict=True)] for mark in sampled]
        inside = sorted(places for places in within if None not in places)
        yield {"points": points, "tile": {"names": names, "along": along, "sampled": inside}}


def _plane(dims: Sequence[Dimension], over: Sequence[str] | None) -> list[Dimension]:
    """The dimensions of a plane of tiles: those that are named first, or else all numeric ones."""
    numbers = [dim for dim in dims if len(dim.names) == 1 and is_number(dim.values[0][0])]
    return [dim for dim in numbers if over is None or dim.name in over[:2]]


def _at(value: float, along: Sequence[Value]) -> int | None:
    """Index of a value along the side of a tile."""
    return next((i for i, one in enumerate(along) if math.isclose(value, float(one), rel_tol=1e-12)), None)


def _cuts(values: Sequence[tuple[Value, ...]], size: int) -> list[tuple[list[Value], Sequence[tuple[Value, ...]]]]:
    """Stretches of about `size` intervals, and the part of each that no later stretch contains."""
    n = len(values) - 1
    count = max(1, round(n / size))
    edges = [round(i * n / count) for i in range(count + 1)]
    return [([value for (value,) in values[a : b + 1]], values[a : b + (b == n)]) for a, b in pairwise(edges)]
