"""What a continuation returns: the dataset of a branch, its cycles along `point` and its special points
along `special`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from disc_model.arrays import Array, Mask
from disc_model.data.columns import with_complex_values, with_real_parts
from disc_model.data.swept_branches import branch_of_sweep, is_of_sweep
from disc_model.data.variables import (
    COORDINATES,
    OF_RESULTS,
    attributes_of_number,
    unit_of_parameter,
)
from disc_model.display import counted, drawings, progress_bar
from disc_model.engine.jit.cache import compiling
from disc_model.errors import Fault, raise_faults, require, rule_of_choice, violations
from disc_model.parameters import Parameters, Quantity
from disc_model.provenance import versions_text
from disc_model.simulation.states import State, is_finite
from disc_model.stability.continuation.arguments import (
    CHANGES,
    LABELS,
    ROUNDING,
    STOPS,
    read_values,
    stop_kinds,
    values_in_si,
)
from disc_model.stability.continuation.curve import CurvePoint, StepControl
from disc_model.stability.continuation.cycles import (
    CLOSED,
    GRAZING,
    HOPF,
    LOST,
    MOST_POINTS,
    PERIOD_DOUBLING,
    SAME_VALUE,
    STOPPED,
    Course,
    Entry,
    Search,
    first_cycle,
    growth_rate,
    leading,
    parameter_scale,
)
from disc_model.stability.cycle import STICK_SLIP, guess_faults, multipliers
from disc_model.stability.segments import extremes_of_cycle
from disc_model.units import CYCLE_TOLERANCES, is_number, limits_faults

if TYPE_CHECKING:
    import pandas as pd

VARIABLES = ("growth_rate", "period", "stick_fraction", "range", "u_min", "u_max")
"""What is known of each cycle of a branch, and of each special point; the last three by simulation."""
SHOWN_ENDS = (GRAZING, HOPF, PERIOD_DOUBLING, MOST_POINTS, LOST)
"""Ends that are special points of a kind of their own."""
NEUTRAL = 1e-6  # logarithm of a multiplier's modulus that counts as 0 at a special point
STATE = ("psi", "f", "u", "u_velocity", "phase", "direction", *COORDINATES)
"""Values of a cycle's state on the section, at time 0."""


@dataclass(frozen=True, eq=False, repr=False)
class SpecialPoint:
    """A point of a branch at which the number or the stability of cycles changes, or its end: one along
    `special` of the branch's dataset, whose variables are its attributes.

    Attributes
    ----------
    kind : "fold", two cycles meet; "period_doubling", a multiplier is -1; "neimark_sacker", a complex pair of
        multipliers has modulus one; "grazing", a switch is touched, and an event appears or vanishes; "hopf", the
        cycle shrinks to steady sliding; "branch_point", another branch crosses; "end", of the branch;
        "max_points", its end for no other reason than the number of points; "lost", its end where no step succeeds
    label : of the kind in AUTO and COCO: LP, PD, TR, BP, HB, EP; GR
    period : s; stick_fraction; growth_rate : 1/s; range, u_min, u_max : m
    multiplier : the one that is critical; at a grazing and at an end, the leading one
    after : number of the point of the branch before it, or at it
    changes_stability : whether the cycle gains or loses stability there
    """

    branch: Branch
    number: int

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return self.branch.variable(f"special_{name}")[self.number].item()

    @property
    def values(self) -> Array:
        """The free parameters, SI units, shape (n_parameters,)."""
        names = self.branch.parameters
        return np.array([getattr(self, name) for name in names])

    @property
    def case(self) -> Parameters:
        """The case with the values of this point."""
        return self.branch.case_of(self.values)

    @property
    def state(self) -> State:
        """The cycle's state on the section, at time 0, to simulate and draw."""
        return self.branch.state_of(self.number, "special_")

    def __repr__(self) -> str:
        values = ", ".join(f"{value:.9g}" for value in self.values)
        return f"SpecialPoint({self.kind} at {values}, period {self.period:.6g} s)"


@dataclass(frozen=True, eq=False, repr=False)
class Branch:
    """Cycles along a curve, their special points, and why it ends: what `continue_cycle` returns.

    The variables of its dataset are attributes, as arrays.

    Attributes
    ----------
    data : the dataset, without the heights of `to_dataset`
    period : s; stick_fraction; growth_rate : 1/s; each (n_points,)
    stable : bool, (n_points,), whether disturbances decay
    multipliers : complex, (n_points, n), largest modulus first
    diameters : int, (n_points,), nodal diameters of the modes with most energy in the leading multiplier's eigenvector
    separations, releases : int, (n_points,), in a period: twice as many releases beyond a period doubling
    range, u_min, u_max : m, (n_points,), of the slider's height over static equilibrium in a period; each cycle is
        simulated for a period when they are first asked for

    Examples
    --------
    >>> import disc_model as dm
    >>> branch = dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.8, 15.2))
    >>> branch.special[1]
    SpecialPoint(fold at 15.094912, period 0.0147969 s)
    """

    data: xr.Dataset

    def __getattr__(self, name: str) -> Array:
        if name.startswith("_") or name == "data":
            raise AttributeError(name)
        return self.variable(name)

    def variable(self, name: str) -> Array:
        """A variable of the dataset."""
        data = self.data
        if name.removeprefix("special_") in ("range", "u_min", "u_max"):
            data = self._complete
        if name not in data.variables:
            raise AttributeError(f"a branch has no {name}")
        return np.asarray(data[name].values)

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of the free parameters."""
        return tuple(str(self.data.attrs["free_parameters"]).split(", "))

    @property
    def case(self) -> Parameters:
        """The case whose cycle is followed; its own values of the free parameters do not count."""
        return Parameters.model_validate_json(self.data.attrs["parameters"])

    @property
    def ended(self) -> str:
        """Why the branch ends: "bound", of the parameter; "closed", it is back at its start; "stopped", at
        the first of the points asked for; "grazing", a switch is touched, and no cycle continues it; "hopf",
        the cycle shrinks to steady sliding; "period_doubling", it becomes one of half the period; "limit", of
        what makes a case; "max_points"; or "lost", no step succeeds. Of both ends if they differ, that of the
        first point first."""
        return str(self.data.attrs["ended"])

    @property
    def not_reached(self) -> Array:
        """Those of the `values` asked for at which the branch has no cycle, in SI units."""
        text = str(self.data.attrs.get("not_reached", ""))
        return np.array([float(value) for value in text.split(", ") if value])

    @property
    def values(self) -> Array:
        """The free parameters, shape (n_points, n_parameters), in SI units."""
        return np.column_stack([self.variable(name) for name in self.parameters])

    @property
    def special(self) -> tuple[SpecialPoint, ...]:
        """The special points in their order along the branch; `special_points` is their table."""
        return tuple(SpecialPoint(self, i) for i in range(self.data.sizes["special"]))

    @property
    def changes(self) -> list[SpecialPoint]:
        """The special points at which a multiplier crosses the unit circle."""
        return [each for each in self.special if each.kind in CHANGES]

    @property
    def folds(self) -> Array:
        """Values at which the first parameter turns, located to rounding, shape (n_folds, n_parameters)."""
        folds = [each.values for each in self.special if each.kind == "fold"]
        return np.array(folds).reshape(-1, len(self.parameters))

    def __len__(self) -> int:
        return int(self.data.sizes["point"])

    def __repr__(self) -> str:
        spans = []
        for name in self.parameters:
            values = np.concatenate([self.variable(name), self.variable(f"special_{name}")])
            unit = unit_of_parameter(name)
            spans.append(f"{name} from {values.min():.6g} to {values.max():.6g} {unit}".rstrip())
        folds = counted(len(self.folds), "fold")
        missed = ", ".join(f"{value:.6g}" for value in self.not_reached)
        text = f"Branch({len(self)} cycles, {', '.join(spans)}, {folds}; ended: {self.ended}"
        return f"{text}; not reached: {missed})" if missed else f"{text})"

    @property
    def special_points(self) -> pd.DataFrame:
        """The special points as a table: their `kind` and `label`, the parameters by their names (SI
        units), the other variables along `special`, and `state`, a `State` of the cycle.

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
        import pandas as pd

        names = ("kind", "label", *self.parameters, *VARIABLES, "multiplier", "after")
        columns: dict[str, Any] = {name: self.variable(f"special_{name}") for name in names}
        columns["state"] = [each.state for each in self.special]
        return pd.DataFrame(columns)

    @cached_property
    def _complete(self) -> xr.Dataset:
        """The dataset with the heights of the slider, for which each cycle is simulated."""
        heights = dict[str, xr.Variable]()
        for dim, begin in (("point", ""), ("special", "special_")):
            periods = self.variable(f"{begin}period")
            values = np.column_stack([self.variable(begin + name) for name in self.parameters])
            rows = []
            for i, period in enumerate(periods.tolist()):
                state = self.state_of(i, begin)
                rows.append(extremes_of_cycle(self.case_of(values[i]), state, period))
            low, high = np.reshape(rows, (-1, 2)).T
            columns = {"range": high - low, "u_min": low, "u_max": high}
            heights |= _variables(dim, begin, columns, np.ones(len(rows), dtype=bool))
        return self.data.assign(heights)

    def to_dataset(self) -> xr.Dataset:
        """The whole branch as a dataset, to save, or to handle by xarray and pandas.

        Along `point`: the parameters by their names, `growth_rate` (1/s), `period` (s),
        `stick_fraction`, `range`, `u_min` and `u_max` (m, for which each cycle is simulated for a period),
        `largest_multiplier` (modulus), `stable`, `separations`, `releases`, `diameters`,
        `multipliers_real` and `multipliers_imag`, and the cycle's state on the section: `psi`, `f`, `u`, `u_velocity`,
        `phase`,
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
        return with_real_parts(self._complete)

    @classmethod
    def from_dataset(cls, data: xr.Dataset) -> Branch:
        """The branch of a dataset that `to_dataset` has made, also one that was saved and loaded, to
        plot, and to start again from its cycles.

        Of a sweep of branches, `data` is one point, such as ``swept.sel(N=300)``. Raises
        `ParameterError` if it is another dataset, or a point of a sweep that has failed.

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
        if is_of_sweep(data):
            data = branch_of_sweep(data)
        names = ["multipliers_real", "releases", "special_kind", "u_max", "a", "special_a"]
        known = isinstance(data, xr.Dataset) and all(name in data for name in names)
        known = known and {"ended", "parameters", "free_parameters"} <= set(data.attrs)
        rule = "must be a dataset of Branch.to_dataset, or a point of a sweep, whole and unchanged"
        require((known, "data", type(data).__name__, rule))
        whole = with_complex_values(data)
        branch = cls(whole)
        vars(branch)["_complete"] = whole  # whose heights take a simulation of each cycle
        return branch

    def at(self, value: Quantity) -> list[int]:
        """Numbers of the cycles at a value of the first parameter, in SI units or as a text with a unit,
        along the branch; none if the branch passes it between two cycles or not at all.

        Raises `ParameterError` if it is no number.
        """
        name = self.parameters[0]
        faults = list[Fault]()
        [wanted] = values_in_si(name, [value], faults, "value")
        raise_faults(faults)
        require((is_finite(wanted), "value", value, "must be one finite number"))
        apart = np.abs(self.variable(name) - wanted)
        return np.flatnonzero(apart <= ROUNDING * abs(wanted)).tolist()

    def case_of(self, values: Array) -> Parameters:
        """The case followed with some values of the free parameters, in SI units."""
        return self.case.replace(**dict(zip(self.parameters, values.tolist(), strict=True)))

    def case_at(self, i: int) -> Parameters:
        """The case of the i-th cycle."""
        return self.case_of(self.values[i])

    def state_of(self, i: int, begin: str = "") -> State:
        """The state of the i-th cycle, or with the beginning "special_" that of a special point."""
        row = {name: self.variable(begin + name)[i].tolist() for name in STATE}
        return State(time=0.0, **row)

    def state(self, i: int) -> State:
        """The state of the i-th cycle on the section, at the end of stick or, without stick, where
        the spring is longest, and at time 0, to simulate and draw; the cycle may be unstable.

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
        return self.state_of(i)

    def refined(self, name: str) -> Array:
        """A variable, or `values`, at the points of the branch and, in their places between these, at
        its `changes`; shape (n_points + n_changes, ...), in SI units."""
        changes = self.changes
        located = [getattr(each, name) for each in changes]
        own = np.asarray(getattr(self, name))
        if not located:
            return own
        return np.insert(own, [each.after + 1 for each in changes], located, axis=0)

    def refined_growth_rate(self) -> Array:
        """As `refined("growth_rate")`, 1/s, and exactly 0 where the cycle gains or loses stability."""
        growth = self.refined("growth_rate").copy()
        periods = [each.period for each in self.changes if each.changes_stability]
        growth[np.isin(self.refined("period"), periods)] = 0.0
        return growth

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


def branch_of(course: Course, exact: Sequence[float] = (), wanted: Sequence[float] = ()) -> Branch:
    """The branch of a course. Values of the parameter that scaling has moved by its rounding from
    one of some `exact` or `wanted` ones are these."""
    problem = course.problem
    entries = _with_ends(course)
    kinds = np.array([entry.kind for entry in entries])
    is_special = kinds != ""
    points = [entry.point for entry in entries]
    values = np.array([problem.values(point) for point in points])
    for value in (*exact, *wanted):
        near = np.abs(values - value) <= SAME_VALUE * abs(value)
        values[near & ~is_special[:, None]] = value
    period = np.array([point.orbit.period for point in points])
    every = np.array([multipliers(point.jacobian) for point in points])
    growth = np.array(
        [growth_rate(each[0], time) for each, time in zip(every, period, strict=True)]
    )
    states = [problem.state(point.z) for point in points]
    both: dict[str, Any] = dict(zip(problem.names, values.T, strict=True))
    both |= {
        "growth_rate": growth,
        "period": period,
        "stick_fraction": np.array([point.orbit.stick_time for point in points]) / period,
    }
    both |= {name: np.array([getattr(state, name) for state in states]) for name in STATE}
    of_cycles = {
        "largest_multiplier": np.abs(every).max(axis=1, initial=0.0),
        "stable": growth < 0,
        "multipliers": every,
        "separations": np.array([point.orbit.counts.separations for point in points]),
        "releases": np.array([point.orbit.counts.releases for point in points]),
        "diameters": np.array([problem.leading_diameters(point) for point in points]),
    }
    neutral = np.abs(growth * period) <= NEUTRAL
    of_special = {
        "kind": kinds,
        "label": np.array([LABELS.get(kind, "") for kind in kinds]),
        "multiplier": np.array([entry.multiplier for entry in entries], dtype=complex),
        "after": np.maximum(np.cumsum(~is_special) - 1, 0),
        "changes_stability": neutral & np.isin(kinds, CHANGES),
    }
    data = xr.Dataset(
        _variables("point", "", both | of_cycles, ~is_special)
        | _variables("special", "special_", both | of_special, is_special),
        attrs={
            "ended": "; ".join(dict.fromkeys(filter(None, (course.first, course.last)))),
            "parameters": problem.base.canonical_json,
            "free_parameters": ", ".join(problem.names),
            "versions": versions_text(),
        },
    )
    along = values[~is_special, 0]
    slack = ROUNDING * problem.scales[0]
    missed = [value for value in wanted if np.abs(along - value).min() > slack]
    if missed:
        data.attrs["not_reached"] = ", ".join(f"{value:.15g}" for value in missed)
    for dim in ("point", "special"):
        number = np.arange(data.sizes[dim])
        data[dim] = xr.Variable(dim, number, OF_RESULTS["Branch"][dim].attributes)
    return Branch(data.set_coords([*problem.names, *(f"special_{name}" for name in problem.names)]))


def _with_ends(course: Course) -> list[Entry]:
    """The points and special points of a course, its ends among the latter; one that closes, stops or
    begins at a special point has that instead."""
    entries = list(course.entries)
    first, last = entries[0], entries[-1]
    if course.last not in (CLOSED, STOPPED):
        entries.append(_end_of(course.last, last))
    if not (first.kind or course.last == CLOSED or course.first == STOPPED):
        entries.insert(1, _end_of(course.first, first))
    return entries


def _end_of(end: str, entry: Entry) -> Entry:
    """The end of a branch as a special point; without a reason it is the start."""
    kind = end if end in SHOWN_ENDS else "end"
    return Entry(entry.point, kind, leading(entry.point))


def _variables(
    dim: str, begin: str, columns: Mapping[str, Array], rows: Mask
) -> dict[str, xr.Variable]:
    """Some rows of columns along a dimension as variables, whose names have a beginning; a second dimension
    is that of the multipliers or modes."""
    known = OF_RESULTS["Branch"]
    variables = {}
    for name, column in columns.items():
        second = "mode" if name in COORDINATES else "multiplier"
        attrs = known[name].attributes if name in known else attributes_of_number(name)
        variables[begin + name] = xr.Variable((dim, second)[: column.ndim], column[rows], attrs)
    return variables


# ---- The function


CYCLE = StepControl()


@compiling()
def continue_cycle(  # noqa: PLR0913
    case: Parameters,
    name: str,
    bounds: tuple[Quantity, Quantity],
    *,
    direction: int = 0,
    guess: State | None = None,
    releases: int = 1,
    tol: float = 1e-12,
    steps: StepControl = CYCLE,
    values: Sequence[Quantity] = (),
    stop_at: str | Sequence[str] | None = None,
    kind: str = STICK_SLIP,
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
    values : of the parameter, within the bounds; the branch has a cycle at exactly each of them, as often as it passes;
        those that it never passes are its `not_reached`
    stop_at : "fold", "period_doubling" or "neimark_sacker", or the label "LP", "PD" or "TR", to end at the first such
        point, in each direction; several of them to end at the first of any
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
    >>> branch = dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.8, 15.2), values=[15.0])
    >>> branch
    Branch(... cycles, Omega from 14.8 to 15.09... rad/s, 1 fold; ended: bound)
    >>> print(f"{branch.folds[0, 0]:.6f} rad/s")
    15.094912 rad/s
    >>> branch.growth_rate[branch.at(15.0)].round(4).tolist()
    [-0.1055, 0.5751]
    """
    ways = is_number(direction) and direction in (-1, 0, 1)
    stops = stop_kinds(stop_at)
    wrong = violations(
        (isinstance(steps, StepControl), "steps", steps, "must be StepControl"),
        (ways, "direction", direction, "must be -1, 0 or 1"),
        (stops is not None, "stop_at", stop_at, STOPS),
        (isinstance(progress, bool), "progress", progress, "must be True or False"),
    )
    wrong += limits_faults("tol", tol, CYCLE_TOLERANCES) + guess_faults(guess, releases, kind)
    span, wanted = read_values(case, name, bounds, values, wrong)
    scale = steps.scale or parameter_scale(case, name, max(map(abs, span)))
    problem, cycle = first_cycle(case, name, scale, float(tol), guess, releases, kind)
    with progress_bar("continue_cycle", None, progress) as bar:

        def tell(point: CurvePoint) -> None:
            bar.describe(f"continue_cycle at {problem.words(point)}")
            bar.advance()

        search = Search(problem, steps, span, stops or frozenset(), tell)
        course = search.follow(problem.start(cycle), int(direction))
        course = search.with_values(course, wanted)
    return branch_of(course, (*span, case.numbers[name]), wanted)
