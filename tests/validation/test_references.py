"""simulate against references that were computed apart from it.

tests/references/data holds event times of a long-double heyoka run (two runs of different order and step
size agree to 4e-18 s, a 53-bit run to 3e-15 s); tests/references/literal.py is the paper's Eqs. (18)-(37) as
printed.
"""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from disc_model import Parameters, Record, Window, plate_modes, simulate
from disc_model.simulation.api import published_start
from tests import needs
from tests.references import stored
from tests.references.printed import literal_events

pytestmark = pytest.mark.compiled

TOLERANCES = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14)
#: Largest event-time error over the stored second divided by tol: about 0.05 s in all the cases, with a
#: margin of 20.
ERROR_PER_TOL = 1.0
#: Below this, double precision (53 bits, times near 55 s have a spacing of 7e-15 s) decides, not tol.
ROUNDING = 1e-13


def _events(name, tol):
    data = stored.load(name)
    p = stored.parameters_of(data)
    start = stored.engine_state(data["start"], p) if data["start"] else None
    return simulate(p, data["t_end"], tol=tol, initial_state=start).events


def _error(name, tol):
    """Largest event-time error (s) after checking that all the events are there, in order."""
    data, events = stored.load(name), _events(name, tol)
    assert list(events["kind"]) == stored.kinds_of(data)
    assert list(events["phase"]) == [e["phase"] for e in data["events"]]
    return float(np.abs(events["time"].to_numpy() - stored.times_of(data)).max())


@pytest.mark.parametrize("name", ["A", "B", "C"])
def test_modes_are_those_of_the_reference(name):
    data = stored.load(name)
    modes = plate_modes(stored.parameters_of(data))
    np.testing.assert_allclose(modes["omega"], data["modes"]["omega"], rtol=2e-15)
    np.testing.assert_allclose(np.abs(modes["psi"]), data["modes"]["psi"], rtol=4e-15)


@pytest.mark.parametrize(("name", "count", "separations"), [("A", 135, 0), ("B", 140, 0), ("C", 398, 131)])
def test_every_event_to_1e_13_at_the_tightest_tolerance(name, count, separations):
    kinds = stored.kinds_of(stored.load(name))
    assert (len(kinds), kinds.count("separation")) == (count, separations)
    assert _error(name, 1e-15) <= 1e-13


@pytest.mark.parametrize("name", ["A", "B", "C"])
def test_error_falls_with_tol_as_ordered(name):
    errors = {tol: _error(name, tol) for tol in (1e-6, 1e-8, 1e-10, 1e-12)}
    for tol, error in errors.items():
        assert error <= ERROR_PER_TOL * tol + ROUNDING, errors
    values = list(errors.values())
    for coarse, fine in itertools.pairwise(values):
        assert fine <= coarse / 10 + ROUNDING, errors  # tol falls a hundredfold: at least ten, in practice 60 to 200


@pytest.mark.parametrize("tol", TOLERANCES)
def test_all_398_switches_of_the_separating_second(tol):
    assert _error("C", tol) <= ERROR_PER_TOL * tol + ROUNDING


def test_values_at_the_events():
    data = stored.load("C")
    events = _events("C", 1e-14)
    for name in ("psi", "f", "P"):
        wanted = np.array([e[name] for e in data["events"]])
        np.testing.assert_allclose(events[name], wanted, atol=1e-10 * np.abs(wanted).max(), rtol=0)


@pytest.mark.parametrize(("tol", "allowed"), [(1e-8, 1e-7), (1e-10, 1e-8), (1e-12, 1e-9), (1e-15, 1e-11)])
def test_first_separation_at_15_1_rad_s(tol, allowed):
    """54.418905535947973 s: long-double runs agree to 4e-16 s, 53-bit runs to 4e-13 s.

    Rounding of one unit in the last place of any mode shifts it by no more than 4e-16 s, see the stored data.
    """
    data = stored.load("first_separation")
    result = simulate(stored.parameters_of(data), 60.0, tol=tol, stop_at="first_separation")
    assert result.first_separation == pytest.approx(data["time"], abs=allowed, rel=0)
    assert len(result.events) == data["events_before"] + 1


def _wild():
    groups = stored.load("wild")["groups"]
    return [
        pytest.param(g["parameters"], g["t_end"], run, id=f"{name}-{i}")
        for name, g in zip(("published", "slippery"), groups, strict=True)
        for i, run in enumerate(g["runs"])
    ]


@pytest.mark.parametrize(("parameters", "t_end", "run"), _wild())
def test_violent_motion(parameters, t_end, run):
    """Crowded switches, P < 0 after an impact, reversals, both directions, all dampers: 2076 events."""
    p = Parameters(**parameters)
    start = stored.engine_state(run["start"], p)
    for tol in (1e-6, 1e-10, 1e-14):
        events = simulate(p, t_end, tol=tol, initial_state=start).events
        assert list(events["kind"]) == run["kinds"]
        assert float(np.abs(events["time"].to_numpy() - stored.times_of(run)).max()) <= ERROR_PER_TOL * tol + ROUNDING


def test_wild_runs_hold_what_they_are_for():
    runs = [param.values[2] for param in _wild()]
    gaps = np.concatenate([np.diff([float(t) for t in run["times"]]) for run in runs])
    kinds = [kind for run in runs for kind in run["kinds"]]
    assert kinds.count("slip_reversal") > 100
    assert (gaps == 0).sum() > 10  # contact lost again in the instant of the impact
    assert ((gaps > 0) & (gaps < 1e-5)).sum() >= 3


# ----------------------------------------------------------------- the paper's equations, literally
#: The literal run (DOP853, rtol 1e-13) agrees with the stored references to 1e-14 s; chaotic growth over the
#: longest span here leaves two more digits, and a wrong term of any size would cost far more than 1e-11 s.
LITERAL = 1e-11


def _compare_with_literal(p, start, span, drive=0.0):
    wanted = literal_events(p, start, span, drive)
    events = simulate(p, start.time + span, tol=1e-14, initial_state=start).events
    assert list(events["kind"]) == [kind for _, kind in wanted]
    np.testing.assert_allclose(events["time"] - start.time, [t for t, _ in wanted], atol=LITERAL, rtol=0)
    return [kind for _, kind in wanted]


@pytest.mark.parametrize(("span", "count"), [(0.05, 7), pytest.param(0.2, 27, marks=pytest.mark.slow)])
def test_literal_from_equilibrium(span, count):
    p = Parameters(N=385.0, Omega=15.1)
    assert len(_compare_with_literal(p, published_start(p), span)) == count


@pytest.mark.parametrize("drive", [0.0, 2.0])
def test_literal_with_separation_and_impact(drive):
    """The start angle does not matter."""
    data = stored.load("C")
    p = stored.parameters_of(data)
    kinds = _compare_with_literal(p, stored.engine_state(data["start"], p), 0.05, drive)
    assert kinds.count("reattachment") >= 3


LITERAL_VARIANTS = {
    "dampers": {"c": 5.0, "c_p": 0.5, "D_star": 5e-5},
    "orthonormal": {"normalization": "orthonormal"},
    "two circles": {"n_circles": 1, "n_diameters": 2},
    "other mass and springs": {"m": 0.3, "k": 8e4, "k_p": 3e4, "mu_s": 0.5, "mu_k": 0.1},
}


@pytest.mark.parametrize("variant", LITERAL_VARIANTS)
def test_literal_other_parameters(variant):
    """From a state of strong vibration, so that contact is lost."""
    p = Parameters(N=60.0, Omega=15.1, **LITERAL_VARIANTS[variant])
    modes = plate_modes(p)
    size = np.sign(modes["psi"].to_numpy()) / modes["omega"].to_numpy()
    pair = modes["diameters"].to_numpy() > 0
    a = -p.N * modes["psi"].to_numpy() / modes["omega"].to_numpy() ** 2
    start = published_start(p).replace(
        phase="slip",
        direction=1,
        f=2.0,
        psi=0.0,
        a=a - 0.6 * size,
        b=0.2 * size * pair,
        alpha=np.zeros(len(a)),
        beta=-0.2 * pair,
    )
    w = float(modes["psi"] @ start.a)
    velocity = float(modes["psi"] @ (start.alpha + modes["diameters"] * start.f * start.b))
    kinds = _compare_with_literal(p, start.replace(u=w, u_velocity=velocity), 0.03)
    assert {"separation", "reattachment"} <= set(kinds)


def test_literal_bonded():
    """Contact kept by force: from the separating second of case C, P turns negative and nothing separates."""
    data = stored.load("C")
    p = Parameters(**data["parameters"], contact="bonded")
    start = stored.engine_state(data["start"], p)
    kinds = _compare_with_literal(p, start, 0.06)
    assert set(kinds) == {"slip_to_stick", "stick_to_slip"}
    record = Record(windows=(Window(start=start.time, stop=start.time + 0.06, rate=1e4),))
    assert simulate(p, start.time + 0.06, initial_state=start, record=record).samples[0]["P"].min() < 0


# ------------------------------------------------------------------------ the references themselves
@needs.MPMATH.mark
def test_stored_data_can_be_regenerated():
    from tests.references import heyoka_reference

    data = stored.load("C")
    run = heyoka_reference.Reference(stored.case_of(data), data["start"]).run(54.5)
    assert len(run.events) > 30
    assert stored.largest_difference(run.events, data) < 1e-16
