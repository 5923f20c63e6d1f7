"""What is drawn upward of a branch of cycles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from disc_model.data.variables import attributes_of_number, axis_of, presentation_of
from disc_model.errors import require, rule_of_choice
from disc_model.figures.words import DRAWN_IN, label_of

if TYPE_CHECKING:
    from disc_model.stability.continuation import Branch, SpecialPoint


def axis_upward(branch: Branch, y: str) -> tuple[str, float]:
    """The label of what is drawn upward, and the factor from SI to the label's unit."""
    if len(branch.parameters) > 1:
        return label_along(branch.parameters[1])
    known = isinstance(y, str) and y in branch.variables
    require((known, "y", y, rule_of_choice(y, branch.variables)))
    return label_of(xr.DataArray(name=y, attrs=branch.variables[y].attributes))


def label_along(name: str) -> tuple[str, float]:
    """The label of an axis of a number of the case, and the factor from SI to its unit."""
    if name in DRAWN_IN.get():
        attrs = attributes_of_number(name)
        return label_of(xr.DataArray(name=name, attrs=attrs))
    return axis_of(name)


def drawn_unit(name: str) -> str:
    """The unit in which values of a number of the case are drawn; "" without one."""
    unit, _ = DRAWN_IN.get().get(name, (presentation_of(name).unit, 1.0))
    return unit


def upward_of(of: Branch | SpecialPoint, branch: Branch, y: str) -> np.ndarray:
    """What is drawn upward, of all cycles of a branch or of a special point, in SI units."""
    if len(branch.parameters) > 1:
        return np.asarray(of.values[..., 1])
    return np.asarray(getattr(of, y))


def refined_upward(branch: Branch, y: str) -> np.ndarray:
    """As `upward_of` of all cycles, with those of the special points at which stability may change."""
    if len(branch.parameters) > 1:
        return branch.refined("values")[:, 1]
    return branch.refined(y)
