"""The couple of friction on the disc's surface: references that know it, by themselves and against each other."""

import numpy as np
import pytest

from disc_model import Parameters, plate_modes, steady_sliding
from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import modal_damping
from tests.contact_laws import LAWS
from tests.references import stored, taylor
from tests.references.fixed_step import first_separation
from tests.references.growth import couple, steady_eigenvalues
from tests.references.printed import MOTIONS, P, lively

EACH_LAW = {"default": {}} | LAWS


def eigenvalues(p, offset):
    """Of steady sliding, by the reference, with the modes of `plate_modes`."""
    modes = plate_modes(p)
    l, psi = modes["diameters"], modes["psi"]
    values = p.model_dump() | {"contact_compliance": contact_compliance(p)}
    return steady_eigenvalues(values, modes["omega"], psi, l, modal_damping(p), couple(offset, psi, l, p.r_0))


# ------------------------------------------------------------------------ the references themselves
@pytest.mark.parametrize(
    ("Omega", "offset", "growth", "frequency"),
    [
        (10, 0, 0.0092, 71), (20, 0, 0.0264, 187), (50, 0, 0.1446, 187),
        (10, 0.001, 0.0198, 274), (20, 0.001, 0.1875, 408), (50, 0.001, 0.4978, 399),
    ],
)  # fmt: skip
def test_growth_of_the_reference_is_that_of_the_prototype(Omega, offset, growth, frequency):
    """Numbers of a program that shares nothing with this one, as printed: four decimals, Hz rounded or cut off."""
    fastest = max(eigenvalues(Parameters(N=385, Omega=Omega, normalization="orthonormal"), offset)[0], key=np.real)
    assert fastest.real == pytest.approx(growth, abs=5.1e-5)
    assert abs(fastest.imag) / (2 * np.pi) == pytest.approx(frequency, abs=0.6)


@pytest.mark.parametrize("law", EACH_LAW)
def test_growth_of_the_reference_without_the_couple_is_ours(law):
    p = Parameters(N=385, Omega=20, c=0.3, c_p=0.7, normalization="orthonormal", **EACH_LAW[law])
    found, (_, R, _) = eigenvalues(p, 0)
    sliding = steady_sliding(p)
    assert sliding.contact_force == pytest.approx(R, rel=1e-12)
    # 1e4 1/s is the size of the eigenvalues, of which rounding takes 15 digits
    assert np.sort(found.real) == pytest.approx(np.sort(sliding.eigenvalues.real), abs=1e-10)


@pytest.mark.parametrize("law", EACH_LAW)
def test_both_references_move_alike_about_steady_sliding(law):
    """Rates of the Taylor integrator, differentiated there, have the eigenvalues of the program of growth rates."""
    p, offset = Parameters(N=385, Omega=20, n_diameters=2, c=0.3, c_p=0.7, D_star=1e-3, **EACH_LAW[law]), 0.01
    q, n = taylor.problem_of(p.replace(friction_offset=offset)), 3
    wanted, (V, R, T) = eigenvalues(p, offset)
    kept = np.array([i for i in range(4 * n + (4 if q.C else 2)) if i not in (n, 3 * n)])

    def rate(y):
        a, b, alpha, beta = y[: 4 * n].reshape(4, n)
        psi, f, u, v = np.append(y[4 * n :], [0, 0])[:4]
        step = taylor.Step(q, "slip", 1, stored.State(0.0, "slip", 1, psi, f, u, v, a, b, alpha, beta), order=1)
        tail = [step.psi[1], step.f[1], step.u[1], step.v[1]][: len(y) - 4 * n]
        return np.concatenate([step.a[1], step.b[1], step.alpha[1], step.beta[1], tail])

    # from the program's forces: the modes at rest in the slider's frame
    turn, y = q.l * q.Omega, np.zeros(4 * n + (4 if q.C else 2), taylor.LONG)
    for i in range(n):
        block = [
            [0, turn[i], 1, 0],
            [-turn[i], 0, 0, 1],
            [-q.w2[i], 0, -q.d[i], turn[i]],
            [0, -q.w2[i], -turn[i], -q.d[i]],
        ]
        y[i : 4 * n : n] = np.linalg.solve(np.array(block, float), [0, 0, float(q.s[i]) * V, -float(q.t[i]) * T])
    slope = (q.l * q.s * y[n : 2 * n]).sum() / q.r_0 if q.normal else 0
    y[4 * n : 4 * n + 2] = (T + R * slope) / q.r_0 / q.k_p, q.Omega
    if q.C:
        y[4 * n + 2] = (q.s * y[:n]).sum() - q.C * V
    assert np.abs(rate(y)).max() < 1e-9 * float((q.w2 * abs(y[:n])).max())
    columns = []
    for i in kept:
        step = np.zeros(len(y), taylor.LONG)
        step[i] = 1e-6 * max(abs(y[i]), 1e-4)
        columns.append((rate(y + step) - rate(y - step))[kept] / (2 * step[i]))
    found = np.linalg.eigvals(np.array(columns, float).T)
    # of differences: 1e-12 of the stiffest entry's 1e8 1/s^2
    assert np.abs(found[:, None] - wanted).min(axis=1).max() < 1e-6


@pytest.mark.parametrize("law", EACH_LAW)
@pytest.mark.parametrize(("phase", "direction"), MOTIONS)
def test_energy_of_the_reference_balances_with_the_work_of_the_couple(law, phase, direction):
    """Coefficient by coefficient: power into disc and slider across the disc, with T v_s, and along it."""
    p, offset, order = P.replace(**EACH_LAW[law]), 0.02, 12
    q, start = taylor.problem_of(p.replace(friction_offset=offset)), lively(phase, direction, p)
    if q.C:
        start = start.replace(u=start.u - 500 * float(q.C), u_velocity=start.u_velocity + 0.01)
    step = taylor.Step(q, phase, direction, stored.reference_state(start, p))

    def times(*factors):
        found = factors[0][:order]
        for x in factors[1:]:
            found = np.convolve(found, x[:order])[:order]
        return found

    def modal(x, y):
        return sum(times(*columns) for columns in zip(x.T, y.T, strict=True))

    v_s = -offset / q.r_0 * step.beta @ (q.l * q.s)
    height, turning = step.u.copy(), -step.f
    height[0], turning[0] = height[0] - q.u_0, turning[0] + q.Omega
    across = sum(modal(*pair) for pair in ((step.alpha, step.alpha), (step.beta, step.beta)))
    across += modal(step.a * q.w2, step.a) + modal(step.b * q.w2, step.b)
    across = (across + q.m * times(step.v, step.v) + q.k * times(height, height) + q.C * times(step.V, step.V)) / 2
    across += q.N * times(step.u)
    along = q.r_0**2 / 2 * (q.m * times(step.f, step.f) + q.k_p * times(step.psi, step.psi))
    lost = modal(step.alpha * q.d, step.alpha) + modal(step.beta * q.d, step.beta) + q.c * times(step.v, step.v)
    work = times(step.T, v_s)
    assert abs(work[0]) > 0 or phase == "separation"
    leaning = times(step.R, step.B, step.f) if q.normal else 0 * work
    friction = q.r_0 * times(step.T, step.f) + leaning
    driven = q.r_0**2 * (q.Omega * times(step.F) - q.c_p * times(turning, turning))
    # V does work on the slope that passes under the slider
    for energy, powers in ((across, (work, times(step.V, step.f, step.B), -lost)), (along, (driven, -friction))):
        rate = energy[1:] * np.arange(1, order)
        size = np.abs([rate, *(power[:-1] for power in powers)]).sum(axis=0)
        # each coefficient to the rounding of the largest of its terms
        assert np.all(np.abs(rate - sum(powers)[:-1]) <= 1e-15 * size)


@pytest.mark.slow
@pytest.mark.compiled
@pytest.mark.parametrize(("N", "Omega", "time"), [(385, 15, 63.6), (200, 30, 37.9)])
def test_first_separation_of_the_reference_is_that_of_the_prototype(N, Omega, time):
    """To its last digit."""
    q = taylor.problem_of(Parameters(N=N, Omega=Omega, normalization="orthonormal", friction_offset=1e-3))
    assert first_separation(q, 80)[0] == pytest.approx(time, abs=0.05)
