"""Selection of what a figure shows from a study or a case. Nothing here draws."""

from collections.abc import Mapping, Sequence
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np
import xarray as xr

from disc_model.data import dataset
from disc_model.data.swept_speeds import ENDS, ONSETS, has_settled, number_swept, swept_speeds
from disc_model.data.variables import EXCLUDED, Outcome, flag_names, stated_in
from disc_model.figures.classes import (
    GROWING,
    NOT_CONVERGED,
    UNKNOWN_STARTS,
    UNSETTLED,
    Look,
    name_of,
)
from disc_model.figures.kinds.base import NORM, key_of
from disc_model.figures.types import Array, Mask, Words
from disc_model.figures.unknown_starts import class_of_starts, rest_on_unknown
from disc_model.figures.value_texts import named_value, rank_of, value_text
from disc_model.figures.words import INFINITE, MINUS_INFINITE, NO_VALUE, VANISHING, WORDS

WITHOUT_CYCLE = (
    "no_cycle",
    "separates",
    "no_stick_slip",
    "steady_sliding",
    "unstable_sliding",
    "at_rest",
)
"""Statuses of points that were computed, and have no stick-slip cycle."""
ROUNDING = 1e-9
"""Relative difference of equal speeds in files."""
TIME_OF_SEPARATION = "first_separation"
"""Variable of a simulation, which some samples are without."""
NOT_SIMULATED = "not_simulated"
"""Outcome of a sample whose motion was not simulated."""
OF_STAYS = (
    "range",
    "u_min",
    "u_max",
    "P_min",
    "P_max",
    "stick_fraction",
    "slip_fraction",
    "separation_fraction",
    "separation_rate",
    "sweep_range",
    "sweep_separation_rate",
)
"""Variables that describe the motion at the end of each stay of a sweep of the speed."""
SAMPLED = ("psi", "psi_velocity", "P", "u", "w_point")
"""Samples of motions after a transient."""
OF_CYCLES = (
    "growth_rate",
    "period",
    "stick_fraction",
    "stick_time",
    "slip_time",
    "multiplier_re",
    "multiplier_im",
    "stick_slip_frequency",
    "cycle_frequency",
    "cycle_growth_rate",
)
"""Variables of a cycle."""

OF_SLIDING_MODES = ("sliding_frequency", "sliding_growth_rate", "forward_wave_fraction")
"""Variables of the modes of steady sliding, which need no cycle."""
ALONE = 0.1
"""Half the width of a cell over its value, where this is the only one along an axis."""

AVERAGES = ("exponent", "exponents")
"""Variables that are averages over a time, which may be too short."""

Data = TypeVar("Data", xr.Dataset, xr.DataArray)


class Part(NamedTuple, Generic[Data]):
    """A part of a study or of a variable, in a panel or a line of its own: what sets it apart, with
    the name of the dimension and without, and its data."""

    name: str
    value: str
    data: Data


def has_values(planes: Sequence[xr.Dataset], variable: str) -> bool:
    """Whether any of several datasets has a number: without one, the ends of a scale would be made
    up."""
    return any(bool(np.isfinite(plane[variable]).any()) for plane in planes)


# ---- Parts of a study


def picked(study: xr.Dataset, values: Mapping[str, float | str], *kept: str) -> xr.Dataset:
    """A grid study at values of some dimensions; dimensions of one value are dropped, but those that
    are kept."""
    words: dict[str, str] = {}
    numbers: dict[str, Any] = {}
    for dim, value in values.items():
        if study[dim].dtype.kind in "iufM":
            numbers[dim] = value
        else:
            known = {key_of(text): str(text) for text in study[dim].values}
            words[dim] = known.get(key_of(value), str(value))
    return without_single(study.sel(words).sel(numbers, method="nearest"), *kept)


def without_single(study: xr.Dataset, *kept: str) -> xr.Dataset:
    """A study without dimensions of one value, but those that are kept."""
    single = [dim for dim, size in study.sizes.items() if size == 1 and dim not in kept]
    return study.squeeze(single)


def normalizations(study: xr.Dataset) -> list[str]:
    """Normalizations for which a grid study has values."""
    if NORM in study.coords:
        return [str(name) for name in np.atleast_1d(study[NORM].values)]
    base = stated_in(study, "base")
    if base.get("disc") or "disc" in study.coords:
        return ["given"]
    return [base[NORM]]


def of(study: xr.Dataset, normalization: str) -> xr.Dataset:
    """Values of a grid study for one normalization."""
    if NORM in study.dims:
        return study.sel({NORM: normalization})
    return study


def parts_along(
    study: Data, by: str | None, words: Mapping[str, str] | None = None
) -> list[Part[Data]]:
    """The parts of a study, or of a variable, along a dimension, in order: words as in `WORDS`, or
    by the number that they begin with; samples with names as they stand in their table. The whole
    without a dimension.

    words : other words for values along the dimension
    """
    if by is None or by not in study.dims:
        return [Part("", "", study)]
    # a zip has several coordinates
    names = [str(name) for name, values in study.coords.items() if values.dims == (by,)]
    slices = [study.isel({by: i}) for i in range(study.sizes[by])]
    parts = _named_parts(slices, by, names, words or {})
    if len(names) > 1 and any(_are_labels(study[name]) for name in names):
        return parts
    return sorted(parts, key=lambda part: _rank(part.data, by, names, words or {}))


def _named_parts(
    slices: Sequence[Data], by: str, names: Sequence[str], words: Mapping[str, str]
) -> list[Part[Data]]:
    """Parts with short names, or with longer ones where these are alike, as lines are known by them."""
    parts = [_part(data, by, names, words, short=True) for data in slices]
    if len({part.name for part in parts}) == len(parts):
        return parts
    return [_part(data, by, names, words) for data in slices]


def _are_labels(values: xr.DataArray) -> bool:
    """Whether values are words that a reader gives samples, and none of parameters."""
    return values.dtype.kind in "UO" and not {*map(str, values.values)} <= {*WORDS}


def _part(
    data: Data, by: str, names: Sequence[str], words: Mapping[str, str], *, short: bool = False
) -> Part[Data]:
    """A part with its names, by its values along some coordinates; words stand for themselves."""
    named = []
    values = []
    for one in names:
        word = _word(data, one, by, words)
        named.append(word or named_value(data, one, short=short))
        values.append(word or value_text(data, one, short=short))
    return Part(", ".join(named), ", ".join(values), data)


def _rank(data: Data, by: str, names: Sequence[str], words: Mapping[str, str]) -> list[Any]:
    """The place of a part among others."""
    return [rank_of(_word(data, one, by, words) or data[one].item()) for one in names]


def _word(data: Data, name: str, by: str, words: Mapping[str, str]) -> str:
    """The word that a file gives for the value along a dimension, "" without one."""
    return words.get(key_of(data[by].item()), "") if name == by else ""


def titles_of(parts: Sequence[Part[Any]]) -> list[str]:
    """Titles of the panels of parts: the dimension is named in the first one only. A single part
    has none, since it stands in the figure's title."""
    if len(parts) < 2:
        return [""]
    first, *others = parts
    return [first.name, *(part.value for part in others)]


def alike(data: xr.Dataset, part: xr.Dataset, by: str) -> xr.Dataset:
    """A further study with the value of a dimension, and the normalization, that a part of the
    first study has."""
    for dim in dict.fromkeys([by, NORM]):
        if dim not in data.dims:
            continue
        known = part.coords.get(dim)
        data = data.sel({dim: normalizations(part)[0] if known is None else known.item()})
    return data


def common_points(data: xr.Dataset, other: xr.Dataset, names: Sequence[str]) -> list[xr.Dataset]:
    """Two studies at the values of some dimensions that both have."""
    for name in names:
        same = np.isclose(data[name].values[:, None], other[name].values, rtol=1e-9, atol=0)
        data = data.isel({name: same.any(axis=1)})
        other = other.isel({name: same.any(axis=0)})
    return [data, other]


def remaining(array: xr.DataArray, axes: Sequence[str]) -> str | None:
    """The dimension that is on no axis, if there is one."""
    return next((str(name) for name in array.dims if name not in axes), None)


# ---- Points without a value


def statuses(study: xr.Dataset) -> xr.DataArray:
    """The status of each point of a grid study, as a word; "ok" without one, and `EXCLUDED` where
    xarray's where has masked it.

    A motion that never sticks again is "steady_sliding" or "unstable_sliding" where the study knows
    the growth rate of steady sliding.
    """
    if "status" not in study:
        return xr.DataArray("ok")
    words = study["status"].copy(data=flag_names(study["status"]).astype(object))
    words = words.where(words != "", EXCLUDED)
    name = "sliding_growth_rate"
    if f"largest_{name}" in study:  # that of all modes, which need not all be in the study
        name = f"largest_{name}"
    if name in study:
        rate = study[name]
        largest = rate.max([dim for dim in rate.dims if dim not in words.dims])
        slides = words == "no_stick_slip"
        words = words.where(~(slides & (largest < 0)), "steady_sliding")
        words = words.where(~(slides & (largest >= 0)), "unstable_sliding")
    return words.astype(str)


def statuses_of(study: xr.Dataset, array: xr.DataArray) -> xr.DataArray:
    """The status of each point as far as a variable depends on it: modes of steady sliding need no
    cycle, and samples with a status of "ok" may be without one, or not simulated."""
    words = statuses(study)
    name = str(array.name)
    if name in OF_SLIDING_MODES and "mode" in array.dims:
        return words.where(~words.isin(WITHOUT_CYCLE), "ok")
    if name == TIME_OF_SEPARATION:
        return _with_flag(words, study.get("outcome"), (NOT_SIMULATED,))
    return words


def _with_flag(
    words: xr.DataArray, flag: xr.DataArray | None, chosen: Sequence[str]
) -> xr.DataArray:
    """Statuses with some words of a flag of the same points in place of "ok"."""
    if flag is None or {*flag.dims} != {*words.dims} or "flag_meanings" not in flag.attrs:
        return words
    of_flag = flag.copy(data=flag_names(flag)).transpose(*words.dims)
    return words.where(~((words == "ok") & of_flag.isin(chosen)), of_flag)


def statuses_like(study: xr.Dataset, array: xr.DataArray) -> Words:
    """The status of each point, in the shape of a variable of the study."""
    words = statuses_of(study, array).broadcast_like(array).transpose(*array.dims)
    return np.asarray(words.values, dtype=str)


def shown_words(flag: xr.DataArray, status: xr.DataArray) -> xr.DataArray:
    """The words of a flag, those of a gap where it has none, and `EXCLUDED` at points that a study's
    rule leaves out."""
    words = flag.copy(data=flag_names(flag).astype(object))
    if (words == "").any():
        gaps_of = np.vectorize(class_of_gap, otypes=[object])
        words = words.where(words != "", xr.apply_ufunc(gaps_of, status))
    return words.where(status != EXCLUDED, EXCLUDED).astype(str).transpose(*flag.dims)


def failed(study: xr.Dataset) -> xr.DataArray:
    """Points of a grid study that failed."""
    return statuses(study) != "ok"


def class_of_gap(status: str) -> str:
    """The class of a point without a value: its status, "failed" for a failure of the computation,
    and "no_value" for a point that was computed."""
    if status == "ok":
        return NO_VALUE
    if status in (*WITHOUT_CYCLE, EXCLUDED, NOT_SIMULATED):
        return status
    return "failed"


def classes_of_gaps(study: xr.Dataset, array: xr.DataArray) -> Words:
    """The class of each point at which a variable has no number, "" where it has one."""
    status = statuses_like(study, array)
    gone = ~np.isfinite(array.values.astype(float)) | (status == EXCLUDED)
    classes = np.vectorize(class_of_gap, otypes=[str])(status)
    of_starts = class_of_starts(study, str(array.name))
    if of_starts is not None:
        words = of_starts.broadcast_like(array).transpose(*array.dims).values
        classes = np.where((classes == NO_VALUE) & (words != ""), words, classes)
    infinite = classes_of_infinite(array)
    classes = np.where((status == "ok") & (infinite != ""), infinite, classes)
    return np.where(gone, classes, "")


def classes_of_infinite(variable: xr.DataArray) -> Words:
    """The class of each point at which a variable has an infinite value, "" elsewhere."""
    values = variable.values.astype(float)
    below = VANISHING if str(variable.name).endswith("growth_rate") else MINUS_INFINITE
    classes = np.where(np.isposinf(values), INFINITE, "")
    return np.where(np.isneginf(values), below, classes)


def gaps(study: xr.Dataset, variable: xr.DataArray) -> dict[str, xr.DataArray]:
    """Points where a variable has no value, by the name of their class; without those that a rule
    excludes."""
    words = statuses_of(study, variable)
    of_starts = class_of_starts(study, str(variable.name))
    if of_starts is not None:
        words = words.where((words != "ok") | (of_starts == ""), of_starts)
    gone = variable.isnull()
    masks: dict[str, xr.DataArray] = {}
    for word in map(str, np.unique(words)):
        here = gone & (words == word)
        if word == EXCLUDED or not here.any():
            continue
        name = name_of(word if word == Outcome.UNDECIDED else class_of_gap(word))
        masks[name] = here | masks.get(name, False)
    return masks


def at_lower_bound(study: xr.Dataset, variable: str) -> xr.DataArray | None:
    """Points whose critical value is the lower bound of its search, and may lie below; None of other
    variables."""
    if variable == "value" and "at_lower_bound" in study:
        return study["at_lower_bound"] == 1
    if variable == "critical_speed" and "scan_Omega" in study:
        speeds = study["scan_Omega"]
        lowest = speeds.min(str(speeds.dims[-1]))  # scans may have bounds of their own
        return study[variable] <= lowest * (1 + ROUNDING)
    return None


def border_alone(study: xr.Dataset, variable: str) -> xr.DataArray | None:
    """1 at points whose critical value is the border of stability, as there is no unstable range before
    it, 0 at others, nan at those without a critical value or with one that may lie below; None of
    other variables and studies."""
    if variable != "value" or "border" not in study:
        return None
    value = study[variable]
    alone = (value == study["border"]).where(value.notnull())
    at_bound = at_lower_bound(study, variable)
    return alone if at_bound is None else alone.where(~at_bound)


def unstable_everywhere(study: xr.Dataset, variable: str) -> xr.DataArray | None:
    """Points of a search at which the motion is unstable at all values, so that it has no border of
    stability; None of other variables."""
    if variable != "border" or not {"at_lower_bound", "crossings"} <= {*study}:
        return None
    along = [dim for dim in study["crossings"].dims if dim not in study["at_lower_bound"].dims]
    crosses = study["crossings"].notnull().any(along)
    return (study["at_lower_bound"] == 1) & ~crosses


def beyond_lowest_speed(study: xr.Dataset, variable: str) -> xr.DataArray | None:
    """Points of sweeps of the speed at which contact is lost at the lowest speed already, or still, so
    that separation begins or ends at a lower one; None of other variables."""
    is_swept = "separation_rate" in study and number_swept(study)
    if variable not in (*ONSETS, *ENDS) or not is_swept:
        return None
    swept = swept_speeds(study)
    return swept.onset_at_bound if variable in ONSETS else swept.end_at_bound


def unsettled(study: xr.Dataset, variable: str) -> xr.DataArray | None:
    """Points of sweeps of the speed whose value describes, or rests on, a motion that had not settled
    when its stay ended, and samples of such motions; None of other variables."""
    if variable in SAMPLED and "settled" in study:
        late = study["settled"].copy(data=flag_names(study["settled"]) == "settled")
        return ~late.broadcast_like(study[variable])
    if "sweep_settled" not in study:
        return None
    dims = {*study["sweep_settled"].dims}
    if variable in OF_STAYS and dims <= {*study[variable].dims}:
        return ~has_settled(study) & study[variable].notnull()
    name = number_swept(study)
    of_sweeps = {"direction", *study[f"sweep_{name}"].dims[-1:]} if name else set()
    if variable in (*ONSETS, *ENDS) and of_sweeps and dims >= of_sweeps:
        swept = swept_speeds(study)
        return swept.onset_unsettled if variable in ONSETS else swept.end_unsettled
    return None


def still_growing(study: xr.Dataset, variable: str) -> xr.DataArray | None:
    """Points whose value describes the end of a motion that still grows or is undecided at the horizon;
    None of other variables and studies."""
    if not {variable, "outcome"} <= {*study}:
        return None
    outcome = study["outcome"]
    is_late = "the late stretch" in str(study[variable].attrs.get("long_name", ""))
    if not is_late or not {*outcome.dims} <= {*study[variable].dims}:
        return None
    open_end = np.isin(flag_names(outcome), (Outcome.GROWING, Outcome.UNDECIDED))
    return outcome.copy(data=open_end).broadcast_like(study[variable]) & study[variable].notnull()


def companion_of(study: xr.Dataset, variable: str, name: str) -> xr.DataArray | None:
    """Another variable of the points of a variable, along the dimensions of this one; None if a study does
    not have it for them."""
    if name not in study:
        return None
    found = study[name]
    index = f"{variable}_index"
    own = f"{name}_index"
    if own in found.dims and study.sizes[own] == study.sizes.get(index):
        found = found.rename({own: index})
    return found if {*found.dims} == {*study[variable].dims} else None


def not_converged(study: xr.Dataset, variable: str) -> xr.DataArray | None:
    """Points whose value is an average over a time that was too short for it; None of other variables
    and studies."""
    if variable not in AVERAGES:
        return None
    converged = companion_of(study, variable, "converged")
    if converged is None:
        return None
    if converged.dtype.kind in "UO" or "flag_meanings" in converged.attrs:
        return converged.copy(data=flag_names(converged) == "no")
    return converged == 0


def doubts(study: xr.Dataset, variable: str) -> dict[Look, xr.DataArray]:
    """Points whose value is another than that of a settled motion from the static start may be, by the
    look that says why."""
    masks = {
        UNSETTLED: unsettled(study, variable),
        GROWING: still_growing(study, variable),
        UNKNOWN_STARTS: rest_on_unknown(study, variable),
        NOT_CONVERGED: not_converged(study, variable),
    }
    return {look: mask for look, mask in masks.items() if mask is not None and mask.any()}


# ---- Stretches along an axis


def edges(values: Array) -> Array:
    """Edges of cells around ascending values: halfway between neighbours, and the first and last
    value; on both sides of a single one."""
    if values.size == 1:
        around = ALONE * np.abs(values) + (values == 0)
        return np.concatenate([values - around, values + around])
    between = 0.5 * (values[1:] + values[:-1])
    return np.concatenate([values[:1], between, values[-1:]])


def stretches(mask: np.ndarray) -> list[tuple[int, int]]:
    """Runs of True: index of the first element, and the index after the last."""
    borders = np.flatnonzero(np.diff(np.concatenate([[0], mask, [0]])))
    return [(first, after) for first, after in borders.reshape(-1, 2).tolist()]


def spans(along: Array, mask: np.ndarray) -> list[tuple[float, float]]:
    """Ranges of ascending values in which a mask holds, up to halfway to their neighbours."""
    borders = edges(along).tolist()
    return [(borders[first], borders[after]) for first, after in stretches(mask)]


def broken(x: Array, y: Array, jump: float, height: Array | None = None) -> list[Array]:
    """A line with gaps where its height, y unless given, changes by more than `jump`."""
    heights = y
    if height is not None:
        heights = height
    return opened(x, y, np.abs(np.diff(heights)) > jump)


def opened(x: Array, y: Array, steps: Mask) -> list[Array]:
    """A line with gaps at some of the steps between its points, of which there is one fewer."""
    places = np.flatnonzero(steps) + 1
    return [np.insert(values.astype(float), places, np.nan) for values in (x, y)]


# ---- Windows of a case


def history(case: xr.DataTree, window: str = "history", until: float | None = None) -> xr.Dataset:
    """Ranges in a window, up to a time in s; two bins define the bin width."""
    ranges = dataset.samples(case, window, envelope=True)
    shown = ranges.sel(time=slice(until))
    if shown.sizes["time"] < 2:
        return ranges
    return shown


def titles_of_shown(study: xr.Dataset, array: xr.DataArray, by: str | None) -> dict[str, str]:
    """What the legend calls each line, by the names of lines; without those of which all points are left
    out."""
    included = array.copy(data=statuses_like(study, array) != EXCLUDED)
    parts = parts_along(included, by)
    shown = [part for part in parts if part.data.any()]
    if len(parts) > 1 and len(shown) == 1:
        return {part.name: part.name for part in shown}
    names = [part.name for part in shown]
    return dict(zip(names, titles_of(shown), strict=True))
