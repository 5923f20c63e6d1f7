"""Evidence for rows of the ledger.

It is made of the paper's cases, simulated and changed as stories.yaml says, and of made-up grids.
"""

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

from disc_model.data.columns import series_dataset
from disc_model.data.variables import EVENT_KINDS, PHASES, attributes
from disc_model.parameters import Parameters
from disc_model.simulation.named_case import run_case
from disc_model.studies.study import load_study
from tests import damages
from tests.damages import Groups
from workflow.paper.judging_tables import COMPLIANT, ENERGIES, GROWTHS, POWERS
from workflow.paper.measures import CaseView

ROOT = Path(__file__).parents[2]
SPECS = {
    name: spec
    for name, spec in load_study(ROOT / "config" / "paper.yaml").cases.items()
    if spec.parameters.normalization == "as_published"
}
STORIES = Path(__file__).with_name("stories.yaml")
TEXTS = yaml.safe_load(STORIES.read_text(encoding="utf-8"))


# ---- Cases


@cache
def simulated(*names: str, normalization: str = "as_published") -> dict[str, xr.DataTree]:
    """Return cases of the paper, all on a linear plate unless some are named: half a minute of one core."""
    specs = {}
    for name in names or SPECS:
        spec = SPECS[name]
        own = spec.parameters.replace(normalization=normalization)
        specs[name] = spec.model_copy(update={"parameters": own})
    with ThreadPoolExecutor(2) as threads:
        cases = threads.map(run_case, specs.values())
        return dict(zip(specs, cases, strict=True))


@cache
def groups_of(name: str) -> Groups:
    """Return the datasets of a case, by the names of their groups."""
    return damages.groups_of(simulated()[name])


def view(name: str, groups: Groups) -> CaseView:
    """Return the view of a case made of groups."""
    return CaseView(name, damages.tree_of(groups))


def said_to_be(name: str, story: str | Mapping[str, Any]) -> CaseView:
    """Return a case as a story has it.

    Parameters
    ----------
    name : of the case
    story : the name of another case, whose motion is said to be this one's; or a mapping of
        groups of the case, to that of another case; of variables of the disc, to lines of a
        spectrum instead of them (frequency in Hz, amplitude, rate of the frequency in Hz/s; noise
        without a frequency); of ``says``, to other values for the whole run
    """
    own = groups_of(name)[""]
    if isinstance(story, str):
        given = dict(groups_of(story))
        parameters = {key: own[key] for key in Parameters.model_fields if key in own}
        given[""] = given[""].assign(parameters)
        given[""].attrs = own.attrs
        return view(name, given)

    found = dict(groups_of(name))
    for key, value in story.items():
        if key == "says":
            found[""] = own.assign(value)
        elif isinstance(value, str):
            found[key] = groups_of(value)[key]
        else:
            for group, held in found.items():
                if key in held and "time" in held.sizes:
                    found[group] = held.assign({key: signal(held["time"], value)})
    return view(name, found)


def signal(time: xr.DataArray, lines: Sequence[Sequence[float | None]]) -> xr.DataArray:
    """Return a sum of lines of a spectrum over time, as stories have them."""
    noise = np.random.default_rng(0)
    total = xr.zeros_like(time)
    for frequency, size, *drift in lines:
        if frequency is None:
            part = noise.standard_normal(time.size)
        else:
            part = np.cos(2 * np.pi * (frequency + sum(drift) / 2 * time) * time)
        total = total + size * part
    return xr.DataArray(total, {"time": time}, ["time"])


def cases(
    stories: Mapping[str, Any], scans: Mapping[str, xr.Dataset] | None = None
) -> dict[str, CaseView]:
    """Return all cases by name, and grid studies.

    Parameters
    ----------
    stories : what some cases are said to be, by one name or several
    scans : the grid studies
    """
    found = {name: CaseView(name, node) for name, node in simulated().items()}
    for names, story in stories.items():
        for name in names.split():
            found[name] = said_to_be(name, story)
    for name, scan in (scans or {}).items():
        found[name] = CaseView(name, xr.DataTree(scan))
    return found


def kept_events(rows: Iterable[tuple[Any, ...]], start: float, stop: float) -> xr.Dataset:
    """Return events as a case keeps them between two times: each a time, a kind and a phase."""
    codes = [(time, EVENT_KINDS.index(kind), PHASES.index(phase)) for time, kind, phase in rows]
    frame = pd.DataFrame(codes, columns=["time", "kind", "phase"])
    return series_dataset(frame, "event").assign_attrs(kept_from=start, kept_until=stop)


# ---- Grid studies


WORDS = (
    "ok failed stick_slip growing separation no_cycle no_stick_slip none begins ends neutral fold no yes "
    "settled changing simulation undecided"
)
"""Words of flags."""


def grid(
    axes: Mapping[str, Any], stated: Mapping[str, Any] | None = None, **variables: Any
) -> xr.Dataset:
    """Return a grid study.

    Parameters
    ----------
    axes : its coordinates
    stated : what it states, as its base and as its options alike
    variables : each along the first axes, as many as it has dimensions; words become flags
    """
    text = json.dumps(stated or {})
    found = xr.Dataset(coords=axes, attrs={"base": text, "options": text})
    for name in found.coords.keys() & Parameters.model_fields.keys():
        found[name].attrs = attributes(name)
    for name, given in variables.items():
        values = np.asarray(given)
        attrs = {}
        if values.dtype.kind == "U":
            values = np.vectorize(WORDS.split().index)(values)
            attrs = {"flag_meanings": WORDS, "flag_values": [*range(len(WORDS.split()))]}
        dims = list(axes)[: values.ndim]
        found[name] = (dims, values, attrs)
    return found


def scans(
    windows: Sequence[Sequence[float]] = TEXTS["windows"], **changes: Mapping[str, Any]
) -> dict[str, xr.Dataset]:
    """Return grid studies as stories.yaml has them, by name.

    Parameters
    ----------
    windows : rad/s, where separation begins and ends, at three preloads or more
    changes : other values of some studies
    """
    texts = TEXTS["scans"]
    found = {}
    for name in {**texts, **changes}:
        values = {**texts.get(name, {}), **changes.get(name, {})}
        found[name] = grid(**values).assign_attrs(study=name)
    found["critical_speed"] = critical_speeds(windows)
    return found


def critical_speeds(windows: Sequence[Sequence[float]]) -> xr.Dataset:
    """Return a study of speeds in rad/s at which separation begins and ends, by preload."""
    speeds = np.array(windows)[:, None]
    preloads = [50.0, 200.0, 385.0, 500.0, 510.0]
    axes = {
        "normalization": ["as_published"],
        "N": preloads[: len(windows)],
        "horizon": [1000.0],
        "crossing_number": [0, 1],
        "scan_Omega": [5.0, 24.0],
    }
    return grid(
        axes,
        {"precision": 0.1},
        status=[["ok"] * len(windows)],
        critical_speed=[speeds[..., 0]],
        crossing=[speeds],
        crossing_kind=[np.where(np.isnan(speeds), "none", ["begins", "ends"])],
    )


# ---- Tables


def tables(supplied: float = 3.88, pulls: float = -3.0) -> dict[str, pd.DataFrame]:
    """Return tables that checks are given, with few rows.

    Parameters
    ----------
    supplied : energy with separation, mJ, beside 3.94 mJ without it and a surplus of 2.37 mJ
    pulls : power in W while the force of maintained contact is negative
    """
    in_period = [supplied, 3.94, 1.57, 2.31, 2.37]
    energies = pd.DataFrame({"case": ["F02", "F07", "F09"]})
    energies[ENERGIES + POWERS] = [*in_period, 4.0, pulls]
    energies[COMPLIANT] = 0.75 * in_period[0]
    changes = [("F11", "a", 52.2), ("F11", "b", np.nan), ("F13", "a", np.nan), ("F13", "b", 60.1)]
    return {
        "energies": energies.assign(remark=np.nan),
        "small_changes": pd.DataFrame(changes, columns=["case", "parameter", "first_s"]),
        "precursor": sliding_growths((10.0, -1.0, 0.2, 0.1), (1000.0, 0.5, 0.4, 0.3)),
    }


def sliding_growths(*rows: tuple[float, float, float, float]) -> pd.DataFrame:
    """Return growth rates of steady sliding in 1/s at speeds in rad/s, as `judging_tables.precursor`."""
    return pd.DataFrame(rows, columns=["Omega", *GROWTHS]).assign(N=385.0)
