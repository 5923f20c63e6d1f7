"""The kinds of figures by the names that study files use, and drawing one from its data."""

from collections.abc import Mapping
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure
from xarray import Dataset, DataTree

from disc_model.data.dataset import Missing
from disc_model.data.variables import stated_in
from disc_model.errors import Fault, ParameterError, suggestion
from disc_model.figures import modes, motions, runs, studies
from disc_model.figures.draw import COLUMN, PAGE, finish, panels, styled
from disc_model.figures.looks import Options
from disc_model.figures.schema import NORM, CasePlot, Kind, Plot, kinds_in
from disc_model.figures.shown import key_of, shown, shown_case
from disc_model.parameters import Parameters

MODULES = (modes, motions, runs, studies)
KINDS = {name: kind for module in MODULES for name, kind in kinds_in(module).items()}
"""Kinds of this package."""
WIDTHS = {"column": COLUMN, "page": PAGE}


def kind_of(name: Any) -> type[Kind]:
    """The kind of a name, such as ``heat_map``, or ``paper.one_separation``: that of a part of the
    workflow that has a module ``figures``, and may be absent. Raises `ParameterError`."""
    part, _, _ = str(name).rpartition(".")
    known = KINDS
    if part:
        known = kinds_of_part(part)
    if not isinstance(name, str) or name not in known:
        rule = f"unknown kind of figure{suggestion(name, known or KINDS)}"
        raise ParameterError(Fault.of(("kind",), name, rule))
    return known[name]


@cache
def kinds_of_part(part: str) -> dict[str, type[Kind]]:
    """Kinds of a part of the workflow; none if it, or its module ``figures``, is absent."""
    try:
        return kinds_in(import_module(f"workflow.{part}.figures"), part)
    except ModuleNotFoundError:
        return {}


def render(plot: Kind, inputs: Mapping[str, DataTree]) -> Figure:
    """Draw a figure from its inputs by name, in the common style and its readers' units.

    A figure of cases, or of a study, that lack what it shows says so instead.
    """
    with styled():
        try:
            if isinstance(plot, CasePlot):
                figure = _of_cases(plot, inputs)
            else:
                figure = _of_studies(plot, inputs)
        except Missing as reason:
            what = "case" if isinstance(plot, CasePlot) else "study"
            figure, axes = panels([["a"]], COLUMN, 2)
            axes["a"].set_axis_off()
            axes["a"].text(0.5, 0.5, f"not shown: the {what} {reason}", ha="center", wrap=True)
        if plot.width is not None:
            figure.set_figwidth(WIDTHS[plot.width])
        return finish(figure, "" if plot.caption else plot.title)


def _of_cases(plot: CasePlot, inputs: Mapping[str, DataTree]) -> Figure:
    """Draw named cases."""
    cases = {name: shown_case(tree, plot.units) for name, tree in inputs.items()}
    options = plot.options
    for key in plot.further:
        named = options[key]
        if isinstance(named, str):
            options[key] = cases.get(named)
        else:
            options[key] = {name: cases[name] for name in named}
    figure: Figure = type(plot).function(cases[plot.case], **options)
    return figure


def _of_studies(plot: Any, inputs: Mapping[str, DataTree]) -> Figure:
    """Draw a study, the first input, and further ones by their roles."""
    study, *others = (_prepared(plot, tree.to_dataset()) for tree in inputs.values())
    overlays = {}
    for role, other in zip([*inputs][1:], others, strict=True):
        if NORM in other.dims and NORM not in study.dims:
            other = other.sel({NORM: normalization_of(study)})
        overlays[role] = other
    figure: Figure = type(plot).function(study, **plot.options, **overlays)
    return figure


def normalization_of(study: Dataset) -> str:
    """The normalization of the modes of a study that has one."""
    if NORM in study.coords:
        return str(study[NORM].item())
    return str(stated_in(study, "base").get(NORM, Parameters.model_fields[NORM].default))


def _prepared(plot: Plot, data: Dataset) -> Dataset:
    """What a figure shows of a dataset: at the values that it chooses, without dimensions of one
    value, in readers' units, with names for values."""
    for name, value in plot.at.items():
        if name in data.dims:
            keys = [key_of(each) for each in data[name].values]
            data = data.isel({name: keys.index(key_of(value))})
    single = {str(name) for name, size in data.sizes.items() if size == 1}
    single -= {*plot.axes.values(), *plot.shows.needs}
    if plot.shows.quantities:  # whose own dimensions the figure takes
        single &= {*data["status"].dims}
    data = shown(data.squeeze(single), plot.units)
    by = plot.axes.get("by", NORM)
    if plot.names and by in data.coords:
        data[by].attrs["names"] = plot.names
    return data


def save(figure: Figure, path: str | Path, title: str = "") -> None:
    """Write a figure with its title; equal figures give equal bytes. Further files have the layout of
    the first."""
    options: Options = {"pil_kwargs": {"compress_level": 1}}  # half the time, 1.1 of the size
    metadata: Options = {"Software": None}
    if Path(path).suffix == ".pdf":
        options = {}
        metadata = {"CreationDate": None}
    if title:
        metadata["Title"] = title
    with styled():
        layout = figure.get_layout_engine()
        if layout is not None:
            layout.execute(figure)
            figure.set_layout_engine(None)
            figure.align_ylabels()
        figure.savefig(path, metadata=metadata, **options)
