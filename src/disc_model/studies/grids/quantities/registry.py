"""The quantities there are. Nothing heavy is imported: studies are checked against this."""

from __future__ import annotations

from typing import NamedTuple

from disc_model.studies.faults import Strict
from disc_model.studies.grids.quantities.bifurcation_options import BifurcationOptions
from disc_model.studies.grids.quantities.critical_speed_options import CriticalSpeedOptions
from disc_model.studies.grids.quantities.floquet_options import FloquetOptions
from disc_model.studies.grids.quantities.hysteresis_options import HysteresisOptions
from disc_model.studies.grids.quantities.lyapunov_options import LyapunovOptions
from disc_model.studies.grids.quantities.outcome_options import OutcomeOptions
from disc_model.studies.grids.quantities.stability_curves_options import StabilityCurvesOptions


class Quantity(NamedTuple):
    """An entry of the registry: the module, its options, and the parameters that it varies by itself.

    Options with a property ``scans`` name those parameters themselves.
    """

    module: str
    options: type[Strict]
    scans: tuple[str, ...] = ()

    def scanned(self, options: Strict | None) -> tuple[str, ...]:
        """Parameters that the quantity varies by itself, given its options."""
        return tuple(getattr(options, "scans", self.scans))


HERE = __package__

QUANTITIES = {
    "outcome": Quantity(f"{HERE}.outcome", OutcomeOptions),
    "critical_speed": Quantity(
        "disc_model.studies.grids.quantities.critical_speed", CriticalSpeedOptions, scans=("Omega",)
    ),
    "floquet": Quantity(f"{HERE}.floquet", FloquetOptions),
    "hysteresis": Quantity(f"{HERE}.hysteresis", HysteresisOptions, scans=("Omega",)),
    "bifurcation": Quantity(f"{HERE}.bifurcation", BifurcationOptions),
    "lyapunov": Quantity(f"{HERE}.lyapunov", LyapunovOptions),
    "stability_curves": Quantity(f"{HERE}.stability_curves", StabilityCurvesOptions),
}
