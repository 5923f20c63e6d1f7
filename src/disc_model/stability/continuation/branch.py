"""What a continuation returns: the cycles of a branch, its special points, and why it ends."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
import xarray as xr

from disc_model.arrays import Array, ComplexArray, Indices, Mask
from disc_model.data.variables import OF_RESULTS, attributes_of_number, unit_of_parameter
from disc_model.display import counted, drawings
from disc_model.errors import Fault, raise_faults, require, rule_of_choice
from disc_model.parameters import Parameters, Quantity
from disc_model.simulation.states import State, is_finite
from disc_model.sources import versions_text
from disc_model.stability.continuation.arguments import ROUNDING, values_in_si
from disc_model.stability.continuation.data import (
    POINTS,
    SPECIAL,
    VARIABLES,
    Columns,
    StoredBranch,
    stored_extremes,
)
from disc_model.stability.continuation.special_kinds import CHANGES
from disc_model.stability.continuation.special_point import SpecialPoint, stored_special_points
from disc_model.stability.return_map import ReturnMap, leading_direction
from disc_model.stability.segments import extremes_of_cycle
from disc_model.units import in_si

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, eq=False, repr=False)
class Branch:
    """Cycles along a curve, their special points, and why it ends: what `continue_cycle` returns.

    Attributes
    ----------
    parameters : names of the free parameters
    values : shape (n_points, n_parameters), in SI units
    period : s; stick_fraction; growth_rate : 1/s; each (n_points,)
    multipliers : complex, (n_points, n), largest modulus first
    diameters : int, (n_points,), nodal diameters of the modes with most energy in the leading multiplier's eigenvector
    separations : int, (n_points,), number of separations in a period
    releases : int, (n_points,), number of releases of stick in a period: twice as many beyond a period doubling
    points : (n_points, n), on the section, in the coordinates of the return map for the case followed
    folds : (n_folds, n_parameters), values at which the first parameter turns, located to rounding; only on a branch
        in one parameter
    ended : reason for which the branch ends; of both ends if they differ, that of the first point first
    case : whose cycle is followed; its own values of the free parameters do not count
    special : the special points in their order along the branch; `special_points` is their table
    not_reached : those of the `values` asked for at which the branch has no cycle, in SI units

    Examples
    --------
    >>> import disc_model as dm
    >>> branch = dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.8, 15.2))
    >>> branch.special[1]
    SpecialPoint(fold at 15.094912, period 0.0147969 s)
    """

    parameters: tuple[str, ...]
    values: Array = field(repr=False)
    period: Array = field(repr=False)
    stick_fraction: Array = field(repr=False)
    growth_rate: Array = field(repr=False)
    multipliers: ComplexArray = field(repr=False)
    diameters: Indices = field(repr=False)
    separations: Indices = field(repr=False)
    releases: Indices = field(repr=False)
    points: Array = field(repr=False)
    folds: Array
    ended: str
    case: Parameters = field(repr=False)
    special: tuple[SpecialPoint, ...] = ()
    not_reached: Array = field(default_factory=lambda: np.zeros(0))
    _make_map: type[ReturnMap] = ReturnMap
    variables: ClassVar = VARIABLES

    @property
    def stable(self) -> Mask:
        """Whether each cycle is stable: disturbances decay; shape (n_points,)."""
        return self.growth_rate < 0

    def __len__(self) -> int:
        return len(self.period)

    def __repr__(self) -> str:
        reached = np.vstack([self.values, *(special.values for special in self.special)])
        spans = []
        for name, values in zip(self.parameters, reached.T, strict=True):
            unit = unit_of_parameter(name)
            spans.append(f"{name} from {values.min():.6g} to {values.max():.6g} {unit}".rstrip())
        folds = counted(len(self.folds), "fold")
        return f"Branch({len(self)} cycles, {', '.join(spans)}, {folds}; {self._end_text()})"

    def _end_text(self) -> str:
        """Why the branch ends, and which of the values asked for it has not reached."""
        text = f"ended: {self.ended}"
        if not len(self.not_reached):
            return text
        missed = ", ".join(f"{value:.6g}" for value in self.not_reached)
        unit = unit_of_parameter(self.parameters[0])
        return f"{text}; not reached: {self.parameters[0]} = {missed} {unit}".rstrip()

    @property
    def special_points(self) -> pd.DataFrame:
        """The special points as a table, in their order along the branch.

        Columns: `kind` and `label` (AUTO's LP, PD, TR, BP, HB and EP; GR for a grazing), the parameters
        by their names (SI units), `growth_rate` (1/s), `period` (s), `stick_fraction`, of the slider's
        height in a period `range`, and the extremes over static equilibrium `u_min` and `u_max` (m),
        `multiplier`, `after` (number of the branch's point before it) and `state`, a `State` of the
        cycle to simulate and draw, of which the printed table shows time and phase. Its method `to_csv`
        writes a file, with the same words for a state, and with units in the heads; ``attrs["units"]``
        has them by the names of the columns.

        Examples
        --------
        >>> import disc_model as dm
        >>> branch = dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.8, 15.2))
        >>> branch.special_points[["kind", "label", "Omega"]]
           kind label      Omega
        0   end    EP  14.800000
        1  fold    LP  15.094912
        2   end    EP  14.800000
        """
        from disc_model.stability.continuation.special_table import special_table

        columns: dict[str, list[object]] = {
            "kind": [special.kind for special in self.special],
            "label": [special.label for special in self.special],
        }
        for i, name in enumerate(self.parameters):
            columns[name] = [float(special.values[i]) for special in self.special]
        for name in VARIABLES:
            columns[name] = [getattr(special, name) for special in self.special]
        columns["multiplier"] = [special.multiplier for special in self.special]
        columns["after"] = [special.after for special in self.special]
        columns["state"] = [special.state for special in self.special]
        described = {name: attributes_of_number(name) for name in self.parameters}
        described |= {name: known.attributes for name, known in VARIABLES.items()}
        return special_table(columns, described)

    def to_dataset(self) -> xr.Dataset:
        """The whole branch as a dataset, to save, or to handle by xarray and pandas.

        Along `point`: the parameters by their names, `growth_rate` (1/s), `period` (s),
        `stick_fraction`, `range`, `u_min` and `u_max` (m, for which each cycle is simulated for a period),
        `largest_multiplier` (modulus), `stable`, `separations`, `releases`, `diameters`,
        `multipliers`, and the cycle's state on the section: `psi`, `f`, `u`, `u_velocity`, `phase`,
        `direction` and, along `mode`, `a`, `b`, `alpha`, `beta`. Along `special`, each with the beginning `special_`:
        `special_kind`, `special_label`, the parameters, `special_multiplier`, `special_after`,
        `special_changes_stability`, and what cycles have, the state included. Attributes: `ended`,
        the case's `parameters` in JSON, and `not_reached` if there are such values.

        Examples
        --------
        >>> import disc_model as dm
        >>> branch = dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.8, 15.2))
        >>> data = branch.to_dataset()
        >>> data["special_kind"].values.tolist(), data["period"].attrs["units"]
        (['end', 'fold', 'end'], 's')
        >>> dm.save(data, "branch.nc")
        >>> dm.load("branch.nc").identical(data)
        True
        """
        return _dataset_of(self)

    @classmethod
    def from_dataset(cls, data: xr.Dataset) -> Branch:
        """The branch of a dataset that `to_dataset` has made, also one that was saved and loaded, to
        plot, and to start again from its cycles. Numbers differ by rounding at most.

        Of a sweep of branches, `data` is one point, such as ``swept.sel(N=300)``.

        Raises `ParameterError` if it is another dataset, or a point of a sweep that has failed.

        Examples
        --------
        >>> import disc_model as dm
        >>> case = dm.Parameters(N=385, Omega=14.9)
        >>> dm.save(dm.continue_cycle(case, "Omega", (14.8, 15.2)).to_dataset(), "branch.nc")
        >>> branch = dm.Branch.from_dataset(dm.load("branch.nc"))
        >>> branch.plot("period").get_xlabel()
        'Speed Ω (rad/s)'
        >>> dm.continue_cycle(branch.case_at(-1), "Omega", (14.7, 14.9), guess=branch.state(-1))
        Branch(... cycles, Omega from 14.7 to 14.9 rad/s, 0 folds; ended: ...)
        """
        stored = StoredBranch(data)
        data = stored.data
        special = stored_special_points(stored)
        folds = [each.values for each in special if each.kind == "fold"]
        branch = cls(
            parameters=stored.parameters,
            values=stored.values(),
            period=data["period"].values,
            stick_fraction=data["stick_fraction"].values,
            growth_rate=data["growth_rate"].values,
            multipliers=data["multipliers"].values.astype(complex),
            diameters=data["diameters"].values,
            separations=data["separations"].values,
            releases=data["releases"].values,
            points=stored.points(),
            folds=np.array(folds).reshape(-1, len(stored.parameters)),
            ended=stored.ended,
            case=stored.case,
            special=special,
            not_reached=stored.not_reached,
            _make_map=stored.make_map,
        )
        # which take a simulation of each cycle
        vars(branch)["_extremes"] = stored_extremes(data)
        return branch

    def at(self, value: Quantity) -> list[int]:
        """Numbers of the cycles at a value of the first parameter, in SI units or as a text with a unit,
        along the branch; none if the branch passes it between two cycles or not at all.

        Raises `ParameterError` if it is no number.

        Examples
        --------
        >>> import disc_model as dm
        >>> case = dm.Parameters(N=385, Omega=14.9)
        >>> branch = dm.continue_cycle(case, "Omega", (14.8, 15.2), values=["143 rpm"])
        >>> branch.growth_rate[branch.at("143 rpm")].round(3).tolist()
        [-0.105, 0.576]
        """
        name = self.parameters[0]
        faults = list[Fault]()
        [wanted] = values_in_si(name, [value], faults, "value")
        raise_faults(faults)
        rule = "must be one finite number, such as branch.values[0, 0]"
        require((is_finite(wanted), "value", value, rule))
        apart = np.abs(self.values[:, 0] - wanted)
        return np.flatnonzero(apart <= ROUNDING * abs(wanted)).tolist()

    def case_at(self, i: int) -> Parameters:
        """The case of the i-th cycle: the case followed with this cycle's values of the free
        parameters."""
        values = self.values[self._number(i)].tolist()
        return self.case.replace(**dict(zip(self.parameters, values, strict=True)))

    def state(self, i: int, push: float | str = 0.0) -> State:
        """The state of the i-th cycle on the section, at the end of stick or, without stick, where
        the spring is longest, and at time 0, to simulate and draw; the cycle may be unstable.

        Simulated for a period, the modal coordinates return to those of this state within 1e-7 of
        the largest, times the leading multiplier. A `push`, such as 0.01 or "-1 %", moves the state
        along the eigenvector of that multiplier, in which an unstable cycle is left soonest: by this
        share of the disc's static deflection, both in terms of energy, and for a positive push in
        the sense that stretches the spring in the plane. Raises `ParameterError` if there is no such
        cycle.

        Examples
        --------
        >>> import disc_model as dm
        >>> branch = dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.8, 15.2))
        >>> print(f"{branch.growth_rate[-1]:.3f}/s")
        0.531/s
        >>> run = dm.simulate(branch.case_at(-1), branch.period[-1], initial_state=branch.state(-1))
        >>> float(abs(run.final_state.u / branch.state(-1).u - 1)) < 1e-10
        True
        >>> for push in (0.01, -0.01):  # on both sides of an unstable cycle
        ...     run = dm.simulate(branch.case_at(-1), 60, initial_state=branch.state(-1, push))
        ...     print(push, run.statistics["n_separations"] > 0)
        0.01 True
        -0.01 False
        """
        i = self._number(i)
        faults: list[Fault] = []
        share: Any = in_si(push, "1", faults, ("push",))
        raise_faults(faults)
        require((is_finite(share), "push", push, "must be a finite number"))
        own = self._make_map(self.case_at(i))
        reference = self._make_map(self.case)
        point = self.points[i] / reference.scale * own.scale
        if share and own.size:
            direction = leading_direction(own, point, float(self.period[i]))
            point = point + share * own.deflection * direction
        return own.state(point)

    @cached_property
    def _extremes(self) -> Array:
        """`u_min` and `u_max` of each cycle, shape (n_points, 2)."""
        extremes = []
        for i, period in enumerate(self.period.tolist()):
            extremes.append(extremes_of_cycle(self.case_at(i), self.state(i), period))
        return np.array(extremes)

    @property
    def u_min(self) -> Array:
        """Least heights of the slider over static equilibrium in a period, m, shape (n_points,); each
        cycle is simulated for a period when they, `u_max` or `range` are asked for."""
        return self._extremes[:, 0]

    @property
    def u_max(self) -> Array:
        """Greatest heights of the slider over static equilibrium in a period, m, shape (n_points,)."""
        return self._extremes[:, 1]

    @property
    def range(self) -> Array:
        """Ranges of the slider's height over a period, m, shape (n_points,)."""
        return self.u_max - self.u_min

    @property
    def changes(self) -> list[SpecialPoint]:
        """The special points at which a multiplier crosses the unit circle, in their order."""
        return [special for special in self.special if special.kind in CHANGES]

    def refined(self, name: str) -> Array:
        """One of `variables`, or `values`, at the points of the branch and, in their places between
        these, at its `changes`; shape (n_points + n_changes, ...), in SI units."""
        own = np.asarray(getattr(self, name))
        places = [special.after + 1 for special in self.changes]
        if not places:
            return own
        located = [getattr(special, name) for special in self.changes]
        return np.insert(own, places, located, axis=0)

    def refined_growth_rate(self) -> Array:
        """As `refined("growth_rate")`, 1/s, and exactly 0 where the cycle gains or loses stability."""
        growth = self.refined("growth_rate").copy()
        changing = [special.changes_stability for special in self.changes]
        after = np.array([special.after for special in self.changes], dtype=int)
        growth[(after + 1 + np.arange(len(after)))[changing]] = 0.0

        # a branch that ends at a special point has it as one of its points, too
        numbers = np.arange(len(self))
        places = numbers + np.searchsorted(after, numbers)
        periods = [special.period for special in self.changes if special.changes_stability]
        growth[places[np.isin(self.period, periods)]] = 0.0
        return growth

    def _number(self, i: int) -> int:
        """A number of a cycle, checked, counted from the first one."""
        number: Any
        try:
            number = range(len(self))[i]
        except (TypeError, IndexError):
            number = None
        rule = f"must be the number of a cycle, from {-len(self)} to {len(self) - 1}"
        require((isinstance(number, int), "i", i, rule))  # a slice gives several
        return int(number)

    def plot(
        self,
        y: str = "growth_rate",
        *,
        ax: Any = None,
        units: Mapping[str, str] | None = None,
        **look: Any,
    ) -> Any:
        """Draw growth_rate, period, stick_fraction, or of the slider's height the range, u_min or u_max
        (extremes over static equilibrium) over the parameter, thick where the cycle is stable, and
        the special points; returns the axes.

        Stability changes at special points, which are located to rounding; in the bends of a very
        stiff contact it may do so between two points, and the line is thin there. A branch in two
        parameters is drawn as the second over the first. Periods are in ms and heights in mm, unless
        `units` says otherwise of a parameter, such as ``{"Omega": "rpm"}``.

        Further branches on the same `ax` have a colour each. Their usual name is the case; `look` has
        options of matplotlib, such as ``label="upper sheet"``, or ``linestyle="--"`` for dashes where
        the cycle is unstable. Raises `ParameterError` if `y` is another name.

        Examples
        --------
        >>> import disc_model as dm
        >>> dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.8, 15.2)).plot("period").get_ylabel()
        'Period of the cycle (ms)'
        """
        known = isinstance(y, str) and y in self.variables
        require((known, "y", y, rule_of_choice(y, self.variables)))
        return drawings().branch(ax, self, y, units, **look)


def _dataset_of(branch: Branch) -> xr.Dataset:
    """A branch as a dataset, as `Branch.to_dataset` describes it."""
    cycles = Columns("point", "")
    cycles.add_parameters(branch.parameters, branch.values)
    cycles.add(VARIABLES, lambda name: getattr(branch, name))
    own = {
        "largest_multiplier": np.abs(branch.multipliers).max(axis=1, initial=0.0),
        "stable": branch.stable,
        "separations": branch.separations,
        "releases": branch.releases,
        "diameters": branch.diameters,
        "multipliers": branch.multipliers,
    }
    cycles.add(POINTS, own.__getitem__)
    cycles.add_states([branch.state(i) for i in range(len(branch))])

    special = Columns("special", "special_")
    values = [each.values for each in branch.special]
    special.add_parameters(branch.parameters, np.reshape(values, (-1, len(branch.parameters))))
    special.add(
        (*VARIABLES, *SPECIAL), lambda name: [getattr(each, name) for each in branch.special]
    )
    special.add_states([each.state for each in branch.special])

    known = OF_RESULTS["Branch"]
    numbers = {
        "point": ("point", np.arange(len(branch)), known["point"].attributes),
        "special": ("special", np.arange(len(branch.special)), known["special"].attributes),
    }
    attrs: dict[str, Any] = {
        "ended": branch.ended,
        "parameters": branch.case.canonical_json,
        "free_parameters": ", ".join(branch.parameters),
        "versions": versions_text(),
    }
    if len(branch.not_reached):
        attrs["not_reached"] = ", ".join(f"{value:.15g}" for value in branch.not_reached)
    coordinates = {**numbers, **cycles.coordinates, **special.coordinates}
    return xr.Dataset({**cycles.variables, **special.variables}, coordinates, attrs)
