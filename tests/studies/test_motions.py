"""Motions of which histories are kept for the explorer."""

import json

import numpy as np
import pytest

from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Record, Window
from disc_model.simulation.states import static_start
from disc_model.studies.grid import Dimension
from disc_model.studies.motions import LONGEST, SAMPLES, cycle_length, run_motions
from disc_model.studies.quantities.outcome import HorizonOutcome
from disc_model.studies.quantity import Point, quantity_of
from tests.studies.refused import parse_grid

AXES = {"N": [100, 200, 385], "Omega": {"start": 10, "stop": 20, "count": 21}}


def texts(quantity: str, **more) -> dict[str, str]:
    raw = {"study": "small", "quantity": quantity, "axes": AXES} | more
    return dict(parse_grid(raw).motions)


def histories(quantity: str, N: list[float], Omega: list[float], **options):
    (text,) = texts(quantity, axes={"N": N, "Omega": Omega}, options=options).values()
    return run_motions(text)


def test_few_values_of_an_axis_are_taken_both_ends_among_them():
    dim = Dimension(("Omega",), (tuple((float(x),) for x in range(11)),))
    assert dim.thinned(4).values == ((0.0,), (3.0,), (7.0,), (10.0,))
    assert dim.thinned(11).values == dim.thinned(99).values == dim.values
    assert dim.thinned(1).values == ((0.0,),)
    # words are all taken
    dim = Dimension(("start",), (tuple((word,) for word in "abcde"),))
    assert dim.thinned(2).values == dim.values


def test_points_of_a_study_and_the_name_of_their_file():
    ((name, text),) = texts("floquet").items()
    points = json.loads(text)["points"]
    assert len(points) == 3 * quantity_of("floquet").motions
    assert (points[0], points[-1]) == ([100.0, 10.0], [385.0, 20.0])
    assert texts("floquet") == {name: text}
    assert name not in texts("floquet", options={"tol": 1e-11})
    assert name not in parse_grid({"study": "small", "quantity": "floquet", "axes": AXES}).batches


def test_the_history_goes_on_from_the_late_stretch():
    """The contact force stays in the range that the dataset gives for the late stretch of a settled motion."""
    row, _ = HorizonOutcome(horizon=200).compute_point(Point(Parameters(N=200, Omega=5)))
    assert row["outcome"] == "quiet"
    found = histories("outcome", [200], [5], horizon=200)
    # another phase of sampling finds extremes to a thousandth of the range
    room = 1e-2 * (row["P_max"] - row["P_min"])
    assert row["P_min"] - room <= found["P"].min() <= found["P"].max() <= row["P_max"] + room
    assert np.ptp(found["P"].values) > 0.9 * (row["P_max"] - row["P_min"])


def test_samples_are_those_of_the_motion():
    found = histories("bifurcation", [385], [15.1], transient=2.0, samples=1).isel(point=0)
    p = Parameters(N=385, Omega=15.1)
    length = float(found["length"])
    window = Window(start=2.0, stop=2.0 + length, rate=1e6)
    (samples,) = simulate(p, 2.0 + length, record=Record(windows=(window,), events=False)).samples
    times = 2.0 + np.linspace(0, length, SAMPLES)
    for name in ("P", "u", "psi"):
        expected = np.interp(times, samples["time"], samples[name])
        # one sample may fall on a jump of P at a switch, on either side
        close = np.isclose(found[name], expected, atol=1e-4 * np.ptp(expected), rtol=0)
        assert close.sum() >= SAMPLES - 8


def test_a_cycle_without_releases_is_the_free_period():
    p = Parameters(N=200, Omega=20, mu_s=0.0, mu_k=0.0)
    assert cycle_length(p, static_start(p)) == pytest.approx(2 * np.pi * np.sqrt(p.m / p.k_p))
    slack = p.replace(k_p=0.0)
    assert cycle_length(slack, static_start(slack)) == LONGEST
