"""Ramps of Omega and N: when they begin and end, and what is carried over.

Event times are held against references in tests/validation/test_ramps.py.
"""

import math
from typing import Any

import numpy as np
import pytest

from disc_model import Parameters, Ramp, Window, simulate
from disc_model.simulation.case import pieces
from tests.contact_laws import LAWS
from tests.refusals import refusal

P = Parameters(N=200.0, Omega=50.0, n_diameters=1)
BRAKE = Ramp(parameter="Omega", to=20.0, start=0.01, end=0.03)
BACK = Ramp(parameter="Omega", to=50.0, start=0.03, end=0.04)
RELIEF = Ramp(parameter="N", to=150.0, start=0.02, end=0.04)
IDLE = (
    Ramp(parameter="Omega", to=50.0, start=0.007, end=0.03),
    Ramp(parameter="N", to=200.0, start=0.0, end=0.02),
    Ramp(parameter="N", to=200.0, start=0.02, end=0.021),
    Ramp(parameter="Omega", to=5.0, start=0.05, end=0.06),
)


@pytest.mark.parametrize("law", [{}, LAWS["compliant_normal"]])  # whose kernels others use as well
def test_rate_zero_and_a_ramp_after_the_end_change_no_bit(law: Any) -> None:
    p = P.replace(**law)
    constant, ramped = (simulate(p, 0.05, {"all": Window(rate=5e3)}, ramps=x) for x in ((), IDLE))
    np.testing.assert_array_equal(ramped.event_rows, constant.event_rows)
    np.testing.assert_array_equal(ramped.final_state.a, constant.final_state.a)
    for name, values in constant.samples["all"].items():
        np.testing.assert_array_equal(ramped.samples["all"][name], values)


@pytest.mark.parametrize(
    ("ramps", "begin", "Omega", "N"),
    [
        ((RELIEF, BRAKE), [0.01, 0.02, 0.03, 0.04], [50, 35, 20, 20], [200, 200, 175, 150]),
        ((BACK, BRAKE), [0.01, 0.03, 0.04], [50, 20, 50], [200, 200, 200]),
    ],
)
def test_pieces_of_ramps(ramps: Any, begin: Any, Omega: Any, N: Any) -> None:
    first, *found = pieces(P, ramps)
    assert (first.begin, first.Omega, first.N) == (-math.inf, 50.0, 200.0)
    assert [piece.begin for piece in found] == begin
    assert [piece.end for piece in found] == [*begin[1:], math.inf]
    assert [piece.Omega for piece in found] == pytest.approx(Omega)
    assert [piece.N for piece in found] == pytest.approx(N)
    assert f"Omega to {ramps[1].to:g}" in repr(simulate(P, 1e-3, ramps=ramps))
    ends = [*Omega[1:], Omega[-1]]
    turned = sum(
        0.5 * (x.Omega + end) * (x.end - x.begin) for x, end in zip(found[:-1], ends, strict=False)
    )
    assert found[-1].angle == pytest.approx(50 * 0.01 + turned)


def test_a_run_in_pieces_is_the_whole_run() -> None:
    """Each run continues where the last one ended, in the midst of ramps; the same ramps are said
    to all."""
    options: dict[str, Any] = {"tol": 1e-13, "ramps": (BRAKE, RELIEF)}
    whole = simulate(P, 0.06, {"all": Window(rate=1e4)}, **options)
    parts = []
    state = None
    for end in (0.005, 0.015, 0.025, 0.035, 0.06):
        parts.append(simulate(P, end, initial_state=state, **options))
        state = parts[-1].final_state
    times = np.concatenate([part.event_rows[:, 0] for part in parts])
    assert len(times) > 5
    # a run's end cuts a step in two, which costs its rounding
    np.testing.assert_allclose(times, whole.event_rows[:, 0], rtol=0, atol=1e-12)
    np.testing.assert_allclose(parts[-1].final_state.a, whole.final_state.a, rtol=1e-9)
    np.testing.assert_allclose(whole.samples["all"]["time"], np.arange(601) * 1e-4, atol=1e-15)
    spent = sum(whole.statistics[f"time_{phase}"] for phase in ("stick", "slip", "separation"))
    assert spent == pytest.approx(0.06, rel=1e-12)


@pytest.mark.parametrize(
    ("values", "fault"),
    [
        ({"parameter": "N", "to": 0, "start": 0, "end": 1}, "to=0: must be > 0 for N"),
        ({"parameter": "Omega", "to": -1, "start": 0, "end": 1}, "to=-1: must be"),
        ({"parameter": "Omega", "to": 1, "start": 1, "end": 1}, "start=1: must be < end=1"),
        ({"parameter": "c", "to": 1, "start": 0, "end": 1}, "parameter='c': must be"),
    ],
)
def test_ramps_that_cannot_be_are_refused(values: Any, fault: str) -> None:
    with refusal(fault):
        Ramp(**values)


def test_overlapping_ramps_of_one_name_are_refused() -> None:
    with refusal(r"ramps\.1\.start=0\.02: must be >= 0\.03"):
        simulate(P, 1, ramps=(BRAKE, BRAKE.replace(start=0.02, end=0.04)))
