"""Ratios by which a study gives its cases: they stay what they are where the quantity varies their
denominator."""

from typing import Any

import numpy as np
import pytest

import disc_model as dm
from disc_model.parameters import RATIOS, Parameters
from disc_model.simulation.case import CaseSpec
from disc_model.stability import continuation, sliding_modes
from disc_model.studies.quantities import sensitivity
from disc_model.studies.run import run_batch
from disc_model.studies.study import parse_study
from tests.studies.conftest import computed
from tests.studies.refused import faults_of, parse_grid

UPPER = {name: upper for name, (upper, _) in RATIOS.items()}
LOWER = {name: lower for name, (_, lower) in RATIOS.items()}
NOMINAL = {"mu_s": 0.4, "k": 5e4, "c": 2.0, "b": 0.12}
SHARES = {"a_over_b": (0.3, 0.4), "r_0_over_b": (0.8, 0.95), "h_over_b": (0.01, 0.03)}


def drawn(ratio: str, rng: np.random.Generator) -> tuple[float, float, float]:
    """A value of a ratio, and the ends of a range of its denominator."""
    share = rng.uniform(*SHARES.get(ratio, (0.2, 0.9)))
    middle = NOMINAL[LOWER[ratio]]
    low = middle * rng.uniform(0.97, 0.99)
    high = middle * rng.uniform(1.01, 1.03)
    return (*np.round([share, low, high], 6),)


def placed(ratio: str, value: float, along: bool) -> dict[str, Any]:
    """The part of a study that gives a ratio, in its base or along an axis."""
    base = {"N": 300, "Omega": 14, "n_diameters": 2}
    if along:
        return {"base": base, "axes": {ratio: [value]}}
    return {
        "base": base | {ratio: value},
        "axes": {"c_p": [0.0]} if ratio != "c_p_over_c" else {"m": [0.1]},
    }


def options_varying(quantity: str, name: str, low: float, high: float) -> dict[str, Any]:
    """Options by which a quantity varies a parameter between two values."""
    scan = {"start": low, "stop": high, "count": 3}
    uniform = {"distribution": "uniform", "low": low, "high": high}
    return {
        "sliding": {"parameter": name, "scan": scan},
        "branches": {"parameter": name, "scan": scan, "dwell": 2},
        "stability_curves": {"x": "Omega", "y": name, "x_range": [13, 15], "y_lines": scan},
        "sensitivity": {"samples": 2, "distributions": {name: uniform}},
    }[quantity]


@pytest.fixture
def cases_computed(monkeypatch: pytest.MonkeyPatch) -> list[Parameters]:
    """The cases that quantities hand to the library, which computes nothing."""
    cases: list[Parameters] = []

    def follow_modes(several: list[Parameters]) -> list[Any]:
        cases.extend(several)
        return []

    def neutral_curves(p: Parameters, bounds: Any, lines: Any, **how: Any) -> Any:
        (name,) = bounds.keys() - {"Omega"}
        cases.extend(p.replace(**{name: value}) for value in lines)
        raise dm.DiscModelError("not computed")

    def sweep(p: Parameters, name: str, values: list[float], *how: Any) -> Any:
        cases.extend(p.replace(**{name: value}) for value in values)
        raise dm.DiscModelError("not computed")

    def evaluate(p: Parameters, tol: float) -> Any:
        cases.append(p)
        return {"cycle": "failed"}, ""

    monkeypatch.setattr(sliding_modes, "follow_modes", follow_modes)
    monkeypatch.setattr(continuation, "neutral_curves", neutral_curves)
    monkeypatch.setattr("disc_model.stability.attractors.sweep", sweep)
    monkeypatch.setattr(sensitivity, "evaluate", evaluate)
    return cases


@pytest.mark.parametrize("along", [False, True], ids=["base", "axis"])
@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("quantity", ["sliding", "branches", "stability_curves", "sensitivity"])
def test_a_ratio_is_kept_where_a_quantity_varies_its_denominator(
    quantity: str, ratio: str, along: bool, cases_computed: list[Parameters]
) -> None:
    """The numerator stayed what it was at the denominator's own value."""
    rng = np.random.default_rng([len(quantity), [*RATIOS].index(ratio), along])
    value, low, high = drawn(ratio, rng)
    part = placed(ratio, value, along)
    if quantity == "stability_curves":
        del part["base"]["Omega"]
    options = options_varying(quantity, LOWER[ratio], low, high)
    grid = parse_grid({"study": "s", "quantity": quantity, "options": options, **part})
    for text in grid.batches.values():
        run_batch(text)
    lowers = [getattr(p, LOWER[ratio]) for p in cases_computed]
    uppers = [getattr(p, UPPER[ratio]) for p in cases_computed]
    count = 3
    if quantity == "sensitivity":
        count = 2
    assert len(lowers) == count
    assert low <= min(lowers) < max(lowers) <= high
    np.testing.assert_allclose(np.divide(uppers, lowers), value, rtol=1e-15)


def test_modes_of_sliding_and_growth_of_samples_are_those_of_the_ratio() -> None:
    p = Parameters(N=385, Omega=12, mu_k_over_mu_s=0.6)
    base = {"N": 385, "Omega": 12, "mu_k_over_mu_s": 0.6}
    scan = {"start": 0.2, "stop": 0.6, "count": 3}
    options = {"parameter": "mu_s", "scan": scan}
    found = computed(quantity="sliding", options=options, base=base, axes={"c": [0.0]})
    for value, rate in zip(found["value"], found["largest_growth_rate"].squeeze(), strict=True):
        assert rate == dm.steady_sliding(p.replace(mu_s=float(value))).growth_rate
    spread = {"mu_s": {"distribution": "uniform", "low": 0.9, "high": 1.1, "relative": True}}
    del base["mu_k_over_mu_s"]
    found = computed(
        quantity="sensitivity",
        options={"samples": 2, "distributions": spread},
        base=base,
        axes={"mu_k_over_mu_s": [0.5, 0.6]},
    )
    for share, of_share in found.groupby("mu_k_over_mu_s"):
        for value, rate in zip(
            of_share["parameter_values"].values.ravel(),
            of_share["growth_rate"].values.ravel(),
            strict=True,
        ):
            case = p.replace(mu_s=value, mu_k_over_mu_s=share)
            assert rate == pytest.approx(dm.floquet(case).growth_rate, abs=1e-12)


@pytest.mark.compiled
def test_curves_over_the_denominator_are_those_of_the_ratio() -> None:
    """A fold that exists only where mu_k rises with mu_s was not found."""
    lines = {"start": 0.38, "stop": 0.42, "count": 2}
    options = {"y": "mu_s", "x_range": [14, 15.5], "y_lines": lines, "points": 5}
    base = {"N": 385, "mu_k_over_mu_s": 0.6}
    found = computed(quantity="stability_curves", options=options, base=base, axes={"c": [0.0]})
    p = Parameters(N=385, Omega=15, mu_k_over_mu_s=0.6)
    bounds = {"Omega": (14, 15.5), "mu_s": (0.38, 0.42)}
    [fold] = dm.neutral_curves(p, bounds, [0.38, 0.42], points=5)
    assert found["n_curves"] == 1
    along = found["x"].values.ravel()
    np.testing.assert_array_equal(along[: len(fold.values)], fold.values[:, 0])


def test_a_prerun_of_a_case_keeps_the_ratio_also_in_the_text_of_its_job() -> None:
    """In the text the ratio was lost, so that a study's job computed another prerun than
    `run_study`."""
    raw = {"study": "s", "base": {"N": 385, "Omega": 12, "mu_k_over_mu_s": 0.5}}
    before = {"prerun": {"parameters": {"mu_s": 0.5}, "time": 1}}
    spec = parse_study(raw | {"cases": {"A": {"start": before, "t_end": 1}}}).specs["A"]
    read = CaseSpec.model_validate_json(spec.canonical)
    assert read.canonical == spec.canonical
    assert read.start.prerun is not None
    assert read.parameters.replace(**read.start.prerun.parameters).mu_k == 0.25
    before["prerun"]["parameters"] = {"mu_s": 0.5, "mu_k": 0.1}
    spec = parse_study(raw | {"cases": {"A": {"start": before, "t_end": 1}}}).specs["A"]
    assert spec.start.prerun is not None
    assert spec.start.prerun.parameters == {"mu_s": 0.5, "mu_k": 0.1}
    before["prerun"]["parameters"] = {"mu_k": 0.5}
    faults = faults_of(parse_study, raw | {"cases": {"A": {"start": before, "t_end": 1}}})
    assert faults == ["cases.A.start.prerun.parameters.mu_k=0.5: must be <= mu_s=0.4"]


def test_a_scan_of_mu_k_raises_mu_s_only_where_it_has_to(cases_computed: list[Parameters]) -> None:
    """With falling friction mu_s counts; all cases had that of the largest mu_k."""
    options = {"parameter": "mu_k", "scan": {"start": 0.2, "stop": 0.6, "count": 3}}
    base = {"N": 385, "Omega": 12, "friction_decay": 3}
    computed_with = {"quantity": "sliding", "options": options, "base": base, "axes": {"c": [0]}}
    for text in parse_grid({"study": "s", **computed_with}).batches.values():
        run_batch(text)
    assert [(p.mu_k, p.mu_s) for p in cases_computed] == [(0.2, 0.4), (0.4, 0.4), (0.6, 0.6)]
