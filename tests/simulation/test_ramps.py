"""Ramps of Omega and N: what may be asked for, when they begin and end, and what is carried over.

Event times are held against references in tests/validation/test_ramps.py.
"""

import math

import numpy as np
import pytest

from disc_model import Parameters, Ramp, Window, simulate
from disc_model.simulation.case import pieces
from tests.contact_laws import LAWS
from tests.refusals import refusal
from tests.simulation.equal import same

P = Parameters(N=200.0, Omega=50.0, n_diameters=1)
BRAKE = Ramp(parameter="Omega", to=20.0, start=0.01, end=0.03)
RELIEF = Ramp(parameter="N", to=150.0, start=0.02, end=0.04)


# ------------------------------------------------------------------------ what is requested
@pytest.mark.parametrize("law", [{}, LAWS["compliant_normal"]])  # whose kernels others use as well
def test_rate_zero_and_a_ramp_after_the_end_change_no_bit(law):
    p = P.replace(**law)
    windows = {"all": Window(rate=5e3)}
    constant = simulate(p, 0.05, windows)
    none = (
        Ramp(parameter="Omega", to=50.0, start=0.007, end=0.03),
        Ramp(parameter="N", to=200.0, start=0.0, end=0.02),
        Ramp(parameter="N", to=200.0, start=0.02, end=0.021),
        Ramp(parameter="Omega", to=5.0, start=0.05, end=0.06),
    )
    same(simulate(p, 0.05, windows, ramps=none), constant)


# ------------------------------------------------------------------------ pieces
def test_pieces_of_overlapping_ramps():
    found = pieces(P, (RELIEF, BRAKE))
    assert [piece.begin for piece in found] == [-math.inf, 0.01, 0.02, 0.03, 0.04]
    assert [piece.end for piece in found] == [0.01, 0.02, 0.03, 0.04, math.inf]
    assert [piece.Omega for piece in found] == pytest.approx([50, 50, 35, 20, 20])
    assert [piece.N for piece in found] == pytest.approx([200, 200, 200, 175, 150])
    assert [piece.Omega_rate for piece in found] == pytest.approx([0, -1500, -1500, 0, 0])
    assert [piece.N_rate for piece in found] == pytest.approx([0, 0, -2500, -2500, 0])
    # not nearly
    assert found[3].Omega == found[4].Omega
    assert found[4].Omega == 20.0
    assert found[4].angle == pytest.approx(0.5 + 0.7 + 0.2)


def test_one_ramp_goes_on_where_another_ends():
    back = Ramp(parameter="Omega", to=50.0, start=0.03, end=0.04)
    found = pieces(P, (back, BRAKE))
    assert [(piece.begin, piece.Omega) for piece in found[1:]] == [
        (0.01, 50.0),
        (0.03, 20.0),
        (0.04, 50.0),
    ]
    times = np.array([[0.0, 0.01, 0.02], [0.03, 0.035, 7.0]])
    run = simulate(P, 1e-3, ramps=(BRAKE, back))
    np.testing.assert_allclose(run.value_at("Omega", times), [[50, 50, 35], [20, 35, 50]])


# ------------------------------------------------------------------------ what is carried over
def test_a_run_in_pieces_is_the_whole_run():
    """Each run continues where the last one ended, in the midst of ramps; the same ramps are said
    to all."""
    ramps = (BRAKE, RELIEF)
    whole = simulate(P, 0.06, tol=1e-13, ramps=ramps)
    state = None
    times = []
    for end in (0.005, 0.015, 0.025, 0.035, 0.06):
        part = simulate(P, end, tol=1e-13, initial_state=state, ramps=ramps)
        times += list(part.events["time"])
        state = part.final_state
    assert len(times) > 5
    # a run's end cuts a step in two, which costs its rounding
    np.testing.assert_allclose(times, whole.events["time"], rtol=0, atol=1e-12)
    np.testing.assert_allclose(state.a, whole.final_state.a, rtol=1e-9)


def test_samples_events_and_statistics_know_no_pieces():
    windows = {
        "all": Window(rate=1e4),
        "bins": Window(rate=2e3, start=0.015, stop=0.045, envelope=3),
    }
    result = simulate(P, 0.05, windows, ramps=(BRAKE, RELIEF))
    sample = result.samples["all"]
    statistics = result.statistics
    np.testing.assert_allclose(sample["time"], np.arange(501) * 1e-4, rtol=0, atol=1e-15)
    assert len(result.samples["bins"]["time"]) == 61 // 3
    spent = sum(statistics[f"time_{phase}"] for phase in ("stick", "slip", "separation"))
    assert spent == pytest.approx(0.05, rel=1e-12)
    assert statistics["n_events"] == len(result.events)
    assert (np.diff(result.events["time"]) >= 0).all()
    assert result.final_state.time == pytest.approx(0.05, rel=1e-14)


def test_values_at():
    result = simulate(P, 0.005, ramps=(BRAKE, RELIEF))
    assert result.value_at("Omega", [0.0, 0.02, 1.0]) == pytest.approx([50, 35, 20])
    assert result.value_at("N", 0.03) == pytest.approx(175)
    with refusal("name='c': must be one of Omega, N"):
        result.value_at("c", 0.0)
    assert "Omega to 20" in repr(result)
