"""Results of simulations."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import ConfigDict, TypeAdapter

from disc_model import errors
from disc_model.arrays import Array, EqualByValue
from disc_model.data.files import regular_file, unreadable
from disc_model.data.variables import EVENT_KINDS, PHASES, SCALARS, attributes, values_text
from disc_model.disc.plate import mode_arrays
from disc_model.display import counted, drawings, number_text
from disc_model.engine import record
from disc_model.engine.record import EVENT_ROW
from disc_model.errors import Status, require
from disc_model.parameters import Parameters
from disc_model.provenance import versions_text
from disc_model.simulation.case import Poincare, Ramp, Window, Windows
from disc_model.simulation.states import State

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.animation import FuncAnimation
    from matplotlib.axes import Axes
    from numpy.typing import NDArray


_ERRORS: dict[Status, type[errors.SimulationError]] = {
    Status.STEP_LIMIT: errors.StepLimit,
    Status.PARADOX: errors.PainleveParadox,
    Status.STALLED: errors.Stalled,
    Status.NON_FINITE: errors.NonFinite,
}
STATUS_OF = {error: status for status, error in _ERRORS.items()}
SAMPLE_ROW = record.SAMPLE_ROW[1:]
"""Columns of a window."""
FOLDED = ("P", "u", "w", "w_point", "psi", "psi_velocity")
BIN_ROW = ("time", *(f"{name}_{end}" for name in FOLDED for end in ("min", "max")))
"""Columns of a window with an envelope."""
ARRAYS = frozenset({"event_rows", "samples"})
"""Fields of a result that its file holds as variables."""
CYCLES = 4  # of stick and slip that pictures show of the end of a run
SHORTEST = 0.1  # s, of the end of a run that is shown where nothing repeats within a second
BINS = 600  # of the envelope of a run
RATE = 4000.0  # samples of the envelope per second, at least
PER_PERIOD = 16  # samples for a spectrum, of the highest mode: beyond its eighth multiple is little
FINE = 4000  # samples of the last cycles
WRITERS = {".gif": "pillow", ".mp4": "ffmpeg"}  # of films by the suffixes of files


@dataclass(frozen=True, eq=False, repr=False)
class Result(EqualByValue):
    """A finished simulation, or the part of it that could be computed; see `status`.

    Attributes
    ----------
    parameters, t_end (s), tol, ramps, initial_state : as given to `simulate`
    windows : as given to `simulate`, with absolute times
    status, message : how the simulation ended; the message gives the time, the phase and the reason
    event_rows : shape (n_events, len(EVENT_ROW)), the data of `events`: phase by its index in `PHASES`, kind by its
        index in `EVENT_KINDS`
    events : DataFrame with time (s), kind, phase (entered), psi (rad), f (rad/s), u (m), u_velocity (m/s), P (N), all
        just after the event; made at its first use; ``events.attrs["units"]`` has the units
    first_separation : s, nan if contact was never lost
    settled_since : s, from which all points of the first `Poincare` lie on the motion on which the run ends; nan if
        this is not shown
    final_state : `State` at the end
    u_0 : m, static height of the slider
    samples : by window, its arrays by name; ``result["late"]`` is a Dataset of those of the window "late"
    statistics : steps, n_events, n_separations, time_stick, time_slip, time_separation (s); of the audit of energies
        energy_residual, audited_steps and, nan unless every step is audited, energy_residual_transverse and
        energy_residual_inplane; surface_speed, nan unless friction acts on a surface that moves
    versions : JSON of the versions of disc_model and of what it uses, by which the motion was computed

    Examples
    --------
    >>> import disc_model as dm
    >>> run = dm.simulate(dm.Parameters(N=385, Omega=15.1), 1)
    >>> run
    Result(N=385 N, Omega=15.1 rad/s: ok at 1 s, no separation, 135 events, 0 windows)
    >>> print(run.events["kind"].iloc[0], round(run.events["time"].iloc[0], 6))
    stick_to_slip 0.005099
    """

    __pydantic_config__ = ConfigDict(
        extra="forbid", ser_json_inf_nan="strings", arbitrary_types_allowed=True
    )

    parameters: Parameters
    t_end: float
    tol: float
    windows: Windows
    status: Status
    message: str
    event_rows: Array = field(repr=False)
    first_separation: float
    final_state: State
    u_0: float
    statistics: Mapping[str, float]
    samples: Mapping[str, dict[str, Array]] = field(default_factory=dict)
    ramps: tuple[Ramp, ...] = ()
    initial_state: State | None = field(default=None, repr=False)
    versions: str = field(default_factory=versions_text, repr=False, compare=False)

    @property
    def _event_columns(self) -> dict[str, Array]:
        """The columns of `events`, with kind and phase as in `event_rows`."""
        columns = dict(zip(EVENT_ROW, self.event_rows.T, strict=True))
        del columns["direction"]
        return columns

    @cached_property
    def events(self) -> pd.DataFrame:
        """The events as a table, made at its first use, because making it takes longer than a short
        simulation; `attrs` has the units of its columns."""
        import pandas as pd

        table = pd.DataFrame(self._event_columns)
        for name, words in (("kind", EVENT_KINDS), ("phase", PHASES)):
            table[name] = pd.Categorical.from_codes(table[name].astype(int), pd.Index(words))
        units = {name: attributes(str(name)).get("units", "1") for name in table}
        table.attrs["units"] = {name: unit for name, unit in units.items() if unit != "1"}
        return table

    @cached_property
    def settled_since(self) -> float:
        """Time from which all points of the run's first `Poincare` lie on the motion on which it ends, s;
        nan if this is not shown."""
        from disc_model.analysis.classify import settled_since

        bins = (samples for samples in self.samples.values() if "w_point_min" in samples)
        for section in self._sections:
            return settled_since(self.samples[section], next(bins, None))
        return math.nan

    @property
    def _sections(self) -> list[str]:
        """Names of each `Poincare` that has samples."""
        return [
            name
            for name, kept in self.windows.items()
            if isinstance(kept, Poincare) and len(self.samples[name]["time"])
        ]

    def __getitem__(self, name: str) -> xr.Dataset:
        """The samples of a window along `time`, with units and the parameters of the case, by the
        window's name; raises `ParameterError`."""
        from disc_model.data.columns import series_dataset

        rule = f"must be one of the windows: {', '.join(self.samples)}"
        require((name in self.samples, "name", name, rule))
        samples = series_dataset(self.samples[name], "time")
        case = self.parameters.canonical_json
        angle = self.windows[name].theta
        return samples.assign_attrs(parameters=case, theta=angle, theta_units="rad")

    def to_tree(self) -> xr.DataTree:
        """Return the result in the layout of files, with CF attributes: its root holds the scalars, and
        its groups are "events" (along `event`), and each window (along `time`)."""
        import xarray as xr

        from disc_model.data.columns import scalars_dataset, series_dataset

        values = {**self.scalars(), "settled_since": self.settled_since}
        scalars = scalars_dataset(self.parameters, values, self.status.value, self.message)
        scalars.attrs["versions"] = self.versions
        if self.ramps:
            scalars.attrs["ramps"] = json.dumps([ramp.model_dump() for ramp in self.ramps])
        events = series_dataset(self._event_columns, "event")
        events.attrs["parameters"] = self.parameters.canonical_json
        windows = {name: self[name] for name in self.samples}
        return xr.DataTree.from_dict({"/": scalars, "events": events, **windows})

    def scalars(self) -> dict[str, float]:
        """Values of `disc_model.data.variables.SCALARS` that need no samples, but for the status."""
        values = {name: self.statistics[name] for name in SCALARS if name in self.statistics}
        for name in ("first_separation", "t_end", "tol", "u_0"):
            values[name] = getattr(self, name)
        values["time_reached"] = self.final_state.time
        return values

    def save(self, path: str | Path) -> None:
        """Write the whole result, in one piece; `Result.load` reads it back.

        Parameters
        ----------
        path : of a netCDF file, ".nc": the tree of `to_tree`, which `disc_model.load` reads as well, with the text
            ``result``, JSON of the case and of what was found, the states too

        Raises
        ------
        ParameterError
            If the file has another suffix.
        disc_model.data.dataset.WriteError
            If the folder does not exist, or the disk is full.

        Examples
        --------
        >>> import disc_model as dm
        >>> run = dm.simulate(dm.Parameters(N=385, Omega=15.1), 1, windows={"late": dm.Window(last=0.1, rate=2e4)})
        >>> run.save("run.nc")
        >>> dm.Result.load("run.nc")["late"].equals(run["late"])
        True
        """
        from disc_model.data.dataset import save

        tree = self.to_tree()
        header = TypeAdapter(Result).dump_json(self, exclude=set(ARRAYS))
        tree.attrs["result"] = header.decode()
        directions = self.event_rows[:, EVENT_ROW.index("direction")]
        tree["events"].dataset = tree["events"].to_dataset().assign(direction=("event", directions))
        save(tree, regular_file(path, ".nc"))

    def to_csv(self, path: str | Path) -> None:
        """Write the events and the samples of each window as tables of text.

        Parameters
        ----------
        path : of a folder, made if it is missing, which gets "events.csv" and a file for each window, such as
            "late.csv", with units in the heads of columns

        Raises
        ------
        OSError
            If there can be no such folder, or a file cannot be written.

        Examples
        --------
        >>> import disc_model as dm
        >>> run = dm.simulate(dm.Parameters(N=385, Omega=15.1), 1, windows={"late": dm.Window(last=0.1, rate=2e4)})
        >>> run.to_csv("run")
        >>> print(open("run/events.csv").readline().strip())
        time (s),kind,phase,psi (rad),f (rad s-1),u (m),u_velocity (m s-1),P (N)
        """
        from disc_model.data.coded import table_of
        from disc_model.data.columns import series_dataset

        folder = Path(path)
        folder.mkdir(parents=True, exist_ok=True)
        events = series_dataset(self._event_columns, "event")
        table_of(events).drop(columns="event").to_csv(folder / "events.csv", index=False)
        for name in self.samples:
            table_of(self[name]).to_csv(folder / f"{name}.csv", index=False)

    @classmethod
    def load(cls, path: str | Path) -> Result:
        """Return what `save` has written to a file, to the last bit. It equals the result that was saved.

        Raises
        ------
        ParameterError
            If the file holds no result.
        disc_model.data.dataset.UnreadableFile
            If the file is damaged, or holds a result that cannot be.
        disc_model.data.dataset.MissingFile
            If there is no such file.
        """
        from disc_model.data.dataset import load_tree

        tree = load_tree(path)
        rule = "must be a file written by Result.save"
        require(("result" in tree.attrs, "path", str(path), rule))
        try:
            header = json.loads(tree.attrs["result"])
            samples = {}
            for name in header["windows"]:
                columns = tree[name].to_dataset().variables.items()
                samples[name] = {key: x.values.astype(float) for key, x in columns}
            rows = np.stack([tree["events"][name] for name in EVENT_ROW], axis=1, dtype=float)
            fields = {**header, "event_rows": rows, "samples": samples}
            return TypeAdapter(cls).validate_python(fields)
        except (LookupError, TypeError, ValueError) as error:
            raise unreadable(path, error) from None

    def __repr__(self) -> str:
        p = self.parameters
        first = self.first_separation
        lost = "no separation"
        if first >= 0:
            lost = f"first separation at {first:.6f} s"
        windows = counted(len(self.samples), "window")
        ended = f"{self.status.value} at {self.final_state.time:.9g} s"
        events = int(self.statistics["n_events"])
        ramped = "".join(f", {ramp.parameter} to {ramp.to:g}" for ramp in self.ramps)
        return f"Result(N={p.N:g} N, Omega={p.Omega:g} rad/s{ramped}: {ended}, {lost}, {events} events, {windows})"

    def summary(self) -> list[tuple[str, str]]:
        """Names and values in words, as the command line shows them."""
        advice = ""
        if not self.status.complete:
            advice = self.status.advice
        lines = {
            "case": values_text(dict(self.parameters)),
            "status": self.message or self.status.value,
            "advice": advice,
            "first separation": number_text(self.first_separation, "s", 9) or "none",
        }
        for name, value in self.statistics.items():
            words = name.removeprefix("n_").replace("_", " ")
            unit = SCALARS[name].units
            lines[words] = number_text(value, "" if unit == "1" else unit, 9)
        return [(name, text) for name, text in lines.items() if text]

    def raise_for_status(self) -> Result:
        """Return self if the run is complete; otherwise raise its `SimulationError`."""
        if not self.status.complete:
            raise _ERRORS[self.status](f"{self.message}. {self.status.advice}")
        return self

    # ---- Pictures: where no window is named, the run is simulated once more, which takes as long

    def plot(
        self,
        windows: str | Sequence[str] | None = None,
        *,
        variables: Sequence[str] = ("P", "w", "psi_velocity"),
        units: Mapping[str, str] | None = None,
    ) -> Axes | NDArray[Any]:
        """Draw variables against time: the range in the whole run, and its last cycles over stick
        and separation.

        Parameters
        ----------
        windows : names of recorded windows, to draw these instead, a column each
        variables : of P, u, w, w_point, psi, psi_velocity; a window without an envelope has u_velocity and
            w_point_velocity too
        units : by the names of variables, such as ``{"P": "kN"}``

        Returns
        -------
        Axes, or array of Axes
            Of a new figure, of shape (variables, columns); of one dimension if there is one window or one variable, and
            axes alone if there is one of both, as by `pyplot.subplots`.

        Raises
        ------
        ParameterError
            If a window was not recorded, or lacks a variable.

        Examples
        --------
        >>> import disc_model as dm
        >>> dm.simulate(dm.Parameters(N=385, Omega=15.1), 60).plot().shape
        (3, 2)

        Runs beside each other, by xarray:

        >>> from matplotlib import pyplot as plt
        >>> _, ax = plt.subplots()
        >>> for N in (300, 385):
        ...     run = dm.simulate(dm.Parameters(N=N, Omega=15), 1, {"end": dm.Window(last=0.05, rate=2e4)})
        ...     line = run["end"]["u"].plot(ax=ax, label=f"{N} N")
        """
        pictures = drawings()
        if windows is None:
            names = ["run", "end"]
            return pictures.history(self._again(*names), names, variables, units)
        if isinstance(windows, str):
            windows = [windows]
        return pictures.history(self.to_tree(), windows, variables, units)

    def plot_phase_portrait(
        self,
        window: str | None = None,
        *,
        x: str = "psi",
        y: str = "psi_velocity",
        ax: Axes | None = None,
        units: Mapping[str, str] | None = None,
        **look: Any,
    ) -> Axes:
        """Draw one variable over another, coloured by phase; of the last cycles if no window is named.

        With `look`, options of matplotlib such as ``label="385 N"``, and beside lines that are on `ax`
        already, it has one colour. `units` are as in `plot`. Returns the axes. Raises
        `ParameterError` as `plot`, and for a window that holds ranges instead of samples.

        Examples
        --------
        >>> import disc_model as dm
        >>> dm.simulate(dm.Parameters(N=385, Omega=15.1), 60).plot_phase_portrait().get_xlabel()
        'Angle ψ (rad)'
        """
        pictures = drawings()
        case, name = self._shown(window, "end")
        return pictures.portrait(case, name, x, y, ax, units, **look)

    def plot_spectrum(
        self,
        window: str | None = None,
        *,
        variable: str = "w_point",
        highest: float | str | None = None,
        ax: Axes | None = None,
        units: Mapping[str, str] | None = None,
        **look: Any,
    ) -> Axes:
        """Draw the amplitude of a variable over the frequency, up to `highest` in Hz or with a unit, or
        to where its lines end, with the frequencies of the strongest.

        Without a named window it is that of the last 8 s, or of the second half of a shorter run,
        with 16 samples in a period of the highest mode. What vibrates faster than half a window's
        rate appears at wrong frequencies. The resolution is 1 over the length of the window. `look` has
        options of matplotlib; a second spectrum on the same `ax` has the next colour. `units` are as in
        `plot`. Returns the axes. Raises `ParameterError` as `plot_phase_portrait`, and if the window is
        too short or nothing vibrates in it.

        Examples
        --------
        >>> import disc_model as dm
        >>> dm.simulate(dm.Parameters(N=385, Omega=15.1), 10).plot_spectrum(highest=500).get_xlabel()
        'Frequency (Hz)'
        """
        pictures = drawings()
        case, name = self._shown(window, "late")
        return pictures.spectrum(case, name, variable, highest, ax=ax, units=units, **look)

    def plot_poincare(
        self, window: str | None = None, *, units: Mapping[str, str] | None = None
    ) -> NDArray[Any]:
        """Draw the Poincaré sections of slider and disc, once a turn of the drive, on two axes of a new
        figure, which it returns; of a `Poincare` that was recorded, or of the whole run if none is
        named. Marks tell stages of the run apart.

        `units` are as in `plot`. Raises `ParameterError` if the window was not recorded as a `Poincare`
        or has no sample.

        Examples
        --------
        >>> import disc_model as dm
        >>> run = dm.simulate(dm.Parameters(N=385, Omega=15.1), 10, {"late": dm.Poincare(start=5)})
        >>> run.plot_poincare("late").shape
        (2,)
        """
        rule = f"must be a recorded Poincare with samples: {', '.join(self._sections)}"
        require((window is None or window in self._sections, "window", window, rule))
        pictures = drawings()
        case, name = self._shown(window, "poincare")
        return pictures.poincare(case, name, units)

    def animate(
        self,
        path: str | Path | None = None,
        window: str | None = None,
        *,
        frames: int = 60,
        fps: int = 12,
    ) -> FuncAnimation:
        """Make a film of the disc from above, its deflection under the slider, and the contact
        force beside it.

        Parameters
        ----------
        path : file to write, such as ``cycle.gif``, or ``cycle.mp4`` by ffmpeg; None writes nothing
        window : name of a recorded window; otherwise the last cycles
        frames, fps : number of pictures, and of those shown in a second

        Returns
        -------
        matplotlib.animation.FuncAnimation

        Raises
        ------
        ParameterError
            If the file has another suffix or no folder.

        Examples
        --------
        >>> import disc_model as dm
        >>> film = dm.simulate(dm.Parameters(N=385, Omega=15.1), 1).animate("cycle.gif", frames=2)
        """
        from disc_model.simulation.api import snapshots

        pictures = drawings()
        # what cannot be written is refused before anything is computed
        file = Path(path or "film.gif")
        known = file.suffix in WRITERS and file.absolute().parent.is_dir()
        rule = "must end in .gif or .mp4, in a folder that exists; a window is given by window="
        require(
            (known, "path", str(path), rule),
            (frames >= 1, "frames", frames, "must be >= 1"),
            (fps > 0, "fps", fps, "must be > 0"),
        )
        case, name = self._shown(window, "end")
        time = pictures.window_of(case, name)["time"]
        times = np.linspace(float(time[0]), float(time[-1]), frames)
        states = snapshots(self.parameters, times, **self._same_motion)
        made = pictures.film(self.parameters, states, case, name)
        if path is not None:
            made.save(path, writer=WRITERS[file.suffix], fps=fps, dpi=100)
        return made

    @property
    def _same_motion(self) -> dict[str, Any]:
        """Options with which the motion is computed once more."""
        return {name: getattr(self, name) for name in ("tol", "ramps", "initial_state")}

    def _shown(self, window: str | None, otherwise: str) -> tuple[xr.DataTree, str]:
        """Windows of the run, and the name of the one to show: a recorded one if it is named, and
        otherwise one of those of `_again`."""
        if window is None:
            return self._again(otherwise), otherwise
        return self.to_tree(), window

    def _last_cycles(self, span: float) -> float:
        """The length of the last cycles of a run of a length, s: from a release of stick on."""
        releases = self.event_rows[self.event_rows[:, 1] == record.STICK_TO_SLIP, 0]
        lengths = self.final_state.time - releases[-1 - CYCLES :]
        if len(lengths) <= CYCLES or lengths[0] >= 1.0:
            return min(SHORTEST, span)
        return min(float(lengths[0]), span)

    def _again(self, *names: str) -> xr.DataTree:
        """Simulate the run once more, and return it with windows that pictures show: "run" (an envelope of
        all of it), "end" (its last cycles), "late" (for a spectrum: its last 8 s, or the second half of a
        shorter run) and "poincare"."""
        from disc_model.simulation.api import simulate

        end = float(self.final_state.time)
        span = end
        if self.initial_state is not None:
            span -= self.initial_state.time
        rate = max(RATE, BINS / span)
        cycles = self._last_cycles(span)
        highest = float(mode_arrays(self.parameters).omega.max(initial=0.0)) / math.tau
        windows: Windows = {
            "run": Window(last=span, rate=rate, envelope=max(2, math.ceil(rate * span / BINS))),
            "end": Window(last=cycles, rate=FINE / cycles),
            "late": Window(last=min(8.0, span / 2), rate=max(RATE, PER_PERIOD * highest)),
            "poincare": Poincare(),
        }
        asked = {name: windows[name] for name in names}
        return simulate(self.parameters, end, asked, **self._same_motion).to_tree()
