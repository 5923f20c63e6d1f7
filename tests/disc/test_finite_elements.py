"""Finite elements of a section: against the plate, and against themselves on finer meshes."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import disc_model as dm
from disc_model.disc.flexibility import residual_flexibility
from disc_model.disc.plate import mode_shapes
from tests import needs

pytestmark = needs.FINITE_ELEMENTS.mark

P = dm.Parameters(N=0, Omega=0, normalization="orthonormal")
PAGE = Path(__file__).parents[2] / "docs" / "brake_disc.md"
RING = [(0.06, 0.1, -0.005, 0.005), (0.1, 0.12, -0.005, 0.005)]
IRON = {"E": P.E, "nu": P.nu, "rho": P.rho}


def ring_by_elements(size: float = 0.01, rectangles: Any = RING, **changes: Any) -> dm.Disc:
    given: dict[str, Any] = {
        "clamped": lambda x: x[0] < 0.06 + 1e-9,
        "slider": (0.1, 0.005),
        "highest_Hz": 3000.0,
    }
    return dm.Disc.from_section(rectangles, size=size, **IRON | given | changes)


def plate_by_elements(highest_Hz: float) -> dm.Disc:
    low = -P.h / 2
    high = P.h / 2
    inside = (P.a, P.r_0, low, high)
    outside = (P.r_0, P.b, low, high)
    halves = [inside, outside]
    slider = (P.r_0, P.h / 2)

    def clamped(x):
        return x[0] < P.a + 1e-9

    return ring_by_elements(P.h, halves, clamped=clamped, slider=slider, highest_Hz=highest_Hz)


@pytest.mark.slow
def test_the_static_deflection_of_the_plate_is_confirmed() -> None:
    """All modes up to 20 kHz, of which those of the plate leave out 0.3 % of its closed form."""
    disc = plate_by_elements(2e4)
    found = np.sum((np.array(disc.amplitude) / disc.omega) ** 2)
    assert found == pytest.approx(residual_flexibility(P).total, rel=5e-3)


def test_the_plate_is_confirmed() -> None:
    """Three-dimensional elasticity of a thin annulus: Kirchhoff's theory is off by (h / wave
    length)^2, some 0.3 %."""
    disc = plate_by_elements(1000)
    plate = dm.plate_modes(P)
    assert list(disc.diameters) == plate["diameters"].tolist()
    np.testing.assert_allclose(disc.omega, plate["omega"], rtol=5e-3)
    np.testing.assert_allclose(disc.amplitude, plate["psi"], rtol=5e-3)
    shapes = mode_shapes(P, np.array(disc.radii))
    errors = np.abs(disc.shapes - shapes)
    largest = np.abs(shapes).max(axis=1, keepdims=True)
    assert np.all(errors < 5e-3 * largest)


def test_a_slender_ring_bends_and_twists_as_in_the_textbook() -> None:
    """Love's ring of square section, here on a thin web; shear, which he leaves out, and the web
    take up to 4 %."""
    R = 0.15
    h = 0.01
    web = (0.05, R - h / 2, 0.485 * h, 0.515 * h)
    ring = [(R - h / 2, R, 0, h), (R, R + h / 2, 0, h)]
    clamped = lambda x: x[0] < 0.05 + 1e-9  # noqa: E731
    disc = ring_by_elements(0.005, [web, *ring], clamped=clamped, slider=(R, h), highest_Hz=1400)
    for n in (2, 3, 4):
        twist = 2 * (1 + P.nu) / (12 * 0.1406)  # E I / (G J)
        omega = np.sqrt(P.E * h**2 / (12 * P.rho * R**4) * n**2 * (n**2 - 1) ** 2 / (n**2 + twist))
        modes = [
            (a, w)
            for l, a, w in zip(disc.diameters, disc.amplitude, disc.omega, strict=True)
            if l == n
        ]
        half_mass = P.rho * h**2 * np.pi * R
        amplitude = 1 / np.sqrt(half_mass)
        assert max(modes) == pytest.approx((amplitude, omega), rel=0.05)


@pytest.mark.parametrize(
    ("change", "phrase"),
    [
        ({"slider": (0.0999, 0.005)}, "slider=(0.0999, 0.005): must be a node of the mesh"),
        (
            {"E": -1.0, "nu": 0.5, "rho": 0},
            "E=-1: must be > 0; nu=0.5: must be < 0.5; rho=0: must be > 0",
        ),
        ({"highest_Hz": 1.0}, "highest_Hz=1: must be above a mode that moves under the slider"),
        (
            {"clamped": lambda x: x[0] < 0.05},
            "clamped=0: must hold nodes of the section: coordinates are in m",
        ),
    ],
)
def test_what_cannot_be_found_is_said(change: dict[str, Any], phrase: str) -> None:
    with pytest.raises(dm.ParameterError) as error:
        ring_by_elements(**change)
    assert phrase in str(error.value)


def test_a_slider_on_the_lower_face_sees_what_one_on_the_upper_face_sees() -> None:
    """A ring is the same from both sides; the tangential amplitude of the lower face had the other
    sign."""
    upper, lower = (ring_by_elements(slider=(0.1, side * 0.005)) for side in (1, -1))
    assert upper.diameters == lower.diameters
    assert max(map(abs, upper.tangential)) > 0.1
    for name in ("omega", "amplitude", "tangential"):
        np.testing.assert_allclose(getattr(lower, name), getattr(upper, name), rtol=1e-6, atol=1e-9)


def test_the_page_does_what_it_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The table, the section and the case of the page, as they stand there."""
    text = PAGE.read_text(encoding="utf-8")
    table, first, drawing, *_ = re.findall(r"```(?:text|python)\n(.*?)```", text, re.DOTALL)
    monkeypatch.chdir(tmp_path)
    Path("disc.csv").write_text(table)
    phrase: dict[str, object] = {}
    of_table = dm.Disc.from_csv("disc.csv")
    exec(first + drawing, phrase)
    disc = phrase["disc"]
    assert isinstance(disc, dm.Disc)
    assert dm.Disc.from_csv("disc.csv") == disc.replace(radii=(), shapes=())
    count = len(of_table.omega)
    np.testing.assert_allclose(disc.omega[:count], of_table.omega, rtol=0.01)
    np.testing.assert_allclose(disc.amplitude[:count], of_table.amplitude, rtol=0.01)


def test_the_brake_disc_of_the_studies_is_that_of_the_page() -> None:
    """Its elements are 2.5 mm; with 5 mm frequencies are off by 1 % at most, as the page says,
    amplitudes by 2 %."""
    wall = (0.067, 0.075, -0.04, 0.012)
    flange = (0.035, 0.067, -0.04, -0.032)
    drawing = [(0.075, 0.1, 0, 0.012), (0.1, 0.135, 0, 0.012), wall, flange]
    for a, b, *_ in drawing:
        assert f"{a:.3f}, {b:.3f}" in PAGE.read_text(encoding="utf-8")
    changes = {
        "E": 110e9,
        "nu": 0.26,
        "clamped": lambda x: x[0] < 0.035 + 1e-9,
        "slider": (0.1, 0.012),
    }
    disc = ring_by_elements(0.005, drawing, **changes)
    stored = dm.Disc.from_csv(PAGE.parents[1] / "config" / "discs" / "brake.csv")
    count = len(disc.omega)
    assert stored.diameters[:count] == disc.diameters
    assert stored.omega[:count] == pytest.approx(disc.omega, rel=0.01)
    assert stored.amplitude[:count] == pytest.approx(disc.amplitude, rel=0.02)
    assert stored.tangential[:count] == pytest.approx(disc.tangential, rel=0.02)
