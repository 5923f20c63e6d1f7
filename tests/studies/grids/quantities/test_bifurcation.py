"""What a motion settles to, sampled at switches."""

from __future__ import annotations

import numpy as np
import pytest

from disc_model.parameters import Parameters
from disc_model.studies.grids.quantities import bifurcation
from disc_model.studies.grids.quantities.schema import BifurcationOptions

APART = {"parameters": {"N": 385, "Omega": 15.1}, "time": 70}


def test_stretches_of_one_motion_are_alike() -> None:
    two = np.tile([1.0, 2.0], 100)
    assert bifurcation.alike(two, two[1:])  # the median is another of the two
    assert not bifurcation.alike(two, np.tile([1.0, 2.0, 3.0], 67))
    assert not bifurcation.alike(two, two + 0.3)
    many = np.random.default_rng(1).uniform(size=(3, 4000))
    assert bifurcation.alike(many[0], many[1])
    assert not bifurcation.alike(many[0], 1.2 * many[1])
    assert not bifurcation.alike(many[0], many[1][:2000])


def test_a_slow_drift_of_one_point_is_told_from_rest() -> None:
    assert bifurcation.alike(np.full(50, 2.0), np.full(50, 2.0 + 1e-6))
    assert not bifurcation.alike(np.full(50, 2.0), np.full(50, 2.1))


@pytest.mark.compiled
@pytest.mark.parametrize(("Omega", "period", "phase"), [(9.5, 1, "stick"), (14.5, 2, "separation")])
def test_a_periodic_motion_has_as_many_points_as_its_period_has_switches(Omega: float, period: int, phase: str) -> None:
    options = BifurcationOptions(prepare=APART, transient=60, section="switch", samples=100)
    values, message = bifurcation.at(Parameters(N=385, Omega=Omega), options)
    assert (values["steady"], message) == ("yes", "")
    assert values["period"] == period
    psi = values["psi"][np.isfinite(values["psi"])]
    assert len(np.unique(np.round(psi, 5))) == period
    assert (values["phase"] == bifurcation.COLUMNS["phase"].variable.flags.index(phase)).all()
