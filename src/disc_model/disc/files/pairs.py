"""Both halves of pairs of modes in a table, which become one mode of a disc.

Their amplitudes are those at antinodes, which are alike, or those at the point of a test, which are
the cosine and the sine of one angle.
"""

import math
from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Any, Literal

import numpy as np

from disc_model.disc.given import SAME_PAIR, ModeOrigin, relative_difference
from disc_model.display import counted
from disc_model.errors import Fault, raise_faults, require

Pairs = Literal["given", "mean", "test"]
"""How a table has pairs of modes: each once, by halves at antinodes, or by halves at the point of a test."""

OF_A_TEST = "; if both were measured at one point, give pairs='test'"
"""Advice on halves of which a disc has the mean."""

JOINED = {
    "mean": f"amplitudes of pairs are the means of their halves{OF_A_TEST}",
    "test": "amplitudes of pairs are the roots of the sums of squares of their halves, as of a test at one point",
}
"""How the amplitudes of halves were joined, for a report."""

Halves = list[list[int]]
"""The rows of a table that become each mode of a disc: one, or the two halves of a pair."""


def halves_in(values: Mapping[str, Any]) -> Halves:
    """The rows of a table that are one mode of the disc: two of equal diameters, and circles if
    these are given, whose frequencies are close."""
    kinds = _kinds(values)
    omega = values["omega"]
    groups: Halves = []
    for i in sorted(range(len(omega)), key=omega.__getitem__):
        single = [group for group in groups if len(group) == 1]
        halves = [group for group in single if kinds[group[0]] == kinds[i]]
        close = [group for group in halves if _are_close(omega[group[0]], omega[i])]
        if close and kinds[i][0] > 0:
            close[0].append(i)
        else:
            groups.append([i])
    return sorted(groups, key=min)


def check_halves(groups: Halves, values: Mapping[str, Any]) -> None:
    """Raise `ParameterError` if rows of a table are left over that would be a mode once more."""
    kinds = _kinds(values)
    omega = values["omega"]
    for one, other in combinations(groups, 2):
        if kinds[one[0]] != kinds[other[0]]:
            continue
        rows = sorted(one + other)
        means = [sum(omega[i] for i in group) / len(group) for group in (one, other)]
        if "circles" in values or _are_close(min(means), max(means)):
            rule = _fault_of(rows, [omega[i] for i in rows], kinds[one[0]][0])
            # the fault is told at the first row of the second group
            raise_faults([Fault(("omega", str(groups.index(other))), "", rule)])


def _fault_of(rows: Sequence[int], omega: Sequence[float], diameters: float) -> str:
    """Why some rows of equal diameters cannot be modes of a disc."""
    *first, last = [str(i + 1) for i in rows]
    who = f"modes {', '.join(first)} and {last} have {counted(int(diameters), 'nodal diameter')}"
    if diameters == 0:
        return (
            f"{who}, and a mode without nodal diameters is no half of a pair: it must be given once"
        )
    if len(rows) > 2:
        return f"{who}, and a pair has two halves: each must be given once"
    apart = 100 * (max(omega) - min(omega)) / max(omega)
    return f"{who} and are {apart:.2g} % apart: halves of a pair are less than {100 * SAME_PAIR:g} % apart"


def _kinds(values: Mapping[str, Any]) -> list[tuple[float, float]]:
    """Nodal diameters and circles of rows, which the halves of a pair have in common."""
    circles = values.get("circles", [0.0] * len(values["omega"]))
    return [*zip(values["diameters"], circles, strict=True)]


def _are_close(lower: float, upper: float) -> bool:
    """Whether two frequencies may be those of a pair."""
    return upper - lower < SAME_PAIR * upper


def mean_of(groups: Halves, values: Mapping[str, Any]) -> dict[str, Any]:
    """The fields of a disc with both halves of each pair in one mode."""
    sign = np.where(np.array(values["amplitude"]) < 0, -1.0, 1.0)
    means = dict(values)
    for name in ("diameters", "circles", "omega", "damping_ratio"):
        if name in values:
            column = np.array(values[name])
            means[name] = [float(column[group].mean()) for group in groups]
    for name in ("amplitude", "tangential", "shapes"):
        if name in values:
            turned = (np.array(values[name]).T * sign).T
            means[name] = [turned[group].mean(axis=0).tolist() for group in groups]
    return means


def of_a_test(groups: Halves, values: Mapping[str, Any]) -> dict[str, Any]:
    """The fields of a disc with both halves of each pair in one mode, whose halves were measured at
    one point.

    There they move by the cosine and the sine of one angle, so that the root of the sum of squares
    is the amplitude. Raises `ParameterError` for tangential motion of halves.
    """
    fields = mean_of(groups, values)
    for mode, group in enumerate(groups):
        if len(group) == 1:
            continue
        _refuse_tangential(group, values)
        amplitudes = np.array(values["amplitude"])[group]
        amplitude = math.hypot(*amplitudes)
        fields["amplitude"][mode] = amplitude
        if "shapes" in values and amplitude > 0:
            shapes = np.array(values["shapes"])[group]
            fields["shapes"][mode] = (amplitudes @ shapes / amplitude).tolist()
    return fields


def _refuse_tangential(group: Sequence[int], values: Mapping[str, Any]) -> None:
    """Raise `ParameterError` if the halves of a pair have tangential motion at the point of a
    test."""
    for row in group:
        tangential = values.get("tangential", {row: 0.0})[row]
        rule = "must be 0 with pairs='test', because its sign beside the amplitude cannot be told "
        rule += f"from halves at one point: give the pair in one row (mode {row + 1})"
        require((tangential == 0, "tangential", tangential, rule))


def origins_of(
    groups: Halves, values: Mapping[str, Any], splits: Sequence[float] = (), pairs: Pairs = "given"
) -> tuple[ModeOrigin, ...]:
    """What each mode of a disc was made of; `splits`: of rows that are pairs, if a table states
    them."""
    origins = []
    for group in groups:
        frequencies = [values["omega"][i] for i in group]
        if splits and len(group) == 1 and splits[group[0]] > 0:
            half = splits[group[0]] / 2
            frequencies = [frequencies[0] * (1 - half), frequencies[0] * (1 + half)]
        amplitude_split = math.nan
        damping_split = math.nan
        has_halves = len(group) > 1
        if has_halves and pairs != "test":
            amplitude_split = relative_difference([abs(values["amplitude"][i]) for i in group])
        if has_halves and "damping_ratio" in values:
            damping_split = relative_difference([values["damping_ratio"][i] for i in group])
        origin = ModeOrigin(
            diameters=int(values["diameters"][group[0]]),
            lower=min(frequencies),
            upper=max(frequencies),
            shapes=len(frequencies),
            amplitude_split=amplitude_split,
            damping_split=damping_split,
        )
        origins.append(origin)
    return tuple(origins)
