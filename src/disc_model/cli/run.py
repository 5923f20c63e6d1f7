"""The command `run`: one case, what happened, a picture and a file of it."""

from __future__ import annotations

import logging
import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from disc_model.cli.case import case_lines, number, parameters_of, tell, with_case_options
from disc_model.cli.progress import prepare, simulating
from disc_model.errors import Fault, ParameterError, refuse, shown
from disc_model.parameters import TOLERANCES, Parameters, limits_rule

if TYPE_CHECKING:
    from disc_model.simulation.case import Record, Window
    from disc_model.simulation.ramps import Ramp
    from disc_model.simulation.result import Result

PLOT_POINTS = 4000
"""Points across a plot: more samples than this are reduced to the least and greatest of each bin."""
PLOT_RATE = 2000.0
"""Samples per second in a plot of the whole run, Hz."""
ZOOM = 0.25
"""Length of the second column of a plot, the end of the run, s."""
TOLERANCE_HELP = f"tolerance, {TOLERANCES[0]:g} to {TOLERANCES[1]:g}"
STOPS = ("first_separation",)
WINDOW_HELP = (
    "samples to keep, such as late:last=3,rate=4000 or whole:rate=2000,envelope=1000; keys start, stop, last (s), "
    "rate (Hz), theta (rad), envelope; may be repeated"
)


RAMP_HELP = (
    "a slow change of Omega or N, such as Omega:to=5,start=100,end=400; keys to (rad/s or N), start, end (s); may be "
    "repeated"
)


class Asked(NamedTuple):
    """What `run` is asked for, checked."""

    parameters: Parameters
    choice: str
    end: float
    tol: float
    max_steps: int | None
    windows: dict[str, Window]
    ramps: tuple[Ramp, ...]


@with_case_options()
def run(
    *,
    t_end: Annotated[
        str | None,
        typer.Option("--t-end", metavar="SECONDS", help=r"time at which the run ends (s) \[required]"),
    ] = None,
    tol: Annotated[str, typer.Option("--tol", metavar="VALUE", help=TOLERANCE_HELP)] = "1e-10",
    stop_at: Annotated[
        str | None,
        typer.Option("--stop-at", metavar="|".join(STOPS), help="end early", autocompletion=lambda: list(STOPS)),
    ] = None,
    plot: Annotated[
        Path | None, typer.Option("--plot", metavar="FILE", help="draw contact force and disc displacement")
    ] = None,
    save: Annotated[
        Path | None, typer.Option("--save", metavar="FILE", help="write the result as netCDF, for disc_model.load")
    ] = None,
    window: Annotated[
        list[str] | None, typer.Option("--window", metavar="NAME:KEY=VALUE,...", help=WINDOW_HELP)
    ] = None,
    ramp: Annotated[list[str] | None, typer.Option("--ramp", metavar="PARAMETER:KEY=VALUE,...", help=RAMP_HELP)] = None,
    max_steps: Annotated[
        str | None, typer.Option("--max-steps", metavar="COUNT", help="give up after so many steps")
    ] = None,
    checkpoint: Annotated[
        Path | None,
        typer.Option(
            "--checkpoint", metavar="FILE", help="from it the same command goes on if this one is interrupted"
        ),
    ] = None,
    case: dict[str, str],
) -> None:
    """Simulate one case from static equilibrium and print what happened."""
    texts = {"window": window or [], "ramp": ramp or []}
    asked = _checked(case, t_end, tol, stop_at, max_steps, texts, {"plot": plot, "save": save}, checkpoint)
    from disc_model.simulation.api import simulate
    from disc_model.simulation.case import Record

    record = Record(windows=tuple(asked.windows.values())) if asked.windows else None
    if plot is not None and record is None:
        record = _plot_record(asked.end)
    if checkpoint is not None:  # where a run goes on, or why it does not
        logging.basicConfig(format="%(message)s")
        logging.getLogger("disc_model").setLevel(logging.INFO)
    prepare(asked.parameters)
    how: dict[str, Any] = {"tol": asked.tol, "max_steps": asked.max_steps, "ramps": asked.ramps}
    with simulating(asked.end) as progress:
        result = simulate(
            asked.parameters, asked.end, record=record, stop_at=stop_at, progress=progress, checkpoint=checkpoint, **how
        )
    _print_summary(result, asked.choice)
    complete = result.status.complete
    if save is not None:
        result.save(save, list(asked.windows) or None)
        tell([("saved", str(save))])
    if plot is not None:
        reached = float(result.final_state.time)
        if 0 < reached < asked.end and not asked.windows:  # the end to be shown is elsewhere than was thought
            p, record = asked.parameters, _plot_record(reached)
            result = simulate(p, reached, tol=asked.tol, record=record, ramps=asked.ramps)
        _save_plot(result, plot)
    if not complete:
        raise typer.Exit(1)


def _checked(
    case: dict[str, str],
    t_end: str | None,
    tol: str,
    stop_at: str | None,
    max_steps: str | None,
    texts: dict[str, list[str]],
    files: dict[str, Path | None],
    checkpoint: Path | None,
) -> Asked:
    """All that is asked for; refuses all that is bad at once, before kernels load."""
    faults: list[str] = []
    parameters, choice = parameters_of(case, faults)
    end = number("t_end", t_end, lambda x: 0 < x < math.inf, "must be finite and > 0", faults)
    tolerance = number("tol", tol, lambda x: TOLERANCES[0] <= x <= TOLERANCES[1], limits_rule(TOLERANCES), faults)
    if stop_at not in (None, *STOPS):
        faults.append(Fault(("stop_at",), shown(stop_at), "must be 'first_separation'"))
    steps = None
    if max_steps is not None:
        rule = "must be a whole number >= 1"
        found = number("max_steps", max_steps, lambda x: x >= 1 and x.is_integer(), rule, faults)
        steps = int(found) if math.isfinite(found) else None
    named = _windows(texts["window"], end, faults)
    ramps = _ramps(texts["ramp"], parameters, faults)
    if (plot := files["plot"]) is not None:
        faults += _plot_faults(plot)
    if (save := files["save"]) is not None:
        faults += _folder_faults("save", save)
    if checkpoint is not None:
        from disc_model.simulation.kept import faults as checkpoint_faults

        faults += checkpoint_faults(checkpoint, 0)
    refuse(faults)
    return Asked(parameters, choice, end, tolerance, steps, named, ramps)


def _ramps(texts: Sequence[str], p: Parameters, faults: list[str]) -> tuple[Ramp, ...]:
    """Ramps of texts such as ``Omega:to=5,start=100,end=400``; adds to `faults` what is wrong with them."""
    from disc_model.simulation.ramps import Ramp
    from disc_model.simulation.ramps import faults as faults_of

    found: list[Ramp] = []
    for i, text in enumerate(texts):
        name, named, said = text.partition(":")
        pairs = [pair.partition("=") for pair in said.split(",")]
        if not named or not all(sign for _, sign, _ in pairs):
            faults.append(Fault(("ramp",), shown(text), "must be PARAMETER:KEY=VALUE,..."))
            continue
        try:
            found.append(Ramp(parameter=name, **{key.strip(): value for key, _, value in pairs}))  # type: ignore[arg-type]
        except ParameterError as error:
            faults += _placed(error, ("ramp", str(i)))
    if not faults:  # else it may not be these parameters that are meant
        faults += faults_of(p, tuple(found), poincare=False)
    return tuple(found)


def _placed(error: ParameterError, place: tuple[str, ...]) -> Iterator[Fault]:
    """Faults of a part, at its place in the command."""
    for fault in error.faults:
        path, value, rule = (fault.path, fault.value, fault.rule) if isinstance(fault, Fault) else ((), "", fault)
        yield Fault((*place, *path), value, rule)


def _windows(texts: Sequence[str], end: float, faults: list[str]) -> dict[str, Window]:
    """Windows by name, of texts such as ``late:last=3,rate=4000``; adds to `faults` what is wrong with them."""
    from disc_model.data.variables import BESIDE_WINDOWS
    from disc_model.simulation.case import Window

    found: dict[str, Window] = {}
    for i, text in enumerate(texts):
        name, named, said = text.rpartition(":")
        name = name if named else f"sample_{i}"
        pairs = [pair.partition("=") for pair in said.split(",")]
        if not name.isidentifier() or name in {*found, *BESIDE_WINDOWS} or not all(sign for _, sign, _ in pairs):
            rule = "must be NAME:KEY=VALUE,... with a name of its own, not that of a variable or of events"
            faults.append(Fault(("window",), shown(text), rule))
            continue
        try:
            found[name] = Window(**{key.strip(): value for key, _, value in pairs})
            if math.isfinite(end) and (stop := found[name].resolved(0.0, end).stop) > end:
                rule = f"must be within the run: stop={shown(stop)} <= t_end={shown(end)}"
                faults.append(Fault(("window", name), "", rule))
        except ParameterError as error:
            faults += _placed(error, ("window", name))
    return found


def _plot_faults(path: Path) -> Iterator[str]:
    """Reasons why a figure cannot be saved, found before the simulation and not after it."""
    from matplotlib.backend_bases import FigureCanvasBase

    kinds = FigureCanvasBase.get_supported_filetypes()
    if path.suffix.lower().lstrip(".") not in kinds:
        yield f"plot={str(path)!r}: must end in one of {', '.join(sorted(kinds))}"
    yield from _folder_faults("plot", path)


def _folder_faults(name: str, path: Path) -> Iterator[str]:
    if not path.parent.is_dir():
        yield f"{name}={str(path)!r}: must be in a folder that exists"


def _plot_record(t_end: float) -> Record:
    """The whole run, as an envelope if long, and its end in detail; the size does not grow with `t_end`."""
    from disc_model.simulation.case import Record, Window

    bins = math.ceil(PLOT_RATE * t_end / PLOT_POINTS)
    whole = Window(start=0.0, stop=t_end, rate=PLOT_RATE, envelope=bins if bins > 1 else None)
    end = Window(start=max(0.0, t_end - ZOOM), stop=t_end, rate=4 * PLOT_RATE)
    return Record(windows=(whole, end) if t_end > ZOOM else (end,))


def _save_plot(result: Result, path: Path) -> None:
    import matplotlib as mpl

    mpl.use("Agg")
    from disc_model.simulation.quicklook import quicklook

    try:
        quicklook(result).savefig(path, dpi=150)
    except OSError as error:
        raise ParameterError(f"plot={str(path)!r}: cannot be written ({error.strerror})") from None
    tell([("figure", str(path))])


def _print_summary(result: Result, choice: str) -> None:
    """Modes if they were chosen, status, switches, time in each phase and effort of one run, a line each."""
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
    tell(lines)
