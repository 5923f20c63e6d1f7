"""A sweep as its pictures need it: without dimensions of one value, in order, and with words for its values."""

import json
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.variables import TRUTH, flag_names, stated_in
from disc_model.figures.selection import without_single
from disc_model.figures.sweep_dimensions import drawn_dims
from disc_model.figures.sweep_options import function_of
from disc_model.figures.words import IN_THOUSANDTH, MISSING, named
from disc_model.parameters import PLATE_NAME, Disc

OF_FUNCTIONS = {
    "bifurcation": "psi",
    "choose_modes": "modes",
    "coupled_natural_frequencies": "value",
    "lyapunov": "exponent",
    "lyapunov_exponents": "exponents",
    "plate_modes": "omega",
    "simulate": "n_separations",
}
"""Variables that are drawn first, of sweeps of a function or of studies of a quantity."""
FIRST_OF_SEVERAL = {
    "exponent": "largest Lyapunov exponent",
    "exponents": "largest Lyapunov exponent",
    "value": "lowest natural frequency of disc and attached slider",
}
"""Names of the first value of such variables that have several at each point."""
ALONG_EXPONENTS = ("errors", "exponent_error", "converged")
"""Variables that say something of each Lyapunov exponent."""


def in_common_units(study: xr.Dataset, variables: Sequence[str]) -> xr.Dataset:
    """The study with all of several variables of one unit in thousandths of it if some of them are."""
    shown = [name for name in variables if name in study]
    units = {study[name].attrs.get("units") for name in shown}
    factors = [named(study[name]).factor for name in shown]
    if len(units) != 1 or {*factors} != {1.0, 1e3}:
        return study
    plain = [name for name, factor in zip(shown, factors, strict=True) if factor == 1.0]
    return study.assign({name: study[name].assign_attrs({IN_THOUSANDTH: 1}) for name in plain})


def without_single_values(study: xr.Dataset) -> xr.Dataset:
    """The study without dimensions of one value; but shares of starts of one case stay along their
    energies, and a single point along its numbers."""
    numbers = drawn_dims(study)
    if numbers and all(study.sizes[dim] == 1 for dim in numbers):
        return without_single(study, *numbers[-2:])
    alone = (
        "basin_fraction" in study and study["basin_fraction"].size == study.sizes["attractor_class"]
    )
    kept = ("energy",) if alone else ()
    return without_single(study, *kept)


def with_first_values(study: xr.Dataset) -> xr.Dataset:
    """The study with the first value at each point of the usual variable of its function, and what is
    known of this value."""
    name = OF_FUNCTIONS.get(function_of(study), "")
    if name not in FIRST_OF_SEVERAL or name not in study:
        return study
    firsts = {}
    for each in (name, *ALONG_EXPONENTS):
        dim = "exponent_number" if name == "exponent" else f"{each}_index"
        if each in study and dim in study[each].dims:
            firsts[each] = study[each].isel({dim: 0}, drop=True)
    if name not in firsts:  # one was selected
        return study
    attrs = {**firsts[name].attrs, "long_name": FIRST_OF_SEVERAL[name]}
    firsts[name] = firsts[name].assign_attrs(attrs)
    return study.drop_vars([*firsts]).assign(firsts)


def with_one_horizon(study: xr.Dataset) -> xr.Dataset:
    """The study with the one horizon that was selected among those with which it was computed, as by
    ``study.sel(horizon=50)``."""
    if "horizon" not in study.coords or study["horizon"].ndim:
        return study
    options = stated_in(study, "options")
    options["horizon"] = study["horizon"].item()
    return study.assign_attrs(options=json.dumps(options))


def ascending(study: xr.Dataset, samples: str) -> xr.Dataset:
    """The study with the numbers along its dimensions, but that of samples, in their order: lines
    would go back and forth, and cells of a map lie on each other. Those that are not finite have no
    place."""
    named = [name for name in study.dims if name in study.coords and name != samples]
    numbers = [name for name in named if study[name].dtype.kind in "fi"]
    placed = {name: np.isfinite(study[name].values) for name in numbers}
    return study.isel(placed).sortby(numbers)


def without_stacks(study: xr.Dataset) -> xr.Dataset:
    """The study with several values along a dimension, as `xarray.Dataset.stack` gives them, as those of
    paired samples."""
    stacked = [
        dim for dim, index in study.indexes.items() if index.nlevels > 1 and dim in study.dims
    ]
    for dim in stacked:
        levels = study.indexes[dim]
        names = [*map(str, levels.names)]
        columns = {}
        for name in names:
            values = levels.get_level_values(name).to_numpy()
            columns[name] = (dim, values, study[name].attrs)
        study = study.drop_vars([dim, *names]).assign_coords(columns)
    return study


def with_own_coordinates(study: xr.Dataset) -> xr.Dataset:
    """The study with the values along a dimension of its results as a coordinate where they are the same
    at all points, as after one of several sweeps in different steps was selected."""
    for name in map(str, study.data_vars):
        along = f"{name}_index"
        beside = [each for each in study.data_vars if along in study[each].dims]
        if along in study[name].dims and len(beside) > 1:
            study = _with_coordinate(study, name, along)
    return study


def _with_coordinate(study: xr.Dataset, name: str, along: str) -> xr.Dataset:
    """The study with a variable as the coordinate of a dimension, without places that have no value; as it
    is if the variable differs between points."""
    rows = study[name].transpose(..., along)
    table = rows.values.reshape(-1, study.sizes[along])
    if rows.dtype.kind not in "fi" or not np.array_equal(
        table, table[:1].repeat(len(table), 0), True
    ):
        return study
    known = np.isfinite(table[0].astype(float))
    kept = study.drop_vars(name).isel({along: known}).rename({along: name})
    return kept.assign_coords({name: (name, table[0][known], rows.attrs)})


def with_words(study: xr.Dataset) -> xr.Dataset:
    """The study with words for True and False along its dimensions, and for words that are missing there, and
    with names for discs, by their order and frequencies."""
    named: dict[Any, Any] = {}
    for name, values in study.coords.items():
        if values.dtype.kind == "b" and values.ndim == 1:
            answers = np.where(values, "yes", "no")
            named[name] = (values.dims, answers, {**values.attrs, **TRUTH})
        if values.ndim == 1 and _are_discs(values):
            named[name] = (values.dims, _names_of_discs(values), values.attrs)
        elif values.ndim == 1 and _lacks_words(values):
            known = np.where(flag_names(values) == "", MISSING, flag_names(values))
            named[name] = (values.dims, known, values.attrs)
    return study.assign_coords(named)


def _are_discs(values: xr.DataArray) -> bool:
    """Whether these are several discs, one of which may be the plate, for which None stands."""
    given = [value for value in values.values.flat if value is not None]
    return values.size > 1 and bool(given) and all(isinstance(value, Disc) for value in given)


def _names_of_discs(values: xr.DataArray) -> list[str]:
    """Names of discs by their order and frequencies, and the word for the plate among them."""
    names = []
    for number, disc in enumerate(values.values, start=1):
        shown = str(disc).removeprefix("Disc(").removesuffix(")")
        names.append(PLATE_NAME if disc is None else f"disc {number}: {shown}")
    return names


def _lacks_words(values: xr.DataArray) -> bool:
    """Whether these are words, some of which are missing."""
    if values.dtype.kind not in "UO":
        return False
    known = values.values[values.notnull().values]
    are_words = known.size > 0 and all(isinstance(word, str) for word in known)
    return are_words and bool((flag_names(values) == "").any())
