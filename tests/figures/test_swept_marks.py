"""Marks and names of lines of sweeps: each entry of a legend has its own, and says what it is of."""

import numpy as np
import pytest
import xarray as xr

import disc_model as dm
from disc_model.figures.classes import FILLED_MARK, GROWING
from tests.figures.reading import labels, small_axes

CASE = dm.Parameters(N=385, Omega=14)


# ---- Two variables of paired samples


def forces(case: dm.Parameters) -> dict[str, float]:
    """The least and the greatest of a force, which the contact changes."""
    ratio = 0.5 if case.contact == "unilateral" else 0.8
    return {"least_force": ratio * case.N, "greatest_force": 2 * ratio * case.N}


# ---- Motions that still grow


def late_forces(words: list[list[str]]) -> xr.Dataset:
    """The greatest force late in motions of some outcomes, over speeds and horizons."""
    outcomes = np.array(words)
    along = ("Omega", "horizon")
    meaning = {"units": "N", "long_name": "greatest contact force over the late stretch"}
    forces = 400.0 + np.arange(outcomes.size).reshape(outcomes.shape)
    data = {
        "status": (along, np.full(outcomes.shape, "ok")),
        "outcome": (along, outcomes),
        "P_max": (along, forces, meaning),
    }
    speeds = 12.0 + np.arange(len(words))
    horizons = 30.0 * (1 + np.arange(len(words[0])))
    return xr.Dataset(data, {"Omega": speeds, "horizon": horizons})


OUTCOMES = [["quiet", "quiet"], ["growing", "separation"], ["undecided", "growing"]]


def test_values_of_motions_that_still_grow_are_filled() -> None:
    """They looked as those of motions that had come to something."""
    ax = dm.plot_sweep(late_forces(OUTCOMES), "P_max", x="Omega", lines="horizon", ax=small_axes())
    assert FILLED_MARK.format(GROWING.label) in labels(ax)
    unnamed = [line for line in ax.lines if line.get_label() == "_nolegend_"]
    filled = [line for line in unnamed if line.get_markerfacecolor() != "none"]
    speeds = [line.get_xdata().tolist() for line in filled]
    assert speeds == [[13.0, 14.0], [14.0]]


def test_cells_of_motions_that_still_grow_are_hatched() -> None:
    """They looked as those of motions that had come to something."""
    study = late_forces([[*words, words[-1]] for words in [*OUTCOMES, OUTCOMES[0]]])
    ax = dm.plot_sweep(study, "P_max", lines=False, ax=small_axes())
    assert GROWING.label in labels(ax)


# ---- Lists and starts


def over_words(name: str, words: list[str], function: str, options: str) -> xr.Dataset:
    """A sweep over lists or starts, as words, and two loads."""
    along = ("N", name)
    data = {
        "status": (along, np.full((2, len(words)), "ok")),
        "value": (along, np.arange(2.0 * len(words)).reshape(2, -1)),
    }
    attributes = {"function": function, "options": options}
    return xr.Dataset(data, {"N": [300.0, 385.0], name: words}, attributes)


LISTS = {
    "bounds of a search": ("bounds", ["9, 20", "12, 20"], "critical", '{"name": "Omega"}'),
    "bounds without a unit": ("bounds", ["0.1, 0.2", "0, 1"], "critical", '{"name": "mu_k"}'),
    "bounds of a scan": ("bounds", ["9, 20", "12 rad/s, 20 rad/s"], "critical_speed", "{}"),
    "a list of one's own": ("gains", ["1, 2", "3"], "", "{}"),
    "starts": ("start", ["u = -0.001", "f = 2"], "outcome", "{}"),
}
SAID_OF_LISTS = {
    "bounds of a search": ["bounds 9 to 20 rad/s", "bounds 12 to 20 rad/s"],
    "bounds without a unit": ["bounds 0.1 to 0.2", "bounds 0 to 1"],
    "bounds of a scan": ["bounds 9 to 20 rad/s", "bounds 12 rad/s to 20 rad/s"],
    "a list of one's own": ["gains = 1 and 2", "gains = 3"],
    "starts": ["height u = -1 mm", "speed f = 2 rad/s"],
}


@pytest.mark.parametrize("name", LISTS)
def test_lists_and_starts_have_names_and_units(name: str) -> None:
    """Numbers stood there alone."""
    study = over_words(*LISTS[name])
    ax = dm.plot_sweep(study, "value", x="N", ax=small_axes())
    assert labels(ax) == SAID_OF_LISTS[name]


# ---- A verdict


def test_whether_contact_is_lost_has_no_unit() -> None:
    """It was labelled in rad/s, as the speed that it was found from."""
    options = {"bounds": (17, 18), "horizon": 1, "step": 1}
    found = dm.critical_speed(CASE, **options)
    assert "units" not in found["at_lower_bound"].attrs
