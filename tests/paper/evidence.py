"""Evidence for rows of the ledger: the paper's cases, simulated, changed as stories.yaml says; and
made-up grids."""

import json
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
import yaml

from disc_model.data.dataset import series_dataset
from disc_model.data.variables import EVENT_KINDS, PHASES
from disc_model.paper.measures import CaseView
from disc_model.parameters import Parameters
from disc_model.simulation.api import run_case
from disc_model.studies.study import load_study

SPECS = load_study(Path(__file__).parents[2] / "config" / "paper.yaml").specs
TEXTS = yaml.safe_load(Path(__file__).with_name("stories.yaml").read_text(encoding="utf-8"))
Groups = dict[str, xr.Dataset]


@cache
def simulated(*names: str, normalization: str = "as_published") -> dict[str, xr.DataTree]:
    """Cases of the paper, all unless some are named: half a minute of one core."""
    specs = {name: SPECS[name] for name in names or SPECS}
    for name, spec in specs.items():
        own = spec.parameters.replace(normalization=normalization)
        specs[name] = spec.model_copy(update={"parameters": own})
    with ThreadPoolExecutor(2) as threads:
        return dict(zip(specs, threads.map(run_case, specs.values()), strict=True))


@cache
def groups_of(name: str) -> Groups:
    """The datasets of a case, by the names of their groups; that of the case itself is ""."""
    node = simulated()[name]
    return {"": node.to_dataset()} | {
        str(n): group.to_dataset(inherit=False) for n, group in node.children.items()
    }


def view(name: str, groups: Groups) -> CaseView:
    return CaseView(
        name, xr.DataTree.from_dict({f"/{group}": held for group, held in groups.items()})
    )


def said_to_be(name: str, story: str | Mapping[str, Any]) -> CaseView:
    """A case as a story has it.

    story : the name of another case, whose motion is said to be this one's, or a mapping: by groups of the case, that
        of another case; by variables of the disc, lines of a spectrum instead of them (frequency in Hz, amplitude, rate
        of the frequency in Hz/s; noise without a frequency); ``says``, other values for the whole run
    """
    own = groups_of(name)[""]
    if isinstance(story, str):
        given = groups_of(story)
        root = given[""].assign({key: own[key] for key in Parameters.model_fields if key in own})
        root.attrs = own.attrs
        return view(name, given | {"": root})
    found = dict(groups_of(name))
    for key, value in story.items():
        if key == "says":
            found[""] = own.assign(value)
        elif isinstance(value, str):
            found[key] = groups_of(value)[key]
        else:
            found |= {
                n: group.assign({key: _lines(group, value)})
                for n, group in found.items()
                if key in group and "time" in group.sizes
            }
    return view(name, found)


def _lines(group: xr.Dataset, lines: Sequence[Sequence[float | None]]) -> xr.DataArray:
    t, noise = group["time"], np.random.default_rng(0)
    parts = [
        size
        * (
            noise.standard_normal(t.size)
            if f is None
            else np.cos(2 * np.pi * (f + sum(drift) / 2 * t) * t)
        )
        for f, size, *drift in lines
    ]
    return xr.DataArray(sum(parts), {"time": t}, ["time"])


def cases(
    stories: Mapping[str, Any], scans: Mapping[str, xr.Dataset] | None = None
) -> dict[str, CaseView]:
    """All cases, those of stories (one name or several) as these have them, and grid studies."""
    found = {name: CaseView(name, node) for name, node in simulated().items()}
    found |= {
        name: said_to_be(name, story) for names, story in stories.items() for name in names.split()
    }
    return found | {name: CaseView(name, xr.DataTree(scan)) for name, scan in (scans or {}).items()}


def kept_events(rows: Iterable[tuple[Any, ...]], start: float, stop: float) -> xr.Dataset:
    """Events as a case keeps them between two times: each a time, a kind and a phase."""
    codes = [(time, EVENT_KINDS.index(kind), PHASES.index(phase)) for time, kind, phase in rows]
    frame = pd.DataFrame(codes, columns=["time", "kind", "phase"])
    return series_dataset(frame, "event").assign_attrs(kept_from=start, kept_until=stop)


WORDS = ("ok", "failed", "quiet", "growing", "separation", "no_cycle", "no_stick_slip")
WORDS += (
    "none",
    "begins",
    "ends",
    "neutral",
    "fold",
    "no",
    "yes",
    "settled",
    "changing",
    "simulation",
    "inferred",
)


def grid(
    axes: Mapping[str, Any], stated: Mapping[str, Any] | None = None, **variables: Any
) -> xr.Dataset:
    """A grid study: each variable along the first axes, as many as it has dimensions, its words as
    flags.

    stated : what it states, as its base and as its options alike
    """
    found = xr.Dataset(
        coords=axes, attrs=dict.fromkeys(("base", "options"), json.dumps(stated or {}))
    )
    for name, given in variables.items():
        values, attrs = np.asarray(given), {}
        if values.dtype.kind == "U":
            values, attrs = np.vectorize(WORDS.index)(values), {"flag_meanings": " ".join(WORDS)}
        found[name] = (list(axes)[: values.ndim], values, attrs)
    return found


def scans(
    windows: Sequence[Sequence[float]] = TEXTS["windows"], **changes: Mapping[str, Any]
) -> dict[str, xr.Dataset]:
    """Grid studies as stories.yaml has them, by name, some of them with other values.

    windows : rad/s, where separation begins and ends, at three preloads or more
    """
    texts = TEXTS["scans"]
    found = {
        x: grid(**texts.get(x, {}) | changes.get(x, {})).assign_attrs(study=x)
        for x in texts | changes
    }
    speeds, preloads = np.array(windows)[:, None], [50.0, 200.0, 385.0, 500.0, 510.0]
    axes = {"normalization": ["as_published"], "N": preloads[: len(windows)], "horizon": [1000.0]}
    found["critical_speed"] = grid(
        axes | {"crossing_number": [0, 1], "scan_Omega": [5.0, 24.0]},
        {"precision": 0.1},
        status=[["ok"] * len(windows)],
        critical_speed=[speeds[..., 0]],
        crossing=[speeds],
        crossing_kind=[np.where(np.isnan(speeds), "none", ["begins", "ends"])],
    )
    return found
