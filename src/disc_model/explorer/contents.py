"""Contents of studies for the explorer's page: numbers packed for JSON, words as they are."""

from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from disc_model.data.variables import SHOWN, attributes, stated_in
from disc_model.display import counted
from disc_model.explorer.beginning import usual_place
from disc_model.explorer.curves import bounds_and_doubts, open_along
from disc_model.explorer.marks import marked_cells
from disc_model.explorer.modes import looks_of_modes
from disc_model.explorer.packing import packed
from disc_model.explorer.padding import without_padding
from disc_model.explorer.rules import rule_of
from disc_model.explorer.sampled import marks_of_samples, strip_of_kinds
from disc_model.explorer.untimed import classes_without_time, looks_without_time
from disc_model.figures.classes import AT_BOUND, LOOKS, Look, looks_of
from disc_model.figures.colours import growth_norm, is_growth
from disc_model.figures.curve_marks import reason_of_open_steps
from disc_model.figures.durations import with_duration
from disc_model.figures.growth import MAP_LOOKS, NEGATIVE, NEUTRAL, classes_without_rate
from disc_model.figures.missing_texts import missing_text
from disc_model.figures.selection import classes_of_gaps, statuses
from disc_model.figures.truths import as_classes
from disc_model.figures.value_texts import BY_SIZE, value_text
from disc_model.figures.words import (
    NO_VALUE,
    UNITS,
    WORDS,
    factors_of,
    known_name,
    lowered,
    named,
    unit_key,
    unit_text,
)
from disc_model.parameters import RATIOS, Parameters

TRACES = ("P", "u", "psi")
ORIGINS = {"u": "from the undeformed disc"}
"""From where the numbers of a history count: others of the slider's height, as of its range, count from
static equilibrium."""
CONFIDENCE = 0.95  # of intervals, where a quantity has no option of it
LEVELS = 65535  # steps between the least and the greatest value of a stored history
NAMED_BY: Mapping[str, Mapping[str, str]] = {
    "branches": {"value": "parameter", "sweep_value": "parameter"},
    "stability_curves": {"x": "x", "y": "y"},
}
"""Variables and dimensions with values of a parameter that an option of their quantity names."""
IN_A_SENTENCE: Mapping[tuple[str, str], str] = {
    ("contact", "unilateral"): "unilateral contact",
    ("contact", "bilateral"): "bilateral contact",
    ("friction_offset", "surface"): "friction on the surface",
    ("contact_compliance", "residual"): "residual flexibility",
}
"""Words of parameters that do not say by themselves what they are of."""


OF_SIMULATED_TIME = (
    "It is the time that was simulated to know the outcome, and not that of the motion, which a call has as "
    "time_reached: departures that were extrapolated are left out, and what was simulated twice counts twice."
)
REMARKS: Mapping[tuple[str, str], str] = MappingProxyType(
    {("regions", "simulated_time"): OF_SIMULATED_TIME}
)
"""What the page says of variables that are easily taken for others."""


class Stated(NamedTuple):
    """What a study's file and its quantity state, beside its dataset.

    Attributes
    ----------
    motion : what its stored motions are
    motion_by : the same more exactly, by the outcome or kind of a point, or the stability of its cycle
    call : how its points are computed in Python, as `disc_model.studies.point_calls.Call.plain`
    units : units of its figures, by parameter
    axes : dimensions across and up in its first figure that has both
    variable : the variable of its first figure that shows one, "" without
    at : values of its figures along dimensions that they do not show, those of earlier ones first
    has_figures : whether there is a figure of it
    tables : files of its discs, by their names along an axis; "" is that of all points
    """

    motion: str = ""
    call: Mapping[str, Any] = MappingProxyType({})
    units: Mapping[str, str] = MappingProxyType({})
    has_figures: bool = True
    axes: Sequence[str] = ()
    variable: str = ""
    at: Mapping[str, Any] = MappingProxyType({})
    motion_by: Mapping[str, str] = MappingProxyType({})
    tables: Mapping[str, str] = MappingProxyType({})


NOTHING_STATED = Stated()
NO_CALL: Mapping[str, Any] = MappingProxyType(
    {
        "quantity": "",
        "options": {},
        "columns": [],
        "recipes": [],
        "begins": {},
        "along": {},
        "headlines": [],
    }
)
"""A call of which nothing is stated: the point's case alone."""


def study_contents(
    name: str, study: xr.Dataset, motions: xr.Dataset | None = None, stated: Stated = NOTHING_STATED
) -> dict[str, Any]:
    """Contents of a merged study, in the units of its figures: fixed parameters, dimensions,
    variables, messages, motions."""
    token = UNITS.set(factors_of(stated.units))
    try:
        return _study_contents(name, study, motions, stated)
    finally:
        UNITS.reset(token)


def _study_contents(
    name: str, study: xr.Dataset, motions: xr.Dataset | None, stated: Stated
) -> dict[str, Any]:
    """Contents of a merged study, in the units that are set."""
    endless = _endless(study)
    study = without_padding(study.transpose(*study.sizes))
    study = _as_texts(_with_parameters(study), endless)
    shown_motions = None
    if motions is not None:
        shown_motions = motion_contents(_as_texts(motions, endless), stated.motion)
        shown_motions["text_by"] = dict(stated.motion_by)
    base = stated_in(study, "base")
    drawn = [x for x in study.data_vars.values() if x.size and x.ndim and x.dtype.kind in "biuf"]
    call = {**NO_CALL, **stated.call}
    # numbers of a point's case
    exact = {name for names in call["along"].values() for name in names}
    exact.add(call.get("sampled", ""))
    return {
        "name": name,
        "title": str(study.attrs.get("title", "")) or name,
        "call": call,
        "discs": stated_in(study, "discs"),
        "tables": dict(stated.tables),
        "start": _start_of_all(study),
        "where": rule_of(study),
        "confidence": _confidence(study),
        "has_figures": stated.has_figures,
        "axes": [name for name in stated.axes if name in study.sizes],
        "first": stated.variable,
        "fixed": [_fixed(parameter, value) for parameter, value in base.items()],
        "dims": [_dimension(study, str(dim), stated.at) for dim in _filled(study)],
        "variables": [_variable(study, x, exact=str(x.name) in exact) for x in drawn],
        "samples": marks_of_samples(study),
        "kinds": strip_of_kinds(study),
        "modes": looks_of_modes(study),
        "messages": _messages(study),
        "motions": shown_motions,
    }


def _filled(study: xr.Dataset) -> list[str]:
    """The dimensions of a study along which it has any place."""
    return [str(dim) for dim, size in study.sizes.items() if size]


def _with_parameters(study: xr.Dataset) -> xr.Dataset:
    """A study whose values of a parameter have the name and unit of it."""
    options = stated_in(study, "options")
    named_by = NAMED_BY.get(str(study.attrs.get("quantity", "")), {})
    known = (*Parameters.model_fields, *RATIOS)
    renamed = {}
    for name, option in named_by.items():
        parameter = options.get(option, "")
        if name in study and parameter in known:
            units = attributes(parameter).get("units", "")
            renamed[name] = study[name].assign_attrs(units=units, long_name=parameter)
    coordinates = {name: x for name, x in renamed.items() if name in study.coords}
    others = {name: x for name, x in renamed.items() if name not in study.coords}
    return study.assign_coords(coordinates).assign(others)


def _endless(study: xr.Dataset) -> list[str]:
    """Coordinates of numbers that are infinite somewhere."""
    numbers = {str(name): x for name, x in study.coords.items() if x.dtype.kind == "f"}
    return [name for name, x in numbers.items() if np.isinf(x.values).any()]


def _start_of_all(study: xr.Dataset) -> dict[str, Any]:
    """The start of a study's motions in its options, to which the start of a point is added."""
    options = stated_in(study, "options")
    return {name: options[name] for name in ("prerun", "perturbation") if options.get(name)}


def _confidence(study: xr.Dataset) -> float:
    """The level of the confidence intervals of shares, of studies that have any."""
    options = stated_in(study, "options")
    return float(options.get("confidence", CONFIDENCE))


def _fixed(name: str, value: Any) -> dict[str, Any]:
    """A parameter that a study does not vary, its value in SI and as it is shown, and whether a case
    has this value unless it is given."""
    field = Parameters.model_fields.get(name)
    usual = field is not None and value in (field.default, str(field.default))
    attrs = attributes(name)
    _, factor = _unit_of(xr.DataArray(0.0, name=name, attrs=attrs))
    shown: Any = value
    match value:
        case int() | float():
            shown = value * factor
        case str():
            shown = _word(name, value)
        case Mapping():  # a disc, of which the page has the call
            shown = counted(len(value["omega"]), "mode")
    return {**_named(name, attrs), "value": value, "shown": shown, "usual": usual}


def _messages(study: xr.Dataset) -> dict[str, Any] | None:
    """Messages of a study's points, as indices into the distinct ones; most points share theirs."""
    if "message" not in study:
        return None
    messages = study["message"]
    words, indices = np.unique(messages.values.astype(str), return_inverse=True)
    return {"dims": [*messages.dims], "words": words.tolist(), "data": packed(indices, "<u4")}


def _as_texts(dataset: xr.Dataset, names: Sequence[str]) -> xr.Dataset:
    """A dataset with some of its coordinates as texts, because JSON has no infinity."""
    texts = {}
    for name in names:
        coordinate = dataset[name]
        words = [f"{value:.12g}" for value in coordinate.values]
        texts[name] = (coordinate.dims, words, coordinate.attrs)
    return dataset.assign_coords(texts)


def motion_contents(motions: xr.Dataset, text: str = "") -> dict[str, Any]:
    """Histories along `point` and `sample` with 16 bits per sample, phases as runs; failed ones are
    left out."""
    good = motions.isel(point=np.flatnonzero(motions["status"].values == 0))
    names = [str(name) for name in good.coords if good[name].dims == ("point",)]
    return {
        "text": text,
        "names": names,
        "samples": good.sizes["sample"],
        "phases": good["phase"].attrs["flag_meanings"].split(),
        "traces": [_trace(good[name]) for name in TRACES],
        "points": [_motion(good.isel(point=i), names) for i in range(good.sizes["point"])],
    }


def _trace(histories: xr.DataArray) -> dict[str, Any]:
    """The histories of one variable, in the unit and under the name that figures have, its size, the
    greatest in any of them, and from where its numbers count, "" where that is clear."""
    name = str(histories.name)
    label, unit, factor = named(histories)
    values = factor * histories.values.astype(float)
    told = {
        "name": name,
        "label": lowered(label),
        "unit": unit,
        "size": float(np.abs(values).max(initial=0.0)),
        "origin": ORIGINS.get(name, ""),
    }
    return {**told, **traces(values)}


def _motion(motion: xr.Dataset, names: Sequence[str]) -> dict[str, Any]:
    """Where a motion lies, its length in s, and its phases."""
    return {
        "at": [motion[name].item() for name in names],
        "length": motion["length"].item(),
        "phase": runs(motion["phase"].values),
    }


def traces(values: np.ndarray) -> dict[str, Any]:
    """Packed histories, shape (points, samples); ``least + step * n`` errs by half a step, 8e-6 of
    each range."""
    least = values.min(axis=1, keepdims=True, initial=np.inf).astype(float)
    greatest = values.max(axis=1, keepdims=True, initial=-np.inf).astype(float)
    step = (greatest - least) / LEVELS
    steps = np.zeros(values.shape)
    np.divide(values - least, step, out=steps, where=step > 0)
    numbers = np.rint(steps)
    return {
        "least": least.ravel().tolist(),
        "step": step.ravel().tolist(),
        "data": packed(numbers, "<u2"),
    }


def runs(values: np.ndarray) -> list[list[int]]:
    """Runs of equal values: the index where each begins, and its value."""
    begins = np.flatnonzero(np.diff(values, prepend=values[0] + 1))
    return [[int(i), int(values[i])] for i in begins]


def _named(name: str, attrs: Mapping[str, Any]) -> dict[str, Any]:
    """Names of a parameter or variable, that of the axes of figures among them, and its unit."""
    variable = xr.DataArray(0.0, name=name, attrs=attrs)
    label = named(variable).name
    symbol = label[:1].lower() + label[1:]  # within a sentence
    if name in SHOWN and SHOWN[name].symbol:
        symbol = SHOWN[name].symbol
    return {
        "name": name,
        "symbol": lowered(symbol),
        "label": lowered(label),
        "title": lowered(str(attrs.get("long_name", name))),
        "unit": _unit_of(variable)[0],
    }


def _unit_of(variable: xr.DataArray) -> tuple[str, float]:
    """The unit in which figures show a variable, and the factor from SI to it."""
    usual = named(variable)
    return UNITS.get().get(unit_key(variable), (usual.unit, usual.factor))


def _dimension(study: xr.Dataset, dim: str, at: Mapping[str, Any]) -> dict[str, Any]:
    """Values along a dimension as they are shown, and in SI as parts, and the place where the study
    opens."""
    if dim not in study.coords:
        return _zip(study, dim)
    values = study[dim].values.tolist()
    _, factor = _unit_of(study[dim])
    scaled = values
    if factor != 1.0 and not isinstance(values[0], str):
        scaled = [float(f"{value * factor:.12g}") for value in values]
    shown = [_word(dim, value) for value in scaled]
    if dim in BY_SIZE:
        shown = [value_text(study.isel({dim: i}), dim) for i in range(len(values))]
    names = _named(dim, study[dim].attrs)
    si_unit = ""
    if known_name(study[dim]) in UNITS.get():  # the page says both
        si_unit = unit_text(str(study[dim].attrs.get("units", "1")))
    if si_unit == names["unit"]:
        si_unit = ""
    described = {**names, "values": scaled, "shown": shown, "parts": {dim: values}}
    return {**described, "si_unit": si_unit, "usual": usual_place(study, dim, at)}


def _zip(study: xr.Dataset, dim: str) -> dict[str, Any]:
    """Places along a zip, which has no coordinate of its own: its parameters as text."""
    columns = {
        str(name): values.values.tolist()
        for name, values in study.coords.items()
        if values.dims == (dim,)
    }
    if not columns:
        columns = {dim: list(range(study.sizes[dim]))}
    rows = zip(*columns.values(), strict=True)
    zipped = [
        study[name] if name in study.coords else xr.DataArray(0, name=name) for name in columns
    ]
    words = [_place(zipped, row) for row in rows]
    names = [_named(str(one.name), one.attrs) for one in zipped]
    return {
        "name": dim,
        "symbol": dim,
        "label": ", ".join(one["label"] for one in names),
        "title": ", ".join(columns),
        "unit": "",
        "values": words,
        "shown": words,
        "parts": columns,
        "usual": 0,
    }


def _word(name: str, value: Any) -> Any:
    """A word along a dimension as it reads in a sentence; numbers stay as they are."""
    if not isinstance(value, str):
        return value
    return IN_A_SENTENCE.get((name, value), WORDS.get(value, value))


def _place(zipped: Iterable[xr.DataArray], values: Sequence[Any]) -> str:
    """A value along each coordinate of a zip, in words."""
    texts = []
    for coordinate, value in zip(zipped, values, strict=True):
        name = str(coordinate.name)
        text = _word(name, value)
        if not isinstance(value, str):
            unit, factor = _unit_of(coordinate)
            symbol = _named(name, coordinate.attrs)["symbol"]
            text = f"{symbol} = {value * factor:.6g} {unit}".strip()
        texts.append(text)
    return ", ".join(texts)


def _variable(study: xr.Dataset, variable: xr.DataArray, *, exact: bool) -> dict[str, Any]:
    """Numbers as 32-bit floats, or with all of their digits, with the classes of points that have
    none, and the scale of colours of growth rates; flags as bytes with words and their looks, those
    of the figures."""
    name = str(variable.name)
    described = _named(name, variable.attrs)
    described["label"] = with_duration(study, name, described["label"])
    described["dims"] = list(variable.dims)
    described["remark"] = REMARKS.get((str(study.attrs.get("quantity", "")), name), "")
    described["marks"] = _marks(study, name)
    meanings = variable.attrs.get("flag_meanings")
    worded = as_classes(study, name)
    if meanings is None and worded.dtype.kind == "U":
        return {**described, **_verdicts(study, worded)}
    if meanings is None:
        described["gaps"] = _gaps(study, variable)
        described["open"] = _open(study, name)
        described["doubts"] = _doubts(study, name)
        described["scale"] = _scale(variable)
        _, factor = _unit_of(variable)
        numbers = variable.values
        if factor != 1.0:
            numbers = factor * numbers
        described["whole"] = _are_whole(numbers, described["unit"])
        described["exact"] = exact
        if exact:
            return {**described, "data": packed(numbers, "<f8")}
        return {**described, "data": packed(numbers, "<f4")}
    words = str(meanings).split()
    codes = np.atleast_1d(variable.attrs.get("flag_values", range(len(words))))
    looks = [_look(look) for look in looks_of(words).values()]
    data = packed(np.searchsorted(codes, variable.values), "u1")
    return {**described, "flags": words, "looks": looks, "data": data}


def _verdicts(study: xr.Dataset, worded: xr.DataArray) -> dict[str, Any]:
    """The classes of a variable that is true or false, as in the figures, and the place of each
    point's class among them."""
    gaps = classes_of_gaps(study, study[str(worded.name)])
    gaps = np.where(gaps == "", NO_VALUE, gaps)
    classes = np.where(worded.values == "", gaps, worded.values)
    words = [str(word) for word in np.unique(classes)]
    looks = looks_of(words)
    if NO_VALUE in looks:
        looks[NO_VALUE] = looks[NO_VALUE]._replace(label=missing_text(study, str(worded.name)))
    codes = np.searchsorted(words, classes)
    in_order = [_look(looks[word]) for word in words]
    return {"flags": words, "truth": True, "looks": in_order, "data": packed(codes, "u1")}


def _are_whole(numbers: np.ndarray, unit: str) -> bool:
    """Whether numbers without a unit are counts."""
    finite = numbers[np.isfinite(numbers)]
    return not unit and bool(np.all(finite == np.rint(finite)))


def _gaps(study: xr.Dataset, variable: xr.DataArray) -> dict[str, Any] | None:
    """Looks of the classes of points that have no number, those of the figures, and for each point
    the place of its class among them from 1 on, or 0; None if all points have a number."""
    words = _words_of_gaps(study, variable)
    classes = [str(word) for word in np.unique(words) if word]
    if not classes:
        return None
    codes = np.searchsorted(["", *classes], words)
    unvalued = LOOKS[NO_VALUE]._replace(label=missing_text(study, str(variable.name)))
    looks = {**looks_of(classes), NO_VALUE: unvalued}
    looks |= looks_without_time(study, str(variable.name))
    return {
        "dims": list(variable.dims),
        "looks": [{"word": word, **_look(looks[word])} for word in classes],
        "data": packed(codes, "u1"),
    }


def _words_of_gaps(study: xr.Dataset, variable: xr.DataArray) -> np.ndarray:
    """The class of each point that has no number, as in the figures; "" for other points."""
    if not {*statuses(study).dims} <= {*variable.dims}:  # then no one status is that of the number
        return np.where(np.isfinite(variable.values.astype(float)), "", NO_VALUE)
    if is_growth(variable.name):
        return classes_without_rate(study, str(variable.name))
    return classes_without_time(study, variable, classes_of_gaps(study, variable))


def _scale(variable: xr.DataArray) -> dict[str, float] | None:
    """The scale of colours that figures have for growth rates: where it ends, and the width around 0
    in which it is nearly linear (1/s); None for other variables."""
    if not is_growth(variable.name):
        return None
    norm = growth_norm(variable.values)
    return {"width": norm.linear_width, "end": float(norm.vmax or 0.0)}


def _marks(study: xr.Dataset, name: str) -> list[dict[str, Any]]:
    """The marks of a variable on maps over each pair of dimensions, as bytes; that of decaying
    disturbances may also be chosen for dots on other maps."""
    found = []
    for mark in marked_cells(study, name):
        found.append(
            {
                "look": _look(mark.look),
                "axes": list(mark.axes),
                "is_stable": mark.look is MAP_LOOKS[NEGATIVE],
                "is_neutral": mark.look is MAP_LOOKS[NEUTRAL],
                "data": packed(mark.cells, "u1"),
            }
        )
    return found


def _open(study: xr.Dataset, name: str) -> list[dict[str, Any]]:
    """The steps at which curves of a variable along each dimension are open, as bytes at the points
    where they begin, and the words that say why."""
    reason = reason_of_open_steps(name)
    return [
        {"axis": axis, "reason": reason, "data": packed(steps, "u1")}
        for axis, steps in open_along(study, name).items()
    ]


def _doubts(study: xr.Dataset, name: str) -> list[dict[str, Any]]:
    """Points whose value may be another one, as bytes, with the looks that say why; "is_bound" is of
    those that may lie anywhere below."""
    found = []
    for look, points in bounds_and_doubts(study, name).items():
        data = packed(points, "u1")
        found.append({"look": _look(look), "is_bound": look is AT_BOUND, "data": data})
    return found


def _look(look: Look) -> dict[str, str]:
    """The look of a class: its name, colour and pattern, and the colour of the pattern."""
    return {**look._asdict(), "ink": look.ink}
