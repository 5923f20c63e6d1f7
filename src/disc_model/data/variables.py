"""The table of variables: meaning and unit of each, and the meanings of flags."""

from __future__ import annotations

import enum
import json
import math
import re
import tomllib
from collections import ChainMap
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from disc_model.display import modes_text
from disc_model.errors import StatusBase
from disc_model.parameters import Parameters

if TYPE_CHECKING:
    from xarray import Dataset

_TABLES = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
WORDS = {name: tuple(words) for name, words in _TABLES["words"].items()}
"""Words that the numbers of flags stand for, by the names that the table has for them."""
PHASES, EVENT_KINDS, STATUSES = (WORDS[name] for name in ("phases", "events", "statuses"))
UNKNOWN_OUTCOMES = ("undecided", "failed")
"""Outcomes of starts of which it is not known what they come to."""


class Outcome(enum.StrEnum):
    """Outcome of a motion, in the words of all datasets; `disc_model.stability.follower` gives the
    criteria."""

    STICK_SLIP = "stick_slip"  # the stable cycle of the static start: within `follower.NEAR`, or that of `floquet`
    OTHER_CYCLE = "other_cycle"  # another stable cycle in contact
    SEPARATING = "separating"  # a stable cycle that loses contact
    QUASI_PERIODIC = "quasi_periodic"  # a motion on an attractor that is regular and aperiodic
    IRREGULAR = "irregular"  # a motion on a chaotic attractor
    STEADY_SLIDING = "steady_sliding"  # steady sliding
    AT_REST = "at_rest"  # the slider stuck to the disc for good
    UNDECIDED = "undecided"  # none of these could be shown
    # in contact at the horizon, after a departure from an unstable cycle or from unstable sliding
    GROWING = "growing"
    SEPARATION = (
        "separation"  # contact is lost before the horizon, and the later motion is not examined
    )


class CycleStatus(StatusBase):
    """Result of the search for a cycle; `advice` says what it means and what to do."""

    OK = "ok", "A cycle was found; its growth rate says whether it is stable."
    NO_CYCLE = (
        "no_cycle",
        "The slider moves on, but no such cycle of up to three releases was found near the start of the search, "
        "as beyond a fold or close to one: give floquet the last state of a simulation as guess, or follow the cycle "
        "of another case by disc_model.continue_cycle.",
    )
    SEPARATES = (
        "separates",
        "Near the static start no cycle keeps contact, and contact is soon lost: simulate.",
    )
    NO_STICK_SLIP = (
        "no_stick_slip",
        "The slider does not stick again: look at disc_model.steady_sliding.",
    )
    AT_REST = "at_rest", "Nothing ever slips: raise Omega, k_p or lower the friction."
    PARADOX = (
        "paradox",
        "Painleve's paradox: rigid Coulomb friction has no solution there; lower mu_k or N.",
    )
    NON_FINITE = "non_finite", "The motion overflowed: check the parameters' magnitudes."


def with_advice(found: str, status: StatusBase) -> str:
    """What was found, and then the advice of its status."""
    if found in ("", status.advice):
        return status.advice
    return f"{found}. {status.advice}"


Entries = dict[str, Any]
"""Attributes or values, by name."""
TEXTS = ("units", "long_name", "comment", "missing", "parameter")
"""Attributes that say what a variable is."""


class Variable(NamedTuple):
    """A variable of a dataset, as an entry of variables.toml states it."""

    units: str = "1"
    long_name: str = ""
    flags: tuple[str, ...] = ()  # the words that the values of a flag stand for
    dims: tuple[str, ...] = ()  # dimensions beyond those of the grid on which it is computed
    whole: bool = False  # whether its values are whole numbers
    comment: str = ""  # the rest of the sentence of which the long name is the beginning
    missing: str = ""  # why there may be no value, such as "there is no cycle"
    parameter: str = ""  # the number of the case whose values they are, or the option that names it

    @property
    def attributes(self) -> Entries:
        """The variable's CF attributes: its `codes`, and the `texts` that it has without options."""
        return {**self.texts(), **self.codes}

    @property
    def codes(self) -> Entries:
        """Attributes of a flag: the words that its values stand for."""
        if not self.flags:
            return {}
        numbers = np.arange(len(self.flags), dtype=np.int8)
        return {"flag_values": numbers, "flag_meanings": " ".join(self.flags)}

    def texts(self, options: Mapping[Any, Any] = MappingProxyType({})) -> Entries:
        """Attributes that say what it is: `units`, `long_name`, `comment`, `missing` and `parameter`,
        without those that are "".

        options : of the quantity, which may name the parameter whose unit, and name unless it has one
            of its own, the variable has
        """
        stated = {name: getattr(self, name) for name in TEXTS[:4] if getattr(self, name)}
        if self.parameter:
            number = options.get(self.parameter, self.parameter)
            return {**attributes(number), **stated, "parameter": number}
        return stated

    @property
    def dtype(self) -> type[np.generic]:
        if self.flags:
            return np.int8
        if self.whole:
            return np.int64
        return np.float64

    @property
    def unknown(self) -> float:
        """Value of unknown points: `failed` for a status, the first value for other flags, 0 for
        counts, else nan."""
        if "failed" in self.flags:
            return self.flags.index("failed")
        if self.flags or self.whole:
            return 0
        return math.nan

    def empty(self, shape: Sequence[int]) -> NDArray[Any]:
        """An array filled with `unknown`."""
        return np.full(shape, self.unknown, dtype=self.dtype)


# motions near the static start that last: a cycle, sliding, rest
STABLE_CYCLES = ("stable", "steady_sliding", "at_rest")
_COMMON = {**_TABLES["modal"], **_TABLES["series"], **_TABLES["scalars"], **_TABLES["common"]}
"""What entries have that they do not state themselves."""


def _variables(table: Entries) -> dict[str, Variable]:
    """The variables of a part of the table, by name."""
    variables = {}
    for name, stated in table.items():
        entry = {"flags": "", "dims": (), **_COMMON.get(name, {}), **stated}
        entry |= {"flags": WORDS[entry["flags"]], "dims": tuple(entry["dims"])}
        variables[name] = Variable(**entry)
    return variables


SERIES, SCALARS, PERTURBATIONS, COORDINATES = (
    _variables(_TABLES[part]) for part in ("series", "scalars", "perturbations", "modal")
)
OF_RESULTS = {name: _variables(part) for name, part in _TABLES["results"].items()}
OF_RESULTS["Result"].update(SCALARS)
"""Variables of results by their class or function, which may mean something else elsewhere."""
OF_QUANTITIES = {
    quantity: {name: _variables(part) for name, part in parts.items()}
    for quantity, parts in _TABLES["quantities"].items()
}
"""Variables of quantities, by quantity, and by what they are there: its "columns", "coordinates", and those that
are "added" to its columns."""
COMMON = _variables(_TABLES["common"])
"""Variables of several quantities and of sweeps."""
GROUPS = ("events", "final_state", "initial_state")  # groups in the file of a run, beside windows
BESIDE_WINDOWS = frozenset({*GROUPS, *SCALARS})
"""Groups and variables beside the windows in a file; no window may have such a name."""
TAKEN = "must not be the name of a variable of results"
"""The rule that says so."""
EXCLUDED = "excluded"
"""Status of points that a rule of the study leaves out."""


# ---- What variables are


_BOUNDS = {"min": "least", "max": "greatest"}
_CF_UNITS = {
    "N/m": "N m-1",
    "N s/m": "N s m-1",
    "kg/m^3": "kg m-3",
    "m/N": "m N-1",
    "rad/s": "rad s-1",
    "s/m": "s m-1",
}
"""Units of parameters as files have them."""


def _of_parameter(name: str) -> Variable:
    """A parameter, whose description is a comment if the table has a shorter name."""
    description = Parameters.model_fields[name].description or name
    text = _TABLES["parameters"].get(name, description)
    unit = Parameters.unit(name) or "1"
    comment = description if text != description else ""
    return Variable(_CF_UNITS.get(unit, unit), text, comment=comment)


def _of_bin(bound: str, variable: Variable) -> Variable:
    """The least or greatest value of a variable within a bin."""
    comment = f"within the bin; {variable.comment}".removesuffix("; ")
    return variable._replace(long_name=f"{bound} {variable.long_name}", comment=comment)


_OF_CASES = {
    **{f"{name}_{end}": _of_bin(_BOUNDS[end], x) for name, x in SERIES.items() for end in _BOUNDS},
    **{name: _of_parameter(name) for name in Parameters.model_fields},
    **SERIES, **SCALARS, **PERTURBATIONS,
}  # fmt: skip


def attributes(name: str) -> Entries:
    """CF attributes of a variable of a run or of a parameter: units, long name, comment and, for a flag, the
    meanings of its values."""
    return _OF_CASES[name].attributes


def known_of(kind: str) -> Mapping[str, Variable]:
    """The variables of a quantity, of a class of results, or of a function of plain numbers."""
    own = OF_QUANTITIES.get(kind, {}).values()
    return ChainMap(OF_RESULTS.get(kind, {}), *own, COMMON)


def described(
    data: Dataset, kind: str, options: Mapping[str, Any] = MappingProxyType({})
) -> Dataset:
    """A dataset of a quantity, or of a class of results, whose variables say what they are.

    data : what the table does not know of it stays as it is
    options : of the quantity, which may name the parameter of which values are
    """
    known = known_of(kind)
    said = data.copy()
    for name in known.keys() & said.variables.keys():
        variable = said.variables[name]
        texts = known[str(name)].texts(options)
        if variable.dtype.kind in "UO":  # words themselves have no unit
            texts.pop("units", None)
        kept = {key: x for key, x in variable.attrs.items() if key not in TEXTS}
        variable.attrs = {**texts, **kept}
    return said


def flag_names(variable: Any) -> np.ndarray:
    """Values of a flag variable (a DataArray) as words, array of str of the same shape; words as they
    are, and "" for nan."""
    if variable.dtype.kind in "UO":
        # as of words that xarray's where has masked
        return np.where(variable.isnull(), "", variable.values).astype(str)
    # the last one is that of a missing value
    known = np.array([*variable.attrs["flag_meanings"].split(), ""])
    return np.asarray(known[variable.fillna(-1).values.astype(int)])


def stated_in(study: Any, what: str) -> Entries:
    """What the dataset of a grid study or of a sweep states, such as its "base" or "options"; empty
    without."""
    return json.loads(study.attrs.get(what, "{}"))


# ---- What readers are shown


class Shown(NamedTuple):
    """Presentation of a variable to readers."""

    name: str
    symbol: str
    unit: str
    factor: float = 1.0  # from SI to the unit


# numeric parameters, perturbations, and sampled variables
SHOWN = {name: Shown(*entry) for name, entry in _TABLES["shown"].items()}


def typeset(text: str) -> str:
    """The text with its indexed symbols, such as c_p, in the notation of matplotlib, also if some
    are in it already."""
    return re.sub(r"(?<!\$)\b(\w)_(\w)\b", r"$\1_\2$", text)


def ranged_variable(name: str) -> str:
    """The sampled variable whose range a variable is an end of, such as P of P_max; the name itself of
    any other."""
    return re.sub("_(min|max)$", "", name)


def unit_of_parameter(name: str) -> str:
    """The unit of a parameter for readers; "" without one."""
    unit = Parameters.unit(name)
    return "" if unit == "1" else unit


def value_with_unit(name: str, value: float) -> str:
    """A value of a parameter with its name and its unit of SI, in a message."""
    return f"{name} = {value:.6g} {unit_of_parameter(name)}".strip()


def message_of(result: Any) -> str:
    """The message of a result, "" without one, with the advice of its status where it is not complete. One of
    this package whose own status is "ok" only says its numbers again: that is ""."""
    status = getattr(result, "status", None)
    message = getattr(result, "message", "")
    if status == "ok" and isinstance(status, StatusBase):
        return ""
    if not isinstance(status, StatusBase) or getattr(status, "complete", False):
        return message
    return with_advice(message, status)


def values_text(
    values: Entries, units: Mapping[str, tuple[str, float]] = MappingProxyType({})
) -> str:
    """N, Omega and all values that differ from Table 1, in units of `SHOWN` or in `units`, with
    factors from SI; of a disc that is given by its modes their number and frequencies."""
    texts = []
    for name, field in Parameters.model_fields.items():
        value = values.get(name, field.default)
        if name in ("normalization", "contact") or value in (field.default, str(field.default)):
            continue
        if name == "disc":
            texts.append(f"a disc given by {modes_text(dict(value)['omega'])}")
            continue
        shown = SHOWN.get(name) or Shown(name, name, unit_of_parameter(name))
        unit, factor = units.get(name, (shown.unit, shown.factor))
        texts.append(f"{shown.symbol or name} = {with_unit(value, unit, factor)}")
    return ", ".join(texts)


def with_unit(value: Any, unit: str, factor: float = 1.0) -> str:
    """A value in SI units in another unit, whose power of ten stands at the number; a word as it is."""
    if not isinstance(value, float | int):
        return str(value)
    if not value:
        unit = unit.removeprefix("10⁻⁵ ")
    return f"{value * factor:g} {unit}".strip().replace(" 10⁻⁵", "·10⁻⁵")
