"""What a simulation returns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from disc_model import errors
from disc_model.data.variables import COUNTS, EVENT_KINDS, PHASES, SCALARS, STATUSES
from disc_model.parameters import Parameters
from disc_model.simulation.record import Record
from disc_model.status import Status

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

Array = NDArray[np.float64]

EVENT_ROW = ("time", "kind", "phase", "direction", "psi", "f", "u", "u_velocity", "P")
"""Columns of `Result.event_rows`, as the engine writes them; phase by its place in `PHASES`, kind in `EVENT_KINDS`."""


_ERRORS: dict[Status, type[errors.SimulationError]] = {
    Status.STEP_LIMIT: errors.StepLimit,
    Status.PARADOX: errors.PainleveParadox,
    Status.STALLED: errors.Stalled,
    Status.NON_FINITE: errors.NonFinite,
}


@dataclass(frozen=True, eq=False)
class State:
    """Where the system is, in the slider's frame.

    Attributes
    ----------
    time : s
    phase : "stick", "slip" or "separation"
    direction : sgn(f) in slip, 0 otherwise
    psi : rad, drive point's angle ahead of the slider
    f : rad/s, the slider's angular speed over the disc
    u, u_velocity : m, m/s, the slider's height and velocity (those of the disc's point in contact)
    a, b, alpha, beta : shape (n_modes,), in the order of `plate_modes`: modal displacements (m sqrt(kg)) and velocities
        along and across the slider's direction; b = beta = 0 for modes without nodal diameter
    known : multiplicity of the root that the phase's switch function has at this very instant (0 away from a switch)
    """

    time: float
    phase: str
    direction: int
    psi: float
    f: float
    u: float
    u_velocity: float
    a: Array
    b: Array
    alpha: Array
    beta: Array
    time_low: float = 0.0
    known: int = 0

    def replace(self, **changes: Any) -> State:
        """A copy with some values changed."""
        import dataclasses

        return dataclasses.replace(self, **changes)


@dataclass(frozen=True, eq=False)
class Result:
    """A finished simulation, or as much of it as could be computed; see `status`.

    Attributes
    ----------
    parameters, t_end (s), tol, record : what was asked
    status, message : how it ended; the message says at what time, in what phase and why
    event_rows : shape (n_events, len(EVENT_ROW)), what `events` is made of
    events : DataFrame with time (s), kind, phase (entered), psi (rad), f (rad/s), u (m), u_velocity (m/s), P (N), all
        just after the event; made when it is first asked for
    first_separation : s, nan if contact was never lost
    final_state : `State` at the end
    u_0 : m, static height of the slider
    samples : one dict of arrays per window
    poincare : dict of arrays, None if not asked for
    statistics : steps, events, separations, time_stick, time_slip, time_separation (s), energy_residual,
        energy_transverse, energy_inplane, audited_steps, wall_time (s)
    """

    parameters: Parameters
    t_end: float
    tol: float
    record: Record
    status: Status
    message: str
    event_rows: Array = field(repr=False)
    first_separation: float
    final_state: State
    u_0: float
    statistics: Mapping[str, float]
    samples: tuple[dict[str, Array], ...] = ()
    poincare: dict[str, Array] | None = field(default=None)

    @cached_property
    def events(self) -> pd.DataFrame:
        """The switches as a table: to make one takes longer than a short simulation."""
        import pandas as pd

        def words(name: str, meanings: tuple[str, ...]) -> pd.Categorical[str]:
            return pd.Categorical.from_codes(columns[name].astype(np.int64), categories=pd.Index(list(meanings)))

        columns = dict(zip(EVENT_ROW, self.event_rows.T, strict=True))
        named = {"time": columns["time"], "kind": words("kind", EVENT_KINDS), "phase": words("phase", PHASES)}
        return pd.DataFrame(named | {name: columns[name] for name in ("psi", "f", "u", "u_velocity", "P")})

    def to_tree(self, names: Sequence[str] | None = None) -> xr.DataTree:
        """All of it in the layout of files, with CF attributes; see `disc_model.data.dataset`.

        Parameters
        ----------
        names : of the windows, in their order; ``sample_0``, ``sample_1``, ... if not given
        """
        from disc_model.data.dataset import to_tree

        return to_tree(self._groups(names))

    def to_dataset(self, group: str = "") -> xr.Dataset:
        """One group of `to_tree`.

        Parameters
        ----------
        group : "" for the scalars, "events" (along `event`), "sample_0", ... or "poincare" (along `time`)

        Raises
        ------
        ParameterError
            If there is no such group.
        """
        groups = self._groups()
        if group not in groups:
            raise errors.ParameterError(f"group={group!r}: must be one of {', '.join(map(repr, groups))}")
        return groups[group]

    def _groups(self, names: Sequence[str] | None = None) -> dict[str, xr.Dataset]:
        """Datasets by group: "" for the scalars, "events", one per window, "poincare"."""
        from disc_model.data.dataset import events_dataset, samples_dataset, scalars_dataset

        scalars = scalars_dataset(self.parameters, self._scalars(), self.status.value, self.message)
        groups = {"": scalars, "events": events_dataset(self.events)}
        names = [f"sample_{i}" for i in range(len(self.samples))] if names is None else names
        for name, window, data in zip(names, self.record.windows, self.samples, strict=True):
            groups[name] = samples_dataset(data, window.theta)
        if self.poincare is not None and self.record.poincare is not None:
            groups["poincare"] = samples_dataset(self.poincare, self.record.poincare.theta)
        return groups

    def _scalars(self) -> dict[str, float]:
        """Values of `disc_model.data.variables.SCALARS`."""
        values = {name: self.statistics[name] for name in SCALARS if name in self.statistics}
        values |= {name: self.statistics[key] for name, key in COUNTS.items()}
        return values | {
            "status": STATUSES.index(self.status.value),
            "first_separation": self.first_separation,
            "t_end": self.t_end,
            "time_reached": self.final_state.time,
            "tol": self.tol,
            "u_0": self.u_0,
        }

    def raise_for_status(self) -> Result:
        """Return self, or raise the `SimulationError` of an incomplete run."""
        if not self.status.complete:
            raise _ERRORS[self.status](f"{self.message}. {self.status.advice}")
        return self
