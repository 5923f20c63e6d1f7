"""Runs that are cut at an event, just before it or just after it, and continued: the motion goes on
as if it had not been cut."""

import math
from typing import Any

import numpy as np
import pytest

from disc_model import Parameters, Ramp, State, simulate
from disc_model.simulation.states import SAME_SPEED, perturb, static_start
from tests.contact_laws import ALL_LAWS, COMPILES, by_series
from tests.refusals import refusal

P = Parameters(N=385, Omega=15.1)
SPANS = (-1e-12, -1e-15, 1e-15, 1e-14, 1e-12, 1e-10)
"""From an event to the cut, s. Errors of the state at the event last for some 1e-11 s at most."""
LAWS: dict[str, dict[str, Any]] = {
    "paper": {},
    "no_drop_of_friction": {"mu_s": 0.3, "mu_k": 0.3},
    "damper": {"c_p": 0.5},
    "no_spring": {"k_p": 0.0, "contact_compliance": 1e-7},
    **ALL_LAWS,
}
QUICK = ("paper", "no_drop_of_friction", "damper", "compliant_normal", "vertical_falling")
"""The laws whose kernels other quick tests compile as well."""


def around(time: float) -> list[float]:
    """Times of cuts around an event: at it, one floating-point number beside it, and `SPANS`."""
    beside = [math.nextafter(time, -math.inf), time, math.nextafter(time, math.inf)]
    return beside + [time + span for span in SPANS]


def assert_equal_where_cut(
    p: Parameters, start: State | None, tol: float, ramps: tuple[Ramp, ...]
) -> None:
    """Cut a run at 24 of its events, continue it over the next events, and compare all events with
    those of the whole run."""
    options: dict[str, Any] = {"tol": tol, "ramps": ramps}
    whole = simulate(p, 0.4, initial_state=start, **options).event_rows
    assert len(whole) > 40
    for i in np.linspace(1, len(whole) - 9, 24).astype(int):
        end = float(whole[i + 6, 0] + whole[i + 7, 0]) / 2
        expected = whole[: i + 7]
        for cut in around(float(whole[i, 0])):
            first = simulate(p, cut, initial_state=start, **options)
            rest = simulate(p, end, initial_state=first.final_state, **options)
            rows = np.concatenate([first.event_rows, rest.event_rows])
            where = f"event {i} at {whole[i, 0]} s, cut at {cut} s"
            assert rows[:, 1].tolist() == expected[:, 1].tolist(), where
            # the error of a step that is cut in two: 80 times the tolerance, of times below 1 s
            np.testing.assert_allclose(
                rows[:, 0], expected[:, 0], rtol=0, atol=80 * tol, err_msg=where
            )


@pytest.mark.parametrize("tol", [1e-10, 1e-6])
@pytest.mark.parametrize(
    "name", [pytest.param(x, marks=() if x in QUICK else COMPILES) for x in LAWS]
)
def test_a_run_that_is_cut_beside_an_event_goes_on_as_the_whole_run(name: str, tol: float) -> None:
    """Final states were refused, because f was -1e-26 in slip forwards, and slip or separation that
    had just begun ended at once, by errors of the state."""
    p = P.replace(**LAWS[name])
    if name != "no_spring":
        assert_equal_where_cut(p, None, tol, ())
    # with separations and impacts
    assert_equal_where_cut(p, perturb(p, static_start(p), u=-0.02), tol, ())


@pytest.mark.parametrize("name", [pytest.param(x, marks=COMPILES) for x in ("paper", *ALL_LAWS)])
def test_so_does_one_on_a_ramp(name: str) -> None:
    p = P.replace(**LAWS[name])
    # a stick that is followed by its series, with its larger errors
    assert_equal_where_cut(p, None, 1e-6, (by_series(p),))


def test_rounding_against_the_direction_of_slip_is_no_fault_and_more_is_one() -> None:
    whole = simulate(P, 0.02)
    release = float(whole.events["time"].iloc[0])
    state = simulate(P, release + 1e-15).final_state
    assert state.phase == "slip"
    assert state.direction == 1
    room = SAME_SPEED * P.Omega
    for f in (-0.5 * room, -1e-26, 0.0):
        rest = simulate(P, 0.02, initial_state=state.replace(f=f, direction=1))
        assert rest.event_rows[:, 1].tolist() == whole.event_rows[1:, 1].tolist()
        times = rest.event_rows[:, 0]
        expected = whole.event_rows[1:, 0]
        np.testing.assert_allclose(times, expected, atol=1e-12)
    with refusal(r"initial_state\.f=.* the sign of direction=1"):
        simulate(P, 0.02, initial_state=state.replace(f=-2 * room))


def test_no_final_state_slips_against_its_direction() -> None:
    p = P.replace(mu_s=0.3, mu_k=0.3)
    start = perturb(p, static_start(p), u=-0.02)
    events = simulate(p, 0.4, initial_state=start).event_rows
    for time in events[:60, 0]:
        for cut in around(float(time)):
            state = simulate(p, cut, initial_state=start).final_state
            assert state.f * state.direction >= 0
