"""Followed motions, sweeps and curves whose outcome is known, and what quantities make of them."""

import json
import math
from collections.abc import Iterable
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
import pytest
import xarray as xr

from disc_model.analysis.classify import Settled, Settling
from disc_model.data.variables import WORDS
from disc_model.errors import Status
from disc_model.stability import attractors
from disc_model.stability.follower import OutcomeResult
from disc_model.stability.segments import Segment
from disc_model.studies import run
from disc_model.studies.merge import merge_batches
from disc_model.studies.quantity import tried
from disc_model.studies.run import run_batch
from tests.stability.continuation.toy_maps import fold_at, fold_map, outside
from tests.studies.refused import parse_grid

__all__ = ["fold_map"]
SMALL = {"n_diameters": 1}


def study(**changes: Any) -> dict[str, Any]:
    """A small study, with some keys changed."""
    raw = {
        "study": "small",
        "quantity": "outcome",
        "options": {"horizon": 2, "evaluation_time": 0.2, "after_separation": 0.2},
        "axes": {"N": [100, 200, 300], "Omega": {"start": 10, "stop": 20, "count": 3}},
        "batch": {"over": ["Omega"], "size": 2},
    }
    return {**raw, **changes}


def computed(**raw) -> xr.Dataset:
    study = parse_grid({"study": "small", **raw})
    return merge_batches(
        [run_batch(text) for text in study.batches.values()], study.grid, study.attrs
    )


class Table(NamedTuple):
    """Arrays by variable, shape (points, ...), and a message for each point, empty without an
    error."""

    arrays: dict[str, np.ndarray]
    messages: list[str]


def compute(quantity: Any, points: Iterable[Any]) -> Table:
    """A quantity at some points."""
    rows, messages = zip(
        *(tried("status", quantity.compute_point, point) for point in points), strict=True
    )
    own = run.coordinates_of(quantity.COORDINATES, quantity)
    variables = run.variables_of(quantity.COLUMNS, own, rows, {"point": len(rows)})
    return Table({name: found.values for name, found in variables.items()}, list(messages))


SCAN = {"start": 12, "stop": 15, "step": 0.5}


@pytest.fixture
def fake_motions(monkeypatch: pytest.MonkeyPatch) -> None:
    def motion(p, horizon, **how):
        """Separation never comes below 12.35 rad/s nor from 14.15 to 14.45, sooner at higher speed
        and load."""
        never = p.Omega < 12.35 or 14.15 < p.Omega < 14.45
        if never:
            first = math.inf
        else:
            first = 2e5 / p.N - 50 * (p.Omega - 12)
        if first <= horizon:
            first_separation = first
        else:
            first_separation = math.nan
        return OutcomeResult(None, simulated=min(first, horizon), first_separation=first_separation)

    def arrival(p, legs):
        """All have settled."""
        return attractors.Arrival(Settling(Settled.SETTLED))

    def carried_on(p, until, *, tol, initial_state):
        """Separation begins at 14 rad/s on the way up, and stays down to 13."""
        apart = p.Omega >= 14 or (
            initial_state is not None and initial_state.apart and p.Omega >= 13
        )
        state = SimpleNamespace(time=until, apart=apart)
        return SimpleNamespace(final_state=state, status=Status.OK, message="")

    def final_segment(p, state, duration, late, tol):
        assert duration == 2
        assert late == 2
        apart = state.apart
        share = 0.0
        if apart:
            share = 0.25
        values = dict.fromkeys(Segment.__dataclass_fields__, 0.0)
        found = Segment(
            **values
            | {
                "separation_fraction": share,
                "slip_fraction": 1 - share,
                "separation_rate": 40 * share,
            }
        )
        return SimpleNamespace(final_state=state, status=Status.OK, message=""), found

    monkeypatch.setattr("disc_model.stability.follower.find_outcome", motion)
    for name, fake in (
        ("arrival", arrival),
        ("simulate", carried_on),
        ("final_segment", final_segment),
    ):
        monkeypatch.setattr(attractors, name, fake)


@pytest.fixture
def speeds(fake_motions: None) -> xr.Dataset:
    options = {"horizons": [900, 1000], "scan": SCAN, "precision": 0.1}
    return computed(
        quantity="critical_speed",
        options=options,
        axes={"N": [200, 400], "normalization": ["as_published"]},
    )


@pytest.fixture
def sweep(fake_motions: None) -> xr.Dataset:
    options = {"scan": SCAN, "dwell": 60, "evaluation_time": 2}
    return computed(
        quantity="hysteresis",
        options=options,
        axes={"N": [200, 400], "normalization": ["as_published"]},
    )


@pytest.fixture
def plane(fold_map: None) -> xr.Dataset:
    options = {
        "x_range": [3, 18],
        "y_lines": {"start": 180, "stop": 420, "count": 3},
        "points": 9,
        "max_points": 60,
    }
    return computed(
        quantity="stability_curves", options=options, axes={"normalization": ["as_published"]}
    )


def growth_over(N, Omega) -> xr.Dataset:
    """Growth of the toy's cycle; nan beyond the fold."""
    load, speed = np.meshgrid(N, Omega, indexing="ij")
    rate = np.where(speed < fold_at(load), outside(speed, load), np.nan)[..., None]
    axes = {
        "N": np.asarray(N, float),
        "Omega": np.asarray(Omega, float),
        "normalization": ["as_published"],
    }
    return xr.Dataset({"growth_rate": (("N", "Omega", "normalization"), rate)}, axes)


def with_failed(study: xr.Dataset, **place) -> xr.Dataset:
    """The study with one point that failed; numbers that it has are not to be believed."""
    study = study.copy(deep=True)
    study["status"].loc[place] = WORDS["point_statuses"].index("failed")
    return study


def made_up_samples(normalization: str = "orthonormal") -> tuple[xr.Dataset, xr.Dataset]:
    """Samples and exponents over three loads, for base values with this normalization."""
    status = ("N", np.zeros(3, np.int8), {"flag_meanings": " ".join(WORDS["point_statuses"])})
    axes = {"N": ("N", [1.0, 2, 3], {"units": "N"})}
    attrs = {
        "base": json.dumps({"normalization": normalization}),
        "options": json.dumps({"section": "stroboscopic"}),
    }
    known = {"flag_meanings": "unknown no yes"}
    each = ("N", "exponent_number")
    samples = {
        "phase": (
            ("N", "sample"),
            np.ones((3, 2), np.int8),
            {"flag_meanings": "none stick slip separation"},
        ),
        "psi": (("N", "sample"), np.ones((3, 2))),
    }
    answers = {"flag_meanings": "undecided changing settled"}
    samples |= {
        "settled": ("N", np.full(3, 2, np.int8), answers),
        "period_events": ("N", np.zeros(3, int)),
    }
    samples["kind"] = (
        "N",
        np.zeros(3, np.int8),
        {"flag_meanings": "failed undecided steady_sliding"},
    )
    exponents = {name: (each, np.ones((3, 1))) for name in ("exponent", "exponent_error")}
    exponents["converged"] = (each, np.zeros((3, 1), np.int8), known)
    one, other = (
        xr.Dataset(values | {"status": status}, axes, attrs) for values in (samples, exponents)
    )
    return one, other
