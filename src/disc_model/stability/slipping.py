"""Cycles that slip all the time: a second section of the return map, and the search near steady sliding.

The section is where the spring in the plane is longest: psi' = 0, and falling.  Where the surface
does not move, the slip speed then rises through the drive's.  A point consists of the modal
coordinates and psi, and on a compliant contact of u, u'.

Such cycles arise in a Hopf bifurcation of steady sliding, and end where they touch zero slip speed.
Where friction falls with the speed they are usually unstable, and separate the motions that come to
stick-slip from those that come to steady sliding.
"""

import math
from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from disc_model.arrays import Array
from disc_model.data.variables import CycleStatus
from disc_model.disc.plate import mode_arrays
from disc_model.engine import columns, saltation, transitions
from disc_model.engine import state as motion
from disc_model.engine.loop import FlightLimits
from disc_model.engine.model import build_state
from disc_model.parameters import Parameters
from disc_model.simulation.states import State, write_state
from disc_model.stability.cycle import SLIPPING, FloquetResult, cycle_of, no_cycle
from disc_model.stability.return_map import (
    RETURNED,
    STOPS,
    VANISHED,
    Counts,
    Orbit,
    Passage,
    ReturnMap,
    integrate_in_pieces,
    longest_step,
    newton,
)
from disc_model.stability.sliding import SteadySliding, split_rows, steady_sliding

PIECES = 16  # in a period of the fastest mode, or of the slider on its spring: none hides a passage
LONGEST = 20.0  # periods of the slider on its spring up to a return
# amplitude of the drive point's rate psi', over Omega, below which a cycle is steady sliding: the
# parameter of a Hopf point, which depends on its square, is known to 1e-8
SMALLEST_CYCLE = 1e-4
MOST_CORRECTIONS = 12  # of the time of a passage
SAME_TIME = 1e-9  # last correction over a piece: what remains is its square
NO_EVENTS = Counts(0, 0, 0, 0, 0)
SMALLEST = 1e-3  # distance from steady sliding at which the search begins, over the deflection
FACTOR = 1.25  # of one distance over that before
MOST_DISTANCES = 60  # up to 500 times the deflection, beyond which the slider has long stopped
HALVINGS = 12  # of the distances up to which the slider does not stop
NEUTRAL = 1e-9  # growth in a return that may be rounding: without damping all motions return
PRECISION = 1e-6  # of the distance from which Newton's method begins, relative to it


class SlippingMap(ReturnMap):
    """The return map of one case to the section on which the spring in the plane is longest; as
    `ReturnMap`, with psi among the coordinates, behind those of the modes."""

    slider = ("psi",)

    def __init__(
        self,
        p: Parameters,
        tol: float = 1e-12,
        parameters: tuple[str, ...] = (),
        *,
        patient: bool = False,
    ) -> None:
        # no motion that separates is followed, as its map is not smooth
        super().__init__(p, tol, parameters, patient=patient)
        self._before = build_state(self.model)
        of_slider = columns.coordinate_rows(self.model, ("psi", "f"))[-2:]
        self._psi_row, self._rate_row = of_slider.tolist()
        motion.copy_state(self._case.start, self._state)
        static = float(np.linalg.norm(self._coordinates()))
        self.deflection = math.hypot(static, p.mu_s * p.N / math.sqrt(p.k_p))

        stiffness = (self.model.stiffness, self.model.stiffness0, [p.k_p / p.m])
        self._piece = math.tau / math.sqrt(np.concatenate(stiffness).max()) / PIECES

        # psi' is linear in the state, of which the drive's rate is the constant
        self._gradient = np.zeros(self._tangent.rows)
        for row in (*self._rows, self._rate_row):
            column = np.zeros(self._tangent.rows)
            column[row] = 1.0
            self._put_column(column)
            self._gradient[row] = self._rates()[self._psi_row] - self.model.Omega

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
        passage = Passage(VANISHED, 0.0, start)
        acceleration = self._acceleration()
        if acceleration > 0:
            passage = self._follow_to_passage()
        outcome, period, end = passage
        amplitude = acceleration * period / math.tau  # of an oscillation about steady sliding
        if outcome == RETURNED and amplitude < SMALLEST_CYCLE * self.model.Omega:
            outcome = VANISHED
        count = self._first + len(self._names)
        jacobian = np.zeros((self.size, count))
        if outcome == RETURNED and tangent:
            self._put(start)
            self._put_columns(count)
            code = self._advance(period, tangent=True)
            outcome = RETURNED if code == transitions.TIME_OVER else code
        if outcome == RETURNED:
            # to the section along the motion: by rounding, and by the change of the time of passage
            rates = self._rates()
            by_turn = rates[self._rows] * self.scale / float(self._gradient @ rates)
            turn = float(rates[self._psi_row])
            end = self._coordinates() - by_turn * turn
            period -= turn / float(self._gradient @ rates)
            if tangent:
                changes = np.hstack(self._blocks())[:, :count]
                turns = self._gradient @ changes + self._changes_of_drive(count)
                jacobian = changes[self._rows] * self.scale[:, None] - np.outer(by_turn, turns)
        by_start, by = jacobian[:, : self.size].copy(), jacobian[:, self._first :].copy()
        return Orbit(outcome, period, 0.0, NO_EVENTS, start, end, by_start, by)

    def next_release(self, start: State) -> Passage:
        """The next passage of the motion from a state through the section; not reached if it stops,
        loses contact or slides steadily."""
        write_state(self._case, start, self._state)
        if motion.phase_of(self._state) != motion.SLIP:
            return Passage(STOPS, start.time, self._coordinates())
        return self._follow_to_passage()

    def point_of(self, rows: Array) -> Array:
        """Coordinates on the section of a state, or of a change of one, in the rows of
        `SteadySliding.jacobian`."""
        modes = mode_arrays(self.parameters)
        (a, alpha, b, beta), slider, height = split_rows(modes, rows)
        column = np.zeros(self._tangent.rows)
        for places, values in zip(
            motion.mode_places(modes.diameters), (a, b, alpha, beta), strict=True
        ):
            exists = places >= 0
            column[places[exists]] = values[exists]
        column[self._rows[len(self.diameters) :]] = [slider[0], *height]
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

    def _rates(self) -> Array:
        """Rates of all rows of a column."""
        before = self._tangent.before
        saltation.rates(self.model, self._state, before)
        return before.reshape(self._tangent.rows, -1)[:, 0].copy()

    def _acceleration(self) -> float:
        """Rate of -psi', rad/s^2."""
        return -float(self._gradient @ self._rates())

    def _blocks(self) -> list[Array]:
        """The columns, in views of the engine's."""
        blocks = self._tangent.columns // columns.COLUMNS_AT_ONCE
        return [columns.block_of_columns(self._tangent, block) for block in range(blocks)]

    def _put_columns(self, count: int) -> None:
        """Set the columns to unit changes of the coordinates, and those of parameters to the change
        of the section with them."""
        changes = np.zeros((self._tangent.rows, self._tangent.columns))
        changes[self._rows, np.arange(self.size)] = 1 / self.scale
        # on the section psi' stays 0, and falls by the rate of slip
        turns = self._gradient @ changes[:, :count] + self._changes_of_drive(count)
        changes[self._rate_row, :count] = turns
        for i, view in enumerate(self._blocks()):
            view[:] = changes[:, i * columns.COLUMNS_AT_ONCE :][:, : columns.COLUMNS_AT_ONCE]
        saltation.slider_rows(self.model, self._state, self._tangent)

    def _changes_of_drive(self, count: int) -> Array:
        """Changes of Omega with each column."""
        changes = np.zeros(count)
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

    def _follow_to_passage(self) -> Passage:
        """Follow the motion from the present state to the next passage through the section, where
        the slider's excess over the drive, -psi', rises through zero."""
        p = self.parameters
        last = math.ceil(LONGEST * math.tau * math.sqrt(p.m / p.k_p) / self._piece)
        is_slower = False  # whether the slider has been slower than the drive since the start
        for number in range(last):
            begin = number * self._piece
            motion.copy_state(self._state, self._before)
            excess = -float(self._rates()[self._psi_row])
            code = self._advance(self._piece)
            if code != transitions.TIME_OVER:
                return Passage(code, begin, self._coordinates())
            later = -float(self._rates()[self._psi_row])
            if is_slower and later >= 0:
                return self._stop_at_passage(begin, excess / (excess - later) * self._piece)
            is_slower = later < 0
        return Passage(VANISHED, last * self._piece, self._coordinates())

    def _stop_at_passage(self, begin: float, time: float) -> Passage:
        """Follow the motion from the state before the present piece, which begins at a time (s), to
        the passage within it, whose `time` (s) since then is given in a first approximation."""
        code = transitions.OFF_SECTION
        for _ in range(MOST_CORRECTIONS):
            motion.copy_state(self._before, self._state)
            self._advance(time)
            correction = -float(self._rates()[self._psi_row]) / self._acceleration()
            if abs(correction) <= SAME_TIME * self._piece:
                code = RETURNED
                break
            time -= correction
        return Passage(code, begin + time, self._coordinates())


def find_slipping_cycle(p: Parameters, tol: float, guess: State | None) -> FloquetResult:
    """The cycle that slips all the time which Newton's method finds near a state in slip, or the
    smallest one round steady sliding."""
    sliding = steady_sliding(p)
    if not sliding.status.exists or min(p.N, p.k_p) <= 0:
        reason = "there is no steady sliding on a spring"
        return no_cycle(p, tol, CycleStatus.NO_CYCLE, reason, SLIPPING)
    map_ = SlippingMap(p, tol)
    orbit = None
    where = "round steady sliding"
    if guess is None:
        orbit = find_slipping_orbit(map_, sliding)
    else:
        where = "near the given state"
        passage = map_.next_release(guess)
        if passage.reached:
            orbit = newton(map_, passage.x)
    if orbit is None:
        without = f"no cycle {where} slips all the time"
        return no_cycle(p, tol, CycleStatus.NO_CYCLE, without, SLIPPING)
    return cycle_of(map_, orbit, SLIPPING)


def find_slipping_orbit(map_: SlippingMap, sliding: SteadySliding) -> Orbit | None:
    """The orbit of the smallest cycle that slips all the time, found along an oscillation of steady
    sliding, the least damped ones first; None if there is none.

    Motions at growing distances from steady sliding approach it or depart from it; a cycle is
    between two of which one grows and one decays.
    """
    equilibrium = map_.point_of(sliding.rows)
    values, vectors = np.linalg.eig(sliding.jacobian)
    oscillating = np.flatnonzero(values.imag > 0)
    for i in oscillating[np.argsort(-values[oscillating].real, kind="stable")]:
        _, (_, rate), _ = split_rows(mode_arrays(map_.parameters), vectors[:, i])
        if rate == 0:  # the slider does not take part in it
            continue
        # the phase in which the slider is as fast as the drive, and becomes faster
        away = map_.point_of(np.real(vectors[:, i] * (-1j * np.conj(rate) / abs(rate))))
        away = away / np.linalg.norm(away)

        def growth(distance: float, away: Array = away) -> float:
            """Logarithm of the distance from the equilibrium after a return over that before, along
            the latter; nan if the motion does not return."""
            x = equilibrium + distance * away
            orbit = map_.evaluate(x, tangent=False)
            before = x - equilibrium
            share = float((orbit.end - equilibrium) @ before) / float(before @ before)
            return math.log(share) if orbit.returned and share > 0 else math.nan

        bracket = _bracket(growth, SMALLEST * map_.deflection)
        if bracket is None:
            continue
        distance = float(brentq(growth, *bracket, rtol=PRECISION))
        orbit = newton(map_, equilibrium + distance * away)
        if orbit is not None:
            return orbit
    return None


def _bracket(growth: Callable[[float], float], first: float) -> tuple[float, float] | None:
    """Two distances of which one grows and one decays, by more than rounding: neighbours, or up to
    that at which the slider stops; None if there are none."""
    low = first
    before = growth(low)
    high = FACTOR * low
    stopped = math.inf
    for _ in range(MOST_DISTANCES + HALVINGS):
        after = growth(high)
        if math.isnan(before) or (stopped < math.inf and high - low < low / 2**HALVINGS):
            return None
        if math.isnan(after):
            stopped = high
        elif before * after <= 0 and max(abs(before), abs(after)) > NEUTRAL:
            return low, high
        else:
            low, before = high, after
        high = FACTOR * low if math.isinf(stopped) else 0.5 * (low + stopped)
    return None
