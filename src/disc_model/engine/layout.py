"""Memory layout of modes and states: flat arrays of doubles, in blocks of eight lanes.

Pairs of diametral modes (l >= 1) fill blocks as (a, a, a, a, b, b, b, b); their displacements are
``z``, their velocities ``e``; unused lanes stay zero.  Axisymmetric modes (l = 0) are few, and
stored one by one in ``y`` and ``g``.
"""

from typing import NamedTuple

import numpy as np

from .jit import inlined
from .jit.packing import packed
from .jit.simd import WIDTH, aligned
from .stick_modes import StickModes, build_stick_modes, no_modes, padded

STICK, SLIP, SEPARATION = 0, 1, 2
PSI, F, U, U_VELOCITY, SLIDER = range(5)  # indices of the slider's psi, f, u, u', and their number
# Rows of Model.lanes; BEND: -l^2 psi_l in a-lanes, so that sum(bend z) = d2w/dtheta2 under the
# slider. From SLOPE_RATE on, a row for each order k: dw_dtheta (k + 1) / unit in a-lanes, dw_dtheta
# in b-lanes. FORCES: psi_l in a-lanes, on which V acts, in b-lanes the couple's arm, on which T
# acts; COUPLE: the latter alone.
(
    SHIFT,
    STIFFNESS,
    DAMPING,
    AMPLITUDE_ROW,
    DW_DTHETA,
    BEND,
    MINUS_AMPLITUDE_DAMPING,
    MINUS_AMPLITUDE_STIFFNESS,
) = range(8)
FORCES, COUPLE, SLOPE_RATE = 8, 9, 10

ROWS = 48  # number of coefficients of a series
HALF = WIDTH // 2
MOST_FREE = 1e4  # longest ``Model.free_unit``: the highest power of eight of them must not overflow


@packed
class Model(NamedTuple):
    """Constants of one case.  Lane arrays have shape (pair lanes,), those ending in 0 (axisymmetric
    modes,).

    Tuples are flags: (True,) for yes, () for no. The compiler knows the length of a tuple, so that
    the usual case has no loop over blocks, and no law is chosen at run time.
    """

    lanes: (
        np.ndarray
    )  # all lane arrays and derived ones: hot kernels use one pointer; the others are views of it
    wide: tuple[bool, ...]  # whether there is more than one block of lanes
    shift: np.ndarray  # +l in a-lanes, -l in b-lanes
    stiffness: np.ndarray  # omega^2
    damping: np.ndarray  # 2 xi omega
    mode_amplitude: np.ndarray  # psi_l in a-lanes, 0 in b-lanes
    dw_dtheta: (
        np.ndarray
    )  # l psi_l in b-lanes, 0 in a-lanes: sum(dw_dtheta z) = dw/dtheta under the slider
    stiffness0: np.ndarray
    damping0: np.ndarray
    mode_amplitude0: np.ndarray
    N: float
    Omega: float
    k: float
    c: float
    m: float
    k_p: float
    c_p: float
    mu_s: float
    mu_k: float
    r_0: float
    u_0: float  # static displacement of the slider, m
    inverse_effective_mass: float  # S2 = sum psi_l^2, 1/kg
    damped_inverse_mass: float  # sum 2 xi_l omega_l psi_l^2, 1/(kg s)
    unit: float  # time unit of the series, s
    free_unit: float  # one radian of the fastest motion out of contact, time units; not used in rigid contact
    velocity_scale: float  # m/s times sqrt(kg): what a modal velocity is compared with
    slider_scale: float  # m/s: what u' is compared with in separation
    bonded: bool
    compliant: tuple[bool, ...]
    compliance: float  # of the contact, m/N; 0 if it is rigid
    normal: tuple[
        bool, ...
    ]  # whether the contact force is normal to the bent disc; else it is vertical
    coupled: tuple[bool, ...]  # whether friction acts on the disc's surface, and so bends it
    couple: (
        np.ndarray
    )  # in b-lanes the arm of friction T on a mode, -(its tangential amplitude at the surface)
    couple_swing: float  # sum l psi_l couple_l, 1/kg
    decaying: tuple[
        bool, ...
    ]  # whether friction in slip falls with the speed; else it is mu_k at once
    decay: float  # of friction, r_0 times ``friction_decay``, s/rad
    modes: StickModes  # closed form of stick
    ramped: tuple[bool, ...] = ()  # whether Omega and N may change with time
    ramp_begin: float = 0.0  # s
    ramp_angle: float = 0.0  # rad, of the drive point at the ramp's begin
    Omega_rate: float = 0.0  # rad/s^2
    N_rate: float = 0.0  # N/s


@inlined
def drive_now(model, state):
    return state.x[DRIVE] if model.ramped else model.Omega


@inlined
def load_now(model, state):
    return state.x[LOAD] if model.ramped else model.N


@inlined
def set_course(model, state):
    """Set Omega and N to those of the state's time, on a ramp."""
    if model.ramped:
        x = state.x
        since = (x[TIME] - model.ramp_begin) + x[TIME_LOW]
        x[DRIVE] = model.Omega + model.Omega_rate * since
        x[LOAD] = model.N + model.N_rate * since


@inlined
def drive_angle(model, time):
    """Angle of the drive point at ``time`` (s), rad."""
    if model.ramped:
        since = time - model.ramp_begin
        return model.ramp_angle + (model.Omega + 0.5 * model.Omega_rate * since) * since
    return model.Omega * time


@packed
class EngineState(NamedTuple):
    """State of the system.  z to g are views of ``disc``; ``x`` holds the slider's scalars, at the
    indices below."""

    disc: np.ndarray  # z, e, y, g, perhaps room for u, u'; padded to whole blocks of lanes
    z: np.ndarray
    e: np.ndarray
    y: np.ndarray
    g: np.ndarray
    x: np.ndarray


# Indices into EngineState.x beside PSI to U_VELOCITY.  KNOWN, KNOWN_FORCE: multiplicity of the root
# with which a phase began, of event function and contact force; PROPAGATED: not 0 if stick has used
# its closed form as far as possible, see ``event_loop``; IN_A_ROW: events at this instant. The time
# is TIME + TIME_LOW, summed with compensation so that event times stay exact to rounding after
# hours.  DRIVE, LOAD: Omega and N now, on a ramp.
TIME, TIME_LOW, PHASE, DIRECTION, KNOWN, KNOWN_FORCE = range(SLIDER, SLIDER + 6)
FORCE, PROPAGATED, IN_A_ROW, DRIVE, LOAD, SCALARS = range(SLIDER + 6, SLIDER + 12)


def pair_lanes(n_pairs):
    """Lane of the a-component of each pair, shape (n_pairs,); b follows ``HALF`` lanes later."""
    i = np.arange(n_pairs)
    return WIDTH * (i // HALF) + i % HALF


def disc_size(width, n_single, compliant):
    """Length of ``EngineState.disc``; on a compliant contact u, u' are stored at its end, for the
    closed form."""
    return padded(2 * (width + n_single) + (2 if compliant else 0))


def _flag(yes) -> tuple[bool, ...]:
    return (True,) if yes else ()


def build_model(  # noqa: PLR0913
    diameters,
    omega,
    psi,
    damping,
    slider,
    *,
    tangential,
    bonded,
    compliance=0.0,
    normal=False,
    friction_decay=np.inf,
) -> Model:
    """Constants of a case. diameters, omega (rad/s), psi (kg^-1/2), damping = 2 xi omega (1/s):
    shape (n_modes,); none for a rigid disc.  slider: N to r_0 of the model.  tangential: of the
    modes at the surface on which friction acts, kg^-1/2, shape (n_modes,); zeros in the middle
    plane.  compliance: of the contact, m/N, 0 if rigid; normal: whether the contact force is normal
    to the bent disc; friction_decay: s/m, inf for the coefficient mu_k at any speed."""
    N, k, m = (slider[name] for name in ("N", "k", "m"))
    diameters = np.asarray(diameters)
    pairs, single = np.flatnonzero(diameters > 0), np.flatnonzero(diameters == 0)
    width, lane = WIDTH * max(1, -(-len(pairs) // HALF)), pair_lanes(len(pairs))
    lanes = aligned((SLOPE_RATE + ROWS) * width)
    rows = lanes.reshape(-1, width)
    rows[SHIFT, lane], rows[SHIFT, lane + HALF] = diameters[pairs], -diameters[pairs]
    rows[STIFFNESS, lane] = rows[STIFFNESS, lane + HALF] = omega[pairs] ** 2
    rows[DAMPING, lane] = rows[DAMPING, lane + HALF] = damping[pairs]
    rows[AMPLITUDE_ROW, lane] = psi[pairs]
    rows[DW_DTHETA, lane + HALF] = diameters[pairs] * psi[pairs]
    rows[BEND, lane] = -(diameters[pairs] ** 2) * psi[pairs]
    rows[COUPLE, lane + HALF] = -tangential[pairs]
    rows[FORCES] = rows[AMPLITUDE_ROW] + rows[COUPLE]
    rows[MINUS_AMPLITUDE_DAMPING] = -rows[AMPLITUDE_ROW] * rows[DAMPING]
    rows[MINUS_AMPLITUDE_STIFFNESS] = -rows[AMPLITUDE_ROW] * rows[STIFFNESS]
    S2, slider_rate = float(np.sum(psi**2)), max(k, slider["k_p"]) / m
    unit = _time_unit(omega, (1 / m + S2) / compliance if compliance else 0.0, slider_rate)
    rows[SLOPE_RATE:, lane + HALF] = rows[DW_DTHETA, lane + HALF]
    rows[SLOPE_RATE:, lane] = np.outer(
        np.arange(1.0, ROWS + 1.0) / unit, rows[DW_DTHETA, lane + HALF]
    )
    decays = np.isfinite(friction_decay) and slider["mu_s"] > slider["mu_k"]
    modes = no_modes()
    if not normal:
        each, n0 = np.concatenate([pairs, single, pairs]), len(single)
        across = np.arange(len(each)) >= len(pairs) + n0
        shape, arm = np.where(across, 0.0, psi[each]), np.where(across, -tangential[each], 0.0)
        place = np.concatenate([lane, 2 * width + np.arange(n0), lane + HALF])
        modes = build_stick_modes(
            (omega[each], damping[each], shape, arm),
            np.stack([place, place + np.where(diameters[each] > 0, width, n0)]), slider,
            u=2 * (width + n0), length=disc_size(width, n0, compliance > 0.0), unit=unit, compliance=compliance,
        )  # fmt: skip
    return Model(
        lanes=lanes,
        wide=_flag(width > WIDTH),
        **dict(
            zip(
                ("shift", "stiffness", "damping", "mode_amplitude", "dw_dtheta"), rows, strict=False
            )
        ),
        **slider,
        stiffness0=omega[single] ** 2,
        damping0=damping[single],
        mode_amplitude0=psi[single],
        u_0=-N * (float(np.sum(psi**2 / omega**2)) + compliance),
        inverse_effective_mass=S2,
        damped_inverse_mass=float(np.sum(damping * psi**2)),
        unit=unit,
        free_unit=min(_time_unit(omega, 0.0, slider_rate) / unit, MOST_FREE),
        velocity_scale=N * float(np.max(np.abs(psi) / omega, initial=0.0)),
        slider_scale=N * (float(np.sum(psi**2 / omega)) + compliance / unit),
        bonded=bonded,
        compliant=_flag(compliance),
        compliance=compliance,
        normal=_flag(normal),
        coupled=_flag(np.any(rows[COUPLE])),
        couple=rows[COUPLE],
        couple_swing=float(np.sum(rows[DW_DTHETA] * rows[COUPLE])),
        decaying=_flag(decays),
        decay=slider["r_0"] * float(friction_decay) if decays else 0.0,
        modes=modes,
    )


def on_ramp(model: Model, begin, angle, **course) -> Model:
    """``model`` while Omega and N change steadily from ``begin`` (s) on; the slider's spring is held where it was.
    angle : rad, of the drive point at ``begin``; course : Omega and N there, Omega_rate and N_rate."""
    share = course["N"] / model.N
    return model._replace(
        **course,
        velocity_scale=share * model.velocity_scale,
        slider_scale=share * model.slider_scale,
        ramped=_flag(True),
        ramp_begin=begin,
        ramp_angle=angle,
        modes=no_modes(),  # the closed form of stick knows no ramps
    )


def _time_unit(omega, contact, slider) -> float:
    """s; one radian of the fastest motion.  contact, slider: squares of the contact's and the
    slider's rates, 1/s^2."""
    if len(omega) == 0 and contact == 0.0:  # a rigid disc, and only the slider moves
        return slider**-0.5 if slider > 0.0 else 1.0
    return 1.0 / max(float(np.max(omega, initial=0.0)), contact**0.5)


def build_state(model: Model) -> EngineState:
    """The static start: equilibrium under the preload, in stick, spring relaxed."""
    width, n0 = len(model.mode_amplitude), len(model.mode_amplitude0)
    disc = aligned(disc_size(width, n0, model.compliant))
    z, e, y, g = (
        disc[:width],
        disc[width : 2 * width],
        disc[2 * width :][:n0],
        disc[2 * width + n0 :][:n0],
    )
    np.divide(-model.N * model.mode_amplitude, model.stiffness, out=z, where=model.stiffness > 0)
    np.divide(-model.N * model.mode_amplitude0, model.stiffness0, out=y, where=model.stiffness0 > 0)
    x = np.zeros(SCALARS)
    x[U] = model.u_0
    x[PHASE] = STICK
    return EngineState(disc, z, e, y, g, x)
