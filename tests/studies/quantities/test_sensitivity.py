"""Uncertain parameters: what is drawn, what becomes of it, and probabilities of functions that are
known."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr
from disc_model.studies.distributions import BLOCK, TruncatedNormal, quantile, unit_draws
from scipy import stats

from disc_model.parameters import Parameters
from disc_model.studies.quantities import sensitivity
from disc_model.studies.quantities.sensitivity import Sensitivity
from disc_model.studies.quantity import Row
from tests.studies.conftest import computed
from tests.studies.refused import parse_grid

SAMPLE_CYCLES = Sensitivity.COLUMNS["cycle"].flags
UNIFORM = {"distribution": "uniform", "low": 0.9, "high": 1.1, "relative": True}


def study(distributions: dict[str, Any], **changes: Any) -> dict[str, Any]:
    options = {
        "distributions": distributions,
        "samples": 8,
        "seed": 3,
        **changes.pop("options", {}),
    }
    usual = {"axes": {"N": [200, 385]}, "base": {"Omega": 15}, "batch": {"size": 4}}
    return {"study": "s", "quantity": "sensitivity", "options": options, **usual, **changes}


def evaluating(monkeypatch: pytest.MonkeyPatch, function: Callable[[Parameters], Row]) -> None:
    monkeypatch.setattr(sensitivity, "evaluate", lambda p, tol: (function(p), ""))


def cycle_row(word: str, growth_rate: float) -> Row:
    return {"cycle": word, "growth_rate": growth_rate}


def test_every_draw_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    """Shares and probabilities against counting; what has no cycle is a class, and what failed
    widens intervals."""

    def function(p: Parameters) -> Row:
        word = SAMPLE_CYCLES[min(int(8 * p.c), 7)]
        rate = np.nan
        if word in ("stable", "unstable"):
            rate = p.c
        return cycle_row(word, rate)

    evaluating(monkeypatch, function)
    spread = {"distribution": "uniform", "low": 0, "high": 1}
    found = computed(**study({"c": spread, "k": UNIFORM}, options={"samples": 64})).sel(N=385)
    c = found["parameter_values"].sel(parameter="c").values.ravel()
    words = np.array(SAMPLE_CYCLES)[np.minimum((8 * c).astype(int), 7)]
    known = words[words != "failed"]
    assert len(known) < len(words) == 64
    assert found["n_known_cycles"] == len(known)
    assert found["n_failed_cycles"] == len(words) - len(known)
    assert found["n_failed_outcomes"] == 0
    unstable = np.isin(known, ("unstable", "no_cycle", "separates", "unstable_sliding"))
    assert found["probability_unstable"] == unstable.mean()
    assert found["probability_unstable_low"] < 4 / 7 < found["probability_unstable_high"]
    hits = int(unstable.sum())
    failed = len(words) - len(known)
    least = stats.binomtest(hits, 64).proportion_ci(0.95, "wilson").low
    most = stats.binomtest(hits + failed, 64).proportion_ci(0.95, "wilson").high
    ends = (found["probability_unstable_low"], found["probability_unstable_high"])
    assert [float(end) for end in ends] == pytest.approx([least, most], rel=1e-12)
    assert found["n_known_outcomes"] == 0
    assert np.isnan(found["probability_separation"])


def test_more_samples_keep_those_that_there_are() -> None:
    """A batch's name is its content; the number of samples is no part of it."""
    few, many = (
        parse_grid(study({"k": UNIFORM}, options={"samples": n})).batches for n in (16, 64)
    )
    assert len(few) == 8
    assert few.items() < many.items()
    both = {"over": ["N", "sample"], "size": 100}
    few_cut, many_cut = (
        parse_grid(study({"k": UNIFORM}, options={"samples": n}, batch=both)) for n in (128, 512)
    )
    assert len(few_cut.batches) == 4
    assert few_cut.batches.items() < many_cut.batches.items()
    assert [value for (value,) in many_cut.values["sample"]] == list(range(512))
    for change in (
        {"seed": 4},
        {"simulated_samples": 1},
        {"distributions": {"k": UNIFORM | {"high": 1.2}}},
    ):
        other = parse_grid(study({"k": UNIFORM}, options={"samples": 16, **change}))
        assert not few.keys() & other.batches.keys()


@pytest.mark.parametrize("share", [1e-6, 0.1, 0.5, 0.999])
def test_quantiles_are_those_of_the_distributions(share: float) -> None:
    normal = {"mean": 2, "deviation": 0.3}
    for text, one in (
        ({"distribution": "uniform", "low": 2, "high": 5}, stats.uniform(2, 3)),
        (
            {"distribution": "truncated_normal", **normal, "low": 1.9, "high": 3},
            stats.truncnorm((1.9 - 2) / 0.3, (3 - 2) / 0.3, 2, 0.3),
        ),
    ):
        made = Sensitivity.model_validate({"distributions": {"k": text}}).distributions["k"]
        assert quantile(made, 7.0, share) == pytest.approx(one.ppf(share), rel=1e-5)
        relative = made.model_copy(update={"relative": True})
        assert quantile(relative, 7.0, share) == pytest.approx(7 * one.ppf(share), rel=1e-5)


def made_up(**changes: Any) -> xr.Dataset:
    """A study of two points, without the engine."""
    with pytest.MonkeyPatch.context() as patch:
        evaluating(patch, lambda p: cycle_row("unstable" if p.k > 5e4 else "stable", p.k - 5e4))
        return computed(
            **study({"k": UNIFORM, "mu_s": UNIFORM}, options={"samples": 64}, **changes)
        )


def test_blocks_of_samples_are_one_sequence() -> None:
    whole = stats.qmc.Sobol(3, scramble=True, rng=np.random.default_rng(5)).random(4 * BLOCK)
    for block in range(4):
        expected = whole[block * BLOCK : (block + 1) * BLOCK]
        np.testing.assert_array_equal(unit_draws(5, 3, block), expected)
    assert not np.array_equal(unit_draws(6, 3, 0), unit_draws(5, 3, 0))


@pytest.mark.parametrize(
    ("samples", "blocks"), [(16, [16]), (64, [64]), (128, [64, 64]), (512, [64, 64, 128, 256])]
)
def test_blocks_of_samples_double_their_number(samples: int, blocks: list[int]) -> None:
    made = Sensitivity.model_validate({"distributions": {"k": UNIFORM}, "samples": samples})
    found = made.dimensions["sample"]
    assert [len(block) for block in found] == blocks
    assert [number for block in found for number in block] == list(range(samples))


@pytest.mark.parametrize(("mean", "low", "high"), [(1.0, 0.8, 1.2), (0.4, 0.1, 0.6)])
def test_rounding_takes_no_quantile_beyond_the_ends(mean: float, low: float, high: float) -> None:
    """By the normal distribution alone they exceed both by 2e-16."""
    made = TruncatedNormal(
        distribution="truncated_normal", mean=mean, deviation=0.1, low=low, high=high
    )
    assert quantile(made, 1.0, 0.0) >= low
    assert quantile(made, 1.0, 1.0) <= high


@pytest.mark.compiled
@pytest.mark.parametrize("extrapolate", [True, False])
def test_motions_of_samples_are_timed_only_where_they_are_simulated(extrapolate: bool) -> None:
    """The case separates at 273 s, after a slow departure from its cycle."""
    narrow = {"distribution": "uniform", "low": 0.9999, "high": 1.0001, "relative": True}
    options = {"samples": 2, "simulated_samples": 2, "extrapolate": extrapolate}
    only = {"axes": {"N": [260]}, "base": {"Omega": 19}, "batch": {"size": 2}}
    found = computed(**study({"k": narrow}, options=options, **only))
    assert float(found["probability_separation"].item()) == 1.0
    times = found["first_separation"].values.ravel()
    assert np.isnan(times).all() == extrapolate
    if not extrapolate:
        # the spring's share of the stiffness changes the growth rate by less than a thousandth
        assert times == pytest.approx(273.0, rel=0.01)
