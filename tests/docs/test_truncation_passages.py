"""What the docs say of the number of modes."""

import json

import numpy as np
import pytest
import xarray as xr
from docs.truncation_passages import ALL, TABLED, passages, settled, summary

MODES = (1.0, 9.0, 17.0, 34.0, 165.0)


@pytest.fixture
def study() -> xr.Dataset:
    """A case whose residual values have settled from nine modes on, while rigid ones go on growing."""
    rigid, residual = np.array([1.0, 2.0, 3.0, 4.0, 5.0]), np.array([1.0, 2.0, 2.001, 2.0, 2.0])
    data = {name: (("case", "contact", "model"), np.array([[rigid, residual]])) for name in ALL}
    data["modes"] = (("case", "contact", "model"), np.broadcast_to(MODES, (1, 2, 5)).copy())
    growth = data["growth_rate"][1].copy()
    growth[..., -1] = np.nan  # too many modes
    data["growth_rate"] = (data["growth_rate"][0], growth)
    return xr.Dataset(
        data,
        {"case": ["orthonormal, N=1"], "contact": ["rigid", "residual"], "model": ["0,0", "4,0", "8,0", "8,1", "16,4"]},
        {"machine": "a machine", "late": "[20.0, 10.0]", "most_growth": 80, "horizon": 200.0},
    )


@pytest.mark.parametrize(
    ("values", "place"),
    [
        ([1.0, 2.0, 2.01, 2.0, 2.0], 1),
        ([2.0, 2.0, 2.5, 2.0, 2.0], None),  # two that agree are too few
        ([2.0, 2.5, 2.0, 2.0, 2.0], 2),  # that the first agrees too is chance
        ([1.0, 2.0, 3.0, 4.0, 5.0], None),
        ([1.0, 2.0, None, None, None], 2),  # settled to none
        ([None, None, 2.0, 2.0, 2.0], 2),
        ([2.0, 2.0, 2.0, 2.0, None], None),
        ([-2.0, -2.0, -2.01], 0),
        ([2.0, 2.0], None),
    ],
)
def test_what_has_settled_agrees_with_two_larger_models(values: list[float | None], place: int | None) -> None:
    assert settled(values, 0.01) == place


def test_a_run_comes_to_words(study: xr.Dataset) -> None:
    run = summary(study)
    assert json.loads(json.dumps(run)) == run
    known = passages(run)
    rigid, residual, _, counted = known["truncation_settled"].strip().splitlines()[2:]
    assert rigid.startswith("| orthonormal, N=1 | rigid | **not** |")
    assert residual.count("| from 9 ") == len(TABLED)
    assert (
        counted
        == "Converged within 165 modes: 0 of 7 quantities with rigid contact, 7 of 7 quantities with residual contact."
    )
    moving = known["truncation_open"]
    assert "| Orthonormal, N=1 | rigid | lowest coupled frequency | 3, 4, 5 | 17, 34, 165 |" in moving
    assert "| growth rate | 2, 3, 4 | 9, 17, 34 |" in moving  # with 165 it was not looked for
    assert "| range of the slider's height | 3000, 4000, 5000 |" in moving  # mm
    assert "| residual |" not in moving


def test_a_motion_that_could_not_be_followed_says_nothing(study: xr.Dataset) -> None:
    """It stands as a dash in the tables, and what has settled is judged without it."""
    gap = study.copy(deep=True)
    gap["separations"][0, :, 3] = np.nan
    known = passages(summary(gap))
    assert "| rate of separations | 2, 3, 5 | 9, 17, 165 |" in known["truncation_open"]
    assert "| residual |" not in known["truncation_open"]
    gap["first_separation"][0, :, 3:] = np.nan  # but none is what it is
    gap["separations"][0, :, 3:] = np.nan
    assert "| rate of separations | 3, -, - | 17, 34, 165 |" in passages(summary(gap))["truncation_open"]


def test_tables_show_both_contacts_in_a_cell(study: xr.Dataset) -> None:
    rows = passages(summary(study))["truncation_tables"].splitlines()
    assert "| 4, 0 | 9 | 2 / 2 | 2 / 2 | 2 / 2 |" in "\n".join(rows)
    [last] = [row for row in rows if row.startswith("| 16, 4 |")]
    assert last.split(" | ")[3] == "- / -"
    assert any("within 200 s" in row and "20 to 30 s after the first separation" in row for row in rows)
