"""A whole study as a function: computed in this process, without files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import xarray as xr

from disc_model.errors import require
from disc_model.simulation.named_case import run_case
from disc_model.studies.merge import merge_batches, merge_cases
from disc_model.studies.run import run_batch
from disc_model.studies.workers import checked_workers


def run_study(
    source: str | Path | Mapping[str, Any],
    *,
    workers: int = 1,
    processes: bool = False,
    executor: Any = None,
    progress: bool = False,
) -> xr.Dataset | xr.DataTree:
    """Compute a study in this process, without files, and return its merged dataset.

    Its quantity may be one that is no function of a case, such as "bifurcation", samples of the motion over
    a parameter, which `plot_sweep` draws, or "campbell", frequencies and growth rates over the speed,
    which `plot_campbell` draws. The page "Quantities of studies" of the documentation lists all.

    Parameters
    ----------
    source : path of a study file, or the mapping that such a file holds
    workers, processes, executor, progress : as in `sweep`, for its batches

    Returns
    -------
    xarray.Dataset
        The quantity over the grid, with the `status` and `message` of each point. A study of named cases gives a
        DataTree of them, one of several grids a DataTree of their datasets.

    Raises
    ------
    disc_model.studies.study.StudyError
        If the study has faults; it lists all of them.

    Examples
    --------
    >>> import disc_model as dm
    >>> axes = {"mu_s": [0.35, 0.4], "mu_k": [0.2]}
    >>> study = {"study": "growth", "quantity": "floquet", "base": {"N": 385, "Omega": 12}, "axes": axes}
    >>> dm.run_study(study)["growth_rate"].sizes
    Frozen({'mu_s': 2, 'mu_k': 1})

    A bifurcation diagram:

    >>> turns = {"study": "turns", "quantity": "bifurcation", "options": {"transient": 20}}
    >>> turns |= {"base": {"N": 385}, "axes": {"Omega": [14, 15]}}
    >>> dm.plot_sweep(dm.run_study(turns)).get_xlabel()
    'Speed Ω (rad/s)'
    """
    # needs yaml, of the extra `workflow`
    from disc_model.studies.study import load_study, parse_study

    named = isinstance(source, str | Path | Mapping)
    require((named, "source", source, "must be the path of a study file, or a mapping"))
    calls = checked_workers(workers, processes, executor, progress)
    if isinstance(source, Mapping):
        folder = Path()
        study = parse_study(source, folder)
    else:
        folder = Path(source).parent
        study = load_study(source)
    grids, names = study.grids([folder])
    datasets: dict[str, Any] = {}
    for grid in (grids[name] for name in names):
        texts = [text for _, text in sorted(grid.batches.items())]
        batches = calls.results(run_batch, texts, grid.name)
        datasets[grid.name] = merge_batches(batches, grid.grid, grid.attrs)
    if study.specs:
        cases = calls.results(run_case, [*study.specs.values()], "cases")
        datasets["cases"] = merge_cases(dict(zip(study.specs, cases, strict=True)), study.labels)
    if len(datasets) == 1:
        return next(iter(datasets.values()))
    return xr.DataTree.from_dict(datasets)
