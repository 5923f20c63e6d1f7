"""Constants of a case: where things lie, and the scales by which rounding and steps are judged."""

import numpy as np
import pytest

from disc_model import Parameters
from disc_model.engine.model import build_state
from disc_model.simulation.states import engine_case

COMPLIANCES = pytest.mark.parametrize("compliance", [0.0, 1e-7])


def case(compliance: float) -> Parameters:
    """So many modes that the room for u lies behind what the modes alone fill: sizes are multiples
    of eight."""
    return Parameters(N=300, Omega=20, n_diameters=2, n_circles=3, contact_compliance=compliance)


@COMPLIANCES
def test_the_closed_form_of_stick_knows_the_places_of_the_state(compliance: float) -> None:
    """At rest under the preload all modes of cos and those without diameter are bent, and on a
    compliant contact u."""
    model = engine_case(case(compliance)).model
    disc = build_state(model).disc
    width = len(model.mode_amplitude)
    n0 = len(model.mode_amplitude0)
    bent = [*np.flatnonzero(model.mode_amplitude), *range(2 * width, 2 * width + n0)]
    if compliance:
        bent.append(2 * (width + n0))
    assert len(model.modes.rest) == len(disc)
    assert np.flatnonzero(model.modes.rest).tolist() == sorted(bent)


@COMPLIANCES
def test_scales_are_of_a_motion_under_the_preload(compliance: float) -> None:
    """The slider's speed: what every mode's static deflection, and the contact's, is at its own
    frequency."""
    p = case(compliance)
    model = engine_case(p).model
    omega = np.sqrt(np.append(model.stiffness[model.mode_amplitude != 0], model.stiffness0))
    force = np.append(model.mode_amplitude[model.mode_amplitude != 0], model.mode_amplitude0)
    each = [p.N * shape**2 / rate for shape, rate in zip(force, omega, strict=True)]
    # sums of the same terms: rounding alone
    of_disc = sum(each)
    of_contact = p.N * compliance / model.unit
    assert model.slider_scale == pytest.approx(of_disc + of_contact, rel=1e-12)
    assert model.velocity_scale == pytest.approx(max(p.N * abs(force) / omega), rel=1e-12)
