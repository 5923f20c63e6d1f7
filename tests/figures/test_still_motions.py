"""Motions that have died away are drawn as flat lines, or as a point."""

import json

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

import disc_model as dm
from disc_model.data.variables import PHASES
from disc_model.figures.history import plot_run
from disc_model.figures.types import Axes

FLAGS = {"flag_meanings": " ".join(PHASES), "flag_values": [*range(len(PHASES))]}
DRIVE = {"Omega": 30.0, "r_0": 0.1}


def run_of(amplitude: float) -> xr.DataTree:
    """A run that slides, with a vibration of a relative amplitude about its static values."""
    time = np.linspace(0.0, 0.01, 101)
    wave = amplitude * np.sin(2 * np.pi * 700 * time)
    values = {
        "u": -6.6e-4 * (1 + wave),
        "P": 5000 * (1 + wave),
        "psi": 0.0875 * (1 + wave),
        "psi_velocity": 30 * wave,
    }
    phase = ("time", np.ones(time.size, np.int8), FLAGS)
    window = xr.Dataset({name: ("time", each) for name, each in values.items()}, {"time": time})
    window["phase"] = phase
    events = xr.Dataset({"time": ("event", [0.0]), "phase": ("event", phase[1][:1], FLAGS)})
    parameters = dm.Parameters(N=5000, Omega=30).canonical_json
    attrs = {"parameters": json.dumps({**json.loads(parameters), **DRIVE})}
    of_run = xr.Dataset({"first_separation": np.inf}, attrs=attrs)
    return xr.DataTree.from_dict({"/": of_run, "/events": events, "/late": window})


def panel() -> Axes:
    return Figure().subplots()


def share_filled(ax: Axes) -> float:
    """The share of its panel that the first line takes upward."""
    low, high = ax.get_ylim()
    return float(np.nanmax(np.ptp(ax.lines[0].get_ydata())) / (high - low))


@pytest.mark.parametrize("variable", ["u", "P", "psi", "psi_velocity"])
def test_histories_on_axes_of_a_reader(variable: str) -> None:
    """What was left of a decay filled its panel as a full vibration."""
    ax = panel()
    plot_run(run_of(1e-8), ["late"], [variable], ax=ax)
    assert share_filled(ax) < 1e-6
    assert not ax.yaxis.get_major_formatter().get_offset()
    moving = panel()
    plot_run(run_of(1e-4), ["late"], [variable], ax=moving)
    assert share_filled(moving) > 0.8
