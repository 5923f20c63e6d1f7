"""Command line ``disc-model``. Invalid input gives exit code 2, a simulation that ends early 1.
Options of commands on one case are made from the fields of pydantic models, which get the texts, so
that the same rules and messages apply.
"""

from __future__ import annotations

import functools
import inspect
import math
import os
import sys
import warnings
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, NoReturn, get_args, get_origin

import typer
from pydantic import AfterValidator, Field
from rich.console import Console
from rich.table import Column, Table

from disc_model import __version__
from disc_model.data.files import regular_file
from disc_model.disc.modes import coupled_natural_frequencies
from disc_model.disc.plate import damping_ratios, mode_arrays
from disc_model.disc.table import disc_of_table
from disc_model.display import counted, number_text
from disc_model.errors import DiscModelError, Fault, ParameterError
from disc_model.parameters import Disc, Parameters
from disc_model.sources import PACKAGE
from disc_model.units import TOLERANCES, Seconds, Strict, Tolerance

# ---- Options, one for each field of a model


def option_name(field: str) -> str:
    """Command-line option of a field: D_star -> --D-star, from_ -> --from."""
    return "--" + field.rstrip("_").replace("_", "-")


def _option(name: str, field: Any, panel: str, placeholder: str | None = None) -> inspect.Parameter:
    """The keyword option of a field of a model, as a text; a placeholder makes a required field
    optional."""
    types = (field.annotation, *get_args(field.annotation))
    words = [word for kind in types if get_origin(kind) is Literal for word in get_args(kind)]
    unit = Parameters.unit(name).removeprefix("1")
    told = field.description + ": a table of modes" * (name == "disc") + f" ({unit})" * bool(unit)
    default = field.default if placeholder is None else placeholder
    if field.is_required() and placeholder is None:
        told += r" \[required]"
    elif isinstance(default, str | int | float):
        told += rf" \[default: {f'{default:g}' if isinstance(default, float) else default}]"
    option = typer.Option(
        option_name(name),
        metavar="|".join(
            words if words and not isinstance(field.default, float) else ["VALUE", *words]
        ),
        help=told,
        show_default=False,
        rich_help_panel=panel,
    )
    how = inspect.Parameter.KEYWORD_ONLY
    return inspect.Parameter(
        name, how, default=placeholder, annotation=Annotated[str | None, option]
    )


def command(
    options: type[Strict], **placeholders: str
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Give a command the options of a model and of a case: it receives the case and the model."""
    own = [_option(name, field, "Options") for name, field in options.model_fields.items()]
    own += [
        _option(name, field, "Case", placeholders.get(name))
        for name, field in Parameters.model_fields.items()
    ]

    def decorate(function: Callable[..., None]) -> Callable[..., None]:
        @functools.wraps(function)
        def wrapped(**values: Any) -> None:
            texts = {name: value for name, value in values.items() if value is not None}
            model = options(
                **{name: texts.pop(name) for name in options.model_fields if name in texts}
            )
            if "disc" in texts:
                texts["disc"] = disc_of_table(texts["disc"])
            if isinstance(model, ModesOptions) and model.from_ is not None:
                texts["disc"] = model.read(texts)
            p = Parameters.model_validate(texts)
            function(p, model)

        wrapped.__signature__ = inspect.Signature(own)  # type: ignore[attr-defined]
        return wrapped

    return decorate


def table(title: str, columns: Mapping[str, Iterable[str]], **options: Any) -> None:
    """Print a table of columns by their heads; options : how rich shows each column."""
    printed = Table(*(Column(head, **options) for head in columns), title=title)
    for row in zip(*columns.values(), strict=True):
        printed.add_row(*row)
    Console().print(printed)


def print_rows(lines: Iterable[tuple[str, str]]) -> None:
    """Print lines that consist of a name and its text."""
    for name, text in lines:
        typer.echo(f"{name:<20}{text}")


def model_line(p: Parameters) -> tuple[str, str]:
    """The model of a case in words."""
    modes = p.normalization if p.disc is None else f"a disc of {counted(len(p.disc.omega), 'mode')}"
    return "model", f"{modes}, {p.contact} contact"


# ---- Modes and cycles


def _writable(path: Path) -> Path:
    """Refuse a file that cannot be written, before the work instead of after it."""
    try:
        regular_file(path)
    except ParameterError as error:
        raise ValueError(error.faults[0].rule) from None
    if not path.parent.is_dir():
        raise ValueError("must be the name of a file in a folder that exists")
    if not os.access(path.parent, os.W_OK):
        raise ValueError("must be in a folder in which files can be written")
    return path


class ModesOptions(Strict):
    """Options of the command `modes` by which it reads a disc from a file."""

    from_: str | None = Field(
        None, description="table, or universal file of a modal test or of finite elements"
    )
    axis: str | None = Field(
        None, description="of a universal file: from the disc to the slider, such as 0,0,1"
    )
    centre: str | None = Field(
        None, description="of a universal file: a point on the axis, such as 0,0,0 (m)"
    )
    units: str | None = Field(
        None, description="of length and force in a universal file, such as mm,N"
    )
    save: Annotated[Path, AfterValidator(_writable)] | None = Field(
        None, description="write the modes as a table, for --disc and for studies"
    )

    def read(self, case: Mapping[str, Any]) -> Disc:
        """The disc of the file: a table, or, if its place is given, a universal file."""
        if "disc" in case:
            raise ParameterError(Fault(("disc",), "", "must be left out: --from gives the disc"))
        file = self.from_ or ""
        if self.axis is None and self.centre is None and self.units is None:
            return Disc.from_csv(file)
        axis, centre, units = ((x or "").split(",") for x in (self.axis, self.centre, self.units))
        return Disc.from_uff(file, case.get("r_0", ""), axis=axis, centre=centre, units=units)


@command(ModesOptions, N="0", Omega="0")
def modes(p: Parameters, options: ModesOptions) -> None:
    """Print the modes of the disc, and its frequencies with the slider at rest."""
    print_rows([model_line(p)])
    arrays = mode_arrays(p)
    columns: dict[str, Iterable[str]] = {
        "circles": map(str, arrays.circles),
        "diameters": map(str, arrays.diameters),
        "omega\n(rad/s)": map("{:.3f}".format, arrays.omega),
        "f\n(Hz)": map("{:.3f}".format, arrays.omega / math.tau),
        "amplitude\n(kg^-1/2)": map("{:.5g}".format, arrays.psi),
        "damping\nratio": map("{:.3g}".format, damping_ratios(p)),
    }
    if p.disc is None or not p.disc.tangential:
        columns["squared\n(1/kg)"] = map("{:.5g}".format, arrays.psi**2)
    else:
        columns["tangent.\n(kg^-1/2)"] = map("{:.5g}".format, p.disc.tangential)
    table("Modes of the disc", columns, justify="right", overflow="fold")
    if options.save is not None:
        save_table(p, options.save)
    at_rest = coupled_natural_frequencies(p)
    columns = {
        "lambda (rad/s)": map("{:.3f}".format, at_rest),
        "f (Hz)": map("{:.3f}".format, at_rest / math.tau),
    }
    slider = f"(slider of {shown_value(p, 'm')} on {shown_value(p, 'k')})"
    table(f"Disc and slider at rest\n{slider}", columns, justify="right")


def shown_value(p: Parameters, name: str) -> str:
    """A parameter of a case in its unit for readers."""
    from disc_model.data.variables import SHOWN

    shown = SHOWN[name]
    return number_text(getattr(p, name) * shown.factor, shown.unit)


def save_table(p: Parameters, path: Path) -> None:
    """Write the modes of a case as a table."""
    if p.disc is None:
        raise ParameterError(Fault(("save",), "", "needs the disc of a file: --from or --disc"))
    p.disc.to_csv(path)
    print_rows([("saved", str(path))])


@command(Strict)
def floquet(p: Parameters, _: Strict) -> None:
    """Find the stick-slip cycle and its multipliers: whether the quiet motion lasts, without
    simulating it."""
    from disc_model.data.variables import CycleStatus
    from disc_model.stability.floquet import floquet as cycle_of

    cycle = cycle_of(p)
    print_rows([*cycle.summary(), model_line(p)])
    if cycle.status is not CycleStatus.OK:
        raise typer.Exit(1)


@command(Strict)
def sliding(p: Parameters, _: Strict) -> None:
    """Print the modes of steady sliding (complex eigenvalues): frequencies, growth rates,
    damping."""
    from disc_model.stability.sliding import sliding_modes, steady_sliding

    state = steady_sliding(p)
    print_rows([model_line(p), *state.summary()])
    if not state.status.exists:
        raise typer.Exit(1)
    modes = sliding_modes(p, state)
    forward = []
    for share, diameters in zip(modes.forward, modes.diameters, strict=True):
        forward.append(f"{share:.2f}" if diameters > 0 else "")
    columns: dict[str, Iterable[str]] = {
        "f (Hz)": map("{:.4f}".format, modes.frequency),
        "growth (1/s)": map("{:.6g}".format, modes.growth_rate),
        "damping ratio": map("{:.3g}".format, modes.damping_ratio),
        "nodal diameters": ["in the plane" if l < 0 else f"{l}" for l in modes.diameters],
        "forward wave": forward,
    }
    table("Modes in the slider's frame", columns, justify="right")


# ---- A simulation


def _savable(path: Path) -> Path:
    """Refuse a file in which no run can be saved."""
    if _writable(path).suffix != ".nc":
        raise ValueError("must end in .nc")
    return path


def _drawable(path: Path) -> Path:
    from matplotlib.backend_bases import FigureCanvasBase

    kinds = FigureCanvasBase.get_supported_filetypes()
    if path.suffix.lower().lstrip(".") not in kinds:
        raise ValueError(f"must end in one of {', '.join(sorted(kinds))}")
    return _writable(path)


def _folder(path: Path) -> Path:
    """Make a folder for files, or refuse it, before the work instead of after it."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ValueError(f"must be the name of a folder: {error.strerror}") from None
    return path


class RunOptions(Strict):
    t_end: Seconds = Field(description="time at which the run ends (s)")
    tol: Tolerance = Field(
        1e-10,
        description=f"error of event times after a second of motion, s, {TOLERANCES[0]:g} to {TOLERANCES[1]:g}; above "
        "1.25e-7 it is computed and recorded as 1.25e-7 (2e-6 on a compliant contact)",
    )
    plot: Annotated[Path, AfterValidator(_drawable)] | None = Field(
        None, description="draw contact force and disc displacement"
    )
    save: Annotated[Path, AfterValidator(_savable)] | None = Field(
        None, description="write the result as netCDF (.nc)"
    )
    csv: Annotated[Path, AfterValidator(_folder)] | None = Field(
        None, description="write the events as text, events.csv, into this folder"
    )


@command(RunOptions)
def run(p: Parameters, options: RunOptions) -> None:
    """Simulate one case from static equilibrium and print what happened."""
    from disc_model.simulation.api import simulate

    result = simulate(p, options.t_end, tol=options.tol)
    seconds = result.statistics["wall_time"]
    wall = f"{seconds:.3g} s ({result.final_state.time / max(seconds, 1e-9):.0f} simulated seconds a second)"
    print_rows([*result.summary(), model_line(p), ("wall time", wall), ("key", p.key)])
    if options.save is not None:
        result.save(options.save)
        print_rows([("saved", str(options.save))])
    if options.csv is not None:
        result.to_csv(options.csv)
        print_rows([("saved", str(options.csv / "events.csv"))])
    if options.plot is not None:
        from matplotlib import pyplot

        pyplot.switch_backend("agg")  # a program that calls `main` may have chosen another
        result.plot()
        pyplot.savefig(options.plot, dpi=150)
        print_rows([("figure", str(options.plot))])
    if not result.status.complete:
        raise typer.Exit(1)


# ---- Studies

# those that this process may use, which a cluster or a container may limit
CORES = os.cpu_count() or 1
if hasattr(os, "sched_getaffinity"):
    CORES = len(os.sched_getaffinity(0))


def study(
    files: Annotated[
        list[Path], typer.Argument(help="study files, later ones laid over earlier ones")
    ],
    cores: Annotated[
        int, typer.Option("--cores", "-j", min=1, help="jobs at the same time")
    ] = CORES,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", "-n", help="only check, and list the jobs")
    ] = False,
    directory: Annotated[
        Path, typer.Option("--directory", "-d", help="where results are written")
    ] = Path(),
    target: Annotated[
        list[str] | None,
        typer.Option("--target", help="a file or rule to make instead of all; repeatable"),
    ] = None,
    unlock: Annotated[
        bool, typer.Option("--unlock", help="only remove the lock that a killed run has left")
    ] = False,
) -> None:
    """Compute a study and draw its figures: only what is missing or out of date, by Snakemake."""
    from disc_model.studies.study import load_study

    load_study(*files)  # says what is wrong in fewer words than Snakemake
    import snakemake.cli  # type: ignore[import-untyped]

    snakefile = (PACKAGE / "workflow" / "Snakefile").resolve()
    options = ["-s", str(snakefile), *(target or []), f"-j{cores}", "--directory", str(directory)]
    options += ["--dry-run"] * dry_run + ["--unlock"] * unlock
    snakemake.cli.main([*options, "--configfile", *(str(file.resolve()) for file in files)])


# ---- All commands

INTERRUPTED = 130  # typer's exit code after Ctrl-C
OF_WORKFLOW = ("matplotlib", "cmcrameri", "yaml", "snakemake")  # which only this extra brings

app = typer.Typer(
    pretty_exceptions_enable=False,
    help="Friction-induced vibration of an elastic disc and a moving slider.",
)
for function in (run, floquet, sliding, modes, study):
    app.command(function.__name__)(function)


def _show_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"disc_model {__version__}")
        raise typer.Exit


@app.callback()
def _all(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_show_version, is_eager=True, help="show the version and exit"
        ),
    ] = False,
) -> None: ...


def main(arguments: list[str] | None = None) -> NoReturn:
    """Run the command line; never shows a traceback for bad input."""
    if arguments is None:
        arguments = sys.argv[1:]
    if not arguments:
        arguments = ["--help"]
    # figures are only saved, and the backend of a notebook may not be installed here; Snakemake's
    # jobs inherit this
    os.environ["MPLBACKEND"] = "agg"
    warnings.formatwarning = lambda text, *_, **__: f"warning: {text}\n"
    message = ""
    try:
        code = app(args=arguments, standalone_mode=False, prog_name="disc-model")
        if code == INTERRUPTED:
            message = "interrupted"
    except DiscModelError as error:
        code = 2
        message = str(error)
    except ModuleNotFoundError as error:
        if error.name not in OF_WORKFLOW:
            raise
        code = 2
        remedy = "pip install 'disc_model[workflow]' brings all that studies need"
        message = f"there is no module {error.name}: {remedy}"
    except Exception as error:
        if not hasattr(error, "format_message"):  # not a usage error of the command-line parser
            raise
        text = " ".join(error.format_message().split()).rstrip(".")
        code = 2
        message = text if text.endswith("?") else f"{text}."
    if message:
        typer.echo(f"error: {message}", err=True)
    sys.exit(code if isinstance(code, int) else 0)
