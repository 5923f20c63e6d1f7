"""Grid studies: files under config/studies/, checked all at once, and the batches of points they expand to.

A grid is the product of dimensions: axes (one parameter each) and zips (several that vary together). Dimensions
named in ``batch.over`` are cut into batches, by position and only inside a block; of the others, every value has
batches of its own. A batch is one JSON text that holds all its result depends on, and is named by the text's hash,
so that a batch whose content is the same is not computed again, wherever and however the file now says it.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field

from disc_model.data.provenance import source_hash
from disc_model.errors import ParameterError
from disc_model.figures.grids.kinds import PLOTS, Plot, Values
from disc_model.parameters import Parameters
from disc_model.schema import Count, Strict
from disc_model.studies.cases.schema import Name
from disc_model.studies.cases.spec import canonical_json
from disc_model.studies.faults import (
    Faults,
    StudyError,
    add_parameter_faults,
    inherit,
    mapping,
    read_file,
    shown_path,
    validated,
)
from disc_model.studies.grids.axes import Blocks, Value, parse_blocks, without_repeats
from disc_model.studies.grids.quantities.schema import QUANTITIES, Quantity, module_of
from disc_model.truncation import AUTO, asked_modes

VARIED = (
    "N", "Omega", "D_star", "c", "c_p", "k", "k_p", "E", "m",
    "n_diameters", "n_circles", "normalization", "contact",
)  # fmt: skip
"""Parameters that a grid may vary, in the order of its dimensions."""
RUNNER = "disc_model.studies.grids.run"
MOST_POINTS = 1_000_000
"""Of a grid. Snakemake takes hours over so many jobs, and much more does not fit into memory."""
ANY = {"N": 1.0, "Omega": 1.0}
"""Values for the check of one parameter where a study does not give the others."""


class BatchSpec(Strict):
    """How points are gathered into jobs.

    over : dimensions that are cut; of the others every value has batches of its own. The last dimension if not given
    size : points in a batch, at most; 20 to 60 s of work keep the cost of starting a job below a few per cent
    """

    over: Annotated[tuple[str, ...], Field(min_length=1)] | None = None
    size: Annotated[Count, Field(ge=1)] = 20


class _Header(Strict):
    """A study file, but for what depends on its quantity; axes are checked one by one."""

    study: Name
    title: str = ""
    quantity: str
    options: dict[str, Any] = Field({})
    base: dict[str, Any] = Field({})
    axes: dict[str, Any] = Field({})
    zip: dict[str, Any] | list[dict[str, Any]] = Field([])
    batch: BatchSpec = BatchSpec()
    figures: dict[Name, Any] = Field({})


@dataclass(frozen=True)
class Dimension:
    """One dimension of a grid: the parameters that vary along it, and their values in blocks of sorted tuples."""

    names: tuple[str, ...]
    blocks: tuple[tuple[tuple[Value, ...], ...], ...]

    @property
    def name(self) -> str:
        """The parameter, or the parameters of a zip, joined by _."""
        return "_".join(self.names)

    @property
    def values(self) -> tuple[tuple[Value, ...], ...]:
        """All values, sorted."""
        return tuple(sorted(value for block in self.blocks for value in block))


@dataclass(frozen=True)
class GridStudy:
    """A checked grid study.

    Attributes
    ----------
    dims : in the order of `VARIED`
    batches : JSON text of each batch by its name, 12 hexadecimal digits
    """

    name: str
    title: str
    quantity: str
    options: Strict
    base: Mapping[str, Any]
    dims: tuple[Dimension, ...]
    batches: Mapping[str, str]
    plots: Mapping[str, Plot]

    @property
    def key(self) -> str:
        """Name of the merged dataset: a hash of the names of its batches and of its grid."""
        return _short_hash(canonical_json([sorted(self.batches), self.grid]))

    @property
    def grid(self) -> list[dict[str, Any]]:
        """Dimensions with their values, for `disc_model.studies.grids.merge`."""
        return [{"names": dim.names, "values": dim.values} for dim in self.dims]

    @property
    def values(self) -> dict[str, tuple[tuple[Value, ...], ...]]:
        """Values along each dimension, by its name."""
        return {dim.name: dim.values for dim in self.dims}

    @property
    def n_points(self) -> int:
        """Number of points of the grid."""
        return _n_points(self.dims)


def _n_points(dims: Sequence[Dimension]) -> int:
    return math.prod(len(dim.values) for dim in dims)


def load_grid(path: str | Path, overrides: Mapping[str, Any] | None = None, resolution: Any = 1) -> GridStudy:
    """Read and check a grid study.

    Parameters
    ----------
    overrides : laid over the file's content, key by key
    resolution : whole number by which the intervals of all ranges of the grid are divided further

    Raises
    ------
    StudyError
        Listing every fault with its path.
    """
    raw, more = read_file(Path(path))
    if isinstance(raw, Mapping) and overrides:
        raw = inherit(raw, overrides)
    try:
        study = parse_grid(raw, resolution)
    except StudyError as error:
        raise StudyError(*more, *error.faults, source=shown_path(Path(path))) from None
    if more:
        raise StudyError(*more, source=shown_path(Path(path)))
    return study


def load_grids(
    paths: Sequence[str | Path], overrides: Any = None, resolution: Any = 1, taken: Collection[str] = ()
) -> dict[str, GridStudy]:
    """Read several grid studies; raises one `StudyError` for all faults of all of them.

    Parameters
    ----------
    overrides : by study, as for `load_grid`
    taken : names that no study may have
    """
    faults: list[str] = []
    studies: dict[str, GridStudy] = {}
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
    known = {Path(path).stem for path in paths}
    faults += [
        f"overrides.{name}: no such study (known: {', '.join(sorted(known))})" for name in overrides.keys() - known
    ]
    for study in studies.values():
        for plot_name, plot in study.plots.items():
            for role, other in plot.others.items():
                where = f"{study.name}: figures.{plot_name}.others.{role} = {other!r}"
                if other not in known:
                    faults.append(f"{where}: no such study")
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
    dims = _dimensions(raw, fineness, base, faults)
    varied = [name for dim in dims for name in dim.names]
    _check_names(raw, dims, varied, () if quantity is None else quantity.scanned(options), quantity, faults)
    _check_truncation(raw, automatic, faults)
    _check_size(dims, faults)
    # what is only meant to be a dimension, and has faults, counts as one without values
    values: Values = dict.fromkeys(sorted(_asked(raw) - set(varied)), ()) | {dim.name: dim.values for dim in dims}
    plots = _plots(mapping(raw.get("figures")), raw.get("quantity"), values, faults)
    if faults or header is None or quantity is None or options is None:
        raise StudyError(*faults)
    first = {name: value for dim in dims for name, value in zip(dim.names, dim.values[0], strict=True)}
    complete = Parameters(**{**ANY, **base, **first}).model_dump()
    complete |= {name: 0.0 for name in quantity.scanned(options) if name in ANY}  # not used
    if automatic:
        complete |= automatic
        del complete["n_circles"]
    for name in varied:
        del complete[name]
    batches = _batches(header, dims, quantity, options, complete)
    return GridStudy(header.study, header.title, header.quantity, options, complete, dims, batches, plots)


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
        faults.add(("quantity",), name, f"unknown quantity (known: {', '.join(QUANTITIES)})")
    return QUANTITIES.get(name) if isinstance(name, str) else None


def _base(values: Mapping[str, Any], faults: Faults) -> tuple[dict[str, Any], dict[str, Any]]:
    """The base values that are right, N and Omega need not be among them; and what leaves the modes to each point."""
    fixed, tolerance, more = asked_modes(values)
    automatic = {} if tolerance is None else {"n_diameters": AUTO, "truncation_tolerance": tolerance}
    add_parameter_faults(more, lambda name: ("base", name), faults)
    try:
        checked = Parameters(**{**ANY, **fixed}).model_dump()
        return {name: checked[name] for name in fixed}, automatic
    except ParameterError as error:
        add_parameter_faults(error.faults, lambda name: ("base", name), faults)
        return {}, automatic


def _check_truncation(raw: Mapping[str, Any], automatic: Mapping[str, Any], faults: Faults) -> None:
    """What is chosen for each point cannot be given, and the choice is made for all points or none."""
    if not automatic:
        return
    given = [("axes", name) for name in ("n_diameters", "n_circles") if name in _asked(raw)]
    if "n_circles" in mapping(raw.get("base")):
        given.append(("base", "n_circles"))
    for path in given:
        faults.add(path, "", f"is chosen for each point, since base.n_diameters is {AUTO!r}")


def _check_size(dims: Sequence[Dimension], faults: Faults) -> None:
    points = _n_points(dims)
    if points > MOST_POINTS:
        faults.add(("axes",), "", f"must make at most {MOST_POINTS} points, and not {points}")


def _dimensions(
    raw: Mapping[str, Any], resolution: int, base: Mapping[str, Any], faults: Faults
) -> tuple[Dimension, ...]:
    dims: list[Dimension] = []
    for name, given in mapping(raw.get("axes")).items():
        path = ("axes", str(name))
        if name not in VARIED:
            faults.add(path, "", f"cannot be an axis (known: {', '.join(VARIED)})")
            continue
        blocks = parse_blocks(given, path, faults, resolution)
        checked = None if blocks is None else _checked(str(name), blocks, base, path, faults)
        if checked is not None:
            dims.append(Dimension((str(name),), without_repeats([[(v,) for v in block] for block in checked])))
    for i, group in enumerate(_zips(raw)):
        where = ("zip",) if isinstance(raw["zip"], Mapping) else ("zip", str(i))
        dim = _zipped(mapping(group), where, base, faults)
        if dim is not None:
            dims.append(dim)
    return tuple(sorted(dims, key=lambda dim: VARIED.index(dim.names[0])))


def _zips(raw: Mapping[str, Any]) -> list[Any]:
    """What a file gives under ``zip``: one group, or a list of them."""
    zips = raw.get("zip")
    return [zips] if isinstance(zips, Mapping) else zips if isinstance(zips, list) else []


def _asked(raw: Mapping[str, Any]) -> set[str]:
    """Parameters that a file wants to vary, whether or not it says rightly how."""
    return {str(name) for group in (raw.get("axes"), *_zips(raw)) for name in mapping(group)}


def _zipped(
    group: Mapping[Any, Any], path: tuple[str, ...], base: Mapping[str, Any], faults: Faults
) -> Dimension | None:
    columns: dict[str, list[Value]] = {}
    for name, given in group.items():
        if name not in VARIED:
            faults.add((*path, str(name)), "", f"cannot be an axis (known: {', '.join(VARIED)})")
            continue
        blocks = parse_blocks(given, (*path, name), faults)
        checked = None if blocks is None else _checked(name, blocks, base, (*path, name), faults)
        if checked is not None:
            columns[name] = [value for block in checked for value in block]
    if not columns or len(columns) < len(group):
        return None
    lengths = {name: len(column) for name, column in columns.items()}
    if len(set(lengths.values())) > 1:
        faults.add(
            path, "", f"must have columns of equal length, not {', '.join(f'{n}: {k}' for n, k in lengths.items())}"
        )
        return None
    names = tuple(sorted(columns, key=VARIED.index))
    return Dimension(names, without_repeats([list(zip(*[columns[name] for name in names], strict=True))]))


def _checked(
    name: str, blocks: Blocks, base: Mapping[str, Any], path: tuple[str, ...], faults: Faults
) -> list[list[Value]] | None:
    """Values as `Parameters` understands them: floats, whole numbers, words."""
    good = True
    result: list[list[Value]] = []
    for block in blocks:
        result.append([])
        for value in block:
            if name == "n_diameters" and value == AUTO:
                good = False
                faults.add(path, value, "cannot be varied: give it in base, for all points")
                continue
            try:
                result[-1].append(getattr(Parameters(**{**ANY, **base, name: value}), name))
            except ParameterError as error:
                good = False
                add_parameter_faults(error.faults, lambda _: path, faults)
    return result if good else None


def _check_names(
    raw: Mapping[str, Any],
    dims: Sequence[Dimension],
    varied: Sequence[str],
    scanned: Sequence[str],
    quantity: Quantity | None,
    faults: Faults,
) -> None:
    for name in sorted({name for name in varied if varied.count(name) > 1}):
        faults.add(("axes", name), "", "varies along two dimensions")
    if not dims and not faults:
        faults.add(("axes",), "", "is required: at least one axis or zip")
    base = mapping(raw.get("base"))
    asked = _asked(raw)
    for name in scanned:
        if name in asked or name in base:
            faults.add(("axes" if name in asked else "base", name), "", f"is varied by the quantity {raw['quantity']}")
    for name in ("N", "Omega"):
        if name not in asked and name not in base and name not in scanned and quantity is not None:
            faults.add(("axes", name), "", "is required, here, in a zip or in base")
    known = [dim.name for dim in dims]
    over = mapping(raw.get("batch")).get("over")
    for name in over if isinstance(over, list) and not faults else ():
        if name not in known:
            faults.add(("batch", "over"), name, f"must name dimensions (known: {', '.join(known)})")


def _plots(raw: Mapping[Any, Any], quantity: Any, values: Values, faults: Faults) -> dict[str, Plot]:
    plots = {}
    for name, given in raw.items():
        path = ("figures", str(name))
        kind = mapping(given).get("kind")
        if not isinstance(kind, str) or kind not in PLOTS:
            faults.add((*path, "kind"), kind, f"unknown kind of figure (known: {', '.join(PLOTS)})")
            continue
        plot = validated(PLOTS[kind], given, path, faults)
        if plot is None:
            continue
        if plot.quantity != quantity:
            faults.add((*path, "kind"), kind, f"needs the quantity {plot.quantity}")
            continue
        for place, value, rule in plot.faults(values):
            faults.add((*path, *place), value, rule)
        plots[str(name)] = plot
    return plots


# ----------------------------------------------------------------------------------------------------
# Batches


def _batches(
    header: _Header, dims: Sequence[Dimension], quantity: Quantity, options: Strict, base: Mapping[str, Any]
) -> dict[str, str]:
    shared = {
        "quantity": header.quantity,
        "options": options.model_dump(),
        "base": base,
        "names": [name for dim in dims for name in dim.names],
        "sources": source_hash(module_of(header.quantity), RUNNER),
    }
    texts = (canonical_json({**shared, "points": points}) for points in _chunks(dims, header.batch))
    return {_short_hash(text): text for text in texts}


def _chunks(dims: Sequence[Dimension], batch: BatchSpec) -> Iterator[list[list[Value]]]:
    """Points of each batch, a list of values in the order of the dimensions."""
    over = set(batch.over or [dims[-1].name])
    # a dimension that is not cut is taken as blocks of one value each
    blocks = [dim.blocks if dim.name in over else tuple((value,) for value in dim.values) for dim in dims]
    for chosen in product(*blocks):
        points = [[value for part in point for value in part] for point in product(*chosen)]
        for i in range(0, len(points), batch.size):
            yield points[i : i + batch.size]


def _short_hash(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:12]
