"""Combinations that the measurements determine, of parameters that they do not tell apart.

What is known of parameters spreads along the left singular vectors of their deviations. Those of small
singular values are combinations that are known: of the logarithms of parameters, which are products of
powers, and of parameters with one unit, which are sums. Numbers are rounded to the simplest that leave a
combination known nearly as well."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from disc_model.arrays import Array
from disc_model.data.variables import unit_of_parameter
from disc_model.fitting.result import Combined

AS_WELL = 2.0
"""Standard deviation of a combination with rounded numbers, over that with exact ones, up to which they
are the same."""
DENOMINATORS = (1, 2, 3, 4)
"""Of the fractions that are tried first, which then become whole numbers."""
DIGITS = (1, 2, 3, 4)
"""Numbers of decimals that are tried where no such fraction will do; with the last, a combination may be
known less well."""
BETTER = 0.1
"""Standard deviation of a combination over that of each of its parts, below which it is determined."""


def combinations_of(
    names: Sequence[str], chosen: Sequence[str], values: Array, spread: Array
) -> dict[str, Combined]:
    """Return what is known of parameters that are not told apart, by its formula: sums of parameters with
    one unit if their numbers are simple, and else products of powers.

    Parameters
    ----------
    names : of all parameters
    chosen : of those that are not told apart
    values : of all, (n,)
    spread : whose product with its transpose is the covariance of all, (n, n)
    """
    if len(chosen) < 2:
        return {}
    places = [names.index(name) for name in chosen]
    values = values[places]
    spread = spread[places]
    if len({unit_of_parameter(name) for name in chosen}) == 1:
        sums = _sums(spread)
        if sums:
            return {_sum_text(chosen, row): _summed(chosen, row, values, spread) for row in sums}
    if (values <= 0).any():
        return {}
    relative = spread / values[:, None]
    found = {}
    for row in _known_rows(relative):
        powers = _simplest(row, relative)
        if powers is not None:
            known = _multiplied(powers, values, relative)
            if np.count_nonzero(powers) == 1:
                [i] = np.flatnonzero(powers)
                known = known._replace(unit=unit_of_parameter(chosen[int(i)]))
            found[_product_text(chosen, powers)] = known
    return found


def _sums(spread: Array) -> list[Array]:
    """Return the combinations that are known, in whole numbers; none unless all have them."""
    found = []
    for row in _known_rows(spread):
        whole = _in_whole_numbers(row, spread)
        if whole is None:
            return []
        found.append(whole)
    return found


def _known_rows(spread: Array) -> Array:
    """Return the combinations that are known, each in a row: as many of their parts as possible are 0, and
    the largest is 1."""
    directions, sizes, _ = np.linalg.svd(spread, full_matrices=False)
    ratios = sizes[:-1] / np.maximum(sizes[1:], np.finfo(float).tiny)
    unknown = int(np.argmax(ratios)) + 1
    rows = directions[:, unknown:].T.copy()
    for i in range(len(rows)):
        pivot = int(np.argmax(np.abs(rows[i])))
        rows[i] /= rows[i, pivot]
        others = np.arange(len(rows)) != i
        rows[others] -= np.outer(rows[others, pivot], rows[i])
    return rows


def _simplest(row: Array, spread: Array) -> Array | None:
    """Return a combination in the simplest numbers with which it is known as well; None if it is not
    determined."""
    whole = _in_whole_numbers(row, spread)
    if whole is not None:
        return whole
    if _is_alone(row, spread):
        return np.round(row)
    rounded = row
    for digits in DIGITS:
        rounded = np.round(row, digits)
        if _is_as_well_known(rounded, row, spread):
            return _ascending(rounded)
    return _ascending(rounded) if _is_known(rounded, spread) else None


def _is_alone(row: Array, spread: Array) -> bool:
    """Whether a combination is one parameter, which is known as well without the others."""
    alone = np.round(row)
    deviation = float(np.linalg.norm(alone @ spread))
    as_well = deviation <= AS_WELL * float(np.linalg.norm(row @ spread))
    return np.count_nonzero(alone) == 1 and as_well


def _in_whole_numbers(row: Array, spread: Array) -> Array | None:
    """Return a combination in small whole numbers with which it is known as well; None without any."""
    for denominator in DENOMINATORS:
        rounded = np.round(row * denominator)
        if _is_as_well_known(rounded, row * denominator, spread):
            return _ascending(rounded)
    return None


def _is_as_well_known(rounded: Array, exact: Array, spread: Array) -> bool:
    """Whether a combination with rounded numbers is known as well as with exact ones."""
    deviation = float(np.linalg.norm(rounded @ spread))
    as_well = deviation <= AS_WELL * float(np.linalg.norm(exact @ spread))
    return as_well and _is_known(rounded, spread)


def _is_known(row: Array, spread: Array) -> bool:
    """Whether a combination is known better than its parts, of which there are several."""
    if np.count_nonzero(row) < 2:
        return False
    parts = np.abs(row) * np.linalg.norm(spread, axis=1)
    deviation = float(np.linalg.norm(row @ spread))
    return deviation <= BETTER * float(parts[row != 0].min())


def _ascending(row: Array) -> Array:
    """Return a combination whose first number is positive."""
    first = row[np.flatnonzero(row)[0]]
    return np.asarray(row * np.sign(first))


def _summed(names: Sequence[str], row: Array, values: Array, spread: Array) -> Combined:
    """Return what is known of a sum."""
    deviation = float(np.linalg.norm(row @ spread))
    return Combined(float(row @ values), deviation, unit_of_parameter(names[0]))


def _multiplied(powers: Array, values: Array, relative: Array) -> Combined:
    """Return what is known of a product of powers."""
    product = float(np.prod(values**powers))
    deviation = float(np.linalg.norm(powers @ relative))
    return Combined(product, product * deviation, "in SI units")


def _sum_text(names: Sequence[str], row: Array) -> str:
    """Return a sum as a formula."""

    def term(name: str, size: float) -> str:
        return name if size == 1 else f"{size:g} * {name}"

    return _formula(names, row, "+-", term)


def _product_text(names: Sequence[str], powers: Array) -> str:
    """Return a product of powers as a formula."""

    def term(name: str, size: float) -> str:
        return name if size == 1 else f"{name}^{size:g}"

    return _formula(names, powers, "*/", term)


def _formula(
    names: Sequence[str], numbers: Array, signs: str, term: Callable[[str, float], str]
) -> str:
    """Return a formula of terms, those of size 0 left out; the first is positive.

    signs : before terms of positive and of negative numbers
    """
    text = ""
    for name, number in zip(names, numbers.tolist(), strict=True):
        if number:
            text += f" {signs[number < 0]} {term(name, abs(number))}"
    return text.removeprefix(f" {signs[0]} ")
