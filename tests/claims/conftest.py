"""The paper's cases, made up once."""

import pytest
import xarray as xr

from disc_model.claims import energy, measures
from tests.claims import made_up


@pytest.fixture(scope="session")
def told() -> xr.DataTree:
    """What happened, by the paper."""
    return made_up.made_up(made_up.AS_TOLD)


@pytest.fixture
def cycles_as_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """Growth rates and energies that fit it, without a search for cycles and a simulation."""
    monkeypatch.setattr(energy, "course", made_up.course_as_told)
    monkeypatch.setattr(measures, "cycle_of", made_up.cycle_as_told)
