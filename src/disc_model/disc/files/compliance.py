"""The static compliance of a disc, as a comment of its table may state it."""

from __future__ import annotations

import difflib
import re

from disc_model.disc.files.rows import begins_a_number, joined, number_in
from disc_model.disc.plate import modes_of_table
from disc_model.errors import Fault, raise_faults, require
from disc_model.parameters import Disc
from disc_model.units import in_si

STATIC_COMPLIANCE = "static_compliance_m_per_N"  # value that a comment line may give
ROUNDING = 1e-9  # relative: both may be the same sum with different rounding
LIKE = 0.8  # likeness of names above which a typing error is suspected
_COMPLIANCE_NAMES = (STATIC_COMPLIANCE.lower(), "static_compliance")
_STATEMENT = re.compile(
    r"\s*#\s*(?P<name>[^:=(\[]+?)\s*(?:[(\[](?P<unit>.*?)[)\]])?\s*[:=]\s*(?P<value>.*?)\s*"
)


def stated_compliance(lines: list[str]) -> str | float | None:
    """The static compliance that a comment states, m/N; a comment that seems to mean it and cannot
    be read is refused."""
    found = []
    for line in lines:
        statement = _STATEMENT.fullmatch(line)
        if statement is None or not _is_on_compliance(statement["name"], statement["value"]):
            continue
        found.append(_compliance(*statement.group("name", "unit", "value")))
    rule = f"must be given once, and not {len(found)} times"
    require((len(found) <= 1, STATIC_COMPLIANCE, found, rule))
    return found[0] if found else None


def _is_on_compliance(name: str, value: str) -> bool:
    """Whether a comment seems to state the static compliance, perhaps with a typing error."""
    words = joined(name)
    likeness = max(
        difflib.SequenceMatcher(None, words, known).ratio() for known in _COMPLIANCE_NAMES
    )
    return likeness >= LIKE or ("complian" in words and begins_a_number(value))


def _compliance(name: str, unit: str | None, value: str) -> str | float:
    """The value of a comment in m/N; its unit stands beside it or beside the name."""
    words = joined(name)
    rule = f"must be named {STATIC_COMPLIANCE}, or static_compliance with a unit of m/N"
    require((words in _COMPLIANCE_NAMES, "comment", name, rule))
    text = f"{value} {unit}" if unit else value
    has_unit = words == STATIC_COMPLIANCE.lower() or isinstance(number_in(text), str)
    require((has_unit, name, value, "must have a unit, such as 42 nm/N"))
    faults: list[Fault] = []
    compliance = in_si(text, "m/N", faults, (STATIC_COMPLIANCE,))
    raise_faults(faults)
    rule = "must be a number in m/N, or with a unit of its kind"
    require((isinstance(number_in(str(compliance)), float), STATIC_COMPLIANCE, text, rule))
    return compliance


def check_compliance(disc: Disc) -> None:
    """Refuse a static compliance that is less than that of the modes."""
    static = disc.static_compliance
    modal = modes_of_table(disc).flexibility
    rule = f"must not be less than what the modes give at the slider, {modal:.6g} m/N"
    is_enough = static is None or static >= modal * (1 - ROUNDING)
    require((is_enough, STATIC_COMPLIANCE, static, rule))
