"""A plate that stretches under the preload, and the membrane's forces on its modes."""

from typing import Any, NamedTuple

import numpy as np

from disc_model.arrays import Array
from disc_model.disc.membrane import quartic_form
from disc_model.disc.plate import mode_arrays
from disc_model.errors import require
from disc_model.parameters import Parameters

MOST_COORDINATES = 52
"""The quartic form has the fourth power of so many numbers: 55 MB."""
_STEPS = 32  # of the preload, in which the static start is found
_MOST_ITERATIONS = 60
_SETTLED = 4e-16


def membrane_forces(p: Parameters, a: Any, b: Any) -> tuple[Any, Any]:
    """The membrane's forces on a and b of all modes of a case that stretches, real or complex, each
    (n_modes, k)."""
    T = quartic_form(p)
    n = len(T)
    pairs = mode_arrays(p).diameters > 0
    q = np.concatenate([a, b[pairs]])
    products = (q[:, None] * q).reshape(n * n, -1)
    K = (T.reshape(n * n, -1) @ products).reshape(n, n, -1)
    force = np.sum(K * q, axis=1)
    across = np.zeros_like(force[: len(a)])
    across[pairs] = force[len(a) :]
    return force[: len(a)], across


class Stretched(NamedTuple):
    """A plate that stretches under the preload."""

    quartic: Array  # see `quartic_form`
    rest: Array  # static displacements a, shape (n_modes,)
    softness: float  # of the disc's point under the slider, by which it yields to more load, m/N


def stretched(p: Parameters) -> Stretched:
    """The static deflection omega^2 a + T a a a = -N psi of a case, by Newton's method in steps of
    the load; arrays are empty if the plate does not stretch."""
    modes = mode_arrays(p)
    n = len(modes.psi)
    count = n + int(np.count_nonzero(modes.diameters))
    if p.stretching == "none" or count == 0:
        return Stretched(np.zeros((0, 0, 0, 0)), np.zeros(0), 0.0)
    rule = f"must be none for more than {MOST_COORDINATES} coordinates of modes, here {count}"
    require((count <= MOST_COORDINATES, "stretching", p.stretching, rule))
    T = quartic_form(p)
    form = T[:n, :n, :n, :n]
    linear = np.diag(modes.omega**2)
    a = np.zeros(n)
    slopes = linear
    for load in np.linspace(0, p.N, _STEPS + 1):
        for _ in range(_MOST_ITERATIONS):
            K = form @ a @ a
            slopes = linear + 3 * K
            change = np.linalg.solve(slopes, (linear + K) @ a + load * modes.psi)
            a = a - change
            if np.max(np.abs(change)) <= _SETTLED * np.max(np.abs(a)):
                break
    return Stretched(T, a, float(modes.psi @ np.linalg.solve(slopes, modes.psi)))
