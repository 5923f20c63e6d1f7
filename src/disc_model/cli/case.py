"""Common options of commands on one case, made from the fields of `Parameters`.

Thus no parameter is forgotten. Values are passed on as text, so that the same rules and messages apply as everywhere
else.
"""

import functools
import inspect
from collections.abc import Callable, Iterable, Iterator
from typing import Annotated, Any, Literal, get_args, get_origin

import typer
from pydantic import create_model
from rich.table import Column, Table

from disc_model.disc.plausibility import warn_of_doubts
from disc_model.disc.tables import read_disc
from disc_model.errors import Fault, ParameterError
from disc_model.mode_choice import AUTO, CHOOSING, CHOSEN_BY, FREQUENCIES, TRUSTED, ModeChoice, chosen_modes, read_asked
from disc_model.parameters import Parameters
from disc_model.units import Strict

ANY = "VALUE"
"""Placeholder in help texts for an option whose values are not a list of words."""


def option_name(field: str) -> str:
    """Command-line option of a field of `Parameters`: D_star -> --D-star."""
    return "--" + field.replace("_", "-")


def _case_options(placeholders: dict[str, str]) -> Iterator[inspect.Parameter]:
    """An option for each field of `Parameters`, and those for choosing modes with ``--n-diameters auto``.

    `placeholders` are values for required fields.
    """
    for name, field in Parameters.model_fields.items():
        placeholder, unit = placeholders.get(name), Parameters.unit(name)
        default = placeholder or field.default
        shown = f"{default:g}" if isinstance(default, float) else default
        rule = "required" if field.is_required() and placeholder is None else f"default: {shown}"
        words, more = _words(field.annotation), ""
        if name == "disc":
            words = ("FILE",)
        if name == "n_diameters":
            words, more = (*words, AUTO), f", {AUTO} for as many as the tolerance below asks for"
        told = f"{field.description}{more}{f' ({unit})' if unit not in ('', '1') else ''} [{rule}]"
        yield _case_option(name, placeholder, words, told)
    quantity, tolerance = CHOOSING
    yield _case_option(quantity, None, tuple(CHOSEN_BY), f"quantity by which {AUTO} chooses [default: {FREQUENCIES}]")
    usual = ", ".join(f"{default:g} for {name}" for name, default in CHOSEN_BY.items())
    told = f"relative tolerance of this quantity, at least {TRUSTED:g} [default: {usual}]"
    yield _case_option(tolerance, None, (ANY,), told)


def _case_option(name: str, default: str | None, words: tuple[str, ...], told: str) -> inspect.Parameter:
    """A keyword option of the case, spelt with and without underscores; `words` are its allowed values."""
    option = typer.Option(
        *dict.fromkeys([option_name(name), f"--{name}"]),
        metavar="|".join(words),
        autocompletion=lambda: [word for word in words if not word.isupper()],
        help=told.replace("[", r"\["),
        show_default=False,
        rich_help_panel="Parameters of the case",
    )
    return inspect.Parameter(
        name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=Annotated[str | None, option]
    )


def _words(annotation: Any) -> tuple[str, ...]:
    """Allowed words of a parameter by its type, and a placeholder if other values are allowed."""
    if get_origin(annotation) is Literal:
        return get_args(annotation)
    return (ANY, *(word for part in get_args(annotation) if get_origin(part) is Literal for word in get_args(part)))


def with_case_options(**placeholders: str) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Give a command one option for each parameter; it receives them together as the mapping `case`."""

    def decorate(command: Callable[..., None]) -> Callable[..., None]:
        options = [p for p in inspect.signature(command, eval_str=True).parameters.values() if p.name != "case"]
        case_options = list(_case_options(placeholders))

        @functools.wraps(command)
        def wrapped(**values: Any) -> None:
            case = {option.name: values.pop(option.name) for option in case_options}
            command(case={name: value for name, value in case.items() if value is not None}, **values)

        wrapped.__signature__ = inspect.Signature(options + case_options)  # type: ignore[attr-defined]
        return wrapped

    return decorate


def parameters_of(case: dict[str, str], faults: list[str]) -> tuple[Parameters, ModeChoice | None]:
    """Parameters of the given options, and the choice of modes, if any; faults are appended to `faults`."""
    values: dict[str, Any] = dict(case)
    try:
        if "disc" in case:
            values["disc"] = read_disc(case["disc"])
    except ParameterError as error:
        del values["disc"]
        inner = (Fault(fault.path[1:], fault.value, fault.rule) for fault in error.faults)  # without the file's name
        faults += (Fault.of(("disc",), case["disc"], str(fault)) for fault in inner)
    try:
        p, request = read_asked(values)
        warn_of_doubts(p, lambda text: typer.echo(f"warning: {text}", err=True))
        if request is None:
            return p, None
        choice = chosen_modes(p, request)
        return choice.parameters, choice
    except ParameterError as error:
        faults += error.faults
        return Parameters(N=0.0, Omega=0.0), None


def case_lines(p: Parameters, choice: ModeChoice | None) -> list[tuple[str, str]]:
    """The case, and its modes if they were chosen: the first lines of every command on one case."""
    case = f"N = {p.N:g} N, Omega = {p.Omega:g} rad/s, {disc_words(p)}, {p.contact} (key {p.key})"
    return [("case", case), *choice_lines(choice)]


def disc_words(p: Parameters) -> str:
    """Description of the disc."""
    return p.normalization if p.disc is None else f"a disc of {len(p.disc.omega)} modes"


def choice_lines(choice: ModeChoice | None) -> Iterator[tuple[str, str]]:
    """Result of ``--n-diameters auto``."""
    if choice is not None:
        p, name = choice.parameters, choice.quantity.replace("_", " ")
        right = f"{name}: error {choice.error:.2g}, {choice.tolerance:g} asked for"
        of_plate = f"n_diameters = {p.n_diameters}, n_circles = {p.n_circles}"
        size = of_plate if p.disc is None else f"the first {len(p.disc.omega)} of the table"
        yield "modes chosen", f"{size} ({right})"


def table(title: str, heads: Iterable[str], rows: Iterable[Iterable[str]], **column: Any) -> Table:
    """A table for the terminal; ``column``: how rich shows each column."""
    made = Table(*(Column(head, **column) for head in heads), title=title)
    for row in rows:
        made.add_row(*row)
    return made


def print_rows(lines: Iterable[tuple[str, str]]) -> None:
    """Print lines that consist of a name and its text."""
    for name, text in lines:
        typer.echo(f"{name:<20}{text}")


def option(name: str, text: str | None, kind: Any, faults: list[str], default: Any = ...) -> Any:
    """The value of a type that `text` stands for, or None if it is faulty; faults are appended to `faults`."""
    fields: dict[str, Any] = {name: (kind, default)}
    values = {} if text is None else {name: text}
    try:
        return getattr(create_model("Option", __base__=Strict, **fields)(**values), name)
    except ParameterError as error:
        faults += error.faults
        return None
