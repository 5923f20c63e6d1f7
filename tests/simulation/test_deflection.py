"""The whole disc's deflection: against the engine's own samples at one point, and the plate's
clamp."""

from pathlib import Path

import numpy as np
import pytest

from disc_model import Parameters, Ramp, Window, deflection, simulate, snapshots
from tests.refusals import refusal

P = Parameters(N=200, Omega=20)


@pytest.mark.parametrize("normalization", ["as_published", "orthonormal"])
def test_it_is_what_the_engine_samples_at_a_point_fixed_to_the_disc(normalization: str) -> None:
    p = P.replace(normalization=normalization)
    times = np.array([0.0, 0.013, 0.05, 0.2])
    w = deflection(p, snapshots(p, times), p.r_0, [0.0, 1.0])
    assert w.dims == ("time", "r", "theta")
    assert w.attrs["units"] == "m"
    windows = {str(theta): Window(stop=0.2, rate=1000, theta=theta) for theta in (0.0, 1.0)}
    for i, samples in enumerate(simulate(p, 0.2, windows).samples.values()):
        sampled = samples["w_point"]
        there = np.searchsorted(samples["time"], times - 1e-9)
        # pieces of a run and one whole run differ by their truncation error
        np.testing.assert_allclose(w[:, 0, i], sampled[there], atol=1e-9 * np.abs(sampled).max())


def test_the_static_disc_is_lowest_under_the_slider() -> None:
    (start,) = snapshots(P, 0.0)
    w = deflection(P, start, [P.a, P.r_0], np.linspace(-np.pi, np.pi, 181))
    clamp, circle = w.values[0]
    assert circle[90] == pytest.approx(start.u, rel=1e-12)
    assert circle.argmin() == 90
    np.testing.assert_allclose(clamp, 0, atol=1e-9 * abs(start.u))
    np.testing.assert_allclose(circle, circle[::-1], atol=1e-15)


RAMPS = (
    Ramp(parameter="Omega", to=12, start=0.02, end=0.05),
    Ramp(parameter="N", to=150, start=0.03, end=0.06),
)
AT_ONE = Window(rate=1000, theta=1.0)


def test_on_a_ramp_the_drive_has_turned_by_less_than_omega_times_the_time() -> None:
    """The angle of the drive was Omega(0) t, so that the disc stood elsewhere."""
    run = simulate(P, 0.1, {"w": AT_ONE}, ramps=RAMPS)
    w = deflection(P, run.final_state, P.r_0, 1.0).item()
    assert w == pytest.approx(run.samples["w"]["w_point"][-1], rel=1e-9)
    # 20 rad/s for 20 ms, 16 rad/s in the mean for 30 ms, 12 rad/s for 50 ms
    assert run.final_state.drive_angle == pytest.approx(1.48, rel=1e-14)
    assert run.final_state.material_angle(P) == pytest.approx(1.48 - run.final_state.psi)
    for state in snapshots(P, [0.01, 0.045, 0.1], ramps=RAMPS):
        i = round(1000 * state.time)
        there = deflection(P, state, P.r_0, 1.0).item()
        # pieces of a run differ from the whole run by truncation errors
        assert there == pytest.approx(run.samples["w"]["w_point"][i], rel=1e-8)


@pytest.mark.parametrize("ramps", [(), RAMPS], ids=["constant", "on ramps"])
def test_a_point_of_the_disc_does_not_jump_where_the_speed_of_the_drive_does(
    ramps: tuple[Ramp, ...],
) -> None:
    first = simulate(P, 0.1, {"w": AT_ONE}, ramps=ramps)
    other = P.replace(Omega=33.0)
    second = simulate(other, 0.2, {"w": AT_ONE}, initial_state=first.final_state)
    before, after = (run.samples["w"]["w_point"] for run in (first, second))
    assert after[0] == pytest.approx(before[-1], rel=1e-12)
    there = deflection(other, second.final_state, P.r_0, 1.0).item()
    assert there == pytest.approx(after[-1], rel=1e-9)
    # a clock that is set anew says where the drive is
    turned = first.final_state.replace(time=0.0)
    assert turned.drive_angle is None
    assert turned.material_angle(P) == -turned.psi
    with refusal(r"drive_angle=nan: "):
        simulate(P, 0.1, initial_state=turned.replace(drive_angle=float("nan")))


def test_a_film_shows_the_disc_and_the_slider_of_the_run_with_its_ramps(tmp_path: Path) -> None:
    """They were those of a run without ramps, beside the force of the right one."""
    run = simulate(P, 0.1, {"w": AT_ONE}, ramps=RAMPS)
    path = tmp_path / "film.gif"
    film = run.animate(path, window="w", frames=2)
    disc, _ = film._fig.axes
    (slider,) = (line for line in disc.lines if line.get_marker() == "s")
    angle, radius = np.ravel(slider.get_data())
    assert angle == pytest.approx(1.48 - run.final_state.psi, rel=1e-6)
    assert radius == P.r_0
