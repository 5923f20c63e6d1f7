"""A page on which every point of grid studies can be looked at: one file, which needs no network."""

import base64
import gzip
import json
from importlib.resources import files
from typing import Any

import numpy as np
import pandas as pd
from jinja2 import Template
from vl_convert import javascript_bundle
from xarray import DataArray, Dataset

from disc_model.data.variables import stated_in, values_text
from disc_model.explorer.charts import (
    HISTORIES,
    Entries,
    Names,
    axes_of,
    history_chart,
    points_chart,
)
from disc_model.figures.draw import edges, missing_text
from disc_model.figures.looks import looks_of
from disc_model.figures.shown import label, shown, value_text

FIRST = ("outcome", "kind", "growth_rate", "y", "critical_speed", "sliding_frequency", "frequency")
"""Variables that are shown before others."""
TEXTS = ("message", "crossing_line")
"""Variables of words that are no classes."""
SNIPPET = "window.vegaEmbed = vegaEmbed;"


def page(title: str, studies: list[Entries]) -> str:
    """The whole page, for studies as from `study_contents`."""
    template = (files(__package__) / "page.html").read_text(encoding="utf-8")
    parts = {"title": title, "studies": studies, "libraries": javascript_bundle(SNIPPET)}
    return Template(template, autoescape=True).render(parts)


def study_contents(name: str, study: Dataset, motions: Dataset | None, stated: Entries) -> Entries:
    """What the page has of a study: its name and title, what is fixed, and `contents`, packed: groups
    of variables with the same dimensions, and motions.

    stated : what its file states: `units` and `axes` of figures, and what each `motion` is
    """
    data = _in_words(shown(study, stated["units"]))
    if max(data.sizes.values()) > 1:
        data = data.squeeze()
    contents: Entries = {}
    if motions:
        data = data.assign_coords(_end=data.get("outcome", data.get("kind", data["status"])))
        seen = shown(motions.isel(point=motions["status"] == 0), stated["units"])
        contents = _motions(_in_words(seen), data["status"], stated)
    dims = dict.fromkeys(x.dims for x in data.values() if x.ndim and x.size)
    contents["groups"] = [_group(data, each, stated["axes"]) for each in dims]
    text = json.dumps(contents, ensure_ascii=False).replace("$", "")  # of mathematics in labels
    return {
        "name": name,
        "title": study.attrs.get("title") or name,
        "fixed": values_text(stated_in(study, "base")),
        "contents": base64.b64encode(gzip.compress(text.encode(), mtime=0)).decode(),
    }


def _in_words(data: Dataset) -> Dataset:
    """A shown dataset whose coordinates are finite numbers, or texts; along a dimension without one, of
    all that varies along it."""
    changed = {}
    for name in [*data.dims, *data.coords]:
        if name in data.coords and data[name].dtype.kind in "fi" and np.isfinite(data[name]).all():
            continue
        along = [x for x in data.coords.values() if x.dims == (name,)] or [data[name]]
        texts = [", ".join(map(value_text, values)) for values in zip(*along, strict=True)]
        changed[name] = (along[0].dims, texts, {"long_name": ", ".join(map(label, along))})
    return data.assign_coords(changed)


def _group(data: Dataset, dims: Any, wished: Names) -> Entries:
    """Variables of the same dimensions: a table of all values that each point has, with labels and
    what is said of missing ones, and the chart."""
    known = data[[name for name, x in data.items() if set(dims).issuperset(x.dims)]]
    own = known[
        sorted(
            (name for name, x in known.items() if x.dims == dims),
            key=FIRST.__contains__,
            reverse=True,
        )
    ]
    axes, chosen = axes_of(own, wished)
    table = known.to_dataframe(dim_order=dims).reset_index()
    flags = [str(name) for name, x in known.items() if x.dtype == object and name not in TEXTS]
    looks = looks_of(table[flags].to_numpy().ravel())
    table[flags] = table[flags].map(lambda word: looks[word].label)
    _add_places(table, own, axes, chosen)
    words = {name: table[name].unique().tolist() for name in flags}
    told = [known[name] for name in [*known.coords, *known]]
    return {
        "title": ", ".join(label(own[dim]) for dim in dims),
        "told": {x.name: [label(x), missing_text(x)] for x in told},
        "points": _columns(table),
        "spec": points_chart(own, axes, _lists(own, flags, chosen), words, looks.values()),
    }


def _lists(own: Dataset, flags: Names, chosen: Names) -> Entries:
    """Labels of what can be chosen: values along dimensions by their index, classes and numbers by their
    names."""
    lists: Any = {dim: dict(enumerate(map(value_text, own[dim]))) for dim in chosen}
    for name, x in own.drop_vars(TEXTS, errors="ignore").items():
        kind = "classes" if name in flags else "numbers"
        lists.setdefault(kind, {})[name] = f"{label(x)} · {name}"
    return lists


def _add_places(table: Any, group: Dataset, axes: Names, chosen: Names) -> None:
    """Add columns that the chart needs: indices along dimensions, and on maps the edges of cells."""
    for dim in chosen:
        table[f"_{dim}"] = pd.factorize(table[dim])[0]
    if len(axes) == 2:
        for letter, dim in zip("xy", axes, strict=True):
            place = pd.factorize(table[dim])[0]
            sides = edges(group[dim])
            table[f"_{letter}0"] = sides[place]
            table[f"_{letter}1"] = sides[place + 1]


def _motions(motions: Dataset, points: DataArray, stated: Entries) -> Entries:
    """A table of shown motions: where and what each is, and what its point comes to; a table of their
    samples, and the chart of one."""
    places = motions["length"].to_dataframe().reset_index()
    places = places.merge(points.to_dataframe().reset_index(), how="left")
    places["text"] = stated["motion"]
    samples = motions.to_dataframe().reset_index()
    return {
        "motions": _columns(places),
        "samples": _columns(samples[["point", "sample", "length", "phase", *HISTORIES]]),
        "history": history_chart(motions),
    }


def _columns(table: Any) -> Entries:
    """The columns of a table, with numbers as short texts."""
    return table.map(lambda x: f"{x:.7g}" if isinstance(x, float) else x).to_dict("list")
