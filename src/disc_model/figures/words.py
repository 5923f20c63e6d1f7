"""Words of figures: labels, units and values of variables. Nothing here draws."""

import re
from collections.abc import Iterable, Mapping
from contextvars import ContextVar
from typing import NamedTuple

import numpy as np
import xarray as xr

from disc_model.data.variables import (
    EXCLUDED,
    FOUND_SPEEDS,
    SERIES,
    SHOWN,
    TRUTH,
    attributes,
    attributes_of_number,
    axis_of,
    flag_names,
    ranged_variable,
    typeset,
)
from disc_model.figures.classes import LOOKS, name_of
from disc_model.figures.durations import with_duration
from disc_model.figures.kinds.base import si_unit
from disc_model.figures.sections import with_section
from disc_model.parameters import RATIOS, Parameters
from disc_model.units import size_of_unit

MODES = {
    "as_published": "modes as published",
    "orthonormal": "orthonormal modes",
    "given": "modes of a table",
}
WORDS = {
    **MODES,
    "vertical": "vertical contact force",
    "normal": "normal contact force",
    "hyperbolic": "hyperbolic friction",
    "exponential": "exponential friction",
}
"""Names of words along a dimension, in the order in which they are drawn: those of the paper first."""
KINDS = {
    "stick_slip": "stick-slip cycle",
    "slipping": "cycle that never sticks",
    "sliding": "steady sliding",
}
"""What options and a dimension of them call kinds of motions."""
OF_MODES = ("n_diameters", "n_circles")
"""Parameters that say how many modes there are."""
UNITS: ContextVar[Mapping[str, tuple[str, float]]] = ContextVar("units", default={})  # noqa: B039
"""Units of the reader and the factors from SI to them, by parameter or sampled variable, while a
figure is drawn."""
DRAWN_IN: ContextVar[Mapping[str, tuple[str, float]]] = ContextVar("drawn in", default={})  # noqa: B039
"""The same of pictures whose values are drawn in these units, so that a reader may draw beside them."""
UNIT_POWER = re.compile(r"([^\W\d]+|1|%)(-?)(\d*(?:\.\d+)?)")
"""A part of a unit in datasets: its name, the sign and the size of its power."""
POWERS = {"": "", "1": "", "2": "²", "3": "³"}
SHORT = {
    "outcome": "outcome",
    "scan_outcome": "outcome",
    "critical_speed": "critical speed for separation",
    "disc": "disc",
    "horizon": "horizon",
    "mode": "mode",
    "onset_speed": "speed at separation onset",
    "offset_speed": "speed at separation end",
    "scan_status": "what became of the computation at a speed of the scan",
    "sweep_status": "what became of the computation at a speed of the sweep",
    "rate_status": "what became of the computation at a rate of the ramp",
}
"""What labels call variables whose long names explain them."""
CRITICAL = re.compile(r"critical value of (?P<parameter>.+?)( for instability of (?P<motion>.+))?")
"""What long names of critical values say."""
BORDER = re.compile(r"(?P<parameter>.+) above which (?P<motion>.+) stays unstable")
"""What those of borders of stability say."""
MOTIONS = {"the stick-slip cycle": "the cycle", "steady sliding": "sliding"}
"""What labels call the motions that these name."""
PERSONS = ("Young", "Poisson")
"""Beginnings of names that are always written with a capital."""
INFINITE = "infinite"
"""Class of points whose value is infinite,"""
MINUS_INFINITE = "minus_infinite"
"""of those whose value is below any axis,"""
VANISHING = "vanishing"
"""and of those where this is a growth rate."""
BELOW_ANY = "growth rate −∞"  # of a disturbance that is gone within a period, as on a rigid disc
NO_VALUE = "no_value"  # class of a point that was computed and has no value
PLAIN_WORDS = re.compile(
    "[a-z]{3,}(_[a-z]{3,})*"
)  # names that are words, and no symbols such as f_ss
MISSING = "missing"  # what stands for a value that there is not
ANSWERS = ("no", "yes")  # words for False and True, in their order
STAYS = "stays"  # key of words for the time at each value of a sweep

IN_THOUSANDTHS = {"period": "ms", "interval": "ms", "range": "mm"}
"""Units of numbers of cycles in all pictures, by the last word of their names, such as `sweep_range`."""
WITHIN_STUDIES = (", in the scan", ", in the sweep")
"""Ends of long names of values that a study goes through by itself."""
IN_THOUSANDTH = "in thousandths"
"""Attribute of a variable that is drawn in thousandths of its unit."""
LOWERED = dict(zip("0123456789aehijklmnoprstuvx", "₀₁₂₃₄₅₆₇₈₉ₐₑₕᵢⱼₖₗₘₙₒₚᵣₛₜᵤᵥₓ", strict=True))
"""Characters that plain text has as indices."""


class Named(NamedTuple):
    """A variable's name in plain text, its unit for readers, and the factor from SI to this."""

    name: str
    unit: str
    factor: float


class Measured(NamedTuple):
    """A variable for an axis: its label with a unit, and its values in this unit."""

    label: str
    values: np.ndarray


SPEED, _ = axis_of("Omega")
LOAD, _ = axis_of("N")


def label_of(variable: xr.DataArray) -> tuple[str, float]:
    """Axis label of any variable or coordinate, and the factor from SI to its unit."""
    name, unit, factor = named(variable)
    found = [parameter_within(variable, around) for around in (CRITICAL, BORDER)]
    is_usual = known_name(variable) and not _name_of_coordinate(variable)
    label = typeset(name) if is_usual or any(found) else name
    if unit:
        label = f"{label} ({unit})"
    return label, factor


def named(variable: xr.DataArray) -> Named:
    """The name of any variable or coordinate in plain text, its unit, and the factor from SI to
    this."""
    known = known_name(variable)
    if known:
        shown = SHOWN[known]
        usual = f"{shown.name} {shown.symbol}".strip()
        return Named(_name_of_coordinate(variable) or usual, *_drawn_in(known))
    # disturbances have one name in all figures
    words = _words_of(variable).replace("disturbances of ", "")
    critical = parameter_within(variable, CRITICAL)
    if critical:
        shown = SHOWN[critical]
        symbol = f"Critical {within_words(shown.name)} {shown.symbol}".strip()
        motion = _motion_within(variable, CRITICAL)
        if motion:
            symbol += f" for instability of {motion}"
        return Named(symbol, *_drawn_in(critical))
    border = parameter_within(variable, BORDER)
    if border:
        shown = SHOWN[border]
        symbol = f"{shown.name} {shown.symbol}".strip()
        above = f" above which {_motion_within(variable, BORDER)} stays unstable"
        return Named(symbol + above, *_drawn_in(border))
    phrase = words[0].upper() + words[1:]
    if "long_name" not in variable.attrs and str(variable.name) not in SHORT:
        phrase = _name_of_own(str(variable.name))
    key = unit_key(variable)
    if key in DRAWN_IN.get():
        return Named(phrase, *DRAWN_IN.get()[key])
    ranged = SHOWN.get(ranged_variable(str(variable.name)))
    if _is_own(variable):
        ranged = None
    if ranged is not None and ranged.factor != 1.0:  # such as u_min, beside u
        return Named(phrase, ranged.unit, ranged.factor)
    if IN_THOUSANDTH in variable.attrs:  # beside others that are
        return Named(phrase, f"m{variable.attrs['units']}", 1e3)
    units = str(variable.attrs.get("units", "1"))
    base = str(variable.name).split("_")[-1]
    if IN_THOUSANDTHS.get(base) == f"m{units}":
        return Named(phrase, IN_THOUSANDTHS[base], 1e3)
    return Named(phrase, unit_text(units), 1.0)


def _drawn_in(name: str) -> tuple[str, float]:
    """The unit in which values of a parameter or sampled variable are drawn, and the factor from SI to it."""
    shown = SHOWN[name]
    return DRAWN_IN.get().get(name, (shown.unit, shown.factor))


def in_readers_unit(name: str, value: float, usual: str) -> tuple[float, str]:
    """A number of a parameter in the unit of the reader, and this; in SI with its usual words if there
    is none."""
    unit, factor = UNITS.get().get(name, (usual, 1.0))
    return value * factor, unit


def unit_key(variable: xr.DataArray) -> str:
    """The parameter or sampled variable by which a reader gives the unit of a variable; "" if there is
    none."""
    known = known_name(variable)
    if known:
        return known
    for around in (CRITICAL, BORDER):
        parameter = parameter_within(variable, around)
        if parameter:
            return parameter
    name = str(variable.name)
    if name in FOUND_SPEEDS:
        is_in_si = variable.attrs.get("units") == attributes("Omega")["units"]
        return "Omega" if is_in_si else ""
    base = ranged_variable(name)
    if base == name or base not in SERIES:
        return ""
    same_unit = variable.attrs.get("units") == SERIES[base].attributes.get("units")
    return base if same_unit else ""


def parameter_along(coordinate: xr.DataArray) -> str:
    """The parameter or ratio of which a coordinate has values; "" if there is none."""
    name = str(coordinate.name).removeprefix("scan_").removeprefix("sweep_")
    return name if name in (*Parameters.model_fields, *RATIOS) else ""


def _name_of_coordinate(variable: xr.DataArray) -> str:
    """The name that a reader has given the values of a parameter in place of the usual one; "" if it is
    this."""
    long_name = variable.attrs.get("long_name")
    name = parameter_along(variable)
    if not name or not isinstance(long_name, str) or long_name.endswith(WITHIN_STUDIES):
        return ""
    usual = attributes_of_number(name).get("long_name", name)
    if (
        not long_name
        or long_name in SHOWN
        or _without_remarks(long_name) == _without_remarks(usual)
    ):
        return ""
    return long_name[0].upper() + long_name[1:]


def parameter_within(variable: xr.DataArray, said: re.Pattern[str]) -> str:
    """The parameter whose long name a variable says within other words, as of the values that `critical`
    finds; "" if it says none."""
    found = said.fullmatch(_words_of(variable))
    return _parameter_of_meaning(found["parameter"]) if found else ""


def _motion_within(variable: xr.DataArray, said: re.Pattern[str]) -> str:
    """What labels call the motion that a variable says to be unstable; "" if it says none."""
    found = said.fullmatch(_words_of(variable))
    motion = found["motion"] if found else None
    return MOTIONS.get(motion, motion) if motion else ""


def _parameter_of_meaning(meaning: str) -> str:
    """The parameter that has a long name; "" if there is none."""
    for name in (*Parameters.model_fields, *RATIOS):
        if name in SHOWN and attributes(name)["long_name"] == meaning:
            return name
    return ""


def within_words(name: str) -> str:
    """The name of a parameter behind other words: small, unless it is that of a person."""
    if name.startswith(PERSONS):
        return name
    return name[:1].lower() + name[1:]


def _name_of_own(name: str) -> str:
    """The name of a reader's own quantity: words begin with a capital, and all else, such as f_ss
    or x, stays as it is."""
    if PLAIN_WORDS.fullmatch(name):
        return name.replace("_", " ").capitalize()
    return name


def _words_of(variable: xr.DataArray) -> str:
    """What a variable says that it is, without remarks."""
    own = str(variable.name)
    long_name = str(variable.attrs.get("long_name", own.replace("_", " ")))
    return SHORT.get(own, _without_remarks(long_name))


def _without_remarks(long_name: str) -> str:
    """A long name without what it says of missing values and of its zero."""
    return long_name.partition(", nan ")[0].partition("; ")[0]


def known_name(variable: xr.DataArray) -> str:
    """The name of a variable in `SHOWN`, "" if it is not there."""
    if _is_own(variable):
        return ""
    own = str(variable.name)
    # a scanned parameter is the long name of its dimension, or its name has a prefix
    for name in (own.removeprefix("scan_").removeprefix("sweep_"), _words_of(variable)):
        if name in SHOWN:
            return name
    return ""


def _is_own(variable: xr.DataArray) -> bool:
    """Whether a variable has the name of a sampled one, such as w, or of a parameter, but is a reader's
    own, with another unit or long name, or none."""
    name = str(variable.name)
    parameter = parameter_along(variable)
    if parameter and name in variable.coords:
        units = variable.attrs.get("units")
        return units is not None and units != attributes_of_number(parameter).get("units")
    if name == parameter != "":
        return variable.attrs.get("units") != attributes(name).get("units")
    sampled = SERIES.get(ranged_variable(name))
    if sampled is None:
        return False
    if variable.attrs.get("units") != sampled.attributes.get("units"):
        return True
    long_name = str(variable.attrs.get("long_name", ""))
    return name in SERIES and _without_remarks(long_name) != _without_remarks(sampled.long_name)


def label_in(study: xr.Dataset, name: str) -> str:
    """Axis label of a variable of a study; of one that depends on the time for which motions were
    followed, with this time, and of samples once per turn with these words."""
    label = label_of(study[name])[0]
    unit = named(study[name]).unit
    ending = f" ({unit})" if unit else ""
    words = label.removesuffix(ending)
    words = with_section(study, name, words)
    return with_duration(study, name, words) + ending


def unit_text(units: str) -> str:
    """A unit of a dataset, such as ``kg m s-2``, as labels have it: ``kg m/s²``; "" for none."""
    above: list[str] = []
    below: list[str] = []
    for part in units.split():
        found = UNIT_POWER.fullmatch(part)
        if found is None:  # not in the notation of datasets
            return units
        name, sign, power = found.groups()
        raised = name + POWERS.get(power, f"^{power}")
        (below if sign else above).append(raised)
    if above in ([], ["1"]) and not below:
        return ""
    return "/".join([" ".join(above) or "1", *below])


def factors_of(units: Mapping[str, str]) -> dict[str, tuple[str, float]]:
    """Units of the reader, as `UNITS` has them: with the factors from SI to them."""
    return {name: (unit, 1 / size_of_unit(unit, si_unit(name))) for name, unit in units.items()}


def measured(variable: xr.DataArray) -> Measured:
    """The label of a variable, and its values in the label's unit."""
    label, factor = label_of(variable)
    if factor == 1.0:  # words stay, and whole numbers
        return Measured(label, variable.values)
    return Measured(label, variable.values * factor)


def lowered(text: str) -> str:
    """The text with its indexed symbols, such as c_p, in plain characters: cₚ."""

    def with_index(found: re.Match[str]) -> str:
        symbol, index = found.groups()
        return symbol + LOWERED[index] if index in LOWERED else found[0]

    return re.sub(r"\b([^\W_])_([^\W_])\b", with_index, text)


def in_order(words: Iterable[str]) -> list[str]:
    """Each of some words or names of classes once: those with looks of their own in the order of these,
    "no" before "yes", and others as they come first."""
    known = {word: place for place, word in enumerate((*ANSWERS, *LOOKS))}
    known |= {name_of(word): place for word, place in known.items()}
    return sorted(dict.fromkeys(words), key=lambda word: known.get(word, len(known)))


def as_numbers(variable: xr.DataArray) -> tuple[list[str], xr.DataArray]:
    """Names of a flag's classes, none for other variables; and the variable with numbers for words,
    their places, nan where there is no word."""
    if variable.dtype.kind in "UO":
        words = flag_names(variable)
        distinct = in_order([str(word) for word in words.flat if word != ""])
        places = {"": np.nan} | {word: float(place) for place, word in enumerate(distinct)}
        heights = [places[word] for word in words.flat]
        numbers = variable.copy(data=np.reshape(heights, words.shape))
        return [name_of(word) for word in distinct], numbers
    words = variable.attrs.get("flag_meanings", "").split()
    return [name_of(word) for word in words if word != EXCLUDED], variable


def is_truth(variable: xr.DataArray) -> bool:
    """Whether the numbers or words of a variable stand for True and False."""
    return variable.attrs.get("comment") == TRUTH["comment"]


def are_counts(variable: xr.DataArray) -> bool:
    """Whether a variable or coordinate counts something, also where some points have no value."""
    whole = variable.dtype.kind in "iu" or variable.name in OF_MODES
    return whole or named(variable).name.startswith("Number of ")
