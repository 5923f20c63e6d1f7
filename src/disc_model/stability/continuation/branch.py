"""What a continuation returns: the dataset of a branch, its cycles along `point` and its special points
along `special`."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
import xarray as xr
from pydantic import Field, InstanceOf

from disc_model.arrays import Array, Mask
from disc_model.data.columns import with_complex_values, with_real_parts
from disc_model.data.variables import (
    COORDINATES,
    OF_RESULTS,
    attributes,
    unit_of_parameter,
    value_with_unit,
)
from disc_model.display import counted, drawings, progress_bar
from disc_model.engine.jit.cache import compiling
from disc_model.errors import require, rule_of_choice
from disc_model.parameters import Parameters
from disc_model.provenance import versions_text
from disc_model.simulation.states import State
from disc_model.stability.continuation.arguments import (
    CHANGES,
    LABELS,
    Bounds,
    require_interval,
    require_within,
)
from disc_model.stability.continuation.curve import MOST_POINTS, CurvePoint, StepControl
from disc_model.stability.continuation.cycles import (
    CLOSED,
    GRAZING,
    HOPF,
    LOST,
    PERIOD_DOUBLING,
    SAME_VALUE,
    Course,
    CycleProblem,
    Entry,
    Tracer,
    first_cycle,
    leading,
)
from disc_model.stability.cycle import STICK_SLIP, Kind, multipliers, require_single
from disc_model.stability.segments import extremes_of_cycle
from disc_model.units import Count, CycleTolerance, checked

if TYPE_CHECKING:
    import pandas as pd

VARIABLES = ("growth_rate", "period", "stick_fraction", "range", "u_min", "u_max")
"""What is known of each cycle of a branch, and of each special point; the last three by simulation."""
SHOWN_ENDS = (GRAZING, HOPF, PERIOD_DOUBLING, MOST_POINTS, LOST)
"""Ends that are special points of a kind of their own."""
NEUTRAL = 1e-6  # logarithm of a multiplier's modulus that counts as 0 at a special point
STATE = ("psi", "f", "u", "u_velocity", "phase", "direction", *COORDINATES)
"""Values of a cycle's state on the section, at time 0."""
OF_CYCLES = (
    *("largest_multiplier", "stable", "multipliers", "separations", "releases", "diameters"),
)
"""What is given of the points of a branch, but not of special ones."""


@dataclass(frozen=True, eq=False, repr=False)
class Branch:
    """Cycles along a curve, their special points, and why it ends: what `continue_cycle` returns.

    The variables of its dataset are attributes, as arrays.

    Attributes
    ----------
    data : the dataset
    period : s; stick_fraction; growth_rate : 1/s; each (n_points,)
    stable : bool, (n_points,), whether disturbances decay
    multipliers : complex, (n_points, n), largest modulus first
    diameters : int, (n_points,), nodal diameters of the modes with most energy in the leading multiplier's eigenvector
    separations, releases : int, (n_points,), in a period: twice as many releases beyond a period doubling
    range, u_min, u_max : m, (n_points,), of the slider's height over static equilibrium in a period

    Examples
    --------
    >>> import disc_model as dm
    >>> branch = dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.8, 15.2))
    >>> branch.folds.round(6)
    array([15.094912])
    """

    data: xr.Dataset

    def __getattr__(self, name: str) -> Array:
        if name.startswith("_") or name == "data":
            raise AttributeError(name)
        return self.variable(name)

    def variable(self, name: str) -> Array:
        """A variable of the dataset."""
        if name not in self.data.variables:
            raise AttributeError(f"a branch has no {name}")
        return np.asarray(self.data[name].values)

    @property
    def name(self) -> str:
        """The free parameter."""
        return str(self.data.attrs["free_parameters"])

    @property
    def case(self) -> Parameters:
        """The case whose cycle is followed; its own value of the free parameter does not count."""
        return Parameters.model_validate_json(self.data.attrs["parameters"])

    @property
    def ended(self) -> str:
        """Why the branch ends: "bound", of the parameter; "closed", it is back at its start; "grazing", a
        switch is touched, and no cycle continues it; "hopf", the cycle shrinks to steady sliding;
        "period_doubling", it becomes one of half the period; "limit", of what makes a case; "max_points"; or
        "lost", no step succeeds. Of both ends if they differ, that of the first point first."""
        return str(self.data.attrs["ended"])

    @property
    def values(self) -> Array:
        """The free parameter, shape (n_points,), in SI units."""
        return self.variable(self.name)

    @property
    def folds(self) -> Array:
        """Values at which the parameter turns, located to rounding, shape (n_folds,)."""
        return self.variable(f"special_{self.name}")[self.variable("special_kind") == "fold"]

    def __len__(self) -> int:
        return int(self.data.sizes["point"])

    def __repr__(self) -> str:
        values = np.concatenate([self.values, self.variable(f"special_{self.name}")])
        unit = unit_of_parameter(self.name)
        span = f"{self.name} from {values.min():.6g} to {values.max():.6g} {unit}".rstrip()
        folds = counted(len(self.folds), "fold")
        return f"Branch({len(self)} cycles, {span}, {folds}; ended: {self.ended})"

    @property
    def special_points(self) -> pd.DataFrame:
        """The special points as a table, at which the number or the stability of cycles changes, and the ends.

        - kind: "fold", two cycles meet; "period_doubling", a multiplier is -1; "neimark_sacker", a complex pair of
          multipliers has modulus one; "grazing", a switch is touched, and an event appears or vanishes; "hopf", the
          cycle shrinks to steady sliding; "branch_point", another branch crosses; "end", of the branch;
          "max_points", its end for no other reason than the number of points; "lost", its end where no step succeeds
        - label: of the kind in AUTO and COCO: LP, PD, TR, BP, HB, EP; GR
        - the parameter by its name; period (s); stick_fraction; range, u_min, u_max (m)
        - growth_rate (1/s): exactly 0 where the cycle gains or loses stability, as `changes_stability` says
        - multiplier: the one that is critical; at a grazing and at an end, the leading one
        - after: number of the point of the branch before it, or at it
        - state: the cycle's `State` on the section, at time 0, to simulate, to draw, and to start again from

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
        table = self.data.drop_dims(["point", "mode", "multiplier"]).to_dataframe()
        table.columns = [str(name).removeprefix("special_") for name in table]
        states: Any = {"state": [self.state(i, "special_") for i in range(len(table))]}
        return table.reset_index(drop=True).assign(**states)

    def to_dataset(self) -> xr.Dataset:
        """The whole branch as a dataset, to save, or to handle by xarray and pandas.

        Along `point`: the parameter by its name, `growth_rate` (1/s), `period` (s),
        `stick_fraction`, `range`, `u_min` and `u_max` (m), `largest_multiplier` (modulus), `stable`,
        `separations`, `releases`, `diameters`, `multipliers_real` and `multipliers_imag`, and the cycle's
        state on the section: `psi`, `f`, `u`, `u_velocity`, `phase`, `direction` and, along `mode`, `a`,
        `b`, `alpha`, `beta`. Along `special`, each with the beginning `special_`: `special_kind`,
        `special_label`, the parameter, `special_multiplier`, `special_after`, `special_changes_stability`,
        and what cycles have, the state included. Attributes: `ended`, and the case's `parameters` in JSON.

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
        return with_real_parts(self.data)

    @classmethod
    def from_dataset(cls, data: xr.Dataset) -> Branch:
        """The branch of a dataset that `to_dataset` has made, also one that was saved and loaded, to
        plot, and to start again from its cycles; raises `ParameterError` if it is another dataset.

        Examples
        --------
        >>> import disc_model as dm
        >>> case = dm.Parameters(N=385, Omega=14.9)
        >>> dm.save(dm.continue_cycle(case, "Omega", (14.8, 15.2)).to_dataset(), "branch.nc")
        >>> branch = dm.Branch.from_dataset(dm.load("branch.nc"))
        >>> branch.plot("period").get_xlabel()
        'Speed Ω (rad/s)'
        >>> dm.continue_cycle(branch.case_at(-1), "Omega", (14.7, 14.9), guess=branch.state(-1))
        Branch(... cycles, Omega from 14.7 to 14.9 rad/s, 0 folds; ended: bound)
        """
        names = {"multipliers_real", "releases", "special_kind", "u_max", "a", "special_a"}
        attrs = {"ended", "parameters", "free_parameters"}
        known = isinstance(data, xr.Dataset) and names <= {*data} and attrs <= {*data.attrs}
        rule = "must be a dataset of Branch.to_dataset, whole and unchanged"
        require((known, "data", type(data).__name__, rule))
        return cls(with_complex_values(data))

    def case_at(self, i: int) -> Parameters:
        """The case of the i-th cycle."""
        return self.case.replace(**{self.name: float(self.values[i])})

    def state(self, i: int, begin: str = "") -> State:
        """The state of the i-th cycle on the section, at the end of stick or, without stick, where
        the spring is longest, and at time 0, to simulate and draw; the cycle may be unstable. With the
        beginning ``"special_"``, that of the i-th special point.

        Examples
        --------
        >>> import disc_model as dm
        >>> branch = dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.8, 15.2))
        >>> print(f"{branch.growth_rate[-1]:.3f}/s")
        0.531/s
        >>> run = dm.simulate(branch.case_at(-1), branch.period[-1], initial_state=branch.state(-1))
        >>> float(abs(run.final_state.u / branch.state(-1).u - 1)) < 1e-10
        True
        """
        return State(time=0.0, **{name: self.variable(begin + name)[i].tolist() for name in STATE})

    def refined(self, name: str) -> Array:
        """A variable of each cycle, such as the parameter, at the points of the branch and, in their
        places between these, where a multiplier crosses the unit circle, with the value of the point
        before if special points have none of their own; shape (n_points + n_crossings,), in SI units."""
        located = np.isin(self.variable("special_kind"), CHANGES)
        after = self.variable("special_after")[located].astype(int)
        own = self.variable(name)
        known = f"special_{name}" in self.data.variables
        inserted = self.variable(f"special_{name}")[located] if known else own[after]
        return np.insert(own, after + 1, inserted)

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

        Periods are in ms and heights in mm, unless `units` says otherwise of a parameter, such as
        ``{"Omega": "rpm"}``. Further branches on the same `ax` have a colour each; `look` has options of
        matplotlib, such as ``label="upper sheet"``. Raises `ParameterError` if `y` is another name.

        Examples
        --------
        >>> import disc_model as dm
        >>> dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.8, 15.2)).plot("period").get_ylabel()
        'Period of the cycle (ms)'
        """
        known = isinstance(y, str) and y in VARIABLES
        require((known, "y", y, rule_of_choice(VARIABLES)))
        return drawings().branch(ax, self, y, units, **look)


# ---- What a continuation has found, in SI units


def row_of(problem: CycleProblem, point: CurvePoint) -> dict[str, Any]:
    """What is kept of a cycle while the map of its case is at hand, the extremes of the slider's height
    by simulation."""
    whole = problem.state(point.z)
    own = {name: getattr(whole, name) for name in STATE}
    period = point.orbit.period
    low, high = extremes_of_cycle(problem.case(point.z), State(time=0.0, **own), period)
    values = multipliers(point.found.jacobian)
    largest = abs(complex(values[0]))
    growth_rate = -math.inf
    if largest:
        growth_rate = math.log(largest) / period
    return {
        problem.names[0]: float(problem.values(point.z)[0]),
        "growth_rate": growth_rate,
        "period": period,
        "stick_fraction": point.orbit.stick_time / period,
        "range": high - low,
        "u_min": low,
        "u_max": high,
        **own,
        "largest_multiplier": largest,
        "stable": growth_rate < 0,
        "multipliers": values,
        "separations": point.orbit.counts.separations,
        "releases": point.orbit.counts.releases,
        "diameters": problem.leading_diameters(point),
    }


def branch_of(problem: CycleProblem, course: Course, exact: Sequence[float] = ()) -> Branch:
    """The branch of a course. Values of the parameter that scaling has moved by its rounding from
    one of some `exact` ones are these."""
    entries = _with_ends(course)
    kinds = np.array([entry.kind for entry in entries])
    is_special = kinds != ""
    columns = {x: np.array([entry.kept[x] for entry in entries]) for x in entries[0].kept}
    [name] = problem.names
    for value in exact:
        near = np.abs(columns[name] - value) <= SAME_VALUE * abs(value)
        columns[name][near & ~is_special] = value
    growth = columns["growth_rate"]
    neutral = (np.abs(growth * columns["period"]) <= NEUTRAL) & np.isin(kinds, CHANGES)
    growth[neutral] = 0.0
    both = {x: column for x, column in columns.items() if x not in OF_CYCLES}
    of_special = {
        "kind": kinds,
        "label": np.array([LABELS.get(kind, "") for kind in kinds]),
        "multiplier": np.array([entry.multiplier for entry in entries], dtype=complex),
        "after": np.maximum(np.cumsum(~is_special) - 1, 0),
        "changes_stability": neutral,
    }
    attrs = {
        "ended": "; ".join(dict.fromkeys(filter(None, (course.first, course.last)))),
        "parameters": problem.base.canonical_json,
        "free_parameters": name,
        "versions": versions_text(),
    }
    variables = _variables("point", "", columns, ~is_special)
    variables |= _variables("special", "special_", both | of_special, is_special)
    return Branch(xr.Dataset(variables, attrs=attrs).set_coords([name, f"special_{name}"]))


def _with_ends(course: Course) -> list[Entry]:
    """The points and special points of a course, its ends among the latter; one that closes or
    begins at a special point has that instead."""
    entries = list(course.entries)
    first = entries[0]
    if course.last != CLOSED:
        entries.append(_end_of(course.last, entries[-1]))
    if not (first.kind or course.last == CLOSED):
        entries.insert(1, _end_of(course.first, first))
    return entries


def _end_of(end: str, entry: Entry) -> Entry:
    """The end of a branch as a special point; without a reason it is the start."""
    kind = "end"
    if end in SHOWN_ENDS:
        kind = end
    return entry._replace(kind=kind, multiplier=leading(entry.point))


def _variables(
    dim: str, begin: str, columns: Mapping[str, Array], rows: Mask
) -> dict[str, xr.Variable]:
    """Some rows of columns along a dimension as variables, whose names have a beginning, and their numbers
    along it; a second dimension is that of the multipliers or modes."""
    known = OF_RESULTS["Branch"]
    variables = {dim: xr.Variable(dim, np.arange(rows.sum()), known[dim].attributes)}
    for name, column in columns.items():
        second = "multiplier"
        if name in COORDINATES:
            second = "mode"
        attrs = known[name].attributes if name in known else attributes(name)
        variables[begin + name] = xr.Variable((dim, second)[: column.ndim], column[rows], attrs)
    return variables


# ---- The function


@checked
@compiling()
def continue_cycle(  # noqa: PLR0913
    case: Parameters,
    name: str,
    bounds: Bounds,
    *,
    direction: Literal[-1, 0, 1] = 0,
    guess: InstanceOf[State] | None = None,
    releases: Annotated[Count, Field(ge=1)] = 1,
    tol: CycleTolerance = 1e-12,
    steps: StepControl = StepControl(),  # noqa: B008
    kind: Kind = STICK_SLIP,
    progress: bool = False,
) -> Branch:
    """Follow a cycle in one parameter by pseudo-arclength, through folds, until it leaves `bounds`.

    The branch goes both ways from the case. From a state `guess` the cycle may lose contact; with
    its impacts it is followed as long as the motion depends continuously on the parameter. Where a
    switch is grazed, the return map jumps, and the branch ends. A branch that closes ends where it
    began.

    Parameters
    ----------
    case : case whose cycle is followed; its value of the parameter must lie within the bounds
    name : the free parameter, one of `Parameters.numbers`
    bounds : values of the parameter between which the cycle is followed; SI units, or texts with units
    direction : 0 for both ways; 1 to begin with increasing values alone, -1 with decreasing ones
    guess, releases, tol : as in `floquet`; with the state of a period doubling and twice its releases, the branch that
        begins there is followed, one way
    steps : length and number of the steps
    kind : "stick_slip"; or "slipping" for the cycle of `floquet(case, kind="slipping")`, which slips all the time, from
        the Hopf point of steady sliding to where it touches zero slip speed
    progress : whether standard error shows how many cycles are found, and at which value of the parameter

    Returns
    -------
    Branch
        The cycles in their order along the curve; its folds and other special points; and in `ended` why it ends.

    Raises
    ------
    ParameterError
        If an argument breaks a rule, or no cycle is found to start from.

    Examples
    --------
    The fold of the cycle at 385 N:

    >>> import disc_model as dm
    >>> branch = dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.8, 15.2))
    >>> branch
    Branch(... cycles, Omega from 14.8 to 15.09... rad/s, 1 fold; ended: bound)
    >>> print(f"{branch.folds[0]:.6f} rad/s")
    15.094912 rad/s
    """
    require_single(guess, releases, kind)
    require_interval(case, name, bounds)
    require_within(case, name, bounds)
    farthest = max(map(abs, bounds))
    problem, start = first_cycle(case, name, farthest, tol, guess, releases, kind)
    with progress_bar("continue_cycle", None, progress) as bar:

        def keep(point: CurvePoint) -> dict[str, Any]:
            value = problem.values(point.z)[0]
            bar.describe(f"continue_cycle at {value_with_unit(name, value)}")
            bar.advance()
            return row_of(problem, point)

        course = Tracer(problem, steps, bounds, keep).follow(start, direction)
    return branch_of(problem, course, (*bounds, case.numbers[name]))
