"""What a fit says of its ends, bounds and limits, and how it is printed."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
import pytest
from matplotlib import pyplot

import disc_model as dm
from disc_model.errors import ParameterError
from disc_model.fitting.block_cycle import Unpredicted
from disc_model.fitting.combinations import combinations_of
from disc_model.fitting.prediction import Prediction
from tests.refusals import refusal

BLOCK = dm.Parameters(N=30, Omega=0.5, n_diameters=-1, k_p=2e3, mu_s=0.5, mu_k=0.3, c_p=0.5)


def both(case: dm.Parameters) -> float:
    """A quantity that determines friction only beside the damper."""
    return 10 * case.mu_s + case.c_p


def damping(case: dm.Parameters) -> float:
    return case.c_p


def damping_up_to_one(case: dm.Parameters) -> float:
    """A quantity that ends at a damper of 1 N s/m."""
    return case.c_p if case.c_p < 1 else math.nan


def fitted(damper: Any) -> dm.Fit:
    """Friction and a damper of 0.5 N s/m, which is known to 0.3 N s/m."""
    measured = [dm.Measurement(both, 5.5, 0.05), dm.Measurement(damper, 0.5, 0.3)]
    return dm.fit(BLOCK, ["mu_s", "c_p"], measured)


def test_an_end_of_an_interval_with_no_case_is_no_number() -> None:
    """It belonged to a negative damper, and was given as a number."""
    found = fitted(damping)
    mu_s = found.parameters["mu_s"]
    assert math.isnan(mu_s.high)
    assert mu_s.low == pytest.approx(0.5 - 0.0596, abs=1e-3)
    [end] = found.outside["mu_s"]
    assert end == pytest.approx(0.5 + 0.0596, abs=1e-3)
    assert (
        f"the interval of mu_s ends where there is no case: mu_s={end:.6g}, c_p=-0.0799"
        in found.doubt
    )


def test_an_end_without_the_motion_names_all_that_has_changed() -> None:
    """It named friction alone, at which the motion exists."""
    found = fitted(damping_up_to_one)
    [end] = found.unpredicted["mu_s"]
    place = f"no such motion was found at mu_s={end:.6g}, c_p=1.0799"
    assert place in found.doubt
    assert "lies within the interval of mu_s" in found.doubt


def test_a_value_is_not_at_a_bound_that_its_interval_passes() -> None:
    found = dm.fit(BLOCK, ["c_p"], [dm.Measurement(damping, 0.5, 1.0)])
    assert found.at_bounds == {"c_p": 0.0}
    assert found.reached == ()
    unlimited = replace(found, limits={"c_p": math.nan})
    title = unlimited.plot()[0].figure.get_suptitle()
    assert "at its bound" not in title
    assert "= 0.5 N s/m (interval passes 0 N s/m)" in " ".join(title.split())
    pyplot.close("all")


def test_a_value_at_its_bound_is_that_of_the_bound() -> None:
    """It was 2.4e-17."""
    found = dm.fit(BLOCK, ["c_p"], [dm.Measurement(damping, -9.0, 1.0)], bounds={"c_p": (0, 5)})
    assert found.reached == ("c_p",)
    assert repr(found).startswith("Fit(c_p=0;")
    assert "= 0 N s/m at its bound" in " ".join(found.plot()[0].figure.get_suptitle().split())
    pyplot.close("all")


def flat(case: dm.Parameters) -> float:
    return min(case.c_p, 1.0)


def test_a_parameter_without_a_limit_says_why() -> None:
    found = dm.fit(BLOCK, ["c_p"], [dm.Measurement(flat, 0.0, 1.0)], bounds={"c_p": (0, 50)})
    assert math.isnan(found.limits["c_p"])
    assert "no limit of c_p is known, since up to it chi squared does not rise" in found.doubt


def test_advice_is_of_what_a_fit_takes(monkeypatch: pytest.MonkeyPatch) -> None:
    """A fit takes no guess."""
    case = dm.Parameters(N=385, Omega=14)
    lost = replace(
        dm.floquet(case),
        period=math.nan,
        message=("no_cycle: none was found: give the last state of a longer simulation as guess"),
    )
    monkeypatch.setattr("disc_model.fitting.prediction.find_cycle", lambda *_: lost)
    with pytest.raises(Unpredicted, match="none was found: measure by a function of the case"):
        Prediction(case).of("period")


def test_a_misspelt_quantity_is_the_only_fault() -> None:
    with pytest.raises(ParameterError) as refused:
        dm.Measurement("perod", "15 ms", "1 ms")
    assert len(refused.value.faults) == 1


def test_a_table_may_have_comments() -> None:
    columns = {"quantity": ["frequency_2_0"], "value": [290.0], "uncertainty": [1.0]}
    case = dm.Parameters(N=385, Omega=14)
    plain = dm.fit(case, ["E"], pd.DataFrame(columns))
    assert dm.fit(case, ["E"], pd.DataFrame({**columns, "Comment": ["cold disc"]})) == plain
    with refusal("measured.coment: is neither a column"):
        dm.fit(case, ["E"], pd.DataFrame({**columns, "coment": ["cold disc"]}))


def test_a_parameter_that_is_known_by_itself_is_no_product() -> None:
    """It was c_p^0.0003 * k_p."""
    values = np.array([0.02, 19000.0])
    relative = np.array([[3.0, 0.0], [0.0, 1e-3]]) @ np.array([[1.0, 0.0], [-0.3, 1.0]])
    found = combinations_of(["c_p", "k_p"], ["c_p", "k_p"], values, relative * values[:, None])
    assert list(found) == ["k_p"]
    assert found["k_p"].value == 19000.0
    assert found["k_p"].unit == "N/m"


def test_values_near_the_start_are_judged_by_the_least_chi_squared() -> None:
    """They were said to miss the measurements, of which the best fit misses none."""
    found = dm.fit(BLOCK, ["c_p"], [dm.Measurement(damping, 5.0, 1.0)])
    nearest = replace(found, chi_squared=found.chi_squared + 3.9, excess=3.9)
    assert not nearest.misses
    assert replace(found, chi_squared=found.chi_squared + 3.9).misses


def test_a_fit_is_printed_as_a_short_table() -> None:
    measured = {"frequency_0_0": (239.0, 0.5), "frequency_2_0": (292.0, 0.5)}
    found = dm.fit(dm.Parameters(N=385, Omega=15, n_diameters=2), ["E"], measured)
    head, row, cost = str(found).splitlines()
    assert head.split() == ["fitted", "value", "deviation", "unit"]
    assert row.split()[0] == "E"
    assert row.split()[-1] == "Pa"
    assert cost.startswith("chi squared ")


def test_each_doubt_is_printed_on_a_line() -> None:
    lines = str(fitted(damping)).splitlines()
    doubts = [line for line in lines if line.startswith("doubt: ")]
    assert len(doubts) >= 2
    assert doubts[0].startswith("doubt: the interval of mu_s ends where")


def test_cycles_that_are_unstable_and_far_are_named_once() -> None:
    found = dm.fit(BLOCK, ["c_p"], [dm.Measurement(damping, 5.0, 1.0)])
    far = replace(found, unstable={"period": 0.5}, elsewhere=("period",))
    assert far.note.count("period") == 1
    assert far.note.endswith("does not stay on it, and none from the static start comes near")
