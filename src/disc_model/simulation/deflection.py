"""Motion of the whole disc: modal coordinates at chosen times, and the deflection that follows from them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from disc_model.disc.plate import mode_arrays, mode_shapes, radial_range
from disc_model.errors import Fault, ParameterError, as_text, raise_faults, require, violations
from disc_model.parameters import Parameters, foreign_case
from disc_model.simulation.api import simulate
from disc_model.simulation.states import Array, State, amplitude_faults, is_finite_array, static_start
from disc_model.units import is_number

if TYPE_CHECKING:
    import xarray as xr


def snapshots(
    p: Parameters, times: ArrayLike, *, tol: float = 1e-10, initial_state: State | None = None
) -> tuple[State, ...]:
    """States of the system at given times, with its modal coordinates.

    Parameters
    ----------
    p : the case
    times : s, ascending, shape (n,); none before the initial state's
    tol, initial_state : as in `disc_model.simulate`

    Returns
    -------
    tuple of State
        One for each time.

    Raises
    ------
    ParameterError
        If times are not ascending finite numbers, or begin too early; and as `disc_model.simulate`.
    SimulationError
        If the motion ends before the last time.

    Examples
    --------
    >>> import disc_model as dm
    >>> [state.phase for state in dm.snapshots(dm.Parameters(N=385, Omega=15.1), [0.0, 0.006])]
    ['stick', 'slip']
    """
    numbers = _numbers(times)
    ascend = numbers is not None and not np.any(np.diff(numbers) < 0)
    starts = initial_state is None or isinstance(initial_state, State)
    wrong = violations((starts, "initial_state", initial_state, "must be a State"))
    raise_faults(foreign_case(p) + wrong + violations((ascend, "times", times, "must be finite and ascend")))
    wanted: list[float] = [] if numbers is None else numbers.tolist()
    state = static_start(p) if initial_state is None else initial_state
    rule = f"must be >= {as_text(state.time)} (the time of the initial state)"
    require(*((time >= state.time, "times", time, rule) for time in wanted[:1]))
    states = []
    for time in wanted:
        if time > state.time:
            state = simulate(p, time, tol=tol, events=False, initial_state=state).raise_for_status().final_state
        states.append(state)
    return tuple(states)


def deflection(p: Parameters, states: State | Iterable[State], r: ArrayLike, theta: ArrayLike) -> xr.DataArray:
    """Displacement w(r, theta, t) of the whole disc, upward, Eq. (15).

    Parameters
    ----------
    p : the case
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

    raise_faults(foreign_case(p))
    modes, (low, high), radii, angles = mode_arrays(p), radial_range(p), _numbers(r), _numbers(theta)
    states_in_order: list[Any] = list(states) if np.iterable(states) else [states]
    within = radii is not None and radii.size and np.all((radii >= low) & (radii <= high))
    limits = f"a={as_text(low)} and b={as_text(high)}" if p.disc is None else f"{as_text(low)} and {as_text(high)}"
    faults = violations(
        (within, "r", r, f"must be within {limits}"), (angles is not None, "theta", theta, "must be finite")
    )
    for i, state in enumerate(states_in_order):
        path, n_modes = ("states", str(i)), len(modes.psi)
        if not isinstance(state, State):
            faults.append(Fault.of(path, state, "must be a State"))
        elif len(state.a) != n_modes:
            faults.append(Fault(path, "", f"must have {n_modes} modes, as the case, and not {len(state.a)}"))
        else:
            faults += amplitude_faults(state, modes.psi, path)
    if faults or radii is None or angles is None:
        raise ParameterError(*faults)
    shapes = mode_shapes(p, radii)
    w = np.empty((len(states_in_order), len(radii), len(angles)))
    for i, state in enumerate(states_in_order):
        # modal coordinates are relative to the slider, whose angle is Omega t - psi
        turn = np.multiply.outer(modes.diameters, angles - (p.Omega * state.time - state.psi))
        w[i] = shapes.T @ (state.a[:, None] * np.cos(turn) + state.b[:, None] * np.sin(turn))
    coords = {
        "time": ("time", [state.time for state in states_in_order], {"units": "s", "long_name": "time"}),
        "r": ("r", radii, {"units": "m", "long_name": "radius"}),
        "theta": ("theta", angles, {"units": "rad", "long_name": "angle fixed to the disc"}),
    }
    attrs = {"units": "m", "long_name": "displacement of the disc"}
    return xr.DataArray(w, coords, ("time", "r", "theta"), name="w", attrs=attrs)


def _numbers(values: ArrayLike) -> Array | None:
    """The values as an array of shape (n,); None if they are not finite numbers."""
    several = [values] if is_number(values) else values
    return np.asarray(several, dtype=float) if is_finite_array(several) else None
