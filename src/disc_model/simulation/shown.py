"""The windows of a run that pictures show: recorded ones, or others of the run simulated again."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.disc.plate import mode_arrays
from disc_model.display import drawings
from disc_model.errors import Fault, ParameterError, require, suggestion
from disc_model.simulation.api import simulate, snapshots
from disc_model.simulation.case import Poincare, Window, Windows
from disc_model.simulation.result import Result
from disc_model.simulation.states import State
from disc_model.units import is_number, is_whole

if TYPE_CHECKING:
    import xarray as xr

CYCLES = 4  # of stick and slip that are shown of the end of a run
SEPARATIONS = 4 * CYCLES  # most of them that are shown of the end of a run
SHORTEST = 0.1  # s, of the end of a run that is shown where nothing repeats within a second
BINS = 600  # of the envelope of a run
RATE = 4000.0  # samples of the envelope per second, at least
FOLDED = 16  # samples for a spectrum per period of the highest mode: what is beyond its eighth multiple is weak
FINE = 4000  # samples of the last cycles
UNNAMED = (
    "none is named, and {} at the end; simulate longer, or record a window, as by"
    " simulate(case, 20, windows={{'late': Window(last=8, rate=8000)}})"
)
"""What is said of the stretch that is drawn if no window is named."""


def shown_windows(
    run: Result, windows: str | Iterable[str] | None
) -> tuple[xr.DataTree, list[str]]:
    """Return windows of a run, and the names of those to show: the named ones that were recorded.

    Without names they are the whole run, if it is much longer than its last cycles, and these.
    """
    if windows is None:
        names = ["end"]
        if run_span(run) > 1.5 * last_cycles(run):
            names = ["run", "end"]
        return simulated_again(run, *names), names

    # what is no text and cannot be iterated is refused later, by its name
    names = [windows]  # type: ignore[list-item]
    if np.iterable(windows) and not isinstance(windows, str):
        names = list(windows)
    return run.to_tree(), names


def shown_window(run: Result, window: str | None, otherwise: str) -> tuple[xr.DataTree, str]:
    """Return windows of a run, and the name of the one to show.

    It is a recorded one if it is named, and otherwise one of those that `simulated_again` knows.
    """
    if window is None:
        return simulated_again(run, otherwise), otherwise
    return run.to_tree(), window


def shown_section(run: Result, window: str | None) -> tuple[xr.DataTree, str]:
    """Return windows of a run, and the name of the Poincaré section to show: a recorded one if it
    is named, and otherwise that of the whole run; raises `ParameterError`."""
    sections = [
        name
        for name, kept in run.windows.items()
        if isinstance(kept, Poincare) and len(run.samples[name]["time"])
    ]
    rule = f"must be a recorded Poincare with samples{suggestion(window, sections)}"
    require((window is None or window in sections, "window", window, rule))
    return shown_window(run, window, "poincare")


def run_span(run: Result) -> float:
    """Return the duration of a run, s."""
    start = 0.0
    if run.initial_state is not None:
        start = float(run.initial_state.time)
    return float(run.final_state.time) - start


def last_cycles(run: Result) -> float:
    """Return the length of the last cycles of a run, s: from a release of stick on."""
    kinds = run.events["kind"]
    end = float(run.final_state.time)
    lengths = [run_span(run)]
    for kind, number in (("stick_to_slip", CYCLES), ("separation", SEPARATIONS)):
        times = run.events["time"][kinds == kind].to_numpy()
        length = SHORTEST
        if len(times) > number:
            length = end - float(times[-1 - number])
        if length >= 1.0:
            length = SHORTEST
        lengths.append(length)
    return min(lengths)


def simulated_again(run: Result, *names: str) -> xr.DataTree:
    """Simulate a run once more, and return it with windows that pictures show.

    Their names are "run" (an envelope of all of it), "end" (its last cycles), "late" (for a
    spectrum: its last 8 s, or the second half of a shorter run) and "poincare".
    """
    end = float(run.final_state.time)
    span = run_span(run)
    rate = max(RATE, BINS / span)
    folded = max(2, math.ceil(rate * span / BINS))
    late = min(8.0, span / 2)
    cycles = last_cycles(run)
    highest = float(mode_arrays(run.parameters).omega.max(initial=0.0)) / math.tau
    windows: Windows = {
        "run": Window(start=end - span, rate=rate, envelope=folded),
        "end": Window(start=end - cycles, rate=FINE / cycles),
        "late": Window(start=end - late, rate=max(RATE, FOLDED * highest)),
        "poincare": Poincare(start=end - span),
    }
    again = simulate(
        run.parameters,
        end,
        {name: windows[name] for name in names},
        tol=run.tol,
        ramps=run.ramps,
        initial_state=run.initial_state,
    )
    return again.to_tree()


def states_between(run: Result, first: float, last: float, number: int) -> tuple[State, ...]:
    """Return states of a run at equal intervals between two times, in s, for which it
    is simulated again."""
    return snapshots(
        run.parameters,
        np.linspace(first, last, number),
        tol=run.tol,
        initial_state=run.initial_state,
        ramps=run.ramps,
    )


# ---- Pictures that take more than a window


def draw_spectrum(
    run: Result, window: str | None, variable: str, highest: Any, **options: Any
) -> Any:
    """Draw the spectrum of a window, see `Result.plot_spectrum`."""
    pictures = drawings()
    case, name = shown_window(run, window, "late")
    try:
        return pictures.spectrum(case, name, variable, highest, **options)
    except ParameterError as error:
        for fault in error.faults:
            if window is None and fault.path == ("window",):
                raise ParameterError(Fault(fault.path, "", UNNAMED.format(fault.rule))) from None
        raise


def film(run: Result, path: str | Path | None, window: str | None, frames: int, fps: int) -> Any:
    """Make a film of a window, see `Result.animate`."""
    pictures = drawings()
    # what cannot be written is refused before anything is computed
    file = Path("film.gif")
    if isinstance(path, str | Path):
        file = Path(path)
    known = path is None or isinstance(path, str | Path)
    suffix = "must end in .gif or .mp4; a window is given by window="
    require(
        (is_whole(frames) and frames >= 1, "frames", frames, "must be a whole number >= 1"),
        (is_number(fps) and fps > 0, "fps", fps, "must be a number > 0"),
        (known and file.suffix in (".gif", ".mp4"), "path", str(path), suffix),
        (file.absolute().parent.is_dir(), "path", str(path), "must be in a folder that exists"),
    )
    case, name = shown_window(run, window, "end")
    time = pictures.window_of(case, name)["time"]
    states = states_between(run, float(time[0]), float(time[-1]), frames)
    made = pictures.film(run.parameters, states, case, name)
    if path is not None:
        writer = "pillow" if file.suffix == ".gif" else "ffmpeg"
        made.save(path, writer=writer, fps=fps, dpi=100)
    return made
