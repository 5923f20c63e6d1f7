"""Modes of steady sliding along one parameter, by complex eigenvalues."""

from __future__ import annotations

import numpy as np
from xarray import Dataset

from disc_model.data.variables import OF_QUANTITIES, value_with_unit
from disc_model.parameters import Parameters
from disc_model.studies.quantity import (
    BETWEEN,
    Bounds,
    Free,
    Step,
    found,
    listed,
    quantity,
    values_between,
)
from disc_model.units import Size

OF_MODES = {
    "frequency": "frequency",
    "mode_growth_rate": "growth_rate",
    "damping_ratio": "damping_ratio",
    "diameters": "diameters",
    "forward_wave_fraction": "forward",
}
"""Columns of the modes, and what these numbers are of each."""


@quantity(points_per_job=60, own=("name",), rules=BETWEEN)
def sliding_modes(
    case: Parameters, *, name: Free = "Omega", bounds: Bounds, step: Step, modes: Size = 24
) -> Dataset:
    """Frequencies, growth rates and damping of the modes of steady sliding along one parameter, each of
    which keeps its number.

    Parameters
    ----------
    name : number of the case that varies
    bounds : its least and greatest value
    step : between its values
    modes : room for that many modes, numbered by frequency at the first value

    Examples
    --------
    >>> import disc_model as dm
    >>> found = dm.sliding_modes(dm.Parameters(N=385, Omega=15), bounds=(10, 20), step=5)
    >>> found["unstable_modes"].values
    array([2, 2, 2])
    """
    from disc_model.stability.sliding import follow_modes, height_of_slider

    values = values_between(bounds, step)
    cases = [case.replace(**{name: value}) for value in values]
    followed = follow_modes(cases)
    n_modes = max(int(each.numbers.max(initial=-1)) + 1 for each in followed)
    table = OF_QUANTITIES["sliding_modes"]["columns"]
    columns = {x: table[x].empty((len(values), n_modes)) for x in OF_MODES}
    rows = []
    messages = []
    for i, (sliding, of_value, numbers) in enumerate(followed):
        for column, number in OF_MODES.items():
            columns[column][i, numbers] = getattr(of_value, number)
        row = {
            "unstable_modes": sliding.growing.size,
            "contact_force": sliding.contact_force,
            "largest_growth_rate": sliding.growth_rate,
        }
        if sliding.status.exists:
            row["height"] = height_of_slider(cases[i], sliding)
        else:
            messages.append(f"{value_with_unit(name, values[i])}: {sliding.message}")
        rows.append(row)
    answer = {"n_modes": n_modes, **columns, **listed(rows)}
    numbered = np.arange(1, modes + 1)
    return found("sliding_modes", answer, *messages[:1], value=values, mode=numbered)
