"""Commands on one case: `run`, `floquet`, `sliding`, `modes` and `compile`.

Their options are made from the fields of pydantic models: `Parameters`, and those of the commands below. Values are
passed on as text, so that the same rules and messages apply as everywhere else.
"""

import functools
import inspect
import math
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal, get_args, get_origin

import typer
from pydantic import AfterValidator, BeforeValidator, Field
from rich.console import Console
from rich.table import Column, Table

from disc_model.data.variables import BESIDE_WINDOWS
from disc_model.disc.flexibility import residual_flexibility
from disc_model.disc.plate import coupled_natural_frequencies, mode_arrays
from disc_model.disc.plausibility import warn_of_doubts
from disc_model.disc.tables import damping_ratios, disc_table, read_disc
from disc_model.errors import Fault, ParameterError, as_text, raise_faults
from disc_model.mode_choice import CHOSEN_BY, FREQUENCIES, TRUSTED, ModeChoice, chosen_modes, read_asked
from disc_model.parameters import AUTO, CHOOSING, Parameters
from disc_model.simulation.case import Ramp, Window
from disc_model.units import CYCLE_TOLERANCES, TOLERANCES, Count, CycleTolerance, Seconds, Strict, Tolerance

# ----------------------------------------------------------------------------------------------------
# Options, one for each field of a model

PANELS = {
    "Run": ["t_end", "stop_at", "window", "ramp", "plot", "save", "csv"],
    "Slider": ["N", "Omega", "m", "r_0", "k", "k_p", "c", "c_p"],
    "Disc": ["D_star", "E", "a", "b", "h", "nu", "rho", "normalization", "damping_ratio", "disc"],
    "Friction and contact": [
        "mu_s", "mu_k", "contact", "contact_compliance", "contact_force", "friction_offset", "friction_decay",
    ],
    "Numerics": ["n_diameters", "n_circles", *CHOOSING, "tol", "max_steps"],
}  # fmt: skip
"""Headings of the help in their order, and the fields below them."""
HELP = {
    "n_diameters": f"highest number of nodal diameters, -1 for a rigid disc, {AUTO}: as many as a tolerance asks for",
    CHOOSING[0]: f"quantity by which {AUTO} chooses, {FREQUENCIES} if not given",
    CHOOSING[1]: f"relative tolerance of this quantity, at least {TRUSTED:g}; if not given, "
    + ", ".join(f"{default:g} for {name}" for name, default in CHOSEN_BY.items()),
}
"""Help texts of fields of `Parameters` that take more on the command line, and of `CHOOSING`."""
WORDS = {
    "disc": ("FILE",), "n_diameters": ("VALUE", AUTO), CHOOSING[0]: tuple(CHOSEN_BY), "t_end": ("SECONDS",),
    "plot": ("FILE",), "save": ("FILE",), "window": ("NAME:KEY=VALUE,...",), "ramp": ("PARAMETER:KEY=VALUE,...",),
}  # fmt: skip
"""Values, in capitals those that stand for others, of options whose types do not name them."""
Given = dict[str, Any]
"""Options that were given, as text, by the fields that they stand for."""


def option_name(field: str) -> str:
    """Command-line option of a field: D_star -> --D-star."""
    return "--" + field.replace("_", "-")


def _option(name: str, field: Any = None, placeholder: str | None = None) -> inspect.Parameter:
    """The keyword option of a field of a model, or of `CHOOSING`; a placeholder makes a required field optional."""
    types = [str] if field is None else [field.annotation, *get_args(field.annotation)]
    literals = tuple(word for kind in types if get_origin(kind) is Literal for word in get_args(kind))
    words = WORDS.get(name) or (literals if literals and float not in types else ("VALUE", *literals))
    told, unit = HELP.get(name) or field.description, Parameters.unit(name).removeprefix("1")
    told += f" ({unit})" * bool(unit)
    if field is not None:
        default = field.default if placeholder is None else placeholder
        shown = f"{default:g}" if isinstance(default, float) else default
        required = field.is_required() and placeholder is None
        told += r" \[required]" if required else rf" \[default: {shown}]" * isinstance(default, str | int | float)
    flag, several = types[0] is bool, get_origin(types[0]) in (tuple, dict)
    option = typer.Option(
        option_name(name),
        metavar=None if flag else "|".join(words),
        autocompletion=None if flag else lambda: [word for word in words if not word.isupper()],
        help=told,
        show_default=False,
        rich_help_panel=next(panel for panel, names in PANELS.items() if name in names),
    )
    kind: Any = bool if flag else list[str] | None if several else str | None
    default = False if flag else placeholder
    return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=Annotated[kind, option])


def command(options: type[Any], **placeholders: str) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Give a command the options of a case and of a model: it receives the case, its choice of modes, and the model."""
    case_options = [_option(name, field, placeholders.get(name)) for name, field in Parameters.model_fields.items()]
    case_options += map(_option, CHOOSING)
    own_options = [_option(name, field) for name, field in options.model_fields.items()]

    def decorate(function: Callable[..., None]) -> Callable[..., None]:
        @functools.wraps(function)
        def wrapped(**values: Any) -> None:
            texts = {name: value for name, value in values.items() if value not in (None, [])}
            case = {option.name: texts.pop(option.name) for option in case_options if option.name in texts}
            faults: list[str] = []
            p, choice = parameters_of(case, faults)
            try:
                model = options(**texts)
            except ParameterError as error:
                faults += error.faults
            raise_faults(faults)
            function(p, choice, model)

        order = [name for names in PANELS.values() for name in names]
        shown = sorted(own_options + case_options, key=lambda option: order.index(option.name))
        wrapped.__signature__ = inspect.Signature(shown)  # type: ignore[attr-defined]
        return wrapped

    return decorate


def parameters_of(case: Given, faults: list[str]) -> tuple[Parameters, ModeChoice | None]:
    """Parameters of the given options, and the choice of modes, if any; faults are appended to `faults`."""
    values = dict(case)
    try:
        values |= {"disc": read_disc(case["disc"])} if "disc" in case else {}
    except ParameterError as error:
        del values["disc"]
        inner = (Fault(fault.path[1:], fault.value, fault.rule) for fault in error.faults)  # without the file's name
        faults += (Fault.of(("disc",), case["disc"], str(fault)) for fault in inner)
    try:
        p, request = read_asked(values)
        if faults:
            return p, None
        warn_of_doubts(p, lambda text: typer.echo(f"warning: {text}", err=True))
        choice = None if request is None else chosen_modes(p, request)
    except ParameterError as error:
        faults += error.faults
        return Parameters(N=0.0, Omega=0.0), None
    return (p, None) if choice is None else (choice.parameters, choice)


def table(title: str, heads: Iterable[str], rows: Iterable[Iterable[str]], **column: Any) -> None:
    """Print a table; ``column``: how rich shows each column."""
    printed = Table(*(Column(head, **column) for head in heads), title=title)
    for row in rows:
        printed.add_row(*row)
    Console().print(printed)


def print_rows(lines: Iterable[tuple[str, str]]) -> None:
    """Print lines that consist of a name and its text."""
    for name, text in lines:
        typer.echo(f"{name:<20}{text}")


def model_lines(p: Parameters, choice: ModeChoice | None) -> Iterator[tuple[str, str]]:
    """The model of a case in words, and the result of ``--n-diameters auto``."""
    modes = p.normalization if p.disc is None else f"a disc of {len(p.disc.omega)} modes"
    yield "model", f"{modes}, {p.contact} contact"
    yield from choice.summary() if choice else ()


# ----------------------------------------------------------------------------------------------------
# Modes and cycles


class ModesOptions(Strict):
    """Options of `modes`."""

    csv: bool = Field(False, description="print the modes as a table that --disc reads, 17 digits")


@command(ModesOptions, N="0", Omega="0")
def modes(p: Parameters, choice: ModeChoice | None, options: ModesOptions) -> None:
    """Print the modes of the disc, its flexibility under the slider, and the coupled frequencies at rest."""
    if options.csv:
        typer.echo(disc_table(p), nl=False)
        return
    print_rows(model_lines(p, choice))
    arrays = mode_arrays(p)
    rows = [
        (str(c), str(l), f"{omega:.3f}", f"{omega / math.tau:.3f}", f"{psi:.6g}", f"{psi**2:.6f}", f"{ratio:.3g}")
        for c, l, omega, psi, ratio in zip(
            arrays.circles, arrays.diameters, arrays.omega, arrays.psi, damping_ratios(p), strict=True
        )
    ]
    heads = (
        "circles",
        "diameters",
        "omega (rad/s)",
        "f (Hz)",
        "amplitude (kg^-1/2)",
        "squared (1/kg)",
        "damping ratio",
    )
    table("Modes of the disc", heads, rows, justify="right")
    if p.disc is None or p.disc.static_compliance is not None:
        give = residual_flexibility(p)
        numbers = (f"{give.total:.7g}", f"{give.remainder:.1e}", f"{give.kept:.7g}", f"{give.residual:.7g}")
        columns = ("all modes (m/N)", "remainder (m/N)", "modes above (m/N)", "residual (m/N)")
        table("Static flexibility of the disc under the slider", columns, [numbers], justify="right")
    at_rest = [(f"{value:.3f}", f"{value / math.tau:.3f}") for value in coupled_natural_frequencies(p)]
    table("Disc and slider at rest", ("lambda (rad/s)", "f (Hz)"), at_rest, justify="right")


class FloquetOptions(Strict):
    """Options of `floquet`."""

    tol: CycleTolerance = Field(
        1e-12, description=f"tolerance of the cycle, {CYCLE_TOLERANCES[0]:g} to {CYCLE_TOLERANCES[1]:g}"
    )


@command(FloquetOptions)
def floquet(p: Parameters, choice: ModeChoice | None, options: FloquetOptions) -> None:
    """Find the stick-slip cycle and its multipliers: whether the quiet motion lasts, without simulating it."""
    from disc_model.data.variables import CycleStatus
    from disc_model.stability.cycle import floquet as cycle_of

    cycle = cycle_of(p, tol=options.tol)
    print_rows([*cycle.summary(), *model_lines(p, choice)])
    if cycle.status is not CycleStatus.OK:
        raise typer.Exit(1)


@command(Strict)
def sliding(p: Parameters, choice: ModeChoice | None, _: Strict) -> None:
    """Print the modes of steady sliding (complex eigenvalues): frequencies, growth rates, damping."""
    from disc_model.stability.sliding import SlidingStatus, sliding_modes, steady_sliding

    state = steady_sliding(p)
    print_rows([*model_lines(p, choice), *state.summary()])
    if state.status is not SlidingStatus.OK:
        raise typer.Exit(1)
    modes = sliding_modes(p, state)
    rows = [
        (f"{f:.4f}", f"{rate:.6g}", f"{xi:.3g}", "in the plane" if l < 0 else f"{l}", f"{wave:.2f}" if l > 0 else "")
        for f, rate, xi, l, wave in zip(
            modes.frequency, modes.growth_rate, modes.damping_ratio, modes.diameters, modes.forward, strict=True
        )
    ]
    heads = ("f (Hz)", "growth (1/s)", "damping ratio", "nodal diameters", "forward wave")
    table("Modes in the slider's frame", heads, rows, justify="right")


def compile_() -> None:
    """Compile the kernels of the default model into the cache, which a first use otherwise does."""
    from disc_model.simulation.api import simulate
    from disc_model.stability.cycle import floquet

    began, p = time.perf_counter(), Parameters(N=385, Omega=15)
    simulate(p, 0.1)
    floquet(p)
    typer.echo(f"kernels compiled and cached: {time.perf_counter() - began:.1f} s")


# ----------------------------------------------------------------------------------------------------
# A simulation


def _values(text: str, form: str) -> tuple[str, dict[str, str]]:
    """Name before the colon, and values by key, of a text such as ``late:last=3,rate=4000``."""
    name, _, rest = text.rpartition(":")
    pairs = [pair.partition("=") for pair in rest.split(",")]
    if not all(sign for _, sign, _ in pairs):
        raise ParameterError(Fault((), as_text(text), f"must be {form}"))
    return name, {key.strip(): value for key, _, value in pairs}


def _windows(texts: Sequence[str]) -> dict[str, Window]:
    """Windows by name; those without one are sample_0 and so on."""
    windows: dict[str, Window] = {}
    for i, text in enumerate(texts):
        name, values = _values(text, "NAME:KEY=VALUE,...")
        name = name or f"sample_{i}"
        if not name.isidentifier() or name in {*windows, *BESIDE_WINDOWS}:
            rule = "must have a name of its own, not that of a variable or of events"
            raise ParameterError(Fault((), as_text(text), rule))
        windows[name] = _part(Window, name, values)
    return windows


def _ramps(texts: Sequence[str]) -> list[Ramp]:
    ramps = [_values(text, "PARAMETER:KEY=VALUE,...") for text in texts]
    return [_part(Ramp, name, {"parameter": name, **values}) for name, values in ramps]


def _part(model: type[Any], name: str, values: dict[str, str]) -> Any:
    try:
        return model(**values)
    except ParameterError as error:
        raise ParameterError(*(fault.inside((name,)) for fault in error.faults)) from None


def _writable(path: Path) -> Path:
    """Refuse a file that cannot be written, before the simulation instead of after it."""
    if not path.parent.is_dir():
        raise ValueError("must be in a folder that exists")
    if path.is_dir():
        raise ValueError("must be the name of a file")
    return path


def _drawable(path: Path) -> Path:
    from matplotlib.backend_bases import FigureCanvasBase

    kinds = FigureCanvasBase.get_supported_filetypes()
    if path.suffix.lower().lstrip(".") not in kinds:
        raise ValueError(f"must end in one of {', '.join(sorted(kinds))}")
    return path


class RunOptions(Strict):
    """Options of `run`."""

    t_end: Seconds = Field(description="time at which the run ends (s)")
    tol: Tolerance = Field(
        1e-10,
        description=f"error of event times after a second of motion, s, {TOLERANCES[0]:g} to {TOLERANCES[1]:g}; above "
        "1.25e-7 it is computed and recorded as 1.25e-7 (2e-6 on a compliant contact)",
    )
    stop_at: Literal["first_separation"] | None = Field(None, description="end early")
    plot: Annotated[Path, AfterValidator(_drawable), AfterValidator(_writable)] | None = Field(
        None, description="draw contact force and disc displacement"
    )
    save: Annotated[Path, AfterValidator(_writable)] | None = Field(
        None, description="write the result as netCDF, for disc_model.load"
    )
    window: Annotated[dict[str, Window], BeforeValidator(_windows)] = Field(
        {},
        description="samples to keep, such as late:last=3,rate=4000 or whole:rate=2000,envelope=1000; keys start, "
        "stop, last (s), rate (Hz), theta (rad), envelope; may be repeated",
    )
    ramp: Annotated[tuple[Ramp, ...], BeforeValidator(_ramps)] = Field(
        (),
        description="a slow change of Omega or N, such as Omega:to=5,start=100,end=400; keys to (rad/s or N), start, "
        "end (s); may be repeated",
    )
    max_steps: Annotated[Count, Field(ge=1)] | None = Field(None, description="give up after so many steps")


@command(RunOptions)
def run(p: Parameters, choice: ModeChoice | None, options: RunOptions) -> None:
    """Simulate one case from static equilibrium and print what happened."""
    from disc_model.simulation.api import Execution, simulate

    limits = Execution(max_steps=options.max_steps)
    result = simulate(
        p, options.t_end, options.window, tol=options.tol, stop_at=options.stop_at, ramps=options.ramp, execution=limits
    )
    speed = f"{result.final_state.time / max(result.statistics['wall_time'], 1e-9):.0f} simulated seconds a second"
    wall = ("wall time", f"{result.statistics['wall_time']:.3g} s ({speed})")
    print_rows([*result.summary(), *model_lines(p, choice), wall, ("key", p.key)])
    if options.save is not None:
        result.save(options.save)
        print_rows([("saved", str(options.save))])
    if options.plot is not None:
        _save_plot(result, [*options.window] or None, options.plot)
    if not result.status.complete:
        raise typer.Exit(1)


def _save_plot(result: Any, windows: list[str] | None, path: Path) -> None:
    import matplotlib as mpl
    from matplotlib import pyplot

    mpl.use("Agg")
    try:
        result.plot(windows)
        pyplot.savefig(path, dpi=150)
    except OSError as error:
        raise ParameterError(f"plot={str(path)!r}: cannot be written ({error.strerror})") from None
    print_rows([("figure", str(path))])
