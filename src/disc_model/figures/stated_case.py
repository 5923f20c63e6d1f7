"""What titles say of the case of a run: its values, and the course of those that its ramps change."""

import json
from collections.abc import Mapping, Sequence
from operator import itemgetter
from typing import Any, NamedTuple

import xarray as xr

from disc_model.data.variables import SHOWN
from disc_model.figures.family import Member
from disc_model.figures.head_texts import what_case
from disc_model.figures.varied_discs import varied_numbers, with_frequencies
from disc_model.parameters import Parameters


def parameters_of(case: xr.DataTree) -> Parameters:
    """The parameters of a recorded case."""
    return Parameters.model_validate_json(case.attrs["parameters"])


def size_of(variable: str, case: xr.DataTree) -> float:
    """The size of a variable that is small where a motion stands still, by the drive of its case, in SI
    units; 0 of one whose own values tell it, such as a force."""
    if not variable.endswith("_velocity"):
        return 0.0
    values: dict[str, Any] = json.loads(case.attrs.get("parameters", "{}"))
    speed = abs(values.get("Omega") or 0.0)
    if variable == "psi_velocity":
        return speed
    radius = values.get("r_0")
    return 0.0 if radius is None else speed * radius


def stated_values(p: Parameters, *varied: str) -> dict[str, Any]:
    """What titles say of a case, by name, but what varies."""
    # what varies has the value of a number, so that the ratio of another is kept
    values = p.replace(**{name: p.numbers[name] for name in varied}).stated
    kept = {name: value for name, value in values.items() if name not in varied}
    return with_frequencies(kept, varied_numbers(*varied))


def told_apart(case: xr.DataTree, name: str, **further: str) -> Member:
    """What tells a run from others on the same axes: the name that a reader gives it, or its values
    and further words; a parameter that ramps change has its course for a value."""
    ramps = ramps_of(case)
    courses = {ramp.parameter: _course(ramp.parameter, ramps) for ramp in ramps}
    return Member(name, {**further, **stated_values(parameters_of(case)), **courses})


def stated(case: Parameters | xr.DataTree, *varied: str) -> str:
    """The values of a case, such as that of a run, but those of what varies."""
    p = parameters_of(case) if isinstance(case, xr.DataTree) else case
    values = stated_values(p, *varied)
    said = what_case(values)
    return with_ramps(said, values, case) if isinstance(case, xr.DataTree) else said


def with_ramps(said: str, values: Mapping[str, Any], case: xr.DataTree) -> str:
    """What is said of a case by some values, with the course of those that its ramps change."""
    ramps = ramps_of(case)
    for name in {ramp.parameter for ramp in ramps}:
        said = said.replace(what_case({name: values[name]}), _course(name, ramps))
    return said


class Course(NamedTuple):
    """A ramp of a run: from the time `start` to `end`, s, its parameter goes from `before` to
    `after`, in SI units."""

    parameter: str
    start: float
    end: float
    before: float
    after: float


def ramps_of(case: xr.DataTree) -> list[Course]:
    """The ramps of a run, in the order in which they begin."""
    ramps = json.loads(case.attrs.get("ramps", "[]"))
    if not ramps:
        return []
    values = parameters_of(case).numbers
    courses = []
    for ramp in sorted(ramps, key=itemgetter("start")):
        name = ramp["parameter"]
        courses.append(Course(name, ramp["start"], ramp["end"], values[name], ramp["to"]))
        values = {**values, name: ramp["to"]}
    return courses


def _course(name: str, ramps: Sequence[Course]) -> str:
    """A parameter's value at the start and those at the ends of its ramps, in words."""
    own = [ramp for ramp in ramps if ramp.parameter == name]
    shown = SHOWN[name]
    values = [own[0].before, *(ramp.after for ramp in own)]
    numbers = [f"{shown.factor * value:g}" for value in values]
    return f"{shown.symbol} = {' to '.join(numbers)} {shown.unit}"
