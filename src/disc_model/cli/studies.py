"""Commands on studies: `study` computes one, `list` lists its parts, `init` lays out a folder for one's own."""

from __future__ import annotations

import os
import re
import shlex
import signal
import subprocess
import sys
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console

from disc_model.cli.case import table
from disc_model.errors import DiscModelError, Fault, ParameterError

if TYPE_CHECKING:
    from disc_model.studies.grid import GridStudy
    from disc_model.studies.study import Study

    Grids = dict[str, GridStudy]

PACKAGE = Path(__file__).resolve().parents[1]
INTERRUPTED = 130
"""Exit code after Ctrl-C, equal to typer's: 128 plus the number of the signal, as in shells."""
KINDS = ("studies", "figures", "cases", "outdated")
Files = Annotated[list[Path], typer.Argument(help="study files, later ones laid over earlier ones")]


def study(
    files: Files,
    cores: Annotated[int, typer.Option("--cores", "-j", min=1, help="jobs at the same time")] = os.cpu_count() or 1,
    dry_run: Annotated[bool, typer.Option("--dry-run", "-n", help="only check, and list the jobs")] = False,
    directory: Annotated[Path, typer.Option("--directory", "-d", help="where results are written")] = Path(),
    target: Annotated[
        list[str] | None, typer.Option("--target", help="a file or rule to make instead of all; may be repeated")
    ] = None,
    unlock: Annotated[bool, typer.Option("--unlock", help="only remove the lock that a killed run has left")] = False,
    snakemake: Annotated[str, typer.Option("--snakemake", help="further options of Snakemake, as one text")] = "",
) -> None:
    """Compute a study and draw its figures: only what is missing or out of date, by Snakemake."""
    with _on_interrupt(signal.SIG_DFL):  # there is nothing to clean up yet, and what is imported swallows exceptions
        _read(files)
    options = [*(target or []), f"-j{cores}", "--directory", str(directory), *(["--unlock"] if unlock else [])]
    command = _command(files, [*options, *shlex.split(snakemake)])
    raise typer.Exit(_plan(command) if dry_run else _run(command))


def list_(
    what: Annotated[
        str, typer.Argument(metavar="|".join(KINDS), help="what to list", autocompletion=lambda: list(KINDS))
    ],
    files: Files,
    directory: Annotated[Path, typer.Option("--directory", "-d", help="where results are")] = Path(),
) -> None:
    """List the grid studies, figures or cases of a study, or what of its results is outdated."""
    if what not in KINDS:
        raise ParameterError(Fault(("what",), repr(what), f"must be one of {', '.join(KINDS)}"))
    chosen, grids, asked = _read(files)
    if what == "outdated":
        typer.echo(_outdated(files, directory))
        return
    heads, rows = _listed(what, chosen, grids, asked)
    Console().print(table(f"{what} of {chosen.name}", heads, rows, overflow="fold"))


def init(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="folder to lay out; made if it is not there")],
) -> None:
    """Lay out a folder for a study of your own: a study file to change, and a Snakefile for it."""
    _require_snakemake()
    workflow = PACKAGE / "workflow"
    schema = (workflow / "schemas" / "study.schema.json").resolve().as_uri()
    sources = ("template/my_study.yaml", "template/Snakefile", "profiles/default/config.yaml")
    texts = {name.removeprefix("template/"): (workflow / name).read_text() for name in sources}
    texts["my_study.yaml"] = texts["my_study.yaml"].replace("SCHEMA", schema)
    if there := [name for name in texts if (directory / name).exists()]:
        raise ParameterError(Fault(("DIR",), repr(str(directory)), f"must not hold {', '.join(there)} yet"))
    try:
        for name, text in texts.items():
            (directory / name).parent.mkdir(parents=True, exist_ok=True)
            (directory / name).write_text(text, encoding="utf-8")
    except OSError as error:
        raise ParameterError(Fault(("DIR",), repr(str(directory)), f"cannot be written ({error.strerror})")) from None
    typer.echo(f"{directory}: {', '.join(texts)}")
    typer.echo(f"next: cd {shlex.quote(str(directory))} && disc-model study my_study.yaml")


# ----------------------------------------------------------------------------------------------------
# Parts


def _require_snakemake() -> None:
    """Raise an error where a study could not be computed."""
    if find_spec("snakemake") is None:
        raise DiscModelError(
            "studies are computed by Snakemake, which is not installed: pip install 'disc_model[workflow]'"
        )


def _command(files: Sequence[Path], options: Sequence[str]) -> list[str]:
    """The Snakemake command that computes a study."""
    _require_snakemake()
    snakefile = (PACKAGE / "workflow" / "Snakefile").resolve()
    named = ["--configfile", *(str(file.resolve()) for file in files)]
    return [sys.executable, "-m", "snakemake", "-s", str(snakefile), *options, *named]


def _plan(command: list[str]) -> int:
    """Print how many jobs of each kind Snakemake would run; its exit code."""
    quiet = [*command, "-n", "--quiet", "rules", "host", "reason"]
    done = subprocess.run(quiet, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    jobs = re.search(r"^(?:job +count\n.*?\n\n|Nothing to be done.*?\n)", done.stdout, re.DOTALL | re.MULTILINE)
    if done.returncode or not jobs:
        typer.echo(done.stdout.rstrip(), err=True)
    else:
        typer.echo(f"{jobs[0].rstrip()}\nnothing was run: --dry-run")
    return done.returncode


@contextmanager
def _on_interrupt(handler: Any) -> Iterator[None]:
    """Set the handler of Ctrl-C for the duration of a block."""
    before = signal.signal(signal.SIGINT, handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _run(command: list[str]) -> int:
    """Run Snakemake and return its exit code; after Ctrl-C, wait until it has stopped its jobs and unlocked the folder.

    The terminal sends the signal to both processes.
    """
    interrupts: list[int] = []
    with _on_interrupt(lambda number, _: interrupts.append(number)), subprocess.Popen(command) as process:
        if interrupts:  # Ctrl-C came before the second process
            process.send_signal(signal.SIGINT)
        code = process.wait()
    if not (code and interrupts):
        return code
    typer.echo("what is finished stays: the same command continues from there", err=True)
    return INTERRUPTED


def _read(files: Sequence[Path]) -> tuple[Study, Grids, tuple[str, ...]]:
    """The study of the files, checked with all files that it names, all grids, and the names of those asked for."""
    from disc_model.studies.study import load_study

    chosen = load_study(*files)
    folders = [Path(), *(file.parent for file in files), PACKAGE]
    return chosen, *chosen.grids(folders)


def _listed(
    what: str, chosen: Study, grids: Grids, asked: Collection[str]
) -> tuple[tuple[str, ...], Sequence[tuple[str, ...]]]:
    """Heads and rows of a table of the grid studies, figures or cases."""
    from disc_model.data.variables import values_text

    if what == "studies":
        heads = ("study", "quantity", "dimensions", "points", "title")
        each = [grids[name] for name in asked]
        return heads, [(one.name, one.quantity, " x ".join(one.values), str(one.n_points), one.title) for one in each]
    if what == "cases":
        parameters = {name: values_text(dict(spec.parameters)) for name, spec in chosen.specs.items()}
        cases = [(name, case.title, parameters[name], f"{case.t_end:g}") for name, case in chosen.cases.items()]
        return ("case", "title", "parameters", "t_end (s)"), cases
    figures = {key: figure for key, figure in chosen.entries(grids).items() if key[0] in (chosen.name, *asked)}
    return ("figure", "kind", "title"), [(name, one.plot.kind, one.title) for (_, name), one in figures.items()]


def _outdated(files: Sequence[Path], directory: Path) -> str:
    """The files of a study that a run would compute, a line each, and their number; according to Snakemake."""
    command = _command(files, ["--summary", "--directory", str(directory)])
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise DiscModelError(f"Snakemake failed: {done.stderr.strip()}")
    head, *lines = [line.split("\t") for line in done.stdout.splitlines() if "\t" in line]
    rows = [dict(zip(head, line, strict=False)) for line in lines]
    outdated = [f"{row['output_file']}: {row['status']}" for row in rows if row["plan"] != "no update"]
    return "\n".join([*outdated, f"{len(outdated)} of {len(rows)} files are missing or out of date"])
