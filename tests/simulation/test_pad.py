"""A pad that presses evenly over an arc: the mean displacement under it, in every law and disc."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from disc_model import Disc, Parameters, Window, deflection, plate_modes, simulate
from disc_model.disc.plate import mode_arrays, modes_at_point, tangential_amplitudes
from disc_model.stability.sliding import steady_sliding
from tests.blocks import STEEL
from tests.references import taylor
from tests.references.growth import pad_means, steady_eigenvalues
from tests.refusals import refusal

BRAKE = Disc.from_csv(Path("config/discs/brake.csv"))
PLATE = Parameters(N=385, Omega=15.1, friction_offset=0.02)
CASES = {
    "plate as published": PLATE,
    "orthonormal, on the surface": PLATE.replace(
        normalization="orthonormal", n_circles=1, friction_offset="surface"
    ),
    "table, on the surface": Parameters(N=8000, Omega=80, disc=BRAKE, friction_offset="surface"),
    "table, couple alone": Parameters(N=8000, Omega=80, disc=BRAKE, friction_offset=6e-3),
}


@pytest.mark.parametrize("p", CASES.values(), ids=CASES)
@pytest.mark.parametrize("arc", [0.01, 0.4, np.pi, 6.0])
def test_amplitudes_are_means_over_the_arc(p: Parameters, arc: float) -> None:
    """Both that normal to the disc and that along the path, by quadrature."""
    padded = p.replace(contact_arc=arc)
    at_point = mode_arrays(p)
    means = pad_means(at_point.diameters, arc)
    # a quadrature's rounding, of the largest value
    close = {"rtol": 0, "atol": 1e-13 * np.abs(at_point.psi).max()}
    np.testing.assert_allclose(mode_arrays(padded).psi, means * at_point.psi, **close)
    np.testing.assert_allclose(
        tangential_amplitudes(padded), means * tangential_amplitudes(p), **close
    )
    assert modes_at_point(padded) is at_point


def test_a_pad_of_no_arc_is_a_point() -> None:
    assert mode_arrays(PLATE.replace(contact_arc=0.0)) is mode_arrays(PLATE)
    small = steady_sliding(PLATE.replace(contact_arc=1e-5)).growth_rate
    assert small == pytest.approx(steady_sliding(PLATE).growth_rate, abs=1e-9)


@pytest.mark.parametrize(
    ("p", "changes", "phrase"),
    [
        (PLATE, {"contact_arc": -0.1}, r"contact_arc=-0\.1: must be >= 0"),
        (PLATE, {"contact_arc": 2 * np.pi}, r"contact_arc=6\.28.*: must be < 6\.28"),
        (PLATE, {"contact_arc": "wide"}, "contact_arc='wide'"),
        (CASES["table, couple alone"], {"contact_arc": 0.2, "contact_compliance": "residual"},
         "must be a number beside contact_arc"),
    ],
)  # fmt: skip
def test_an_arc_that_is_none_is_refused(p: Parameters, changes: Any, phrase: str) -> None:
    assert PLATE.replace(contact_arc="20 deg").contact_arc == pytest.approx(np.pi / 9, rel=1e-15)
    with refusal(phrase):
        p.replace(**changes)


@pytest.mark.parametrize(("diameters", "growth"), [(4, 1.155), (10, 2.878), (20, 2.888)])
def test_growth_of_steady_sliding_on_steel_converges_under_a_pad(
    diameters: int, growth: float
) -> None:
    """By the equations as they stand; from 10 to 20 diameters within a tenth, where that of a point
    rises from 12 to 31/s. Without nodal circles: three of these raise it to 3.46/s."""
    p = STEEL.replace(n_diameters=diameters, contact_arc=0.4)
    found = steady_sliding(p).growth_rate
    assert found == pytest.approx(growth, abs=1e-3)
    modes = modes_at_point(p)
    psi = pad_means(modes.diameters, 0.4) * modes.psi
    tangential = -p.h / 2 / p.r_0 * modes.diameters * psi
    damping = 2 * p.damping_ratio * modes.omega
    values, _ = steady_eigenvalues(
        p.model_dump(), modes.omega, psi, modes.diameters, damping, tangential
    )
    assert found == pytest.approx(values.real.max(), abs=1e-5)


@pytest.mark.compiled
def test_events_under_a_pad_are_those_of_the_reference() -> None:
    p = PLATE.replace(contact_arc=0.7)
    modes = plate_modes(p.replace(contact_arc=0))
    sign = np.sign(modes["psi"].to_numpy())
    means = pad_means(modes["diameters"], 0.7)
    q = taylor.Problem(
        p.model_dump(), modes["omega"], means * sign * modes["psi"], modes["diameters"],
        offset=p.friction_offset,
    )  # fmt: skip
    reference = taylor.Reference(q, q.equilibrium()).run(0.1)
    result = simulate(p, 0.1, tol=1e-13)
    wanted = [float(event["time"]) for event in reference.events]
    assert len(wanted) >= 10
    np.testing.assert_allclose(result.events["time"], wanted, rtol=0, atol=5e-9)


@pytest.mark.compiled
def test_a_point_of_the_disc_moves_by_its_own_amplitudes() -> None:
    """`w` is the mean under the pad, `w_point` the displacement of a single point: both agree with
    the deflection of the whole disc."""
    p = PLATE.replace(contact_arc=1.0)
    window = {"end": Window(start=0.0499, stop=0.05, rate=1e4, theta=2.0)}
    result = simulate(p, 0.05, window)
    last = result["end"].isel(time=-1)
    state = result.final_state
    at_point = deflection(p, state, [p.r_0], [2.0]).item()
    assert float(last["w_point"]) == pytest.approx(at_point, rel=1e-9)

    nodes, weights = np.polynomial.legendre.leggauss(40)
    angles = state.material_angle(p) + 0.5 * nodes
    around = deflection(p, state, [p.r_0], angles).values[0, 0]
    assert float(last["w"]) == pytest.approx(float(weights @ around) / 2, rel=1e-9)
