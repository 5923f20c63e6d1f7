"""Command line: ``python -m disc_model run|modes|warm``.

The options of a case are made from the fields of `Parameters`, so that none can be forgotten, and their
values are handed on as text, so that the same rules and messages apply as everywhere else. What is wrong with
the input is one line on stderr and exit code 2; a simulation that ends before its time is reported and gives
exit code 1.
"""

from __future__ import annotations

import inspect
import logging
import math
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer
from rich.console import Console
from rich.table import Table

from disc_model.errors import DiscModelError, Fault, ParameterError
from disc_model.parameters import Parameters
from disc_model.schema import TOLERANCES, limits_rule, shown

if TYPE_CHECKING:
    from disc_model.simulation.case import Record
    from disc_model.simulation.result import Result

PLOT_POINTS = 4000
"""Points across a plot: more samples than this are reduced to the least and greatest of each bin."""
PLOT_RATE = 2000.0
"""Samples per second in a plot of the whole run, Hz."""
ZOOM = 0.25
"""Length of the second column of a plot, the end of the run, s."""
TOLERANCE_HELP = f"tolerance, {TOLERANCES[0]:g} to {TOLERANCES[1]:g}"

app = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    help="Friction-induced vibration of an elastic disc and a moving slider.",
)


def option_name(field: str) -> str:
    """Command-line option of a field of `Parameters`: D_star -> --D-star."""
    return "--" + field.replace("_", "-")


def _case_options(placeholders: dict[str, str] | None = None) -> list[inspect.Parameter]:
    """One keyword option for each field of `Parameters`; `placeholders` are values for required fields."""
    options = []
    for name, field in Parameters.model_fields.items():
        given = (placeholders or {}).get(name)
        spellings = dict.fromkeys([option_name(name), f"--{name}"])
        unit = Parameters.unit(name)
        default = "required" if field.is_required() and given is None else f"default: {_text(given or field.default)}"
        option = typer.Option(
            *spellings,
            metavar="VALUE",
            help=f"{field.description}{f' ({unit})' if unit not in ('', '1') else ''} [{default}]".replace("[", r"\["),
            show_default=False,
            rich_help_panel="Parameters of the case",
        )
        options.append(
            inspect.Parameter(
                name, inspect.Parameter.KEYWORD_ONLY, default=given, annotation=Annotated[str | None, option]
            )
        )
    return options


def _text(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


def _with_case_options(**placeholders: str) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Give a command one option for each parameter; it receives them together as the mapping `case`."""

    def decorate(command: Callable[..., None]) -> Callable[..., None]:
        own = [p for p in inspect.signature(command, eval_str=True).parameters.values() if p.name != "case"]
        case_options = _case_options(placeholders)

        def wrapped(**values: Any) -> None:
            case = {option.name: values.pop(option.name) for option in case_options}
            command(case={name: value for name, value in case.items() if value is not None}, **values)

        wrapped.__signature__ = inspect.Signature(own + case_options)  # type: ignore[attr-defined]
        wrapped.__annotations__ = {p.name: p.annotation for p in own + case_options}
        wrapped.__doc__, wrapped.__name__ = command.__doc__, command.__name__
        return wrapped

    return decorate


@app.command()
@_with_case_options()
def run(
    *,
    t_end: Annotated[
        str | None,
        typer.Option("--t-end", metavar="SECONDS", help=r"time at which the run ends (s) \[required]"),
    ] = None,
    tol: Annotated[str, typer.Option("--tol", metavar="VALUE", help=TOLERANCE_HELP)] = "1e-10",
    stop_at: Annotated[
        str | None, typer.Option("--stop-at", metavar="EVENT", help="end early: first_separation")
    ] = None,
    plot: Annotated[
        Path | None, typer.Option("--plot", metavar="FILE", help="draw contact force and disc displacement")
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
    parameters, choice, end, tolerance = _checked(case, t_end, tol, stop_at, plot, checkpoint)
    from disc_model.simulation.api import simulate

    record = _plot_record(end) if plot is not None else None
    if checkpoint is not None:  # where a run goes on, or why it does not
        logging.basicConfig(format="%(message)s")
        logging.getLogger("disc_model").setLevel(logging.INFO)
    with _progress(end) as progress:
        result = simulate(
            parameters, end, tol=tolerance, record=record, stop_at=stop_at, progress=progress, checkpoint=checkpoint
        )
    _print_summary(result, choice)
    complete = result.status.complete
    if plot is not None:
        reached = float(result.final_state.time)
        if 0 < reached < end:  # the end to be shown is elsewhere than was thought
            result = simulate(parameters, reached, tol=tolerance, record=_plot_record(reached))
        _save_plot(result, plot)
    if not complete:
        raise typer.Exit(1)


@app.command()
@_with_case_options(N="0", Omega="0")
def modes(*, case: dict[str, str]) -> None:
    """Print the disc's modes, its give under the slider, and the frequencies of both with the slider at rest."""
    from disc_model.flexibility import residual_flexibility
    from disc_model.plate import plate_modes, slider_at_rest_frequencies
    from disc_model.truncation import read_parameters

    parameters, _ = read_parameters(case)
    table = Table(title=f"Modes of the disc ({parameters.normalization})")
    for heading in ("circles", "diameters", "omega (rad/s)", "f (Hz)", "psi (kg^-1/2)", "psi^2 (1/kg)"):
        table.add_column(heading, justify="right")
    for row in plate_modes(parameters).itertuples():
        omega, psi = float(row.omega), float(row.psi)  # type: ignore[arg-type]
        numbers = (f"{omega:.3f}", f"{omega / math.tau:.3f}", f"{psi:.6g}", f"{psi**2:.6g}")
        table.add_row(str(row.circles), str(row.diameters), *numbers)
    flexibility = residual_flexibility(parameters)
    give = Table(title="Static give of the disc under the slider")
    for heading in ("all modes (m/N)", "remainder (m/N)", "modes above (m/N)", "residual (m/N)"):
        give.add_column(heading, justify="right")
    give.add_row(
        f"{flexibility.total:.7g}", f"{flexibility.remainder:.1e}", f"{flexibility.kept:.7g}",
        f"{flexibility.residual:.7g}",
    )  # fmt: skip
    shifted = Table(title="Disc and slider at rest")
    for heading in ("lambda (rad/s)", "f (Hz)"):
        shifted.add_column(heading, justify="right")
    for value in slider_at_rest_frequencies(parameters):
        shifted.add_row(f"{value:.3f}", f"{value / math.tau:.3f}")
    console = Console()
    console.print(table)
    console.print(give)
    console.print(shifted)


@app.command()
def warm() -> None:
    """Compile the kernels into the cache, so that jobs started in parallel find them there."""
    from disc_model.simulation.api import simulate

    for contact in ("separable", "bonded"):
        simulate(Parameters(N=385, Omega=15.1, contact=contact), 0.02)
    typer.echo("kernels compiled and cached")


def _checked(
    case: dict[str, str],
    t_end: str | None,
    tol: str,
    stop_at: str | None,
    plot: Path | None,
    checkpoint: Path | None,
) -> tuple[Parameters, str, float, float]:
    """Parameters, how their modes were chosen, t_end, tol; refuses all that is bad at once, before kernels load."""
    from disc_model.truncation import read_parameters

    faults: list[str] = []
    try:
        parameters, choice = read_parameters(case)
    except ParameterError as error:
        faults += error.faults
    end = _number("t_end", t_end, lambda x: 0 < x < math.inf, "must be finite and > 0", faults)
    tolerance = _number("tol", tol, lambda x: TOLERANCES[0] <= x <= TOLERANCES[1], limits_rule(TOLERANCES), faults)
    if stop_at not in (None, "first_separation"):
        faults.append(Fault(("stop_at",), shown(stop_at), "must be 'first_separation'"))
    if plot is not None:
        faults += _plot_faults(plot)
    if checkpoint is not None:
        faults += _checkpoint_faults(checkpoint)
    if faults:
        raise ParameterError(*faults)
    return parameters, choice, end, tolerance


def _number(name: str, text: str | None, holds: Callable[[float], bool], rule: str, faults: list[str]) -> float:
    """The number that `text` stands for; what is wrong with it is added to `faults`."""
    if text is None:
        faults.append(Fault((name,), "", "is required"))
        return math.nan
    try:
        value = float(text)
    except ValueError:
        faults.append(Fault((name,), shown(text), "must be a number"))
        return math.nan
    if not holds(value):
        faults.append(Fault((name,), shown(value), rule))
    return value


def _plot_faults(path: Path) -> Iterator[str]:
    """Reasons why a figure cannot be saved, found before the simulation and not after it."""
    from matplotlib.backend_bases import FigureCanvasBase

    kinds = FigureCanvasBase.get_supported_filetypes()
    if path.suffix.lower().lstrip(".") not in kinds:
        yield f"plot={str(path)!r}: must end in one of {', '.join(sorted(kinds))}"
    if not path.parent.is_dir():
        yield f"plot={str(path)!r}: must be in a folder that exists"


def _checkpoint_faults(path: Path) -> Iterator[str]:
    from disc_model.simulation.kept import faults

    return faults(path, 0)


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
    from disc_model.figures.quicklook import quicklook

    try:
        quicklook(result).savefig(path, dpi=150)
    except OSError as error:
        raise ParameterError(f"plot={str(path)!r}: cannot be written ({error.strerror})") from None
    typer.echo(f"{'figure':<20}{path}")


@contextmanager
def _progress(t_end: float) -> Iterator[Callable[[float], None] | None]:
    """A progress bar on a terminal, nothing where stderr is a file."""
    if not sys.stderr.isatty():
        yield None
        return
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (TextColumn("simulating"), BarColumn(), TextColumn("{task.completed:.2f} of {task.total:g} s"))
    with Progress(*columns, TimeRemainingColumn(), console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("simulating", total=t_end)
        yield lambda time: bar.update(task, completed=min(float(time), t_end))


def _print_summary(result: Result, choice: str) -> None:
    """Modes if they were chosen, status, switches, time in each phase and effort of one run, a line each."""
    p, s = result.parameters, result.statistics
    reached = float(result.final_state.time)
    lines = [
        ("case", f"N = {p.N:g} N, Omega = {p.Omega:g} rad/s, {p.normalization}, {p.contact} (key {p.key})"),
        *([("modes chosen", choice)] if choice else []),
        ("status", result.message or result.status.value),
        ("time reached", f"{reached:.9g} s of {result.t_end:g} s"),
        (
            "first separation",
            "none" if math.isnan(result.first_separation) else f"{result.first_separation:.9f} s",
        ),
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
    if result.status.value not in ("ok", "stopped"):
        lines.append(("advice", result.status.advice))
    for name, text in lines:
        typer.echo(f"{name:<20}{text}")


INTERRUPTED = 130
"""What typer makes of Ctrl-C: 128 and the number of the signal, as shells do."""


def _fail(message: str) -> NoReturn:
    """One line on stderr, exit code 2."""
    if message:  # empty where the help text was shown instead
        typer.echo(f"error: {' '.join(message.split())}", err=True)
    sys.exit(2)


def main(arguments: list[str] | None = None) -> NoReturn:
    """Run the command line; never shows a traceback for bad input."""
    try:
        code = app(args=arguments, standalone_mode=False, prog_name="python -m disc_model")
    except DiscModelError as error:
        _fail(str(error))
    except Exception as error:
        if not hasattr(error, "format_message"):  # not a usage error of the command-line parser
            raise
        _fail(error.format_message())
    if code == INTERRUPTED:
        typer.echo("error: interrupted", err=True)
    sys.exit(code if isinstance(code, int) else 0)
