"""Maps of where methods fail."""

import math
from functools import lru_cache

import numpy as np
import pytest

from disc_model.benchmarks import failure_maps, figures
from disc_model.benchmarks.methods.rk4 import STABILITY_LIMIT
from disc_model.benchmarks.registry import METHODS
from disc_model.benchmarks.scenes import Verdict, errors
from disc_model.figures.drawing import save
from disc_model.plate import mode_arrays


@pytest.fixture
def short(monkeypatch: pytest.MonkeyPatch) -> None:
    """Maps of 20 ms of stick-slip and 10 ms of separations."""
    monkeypatch.setattr(failure_maps, "SPANS", {"stick_slip": 0.02, "separating": 1e-2})
    for name in ("short_problem", "engine_answer"):
        monkeypatch.setattr(failure_maps, name, lru_cache(getattr(failure_maps, name).__wrapped__))


@pytest.mark.usefixtures("short")
def test_maps_of_steps_and_of_tolerances(tmp_path) -> None:
    found = failure_maps.failure_map("RK4", "separating", (1, 2), (1e-3, 2e-5))
    assert found["modes"].values.tolist() == [3, 5]
    assert found["step_limit"].values == pytest.approx(2 * math.sqrt(2) / found["omega_max"].values)
    assert found["shortest_phase"].values.min() > 0
    engine = failure_maps.failure_map("series", "separating", (1, 2), (1e-6, 1e-10))
    assert (engine["verdict"].values == Verdict.CONVERGED).all()
    adaptive = failure_maps.failure_map("RK45", "separating", (1,), (1e-2, 1e-5))
    smooth = failure_maps.failure_map("regularised", "separating", (1,), (10.0, 1.0))
    assert np.isfinite(adaptive["longest_step"]).all()
    figure = figures.failure_maps(found, engine, adaptive, smooth, adaptive)
    titles = [ax.get_title(loc="left") for ax in figure.axes if ax.get_title(loc="left")]
    assert titles[0] == f"(a) {METHODS['RK4'].label}"
    assert len(titles) == 5
    save(figure, tmp_path / "maps.png")


def test_heyoka_is_compiled_compactly_for_maps() -> None:
    assert METHODS["heyoka"].economical().arguments == ("compact",)


@pytest.mark.compiled
@pytest.mark.parametrize("diameters", [2, 4])
def test_observed_stability_limit_is_the_linear_one(diameters):
    """2 sqrt(2)/omega_max is exact for a linear undamped system; stick-slip and damping shift it by 3 % at most."""
    problem, answer = (
        find("stick_slip", diameters) for find in (failure_maps.short_problem, failure_maps.engine_answer)
    )
    limit = STABILITY_LIMIT / float(mode_arrays(problem.parameters).omega.max())
    results = [METHODS["RK4"].solve(problem, share * limit) for share in (0.97, 1.03)]
    unstable = [errors(problem, answer, result).verdict is Verdict.UNSTABLE for result in results]
    assert unstable == [False, True]
