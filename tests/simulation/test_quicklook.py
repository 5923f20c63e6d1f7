"""A first look at a result."""

import math

import matplotlib.pyplot as plt
import numpy as np
import pytest

from disc_model import ParameterError, Parameters, Window, simulate

P = Parameters(N=200, Omega=50, n_diameters=1)


def test_quicklook_marks_the_separation_and_draws_bands():
    p = P.replace(N=60.0)
    start = simulate(p, 1e-6).final_state
    kicked = start.replace(alpha=start.alpha + np.array([0.0, 20.0]), time=0.0)
    window = Window(start=0.0, stop=0.02, rate=2000)
    windows = {"bins": window.replace(envelope=4), "all": window}
    result = simulate(p, 0.02, windows, tol=1e-8, initial_state=kicked)
    assert math.isfinite(result.first_separation)
    figure = result.plot()
    assert len(figure.axes) == 4
    assert "N = 60 N" in figure.get_suptitle()
    marks = [line for line in figure.axes[1].lines if line.get_linestyle() == "--"]
    assert marks[0].get_xdata()[0] == result.first_separation
    plt.close(figure)
    with pytest.raises(ParameterError, match=r"windows: must have one window or more to be drawn"):
        simulate(P, 1e-3).plot()
