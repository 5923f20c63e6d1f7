"""The paper's cases, made up once."""

import pytest
import xarray as xr

from disc_model.paper import measures, section41
from tests.paper import made_up


@pytest.fixture(scope="session")
def told() -> xr.DataTree:
    """What happened, by the paper."""
    return made_up.made_up(made_up.AS_TOLD)


@pytest.fixture
def cycles_as_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """Growth rates, energies and repeated simulations that fit it, without a search for cycles and a simulation."""
    monkeypatch.setattr(measures, "separates_within", lambda p, until: p.Omega > 15.05)
    monkeypatch.setattr(section41, "course", made_up.course_as_told)
    monkeypatch.setattr(section41, "of_windows", made_up.windows_as_told)
    monkeypatch.setattr(measures, "cycle_of", made_up.cycle_as_told)
