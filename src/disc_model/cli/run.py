"""The command `run`: simulate one case, print its events, and save a picture and a file."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer
from pydantic import Field

from disc_model.cli.case import case_lines, option, parameters_of, print_rows, with_case_options
from disc_model.data.variables import BESIDE_WINDOWS
from disc_model.errors import Fault, ParameterError, as_text, raise_faults
from disc_model.mode_choice import ModeChoice
from disc_model.simulation.case import Window
from disc_model.simulation.ramps import Ramp
from disc_model.units import TOLERANCES, Count, Seconds, Tolerance

if TYPE_CHECKING:
    from disc_model.simulation.result import Result

PLOT_POINTS = 4000
"""Points across a plot: more samples are reduced to the least and greatest of each bin."""
PLOT_RATE = 2000.0
"""Samples per second in a plot of the whole run, Hz."""
ZOOM = 0.25
"""Length of the second column of a plot, the end of the run, s."""
T_END_HELP = r"time at which the run ends (s) \[required]"
TOLERANCE_HELP = (
    f"error of event times after a second of motion, s, {TOLERANCES[0]:g} to {TOLERANCES[1]:g}; above 1.25e-7 it is "
    "computed and recorded as 1.25e-7 (2e-6 on a compliant contact)"
)
STOPS = ("first_separation",)
WINDOW_HELP = (
    "samples to keep, such as late:last=3,rate=4000 or whole:rate=2000,envelope=1000; keys start, stop, last (s), "
    "rate (Hz), theta (rad), envelope; may be repeated"
)
RAMP_HELP = (
    "a slow change of Omega or N, such as Omega:to=5,start=100,end=400; keys to (rad/s or N), start, end (s); may be "
    "repeated"
)


@with_case_options()
def run(
    *,
    t_end: Annotated[str | None, typer.Option(metavar="SECONDS", help=T_END_HELP)] = None,
    tol: Annotated[str, typer.Option(metavar="VALUE", help=TOLERANCE_HELP)] = "1e-10",
    stop_at: Annotated[
        str | None, typer.Option(metavar="|".join(STOPS), help="end early", autocompletion=lambda: list(STOPS))
    ] = None,
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="draw contact force and disc displacement")] = None,
    save: Annotated[
        Path | None, typer.Option(metavar="FILE", help="write the result as netCDF, for disc_model.load")
    ] = None,
    window: Annotated[list[str] | None, typer.Option(metavar="NAME:KEY=VALUE,...", help=WINDOW_HELP)] = None,
    ramp: Annotated[list[str] | None, typer.Option(metavar="PARAMETER:KEY=VALUE,...", help=RAMP_HELP)] = None,
    max_steps: Annotated[str | None, typer.Option(metavar="COUNT", help="give up after so many steps")] = None,
    case: dict[str, str],
) -> None:
    """Simulate one case from static equilibrium and print what happened."""
    faults: list[str] = []
    p, choice = parameters_of(case, faults)
    end = option("t_end", t_end, Seconds, faults)
    tolerance = option("tol", tol, Tolerance, faults)
    until = option("stop_at", stop_at, Literal[*STOPS], faults, default=None)
    most = option("max_steps", max_steps, Annotated[Count, Field(ge=1)], faults, default=None)
    windows = _windows(window or [], end, faults)
    ramps = _ramps(ramp or [], faults)
    faults += _file_faults(plot, save)
    raise_faults(faults)  # before kernels load; `simulate` checks ramps
    from disc_model.simulation.api import Execution, simulate

    kept = windows if windows or plot is None else plot_windows(end)
    execution = Execution(max_steps=most)
    result = simulate(p, end, kept, tol=tolerance, stop_at=until, ramps=ramps, execution=execution)
    _print_summary(result, choice)
    complete = result.status.complete
    if save is not None:
        result.save(save)
        print_rows([("saved", str(save))])
    if plot is not None:
        reached = float(result.final_state.time)
        if 0 < reached < end and not windows:  # the end to plot differs from the expected one
            result = simulate(p, reached, plot_windows(reached), tol=tolerance, ramps=ramps)
        _save_plot(result, plot)
    if not complete:
        raise typer.Exit(1)


def _values(text: str) -> dict[str, Any]:
    """Values by key, from a text such as ``last=3,rate=4000``; none if it is no such text."""
    pairs = [pair.partition("=") for pair in text.split(",")]
    return {key.strip(): value for key, _, value in pairs} if all(sign for _, sign, _ in pairs) else {}


def _ramps(texts: Sequence[str], faults: list[str]) -> tuple[Ramp, ...]:
    """Ramps from texts such as ``Omega:to=5,start=100,end=400``; faults are appended to `faults`."""
    ramps: list[Ramp] = []
    for i, text in enumerate(texts):
        name, named, rest = text.partition(":")
        values = _values(rest)
        if not named or not values:
            faults.append(Fault(("ramp",), as_text(text), "must be PARAMETER:KEY=VALUE,..."))
            continue
        try:
            ramps.append(Ramp(parameter=name, **values))
        except ParameterError as error:
            faults += (fault.inside(("ramp", str(i))) for fault in error.faults)
    return tuple(ramps)


def _windows(texts: Sequence[str], end: float | None, faults: list[str]) -> dict[str, Window]:
    """Windows by name, from texts such as ``late:last=3,rate=4000``; faults are appended to `faults`."""
    windows: dict[str, Window] = {}
    for i, text in enumerate(texts):
        name, named, rest = text.rpartition(":")
        name = name if named else f"sample_{i}"
        values = _values(rest)
        if not name.isidentifier() or name in {*windows, *BESIDE_WINDOWS} or not values:
            rule = "must be NAME:KEY=VALUE,... with a name of its own, not that of a variable or of events"
            faults.append(Fault(("window",), as_text(text), rule))
            continue
        try:
            windows[name] = Window(**values)
            if end is not None and (stop := windows[name].resolved(0.0, end).stop) > end:
                rule = f"must be within the run: stop={as_text(stop)} <= t_end={as_text(end)}"
                faults.append(Fault(("window", name), "", rule))
        except ParameterError as error:
            faults += (fault.inside(("window", name)) for fault in error.faults)
    return windows


def _file_faults(plot: Path | None, save: Path | None) -> Iterator[str]:
    """Reasons why files cannot be written, found before the simulation instead of after it."""
    if plot is not None:
        from matplotlib.backend_bases import FigureCanvasBase

        kinds = FigureCanvasBase.get_supported_filetypes()
        if plot.suffix.lower().lstrip(".") not in kinds:
            yield f"plot={str(plot)!r}: must end in one of {', '.join(sorted(kinds))}"
    for name, path in (("plot", plot), ("save", save)):
        if path is None:
            continue
        from disc_model.data.dataset import NAME_RULE, may_be_file

        if not path.parent.is_dir():
            yield f"{name}={str(path)!r}: must be in a folder that exists"
        elif not may_be_file(path):
            yield f"{name}={str(path)!r}: {NAME_RULE}"


def plot_windows(t_end: float) -> dict[str, Window]:
    """Windows of the whole run, as an envelope if long, and of its end in detail; of a size independent of `t_end`."""
    bins = math.ceil(PLOT_RATE * t_end / PLOT_POINTS)
    whole = Window(start=0.0, stop=t_end, rate=PLOT_RATE, envelope=bins if bins > 1 else None)
    end = Window(start=max(0.0, t_end - ZOOM), stop=t_end, rate=4 * PLOT_RATE)
    return {"whole": whole, "end": end} if t_end > ZOOM else {"end": end}


def _save_plot(result: Result, path: Path) -> None:
    import matplotlib as mpl

    mpl.use("Agg")
    from disc_model.simulation.quicklook import quicklook

    try:
        quicklook(result).savefig(path, dpi=150)
    except OSError as error:
        raise ParameterError(f"plot={str(path)!r}: cannot be written ({error.strerror})") from None
    print_rows([("figure", str(path))])


def _print_summary(result: Result, choice: ModeChoice | None) -> None:
    """Print the summary of one run: chosen modes, status, events, time in each phase and effort, a line each."""
    s = result.statistics
    reached = float(result.final_state.time)
    first = result.first_separation
    lines = [
        *case_lines(result.parameters, choice),
        ("status", result.message or result.status.value),
        ("time reached", f"{reached:.9g} s of {result.t_end:g} s"),
        ("first separation", "none" if math.isnan(first) else f"{first:.9f} s"),
        ("events", str(s["events"])),
    ]
    counts = result.events["kind"].value_counts()
    lines += [(f"  {kind}", str(count)) for kind, count in counts.items() if count]
    for phase in ("stick", "slip", "separation"):
        share = s[f"time_{phase}"] / reached if reached else 0.0
        lines.append((f"time in {phase}", f"{s[f'time_{phase}']:.6g} s ({share:.2%})"))
    ratio = f"{reached / s['wall_time']:.0f}" if s["wall_time"] > 0 else "-"
    lines += [
        ("steps", str(s["steps"])),
        ("wall time", f"{s['wall_time']:.3g} s ({ratio} simulated seconds a second)"),
        ("energy residual", f"{s['energy_residual']:.2e} (largest of {s['audited_steps']} steps, relative)"),
    ]
    if not result.status.complete:
        lines.append(("advice", result.status.advice))
    print_rows(lines)
