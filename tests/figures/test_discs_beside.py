"""Cases with different discs on the same axes: the legend says which disc is which."""

from collections.abc import Callable
from typing import Any

import pytest

import disc_model as dm
from tests.figures.test_wishes import legend_texts

PLATE = dm.Parameters(N=385, Omega=15)


def table(*frequencies: float) -> dm.Disc:
    count = len(frequencies)
    return dm.Disc(diameters=[2, 3, 4][:count], omega=frequencies, amplitude=[1.0] * count)


def of_modes(*frequencies: float) -> dm.Parameters:
    return PLATE.replace(disc=table(*frequencies), r_0=0.1)


def _run(case: dm.Parameters, **wishes: Any) -> Any:
    run = dm.simulate(case, 0.1, {"late": dm.Window(last=0.05, rate=1e4)})
    return run.plot("late", variables=["u"], **wishes)


def _sweep(case: dm.Parameters, **wishes: Any) -> Any:
    swept = dm.sweep(dm.steady_sliding, case, Omega=[14, 15])
    return dm.plot_sweep(swept, "growth_rate", **wishes)


DRAWN: dict[str, Callable[..., Any]] = {
    "run": _run,
    "sweep": _sweep,
    "eigenvalues": lambda case, **wishes: dm.steady_sliding(case).plot(**wishes),
}


def names(kind: str, *cases: dm.Parameters) -> list[str]:
    draw = DRAWN[kind]
    ax = draw(cases[0])
    for case in cases[1:]:
        draw(case, ax=ax)
    return legend_texts(ax)[: len(cases)]


@pytest.mark.parametrize("kind", DRAWN)
def test_table_beside_a_plate(kind: str) -> None:
    assert names(kind, of_modes(3000, 5000), PLATE) == ["disc of 2 modes", "plate"]


@pytest.mark.parametrize("kind", DRAWN)
def test_equal_tables_are_one_disc(kind: str) -> None:
    cases = (of_modes(3000, 5000).replace(N=load) for load in (300, 385))
    assert names(kind, *cases) == ["N = 300 N", "N = 385 N"]
