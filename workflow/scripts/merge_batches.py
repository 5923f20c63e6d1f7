"""Merge the batches of a grid study into one dataset, and list the points that failed, and remarks on
others. Standard input has a `disc_model.studies.batch.MergePlan` as JSON."""

import sys
from pathlib import Path

import xarray as xr

from disc_model.data.dataset import load_result, save
from disc_model.errors import script
from disc_model.studies.batch import MergePlan
from disc_model.studies.merge import merge_batches
from disc_model.studies.point_lists import failures, point_list, remarks


@script
def main(output: str, failed: str, remarked: str, folder: str) -> None:
    plan = MergePlan.model_validate_json(sys.stdin.read())
    batches = [load_result(Path(folder, f"{name}.nc")).to_dataset() for name in plan.batches]
    study = merge_batches(batches, plan.grid, plan.attrs)
    for path, listed in ((failed, failures), (remarked, remarks)):
        lines = listed(study)
        Path(path).write_text(point_list(lines), encoding="utf-8")
    save(xr.DataTree(study), output)
