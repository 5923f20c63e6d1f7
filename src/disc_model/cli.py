"""Command line ``disc-model``. Wrong input gives exit code 2, a computation that ends early 1."""

from __future__ import annotations

import argparse
import math
import os
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import disc_model as dm
from disc_model.display import brought
from disc_model.provenance import PACKAGE

if TYPE_CHECKING:
    from pandas import DataFrame

INTERRUPTED = 130  # exit code of a shell after Ctrl-C


def values_of(texts: list[str]) -> dict[str, Any]:
    """The values of texts such as N=385; a disc is the file of its table."""
    values: dict[str, Any] = {}
    for text in texts:
        name, sign, value = text.partition("=")
        if not sign:
            raise dm.ParameterError(f"{text}: must be NAME=VALUE, such as N=385")
        values[name] = dm.Disc.from_csv(value) if name == "disc" else value
    return values


def case_of(texts: list[str]) -> dm.Parameters:
    """The case of texts such as N=385."""
    return dm.Parameters(**values_of(texts))


def show(rows: list[tuple[str, str]]) -> None:
    """Print names and their texts."""
    for name, text in rows:
        print(f"{name:<20}{text}")


def show_table(title: str, table: DataFrame) -> None:
    """Print a table below its title."""
    print(f"\n{title}\n{table.to_string(index=False, float_format='{:.6g}'.format)}")


# ---- Commands, which return whether they came to their end


def run(options: argparse.Namespace) -> bool:
    """Simulate a case from static equilibrium."""
    case = case_of(options.case)
    result = dm.simulate(case, options.t_end, tol=options.tol)
    show([*result.summary(), ("key", case.key)])
    if options.save is not None:
        result.save(options.save)
    if options.csv is not None:
        options.csv.mkdir(parents=True, exist_ok=True)
        result.to_csv(options.csv)
    if options.plot is not None:
        result.plot()
        brought("matplotlib.pyplot", "plot").savefig(options.plot, dpi=150)
    return result.status.complete


def floquet(options: argparse.Namespace) -> bool:
    """Find the stick-slip cycle and its multipliers."""
    cycle = dm.floquet(case_of(options.case))
    print(cycle)
    if cycle.status != "ok":
        print(cycle.status.advice)
        return False
    return True


def sliding(options: argparse.Namespace) -> bool:
    """Find the complex eigenvalues of steady sliding."""
    import pandas as pd

    state = dm.steady_sliding(case_of(options.case))
    print(repr(state))
    upper = state.eigenvalues[state.eigenvalues.imag >= 0]
    if not upper.size:
        return False
    columns = {"growth rate (1/s)": upper.real, "frequency (Hz)": upper.imag / math.tau}
    show_table("Modes in the slider's frame", pd.DataFrame(columns))
    return True


def squeal(options: argparse.Namespace) -> bool:
    """Find the modes of steady sliding that grow within a range of speeds, and why."""
    bounds = tuple(options.bounds)
    case = case_of([f"Omega={bounds[-1]}", *options.case])
    show_table("Modes that grow (Hz, 1/s, rad/s)", dm.squeal(case, bounds))
    return True


def modes(options: argparse.Namespace) -> bool:
    """Find the modes of the disc, and its frequencies with the slider at rest."""
    import pandas as pd

    values = {"N": 0, "Omega": 0, **values_of(options.case)}
    if options.source is not None:
        place = {"axis": options.axis, "centre": options.centre, "units": options.units}
        values["disc"] = dm.Disc.from_uff(options.source, values.get("r_0", ""), **place)
    case = dm.Parameters(**values)
    show_table("Disc alone: omega in rad/s, psi in kg^-1/2", dm.plate_modes(case))
    at_rest = dm.coupled_natural_frequencies(case)
    columns = {"omega (rad/s)": at_rest, "frequency (Hz)": at_rest / math.tau}
    show_table("Disc and slider at rest", pd.DataFrame(columns))
    if options.save is not None and case.disc is not None:
        case.disc.to_csv(options.save)
    return True


def study(options: argparse.Namespace) -> bool:
    """Compute a study and draw its figures by Snakemake: only what is missing or out of date.
    Further options are those of Snakemake."""
    snakemake = brought("snakemake.cli", "workflow")
    from disc_model.studies.study import load_study

    load_study(*options.files)  # says what is wrong in fewer words than Snakemake
    snakefile = (PACKAGE / "workflow" / "Snakefile").resolve()
    cores = options.cores or brought("snakemake.utils", "workflow").available_cpu_count()
    files = [str(file.resolve()) for file in options.files]
    arguments = ["-s", str(snakefile), *options.target, f"-j{cores}", *options.case]
    snakemake.main([*arguments, "--configfile", *files])
    return True


# ---- Arguments


def parser() -> argparse.ArgumentParser:
    """The arguments of all commands."""
    whole = argparse.ArgumentParser("disc-model", description="Vibration of a disc and a slider.")
    whole.add_argument("--version", action="version", version=f"disc_model {dm.__version__}")
    commands = whole.add_subparsers(required=True, metavar="COMMAND")
    made = {}
    for command in (run, floquet, sliding, squeal, modes, study):
        words = str(command.__doc__)
        made[command] = commands.add_parser(command.__name__, help=words, description=words)
        made[command].set_defaults(command=command)
        if command is not study:
            what = "parameters, such as N=385 h=2mm disc=disc.csv"
            made[command].add_argument("case", nargs="*", metavar="NAME=VALUE", help=what)

    made[run].add_argument("--t-end", required=True, help="time at which the run ends, s")
    made[run].add_argument("--tol", type=float, default=1e-10, help="error of event times, s")
    made[run].add_argument("--plot", type=Path, help="draw contact force and displacement")
    made[run].add_argument("--save", type=Path, help="write the result as netCDF")
    made[run].add_argument("--csv", type=Path, help="write the events as text into this folder")

    what = "lowest and highest speed (rad/s, or with units)"
    made[squeal].add_argument("--bounds", nargs=2, required=True, help=what)

    what = "universal file of a modal test or of finite elements"
    made[modes].add_argument("--from", dest="source", type=Path, metavar="FILE", help=what)
    for name, what in (
        ("--axis", "from the disc to the slider, such as 0,0,1"),
        ("--centre", "a point on the axis, such as 0,0,0 (m)"),
        ("--units", "of length and force in the file, such as mm,N"),
    ):
        made[modes].add_argument(name, type=lambda text: text.split(","), default=(), help=what)
    made[modes].add_argument("--save", type=Path, help="write the modes of the disc as a table")

    what = "study files, later ones laid over earlier ones"
    made[study].add_argument("files", nargs="+", type=Path, metavar="FILE", help=what)
    made[study].add_argument("--cores", "-j", type=int, help="jobs at the same time")
    what = "a file or rule to make instead of all; repeatable"
    made[study].add_argument("--target", action="append", default=[], help=what)
    return whole


def main(arguments: list[str] | None = None) -> NoReturn:
    """Run the command line; wrong input is told in one line."""
    # figures are only saved; Snakemake's jobs inherit this
    os.environ["MPLBACKEND"] = "agg"
    warnings.formatwarning = lambda text, *_, **__: f"warning: {text}\n"
    options, rest = parser().parse_known_args(arguments)
    options.case = [*getattr(options, "case", []), *rest]
    try:
        sys.exit(not options.command(options))
    except (dm.DiscModelError, ModuleNotFoundError) as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        sys.exit(INTERRUPTED)
