"""Discs from tables of their modes, CSV files as this package and as laboratories write them."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, get_args

from disc_model.disc.files.compliance import STATIC_COMPLIANCE, check_compliance, stated_compliance
from disc_model.disc.files.heads import COLUMNS, Head, read_head, with_unit, with_units_of_cells
from disc_model.disc.files.pairs import (
    JOINED,
    OF_A_TEST,
    Halves,
    Pairs,
    check_halves,
    halves_in,
    mean_of,
    of_a_test,
    origins_of,
)
from disc_model.disc.files.rows import begins_a_number, joined, number_in, rows_of
from disc_model.disc.given import SAME_PAIR, DiscReport, doubts_of_halves
from disc_model.errors import Fault, ParameterError, as_text, raise_faults, require
from disc_model.mode_units import POLES, UNCERTAIN
from disc_model.parameters import Disc

if TYPE_CHECKING:
    import os

WRITTEN = (
    "diameters",
    "circles",
    "omega_rad_per_s",
    "amplitude_per_sqrt_kg",
    "damping_ratio",
    "tangential_per_sqrt_kg",
)
"""Columns of `table_text`, in this order, before those of shapes."""
SPLIT = "frequency_split"
"""Column of a table with the relative difference of the frequencies of each pair, which is in the report."""
DOUBT = "# check:"
"""Beginning of a comment with a doubt of the report on the file from which a disc was first read."""
IGNORED = ("name", "mode_name", "comment", "comments", "remark", "remarks", "description", "note")
"""Heads of columns that are for readers, in lower case with "_" between words."""
LABELS = ("mode", "mode_number", "mode_no", "mode_nr", "number", "no", "nr")
"""Heads of a first column that only labels modes, in lower case with "_" between words."""
READ_AS = {
    "diameters": ("nodal diameters", 1.0, ""),
    "circles": ("nodal circles", 1.0, ""),
    "omega": ("frequency", 1 / math.tau, " Hz"),
    "amplitude": ("amplitude", 1.0, " kg^-1/2"),
    "tangential": ("tangential amplitude", 1.0, " kg^-1/2"),
    "damping_ratio": ("damping ratio", 1.0, ""),
}
"""Words for fields of a `Disc`, factors from their SI units to those of a report, and these."""
DAMPING: dict[str, Callable[[float, float], float]] = {
    "q_factor": lambda q, _: 1 / (2 * q),
    "log_decrement": lambda decrement, _: decrement / math.hypot(math.tau, decrement),
    "decay_rate": lambda rate, omega: rate / omega,
}
"""The damping ratio from what stands for it, and the natural frequency, rad/s."""
FIELDS_OF = {
    "pole": ("omega", "damping_ratio"),
    "pole_real": ("damping_ratio",),
    "pole_imag": ("omega",),
    "modal_mass": ("amplitude",),
    **dict.fromkeys(DAMPING, ("damping_ratio",)),
}
"""Fields of a `Disc` that other quantities stand for."""


class Column(NamedTuple):
    """A column of a table: its head and the texts of its cells."""

    head: Head
    cells: tuple[str, ...]

    @property
    def numbers(self) -> list[float | str]:
        """The numbers in SI units; a cell without a number stays a text, which `Disc` refuses."""
        return [number_in(cell, self.head.factor) for cell in self.cells]


def read_disc(path: str | os.PathLike[str], pairs: Pairs = "given") -> Disc:
    """Read a disc from a table of its modes, see `disc_model.Disc.from_csv`."""
    is_choice = isinstance(pairs, str) and pairs in get_args(Pairs)
    require((is_choice, "pairs", pairs, "must be 'given', 'mean' or 'test'"))
    name = Path(path).name
    try:
        text = Path(path).read_text(encoding="utf-8-sig")
    except (OSError, ValueError) as error:
        fault = Fault((as_text(str(path)),), "", f"must be a text file that can be read ({error})")
        raise ParameterError(fault) from None
    try:
        return _disc(text.splitlines(), pairs, name)
    except ParameterError as error:
        raise ParameterError(*(fault.inside((name,)) for fault in error.faults)) from None


def table_text(disc: Disc) -> str:
    """Write a disc as a table of this package."""
    columns: dict[str, Sequence[Any]] = {}
    for name in WRITTEN:
        values = getattr(disc, COLUMNS[name][0])
        if values:
            columns[name] = values
    if disc.report is not None and any(disc.report.split):
        splits = zip(disc.diameters, disc.report.split, strict=True)
        columns[SPLIT] = [split if diameters else 0.0 for diameters, split in splits]
    for i, radius in enumerate(disc.radii):
        columns[f"shape_at_{radius}_m"] = [shape[i] for shape in disc.shapes]
    lines = [",".join(columns)]
    for row in zip(*columns.values(), strict=True):
        lines.append(",".join(map(str, row)))
    for doubt in disc.report.doubts if disc.report else ():
        lines.insert(0, f"{DOUBT} {doubt}")
    if disc.static_compliance is not None:
        lines.insert(0, f"# {STATIC_COMPLIANCE}: {disc.static_compliance}")
    return "".join(f"{line}\n" for line in lines)


# ---- Lines


def _disc(lines: list[str], pairs: Pairs, source: str) -> Disc:
    """The disc of the lines of a table."""
    static = stated_compliance(lines)
    rows = rows_of([line for line in lines if not line.lstrip().startswith("#")])
    columns = _columns(rows)
    values = _values(columns)
    splits = _stated_splits(values, columns)
    values["static_compliance"] = static
    halves: Halves = [[i] for i in range(len(columns[0].cells))]
    fields = values
    try:
        raise_faults([*_with_units(values)])
        if pairs != "given" and _all_numbers(values):
            halves = halves_in(values)
            check_halves(halves, values)
            joined_halves = mean_of if pairs == "mean" else of_a_test
            fields = joined_halves(halves, values)
        disc = Disc(**fields)
    except ParameterError as error:
        faults = (_of_table(fault, columns, halves) for fault in error.faults)
        raise ParameterError(*faults) from None
    check_compliance(disc)
    origins = origins_of(halves, values, splits, pairs)
    notes = [*_notes(columns, disc), *_passed_over(rows)]
    if any(len(group) > 1 for group in halves):
        notes.append(JOINED[pairs])
    doubts = (*stated_doubts(lines), *doubts_of_halves(origins, OF_A_TEST))
    return disc.with_report(DiscReport(source, origins, notes=tuple(notes), doubts=doubts))


def stated_doubts(lines: list[str]) -> Iterator[str]:
    """Yield the doubts of an earlier report, which comments of a table have."""
    for line in lines:
        if line.startswith(DOUBT):
            yield line.removeprefix(DOUBT).strip()


def _with_units(values: Mapping[str, Any]) -> Iterator[Fault]:
    """Yield faults of cells with a unit that the head of their column does not take."""
    for name in UNCERTAIN:
        for i, value in enumerate(values.get(name, [])):
            if isinstance(value, str) and begins_a_number(value):
                yield Fault.of((name, str(i)), value, "must be a number")


# ---- Report


def _notes(columns: list[Column], disc: Disc) -> Iterator[str]:
    """Yield how each column of a table was understood: as what, and from which value to which."""
    for column in columns:
        head = column.head
        if head.quantity == "shape":
            yield f"{head.text!r} as shape at {head.radius:g} m"
            continue
        if head.quantity == "split":
            yield f"{head.text!r} as split of frequencies"
            continue
        for field in FIELDS_OF.get(head.quantity, (head.quantity,)):
            yield f"{head.text!r} as {_range(disc, field)}"
    if not any(disc.damping_ratio):
        yield "no damping"


def _passed_over(rows: list[list[str]]) -> Iterator[str]:
    """Yield of each column of a table that is for readers that it was passed over."""
    names = rows[0]
    kept = _without_remarks(_without_labels(rows))[0]
    for name in names:
        if name not in kept:
            yield f"{name!r} passed over"


def _range(disc: Disc, field: str) -> str:
    """What a field of a disc is, with its least and greatest value."""
    name, factor, unit = READ_AS[field]
    values = getattr(disc, field)
    low = f"{factor * min(values):.5g}"
    high = f"{factor * max(values):.5g}"
    if low == high:
        return f"{name}, {low}{unit}"
    return f"{name}, {low} to {high}{unit}"


# ---- Columns


def _columns(rows: list[list[str]]) -> list[Column]:
    """The columns of a table, checked as a whole."""
    names, *body = _without_remarks(_without_labels(rows)) or [[]]
    if body and _is_of_units(body[0], names):
        names = [*map(with_unit, names, body.pop(0))]
    names, body = with_units_of_cells(names, body)
    heads, faults = _heads(names)
    raise_faults(faults or _faults_together(heads))
    rule = f"values: must be as many as columns, {len(names)}"
    uneven = []
    for i, row in enumerate(body, 1):
        if len(row) != len(names):
            uneven.append(f"mode {i} has {len(row)} {rule}")
    raise_faults(uneven[:3])
    cells = zip(*body, strict=True) if body else [()] * len(heads)
    return [Column(head, column) for head, column in zip(heads, cells, strict=True)]


def _without_remarks(rows: list[list[str]]) -> list[list[str]]:
    """The rows without columns that are for readers."""
    if not rows:
        return rows
    kept = [i for i, name in enumerate(rows[0]) if joined(name).rstrip(".") not in IGNORED]
    return [[cell for i, cell in enumerate(row) if i in kept or i >= len(rows[0])] for row in rows]


def _is_of_units(row: list[str], names: list[str]) -> bool:
    """Whether a row below the names has their units: as many cells, none of which is a number."""
    return len(row) == len(names) and not any(map(begins_a_number, row))


def _without_labels(rows: list[list[str]]) -> list[list[str]]:
    """The rows without a first column that labels modes: what it counts, no other column needs."""
    if rows and joined(rows[0][0]).rstrip(".") in LABELS:
        return [row[1:] for row in rows]
    return rows


def _heads(names: list[str]) -> tuple[list[Head], list[Fault]]:
    """Heads that are known, and the faults of all."""
    heads: list[Head] = []
    faults: list[Fault] = []
    for name in names:
        try:
            heads.append(read_head(name))
        except ParameterError as error:
            faults += error.faults
    if faults and len(names) == 1 and len(names[0].split()) > 1:
        rule = "must be separated by commas, semicolons or tabs"
        faults = [Fault.of(("columns",), names[0], rule)]
    return heads, faults


def _faults_together(heads: list[Head]) -> list[Fault]:
    """Faults of heads that are right by themselves: one that is missing, or says again what another
    one says."""
    quantities = [head.quantity for head in heads if head.quantity != "shape"]
    needed = ["diameters"]
    if "modal_mass" not in quantities:
        needed.append("amplitude")
    if not ("pole" in quantities or {"pole_real", "pole_imag"} <= {*quantities}):
        needed.append("omega")
    faults = []
    for quantity in dict.fromkeys([*needed, *quantities]):
        count = quantities.count(quantity)
        if count != 1:
            faults.append(_wrong_count(quantity, count))
    same = [*itertools.product(POLES, ("omega", "damping_ratio", *DAMPING))]
    same += itertools.combinations(("damping_ratio", *DAMPING), 2)
    same.append(("modal_mass", "amplitude"))
    for one, other in same:
        if one in quantities and other in quantities:
            rule = f"must not have both {one} and {other}, which say the same"
            faults.append(Fault(("columns",), "", rule))
    return faults


def _wrong_count(quantity: str, count: int) -> Fault:
    """The fault that a quantity has no column, or several."""
    names = [name for name, (which, _) in COLUMNS.items() if which == quantity]
    rule = f"must have one column {' or '.join(names) or quantity}"
    if count > 0:
        rule += f", and not {count}"
    return Fault(("columns",), "", rule)


def _values(columns: list[Column]) -> dict[str, Any]:
    """The fields of a `Disc` from the columns of a table."""
    values: dict[str, Any] = {
        column.head.quantity: column.numbers
        for column in columns
        if column.head.quantity != "shape"
    }
    shapes = [column for column in columns if column.head.quantity == "shape"]
    if shapes:
        shapes.sort(key=lambda column: column.head.radius)
        values["radii"] = [column.head.radius for column in shapes]
        values["shapes"] = [*zip(*(column.numbers for column in shapes), strict=True)]
    if any(name in values for name in POLES):
        _replace_poles(values, columns)
    _replace_others(values)
    return values


def _replace_others(values: dict[str, Any]) -> None:
    """Put damping ratios and amplitudes in the place of what stands for them; raises
    `ParameterError` for cells that are no positive numbers."""
    for name in ("modal_mass", *DAMPING):
        for i, value in enumerate(values.get(name, [])):
            is_positive = isinstance(value, float) and 0 < value < math.inf
            require((is_positive, name, value, f"must be a number > 0 (mode {i + 1})"))
    for name, ratio_of in DAMPING.items():
        if name in values:
            pairs = zip(values.pop(name), values["omega"], strict=True)
            values["damping_ratio"] = [_or_nan(ratio_of, *pair) for pair in pairs]
    if "modal_mass" in values:
        values["amplitude"] = [1 / math.sqrt(mass) for mass in values.pop("modal_mass")]


def _or_nan(ratio_of: Callable[[float, float], float], value: float, omega: Any) -> float:
    """A damping ratio, nan beside a natural frequency that is no positive number, which is
    refused."""
    is_positive = isinstance(omega, float) and omega > 0
    return ratio_of(value, omega) if is_positive else math.nan


def _stated_splits(values: dict[str, Any], columns: list[Column]) -> list[float]:
    """The splits of pairs that a table states, taken out of its values; none if there are none."""
    splits = values.pop("split", [])
    for i, split in enumerate(splits):
        is_split = isinstance(split, float) and 0 <= split < 2 * SAME_PAIR
        head = next(column.head.text for column in columns if column.head.quantity == "split")
        rule = f"must be a number from 0 to {2 * SAME_PAIR:g} (mode {i + 1})"
        is_alone = values["diameters"][i] == 0 and split != 0
        alone = f"must be 0 for a mode without nodal diameters, which is no pair (mode {i + 1})"
        require((is_split, head, split, rule), (not is_alone, head, split, alone))
    return splits


def _replace_poles(values: dict[str, Any], columns: list[Column]) -> None:
    """Put natural frequencies and damping ratios in the place of poles."""
    stated = {column.head.quantity: column for column in columns}
    if "pole" in stated:
        factor = stated["pole"].head.factor
        texts = list(stated["pole"].cells)
        poles = [_complex(cell) * factor for cell in texts]
    else:
        parts = zip(stated["pole_real"].cells, stated["pole_imag"].cells, strict=True)
        texts = [f"{real}, {imag}" for real, imag in parts]
        poles = [*map(_pole, values["pole_real"], values["pole_imag"])]
    for i, (text, pole) in enumerate(zip(texts, poles, strict=True)):
        is_pole = pole.real <= 0 and pole.imag != 0 and abs(pole) < math.inf
        rule = "must be a complex number with a real part of at most 0 and an imaginary part "
        require((is_pole, "pole", text, f"{rule}(mode {i + 1})"))

    for name in POLES:
        values.pop(name, None)
    values["omega"] = [abs(pole) for pole in poles]
    values["damping_ratio"] = [max(0.0, -pole.real / abs(pole)) for pole in poles]


def _pole(real: float | str, imag: float | str) -> complex:
    """A pole from its two cells; nan where one of them is no number."""
    if isinstance(real, str) or isinstance(imag, str):
        return complex(math.nan, math.nan)
    return complex(real, imag)


def _complex(cell: str) -> complex:
    """A complex number such as -5.8+5837i; nan of other text."""
    text = cell.replace(" ", "").replace("i", "j").replace("*", "")
    text = text.replace("±", "+").replace("+/-", "+").replace("+-", "+")
    try:
        return complex(text)
    except ValueError:
        return complex(math.nan, math.nan)


# ---- Cells


def _all_numbers(values: Mapping[str, Any]) -> bool:
    """Whether all that averages need is there, as numbers."""
    if not {"diameters", "omega", "amplitude"} <= {*values}:
        return False
    for name, column in values.items():
        cells = column if isinstance(column, list) else []
        if name == "shapes":
            cells = [*itertools.chain.from_iterable(column)]
        if not all(isinstance(cell, float) and math.isfinite(cell) for cell in cells):
            return False
    return True


def _of_table(fault: Fault, columns: list[Column], halves: Halves) -> Fault:
    """A fault in a number of a `Disc` with the column, cell and mode of the table, the first of its
    halves."""
    column = next((one for one in columns if one.head.quantity == fault.path[0]), None)
    if column is None or len(fault.path) != 2:
        return fault
    i = halves[int(fault.path[1])][0]
    converted = column.head.factor != 1.0
    unit = " rad/s" if converted and "within" in fault.rule else ""
    rule = f"{fault.rule}{unit} (mode {i + 1})"
    return Fault.of((column.head.text,), column.cells[i], rule)
