"""The engine with a column for every coordinate of the full system."""

import numpy as np

from disc_model import Parameters
from disc_model.engine import saltation, section
from disc_model.engine.columns import build_tangent, column_of, n_rows
from disc_model.engine.loop import FlightLimits
from disc_model.engine.model import build_state
from disc_model.engine.series import build_series
from disc_model.simulation.states import State, engine_case, series_order, write_state


class Full:
    """The engine with a column for every coordinate: those of the modes, psi, f; u and u' too if
    asked for.

    scalars : how many of psi, f, u, u' are coordinates
    """

    def __init__(self, p: Parameters, start: State, tol: float = 1e-14, scalars: int = 2):
        case = engine_case(p)
        self.order = series_order(tol)
        self.tol = tol
        self.model = case.model
        width = len(self.model.mode_amplitude)
        n0 = len(self.model.mode_amplitude0)
        used = np.flatnonzero(self.model.shift)
        single = np.arange(n0)
        rows = [
            used,
            width + used,
            2 * width + single,
            2 * width + n0 + single,
            2 * (width + n0) + np.arange(scalars),
        ]
        self.rows = np.concatenate(rows)
        self.series, self.state = (build_series(self.model, self.order), build_state(self.model))
        self.tangent = build_tangent(self.model, len(self.rows), self.order)
        self.n_rows = n_rows(self.model)
        write_state(case, start, self.state)
        self.set_columns(np.eye(len(self.rows)))

    def set_columns(self, columns):
        now = np.zeros((self.n_rows, self.tangent.columns))
        now[self.rows, : columns.shape[1]] = columns
        self.tangent.now[:] = now.reshape(self.n_rows, -1, 8).transpose(1, 0, 2).ravel()

    @property
    def columns(self):
        now = (
            self.tangent.now.reshape(-1, self.n_rows, 8).transpose(1, 0, 2).reshape(self.n_rows, -1)
        )
        return now[self.rows, : len(self.rows)]

    @property
    def coordinates(self):
        return column_of(self.state, self.model)[self.rows]

    @property
    def rates(self):
        out = np.zeros(self.n_rows * 8)
        saltation.rates(self.model, self.state, out)
        return out[::8][self.rows]

    def fly(self, duration, tangent=True):
        limits = (self.order, self.tol, 2.0, duration, 0)
        course = FlightLimits(*limits, may_separate=True, tangent=tangent)
        return section.integrate(self.model, self.series, self.state, self.tangent, course)
