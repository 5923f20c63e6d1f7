"""Friction-induced vibration of an elastic disc and a moving slider with separation and
reattachment.

    >>> import disc_model
    >>> result = disc_model.simulate(disc_model.Parameters(N=385, Omega=15.1), 60)
    >>> result.first_separation

Functions take one case, and `sweep` calls them for many. `run_study` computes what needs many cases at
once, such as a bifurcation diagram (quantity "bifurcation", which `plot_sweep` draws) or a Campbell
diagram ("campbell", `plot_campbell`).

Names are imported at their first use, so that `import disc_model` is fast and numba is loaded only
for simulations.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

__version__ = "0.3.0"

_NAMES = {
    "data.coded": "words",
    "data.exchange": "load save",
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
    "studies.functions": "outcome critical_speed basins hysteresis",
    "studies.whole_study": "run_study",
    "studies.sweeps": "sweep",
    "stability.continuation": "Branch StepControl continue_cycle neutral_curves",
    "stability.critical": "critical",
    "stability.floquet": "floquet",
    "stability.lyapunov": "lyapunov_exponents",
    "stability.sliding": "steady_sliding",
}
_OF_STUDIES = (
    "bifurcation",
    "branches",
    "campbell",
    "locking",
    "lyapunov",
    "ramps",
    "range_law",
    "regions",
    "sensitivity",
    "sliding",
    "stability_curves",
)
"""Quantities of studies that are no functions of this name."""
_HOMES = {name: module for module, names in _NAMES.items() for name in names.split()}

__all__ = [*_HOMES, "__version__"]

if TYPE_CHECKING:
    from disc_model.analysis.contact_loss import pinned_range
    from disc_model.data.coded import words
    from disc_model.data.exchange import load, save
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
    from disc_model.stability.floquet import floquet
    from disc_model.stability.lyapunov import lyapunov_exponents
    from disc_model.stability.sliding import steady_sliding
    from disc_model.studies.functions import basins, critical_speed, hysteresis, outcome
    from disc_model.studies.sweeps import sweep
    from disc_model.studies.whole_study import run_study


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        hint = ""
        if name in _OF_STUDIES:
            hint = f": it is a quantity of studies, as in run_study({{'quantity': {name!r}, ...}})"
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}{hint}")
    value = getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
