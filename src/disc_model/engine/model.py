"""Constants of one case, as kernels read them: flat arrays of doubles, in blocks of eight lanes.

Pairs of diametral modes (l >= 1) fill blocks as (a, a, a, a, b, b, b, b); unused lanes are zero.
Axisymmetric modes (l = 0) are few, and stored one by one in the arrays whose names end in 0.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from .jit import inlined
from .jit.packing import packed
from .jit.simd import WIDTH, aligned, load
from .state import (
    DRIVE,
    HALF,
    LOAD,
    PHASE,
    STICK,
    TIME,
    TIME_LOW,
    EngineState,
    U,
    disc_size,
    lanes_for,
    mode_places,
    pair_lanes,
    views_of_disc,
)
from .stick_modes import Components, StickModes, build_stick_modes, no_modes

ROWS = 48  # number of coefficients of a series
MEMBRANE_GROUP = 3  # vectors of the membrane's products that one loop takes side by side
MOST_FREE = 1e4  # longest ``Model.free_unit``: the highest power of eight of them must not overflow

# Rows of ``Model.lanes``. Sums over lanes of a row times the displacements z, or the velocities e:
# AMPLITUDE (psi_l in lanes of a) gives w and, with e, its velocity; SLOPE (l psi_l in lanes of b)
# B = dw/dtheta; BEND (-l^2 psi_l in lanes of a) d2w/dtheta2, all under the slider. TANGENTIAL (t_l in
# lanes of b) gives, with e, the velocity v_s of the surface on which friction acts, and its rate
# are the next three: -t_l 2 xi omega and -t_l omega^2 in lanes of b, and -l t_l in lanes of a. FORCES:
# psi_l in lanes of a, on which V acts, and t_l in lanes of b, on which H acts. From SLOPE_RATE on, a
# row for each order k: SLOPE, and in lanes of a the same times (k + 1) / unit.
(
    SHIFT,
    STIFFNESS,
    DAMPING,
    AMPLITUDE,
    SLOPE,
    BEND,
    MINUS_AMPLITUDE_DAMPING,
    MINUS_AMPLITUDE_STIFFNESS,
    FORCES,
    TANGENTIAL,
    TANGENTIAL_DAMPING,
    TANGENTIAL_STIFFNESS,
    TANGENTIAL_TURN,
    SLOPE_RATE,
) = range(14)
_N_ROWS = SLOPE_RATE + ROWS


@packed()
class Membrane(NamedTuple):
    """The membrane of a plate that stretches, see `stretching`: the map from s to K, vector by
    vector, and where numbers stand in work space."""

    owns: np.ndarray  # vectors of displacements: blocks of pairs, and modes without nodal diameter
    groups: np.ndarray  # the first group of vectors with each of these, and their number
    partners: np.ndarray  # vector of displacements that each vector multiplies it by, (vectors,)
    sources: np.ndarray  # the first vector of K that is the same, (vectors,)
    begins: np.ndarray  # first entry of each vector of K, (vectors + 1,)
    places: np.ndarray  # of the number of s that an entry multiplies, (entries,)
    values: np.ndarray  # the vector by which, (entries * 8,)
    table: np.ndarray  # place of K_ij; i, j: lanes, then modes without nodal diameter
    rest: np.ndarray  # static displacements of these
    softness: float  # -du_0 / dN, m/N
    displacements: int  # where sections of the work space begin, for one order
    coefficients: int
    products: int
    length: int  # of the work space beyond ``products``


_NONE = np.zeros(0, np.int64)
NO_MEMBRANE = Membrane(
    _NONE, _NONE, _NONE, _NONE, _NONE, _NONE, np.zeros(0), _NONE, np.zeros(0), 0.0, 0, 0, 0, 0
)


@packed()
class Model(NamedTuple):
    """Constants of one case. Arrays of lanes have shape (lanes of pairs,), those whose names end in
    0 have shape (modes without nodal diameter,).

    Flags are () for no and (True,) for yes: a length is part of the type, so that numba compiles no
    branch of a law that the case does not have.
    """

    # all rows, as [block][row][lane]: hot kernels use one pointer, and a row's place is a constant
    lanes: np.ndarray
    shift: np.ndarray  # +l in lanes of a, -l in lanes of b
    stiffness: np.ndarray  # omega^2
    damping: np.ndarray  # 2 xi omega
    mode_amplitude: np.ndarray  # psi_l in lanes of a, 0 in lanes of b
    dw_dtheta: np.ndarray  # l psi_l in lanes of b, 0 in lanes of a
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
    inverse_effective_mass: float  # S = sum psi_l^2, 1/kg
    damped_inverse_mass: float  # sum 2 xi_l omega_l psi_l^2, 1/(kg s)
    unit: float  # of the time of series, s: one radian of the fastest motion
    free_unit: float  # one radian of the fastest motion out of compliant contact, in units of time
    velocity_scale: float  # m/s times sqrt(kg): what a modal velocity is compared with
    slider_scale: float  # m/s: what u' is compared with where it is not the disc's
    bonded: bool  # whether contact is bilateral
    compliance: float  # of the contact, m/N; 0 if it is rigid
    point_amplitude: np.ndarray  # of a single point at r_0, in lanes of a: a pad has the mean
    point_amplitude0: np.ndarray
    tangential: (
        np.ndarray
    )  # t_l of the surface on which friction acts in lanes of b, 0 in lanes of a
    surface_inverse_mass: float  # S_t = sum t_l^2, 1/kg
    damped_surface_inverse_mass: float  # sum 2 xi_l omega_l t_l^2, 1/(kg s)
    surface_swing: float  # sum l psi_l t_l, 1/kg
    decay: float  # of friction, r_0 times ``friction_decay``, s/rad; 0 if it does not fall
    fall_of_friction: float  # mu_s - mu_k where friction falls with the speed, else 0
    onset_friction: float  # coefficient of friction where slip begins
    viscous: float  # r_0 times ``viscous_friction``, s/rad
    modes: StickModes  # closed form of stick
    membrane: Membrane
    has_more_blocks: tuple[bool, ...]  # whether there is more than one block of lanes
    has_compliance: tuple[bool, ...]  # whether the contact is compliant
    has_normal_force: tuple[bool, ...]  # whether the contact force is normal to the bent disc
    has_moving_surface: tuple[bool, ...]  # whether the surface on which friction acts moves
    has_varying_friction: tuple[bool, ...]  # whether friction in slip depends on the speed
    has_exponential_friction: tuple[bool, ...]  # whether it falls exponentially, not as a hyperbola
    has_stretching: tuple[bool, ...]  # whether the plate stretches
    has_ramp: tuple[bool, ...] = ()  # whether Omega and N may change with time
    ramp_begin: float = 0.0  # s
    ramp_angle: float = 0.0  # rad, of the drive point at the ramp's begin
    Omega_rate: float = 0.0  # rad/s^2
    N_rate: float = 0.0  # N/s


class DiscModes(NamedTuple):
    """The modes kept, each an array of shape (n_modes,); none for a rigid disc."""

    diameters: np.ndarray  # l
    omega: np.ndarray  # rad/s
    psi: np.ndarray  # amplitude under the slider, kg^-1/2
    psi_at_point: np.ndarray  # of a single point at r_0: a pad has the mean over its arc
    damping: np.ndarray  # 2 xi omega, 1/s
    tangential: np.ndarray  # amplitude at the surface on which friction acts, kg^-1/2
    # of a plate that stretches: the tensor T of `stretching`, static displacements a under the
    # preload, shape (n_modes,), and -du_0/dN of rigid contact, m/N
    quartic: np.ndarray = np.zeros((0, 0, 0, 0))
    rest: np.ndarray = np.zeros(0)
    softness: float = 0.0


class Contact(NamedTuple):
    """The law of contact."""

    bonded: bool = False  # whether contact is bilateral
    compliance: float = 0.0  # m/N; 0 if it is rigid
    normal: bool = False  # whether the contact force is normal to the bent disc, not vertical
    friction_decay: float = np.inf  # s/m; inf for the coefficient mu_k at any speed
    exponential: bool = False  # whether friction falls exponentially, not as a hyperbola
    viscous_friction: float = 0.0  # s/m


def _flag(yes) -> tuple[bool, ...]:
    return (True,) if yes else ()


def build_model(modes: DiscModes, slider: Mapping[str, Any], contact: Contact) -> Model:
    """Return the constants of a case; ``slider`` has N, Omega, k, c, m, k_p, c_p, mu_s, mu_k and
    r_0 by name."""
    N = slider["N"]
    m = slider["m"]
    psi = modes.psi
    omega = modes.omega
    compliance = contact.compliance
    single = np.flatnonzero(modes.diameters == 0)
    falls = np.isfinite(contact.friction_decay) and slider["mu_s"] > slider["mu_k"]

    # scales of time
    S = float(np.sum(psi**2))
    contact_rate = (1 / m + S) / compliance if compliance else 0.0
    slider_rate = max(slider["k"], slider["k_p"]) / m
    unit = _time_unit(omega, contact_rate, slider_rate)
    free_unit = _time_unit(omega, 0.0, slider_rate) / unit

    rows = _rows(modes, unit)
    membrane = NO_MEMBRANE
    u_0 = -N * (float(np.sum(psi**2 / omega**2)) + compliance)
    if modes.quartic.size:
        membrane = _membrane(modes, compliance)
        u_0 = float(psi @ modes.rest) - N * compliance
    return Model(
        lanes=_in_blocks(rows),
        shift=rows[SHIFT],
        stiffness=rows[STIFFNESS],
        damping=rows[DAMPING],
        mode_amplitude=rows[AMPLITUDE],
        dw_dtheta=rows[SLOPE],
        stiffness0=omega[single] ** 2,
        damping0=modes.damping[single],
        mode_amplitude0=psi[single],
        **slider,
        u_0=u_0,
        inverse_effective_mass=S,
        damped_inverse_mass=float(np.sum(modes.damping * psi**2)),
        unit=unit,
        free_unit=min(free_unit, MOST_FREE),
        velocity_scale=N * float(np.max(np.abs(psi) / omega, initial=0.0)),
        slider_scale=N * (float(np.sum(psi**2 / omega)) + compliance / unit),
        bonded=contact.bonded,
        compliance=compliance,
        point_amplitude=_point_amplitudes(modes),
        point_amplitude0=modes.psi_at_point[single],
        tangential=rows[TANGENTIAL],
        surface_inverse_mass=float(np.sum(rows[TANGENTIAL] ** 2)),
        damped_surface_inverse_mass=-float(np.sum(rows[TANGENTIAL] * rows[TANGENTIAL_DAMPING])),
        surface_swing=float(np.sum(rows[SLOPE] * rows[TANGENTIAL])),
        decay=slider["r_0"] * float(contact.friction_decay) if falls else 0.0,
        fall_of_friction=slider["mu_s"] - slider["mu_k"] if falls else 0.0,
        onset_friction=slider["mu_s"] if falls else slider["mu_k"],
        viscous=slider["r_0"] * float(contact.viscous_friction),
        # under the normal force friction in stick is no linear function of the state, nor is the
        # membrane's force
        modes=no_modes()
        if contact.normal or modes.quartic.size
        else _stick_modes(modes, slider, compliance, unit),
        membrane=membrane,
        has_more_blocks=_flag(rows.shape[1] > WIDTH),
        has_compliance=_flag(compliance),
        has_normal_force=_flag(contact.normal),
        has_moving_surface=_flag(np.any(rows[TANGENTIAL])),
        has_varying_friction=_flag(falls or contact.viscous_friction > 0.0),
        has_exponential_friction=_flag(falls and contact.exponential),
        has_stretching=_flag(modes.quartic.size),
    )


def _time_unit(omega, contact, slider) -> float:
    """Return one radian of the fastest motion, s; contact, slider: squares of the contact's and the
    slider's rates, 1/s^2."""
    if len(omega) == 0 and contact == 0.0:  # a rigid disc, and only the slider moves
        return slider**-0.5 if slider > 0.0 else 1.0
    return 1.0 / max(float(np.max(omega, initial=0.0)), contact**0.5)


def _rows(modes: DiscModes, unit: float) -> np.ndarray:
    """Return the rows of ``Model.lanes`` for a unit of time, s."""
    pairs = np.flatnonzero(modes.diameters > 0)
    l = modes.diameters[pairs]
    psi = modes.psi[pairs]
    of_a = pair_lanes(len(pairs))
    of_b = of_a + HALF
    of_both = np.concatenate([of_a, of_b])
    width = lanes_for(len(pairs))
    rows = np.zeros((_N_ROWS, width))
    rows[SHIFT, of_a] = l
    rows[SHIFT, of_b] = -l
    rows[STIFFNESS, of_both] = np.tile(modes.omega[pairs] ** 2, 2)
    rows[DAMPING, of_both] = np.tile(modes.damping[pairs], 2)
    rows[AMPLITUDE, of_a] = psi
    rows[SLOPE, of_b] = l * psi
    rows[BEND, of_a] = -(l**2) * psi
    rows[MINUS_AMPLITUDE_DAMPING] = -rows[AMPLITUDE] * rows[DAMPING]
    rows[MINUS_AMPLITUDE_STIFFNESS] = -rows[AMPLITUDE] * rows[STIFFNESS]
    tangential = modes.tangential[pairs]
    rows[TANGENTIAL, of_b] = tangential
    rows[TANGENTIAL_DAMPING] = -rows[TANGENTIAL] * rows[DAMPING]
    rows[TANGENTIAL_STIFFNESS] = -rows[TANGENTIAL] * rows[STIFFNESS]
    rows[TANGENTIAL_TURN, of_a] = -l * tangential
    rows[FORCES] = rows[AMPLITUDE] + rows[TANGENTIAL]
    rows[SLOPE_RATE:, of_b] = l * psi
    rows[SLOPE_RATE:, of_a] = np.outer(np.arange(1.0, ROWS + 1.0) / unit, l * psi)
    return rows


def _in_blocks(rows: np.ndarray) -> np.ndarray:
    """Return ``Model.lanes`` with these rows."""
    lanes = aligned(rows.size)
    by_block = rows.reshape(_N_ROWS, -1, WIDTH).swapaxes(0, 1)
    lanes[:] = by_block.ravel()
    return lanes


def _membrane(modes: DiscModes, compliance: float) -> Membrane:
    """Return the membrane of modes with a ``quartic`` form."""
    pairs = np.flatnonzero(modes.diameters > 0)
    single = np.flatnonzero(modes.diameters == 0)
    width = lanes_for(len(pairs))
    n = width + len(single)

    # T of lanes and of modes without nodal diameter, where n stands for none
    of_a = pair_lanes(len(pairs))
    places = np.concatenate([of_a, of_a + HALF, np.arange(width, n)])
    of_b = len(modes.diameters) + np.arange(len(pairs))
    coordinates = np.concatenate([pairs, of_b, single])
    T = np.zeros(4 * (n + 1,))
    T[np.ix_(*4 * [places])] = modes.quartic[np.ix_(*4 * [coordinates])]
    rest = np.zeros(n)
    rest[places] = np.append(modes.rest, np.zeros(len(pairs)))[coordinates]

    # vectors of displacements, and groups of partners of an own
    lane = np.arange(WIDTH)
    vectors = [b + (lane ^ r) for b in range(0, width, WIDTH) for r in range(WIDTH)]
    vectors += [np.full(WIDTH, j) for j in range(width, n + 1)]
    owns = [*range(0, width, WIDTH), *range(width, n)]
    groups = [0]
    partners: list[int] = []
    for own in owns:
        partners += range(n) if own < width else owns
        partners += [n] * (-len(partners) % MEMBRANE_GROUP)
        groups.append(len(partners) // MEMBRANE_GROUP)

    # both factors in each lane of each vector; two modes without nodal diameter fill one lane
    of_own = np.repeat(np.array(vectors)[owns], np.diff(groups) * MEMBRANE_GROUP, axis=0)
    of_partner = np.array(vectors)[partners]
    of_partner[(of_own >= width) & (of_partner >= width) & (lane > 0)] = n
    table = np.zeros((n + 1, n + 1), np.int64)
    sources = np.arange(len(partners))
    for v, (i, j) in enumerate(zip(of_own, of_partner, strict=True)):
        if i[0] >= width > j[0]:  # a mode by a block is the block by this mode
            sources[v] = table[j[0], i[0]] // WIDTH
        table[i, j] = sources[v] * WIDTH + lane
    begins, columns, values = _map_of(T, of_own, of_partner)
    coefficients = (len(owns) + len(vectors)) * WIDTH
    products = coefficients + len(partners) * WIDTH
    return Membrane(
        owns=np.array(owns),
        groups=np.array(groups),
        partners=np.array(partners),
        sources=sources,
        begins=begins,
        places=columns,
        values=values,
        table=table[:n, :n].ravel(),
        rest=rest,
        softness=modes.softness + compliance,
        displacements=len(owns) * WIDTH,
        coefficients=coefficients,
        products=products,
        length=len(partners) * WIDTH,
    )


def _map_of(T: np.ndarray, own: np.ndarray, partner: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return ``begins``, ``places`` and ``values`` of a `Membrane`; own, partner: both factors of
    each vector, (vectors, 8)."""
    product = np.minimum(own, partner) * len(T) + np.maximum(own, partner)
    products, first = np.unique(product, return_index=True)  # a place of each
    k, l = np.divmod(products, len(T))
    by_product = np.where(k == l, 1.0, 2.0) * T[:, :, k, l]
    begins = [0]
    places: list[int] = []
    values: list[np.ndarray] = []
    for rows in by_product[own, partner]:
        used = np.flatnonzero(rows.any(axis=0))
        places += first[used].tolist()
        values += [*rows[:, used].T]
        if len(places) % 2:  # entries are taken in twos
            places.append(0)
            values.append(np.zeros(WIDTH))
        begins.append(len(places))
    flat = aligned(len(values) * WIDTH)
    flat[:] = np.ravel(values)
    return np.array(begins), np.array(places), flat


def work_space(model: Model, orders: int) -> int:
    """Return the length of the work space of `stretching` for so many orders."""
    return orders * model.membrane.products + model.membrane.length


def _point_amplitudes(modes: DiscModes) -> np.ndarray:
    """Return ``Model.point_amplitude``."""
    pairs = np.flatnonzero(modes.diameters > 0)
    lanes = np.zeros(lanes_for(len(pairs)))
    lanes[pair_lanes(len(pairs))] = modes.psi_at_point[pairs]
    return lanes


def _stick_modes(
    modes: DiscModes, slider: Mapping[str, Any], compliance: float, unit: float
) -> StickModes:
    """Return the closed form of stick under the vertical force."""
    along, across, along_velocity, across_velocity = mode_places(modes.diameters)
    pairs = np.flatnonzero(modes.diameters > 0)
    single = np.flatnonzero(modes.diameters == 0)
    # components a of the pairs, modes without nodal diameter, components b
    upright = np.concatenate([pairs, single])
    each = np.concatenate([upright, pairs])
    is_b = np.arange(len(each)) >= len(upright)
    components = Components(
        omega=modes.omega[each],
        damping=modes.damping[each],
        shape=np.where(is_b, 0.0, modes.psi[each]),
        tangential=np.where(is_b, modes.tangential[each], 0.0),
    )
    displacements = np.concatenate([along[upright], across[pairs]])
    velocities = np.concatenate([along_velocity[upright], across_velocity[pairs]])
    width = lanes_for(len(pairs))
    return build_stick_modes(
        components,
        np.stack([displacements, velocities]),
        slider,
        u=2 * (width + len(single)),
        length=disc_size(width, len(single), compliance > 0.0),
        unit=unit,
        compliance=compliance,
    )


def build_state(model: Model) -> EngineState:
    """Return the static start: equilibrium under the preload, in stick, spring relaxed."""
    width = len(model.mode_amplitude)
    n_single = len(model.mode_amplitude0)
    compliant = bool(model.has_compliance)
    state = views_of_disc(width, n_single, compliant, work_space(model, 1))
    state.x[U] = model.u_0
    state.x[PHASE] = STICK
    if model.has_stretching:
        state.z[:], state.y[:] = np.split(model.membrane.rest, [width])
        return state
    exists = model.stiffness > 0
    np.divide(-model.N * model.mode_amplitude, model.stiffness, out=state.z, where=exists)
    exists0 = model.stiffness0 > 0
    np.divide(-model.N * model.mode_amplitude0, model.stiffness0, out=state.y, where=exists0)
    return state


def flags_of(model: Model) -> tuple[Any, ...]:
    """Return the flags of a model, which alone decide how kernels are compiled for it."""
    return tuple(entry for entry in model if type(entry) is tuple)


def blocks_of(model: Model) -> int:
    """Return the number of blocks of lanes, to which the cost of a step is proportional."""
    return len(model.shift) // WIDTH


def slope_under_slider(model: Model, state: EngineState) -> float:
    """Return B = dw/dtheta, m."""
    return float(np.dot(model.dw_dtheta, state.z))


# ---- Ramps


def on_ramp(model: Model, begin: float, angle: float, **course: Any) -> Model:
    """Return a model whose Omega and N change steadily from ``begin`` (s) on; the slider's spring
    is held where it was.

    angle : rad, of the drive point at ``begin``
    course : Omega and N there, Omega_rate and N_rate
    """
    share = course["N"] / model.N
    return model._replace(
        **course,
        velocity_scale=share * model.velocity_scale,
        slider_scale=share * model.slider_scale,
        has_ramp=_flag(True),
        ramp_begin=begin,
        ramp_angle=angle,
        modes=no_modes(),  # the closed form of stick knows no ramps
    )


@inlined
def drive_now(model, state):
    """Return Omega at the state's time."""
    return state.x[DRIVE] if model.has_ramp else model.Omega


@inlined
def load_now(model, state):
    """Return N at the state's time."""
    return state.x[LOAD] if model.has_ramp else model.N


@inlined
def set_course(model, state):
    """Set Omega and N to those of the state's time, on a ramp."""
    if model.has_ramp:
        x = state.x
        since = (x[TIME] - model.ramp_begin) + x[TIME_LOW]
        x[DRIVE] = model.Omega + model.Omega_rate * since
        x[LOAD] = model.N + model.N_rate * since


@inlined
def drive_angle(model, time):
    """Return the angle of the drive point at a time (s), rad."""
    if model.has_ramp:
        since = time - model.ramp_begin
        return model.ramp_angle + (model.Omega + 0.5 * model.Omega_rate * since) * since
    return model.Omega * time


# ---- Flags and rows of lanes


@inlined
def is_rigid(model):
    """Return whether contact is rigid; numba has no ``not`` of a flag as a value."""
    return len(model.has_compliance) == 0


@inlined
def lane_count(model):
    """Return the number of lanes; a constant for the compiler if there is one block."""
    return len(model.shift) if model.has_more_blocks else WIDTH


@inlined
def constants(model, row, b):
    """Return the block of a row that begins at lane b."""
    return load(model.lanes, b * _N_ROWS + row * WIDTH)
