"""Results of simulations."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from disc_model import errors
from disc_model.data.variables import BESIDE_WINDOWS, COUNTS, EVENT_KINDS, PHASES, SCALARS
from disc_model.engine.event_loop import EVENT_ROW
from disc_model.errors import Fault, ParameterError, Status, as_text, raise_faults, violations
from disc_model.parameters import Parameters
from disc_model.simulation.case import Record
from disc_model.simulation.ramps import RAMPED, Ramp, values_at
from disc_model.simulation.states import Array, State, is_finite_array

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.figure import Figure


_ERRORS: dict[Status, type[errors.SimulationError]] = {
    Status.STEP_LIMIT: errors.StepLimit,
    Status.PARADOX: errors.PainleveParadox,
    Status.STALLED: errors.Stalled,
    Status.NON_FINITE: errors.NonFinite,
}
STATUS_OF = {error: status for status, error in _ERRORS.items()}


@dataclass(frozen=True, eq=False, repr=False)
class Result:
    """A finished simulation, or the part of it that could be computed; see `status`.

    Attributes
    ----------
    parameters, t_end (s), tol, record : as given to `simulate`
    status, message : how the simulation ended; the message gives the time, the phase and the reason
    event_rows : shape (n_events, len(EVENT_ROW)), the data of `events`: phase by its index in `PHASES`, kind by its
        index in `EVENT_KINDS`
    events : DataFrame with time (s), kind, phase (entered), psi (rad), f (rad/s), u (m), u_velocity (m/s), P (N), all
        just after the event; made at its first use
    first_separation : s, nan if contact was never lost
    final_state : `State` at the end
    u_0 : m, static height of the slider
    samples : one dict of arrays per window
    poincare : dict of arrays, None if not requested
    ramps : as given to `simulate`
    statistics : steps, events, separations, time_stick, time_slip, time_separation (s), energy_residual,
        energy_residual_transverse, energy_residual_inplane, audited_steps, wall_time (s)
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
    ramps: tuple[Ramp, ...] = ()

    @cached_property
    def events(self) -> pd.DataFrame:
        """The events as a table, made at its first use, because making it takes longer than a short simulation."""
        import pandas as pd

        def words(name: str, meanings: tuple[str, ...]) -> pd.Categorical[str]:
            return pd.Categorical.from_codes(columns[name].astype(np.int64), categories=pd.Index(list(meanings)))

        columns = dict(zip(EVENT_ROW, self.event_rows.T, strict=True))
        named = {"time": columns["time"], "kind": words("kind", EVENT_KINDS), "phase": words("phase", PHASES)}
        return pd.DataFrame(named | {name: columns[name] for name in ("psi", "f", "u", "u_velocity", "P")})

    def value_at(self, name: str, times: ArrayLike) -> Array:
        """Omega (rad/s) or N (N) at given times (s), ramps included.

        Raises
        ------
        ParameterError
            If the name is another one, or a time is not a finite number.
        """
        known = isinstance(name, str) and name in RAMPED
        finite = is_finite_array(times, flat=False)
        rule = f"must be one of {', '.join(RAMPED)}"
        raise_faults(violations((known, "name", name, rule), (finite, "times", times, "must be finite numbers")))
        return values_at(self.parameters, self.ramps, name, times)

    def to_tree(self, names: Sequence[str] | None = None) -> xr.DataTree:
        """The whole result in the layout of files, with CF attributes; see `disc_model.data.dataset`.

        Its root holds the scalars, and its groups are "events" (along `event`), one per window, and "poincare" (along
        `time`).

        Parameters
        ----------
        names : names of the windows, in their order; ``sample_0``, ``sample_1``, ... if not given

        Raises
        ------
        ParameterError
            If the names are not distinct, or not as many as windows.
        """
        from disc_model.data.dataset import events_dataset, samples_dataset, scalars_dataset, to_tree

        scalars = scalars_dataset(self.parameters, self._scalars(), self.status.value, self.message)
        if self.ramps:
            scalars.attrs["ramps"] = json.dumps([ramp.model_dump() for ramp in self.ramps])
        groups = {"": scalars, "events": events_dataset(self.events)}
        names = [f"sample_{i}" for i in range(len(self.samples))] if names is None else _checked_names(names, self)
        for name, window, data in zip(names, self.record.windows, self.samples, strict=True):
            groups[name] = samples_dataset(data, window.theta)
        if self.poincare is not None and self.record.poincare is not None:
            groups["poincare"] = samples_dataset(self.poincare, self.record.poincare.theta)
        return to_tree(groups)

    def _scalars(self) -> dict[str, float]:
        """Values of `disc_model.data.variables.SCALARS`, but for the status."""
        values = {name: self.statistics[name] for name in SCALARS if name in self.statistics}
        values |= {name: self.statistics[key] for name, key in COUNTS.items()}
        return values | {
            "first_separation": self.first_separation,
            "t_end": self.t_end,
            "time_reached": self.final_state.time,
            "tol": self.tol,
            "u_0": self.u_0,
        }

    def save(self, path: str | Path, names: Sequence[str] | None = None) -> None:
        """Write `to_tree` as netCDF, in one piece; `disc_model.load` reads it.

        Parameters
        ----------
        names : names of the windows, as for `to_tree`

        Raises
        ------
        ParameterError
            Under the conditions of `to_tree`.
        disc_model.data.dataset.WriteError
            If the folder does not exist, or the disk is full.
        """
        from disc_model.data.dataset import save

        save(self.to_tree(names), path)

    def plot(self) -> Figure:
        """Quick plot of contact force and disc displacement, one column a window, as a matplotlib figure.

        Raises
        ------
        ParameterError
            If no window was recorded.
        ImportError
            If matplotlib is not installed; the message names the extra that installs it.
        """
        try:
            from disc_model.simulation.quicklook import quicklook
        except ModuleNotFoundError as error:
            reason = f"Result.plot needs {error.name}: pip install 'disc_model[workflow]' brings it"
            raise ModuleNotFoundError(reason, name=error.name) from None
        return quicklook(self)

    def __repr__(self) -> str:
        p, first = self.parameters, self.first_separation
        lost = "no separation" if math.isnan(first) else f"first separation at {first:.6f} s"
        windows = f"{len(self.samples)} window{'' if len(self.samples) == 1 else 's'}"
        ended = f"{self.status.value} at {self.final_state.time:.9g} s"
        events = self.statistics["events"]
        ramped = "".join(f", {ramp.parameter} to {ramp.to:g}" for ramp in self.ramps)
        return f"Result(N={p.N:g} N, Omega={p.Omega:g} rad/s{ramped}: {ended}, {lost}, {events} events, {windows})"

    def raise_for_status(self) -> Result:
        """Return self if the run is complete; otherwise raise its `SimulationError`."""
        if not self.status.complete:
            raise _ERRORS[self.status](f"{self.message}. {self.status.advice}")
        return self


_GROUP = re.compile(r"\w([^/]{0,58}[^/\s])?")
"""Names that netCDF accepts for a group, whatever their length in bytes, and that are readable."""


def _checked_names(names: Sequence[str], result: Result) -> Sequence[str]:
    """Names of a result's windows, checked: each becomes a group of a file, beside the groups of every file."""
    listed = list(names) if np.iterable(names) and not isinstance(names, str) else [names]
    good = all(isinstance(name, str) and _GROUP.fullmatch(name) and name.isprintable() for name in listed)
    if not good or not len(listed) == len(result.samples) == len(set(listed) - set(BESIDE_WINDOWS)):
        rule = f"must be {len(result.samples)} different names, one a window, of at most 60 printable characters, "
        rule += "a letter, digit or _ first, no / and no space last, none of them that of a variable"
        raise ParameterError(Fault(("names",), as_text(names), rule))
    return listed
