"""The return map of motions that slip all the time: its section and its derivatives."""

import numpy as np
import pytest

import disc_model as dm
from disc_model.stability.cycle import smallest_in_slip
from disc_model.stability.return_map import ENDS, PARAMETERS, RETURNED, SlippingMap
from tests.contact_laws import COMPILES
from tests.engine.test_saltation import differences

pytestmark = pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")

# the slider is at its Hopf point at 3.27 rad/s, and the disc's modes are damped beyond it
DISC = dm.Parameters(
    N=20, Omega=3.6, n_diameters=2, mu_s=0.4, mu_k=0.2, friction_decay=4, c=0.5, c_p=3
)
CASES = [
    pytest.param({"n_diameters": -1}, id="block"),
    pytest.param({}, id="disc"),
    # softer than elsewhere: differences over a stiff contact, whose load changes, need steps that
    # rounding spoils
    pytest.param({"contact_compliance": 1e-6}, id="compliant", marks=COMPILES),
    pytest.param({"contact_force": "normal"}, id="normal", marks=COMPILES),
    pytest.param({"friction_offset": 0.002}, id="moving surface", marks=COMPILES),
]


def cycle_on_section(
    p: dm.Parameters, names: tuple[str, ...] = ()
) -> tuple[SlippingMap, np.ndarray]:
    """The map of a case, and the point of its cycle."""
    map_ = SlippingMap(p, parameters=names)
    orbit = smallest_in_slip(map_)
    assert orbit is not None
    return map_, orbit.start


@pytest.mark.parametrize("law", CASES)
def test_a_simulated_motion_returns_to_the_fixed_point_after_the_period(law) -> None:
    p = DISC.replace(**law)
    map_, x = cycle_on_section(p)
    orbit = map_.evaluate(x)
    assert orbit.outcome == RETURNED
    start = map_.state(x)
    assert start.f == pytest.approx(p.Omega, rel=0.05)  # exactly, but where the surface moves
    run = dm.simulate(p, orbit.period, initial_state=start, tol=1e-13)
    assert len(run.events) == 0
    # the residual that is allowed to a cycle is 1e-12, and one more comes by the simulation
    np.testing.assert_allclose(map_.point(run.final_state), x, rtol=0, atol=1e-11 * map_.deflection)


@pytest.mark.parametrize("law", CASES)
def test_derivatives_by_coordinates_are_those_of_differences(law) -> None:
    map_, x = cycle_on_section(DISC.replace(**law))
    jacobian = map_.evaluate(x).jacobian
    expected = []
    for unit in np.eye(map_.size):

        def end(share: float, unit: np.ndarray = unit) -> np.ndarray:
            return map_.evaluate(x + share * unit, tangent=False).end

        expected.append(differences(end, 1e-5 * map_.deflection))
    np.testing.assert_allclose(jacobian, np.array(expected).T, rtol=0, atol=1e-7)
    # multipliers are even less sensitive, as long as they are apart
    ours = np.sort_complex(np.linalg.eigvals(jacobian))
    others = np.sort_complex(np.linalg.eigvals(np.array(expected).T))
    np.testing.assert_allclose(ours, others, rtol=0, atol=1e-6)


@pytest.mark.parametrize("name", PARAMETERS)
def test_derivatives_by_parameters_are_those_of_differences(name) -> None:
    map_, x = cycle_on_section(DISC, (name,))
    modal = x / map_.scale
    value = getattr(DISC, name)

    def end(share: float) -> np.ndarray:
        """The end in units of the disc, since the scale of coordinates depends on some parameters."""
        changed = SlippingMap(DISC.replace(**{name: value * (1 + share)}))
        return changed.evaluate(modal * changed.scale, tangent=False).end / changed.scale

    ours = map_.evaluate(x).by[:, 0] / map_.scale * value
    expected = differences(end, 1e-3)
    # changes of c and D_star are small beside the coordinates, whose rounding over a step of 1e-3
    # leaves 1e-11 of them
    largest = np.abs(modal * map_.scale).max()
    away = np.abs((ours - expected) * map_.scale)
    assert away.max() < 1e-6 * np.abs(expected * map_.scale).max() + 1e-10 * largest


@pytest.mark.parametrize(("share", "end"), [(20, "stops"), (2000, "lost_contact")])
def test_a_motion_that_stops_or_loses_contact_does_not_return(share, end) -> None:
    map_, x = cycle_on_section(DISC)
    sliding = map_.point_of(dm.steady_sliding(DISC).rows)
    assert ENDS[map_.evaluate(sliding + share * (x - sliding)).outcome] == end
