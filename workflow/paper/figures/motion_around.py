"""The motion of disc and slider from samples of the disc at several angles."""

import json

import numpy as np
import xarray as xr

from disc_model.data import dataset
from disc_model.data.variables import flag_names
from disc_model.disc.plate import modes_at_point
from disc_model.figures.disc import Motion
from disc_model.figures.stated_case import parameters_of
from disc_model.figures.types import Array, ComplexArray, Indices
from disc_model.simulation.case import Ramp, angle_of_drive, pieces


def motion_of(case: xr.DataTree) -> Motion:
    """The motion of disc and slider from windows `around0`, ... of the disc at r_0 and as many
    angles as determine the harmonics that modes without nodal circles are; raises `Missing` if they
    do not."""
    p = parameters_of(case)
    harmonics = np.arange(p.n_diameters + 1)
    count = 2 * len(harmonics) - 1
    windows = [dataset.samples(case, f"around{j}", at_least=1) for j in range(count)]
    if p.n_circles:
        raise dataset.Missing(
            "has modes with nodal circles, which a circle of points does not tell apart"
        )
    time, psi, u = (windows[0][name].values for name in ("time", "psi", "u"))
    if any(not np.array_equal(window["time"].values, time) for window in windows):
        raise dataset.Missing("recorded the disc at other times at other angles")

    # harmonics at each instant, by least squares
    angles = np.array([window.attrs["theta"] for window in windows])
    values = np.array([window["w_point"].values for window in windows])
    solution = _harmonics(angles, harmonics, values)
    amplitudes = solution / modes_at_point(p).psi[:, None]
    ramps = [Ramp(**ramp) for ramp in json.loads(case.attrs.get("ramps", "[]"))]
    intervals = pieces(p, ramps)
    drive = np.array([angle_of_drive(intervals, t) for t in time])
    slider = drive - psi
    return Motion(p, time, amplitudes, slider, u, flag_names(windows[0]["phase"]))


def _harmonics(angles: Array, orders: Indices, values: Array) -> ComplexArray:
    """Cosine + i sine of the harmonics of some orders in values at angles, shape (angles, n):
    (orders, n)."""
    turns = orders * angles[:, None]
    terms = np.hstack([np.cos(turns), np.sin(turns)[:, 1:]])
    found = np.linalg.lstsq(terms, values, rcond=None)[0]
    solution = found[: len(orders)].astype(complex)
    solution[1:] += 1j * found[len(orders) :]
    return solution
