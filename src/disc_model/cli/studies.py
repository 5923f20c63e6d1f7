"""Commands on studies: `study` computes one, `list` and `status` say what it has, `init` lays out a folder for one."""

from __future__ import annotations

import os
import re
import shlex
import signal
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from disc_model.cli.case import table
from disc_model.errors import DiscModelError, Fault, ParameterError, suggestion

if TYPE_CHECKING:
    from disc_model.studies.grid import GridStudy
    from disc_model.studies.study import Study

    Grids = dict[str, GridStudy]

PACKAGE = Path(__file__).resolve().parents[1]
INTERRUPTED = 130
"""Exit code after Ctrl-C, equal to typer's: 128 plus the number of the signal, as in shells."""
LISTED = ("studies", "figures", "cases")
Files = Annotated[list[Path], typer.Argument(help="study files, later ones laid over earlier ones")]


def study(
    files: Files,
    cores: Annotated[int, typer.Option("--cores", "-j", min=1, help="jobs at the same time")] = os.cpu_count() or 1,
    dry_run: Annotated[bool, typer.Option("--dry-run", "-n", help="only check, and list the jobs")] = False,
    directory: Annotated[Path, typer.Option("--directory", "-d", help="where results are written")] = Path(),
    figure: Annotated[
        list[str] | None, typer.Option("--figure", metavar="NAME", help="a figure to draw instead of all; repeatable")
    ] = None,
    target: Annotated[
        list[str] | None, typer.Option("--target", help="a file or rule to make instead of all; repeatable")
    ] = None,
    unlock: Annotated[bool, typer.Option("--unlock", help="only remove the lock that a killed run has left")] = False,
    snakemake: Annotated[str, typer.Option("--snakemake", help="further options of Snakemake, as one text")] = "",
) -> None:
    """Compute a study and draw its figures: only what is missing or out of date, by Snakemake."""
    with _on_interrupt(signal.SIG_DFL):  # there is nothing to clean up yet, and what is imported swallows exceptions
        chosen, grids, _ = _read(files)
    targets = [*(target or []), *(_figure_file(name, chosen, grids) for name in figure or [])]
    options = [*targets, f"-j{cores}", "--directory", str(directory), *(["--unlock"] if unlock else [])]
    command = _command(files, [*options, *shlex.split(snakemake)])
    raise typer.Exit(_plan(command) if dry_run else _run(command))


def list_(
    what: Annotated[
        str, typer.Argument(metavar="|".join(LISTED), help="what to list", autocompletion=lambda: list(LISTED))
    ],
    files: Files,
) -> None:
    """List the grid studies, figures or cases of a study."""
    if what not in LISTED:
        raise ParameterError(Fault(("what",), repr(what), f"must be one of {', '.join(LISTED)}"))
    from disc_model.data.variables import values_text

    chosen, grids, requested = _read(files)
    heads: tuple[str, ...]
    rows: list[tuple[str, ...]]
    if what == "studies":
        heads = ("study", "quantity", "dimensions", "points", "title")
        listed = [grids[name] for name in requested]
        rows = [(x.name, x.quantity, " x ".join(x.values), str(x.n_points), x.title) for x in listed]
    elif what == "cases":
        heads = ("case", "title", "parameters", "t_end (s)")
        texts = {name: values_text(dict(spec.parameters)) for name, spec in chosen.specs.items()}
        labels = chosen.labels
        rows = [(name, labels[name]["title"], texts[name], f"{case.t_end:g}") for name, case in chosen.cases.items()]
    else:
        heads, entries = ("figure", "kind", "title"), chosen.entries(grids).items()
        rows = [(name, x.plot.kind, x.title) for (study, name), x in entries if study in (chosen.name, *requested)]
    if rows:
        table(f"{what} of {chosen.name}", heads, rows, overflow="fold")
    else:
        typer.echo(f"{chosen.name} has no {what}")


def status(
    files: Files, directory: Annotated[Path, typer.Option("--directory", "-d", help="where results are")] = Path()
) -> None:
    """List what of a study's results is missing or out of date, according to Snakemake."""
    _read(files)
    done = subprocess.run(
        _command(files, ["--summary", "--directory", str(directory)]), capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise DiscModelError(f"Snakemake failed: {done.stderr.strip()}")
    head, *lines = [line.split("\t") for line in done.stdout.splitlines() if "\t" in line]
    rows = [dict(zip(head, line, strict=False)) for line in lines]
    outdated = [f"{row['output_file']}: {row['status']}" for row in rows if row["plan"] != "no update"]
    typer.echo("\n".join([*outdated, f"{len(outdated)} of {len(rows)} files are missing or out of date"]))


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
    if existing := [name for name in texts if (directory / name).exists()]:
        raise ParameterError(Fault(("DIR",), repr(str(directory)), f"must not hold {', '.join(existing)} yet"))
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


def _figure_file(name: str, chosen: Study, grids: Grids) -> str:
    """The file of a figure of a study, or of a grid that it names."""
    entries = chosen.entries(grids)
    studies = [study for study, figure in entries if figure == name]
    if not studies:
        known = [figure for _, figure in entries]
        raise ParameterError(Fault.of(("figure",), name, f"no such figure{suggestion(name, known)}"))
    return f"results/{studies[0]}/figures/{name}.png"
