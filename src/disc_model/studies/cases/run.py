"""Running cases for the workflow: a failure becomes a status in the dataset instead of ending the study."""

from __future__ import annotations

import logging
from pathlib import Path

import xarray as xr

from disc_model.data.dataset import failed_groups, json_attribute, to_tree
from disc_model.data.provenance import git_commit, source_hash, versions
from disc_model.errors import DiscModelError
from disc_model.simulation.api import prepared, simulate
from disc_model.simulation.case import CaseSpec, Start
from disc_model.studies.modes import chosen, from_text

log = logging.getLogger(__name__)


def run_case(spec: CaseSpec, checkpoint: Path | None = None) -> xr.DataTree:
    """Simulate one case; the tree has the layout described in `disc_model.data.dataset`.

    ``checkpoint``: file from which an interrupted case goes on, see `disc_model.simulation.api`.
    """
    p, truncation = spec.parameters, spec.truncation
    try:
        if spec.modes:
            choice = chosen(p, from_text(spec.modes))
            p, truncation = choice.parameters, choice.to_json()
            log.info("modes chosen: %s", truncation)
        result = simulate(
            p,
            spec.t_end,
            tol=spec.tol,
            initial_state=prepared(p, spec.start, spec.tol),
            record=spec.record,
            stop_at=spec.stop_at,
            checkpoint=checkpoint,
            ramps=spec.ramps,
        )
    except DiscModelError as error:
        log.error("no result: %s", error)
        tree = to_tree(failed_groups(p, spec.t_end, spec.tol, f"{type(error).__name__}: {error}"))
    else:
        log.info("%s, first separation %s s, %s", result.status.value, result.first_separation, result.statistics)
        tree = result.to_tree([name for name, _ in spec.windows])
        tree["events"].dataset = _kept_events(tree["events"].to_dataset(), spec.events)
    if spec.start != Start():
        tree.attrs["start"] = json_attribute(spec.start.model_dump())
    if truncation:
        tree.attrs["truncation"] = truncation
    tree.attrs |= provenance() | {"specification": spec.canonical, "specification_key": spec.key}
    return tree


def provenance() -> dict[str, str]:
    """What produced a case: hash of the sources, commit, and versions of the packages."""
    return {
        "source_hash": source_hash(__name__),
        "git_commit": git_commit(),
        "versions": json_attribute(versions()),
    }


def _kept_events(events: xr.Dataset, span: tuple[float, float] | None) -> xr.Dataset:
    if span is None:
        return events.isel(event=slice(0))
    time = events["time"].values
    kept = events.isel(event=slice(*time.searchsorted([span[0], span[1]], side="left")))
    return kept.assign_attrs(kept_from=span[0], kept_until=span[1])
