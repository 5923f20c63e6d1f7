"""What figures call points that were computed and have no value."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from disc_model.data.swept_speeds import SPEED, number_swept
from disc_model.data.variables import stated_in, unit_of_parameter
from disc_model.figures.classes import name_of
from disc_model.figures.durations import duration_of, horizon_text, run_text
from disc_model.figures.words import NO_VALUE, in_readers_unit, measured, named
from disc_model.parameters import Parameters
from disc_model.units import in_si

RATE = "rad/s"
"""The unit of speeds unless a reader has another one."""
TIMES_OF_SEPARATION = ("first_separation", "scan_first_separation")
"""Variables that have no value where contact is kept up to the horizon."""
BEYOND = {
    "branch_point": "no branch, or one of fewer points",
    "branch": "no further branch",
    "curve_point": "no curve, or one of fewer points",
    "curve": "no further curve",
    "crossing_number": "no further crossing",
    "crossing": "no further crossing",
    "attractor": "no further attractor",
    "release": "no further release",
    "begin": "contact is not lost",
    "probe": "no release held for a phase",
}
"""What it means that there is no value at a place of a dimension that has room for more than was found."""
_NO_MODE = "no mode of this number"
_NO_LOCK = "no stable cycle was found at it"
_NO_PERIOD = "it does not repeat"
_NOT_SWEPT = "the sweep did not come here"
_NO_START = "no start led to lasting separation"
_NO_MULTIPLIER = "no multiplier of the mode"
_NO_CYCLE = "no cycle is followed"
_NOT_ON_RECORD = "the record shows none"
_NO_ATTRACTOR = "no further attractor, or not periodic"
_NO_EFFECT = "no further crossing, or not known"
GONE: Mapping[str, Mapping[str, str]] = {
    "basins": {
        **dict.fromkeys(("critical_energy", "critical_energy_sampled"), _NO_START),
        "critical_energy_lower": "no start separates, or that without energy does",
        **dict.fromkeys(("attractor_period", "attractor_growth_rate"), _NO_ATTRACTOR),
    },
    "bifurcation": {
        **dict.fromkeys(("psi", "psi_velocity", "P", "u"), "no further event while sampled"),
        "w_point": "sampled once a turn only",
        "first_separation": "no separation up to the last sample",
        **dict.fromkeys(("period_events", "period_residual"), "not shown to repeat"),
        **dict.fromkeys(("change_rate", "least_rate"), _NOT_ON_RECORD),
    },
    "branches": dict.fromkeys(("sweep_range", "sweep_separation_rate"), _NOT_SWEPT),
    "campbell": {
        **dict.fromkeys(
            ("sliding_frequency", "sliding_growth_rate", "forward_wave_fraction"), _NO_MODE
        ),
        **dict.fromkeys(("cycle_frequency", "cycle_growth_rate", "mac"), _NO_MULTIPLIER),
        **dict.fromkeys(("crossing_growth_rate", "crossing_rise"), _NO_EFFECT),
    },
    "critical_speed": {"scan_first_separation": "no separation, or not timed"},
    "locking": {
        **dict.fromkeys(("period", "period_residual"), _NO_PERIOD),
        **dict.fromkeys(("leading_multiplier", "growth_rate"), _NO_LOCK),
        "swing_multiplier": _NO_LOCK,
        "real_multiplier": f"{_NO_LOCK}, or none is real",
        "separations_per_release": "no release of stick, or no separation",
        "separation_interval": "no release of stick, or no separation",
    },
    "outcome": {
        "cycle_distance": "it was not left for a cycle",
        "return_map_residual": "it returned too seldom",
        "return_map_residual_rate": "it returned too seldom, or exactly",
    },
    "regions": {
        **dict.fromkeys(("period", "period_ratio"), _NO_CYCLE),
        "simulated_time": "not simulated",
    },
    "sliding": {
        **dict.fromkeys(
            ("frequency", "mode_growth_rate", "damping_ratio", "forward_wave_fraction"), _NO_MODE
        ),
        "mac": "no such mode, or the first value",
    },
}
"""Why points that were computed have no value of some variables, by quantity."""
NOT_SWEPT_OVER = "none found within the bounds"
"""Said where no speed of a sweep is one at which separation begins or ends, if its speeds are not known."""
NONE_FOUND = "none found"
ENDLESS = "none, or it continues"
"""Said where separation does not begin, or does not end, on a ramp of the speed."""
WITHOUT = {
    "if contact is not lost": "contact is not lost",
    "without one": "no cycle",
    "if there is none": NONE_FOUND,
    "if this is not examined: of a stable cycle, and without one": "stable: not examined",
    "if at none or at the lowest": NOT_SWEPT_OVER,
    "if it still does at the lowest": NOT_SWEPT_OVER,
    "if there is none, or it continues": ENDLESS,
    "if it was not": "it was not left",
    "if no step is audited": "no step is audited",
    "unless every step is audited": "not every step is audited",
    "unless friction acts on a surface that moves": "friction acts on no surface that moves",
    "if friction acts on no surface that moves": "friction acts on no surface that moves",
}
"""What figures say for what long names say after "nan"."""


def missing_text(study: xr.Dataset, name: str) -> str:
    """What figures call points of a variable that were computed and have no value."""
    if name == "first_separation" and study.attrs.get("function") == "simulate":
        return _without_separation(study)
    horizon = horizon_text(study)
    if not horizon and "horizon" in study.dims:
        horizon = "the horizon"
    if name in TIMES_OF_SEPARATION and horizon:
        # some that occur have no time where departures are extrapolated
        options = stated_in(study, "options")
        untimed = options.get("extrapolate") or "extrapolate" in study.dims
        return f"none within {horizon}, or not timed" if untimed else f"none within {horizon}"
    reason = _reason_in(study, name) or name_of(NO_VALUE)
    duration = duration_of(study, name)
    if duration and reason != name_of(NO_VALUE):
        return f"{reason} within {duration}"
    return reason


def _without_separation(study: xr.Dataset) -> str:
    """What a sweep of `simulate` says of points without a separation: within which time there is
    none."""
    within = f"none within {run_text(study) or 'the run'}"
    left = study["first_separation"].isnull() & (study["time_reached"] < study["t_end"])
    return f"{within}, or ended early" if left.any() else within


def _reason_in(study: xr.Dataset, name: str) -> str:
    """Why a point that was computed has no value, as far as the study's dimensions and the variable's
    long name say; "" if they do not."""
    if name == "critical_speed" and "scan_Omega" in study.coords:
        speeds = study["scan_Omega"].values
        low, _ = in_readers_unit(SPEED, speeds[0], RATE)
        high, unit = in_readers_unit(SPEED, speeds[-1], RATE)
        return f"none found from {low:g} to {high:g} {unit}" + _steps_of(study, "scan_Omega")
    if study.attrs.get("function") == "critical" and name in ("value", "border"):
        return _without_critical(study, name)
    if name not in study:
        return ""
    quantity = study.attrs.get("quantity", study.attrs.get("function", ""))
    of_quantity = GONE.get(str(quantity), {})
    if name in of_quantity:
        return of_quantity[name]
    dims = study[name].dims
    for dim, reason in BEYOND.items():
        if dim in dims:
            return reason
    reason = WITHOUT.get(str(study[name].attrs.get("long_name", "")).partition(", nan ")[2], "")
    if quantity == "ramps" and reason in (NONE_FOUND, ENDLESS):
        return _without_in_ramps(study, reason)
    if reason == NOT_SWEPT_OVER:
        return _none_swept_over(study)
    return reason


def _none_swept_over(study: xr.Dataset) -> str:
    """What is said where no speed of a sweep is one at which separation begins or ends."""
    along = f"sweep_{number_swept(study)}"
    if along not in study.coords:
        return NOT_SWEPT_OVER
    values = study[along].values
    name = number_swept(study)
    low, unit = in_readers_unit(name, values.min(), unit_of_parameter(name))
    high, _ = in_readers_unit(name, values.max(), unit)
    found = f"none found from {low:g} to {high:g} {unit}".rstrip()
    if along != f"sweep_{SPEED}":
        return found
    return found + _steps_of(study, along)


def _without_in_ramps(study: xr.Dataset, reason: str) -> str:
    """What is said where separation does not begin or end on a ramp, with the speeds of the ramp."""
    options = stated_in(study, "options")
    if not {"low", "high"} <= {*options}:
        return reason
    low, unit = in_readers_unit(SPEED, options["low"], RATE)
    high, _ = in_readers_unit(SPEED, options["high"], RATE)
    if reason == ENDLESS:
        return f"{reason} at {low:g} {unit}"
    return f"{reason} from {low:g} to {high:g} {unit}"


def text_below_lowest(study: xr.Dataset) -> str:
    """What is said of points at which separation begins or ends below all speeds of a sweep."""
    name = number_swept(study)
    text = (
        "contact lost at the lowest speed" if name == SPEED else "contact lost at the lowest value"
    )
    if f"sweep_{name}" not in study.coords:
        return text
    lowest = study[f"sweep_{name}"].values.min()
    low, unit = in_readers_unit(name, lowest, unit_of_parameter(name))
    return f"{text}, {low:g} {unit}".rstrip()


def _steps_of(study: xr.Dataset, scanned: str) -> str:
    """In which steps the speed was scanned or swept, between which anything may be overlooked; "" if
    these are not known, or not even."""
    if scanned not in study.coords or "step" in study.dims or study[scanned].size < 2:
        return ""
    steps = np.diff(study[scanned].values)
    if not np.allclose(steps, steps[0], rtol=1e-3):
        return ""
    step, unit = in_readers_unit(SPEED, abs(steps[0]), RATE)
    return f" in steps of {step:.3g} {unit}"


def _without_critical(study: xr.Dataset, name: str) -> str:
    """What is said of a search that has found no critical value, or no border of stability."""
    if name == "value":
        return _none_within_bounds(study)
    unstable, stable = texts_without_border(study)
    return f"{stable}, or {unstable}"


def texts_without_border(study: xr.Dataset) -> tuple[str, str]:
    """What is said of points of a search without a border of stability, which are unstable at all
    values; and of those that are stable at the upper bound."""
    unstable = f"unstable at all values {_range_searched(study, 'border')}".rstrip()
    bounds = _bounds_of(study, "border")
    if bounds is None:
        return unstable, "stable at the upper bound"
    return unstable, f"stable at the upper bound, {bounds[1]} {_unit_of(study, 'border')}".rstrip()


def _none_within_bounds(study: xr.Dataset) -> str:
    """What is said of a search that has found no critical value: the motion is stable at all values
    computed, in the unit of the value, with their largest step if it is known; "" without bounds."""
    if _bounds_of(study, "value") is None:
        return ""
    found = f"none found {_range_searched(study, 'value')}"
    if "resolution" in study and study["resolution"].notnull().any():
        step = _as_value(study, "value", float(study["resolution"].max()))
        return f"{found} in steps of at most {step:.2g} {_unit_of(study, 'value')}".rstrip()
    return found


def _range_searched(study: xr.Dataset, name: str) -> str:
    """The bounds of a search, in the unit of a variable; "" without any."""
    bounds = _bounds_of(study, name)
    if bounds is None:
        return ""
    lowest, highest = bounds
    return f"from {lowest} to {highest} {_unit_of(study, name)}".rstrip()


def _bounds_of(study: xr.Dataset, name: str) -> tuple[str, str] | None:
    """The bounds of a search as texts, in the unit of a variable or with their own; None without any."""
    given = stated_in(study, "options").get("bounds")
    if given is None:
        return None
    lowest, highest = (_bound_text(study, name, bound) for bound in given)
    return lowest, highest


def _bound_text(study: xr.Dataset, name: str, bound: float | str) -> str:
    """A bound of a search as a number in the unit of a variable, also if it was given as a text."""
    searched = str(stated_in(study, "options").get("name", ""))
    number = float(in_si(bound, Parameters.unit(searched), [], ("bounds",)))
    return f"{_as_value(study, name, number):.6g}"


def _unit_of(study: xr.Dataset, name: str) -> str:
    """The unit that figures have for a variable; "" for none."""
    return named(study[name]).unit


def _as_value(study: xr.Dataset, name: str, number: float) -> float:
    """A number in SI, in the unit that figures have for a variable."""
    values = study[name].copy(data=np.full(study[name].shape, number))
    return float(measured(values).values.flat[0])
