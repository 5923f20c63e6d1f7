"""Cycles and their multipliers, tabulated."""

from disc_model import Parameters, floquet
from disc_model.data.variables import flag_names
from tests.studies.grids.conftest import SMALL, computed


def test_cycles_are_tabulated_with_their_status() -> None:
    found = computed(quantity="floquet", options={}, base={"Omega": 20} | SMALL, axes={"N": [0, 200]})
    assert flag_names(found["status"]).tolist() == ["no_stick_slip", "ok"]
    assert found["growth_rate"].sel(N=200) == floquet(Parameters(N=200, Omega=20, **SMALL)).growth_rate
    assert str(found["message"].sel(N=0).item())
