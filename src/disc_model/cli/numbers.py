"""Commands that print numbers of one case: `modes`, `floquet`."""

import math
import time
from typing import Annotated

import typer
from rich.console import Console

from disc_model.cli.case import (
    case_lines,
    choice_lines,
    disc_words,
    option,
    parameters_of,
    print_rows,
    table,
    with_case_options,
)
from disc_model.disc.flexibility import residual_flexibility
from disc_model.disc.plate import coupled_natural_frequencies, mode_arrays
from disc_model.disc.tables import damping_ratios, disc_table
from disc_model.errors import raise_faults
from disc_model.parameters import Parameters
from disc_model.units import CYCLE_TOLERANCES, CycleTolerance

TOLERANCE_HELP = f"tolerance of the cycle, {CYCLE_TOLERANCES[0]:g} to {CYCLE_TOLERANCES[1]:g}"


@with_case_options(N="0", Omega="0")
def modes(
    *,
    csv: Annotated[bool, typer.Option("--csv", help="print the modes as a table that --disc reads, 17 digits")] = False,
    case: dict[str, str],
) -> None:
    """Print the modes of the disc, its flexibility under the slider, and the coupled frequencies at rest."""
    faults: list[str] = []
    parameters, choice = parameters_of(case, faults)
    raise_faults(faults)
    if csv:
        typer.echo(disc_table(parameters), nl=False)
        return
    print_rows(choice_lines(choice))
    arrays = mode_arrays(parameters)
    ratios = damping_ratios(parameters)
    rows = [
        (str(c), str(l), f"{omega:.3f}", f"{omega / math.tau:.3f}", f"{psi:.6g}", f"{psi**2:.6f}", f"{ratio:.3g}")
        for c, l, omega, psi, ratio in zip(
            arrays.circles, arrays.diameters, arrays.omega, arrays.psi, ratios, strict=True
        )
    ]
    columns = ("circles", "diameters", "omega (rad/s)", "f (Hz)", "psi (kg^-1/2)", "psi^2 (1/kg)", "xi")
    tables = [table(f"Modes of the disc ({disc_words(parameters)})", columns, rows, justify="right")]
    if parameters.disc is None or parameters.disc.static_compliance is not None:
        give = residual_flexibility(parameters)
        numbers = (f"{give.total:.7g}", f"{give.remainder:.1e}", f"{give.kept:.7g}", f"{give.residual:.7g}")
        heads = ("all modes (m/N)", "remainder (m/N)", "modes above (m/N)", "residual (m/N)")
        tables.append(table("Static flexibility of the disc under the slider", heads, [numbers], justify="right"))
    at_rest = [(f"{value:.3f}", f"{value / math.tau:.3f}") for value in coupled_natural_frequencies(parameters)]
    tables.append(table("Disc and slider at rest", ("lambda (rad/s)", "f (Hz)"), at_rest, justify="right"))
    for each in tables:
        Console().print(each)


@with_case_options()
def floquet(
    *,
    tol: Annotated[str, typer.Option("--tol", metavar="VALUE", help=TOLERANCE_HELP)] = "1e-12",
    case: dict[str, str],
) -> None:
    """Find the stick-slip cycle and its multipliers: whether the quiet motion lasts, without simulating it."""
    faults: list[str] = []
    parameters, choice = parameters_of(case, faults)
    tolerance = option("tol", tol, CycleTolerance, faults)
    raise_faults(faults)
    from disc_model.data.variables import CycleStatus
    from disc_model.stability.cycle import floquet as cycle_of

    cycle = cycle_of(parameters, tol=tolerance)
    exists = cycle.status is CycleStatus.OK
    lines = [*case_lines(parameters, choice), ("status", cycle.message or cycle.status.value)]
    if exists:
        verdict = "small disturbances die out" if cycle.stable else "small disturbances grow"
        lines += [
            ("growth rate", f"{cycle.growth_rate:.6g} 1/s ({verdict})"),
            ("period", f"{cycle.period:.9g} s ({1 / cycle.period:.6g} Hz), {cycle.stick_fraction:.2%} of it sticking"),
            ("a period has", f"{cycle.releases} releases, {cycle.separations} separations"),
            ("leading multiplier", f"{cycle.multipliers[0]:.6g}, modulus {abs(cycle.multipliers[0]):.9g}"),
        ]
    else:
        lines.append(("advice", cycle.status.advice))
    rate = cycle.sliding.growth_rate
    sliding = f"growth rate {rate:.6g} 1/s" if math.isfinite(rate) else cycle.sliding.message
    lines.append(("steady sliding", sliding))
    print_rows(lines)
    if not exists:
        raise typer.Exit(1)


def compile_() -> None:
    """Compile the kernels of the default model into the cache, which a first use otherwise does."""
    from disc_model.simulation.api import simulate
    from disc_model.stability.cycle import floquet

    began, p = time.perf_counter(), Parameters(N=385, Omega=15)
    simulate(p, 0.1)
    floquet(p)
    typer.echo(f"kernels compiled and cached: {time.perf_counter() - began:.1f} s")
