"""Disc modes against the paper's numbers and against Rayleigh-Ritz, which shares no code and no
method."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from disc_model import Disc, ModeError, Parameters, coupled_natural_frequencies, plate_modes
from disc_model.disc import plate as plate_module
from disc_model.disc.flexibility import residual_flexibility
from disc_model.disc.plate import (
    coupled_frequencies,
    coupled_shapes,
    modal_damping,
    mode_arrays,
    mode_shapes,
)
from tests.references.ritz import ritz_lambdas

P = Parameters(N=385, Omega=15.1)
ORTHONORMAL = P.replace(normalization="orthonormal")
EXTREMES = yaml.safe_load(Path(__file__).with_name("plate_extremes.yaml").read_text())


def lambdas(p: Parameters) -> np.ndarray:
    """lambda = beta b of `plate_modes`, (circles, diameters)."""
    omega = plate_modes(p).omega.to_numpy()
    return ((p.rho * p.h / p.D) ** 0.25 * np.sqrt(omega) * p.b).reshape(
        p.n_circles + 1, p.n_diameters + 1
    )


def test_modes_of_the_free_disc_agree_with_the_paper() -> None:
    omega, psi = plate_modes(P)[["omega", "psi"]].to_numpy().T
    assert_allclose(omega, [1491.927, 1516.757, 1823.881, 2774.194, 4383.044], rtol=0, atol=5.1e-4)
    assert_allclose(psi**2, [1.70575, 66.79457, 2.35417, 1.32275, 0.96751], rtol=0, atol=5.1e-6)
    # what the modes give way under a unit force
    each = psi**2 / omega**2
    total = float(np.sum(each))
    assert mode_arrays(P).flexibility == pytest.approx(total, rel=1e-14)


def test_slider_at_rest_agrees_with_the_papers_ten_numbers() -> None:
    # Section 4.4 prints nine numbers for the slider at rest and repeats the highest of the free
    # disc.
    paper = [850.86, 1492.55, 1516.76, 1814.90, 1823.88, 2758.02, 2774.19, 4360.49, 4383.04]
    assert [f"{value:.2f}" for value in coupled_natural_frequencies(P)] == [
        f"{value:.2f}" for value in paper
    ]


@pytest.mark.parametrize(("p", "lowest"), [(P, 850.864), (ORTHONORMAL, 1178.65)])
def test_coupled_frequencies_are_the_shifted_ones(p: Parameters, lowest: float) -> None:
    mine = coupled_frequencies(p)
    assert mine[0] == pytest.approx(lowest, abs=0.01)
    partners = plate_modes(p).query("diameters > 0")["omega"]
    assert_allclose(np.sort([*mine, *partners]), coupled_natural_frequencies(p), rtol=1e-12)


@pytest.mark.parametrize("give", [0.0, 2.5e-7])
def test_coupled_shapes_solve_the_equations_of_motion(give: float) -> None:
    """In rigid contact u is the disc's; on a compliant one it is a coordinate, and the contact is a
    spring."""
    modes = mode_arrays(P)
    n = 5
    frequencies, shapes = coupled_shapes(P, give)
    assert_allclose(frequencies[::-1], coupled_frequencies(P, give), rtol=1e-12)
    if give == 0:
        slider = np.append(modes.psi, 0)
    else:
        slider = np.eye(n + 1)[n]
    stiff = np.diag(np.append(modes.omega**2, 0)) + P.k * np.outer(slider, slider)
    inert = np.diag(np.append(np.ones(n), 0)) + P.m * np.outer(slider, slider)
    if give:
        stretch = np.append(modes.psi, -1)
        stiff += np.outer(stretch, stretch) / give
    # rows: each mode times its frequency, and u over the root of the compliance
    v = np.zeros((n + 1, len(frequencies)))
    v[: len(shapes)] = shapes * np.append(1 / modes.omega, np.sqrt(give))[: len(shapes), None]
    # rounding of a problem whose condition is (highest frequency / lowest)^2, about 30
    left = stiff @ v
    right = inert @ v * frequencies**2
    largest = np.abs(left).max()
    assert_allclose(left, right, atol=1e-12 * largest)


def test_modal_damping_is_twice_the_share_of_critical_damping_times_the_frequency() -> None:
    # 2 xi omega of the lowest mode: 1e-5 N m s over D = 104.66 N m times (1491.927 rad/s)^2
    assert modal_damping(P)[0] == pytest.approx(0.212676, rel=1e-5)
    assert_allclose(modal_damping(P.replace(D_star=0)), 0)
    given = Disc(
        diameters=[0, 1], omega=[1e3, 2e3], amplitude=[1.0, 2.0], damping_ratio=[1e-3, 0.0]
    )
    assert_allclose(modal_damping(P.replace(damping_ratio=1e-3)), 2e-3 * mode_arrays(P).omega)
    assert_allclose(modal_damping(Parameters(N=385, Omega=15.1, disc=given)), [2.0, 0.0])


def test_the_surface_moves_along_as_normals_of_the_middle_plane_turn() -> None:
    """By -z/r_0 dw/dtheta; what a table says of the surface replaces that."""
    given = P.replace(
        disc=Disc(diameters=[0, 2], omega=[1e3, 2e3], amplitude=[1.0, -3.0], tangential=[0.0, 0.2])
    )
    for p, offset, z in ((P, 0.003, 0.003), (P, "surface", P.h / 2), (given, 0.003, 0.003)):
        slope = (
            mode_arrays(p).psi * np.sin(1e-9 * mode_arrays(p).diameters) / 1e-9
        )  # of w under the slider
        found = plate_module.tangential_amplitudes(p.replace(friction_offset=offset))
        assert_allclose(found, -z / p.r_0 * slope, rtol=1e-14)
    assert list(plate_module.tangential_amplitudes(given.replace(friction_offset="surface"))) == [
        0.0,
        0.2,
    ]


@given(st.floats(0.03, 0.97), st.floats(-0.8, 0.49), st.integers(0, 20))
def test_any_disc_agrees_with_ritz(inner: float, nu: float, l: int) -> None:
    p = P.replace(a=inner * P.b, r_0=P.b, nu=nu, n_diameters=l, n_circles=4)
    ratio = p.a / p.b
    found = lambdas(p)
    expected = ritz_lambdas(ratio, nu, l, 5)
    assert_allclose(found[:, l], expected, rtol=1e-8)


def test_highest_numbers_of_diameters_and_circles_do_not_overflow() -> None:
    p = P.replace(n_diameters=60, n_circles=20)
    modes = plate_modes(p)
    assert len(modes) == 61 * 21
    assert np.all(np.isfinite(modes.psi))
    assert np.all(np.diff(lambdas(p), axis=0) > 0)
    ratio = p.a / p.b
    found = lambdas(p)
    expected = ritz_lambdas(ratio, p.nu, 60, 3)
    assert_allclose(found[:3, 60], expected, rtol=1e-8)


def shape_on_nodes(p: Parameters, nodes: np.ndarray) -> np.ndarray:
    """R(r) of every mode at many radii, taken from `plate_modes` by moving the slider, (nodes,
    modes)."""
    scale = np.sqrt(p.rho * p.h * p.b**2)
    modes = [plate_modes(p.replace(r_0=r)) for r in nodes]
    return np.array([m.psi / np.where(m.diameters > 0, np.sqrt(2), 1) for m in modes]) * scale


@pytest.mark.parametrize("inner", [0.02, 0.3667, 0.9])
@pytest.mark.parametrize("nu", [-0.9, 0.211, 0.49])
def test_orthonormal_modes_are_positive_at_the_free_edge(inner: float, nu: float) -> None:
    """None vanishes there, or the sign would be rounding: a quarter of the largest deflection is
    the least."""
    p = ORTHONORMAL.replace(a=inner * P.b, r_0=P.b, nu=nu, n_diameters=20, n_circles=10)
    shapes = mode_shapes(p, np.linspace(p.a, p.b, 300))
    largest = np.abs(shapes).max(axis=1)
    at_edge = shapes[:, -1]
    assert np.all(at_edge > 0.25 * largest)


def test_orthonormal_shapes_satisfy_eq_17() -> None:
    p = ORTHONORMAL.replace(n_diameters=3, n_circles=2)
    x, w = np.polynomial.legendre.leggauss(40)
    half = (p.b - p.a) / 2
    r = p.a + half * (x + 1)
    R = shape_on_nodes(p, r).reshape(r.size, 3, 4)
    gram = 2 * np.pi / p.b**2 * np.einsum("i,icl,idl->lcd", w * half * r, R, R)
    assert_allclose(gram, np.tile(np.eye(3), (4, 1, 1)), atol=1e-12)


def test_a_wrong_root_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    roots = plate_module._roots
    monkeypatch.setattr(plate_module, "_roots", lambda *given: roots(*given[:3], given[3] + 1)[1:])
    with pytest.raises(ModeError, match="missed or doubled"):
        plate_modes(P.replace(nu=0.2123))  # of no other test: nothing is remembered of it


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("normalization", ["as_published", "orthonormal"])
@pytest.mark.parametrize(("changes", "text"), EXTREMES)
def test_extremes_are_one_clear_error(
    changes: dict[str, float], text: str, normalization: str
) -> None:
    p = P.replace(normalization=normalization, **changes)
    with pytest.raises(ModeError, match=text):
        _ = residual_flexibility(p), coupled_natural_frequencies(p)
