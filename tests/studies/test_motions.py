"""Motions of which histories are kept for the explorer."""

import json

import numpy as np
import pytest

from disc_model import floquet
from disc_model.data.variables import CycleStatus, flag_names
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Window
from disc_model.simulation.states import State, static_start
from disc_model.studies.grid import Dimension
from disc_model.studies.motions import SAMPLES, Motions, run_motions
from disc_model.studies.quantity import Point, Quantity
from disc_model.studies.registry import quantity_of
from tests.studies.refused import parse_grid

LATE = (15.1, {"horizon": 60})
AXES = {"N": [100, 200, 385], "Omega": {"start": 10, "stop": 20, "count": 41}}


def texts(quantity: str, **more) -> dict[str, str]:
    raw = {"study": "small", "quantity": quantity, "axes": AXES} | more
    return dict(parse_grid(raw).motions)


def histories(quantity: str, N: list[float], Omega: list[float], **options):
    (text,) = texts(quantity, axes={"N": N, "Omega": Omega}, options=options).values()
    return run_motions(text)


def test_points_of_a_study_and_the_name_of_their_file():
    ((name, text),) = texts("floquet").items()
    points = json.loads(text)["points"]
    assert len(points) == 3 * quantity_of("floquet").motions
    assert points[0] == [100.0, 10.0]
    assert points[-1] == [385.0, 20.0]
    assert texts("floquet") == {name: text}
    assert name not in texts("floquet", options={"tol": 1e-11})
    few = {"N": [100, 200, 300, 385], "Omega": {"start": 10, "stop": 20, "count": 25}}
    (small,) = texts("floquet", axes=few).values()
    assert len(json.loads(small)["points"]) == 4 * 25, "all points of a grid of up to 100"
    assert name not in parse_grid({"study": "small", "quantity": "floquet", "axes": AXES}).batches


def test_motions_are_kept_at_evenly_spaced_values_and_at_every_word():
    eight = Dimension(["c"], [[(float(i),) for i in range(8)]])
    assert eight.thinned(4).values == ((0.0,), (2.0,), (5.0,), (7.0,))
    assert eight.thinned(1).values == ((0.0,),)
    assert eight.thinned(9).values == eight.values
    words = Dimension(["start"], [[(word,) for word in "abc"]])
    assert words.thinned(2).values == words.values


def test_samples_are_those_of_the_motion():
    found = histories("bifurcation", [385], [15.1], transient=2.0, samples=1).isel(point=0)
    p = Parameters(N=385, Omega=15.1)
    length = float(found["length"])
    window = Window(start=2.0, stop=2.0 + length, rate=1e6)
    samples = simulate(p, 2.0 + length, {"w": window}, events=False).samples["w"]
    times = 2.0 + np.linspace(0, length, SAMPLES)
    for name in ("P", "u", "psi"):
        expected = np.interp(times, samples["time"], samples[name])
        # one sample may fall on a jump of P at a switch, on either side
        close = np.isclose(found[name], expected, atol=1e-4 * np.ptp(expected), rtol=0)
        assert close.sum() >= SAMPLES - 8


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("quantity", "Omega", "options"),
    [
        ("floquet", 14.0, {}),
        *((name, *at) for name in ("outcome", "regions") for at in ((14.0, {"horizon": 5}), LATE)),
    ],
)
def test_a_quantity_shows_the_motion_that_it_tells_of(
    quantity: str, Omega: float, options: dict[str, float]
) -> None:
    motion = histories(quantity, [385], [Omega], **options).isel(point=0)
    assert int(motion["status"]) == 0
    assert 0 < float(motion["length"]) < 1
    phases = set(flag_names(motion["phase"]).tolist())
    expected = {"stick", "slip"}
    if Omega > 15:
        expected.add("separation")
    assert phases == expected


class FromRest(Quantity):
    """A quantity whose motions begin at the static start."""

    def state_at(self, point: Point) -> State:
        return static_start(point.parameters)


def length_of(p: Parameters) -> float:
    values, _ = Motions(FromRest()).compute_point(Point(p))
    return float(values["length"])


def test_a_history_is_two_cycles_long() -> None:
    """Of the cycle itself; of the free swing of the slider where nothing is released; and a tenth of
    a second at most."""
    p = Parameters(N=385, Omega=14)
    found = histories("floquet", [385], [14.0]).isel(point=0)
    period = floquet(p).period
    free = 2 * np.pi * np.sqrt(p.m / p.k_p)
    assert period > free
    assert float(found["length"]) == pytest.approx(2 * period, rel=1e-9)
    assert length_of(p.replace(Omega=0)) == pytest.approx(2 * free, rel=1e-12)
    # its free swing lasts 0.14 s
    assert length_of(p.replace(Omega=0, k_p=200)) == pytest.approx(0.1)
    assert length_of(p.replace(Omega=0, k_p=0)) == pytest.approx(0.1)
    # two releases in half a second, 0.2 s apart
    assert length_of(p.replace(Omega=0.3)) == pytest.approx(0.1)


def test_phases_of_a_history_are_those_of_its_samples() -> None:
    found = histories("floquet", [385], [14.0]).isel(point=0)
    words = flag_names(found["phase"])
    # a cycle begins at the end of stick, and sticks again at its end
    assert words[1] == "slip"
    half = (SAMPLES - 1) // 2
    assert words[half] == "stick"
    assert words[-2] == "stick"


@pytest.mark.compiled
def test_a_motion_sampled_at_events_begins_after_its_whole_transient() -> None:
    """It was that after 20 s, in contact all along; samples were taken after 80 s, with separations."""
    ratio = {"base": {"N": 385, "Omega": 15.5}, "axes": {"mu_k_over_mu_s": [0.6]}}
    options = {"section": "event", "transient": 20, "samples": 3}
    (text,) = texts("bifurcation", options=options, **ratio).values()
    motion = run_motions(text).isel(point=0)
    assert "separation" in flag_names(motion["phase"])
    assert float(motion["P"].min()) == 0.0


@pytest.mark.compiled
def test_where_no_cycle_is_found_the_motion_from_the_static_start_is_kept() -> None:
    """No motion was shown of a study most of whose points slide."""
    (text,) = texts("floquet", base={"c_p": 20}, axes={"N": [200], "Omega": [14.0]}).values()
    motion = run_motions(text).isel(point=0)
    assert int(motion["status"]) == 0
    assert set(flag_names(motion["phase"]).tolist()) <= {"stick", "slip"}
    start = static_start(Parameters(N=200, Omega=14.0, c_p=20.0))
    assert float(motion["u"][0]) == pytest.approx(start.u)


def test_every_status_of_a_search_for_cycles_says_what_motion_is_kept() -> None:
    told = quantity_of("floquet").motion_by
    assert {status.value for status in CycleStatus} <= {*told}
