"""The stability analyses under every law of contact: against differences of motions."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from disc_model import ParameterError, Parameters, floquet, steady_sliding
from disc_model.engine import layout, outcomes, switches
from disc_model.stability.branch import Steps
from disc_model.stability.continuation import continue_cycle
from disc_model.stability.lyapunov import lyapunov_exponents
from disc_model.stability.return_map import ReturnMap, multipliers
from tests.contact_laws import LAWS
from tests.engine.test_variational import FLIGHTS, check_derivatives, differences
from tests.stability.test_sliding import check_against_flow

# Derivatives of motions take a minute and more to compile for each law.
pytestmark = pytest.mark.slow


def departure(law: str, flight: str) -> tuple[ReturnMap, np.ndarray]:
    """A disturbed point of the section; on a compliant contact the slider goes with the disc, at a disturbed force."""
    p, size, seed, _ = FLIGHTS[flight]
    map_ = ReturnMap(p.replace(**LAWS[law]))
    modal = len(map_.diameters)
    noise = np.random.default_rng(seed).normal(size=map_.size)
    x = map_.static.copy()
    x[:modal] += size * np.max(np.abs(x[:modal])) * noise[:modal]
    if map_.size > modal:
        model, state = map_.model, layout.build_state(map_.model)
        state.disc[map_._section.rows[:modal]] = x[:modal] / map_.scale[:modal]
        w, velocity, _ = switches.disc_point(model, state)
        height = w - model.give[0] * p.N * (1 + 0.1 * noise[modal])
        x[modal:] = np.array([height, velocity]) * map_.scale[modal:]
    return map_, x


def step(map_: ReturnMap, x: np.ndarray) -> float:
    """Of differences: the contact spring is short, a hundredth of it lies between two neighbours."""
    return 1e-6 * float(np.linalg.norm(x)) * (1.0 if map_.size == len(map_.diameters) else 1e-2)


FLOWN = ["stick and slip", "separation at speed"]


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("flight", FLOWN)
def test_jacobian_of_a_flight(law: str, flight: str) -> None:
    map_, x = departure(law, flight)
    how = {"may_separate": True}
    log, _, jacobian, _ = map_.evaluate(x, **how)
    assert log.outcome == outcomes.RETURNED
    assert (log.counts.separations > 0) == ("separation" in flight)
    for direction in np.random.default_rng(0).normal(size=(2, map_.size)) / np.sqrt(map_.size):
        direction[len(map_.diameters) :] *= 1e-2
        expected = differences(lambda s, d=direction: map_.evaluate(x + s * d, tangent=False, **how)[1], step(map_, x))
        assert np.linalg.norm(jacobian @ direction - expected) < 1e-6 * np.linalg.norm(expected)


@pytest.mark.compiled
@pytest.mark.parametrize("law", [*LAWS, "residual"])
@pytest.mark.parametrize("flight", FLOWN)
def test_derivatives_of_a_flight_by_parameters(law: str, flight: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(LAWS, "residual", {"contact_compliance": "residual"})
    map_, x = departure(law, flight)
    compliant = map_.size > len(map_.diameters)

    def step(name: str) -> float:
        # what damps acts little: it can change much
        return 1e-2 if name in ("c", "c_p", "D_star") else 1e-4 * (1e-2 if compliant else 1.0)

    check_derivatives(map_, x, step)


def with_the_slider(map_: ReturnMap) -> np.ndarray:
    """Directions in columns: of each mode, the slider going along so that the contact's force stays; of u, u' alone."""
    directions, n = np.eye(map_.size), len(map_.diameters)
    if map_.size > n:
        state = layout.build_state(map_.model)
        for i in range(n):
            state.disc[:], state.x[:] = 0.0, 0.0
            state.disc[map_._section.rows[i]] = 1 / map_.scale[i]
            w, velocity, _ = switches.disc_point(map_.model, state)
            directions[n:, i] = np.array([w, velocity]) * map_.scale[n:]
    return directions


GROWING = {
    "stable": {"N": 200, "Omega": 20.0, "c": 0.5},
    "growing": {"N": 300, "Omega": 20.0},
    "orthonormal": {"N": 600, "Omega": 30.0, "normalization": "orthonormal"},
}


WITH_RESIDUAL: dict[str, dict[str, Any]] = {
    "residual": {"contact_compliance": "residual"},
    "residual_normal": {"contact_compliance": "residual", "contact_force": "normal"},
}


@pytest.mark.compiled
@pytest.mark.parametrize("law", [*LAWS, *WITH_RESIDUAL])
@pytest.mark.parametrize("case", GROWING)
def test_growth_rate_against_differences_of_the_return_map(law: str, case: str) -> None:
    p = Parameters(**GROWING[case], **(LAWS | WITH_RESIDUAL)[law])
    found = floquet(p, tol=1e-14).raise_for_status()
    map_ = ReturnMap(p, tol=1e-14)
    x = map_.point(found.state)
    directions, modal = with_the_slider(map_), len(map_.diameters)
    # truncated at 5e-9 and rounded at 5e-10 1/s, about; the contact's force changes by a hundredth of N
    h = 3e-5 * np.linalg.norm(map_.static[:modal]) * np.where(np.arange(map_.size) < modal, 1.0, 0.3)
    columns = [
        differences(lambda s, d=d: map_.evaluate(x + s * d, tangent=False)[1], size)
        for d, size in zip(directions.T, h, strict=True)
    ]
    jacobian = np.array(columns).T @ np.linalg.inv(directions)
    growth = math.log(abs(multipliers(jacobian)[0])) / found.period
    assert found.growth_rate == pytest.approx(growth, rel=0, abs=1e-7)


@pytest.mark.compiled
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("case", [{}, {"c": 0.3, "c_p": 0.7}])
def test_steady_sliding_has_the_flows_eigenvalues(law: str, case: dict[str, float]) -> None:
    # a contact spring swings many times in a flight, and its roundings add up
    check_against_flow(Parameters(N=300, Omega=50, **case, **LAWS[law]), 1e-9)


@pytest.mark.compiled
@pytest.mark.parametrize("law", LAWS)
def test_a_branch_has_the_cycles_growth(law: str) -> None:
    p = Parameters(N=300, Omega=20.0, **LAWS[law])
    branch = continue_cycle(p, "Omega", (19.0, 20.5), steps=Steps(longest=0.5))
    assert branch.values[-1, 0] > 20.5
    middle = len(branch) // 2
    here = floquet(p.replace(Omega=float(branch.values[middle, 0])))
    assert branch.growth_rate[middle] == pytest.approx(here.growth_rate, abs=1e-8)


@pytest.mark.compiled
@pytest.mark.parametrize("law", LAWS)
def test_the_largest_exponent_of_a_quiet_motion_is_the_cycles(law: str) -> None:
    p = Parameters(N=200, Omega=20, c=0.5, **LAWS[law])
    cycle = floquet(p)
    found = lyapunov_exponents(p, 3000 * cycle.period, transient=30.0, interval=cycle.period, count=2)
    # one exponent is zero, along the motion; the other that of the slowest disturbance. A column swings within a
    # cycle, by exp(2) with the contact spring: over 42 s that is 0.05/s.
    assert found.exponents[0] == pytest.approx(0.0, abs=0.05)
    assert found.exponents[1] == pytest.approx(cycle.growth_rate, abs=0.05)


@pytest.mark.parametrize("law", [{}, LAWS["compliant"]])
def test_a_rigid_disc_has_nothing_to_lose(law: dict[str, float]) -> None:
    p = Parameters(N=385.0, Omega=15.1, n_diameters=-1, **law)
    for analysis in (floquet, steady_sliding, lambda p: lyapunov_exponents(p, 1.0)):
        with pytest.raises(ParameterError, match=r"n_diameters=-1: must be >= 0: .* needs modes of the disc"):
            analysis(p)
