"""A quantity of studies for a single case, whose options are the arguments of a function."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import xarray as xr

from disc_model.data.coded import words
from disc_model.data.described import described
from disc_model.display import progress_bar
from disc_model.errors import Fault, ParameterError, raise_faults, violations
from disc_model.parameters import Parameters, foreign_case
from disc_model.sources import versions_text
from disc_model.studies.quantity import Point
from disc_model.studies.registry import quantity_of
from disc_model.studies.run import POINT, coordinates_of, variables_of, with_cuts

ARGUMENTS = {"perturbation": "start", "horizons": "horizon"}
"""Arguments of functions for options of other names."""
OF_SCANS = {"start": "bounds", "stop": "bounds", "step": "step"}
"""Arguments of functions for the parts of an option `scan`."""
IN_RULES = {"stop - start": "highest - lowest", "start=": "lowest=", "stop=": "highest="}
"""What rules of a scan say, and what they say of `bounds`."""


def compute_quantity(
    name: str,
    case: Parameters,
    options: Mapping[str, Any],
    start: Mapping[str, float] | None = None,
    *,
    progress: bool = False,
    prepare: Callable[[Any], None] | None = None,
) -> xr.Dataset:
    """Compute a quantity of a case.

    Parameters
    ----------
    name, options : of the quantity
    case : the case
    start : perturbations of the static start by name
    progress : whether a bar on standard error shows how many motions are done, where there are several
    prepare : what is done to the quantity before

    Returns
    -------
    xarray.Dataset
        Its variables, flags as words; attributes are the case (`parameters`), the `options` in JSON, and in `message`
        what went wrong
    """
    faults = foreign_case(case)
    try:
        point = Point.perturbed(case, start)
        quantity = quantity_of(name).model_validate(options)
    except ParameterError as error:
        faults += [_fault_of_argument(fault, options) for fault in error.faults]
    faults += violations(
        (isinstance(progress, bool), "progress", progress, "must be True or False")
    )
    raise_faults(faults)

    if prepare is not None:
        prepare(quantity)
    with progress_bar(name, quantity.starts, progress) as bar:
        quantity.report_to(bar.advance)
        row, message = quantity.compute_point(point)
    coordinates = coordinates_of(quantity.COORDINATES, quantity)
    message = with_cuts(message, row, quantity, coordinates)
    columns = variables_of(quantity.COLUMNS, coordinates, [row], {POINT: 1})
    attrs = {
        "parameters": case.canonical_json,
        "options": quantity.model_dump_json(),
        "message": message,
        "versions": versions_text(),
    }
    dataset = xr.Dataset(columns, coordinates, attrs).isel({POINT: 0})
    return words(described(dataset, name, quantity.model_dump()))


def _fault_of_argument(fault: Fault, options: Mapping[str, Any]) -> Fault:
    """The fault of an option, as that of a function's argument."""
    if fault.path == ("scan",):  # of its parts together, each of which is right by itself
        scan = options["scan"]
        rule = fault.rule
        for part, words in IN_RULES.items():
            rule = rule.replace(part, words)
        return Fault.of(("bounds",), (scan["start"], scan["stop"]), rule)
    if fault.path[:1] == ("scan",):
        return Fault((OF_SCANS[fault.path[1]],), fault.value, fault.rule)
    name, *within = fault.path or ("",)
    path = (ARGUMENTS.get(name, name), *within) if name else ()
    return Fault(path, fault.value, fault.rule)
