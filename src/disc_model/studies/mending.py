"""All faults of a study file in one round: rules between its parts can be checked only where the
parts are right, so that the rest is checked once more without what is wrong."""

import copy
import re
from collections.abc import Callable, Mapping, Sequence
from difflib import SequenceMatcher
from typing import Any

from disc_model.errors import OTHER_NAMES, Fault, ParameterError, as_text

ROUNDS = 10  # greatest number of times that the rest is checked
MEANT = re.compile(r"did you mean ([^?]+)\?")
ANY = 1.0  # value of a required number,
ANY_NAMES = {"study": "study"}  # and required texts
REQUIRED = "is required"  # what a value that was left out leaves behind,
SAME_VALUES = ("name", "parameter", "count", "exponents")
"""Options that take what arguments of another name do."""
OF_WHAT_IS_LEFT = ("must not be empty", "must give either")
"""Beginnings of rules that a mapping or list breaks for want of what was left out of it."""
NOT_RECORDED = "is not recorded"
"""What a figure's rule says of a window that was left out."""


def all_faults(content: Any, first: Sequence[Fault], check: Callable[[Any], object]) -> list[str]:
    """The faults of a content, and those that are seen without them.

    Parameters
    ----------
    content : of a study file
    first : its faults, as `check` has found them
    check : raises `ParameterError` with faults of a content
    """
    latest = [fault for fault in first if isinstance(fault, Fault)]
    faults = [*first]
    rest = copy.deepcopy(content)
    left_out: dict[str, tuple[str, ...]] = {}
    for _ in range(ROUNDS):
        if not (_mend_any(rest, latest, left_out) or _leave_out_axes(rest, latest, left_out)):
            break
        try:
            check(rest)
            break
        except ParameterError as error:
            latest = [fault for fault in error.faults if isinstance(fault, Fault)]
        told = {fault.path for fault in faults if isinstance(fault, Fault)}
        new = [fault for fault in latest if fault.path not in told]
        faults += [fault for fault in new if _is_further(fault, left_out)]
    return list(dict.fromkeys(faults))


def _mend_any(content: Any, faults: Sequence[Fault], left_out: dict[str, tuple[str, ...]]) -> bool:
    """Mend a content at each fault; returns whether any was found in it."""
    found = [_mend(content, fault, left_out) for fault in faults]
    return any(found)


def _mend(content: Any, fault: Fault, left_out: dict[str, tuple[str, ...]]) -> bool:
    """Give a wrong name the one that is meant, or leave out what is wrong, whose path is then known
    by its name; returns whether it was found in the content."""
    *outer, last = fault.path or ("",)
    if REQUIRED in fault.rule:  # some number stands for one that is wrong or missing
        place = left_out.get(last, ())
        if tuple(outer) == ("axes",):  # and not a part of an axis, such as its start
            place = ("base", last)
            left_out.setdefault(last, place)
        return _fill(content, place)
    parent = _within(content, outer)
    if _entry(parent, last) is None:
        return False
    if isinstance(parent, list):
        del parent[int(last)]
    elif not _mend_value(parent, last, fault) and not _rename(parent, last, fault):
        del parent[last]
        left_out[last] = fault.path
    return True


def _leave_out_axes(
    content: Any, faults: Sequence[Fault], left_out: dict[str, tuple[str, ...]]
) -> bool:
    """Leave out axes without a required part, such as their start; returns whether there are any."""
    axes = _entry(content, "axes")
    found = False
    for fault in faults:
        part, *inner = fault.path or ("",)
        if part == "axes" and len(inner) > 1 and _entry(axes, inner[0]) is not None:
            del axes[inner[0]]
            left_out[inner[0]] = (part, inner[0])
            found = True
    return found


def _mend_value(parent: dict[str, Any], name: str, fault: Fault) -> bool:
    """Leave a wrong value out of a list, or take the word that is meant; returns whether the value
    is one of these."""
    value = parent[name]
    if isinstance(value, list):
        rest = [each for each in value if as_text(each) != fault.value]
        if 0 < len(rest) < len(value):
            parent[name] = rest
            return True
    meant = _meant(fault)
    if isinstance(value, dict):
        return _mend_key(value, fault)
    if isinstance(value, str) and _likeness(meant, value) > _likeness(meant, name):
        parent[name] = meant
        return True
    return False


def _mend_key(value: dict[Any, Any], fault: Fault) -> bool:
    """Give a key of a mapping the name that is meant, or leave it out; returns whether the fault is of
    one."""
    wrong = [key for key in value if as_text(key) == fault.value]
    if not wrong:
        return False
    part = value.pop(wrong[0])
    meant = _meant(fault)
    if meant:
        value.setdefault(meant, part)
    return True


def _rename(parent: dict[str, Any], name: str, fault: Fault) -> bool:
    """Give a value the name that is meant; returns whether there is one."""
    meant = _meant(fault)
    differs = meant in OTHER_NAMES.get(name, ()) and name not in SAME_VALUES
    if not meant or meant in parent or differs:
        return False
    parent[meant] = parent.pop(name)
    return True


def _meant(fault: Fault) -> str:
    """What a fault supposes to be meant for a name or word; "" if it does not, or supposes a unit."""
    if fault.rule.startswith("must be a number"):
        return ""
    found = MEANT.search(fault.rule)
    return found[1] if found else ""


def _fill(content: Any, place: Sequence[str]) -> bool:
    """Give a required number or text some value; returns whether there is a place for it."""
    parent = _within(content, place[:-1])
    if not place or not isinstance(parent, dict) or place[-1] in parent:
        return False
    parent[place[-1]] = ANY_NAMES.get(place[-1], ANY)
    return True


def _within(part: Any, path: Sequence[str]) -> Any:
    """What stands at a path in a content; None if it has no such path."""
    for step in path:
        part = _entry(part, step)
    return part


def _likeness(first: str, second: str) -> float:
    """How alike two texts are, from 0 to 1."""
    return SequenceMatcher(None, first.lower(), second.lower()).ratio()


def _entry(part: Any, step: str) -> Any:
    """An entry of a mapping or of a list; None if there is none."""
    if isinstance(part, dict):
        return part.get(step)
    if isinstance(part, list) and step.isdigit() and int(step) < len(part):
        return part[int(step)]
    return None


def _is_further(fault: Fault, left_out: Mapping[str, Sequence[str]]) -> bool:
    """Whether a fault of the rest is one of the content, and not only of what was left out: figures
    may show an axis that was, and a part may have nothing else."""
    without_axis = any(path[0] in ("axes", "zip") for path in left_out.values())
    if without_axis and fault.path[:1] == ("figures",):
        return False
    shortened = [path[:-1] for path in left_out.values()]
    if fault.path in shortened and fault.rule.startswith(OF_WHAT_IS_LEFT):
        return False
    without_records = any("record" in path for path in left_out.values())
    if without_records and fault.path[:1] == ("figures",) and NOT_RECORDED in fault.rule:
        return False
    without_cases = ("cases",) in left_out.values()
    if without_cases and fault.path[:1] == ("figures",) and fault.path[-1:] == ("case",):
        return False
    said = fault.partition(" (known:")[0]
    names = {*re.findall(r"\w+", said)}
    return REQUIRED not in fault.rule and names.isdisjoint(left_out)
