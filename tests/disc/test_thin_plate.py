"""Where Kirchhoff's plate is valid: its frequencies against those of Mindlin's waves."""

import math

import numpy as np
import pytest

import disc_model as dm
from disc_model import Parameters
from disc_model.disc.thin_plate import excess_of_thin_plate, shortest_wave

STEEL = {"E": 210e9, "rho": 7850.0, "nu": 0.3, "h": 6e-3}


def mindlin(wavenumber: float, h: float, nu: float, E: float, rho: float) -> float:
    """Lowest frequency of a wave, from the three equations of motion of Mindlin's plate in SI units:
    deflection, and rotation along the wave."""
    shear = math.pi**2 / 12 * E / (2 * (1 + nu)) * h
    bending = E * h**3 / (12 * (1 - nu**2))
    stiffness = [
        [shear * wavenumber**2, shear * wavenumber],
        [shear * wavenumber, bending * wavenumber**2 + shear],
    ]
    mass = np.diag([rho * h, rho * h**3 / 12])
    squares = np.linalg.eigvals(np.linalg.solve(mass, stiffness))
    return math.sqrt(min(squares.real))


@pytest.mark.parametrize("length", [100.0, 27.0, 8.0, 4.0])
@pytest.mark.parametrize("nu", [0.211, 0.3])
def test_the_excess_is_that_over_mindlin_s_waves(length: float, nu: float) -> None:
    h, E, rho = 6e-3, 210e9, 7850.0
    wavenumber = math.tau / (length * h)
    kirchhoff = wavenumber**2 * math.sqrt(E * h**2 / (12 * (1 - nu**2) * rho))
    excess = kirchhoff / mindlin(wavenumber, h, nu, E, rho) - 1
    found = float(excess_of_thin_plate(np.array((wavenumber * h) ** 2), nu))
    # the eigenvalues of the two equations are known to 1e-11 of the higher one
    assert found == pytest.approx(excess, abs=1e-6)


def test_long_waves_have_the_leading_term() -> None:
    squared = (math.tau / 100) ** 2
    leading = (1 + 2 / (math.pi**2 / 12 * 0.7)) / 24 * squared
    # the next term is of the order of its square
    assert float(excess_of_thin_plate(np.array(squared), 0.3)) == pytest.approx(leading, rel=5e-3)
    assert leading == pytest.approx(7.36e-4, rel=1e-3)


def test_the_paper_s_modes_are_long_and_those_of_a_thick_disc_are_short() -> None:
    wave = shortest_wave(Parameters(N=385, Omega=15))
    assert wave is not None
    assert (wave.diameters, wave.circles) == (4, 0)
    assert wave.length == pytest.approx(77.9, rel=1e-3)
    assert wave.excess == pytest.approx(1.1e-3, rel=0.01)
    steel = Parameters(N=5000, Omega=60, n_diameters=10, n_circles=3, **STEEL)
    short = shortest_wave(steel)
    assert short is not None
    assert (short.diameters, short.circles) == (10, 3)
    assert short.length == pytest.approx(5.4, rel=0.01)
    assert short.excess == pytest.approx(0.22, rel=0.03)


def test_a_disc_without_a_plate_has_no_wavelength() -> None:
    disc = dm.Disc(diameters=[40], omega=[9e5], amplitude=[1.0])
    assert shortest_wave(Parameters(N=385, Omega=15, disc=disc, r_0=0.1)) is None
    assert shortest_wave(Parameters(N=385, Omega=15, n_diameters=-1)) is None
