"""Command line: ``disc-model run|floquet|sliding|modes|study|list|status|init|compile``.

Invalid input is reported on stderr with exit code 2: one line, or for a study file a list of its faults. A simulation
that ends early is reported and gives exit code 1.
"""

import re
import sys
from typing import Annotated, NoReturn

import typer

from disc_model import __version__
from disc_model.cli import case, studies
from disc_model.errors import DiscModelError

app = typer.Typer(
    pretty_exceptions_enable=False, help="Friction-induced vibration of an elastic disc and a moving slider."
)
for function in (
    *(case.run, case.floquet, case.sliding, case.modes),
    *(studies.study, studies.list_, studies.status, studies.init, case.compile_),
):
    app.command(function.__name__.rstrip("_"))(function)


def _show_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"disc_model {__version__}")
        raise typer.Exit


@app.callback()
def _all(
    version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="show the version and exit")
    ] = False,
) -> None: ...


def _fail(message: str) -> NoReturn:
    """Print a fault on stderr and exit with code 2."""
    typer.echo(f"error: {message}", err=True)
    sys.exit(2)


def main(arguments: list[str] | None = None) -> NoReturn:
    """Run the command line; never shows a traceback for bad input."""
    arguments = sys.argv[1:] if arguments is None else arguments
    # options may be spelt with underscores, as the parameters are
    arguments = [re.sub("^--[^=]+", lambda option: option[0].replace("_", "-"), text) for text in arguments]
    if not arguments or arguments[0] == "help":
        arguments = [*arguments[1:], "--help"]
    try:
        code = app(args=arguments, standalone_mode=False, prog_name="disc-model")
    except DiscModelError as error:
        _fail(str(error))
    except ModuleNotFoundError as error:
        if error.name not in ("matplotlib", "cmcrameri", "yaml", "snakemake"):  # which only the extra `workflow` brings
            raise
        _fail(f"there is no module {error.name}: pip install 'disc_model[workflow]' brings all that studies need")
    except Exception as error:
        if not hasattr(error, "format_message"):  # not a usage error of the command-line parser
            raise
        text = " ".join(error.format_message().split()).rstrip(".")
        _fail(text if text.endswith("?") else f"{text}.")
    if code == studies.INTERRUPTED:
        typer.echo("error: interrupted", err=True)
    sys.exit(code if isinstance(code, int) else 0)
