"""Words of figures: labels of variables, names of values, and what a figure's head says. Nothing here
draws."""

import re
from collections.abc import Collection, Mapping
from contextvars import ContextVar
from textwrap import fill
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from disc_model.data.variables import (
    EXCLUDED,
    SERIES,
    SHOWN,
    TRUTH,
    attributes,
    axis_of,
    flag_names,
    stated_in,
    typeset,
    values_text,
)
from disc_model.figures.classes import name_of
from disc_model.figures.durations import duration_of, horizon_text, run_text, with_duration
from disc_model.figures.kinds.base import si_unit
from disc_model.figures.sections import with_section
from disc_model.parameters import RATIOS, Parameters
from disc_model.units import in_si

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
MODELS = {
    "normal": WORDS["normal"],
    "exponential": WORDS["exponential"],
    "residual": "residual flexibility",
    "surface": "friction on the surface",
    "bilateral": "bilateral contact",
    "bonded": "bilateral contact",  # its name in older files of results
}
AT_ZERO = {
    "contact_compliance": "rigid contact",
    "contact_arc": "contact at a point",
    "friction_offset": "friction in the middle plane",
}
"""What parameters mean that are zero: they name themselves."""
BY_SIZE = {"exponent_number": "exponent {}"}
"""Names of the values along a dimension of descending numbers, but for the first, the largest."""
IN_WORDS = {
    "n_diameters = -1": "rigid disc",
    "n_diameters =": "nodal diameters up to",
    "n_circles =": "nodal circles up to",
    "contact_arc =": "a pad over",
    "contact_compliance =": "contact compliance",
    "friction_offset =": "friction above the middle plane by",
}
"""What heads of figures say for parameters without a symbol."""
OF_FRICTION = ("mu_s", "mu_k", "mu_k_over_mu_s", "friction_decay", "viscous_friction")
"""Parameters of the law of friction,"""
OF_DAMPING = ("D_star", "damping_ratio", "c", "c_p", "c_p_over_c")
OF_CONTACT = ("friction_offset", "contact_arc", "contact_compliance")
IDENTIFYING = ("disc", "E", "h", "h_over_b", "m", "k")
"""what tells a disc and a slider from others first,"""
OF_DISC = ("nu", "rho", "a", "b", "r_0", "a_over_b", "r_0_over_b")
"""the rest of the material and of the size of the disc,"""
OF_MODES = ("n_diameters", "n_circles")
"""and how many modes there are."""
ORDERED = ("N", "Omega", *OF_FRICTION, *IDENTIFYING, *OF_DAMPING, *OF_CONTACT, *OF_DISC, *OF_MODES)
"""Parameters that have a place of their own in a title."""
UNITS: ContextVar[Mapping[str, tuple[str, float]]] = ContextVar("units", default={})  # noqa: B039
"""Units of the reader and the factors from SI to them, by parameter or sampled variable, while a
figure is drawn."""
UNIT_POWER = re.compile(r"([^\W\d]+|1|%)(-?)(\d*(?:\.\d+)?)")
"""A part of a unit in datasets: its name, the sign and the size of its power."""
POWERS = {"": "", "1": "", "2": "²", "3": "³"}
SHORT = {
    "outcome": "outcome",
    "scan_outcome": "outcome",
    "critical_speed": "critical speed",
    "horizon": "horizon",
    "mode": "mode",
    "onset_speed": "speed at separation onset",
    "offset_speed": "speed at separation end",
    "scan_status": "what became of the computation at a speed of the scan",
    "sweep_status": "what became of the computation at a speed of the sweep",
    "rate_status": "what became of the computation at a rate of the ramp",
}
"""What labels call variables whose long names explain them."""
TIMES_OF_SEPARATION = ("first_separation", "scan_first_separation")
"""Variables that have no value where contact is kept up to the horizon."""
CRITICAL = ("critical value of ", "")
"""What long names of critical values say before and after that of the parameter."""
BORDER = ("", " above which the motion stays unstable")
"""What those of borders of stability say before and after it."""
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
ROUNDING = 1e-9  # relative, of a number in another unit
STAYS = "stays"  # key of words for the time at each value of a sweep
LONGEST_NAME = 22  # characters of a line of the name of a class beside the panel
CHARACTER = 0.06  # inch, mean width of a character of a figure's head


BEYOND = {
    "branch_point": "no branch, or one of fewer points",
    "branch": "no further branch",
    "curve_point": "no curve, or one of fewer points",
    "curve": "no further curve",
    "crossing_number": "no further crossing",
    "crossing": "no further crossing",
    "attractor": "no further attractor",
    "release": "no further release",
    "begin": "contact is not lost",
}
"""What it means that there is no value at a place of a dimension that has room for more than was found."""
_NO_MODE = "no mode of this number"
_NO_LOCK = "no stable cycle was found at it"
_NO_PERIOD = "it does not repeat"
_NOT_SWEPT = "the sweep did not come here"
_NO_START = "no start led to lasting separation"
_NO_MULTIPLIER = "no multiplier of the mode"
_NO_CYCLE = "no cycle is followed"
GONE: Mapping[str, Mapping[str, str]] = {
    "basins": dict.fromkeys(
        ("critical_energy", "critical_energy_lower", "critical_energy_sampled"), _NO_START
    ),
    "bifurcation": {
        **dict.fromkeys(("psi", "psi_velocity", "P", "u"), "no further event while sampled"),
        "w_point": "sampled once a turn only",
        "first_separation": "no separation up to the last sample",
        "period_events": "not shown to repeat",
    },
    "branches": dict.fromkeys(("sweep_range", "sweep_separation_rate"), _NOT_SWEPT),
    "campbell": {
        **dict.fromkeys(
            ("sliding_frequency", "sliding_growth_rate", "forward_wave_fraction"), _NO_MODE
        ),
        **dict.fromkeys(("cycle_frequency", "cycle_growth_rate", "mac"), _NO_MULTIPLIER),
    },
    "critical_speed": {"scan_first_separation": "no separation, or not timed"},
    "floquet": {"near_motion": "stable: not examined"},
    "locking": {
        **dict.fromkeys(("period", "period_residual"), _NO_PERIOD),
        **dict.fromkeys(("leading_multiplier", "growth_rate"), _NO_LOCK),
        **dict.fromkeys(("real_multiplier", "swing_multiplier"), _NO_LOCK),
        "separations_per_release": "no release of stick, or no separation",
        "separation_interval": "no release of stick, or no separation",
    },
    "outcome": {
        "cycle_distance": "it was not left for a cycle",
        "return_map_residual": "it returned too seldom",
        "return_map_residual_rate": "it returned too seldom",
    },
    "regions": {
        **dict.fromkeys(("period", "period_ratio"), _NO_CYCLE),
        "simulated_time": "not simulated",
    },
    "sliding": {
        **dict.fromkeys(
            ("frequency", "mode_growth_rate", "damping_ratio", "forward_wave_fraction"), _NO_MODE
        ),
        "mac": "no such mode, or the first value",
    },
}
"""Why points that were computed have no value of some variables, by quantity."""
NOT_SWEPT_OVER = "none found within the bounds"
"""Said where no speed of a sweep is one at which separation begins or ends, if its speeds are not known."""
NONE_FOUND = "none found"
ENDLESS = "none, or it continues"
"""Said where separation does not begin, or does not end, on a ramp of the speed."""
WITHOUT = {
    "if contact is not lost": "contact is not lost",
    "without one": "no cycle",
    "if there is none": NONE_FOUND,
    "if this is not examined: of a stable cycle, and without one": "stable: not examined",
    "if at none or at the lowest": NOT_SWEPT_OVER,
    "if it still does at the lowest": NOT_SWEPT_OVER,
    "if there is none, or it continues": ENDLESS,
    "if it was not": "it was not left",
    "if no step is audited": "no step is audited",
    "unless every step is audited": "not every step is audited",
    "unless friction acts on a surface that moves": "friction acts on no surface that moves",
}
"""What figures say for what long names say after "nan"."""
IN_THOUSANDTHS = {"period": "ms", "interval": "ms", "range": "mm"}
"""Units of numbers of cycles in all pictures, by the last word of their names, such as `sweep_range`."""
IN_THOUSANDTH = "in thousandths"
"""Attribute of a variable that is drawn in thousandths of its unit."""
RANGE_END = re.compile("_(min|max)$")
"""The end of the name of a bound of a sampled variable's range."""
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


# ---- Labels of variables

SPEED, _ = axis_of("Omega")
LOAD, _ = axis_of("N")


def label_of(variable: xr.DataArray) -> tuple[str, float]:
    """Axis label of any variable or coordinate, and the factor from SI to its unit."""
    name, unit, factor = named(variable)
    found = [parameter_within(variable, around) for around in (CRITICAL, BORDER)]
    label = typeset(name) if known_name(variable) or any(found) else name
    if unit:
        label = f"{label} ({unit})"
    return label, factor


def named(variable: xr.DataArray) -> Named:
    """The name of any variable or coordinate in plain text, its unit, and the factor from SI to
    this."""
    known = known_name(variable)
    if known:
        shown = SHOWN[known]
        return Named(f"{shown.name} {shown.symbol}".strip(), shown.unit, shown.factor)
    # disturbances have one name in all figures
    words = _words_of(variable).replace("disturbances of ", "")
    critical = parameter_within(variable, CRITICAL)
    if critical:
        shown = SHOWN[critical]
        symbol = f"Critical {_within_words(shown.name)} {shown.symbol}".strip()
        return Named(symbol, shown.unit, shown.factor)
    border = parameter_within(variable, BORDER)
    if border:
        shown = SHOWN[border]
        symbol = f"{shown.name} {shown.symbol}".strip()
        return Named(symbol + BORDER[1], shown.unit, shown.factor)
    phrase = words[0].upper() + words[1:]
    if "long_name" not in variable.attrs and str(variable.name) not in SHORT:
        phrase = _name_of_own(str(variable.name))
    ranged = SHOWN.get(RANGE_END.sub("", str(variable.name)))
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


def parameter_within(variable: xr.DataArray, around: tuple[str, str]) -> str:
    """The parameter whose long name a variable says between two phrases, as of the values that `critical`
    finds; "" if it says none."""
    before, after = around
    words = _words_of(variable)
    if not (words.startswith(before) and words.endswith(after)):
        return ""
    return _parameter_of_meaning(words.removeprefix(before).removesuffix(after))


def _parameter_of_meaning(meaning: str) -> str:
    """The parameter that has a long name; "" if there is none."""
    for name in (*Parameters.model_fields, *RATIOS):
        if name in SHOWN and attributes(name)["long_name"] == meaning:
            return name
    return ""


def _within_words(name: str) -> str:
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
    if name in (*Parameters.model_fields, *RATIOS) and name not in variable.coords:
        return variable.attrs.get("units") != attributes(name).get("units")
    sampled = SERIES.get(RANGE_END.sub("", name))
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


def missing_text(study: xr.Dataset, name: str) -> str:
    """What figures call points of a variable that were computed and have no value."""
    if name == "first_separation" and study.attrs.get("function") == "simulate":
        return _without_separation(study)
    horizon = horizon_text(study)
    if not horizon and "horizon" in study.dims:
        horizon = "the horizon"
    if name in TIMES_OF_SEPARATION and horizon:
        # some that occur have no time where departures are extrapolated
        options = stated_in(study, "options")
        untimed = options.get("extrapolate") or "extrapolate" in study.dims
        return f"none within {horizon}, or not timed" if untimed else f"none within {horizon}"
    reason = _reason_in(study, name) or name_of(NO_VALUE)
    duration = duration_of(study, name)
    if duration and reason != name_of(NO_VALUE):
        return f"{reason} within {duration}"
    return reason


def _without_separation(study: xr.Dataset) -> str:
    """What a sweep of `simulate` says of points without a separation: within which time there is
    none."""
    within = f"none within {run_text(study) or 'the run'}"
    left = study["first_separation"].isnull() & (study["time_reached"] < study["t_end"])
    return f"{within}, or ended early" if left.any() else within


def _reason_in(study: xr.Dataset, name: str) -> str:
    """Why a point that was computed has no value, as far as the study's dimensions and the variable's
    long name say; "" if they do not."""
    if name == "critical_speed" and "scan_Omega" in study.coords:
        speeds = study["scan_Omega"].values
        found = f"none found from {speeds[0]:g} to {speeds[-1]:g} rad/s"
        return found + _steps_of(study, "scan_Omega")
    if study.attrs.get("function") == "critical" and name in ("value", "border"):
        return _without_critical(study, name)
    if name not in study:
        return ""
    quantity = study.attrs.get("quantity", study.attrs.get("function", ""))
    of_quantity = GONE.get(str(quantity), {})
    if name in of_quantity:
        return of_quantity[name]
    dims = study[name].dims
    for dim, reason in BEYOND.items():
        if dim in dims:
            return reason
    reason = WITHOUT.get(str(study[name].attrs.get("long_name", "")).partition(", nan ")[2], "")
    if quantity == "ramps" and reason in (NONE_FOUND, ENDLESS):
        return _without_in_ramps(study, reason)
    if reason == NOT_SWEPT_OVER:
        return _none_swept_over(study)
    return reason


def _none_swept_over(study: xr.Dataset) -> str:
    """What is said where no speed of a sweep is one at which separation begins or ends."""
    if "sweep_Omega" not in study.coords:
        return NOT_SWEPT_OVER
    speeds = study["sweep_Omega"].values
    found = f"none found from {speeds.min():g} to {speeds.max():g} rad/s"
    return found + _steps_of(study, "sweep_Omega")


def _without_in_ramps(study: xr.Dataset, reason: str) -> str:
    """What is said where separation does not begin or end on a ramp, with the speeds of the ramp."""
    options = stated_in(study, "options")
    if not {"low", "high"} <= {*options}:
        return reason
    low, high = options["low"], options["high"]
    if reason == ENDLESS:
        return f"{reason} at {low:g} rad/s"
    return f"{reason} from {low:g} to {high:g} rad/s"


def text_below_lowest(study: xr.Dataset) -> str:
    """What is said of points at which separation begins or ends below all speeds of a sweep."""
    text = "contact lost at the lowest speed"
    if "sweep_Omega" not in study.coords:
        return text
    return f"{text}, {study['sweep_Omega'].values.min():g} rad/s"


def _steps_of(study: xr.Dataset, scanned: str) -> str:
    """In which steps the speed was scanned or swept, between which anything may be overlooked; "" if
    these are not known, or not even."""
    if scanned not in study.coords or "step" in study.dims or study[scanned].size < 2:
        return ""
    steps = np.diff(study[scanned].values)
    if not np.allclose(steps, steps[0], rtol=1e-3):
        return ""
    return f" in steps of {abs(steps[0]):.3g} rad/s"


def _without_critical(study: xr.Dataset, name: str) -> str:
    """What is said of a search that has found no critical value, or no border of stability."""
    if name == "value":
        return _none_within_bounds(study)
    unstable, stable = texts_without_border(study)
    return f"{stable}, or {unstable}"


def texts_without_border(study: xr.Dataset) -> tuple[str, str]:
    """What is said of points of a search without a border of stability, which are unstable at all
    values; and of those that are stable at the upper bound."""
    unstable = f"unstable at all values {_range_searched(study, 'border')}".rstrip()
    bounds = _bounds_of(study, "border")
    if bounds is None:
        return unstable, "stable at the upper bound"
    return unstable, f"stable at the upper bound, {bounds[1]} {_unit_of(study, 'border')}".rstrip()


def _none_within_bounds(study: xr.Dataset) -> str:
    """What is said of a search that has found no critical value: the motion is stable at all values
    computed, in the unit of the value, with their largest step if it is known; "" without bounds."""
    if _bounds_of(study, "value") is None:
        return ""
    found = f"none found {_range_searched(study, 'value')}"
    if "resolution" in study and study["resolution"].notnull().any():
        step = _as_value(study, "value", float(study["resolution"].max()))
        return f"{found} in steps of at most {step:.2g} {_unit_of(study, 'value')}".rstrip()
    return found


def _range_searched(study: xr.Dataset, name: str) -> str:
    """The bounds of a search, in the unit of a variable; "" without any."""
    bounds = _bounds_of(study, name)
    if bounds is None:
        return ""
    lowest, highest = bounds
    return f"from {lowest} to {highest} {_unit_of(study, name)}".rstrip()


def _bounds_of(study: xr.Dataset, name: str) -> tuple[str, str] | None:
    """The bounds of a search as texts, in the unit of a variable or with their own; None without any."""
    given = stated_in(study, "options").get("bounds")
    if given is None:
        return None
    lowest, highest = (_bound_text(study, name, bound) for bound in given)
    return lowest, highest


def _bound_text(study: xr.Dataset, name: str, bound: float | str) -> str:
    """A bound of a search as a number in the unit of a variable, also if it was given as a text."""
    searched = str(stated_in(study, "options").get("name", ""))
    number = float(in_si(bound, Parameters.unit(searched), [], ("bounds",)))
    return f"{_as_value(study, name, number):.6g}"


def _unit_of(study: xr.Dataset, name: str) -> str:
    """The unit that figures have for a variable; "" for none."""
    return named(study[name]).unit


def _as_value(study: xr.Dataset, name: str, number: float) -> float:
    """A number in SI, in the unit that figures have for a variable."""
    values = study[name].copy(data=np.full(study[name].shape, number))
    return float(measured(values).values.flat[0])


def unit_text(units: str) -> str:
    """A unit of a dataset, such as ``kg m s-2``, as labels have it: ``kg m/s²``; "" for none."""
    if units == "kg^-1/2":
        return "1/√kg"
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
    return {
        name: (unit, 1 / in_si(f"1 {unit}", si_unit(name), [], ())) for name, unit in units.items()
    }


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


def as_numbers(variable: xr.DataArray) -> tuple[list[str], xr.DataArray]:
    """Names of a flag's classes, none for other variables; and the variable with numbers for words,
    their places, nan where there is no word."""
    if variable.dtype.kind in "UO":
        words = flag_names(variable)
        distinct = np.unique(words[words != ""])
        places = np.searchsorted(distinct, words).astype(float)
        numbers = variable.copy(data=np.where(words == "", np.nan, places))
        return [name_of(word) for word in distinct], numbers
    words = variable.attrs.get("flag_meanings", "").split()
    return [name_of(word) for word in words if word != EXCLUDED], variable


# ---- Names of values


def value_text(data: xr.DataArray | xr.Dataset, by: str, *, short: bool = False) -> str:
    """A value along a dimension with its unit, or its word; a short one has four digits if six do not give
    it exactly, as that of a sample."""
    value = data[by].item()
    if isinstance(value, str):
        words = KINDS if by == "kind" else WORDS
        return words.get(value, value)
    if isinstance(value, float) and np.isnan(value):
        return "missing"
    if by in AT_ZERO and not value:
        return AT_ZERO[by]
    if by in BY_SIZE:
        return BY_SIZE[by].format(value + 1) if value else f"largest {by.partition('_')[0]}"
    if by == "contact_compliance":
        return f"compliance {value * SHOWN[by].factor:.3g} µm/N"
    if by == "contact_arc":
        return f"a pad over {value:g} rad"
    if by == "friction_offset":
        return f"friction {value * SHOWN[by].factor:g} mm above the middle plane"
    _, unit, factor = named(data[by])
    unit, factor = UNITS.get().get(by, (unit, factor))
    number = _short_number(value * factor) if short else f"{value * factor:g}"
    return f"{number} {unit}".strip()


def _short_number(value: float) -> str:
    """A number with up to six digits, or with four if six do not give it exactly."""
    text = f"{value:g}"
    short = f"{value:.4g}"
    is_exact = np.isclose(float(text), value, rtol=ROUNDING, atol=0)
    return text if is_exact or "e" in short else short


def named_value(data: xr.DataArray | xr.Dataset, by: str, *, short: bool = False) -> str:
    """The name of a dimension, and a value along it; a word stands for itself."""
    text = value_text(data, by, short=short)
    value = data[by].item()
    if by in AT_ZERO or by in BY_SIZE or (isinstance(value, str) and not is_truth(data[by])):
        return text
    return f"{typeset(named(data[by]).name)} = {text}"


def is_truth(variable: xr.DataArray) -> bool:
    """Whether the numbers or words of a variable stand for True and False."""
    return variable.attrs.get("comment") == TRUTH["comment"]


def are_counts(variable: xr.DataArray) -> bool:
    """Whether a variable or coordinate counts something, also where some points have no value."""
    whole = variable.dtype.kind in "iu" or variable.name in OF_MODES
    return whole or named(variable).name.startswith("Number of ")


def symbol_of(name: str) -> str:
    """The symbol of a parameter; any other number has its name."""
    return SHOWN[name].symbol if name in SHOWN else name


def stated_value(name: str, value: Any) -> str:
    """The value of a parameter by its symbol, whether it is that of Table 1 or not."""
    text = value_text(xr.Dataset(coords={name: value}), name)
    if name == "contact":
        return f"{text} contact"
    if isinstance(value, str) or name in AT_ZERO:
        return text
    return f"{symbol_of(name)} = {text}"


def rank_of(value: Any) -> Any:
    """Place of a value in an order: words as in `WORDS`, or by the number that they begin with."""
    if not isinstance(value, str):
        return value
    known = {word: place for place, word in enumerate(WORDS)}
    leading = re.match(r"\d+", value)
    number = np.inf
    if leading:
        number = float(leading[0])
    return known.get(value, 0), number


def in_lines(name: str) -> str:
    """The name of a class beside a panel, or words in it, in lines that leave this its room."""
    return fill(name, LONGEST_NAME)


# ---- Heads of figures


def what_case(values: Mapping[str, Any], selected: Mapping[str, str] = MappingProxyType({})) -> str:
    """Values of parameters for titles: N, Omega, and those that differ from Table 1; and the stays of a
    sweep, in words. What identifies a case comes first: its friction, and what tells its disc and slider
    from others. How the disc is computed comes last, as a title may have no room for all.

    selected : words for others of the values, by their names
    """
    words = [
        MODELS[value] for value in values.values() if isinstance(value, str) and value in MODELS
    ]
    numbers = {name: value for name, value in values.items() if not isinstance(value, str)}
    said = [_numbers_text(numbers, ("N", "Omega", *OF_FRICTION))]
    said += [text for name, text in selected.items() if name in values]
    said += words
    said += [_numbers_text(numbers, IDENTIFYING)]
    said += [_numbers_text(numbers, (*OF_DAMPING, *OF_CONTACT))]
    others = {*numbers} - {*ORDERED}
    said += [_numbers_text(numbers, others), values.get(STAYS, "")]
    said += [_numbers_text(numbers, OF_DISC), _numbers_text(numbers, OF_MODES)]
    if values.get("normalization") == "orthonormal":
        said.append(MODES["orthonormal"])
    return ", ".join(filter(None, said))


def _numbers_text(values: Mapping[str, Any], chosen: Collection[str]) -> str:
    """The chosen ones among values of parameters, for titles."""
    numbers = {name: value for name, value in values.items() if name in chosen}
    said = values_text(numbers, UNITS.get())
    for name, phrase in IN_WORDS.items():
        said = said.replace(name, phrase)
    return said


def head_text(width: float, title: str, values: str, most: int | None = None) -> str:
    """A title and values of parameters, in lines that fit a width in inches; a value stays on the
    line of its name. Of values that need more lines than `most`, the last ones are only counted."""
    unbroken = [value.replace(" ", "\u00a0") for value in typeset(values).split(", ")]
    length = round(width / CHARACTER)
    said = _in_lines(", ".join(unbroken), length)
    for count in range(len(unbroken) - 1, 0, -1):
        if most is None or said.count("\n") < most:
            break
        rest = f"and {len(unbroken) - count} more".replace(" ", "\u00a0")
        said = _in_lines(f"{', '.join(unbroken[:count])} {rest}", length)
    lines = [fill(line, length) for line in title.splitlines()]
    lines = [text for text in (*lines, said) if text]
    return "\n".join(lines).replace("\u00a0", " ")


def _in_lines(values: str, length: int) -> str:
    """Values in lines of a number of characters; one that is longer has a line of its own."""
    return fill(values, max(length, 1), break_long_words=False, break_on_hyphens=False)
