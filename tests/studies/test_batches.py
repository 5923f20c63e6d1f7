"""Grid studies: what files may say, and how grids become batches."""

import json
import time
from typing import Any

import pytest
import xarray as xr

from disc_model import floquet, mode_choice
from disc_model.mode_choice import choose_modes
from disc_model.studies.grid import GridStudy
from disc_model.studies.run import run_batch
from tests.studies.conftest import computed, study
from tests.studies.refused import parse_grid


def points(grid: GridStudy) -> list[list[list[Any]]]:
    return [json.loads(text)["points"] for text in grid.batches.values()]


def test_batches_are_fixed_axes_times_chunks_of_blocks() -> None:
    grid = parse_grid(study())
    assert points(grid) == [
        [[100.0, 10.0], [100.0, 15.0]], [[100.0, 20.0]],
        [[200.0, 10.0], [200.0, 15.0]], [[200.0, 20.0]],
        [[300.0, 10.0], [300.0, 15.0]], [[300.0, 20.0]],
    ]  # fmt: skip
    assert grid.n_points == 9
    assert all(len(name) == 12 for name in grid.batches)


def test_zipped_pairs_are_one_dimension() -> None:
    zipped = {"Omega": [20, 10, 20], "N": [200, 385, 200]}
    grid = parse_grid(study(axes={"D_star": [0, 1e-5]}, zip=zipped, batch={"size": 2}))
    assert [dim.name for dim in grid.dims] == ["N_Omega", "D_star"]
    assert grid.dims[0].values == ((200.0, 20.0), (385.0, 10.0))
    assert points(grid) == [[[200.0, 20.0, 0.0], [200.0, 20.0, 1e-5]], [[385.0, 10.0, 0.0], [385.0, 10.0, 1e-5]]]


def test_spelling_order_and_the_sign_of_zero_do_not_matter() -> None:
    axes = {"Omega": ["20.0", 1.5e1, 10], "N": [300, 100, 200.0, 100]}
    other = parse_grid(study(axes=axes, title="called otherwise"))
    assert other.batches == parse_grid(study()).batches
    one, other = (parse_grid(study(axes={"N": [1], "Omega": [zero]})) for zero in (0.0, -0.0))
    assert one.batches == other.batches


def test_changes_change_only_the_batches_they_touch() -> None:
    before = set(parse_grid(study()).batches)
    axes = study()["axes"]
    assert len(set(parse_grid(study(axes={**axes, "N": [100, 150, 200, 300]})).batches) - before) == 2
    assert set(parse_grid(study(axes={**axes, "N": [100, 300]})).batches) < before
    assert not before & set(parse_grid(study(base={"mu_k": 0.23})).batches)
    assert not before & set(parse_grid(study(options={"horizon": 3})).batches)
    longer = {"blocks": [axes["Omega"], [12.5]]}
    assert len(set(parse_grid(study(axes={**axes, "Omega": longer})).batches) - before) == 3


def growth(**axes: Any) -> dict[str, Any]:
    """A growth map of a study that says nothing of batches."""
    return {"study": "map", "quantity": "floquet", "axes": axes}


def span_of(count: int) -> dict[str, float]:
    return {"start": 10, "stop": 50, "count": count}


def test_batches_hold_whole_values_and_about_the_same_work() -> None:
    """Each value of all axes but the last had batches of its own: a map of 41 x 41 points made 41 or even 1681 jobs."""
    grid = parse_grid(growth(N=span_of(9), Omega=span_of(41), k=span_of(41)))
    room = grid.options.batch_size
    assert [len(batch) for batch in points(grid)] == [4 * 41 * 41, 4 * 41 * 41, 41 * 41]
    assert 4 * 41 * 41 <= room < 5 * 41 * 41


@pytest.mark.slow
@pytest.mark.parametrize(("quantity", "options"), [("floquet", {}), ("outcome", {"horizon": 100}), ("campbell", {})])
def test_a_point_costs_about_what_its_quantity_says(quantity: str, options: dict[str, float]) -> None:
    """Within a factor of five, for other processors: batches used to cost 15 times their work.

    A test by time is no quick test: without the newer instructions of a processor a point costs ten times as much.
    """
    grid = parse_grid(growth(N=[200], Omega=span_of(9)) | {"quantity": quantity, "options": options})
    (text,) = grid.batches.values()
    run_batch(text)  # loads the kernels
    began = time.process_time()
    run_batch(text)
    assert 0.2 < (time.process_time() - began) / 9 / grid.options.seconds < 5


@pytest.mark.parametrize(
    ("given", "counts"),
    [
        ({"start": 10, "stop": 20, "count": 4}, [4, 7, 13]),
        ({"start": 10, "stop": 20, "count": 4, "scale": "log"}, [4, 7, 13]),
        ({"blocks": [[1.0, 9.0], {"start": 2, "stop": 4, "count": 3}]}, [5, 7, 11]),
    ],
)
def test_finer_resolution_keeps_all_batches_and_divides_ranges_alone(given: dict[str, Any], counts: list[int]) -> None:
    axes = {"N": [100], "Omega": given}
    coarse, fine, finest = (parse_grid(study(axes=axes), resolution) for resolution in (1, 2, "4"))
    assert [grid.n_points for grid in (coarse, fine, finest)] == counts
    assert coarse.batches.keys() < fine.batches.keys() < finest.batches.keys()


AUTOMATIC = {"n_diameters": "auto", "truncation_tolerance": "1e-2"}


def cycles(axes: dict[str, Any], **base: Any) -> xr.Dataset:
    return computed(quantity="floquet", base={"N": 300} | base, axes=axes)


@pytest.mark.compiled
def test_the_modes_are_chosen_for_each_point() -> None:
    axes = {"normalization": ["as_published", "orthonormal"]}
    done = cycles(axes, Omega=20, **AUTOMATIC)
    for i, normalization in enumerate(axes["normalization"]):
        own = choose_modes({"N": 300, "Omega": 20, "normalization": normalization}, 1e-2).parameters
        assert (done["n_diameters"][i], done["n_circles"][i]) == (own.n_diameters, own.n_circles)
        assert done["growth_rate"][i] == pytest.approx(floquet(own).growth_rate, abs=1e-9)
    assert done["n_diameters"][0] < done["n_diameters"][1]
    assert done["n_diameters"].dims == ("normalization",)
    assert json.loads(done.attrs["base"])["n_diameters"] == "auto"


OUTCOME = "studies.quantities.outcome"


def test_only_batches_whose_modes_a_motion_chooses_depend_on_what_chooses() -> None:
    def sources(**base: Any) -> tuple[str, ...]:
        return parse_grid(study(base=base)).sources

    assert sources(n_diameters="auto") == sources(n_diameters=3) == (OUTCOME,)
    assert sources(n_diameters="auto", truncation_quantity="growth") == (OUTCOME, "mode_choice")


def test_modes_chosen_by_a_motion_are_chosen_for_each_point(monkeypatch: pytest.MonkeyPatch) -> None:
    """Settled from 5 modes on; where the spring is hard it never does, and that point alone fails."""
    settled = {1: 1.0, 2: 2.0, 4: 2.002, 8: 2.003}
    monkeypatch.setitem(
        mode_choice.MEASURES, "growth", lambda p: p.n_diameters if p.k > 1e6 else settled[p.n_diameters]
    )
    done = cycles({"k": [5e4, 1e12]}, Omega=0, n_diameters="auto", truncation_quantity="growth")
    assert done["n_diameters"].values.tolist() == [2, -1]
    assert "n_diameters: undecided: growth still changes by 0.5 of itself" in str(done["message"].values[1])
