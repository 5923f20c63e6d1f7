"""Reasons of missing values, which must be true of every point that has one."""

from typing import Any

import numpy as np
import pytest
import xarray as xr

from disc_model.data.missing import reason_of
from disc_model.figures.missing_texts import missing_text
from disc_model.figures.selection import classes_of_gaps, gaps
from tests.explorer.test_page import flagged


def samples() -> xr.Dataset:
    """Four samples: a stable cycle, an unstable one, no cycle, and one that was simulated."""
    nothing = np.full(4, np.nan)
    long_name = f"rate, nan {reason_of('sensitivity', 'other_growth_rate')}"
    cycles = np.array([0, 1, 2, 0], np.int8)
    outcomes = np.array([0, 0, 0, 1], np.int8)
    data: dict[str, Any] = {
        "status": ("sample", np.zeros(4, np.int8), flagged("ok failed")),
        "cycle": ("sample", cycles, flagged("stable unstable no_cycle")),
        "outcome": ("sample", outcomes, flagged("not_simulated quiet")),
        "other_growth_rate": ("sample", nothing, {"long_name": long_name}),
        "near_motion": ("sample", nothing),
        "first_separation": ("sample", nothing),
    }
    return xr.Dataset(data, {"sample": range(4)}, {"quantity": "sensitivity"})


@pytest.mark.parametrize("name", ["other_growth_rate", "near_motion"])
def test_a_rate_of_a_sample_does_not_wait_for_its_simulation(name: str) -> None:
    """It was "not simulated", though no simulation gives it; and where there is no cycle, no other
    one can be near."""
    study = samples()
    found = classes_of_gaps(study, study[name])
    assert found.tolist() == ["no_value", "no_value", "no_cycle", "no_value"]
    masks = gaps(study, study[name])
    assert masks["no cycle found"].values.tolist() == [False, False, True, False]


def test_modes_of_steady_sliding_need_no_cycle() -> None:
    """Beyond the last mode they said "no cycle found" where there is none."""
    dims = ("Omega", "mode")
    numbers = np.array([[1.0, np.nan], [1.0, np.nan]])
    data = {
        "status": ("Omega", np.array([0, 1], np.int8), flagged("ok no_cycle")),
        "sliding_frequency": (dims, numbers),
        "cycle_frequency": (dims, numbers),
    }
    study = xr.Dataset(data, {"Omega": [40.0, 50.0], "mode": [1, 2]}, {"quantity": "campbell"})
    found = classes_of_gaps(study, study["sliding_frequency"])
    assert found.tolist() == [["", "no_value"], ["", "no_value"]]
    assert missing_text(study, "sliding_frequency") == "no mode of this number"
    found = classes_of_gaps(study, study["cycle_frequency"])
    assert found[1, 1] == "no_cycle"


@pytest.mark.parametrize(
    ("quantity", "name", "dim", "text"),
    [
        ("basins", "attractor_period", "attractor", "no further attractor, or not periodic"),
        ("basins", "attractor_growth_rate", "attractor", "no further attractor, or not periodic"),
        (
            "basins",
            "critical_energy_lower",
            "Omega",
            "no start separates, or that without energy does",
        ),
        ("bifurcation", "period_residual", "Omega", "not shown to repeat"),
        ("bifurcation", "change_rate", "Omega", "the record shows none"),
        ("bifurcation", "least_rate", "Omega", "the record shows none"),
        ("campbell", "crossing_growth_rate", "crossing", "no further crossing, or not known"),
        ("campbell", "crossing_rise", "crossing", "no further crossing, or not known"),
        ("locking", "real_multiplier", "Omega", "no stable cycle was found at it, or none is real"),
        ("locking", "map_phase", "probe", "no release held for a phase"),
        ("outcome", "return_map_residual_rate", "Omega", "it returned too seldom, or exactly"),
    ],
)
def test_a_reason_names_every_case(quantity: str, name: str, dim: str, text: str) -> None:
    """They had one of two, or "no value"."""
    study = xr.Dataset({name: (dim, [np.nan])}, attrs={"quantity": quantity})
    assert missing_text(study, name) == text
