"""The stick-slip cycle: return map, Jacobian, statuses, steady sliding."""

from __future__ import annotations

import math

import numpy as np
import pytest

from disc_model import ParameterError, Parameters, floquet, simulate, steady_sliding
from disc_model.engine import layout, machine, saltation, tangent, variational
from disc_model.errors import DiscModelError
from disc_model.simulation.api import build_model
from disc_model.simulation.bridge import write_state
from disc_model.simulation.result import State
from disc_model.simulation.tolerance import series_order
from disc_model.stability import curves
from disc_model.stability.cycle import CycleError, CycleStatus, find_cycle
from disc_model.stability.floquet_batch import STATUS_NAMES, solve
from disc_model.stability.return_map import PARAMETERS, RETURNED, ReturnMap
from disc_model.stability.sliding import SlidingStatus
from tests.stability.test_small_cycles import assert_closed

BASE = Parameters(N=200, Omega=20)
DAMPED = Parameters(N=200, Omega=20, c=0.05, c_p=0.02)


def central_differences(map_: ReturnMap, x: np.ndarray, **how) -> np.ndarray:
    """Jacobian of the map by central differences of fourth order."""
    h = 3e-5 * np.linalg.norm(x)
    columns = []
    for unit in np.eye(map_.size):
        ends = [map_.evaluate(x + s * h * unit, tangent=False, **how)[1] for s in (-2, -1, 1, 2)]
        columns.append((ends[0] - 8 * ends[1] + 8 * ends[2] - ends[3]) / (12 * h))
    return np.array(columns).T


def after_separation(p: Parameters, t_end: float) -> tuple[ReturnMap, np.ndarray]:
    """A point of the section on the motion after contact was first lost."""
    late = simulate(p, t_end).final_state
    map_ = ReturnMap(p)
    outcome, x = map_.next_release(late)
    assert outcome == RETURNED
    return map_, x


class Full:
    """The engine with a column for every coordinate of the full system: modal ones, psi, f."""

    def __init__(self, p: Parameters, start: State, tol: float = 1e-14):
        self.model, self.order, self.tol = build_model(p), series_order(tol), tol
        width, n0 = len(self.model.force), len(self.model.force0)
        used, single = np.flatnonzero(self.model.shift), np.arange(n0)
        psi = 2 * width + 2 * n0
        self.rows = np.concatenate([used, width + used, 2 * width + single, 2 * width + n0 + single, [psi, psi + 1]])
        self.series, self.state = layout.build_series(self.model, self.order), layout.build_state(self.model)
        self.tangent = tangent.build_tangent(self.model, len(self.rows), self.order)
        self.n_rows = tangent.n_rows(self.model)
        write_state(p, self.model, start, self.state)
        self.set_columns(np.eye(len(self.rows)))

    def set_columns(self, columns):
        now = np.zeros((self.n_rows, self.tangent.columns))
        now[self.rows, : columns.shape[1]] = columns
        self.tangent.now[:] = now.reshape(self.n_rows, -1, 8).transpose(1, 0, 2).ravel()

    @property
    def columns(self):
        now = self.tangent.now.reshape(-1, self.n_rows, 8).transpose(1, 0, 2).reshape(self.n_rows, -1)
        return now[self.rows, : len(self.rows)]

    @property
    def coordinates(self):
        s = self.state
        return np.concatenate([s.z, s.e, s.y, s.g, s.x[layout.PSI : layout.SPEED + 1]])[self.rows]

    @property
    def rates(self):
        out = np.zeros(self.n_rows * 8)
        saltation.rates(self.model, self.state, out)
        return out[::8][self.rows]

    def release(self):
        log = np.zeros(tangent.LOG_SIZE)
        variational.change_phase(self.model, self.state, machine.RELEASE_FORWARD, False, log)

    def fly(self, duration, tangent=True):
        return variational.fly(
            self.model, self.series, self.state, self.tangent, self.order, self.tol, 2.0, duration, 0, True, tangent
        )

    def release_change(self, vector):
        """Gradient of the release condition times a vector of coordinates, f's left out."""
        self.set_columns(np.where(np.arange(len(vector)) < len(vector) - 1, vector, 0)[:, None])
        saltation.switch_times(self.model, self.state, self.tangent, machine.RELEASE_FORWARD)
        return -self.tangent.tau[0]


@pytest.mark.parametrize(
    "p",
    [
        BASE,
        DAMPED,
        Parameters(N=300, Omega=50, k_p=2e3),
        Parameters(N=600, Omega=30, normalization="orthonormal"),
        Parameters(N=200, Omega=20, n_diameters=6),
        Parameters(N=200, Omega=20, n_diameters=0),
        Parameters(N=200, Omega=20, contact="bonded"),
    ],
    ids=["base", "damped", "soft spring", "orthonormal", "two blocks", "axisymmetric", "bonded"],
)
def test_multipliers_agree_with_central_differences_of_the_return_map(p):
    cycle = find_cycle(p)
    assert cycle.status is CycleStatus.OK
    expected = central_differences(cycle.map, cycle.solution.x)
    mine = floquet(p).multipliers
    reference = np.linalg.eigvals(expected)
    distance = np.min(np.abs(mine[:, None] - reference[None, :]), axis=1)
    assert np.max(distance) < 1e-6
    assert np.max(np.abs(expected - cycle.solution.jacobian)) < 1e-7


@pytest.mark.parametrize("releases", [1, 2])
def test_jacobian_through_separation_and_impact(releases):
    map_, x = after_separation(Parameters(N=385, Omega=15.1), 60.0)
    flight, _, jacobian, _ = map_.evaluate(x, releases=releases, may_separate=True)
    assert flight.outcome == RETURNED
    assert flight.separations > 0
    expected = central_differences(map_, x, releases=releases, may_separate=True)
    assert np.max(np.abs(jacobian - expected)) < 1e-6 * np.max(np.abs(expected))


@pytest.mark.parametrize("name", PARAMETERS)
@pytest.mark.parametrize("where", ["cycle", "separation"])
def test_derivatives_by_parameters_agree_with_central_differences(name, where):
    p = DAMPED if where == "cycle" else Parameters(N=385, Omega=15.1, c=0.01, c_p=0.01)
    map_, x = (ReturnMap(p), None) if where == "cycle" else after_separation(p, 60.0)
    x = map_.static if x is None else x
    how = {"may_separate": True}
    _, _, _, by = ReturnMap(p, parameters=(name,)).evaluate(x, **how)
    value = getattr(p, name)
    h = (1e-2 if name in ("c", "c_p") else 1e-4) * value
    ends = []
    for change in (-2 * h, -h, h, 2 * h):
        other = ReturnMap(p.replace(**{name: value + change}))
        end = other.evaluate(x / map_.scale * other.scale, tangent=False, **how)[1]
        ends.append(end / other.scale * map_.scale)
    expected = (ends[0] - 8 * ends[1] + 8 * ends[2] - ends[3]) / (12 * h)
    assert np.linalg.norm(by[:, 0] - expected) < 1e-5 * np.linalg.norm(expected)


def test_the_cycle_closes_in_a_simulation():
    result = floquet(BASE)
    run = assert_closed(result)
    assert result.stick_fraction == pytest.approx(run.statistics["time_stick"] / result.period, abs=1e-9)


def test_result_is_complete_and_consistent():
    result = floquet(BASE)
    assert result.status is CycleStatus.OK
    assert result.multipliers.shape == (18,)
    assert np.all(np.diff(np.abs(result.multipliers)) <= 1e-13)
    assert np.allclose(np.exp(result.exponents * result.period), result.multipliers)
    assert result.growth_rate == pytest.approx(result.exponents[0].real, rel=1e-12)
    assert result.kind == "neimark_sacker"
    assert not result.stable
    assert result.releases == result.sticks == 1
    assert result.residual < 1e-12
    assert result.raise_for_status() is result
    assert result.state.phase == "stick"
    assert result.state.f == 0
    with pytest.raises(ValueError, match="read-only"):
        result.multipliers[0] = 0


@pytest.mark.parametrize(
    ("changes", "status"),
    [
        ({"N": 385, "Omega": 15.1}, CycleStatus.NO_CYCLE),
        ({"Omega": 0}, CycleStatus.AT_REST),
        ({"N": 0}, CycleStatus.NO_STICK_SLIP),
        ({"mu_s": 0, "mu_k": 0}, CycleStatus.NO_STICK_SLIP),
        ({"k_p": 0}, CycleStatus.AT_REST),
        ({"c_p": 5}, CycleStatus.NO_STICK_SLIP),
    ],
)
def test_without_a_cycle_the_status_says_what_was_found(changes, status):
    result = floquet(BASE.replace(**changes))
    assert result.status is status
    assert result.status.advice
    assert result.message.startswith(status.value)
    assert math.isnan(result.growth_rate)
    assert result.multipliers.shape == (0,)
    assert result.state is None
    assert not result.stable
    with pytest.raises(CycleError, match=status.value):
        result.raise_for_status()
    assert issubclass(CycleError, DiscModelError)


def test_bad_input_is_named_in_full():
    with pytest.raises(ParameterError, match=r"p='x': must be Parameters; tol=0.5: must be within"):
        floquet("x", tol=0.5)
    with pytest.raises(ParameterError, match="must be Parameters"):
        steady_sliding(3)


def test_product_of_multipliers_is_that_of_divergence_and_saltation():
    """det of the return map from Liouville's formula.

    In slip the flow's determinant is exp(integral of the divergence), in stick likewise on f = 0.  The release
    multiplies volumes by (h' after) / (h' before).  At rest f is lost: what remains of the determinant is the f
    component of the jump of the rates there, carried backwards through the cycle, over f' before.
    """
    cycle = find_cycle(DAMPED, 1e-14)
    map_, x, flight = cycle.map, cycle.solution.x, cycle.solution.flight
    nodes, weights = np.polynomial.legendre.leggauss(24)
    trace, start = 0.0, map_.state(x)
    for begin, length in ((0.0, flight.slip_time), (flight.slip_time, flight.stick_time)):
        for node, weight in zip(nodes, weights, strict=True):
            run = Full(DAMPED, start)
            run.release()
            run.fly(begin + length * (node + 1) / 2, tangent=False)
            trace += weight * length / 2 * variational.divergence(run.model, run.state)
    run = Full(DAMPED, start)
    before = run.rates
    run.release()
    after = run.rates
    run.fly(flight.slip_time * (1 - 1e-13))
    assert run.state.x[layout.PHASE] == layout.SLIP
    at_rest = run.rates
    jump = at_rest.copy()
    run.state.x[layout.PHASE], run.state.x[layout.SPEED] = layout.STICK, 0.0
    jump -= run.rates
    carried = np.linalg.solve(run.columns, jump)
    section = Full(DAMPED, start)
    section.tangent.before[:] = 0.0
    saltation.rates(section.model, section.state, section.tangent.before)

    def h(vector):
        return section.release_change(vector)

    # tau is the change over the rate before, so that h(before) is one
    assert h(before) == pytest.approx(1, rel=1e-12)
    rest = (carried[-1] - after[-1] * h(carried) / h(after)) / at_rest[-1]
    expected = math.exp(trace) * h(after) * rest
    product = np.prod(floquet(DAMPED, tol=1e-14).multipliers)
    assert product.imag == pytest.approx(0, abs=1e-12)
    assert product.real == pytest.approx(expected, rel=1e-8)


def test_batch_equals_the_single_results():
    cases = [BASE, Parameters(N=385, Omega=15.1), Parameters(N=50, Omega=15), BASE.replace(Omega=0)]
    batch = solve(cases)
    singles = [floquet(p) for p in cases]
    assert [STATUS_NAMES[code] for code in batch["status"]] == [single.status.value for single in singles]
    for name in ("growth_rate", "period", "stick_fraction"):
        assert np.array_equal(batch[name], [getattr(s, name) for s in singles], equal_nan=True)
    assert np.array_equal(batch["sliding_growth_rate"], [s.sliding.growth_rate for s in singles], equal_nan=True)
    assert batch["multiplier_re"][0] == singles[0].multipliers[0].real
    assert batch["multiplier_im"][0] == singles[0].multipliers[0].imag
    assert all(array.shape == (len(cases),) for array in batch.values())


@pytest.mark.parametrize(
    "p", [BASE, Parameters(N=300, Omega=50, c_p=0.7, c=0.3), Parameters(N=100, Omega=40, normalization="orthonormal")]
)
def test_steady_sliding_is_an_equilibrium_with_the_flows_eigenvalues(p):
    sliding = steady_sliding(p)
    assert sliding.status is SlidingStatus.OK
    modal = {name: getattr(sliding, name) for name in ("a", "b", "alpha", "beta")}
    start = State(0.0, "slip", 1, sliding.psi, p.Omega, 0.0, 0.0, **modal)
    run, duration = Full(p, start), 1e-3
    before = run.coordinates
    assert run.fly(duration) == variational.TIME_OVER
    assert np.allclose(run.coordinates, before, rtol=0, atol=1e-12 * np.max(np.abs(before)))
    flow = np.linalg.eigvals(run.columns)
    expected = np.exp(sliding.eigenvalues * duration)
    distance = np.min(np.abs(expected[:, None] - flow[None, :]), axis=1)
    assert np.max(distance) < 1e-10
    assert sliding.growth_rate == pytest.approx(np.log(np.abs(flow).max()) / duration, abs=1e-6)


def test_steady_sliding_without_drive():
    sliding = steady_sliding(BASE.replace(Omega=0))
    assert sliding.status is SlidingStatus.AT_REST
    assert not sliding.stable


def test_attractors_name_what_is_stable():
    assert floquet(Parameters(N=50, Omega=15)).attractors[:1] == ("stick_slip",)
    both_gone = floquet(BASE)
    assert both_gone.attractors == ()


def test_a_seed_met_on_the_way_to_another_modulus_is_a_cycle_there():
    """E scales the coordinates of the section."""
    seed = curves._first_event(Parameters(N=385, Omega=15), "E", 1.4e11, -1, 1e-12, [])
    assert seed is not None
    assert seed.kind == "fold"
    # twice the stick-slip rate meets the mode's frequency, sqrt(E), at Omega = 15.0949 for 150 GPa
    assert pytest.approx(149.42e9, rel=1e-4) == seed.case.E
    map_ = ReturnMap(seed.case)
    _, end, _, _ = map_.evaluate(seed.point)
    # rounding, and what a corrector leaves; with the coordinates of 150 GPa it is 1e-4
    assert np.linalg.norm(end - seed.point) < 1e-9 * np.linalg.norm(map_.static)
