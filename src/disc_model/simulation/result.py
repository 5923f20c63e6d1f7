"""What a simulation starts from and returns, and the engine's lanes behind it."""

from __future__ import annotations

import dataclasses
import json
import math
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from disc_model import errors
from disc_model.data.variables import BESIDE_WINDOWS, COUNTS, EVENT_KINDS, PHASES, SCALARS, STATUSES
from disc_model.engine import layout
from disc_model.engine.audit import N_SUMS
from disc_model.engine.event_loop import EVENT_ROW, N_COUNTERS
from disc_model.engine.transitions import TOUCHING
from disc_model.errors import Fault, ParameterError, Status, shown
from disc_model.flexibility import contact_give
from disc_model.parameters import RESIDUAL, Parameters, is_number
from disc_model.plate import modal_damping, mode_arrays
from disc_model.plausibility import warn_of_doubts
from disc_model.simulation.case import Record
from disc_model.simulation.ramps import RAMPED, Ramp, values_at

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.figure import Figure


Array = NDArray[np.float64]

_ERRORS: dict[Status, type[errors.SimulationError]] = {
    Status.STEP_LIMIT: errors.StepLimit,
    Status.PARADOX: errors.PainleveParadox,
    Status.STALLED: errors.Stalled,
    Status.NON_FINITE: errors.NonFinite,
}


@dataclass(frozen=True, eq=False, repr=False)
class State:
    """Where the system is, in the slider's frame.

    Attributes
    ----------
    time : s
    phase : "stick", "slip" or "separation"
    direction : sgn(f) in slip, 0 otherwise
    psi : rad, drive point's angle ahead of the slider
    f : rad/s, the slider's angular speed over the disc
    u, u_velocity : m, m/s, the slider's height and velocity. In rigid contact they are those of the disc under it: a
        start with another u is refused, and u_velocity is not looked at
    a, b, alpha, beta : shape (n_modes,), in the order of `plate_modes`: modal displacements (m sqrt(kg)) and velocities
        along and across the slider's direction; b = beta = 0 for modes without nodal diameter
    known : multiplicity of the root that the phase's switch function has at this very instant (0 away from a switch)
    case_key : the case in which it was computed; phase and `known` of a switch are found anew in any other
    mode_amplitudes : kg^-1/2, shape (n_modes,), psi of the `plate_modes` that a, b, alpha and beta belong to. A case
        with others refuses the state. None if it was made by hand
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
    case_key: str = ""
    mode_amplitudes: Array | None = None

    def replace(self, **changes: Any) -> State:
        """A copy with some values changed.

        A new time is meant exactly, so that `time_low` starts at 0 with it.  With any other change the state is no
        longer that of its case, and `case_key` becomes empty.
        """
        if "time" in changes:
            changes = {"time_low": 0.0} | changes
        if not changes.keys() <= {"time", "time_low"}:
            changes = {"case_key": ""} | changes
        return dataclasses.replace(self, **changes)

    def __repr__(self) -> str:
        return (
            f"State(time={self.time:.9g} s, {self.phase}, psi={self.psi:.6g} rad, f={self.f:.6g} rad/s, "
            f"u={self.u:.6g} m, u_velocity={self.u_velocity:.6g} m/s, {len(self.a)} modes)"
        )

    def save(self, path: str | Path) -> None:
        """Write it as netCDF, to the last bit.

        Raises
        ------
        disc_model.data.dataset.WriteError
            If there is no such folder, or the disk is full.
        """
        import xarray as xr

        from disc_model.data import dataset

        modal = {
            name: ("mode", np.asarray(getattr(self, name), float), {"units": unit}) for name, unit in _MODAL.items()
        }
        plain = {name: ((), float(getattr(self, name)), {"units": unit}) for name, unit in _PLAIN.items()}
        if self.mode_amplitudes is not None:
            modal["mode_amplitudes"] = ("mode", np.asarray(self.mode_amplitudes, float), {"units": "kg-1/2"})
        whole = {name: ((), np.int64(getattr(self, name))) for name in ("direction", "known")}
        attrs = {"Conventions": dataset.CONVENTIONS, "phase": self.phase, "case_key": self.case_key}
        dataset.save(xr.DataTree(xr.Dataset(modal | plain | whole, attrs=attrs)), path)

    @classmethod
    def load(cls, path: str | Path) -> State:
        """Read a file that `save` has written.

        Raises
        ------
        ParameterError
            If it holds no state.
        disc_model.data.dataset.DamagedFile
            If it is not what was written.
        """
        from disc_model.data import dataset

        found = dataset.load(path).to_dataset()
        wanted = (*_MODAL, *_PLAIN, "direction", "known")
        if "phase" not in found.attrs or not {*wanted} <= found.data_vars.keys():
            raise ParameterError(Fault(("path",), shown(str(path)), "must be a file written by State.save"))
        held: dict[str, Any] = {name: found[name].values for name in _MODAL}
        held |= {name: float(found[name]) for name in _PLAIN}
        held |= {name: int(found[name]) for name in ("direction", "known")}
        held |= {name: found[name].values for name in ("mode_amplitudes",) if name in found}
        return cls(phase=str(found.attrs["phase"]), case_key=str(found.attrs.get("case_key", "")), **held)


_MODAL = {"a": "m kg1/2", "b": "m kg1/2", "alpha": "m kg1/2 s-1", "beta": "m kg1/2 s-1"}
_PLAIN = {"time": "s", "time_low": "s", "psi": "rad", "f": "rad s-1", "u": "m", "u_velocity": "m s-1"}
"""Units of what a state's file holds, by shape."""


@dataclass(frozen=True, eq=False, repr=False)
class Result:
    """A finished simulation, or as much of it as could be computed; see `status`.

    Attributes
    ----------
    parameters, t_end (s), tol, record : what was asked
    status, message : how it ended; the message says at what time, in what phase and why
    event_rows : shape (n_events, len(EVENT_ROW)), what `events` is made of: phase by its place in `PHASES`, kind by
        that in `EVENT_KINDS`
    events : DataFrame with time (s), kind, phase (entered), psi (rad), f (rad/s), u (m), u_velocity (m/s), P (N), all
        just after the event; made when it is first asked for
    first_separation : s, nan if contact was never lost
    final_state : `State` at the end
    u_0 : m, static height of the slider
    samples : one dict of arrays per window
    poincare : dict of arrays, None if not asked for
    ramps : those that were asked for
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
        """The switches as a table: to make one takes longer than a short simulation."""
        import pandas as pd

        def words(name: str, meanings: tuple[str, ...]) -> pd.Categorical[str]:
            return pd.Categorical.from_codes(columns[name].astype(np.int64), categories=pd.Index(list(meanings)))

        columns = dict(zip(EVENT_ROW, self.event_rows.T, strict=True))
        named = {"time": columns["time"], "kind": words("kind", EVENT_KINDS), "phase": words("phase", PHASES)}
        return pd.DataFrame(named | {name: columns[name] for name in ("psi", "f", "u", "u_velocity", "P")})

    def value_at(self, name: str, times: ArrayLike) -> Array:
        """Omega (rad/s) or N (N) at given times (s), on ramps and off them.

        Raises
        ------
        ParameterError
            For another name, or times that are no finite numbers.
        """
        known = isinstance(name, str) and name in RAMPED
        errors.refuse(
            errors.broken(
                (known, "name", name, f"must be one of {', '.join(RAMPED)}"),
                (is_finite_array(times, flat=False), "times", times, "must be finite numbers"),
            )
        )
        return values_at(self.parameters, self.ramps, name, times)

    def to_tree(self, names: Sequence[str] | None = None) -> xr.DataTree:
        """All of it in the layout of files, with CF attributes; see `disc_model.data.dataset`.

        Parameters
        ----------
        names : of the windows, in their order; ``sample_0``, ``sample_1``, ... if not given

        Raises
        ------
        ParameterError
            If they are not as many different names as windows.
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
        if not isinstance(group, str) or group not in groups:
            raise ParameterError(f"group={shown(group)}: must be one of {', '.join(map(repr, groups))}")
        return groups[group]

    def _groups(self, names: Sequence[str] | None = None) -> dict[str, xr.Dataset]:
        """Datasets by group: "" for the scalars, "events", one per window, "poincare"."""
        from disc_model.data.dataset import events_dataset, samples_dataset, scalars_dataset

        scalars = scalars_dataset(self.parameters, self._scalars(), self.status.value, self.message)
        if self.ramps:
            scalars.attrs["ramps"] = json.dumps([ramp.model_dump() for ramp in self.ramps])
        groups = {"": scalars, "events": events_dataset(self.events)}
        names = [f"sample_{i}" for i in range(len(self.samples))] if names is None else _checked_names(names, self)
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

    def save(self, path: str | Path, names: Sequence[str] | None = None) -> None:
        """Write `to_tree` as netCDF, in one piece and with a checksum; `disc_model.load` reads it.

        Parameters
        ----------
        names : of the windows, as for `to_tree`

        Raises
        ------
        ParameterError
            As of `to_tree`.
        disc_model.data.dataset.WriteError
            If there is no such folder, or the disk is full.
        """
        from disc_model.data.dataset import save

        save(self.to_tree(names), path)

    def plot(self) -> Figure:
        """A first look: contact force and disc displacement, one column a window, as a matplotlib figure.

        Raises
        ------
        ParameterError
            If no window was recorded.
        ImportError
            If there is no matplotlib; the message says which extra brings it.
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
        kept = f"{len(self.samples)} window{'' if len(self.samples) == 1 else 's'}"
        ended = f"{self.status.value} at {self.final_state.time:.9g} s"
        events = self.statistics["events"]
        ramped = "".join(f", {ramp.parameter} to {ramp.to:g}" for ramp in self.ramps)
        return f"Result(N={p.N:g} N, Omega={p.Omega:g} rad/s{ramped}: {ended}, {lost}, {events} events, {kept})"

    def raise_for_status(self) -> Result:
        """Return self, or raise the `SimulationError` of an incomplete run."""
        if not self.status.complete:
            raise _ERRORS[self.status](f"{self.message}. {self.status.advice}")
        return self


_GROUP = re.compile(r"\w([^/]{0,58}[^/\s])?")
"""What netCDF takes as the name of a group, whatever its characters take in bytes, and everybody can read."""


def _checked_names(names: Sequence[str], result: Result) -> Sequence[str]:
    """Names of a result's windows: each becomes a group of a file, beside those that are there in any case."""
    given = list(names) if np.iterable(names) and not isinstance(names, str) else [names]
    good = all(isinstance(name, str) and _GROUP.fullmatch(name) and name.isprintable() for name in given)
    if not good or not len(given) == len(result.samples) == len(set(given) - set(BESIDE_WINDOWS)):
        rule = f"must be {len(result.samples)} different names, one a window, of at most 60 printable characters, "
        rule += "a letter, digit or _ first, no / and no space last, none of them that of a variable"
        raise ParameterError(Fault(("names",), shown(names), rule))
    return given


# ----------------------------------------------------------------------------------------------------
# Between `Parameters` and `State` (modes in the order of `plate_modes`) and the engine's lanes

CASES = 32
"""Cases whose constants and workspaces are kept: tens of kilobytes each, with a thousand modes a few megabytes."""


class Workspace(NamedTuple):
    """What the engine writes to in a run: of one run at a time.

    state, probe : where the run is, and where it looks ahead
    series : of one step; the next begins them anew
    counters, phase_times, sums : as in `event_loop.RunBuffers`
    """

    state: layout.EngineState
    probe: layout.EngineState
    series: layout.Series
    counters: np.ndarray
    phase_times: np.ndarray
    sums: np.ndarray


class EngineCase(NamedTuple):
    """What the engine is given of a case.  Shared by all runs of the case, and therefore never written.

    model, start : the engine's constants, and the static start
    key, amplitudes : what states of the case carry as `case_key` and `mode_amplitudes`
    present : of a, b, alpha and beta of all modes, in this order, the numbers of those that there are: modes without
        nodal diameter have no b and beta
    places : of these in `layout.EngineState.disc`
    point : u, u' (but for the slope's share) and slope B of the disc under the slider from `layout.EngineState.disc`
    idle : workspaces that no run uses now, by the order of their series; all that changes here
    """

    model: layout.Model
    start: layout.EngineState
    key: str
    amplitudes: np.ndarray
    present: np.ndarray
    places: np.ndarray
    point: np.ndarray
    idle: dict[int, list[Workspace]]


@lru_cache(maxsize=CASES)
def engine_case(p: Parameters) -> EngineCase:
    """The engine's constants of a case; what equal parameters have found before is found again."""
    warn_of_doubts(p)
    modes = mode_arrays(p)
    names = ("N", "Omega", "k", "c", "m", "k_p", "c_p", "mu_s", "mu_k", "r_0")
    model = layout.build_model(
        modes.diameters,
        modes.omega,
        modes.psi,
        modal_damping(p),
        {name: getattr(p, name) for name in names},
        bonded=p.contact == "bonded",
        compliance=contact_give(p) if p.contact_compliance == RESIDUAL else float(p.contact_compliance),
        normal=p.contact_force == "normal",
    )
    pairs, single = np.flatnonzero(modes.diameters > 0), np.flatnonzero(modes.diameters == 0)
    lane, width, n_modes = layout.pair_lanes(len(pairs)), len(model.shift), len(modes.diameters)
    places = np.full((4, n_modes), -1)
    places[:, pairs] = lane + np.array([[0], [layout.HALF], [width], [width + layout.HALF]])
    places[0::2, single] = 2 * width + np.arange(len(single)) + np.array([[0], [len(single)]])
    present = np.flatnonzero(places >= 0)
    point, start = _point(model), layout.build_state(model)
    return EngineCase(model, start, p.key, modes.psi, present, places.ravel()[present], point, {})


def _point(model: layout.Model) -> np.ndarray:
    """See `EngineCase`."""
    width, n0 = len(model.mode_amplitude), len(model.mode_amplitude0)
    point = np.zeros((3, layout.disc_size(width, n0, len(model.compliance) == 1)))
    u, v, slope = point[:, : 2 * (width + n0)]
    u[:width], u[2 * width : 2 * width + n0] = model.mode_amplitude, model.mode_amplitude0
    v[width : 2 * width], v[2 * width + n0 :] = model.mode_amplitude, model.mode_amplitude0
    slope[:width] = model.dw_dtheta
    return point


def take_workspace(case: EngineCase, order: int) -> Workspace:
    """A workspace of the caller's own, at the static start, with nothing counted; for `give_back` in the end.

    To make one takes as long as 30 steps.
    """
    try:
        found = case.idle[order].pop()
    except LookupError:
        state, probe = layout.build_state(case.model), layout.build_state(case.model)
        series, counters = layout.build_series(case.model, order), np.zeros(N_COUNTERS, np.int64)
        return Workspace(state, probe, series, counters, np.zeros(3), np.zeros(N_SUMS))
    for state in (found.state, found.probe):
        state.disc[:], state.x[:] = case.start.disc, case.start.x
    for counted in (found.counters, found.phase_times, found.sums):
        counted.fill(0)
    return found


def give_back(case: EngineCase, order: int, workspace: Workspace) -> None:
    """Leave a workspace to later runs."""
    case.idle.setdefault(order, []).append(workspace)


def read_state(case: EngineCase, state: layout.EngineState, key: str = "") -> State:
    """The engine's state as a `State`; key: of the case if it is not its own, as on ramps."""
    modal = np.zeros(4 * len(case.amplitudes))
    modal[case.present] = state.disc[case.places]
    modal.setflags(write=False)
    a, b, alpha, beta = modal.reshape(4, -1)
    x = state.x.tolist()
    phase, f = int(x[layout.PHASE]), x[layout.SPEED]
    u, v = x[layout.U], x[layout.U_VELOCITY]
    if phase != layout.SEPARATION and len(case.model.compliance) != 1:
        u, v, slope = case.point.dot(state.disc).tolist()
        v += f * slope
    return State(
        time=x[layout.TIME],
        time_low=x[layout.TIME_LOW],
        phase=PHASES[phase],
        direction=int(x[layout.DIRECTION]),
        psi=x[layout.PSI],
        f=f,
        u=u,
        u_velocity=v,
        known=int(x[layout.KNOWN]),
        case_key=key or case.key,
        mode_amplitudes=case.amplitudes,
        a=a,
        b=b,
        alpha=alpha,
        beta=beta,
    )


def write_state(case: EngineCase, given: State, state: layout.EngineState, key: str = "") -> bool:
    """Put ``given`` into the engine's state; key: of the case if it is not its own, as on ramps.

    Returns
    -------
    Whether the engine is to find out what holds at this instant, before any time passes: at a switch of another case.

    Raises
    ------
    ParameterError
        If arrays have the wrong shape, numbers are not finite, the phase contradicts the velocities, or the state
        belongs to other modes.
    """
    faults = _faults(given, case)
    if faults:
        raise ParameterError(*faults)
    state.disc.fill(0.0)
    state.x.fill(0.0)
    state.disc[case.places] = np.concatenate((given.a, given.b, given.alpha, given.beta))[case.present]
    if given.phase != "separation" and len(case.model.compliance) != 1:  # else u is a state of its own
        _check_height(case, given.u, state)
    x = state.x
    x[layout.TIME], x[layout.TIME_LOW] = given.time, given.time_low
    x[layout.PSI], x[layout.SPEED] = given.psi, given.f
    x[layout.U], x[layout.U_VELOCITY] = given.u, given.u_velocity
    x[layout.PHASE] = PHASES.index(given.phase)
    x[layout.DIRECTION] = given.direction if given.phase == "slip" else 0.0
    x[layout.KNOWN] = given.known
    return bool(given.known) and given.case_key != (key or case.key) and _forget_switch(case, state)


def _forget_switch(case: EngineCase, state: layout.EngineState) -> bool:
    """Look at a state at a switch of another case: what vanishes in that case need not in this one.

    A slider that touches the disc, and neither leaves nor hits it, is put into contact, where the engine is to find out
    whether it stays there.  Returns whether that is so.
    """
    x, sizes = state.x, np.abs(case.point).dot(np.abs(state.disc))
    w, velocity, slope = case.point.dot(state.disc)
    f, compliant, known = x[layout.SPEED], len(case.model.compliance) == 1, x[layout.KNOWN]
    opening = x[layout.U_VELOCITY] - velocity - f * slope
    touches = abs(x[layout.U] - w) <= SAME_HEIGHT * sizes[0]
    rests = abs(opening) <= SAME_HEIGHT * (sizes[1] + abs(f) * sizes[2])
    x[layout.KNOWN] = 0.0
    if x[layout.PHASE] == layout.SEPARATION and touches and not rests:
        x[layout.KNOWN] = 1.0 if opening > 0 else 0.0
    elif compliant and touches and known >= TOUCHING:
        x[layout.KNOWN] = TOUCHING + (1 if f == 0 and x[layout.PHASE] == layout.SLIP else 0)
    elif touches or x[layout.PHASE] == layout.SLIP:
        x[layout.PHASE], x[layout.DIRECTION] = layout.SLIP if f else layout.STICK, np.sign(f)
        return True
    return False


SAME_HEIGHT = 1e-9
"""Of the disc's deflection: far more than rounding, and far less than what anybody means by another height."""
SAME_AMPLITUDE = 1e-9
"""Of the largest amplitude: modes computed on two processors differ by 1e-13 of it at most, as measured."""


def _check_height(case: EngineCase, u: float, state: layout.EngineState) -> None:
    """In contact the disc says where the slider is: another u would be passed over in silence."""
    row = case.point[0]
    w = float(row.dot(state.disc))
    off = abs(u - w)
    # what is within this share of w itself, as nearly always, need not be compared with the modes' shares
    if off > SAME_HEIGHT * abs(w) and off > SAME_HEIGHT * float(np.abs(row).dot(np.abs(state.disc))):
        rule = f"must be the disc's displacement under the slider in contact, {w:.9g}; change a with it, or the phase"
        raise ParameterError(Fault(("initial_state", "u"), shown(u), rule))


def _faults(given: State, case: EngineCase) -> list[str]:
    faults: list[str] = []
    n_modes = len(case.amplitudes)
    # contact and its force can begin at once where contact is compliant
    highest_known = 7 if len(case.model.compliance) == 1 else 3

    def add(name: str, rule: str, value: object = None) -> None:
        faults.append(Fault(("initial_state", name), "" if value is None else shown(value), rule))

    for name in _MODAL:
        if not is_finite_array(getattr(given, name), n_modes):
            add(name, f"must be {n_modes} finite numbers, one per row of plate_modes")
    faults += amplitude_faults(given, case.amplitudes, ("initial_state",))
    endless = [name for name in _PLAIN if not _is_finite(getattr(given, name))]
    for name in endless:
        if name != "time_low":
            add(name, "must be finite", getattr(given, name))
    # the clock's compensation is at most a unit in the last place of the time
    if "time_low" in endless or ("time" not in endless and abs(given.time_low) > math.ulp(given.time)):
        add("time_low", "must be less than the last digit of the time", given.time_low)
    if not _is_among(given.known, range(highest_known + 1)):
        rule = "0, 1, 2 or 3" if highest_known == 3 else f"a whole number from 0 to {highest_known}"
        add("known", f"must be {rule}", given.known)
    if not isinstance(given.phase, str) or given.phase not in PHASES:
        add("phase", f"must be one of {', '.join(PHASES)}", given.phase)
    elif given.phase == "stick" and "f" not in endless and given.f != 0:
        add("f", "must be 0 in stick", given.f)
    elif given.phase == "slip" and not _is_among(given.direction, (-1, 1)):
        add("direction", "must be -1 or 1 in slip", given.direction)
    elif given.phase == "slip" and "f" not in endless and given.f * given.direction < 0:
        add("f", f"must have the sign of direction={given.direction}", given.f)
    return faults


def amplitude_faults(given: State, amplitudes: Array, place: tuple[str, ...]) -> list[str]:
    """What is wrong with a state's `mode_amplitudes` for a case whose modes have these, shape (n_modes,)."""
    own = given.mode_amplitudes
    if own is None or own is amplitudes:
        return []
    place = (*place, "mode_amplitudes")
    if not is_finite_array(own, len(amplitudes)):
        return [Fault(place, "", f"must be {len(amplitudes)} finite numbers, psi of plate_modes")]
    other = np.abs(own - amplitudes) > SAME_AMPLITUDE * np.max(np.abs(amplitudes), initial=0.0)
    rule = "must be {:.9g}, psi of this mode in plate_modes: the state belongs to other modes"
    return [
        Fault((*place, str(i)), shown(float(own[i])), rule.format(amplitudes[i])) for i in np.flatnonzero(other)[:1]
    ]


def _is_finite(value: object) -> bool:
    return is_number(value) and math.isfinite(value)  # type: ignore[arg-type]


def _is_among(value: object, known: Collection[int]) -> bool:
    """Whether a value is one of a few whole numbers; a bool is none."""
    return is_number(value) and value in known


def is_finite_array(values: object, size: int | None = None, *, flat: bool = True) -> bool:
    """Whether values are finite real numbers: so many, or any number of them, and in one dimension if `flat`."""
    try:
        array = np.asarray(values)
    except (TypeError, ValueError):
        return False
    fits = size in (None, array.size) and (array.ndim == 1 or not flat)
    return fits and array.dtype.kind in "fiu" and all(map(math.isfinite, array.ravel().tolist()))


# ----------------------------------------------------------------------------------------------------
# From the one tolerance a user gives to the order and the local tolerance of the series

# Local truncation error for a tolerance of 1.  Event times over a second of motion then are as good as the tolerance
# says, measured against the long-double references (docs/accuracy.md).
LOCAL = 80.0
# The same on a compliant contact: three times as many steps follow a motion of the slider on the contact that little
# damps, and errors gather in it.
LOCAL_COMPLIANT = LOCAL / 16
# A looser step is no cheaper, because the series must reach from switch to switch anyway, and begins to lose switches.
LOOSEST = 1e-5


def series_tolerance(tol: float, compliant: bool = False) -> float:
    """Size of the last terms of a step, relative to the state's scale."""
    return min((LOCAL_COMPLIANT if compliant else LOCAL) * tol, LOOSEST)


def series_order(tol: float) -> int:
    """Degree of the Taylor series, an even number: cheapest for the tolerance, measured (20 at 1e-10)."""
    digits = -math.log10(series_tolerance(tol))
    return min(max(2 * round(digits + 1.6), 18), 28)
