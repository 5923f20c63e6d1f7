"""What pictures of a run have in common: its stated case, and its windows."""

import numpy as np
import xarray as xr

from disc_model.data import dataset
from disc_model.errors import Fault, ParameterError, require, suggestion
from disc_model.figures.words import what_case
from disc_model.parameters import Parameters


def stated(case: Parameters | xr.DataTree, *varied: str) -> str:
    """The values of a case, such as that of a run, but those of what varies."""
    p = case
    if isinstance(p, xr.DataTree):
        p = Parameters.model_validate_json(p.attrs["parameters"])
    # what varies has the value of a number, so that the ratio of another is kept
    values = p.replace(**{name: p.numbers[name] for name in varied}).stated
    return what_case({name: value for name, value in values.items() if name not in varied})


def window_of(
    case: xr.DataTree,
    name: object,
    *variables: tuple[str, object],
    which: str = "window",
    samples: bool = False,
) -> xr.Dataset:
    """A window of a run, if it holds what is needed; raises `ParameterError`.

    Parameters
    ----------
    name : of the window
    variables : what it must hold, each after the argument that names it
    which : the argument that names the window
    samples : whether it must hold samples instead of ranges
    """
    known = [str(child) for child in case.children if child not in ("events", "poincare")]
    if not (isinstance(name, str) and name in case.children):
        raise ParameterError(Fault.of((which,), name, f"was not recorded{suggestion(name, known)}"))
    window = dataset.group(case, name)
    held = [str(x).removesuffix("_min").removesuffix("_max") for x in window if x != "phase"]
    for argument, variable in variables:
        if not (isinstance(variable, str) and variable in held):
            rule = f"is not in the window {name}{suggestion(variable, dict.fromkeys(held))}"
            raise ParameterError(Fault.of((argument,), variable, rule))
    require(("phase" in window or not samples, which, name, "must hold samples, not their ranges"))
    return window


def span_of(window: xr.Dataset) -> float:
    """Time from the first to the last sample of a window, s."""
    times = window["time"].values
    return float(np.ptp(times)) if times.size else 0.0
