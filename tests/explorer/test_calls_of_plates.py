"""Calls of points whose plate is not the paper's, and what the page says beside values and calls."""

import warnings
from typing import Any

import pytest

import disc_model as dm
from disc_model.explorer import Stated
from disc_model.explorer import study_contents as contents_of
from disc_model.studies.point_calls import call_of
from disc_model.studies.registry import quantity_of
from tests import needs
from tests.explorer.test_finding import Open, opened

pytestmark = [pytest.mark.slow, pytest.mark.compiled, needs.BROWSER.mark]

__all__ = ["opened"]  # a fixture

BASE = {"N": 200, "Omega": 40, "n_diameters": 1}
SPREAD = {"distribution": "uniform", "low": 0.95, "high": 1.05, "relative": True}
OPTIONS = {"samples": 2, "distributions": {"h": SPREAD}}


def contents_of_study(quantity: str, options: dict[str, Any], **given: Any) -> dict[str, Any]:
    """The contents of a small study for the page."""
    raw = {"study": "mine", "quantity": quantity, "options": options, "base": BASE}
    call = call_of(quantity, quantity_of(quantity).model_validate(options)).plain
    return contents_of("mine", dm.run_study(raw | given), stated=Stated(call=call))


@pytest.mark.parametrize(
    ("quantity", "options", "given"),
    [
        ("sensitivity", OPTIONS, {"axes": {"m": [0.1, 0.11]}}),
        ("floquet", {}, {"axes": {"h": [0.0021, 0.0022]}}),
        ("floquet", {}, {"axes": {"E": [1.4e11, 1.45e11]}}),
        ("floquet", {}, {"axes": {"h_over_b": [0.018, 0.02]}}),
        ("floquet", {}, {"base": BASE | {"damping_ratio": 0.01}, "axes": {"h": [0.0021, 0.0022]}}),
    ],
)
def test_a_call_of_another_plate_runs_without_a_warning(
    opened: Open, quantity: str, options: dict[str, Any], given: dict[str, Any]
) -> None:
    """The package asked to state the normalization."""
    with opened([contents_of_study(quantity, options, **given)]) as shown:
        lines = shown.text("call").split("\n")
        assert "normalization=" in lines[0]
        names: dict[str, Any] = {"dm": dm}
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            exec("\n".join(lines[:-1]), names)


def test_a_call_of_the_papers_plate_states_no_more(opened: Open) -> None:
    """The call stays as short as it was."""
    with opened([contents_of_study("floquet", {}, axes={"m": [0.1, 0.11]})]) as shown:
        assert "normalization" not in shown.text("call")
