"""Words for the options with which sweeps were computed, and for what they look for, where these tell
lines apart."""

from __future__ import annotations

from typing import Any, NamedTuple

import xarray as xr

from disc_model.data.variables import stated_in, unit_of_parameter
from disc_model.figures.words import KINDS, STAYS
from disc_model.units import is_number


class Phrase(NamedTuple):
    """What legends say of an option: words with braces for its value, and the unit of that."""

    words: str
    unit: str = ""


PHRASES = {
    STAYS: Phrase("stays of {}", "s"),
    "after_separation": Phrase("{} after separation", "s"),
    "attractor_tol": Phrase("attractors within {}"),
    "bounds": Phrase("bounds {}"),
    "confidence": Phrase("confidence {}"),
    "count": Phrase("{} exponents"),
    "duration": Phrase("over {}", "s"),
    "energies": Phrase("energies {}", "J"),
    "evaluation_time": Phrase("last {} of stays", "s"),
    "horizon": Phrase("horizon {}", "s"),
    "interval": Phrase("intervals of {}", "s"),
    "max_attractors": Phrase("up to {} attractors"),
    "max_crossings": Phrase("up to {} crossings"),
    "n_bisection_directions": Phrase("{} bisected directions"),
    "n_starts": Phrase("{} starts"),
    "points": Phrase("{} points"),
    "precision": Phrase("precision {}"),
    "quantity": Phrase("by {}"),
    "releases": Phrase("{} releases"),
    "section": Phrase("{} section"),
    "seed": Phrase("seed {}"),
    "step": Phrase("steps of {}"),
    "stop_at": Phrase("up to {}"),
    "t_end": Phrase("within {}", "s"),
    "tol": Phrase("tolerance {}"),
}
"""What legends say of options,"""
OF_FUNCTIONS = {
    "critical_speed": {
        "bounds": Phrase("bounds {}", "rad/s"),
        "precision": Phrase("precision {}", "rad/s"),
        "step": Phrase("steps of {}", "rad/s"),
    },
    "hysteresis": {"bounds": Phrase("bounds {}", "rad/s"), "step": Phrase("steps of {}", "rad/s")},
    "outcome": {"evaluation_time": Phrase("last {} of the motion", "s")},
}
"""and of those that have another unit or meaning in some functions."""
OF_TRUTH = {
    "early_end": ("early ends", "no early ends"),
    "extrapolate": ("departures extrapolated", "departures not extrapolated"),
    "leave_out_trivial": ("without the trivial exponent", "with the trivial exponent"),
}
"""What they say of options that are true, and of those that are false."""
UNSET = {
    "duration": "",  # which `t_end` may say
    "precision": "precision of a millionth of the range",
    "stop_at": "not stopped",
    "t_end": "",
}
"""What legends say of options that are not set, beside lines for which they are."""
COMPARED = (STAYS, "horizon", "duration", "t_end")
"""Options that are said beside those of another function, which has settings of its own."""
UNSAID = ("progress",)
"""Options that change no result."""
SEPARATION = "separation"


def function_of(study: xr.Dataset) -> str:
    """The name of the function, or of the quantity of a grid study, that computed a study; "" if it is
    not stated."""
    return str(study.attrs.get("function", study.attrs.get("quantity", "")))


def sought_in(study: xr.Dataset) -> str:
    """What critical values are those of, in words: separation, or an instability; "" of all else."""
    function = function_of(study)
    if function == "critical_speed":
        return SEPARATION
    if function == "critical":
        kind = stated_in(study, "options").get("kind", "stick_slip")
        return f"instability of the {KINDS[kind]}".replace("the steady", "steady")
    return ""


def options_of(study: xr.Dataset) -> dict[str, str]:
    """Words for the options with which a study was computed, by their names, such as the length of
    stays: those that are numbers, words, true or false, or lists of such."""
    options = stated_in(study, "options")
    phrases = _phrases_of(study)
    if {"dwell", "max_dwell"} <= {*options}:
        stays = {f"{options.pop(name)}".removesuffix(".0"): None for name in ("dwell", "max_dwell")}
        options[STAYS] = f"{' to '.join(stays)} s"
    if function_of(study) == "critical":
        searched = options.pop("name", "")
        options.pop("kind", None)  # which is said of what is sought
        options = _in_unit_of(options, searched)
    said = {}
    for name, value in options.items():
        if name not in UNSAID and _has_words(value):
            said[name] = _said(name, value, phrases.get(name))
    return said


def _phrases_of(study: xr.Dataset) -> dict[str, Phrase]:
    """What legends say of the options of a study; the bounds of a search are in the unit of the parameter
    that is searched."""
    function = function_of(study)
    phrases = {**PHRASES, **OF_FUNCTIONS.get(function, {})}
    searched = stated_in(study, "options").get("name")
    if function in ("critical", "hysteresis") and isinstance(searched, str):
        unit = unit_of_parameter(searched)
        for name in ("bounds", "step"):
            phrases[name] = phrases[name]._replace(unit=unit)
    return phrases


def list_text(study: xr.Dataset, name: str, values: list[Any]) -> str:
    """What is said of a list that is the value of an option."""
    return _said(name, values, _phrases_of(study).get(name))


def stays_in(study: xr.Dataset) -> dict[str, str]:
    """Words for the stays at each value of a sweep up and down; nothing if a study has none."""
    return {name: text for name, text in options_of(study).items() if name == STAYS}


def option_text(name: str, value: Any) -> str:
    """What is said of the value of an option; "" of one that has no words."""
    phrase = PHRASES.get(name)
    return _said(name, value, phrase) if phrase else ""


def set_options(study: xr.Dataset) -> set[str]:
    """The names of the options that are set, also those of which nothing is said, such as tables."""
    return {name for name, value in stated_in(study, "options").items() if value is not None}


def unset_text(name: str) -> str:
    """What is said of an option that is not set."""
    return UNSET.get(name, f"default {name.replace('_', ' ')}")


def _in_unit_of(options: dict[str, Any], searched: str) -> dict[str, Any]:
    """The options of a search, with the precision in the unit of the parameter that is searched."""
    precision = options.get("precision")
    if not is_number(precision):
        return options
    unit = unit_of_parameter(searched)
    return {**options, "precision": f"{precision:g} {unit}".rstrip()}


def _said(name: str, value: Any, phrase: Phrase | None) -> str:
    """What is said of the value of an option, by a phrase if there is one."""
    if name == "kind":
        return KINDS.get(value, value)
    if phrase is None:
        phrase = Phrase(f"{name.replace('_', ' ')} = {{}}")
    if isinstance(value, bool):
        return _said_of_truth(name, value)
    values = value if isinstance(value, list) else [value]
    unit = phrase.unit if all(map(is_number, values)) else ""
    between = " to " if name == "bounds" else " and "
    return phrase.words.format(f"{_listed(values, between)} {unit}".rstrip())


def _has_words(value: Any) -> bool:
    """Whether legends can say the value of an option."""
    if isinstance(value, list):
        return bool(value) and all(isinstance(each, str) or is_number(each) for each in value)
    return isinstance(value, str | bool) or is_number(value)


def _said_of_truth(name: str, value: bool) -> str:
    """What is said of an option that is true or false."""
    words = name.replace("_", " ")
    if_true, if_false = OF_TRUTH.get(name, (f"with {words}", f"without {words}"))
    return if_true if value else if_false


def _listed(values: list[Any], between: str) -> str:
    """All values of an option, the last one after the word for what is `between`."""
    *first, last = (f"{value:g}" if is_number(value) else str(value) for value in values)
    return f"{', '.join(first)}{between}{last}" if first else last
