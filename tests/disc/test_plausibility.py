"""Values that mistaken units make are told, and none of the paper's."""

import warnings
from pathlib import Path
from typing import Any

import pytest

from disc_model import Disc, ImplausibleValue, Parameters

LOAD: dict[str, Any] = {"N": 200, "Omega": 20}


def told(**given: Any) -> list[str]:
    """Warnings of a case, at the line that makes it."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        Parameters(**LOAD, **given)
    assert {Path(each.filename).name for each in caught} <= {Path(__file__).name}
    assert {each.category for each in caught} <= {ImplausibleValue}
    return [str(each.message) for each in caught]


def disc(damping_ratio: float) -> Disc:
    return Disc(diameters=[0], omega=[1e3], amplitude=[4], damping_ratio=[damping_ratio])


@pytest.mark.parametrize(
    ("given", "name"),
    [
        ({"h": 0.0153}, "h is more than a fifth of b - a"),
        ({"E": 150}, "E is below 1e+09 Pa"),
        ({"damping_ratio": 0.051}, "damping ratio above 0.05"),
        ({"disc": disc(0.3), "r_0": 0.1}, "damping ratio above 0.05"),
    ],
)
def test_each_doubt_is_told(given: dict[str, Any], name: str) -> None:
    [text] = told(**given)
    assert text.startswith(name)


@pytest.mark.parametrize(
    "given",
    [{}, {"h": 0.0151}, {"E": "1 GPa"}, {"damping_ratio": 0.05}, {"disc": disc(0.05), "r_0": 0.1}],
)
def test_plausible_values_are_not_doubted(given: dict[str, Any]) -> None:
    assert told(**given) == []
