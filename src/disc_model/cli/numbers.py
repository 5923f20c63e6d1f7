"""Commands that print numbers of one case: `modes`, `floquet`."""

from __future__ import annotations

import math
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from disc_model.cli.case import case_lines, number, parameters_of, tell, with_case_options
from disc_model.cli.progress import compiling
from disc_model.errors import ParameterError
from disc_model.parameters import CYCLE_TOLERANCES, Parameters, limits_rule

TOLERANCE_HELP = f"tolerance of the cycle, {CYCLE_TOLERANCES[0]:g} to {CYCLE_TOLERANCES[1]:g}"


@with_case_options(N="0", Omega="0")
def modes(*, case: dict[str, str]) -> None:
    """Print the disc's modes, its give under the slider, and the frequencies of both with the slider at rest."""
    from disc_model.flexibility import residual_flexibility
    from disc_model.plate import plate_modes, slider_at_rest_frequencies

    faults: list[str] = []
    parameters, choice = parameters_of(case, faults)
    if faults:
        raise ParameterError(*faults)
    if choice:
        tell([("modes chosen", choice)])
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


@with_case_options()
def floquet(
    *,
    tol: Annotated[str, typer.Option("--tol", metavar="VALUE", help=TOLERANCE_HELP)] = "1e-12",
    case: dict[str, str],
) -> None:
    """Find the stick-slip cycle and its multipliers: whether the quiet motion lasts, without simulating it."""
    faults: list[str] = []
    parameters, choice = parameters_of(case, faults)
    rule = limits_rule(CYCLE_TOLERANCES)
    tolerance = number("tol", tol, lambda x: CYCLE_TOLERANCES[0] <= x <= CYCLE_TOLERANCES[1], rule, faults)
    if faults:
        raise ParameterError(*faults)
    with compiling():
        from disc_model.stability.cycle import CycleStatus
        from disc_model.stability.cycle import floquet as cycle_of

        cycle = cycle_of(parameters, tol=tolerance)
        sliding = cycle.sliding
    found = cycle.status is CycleStatus.OK
    lines = [*case_lines(parameters, choice), ("status", cycle.message or cycle.status.value)]
    if found:
        verdict = "small disturbances die out" if cycle.stable else "small disturbances grow"
        lines += [
            ("growth rate", f"{cycle.growth_rate:.6g} 1/s ({verdict})"),
            ("period", f"{cycle.period:.9g} s ({1 / cycle.period:.6g} Hz), {cycle.stick_fraction:.2%} of it sticking"),
            ("a period has", f"{cycle.releases} releases, {cycle.separations} separations"),
            ("leading multiplier", f"{cycle.multipliers[0]:.6g}, modulus {abs(cycle.multipliers[0]):.9g}"),
        ]
    else:
        lines.append(("advice", cycle.status.advice))
    lines.append(("steady sliding", f"growth rate {sliding.growth_rate:.6g} 1/s"))
    tell(lines)
    if not found:
        raise typer.Exit(1)


def warm() -> None:
    """Compile the kernels into the cache, so that jobs started in parallel find them there."""
    with compiling():
        from disc_model.simulation.api import simulate

        for contact in ("separable", "bonded"):
            simulate(Parameters(N=385, Omega=15.1, contact=contact), 0.02)
    typer.echo("kernels compiled and cached")
