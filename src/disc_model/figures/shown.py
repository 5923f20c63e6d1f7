"""Datasets as readers see them: in their units, with labels, and flags as words. What draws them
knows nothing of SI."""

from collections.abc import Mapping
from contextlib import suppress
from typing import Any

import numpy as np
from xarray import DataArray, Dataset, DataTree

from disc_model.data.dataset import Missing
from disc_model.data.variables import SERIES, SHOWN, flag_names, ranged_variable, typeset, with_unit
from disc_model.data.variables import attributes as attributes_in_files
from disc_model.parameters import Parameters
from disc_model.units import size_of_unit

THOUSANDTHS = {"m": "mm", "s": "ms"}
"""Units of ranges and periods for readers, by those of files."""
IN_WORDS = {
    "as_published": "modes as published",
    "orthonormal": "orthonormal modes",
    "given": "modes of a table",
    "unilateral": "with separation",
    "bilateral": "separation ignored",
    "vertical": "vertical contact force",
    "normal": "normal contact force",
}
"""Words along a dimension that need a noun."""


def shown(data: Dataset, units: Mapping[str, str] | None = None) -> Dataset:
    """A dataset in the units of all figures, or in those of a reader, such as ``{"Omega": "rpm"}``.

    Each variable has the attributes `long_name` and `units` of its label, and `factor`, which turns a
    value in SI units into what is shown. Flags are words.
    """
    wishes = factors_of(units or {})
    changed = {name: _shown(data[name], wishes).variable for name in data.variables}
    coordinates = {name: changed.pop(name) for name in list(changed) if name in data.coords}
    return data.assign(changed).assign_coords(coordinates)


def shown_case(case: DataTree, units: Mapping[str, str] | None = None) -> DataTree:
    """The tree of a case, with its numbers and those of its parameters as readers see them; `window_of`
    shows one of its windows."""
    p = Parameters.model_validate_json(case.attrs["parameters"])
    numbers = {name: ((), x, attributes_in_files(name)) for name, x in p.numbers.items()}
    root = case.to_dataset(inherit=False).assign(numbers)
    tree = DataTree(shown(root, units), children=dict(case.children))
    tree.attrs["shown_in"] = units
    return tree


def window_of(case: DataTree, name: str) -> Dataset:
    """A window of a shown case, with the place of the disc's point in its labels; raises `Missing`
    if it has fewer than two samples."""
    if name not in case.children:
        why = {"failed": "failed"}
        raise Missing(why.get(case["status"].item(), f"did not record {name}"))
    window = shown(case.children[name].to_dataset(inherit=False), case.attrs.get("shown_in"))
    if window.sizes["time"] < 2:
        raise Missing(f"has too few samples in {name}")
    for variable, x in window.items():
        if "w_point" in str(variable):
            x.attrs["long_name"] += f", θ\u00a0=\u00a0{window.attrs['theta']:g}\u00a0rad"
    return window


def factors_of(units: Mapping[str, str]) -> dict[str, tuple[str, float]]:
    """A reader's units, with the factors from SI to them."""
    return {name: (unit, 1 / size_of_unit(unit, si_unit(name))) for name, unit in units.items()}


def _shown(x: DataArray, units: Mapping[str, tuple[str, float]]) -> DataArray:
    """A variable with values, name and unit for readers."""
    attributes = {**x.attrs, "long_name": name_of(x), "units": "", "factor": 1.0}
    if "flag_meanings" in x.attrs:
        attributes = {k: x for k, x in attributes.items() if not k.startswith("flag_")}
        return x.copy(data=flag_names(x).astype(object)).assign_attrs(attributes)
    if x.dtype.kind not in "fiu":
        return x.assign_attrs(attributes)
    known = parameter_of(x)
    unit = readable(x.attrs.get("units", ""))
    factor = 1.0
    if known:
        attributes["parameter"] = known
        unit = SHOWN[known].unit
        factor = SHOWN[known].factor
    elif str(x.name).endswith(("range", "period")) and unit in THOUSANDTHS:
        unit = THOUSANDTHS[unit]
        factor = 1e3
    unit, factor = units.get(known, (unit, factor))
    attributes.update(units=unit, factor=factor)
    values = x.values
    if factor != 1.0:
        values = values * factor
    plain = DataArray(values, dims=x.dims, name=x.name)
    plain.attrs = attributes
    return plain


def parameter_of(x: DataArray) -> str:
    """The parameter or sampled variable that an array has values of, "" if it has a meaning or a unit
    of its own."""
    stated = x.attrs.get("parameter", "")
    if stated in SHOWN:
        return str(stated)
    own = ranged_variable(str(x.name).removeprefix("scan_").removeprefix("sweep_"))
    if own not in SHOWN or "units" not in x.attrs:
        return ""
    usual = attributes_in_files(own)["units"]
    if readable(x.attrs["units"]) != readable(usual):
        return ""
    return own


def si_unit(name: str) -> str:
    """The SI unit of a parameter or of a sampled variable, "" without one."""
    unit = Parameters.unit(name)
    if not unit and name in SERIES:
        unit = SERIES[name].units.replace(" s-1", "/s")
    return unit


def readable(units: str) -> str:
    """A unit of CF as text: ``N m-2`` is ``N/m²``, and ``1`` is nothing."""
    above = []
    below = []
    for part in units.replace("2", "²").replace("3", "³").split():
        name, _, power = part.partition("-")
        if power:
            below.append(name + power.removeprefix("1"))
        elif name != "1":
            above.append(name)
    if below:
        above = above or ["1"]
    return "/".join([" ".join(above), *below])


def name_of(x: DataArray) -> str:
    """What labels call an array: name and symbol of a parameter, else its long name."""
    known = parameter_of(x)
    if known:
        return typeset(f"{SHOWN[known].name} {SHOWN[known].symbol}".strip())
    said = str(x.attrs.get("long_name", x.name)).replace("_", " ")
    if len(said) > 1:
        return said[0].upper() + said[1:]
    return said


def label(x: DataArray) -> str:
    """The label of an axis or of a bar of colours, of an array as it is shown."""
    unit = x.attrs.get("units", "").replace(" ", "\u00a0")  # no line ends within it
    name = str(x.attrs.get("long_name", x.name))
    return f"{name} ({unit})" if unit else name


def value_text(x: DataArray) -> str:
    """One shown value along a dimension, ``N = 385 N``, or its word; by the attribute `names` of its
    coordinate, if that has it."""
    value = x.item()
    names: Mapping[str, str] = x.attrs.get("names", {})
    if not isinstance(value, int | float):
        return names.get(key_of(str(value)), _word_text(str(x.name), str(value)))
    known = parameter_of(x)
    symbol = str(x.attrs.get("long_name", x.name))
    if known:
        symbol = SHOWN[known].symbol or SHOWN[known].name
    stated = key_of(value / x.attrs.get("factor", 1.0))  # as a study file has it
    text = f"{typeset(symbol)} = {with_unit(value, x.attrs.get('units', ''))}"
    return names.get(stated, text)


def _word_text(name: str, word: str) -> str:
    """A word along a dimension; beside its parameter if that has numbers, too, which then are words."""
    if name not in SHOWN:
        return IN_WORDS.get(word, word.replace("_", " "))
    own = SHOWN[name]
    with suppress(ValueError):
        word = with_unit(float(word), own.unit, own.factor)
    return f"{typeset(own.symbol or own.name)} = {word}"


def key_of(value: Any) -> str:
    """The text by which a value along a dimension is known, the same for all ways to write a
    number."""
    try:
        return f"{float(value):.12g}"
    except ValueError:
        return str(value)


def placed(x: DataArray, value: float) -> float:
    """A value in SI units, such as a study file has, in the unit in which an array is shown."""
    return value * float(x.attrs["factor"])


def words(x: DataArray) -> np.ndarray:
    """Words of a shown flag as texts; "" where there is none."""
    return np.where(x.isnull(), "", x.values).astype(str)
