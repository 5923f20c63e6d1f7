"""Membrane energy of a plate that is deflected by a thickness or more, and so stretches.

After von Karman, with the inertia in the plane neglected: a deflection w = sum g_l(r) (a_l cos +
b_l sin) strains the middle plane, and displacements in the plane relax what they can. The energy
left is a quartic form of a and b. Products of two modes are taken harmonic by harmonic, with z_0 =
a_0, z_l = (a_l - i b_l)/2 and z_-l its conjugate, and the displacements

    u_r = U(r) e^(i n theta),    u_t = i V(r) e^(i n theta)

are eliminated by least squares: what the strains of U and V cannot fit is the residual strain.
Rigid motions of a free plate drop out by the rank.
"""

from functools import lru_cache
from itertools import combinations_with_replacement
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from disc_model.arrays import Array
from disc_model.disc.plate import mode_arrays, mode_slopes
from disc_model.parameters import Parameters

# parameters on which the quartic form depends
_OF_FORM = "a b r_0 h E nu rho n_diameters n_circles normalization stretching"


class Wave(NamedTuple):
    """A mode as one of the harmonics that it consists of: its number, and the nodal diameters with
    the sign of the harmonic."""

    mode: int
    n: int


class Harmonic(NamedTuple):
    """Membrane energy of one harmonic: V4 = Re(S* G S), S_P = z_p z_q for the pairs P of waves."""

    pairs: list[tuple[Wave, Wave]]
    G: Array  # N m^-3 kg^-2


def harmonics(p: Parameters) -> dict[int, Harmonic]:
    """Membrane energy of a case, whose inner edge is clamped or free in its plane, by harmonics n
    >= 0."""
    diameters = mode_arrays(p).diameters
    waves = [Wave(mode, int(l)) for mode, l in enumerate(diameters)]
    waves += [Wave(wave.mode, -wave.n) for wave in waves if wave.n > 0]
    pairs: dict[int, list[tuple[Wave, Wave]]] = {}
    for one, other in combinations_with_replacement(waves, 2):
        n = one.n + other.n
        if n >= 0:
            pairs.setdefault(n, []).append((one, other))

    held = int(p.stretching == "clamped")
    plane = Plane((p.a, p.b), p.h, p.E, p.nu, held, 20 + p.n_diameters + 8 * p.n_circles)
    g, slopes = mode_slopes(p, plane.r)
    found = {}
    for n, of_n in sorted(pairs.items()):
        strains = [plane.strains(pair, g, slopes) for pair in of_n]
        found[n] = Harmonic(of_n, plane.energy(n, np.column_stack(strains)))
    return found


class Plane:
    """A ring that is strained in its plane, and displacements that relax it.

    radii : of its edges, m
    h, E, nu : thickness (m), Young's modulus (Pa), Poisson's ratio
    held : the edge that cannot move in the plane, 1 for the inner one, -1 for the outer one, 0 for none
    degree : of the Legendre polynomials in U and V
    """

    def __init__(
        self, radii: tuple[float, float], h: float, E: float, nu: float, held: int, degree: int
    ) -> None:
        x, weights = legendre.leggauss(3 * degree)
        half = (radii[1] - radii[0]) / 2
        self.r = radii[0] + half * (x + 1)
        self._nu = nu
        # the square of a strain's norm is its energy over pi
        self._root = np.sqrt(E * h / (1 - nu**2) * half * weights * self.r)

        values = legendre.legvander(x, degree)
        slopes = legendre.legval(x, legendre.legder(np.eye(degree + 1))).T / half
        if held:
            share = ((1 + held * x) / 2)[:, None]
            slopes = held * values / (2 * half) + share * slopes
            values = share * values
        self._values = values
        self._slopes = slopes

    def strains(self, pair: tuple[Wave, Wave], g: Array, slopes: Array) -> Array:
        """Strains of a deflection's pair of waves; g, slopes: amplitudes of the modes at the radii
        r, kg^-1/2, and their derivatives, both (n_modes, len(r))."""
        one, other = pair
        share = 0.5 if one == other else 1.0
        along = share * slopes[one.mode] * slopes[other.mode]
        across = -share * one.n * other.n * g[one.mode] * g[other.mode] / self.r**2
        shear = (
            one.n * g[one.mode] * slopes[other.mode] + other.n * g[other.mode] * slopes[one.mode]
        )
        return self._scaled(along, across, share * shear / self.r)

    def energy(self, n: int, strains: Array) -> Array:
        """The matrix G of strains of the harmonic n, in columns, after displacements have relaxed
        what they can."""
        over_r = self._values / self.r[:, None]
        along = np.hstack([self._slopes, np.zeros_like(over_r)])
        across = np.hstack([over_r, -n * over_r])
        shear = np.hstack([n * over_r, self._slopes - over_r])
        vectors, sizes, _ = np.linalg.svd(self._scaled(along, across, shear), full_matrices=False)
        span = vectors[:, sizes > 1e-12 * sizes[0]]  # without rigid motions
        left = strains
        for _ in range(2):  # the second time against rounding
            left = left - span @ (span.T @ left)
        return np.pi * min(n + 1, 2) * left.T @ left

    def _scaled(self, along: Array, across: Array, shear: Array) -> Array:
        """Strains e_r, e_t and gamma / i at the nodes, one below the other."""
        nu = self._nu
        root = self._root.reshape(-1, *[1] * (along.ndim - 1))
        along = root * (along + nu * across)
        across = root * np.sqrt(1 - nu**2) * across
        return np.concatenate([along, across, root * np.sqrt((1 - nu) / 2) * shear])


# ---- In real coordinates


def quartic_form(p: Parameters) -> Array:
    """The symmetric tensor T with V4 = T q q q q / 4, q being a of all modes and b of those with
    nodal diameters, in the order of `plate_modes`; shape (n, n, n, n). The membrane's force on q
    is T q q q."""
    return _quartic_form(
        Parameters(N=0, Omega=0, **{name: getattr(p, name) for name in _OF_FORM.split()})
    )


@lru_cache(maxsize=16)
def _quartic_form(p: Parameters) -> Array:
    """As `quartic_form`, cached by the values on which it depends."""
    diameters = mode_arrays(p).diameters
    across = np.cumsum(diameters > 0) + len(diameters) - 1  # place of b
    count = int(across[-1]) + 1

    def coordinates(wave: Wave) -> Array:
        """z of a wave as a combination of the coordinates."""
        z = np.zeros(count, complex)
        z[wave.mode] = 1.0
        if wave.n:
            z[wave.mode] = 0.5
            z[across[wave.mode]] = -0.5j * np.sign(wave.n)
        return z

    form = np.zeros((count**2, count**2))
    for harmonic in harmonics(p).values():
        products = []
        for one, other in harmonic.pairs:
            product = np.outer(coordinates(one), coordinates(other))
            products.append(((product + product.T) / 2).ravel())
        rows = np.array(products)
        form += (rows.conj().T @ harmonic.G @ rows).real
    paired = form.reshape(4 * (count,))
    T = 4 / 3 * (paired + paired.transpose(0, 2, 1, 3) + paired.transpose(0, 3, 2, 1))
    T.setflags(write=False)
    return T
