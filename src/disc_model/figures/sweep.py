"""Pictures of sweeps and of grid studies: lines along one dimension, colours over two."""

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any
from weakref import ref

import numpy as np
import xarray as xr

from disc_model.errors import require, suggestion
from disc_model.figures.basins import draw_shares, entries_of, outcomes_in
from disc_model.figures.canvas import Page, Wishes, page_for
from disc_model.figures.colours import ColourWishes, is_colormap
from disc_model.figures.curve import MARKS, draw_lines
from disc_model.figures.drawing import COLUMN
from disc_model.figures.heat_map import draw_maps
from disc_model.figures.named_axes import Quantities
from disc_model.figures.sweep_lines import (
    join_lines,
    lines_beside,
    lines_of,
    lines_on,
    names_asked,
    next_look,
    quantities_of,
)
from disc_model.figures.types import Artist, Axes
from disc_model.figures.words import (
    horizon_text,
    known_name,
    label_in,
    label_of,
    measured,
    value_text,
    what_case,
)
from disc_model.parameters import Disc

SHARES = ("basin_fraction_by_energy", "basin_fraction")
PREFERRED = (
    *SHARES,
    "growth_rate",
    "outcome",
    "critical_speed",
    "separation_rate",
    "scan_first_separation",
    "value",
    "kind",
)
"""Variables that are drawn unless another one is asked for, the first that there is."""
OF_FUNCTIONS = {
    "choose_modes": "modes",
    "coupled_natural_frequencies": "value",
    "lyapunov_exponents": "exponents",
    "simulate": "n_separations",
}
"""Variables that are drawn before those, of sweeps of a function."""
FIRST_OF_SEVERAL = {
    "exponents": "largest Lyapunov exponent",
    "value": "lowest natural frequency of disc and attached slider",
}
"""Names of the first value of such variables that have several at each point."""
COUNTED = ("branch", "branch_point")
"""Dimensions whose values only count something."""


def plot_sweep(  # noqa: PLR0913
    study: xr.Dataset | xr.DataTree,
    variable: str | Sequence[str] = "",
    x: str = "",
    *,
    log: bool = False,
    cmap: Any = None,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | None = None,
) -> Axes:
    """Draw a sweep or a grid study, as `disc_model.plot_sweep` describes."""
    listed = isinstance(variable, list | tuple)
    first, *others = variable if listed and variable else [variable]
    names = all(isinstance(each, str | None) for each in (first, *others))
    require(
        (isinstance(study, xr.Dataset), "study", study, "must be an xarray.Dataset"),
        (names, "variable", variable, "must be a name, or a list of names"),
        (isinstance(x, str | None), "x", x, "must be a name"),
        (isinstance(log, bool), "log", log, "must be True or False"),
        (is_colormap(cmap), "cmap", cmap, "must be a colour map of matplotlib, or its name"),
    )
    if not first:
        study = _with_first_values(study)  # type: ignore[arg-type]  # checked
    whole = _varying(_with_names_of_discs(study))  # type: ignore[arg-type]  # checked
    varying, column = _along_pairs(whole, x)
    if not column:
        varying = _ascending(varying)
    drawn = [_drawn(varying, each, column, x) for each in (first, *others)]
    for each in drawn[1:]:
        alike = each.is_line and drawn[0].is_line and each.across == drawn[0].across
        rule = "must be lines over the same dimension to be drawn together"
        require((alike, "variable", each.variable, rule))
    called, labels = names_asked(labels, [each.variable for each in drawn])
    wishes = Wishes(ax, legend, labels, title)
    with page_for(wishes, COLUMN, 2.9, title=_case_of(varying)) as page:
        for each in drawn:
            _draw(page, varying, each, ColourWishes(log, cmap), called.get(each.variable, ""))
            page.remember()  # the next variable joins this one
    return page.ax


# ---- What is drawn


@dataclass(frozen=True)
class Drawn:
    """A variable, and its dimensions: along the horizontal axis, and up or by line, if any.

    mapped : whether the second dimension goes up, in a map
    joined : whether lines join the points; not those of paired values, which have no order
    """

    variable: str
    across: str
    second: str | None
    mapped: bool
    joined: bool = True

    @property
    def is_line(self) -> bool:
        """Whether lines or points are drawn, and no bars or map."""
        return not (self.mapped or self.variable in SHARES)


def _drawn(study: xr.Dataset, variable: str, column: str, x: str) -> Drawn:
    """What is drawn of a variable, over a column of paired values, if there is one."""
    drawn = _chosen_axes(study, _chosen_variable(study, variable), column or x)
    return replace(drawn, mapped=False, joined=False) if column else drawn


def _varying(study: xr.Dataset) -> xr.Dataset:
    """The study without dimensions of one value; but shares of starts of one case stay along their
    energies."""
    alone = (
        "basin_fraction" in study and study["basin_fraction"].size == study.sizes["attractor_class"]
    )
    kept = ("energy",) if alone else ()
    return study.squeeze(
        [dim for dim, size in study.sizes.items() if size == 1 and dim not in kept]
    )


def _with_first_values(study: xr.Dataset) -> xr.Dataset:
    """The study with the first value at each point of the usual variable of its function."""
    name = OF_FUNCTIONS.get(study.attrs.get("function", ""), "")
    if name not in FIRST_OF_SEVERAL or name not in study:
        return study
    several = [dim for dim in study[name].dims if dim == f"{name}_index"]
    first = study[name].isel(dict.fromkeys(several, 0))
    attrs = {**first.attrs, "long_name": FIRST_OF_SEVERAL[name]}
    return study.drop_vars(name).assign({name: first.assign_attrs(attrs)})


def _ascending(study: xr.Dataset) -> xr.Dataset:
    """The study with the numbers along its dimensions in their order: lines would go back and
    forth, and cells of a map lie on each other. Those that are not finite have no place."""
    named = [name for name in study.dims if name in study.coords]
    numbers = [name for name in named if study[name].dtype.kind in "fi"]
    placed = {name: np.isfinite(study[name].values) for name in numbers}
    return study.isel(placed).sortby(numbers)


def _with_names_of_discs(study: xr.Dataset) -> xr.Dataset:
    """The study with names for the discs along its dimensions, by their order and frequencies."""
    named = {}
    for name, values in study.coords.items():
        discs = [value for value in values.values.flat if isinstance(value, Disc)]
        if discs and values.ndim == 1:
            shown = [str(disc).removeprefix("Disc(").removesuffix(")") for disc in discs]
            words = [f"disc {i}: {text}" for i, text in enumerate(shown, start=1)]
            named[name] = (values.dims, words, values.attrs)
    return study.assign_coords(named)


def _along_pairs(study: xr.Dataset, x: str) -> tuple[xr.Dataset, str]:
    """The study along one of the columns of numbers that vary together, the first of them unless
    `x` is another, or their labels, and its name; "" if none vary together."""
    for dim in study.get("status", study).dims:
        beside = [
            name for name, values in study.coords.items() if values.dims == (dim,) and name != dim
        ]
        columns = [str(name) for name in beside if study[name].dtype.kind in "fi"]
        columns += [str(name) for name in beside if study[name].dtype.kind in "UO"]
        if columns and (dim not in study.coords or x in columns):
            column = x or columns[0]
            require((column in columns, "x", x, f"must be one of {', '.join(columns)}"))
            return study.swap_dims({dim: column}), column
    return study, ""


def _drawn_dims(study: xr.Dataset) -> list[str]:
    """Dimensions of a study whose values are numbers of a quantity; words where there are none."""
    named = [str(dim) for dim in study.dims if dim in study.coords and dim not in COUNTED]
    numbers = [dim for dim in named if study[dim].dtype.kind in "fi"]
    if numbers or "status" not in study:
        return numbers
    return [dim for dim in named if dim in study["status"].dims]


def _chosen_variable(study: xr.Dataset, variable: str) -> str:
    """The variable that is drawn; raises `ParameterError`."""
    numbers = {*_drawn_dims(study)}
    over = {str(name): {*values.dims} for name, values in study.items()}
    choices = [name for name, dims in over.items() if dims & numbers and dims <= {*study.coords}]
    flat = [name for name in choices if len(over[name]) < 3]
    of_function = OF_FUNCTIONS.get(study.attrs.get("function", ""), "")
    preferred = [name for name in (of_function, *PREFERRED) if name in flat]
    numeric = [name for name in flat if study[name].dtype.kind in "fi"]
    usual = next(iter([*preferred, *numeric, *choices]), "")
    named = variable or usual
    points = "must have two points or more along a number or a word"
    require((bool(numbers), "study", "a single point", points))
    rule = f"must be one over the grid{suggestion(named, choices)}"
    further = [dim for dim in over.get(named, ()) if dim not in study.coords]
    if further:
        rule = f"must not vary along {further[0]}: select one, as by study.isel({further[0]}=0)"
    require((named in choices, "variable", named, rule))
    return named


def _chosen_axes(study: xr.Dataset, variable: str, x: str) -> Drawn:
    """The dimensions along which a variable is drawn; raises `ParameterError`."""
    dims = [str(dim) for dim in study[variable].dims]
    numbers = [dim for dim in dims if dim in _drawn_dims(study)]
    across = x or numbers[0]
    many = "must vary along at most two: select values of the others, as by study.sel(N=300)"
    require((len(dims) < 3, "study", ", ".join(dims), many))
    require((across in numbers, "x", across, f"must be one of {', '.join(numbers)}"))
    second = next((dim for dim in dims if dim != across), None)
    plane = len(numbers) == 2 and all(study[dim].dtype.kind in "fi" for dim in numbers)
    return Drawn(variable, across, second, mapped=plane)


def _values_of(study: xr.Dataset) -> dict[str, Any]:
    """The values of the case that do not vary in a study."""
    case = json.loads(study.attrs.get("base", study.attrs.get("parameters", "{}")))
    shown = {str(name).removeprefix("sweep_").removeprefix("scan_") for name in study.coords}
    fixed = {name: value for name, value in case.items() if name not in shown}
    for name, values in study.coords.items():
        if not values.ndim or values.size == 1:
            fixed[str(name)] = values.item()
    return fixed


def _said_of(study: xr.Dataset) -> dict[str, str]:
    """Words for single values of what is no parameter and has a unit, such as a horizon."""
    said = {}
    for name, values in study.coords.items():
        if values.size == 1 and values.attrs.get("units", "1") != "1" and not known_name(values):
            said[str(name)] = f"{name} = {value_text(study, str(name))}"
    return said


def _case_of(study: xr.Dataset) -> str:
    """The text of these values."""
    return what_case(_values_of(study))


# ---- Drawing


def _draw(page: Page, study: xr.Dataset, drawn: Drawn, wishes: ColourWishes, name: str) -> None:
    """Draw bars of shares, lines, which have a name if the reader gives one, or a map."""
    label = label_in(study, drawn.variable)
    across = label_of(study[drawn.across])[0]
    if drawn.variable in SHARES and not wishes.log:
        wishes.refuse()
        page.show(Quantities(across, label_of(study[drawn.variable])[0]))
        page.explain(_draw_bars(page.ax, study, drawn), beside="below")
    elif not drawn.mapped:
        wishes.refuse()
        _draw_lines(page, study, drawn, wishes.log, name)
    else:
        page.show(Quantities(across, label_of(study[drawn.second])[0], label))
        plane = study.transpose(drawn.second, drawn.across, ...)
        key = draw_maps(page.figure, [page.ax], [plane], drawn.variable, wishes)
        page.explain(key.handles, beside="below", title=key.title)
        page.is_map = True
        whole = study[drawn.second].dtype.kind == "i"
        if whole and page.ax.get_yscale() == "linear":
            page.ax.locator_params(axis="y", integer=True)


def _draw_lines(page: Page, study: xr.Dataset, drawn: Drawn, log: bool, name: str) -> None:
    """Draw lines beside those of other variables of the same unit, and of other cases."""
    others = lines_on(page.ax)
    labels = (label_of(study[drawn.across])[0], label_in(study, drawn.variable))
    lines = lines_of(study, drawn.variable, labels, name, _values_of(study))
    lines.shown.said = _said_of(study)
    quantities = quantities_of(lines, others)
    page.show(quantities)
    marks = {}
    if drawn.second is None:
        marks[""] = MARKS[len(lines_beside(page.ax)) % len(MARKS)]
    found = draw_lines(
        page.ax,
        study,
        drawn.variable,
        drawn.across,
        log,
        marks,
        joined=drawn.joined,
        single=next_look(page.ax),
    )
    page.ax.set_ylabel(quantities.y)
    lines.parts = [(part, ref(line)) for part, line in found]
    join_lines(page, lines)


def _draw_bars(ax: Axes, study: xr.Dataset, drawn: Drawn) -> list[Artist]:
    """Draw the shares of starts as bars; returns entries of a legend."""
    shares = study[drawn.variable]
    classes = outcomes_in(shares)
    across = measured(study[drawn.across])
    places = across.values
    if drawn.across == "energy":  # equally far apart, as one may be 0
        places = np.arange(places.size)
    draw_shares(ax, shares, classes, places)
    if drawn.across == "energy":
        ax.set_xticks(places, [f"{energy:g}" for energy in across.values])
    ax.set_xlabel(across.label)
    ax.set_ylabel(label_of(shares)[0])
    ax.set_xmargin(0.04)
    within = horizon_text(study) or "the horizon"
    return entries_of(classes, f"undecided within {within}: raise horizon")
