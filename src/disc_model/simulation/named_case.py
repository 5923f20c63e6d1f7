"""A named case of a study: from its specification to a dataset."""

from __future__ import annotations

import json
import logging
from typing import TYPE_CHECKING

from disc_model.errors import DiscModelError
from disc_model.provenance import git_commit, physics_hash, versions_text
from disc_model.simulation.api import simulate
from disc_model.simulation.case import CaseSpec, Span, Start
from disc_model.simulation.starts import make_initial_state

if TYPE_CHECKING:
    import xarray as xr

log = logging.getLogger(__name__)


def run_case(spec: CaseSpec) -> xr.DataTree:
    """Simulate a named case of a study, in the layout of `disc_model.data.dataset`; a failure is
    recorded as a status."""
    import xarray as xr

    from disc_model.data.columns import scalars_dataset

    p = spec.parameters
    kept = spec.record.events
    try:
        result = simulate(
            p,
            spec.t_end,
            spec.record.sections,
            events=bool(kept),
            tol=spec.tol,
            initial_state=make_initial_state(p, spec.start, spec.tol),
            stop_at=spec.stop_at,
            ramps=spec.ramps,
        )
    except DiscModelError as error:
        log.error("no result: %s", error)
        known = {"t_end": spec.t_end, "tol": spec.tol}
        tree = xr.DataTree(scalars_dataset(p, known, "failed", f"{type(error).__name__}: {error}"))
    else:
        log.info("%s", result)
        tree = result.to_tree()
        if kept:
            span = Span() if kept is True else kept
            begin, end = span.ends(0.0, result.final_state.time)
            events = tree["events"].to_dataset()
            within = slice(*events["time"].values.searchsorted([begin, end]))
            events = events.isel(event=within)
            tree["events"].dataset = events.assign_attrs(kept_from=begin, kept_until=end)
    if spec.start != Start():
        tree.attrs["start"] = json.dumps(spec.start.model_dump(), sort_keys=True)
    tree.attrs |= {
        "source_hash": physics_hash(),
        "git_commit": git_commit(),
        "versions": versions_text(),
        "specification": spec.canonical,
        "specification_key": spec.key,
    }
    return tree
