"""What nan means in each variable, said in long names where computations do not say it."""

import tomllib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import xarray as xr

_REASONS = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
_OF_DIMENSIONS: Mapping[str, str] = _REASONS.pop("dimensions")


def reason_of(kind: str, name: str, dims: Iterable[Any] = ()) -> str:
    """Why a variable of a quantity, or of a class of results, may be nan: a clause such as "if there
    is no cycle"; "" if that is not known."""
    of_kind = _REASONS.get(kind, {})
    if name in of_kind:
        return of_kind[name]
    for dimension, reason in _OF_DIMENSIONS.items():
        if dimension in dims:
            return reason
    return ""


def with_reason(attributes: Mapping[str, Any], reason: str) -> dict[str, Any]:
    """Attributes whose long name says what nan means; one that says it already stays."""
    long_name = attributes.get("long_name", "")
    if not reason or not long_name or ", nan " in long_name:
        return dict(attributes)
    return {**attributes, "long_name": f"{long_name}, nan {reason}"}


def explained(study: xr.Dataset, kind: str) -> xr.Dataset:
    """A dataset of a quantity, or of a class of results, whose numbers say what nan means."""
    described = {}
    for name, variable in study.data_vars.items():
        if variable.dtype.kind in "fc":
            reason = reason_of(kind, str(name), variable.dims)
            described[name] = variable.assign_attrs(with_reason(variable.attrs, reason))
    return study.assign(described)
