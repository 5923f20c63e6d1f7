"""What a run says of the surface beside its balances of energy."""

import numpy as np
import pytest

from disc_model import Parameters
from disc_model.engine.audit import surface_share
from disc_model.engine.model import build_state
from disc_model.engine.series import build_series
from disc_model.engine.step import expand
from disc_model.simulation.states import engine_case

ORDER = 4


@pytest.mark.parametrize("Omega", [10.0, 0.0])
def test_the_surface_s_speed_is_that_over_the_drive_s_if_that_moves(Omega: float) -> None:
    p = Parameters(N=200, Omega=Omega, n_diameters=1, friction_offset=0.02)
    model = engine_case(p).model
    state = build_state(model)
    lane = np.flatnonzero(model.tangential)[0]
    state.e[lane] = -3.0 / model.tangential[lane]  # v_s = -3 m/s
    series = build_series(model, ORDER)
    expand(model, series, state, ORDER)
    wanted = 0.0
    if Omega:
        wanted = 3.0 / (p.r_0 * Omega)
    assert surface_share(model, series) == pytest.approx(wanted, rel=1e-14)
