"""What a title says of a disc given by its modes, of which some frequencies vary, or which is the only one
of an axis."""

from collections.abc import Mapping
from typing import Any

import xarray as xr

from disc_model.data.variables import stated_in
from disc_model.parameters import Disc


def with_frequencies(
    values: Mapping[str, Any], given: Mapping[str, float | None]
) -> dict[str, Any]:
    """Values of a case whose disc has other frequencies of some modes, by names such as omega_1_0;
    None for one that varies. Without such names, the values as they are."""
    disc = values.get("disc")
    if isinstance(disc, Disc):
        disc = dict(disc)
    if not isinstance(disc, Mapping) or not any(name.startswith("omega_") for name in given):
        return dict(values)
    modes = zip(disc["diameters"], disc["circles"], disc["omega"], strict=True)
    omega = []
    for diameters, circles, frequency in modes:
        omega.append(given.get(f"omega_{diameters}_{circles}", frequency))
    return {**values, "disc": {**disc, "omega": omega}}


def varied_numbers(*names: str) -> dict[str, float | None]:
    """Numbers of a disc that vary, by their names, for `with_frequencies`."""
    return dict.fromkeys(names)


def single_disc(study: xr.Dataset) -> dict[str, Any]:
    """The one disc of a study that has it on an axis, or that was selected there, by its name in cases; empty
    for several, and for a name of which a study has no table."""
    if "disc" not in study.coords or study["disc"].size != 1:
        return {}
    disc = study["disc"].item()
    if isinstance(disc, str):
        disc = stated_in(study, "discs").get(disc)
    return {} if disc is None else {"disc": disc}
