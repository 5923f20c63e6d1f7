"""The return map of cycles, on one of two sections, and its fixed points.

Of stick-slip the section is the instant before a forward release: g = 0 and T = mu_s P.  A point of
it consists of the modal coordinates alone, because f follows from the speed of the surface and psi
from the release condition, scaled to the norm of the disc's energy: omega a, omega b, alpha, beta.
On a rigid disc the section is a single point, to which all motions return that stick: size is 0.

Of cycles that slip all the time it is where the slip speed rises through the drive's: f = Omega.
Where the surface does not move, the spring in the plane is longest there.  Points have psi as well.
Such cycles arise in a Hopf bifurcation of steady sliding, and end where they touch zero slip speed.
Where friction falls with the speed they are usually unstable, and separate the motions that come to
stick-slip from those that come to steady sliding.

Derivatives come from the variational equations.
"""

import math
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, ClassVar, NamedTuple

import numpy as np
from scipy.optimize import brentq

from disc_model.arrays import Array
from disc_model.disc.plate import mode_arrays
from disc_model.engine import columns, loop, saltation, section, tangent, transitions
from disc_model.engine import state as motion
from disc_model.engine.model import Model, build_state
from disc_model.engine.series import build_series
from disc_model.parameters import RESIDUAL, Parameters, require_case
from disc_model.simulation.states import (
    State,
    engine_case,
    read_state,
    series_order,
    series_tolerance,
    write_state,
)
from disc_model.stability.sliding import split_rows

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
# over the model's unit of time: the rate of the fastest oscillation above which steps are
# shortened; all published cases are below it
FAST = 1.25
LEAST_DECREASE = 0.2  # of the residual in a step of Newton's method, over the step's share
MOST_HALVINGS = 7  # of such a step, before it is given up
SLOW = 0.05  # a step that leaves more of the residual needs the Jacobian at its own point
MOST_JACOBIANS = 14  # in a search for a fixed point
COARSE_JACOBIANS = 3  # of these, which only give a direction
# ends of motions that slip all the time
STOPS = -1
VANISHED = -2
ENDS = {
    transitions.RETURNED: "returned",
    transitions.TIME_OVER: "time_over",
    transitions.NO_SOLUTION: "paradox",
    transitions.STALLED: "stalled",
    transitions.NON_FINITE: "non_finite",
    transitions.STOPPED: "lost_contact",
    transitions.OFF_SECTION: "off_section",
    STOPS: "stops",
    VANISHED: "vanished",
}

NOWHERE = np.zeros(0)  # for a motion that goes on from the present state


def longest_step(model: Model, order: int, tolerance: float) -> float:
    """As `tangent.longest_step`, but shorter where dampers, springs together or a fast drive
    oscillate faster."""
    damping = max(
        model.damping.max(), model.damping0.max(initial=0.0), max(model.c, model.c_p) / model.m
    )
    contact = 0.0
    if model.has_compliance:
        contact = (1 / model.m + model.inverse_effective_mass) / model.compliance
    springs = max(model.k, model.k_p) / model.m
    stiffness = max((model.unit * model.free_unit) ** -2, springs) + contact
    turning = model.shift.max() * model.Omega
    fastest = damping / 2 + math.sqrt(damping**2 / 4 + stiffness) + turning
    rate = fastest * model.unit
    longest = tangent.longest_step(order, tolerance)
    if rate > FAST:
        return longest / rate
    return longest


def parameter_change(p: Parameters, model: Model, name: str) -> Array:
    """Derivative of the equations with respect to one of `PARAMETERS`: a column of
    `Tangent.inputs`."""
    if name in ("Omega", "c", "m", "k_p", "c_p"):
        return columns.input_column(model, {name: 1.0})
    if name == "k":
        return columns.input_column(model, {"k": 1.0, "load": -model.u_0})
    sunk = model.u_0  # u_0 if it followed N at its present rate to 0: without stretching it does
    if model.has_stretching:
        sunk = -model.N * model.membrane.softness
    if name == "N":
        return columns.input_column(model, {"load": 1.0 - model.k * sunk / model.N})
    if name == "D_star":
        by_D_star = model.stiffness / p.D, model.stiffness0 / p.D
        return columns.input_column(model, {}, damping=by_D_star)
    # E: omega^2 is proportional to it; the damping (D_star / D) omega^2 does not depend on it, but
    # 2 xi omega does
    stiffness = model.stiffness / p.E, model.stiffness0 / p.E
    damping: tuple[Any, Any] = 0.0, 0.0
    if p.damping_ratio is not None:
        damping = model.damping / (2 * p.E), model.damping0 / (2 * p.E)
    # u_0 depends on N / E alone, and the residual flexibility is proportional to 1 / E
    if p.contact_compliance == RESIDUAL:
        scalars = {"load": model.k * sunk / p.E, "compliance": -1.0 / p.E}
    else:
        softness = model.N * model.compliance
        scalars = {"load": model.k * (sunk + softness) / p.E, "compliance": 0.0}
    return columns.input_column(model, scalars, stiffness, damping)


class Counts(NamedTuple):
    """Number of events of each kind in an orbit, or in a period of a cycle."""

    releases: int
    backward_releases: int
    reversals: int
    separations: int
    sticks: int


@dataclass(frozen=True, eq=False)
class Orbit:
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
    patient : whether motions from points of the section are followed through separations; their returns may take 60
        times as long, about 5 s. Otherwise they end there
    """

    slider: ClassVar[tuple[str, ...]] = ()
    """Coordinates of the slider on the section, besides u, u' on a compliant contact."""

    def __init__(
        self,
        p: Parameters,
        tol: float = 1e-12,
        parameters: tuple[str, ...] = (),
        *,
        patient: bool = False,
    ) -> None:
        require_case(p)
        self.tol = float(tol)  # kernels are compiled for the types of their arguments
        self.parameters = p
        self.patient = patient
        self._case = engine_case(p)
        self.model = self._case.model
        model = self.model

        # the Jacobian needs a finer series than event times do, and no rougher one could reach a
        # residual of 1e-8
        tolerance = 1 / 20 * min(self.tol, 1e-10)
        self.order = series_order(tolerance)
        self.tolerance = series_tolerance(tolerance, compliant=p.contact_compliance != 0)
        self._series = build_series(model, self.order)
        self._state = build_state(model)

        # coordinates of the section
        modes = columns.coordinate_rows(model, ())
        height = ("u", "u_velocity") if model.has_compliance else ()
        self._rows = columns.coordinate_rows(model, (*self.slider, *height))
        self.diameters = columns.diameters_of_rows(model)[modes]
        self.scale = columns.energy_scale(model)[self._rows]
        self.size = len(self._rows)

        # columns of the variational equations: by the coordinates, then by the parameters
        self._names = parameters
        self._tangent = columns.build_tangent(model, self.size, self.order, len(parameters))
        self._first = self._tangent.plain
        for i, name in enumerate(parameters):
            columns.put_input_column(self._tangent, i, parameter_change(p, model, name))
        jacobian = np.zeros((self.size, self._tangent.columns))
        self._section = section.Section(self._rows, self.scale, np.zeros(self.size), jacobian)

        self.static = self._coordinates()
        self.deflection = max(float(np.linalg.norm(self.static)), sys.float_info.min)

    def _coordinates(self) -> Array:
        column = columns.column_of(self._state, self.model)
        return np.asarray(column[self._rows] * self.scale, dtype=float)

    @property
    def longest(self) -> float:
        """Time allowed for a return, s: several times that of the rigid disc, whatever the
        speed."""
        p = self.parameters
        stuck = 2 * (p.mu_s - p.mu_k) * p.N / (p.r_0 * p.k_p * p.Omega)
        longest = 4 * (stuck + 2 * math.pi * math.sqrt(p.m / p.k_p)) + 0.01
        if self.patient:
            return 60.0 * longest
        return longest

    def evaluate(
        self, x: Array, *, releases: int = 1, tangent: bool = True, coarse: bool = False
    ) -> Orbit:
        """Follow the motion from `x` to the `releases`-th next release; `coarse` suffices for a
        direction."""
        start = np.array(x, dtype=float)
        # the engine knows a start by its length, and reads as many numbers as the section has
        given = start if self.size else np.zeros(1)
        duration = int(releases) * self.longest
        code = self._fly(
            duration, releases, given, tangent=tangent, separate=self.patient, coarse=coarse
        )
        log = self._tangent.log
        events = log[columns.RELEASES : columns.STICKS + 1].astype(int)
        jacobian = self._section.jacobian
        last = self._first + len(self._names)
        return Orbit(
            outcome=code,
            period=float(log[columns.DURATION]),
            stick_time=float(log[columns.STICK_TIME]),
            counts=Counts(*events.tolist()),
            start=start,
            end=self._section.end.copy(),
            jacobian=jacobian[:, : self.size].copy(),
            by=jacobian[:, self._first : last].copy(),
        )

    def _fly(
        self,
        duration: float,
        releases: int,
        start: Array = NOWHERE,
        *,
        tangent: bool = False,
        separate: bool = False,
        coarse: bool = False,
    ) -> int:
        """Follow the motion from a point of the section, or from the present state, to the `releases`-th
        next release, for at most a duration (s); or for this duration, with 0. Returns the exit code."""
        order = self.order
        tolerance = self.tolerance
        tolerance_of_columns = 10 * self.tolerance
        if coarse:
            order = min(20, order)
            tolerance = 1e-9
            tolerance_of_columns = 1e-5
        longest = math.inf
        if tangent:
            longest = longest_step(self.model, order, tolerance_of_columns)
        limits = loop.FlightLimits(
            order, tolerance, longest, duration, int(releases), bool(separate), bool(tangent)
        )
        return section.integrate(
            self.model, self._series, self._state, self._tangent, limits, self._section, start
        )

    def next_release(self, start: State) -> Passage:
        """The first passage of the motion from `start` through the section; a motion that loses
        contact before ends there, unless the map is patient."""
        write_state(self._case, start, self._state)
        return self._follow_to_release(self.longest, separate=self.patient)

    @cached_property
    def first_release(self) -> Passage:
        """The first passage of the motion from the static start, in contact, through the section:
        the first release from a stick that has lasted.

        A damper that pulls more than friction can hold releases the slider at once, beyond the
        section. The passage is then the one after.
        """
        p = self.parameters
        motion.copy_state(self._case.start, self._state)
        # four times the first stick of a rigid disc: surface friction and slopes change the loads
        stick = max(p.mu_s * p.N / p.r_0 - p.c_p * p.Omega, 0.0) / (p.k_p * p.Omega)
        first = self._follow_to_release(4 * stick + self.longest)
        if not first.reached or first.time > 0.0:
            return first
        return self._follow_to_release(self.longest, releases=2)

    def _follow_to_release(
        self, duration: float, releases: int = 1, *, separate: bool = False
    ) -> Passage:
        """Follow the motion from the present state for at most a duration (s) to a release."""
        code = self._fly(duration, releases, separate=separate)
        scalars = motion.scalars_of(self._state)
        return Passage(code, scalars["time"] + scalars["time_low"], self._section.end.copy())

    def apart(self, x: Array, y: Array) -> float:
        """Distance of two points of the section, over the static deflection."""
        return float(np.linalg.norm(x - y)) / self.deflection

    def point(self, state: State) -> Array:
        """The point of the section of a state that lies on it."""
        write_state(self._case, state, self._state)
        return self._coordinates()

    def point_of(self, rows: Any) -> Any:
        """Coordinates on the section of a state, or of a change of one, in the rows of
        `SteadySliding.jacobian`; complex for a complex change."""
        modes = mode_arrays(self.parameters)
        (a, alpha, b, beta), slider, height = split_rows(modes, rows)
        column = np.zeros(self._tangent.rows, rows.dtype)
        places = np.concatenate(motion.mode_places(modes.diameters))
        values = np.concatenate([a, b, alpha, beta])
        column[places[places >= 0]] = values[places >= 0]
        column[self._rows[len(self.diameters) :]] = [*slider[: len(self.slider)], *height]
        return column[self._rows] * self.scale

    def state(self, x: Array) -> State:
        """The point `x` of the section as a `State` (time 0, at the end of stick)."""
        section.put_point(self.model, self._state, self._section, x)
        return read_state(self._case, self._state)

    def returns(self, x: Array, most: int, *, coarse: bool = False) -> Iterator[Array]:
        """Points of the motion from `x` at its next releases, at most `most`, as long as it
        returns."""
        for _ in range(most):
            orbit = self.evaluate(x, tangent=False, coarse=coarse)
            if not orbit.returned:
                return
            x = orbit.end
            yield x


# ---- The section of cycles that slip all the time

PIECES = 16  # in a period of the fastest mode, or of the slider on its spring: none hides a passage
LONGEST = 20.0  # periods of the slider on its spring up to a return
# amplitude of f, over Omega, below which a cycle is steady sliding: the
# parameter of a Hopf point, which depends on its square, is known to 1e-8
SMALLEST_CYCLE = 1e-4
SAME_TIME = 1e-9  # error of a passage over a piece: what remains is its square
NO_EVENTS = Counts(0, 0, 0, 0, 0)


class SlippingMap(ReturnMap):
    """As `ReturnMap`, on the section f = Omega, with psi among the coordinates, behind those of the
    modes. A motion that separates is never followed, as its map is not smooth."""

    slider = ("psi",)

    def __init__(self, p: Parameters, *args: Any, **options: Any) -> None:
        super().__init__(p, *args, **options)
        self.deflection = math.hypot(self.deflection, p.mu_s * p.N / math.sqrt(p.k_p))
        self._before = build_state(self.model)
        # the engine gives f as well, behind the coordinates
        rows = np.append(self._rows, columns.coordinate_rows(self.model, ("f",))[-1])
        changes = np.zeros((self.size + 1, self._tangent.columns))
        scale = np.append(self.scale, 1.0)
        self._section = section.Section(rows, scale, np.zeros(self.size + 1), changes)
        # changes of f on the section with each column
        self._moves = np.zeros(self._tangent.columns)
        if "Omega" in self._names:
            self._moves[self._first + self._names.index("Omega")] = 1.0

    @np.errstate(divide="ignore", invalid="ignore")  # where the motion does not return
    def evaluate(
        self, x: Array, *, releases: int = 1, tangent: bool = True, coarse: bool = False
    ) -> Orbit:
        """Follow the motion from `x` to its next passage; `releases` and `coarse` have no meaning."""
        start = np.array(x, dtype=float)
        self._put(start)
        acceleration = self._rates()[-1]
        outcome, period = self._follow_to_passage()
        # the amplitude of an oscillation about steady sliding
        smallest = math.tau * SMALLEST_CYCLE * self.model.Omega
        if outcome == RETURNED and acceleration * period < smallest:
            outcome = VANISHED
        if outcome == RETURNED and tangent:
            self._put(start)
            self._put_columns()
            outcome = self._advance(period, tangent=True)

        # to the section along the motion: by rounding, and by the change of the time of passage
        *rates, acceleration = self._rates()
        along = np.array(rates) / acceleration
        end = self._section.end[:-1] - along * self._excess
        changes = self._section.jacobian
        changes = changes[:-1] - np.outer(along, changes[-1] - self._moves)
        by_start, by = changes[:, : self.size], changes[:, self._first :][:, : len(self._names)]
        period -= self._excess / acceleration
        return Orbit(outcome, period, 0.0, NO_EVENTS, start, end, by_start, by)

    def state(self, x: Array) -> State:
        """The point `x` of the section as a `State` in slip, at time 0."""
        self._put(x)
        return read_state(self._case, self._state)

    def _put(self, x: Array) -> None:
        """Put the engine's state at a point of the section, in slip at time 0."""
        column = np.zeros(self._tangent.rows)
        column[self._section.rows] = [*(x / self.scale), self.model.Omega]
        columns.put_column(self._state, self.model, column)
        motion.put_phase(self._state, motion.SLIP, 1)

    def _put_columns(self) -> None:
        """Set the columns to unit changes of the coordinates, and those of parameters to the change
        of the section with them."""
        changes = np.zeros((self._tangent.rows, self._tangent.columns))
        changes[self._rows, np.arange(self.size)] = 1 / self.scale
        changes[self._section.rows[-1]] = self._moves
        blocks = changes.reshape(len(changes), -1, columns.COLUMNS_AT_ONCE).swapaxes(0, 1)
        self._tangent.now[:] = blocks.ravel()
        saltation.slider_rows(self.model, self._state, self._tangent)

    def _rates(self) -> Array:
        """Rates of the coordinates and of f."""
        before = self._tangent.before
        saltation.rates(self.model, self._state, before)
        rates = before.reshape(self._tangent.rows, -1)[self._section.rows, 0]
        return np.asarray(rates * self._section.scale, dtype=float)

    @property
    def _excess(self) -> float:
        """The slip speed over the drive's where the motion has ended, rad/s."""
        return float(self._section.end[-1] - self.model.Omega)

    def _advance(self, duration: float, *, tangent: bool = False) -> int:
        """Follow the motion for a duration (s); `RETURNED`, or why it does not slip on until then."""
        events = self._tangent.log[columns.RELEASES : columns.STICKS + 1]
        events[:] = 0.0
        code = self._fly(duration, 0, tangent=tangent)
        if code != transitions.TIME_OVER:
            return code
        return STOPS if events.any() else RETURNED

    def _follow_to_passage(self) -> tuple[int, float]:
        """Follow the motion from the present state to the next passage through the section: exit code
        and time (s)."""
        model = self.model
        slowest = math.tau * math.sqrt(model.m / model.k_p)
        fastest = max(model.stiffness.max(), model.stiffness0.max(initial=0), model.k_p / model.m)
        piece = math.tau / math.sqrt(fastest) / PIECES
        is_slower = False  # whether the slider has been slower than the drive since the start

        def excess_after(time: float) -> float:
            motion.copy_state(self._before, self._state)
            self._advance(time)
            return self._excess

        for number in range(math.ceil(LONGEST * slowest / piece)):
            motion.copy_state(self._state, self._before)
            code = self._advance(piece)
            if code != RETURNED:
                return code, number * piece
            if is_slower and self._excess >= 0:
                time = float(brentq(excess_after, 0.0, piece, xtol=SAME_TIME * piece))
                excess_after(time)
                return RETURNED, number * piece + time
            is_slower = self._excess < 0
        return VANISHED, LONGEST * slowest


# ---- Fixed points


def rounding(tol: float, factor: float) -> float:
    """Relative residual accepted when it stops decreasing; a rough `tol` does not allow more than
    1e-8."""
    return max(tol, min(factor * tol, 1e-8))


def newton(map_: ReturnMap, x: Array, *, releases: int = 1) -> Orbit | None:
    """The orbit from a fixed point of the map, by Newton's method with a line search; None if it
    finds none.

    The residual must fall below the map's `tol`, over its deflection. If rounding stops it earlier,
    up to ten thousand times as much is accepted, but never more than 1e-8.  Jacobians are reused;
    the result has that of the fixed point.
    """
    follow = partial(map_.evaluate, releases=releases)
    goal = map_.tol * map_.deflection
    orbit = follow(x, coarse=True)
    jacobian = orbit.jacobian
    for computed in range(1, MOST_JACOBIANS + 1):
        better = None
        if orbit.returned and orbit.residual > goal:
            better = _search_along_step(follow, orbit, jacobian, MOST_HALVINGS)
        if better is None:
            break
        # a good step is followed by another with its Jacobian, which must not shorten that
        while goal < better.residual <= SLOW * orbit.residual:
            orbit = better
            better = _search_along_step(follow, orbit, jacobian, 1) or orbit
        orbit = better
        if orbit.residual > goal:
            jacobian = follow(orbit.start, coarse=computed < COARSE_JACOBIANS).jacobian

    solution = follow(orbit.start)
    largest = rounding(map_.tol, 1e4) * map_.deflection
    close = solution.returned and solution.residual <= largest
    if close and bool(np.all(np.isfinite(solution.jacobian))):
        return solution
    return None


def _search_along_step(
    follow: Callable[..., Orbit], orbit: Orbit, jacobian: Array, halvings: int
) -> Orbit | None:
    """The orbit from the first point along a step of Newton's method that decreases the residual
    in proportion; the whole step is tried first, then its half, `halvings` times in all."""
    step = newton_step(jacobian - np.eye(len(jacobian)), orbit.end - orbit.start)
    for shrink in range(halvings):
        share = 0.5**shrink
        trial = follow(orbit.start - step * share, tangent=False)
        if trial.returned and trial.residual < orbit.residual * (1 - LEAST_DECREASE * share):
            return trial
    return None


def newton_step(matrix: Array, right: Array) -> Array:
    """A step of Newton's method; if the matrix is singular, the least-squares solution of least
    norm."""
    try:
        return np.asarray(np.linalg.solve(matrix, right), dtype=float)
    except np.linalg.LinAlgError:
        return np.asarray(np.linalg.lstsq(matrix, right, rcond=None)[0], dtype=float)
