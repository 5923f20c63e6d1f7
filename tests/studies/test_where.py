"""Points that a grid's own rule leaves out: not computed, recorded as excluded, drawn as empty; and axes of ratios."""

from pathlib import Path
from typing import Any

import numpy as np

from disc_model.data.variables import flag_names
from disc_model.figures import drawing
from disc_model.studies.merge import failures, merge_batches
from disc_model.studies.run import run_batch
from tests.studies.refused import parse_grid


def raw(**changes: Any) -> dict[str, Any]:
    base, axes = {"N": 200, "Omega": 20, "n_diameters": 1}, {key: [0.1, 0.2, 0.3] for key in ("mu_s", "mu_k")}
    return {"study": "s", "quantity": "floquet", "base": base, "axes": axes, "where": "mu_k <= mu_s"} | changes


def test_excluded_points_are_there_without_values_and_drawn_as_empty(tmp_path: Path) -> None:
    figure = {"kind": "heat_map", "variable": "period", "x": "mu_s", "y": "mu_k"}
    grid = parse_grid(raw(figures={"f": figure, "g": figure | {"variable": "growth_rate"}}))
    batches = [run_batch(text) for text in grid.batches.values()]
    study = merge_batches(batches, grid.grid, grid.attrs)
    left_out = study["mu_k"] > study["mu_s"]
    status = flag_names(study["status"])
    assert ((status == "excluded") == left_out.transpose(*study["status"].dims)).all()
    assert np.isfinite(study["period"]).equals(~left_out.transpose(*study["period"].dims))
    assert not list(failures(study))
    assert list(drawing.gaps(study, study["period"])) == []
    for name, plot in grid.plots.items():
        plot.draw(study, {}).savefig(tmp_path / f"{name}.png")
