"""What a continuation returns: the dataset of a branch, its cycles with the special ones among them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
import xarray as xr
from pydantic import Field, InstanceOf

from disc_model.arrays import Array, ComplexArray
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
from disc_model.stability.continuation.arguments import CHANGES, Bounds, require_interval
from disc_model.stability.continuation.curve import MOST_POINTS, CurvePoint, StepControl
from disc_model.stability.continuation.cycles import (
    CLOSED,
    GRAZING,
    HOPF,
    LOST,
    PERIOD_DOUBLING,
    Course,
    CycleProblem,
    Tracer,
    first_cycle,
)
from disc_model.stability.cycle import STICK_SLIP, Kind, multipliers, require_single
from disc_model.stability.segments import extremes_of_cycle
from disc_model.units import Count, CycleTolerance, checked

if TYPE_CHECKING:
    import pandas as pd

VARIABLES = ("growth_rate", "period", "stick_fraction", "range", "u_min", "u_max")
"""What is drawn of each cycle of a branch; the last three by simulation."""
SHOWN_ENDS = (GRAZING, HOPF, PERIOD_DOUBLING, MOST_POINTS, LOST)
"""Ends that are special points of a kind of their own."""
NEUTRAL = 1e-6  # logarithm of a multiplier's modulus that counts as 0 at a special point
SAME_VALUE = 1e-12  # relative difference of two values of a parameter that is rounding
STATE = ("psi", "f", "u", "u_velocity", "phase", "direction", *COORDINATES)
"""Values of a cycle's state on the section, at time 0: variables with the beginning "state_", because a
parameter may have one of these names."""


@dataclass(frozen=True, eq=False, repr=False)
class Branch:
    """Cycles along a curve, special ones among them, and why it ends: what `continue_cycle` returns, and
    what is made of a stored dataset of one. Raises `ParameterError` for another dataset.

    The variables of its dataset are attributes, as arrays.

    Attributes
    ----------
    data : the dataset, see `to_dataset`
    period : s; stick_fraction; growth_rate : 1/s; each (n_points,)
    stable : bool, (n_points,), whether disturbances decay
    kind : (n_points,), of special points, see `special_points`; else ""
    multipliers : complex, (n_points, n), largest modulus first
    diameters : int, (n_points,), nodal diameters of the modes with most energy in the leading multiplier's eigenvector
    separations, releases : int, (n_points,), in a period: twice as many releases beyond a period doubling
    range, u_min, u_max : m, (n_points,), of the slider's height over static equilibrium in a period

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=14.9)
    >>> dm.save(dm.continue_cycle(case, "Omega", (14.8, 15.2)), "branch.nc")
    >>> branch = dm.Branch(dm.load("branch.nc"))
    >>> branch.folds.round(6)
    array([15.094912])
    """

    data: xr.Dataset

    def __post_init__(self) -> None:
        known = isinstance(self.data, xr.Dataset) and {"kind", "state_beta"} <= {*self.data}
        rule = "must be a dataset of Branch.to_dataset, whole and unchanged"
        require((known, "data", type(self.data).__name__, rule))

    def __getattr__(self, name: str) -> Array:
        if name == "data" or name not in self.data.variables:
            raise AttributeError(f"a branch has no {name}")
        return np.asarray(self.data[name].values)

    @property
    def multipliers(self) -> ComplexArray:
        """Multipliers, shape (n_points, n), largest modulus first."""
        return np.asarray(self.multipliers_real + 1j * self.multipliers_imag)

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
        return np.asarray(self.data[self.name].values)

    @property
    def folds(self) -> Array:
        """Values at which the parameter turns, located to rounding, shape (n_folds,)."""
        return self.values[self.kind == "fold"]

    def __len__(self) -> int:
        return int(self.data.sizes["point"])

    def __repr__(self) -> str:
        values = self.values
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
        - point: its number along the branch
        - growth_rate (1/s): exactly 0 where the cycle gains or loses stability
        - multiplier: the one that is critical; at a grazing and at an end, the leading one
        - the parameter by its name, and what else is known of cycles
        - state: the cycle's `State`, see `state`

        Examples
        --------
        >>> import disc_model as dm
        >>> branch = dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.8, 15.2))
        >>> branch.special_points[["kind", "Omega"]]
           kind      Omega
        0   end  14.800000
        1  fold  15.094912
        2   end  14.800000
        """
        special = self.data.drop_dims(["mode", "multiplier"]).isel(point=self.kind != "")
        table = special.drop_vars(
            [x for x in special if str(x).startswith("state_")]
        ).to_dataframe()
        multiplier = table.pop("critical_real") + 1j * table.pop("critical_imag")
        points = np.flatnonzero(self.kind).tolist()
        states: Any = [self.state(i) for i in points]
        return table.reset_index(drop=True).assign(
            multiplier=multiplier.tolist(), point=points, state=states
        )

    def to_dataset(self) -> xr.Dataset:
        """The whole branch as a dataset, to save, or to handle by xarray and pandas.

        Along `point`: the parameter by its name, `growth_rate` (1/s), `period` (s),
        `stick_fraction`, `range`, `u_min` and `u_max` (m), `stable`, `separations`, `releases`,
        `diameters`, `multipliers_real` and `multipliers_imag`, and the cycle's state on the section:
        `state_psi` and so on and, along `mode`, `state_a`, `state_b`, `state_alpha`, `state_beta`. The
        `kind` of special points, else "", and their critical multiplier, `critical_real`
        and `critical_imag`. Attributes: `ended`, and the case's `parameters` in JSON.

        Examples
        --------
        >>> import disc_model as dm
        >>> branch = dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.8, 15.2))
        >>> data = branch.to_dataset()
        >>> data["kind"].values[[0, -1]].tolist(), data["period"].attrs["units"]
        (['end', 'end'], 's')
        >>> dm.save(data, "branch.nc")
        >>> dm.load("branch.nc").identical(data)
        True
        """
        return self.data

    def case_at(self, i: int) -> Parameters:
        """The case of the i-th cycle."""
        return self.case.replace(**{self.name: float(self.values[i])})

    def state(self, i: int) -> State:
        """The state of the i-th cycle on the section, at the end of stick or, without stick, where
        the spring is longest, and at time 0, to simulate, to draw, and to start again from; the cycle
        may be unstable.

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
        values = {name: self.data[f"state_{name}"].values[i].tolist() for name in STATE}
        return State(time=0.0, **values)

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
    state = problem.state(point.z).replace(time=0.0)
    period = point.orbit.period
    low, high = extremes_of_cycle(problem.case(point.z), state, period)
    values = multipliers(point.found.jacobian)
    growth_rate = -math.inf
    if values[0]:
        growth_rate = math.log(abs(values[0])) / period
    return {
        problem.names[0]: float(problem.values(point.z)[0]),
        "growth_rate": growth_rate,
        "period": period,
        "stick_fraction": point.orbit.stick_time / period,
        "range": high - low,
        "u_min": low,
        "u_max": high,
        "stable": growth_rate < 0,
        "multipliers_real": values.real,
        "multipliers_imag": values.imag,
        "separations": point.orbit.counts.separations,
        "releases": point.orbit.counts.releases,
        "diameters": problem.leading_diameters(point),
        **{f"state_{name}": getattr(state, name) for name in STATE},
    }


def branch_of(problem: CycleProblem, course: Course, exact: Sequence[float] = ()) -> Branch:
    """The branch of a course. Values of the parameter that scaling has moved by its rounding from
    one of some `exact` ones are these."""
    entries = course.entries
    # a branch that closes has no ends; others may end at a special point
    if course.last != CLOSED:
        for i, end in ((0, course.first), (-1, course.last)):
            if not entries[i].kind:
                kind = end if end in SHOWN_ENDS else "end"
                entries[i] = entries[i]._replace(kind=kind, multiplier=entries[i].point.leading)
    rows = []
    for entry in entries:
        critical = {"critical_real": entry.multiplier.real, "critical_imag": entry.multiplier.imag}
        rows.append({**entry.kept, "kind": entry.kind, **critical})
    columns = {x: np.array([row[x] for row in rows]) for x in rows[0]}
    [name] = problem.names
    for value in exact:
        columns[name][np.isclose(columns[name], value, rtol=SAME_VALUE, atol=0)] = value
    growth = columns["growth_rate"]
    neutral = np.abs(growth * columns["period"]) <= NEUTRAL
    growth[neutral & np.isin(columns["kind"], CHANGES)] = 0.0

    known = OF_RESULTS["Branch"]
    variables = {}
    for x, column in columns.items():
        own = x.removeprefix("state_")
        dims = ("point", "mode" if own in COORDINATES else "multiplier")
        attrs = attributes(name) if x == name else known[own].attributes
        variables[x] = xr.Variable(dims[: column.ndim], column, attrs)
    attrs = {
        "ended": "; ".join(dict.fromkeys(filter(None, (course.first, course.last)))),
        "parameters": problem.base.canonical_json,
        "free_parameters": name,
        "versions": versions_text(),
    }
    return Branch(xr.Dataset(variables, attrs=attrs).set_coords(name))


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
    value = case.numbers[name]
    rule = f"must lie within the bounds, {bounds[0]:g} to {bounds[1]:g}"
    require((bounds[0] <= value <= bounds[1], name, value, rule))
    problem, start = first_cycle(case, name, bounds, tol, guess, releases, kind)
    with progress_bar("continue_cycle", None, progress) as done:

        def keep(point: CurvePoint) -> dict[str, Any]:
            here = value_with_unit(name, problem.values(point.z)[0])
            done(f"continue_cycle at {here}")
            return row_of(problem, point)

        course = Tracer(problem, steps, keep).follow(start, direction)
    return branch_of(problem, course, (*bounds, value))
