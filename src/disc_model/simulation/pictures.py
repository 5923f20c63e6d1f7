"""Pictures of a run: the methods of a `disc_model.Result` that draw."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.display import draw
from disc_model.errors import require
from disc_model.simulation.case import Poincare, Window
from disc_model.units import is_whole

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.animation import FuncAnimation
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

CYCLES = 4  # of stick and slip that are shown of the end of a run, with at most four times as many separations
BINS, RATE = 600, 4000.0  # bins of the envelope of a run, and its samples per second at least
FOLDED = 16  # samples for a spectrum per period of the highest mode: what is beyond its eighth multiple is weak
FINE = 4000  # samples of the last cycles


class Pictures:
    """What a `disc_model.Result` can draw. Where no window is named, the run is simulated once
    more, with the samples that the picture needs, which takes as long as the run itself. All return
    matplotlib axes, in a new figure or those given as `ax`."""

    def plot(
        self,
        windows: str | Sequence[str] | None = None,
        *,
        variables: Sequence[str] = ("P", "w", "psi_velocity"),
        ax: Axes | Sequence[Axes] | None = None,
        legend: bool | Mapping[str, Any] = True,
        labels: Mapping[str, str] | None = None,
        title: str | None = None,
    ) -> Axes | NDArray[Any]:
        """Draw variables against time: the range in the whole run, and its last cycles over stick
        and separation.

        Parameters
        ----------
        windows : names of recorded windows, to draw these instead, a column each
        variables : of P, u, w, w_point, psi, psi_velocity; a window without an envelope has u_velocity and
            w_point_velocity too
        ax : axes to draw on, one for each variable and column; settings of matplotlib (rcParams)
            hold there, and in a new figure those that are not the usual ones
        legend : False for none, or options of `Axes.legend`, such as ``{"loc": "upper left"}``
        labels : other words for labels of axes, by "x" and "y", and for entries of the legend, by
            the usual ones
        title : another title; "" for none

        Returns
        -------
        Axes, or array of Axes
            Of shape (variables, columns) if there are several.

        Raises
        ------
        ParameterError
            If a window was not recorded, lacks a variable, or `ax` does not fit.

        Examples
        --------
        >>> import disc_model as dm
        >>> dm.simulate(dm.Parameters(N=385, Omega=15.1), 60).plot().shape
        (3, 2)
        """
        if windows is not None:
            names = (
                [windows] if isinstance(windows, str) or not np.iterable(windows) else list(windows)
            )
            case = self._case()
        else:
            names = ["run", "end"] if self._span > 1.5 * self._last_cycles else ["end"]
            case = self._case(*names)
        return draw(
            "plot_run", case, names, variables, ax=ax, legend=legend, labels=labels, title=title
        )

    def plot_phase_portrait(
        self,
        window: str | None = None,
        *,
        x: str = "psi",
        y: str = "psi_velocity",
        ax: Axes | None = None,
        legend: bool | Mapping[str, Any] = True,
        labels: Mapping[str, str] | None = None,
        title: str | None = None,
    ) -> Axes:
        """Draw one variable over another, coloured by phase; of the last cycles if no window is
        named.

        `ax`, `legend`, `labels` and `title` are as in `plot`. Returns the axes. Raises
        `ParameterError` as `plot`, and for a window that holds ranges instead of samples.

        Examples
        --------
        >>> import disc_model as dm
        >>> dm.simulate(dm.Parameters(N=385, Omega=15.1), 60).plot_phase_portrait().get_xlabel()
        'Angle ψ (rad)'
        """
        case, name = self._of(window, "end")
        return draw(
            "plot_phase_portrait",
            case,
            name,
            x,
            y,
            ax=ax,
            legend=legend,
            labels=labels,
            title=title,
        )

    def plot_spectrum(
        self,
        window: str | None = None,
        *,
        variable: str = "w_point",
        highest: float | None = None,
        ax: Axes | None = None,
        legend: bool | Mapping[str, Any] = True,
        labels: Mapping[str, str] | None = None,
        title: str | None = None,
    ) -> Axes:
        """Draw the amplitude of a variable over the frequency, up to `highest` in Hz, or to where
        its lines fall below a hundredth of the strongest.

        Without a named window it is that of the last 8 s, or of the second half of a shorter run,
        with 16 samples in a period of the highest mode. What vibrates faster than half a window's
        rate appears at wrong frequencies. `ax`, `legend`, `labels` and `title` are as in `plot`.
        Returns the axes. Raises `ParameterError` as `plot_phase_portrait`, and if the window is too
        short or nothing vibrates in it.

        Examples
        --------
        >>> import disc_model as dm
        >>> dm.simulate(dm.Parameters(N=385, Omega=15.1), 10).plot_spectrum(highest=500).get_xlabel()
        'Frequency (Hz)'
        """
        case, name = self._of(window, "late")
        return draw(
            "plot_spectrum",
            case,
            name,
            variable,
            highest,
            ax=ax,
            legend=legend,
            labels=labels,
            title=title,
        )

    def plot_poincare(
        self,
        *,
        ax: Sequence[Axes] | None = None,
        legend: bool | Mapping[str, Any] = True,
        labels: Mapping[str, str] | None = None,
        title: str | None = None,
    ) -> NDArray[Any]:
        """Draw the Poincaré sections of slider and disc, once a turn of the drive, on two axes,
        which it returns.

        `legend`, `labels` and `title` are as in `plot`. Raises `ParameterError` unless `ax` is two
        axes.

        Examples
        --------
        >>> import disc_model as dm
        >>> dm.simulate(dm.Parameters(N=385, Omega=15.1), 10).plot_poincare().shape
        (2,)
        """
        case = self._case("poincare")
        return draw("plot_poincare", case, ax=ax, legend=legend, labels=labels, title=title)

    def animate(
        self,
        path: str | Path | None = None,
        *,
        window: str | None = None,
        frames: int = 60,
        fps: int = 12,
    ) -> FuncAnimation:
        """Make a film of the disc from above, its deflection under the slider, and the contact
        force beside it.

        Parameters
        ----------
        path : file to write, such as ``cycle.gif``, or ``cycle.mp4`` by ffmpeg; None writes nothing
        window : name of a recorded window; otherwise the last cycles
        frames, fps : number of pictures, and how many are shown in a second

        Returns
        -------
        matplotlib.animation.FuncAnimation

        Raises
        ------
        ParameterError
            If an argument breaks a rule, or the file has another suffix or no folder.

        Examples
        --------
        >>> import disc_model as dm
        >>> film = dm.simulate(dm.Parameters(N=385, Omega=15.1), 1).animate("cycle.gif", frames=2)
        """
        require((is_whole(frames) and frames >= 1, "frames", frames, "must be a whole number >= 1"))
        draw(
            "film_writer", path, fps
        )  # refuses what cannot be written, before anything is computed
        result: Any = self
        samples = draw("window_of", *self._of(window, "end"))
        times = np.linspace(float(samples["time"][0]), float(samples["time"][-1]), frames)
        api = import_module("disc_model.simulation.api")
        states = api.snapshots(
            result.parameters,
            times,
            tol=result.tol,
            initial_state=result.initial_state,
            ramps=result.ramps,
        )
        return draw("animate", result.parameters, states, samples, path, fps)

    def _of(self, window: str | None, otherwise: str) -> tuple[xr.DataTree, str]:
        return (self._case(otherwise), otherwise) if window is None else (self._case(), window)

    @property
    def _span(self: Any) -> float:
        """Duration of the run, s."""
        start = 0.0 if self.initial_state is None else float(self.initial_state.time)
        return float(self.final_state.time) - start

    @property
    def _last_cycles(self: Any) -> float:
        """Length of the last cycles, s: from a release of stick on."""
        kinds = self.events["kind"]
        end = float(self.final_state.time)
        lengths = [self._span]
        for kind, number in ("stick_to_slip", CYCLES), ("separation", 4 * CYCLES):
            times = self.events["time"][kinds == kind].to_numpy()
            length = end - float(times[-1 - number]) if len(times) > number else 0.1
            lengths.append(length if length < 1.0 else 0.1)
        return min(lengths)

    def _case(self: Any, *names: str) -> xr.DataTree:
        """The run as a tree of windows: those that were recorded, or others, for which it is
        simulated once more."""
        if not names:
            return self.to_tree()
        end = float(self.final_state.time)
        span = self._span
        rate = max(RATE, BINS / span)
        late = min(8.0, span / 2)
        omega = import_module("disc_model.disc.plate").mode_arrays(self.parameters).omega
        highest = float(omega.max(initial=0.0)) / math.tau
        windows = {
            "run": Window(
                start=end - span, rate=rate, envelope=max(2, math.ceil(rate * span / BINS))
            ),
            "end": Window(start=end - self._last_cycles, rate=FINE / self._last_cycles),
            "late": Window(start=end - late, rate=max(RATE, FOLDED * highest)),
            "poincare": Poincare(start=end - span),
        }
        how = {"tol": self.tol, "ramps": self.ramps, "initial_state": self.initial_state}
        simulate = import_module("disc_model.simulation.api").simulate
        return simulate(
            self.parameters, end, {name: windows[name] for name in names}, **how
        ).to_tree()
