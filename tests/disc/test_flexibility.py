"""Residual flexibility against modal sums and against collocation, which shares neither code nor
functions with it."""

import numpy as np
import pytest
from numpy.polynomial import chebyshev

from disc_model import Disc, Parameters, plate_modes
from disc_model.disc import flexibility as module
from disc_model.disc.flexibility import harmonic_flexibility, residual_flexibility
from tests.references.growth import pad_means

P = Parameters(N=385, Omega=15.1, normalization="orthonormal")


@pytest.mark.parametrize(
    ("diameters", "circles", "known"),
    [
        (20, 5, 5.5833e-6),
        (40, 10, 5.5927e-6),
        pytest.param(60, 20, 5.5945e-6, marks=pytest.mark.slow),
    ],
)
def test_modal_sums_approach_the_total_from_below(
    diameters: int, circles: int, known: float
) -> None:
    p = P.replace(n_diameters=diameters, n_circles=circles)
    flexibility = residual_flexibility(p)
    modes = plate_modes(p)
    assert flexibility.kept == pytest.approx(known, abs=5.1e-11)
    assert flexibility.kept == pytest.approx(
        float(((modes.psi / modes.omega) ** 2).sum()), rel=1e-14
    )
    assert 0 < flexibility.residual < 0.003 * flexibility.total


def collocated(l: int, inner: float, load: float, nu: float, degree: int = 36) -> float:
    """Deflection of the harmonic at a unit load by Chebyshev collocation on both sides of it, in
    units of b^2 / D."""
    matrix = []
    right = []
    size = degree + 1

    def derivatives(low: float, high: float, r: np.ndarray) -> np.ndarray:
        """(5, len(r), size): the polynomials' derivatives 0 to 4 on [low, high] at r."""
        basis = np.eye(size)
        out = []
        for k in range(5):
            columns = basis
            if k:
                columns = chebyshev.chebder(basis, k)
            out.append(
                chebyshev.chebval((2 * r - low - high) / (high - low), columns).T
                * (2 / (high - low)) ** k
            )
        return np.array(out)

    def add(sides: list, value: float) -> None:
        matrix.append(np.concatenate(sides))
        right.append(value)

    zero = np.zeros(size)
    for i, (low, high) in enumerate(((inner, load), (load, 1.0))):
        nodes = (low + high) / 2 + (high - low) / 2 * np.cos(
            np.pi * (np.arange(size - 4) + 0.5) / (size - 4)
        )
        d = derivatives(low, high, nodes)
        r = nodes[:, None]
        factor = 1 + 2 * l**2
        highest = d[4] + 2 / r * d[3]
        plate = highest - factor / r**2 * d[2] + factor / r**3 * d[1]
        plate += (l**4 - 4 * l**2) / r**4 * d[0]
        for row in plate:
            both = [zero, row]
            if i == 0:
                both = [row, zero]
            add(both, 0.0)
    clamp = derivatives(inner, load, np.array([inner]))[:, 0]
    free = derivatives(load, 1.0, np.array([1.0]))[:, 0]
    left, after = (
        derivatives(*ends, np.array([load]))[:, 0] for ends in ((inner, load), (load, 1.0))
    )
    add([clamp[0], zero], 0.0)
    add([clamp[1], zero], 0.0)
    add([zero, free[2] + nu * (free[1] - l**2 * free[0])], 0.0)
    square = l**2
    value, slope, second, third = free[:4]
    slope_of_laplacian = third + second - (1 + square) * slope + 2 * square * value
    add([zero, slope_of_laplacian - (1 - nu) * l**2 * (free[1] - free[0])], 0.0)
    for k, jump in enumerate((0.0, 0.0, 0.0, 1 / load)):
        add([-left[k], after[k]], jump)
    scale = np.abs(matrix).max(axis=1)
    solution = np.linalg.solve(np.array(matrix) / scale[:, None], np.array(right) / scale)
    return float(after[0] @ solution[size:])


@pytest.mark.parametrize("l", [0, 1, 2, 3, 7, 12])
@pytest.mark.parametrize(
    ("inner", "load", "nu"),
    [(0.044 / 0.12, 0.1 / 0.12, 0.211), (0.2, 0.97, -0.4), (0.6, 0.7, 0.45)],
)
def test_harmonics_against_collocation(l: int, inner: float, load: float, nu: float) -> None:
    # fourth derivatives of degree 36: about 36^4 roundings
    own = harmonic_flexibility(np.array([l]), inner, load, nu)[0]
    assert own == pytest.approx(collocated(l, inner, load, nu), rel=1e-9)


@pytest.mark.parametrize("arc", [0.1, 0.4, 2.0])
def test_a_pad_deflects_the_plate_by_the_mean_over_its_arc(arc: float) -> None:
    """Of the deflection under a load that is spread over the arc: a double integral of that at a
    distance x from a point load, or, with the other half of the square, 2 int (1 - x/arc) w dx/arc."""
    l = np.arange(module.HIGHEST_HARMONIC + 1)
    harmonics = harmonic_flexibility(l, P.a / P.b, P.r_0 / P.b, P.nu)
    harmonics[0] /= 2
    nodes, weights = np.polynomial.legendre.leggauss(3000)
    x = arc * (nodes + 1) / 2
    mean = 0.0
    for place, weight in zip(x, weights, strict=True):
        mean += weight * (1 - place / arc) * float(np.cos(l * place) @ harmonics) / np.pi
    wanted = mean * P.b**2 / P.D
    flexibility = residual_flexibility(P.replace(contact_arc=arc))
    assert flexibility.total == pytest.approx(wanted, rel=1e-10)
    kept = plate_modes(P)
    means = pad_means(kept["diameters"], arc)
    assert flexibility.kept == pytest.approx(
        float(((means * kept.psi / kept.omega) ** 2).sum()), rel=1e-13
    )
    assert 0 < flexibility.residual < residual_flexibility(P).residual


@pytest.mark.parametrize(
    ("r_0", "arc", "error"),
    [
        (0.045, 0, 1e-4),
        (0.1, 0, 1e-13),
        (0.119, 0, 1e-6),
        (0.12, 0, 1e-7),
        (0.1, 1e-4, 1e-8),
        (0.1, 0.03, 1e-7),
        (0.1, 0.4, 1e-8),
        (0.1, 5.0, 1e-10),
    ],
)
def test_few_harmonics_are_enough(
    r_0: float, arc: float, error: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Near an edge higher harmonics differ from the unbounded plate's: the hardest place. Here 256
    of the 4096 that are summed."""
    monkeypatch.setattr(module, "_deflection", module._deflection.__wrapped__)  # not from the cache
    p = P.replace(r_0=r_0, contact_arc=arc)
    found = residual_flexibility(p).total
    monkeypatch.setattr(module, "HIGHEST_HARMONIC", 256)
    assert residual_flexibility(p).total == pytest.approx(found, rel=error)
    # to the last bit: factors of two
    larger = p.replace(a=2 * p.a, b=2 * p.b, r_0=2 * r_0)
    assert residual_flexibility(larger).total == 4 * residual_flexibility(p).total


def test_residual_flexibility_of_published_modes_falls_as_modes_are_added() -> None:
    p = P.replace(normalization="as_published")
    found = [residual_flexibility(p.replace(n_diameters=n)) for n in (2, 4, 8)]
    rests = [flexibility.residual for flexibility in found]
    assert rests[0] > rests[1] > rests[2] > 0


def test_a_disc_given_by_its_modes_has_the_flexibility_that_its_table_says() -> None:
    disc = Disc(diameters=[0, 1], omega=[1e3, 2e3], amplitude=[1.0, 4.0], static_compliance=9e-6)
    found = residual_flexibility(Parameters(N=385, Omega=15.1, disc=disc))
    assert found.total == 9e-6
    assert found.kept == pytest.approx(1e-6 + 4e-6, rel=1e-14)
