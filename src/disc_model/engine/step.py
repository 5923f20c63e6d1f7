"""The next step of a motion: the series of its phase, the step's length, and the event that ends
it."""

from typing import NamedTuple

from .contact import slip_growth
from .dense_output import CLOSED_FORM
from .jit import helper, inlined
from .model import drive_now, is_rigid, set_course
from .roots import NO_ROOT, first_root, set_powers
from .separation import separation_series
from .series import load_state
from .slip import slip_series
from .state import (
    DIRECTION,
    FORCE,
    IN_A_ROW,
    KNOWN,
    KNOWN_FORCE,
    PHASE,
    PHI_RATE,
    PROPAGATED,
    SEPARATION,
    SLIP,
    STICK,
    TIME,
    TIME_LOW,
)
from .step_size import step_size
from .stick import stick_series
from .stick_modes import LONGEST_STICK
from .stick_propagator import closed_form_length
from .transitions import (
    AT_REST,
    CONSISTENT,
    CONTACT_LOST,
    GAP_CLOSED,
    NO_SOLUTION,
    NON_FINITE,
    NOTHING,
    PAINLEVE_MARGIN,
    RELEASE_BACKWARD,
    RELEASE_FORWARD,
    ROUNDING,
    force_error,
    gap_error,
    inplane_force_per_radius,
    slip_error,
    usual_denominator,
)

# ``x[PROPAGATED]`` after the closed form of stick, which usually ends shortly before the release:
# the next step is short, and a series of low order is enough for it.
JUST_PROPAGATED = 2.0
ORDER_BEFORE_RELEASE = 10
# Time units after its beginning in which a phase's event functions are rounding: a run that is cut
# so soon continues with the roots that are known there.
JUST_BEGUN = 1e-9
# More events without the clock advancing end a motion: a guard, not a tuned interval.
MAX_EVENTS_IN_A_ROW = 200


class Step(NamedTuple):
    """A step that is planned but not taken."""

    code: int  # CONSISTENT, or the exit code with which the motion ends before it
    order: int  # of the series, or CLOSED_FORM
    length: float  # time units
    cause: int  # of the event at its end, or NOTHING


# ---- Planning a step


@inlined
def closed_form_length_within(model, series, state, left):
    """Return the length of a step over stick in closed form, at most ``left`` time units; 0 if
    there is none."""
    if state.x[PHASE] == STICK and state.x[PROPAGATED] == 0.0:
        return min(closed_form_length(model, series, state), left)
    return 0.0


@inlined
def sufficient_order(model, state, order):
    """Return the order of a step's series: ``order``, or less just before a release."""
    just_propagated = state.x[PROPAGATED] == JUST_PROPAGATED
    if just_propagated and is_rigid(model):
        return ORDER_BEFORE_RELEASE
    return order


@inlined
def series_step(model, series, state, order, tolerance, longest, left):
    """Return the next step by the series of the phase, which enter ``series``.

    order, tolerance : of the series
    longest : largest number of time units in which small changes are still followed; inf if the
        motion is followed alone
    left : time units to the end
    """
    phase = state.x[PHASE]
    denominator = expand(model, series, state, order)
    if denominator <= PAINLEVE_MARGIN:
        return Step(NO_SOLUTION, order, 0.0, NOTHING)
    length = step_size(model, series, order, tolerance, phase)
    if not length > 0.0:
        return Step(NON_FINITE, order, 0.0, NOTHING)
    if model.has_varying_friction and phase == SLIP:
        # where friction falls or rises steeply, a change of g grows or decays faster than the fastest
        # motion
        growth = slip_growth(model, series, state.x[DIRECTION])
        longest /= max(growth * model.unit, 1.0)
    longest = min(min(length, longest), left)
    length, cause = first_event(model, series, state, order, longest, tolerance)
    return Step(CONSISTENT, order, length, cause)


@inlined
def expand(model, series, state, order):
    """Fill the series of the current phase. Returns the denominator of P in slip over that without
    friction, else 1."""
    load_state(model, series, state)
    phase = state.x[PHASE]
    if phase == SLIP:
        denominator = slip_series(model, series, order, state.x[DIRECTION])
        return denominator / usual_denominator(model)
    if phase == SEPARATION:
        separation_series(model, series, order)
    else:
        stick_series(model, series, order)
    return 1.0


# ---- The event that ends a step


@inlined
def first_event(model, series, state, order, x_end, tolerance):
    """Return place and cause of the phase's end within (0, x_end]: (x, cause), or (x_end, NOTHING);
    in time units.

    A run that was cut just after an event knows no root at its start, but its first coefficients
    are still errors of the state at the event, by the rounding and the ``tolerance`` of the series.
    They do not end the phase that has just begun: the first coefficient beyond them decides.
    """
    set_powers(series.powers, x_end, order)
    phase = state.x[PHASE]
    known_force = 0
    if model.has_compliance:  # there the contact force, too, starts at zero
        known_force = int(state.x[KNOWN_FORCE])
    if phase == SEPARATION:
        return _end_of_separation(model, series, state, order, x_end, tolerance)
    if phase == SLIP:
        end = _end_of_slip(model, series, state, order, x_end, tolerance)
        if not model.bonded:
            end = _end_of_contact(model, series, state, known_force, order, end, tolerance)
        return end
    return _end_of_stick(model, series, state, order, x_end, known_force, tolerance)


@inlined
def _earlier(series, c, known, n, cause, end):
    """Return place and cause of the first root of the event function ``c``, or ``end`` if there is
    none before.

    known : multiplicity of its root at the start
    n : its degree
    end : place and cause of the earliest end found so far; ``series.powers`` are those of the place
    """
    x_end, _ = end
    x = first_root(c, known, n, x_end, series.powers, series.roots)
    if x == NO_ROOT:
        return end
    set_powers(series.powers, x, n)
    return x, cause


@inlined
def _end_of_separation(model, series, state, order, x_end, tolerance):
    """As `first_event`: the gap closes."""
    gap = series.switch
    known = int(state.x[KNOWN])
    end = _earlier(series, gap, known, order, GAP_CLOSED, (x_end, NOTHING))
    if end[1] == GAP_CLOSED and known == 0:
        known = _zeros_of_gap(model, series, state, tolerance)
        if known > 0 and gap[known] > 0.0:
            set_powers(series.powers, x_end, order)
            return _earlier(series, gap, known, order, GAP_CLOSED, (x_end, NOTHING))
    return end


@helper
def _zeros_of_gap(model, series, state, tolerance):
    """Return how many first coefficients of the gap are zero, but for their errors: see
    `first_event`."""
    gap = series.switch
    rounding = gap_error(model, state, 0, 0.0)
    closing = 0.0
    if not model.has_compliance and gap[3] > 0.0:
        # the time for which an error of the acceleration closes the gap, before its rate opens it
        closing = gap_error(model, state, 2, tolerance) / gap[3]
    zeros = 0
    while zeros < 3 and gap[zeros] <= rounding:
        error = gap_error(model, state, zeros, tolerance)
        if zeros < 2:
            error += gap[3] * closing ** (3 - zeros)
        if gap[zeros] < -error:
            break
        zeros += 1
    return zeros


@inlined
def _end_of_slip(model, series, state, order, x_end, tolerance):
    """As `first_event`: g reaches 0."""
    known = int(state.x[KNOWN])
    end = _earlier(series, series.switch, known, order, AT_REST, (x_end, NOTHING))
    if end[1] == AT_REST and known == 0:
        known = _zeros_of_slip(model, series, state, tolerance)
        if known > 0 and series.switch[known] > 0.0:
            set_powers(series.powers, x_end, order)
            return _earlier(series, series.switch, known, order, AT_REST, (x_end, NOTHING))
    return end


@helper
def _zeros_of_slip(model, series, state, tolerance):
    """Return how many first coefficients of g in slip are zero, but for their errors: see
    `first_event`."""
    usual_speed = drive_now(model, state)
    rounding = slip_error(model, state, 0.0)
    error = slip_error(model, state, tolerance)
    least = -error - tolerance * usual_speed
    greatest = rounding + ROUNDING * usual_speed
    if not least <= series.switch[0] <= greatest:
        return 0
    return 2 if -error <= series.switch[1] <= rounding else 1


@inlined
def _end_of_contact(model, series, state, known, order, end, tolerance):
    """As `first_event`, where P = 0 ends contact before ``end``, the earliest end found so far.

    known : multiplicity of the root of P at the start
    """
    found = _earlier(series, series.P, known, order - 1, CONTACT_LOST, end)
    if model.has_compliance and found[1] == CONTACT_LOST and known == 0 and series.P[1] > 0.0:
        just_begun = abs(series.P[0]) <= force_error(model, state, tolerance)
        if just_begun:
            set_powers(series.powers, end[0], order)
            return _earlier(series, series.P, 1, order - 1, CONTACT_LOST, end)
    return found


@inlined
def _end_of_stick(model, series, state, order, x_end, known_force, tolerance):
    """As `first_event`: friction is overcome in either direction, or contact is lost."""
    end = x_end, NOTHING
    known_release = known_force
    if not model.bonded and _stays_unloaded(model, series, state):
        # P = 0 and the friction limit coincide, and it is contact that ends
        end = _end_of_contact(model, series, state, known_force, order, end, tolerance)
        if not model.has_normal_force:
            return end
        # the slope of the disc may pull: here P is no factor of the release functions
        known_release = 0
    end = _earlier(series, series.switch, known_release, order - 1, RELEASE_FORWARD, end)
    # under the vertical force the pull only grows; a bent disc's slope can turn it, a surface that
    # moves, or the damper of a slowing drive
    turned = series.switch2[0] < series.switch[0]
    if model.has_normal_force or model.has_moving_surface or model.has_ramp or turned:
        end = _earlier(series, series.switch2, known_release, order - 1, RELEASE_BACKWARD, end)
    # friction may hold although contact ends: without any, or on a slope so steep that it holds the
    # slider down
    without = model.mu_s == 0.0
    if not model.bonded and (without or (model.has_compliance and model.has_normal_force)):
        end = _end_of_contact(model, series, state, known_force, order, end, tolerance)
    return end


@inlined
def _stays_unloaded(model, series, state):
    """Return whether nothing pulls at a sticking slider throughout the step but the disc's slope."""
    if (model.k_p + model.c_p) * model.Omega_rate != 0.0:
        return False  # the drive begins to move, on a ramp
    if model.has_moving_surface:
        return series.hold[0] == 0.0 and series.hold[1] == 0.0
    undriven = model.k_p * model.Omega == 0.0
    return undriven and inplane_force_per_radius(model, state) == 0.0


# ---- The clock


@inlined
def advance_clock(model, state, step):
    """Advance the clock by a step, by a compensated sum, and with it drive and load of a ramp.
    Returns whether it has moved."""
    x = state.x
    if step.length > JUST_BEGUN:
        x[KNOWN] = 0.0
        x[KNOWN_FORCE] = 0.0
    x[FORCE] = 0.0
    x[PROPAGATED] = _propagated(step)
    before = x[TIME]
    dt = step.length * model.unit + x[TIME_LOW]
    new = before + dt
    change = new - before
    x[TIME_LOW] = (before - (new - change)) + (dt - change)
    x[TIME] = new
    set_course(model, state)
    return new != before


@inlined
def _propagated(step):
    """``x[PROPAGATED]`` after a step: 0 if the closed form may be used again."""
    if step.length >= LONGEST_STICK:
        return 0.0
    return JUST_PROPAGATED if step.order == CLOSED_FORM else 1.0


@inlined
def settle(state):
    """Set g to zero if it has reached that within rounding at the end of a run: a motion that
    continues from here begins with that event."""
    x = state.x
    if x[PHASE] == SLIP and x[DIRECTION] * x[PHI_RATE] < 0.0:
        x[PHI_RATE] = 0.0


@inlined
def stalls(state, clock_moved):
    """Count an event, and return whether too many have followed each other at one instant."""
    x = state.x
    x[IN_A_ROW] = 0.0 if clock_moved else x[IN_A_ROW] + 1.0
    return x[IN_A_ROW] > MAX_EVENTS_IN_A_ROW
