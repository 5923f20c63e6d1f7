"""The cycle's stability against growth in simulations, prototypes' growth rates, and limits with
known answers."""

from pathlib import Path

import numpy as np
import pytest
import yaml

from disc_model import Parameters, floquet
from disc_model.analysis.spectra import nearest_resonance
from disc_model.data.variables import CycleStatus
from disc_model.stability.continuation import continue_cycle, neutral_curves

pytestmark = pytest.mark.compiled
CASES = yaml.safe_load(Path(__file__).with_name("growth.yaml").read_text(encoding="utf-8"))


@pytest.mark.parametrize(("case", "growth", "accuracy"), CASES["growth"], ids=str)
def test_growth_rates_of_the_published_cases(case, growth, accuracy):
    result = floquet(Parameters(**case))
    assert result.status is CycleStatus.OK
    assert result.growth_rate == pytest.approx(growth, abs=accuracy)
    assert result.stable == (growth < 0)


def test_the_quiet_cases_rate_and_the_wandering_ones_multiplier():
    assert 1 / floquet(Parameters(N=385, Omega=15)).period == pytest.approx(67.4717, abs=1e-4)
    result = floquet(Parameters(N=300, Omega=50, k_p=2e3))
    assert result.multipliers[0].real == pytest.approx(0.478, abs=1e-3)
    assert result.multipliers[0].imag == pytest.approx(0.881, abs=1e-3)


def test_the_fold_near_15_0949():
    p = Parameters(N=385, Omega=14.8)
    branch = continue_cycle(p, "Omega", (14.5, 16.0))
    [fold] = branch.folds
    assert fold == pytest.approx(15.0949, abs=5e-5)
    # the quiet branch is stable, the other has a real multiplier above one
    assert branch.growth_rate[0] < 0
    assert branch.multipliers[-1, 0] == branch.multipliers[-1, 0].real > 1
    statuses = [floquet(p.replace(Omega=fold + off)).status for off in (-1e-3, 1e-3)]
    assert statuses == [CycleStatus.OK, CycleStatus.NO_CYCLE]
    resonance = nearest_resonance(
        p, branch.period[-1], branch.multipliers[-1, 0], int(branch.diameters[-1])
    )
    assert resonance.label == "2 f_s = 135.42 Hz"


@pytest.mark.parametrize(
    ("start", "names"),
    [
        pytest.param(*case, marks=pytest.mark.slow if case[1][0] in ("k_p", "m", "k") else ())
        for case in CASES["neutral"]
    ],
    ids=str,
)
def test_neutral_curves_in_other_pairs(start, names):
    p = Parameters(**start)
    value = {name: getattr(p, name) for name in names}
    bounds = {name: (0.5 * value[name], 2.5 * value[name]) for name in names}
    lines = [share * value[names[1]] for share in (1.0, 2.0)]
    found = neutral_curves(p, bounds, lines, points=16, max_points=6)
    matched = 0
    for curve in found:
        rates = np.log(np.abs(curve.multipliers)) / curve.period
        beside = curve.adjoins_stable_cycle & (curve.kind == "neutral")
        assert np.abs(rates[beside]).max(initial=0) < 1e-6
        for values, period in zip(curve.values[beside], curve.period[beside], strict=True):
            here = floquet(p.replace(**dict(zip(names, values.tolist(), strict=True))))
            if here.period == pytest.approx(
                period, rel=1e-7
            ):  # else the static start leads elsewhere
                matched += 1
                assert here.growth_rate == pytest.approx(0, abs=1e-6)
    assert matched
