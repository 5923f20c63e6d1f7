"""Cycles that slip all the time: a second section of the return map, and the search near steady sliding.

The section is where the slip speed rises through the drive's: f = Omega. Where the surface does not
move, the spring in the plane is longest there.  A point consists of the modal coordinates and psi,
and on a compliant contact of u, u'.

Such cycles arise in a Hopf bifurcation of steady sliding, and end where they touch zero slip speed.
Where friction falls with the speed they are usually unstable, and separate the motions that come to
stick-slip from those that come to steady sliding.
"""

import math

import numpy as np
from scipy.optimize import brentq

from disc_model.arrays import Array
from disc_model.data.variables import CycleStatus
from disc_model.disc.plate import mode_arrays
from disc_model.engine import columns, saltation, section, transitions
from disc_model.engine import state as motion
from disc_model.engine.loop import FlightLimits
from disc_model.engine.model import build_state
from disc_model.parameters import Parameters
from disc_model.simulation.states import State, read_state, write_state
from disc_model.stability.cycle import SLIPPING, FloquetResult, cycle_of, no_cycle
from disc_model.stability.return_map import (
    RETURNED,
    STOPS,
    VANISHED,
    Counts,
    Orbit,
    Passage,
    ReturnMap,
    longest_step,
    newton,
)
from disc_model.stability.sliding import SteadySliding, split_rows, steady_sliding

PIECES = 16  # in a period of the fastest mode, or of the slider on its spring: none hides a passage
LONGEST = 20.0  # periods of the slider on its spring up to a return
# amplitude of f, over Omega, below which a cycle is steady sliding: the
# parameter of a Hopf point, which depends on its square, is known to 1e-8
SMALLEST_CYCLE = 1e-4
SAME_TIME = 1e-9  # error of a passage over a piece: what remains is its square
NO_EVENTS = Counts(0, 0, 0, 0, 0)
SMALLEST = 1e-3  # distance from steady sliding at which the search begins, over the deflection
FACTOR = 1.25  # of one distance over that before
NEUTRAL = 1e-9  # growth in a return that may be rounding: without damping all motions return
PRECISION = 1e-6  # of the distance from which Newton's method begins, relative to it


class SlippingMap(ReturnMap):
    """The return map of one case to the section on which the slip speed rises through the drive's; as
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
        # none that separates is followed, as its map is not smooth
        super().__init__(p, tol, parameters, patient=patient)
        self._before = build_state(self.model)
        self._rate_row = int(columns.coordinate_rows(self.model, ("f",))[-1])
        motion.copy_state(self._case.start, self._state)
        static = float(np.linalg.norm(self._coordinates()))
        self.deflection = math.hypot(static, p.mu_s * p.N / math.sqrt(p.k_p))

        stiffness = (self.model.stiffness, self.model.stiffness0, [p.k_p / p.m])
        self._piece = math.tau / math.sqrt(np.concatenate(stiffness).max()) / PIECES

        # changes of f on the section with each column
        self._moves = np.zeros(self._tangent.columns)
        if "Omega" in parameters:
            self._moves[self._first + parameters.index("Omega")] = 1.0

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
        acceleration = self._rates()[self._rate_row]
        outcome, period, end = Passage(VANISHED, 0.0, start)
        if acceleration > 0:
            outcome, period, end = self._follow_to_passage()
        # the amplitude of an oscillation about steady sliding
        smallest = math.tau * SMALLEST_CYCLE * self.model.Omega
        if outcome == RETURNED and acceleration * period < smallest:
            outcome = VANISHED
        count = self._first + len(self._names)
        jacobian = np.zeros((self.size, count))
        if outcome == RETURNED and tangent:
            self._put(start)
            self._put_columns()
            outcome = self._advance(period, tangent=True)
        if outcome == RETURNED:
            # to the section along the motion: by rounding, and by the change of the time of passage
            rates = self._rates()
            delay = self._excess() / rates[self._rate_row]
            end = self._coordinates() - delay * rates[self._rows] * self.scale
            period -= delay
            if tangent:
                changes = np.hstack(self._blocks())[:, :count]
                delays = (changes[self._rate_row] - self._moves[:count]) / rates[self._rate_row]
                along = changes[self._rows] - np.outer(rates[self._rows], delays)
                jacobian = along * self.scale[:, None]
        by_start, by = jacobian[:, : self.size].copy(), jacobian[:, self._first :].copy()
        return Orbit(outcome, period, 0.0, NO_EVENTS, start, end, by_start, by)

    def next_release(self, start: State) -> Passage:
        """The next passage of the motion from a state through the section; not reached if it stops,
        loses contact or slides steadily."""
        write_state(self._case, start, self._state)
        if motion.phase_of(self._state) != motion.SLIP:
            return Passage(STOPS, start.time, self._coordinates())
        return self._follow_to_passage()

    def state(self, x: Array) -> State:
        """The point `x` of the section as a `State` in slip, at time 0."""
        self._put(x)
        return read_state(self._case, self._state)

    # ---- The engine's state and columns

    def _put(self, x: Array) -> None:
        """Put the engine's state at a point of the section, in slip at time 0."""
        column = np.zeros(self._tangent.rows)
        column[self._rows] = x / self.scale
        column[self._rate_row] = self.model.Omega
        columns.put_column(self._state, self.model, column)
        motion.put_phase(self._state, motion.SLIP, 1)

    def _rates(self) -> Array:
        """Rates of all rows of a column."""
        before = self._tangent.before
        saltation.rates(self.model, self._state, before)
        return before.reshape(self._tangent.rows, -1)[:, 0].copy()

    def _excess(self) -> float:
        """The slip speed over the drive's, rad/s."""
        return float(columns.column_of(self._state, self.model)[self._rate_row] - self.model.Omega)

    def _blocks(self) -> list[Array]:
        """The columns, in views of the engine's."""
        blocks = self._tangent.columns // columns.COLUMNS_AT_ONCE
        return [columns.block_of_columns(self._tangent, block) for block in range(blocks)]

    def _put_columns(self) -> None:
        """Set the columns to unit changes of the coordinates, and those of parameters to the change
        of the section with them."""
        changes = np.zeros((self._tangent.rows, self._tangent.columns))
        changes[self._rows, np.arange(self.size)] = 1 / self.scale
        changes[self._rate_row] = self._moves
        for i, view in enumerate(self._blocks()):
            view[:] = changes[:, i * columns.COLUMNS_AT_ONCE :][:, : columns.COLUMNS_AT_ONCE]
        saltation.slider_rows(self.model, self._state, self._tangent)

    # ---- The motion

    def _advance(self, duration: float, *, tangent: bool = False) -> int:
        """Follow the motion for a duration (s); `RETURNED`, or why it does not slip on until then."""
        log = self._tangent.log
        log[:] = 0.0
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
        code = section.integrate(self.model, self._series, self._state, self._tangent, limits)
        if code != transitions.TIME_OVER:
            return code
        if log[columns.STICKS] + log[columns.REVERSALS] > 0:
            return STOPS
        return RETURNED

    def _follow_to_passage(self) -> Passage:
        """Follow the motion from the present state to the next passage through the section."""
        p = self.parameters
        piece = self._piece
        last = math.ceil(LONGEST * math.tau * math.sqrt(p.m / p.k_p) / piece)
        is_slower = False  # whether the slider has been slower than the drive since the start

        def excess_after(time: float) -> float:
            motion.copy_state(self._before, self._state)
            self._advance(time)
            return self._excess()

        for number in range(last):
            motion.copy_state(self._state, self._before)
            code = self._advance(piece)
            if code != RETURNED:
                return Passage(code, number * piece, self._coordinates())
            excess = self._excess()
            if is_slower and excess >= 0:
                time = float(brentq(excess_after, 0.0, piece, xtol=SAME_TIME * piece))
                excess_after(time)
                return Passage(RETURNED, number * piece + time, self._coordinates())
            is_slower = excess < 0
        return Passage(VANISHED, last * piece, self._coordinates())


def find_slipping_cycle(p: Parameters, tol: float, guess: State | None) -> FloquetResult:
    """The cycle that slips all the time which Newton's method finds near a state in slip, or the
    smallest one round steady sliding."""
    sliding = steady_sliding(p)
    if not sliding.status.exists or min(p.N, p.k_p) <= 0:
        reason = "there is no steady sliding on a spring"
        return no_cycle(p, tol, CycleStatus.NO_CYCLE, reason, SLIPPING)
    map_ = SlippingMap(p, tol)
    orbit = None
    where = "near the given state"
    if guess is None:
        where = "round steady sliding"
        orbit = find_slipping_orbit(map_, sliding)
    elif (passage := map_.next_release(guess)).reached:
        orbit = newton(map_, passage.x)
    if orbit is None:
        reason = f"no cycle {where} slips all the time"
        return no_cycle(p, tol, CycleStatus.NO_CYCLE, reason, SLIPPING)
    return cycle_of(map_, orbit, SLIPPING)


def find_slipping_orbit(map_: SlippingMap, sliding: SteadySliding) -> Orbit | None:
    """The orbit of the smallest cycle that slips all the time, found along an oscillation of steady
    sliding, the least damped ones first; None if there is none.

    Motions at growing distances from steady sliding approach it or depart from it; a cycle is
    between two of which one grows, or stops, and one decays.
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
            """The distance from the equilibrium after a return over that before, along the latter, less
            one; 1 if the motion does not return, 0 where only rounding grows."""
            before = distance * away
            orbit = map_.evaluate(equilibrium + before, tangent=False)
            share = float((orbit.end - equilibrium) @ before) / distance**2
            grown = 1.0
            if orbit.returned:
                grown = min(share - 1, 1.0)
            if abs(grown) > NEUTRAL:
                return grown
            return 0.0

        low = SMALLEST * map_.deflection
        before = growth(low)
        while before * (after := growth(FACTOR * low)) >= 0 and after < 1:
            low *= FACTOR
            before = after
        if before * after >= 0:
            continue
        distance = brentq(growth, low, FACTOR * low, xtol=PRECISION * low)
        orbit = newton(map_, equilibrium + distance * away)
        if orbit is not None:
            return orbit
    return None
