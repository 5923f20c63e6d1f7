"""What variables of datasets are, as attributes that the table of variables has: attached where results
are merged or read, so that other words need no new computation."""

from collections import ChainMap
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from xarray import Dataset

from disc_model.data.variables import COMMON, OF_QUANTITIES, OF_RESULTS, TEXTS, Variable


def known_of(kind: str) -> Mapping[str, Variable]:
    """The variables of a quantity, of a class of results, or of a function of plain numbers."""
    own = OF_QUANTITIES.get(kind, {}).values()
    return ChainMap(OF_RESULTS.get(kind, {}), *own, COMMON)


def described(
    data: Dataset, kind: str, options: Mapping[str, Any] = MappingProxyType({})
) -> Dataset:
    """A dataset of a quantity, or of a class of results, whose variables say what they are.

    data : what the table does not know of it stays as it is
    options : of the quantity, which may name the parameter of which values are
    """
    known = known_of(kind)
    said = data.copy()
    for name in known.keys() & said.variables.keys():
        variable = said.variables[name]
        texts = known[str(name)].texts(options)
        if variable.dtype.kind in "UO":  # words themselves have no unit
            texts.pop("units", None)
        kept = {key: x for key, x in variable.attrs.items() if key not in TEXTS}
        variable.attrs = {**texts, **kept}
    return said
