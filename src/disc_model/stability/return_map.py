"""The return map of the stick-slip cycle, and its fixed points.

The section is the instant before a forward release: f = 0 and r_0 F = mu_s P.  A point of it
consists of the modal coordinates alone, because psi follows from the release condition, scaled to
the norm of the disc's energy: omega a, omega b, alpha, beta.  Derivatives come from the variational
equations (`disc_model.engine.event_loop`).
"""

import math
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from disc_model.engine import event_loop, layout, transitions
from disc_model.engine import tangent as columns
from disc_model.engine.series import Series, build_series
from disc_model.errors import raise_faults, violations
from disc_model.parameters import RESIDUAL, Parameters, foreign_case
from disc_model.simulation.states import (
    State,
    engine_case,
    read_state,
    series_order,
    series_tolerance,
    write_state,
)

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

PARAMETERS = (
    "Omega",
    "N",
    "D_star",
    "c",
    "c_p",
    "k",
    "k_p",
    "E",
    "m",
)  # by which the map can be differentiated
RETURNED = transitions.RETURNED
# steps times blocks of lanes and of columns: some 0.2 s, after which Ctrl-C is answered
WORK_PER_PIECE = 100_000
ENDS = {
    transitions.RETURNED: "returned",
    transitions.TIME_OVER: "time_over",
    transitions.NO_SOLUTION: "paradox",
    transitions.STALLED: "stalled",
    transitions.NON_FINITE: "non_finite",
    transitions.STOPPED: "lost_contact",
    transitions.OFF_SECTION: "off_section",
}


def case_faults(p: Any, analysis: str) -> list[str]:
    """Faults of a case for ``analysis``: it must be `Parameters`, and have modes, which alone can
    become unstable."""
    rule = f"must be >= 0: {analysis} needs modes of the disc"
    return foreign_case(p) or violations((p.n_diameters >= 0, "n_diameters", p.n_diameters, rule))


def longest_step(model: layout.Model, order: int, tolerance: float) -> float:
    """As `columns.longest_step`, but shorter where dampers, springs together or a fast drive
    oscillate faster."""
    damping = max(
        model.damping.max(), model.damping0.max(initial=0.0), max(model.c, model.c_p) / model.m
    )
    contact = (
        (1 / model.m + model.inverse_effective_mass) / model.compliance if model.compliant else 0.0
    )
    stiffness = (
        max((model.unit * model.free_unit) ** -2, max(model.k, model.k_p) / model.m) + contact
    )
    fastest = damping / 2 + math.sqrt(damping**2 / 4 + stiffness) + model.shift.max() * model.Omega
    rate = fastest * model.unit
    # all published cases are below 1.25, where steps are not shortened
    return columns.longest_step(order, tolerance) / (rate if rate > 1.25 else 1.0)


def integrate_in_pieces(
    model: layout.Model,
    series: Series,
    state: layout.EngineState,
    tangent: columns.Tangent,
    course: event_loop.IntegrationLimits,
    section: event_loop.Section | None = None,
    start: Array | None = None,
) -> int:
    """`event_loop.integrate`, with a return to Python after every `WORK_PER_PIECE`: a kernel cannot
    be interrupted, and an integration under extreme stiffness or mass takes minutes."""
    blocks = max(1, len(model.shift) // layout.WIDTH)
    if course.tangent:
        blocks *= 1 + tangent.columns // layout.WIDTH
    step = min(course.longest, event_loop.TYPICAL_STEP) * model.unit
    piece = WORK_PER_PIECE / blocks * step
    left, releases = course.t_max, course.releases
    where: tuple[Any, ...] = () if section is None else (section,)
    if start is not None:
        where = (section, start)
        tangent.log[columns.RELEASES] = 0.0  # as the engine does there
    while True:
        before = float(tangent.log[columns.RELEASES])
        now = course._replace(t_max=min(left, piece), releases=releases)
        code: int = event_loop.integrate(model, series, state, tangent, now, *where)
        if code != transitions.TIME_OVER or left <= piece:
            return code
        left -= piece
        releases -= int(tangent.log[columns.RELEASES] - before)
        where = where[:1]


def parameter_change(p: Parameters, model: layout.Model, name: str) -> Array:
    """Derivative of the equations with respect to one of `PARAMETERS`: a column of
    `Tangent.parameters`."""
    width, n0 = len(model.mode_amplitude), len(model.mode_amplitude0)
    change = np.zeros(columns.N_SCALARS + 2 * width + 2 * n0)
    ends = columns.N_SCALARS + np.cumsum([0, width, width, n0])
    scalars, stiffness, damping, stiffness0, damping0 = np.split(change, ends)
    entries = {"Omega": columns.D_OMEGA, "c": columns.D_C, "m": columns.D_M, "k": columns.D_K}
    entries |= {"k_p": columns.D_K_P, "c_p": columns.D_C_P}
    if name in entries:
        scalars[entries[name]] = 1.0
    if name == "k":
        scalars[columns.LOAD] = -model.u_0
    elif name == "N":  # u_0 is proportional to N
        scalars[columns.LOAD] = 1.0 - model.k * model.u_0 / model.N
    elif name == "E":
        # omega^2 is proportional to E; the damping (D_star / D) omega^2 does not depend on it, but
        # 2 xi omega does
        stiffness[:], stiffness0[:] = model.stiffness / p.E, model.stiffness0 / p.E
        if p.damping_ratio is not None:
            damping[:], damping0[:] = model.damping / (2 * p.E), model.damping0 / (2 * p.E)
        # u_0 and the residual flexibility are proportional to 1 / E
        residual = p.contact_compliance == RESIDUAL
        scalars[columns.LOAD] = (
            model.k * (model.u_0 + (0.0 if residual else model.N * model.compliance)) / p.E
        )
        scalars[columns.D_COMPLIANCE] = -1.0 / p.E if residual else 0.0
    elif name == "D_star":
        damping[:], damping0[:] = model.stiffness / p.D, model.stiffness0 / p.D
    return change


def coordinate_rows(model: layout.Model) -> NDArray[np.intp]:
    """Rows of a column without those of empty lanes, in which rounding errors would stay for
    ever."""
    lanes, width = np.flatnonzero(model.shift), len(model.mode_amplitude)
    return np.concatenate([lanes, width + lanes, np.arange(2 * width, columns.n_rows(model))])


def energy_scale(model: layout.Model) -> Array:
    """Square root of twice the energy of a unit of each row of a column: (rows,)."""
    ones, ones0 = np.ones(len(model.mode_amplitude)), np.ones(len(model.mode_amplitude0))
    slider = [model.r_0 * math.sqrt(model.k_p or model.m), model.r_0 * math.sqrt(model.m)]
    contact = 1 / model.compliance if model.compliant else 0.0
    height = [math.sqrt(model.k + contact or model.m), math.sqrt(model.m)]
    stiffness = np.where(model.stiffness > 0, model.stiffness, 1.0)
    return np.concatenate(
        [np.sqrt(stiffness), ones, np.sqrt(model.stiffness0), ones0, slider, height]
    )


class Counts(NamedTuple):
    """Number of events of each kind in a flight, or in a period of a cycle."""

    releases: int
    backward_releases: int
    reversals: int
    separations: int
    sticks: int


@dataclass(frozen=True, eq=False)
class Flight:
    """The motion between two returns to the section: exit code, durations (s), and derivatives of
    the end by the start, (n, n), and the map's parameters, (n, their number). Without a return, or
    tangents, these mean nothing."""

    outcome: int
    period: float
    stick_time: float
    counts: Counts
    start: Array
    end: Array
    jacobian: Array
    by: Array

    @property
    def returned(self) -> bool:
        return self.outcome == RETURNED

    @property
    def residual(self) -> float:
        """Distance of the end from the start: 0 for a cycle."""
        change = self.end - self.start
        return math.sqrt(change.dot(change))  # as np.linalg.norm, in a quarter of the time


class Passage(NamedTuple):
    """Where a motion comes to the section: exit code, `RETURNED` on success; time (s) and
    coordinates, (n,), which otherwise are those of its end."""

    outcome: int
    time: float
    x: Array

    @property
    def reached(self) -> bool:
        return self.outcome == RETURNED


class ReturnMap:
    """The return map of one case; it owns the engine's arrays, so that one object serves one
    thread.

    size : dimension n of the section: four for each pair of modes, two for each axisymmetric one, and on a compliant
        contact two for the slider's u, u'
    scale : (n,), factor from modal displacements and velocities to coordinates: omega, or 1; u and u' likewise
    diameters : nodal diameters of the mode of each coordinate, without the slider's coordinates, which come last
    static : (n,), static equilibrium under the preload. The motion from there need not come to this
        point: friction on the surface bends the disc during the first stick, see `first_release`
    deflection : norm of `static`, the unit of distances on the section; `tol` is the residual of cycles over it
    patient : whether motions that separate are followed; their returns may take 60 times as long, about 5 s
    """

    def __init__(
        self,
        p: Parameters,
        tol: float = 1e-12,
        parameters: tuple[str, ...] = (),
        *,
        patient: bool = False,
    ) -> None:
        raise_faults(case_faults(p, "the return map"))
        self.tol = tol = float(tol)  # kernels are compiled for the types of their arguments
        self.parameters, self.patient = p, patient
        self._case = engine_case(p)
        self.model = model = self._case.model
        # the Jacobian needs a finer series than event times do, and no rougher one could reach a
        # residual of 1e-8
        flights = 1 / 20 * min(tol, 1e-10)
        self.order = series_order(flights)
        self.tolerance = series_tolerance(flights, compliant=p.contact_compliance != 0)
        self._series, self._state = build_series(model, self.order), layout.build_state(model)
        modes, slider = np.split(coordinate_rows(model), [-layout.SLIDER])
        self._slider = int(slider[0])
        l = np.abs(model.shift).astype(np.int64)
        self.diameters = np.concatenate([l, l, np.zeros(2 * len(model.mode_amplitude0), np.int64)])[
            modes
        ]
        height = slider[[layout.U, layout.U_VELOCITY]]
        rows = np.append(modes, height) if model.compliant else modes
        self.scale = energy_scale(model)[rows]
        self.size = n = len(rows)
        self._first = layout.WIDTH * -(-n // layout.WIDTH)
        self._names = parameters
        self._tangent = columns.build_tangent(
            model, self._first + len(parameters), self.order, self._first
        )
        changes = self._tangent.parameters.reshape(
            self._tangent.columns // layout.WIDTH, -1, layout.WIDTH
        )
        for i, name in enumerate(parameters, self._first):
            changes[i // layout.WIDTH, :, i % layout.WIDTH] = parameter_change(p, model, name)
        jacobian = np.zeros((n, self._tangent.columns))
        self._section = event_loop.Section(rows, self.scale, np.zeros(n), jacobian)
        self.static = self._coordinates()
        self.deflection = max(float(np.linalg.norm(self.static)), sys.float_info.min)

    def _coordinates(self) -> Array:
        column = np.append(
            self._state.disc[: self._slider], self._state.x[layout.PSI : layout.U_VELOCITY + 1]
        )
        return np.asarray(column[self._section.rows] * self.scale, dtype=float)

    @property
    def longest(self) -> float:
        """Time allowed for a return, s: several times that of the rigid disc, whatever the
        speed."""
        p = self.parameters
        stuck = 2 * (p.mu_s - p.mu_k) * p.N / (p.r_0 * p.k_p * p.Omega)
        return (60.0 if self.patient else 1.0) * (
            4 * (stuck + 2 * math.pi * math.sqrt(p.m / p.k_p)) + 0.01
        )

    def evaluate(
        self,
        x: Array,
        *,
        releases: int = 1,
        tangent: bool = True,
        may_separate: bool = False,
        coarse: bool = False,
    ) -> Flight:
        """Follow the motion from `x` to the `releases`-th next release; `coarse` suffices for a
        direction."""
        t, start = self._tangent, np.array(x, dtype=float)
        order, tolerance, of_columns = self.order, self.tolerance, 10 * self.tolerance
        if coarse:
            order, tolerance, of_columns = min(20, order), 1e-9, 1e-5
        longest = longest_step(self.model, order, of_columns) if tangent else math.inf
        course = event_loop.IntegrationLimits(
            order,
            tolerance,
            longest,
            int(releases) * self.longest,
            int(releases),
            bool(may_separate),
            bool(tangent),
        )
        code = integrate_in_pieces(
            self.model, self._series, self._state, t, course, self._section, start
        )
        whole, stick = t.log[[columns.DURATION, columns.STICK_TIME]].tolist()
        counts = Counts(*t.log[columns.RELEASES : columns.STICKS + 1].astype(int).tolist())
        jacobian, last = self._section.jacobian, self._first + len(self._names)
        by_start, by = jacobian[:, : self.size].copy(), jacobian[:, self._first : last].copy()
        return Flight(code, whole, stick, counts, start, self._section.end.copy(), by_start, by)

    def next_release(self, start: State) -> Passage:
        """The first passage of the motion from `start` through the section; a motion that loses
        contact before ends there, unless the map is patient."""
        write_state(self._case, start, self._state)
        return self._follow_to_release(self.longest, may_separate=self.patient)

    @cached_property
    def first_release(self) -> Passage:
        """The first passage of the motion from the static start, in contact, through the section:
        the first release from a stick that has lasted.

        A damper that pulls more than friction can hold releases the slider at once, beyond the
        section. The passage is then the one after.
        """
        p, case = self.parameters, self._case
        self._state.disc[:], self._state.x[:] = case.start.disc, case.start.x
        # four times the first stick of a rigid disc: surface friction and slopes change the loads
        stick = max(p.mu_s * p.N / p.r_0 - p.c_p * p.Omega, 0.0) / (p.k_p * p.Omega)
        first = self._follow_to_release(4 * stick + self.longest, may_separate=False)
        if not first.reached or first.time > 0.0:
            return first
        return self._follow_to_release(self.longest, may_separate=False, releases=2)

    def _follow_to_release(
        self, duration: float, *, may_separate: bool, releases: int = 1
    ) -> Passage:
        """Follow the motion from the present state for at most a duration (s) to a release."""
        course = event_loop.IntegrationLimits(
            self.order,
            self.tolerance,
            math.inf,
            duration,
            releases,
            may_separate=may_separate,
            tangent=False,
        )
        code = integrate_in_pieces(self.model, self._series, self._state, self._tangent, course)
        x = self._state.x
        return Passage(code, float(x[layout.TIME] + x[layout.TIME_LOW]), self._coordinates())

    def point(self, state: State) -> Array:
        """The point of the section of a state that lies on it."""
        write_state(self._case, state, self._state)
        return self._coordinates()

    def state(self, x: Array) -> State:
        """The point `x` of the section as a `State` (time 0, at the end of stick)."""
        state, column = self._state, np.zeros(self._slider + layout.SLIDER)
        column[self._section.rows] = x / self.scale
        state.disc[:], state.x[:] = 0.0, 0.0
        state.disc[: self._slider], state.x[layout.PSI : layout.U_VELOCITY + 1] = np.split(
            column, [self._slider]
        )
        state.x[layout.PHASE] = layout.STICK
        state.x[layout.PSI] = event_loop.release_angle(self.model, state)
        return read_state(self._case, state)

    def returns(
        self, x: Array, most: int, *, may_separate: bool = False, coarse: bool = False
    ) -> Iterator[Array]:
        """Points of the motion from `x` at its next releases, at most `most`, as long as it
        returns."""
        for _ in range(most):
            flight = self.evaluate(x, tangent=False, may_separate=may_separate, coarse=coarse)
            if not flight.returned:
                return
            yield (x := flight.end)


def rounding(tol: float, factor: float) -> float:
    """Relative residual accepted when it stops decreasing; a rough `tol` does not allow more than
    1e-8."""
    return max(tol, min(factor * tol, 1e-8))


def newton(
    map_: ReturnMap, x: Array, *, releases: int = 1, may_separate: bool = False
) -> Flight | None:
    """The flight from a fixed point of the map, by Newton's method with a line search; None if it
    finds none.

    The residual must fall below the map's `tol`, over its deflection. If rounding stops it earlier,
    up to ten thousand times as much is accepted, but never more than 1e-8.  Jacobians are reused;
    the result has that of the fixed point.
    """
    follow = partial(map_.evaluate, releases=releases, may_separate=may_separate)
    goal, identity = map_.tol * map_.deflection, np.eye(map_.size)
    flight = follow(x, coarse=True)
    jacobian, used, fresh = flight.jacobian, 1, True
    if not flight.returned:
        return None
    while not flight.residual <= goal:
        if not math.isfinite(flight.residual):
            return None
        step, ratio = newton_step(jacobian - identity, flight.end - flight.start), 1.0
        for shrink in range(7 if fresh else 1):
            trial = follow(flight.start - step * 0.5**shrink, tangent=False)
            if trial.returned and trial.residual < flight.residual * (1 - 0.2 * 0.5**shrink):
                ratio, flight, fresh = trial.residual / flight.residual, trial, False
                break
        else:
            if fresh and flight.residual <= rounding(map_.tol, 1e3) * map_.deflection:
                break
            if fresh:
                return None
        if (
            flight.residual > goal and ratio > 0.05
        ):  # a better step is followed by another with its Jacobian
            if used >= 14:  # Jacobians
                return None
            again = follow(flight.start, coarse=used < 3)  # the first ones only give a direction
            if not again.returned:
                return None
            jacobian, used, fresh = again.jacobian, used + 1, True
    solution = follow(flight.start)
    close = solution.returned and solution.residual <= rounding(map_.tol, 1e4) * map_.deflection
    return solution if close and np.all(np.isfinite(solution.jacobian)) else None


def newton_step(matrix: Array, right: Array) -> Array:
    """A step of Newton's method; if the matrix is singular, the least-squares solution of least
    norm."""
    try:
        return np.asarray(np.linalg.solve(matrix, right), dtype=float)
    except np.linalg.LinAlgError:
        return np.asarray(np.linalg.lstsq(matrix, right, rcond=None)[0], dtype=float)
