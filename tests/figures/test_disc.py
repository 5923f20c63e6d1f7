"""The whole disc in pictures: deflections, the place of the slider, and scales in millimetres."""

import functools

import numpy as np
import pytest
from matplotlib import pyplot

import disc_model as dm
from disc_model.figures import disc
from disc_model.figures.drawing import SEPARATED, SLIDER
from disc_model.simulation.api import snapshots
from tests.references.printed import P as LIVELY
from tests.references.printed import lively

P = dm.Parameters(N=385, Omega=15.1)
TIMES = [0.11, 0.23, 0.9]  # after more than a turn in the end
ANGLES = np.array([0.0, 0.7, 2.9, 5.1])


@functools.cache
def states() -> tuple[dm.State, ...]:
    return tuple(snapshots(P, TIMES))


def motion() -> disc.Motion:
    return disc.Motion.of(P, states())


@pytest.mark.parametrize("radii", [None, [0.06, 0.12]])
def test_a_picture_has_the_deflection_of_the_disc_at_its_angles(radii: list[float] | None) -> None:
    """Angles are fixed to the disc, as those of `deflection`."""
    shown = motion()
    for i, state in enumerate(states()):
        if radii is None:
            drawn = shown.deflection(i, None, ANGLES)[0]
            expected = dm.deflection(P, state, P.r_0, ANGLES).values
        else:
            drawn = shown.deflection(i, np.array(radii), ANGLES)
            expected = [dm.deflection(P, state, r, ANGLES).values.ravel() for r in radii]
        np.testing.assert_allclose(drawn, np.reshape(expected, drawn.shape), rtol=0, atol=1e-15)


def test_the_disc_lies_where_the_material_is() -> None:
    """By the slider's own angle the shape of a disc whose surface moves would lie elsewhere."""
    p = LIVELY.replace(friction_offset=0.02)
    state = lively("slip", 1, p).replace(surface_turn=0.3)
    shown = disc.Motion.of(p, [state])
    expected = dm.deflection(p, state, [p.r_0], ANGLES)[0]
    np.testing.assert_allclose(shown.deflection(0, None, ANGLES), expected, rtol=1e-12)
    under = shown.deflection(0, None, shown.slider)
    assert under.item() == pytest.approx(state.u, rel=1e-12)


def test_the_slider_stands_on_the_disc_under_it() -> None:
    shown = motion()
    for i, state in enumerate(states()):
        under = shown.deflection(i, None, shown.slider[i : i + 1])[0, 0]
        assert under == pytest.approx(state.u, abs=1e-14), "in contact"


def test_the_scale_of_a_film_holds_its_largest_deflection_on_both_sides() -> None:
    shown = motion()
    scale = disc.scale_of(shown)
    around = np.linspace(0, 2 * np.pi, 181)
    edge = np.array([P.b])
    largest = max(np.abs(shown.deflection(i, edge, around)).max() for i in range(len(TIMES)))
    assert scale.vmax == pytest.approx(1e3 * largest)
    assert scale.vmin == -scale.vmax


def test_the_disc_from_above_is_in_millimetres_with_the_slider_at_its_angle() -> None:
    shown = motion()
    _, ax = pyplot.subplots()
    mesh = disc.draw_disc(ax, shown, 1, disc.scale_of(shown))
    plane = disc.plane_of(P)
    values = np.asarray(mesh.get_array()).reshape(plane.x.shape)
    np.testing.assert_allclose(values, 1e3 * shown.deflection(1, plane.r, plane.theta))
    x, y = (line[0] for line in ax.lines[0].get_data())
    angle = shown.slider[1]
    assert (x, y) == pytest.approx((100 * np.cos(angle), 100 * np.sin(angle)))
    # a quarter turn of theta is upward, at the outer edge
    outer = np.hypot(plane.x, plane.y)
    assert outer.min() == pytest.approx(1e3 * P.a)
    assert outer.max() == pytest.approx(1e3 * P.b)
    assert plane.y[-1, 45] == pytest.approx(1e3 * P.b)
    circles = [patch.get_radius() for patch in ax.patches if hasattr(patch, "get_radius")]
    assert circles == pytest.approx([1e3 * P.a, 1e3 * P.b])
    pyplot.close("all")


@pytest.mark.parametrize(
    ("phase", "colour"), [("stick", SLIDER), ("slip", SLIDER), ("separation", SEPARATED)]
)
def test_a_slider_apart_has_the_colour_of_separation(phase: str, colour: str) -> None:
    shown = motion()._replace(phase=np.array([phase] * len(TIMES)))
    assert disc.colour_of(shown, 0) == colour
