"""Friction-induced vibration of an elastic disc and a moving slider with separation and
reattachment.

    >>> import disc_model
    >>> result = disc_model.simulate(disc_model.Parameters(N=385, Omega=15.1), 60)
    >>> result.first_separation

Functions take one case, and `sweep` calls them for many; `run_study` computes what a study file says.

Names are imported at their first use, so that `import disc_model` is fast and numba is loaded only
for simulations.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

__version__ = "0.3.0"

_NAMES = {
    "data.coded": "words",
    "data.dataset": "load save",
    "analysis.contact_loss": "pinned_range",
    "disc.flexibility": "residual_flexibility",
    "disc.modes": "plate_modes coupled_natural_frequencies",
    "errors": (
        "Status DiscModelError ParameterError ModeError SimulationError PainleveParadox StepLimit Stalled NonFinite "
        "ImplausibleValue"
    ),
    "fit": "fit",
    "mode_choice": "choose_modes",
    "parameters": "Parameters Disc",
    "figures": "plot_campbell plot_modes plot_sweep",
    "simulation.api": "simulate snapshots Execution",
    "simulation.case": "Window Poincare Ramp",
    "simulation.result": "Result",
    "simulation.starts": "initial_state",
    "simulation.states": "State deflection",
    "studies.quantities.basins": "basins",
    "studies.quantities.bifurcation": "bifurcation",
    "studies.quantities.branches": "branches",
    "studies.quantities.campbell": "campbell",
    "studies.quantities.critical_speed": "critical_speed",
    "studies.quantities.hysteresis": "hysteresis",
    "studies.quantities.locking": "locking",
    "studies.quantities.outcome": "outcome",
    "studies.quantities.ramps": "ramps",
    "studies.quantities.range_law": "range_law",
    "studies.quantities.regions": "regions",
    "studies.quantities.sensitivity": "sensitivity",
    "studies.quantities.sliding_modes": "sliding_modes",
    "studies.run": "run_study",
    "studies.sweep": "sweep",
    "stability.continuation": "Branch StepControl continue_cycle neutral_curves",
    "stability.critical": "critical",
    "stability.cycle": "floquet",
    "stability.lyapunov": "lyapunov_exponents",
    "stability.sliding": "steady_sliding",
    "stability.squeal": "squeal",
}
_HOMES = {name: module for module, names in _NAMES.items() for name in names.split()}

__all__ = [*_HOMES, "__version__"]

if TYPE_CHECKING:
    from disc_model.analysis.contact_loss import pinned_range
    from disc_model.data.coded import words
    from disc_model.data.dataset import load, save
    from disc_model.disc.flexibility import residual_flexibility
    from disc_model.disc.modes import coupled_natural_frequencies, plate_modes
    from disc_model.errors import (
        DiscModelError,
        ImplausibleValue,
        ModeError,
        NonFinite,
        PainleveParadox,
        ParameterError,
        SimulationError,
        Stalled,
        Status,
        StepLimit,
    )
    from disc_model.figures import plot_campbell, plot_modes, plot_sweep
    from disc_model.fit import fit
    from disc_model.mode_choice import choose_modes
    from disc_model.parameters import Disc, Parameters
    from disc_model.simulation.api import Execution, simulate, snapshots
    from disc_model.simulation.case import Poincare, Ramp, Window
    from disc_model.simulation.result import Result
    from disc_model.simulation.starts import initial_state
    from disc_model.simulation.states import State, deflection
    from disc_model.stability.continuation import (
        Branch,
        StepControl,
        continue_cycle,
        neutral_curves,
    )
    from disc_model.stability.critical import critical
    from disc_model.stability.cycle import floquet
    from disc_model.stability.lyapunov import lyapunov_exponents
    from disc_model.stability.sliding import steady_sliding
    from disc_model.stability.squeal import squeal
    from disc_model.studies.quantities.basins import basins
    from disc_model.studies.quantities.bifurcation import bifurcation
    from disc_model.studies.quantities.branches import branches
    from disc_model.studies.quantities.campbell import campbell
    from disc_model.studies.quantities.critical_speed import critical_speed
    from disc_model.studies.quantities.hysteresis import hysteresis
    from disc_model.studies.quantities.locking import locking
    from disc_model.studies.quantities.outcome import outcome
    from disc_model.studies.quantities.ramps import ramps
    from disc_model.studies.quantities.range_law import range_law
    from disc_model.studies.quantities.regions import regions
    from disc_model.studies.quantities.sensitivity import sensitivity
    from disc_model.studies.quantities.sliding_modes import sliding_modes
    from disc_model.studies.run import run_study
    from disc_model.studies.sweep import sweep


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
