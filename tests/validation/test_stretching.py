"""Plates that stretch: the engine against two given scenes, an own integrator in long double, and
the linear engine."""

import math
import re
from pathlib import Path

import numpy as np
import pytest

from disc_model import (
    Parameters,
    Ramp,
    floquet,
    initial_state,
    plate_modes,
    simulate,
    steady_sliding,
)
from disc_model.stability.return_map import ReturnMap
from tests.contact_laws import ALL_LAWS
from tests.engine.test_saltation import differences
from tests.references import stored, taylor
from tests.stability.test_return_map import central_differences, check_derivatives
from tests.validation.agree import followed

KINDS = ("stick_to_slip", "slip_to_stick", "separation", "reattachment")
GIVEN = (Path(__file__).parent / "stretching.txt").read_text()
SCENES = {
    "orthonormal": {"N": 200, "Omega": 50, "kick": -0.00225, "span": 0.15},
    "as_published": {"N": 385, "Omega": 15.1, "kick": 0.0, "span": 0.3},
}


def start_of(p, kick):
    """The static start with the axisymmetric mode displaced so that the slider moves by kick, m."""
    state = initial_state(p)
    psi = plate_modes(p)["psi"].to_numpy()
    a = state.a.copy()
    a[0] += kick / psi[0]
    u = psi @ a
    if p.contact_compliance:
        u = state.u + kick
    return state.replace(a=a, u=float(u))


@pytest.mark.compiled
@pytest.mark.parametrize("norm", SCENES)
def test_given_scenes(norm):
    """Every event of two other programs, which agree to 1e-11 s, and the static start."""
    scene = SCENES[norm]
    p = Parameters(N=scene["N"], Omega=scene["Omega"], normalization=norm, stretching="clamped")
    [text] = [part for part in GIVEN.split("##") if part.startswith(f" {norm}")]
    u_0 = float(re.search(r"u_0 = (\S+) m", text)[1])
    a = [float(x) for x in re.search(r"a_l = (.+)", text)[1].split(", ")]
    rest = initial_state(p)
    sign = np.sign(plate_modes(p)["psi"].to_numpy())
    assert rest.u == pytest.approx(u_0, abs=1e-15)
    np.testing.assert_allclose(sign * rest.a, a, rtol=1e-12)

    run = simulate(p, scene["span"], tol=1e-13, initial_state=start_of(p, scene["kick"]))
    mine = list(zip(run.events["kind"].values, run.events["time"].values, strict=True))
    wanted = re.findall(r"(?:^|; )(\d) (\d\.\d+)", text, re.M)
    if norm == "orthonormal":
        assert len(mine) == len(wanted)
    for kind, time in wanted:
        assert any(KINDS[int(kind)] == name and abs(t - float(time)) < 1e-10 for name, t in mine), (
            time
        )


LAWS = {name: ALL_LAWS[name] for name in ("compliant", "normal", "vertical_coupled")}
LAWS["compliant_normal_exponential"] = ALL_LAWS["compliant_normal_exponential"]
LAWS["vertical_coupled_falling"] = ALL_LAWS["vertical_coupled_falling"]
LAWS["pad"] = ALL_LAWS["normal_coupled"] | {"contact_arc": 0.3}
RAMPS = (
    Ramp(parameter="N", to=300, start=0.004, end=0.02),
    Ramp(parameter="Omega", to=20, start=0.0, end=0.01),
)
PLATE = {"N": 385, "Omega": 15.1, "c": 0.3}
# the case, by how much the slider is displaced (m), how long it is followed (s), ramps
SCENES_OF_OWN = {
    "free edge": (
        {"N": 400, "Omega": 30, "normalization": "orthonormal", "stretching": "free"},
        -0.003,
        0.03,
    ),
    "six diameters": ({"N": 300, "Omega": 40, "n_diameters": 6, "c": 0.3}, 0.001, 0.05),
    "bilateral": ({"N": 150, "Omega": 10, "c_p": 0.3, "contact": "bilateral"}, -0.004, 0.05),
    **{name: (PLATE | {"c_p": 0.2} | law, -0.004, 0.025) for name, law in LAWS.items()},
    "ramps": (PLATE, -0.003, 0.03, RAMPS),
}


@pytest.mark.compiled
@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=() if name == "free edge" else pytest.mark.slow)
        for name in SCENES_OF_OWN
    ],
)
def test_scenes_of_an_own_integrator(name):
    """Every event and the final state; coefficients of the membrane agree to 1e-10."""
    case, kick, span, *ramps = SCENES_OF_OWN[name]
    p = Parameters(**{"stretching": "clamped"} | case)
    start = stored.reference_state(start_of(p, kick), p)
    ramps = ramps[0] if ramps else ()
    run, other = followed(p, span, start, ramps=ramps, tol=1e-14, within=1e-9)
    assert len(run.events) >= 3
    a = stored.engine_state(other.state(), p).a
    np.testing.assert_allclose(run.final_state.a, a, rtol=0, atol=1e-6 * abs(a).max())


GROWTH = [
    ("as_published", 300, 20, -0.0635),
    ("as_published", 200, 20, -0.0054),
    ("as_published", 200, 50, 0.0267),
    ("orthonormal", 200, 50, 0.0533),
    ("orthonormal", 600, 30, 0.1299),
    ("orthonormal", 600, 100, 0.4366),
]


@pytest.mark.compiled
@pytest.mark.parametrize(("norm", "N", "Omega", "rate"), GROWTH)
def test_growth_rates(norm, N, Omega, rate):
    p = Parameters(N=N, Omega=Omega, normalization=norm, stretching="clamped")
    assert floquet(p).growth_rate == pytest.approx(rate, abs=1e-4)


@pytest.mark.compiled
def test_small_amplitudes_are_those_of_the_linear_engine():
    """At a load of 1/1000 N the membrane's force is below 1e-10 of the plate's."""
    linear = Parameters(N=1e-3, Omega=15.1, k_p=0.05, normalization="orthonormal", m=0.1)
    stretching = linear.replace(stretching="clamped")
    runs = [simulate(p, 0.05, tol=1e-13) for p in (linear, stretching)]
    times = [run.events["time"].values for run in runs]
    assert len(times[0]) >= 1
    np.testing.assert_allclose(times[0], times[1], rtol=0, atol=1e-9)
    np.testing.assert_allclose(
        runs[0].final_state.a,
        runs[1].final_state.a,
        rtol=0,
        atol=1e-9 * abs(runs[0].final_state.a).max(),
    )


@pytest.mark.compiled
@pytest.mark.slow
def test_energy_over_a_long_time():
    p = Parameters(N=200, Omega=50, normalization="orthonormal", stretching="clamped")
    run = simulate(p, 100, tol=1e-14, initial_state=start_of(p, -0.00225), events=False)
    assert run.statistics["energy_residual"] < 1e-12


@pytest.mark.compiled
@pytest.mark.slow
@pytest.mark.parametrize(("N", "Omega", "first"), [(200, 50, 157.5728), (800, 30, math.nan)])
def test_first_separations_of_the_physical_disc(N, Omega, first):
    """As another program has them; slow growth multiplies what differs by 1e4."""
    p = Parameters(N=N, Omega=Omega, normalization="orthonormal", stretching="clamped")
    run = simulate(p, 200, events=False)
    assert run.first_separation == pytest.approx(first, abs=2e-3, nan_ok=True)


@pytest.mark.parametrize(
    "case",
    [
        {"N": 200, "Omega": 50, "normalization": "orthonormal"},
        {"N": 385, "Omega": 15.1},
        {"N": 385, "Omega": 15.1, "friction_offset": "surface", "friction_decay": 2.0},
        {"N": 300, "Omega": 40, "contact_compliance": 2e-7, "contact_force": "normal"},
    ],
)
def test_steady_sliding(case):
    """The own integrator's state does not change there, but for the membrane's coefficients."""
    p = Parameters(stretching="clamped", **case)
    sliding = steady_sliding(p)
    assert sliding.status == "further"
    state = start_of(p, 0.0)
    modal = {name: getattr(sliding, name) for name in stored.MODAL}
    u = plate_modes(p)["psi"].to_numpy() @ sliding.a
    q = taylor.problem_of(p)
    if p.contact_compliance:
        load = q.N - q.k * q.u_0
        u = (u - q.C * load) / (1 + q.k * q.C)
    state = state.replace(
        phase="slip", direction=1, psi=sliding.psi, f=p.Omega, u=float(u), **modal
    )
    step = taylor.Step(q, "slip", 1, stored.reference_state(state, p), order=2)
    assert float(step.R[0]) == pytest.approx(sliding.contact_force, rel=1e-8)
    assert float(abs(step.f[1])) < 1e-6 * p.Omega
    assert float(abs(step.a[1]).max()) < 1e-10
    for rates in (step.alpha[1], step.beta[1]):
        assert float(abs(rates).max()) < 1e-7 * float((q.w2 * abs(step.a[0])).max())


def test_the_jacobian_agrees_with_differences_along_a_direction():
    """Quick enough without compilation."""
    map_ = ReturnMap(Parameters(N=385, Omega=15.1, c=0.3, c_p=0.2, stretching="clamped"))
    x = map_.static
    along = np.linalg.norm(x) * np.cos(np.arange(map_.size))

    def end(share):
        return map_.evaluate(x + share * along, tangent=False).end

    expected = differences(end, 1e-4)
    found = map_.evaluate(x).jacobian @ along
    assert np.linalg.norm(found - expected) < 1e-7 * np.linalg.norm(expected)


@pytest.mark.compiled
def test_derivatives_by_parameters():
    map_ = ReturnMap(Parameters(N=385, Omega=15.1, c=0.3, c_p=0.2, stretching="clamped"))
    check_derivatives(map_, map_.static, lambda name: 1e-2 if name in ("c", "c_p") else 1e-4)


@pytest.mark.compiled
def test_multipliers_are_those_of_simulated_motion():
    """With separations and impacts on the way."""
    p = Parameters(N=200, Omega=50, normalization="orthonormal", stretching="clamped")
    late = simulate(p, 0.05, initial_state=start_of(p, -0.00225)).final_state
    map_ = ReturnMap(p, patient=True)
    x = map_.next_release(late).x
    orbit = map_.evaluate(x)
    expected = central_differences(map_, x, 1e-5 * np.linalg.norm(x))
    wanted = np.sort_complex(np.linalg.eigvals(expected))
    found = np.sort_complex(np.linalg.eigvals(orbit.jacobian))
    np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-6 * abs(wanted).max())
