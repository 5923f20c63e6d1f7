"""Methods of a `disc_model.Result` that draw.

Where no window is named, the run is simulated once more, with the samples that the picture needs,
which takes as long as the run itself. All return matplotlib axes, in a new figure or those given as
`ax`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from disc_model.attached.drawing import drawings

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from disc_model.simulation.result import Result

UNNAMED = (
    "none is named, and the end of the run {}; simulate longer, or record a window, as by"
    " simulate(case, 20, windows={{'late': Window(last=8, rate=8000)}})"
)
"""What is said of the stretch that is drawn if no window is named."""


def plot(
    self: Result,
    windows: str | Sequence[str] | None = None,
    *,
    variables: Sequence[str] = ("P", "w", "psi_velocity"),
    ax: Axes | Sequence[Axes] | None = None,
    legend: bool | Mapping[str, Any] = True,
    labels: Mapping[str, str] | None = None,
    title: str | bool | None = None,
) -> Axes | NDArray[Any]:
    """Draw variables against time: the range in the whole run, and its last cycles over stick
    and separation.

    Runs on the same axes have a look and a name in the legend each, and neither shades of phases and ramps nor
    marks of first separations, which are those of one run.

    Parameters
    ----------
    windows : names of recorded windows, to draw these instead, a column each
    variables : of P, u, w, w_point, psi, psi_velocity; a window without an envelope has u_velocity and
        w_point_velocity too
    ax : axes to draw on, one for each variable and column; settings of matplotlib (rcParams)
        hold there, and in a new figure those that are not the usual ones. Axes with another quantity
        or unit of a picture of this package are refused; labels that you have set yourself stay
    legend : False for none, or options of `Axes.legend`, such as ``{"loc": "upper left"}``. Without one, all entries
        are those of ``ax.get_legend_handles_labels()``, so that ``ax.legend()`` and ``figure.legend()`` write them
    labels : other words for labels of axes, by "x" and "y", and for entries of the legend, by
        the usual ones; by "case" the name of the run among several, otherwise what differs between them
    title : another title; "" or False for none; True for the values of the case also above axes of your own

    Returns
    -------
    Axes, or array of Axes
        Of shape (variables, columns); of one dimension if there is one window or one variable, and axes alone if there
        is one of both, as by `pyplot.subplots`.

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
    from disc_model.attached.shown import shown_windows

    pictures = drawings()
    case, names = shown_windows(self, windows)
    return pictures.plot_run(
        case, names, variables, ax=ax, legend=legend, labels=labels, title=title
    )


def plot_phase_portrait(
    self: Result,
    window: str | None = None,
    *,
    x: str = "psi",
    y: str = "psi_velocity",
    ax: Axes | None = None,
    legend: bool | Mapping[str, Any] = True,
    labels: Mapping[str, str] | None = None,
    title: str | bool | None = None,
) -> Axes:
    """Draw one variable over another, coloured by phase, or by run if there are several on the same
    axes; of the last cycles if no window is named.

    `ax`, `legend`, `labels` and `title` are as in `plot`. Returns the axes. Raises
    `ParameterError` as `plot`, and for a window that holds ranges instead of samples.

    Examples
    --------
    >>> import disc_model as dm
    >>> dm.simulate(dm.Parameters(N=385, Omega=15.1), 60).plot_phase_portrait().get_xlabel()
    'Angle ψ (rad)'
    """
    from disc_model.attached.shown import shown_window

    pictures = drawings()
    case, name = shown_window(self, window, "end")
    return pictures.plot_phase_portrait(
        case, name, x, y, ax=ax, legend=legend, labels=labels, title=title
    )


def plot_spectrum(
    self: Result,
    window: str | None = None,
    *,
    variable: str = "w_point",
    highest: float | None = None,
    ax: Axes | None = None,
    legend: bool | Mapping[str, Any] = True,
    labels: Mapping[str, str] | None = None,
    title: str | bool | None = None,
) -> Axes:
    """Draw the amplitude of a variable over the frequency, up to `highest` in Hz, or to where
    its lines fall below a hundredth of the strongest, and at least to the last of the five
    strongest.

    Up to five lines have their frequency beside the peak, or above it with a line to the peak: the
    strongest, and of the next four those that find room beside the names of stronger ones. A weaker
    line has none, nor has any of several spectra on the same axes, which have a colour and a width each.

    Without a named window it is that of the last 8 s, or of the second half of a shorter run,
    with 16 samples in a period of the highest mode. What vibrates faster than half a window's
    rate appears at wrong frequencies. The resolution is 1 over the length of the window: frequencies
    beside peaks have no more digits, and peaks below 4 times it have none, since the window cannot
    tell them from a drift. `ax`, `legend`, `labels` and `title` are as in `plot`.
    Returns the axes. Raises `ParameterError` as `plot_phase_portrait`, and if the window is too
    short or nothing vibrates in it.

    Examples
    --------
    >>> import disc_model as dm
    >>> dm.simulate(dm.Parameters(N=385, Omega=15.1), 10).plot_spectrum(highest=500).get_xlabel()
    'Frequency (Hz)'
    """
    from disc_model.attached.shown import shown_window
    from disc_model.errors import Fault, ParameterError

    pictures = drawings()
    case, name = shown_window(self, window, "late")
    try:
        return pictures.plot_spectrum(
            case, name, variable, highest, ax=ax, legend=legend, labels=labels, title=title
        )
    except ParameterError as error:
        for fault in error.faults:
            if window is None and fault.path == ("window",):
                raise ParameterError(Fault(fault.path, "", UNNAMED.format(fault.rule))) from None
        raise


def plot_poincare(
    self: Result,
    window: str | None = None,
    *,
    ax: Sequence[Axes] | None = None,
    legend: bool | Mapping[str, Any] = True,
    labels: Mapping[str, str] | None = None,
    title: str | bool | None = None,
) -> NDArray[Any]:
    """Draw the Poincaré sections of slider and disc, once a turn of the drive, on two axes,
    which it returns; of a `Poincare` that was recorded, or of the whole run if none is named.
    Marks tell stages of the run apart, or runs if there are several on the same axes.

    `legend`, `labels` and `title` are as in `plot`. Raises `ParameterError` if the window was not
    recorded as a `Poincare` or has no sample, and unless `ax` is two axes.

    Examples
    --------
    >>> import disc_model as dm
    >>> run = dm.simulate(dm.Parameters(N=385, Omega=15.1), 10, {"late": dm.Poincare(start=5)})
    >>> run.plot_poincare("late").shape
    (2,)
    """
    from disc_model.attached.shown import shown_section

    pictures = drawings()
    case, name = shown_section(self, window)
    return pictures.plot_poincare(case, name, ax=ax, legend=legend, labels=labels, title=title)


def animate(
    self: Result,
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
    from disc_model.attached.shown import shown_window, states_between
    from disc_model.errors import require
    from disc_model.units import is_whole

    pictures = drawings()
    # what cannot be written is refused before anything is computed
    require((is_whole(frames) and frames >= 1, "frames", frames, "must be a whole number >= 1"))
    pictures.film_writer(path, fps)

    case, name = shown_window(self, window, "end")
    samples = pictures.window_of(case, name)
    time = samples["time"]
    states = states_between(self, float(time[0]), float(time[-1]), frames)
    return pictures.animate(self.parameters, states, samples, path, fps)
