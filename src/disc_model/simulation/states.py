"""States of motions, the disc's deflection in them, and those of the engine: a case's constants,
states written and read, order and tolerance of series."""

from __future__ import annotations

import dataclasses
import math
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, lru_cache, partial
from typing import Annotated, Any

import numpy as np
from pydantic import InstanceOf, PlainSerializer, PlainValidator

from disc_model.arrays import Array, EqualByValue
from disc_model.data.variables import PHASES
from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import (
    modal_damping,
    mode_arrays,
    mode_shapes,
    modes_at_point,
    radial_range,
    tangential_amplitudes,
)
from disc_model.disc.stretched import stretched
from disc_model.engine import state as motion
from disc_model.engine.model import Contact, DiscModes, Model, build_model, build_state, flags_of
from disc_model.engine.series import Series, build_series
from disc_model.engine.state import SEPARATION, SLIP, STICK, EngineState
from disc_model.errors import as_text, require, rule_of_choice
from disc_model.parameters import Parameters
from disc_model.units import Unit, checked, is_number, is_quantity

MODAL = ("a", "b", "alpha", "beta")
"""Names of the variables of a state with one value a mode."""
PLAIN = ("time", "time_low", "psi", "f", "u", "u_velocity", "surface_turn")
"""Names of its scalars."""
# relative to the disc's deflection: far above rounding, far below any intended difference
SAME_HEIGHT = 1e-9
INSIDE = 1e-5  # likewise, by which errors of the loosest series may put a slider into the disc
SAME_SPEED = 1e-9  # relative to the drive's: a slip by less against its direction is rounding too


Modal = Annotated[
    Array, PlainValidator(partial(np.array, dtype=float)), PlainSerializer(np.ndarray.tolist)
]
"""An array of numbers, a list in files."""


@dataclass(frozen=True, eq=False, repr=False)
class State(EqualByValue):
    """State of the system in the slider's frame. States are equal if all of their values are.

    Attributes
    ----------
    time : s
    phase : "stick", "slip" or "separation"
    direction : sign of the slip speed r_0 f - v_s in slip, 0 otherwise
    psi : rad, drive point's angle ahead of the slider
    f : rad/s, the slider's angular speed; in stick that of the disc's surface under it, v_s / r_0, which is 0 unless
        the surface moves
    u, u_velocity : m, m/s, the slider's height and velocity. In rigid contact they are those of the disc under it: an
        initial state with another u is refused, and its u_velocity is ignored
    a, b, alpha, beta : shape (n_modes,), in the order of `plate_modes`: modal displacements (m sqrt(kg)) and velocities
        along and across the slider's direction; b = beta = 0 for modes without nodal diameter
    surface_turn : rad, by which the disc's surface has moved under the slider, the integral of v_s / r_0; 0 unless
        friction acts on a surface that moves
    drive_angle : rad, by which the drive point has turned since the time 0, ramps included. None stands for Omega time
    case_key : the case in which it was computed; in any other case, the phase after an event is determined anew
    mode_amplitudes : kg^-1/2, shape (n_modes,), psi of the `plate_modes` to which a, b, alpha and beta belong. A case
        with other amplitudes refuses the state. None if the state was made by hand

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=15.1)
    >>> first = dm.simulate(case, 0.5)
    >>> second = dm.simulate(case, duration=0.5, initial_state=first.final_state)
    >>> len(first.events) + len(second.events) == len(dm.simulate(case, 1).events)
    True
    >>> pushed = dm.simulate(case, 1, initial_state=dm.simulate(case, 1e-6).final_state.replace(psi=0.001))
    """

    time: float
    phase: str
    direction: int
    psi: float
    f: float
    u: float
    u_velocity: float
    a: Modal
    b: Modal
    alpha: Modal
    beta: Modal
    time_low: float = 0.0
    surface_turn: float = 0.0
    drive_angle: float | None = None
    case_key: str = ""
    mode_amplitudes: Modal | None = None
    _roots: tuple[int, int] = (0, 0)  # multiplicity at this instant, `engine.state.known_roots`

    def replace(self, **changes: Any) -> State:
        """Return a copy with some values changed.

        A new time is exact: it sets `time_low` to 0 and `drive_angle` to None.  Any change but of
        these three separates the state from the case in which it was computed, and empties
        `case_key`.
        """
        implied: dict[str, Any] = {}
        if "time" in changes:
            implied |= {"time_low": 0.0, "drive_angle": None}
        if not changes.keys() <= {"time", "time_low", "drive_angle"}:
            implied["case_key"] = ""
        plain = {name: float(x) for name, x in changes.items() if name in PLAIN}
        return dataclasses.replace(self, **implied | changes | plain)

    def __repr__(self) -> str:
        return (
            f"State(time={self.time:.9g} s, {self.phase}, psi={self.psi:.6g} rad, f={self.f:.6g} rad/s, "
            f"u={self.u:.6g} m, u_velocity={self.u_velocity:.6g} m/s, {len(self.a)} modes)"
        )

    def __str__(self) -> str:
        """What names it in a row of a table."""
        return f"State({self.time:.6g} s, {self.phase})"

    def material_angle(self, case: Parameters) -> float:
        """Angle on the disc of the material point under the slider, rad, about which modal
        coordinates are resolved: that of the drive point, less psi and `surface_turn`."""
        turned = self.drive_angle
        if turned is None:
            turned = case.Omega * self.time
        return turned - self.psi - self.surface_turn


def static_start(p: Parameters) -> State:
    """The static start: static equilibrium under the preload, in stick, spring relaxed, at time
    0."""
    case = engine_case(p)
    return read_state(case, case.start)


def perturb(
    p: Parameters, state: State, u: float = 0.0, u_velocity: float = 0.0, f: float = 0.0
) -> State:
    """A state with perturbed coordinates of the slider; the disc under the slider moves with it.

    u : m, with the disc's deflection under a steady force: a_l increases by u (psi_l/omega_l^2) / sum psi^2/omega^2
    u_velocity : m/s, as after a blow at the slider: alpha_l increases by u_velocity psi_l / sum psi^2
    f : rad/s; a sticking slider then slips, and one whose f becomes 0 sticks
    """
    modes = mode_arrays(p)
    give = modes.psi / modes.omega**2
    changes: dict[str, Any] = {
        "a": state.a + u * give / (modes.psi @ give),
        "alpha": state.alpha + u_velocity * modes.psi / (modes.psi @ modes.psi),
        "u": state.u + u,
        "u_velocity": state.u_velocity + u_velocity,
        "f": state.f + f,
    }
    if f and state.phase != "separation":
        rate = slip_rate(p, state) + f
        changes |= {"phase": "slip" if rate else "stick", "direction": int(np.sign(rate))}
    return state.replace(**changes)


def slip_rate(p: Parameters, state: State) -> float:
    """Slip speed over r_0, rad/s: the slider's angular speed f less that of the surface under it."""
    return state.f - surface_rate(p, state)


def surface_rate(p: Parameters, state: State) -> float:
    """Speed of the disc's surface under the slider over r_0, rad/s."""
    return float(engine_case(p).surface @ state.beta)


def _numbers(values: object) -> Array:
    """One number or several as an array of shape (n,); raises ValueError unless they are finite."""
    array = np.atleast_1d(np.asarray(values))
    plain = array.ndim == 1 and array.dtype.kind in "fiu" and np.isfinite(array).all()
    if is_quantity(values) or not plain:  # numpy would leave the unit out
        raise ValueError("must be finite numbers")
    return array.astype(float)


Times = Annotated[Any, PlainValidator(_numbers), Unit("s")]
Radii = Annotated[Any, PlainValidator(_numbers), Unit("m")]
Angles = Annotated[Any, PlainValidator(_numbers), Unit("rad")]
"""Arrays of numbers, shape (n,), in these units."""


@checked
def deflection(
    case: Parameters,
    states: InstanceOf[State] | Sequence[InstanceOf[State]],
    r: Radii,
    theta: Angles,
) -> Any:
    """Displacement w(r, theta, t) of the whole disc, upward, Eq. (15).

    Parameters
    ----------
    case : the case
    states : one state, or several, such as `snapshots` returns
    r : m, radii from a to b, or within those at which a table gives shapes, shape (n_r,)
    theta : rad, angles fixed to the disc, shape (n_theta,); the slider starts at 0

    Returns
    -------
    xarray.DataArray
        In m, over time, r and theta.

    Raises
    ------
    ParameterError
        If a radius is off the disc, an angle is not finite, a state has other modes, or the disc has no shapes.

    Examples
    --------
    >>> import disc_model as dm
    >>> import numpy as np
    >>> case = dm.Parameters(N=385, Omega=15.1)
    >>> w = dm.deflection(case, dm.snapshots(case, [0.0, 0.1]), np.linspace(0.044, 0.12, 20), np.linspace(0, 6.28, 73))
    >>> dict(w.sizes)
    {'time': 2, 'r': 20, 'theta': 73}
    """
    import xarray as xr

    modes = mode_arrays(case)
    low, high = radial_range(case)
    given = [states] if isinstance(states, State) else states
    rule = f"must be within {as_text(low)} and {as_text(high)}"
    require((np.all((low <= r) & (r <= high)), "r", r.tolist(), rule))
    for state in given:
        rule = f"must be states of the case, with {len(modes.psi)} modes"
        require((belongs_to(state, modes.psi), "states", state, rule))
    shapes = mode_shapes(case, r).T
    w = []
    for state in given:
        turn = np.multiply.outer(modes.diameters, theta - state.material_angle(case))
        w.append(shapes @ (state.a[:, None] * np.cos(turn) + state.b[:, None] * np.sin(turn)))
    coords = {
        "time": ("time", [x.time for x in given], {"units": "s", "long_name": "time"}),
        "r": ("r", r, {"units": "m", "long_name": "radius"}),
        "theta": ("theta", theta, {"units": "rad", "long_name": "angle fixed to the disc"}),
    }
    attrs = {"units": "m", "long_name": "displacement of the disc; from the undeformed disc"}
    return xr.DataArray(np.array(w), coords, ("time", "r", "theta"), name="w", attrs=attrs)


# ---- Conversion of `Parameters` and `State` to the engine's lanes and back

# Arrays to which the engine writes in one run: its state, the state at a trial time ahead, Taylor
# series of one step
Workspace = tuple[EngineState, EngineState, Series]


@dataclass(frozen=True, eq=False)
class EngineCase:
    """Constants of a case for the engine, shared by all runs of the case."""

    key: str  # `State.case_key`
    model: Model
    kind: tuple[Any, ...]  # `flags_of` the model: they determine the types of all arguments
    start: EngineState  # the static start
    amplitudes: np.ndarray  # `State.mode_amplitudes`
    # indices in a, b, alpha, beta of all modes of what exists: no b, beta without nodal diameter
    present: np.ndarray
    places: np.ndarray  # their indices in `EngineState.disc`
    # matrix from there to u, u' (without the slope's share), slope B and v_s / r_0 under the slider
    point: np.ndarray
    surface: np.ndarray  # shape (n_modes,), from beta to v_s / r_0
    # workspaces that no run uses at present, by the order of their series
    idle: defaultdict[int, list[Workspace]]


@lru_cache(maxsize=32)  # with their workspaces tens of kilobytes each, megabytes with 1000 modes
def engine_case(p: Parameters) -> EngineCase:
    """The engine's constants of a case, cached for equal parameters."""
    modes = mode_arrays(p)
    tangential = tangential_amplitudes(p)
    model = build_model(
        DiscModes(
            diameters=modes.diameters,
            omega=modes.omega,
            psi=modes.psi,
            psi_at_point=modes_at_point(p).psi,
            damping=modal_damping(p),
            tangential=tangential,
            **stretched(p)._asdict(),
        ),
        {name: getattr(p, name) for name in Model._fields if name in Parameters.model_fields},
        Contact(
            bonded=p.contact == "bilateral",
            compliance=contact_compliance(p),
            normal=p.contact_force == "normal",
            friction_decay=p.friction_decay,
            exponential=p.friction_law == "exponential",
            viscous_friction=p.viscous_friction,
        ),
    )
    pairs = np.flatnonzero(modes.diameters > 0)
    places = motion.mode_places(modes.diameters)
    present = np.flatnonzero(places >= 0)
    start = build_state(model)
    point = np.zeros((4, len(start.disc)))
    point[0, places[0]] = point[1, places[2]] = modes.psi
    point[2, places[1, pairs]] = (modes.diameters * modes.psi)[pairs]
    surface = tangential / p.r_0
    point[3, places[3, pairs]] = surface[pairs]
    return EngineCase(
        key=p.key,
        model=model,
        kind=flags_of(model),
        start=start,
        amplitudes=modes.psi,
        present=present,
        places=places.ravel()[present],
        point=point,
        surface=surface,
        idle=defaultdict(list),
    )


def take_workspace(case: EngineCase, order: int) -> Workspace:
    """A workspace at the static start; the run gives it back to `EngineCase.idle`, as making one
    takes 30 steps."""
    try:  # in one step: several threads may take one
        workspace = case.idle[order].pop()
    except IndexError:
        return (build_state(case.model), build_state(case.model), build_series(case.model, order))
    for state in workspace[:2]:
        motion.copy_state(case.start, state)
    return workspace


def read_state(
    case: EngineCase, state: EngineState, key: str = "", drive_angle: float | None = None
) -> State:
    """The engine's state as a `State`; key: the `case_key` if it differs from the case's own, as on
    ramps; drive_angle: that of `State`."""
    modal = np.zeros(4 * len(case.amplitudes))
    modal[case.present] = state.disc[case.places]
    modal.setflags(write=False)
    modes: dict[str, Any] = dict(zip(MODAL, modal.reshape(4, -1), strict=True))
    phase = motion.phase_of(state)
    direction = motion.direction_of(state)
    scalars: dict[str, Any] = motion.scalars_of(state)
    rate = scalars.pop("g")
    if phase == SLIP and rate * direction < 0:
        rate = 0.0  # slip that has just begun or is about to end, and g is rounding
    w, velocity, slope, surface = case.point.dot(state.disc).tolist()
    if phase != SEPARATION and not case.model.has_compliance:
        scalars |= {"u": w, "u_velocity": velocity + rate * slope}
    return State(
        **scalars,
        **modes,
        phase=PHASES[phase],
        direction=direction,
        f=rate + surface,
        drive_angle=drive_angle,
        case_key=key or case.key,
        mode_amplitudes=case.amplitudes,
        _roots=motion.known_roots(state),
    )


def write_state(
    case: EngineCase, source: State, state: EngineState, key: str = "", *, is_start: bool = False
) -> bool:
    """Write ``source`` to the engine's state; key as in `read_state`. The start of a run must not be
    inside the disc, but a direction of change may be. Returns whether the engine
    has to determine the phase at this instant first: the state lies at an event of another case.
    Raises `ParameterError`."""
    _check(source, case)
    motion.clear(state)
    modal = np.concatenate([getattr(source, name) for name in MODAL])
    state.disc[case.places] = modal[case.present]
    gap = _checked_gap(case, source, state, is_start=is_start)
    rate = _checked_rate(case, source)

    # the engine's scalars are those of `PLAIN`, with the rate over the material in place of f
    values = [getattr(source, name) for name in PLAIN]
    values[PLAIN.index("f")] = rate
    motion.put_scalars(state, values)
    phase = PHASES.index(source.phase)
    if phase == SLIP and case.model.has_compliance and rate == gap == 0 and not any(source._roots):
        phase = STICK  # no force, and so no friction that slip could overcome
    motion.put_phase(state, phase, source.direction * (phase == SLIP), source._roots)
    at_event = any(source._roots) and source.case_key != (key or case.key)
    return at_event and _forget_switch(case, source, state, gap, rate)


def _forget_switch(
    case: EngineCase, source: State, state: EngineState, gap: float, rate: float
) -> bool:
    """Adapt a state at an event of another case: an event function that vanishes there need not
    vanish here. Returns whether the engine must determine if contact lasts: a slider that rests on
    the disc is put into contact."""
    sizes = SAME_HEIGHT * np.abs(case.point).dot(np.abs(state.disc))
    _, velocity, slope, _ = case.point.dot(state.disc)
    phase = motion.phase_of(state)
    opening = source.u_velocity - velocity - rate * slope
    touches = abs(gap) <= sizes[0]
    rests = abs(opening) <= sizes[1] + abs(rate) * sizes[2]
    known = (0, 0)
    if phase == SEPARATION and touches and not rests:
        known = (int(opening > 0), 0)
    elif case.model.has_compliance and touches and source._roots[1] > 0:
        known = (int(rate == 0 and phase == SLIP), 1)
    elif touches or phase == SLIP:
        motion.put_phase(state, SLIP if rate else STICK, int(np.sign(rate)))
        return True
    motion.put_phase(state, phase, motion.direction_of(state), known)
    return False


def _check(state: State, case: EngineCase) -> None:
    """Raise `ParameterError` if a value of a state is none, or the state is one of other modes."""
    count = len(case.amplitudes)
    rule = f"must be {count} finite numbers, one per row of plate_modes"
    for name in MODAL:
        values = getattr(state, name)
        good = np.shape(values) == (count,) and np.asarray(values).dtype.kind in "fiu"
        require((good and np.isfinite(values).all(), f"initial_state.{name}", values, rule))
    numbers = {name: getattr(state, name) for name in PLAIN}
    numbers["drive_angle"] = state.drive_angle or 0.0
    for name, value in numbers.items():
        good = is_number(value) and math.isfinite(value)
        require((good, f"initial_state.{name}", value, "must be a finite number"))
    signed = state.phase != "slip" or state.direction in (-1, 1)
    own = belongs_to(state, case.amplitudes)
    rule = "must be psi of plate_modes: the state belongs to other modes"
    digit = math.ulp(state.time)  # of which the clock's compensation is a part
    less = "must be less than the last digit of the time"
    require(
        (state.phase in PHASES, "initial_state.phase", state.phase, rule_of_choice(PHASES)),
        (signed, "initial_state.direction", state.direction, "must be -1 or 1 in slip"),
        (own, "initial_state.mode_amplitudes", state.mode_amplitudes, rule),
        (abs(state.time_low) <= digit, "initial_state.time_low", state.time_low, less),
    )


def belongs_to(state: State, amplitudes: Array) -> bool:
    """Whether a state is one of modes with these amplitudes, shape (n_modes,)."""
    stated = state.mode_amplitudes
    if stated is None:
        return len(state.a) == len(amplitudes)
    if stated is amplitudes:  # as nearly always, and at once
        return True
    # modes from two processors differ by at most 1e-13 (measured)
    within = 1e-9 * np.max(np.abs(amplitudes), initial=0.0)
    return np.shape(stated) == amplitudes.shape and np.allclose(stated, amplitudes, 0, within)


def _checked_gap(case: EngineCase, source: State, state: EngineState, *, is_start: bool) -> float:
    """The slider's height over the disc, m. Raises `ParameterError` if it is within the disc, or not on it
    in rigid contact."""
    row = case.point[0]
    w = float(row.dot(state.disc))
    gap = source.u - w
    place = "at"
    good = case.model.has_compliance or gap == 0
    size = float(np.abs(row).dot(np.abs(state.disc))) + abs(source.u_velocity) * case.model.unit
    if source.phase == "separation":
        place = "at or above"
        good = not is_start or gap >= -INSIDE * size
    rule = (
        f"must be {place} the disc under the slider, {w:.9g}, in {source.phase}: change a with it"
    )
    require((good or abs(gap) <= SAME_HEIGHT * size, "initial_state.u", source.u, rule))
    return gap


def _checked_rate(case: EngineCase, source: State) -> float:
    """The rate g over the material, rad/s: 0 in stick, and where only rounding makes it differ from 0
    or from the direction of slip. Raises `ParameterError` if it differs by more."""
    surface = float(case.surface @ source.beta)
    rate = source.f - surface
    if source.phase == "separation":
        return rate
    if source.phase == "stick":
        rule = f"must be {surface:.9g} in stick, the disc's surface's"
        require((abs(rate) <= SAME_SPEED * abs(surface), "initial_state.f", source.f, rule))
        return 0.0
    rounding = SAME_SPEED * (case.model.Omega + abs(surface))
    rule = f"must have the sign of direction={source.direction}, less the surface's {surface:.9g}"
    require((rate * source.direction >= -rounding, "initial_state.f", source.f, rule))
    begins = source._roots[0] > 0 and abs(rate) <= rounding
    if begins or rate * source.direction < 0:
        return 0.0
    return rate


# Local truncation error for a tolerance of 1, on rigid and on compliant contact. With it the errors
# of event times over a second equal the tolerance, as measured against the long-double references
# (docs/verification.md). Compliant contact takes three times as many steps, and errors accumulate in
# the weakly damped vibration of the slider on it.
LOCAL = (80.0, 5.0)
# s; looser is no cheaper, because the series must reach from event to event anyway, and may miss events
LOOSEST = (1.25e-7, 2e-6)


def series_tolerance(tol: float, compliant: bool = False) -> float:
    """Size of the last terms of a step, relative to the state's scale."""
    if tol >= LOOSEST[compliant]:
        return 1e-5
    return LOCAL[compliant] * tol


def loosest_tolerance(p: Parameters) -> float:
    """The greatest tolerance of a simulation that makes a difference, s."""
    return LOOSEST[p.contact_compliance != 0]


@cache
def series_order(tol: float) -> int:
    """Degree of the Taylor series, an even number: the cheapest one for the tolerance, as measured
    (20 at 1e-10)."""
    digits = -math.log10(series_tolerance(tol))
    return min(max(2 * round(digits + 1.6), 18), 28)
