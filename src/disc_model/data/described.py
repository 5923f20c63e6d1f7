"""What variables of datasets are, as attributes that the table of variables has: attached where results
are merged or read, so that other words need no new computation."""

from collections import ChainMap
from collections.abc import Mapping
from contextlib import suppress
from types import MappingProxyType
from typing import Any

import xarray as xr

from disc_model.data.variables import COMMON, OF_QUANTITIES, OF_RESULTS, TEXTS, Variable, attributes


def known_of(kind: str) -> Mapping[str, Variable]:
    """The variables of a quantity, of a class of results, or of a function of plain numbers."""
    own = OF_QUANTITIES.get(kind, {}).values()
    return ChainMap(OF_RESULTS.get(kind, {}), *own, COMMON)


def described(
    data: xr.Dataset, kind: str, options: Mapping[str, Any] = MappingProxyType({})
) -> xr.Dataset:
    """A dataset of a quantity, or of a class of results, whose variables say what they are.

    data : what the table does not know of it stays as it is
    options : of the quantity, which may name the parameter of which values are
    """
    known = known_of(kind)
    said = data.copy()
    for name in known.keys() & said.variables.keys():
        _describe(said.variables[name], known[str(name)].texts(options))
    return said


def describe_run(tree: xr.DataTree) -> None:
    """Have the variables in the tree of a named case say what they are."""
    for node in tree.subtree:
        for name, variable in node.variables.items():
            with suppress(KeyError):  # which are unknown
                _describe(variable, attributes(str(name)))


def _describe(variable: xr.Variable, attrs: Mapping[str, Any]) -> None:
    """Replace the texts of a variable, and keep what its numbers need, such as words of flags; words
    themselves have no unit."""
    said = {name: attrs[name] for name in TEXTS if name in attrs}
    if variable.dtype.kind in "UO":
        said.pop("units", None)
    kept = {name: value for name, value in variable.attrs.items() if name not in TEXTS}
    variable.attrs = {**said, **kept}
