"""The membrane of a plate that stretches, against textbooks and an own computation."""

import numpy as np
import pytest

from disc_model import Disc, ParameterError, Parameters, plate_modes
from disc_model.disc.membrane import Plane, Wave, harmonics, quartic_form
from disc_model.disc.stretched import membrane_forces, stretched
from tests.references.membrane import Membrane

P = Parameters(N=200, Omega=50, normalization="orthonormal", stretching="clamped")


def stiffening(held):
    """A of w/h + A (w/h)^3, a solid plate under a uniform load, its edge clamped against bending."""
    plane = Plane((1e-9, 1.0), h=1.0, E=1.0, nu=0.3, held=held, degree=24)
    r = plane.r
    shape, slope = (1 - r**2) ** 2, -4 * r * (1 - r**2)
    pair = Wave(0, 0), Wave(0, 0)
    [[G]] = plane.energy(0, plane.strains(pair, shape[None], slope[None])[:, None])
    bending = 64 * np.pi / 3 / 12 / (1 - 0.3**2)
    return 4 * G / bending


def test_timoshenko():
    """Theory of plates and shells, 1959, Section 97: edge immovable, and movable."""
    assert stiffening(-1) == pytest.approx(0.47125, abs=1e-12)
    assert stiffening(0) == pytest.approx(0.14625, abs=1e-12)


@pytest.mark.parametrize("edge", ["clamped", "free"])
def test_coefficients_of_an_own_computation(edge):
    """By the strong form of equilibrium and collocation."""
    other = Membrane(P, edge)
    for n, harmonic in harmonics(P.replace(stretching=edge)).items():
        pairs, G = other.coefficients(n)
        numbers = [sorted((one.n, two.n)) for one, two in harmonic.pairs]
        order = [numbers.index(sorted(pair)) for pair in pairs]
        sizes = np.sqrt(np.diag(G))
        np.testing.assert_allclose(
            harmonic.G[np.ix_(order, order)] / np.outer(sizes, sizes),
            G / np.outer(sizes, sizes),
            atol=1e-7,
        )


def turned(p, q, angle):
    """Coordinates q, a then b, in a frame that is turned."""
    l = plate_modes(p)["diameters"].to_numpy()
    a = q[: len(l)]
    b = np.zeros(len(l))
    b[l > 0] = q[len(l) :]
    c, s = np.cos(l * angle), np.sin(l * angle)
    return np.concatenate([a * c + b * s, (b * c - a * s)[l > 0]])


@pytest.mark.parametrize("size", [(4, 0), (3, 1), (2, 3)])
@pytest.mark.parametrize("edge", ["clamped", "free"])
def test_energy_does_not_change_by_rotation(edge, size):
    p = P.replace(stretching=edge, n_diameters=size[0], n_circles=size[1])
    T = quartic_form(p)
    q = np.random.default_rng(3).standard_normal(len(T))
    energies = [T @ x @ x @ x @ x for x in (turned(p, q, angle) for angle in (0, 0.3, 2.0, -1.1))]
    np.testing.assert_allclose(energies, energies[0], rtol=1e-14)
    a = q[: len(plate_modes(p))]
    b = np.zeros_like(a)
    b[plate_modes(p)["diameters"] > 0] = q[len(a) :]
    along, across = membrane_forces(p, a[:, None], b[:, None])
    assert np.sum(a * along[:, 0] + b * across[:, 0]) == pytest.approx(energies[0], rel=1e-13)


def test_stiffening_in_one_mode():
    """Force over displacement at r_0 when w(r_0) = h, over the linear one, l = 0 to 4."""
    expected = {
        "clamped": [1.522, 1.093, 1.224, 2.063, 2.764],
        "free": [1.344, 1.041, 1.173, 1.802, 2.351],
    }
    modes = plate_modes(P)
    for edge, wanted in expected.items():
        T = quartic_form(P.replace(stretching=edge))
        q = P.h / modes["psi"].to_numpy()
        own = np.array([T[i, i, i, i] for i in range(5)])
        ratio = 1 + own * q**2 / modes["omega"].to_numpy() ** 2
        np.testing.assert_allclose(ratio, wanted, atol=6e-4)


@pytest.mark.parametrize(
    ("norm", "N", "deflection"),
    [
        ("as_published", 385, 3.535145116789251e-3),
        ("as_published", 300, 3.116e-3),
        ("as_published", 200, 2.536e-3),
        ("orthonormal", 200, 1.054001847930699e-3),
        ("orthonormal", 600, 3.121e-3),
        ("orthonormal", 800, 4.118e-3),
    ],
)
def test_static_deflection(norm, N, deflection):
    p = P.replace(N=N, normalization=norm)
    exact = len(str(deflection)) > 12
    found = stretched(p).rest @ plate_modes(p)["psi"]
    assert -found == pytest.approx(deflection, abs=1e-15 if exact else 5e-7)


def test_softness_is_the_slope_of_the_static_deflection():
    def height(N):
        return stretched(P.replace(N=N)).rest @ plate_modes(P)["psi"]

    slope = (height(400.0) - height(399.0) + height(401.0) - height(400.0)) / 2
    assert stretched(P.replace(N=400)).softness == pytest.approx(-slope, rel=1e-5)


def test_refusals():
    disc = Disc(diameters=[1], omega=[1500.0], amplitude=[2.0])
    with pytest.raises(ParameterError, match="stretching='clamped': must be left out where a disc"):
        Parameters(N=1, Omega=1, disc=disc, stretching="clamped")
    with pytest.raises(ParameterError, match="must be none for more than 52 coordinates"):
        stretched(P.replace(n_diameters=30))
