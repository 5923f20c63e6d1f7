"""The long-double references of every contact law (tests/references/taylor.py)."""

from __future__ import annotations

import pytest

from tests.references import stored, taylor


# ------------------------------------------------------------------------ the references themselves
@pytest.mark.parametrize(("name", "span"), [("A", 0.1), ("B", 0.1), ("C", 0.1)])
def test_the_default_law_gives_the_stored_references(name, span):
    """Two long-double integrators that share no code, 13 to 44 events; rounding alone is 1e-19 s."""
    data = stored.load(name)
    case = stored.case_of(data)
    q = taylor.Problem(case.N, case.Omega, case.omega, case.psi, taylor.Law())
    start = data["start"] or q.equilibrium()
    events = taylor.Reference(q, start).run(float(start.time) + span).events
    assert len(events) >= 13
    assert stored.largest_difference(events, data) < 1e-17


@pytest.mark.parametrize("name", taylor.LAWS)
def test_stored_runs_can_be_regenerated(name):
    runs = stored.load(f"contact_{name}")["runs"]
    q = taylor.problem(name)
    for run, start in ((runs[0], q.equilibrium()), (runs[1], runs[1]["start"])):
        reference = taylor.Reference(q, start, audit=True).run(float(start.time) + 0.01)
        assert stored.largest_difference(reference.events, run) < 1e-16
        assert reference.defect < 1e-17


@pytest.mark.parametrize("name", taylor.LAWS)
def test_stored_runs_hold_what_they_are_for(name):
    first, *pieces = stored.load(f"contact_{name}")["runs"]
    kinds = [kind for run in pieces for kind in run["kinds"]]
    assert first["kinds"].count("stick_to_slip") > 60
    assert pieces[-1]["t_end"] == pytest.approx(0.5)
    assert kinds.count("separation") > 50
    assert kinds.count("stick_to_slip") > 50
    assert max(run["largest_difference_to_check_run"] for run in (first, *pieces)) < 1e-15
    # coefficients of two exact balances, relative to the energy: rounding of 64 bits
    assert max(run["largest_energy_defect"] for run in (first, *pieces)) < 1e-16


@pytest.mark.parametrize(("law", "rising"), [(taylor.Law(), True), (taylor.Law(0.0, "normal"), False)])
def test_energy_of_the_references_impacts(law, rising):
    """The change is as the model says; with the vertical force an impact can raise the energy, with the normal none."""
    data = stored.load("C")
    q = taylor.Problem(385.0, 15.1, data["modes"]["omega"], data["modes"]["psi"], law)
    impacts = taylor.Reference(q, data["start"]).run(54.6).impacts
    assert len(impacts) > 5
    for change, expected in impacts:
        assert change == pytest.approx(expected, abs=1e-16)  # of some 0.1 J
    assert any(change > 0 for change, _ in impacts) == rising
