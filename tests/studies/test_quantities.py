"""What all quantities must keep: a batch has the results of its points, and a failure costs its own
point alone."""

import math
import re
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from disc_model.studies.batch import read_infinity
from disc_model.studies.registry import quantity_names, quantity_of

from disc_model import floquet
from disc_model.data.described import known_of
from disc_model.data.variables import COMMON, WORDS, Variable, attributes_of_number, flag_names
from disc_model.errors import Status
from disc_model.parameters import Parameters
from disc_model.studies.grid import VARIED
from disc_model.studies.quantity import Point, Quantity, Range, holds, with_ends
from disc_model.studies.run import describe
from tests.refusals import refusal
from tests.studies.conftest import compute, computed

SCAN = {"start": 10, "stop": 20, "count": 2}
SWEEP = {"dwell": 0.5, "max_dwell": 1, "evaluation_time": 0.2}
OPTIONS: dict[str, dict[str, Any]] = {
    "basins": {"energies": [0.01, 0.1], "n_starts": 2, "horizon": 3},
    "bifurcation": {"transient": 0.5, "samples": 3},
    "branches": {"scan": SCAN, "max_points": 3} | SWEEP,
    "campbell": {"modes": 4},
    "critical_speed": {"horizons": [1, 2], "scan": SCAN, "precision": 5},
    "floquet": {},
    "hysteresis": {"scan": SCAN} | SWEEP,
    "locking": {"transient": 0.5, "record": 0.5, "max_record": 0.5, "releases": 2, "probes": 2},
    "lyapunov": {"transient": 0.5, "duration": 0.5},
    "outcome": {"horizon": 2, "evaluation_time": 0.2, "after_separation": 0.2},
    "ramps": {"low": 10, "high": 12, "rates": {"start": 5, "stop": 10, "count": 2}, "dwell": 0.2},
    "range_law": {"horizon": 0.6, "displaced_horizon": 0.6, "evaluation_time": 0.4},
    "regions": {"horizon": 5, "initial_cell_size": 2},
    "sensitivity": {
        "distributions": {"k": {"distribution": "uniform", "low": 4e4, "high": 5e4}},
        "samples": 2,
        "simulated_samples": 1,
        "horizon": 1,
    },
    "sliding": {"scan": SCAN},
    "stability_curves": {
        "x_range": [10, 20],
        "y_lines": SCAN | {"stop": 200},
        "points": 3,
        "max_points": 3,
    },
}


def grid(name: str, **batch: Any) -> dict[str, Any]:
    """A small grid over the damping of the spring, and a plane or the speed where it is needed."""
    scanned = quantity_of(name).model_validate(OPTIONS[name]).scanned
    base = {key: value for key, value in {"N": 200, "Omega": 15}.items() if key not in scanned}
    axes: dict[str, Any] = {"c_p": [0, 0.02, 0.05]}
    if name in ("campbell", "regions"):
        axes["Omega"] = [base.pop("Omega"), 16, 17]
    raw = {
        "quantity": name,
        "options": OPTIONS[name],
        "base": base | {"n_diameters": 1},
        "axes": axes,
        "batch": batch,
    }
    return {"study": "small"} | raw


@pytest.mark.compiled
@pytest.mark.parametrize("name", quantity_names())
def test_a_batch_of_a_grid_has_the_results_of_its_points(name: str) -> None:
    """To the last bit: points of a batch share nothing. Tiles of a plane may share a batch."""
    if name == "regions":
        tiled = grid(name)
        tiled["axes"] |= {"normalization": ["as_published", "orthonormal"]}
        alone = {"over": ["c_p", "Omega"]}
        together = {"over": ["c_p", "Omega", "normalization"]}
        one, all_ = (computed(**tiled | {"batch": batch}) for batch in (alone, together))
    else:
        one, all_ = (computed(**grid(name, size=size)) for size in (1, 100))
    assert one.identical(all_.assign_attrs(one.attrs))
    quantity = quantity_of(name)
    assert {*quantity.COLUMNS, *quantity.SUMMARY_COLUMNS, "message"} == {*one.data_vars}
    assert set(np.unique(flag_names(one["status"]))) == {"ok"}
    numbers = [
        key for key, column in quantity.COLUMNS.items() if not column.flags and not column.whole
    ]
    # there is no curve in so small a plane
    assert any(np.isfinite(one[key]).any() for key in numbers) or name == "stability_curves"


def unexplained(study: Any) -> list[str]:
    """Numbers that are nan somewhere, and whose attributes do not say why."""
    found = []
    for name, variable in study.data_vars.items():
        missing = variable.dtype.kind in "fc" and np.isnan(variable.values).any()
        if missing and "missing" not in variable.attrs:
            found.append(str(name))
    return found


@pytest.mark.compiled
@pytest.mark.parametrize("name", quantity_names())
def test_a_study_says_what_nan_means(name: str) -> None:
    """Points of a disc at events, energies and whole curves were nan without a word."""
    options = [{}]
    if name == "bifurcation":
        options = [{}, {"section": "event"}]
    for chosen in options:
        raw = grid(name)
        raw["options"] = raw["options"] | chosen
        assert unexplained(computed(**raw)) == []


@pytest.mark.parametrize("name", quantity_names())
def test_a_quantity_says_how_many_points_a_job_has_and_what_its_motions_show(name: str) -> None:
    quantity = quantity_of(name)
    assert "status" in quantity.COLUMNS
    assert quantity.points_per_job >= 1
    assert (
        bool(quantity.motions)
        == bool(quantity.motion)
        == (quantity.state_at is not Quantity.state_at)
    )
    assert bool(quantity.SUMMARY_COLUMNS) == ("summarise" in vars(quantity))


P, Q = (Point(Parameters(N=N, Omega=1)) for N in (1, 0))


def made_up_quantity(compute_point: Callable[..., object]) -> SimpleNamespace:
    """A quantity of one number."""
    columns = {"status": COMMON["status"], "value": Variable("1", "a number")}
    return SimpleNamespace(COLUMNS=columns, COORDINATES={}, compute_point=compute_point)


@pytest.mark.parametrize("name", quantity_names())
def test_all_that_a_quantity_gives_has_a_name_and_a_unit_or_classes(name: str) -> None:
    quantity = quantity_of(name)
    columns = {**quantity.COLUMNS, **quantity.SUMMARY_COLUMNS}
    made = quantity.model_validate(OPTIONS[name]).model_dump()
    for key, column in columns.items():
        attributes = column.texts(made)
        assert attributes.get("long_name"), key
        # the values are of another parameter in each row
        assert attributes.get("units") or key == "parameter_values", key
    known = known_of(name)
    for key in {**quantity.COORDINATES, **quantity.SUMMARY_COORDINATES}:
        assert known[key].texts(made)["long_name"], key


@pytest.mark.parametrize("name", [*VARIED, "sample"])
def test_all_that_varies_has_a_name(name: str) -> None:
    assert describe(name)["long_name"]


def test_a_numerical_failure_is_the_status_of_its_point() -> None:
    """One singular matrix used to end all points of a batch."""

    def compute_point(point: Point):
        N = point.parameters.N
        return {"status": "ok", "value": np.linalg.solve([[N]], [N**2])[0]}, ""

    table = compute(made_up_quantity(compute_point), [P, Q, P])
    assert [WORDS["point_statuses"][i] for i in table.arrays["status"]] == ["ok", "failed", "ok"]
    np.testing.assert_array_equal(table.arrays["value"], [1.0, math.nan, 1.0])
    assert table.messages == ["", "LinAlgError: Singular matrix", ""]


def test_a_mistake_in_the_program_is_no_status() -> None:
    def compute_point(point: Point):
        raise KeyError("horizon")

    with pytest.raises(KeyError):
        compute(made_up_quantity(compute_point), [P])


# ---- ranges and rules


def test_ranges_have_equal_steps_or_equal_ratios_and_both_ends() -> None:
    assert Range(start=1, stop=2, step=0.25).values == [1, 1.25, 1.5, 1.75, 2]
    assert Range(start=0.1, stop=0.5, count=5).values == [0.1, 0.2, 0.3, 0.4, 0.5]
    assert Range(start=2, stop=162, count=5, scale="log").values == [2, 6, 18, 54, 162]
    assert Range(start=1, stop=2, step=0.25).intervals == 4


@pytest.mark.parametrize(
    ("rule", "kept"),
    [
        ("mu_k <= mu_s", True),
        ("mu_k < 0.2 or N > 300", False),
        ("1/c > 0", False),  # cannot be evaluated
        ("contact == 'unilateral'", True),
        ("contact < 1", False),
        ("mu_k_over_mu_s == 0.5", True),
        ("k == 50000", True),  # a value that is not given has that of Table 1
    ],
)
def test_a_rule_compares_all_values_of_a_point(rule: str, kept: bool) -> None:
    point = {"N": 200, "mu_s": 0.4, "mu_k_over_mu_s": 0.5, "c": 0, "contact": "unilateral"}
    assert holds([rule], point) is kept
    assert holds(["N > 100", rule], point) is kept


def test_a_share_comes_before_the_ends_of_its_interval() -> None:
    found = with_ends("share", (0.3, 0.1, 0.6))
    assert found == {"share": 0.3, "share_low": 0.1, "share_high": 0.6}


def test_the_word_for_infinity_is_a_number_where_numbers_stand() -> None:
    assert read_infinity("friction_decay", "inf") == math.inf
    assert read_infinity("disc", "inf") == "inf", "the name of a table"
    assert read_infinity("N", 3.0) == 3.0


# ---- single columns


def test_the_leading_multiplier_of_a_point_is_that_of_its_cycle() -> None:
    p = Parameters(N=300, Omega=14, n_diameters=1)
    cycle = floquet(p)
    values, _ = quantity_of("floquet")().compute_point(Point(p))
    largest = cycle.multipliers[np.argmax(np.abs(cycle.multipliers))]
    assert abs(complex(values["multiplier_re"], values["multiplier_im"])) == abs(largest)
    assert values["growth_rate"] == pytest.approx(np.log(abs(largest)) / cycle.period)
    assert values["stick_fraction"] == cycle.stick_fraction


def test_exponents_have_converged_or_not_or_are_unknown(monkeypatch: pytest.MonkeyPatch) -> None:
    found = SimpleNamespace(
        status=Status.OK,
        exponents=np.array([0.3, -0.2, -np.inf]),
        errors=np.array([0.1, 0.2, np.nan]),
        converged=np.array([True, False, False]),
        trivial_exponent=0.01,
        duration=7.0,
        separations=3,
    )
    monkeypatch.setattr("disc_model.stability.lyapunov.lyapunov_exponents", lambda *_, **__: found)
    monkeypatch.setattr("disc_model.simulation.starts.state_after", lambda *_: None)
    quantity = quantity_of("lyapunov").model_validate({"transient": 1, "duration": 7})
    values, _ = quantity.compute_point(P)
    words = quantity.COLUMNS["converged"].flags
    assert [words[i] for i in values["converged"]] == ["yes", "no", "unknown"]
    assert values["averaging_time"] == 7.0
    assert values["separations"] == 3


@pytest.mark.parametrize(
    ("parameter", "units"),
    [
        ("Omega", "rad s-1"),
        ("mu_k_over_mu_s", "1"),
        ("omega_2_0", "rad s-1"),
        ("damping_ratio_2_0", "1"),
    ],
)
def test_numbers_of_modes_have_units_in_datasets_too(parameter: str, units: str) -> None:
    """They had none."""
    assert attributes_of_number(parameter)["units"] == units


@pytest.mark.parametrize(
    ("rule", "kept"),
    [
        ("mu_k <= mu_s", True),
        ("mu_k > mu_s", False),
        ("mu_k / c_p > 0", False),
        ("n_diameters * normalization != 'x'", False),
        ("n_diameters == 2", True),
    ],
)
def test_a_rule_that_cannot_be_evaluated_does_not_hold(rule: str, kept: bool) -> None:
    """Neither a division by zero, nor a word that would be repeated."""
    values = {"mu_k": 0.2, "mu_s": 0.4, "c_p": 0.0, "n_diameters": 2, "normalization": "x"}
    assert holds([rule], values) is kept


RULES = [
    (
        "hysteresis",
        SWEEP | {"scan": SCAN, "dwell": 0.1},
        "evaluation_time=0.2 must be <= dwell=0.1",
    ),
    ("branches", SWEEP | {"scan": SCAN, "dwell": 0.1}, "evaluation_time=0.2 must be <= dwell=0.1"),
    (
        "branches",
        SWEEP | {"scan": SCAN, "sweep_from": 21},
        "sweep_from=21 must be <= the scan's last value, 20",
    ),
    ("locking", {"record": 5, "max_record": 4}, "record=5 must be <= max_record=4"),
    (
        "outcome",
        {"horizon": 0.5},
        "evaluation_time=1 must be <= after_separation=5 and <= horizon=0.5",
    ),
    ("ramps", {"low": 3, "high": 2, "rates": SCAN}, "low=3 must be < high=2"),
    (
        "range_law",
        {"horizon": 1},
        "evaluation_time=2 must be < horizon=1 and < displaced_horizon=40",
    ),
    (
        "critical_speed",
        {"horizons": [1], "scan": SCAN, "precision": 3},
        "rad/s must be a multiple of precision=3 rad/s",
    ),
    ("basins", {"energies": [0, 1], "n_starts": 2}, "n_starts=2 must be 1 where an energy is 0"),
]
"""Options that break a rule between them, and what it says."""


@pytest.mark.parametrize(("name", "options", "said"), RULES)
def test_a_rule_between_options_shows_their_values(
    name: str, options: dict[str, Any], said: str
) -> None:
    with refusal(re.escape(said)):
        quantity_of(name).model_validate(options)


def test_an_axis_has_a_hundred_thousand_values_at_most() -> None:
    made = Range(start=0, stop=1, count=100_000)
    assert made.intervals == 99_999
    rule = "must be at most 100000 values"
    with refusal(rule):
        Range(start=0, stop=1, count=100_001)
    with refusal(rule):
        Range(start=0, stop=1, step=1e-5)
