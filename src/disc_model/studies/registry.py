"""All quantities of grid studies by their names; a new one is added here."""

from disc_model.errors import Fault, ParameterError, suggestion
from disc_model.studies.quantities.basins import AttractorBasins
from disc_model.studies.quantities.bifurcation import Bifurcation
from disc_model.studies.quantities.branches import Branches
from disc_model.studies.quantities.campbell import Campbell
from disc_model.studies.quantities.critical_speed import CriticalSpeed
from disc_model.studies.quantities.floquet import Floquet
from disc_model.studies.quantities.hysteresis import Hysteresis
from disc_model.studies.quantities.locking import Locking
from disc_model.studies.quantities.lyapunov import Lyapunov
from disc_model.studies.quantities.outcome import HorizonOutcome
from disc_model.studies.quantities.ramps import Ramps
from disc_model.studies.quantities.range_law import RangeLaw
from disc_model.studies.quantities.regions import Regions
from disc_model.studies.quantities.sensitivity import Sensitivity
from disc_model.studies.quantities.sliding import Sliding
from disc_model.studies.quantities.stability_curves import StabilityCurves
from disc_model.studies.quantity import Quantity

QUANTITIES: dict[str, type[Quantity]] = {
    "basins": AttractorBasins,
    "bifurcation": Bifurcation,
    "branches": Branches,
    "campbell": Campbell,
    "critical_speed": CriticalSpeed,
    "floquet": Floquet,
    "hysteresis": Hysteresis,
    "locking": Locking,
    "lyapunov": Lyapunov,
    "outcome": HorizonOutcome,
    "ramps": Ramps,
    "range_law": RangeLaw,
    "regions": Regions,
    "sensitivity": Sensitivity,
    "sliding": Sliding,
    "stability_curves": StabilityCurves,
}


def quantity_names() -> list[str]:
    """Return the names of all quantities."""
    return list(QUANTITIES)


def quantity_of(name: str) -> type[Quantity]:
    """Return the quantity of a name; raises `ParameterError`."""
    if name not in QUANTITIES:
        rule = f"unknown quantity{suggestion(name, quantity_names())}"
        raise ParameterError(Fault.of((), name, rule))
    return QUANTITIES[name]
