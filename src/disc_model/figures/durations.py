"""For how long motions were followed, as far as results depend on it, in words of figures."""

from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.variables import stated_in
from disc_model.figures.unknown_starts import OF_STARTS

OF_HORIZON = (
    "outcome",
    "scan_outcome",
    "kind",
    "critical_speed",
    "n_crossings",
    "crossing",
    "crossing_kind",
    *OF_STARTS,
)
"""Variables that say what motions do within the horizon that a study states."""
OF_RUNS = (
    "steps",
    "audited_steps",
    "n_events",
    "n_separations",
    "time_stick",
    "time_slip",
    "time_separation",
    "surface_speed",
    "energy_residual",
    "energy_residual_transverse",
    "energy_residual_inplane",
)
"""Variables of `simulate` that grow with the length of a run."""
OF_EXPONENTS = ("separations", "converged")
"""Variables of `lyapunov_exponents` that are of the time over which exponents are taken."""
SAID = {
    "within the horizon": "within {}",
    "in that time": "within {}",
    "both halves of that time": "both halves of {}",
}
"""What long names say of such a time, and what figures say instead."""
WITHOUT_COMMA = ("outcome", "scan_outcome", "critical_speed", *OF_RUNS)
"""Variables whose names are so short that the time follows without a comma."""


def with_duration(study: xr.Dataset, name: str, words: str) -> str:
    """The words for a variable of a study, with the time for which motions were followed, if it
    depends on this and the time is the same at all points."""
    duration = duration_of(study, name)
    if not duration:
        return words
    for phrase, said in SAID.items():
        if phrase in words:
            return words.replace(phrase, said.format(duration))
    if name not in WITHOUT_COMMA:
        words += ","
    return f"{words} within {duration}"


def duration_of(study: xr.Dataset, name: str) -> str:
    """The time, with its unit, for which the motions were followed on which a variable depends; "" if
    it depends on none, or on several."""
    function = study.attrs.get("function", study.attrs.get("quantity"))
    if name in OF_HORIZON or "within the horizon" in _long_name(study, name):
        return horizon_text(study)
    if name in OF_RUNS and function == "simulate":
        return run_text(study)
    if name in OF_EXPONENTS and function in ("lyapunov_exponents", "lyapunov"):
        return one_time(study, "duration")
    return ""


def _long_name(study: xr.Dataset, name: str) -> str:
    """What a variable of a study says that it is, "" if nothing."""
    return str(study[name].attrs.get("long_name", "")) if name in study else ""


def horizon_text(study: xr.Dataset) -> str:
    """The one horizon that a study states, with its unit; "" if there is none."""
    return _seconds(stated_in(study, "options").get("horizon"))


def run_text(study: xr.Dataset) -> str:
    """The length of all runs of a sweep of `simulate`, with its unit; "" if they differ, or if it is
    not known because they continue another run."""
    options = stated_in(study, "options")
    if "initial_state" in options:
        return _seconds(options.get("duration"))
    return one_time(study, "t_end")


def one_time(study: xr.Dataset, name: str) -> str:
    """The time that a variable has at all points at which it is known, with its unit; "" if there are
    several."""
    if name not in study:
        return ""
    times = study[name].values
    known = np.unique(times[np.isfinite(times)])
    return _seconds(known.tolist())


def _seconds(time: Any) -> str:
    """A time as options state it, in seconds or as a text with a unit; "" if it is none, or several."""
    if isinstance(time, list) and len(time) == 1:
        time = time[0]
    if isinstance(time, str):
        return time
    return f"{time:g} s" if isinstance(time, float | int) else ""
