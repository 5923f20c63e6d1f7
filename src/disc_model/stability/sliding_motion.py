"""Motions near steady sliding: whether they approach it as its eigenvalues predict."""

import math
from functools import lru_cache

import numpy as np

from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import mode_arrays
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.states import State, static_start
from disc_model.stability import thresholds
from disc_model.stability.linear_motion import grows_at_rate, left_vector
from disc_model.stability.return_map import Array
from disc_model.stability.segments import Segment
from disc_model.stability.sliding import SteadySliding, height_of_slider, join_rows, steady_sliding
from disc_model.stability.sliding_modes import energy_weights

_sliding = lru_cache(maxsize=1)(steady_sliding)  # needed at the end of each leg of a motion


def approaches_sliding(p: Parameters, state: State) -> bool:
    """Whether a slipping motion approaches stable steady sliding as the eigenvalues there
    predict."""
    if state.phase != "slip" or not _sliding(p).stable:
        return False
    times = thresholds.TEST_TIMES[-1]
    return _follows_eigenvalues(
        p, state, times, arrived=thresholds.ARRIVED, farthest=thresholds.NEAR
    )


def departs_from_sliding(p: Parameters, state: State) -> bool:
    """Whether a slipping motion departs from unstable steady sliding as the eigenvalues there
    predict, for some seconds or until it has grown by a factor of e."""
    if state.phase != "slip" or not _sliding(p).growing.size:
        return False
    time_of_growth = 1 / _sliding(p).growth_rate
    first, last = thresholds.TEST_TIMES[-1]
    shorter = min(1.0, time_of_growth / last)
    times = (shorter * first, shorter * last)
    return _follows_eigenvalues(p, state, times, arrived=0.0, farthest=math.inf)


def _follows_eigenvalues(
    p: Parameters, state: State, times: tuple[float, float], *, arrived: float, farthest: float
) -> bool:
    """Whether a slipping motion follows the linear one about steady sliding at two times (s) from a
    state on.

    arrived, farthest : distance within which a motion has arrived, and the largest of the state,
        over the static deflection

    It is followed with `TEST_TOL`, because errors of coarser simulations keep it away: at 1e-10, by
    7e-7 of the static deflection on a disc whose modes of 2 kHz decay at 0.4/s.
    """
    sliding = _sliding(p)
    modes = mode_arrays(p)
    scale = np.sqrt(energy_weights(p))  # by it the norm of rows is that of the energy
    jacobian = scale[:, None] * sliding.jacobian / scale
    expected = scale * _from_sliding(p, sliding, state)
    static = p.N * float(np.linalg.norm(modes.psi / modes.omega))
    if static == 0:  # a rigid disc: the spring in the plane, bent up to the limit of friction
        static = p.mu_s * p.N / math.sqrt(p.k_p)
    least = arrived * static
    if not np.linalg.norm(expected) <= farthest * static:
        return False

    # slow to import, and few motions come so near
    from scipy.linalg import expm

    leading = left_vector(jacobian, np.real)
    parts = list[float]()
    before = 0.0
    for time in times:
        end = state.time + time
        result = simulate(p, end, tol=thresholds.TEST_TOL, initial_state=state, events=False)
        if not result.status.complete or result.final_state.phase != "slip":
            return False
        apart = scale * _from_sliding(p, sliding, result.final_state)
        expected = expm(jacobian * (time - before)) @ expected
        size = float(np.linalg.norm(expected))
        if not np.linalg.norm(apart - expected) <= max(thresholds.LARGEST_ERROR * size, least):
            return False
        parts.append(float(abs(leading @ apart)))
        before = time
    return grows_at_rate(parts, times[1] - times[0], sliding.growth_rate, least)


def segment_of_sliding(p: Parameters) -> Segment:
    """The segment of steady sliding itself, without the transient of a motion that approaches it."""
    sliding = _sliding(p)
    height = float(height_of_slider(p, sliding) - static_start(p).u)
    return Segment(
        P_min=sliding.contact_force,
        P_max=sliding.contact_force,
        u_min=height,
        u_max=height,
        stick_fraction=0.0,
        slip_fraction=1.0,
        separation_fraction=0.0,
        separation_rate=0.0,
    )


def _from_sliding(p: Parameters, sliding: SteadySliding, state: State) -> Array:
    """Distance from steady sliding, in the rows of its Jacobian."""
    modes = mode_arrays(p)
    compliance = contact_compliance(p)
    disc = (
        state.a - sliding.a,
        state.alpha - sliding.alpha,
        state.b - sliding.b,
        state.beta - sliding.beta,
    )
    height = []
    if compliance:
        rest = height_of_slider(p, sliding)
        height = [float(state.u - rest), float(state.u_velocity)]
    return join_rows(modes, disc, (state.psi - sliding.psi, state.f - p.Omega), height)
