"""Grid studies: files under config/studies/, checked all at once, and the batches of points they expand to.

A batch is one text; a workflow job is given one. Blocks of values are cut into batches of about the same work, by
position and only inside a block: a finer axis adds batches and keeps the others. A quantity that needs a plane at once
is cut into tiles of it. The text holds all that its result depends on. The batch is named by the text's hash, so that a
batch whose content is the same is not computed again, wherever and however the file now says it.
"""

from __future__ import annotations

import importlib
import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, pairwise, product
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field

from disc_model.data.provenance import source_hash
from disc_model.data.variables import KICKS, SAMPLE
from disc_model.errors import ParameterError, suggestion
from disc_model.figures.kinds import PLOTS, General, Plot, RegionMap, Values
from disc_model.figures.kinds import Fault as PlotFault
from disc_model.kernels import DECIDING, kinds_of
from disc_model.parameters import AUTO, CHOOSING, Count, Parameters, Strict, Title, is_number, leaves_modes
from disc_model.plausibility import RULES
from disc_model.simulation.case import START, SomeParameters, Start, canonical_json, content_key
from disc_model.studies.files import (
    Faults,
    Name,
    StudyError,
    add_parameter_faults,
    inherit,
    is_name,
    mapping,
    read_file,
    shown_path,
    validated,
    with_more_faults,
)
from disc_model.studies.grids.dimensions import (
    PUBLISHED,
    Dimension,
    Value,
    asked,
    check_points,
    check_size,
    n_points,
    parse_dimensions,
    points,
    thinned,
)
from disc_model.studies.grids.distributions import Sampled, check_distributions
from disc_model.studies.grids.quantities.schema import QUANTITIES, Quantity, module_of
from disc_model.studies.grids.run import own_coordinates
from disc_model.studies.grids.summaries import summary_of
from disc_model.studies.modes import chooser
from disc_model.truncation import FREQUENCIES, asked_modes

# ----------------------------------------------------------------------------------------------------
# Batches

RUNNER = "disc_model.studies.grids.run"
MOTIONS = "disc_model.studies.grids.motions"


class BatchSpec(Strict):
    """How points are gathered into jobs.

    over : dimensions that are cut; of the others every value has batches of its own. If not given, the first dimensions
        are cut as far as it takes to come down to `size`
    size : points in a batch, at most; if not given, about 20 s of work by what a point of the quantity costs
    tile : intervals along the side of a tile, about, for a quantity that needs a plane at once; `over` names its two
        dimensions first, and then those of which all values share a batch. If not given, the plane's are the only two
        that are numbers, and all other values share a batch
    """

    over: Annotated[tuple[str, ...], Field(min_length=1)] | None = None
    size: Annotated[Count, Field(ge=1)] | None = None
    tile: Annotated[Count, Field(ge=1)] = 32


def batch_texts(
    quantity: str,
    options: Strict,
    base: Mapping[str, Any],
    starts: Mapping[str, Start],
    dims: Sequence[Dimension],
    batch: BatchSpec,
    runner: str = RUNNER,
    sampled: Collection[Mapping[str, float]] = (),
) -> dict[str, str]:
    """The text of each batch by its name, 12 hexadecimal digits.

    Parameters
    ----------
    runner : the module that will compute it
    sampled : points of a plane at which a tiled quantity is worked out in any case
    """
    choosing = chooser(asked_modes(base)[1]) if leaves_modes(base) else ()
    shared: dict[str, Any] = {
        "quantity": quantity,
        "options": options.model_dump(),
        "base": base,
        "names": [name for dim in dims for name in dim.names],
        "sources": source_hash(module_of(quantity), runner, *choosing),
    }
    parts: Iterator[dict[str, Any]]
    if QUANTITIES[quantity].tiled and runner == RUNNER:
        parts = _tiles(dims, batch, sampled)
    else:
        size = batch.size or QUANTITIES[quantity].batch_size(options)
        parts = ({**_used(starts, shared["names"], cut), "points": cut} for cut in _chunks(dims, batch.over, size))
    texts = [canonical_json({**shared, **part}) for part in parts]
    return {content_key(text): text for text in texts}


def motion_texts(
    quantity: str, options: Strict, base: Mapping[str, Any], starts: Mapping[str, Start], dims: Sequence[Dimension]
) -> dict[str, str]:
    """The same for `disc_model.studies.grids.motions`: one batch of a few points; none for some quantities."""
    most = QUANTITIES[quantity].motions
    if not most:
        return {}
    few = [thinned(dim, most) for dim in dims]
    batch = BatchSpec(over=tuple(dim.name for dim in few), size=n_points(few))
    return batch_texts(quantity, options, base, starts, few, batch, MOTIONS)


def _used(starts: Mapping[str, Start], names: Sequence[str], points: Sequence[Sequence[Value]]) -> dict[str, Any]:
    """The starts that points name, if they do."""
    if START not in names:
        return {}
    used = {str(point[names.index(START)]) for point in points}
    return {"starts": {name: starts[name].model_dump() for name in sorted(used)}}


def _chunks(dims: Sequence[Dimension], over: Sequence[str] | None, size: int) -> Iterator[list[list[Value]]]:
    """Points of each batch, a list of values in the order of the dimensions."""
    # a dimension that is not to be cut is taken as blocks of one value each
    blocks = [dim.blocks if over is None or dim.name in over else [(value,) for value in dim.values] for dim in dims]
    for chosen in product(*blocks):
        for part in _parts(chosen, size):
            yield [[*chain.from_iterable(point)] for point in part]


def _parts(blocks: Sequence[Sequence[Any]], size: int) -> Iterator[list[tuple[Any, ...]]]:
    """The product of blocks in parts of at most `size`, each of whole values of a block and all of those after it.

    So a further value of a dimension that is cut down to single values adds parts and leaves the others.
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
    """Points of each tile; and the values along its sides, with those of the next tiles that bound its last cells."""
    plane = _plane(dims, batch.over)
    others = [dim for dim in dims if dim not in plane]
    names = [dim.name for dim in plane]
    sides = [_cuts([value for (value,) in dim.values], batch.tile) for dim in plane]
    gathered = batch.over or [dim.name for dim in others]
    shares = [[dim.values] if dim.name in gathered else [(value,) for value in dim.values] for dim in others]
    for chosen, tile in product(product(*shares), product(*sides)):
        own: dict[str, Sequence[tuple[Value, ...]]] = {
            dim.name: share for dim, share in zip(others, chosen, strict=True)
        }
        own |= {name: [(value,) for value in kept] for name, (_, kept) in zip(names, tile, strict=True)}
        points = [[*chain.from_iterable(point)] for point in product(*(own[dim.name] for dim in dims))]
        along = [values for values, _ in tile]
        within = [[_at(mark[name], values) for name, values in zip(names, along, strict=True)] for mark in sampled]
        kept = sorted(places for places in within if None not in places)
        yield {"points": points, "tile": {"names": names, "along": along, "sampled": kept}}


def _plane(dims: Sequence[Dimension], over: Sequence[str] | None) -> list[Dimension]:
    """The dimensions of a plane of tiles: those that are named first, or else all that are numbers."""
    numbers = [dim for dim in dims if len(dim.names) == 1 and is_number(dim.values[0][0])]
    return [dim for dim in numbers if over is None or dim.name in over[:2]]


def _at(value: float, along: Sequence[Value]) -> int | None:
    """Place of a value along the side of a tile."""
    return next((i for i, one in enumerate(along) if math.isclose(value, float(one), rel_tol=1e-12)), None)


def _cuts(values: Sequence[Value], size: int) -> list[tuple[list[Value], list[Value]]]:
    """Stretches of about `size` intervals, and what of each no later one has."""
    n = len(values) - 1
    count = max(1, round(n / size))
    edges = [round(i * n / count) for i in range(count + 1)]
    return [(list(values[a : b + 1]), list(values[a : b + (b == n)])) for a, b in pairwise(edges)]


# ----------------------------------------------------------------------------------------------------
# Studies

LOOKED_AT = 300
"""Points, about, at which each rule is asked whether they can be meant."""
FIRST_SAMPLES = 64
"""In the first block of samples."""
REQUIRED = ("N", "Omega")
"""Parameters without a base value."""
GRID_KEYS = frozenset({"quantity", "options", "axes", "zip", "batch", "starts"})
"""What a study file says of a grid alone."""


class _Header(Strict):
    """A study file, but for what depends on its quantity; axes are checked one by one."""

    study: Name
    title: Title = ""
    quantity: str
    options: dict[str, Any] = Field({})
    base: dict[str, Any] = Field({})
    axes: dict[str, Any] = Field({})
    zip: dict[str, Any] | list[dict[str, Any]] = Field([])
    batch: BatchSpec = BatchSpec()
    starts: dict[str, Any] = Field({})
    figures: dict[Name, Any] = Field({})


@dataclass(frozen=True)
class GridStudy:
    """A checked grid study.

    Attributes
    ----------
    dims : in the order of `VARIED`
    batches : JSON text of each batch by its name, 12 hexadecimal digits
    motions : the same of the points whose motion can be looked at
    """

    name: str
    title: str
    quantity: str
    options: Strict
    base: Mapping[str, Any]
    dims: tuple[Dimension, ...]
    batches: Mapping[str, str]
    plots: Mapping[str, Plot]
    motions: Mapping[str, str]

    @property
    def key(self) -> str:
        """Name of the merged dataset: a hash of the names of its batches and of its grid."""
        return content_key(canonical_json([sorted(self.batches), self.grid]))

    @property
    def grid(self) -> list[dict[str, Any]]:
        """Dimensions with their values, for `disc_model.studies.grids.merge`."""
        return [{"names": dim.names, "values": dim.values} for dim in self.dims]

    @property
    def values(self) -> dict[str, tuple[tuple[Value, ...], ...]]:
        """Values along each dimension, by its name."""
        return {dim.name: dim.values for dim in self.dims}

    @property
    def kernels(self) -> list[str]:
        """Kinds of kernels that its points need, as `disc_model.kernels` names them."""
        deciding = [dim for dim in self.dims if not DECIDING.isdisjoint(dim.names)]
        cases = [{**self.base, **point} for point in points(deciding)]
        return kinds_of(cases, QUANTITIES[self.quantity].tasks)

    @property
    def n_points(self) -> int:
        """Number of points of the grid."""
        return n_points(self.dims)

    @property
    def doubts(self) -> Iterator[str]:
        """What is implausible about its points, each with their number."""
        base = {name: value for name, value in self.base.items() if name not in CHOOSING and value != AUTO}
        for rule in RULES.values():
            dims = [dim for dim in self.dims if not set(rule.names).isdisjoint(dim.names)]
            looked_at = [thinned(dim, round(LOOKED_AT ** (1 / len(dims)))) for dim in dims]
            cases = [base | next(points(self.dims)) | point for point in points(looked_at)]
            found = [
                text
                for case in cases
                if (text := rule.doubt(Parameters(**{x: case[x] for x in case if x in Parameters.model_fields})))
            ]
            if found:
                about = "about " * (n_points(looked_at) < n_points(dims))
                yield f"{found[0]} ({about}{len(found) * self.n_points // len(cases)} of {self.n_points} points)"


def load_grid(path: str | Path, overrides: Mapping[str, Any] | None = None, resolution: Any = 1) -> GridStudy:
    """Read and check a grid study; raises one `StudyError` that lists every fault with its path.

    Parameters
    ----------
    overrides : laid over the file's content, key by key
    resolution : whole number by which the intervals of all ranges of the grid are divided further
    """
    raw, more = read_file(Path(path))
    if isinstance(raw, Mapping) and overrides:
        raw = inherit(raw, overrides)
    return with_more_faults(lambda content: parse_grid(content, resolution), raw, more, shown_path(Path(path)))


def load_grids(
    paths: Sequence[str | Path],
    overrides: Any = None,
    resolution: Any = 1,
    taken: Collection[str] = (),
    own: Mapping[str, GridStudy] | None = None,
    asked: Collection[str] | None = None,
) -> dict[str, GridStudy]:
    """Read several grid studies; raises one `StudyError` for all faults of all of them.

    Parameters
    ----------
    overrides : by study, as for `load_grid`
    taken : names that no study may have
    own : a grid that is there without a file
    asked : names of those whose figures are to be drawn, so that what these show must be there; all if not given
    """
    faults: list[str] = []
    studies: dict[str, GridStudy] = dict(own or {})
    overrides = mapping(overrides)
    for path in paths:
        name = Path(path).stem
        try:
            study = load_grid(path, mapping(overrides.get(name)), resolution)
        except StudyError as error:
            faults += [f"{error.source}: {fault}" for fault in error.faults]
            continue
        if study.name != name:
            faults.append(f"{path}: study = {study.name!r}: must be the name of the file")
        if name in studies:
            faults.append(f"{path}: study = {study.name!r}: is another file's study")
        if study.name in taken:
            faults.append(f"{path}: study = {study.name!r}: is the name of another folder of results")
        studies[name] = study
    known = {*(own or {}), *(Path(path).stem for path in paths)}
    faults += [f"overrides.{name}: no such study{suggestion(name, sorted(known))}" for name in overrides.keys() - known]
    for study in studies.values():
        for plot_name, plot in study.plots.items() if asked is None or study.name in asked else ():
            for role, other in plot.others.items():
                where = f"{study.name}: figures.{plot_name}.others.{role} = {other!r}"
                if other not in known:
                    faults.append(f"{where}: no such study{suggestion(other, sorted(known))}")
                elif other in studies:
                    faults += [f"{where}: {rule}" for rule in plot.misfits_of(role, study, studies[other])]
    if faults:
        raise StudyError(*faults, source="grid studies")
    return studies


def parse_grid(raw: Any, resolution: Any = 1) -> GridStudy:
    """Check the mapping a grid study's file holds; raises `StudyError` listing every fault."""
    faults = Faults()
    fineness = _resolution(resolution, faults)
    header = validated(_Header, raw, (), faults)
    raw = mapping(raw)
    quantity = _quantity(raw, faults)
    options = (
        None if quantity is None else validated(quantity.options, mapping(raw.get("options")), ("options",), faults)
    )
    base, automatic = _base(mapping(raw.get("base")), faults)
    starts = _starts(mapping(raw.get("starts")), faults)
    dims = (*parse_dimensions(raw, fineness, starts, faults), *_samples(options))
    scanned = () if quantity is None else quantity.scanned(options)
    _check_names(raw, dims, scanned, quantity, faults)
    _check_starts(raw, quantity, faults)
    _check_truncation(raw, automatic, faults)
    if not faults:
        check_points(dims, base, faults)
    if not faults and isinstance(options, Sampled):
        check_distributions(options, base, dims[:-1], faults)
    check_size(dims, faults)
    # what is only meant to be a dimension, and has faults, counts as one without values
    meant = sorted(asked(raw).difference(*(dim.names for dim in dims)))
    values: Values = dict.fromkeys(meant, ()) | {dim.name: dim.values for dim in dims}
    plots = _plots(mapping(raw.get("figures")), raw.get("quantity"), options, values, faults)
    if faults or header is None or quantity is None or options is None:
        raise StudyError(*faults)
    first = {name: value for name, value in next(points(dims)).items() if name in Parameters.model_fields}
    unused = {name: 0.0 for name in scanned if name in REQUIRED}
    complete = Parameters(**{**unused, **base, **first}).canonical
    if automatic:
        complete |= automatic
        del complete["n_circles"]
    for name in first:
        complete.pop(name, None)
    sampled = [
        {plot.x: mark.x, plot.y: mark.y}
        for plot in plots.values()
        if isinstance(plot, RegionMap)
        for mark in plot.marks.values()
    ]
    batches = batch_texts(header.quantity, options, complete, starts, dims, header.batch, sampled=sampled)
    motions = motion_texts(header.quantity, options, complete, starts, dims)
    return GridStudy(header.study, header.title, header.quantity, options, complete, dims, batches, plots, motions)


# ----------------------------------------------------------------------------------------------------
# Checks


def _resolution(value: Any, faults: Faults) -> int:
    try:
        number = int(str(value))
    except ValueError:
        number = 0
    if number < 1:
        faults.add(("resolution",), value, "must be a whole number >= 1")
        return 1
    return number


def _quantity(raw: Mapping[str, Any], faults: Faults) -> Quantity | None:
    name = raw.get("quantity")
    if isinstance(name, str) and name not in QUANTITIES:
        faults.add(("quantity",), name, f"unknown quantity{suggestion(name, QUANTITIES)}")
    return QUANTITIES.get(name) if isinstance(name, str) else None


def _base(values: Mapping[str, Any], faults: Faults) -> tuple[dict[str, Any], dict[str, Any]]:
    """The base values that are right, N and Omega need not be among them; and what leaves the modes to each point."""
    fixed, asked, more = asked_modes(values) if leaves_modes(values) else (dict(values), None, [])
    automatic: dict[str, Any] = {}
    if asked is not None:
        automatic = {"n_diameters": AUTO, "truncation_tolerance": asked.tolerance}
        if asked.quantity != FREQUENCIES:
            automatic["truncation_quantity"] = asked.quantity
    add_parameter_faults(more, lambda name: ("base", name), faults)
    try:
        checked = SomeParameters(**fixed)
        return {name: getattr(checked, name) for name in fixed}, automatic
    except ParameterError as error:
        add_parameter_faults(error.faults, lambda name: ("base", name), faults)
        return {}, automatic


def _starts(given: Mapping[Any, Any], faults: Faults) -> dict[str, Start]:
    """The starts that a file names and says rightly; and the published one."""
    starts = {PUBLISHED: Start()}
    for name, raw in given.items():
        path = ("starts", str(name))
        if not is_name(str(name)) or name == PUBLISHED:
            faults.add(path, "", f"must be letters, digits and _, starting with a letter, and not {PUBLISHED}")
        elif (start := validated(Start, raw, path, faults)) is not None:
            starts[str(name)] = start
    return starts


def _samples(options: Strict | None) -> tuple[Dimension, ...]:
    """The dimension of samples, the last, in blocks that double their number: twice as many only add one."""
    if not isinstance(options, Sampled):
        return ()
    ends = [0, min(FIRST_SAMPLES, options.samples)]
    while ends[-1] < options.samples:
        ends.append(2 * ends[-1])
    return (Dimension((SAMPLE,), tuple(tuple((number,) for number in range(a, b)) for a, b in pairwise(ends))),)


def _check_starts(raw: Mapping[str, Any], quantity: Quantity | None, faults: Faults) -> None:
    """What starts elsewhere must be followed by the quantity, and its start be said in one place."""
    wanted = [name for name in (START, *KICKS) if name in asked(raw)]
    options = mapping(raw.get("options"))
    if quantity is not None and not quantity.starts:
        for name in wanted:
            faults.add(("axes", name), "", f"the quantity {raw['quantity']} follows no motion from a start")
    for name in ("prepare", "kick"):
        if START in wanted and name in options:
            faults.add(("options", name), "", "must not be given where the start varies: say it under starts")
    for name in wanted:
        if name in KICKS and name.removeprefix("kick_") in mapping(options.get("kick")):
            faults.add(("options", "kick", name.removeprefix("kick_")), "", f"is given, and varies as axes.{name}")


def _check_truncation(raw: Mapping[str, Any], automatic: Mapping[str, Any], faults: Faults) -> None:
    """What is chosen for each point cannot be given, and the choice is made for all points or none."""
    if not automatic:
        return
    given = [("axes", name) for name in ("n_diameters", "n_circles") if name in asked(raw)]
    if "n_circles" in mapping(raw.get("base")):
        given.append(("base", "n_circles"))
    for path in given:
        faults.add(path, "", f"is chosen for each point, since base.n_diameters is {AUTO!r}")


def _check_names(
    raw: Mapping[str, Any],
    dims: Sequence[Dimension],
    scanned: Sequence[str],
    quantity: Quantity | None,
    faults: Faults,
) -> None:
    varied = [name for dim in dims for name in dim.names]
    for name in sorted({name for name in varied if varied.count(name) > 1}):
        faults.add(("axes", name), "", "varies along two dimensions")
    if not dims and not faults:
        faults.add(("axes",), "", "is required: at least one axis or zip")
    base = mapping(raw.get("base"))
    wanted = asked(raw)
    for name in scanned:
        if name in wanted or name in base:
            faults.add(("axes" if name in wanted else "base", name), "", f"is varied by the quantity {raw['quantity']}")
    for name in sorted(wanted & base.keys()):
        faults.add(("base", name), base[name], "varies as well: give it in base or as an axis, not both")
    for name in REQUIRED:
        if name not in wanted and name not in base and name not in scanned and quantity is not None:
            faults.add(("axes", name), "", "is required, here, in a zip or in base")
    if quantity is not None and quantity.over not in ("", SAMPLE, *(dim.name for dim in dims), *wanted):
        faults.add(("axes", quantity.over), "", f"is required: {raw['quantity']} looks along it")
    known = [dim.name for dim in dims]
    over = mapping(raw.get("batch")).get("over")
    for name in over if isinstance(over, list) and not faults else ():
        if name not in known:
            faults.add(("batch", "over"), name, f"must name dimensions (known: {', '.join(known)})")
    if quantity is not None and quantity.tiled and not faults and len(_plane(dims, over)) != 2:
        rule = f"must name the two dimensions, single numbers, of {raw['quantity']}'s plane first"
        faults.add(("batch", "over"), over, rule)


def _plots(
    raw: Mapping[Any, Any], quantity: Any, options: Strict | None, values: Values, faults: Faults
) -> dict[str, Plot]:
    plots = {}
    for name, given in raw.items():
        path = ("figures", str(name))
        kind = mapping(given).get("kind")
        if not isinstance(kind, str) or kind not in PLOTS:
            faults.add((*path, "kind"), kind, f"unknown kind of figure{suggestion(kind, PLOTS)}")
            continue
        plot = validated(PLOTS[kind], given, path, faults)
        if plot is None:
            continue
        found: Iterable[PlotFault]
        if isinstance(plot, General):
            found = () if options is None else _general(plot, quantity, options, values)
        elif quantity in plot.quantities:
            found = plot.faults(values)
        else:
            found = (PlotFault(("kind",), kind, f"needs the quantity {plot.quantities[0]}"),)
        for place, value, rule in found:
            faults.add((*path, *place), value, rule)
        plots[str(name)] = plot
    return plots


def _general(plot: General, quantity: str, options: Strict, values: Values) -> Iterator[PlotFault]:
    """What keeps a general figure from being drawn: the quantity's module knows its variables and dimensions."""
    module = importlib.import_module(module_of(quantity))
    grid = {name: [one[0] if len(one) == 1 else one for one in along] for name, along in values.items()}
    own = own_coordinates(module, options)
    variables = {name: (*grid, *column.dims) for name, column in module.COLUMNS.items()}
    if (summary := summary_of(quantity)) is not None:
        others = [name for name in grid if name != QUANTITIES[quantity].over]
        variables |= {name: (*others, *column.dims) for name, column in summary.COLUMNS.items()}
        own |= own_coordinates(summary, options)
    return plot.faults_among(grid | {name: along.values.tolist() for name, along in own.items()}, variables)
