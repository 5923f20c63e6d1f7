"""The return map of motions that slip all the time, whose fixed points are cycles without stick.

The section is where the spring in the plane is longest: psi' = 0, and falling.  Where the surface
does not move, the slip speed then rises through the drive's.  A point of the section consists of
the modal coordinates and psi, scaled to the norm of their energy as in
`disc_model.stability.return_map`, and on a compliant contact of the slider's u, u'.

Such cycles arise in a Hopf bifurcation of steady sliding, and end where they touch zero slip speed.
Where friction falls with the speed they are usually unstable, and separate the motions that come to
stick-slip from those that come to steady sliding.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from disc_model.arrays import Array, ComplexArray
from disc_model.disc.plate import mode_arrays
from disc_model.engine import columns, saltation, transitions
from disc_model.engine import state as motion
from disc_model.engine.loop import FlightLimits
from disc_model.engine.model import build_state
from disc_model.engine.series import build_series
from disc_model.errors import raise_faults
from disc_model.parameters import Parameters, foreign_case
from disc_model.simulation.states import (
    State,
    engine_case,
    read_state,
    series_order,
    series_tolerance,
    write_state,
)
from disc_model.stability.return_map import (
    RETURNED,
    STOPS,
    VANISHED,
    Counts,
    Orbit,
    compression_coordinates,
    integrate_in_pieces,
    longest_step,
    parameter_change,
)
from disc_model.stability.sliding import SteadySliding, height_of_slider, split_rows

PIECES = 16  # in a period of the fastest mode, or of the slider on its spring: none hides a passage
LONGEST = 20.0  # periods of the slider on its spring up to a return
# amplitude of the drive point's rate psi', over Omega, below which a cycle is steady sliding: the
# parameter of a Hopf point, which depends on its square, is known to 1e-8
SMALLEST_CYCLE = 1e-4
MOST_CORRECTIONS = 12  # of the time of a passage
SAME_TIME = 1e-9  # last correction over a piece: what remains is its square
NO_EVENTS = Counts(0, 0, 0, 0, 0)


class _Passage(NamedTuple):
    """The next passage through the section: exit code, and time (s) after the start."""

    outcome: int
    time: float


class SlippingMap:
    """The return map of one case to the section on which the spring in the plane is longest; it
    owns the engine's arrays, so that one object serves one thread.

    size : dimension n of the section: four for each pair of modes, two for each axisymmetric one, one for psi, and on
        a compliant contact two for the slider's u, u'
    scale : (n,), factor from modal displacements and velocities, psi, u and u' to coordinates
    diameters : nodal diameters of the mode of each coordinate, without the slider's coordinates, which come last
    deflection : unit of distances: the norm of the static equilibrium with the spring at the limit of friction
    """

    def __init__(
        self,
        p: Parameters,
        tol: float = 1e-12,
        parameters: tuple[str, ...] = (),
        *,
        patient: bool = False,
    ) -> None:
        raise_faults(foreign_case(p))
        self.parameters = p
        self.tol = float(tol)
        self.patient = patient  # no motion that separates is followed, as its map is not smooth
        self._case = engine_case(p)
        self.model = self._case.model
        accuracy = 1 / 20 * min(self.tol, 1e-10)
        self.order = series_order(accuracy)
        self.tolerance = series_tolerance(accuracy, compliant=p.contact_compliance != 0)
        self._series = build_series(self.model, self.order)
        self._state = build_state(self.model)
        self._before = build_state(self.model)

        # coordinates of the section
        height = ("u", "u_velocity") if self.model.has_compliance else ()
        self._rows = columns.coordinate_rows(self.model, ("psi", *height))
        of_slider = columns.coordinate_rows(self.model, ("psi", "f"))[-2:]
        self._psi_row = int(of_slider[0])
        self._rate_row = int(of_slider[1])
        modes = columns.coordinate_rows(self.model, ())
        self.diameters = columns.diameters_of_rows(self.model)[modes]
        self.scale = columns.energy_scale(self.model)[self._rows]
        self.size = len(self._rows)
        self.compression = compression_coordinates(self.model, self._rows)

        # columns of the variational equations: by the coordinates, then by the parameters
        self._names = parameters
        self._tangent = columns.build_tangent(self.model, self.size, self.order, len(parameters))
        self._first = self._tangent.plain
        for i, name in enumerate(parameters):
            columns.put_input_column(self._tangent, i, parameter_change(p, self.model, name))

        motion.copy_state(self._case.start, self._state)
        static = float(np.linalg.norm(self._coordinates()))
        self.deflection = math.hypot(static, p.mu_s * p.N / math.sqrt(p.k_p))
        self._gradient = self._gradient_of_turn()

    def evaluate(
        self,
        x: Array,
        *,
        releases: int = 1,
        tangent: bool = True,
        may_separate: bool = False,
        coarse: bool = False,
    ) -> Orbit:
        """Follow the motion from `x` to its next passage through the section; the options that
        speak of releases and separations have no meaning here."""
        start = np.array(x, dtype=float)
        self._put(start)
        acceleration = self._acceleration()
        if acceleration <= 0:
            return self._orbit(VANISHED, 0.0, start, tangent=tangent)
        outcome, period = self._follow_to_passage()
        amplitude = acceleration * period / math.tau  # of an oscillation about steady sliding
        if outcome == RETURNED and amplitude < SMALLEST_CYCLE * self.model.Omega:
            outcome = VANISHED
        if outcome == RETURNED and tangent:
            self._put(start)
            self._put_columns()
            outcome = self._advance(period, tangent=True)
            outcome = RETURNED if outcome == transitions.TIME_OVER else outcome
        return self._orbit(outcome, period, start, tangent=tangent)

    def _orbit(self, outcome: int, period: float, start: Array, *, tangent: bool) -> Orbit:
        """The motion that has come to a state, with the state and the columns moved to the section
        along the motion, by rounding and by the change of the time of passage."""
        end = self._coordinates()
        count = self._first + len(self._names)
        jacobian = np.zeros((self.size, count))
        if outcome == RETURNED:
            rates = self._rates()
            by_turn = rates[self._rows] * self.scale / float(self._gradient @ rates)
            turn = float(rates[self._psi_row])
            end = end - by_turn * turn
            period -= turn / float(self._gradient @ rates)
            if tangent:
                changes = self._columns()[:, :count]
                turns = self._gradient @ changes + self._changes_of_drive()
                jacobian = changes[self._rows] * self.scale[:, None] - np.outer(by_turn, turns)
        return Orbit(
            outcome=outcome,
            period=period,
            stick_time=0.0,
            counts=NO_EVENTS,
            start=start,
            end=end,
            jacobian=jacobian[:, : self.size].copy(),
            by=jacobian[:, self._first : count].copy(),
        )

    # ---- Points of the section

    def next_passage(self, start: State) -> Array | None:
        """The point of the section to which the motion from a state comes next; None if it stops,
        loses contact or slides steadily."""
        write_state(self._case, start, self._state)
        if motion.phase_of(self._state) != motion.SLIP:
            return None
        passage = self._follow_to_passage()
        return self._coordinates() if passage.outcome == RETURNED else None

    def point(self, state: State) -> Array:
        """The point of the section of a state that lies on it."""
        write_state(self._case, state, self._state)
        return self._coordinates()

    def state(self, x: Array) -> State:
        """The point `x` of the section as a `State` in slip, at time 0."""
        self._put(x)
        return read_state(self._case, self._state)

    def beside_sliding(
        self, sliding: SteadySliding, shape: ComplexArray, distance: float
    ) -> Array | None:
        """The point of the section at a distance from steady sliding on an oscillation with a
        complex `shape`, a column of rows of `SteadySliding.jacobian`; None if the slider does not
        take part in it."""
        modes = mode_arrays(self.parameters)
        _, (_, of_rate), _ = split_rows(modes, shape)
        rate = complex(of_rate)
        if rate == 0:
            return None
        # the phase in which the slider is as fast as the drive, and becomes faster
        turn = -1j * rate.conjugate() / abs(rate)
        disc, (psi, _), height = split_rows(modes, np.real(shape * turn))
        away = self._point_of(disc, float(psi), height)
        return self.sliding_point(sliding) + distance * away / np.linalg.norm(away)

    def sliding_point(self, sliding: SteadySliding) -> Array:
        """Steady sliding in the coordinates of the section, (n,)."""
        disc = (sliding.a, sliding.alpha, sliding.b, sliding.beta)
        height = []
        if self.model.has_compliance:
            height = [height_of_slider(self.parameters, sliding), 0.0]
        return self._point_of(disc, sliding.psi, height)

    def _point_of(self, disc: Sequence[Array], psi: float, height: Sequence[float]) -> Array:
        """Coordinates from a, alpha, b, beta of all modes, psi, and u, u' on a compliant
        contact."""
        a, alpha, b, beta = disc
        diameters = mode_arrays(self.parameters).diameters
        column = np.zeros(self._tangent.rows)
        for places, values in zip(motion.mode_places(diameters), (a, b, alpha, beta), strict=True):
            exists = places >= 0
            column[places[exists]] = values[exists]
        of_slider = self._rows[len(self.diameters) :]
        column[of_slider] = [psi, *height]
        return np.asarray(column[self._rows] * self.scale, dtype=float)

    # ---- The engine's state and columns

    def _put(self, x: Array) -> None:
        """Put the engine's state at a point of the section, in slip at time 0."""
        column = np.zeros(self._tangent.rows)
        column[self._rows] = x / self.scale
        self._put_column(column)
        # psi' falls by the rate of slip
        column[self._rate_row] = self._rates()[self._psi_row]
        self._put_column(column)

    def _put_column(self, column: Array) -> None:
        columns.put_column(self._state, self.model, column)
        motion.put_phase(self._state, motion.SLIP, 1)

    def _coordinates(self) -> Array:
        column = columns.column_of(self._state, self.model)
        return np.asarray(column[self._rows] * self.scale, dtype=float)

    def _rates(self) -> Array:
        """Rates of all rows of a column."""
        before = self._tangent.before
        saltation.rates(self.model, self._state, before)
        return before.reshape(self._tangent.rows, -1)[:, 0].copy()

    def _gradient_of_turn(self) -> Array:
        """Derivatives of psi' by all rows of a column: psi' is linear in the state, of which the
        drive's rate is the constant."""
        gradient = np.zeros(self._tangent.rows)
        for row in (*self._rows, self._rate_row):
            column = np.zeros(self._tangent.rows)
            column[row] = 1.0
            self._put_column(column)
            gradient[row] = self._rates()[self._psi_row] - self.model.Omega
        return gradient

    def _excess(self) -> float:
        """By how much the slider is faster than the drive, -psi', rad/s."""
        return -float(self._rates()[self._psi_row])

    def _acceleration(self) -> float:
        """Rate of `_excess`, rad/s^2."""
        return -float(self._gradient @ self._rates())

    def _columns(self) -> Array:
        """The columns, shape (rows, columns)."""
        blocks = self._tangent.columns // columns.COLUMNS_AT_ONCE
        views = [columns.block_of_columns(self._tangent, block) for block in range(blocks)]
        return np.hstack(views)

    def _put_columns(self) -> None:
        """Set the columns to unit changes of the coordinates, and those of parameters to the change
        of the section with them."""
        changes = np.zeros((self._tangent.rows, self._tangent.columns))
        changes[self._rows, np.arange(self.size)] = 1 / self.scale
        # on the section psi' stays 0, and falls by the rate of slip
        count = self._first + len(self._names)
        turns = self._gradient @ changes[:, :count] + self._changes_of_drive()
        changes[self._rate_row, :count] = turns

        at_once = columns.COLUMNS_AT_ONCE
        for block in range(self._tangent.columns // at_once):
            view = columns.block_of_columns(self._tangent, block)
            view[:] = changes[:, block * at_once : (block + 1) * at_once]
        saltation.slider_rows(self.model, self._state, self._tangent)

    def _changes_of_drive(self) -> Array:
        """Changes of Omega with each column."""
        changes = np.zeros(self._first + len(self._names))
        if "Omega" in self._names:
            changes[self._first + self._names.index("Omega")] = 1.0
        return changes

    # ---- The motion

    def _advance(self, duration: float, *, tangent: bool = False) -> int:
        """Follow the motion for a duration (s); exit code."""
        self._tangent.log[:] = 0.0
        longest = math.inf
        if tangent:
            longest = longest_step(self.model, self.order, 10 * self.tolerance)
        limits = FlightLimits(
            self.order,
            self.tolerance,
            longest,
            duration,
            releases=0,
            may_separate=False,
            tangent=tangent,
        )
        code = integrate_in_pieces(self.model, self._series, self._state, self._tangent, limits)
        stops = self._tangent.log[columns.STICKS] + self._tangent.log[columns.REVERSALS] > 0
        return STOPS if code == transitions.TIME_OVER and stops else code

    def _piece(self) -> float:
        """Time between two looks at the slip speed, s."""
        p = self.parameters
        stiffest = max(
            self.model.stiffness.max(initial=0.0), self.model.stiffness0.max(initial=0.0)
        )
        return math.tau / math.sqrt(max(stiffest, p.k_p / p.m)) / PIECES

    def _follow_to_passage(self) -> _Passage:
        """Follow the motion from the present state to the next passage through the section."""
        p = self.parameters
        piece = self._piece()
        last = math.ceil(LONGEST * math.tau * math.sqrt(p.m / p.k_p) / piece)
        is_slower = False  # whether the slider has been slower than the drive since the start
        for number in range(last):
            motion.copy_state(self._state, self._before)
            excess = self._excess()
            code = self._advance(piece)
            if code != transitions.TIME_OVER:
                return _Passage(code, number * piece)
            later = self._excess()
            if is_slower and later >= 0:
                share = excess / (excess - later)
                return self._stop_at_passage(number * piece, share * piece)
            is_slower = later < 0
        return _Passage(VANISHED, last * piece)

    def _stop_at_passage(self, begin: float, time: float) -> _Passage:
        """Follow the motion from the state before the present piece, which begins at a time (s), to
        the passage within it, whose `time` (s) since then is given in a first approximation."""
        for _ in range(MOST_CORRECTIONS):
            motion.copy_state(self._before, self._state)
            self._advance(time)
            correction = self._excess() / self._acceleration()
            if abs(correction) <= SAME_TIME * self._piece():
                return _Passage(RETURNED, begin + time)
            time -= correction
        return _Passage(transitions.OFF_SECTION, begin + time)
