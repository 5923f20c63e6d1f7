"""What a picture of a sweep shows: which variable, over which of its dimensions, and of what case."""

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from disc_model.data.swept_branches import is_of_sweep, selected_text
from disc_model.data.variables import TRUTH, WITHOUT_EFFECT, stated_in
from disc_model.display import counted
from disc_model.errors import Fault, ParameterError, require, suggestion
from disc_model.figures.selection import without_single
from disc_model.figures.sweep_options import function_of, option_text, stays_in
from disc_model.figures.swept_lists import with_names_of_lists
from disc_model.figures.words import (
    IN_THOUSANDTH,
    known_name,
    named,
    symbol_of,
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
    "bifurcation": "psi",
    "choose_modes": "modes",
    "coupled_natural_frequencies": "value",
    "lyapunov": "exponent",
    "lyapunov_exponents": "exponents",
    "simulate": "n_separations",
}
"""Variables that are drawn before those, of sweeps of a function or of studies of a quantity."""
FIRST_OF_SEVERAL = {
    "exponent": "largest Lyapunov exponent",
    "exponents": "largest Lyapunov exponent",
    "value": "lowest natural frequency of disc and attached slider",
}
"""Names of the first value of such variables that have several at each point."""
OF_POINTS = ("status", "message")
"""Variables that say whether points were computed."""
ALONG_EXPONENTS = ("errors", "exponent_error", "converged")
"""Variables that say something of each Lyapunov exponent."""
COUNTED = ("branch", "branch_point")
"""Dimensions whose values only count something."""
COUNT = re.compile("number of the (?!.* along )")
"""What long names of dimensions begin with along which a variable has several values at one point, in
no order of their own."""
FEW = 3  # values of a dimension, which are lines rather than rows of a map


class Paired(NamedTuple):
    """A study of paired samples: the column of their values along the horizontal axis, "" for none, or
    the dimension of samples that have a line each, "" for none."""

    study: xr.Dataset
    column: str = ""
    samples: str = ""


@dataclass(frozen=True)
class Drawn:
    """A variable, and its dimensions: along the horizontal axis, and up or by line, if any.

    mapped : whether the second dimension goes up, in a map
    joined : whether lines join the points; not those of paired values, which have no order
    sampled : whether the second dimension is that of paired samples, each of which has a line
    counted : whether the second dimension only counts values, all of which are points
    """

    variable: str
    across: str
    second: str | None
    mapped: bool
    joined: bool = True
    sampled: bool = False
    counted: bool = False

    @property
    def is_line(self) -> bool:
        """Whether lines or points are drawn, and no bars or map."""
        return not (self.mapped or self.variable in SHARES)


def choose_drawn(
    study: xr.Dataset,
    variables: Sequence[str],
    x: str,
    lines: str | None = "",
    *,
    points: bool = False,
) -> tuple[xr.Dataset, list[Drawn]]:
    """The study as it is drawn, and what is drawn of each variable, "" for the usual one; several
    are lines over the same dimension. Raises `ParameterError`.

    x, lines : dimensions along the horizontal axis, and with a line for each value; "" for the usual
        ones; None for a map in place of lines
    points : whether all values at a place along the axis are points
    """
    _refuse_branches(study)
    study = _without_zeros(_without_stacks(study))
    study = _with_own_coordinates(study)
    if not variables[0]:
        study = _with_first_values(study)
    whole = _varying(_with_words(study))
    paired = _paired(_with_one_horizon(whole), x)
    varying = paired.study
    if not paired.column:
        varying = _ascending(varying, paired.samples)

    if points:
        drawn = [_as_points(varying, each, paired.column or x) for each in variables]
    else:
        drawn = [_drawn(paired._replace(study=varying), each, x, lines) for each in variables]
    for each in drawn[1:]:
        alike = each.is_line and drawn[0].is_line and each.across == drawn[0].across
        rule = "must be lines over the same dimension to be drawn together"
        require((alike, "variable", each.variable, rule))
    varying = with_names_of_lists(varying, drawn[0].second)
    return _in_common_units(varying, variables), drawn


def _as_points(study: xr.Dataset, variable: str, x: str) -> Drawn:
    """What is drawn of a variable, as points: all of a second dimension at each place along the first."""
    drawn = _chosen_axes(study, _chosen_variable(study, variable), x)
    if drawn.variable in SHARES:
        raise ParameterError(Fault(("points",), "", f"{drawn.variable} is drawn as bars"))
    counted = drawn.second is not None
    return replace(drawn, mapped=False, joined=False, sampled=False, counted=counted)


def _in_common_units(study: xr.Dataset, variables: Sequence[str]) -> xr.Dataset:
    """The study with all of several variables of one unit in thousandths of it if some of them are."""
    shown = [name for name in variables if name in study]
    units = {study[name].attrs.get("units") for name in shown}
    factors = [named(study[name]).factor for name in shown]
    if len(units) != 1 or {*factors} != {1.0, 1e3}:
        return study
    plain = [name for name, factor in zip(shown, factors, strict=True) if factor == 1.0]
    return study.assign({name: study[name].assign_attrs({IN_THOUSANDTH: 1}) for name in plain})


def _refuse_branches(study: xr.Dataset) -> None:
    """Raise `ParameterError` for branches of a sweep, each of which has points of its own."""
    if not is_of_sweep(study):
        return
    branch = f"disc_model.Branch.from_dataset({selected_text(study, 'study')})"
    rule = f"holds branches: draw all by disc_model.plot_branches(study), or one by {branch}.plot()"
    raise ParameterError(Fault(("study",), "a sweep of branches", rule))


def _drawn(paired: Paired, variable: str, x: str, lines: str | None) -> Drawn:
    """What is drawn of a variable, over a column of paired values, if there is one."""
    study, column, samples = paired
    name = _chosen_variable(study, variable)
    if lines:
        drawn = _with_lines(study, name, column or x, lines)
    else:
        drawn = _chosen_axes(study, name, column or x)
    if lines is None and drawn.second in study.coords:
        drawn = replace(drawn, mapped=_are_plane(study, drawn), counted=False)
    elif drawn.mapped:
        drawn = _with_few_lines(study, drawn, x)
    if column:
        return replace(drawn, mapped=False, joined=False)
    if only_counts(study, drawn.across):
        drawn = replace(drawn, joined=False)
    if samples and drawn.second == samples:
        return replace(drawn, mapped=False, sampled=True)
    return drawn


def _with_lines(study: xr.Dataset, variable: str, x: str, lines: str) -> Drawn:
    """What is drawn of a variable with a line for each value of a dimension; raises
    `ParameterError`."""
    dims = [str(dim) for dim in study[variable].dims]
    known = [dim for dim in dims if dim != x]
    bars = f"must be left out, because {variable} is drawn as bars"
    alone = f"must be a second dimension, but {variable} varies along {dims[0]} only"
    other = f"must be another dimension than x{suggestion(lines, known)}"
    require((variable not in SHARES, "lines", lines, bars))
    require((len(dims) > 1, "lines", lines, alone))
    require((lines in known, "lines", lines, other))
    across = x or next(dim for dim in dims if dim != lines)
    return replace(_chosen_axes(study, variable, across), mapped=False, counted=False)


def _with_few_lines(study: xr.Dataset, drawn: Drawn, x: str) -> Drawn:
    """What is drawn of a map: a line for each value of the dimension with fewest values, if these are
    few, and if it is not the one that a reader wants along the horizontal axis."""
    across, second = drawn.across, str(drawn.second)
    if not x and study.sizes[across] < study.sizes[second]:
        across, second = second, across
    if study.sizes[second] > FEW:
        return drawn
    return replace(drawn, across=across, second=second, mapped=False)


def _varying(study: xr.Dataset) -> xr.Dataset:
    """The study without dimensions of one value; but shares of starts of one case stay along their
    energies."""
    alone = (
        "basin_fraction" in study and study["basin_fraction"].size == study.sizes["attractor_class"]
    )
    kept = ("energy",) if alone else ()
    return without_single(study, *kept)


def _with_first_values(study: xr.Dataset) -> xr.Dataset:
    """The study with the first value at each point of the usual variable of its function, and what is
    known of this value."""
    name = OF_FUNCTIONS.get(function_of(study), "")
    if name not in FIRST_OF_SEVERAL or name not in study:
        return study
    firsts = {}
    for each in (name, *ALONG_EXPONENTS):
        dim = "exponent_number" if name == "exponent" else f"{each}_index"
        if each in study and dim in study[each].dims:
            firsts[each] = study[each].isel({dim: 0}, drop=True)
    if name not in firsts:  # one was selected
        return study
    attrs = {**firsts[name].attrs, "long_name": FIRST_OF_SEVERAL[name]}
    firsts[name] = firsts[name].assign_attrs(attrs)
    return study.drop_vars([*firsts]).assign(firsts)


def _with_one_horizon(study: xr.Dataset) -> xr.Dataset:
    """The study with the one horizon that was selected among those with which it was computed, as by
    ``study.sel(horizon=50)``."""
    if "horizon" not in study.coords or study["horizon"].ndim:
        return study
    options = stated_in(study, "options")
    options["horizon"] = study["horizon"].item()
    return study.assign_attrs(options=json.dumps(options))


def _ascending(study: xr.Dataset, samples: str) -> xr.Dataset:
    """The study with the numbers along its dimensions, but that of samples, in their order: lines
    would go back and forth, and cells of a map lie on each other. Those that are not finite have no
    place."""
    named = [name for name in study.dims if name in study.coords and name != samples]
    numbers = [name for name in named if study[name].dtype.kind in "fi"]
    placed = {name: np.isfinite(study[name].values) for name in numbers}
    return study.isel(placed).sortby(numbers)


def _without_stacks(study: xr.Dataset) -> xr.Dataset:
    """The study with several values along a dimension, as `xarray.Dataset.stack` gives them, as those of
    paired samples."""
    stacked = [
        dim for dim, index in study.indexes.items() if index.nlevels > 1 and dim in study.dims
    ]
    for dim in stacked:
        levels = study.indexes[dim]
        names = [*map(str, levels.names)]
        columns = {}
        for name in names:
            values = levels.get_level_values(name).to_numpy()
            columns[name] = (dim, values, study[name].attrs)
        study = study.drop_vars([dim, *names]).assign_coords(columns)
    return study


def _without_zeros(study: xr.Dataset) -> xr.Dataset:
    """The study with no number of events in a period where a motion is not shown to repeat, for which it
    has 0."""
    if "period_events" not in study:
        return study
    events = study["period_events"]
    words = str(events.attrs.get("long_name", "")).replace(", 0 if", ", nan if")
    shown = events.where(events > 0).assign_attrs({**events.attrs, "long_name": words})
    return study.assign(period_events=shown)


def _with_own_coordinates(study: xr.Dataset) -> xr.Dataset:
    """The study with the values along a dimension of its results as a coordinate where they are the same
    at all points, as after one of several sweeps in different steps was selected."""
    for name in map(str, study.data_vars):
        along = f"{name}_index"
        beside = [each for each in study.data_vars if along in study[each].dims]
        if along in study[name].dims and len(beside) > 1:
            study = _with_coordinate(study, name, along)
    return study


def _with_coordinate(study: xr.Dataset, name: str, along: str) -> xr.Dataset:
    """The study with a variable as the coordinate of a dimension, without places that have no value; as it
    is if the variable differs between points."""
    rows = study[name].transpose(..., along)
    table = rows.values.reshape(-1, study.sizes[along])
    if rows.dtype.kind not in "fi" or not np.array_equal(
        table, table[:1].repeat(len(table), 0), True
    ):
        return study
    known = np.isfinite(table[0].astype(float))
    kept = study.drop_vars(name).isel({along: known}).rename({along: name})
    return kept.assign_coords({name: (name, table[0][known], rows.attrs)})


def _with_words(study: xr.Dataset) -> xr.Dataset:
    """The study with words for True and False along its dimensions, and with names for discs, by their order
    and frequencies."""
    named: dict[Any, Any] = {}
    for name, values in study.coords.items():
        if values.dtype.kind == "b" and values.ndim == 1:
            answers = np.where(values, "yes", "no")
            named[name] = (values.dims, answers, {**values.attrs, **TRUTH})
        discs = [value for value in values.values.flat if isinstance(value, Disc)]
        if discs and values.ndim == 1:
            shown = [str(disc).removeprefix("Disc(").removesuffix(")") for disc in discs]
            words = [f"disc {i}: {text}" for i, text in enumerate(shown, start=1)]
            named[name] = (values.dims, words, values.attrs)
    return study.assign_coords(named)


def _paired(study: xr.Dataset, x: str) -> Paired:
    """The study along one of the columns of numbers that vary together, the first of them unless
    `x` is another, or their labels; or with a line for each sample if `x` is an axis beside them."""
    for dim in map(str, study.get("status", study).dims):
        columns = _columns_along(study, dim)
        if not columns:
            continue
        named = dim in study.coords
        beside = [name for name in _drawn_dims(study) if name != dim]
        if x in columns or not (named or x in beside):
            column = x or columns[0]
            rule = f"must be one of {', '.join([*columns, *beside])}"
            require((column in columns, "x", x, rule))
            return Paired(study.swap_dims({dim: column}), column=column)
        if not named:
            return Paired(study.swap_dims({dim: columns[0]}), samples=columns[0])
        if study[dim].dtype.kind in "UO":
            return Paired(study, samples=dim)
    return Paired(study)


def _columns_along(study: xr.Dataset, dim: str) -> list[str]:
    """The columns of numbers along a dimension of samples, those of the case first, and then of words."""
    beside = [
        str(name) for name, values in study.coords.items() if values.dims == (dim,) and name != dim
    ]
    numbers = [name for name in beside if study[name].dtype.kind in "fi"]
    numbers.sort(key=lambda name: _is_without_effect(study[name]))
    return [*numbers, *(name for name in beside if study[name].dtype.kind in "UO")]


def _is_without_effect(values: xr.DataArray) -> bool:
    """Whether numbers along samples are none of the case."""
    return WITHOUT_EFFECT.items() <= values.attrs.items()


def _drawn_dims(study: xr.Dataset) -> list[str]:
    """Dimensions of a study whose values are numbers of a quantity; words where there are none."""
    named = [str(dim) for dim in study.dims if dim in study.coords and dim not in COUNTED]
    numbers = [dim for dim in named if study[dim].dtype.kind in "fi"]
    if "status" not in study or not all(only_counts(study, dim) for dim in numbers):
        return numbers
    words = [dim for dim in named if dim in study["status"].dims and dim not in numbers]
    return [*words, *numbers]


def _usual_variable(study: xr.Dataset, choices: Sequence[str]) -> str:
    """The first of the variables preferred, or else of numbers, or of all others than whether points were
    computed, or of all; "" without any."""
    flat = [name for name in choices if study[name].ndim < 3]
    of_function = OF_FUNCTIONS.get(function_of(study), "")
    preferred = [name for name in (of_function, *PREFERRED) if name in flat]
    numeric = [name for name in flat if study[name].dtype.kind in "fi"]
    results = [name for name in flat if name not in OF_POINTS]
    return next(iter([*preferred, *numeric, *results, *choices]), "")


def _chosen_variable(study: xr.Dataset, variable: str) -> str:
    """The variable that is drawn; raises `ParameterError`."""
    choices = _choices(study)
    single = [name for name in choices if {*study[name].dims} <= {*study.coords}]
    results = [name for name in single if name not in OF_POINTS]
    chosen = variable or _usual_variable(study, results or choices)
    points = "must have two points or more along a number or a word"
    require((bool(_drawn_dims(study)), "study", "a single point", points))
    _refuse_complex(study, chosen)
    rule = f"must be one over the grid{suggestion(chosen, choices)}"
    further = _dims_without_coordinates(study, chosen)
    if further and chosen not in choices:
        rule = f"must not vary along {further[0]}: select one, as by study.isel({further[0]}=0)"
    require((chosen in choices, "variable", chosen, rule))
    _refuse_several_units(study, chosen)
    return chosen


def _choices(study: xr.Dataset) -> list[str]:
    """The variables that can be drawn: real ones along a number or a word of the grid."""
    drawn = {*_drawn_dims(study)}
    choices = []
    for name, values in study.items():
        along_grid = bool({*values.dims} & drawn)
        several = len(_dims_without_coordinates(study, str(name))) > 1
        at_points = {*study.get("status", values).dims} <= {*values.dims}
        if along_grid and at_points and values.dtype.kind != "c" and not several:
            choices.append(str(name))
    return choices


def _dims_without_coordinates(study: xr.Dataset, variable: str) -> list[Any]:
    """The dimensions of a variable that have no coordinate; none of what is no variable."""
    if variable not in study.data_vars:
        return []
    return [dim for dim in study[variable].dims if dim not in study.coords]


def _refuse_complex(study: xr.Dataset, variable: str) -> None:
    """Raise `ParameterError` if a variable has complex numbers."""
    real = variable not in study or study[variable].dtype.kind != "c"
    rule = f"is complex: draw a part of it, as by study.assign(size=abs(study.{variable}))"
    require((real, "variable", variable, rule))


def _refuse_several_units(study: xr.Dataset, variable: str) -> None:
    """Raise `ParameterError` if the values of a variable are of several parameters, in units of their own."""
    of_names = function_of(study) == "critical" and "name" in study[variable].dims
    no_unit = variable in ("value", "border") and "units" not in study[variable].attrs
    rule = "has another unit for each name: select one, as by study.isel(name=0)"
    require((not (of_names and no_unit), "variable", variable, rule))


def _chosen_axes(study: xr.Dataset, variable: str, x: str) -> Drawn:
    """The dimensions along which a variable is drawn; raises `ParameterError`."""
    dims = [str(dim) for dim in study[variable].dims]
    numbers = [dim for dim in dims if dim in _drawn_dims(study)]
    across = x or next((dim for dim in numbers if not only_counts(study, dim)), numbers[0])
    many = "must vary along at most two: select values of the others, as by study.sel(N=300)"
    require((len(dims) < 3, "study", ", ".join(dims), many))
    known = [*numbers, *(dim for dim in dims if dim in study.coords and dim not in numbers)]
    require((across in known, "x", across, f"must be one of {', '.join(known)}"))
    second = next((dim for dim in dims if dim != across), None)
    counted = second is not None and only_counts(study, second)
    drawn = Drawn(variable, across, second, mapped=False, counted=counted)
    return replace(drawn, mapped=not counted and _are_plane(study, drawn))


def _are_plane(study: xr.Dataset, drawn: Drawn) -> bool:
    """Whether a variable has two dimensions of numbers."""
    numbers = [dim for dim in (drawn.across, drawn.second) if dim in _drawn_dims(study)]
    return len(numbers) == 2 and all(study[dim].dtype.kind in "fi" for dim in numbers)


def only_counts(study: xr.Dataset, dim: str) -> bool:
    """Whether a dimension only counts the values that a variable has at a point, such as the samples
    of a Poincaré section."""
    if dim not in study.coords:
        return True
    return bool(COUNT.match(str(study[dim].attrs.get("long_name", ""))))


def values_of(study: xr.Dataset) -> dict[str, Any]:
    """The values of the case that do not vary in a study."""
    case = json.loads(study.attrs.get("base", study.attrs.get("parameters", "{}")))
    shown = {str(name).removeprefix("sweep_").removeprefix("scan_") for name in study.coords}
    fixed = {name: value for name, value in case.items() if name not in shown}
    for name, values in study.coords.items():
        if not values.ndim or values.size == 1:
            fixed[str(name)] = values.item()
    return fixed


def said_of(study: xr.Dataset) -> dict[str, str]:
    """Words for single values of what is no parameter and has a unit, such as a horizon."""
    said = {}
    for name, values in study.coords.items():
        if values.size == 1 and values.attrs.get("units", "1") != "1" and not known_name(values):
            stated = f"{name} = {value_text(study, str(name))}"
            said[str(name)] = option_text(str(name), values.item()) or stated
    return said


def title_of(study: xr.Dataset, drawn: Drawn, selected: Mapping[str, str]) -> str:
    """What does not vary in a study, and of paired samples, what varies beside the column over which
    they are drawn, and how many have no number there.

    selected : words for what was selected of the study
    """
    said = [what_case({**values_of(study), **stays_in(study)}, selected)]
    if drawn.sampled:
        said.append(_varies(_numbers_along(study, str(drawn.second))))
    else:
        said += _said_of_samples(study, drawn.across)
    return ", ".join(filter(None, said))


def _said_of_samples(study: xr.Dataset, column: str) -> Iterator[str]:
    """Yield what varies with a column of paired samples, and how many have no number in it."""
    beside = [name for name in _numbers_along(study, column) if name != column]
    if beside:
        yield f"{_varies(beside)} as well"
    missing = int(study[column].isnull().sum())
    if missing:
        yield f"{counted(missing, 'sample')} without {symbol_of(column)}"


def _numbers_along(study: xr.Dataset, dim: str) -> list[str]:
    """The names of numbers of the case along a dimension."""
    along = [str(name) for name, values in study.coords.items() if values.dims == (dim,)]
    numbers = [name for name in along if study[name].dtype.kind in "fi"]
    return [name for name in numbers if not _is_without_effect(study[name])]


def _varies(names: Sequence[str]) -> str:
    """What is said of numbers that vary between samples; "" of none."""
    if not names:
        return ""
    verb = "vary" if len(names) > 1 else "varies"
    return f"{' and '.join(map(symbol_of, names))} {verb}"
