"""The dataset of a branch: its cycles along `point`, its special points along `special`."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.swept_branches import branch_of_sweep, is_of_sweep, refuse_failed
from disc_model.data.variables import COORDINATES, OF_RESULTS, attributes_of_number
from disc_model.errors import require
from disc_model.parameters import Parameters
from disc_model.simulation.states import State
from disc_model.stability.return_map import ReturnMap
from disc_model.stability.slipping import SlippingMap

VARIABLES = {
    name: OF_RESULTS["Branch"][name]
    for name in ("growth_rate", "period", "stick_fraction", "range", "u_min", "u_max")
}
"""What is known of each cycle of a branch, and of each special point."""
EXTREMES = ("u_min", "u_max")
"""Those of them between which the height lies."""
POINTS = ("largest_multiplier", "stable", "separations", "releases", "diameters", "multipliers")
"""What is known of the cycles alone,"""
SPECIAL = ("kind", "label", "multiplier", "after", "changes_stability")
"""and of the special points alone."""
STATE = ("psi", "f", "u", "u_velocity", "phase", "direction", *COORDINATES)
"""Values of the cycle's state on the section, at time 0."""


class StoredBranch:
    """What a dataset of a branch holds, or a point of a sweep; raises `ParameterError` if it is of
    something else."""

    def __init__(self, data: xr.Dataset) -> None:
        refuse_failed(data)
        if is_of_sweep(data):
            data = branch_of_sweep(data)
        names = ["multipliers", "releases", "special_kind", "u_max", "a", "special_a"]
        known = isinstance(data, xr.Dataset) and all(name in data for name in names)
        known = known and {"ended", "parameters", "free_parameters"} <= set(data.attrs)
        rule = "must be a dataset of Branch.to_dataset, or a point of a sweep, whole and unchanged"
        require((known, "data", type(data).__name__, rule))
        self.data = data
        self.case = Parameters.model_validate_json(data.attrs["parameters"])
        self.parameters = tuple(data.attrs["free_parameters"].split(", "))
        self.ended = str(data.attrs["ended"])

    @property
    def not_reached(self) -> np.ndarray:
        """Values of the parameter at which the branch has no cycle."""
        text = self.data.attrs.get("not_reached", "")
        return np.array([float(value) for value in text.split(", ") if value])

    def values(self, begin: str = "") -> np.ndarray:
        """The free parameters along the points, or with the beginning "special_" along these."""
        return np.column_stack([self.data[begin + name].values for name in self.parameters])

    def case_at(self, values: np.ndarray) -> Parameters:
        """The case with some values of the free parameters."""
        return self.case.replace(**dict(zip(self.parameters, values.tolist(), strict=True)))

    def states(self, begin: str = "") -> list[State]:
        """The states on the section, as `values`."""
        columns = {name: self.data[begin + name].values.tolist() for name in STATE}
        rows = zip(*columns.values(), strict=True)
        return [State(time=0.0, **dict(zip(columns, row, strict=True))) for row in rows]

    @property
    def make_map(self) -> type[ReturnMap]:
        """What makes the map of whose section the states are."""
        slips = "slip" in self.data["phase"].values[:1]
        return SlippingMap if slips else ReturnMap

    def points(self) -> np.ndarray:
        """The points of the section, (n, n_coordinates), scaled as those of the case."""
        return np.array(self.modal()) * self.make_map(self.case).scale

    def modal(self, begin: str = "") -> list[np.ndarray]:
        """The points of the section in modal coordinates, as `values`."""
        points = []
        for state, values in zip(self.states(begin), self.values(begin), strict=True):
            own = self.make_map(self.case_at(values))
            points.append(own.point(state) / own.scale)
        return points


def stored_extremes(data: xr.Dataset, begin: str = "") -> np.ndarray:
    """The extremes of the height that a dataset has, shape (n, 2)."""
    return np.column_stack([data[f"{begin}{name}"].values for name in EXTREMES])


class Columns:
    """Variables along a dimension, whose names have a beginning."""

    def __init__(self, dim: str, begin: str) -> None:
        self.dim = dim
        self.begin = begin
        self.variables: dict[str, xr.Variable] = {}
        self.coordinates: dict[str, xr.Variable] = {}

    def add_parameters(self, names: Iterable[str], values: np.ndarray) -> None:
        """Add the free parameters as coordinates, from their values, (n, n_parameters)."""
        for i, name in enumerate(names):
            column = xr.Variable(self.dim, values[:, i], attributes_of_number(name))
            self.coordinates[self.begin + name] = column

    def add(self, names: Iterable[str], values_of: Callable[[str], Any]) -> None:
        """Add columns by their names; a second dimension is that of the multipliers or modes."""
        for name in names:
            values = np.asarray(values_of(name))
            second = "mode" if name in COORDINATES else "multiplier"
            dims = (self.dim, second)[: values.ndim]
            attrs = OF_RESULTS["Branch"][name].attributes
            self.variables[self.begin + name] = xr.Variable(dims, values, attrs)

    def add_states(self, states: list[State]) -> None:
        """Add the values of states."""
        self.add(STATE, lambda name: [getattr(state, name) for state in states])
