"""What a picture of a sweep shows: which variable, over which of its dimensions."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import xarray as xr

from disc_model.data.swept_branches import is_of_sweep, selected_text
from disc_model.errors import Fault, ParameterError, require, rule_of_choice, suggestion
from disc_model.figures.separating_share import SHARE
from disc_model.figures.settled_motions import without_zeros
from disc_model.figures.shares_by_energy import OF_LINES, asks_for_lines, with_separating_shares
from disc_model.figures.sweep_dimensions import (
    columns_along,
    dims_without_coordinates,
    drawn_dims,
    only_counts,
    selection_for,
)
from disc_model.figures.sweep_options import function_of
from disc_model.figures.sweep_study import (
    OF_FUNCTIONS,
    ascending,
    in_common_units,
    with_first_values,
    with_one_horizon,
    with_own_coordinates,
    with_words,
    without_single_values,
    without_stacks,
)
from disc_model.figures.swept_lists import with_names_of_lists

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
OF_POINTS = ("status", "message")
"""Variables that say whether points were computed."""
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
    study = without_zeros(without_stacks(study))
    study = with_own_coordinates(study)
    if asks_for_lines(study, variables[0], lines):
        study, variables = with_separating_shares(study), [SHARE]
    if not variables[0]:
        study = with_first_values(study)
    whole = without_single_values(with_words(study))
    paired = _paired(with_one_horizon(whole), x)
    varying = paired.study
    if not paired.column:
        varying = ascending(varying, paired.samples)

    if points:
        drawn = [_as_points(varying, each, paired.column or x) for each in variables]
    else:
        drawn = [_drawn(paired._replace(study=varying), each, x, lines) for each in variables]
    for each in drawn[1:]:
        alike = each.is_line and drawn[0].is_line and each.across == drawn[0].across
        rule = "must be lines over the same dimension to be drawn together"
        require((alike, "variable", each.variable, rule))
    varying = with_names_of_lists(varying, drawn[0].second)
    return in_common_units(varying, variables), drawn


def _as_points(study: xr.Dataset, variable: str, x: str) -> Drawn:
    """What is drawn of a variable, as points: all of a second dimension at each place along the first."""
    drawn = _chosen_axes(study, _chosen_variable(study, variable), x)
    if drawn.variable in SHARES:
        raise ParameterError(Fault(("points",), "", f"{drawn.variable} is drawn as bars"))
    counted = drawn.second is not None
    return replace(drawn, mapped=False, joined=False, sampled=False, counted=counted)


def _refuse_branches(study: xr.Dataset) -> None:
    """Raise `ParameterError` for branches of a sweep, each of which has points of its own."""
    if not is_of_sweep(study):
        return
    branch = f"disc_model.Branch.from_dataset({selected_text(study, 'study')})"
    rule = f"holds branches: draw one by {branch}.plot()"
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


def _paired(study: xr.Dataset, x: str) -> Paired:
    """The study along one of the columns of numbers that vary together, the first of them unless
    `x` is another, or their labels; or with a line for each sample if `x` is an axis beside them."""
    for dim in map(str, study.get("status", study).dims):
        columns = columns_along(study, dim)
        if not columns:
            continue
        named = dim in study.coords
        beside = [name for name in drawn_dims(study) if name != dim]
        if x in columns or not (named or x in beside):
            column = x or columns[0]
            rule = rule_of_choice(x, [*columns, *beside])
            require((column in columns, "x", x, rule))
            return Paired(study.swap_dims({dim: column}), column=column)
        if not named:
            return Paired(study.swap_dims({dim: columns[0]}), samples=columns[0])
        if study[dim].dtype.kind in "UO":
            return Paired(study, samples=dim)
    return Paired(study)


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
    require((bool(drawn_dims(study)), "study", "a single point", points))
    _refuse_complex(study, chosen)
    rule = f"must be one over the grid{suggestion(chosen, choices)}"
    further = dims_without_coordinates(study, chosen)
    if further and chosen not in choices:
        rule = f"must not vary along {further[0]}: select one, as by study.isel({further[0]}=0)"
    require((chosen in choices, "variable", chosen, rule))
    _refuse_several_units(study, chosen)
    return chosen


def _choices(study: xr.Dataset) -> list[str]:
    """The variables that can be drawn: real ones along a number or a word of the grid."""
    drawn = {*drawn_dims(study)}
    choices = []
    for name, values in study.items():
        along_grid = bool({*values.dims} & drawn)
        several = len(dims_without_coordinates(study, str(name))) > 1
        at_points = {*study.get("status", values).dims} <= {*values.dims}
        if along_grid and at_points and values.dtype.kind != "c" and not several:
            choices.append(str(name))
    return choices


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
    numbers = [dim for dim in dims if dim in drawn_dims(study)]
    across = x or next((dim for dim in numbers if not only_counts(study, dim)), numbers[0])
    if len(dims) > 2:
        raise ParameterError(
            Fault.of(("study",), ", ".join(dims), _rule_of_many(study, variable, x))
        )
    known = [*numbers, *(dim for dim in dims if dim in study.coords and dim not in numbers)]
    require((across in known, "x", across, _rule_of_axis(study, across, known)))
    second = next((dim for dim in dims if dim != across), None)
    counted = second is not None and only_counts(study, second)
    drawn = Drawn(variable, across, second, mapped=False, counted=counted)
    return replace(drawn, mapped=not counted and _are_plane(study, drawn))


def _rule_of_many(study: xr.Dataset, variable: str, x: str) -> str:
    """The rule that a variable breaks which varies along more dimensions than a picture has."""
    selection = selection_for(study, variable, x)
    rule = f"must vary along at most two: select values of the others, as by {selection}"
    return f"{rule}, {OF_LINES}" if variable == SHARES[0] else rule


def _rule_of_axis(study: xr.Dataset, x: str, known: Sequence[str]) -> str:
    """The rule that a name breaks which is no dimension of what is drawn: it is one of the known ones, or one
    of a variable of more dimensions than a picture has."""
    for name in (*PREFERRED, *_choices(study)):
        if name in study and x in study[name].dims and study[name].ndim > 2:
            selection = selection_for(study, name, x)
            first = f"select one value of each other axis first, as by {selection}"
            return f"is an axis of {name}: {first}"
    return rule_of_choice(x, known)


def _are_plane(study: xr.Dataset, drawn: Drawn) -> bool:
    """Whether a variable has two dimensions of numbers."""
    numbers = [dim for dim in (drawn.across, drawn.second) if dim in drawn_dims(study)]
    return len(numbers) == 2 and all(study[dim].dtype.kind in "fi" for dim in numbers)
