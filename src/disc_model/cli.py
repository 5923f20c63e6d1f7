"""Command line ``disc-model``. Invalid input gives exit code 2, a simulation that ends early 1.
Options of commands on one case are made from the fields of pydantic models, which get the texts, so
that the same rules and messages apply.
"""

from __future__ import annotations

import functools
import inspect
import logging
import math
import os
import shlex
import sys
import time
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryFile
from typing import TYPE_CHECKING, Annotated, Any, Literal, NoReturn, get_args, get_origin

import platformdirs
import typer
from pydantic import AfterValidator, Field
from rich.console import Console
from rich.table import Column, Table

from disc_model import __version__
from disc_model.data.files import RUN_BY, SUFFIXES, regular_file
from disc_model.disc.modes import coupled_natural_frequencies
from disc_model.disc.plate import damping_ratios, mode_arrays
from disc_model.disc.plausibility import ImplausibleValue, warn_of_doubts
from disc_model.disc.table import disc_of_table
from disc_model.display import counted, number_text
from disc_model.errors import DiscModelError, Fault, ParameterError, suggestion
from disc_model.parameters import Disc, Parameters
from disc_model.sources import PACKAGE
from disc_model.units import TOLERANCES, Seconds, Strict, Tolerance
from disc_model.without_reader import end_without_reader, go_on_without_reader

if TYPE_CHECKING:
    from disc_model.studies.grid import GridStudy
    from disc_model.studies.plan import Plan
    from disc_model.studies.study import Study

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
            warn_of_doubts(p, lambda text: typer.echo(f"warning: {text}", err=True))
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
        """The disc of the file; warnings become lines of their own."""
        if "disc" in case:
            raise ParameterError(Fault(("disc",), "", "must be left out: --from gives the disc"))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", ImplausibleValue)
            disc = self._disc(case)
        for warning in caught:
            typer.echo(f"warning: {warning.message}", err=True)
        return disc

    def _disc(self, case: Mapping[str, Any]) -> Disc:
        """The disc of a table, or, if its place is given, of a universal file."""
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
    from disc_model.stability.sliding import SlidingStatus, steady_sliding
    from disc_model.stability.sliding_modes import sliding_modes

    state = steady_sliding(p)
    print_rows([model_line(p), *state.summary()])
    if state.status is not SlidingStatus.OK:
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


def compile_() -> None:
    """Compile the kernels of the default model into the cache, which a first use otherwise does."""
    from disc_model.simulation.api import simulate
    from disc_model.stability.floquet import floquet

    began = time.perf_counter()
    p = Parameters(N=385, Omega=15)
    simulate(p, 0.1)
    floquet(p)
    typer.echo(f"kernels compiled and cached: {time.perf_counter() - began:.1f} s")


# ---- A simulation


def _of_suffix(path: Path, suffixes: Sequence[str]) -> Path:
    """Refuse a file without one of these suffixes, or one that cannot be written."""
    if _writable(path).suffix not in suffixes:
        raise ValueError(f"must end in {' or '.join(suffixes)}")
    return path


def _savable(path: Path) -> Path:
    """Refuse a file in which no run can be saved."""
    return _of_suffix(path, SUFFIXES)


def _drawable(path: Path) -> Path:
    from matplotlib.backend_bases import FigureCanvasBase

    kinds = FigureCanvasBase.get_supported_filetypes()
    if path.suffix.lower().lstrip(".") not in kinds:
        raise ValueError(f"must end in one of {', '.join(sorted(kinds))}")
    return _writable(path)


def _folder(path: Path) -> Path:
    """Make a folder for files, or refuse it, before the work instead of after it."""
    try:
        _make_folder(path)
    except ParameterError as error:
        raise ValueError(error.faults[0].rule) from None
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
        None, description="write the result as netCDF (.nc) or for MATLAB (.mat)"
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


def convert(
    source: Annotated[Path, typer.Argument(help="dataset of a study, or a saved run or sweep")],
    target: Annotated[
        str,
        typer.Argument(
            help="file to write: .mat for MATLAB, .csv for a table, .nc for netCDF; tables/ for all tables in a folder"
        ),
    ],
    variables: Annotated[
        str,
        typer.Option(
            "--variables",
            metavar="A,B,...",
            help="only these variables, such as those of one table",
        ),
    ] = "",
) -> None:
    """Write a dataset in another format, such as results/s/s.nc for MATLAB or as a table."""
    from disc_model.data.exchange import TABLE, WRITTEN, load, save
    from disc_model.data.text_tables import names_folder

    if not names_folder(target):
        try:
            _of_suffix(Path(target), WRITTEN)
        except ValueError as error:
            raise ParameterError(Fault.of(("TARGET",), target, str(error))) from None
    data = load(source)
    if variables:
        data = _with_variables(data, variables)
    if target.endswith(TABLE):
        _refuse_several_tables(data)
    save(data, target)
    print_rows([("saved", target)])


def _with_variables(data: Any, names: str) -> Any:
    """Some variables of a dataset, by their names between commas, with their coordinates."""
    if getattr(data, "children", None):
        rule = "cannot be chosen: the file has groups"
        raise ParameterError(Fault.of(("variables",), names, rule))
    chosen = [name.strip() for name in names.split(",")]
    known = [str(name) for name in data.data_vars]
    for name in chosen:
        if name not in known:
            rule = f"is no variable of the dataset{suggestion(name, known)}"
            raise ParameterError(Fault.of(("variables",), name, rule))
    return data[chosen]


def _refuse_several_tables(data: Any) -> None:
    """Refuse a dataset that is more than one table, and name the option that chooses one."""
    from disc_model.data.branch_table import has_branches
    from disc_model.data.point_table import rule_of_rows, without_place

    if getattr(data, "children", None) or has_branches(data):
        return
    others = without_place(data)
    if not others:
        return
    alike = [name for name in others if data[name].dims == data[others[0]].dims]
    choice = f"choose one, such as --variables {','.join(alike)}"
    placed = [str(name) for name in data.data_vars if name not in others]
    if placed:
        choice = f"{choice} or --variables {','.join(placed)}"
    choice += " or the folder tables/ in place of the file, for all tables"
    rule = f"{rule_of_rows(data)}: {', '.join(others)}; {choice}"
    raise ParameterError(Fault(("SOURCE",), "", rule))


# ---- Studies

DRY = (
    "--dry-run",
    "--quiet",
    "rules",
    "host",
    "reason",
)  # how many jobs of each kind, without their files
# those that this process may use, which a cluster or a container may limit
CORES = os.cpu_count() or 1
if hasattr(os, "sched_getaffinity"):
    CORES = len(os.sched_getaffinity(0))
MOST_FILES = 5  # of a study that are named when it is made
EXPLORER = "explorer"  # the target that makes a page of all points
Files = Annotated[list[Path], typer.Argument(help="study files, later ones laid over earlier ones")]


def study(
    files: Files,
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
    chosen, grids, requested = _read(files)
    if find_spec("snakemake") is None:
        raise ModuleNotFoundError(name="snakemake")
    _make_folder(directory)
    _find_cache(directory)
    if dry_run and not unlock:
        page = EXPLORER in (target or [])
        _show_plan(chosen, grids, requested, directory / "results", cores=cores, page=page)
    options = [*(target or []), f"-j{cores}", "--directory", str(directory)]
    if dry_run:
        options += DRY
    else:
        go_on_without_reader()  # jobs would stay, and the lock of the folder
    if unlock:
        options.append("--unlock")
    os.environ[RUN_BY] = _command_of(files, directory)
    try:
        _run_workflow(files, options)
    except SystemExit as ended:
        if not (ended.code or dry_run or unlock):
            _say_where(directory / "results" / chosen.name, target or [])
            if not target:
                _say_of_older_page(chosen, grids, requested, directory / "results")
        raise


def _run_workflow(files: Sequence[Path], options: Sequence[str]) -> NoReturn:
    """Run the workflow of this package on study files by Snakemake, which ends with an exit code."""
    import snakemake.cli  # type: ignore[import-untyped]

    snakemake.cli.print = _print_without_profile
    logging.getLogger("snakemake.logging").addFilter(_is_told)
    snakefile = (PACKAGE / "workflow" / "Snakefile").resolve()
    configured = ["--configfile", *(str(file.resolve()) for file in files)]
    snakemake.cli.main(["-s", str(snakefile), *options, *configured])
    raise SystemExit(0)


def _say_where(folder: Path, targets: Sequence[str]) -> None:
    """Print where the results of a study are, or the page of all points: not of other targets, which
    the reader has named."""
    if EXPLORER in targets:
        typer.echo(f"explorer: {folder / 'explorer.html'}")
    if targets:
        return
    found = [*sorted(folder.glob("*.nc")), *sorted(folder.glob("figures/*.png"))]
    names = [file.relative_to(folder).as_posix() for file in found]
    if len(names) > MOST_FILES:
        names = [*names[:MOST_FILES], "..."]
    listed = f" ({', '.join(names)})" if names else ""
    typer.echo(f"results: {folder}{listed}")


def _say_of_older_page(
    chosen: Study, grids: Mapping[str, GridStudy], requested: Sequence[str], results: Path
) -> None:
    """Print that the page of all points shows older results than those of a run, if it does."""
    from disc_model.studies.older_page import line_of_older_page

    command = f"{os.environ[RUN_BY]} --target {EXPLORER}"
    if line := line_of_older_page(chosen, grids, requested, results, command):
        typer.echo(line)


def _command_of(files: Sequence[Path], directory: Path) -> str:
    """The command that runs the study of some files, as a job may tell the reader."""
    words = ["disc-model", "study", *map(str, files)]
    if directory != Path():
        words += ["--directory", str(directory)]
    return shlex.join(words)


def _print_without_profile(*texts: Any, **options: Any) -> None:
    """Print what Snakemake prints, but not that it uses the profile of this package."""
    said = " ".join(map(str, texts))
    if not said.startswith("Using workflow specific profile "):
        print(said, **options)


NOT_TOLD = (
    # advice to look at times of files alone, by which results would stay that a change has made out of date
    "--rerun-triggers mtime",
    # how Snakemake is set up, which no reader has chosen
    "Assuming unrestricted shared filesystem usage",
    "Using shell: ",
    "Provided cores: ",
    "Rules claiming more threads will be scaled down",
    "Conda environments: ignored",
)
"""Parts of what Snakemake logs that readers are not told."""


def _is_told(record: logging.LogRecord) -> bool:
    """Whether readers are told what Snakemake logs."""
    said = str(record.msg)
    return not any(part in said for part in NOT_TOLD)


def _show_options(grid: GridStudy) -> None:
    """Print the options of a grid's quantity, with their values."""
    from disc_model.studies.options import options_of, value_text

    values = grid.options
    options = options_of(type(values))
    columns = {
        "option": [option.name for option in options],
        "value": [value_text(getattr(values, option.name)) for option in options],
        "unit": [option.unit.replace("`", "") for option in options],
        "meaning": [option.meaning for option in options],
    }
    table(f"options of the quantity {grid.quantity}", columns, overflow="fold")


def _batches_text(batches: int, computed: int) -> str:
    """The number of batches of a study, and how many of them are computed already."""
    if not computed:
        return str(batches)
    verb = "is" if computed == 1 else "are"
    return f"{batches}, of which {computed} {verb} computed"


def _show_plan(
    chosen: Study,
    known: Mapping[str, GridStudy],
    requested: Sequence[str],
    results: Path,
    *,
    cores: int,
    page: bool,
) -> None:
    """Print what there is to compute, how long it may take, the options of a single grid, and what has
    changed."""
    from disc_model.studies import plan
    from disc_model.studies.costs import machine_factor
    from disc_model.studies.fixed_costs import fixed_costs

    grids = [known[name] for name in requested]
    plans = [plan.plan_of(grid, results) for grid in grids]
    if chosen.specs:
        plans.append(plan.plan_of_cases(chosen.name, chosen.specs, results))
    factor = machine_factor()
    _show_work(chosen.name, plans, factor)
    if len(grids) == 1:
        _show_options(grids[0])
    unfinished = {each.name for each in plans if each.seconds}
    _show_changes([grid for grid in grids if grid.name in unfinished], results)

    figures = chosen.entries(known)
    shown = {key: entry for key, entry in figures.items() if key[0] in (chosen.name, *requested)}
    fixed = fixed_costs(plans, shown, results, page=page)
    seconds = [*fixed.jobs, *(x for each in plans for x in each.seconds)]
    if seconds:
        text = plan.duration_text(factor * (fixed.alone + plan.time_on(cores, seconds)))
        typer.echo(
            f"Estimated time: {text} on {cores} cores, to a factor of three, with the start of jobs and"
            " figures; kernels that are not compiled yet take 10 to 20 s each."
        )


def _show_work(name: str, plans: Sequence[Plan], factor: float) -> None:
    """Print what there is to compute for a study.

    factor : how many times as long as for the measured costs this machine takes
    """
    from disc_model.studies.plan import duration_text

    batches = [_batches_text(each.batches, each.computed) for each in plans]
    columns: dict[str, Iterable[str]] = {
        "study": [each.name for each in plans],
        "quantity": [each.quantity for each in plans],
        "points": [str(each.points) for each in plans],
        "batches": batches,
        "work": [duration_text(factor * sum(each.seconds)) for each in plans],
    }
    table(f"plan of {name}", columns, overflow="fold")


def _show_changes(grids: Sequence[GridStudy], results: Path) -> None:
    """Print which values of grids differ from those of their results."""
    from disc_model.studies.changed_values import changes_since

    for grid in grids:
        for change in changes_since(grid, results):
            typer.echo(f"{grid.name}: changed since the last run: {change}")


def _make_folder(directory: Path) -> None:
    """Make the folder of results; raises `ParameterError` if that is impossible."""
    try:
        directory.mkdir(parents=True, exist_ok=True)
        with TemporaryFile(dir=directory):
            pass
    except FileExistsError:
        raise ParameterError(
            Fault(("directory",), repr(str(directory)), "must be a folder, and is a file")
        ) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise ParameterError(
            Fault(("directory",), repr(str(directory)), f"cannot be written ({reason})")
        ) from None


def _find_cache(directory: Path) -> None:
    """Let Snakemake keep its cache under the folder of results where the user's own cannot be
    written, as without a home."""
    own = platformdirs.user_cache_path("snakemake", "snakemake")
    try:
        own.mkdir(parents=True, exist_ok=True)
        with TemporaryFile(dir=own):
            return
    except OSError:
        os.environ["XDG_CACHE_HOME"] = str(directory.resolve() / ".snakemake" / "cache")
    if platformdirs.user_cache_path("snakemake", "snakemake") == own:  # not everywhere obeyed
        rule = "must be a folder that can be written, because Snakemake keeps its cache there"
        raise ParameterError(Fault((), "", f"{own}: {rule}"))


def list_(
    what: Annotated[Literal["studies", "figures", "cases"], typer.Argument(help="what to list")],
    files: Files,
) -> None:
    """List the grid studies, figures or cases of a study."""
    from disc_model.data.variables import values_text

    chosen, grids, requested = _read(files)
    rows: list[tuple[str, ...]]
    if what == "studies":
        heads = ["study", "quantity", "dimensions", "points", "title"]
        listed = [grids[name] for name in requested]
        rows = [
            (x.name, x.quantity, " x ".join(x.values), str(x.n_points), x.title) for x in listed
        ]
    elif what == "cases":
        heads = ["case", "title", "parameters", "t_end (s)"]
        texts = {name: values_text(dict(spec.parameters)) for name, spec in chosen.specs.items()}
        labels = chosen.labels
        rows = [
            (name, labels[name]["title"], texts[name], f"{case.t_end:g}")
            for name, case in chosen.cases.items()
        ]
    else:
        heads = ["figure", "kind", "title"]
        rows = []
        for (study, name), entry in chosen.entries(grids).items():
            if study in (chosen.name, *requested):
                rows.append((name, entry.plot.kind, entry.title))
    if rows:
        columns = dict(zip(heads, zip(*rows, strict=True), strict=True))
        table(f"{what} of {chosen.name}", columns, overflow="fold")
    else:
        typer.echo(f"{chosen.name} has no {what}")


def init(
    directory: Annotated[
        Path, typer.Argument(metavar="DIR", help="folder to lay out; made if it is not there")
    ],
) -> None:
    """Lay out a folder for a study of your own: a study file to change, and a Snakefile for it."""
    workflow = PACKAGE / "workflow"
    schema = (workflow / "schemas" / "study.schema.json").resolve().as_uri()
    sources = ("template/my_study.yaml", "template/Snakefile", "profiles/default/config.yaml")
    texts = {name.removeprefix("template/"): (workflow / name).read_text() for name in sources}
    texts["my_study.yaml"] = texts["my_study.yaml"].replace("SCHEMA", schema)
    existing = [name for name in texts if (directory / name).exists()]
    if existing:
        raise ParameterError(
            Fault(("DIR",), repr(str(directory)), f"must not hold {', '.join(existing)} yet")
        )
    try:
        for name, text in texts.items():
            (directory / name).parent.mkdir(parents=True, exist_ok=True)
            (directory / name).write_text(text, encoding="utf-8")
    except OSError as error:
        raise ParameterError(
            Fault(("DIR",), repr(str(directory)), f"cannot be written ({error.strerror})")
        ) from None
    typer.echo(f"{directory}: {', '.join(texts)}")
    typer.echo(f"next: cd {shlex.quote(str(directory))} && disc-model study my_study.yaml")


# ---- Parts


def _read(files: Sequence[Path]) -> tuple[Study, dict[str, GridStudy], tuple[str, ...]]:
    """The study of the files, checked with all files that it names, all grids, and the names of
    those asked for."""
    from disc_model.studies.study import load_study

    chosen = load_study(*files)
    folders = [Path(), *(file.parent for file in files), PACKAGE]
    return chosen, *chosen.grids(folders)


# ---- All commands

INTERRUPTED = 130  # typer's exit code after Ctrl-C
OF_WORKFLOW = ("matplotlib", "cmcrameri", "yaml", "snakemake")  # which only this extra brings

app = typer.Typer(
    pretty_exceptions_enable=False,
    help="Friction-induced vibration of an elastic disc and a moving slider.",
)
for function in (run, floquet, sliding, modes, study, list_, convert, init, compile_):
    app.command(function.__name__.rstrip("_"))(function)


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
    if arguments is None:  # in a process of its own
        arguments = sys.argv[1:]
        end_without_reader()
    if not arguments:
        arguments = ["--help"]
    # figures are only saved, and the backend of a notebook may not be installed here; Snakemake's
    # jobs inherit this
    os.environ["MPLBACKEND"] = "agg"
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
