"""What points cost: the law of it against measurements, sizes of batches."""

import json
import math
import time
from typing import Any

import pytest

import disc_model as dm
from disc_model.parameters import Parameters
from disc_model.studies.costs import PAPER, machine_factor, unit_costs
from disc_model.studies.grid import GridStudy
from disc_model.studies.quantity import WORK
from disc_model.studies.registry import quantity_names
from disc_model.studies.run import run_batch
from disc_model.studies.study import load_study
from tests.processes import ROOT
from tests.studies.refused import parse_grid

CONFIG = ROOT / "config"
PLATE = {"N": 300, "Omega": 14}
STEEL = {"E": 210e9, "rho": 7850, "nu": 0.3, "h": 6e-3, "m": 0.3, "k": 5e5, "k_p": 2e5}
STEEL |= {"N": 5000, "Omega": 40, "mu_s": 0.45, "mu_k": 0.35, "normalization": "orthonormal"}
BRAKE = {"N": 8000, "Omega": 40, "r_0": 0.1, "k": 1e6, "k_p": 1e6, "m": 0.5}

MEASURED: list[tuple[dict[str, Any], float, float]] = [
    # processor time of a simulated second and of `floquet`, relative to those of the paper's case
    ({"n_diameters": 2}, 0.58, 0.64),
    ({"n_diameters": 6}, 2.5, 2.2),
    ({"n_diameters": 8}, 3.4, 4.5),
    ({"n_diameters": 4, "n_circles": 1}, 3.5, 4.6),
    ({"n_diameters": 6, "n_circles": 1}, 5.8, 13.6),
    ({"contact_compliance": 2.6e-7}, 3.1, 2.2),
    ({"contact_force": "normal"}, 1.7, 1.15),
    ({"friction_decay": 2}, 2.3, 1.2),
    (STEEL, 3.6, 2.4),
]


@pytest.mark.parametrize(("changes", "second", "cycle"), MEASURED)
def test_the_law_of_costs_gives_what_was_measured(
    changes: dict[str, Any], second: float, cycle: float
) -> None:
    """Within a factor of two and a half, where the cases lie apart by a factor of twenty."""
    costs = unit_costs(Parameters(**PLATE | changes))
    assert 0.4 < costs.second / PAPER.second / second < 2.5
    assert 0.4 < costs.cycle / PAPER.cycle / cycle < 2.5


def test_the_costs_of_a_brake_disc_and_of_the_paper() -> None:
    assert unit_costs(Parameters(**PLATE)) == pytest.approx(PAPER, rel=1e-4)
    brake = dm.Disc.from_csv(CONFIG / "discs" / "brake.csv")
    costs = unit_costs(Parameters(**BRAKE, disc=brake, friction_offset="surface"))
    assert 0.4 < costs.second / PAPER.second / 27.7 < 2.5
    assert 0.4 < costs.cycle / PAPER.cycle / 7.2 < 2.5


def test_a_case_without_a_disc_or_a_spring_costs_something() -> None:
    for changes in ({"n_diameters": -1}, {"k_p": 0}):
        costs = unit_costs(Parameters(**PLATE | changes))
        assert 0 < costs.second < PAPER.second


def growth(**changes: Any) -> GridStudy:
    axes = {"mu_s": {"start": 0.3, "stop": 0.6, "count": 101}, "c_p": [0.0, 0.01, 0.02]}
    raw: dict[str, Any] = {
        "study": "s",
        "quantity": "floquet",
        "base": {**PLATE, **changes.pop("base", {})},
    }
    return parse_grid({**raw, "axes": axes} | changes)


def sizes(grid: GridStudy) -> list[int]:
    return [len(json.loads(text)["points"]) for text in grid.batches.values()]


def test_batches_have_about_the_same_work_whatever_a_case_costs() -> None:
    """A point of many modes counted as one of few: on one core, a batch took minutes."""
    assert len(sizes(growth())) == 1
    assert sum(growth().work.values()) == pytest.approx(303 * PAPER.cycle, rel=1e-3)
    dear = growth(base={"n_diameters": 30, "n_circles": 2})
    assert len(sizes(dear)) > 10
    assert max(dear.work.values()) < 1.5 * WORK
    assert min(sorted(dear.work.values())[1:]) > WORK / 3
    assert sum(sizes(dear)) == 303


def test_few_batches_are_equal_and_of_many_a_value_at_the_end_changes_the_last() -> None:
    """Of two batches, one had six sevenths of the points, and a core waited."""
    axis = {"start": 0.3, "stop": 0.6, "count": 301}
    axes = {"mu_s": axis}
    assert sizes(growth(axes=axes, batch={"size": 200})) == [151, 150]
    assert sizes(growth(axes=axes, batch={"size": 120})) == [101, 101, 99]
    many = growth(axes=axes, batch={"size": 30})
    assert sizes(many) == [30] * 10 + [1]
    longer = {"mu_s": axis | {"stop": 0.601, "count": 302}}
    after = growth(axes=longer, batch={"size": 30})
    assert len(after.batches.keys() - many.batches.keys()) == 1


def test_many_starts_of_one_point_each_share_the_work() -> None:
    """169 starts of a steel disc took four minutes in one batch, estimated at 20 s."""
    starts = {"start": 0, "stop": 1e-3, "count": 13}
    axes = {"perturbation_u": starts, "perturbation_f": starts | {"stop": 2}}
    raw = {"study": "s", "quantity": "basins", "base": STEEL, "axes": axes}
    grid = parse_grid(raw)
    assert len(grid.batches) >= 4
    # processor time measured since the attractors of a case are found once in a batch; 253 s before
    assert 88 / 3 < sum(grid.work.values()) < 3 * 88


def test_a_dear_value_elsewhere_leaves_the_batches_that_there_are() -> None:
    axis = {"start": 0.002, "stop": 0.003, "count": 5}
    raw = {"study": "x", "quantity": "floquet", "base": PLATE, "axes": {"h": axis}}
    before = parse_grid(raw)
    after = parse_grid({**raw, "axes": {"h": {**axis, "extra": [0.02]}}})
    assert before.batches.items() < after.batches.items()


def test_a_plane_is_cut_into_tiles_of_about_the_same_work() -> None:
    sides = {"start": 10, "stop": 50, "count": 81}
    raw = {
        "study": "s",
        "quantity": "regions",
        "options": {"horizon": 500},
        "base": {"mu_s": 0.4},
        "axes": {"N": sides | {"stop": 810}, "Omega": sides},
    }
    usual = parse_grid(raw)
    dear = parse_grid({**raw, "base": {"n_diameters": 12}})
    both = parse_grid(
        {**raw, "axes": {**raw["axes"], "normalization": ["as_published", "orthonormal"]}}  # type: ignore[dict-item]
    )
    assert len(usual.batches) < len(dear.batches)
    assert len(both.batches) == 2 * len(usual.batches)
    for grid in (usual, dear, both):
        assert max(grid.work.values()) < 2.5 * WORK
        points = [tuple(p) for text in grid.batches.values() for p in json.loads(text)["points"]]
        assert len(points) == len(set(points)) == grid.n_points


def test_the_law_of_costs_counts_modes_frequencies_and_laws() -> None:
    """Twice the slider's frequency has twice as many releases; laws of contact add up as factors."""
    case = Parameters(**PLATE)
    usual = unit_costs(case)
    fast = unit_costs(case.replace(m=case.m / 4))
    assert fast.second == pytest.approx(2 * usual.second, rel=1e-12)
    assert fast.cycle == pytest.approx(usual.cycle, rel=1e-12), "one release counts"
    # a slider hardly ever slips below 0.3 of the paper's frequency
    slow = unit_costs(case.replace(k_p=case.k_p / 400))
    assert slow.second == pytest.approx(0.3 * usual.second, rel=1e-12)
    laws: dict[str, dict[str, Any]] = {
        "compliant": {"contact_compliance": 1e-8},
        "normal": {"contact_force": "normal"},
        "falling": {"friction_decay": 2.0},
        "viscous": {"viscous_friction": 0.01},
    }
    measured = {
        "compliant": (3.0, 2.2),
        "normal": (1.7, 1.15),
        "falling": (1.7, 1.2),
        "viscous": (1.7, 1.2),
    }
    for name, law in laws.items():
        costs = unit_costs(case.replace(**law))
        found = (costs.second / usual.second, costs.cycle / usual.cycle)
        assert found == pytest.approx(measured[name], rel=1e-12), name
    every = laws["compliant"] | laws["normal"] | laws["falling"] | laws["viscous"]
    together = unit_costs(case.replace(**every))
    assert together.second == pytest.approx(3.0 * 1.7 * 1.7 * usual.second, rel=1e-12)


def test_the_machine_s_factor_is_about_the_same_twice() -> None:
    first = machine_factor()
    second = machine_factor()
    assert 0.05 < first < 50
    assert 0.3 < first / second < 3


# ---- against the clock

SHIPPED = {  # a study of each quantity, and at most so many of its points
    "basins": ("basins", 3),
    "bifurcation": ("bifurcation_N", 24),
    "branches": ("decay_coexistence", 1),
    "campbell": ("campbell", 60),
    "critical_speed": ("critical_speed_couple", 4),
    "floquet": ("brake_growth", 60),
    "hysteresis": ("hysteresis_orthonormal", 2),
    "locking": ("locking", 10),
    "lyapunov": ("lyapunov_Omega", 8),
    "outcome": ("brake_outcome", 15),
    "ramps": ("ramps", 1),
    "range_law": ("range_law", 10),
    "sensitivity": ("sensitivity", 64),
    "sliding": ("sliding", 13),
    "stability_curves": ("neutral_c_p", 1),
}


def test_a_shipped_study_of_every_quantity_is_measured() -> None:
    assert {*SHIPPED, "regions"} == {*quantity_names()}


@pytest.mark.slow
@pytest.mark.compiled
@pytest.mark.parametrize("quantity", SHIPPED)
def test_points_cost_what_is_estimated_within_a_factor_of_three(quantity: str) -> None:
    """Points spread evenly over a study. Their processor time, since other programs run beside."""
    name, most = SHIPPED[quantity]
    grid = load_study(CONFIG / "studies" / f"{name}.yaml").grid
    assert grid is not None
    step = math.ceil(grid.n_points / most)
    parts = [json.loads(text) for text in grid.batches.values()]
    for part in parts:
        part["points"] = part["points"][::step]
    parts = [part for part in parts if part["points"]]
    run_batch(json.dumps(parts[0] | {"points": parts[0]["points"][:1]}))  # compiles and imports
    began = time.process_time()
    for part in parts:
        run_batch(json.dumps(part))
    count = sum(len(part["points"]) for part in parts)
    measured = (time.process_time() - began) / count
    estimated = machine_factor() * sum(grid.work.values()) / grid.n_points
    assert 1 / 3 < measured / estimated < 3, (measured, estimated)


@pytest.mark.slow
@pytest.mark.compiled
def test_a_tile_costs_what_is_estimated_within_a_factor_of_three() -> None:
    grid = load_study(CONFIG / "studies" / "map_couple.yaml").grid
    assert grid is not None
    name, text = next(iter(grid.batches.items()))
    usual = Parameters(N=300, Omega=20, friction_offset="surface")
    dm.outcome(usual, 1)  # compiles and imports
    dm.floquet(usual)
    began = time.process_time()
    run_batch(text)
    measured = time.process_time() - began
    assert 1 / 3 < measured / (machine_factor() * grid.work[name]) < 3
