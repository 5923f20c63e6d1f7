"""Calls in Python that compute a point of a study, for pages: the point's case, a call of it, and
where the call has the number of a variable."""

import inspect
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from disc_model.studies.functions import basins, critical_speed, hysteresis, outcome
from disc_model.studies.quantities.ramps import Ramps
from disc_model.studies.quantities.stability_curves import StabilityCurves
from disc_model.studies.quantity import Quantity


class Recipe(NamedTuple):
    """A call of a point's case that gives some variables of a quantity.

    Attributes
    ----------
    function : what is called, such as ``dm.floquet``
    arguments : those after the case, in Python
    numbers : expressions of what the call has `found`, by variable; "" where it is a dataset that
        has the variable under its own name, along the quantity's own dimensions
    takes_kick : whether the call has the argument `start`, for perturbations of the static start
    """

    function: str
    arguments: Sequence[str]
    numbers: Mapping[str, str]
    takes_kick: bool = False


class Call(NamedTuple):
    """How the points of a study are computed anew, in parts.

    Attributes
    ----------
    quantity, options : of the study, the options that differ from their defaults
    columns : variables that each point has by itself; others are of several points together
    recipes : calls that give some of them; `disc_model.run_study` of one point gives all
    begins : parameters of the case that the quantity varies by itself, each where its range begins
    along : the dimensions or variables in which the values of such parameters are, by parameter
    sampled : the variable that has the values of sampled parameters, "" without
    lifts_mu_s : whether mu_s rises with mu_k where that is larger
    computes : what a study of the point computes for one number, in words
    headlines : the variables that say what the quantity is about, the first one that varies first
    """

    quantity: str
    options: Mapping[str, Any]
    columns: Sequence[str]
    recipes: Sequence[Recipe]
    begins: Mapping[str, float]
    along: Mapping[str, Sequence[str]]
    sampled: str = ""
    lifts_mu_s: bool = False
    computes: str = ""
    headlines: Sequence[str] = ()

    @property
    def plain(self) -> dict[str, Any]:
        """All of it as mappings and lists, for JSON."""
        return {**self._asdict(), "recipes": [recipe._asdict() for recipe in self.recipes]}


COMPUTES: Mapping[str, str] = {
    "branches": "the sweep and all branches",
    "critical_speed": "the whole scan",
    "hysteresis": "the whole sweep",
    "basins": "all starts",
    "ramps": "all ramps",
    "sliding": "the modes along the whole range",
    "stability_curves": "all curves",
}
"""What a quantity computes for any of its numbers."""
HEADLINES: Mapping[str, Sequence[str]] = {
    "basins": ("separating_fraction",),
    "bifurcation": ("psi",),
    "branches": ("range", "sweep_range"),
    "campbell": ("sliding_frequency", "growth_rate"),
    "critical_speed": ("critical_speed",),
    "floquet": ("growth_rate",),
    "hysteresis": ("onset_speed", "offset_speed"),
    "locking": ("map_next_phase", "separations_per_release"),
    "lyapunov": ("exponent",),
    "outcome": ("outcome",),
    "ramps": ("onset_speed", "offset_speed"),
    "range_law": ("range",),
    "regions": ("outcome",),
    "sensitivity": ("growth_rate",),
    "sliding": ("largest_growth_rate",),
    "stability_curves": ("y",),
}
"""The variables that say what a quantity is about, by its name."""
OF_CYCLES: Mapping[str, str] = {
    "growth_rate": "found.growth_rate",
    "period": "found.period",
    "stick_fraction": "found.stick_fraction",
    "multiplier_re": "found.multipliers[0].real",
    "multiplier_im": "found.multipliers[0].imag",
    "stick_slip_frequency": "found.releases / found.period",
    "sliding_growth_rate": "found.sliding.growth_rate",
    "cycle": "found.motion",
}
"""What the result of `floquet` has of the variables of quantities."""
OF_SLIDING: Mapping[str, str] = {
    "unstable_modes": "found.growing.size",
    "largest_growth_rate": "found.growth_rate",
    "contact_force": "found.contact_force",
}
"""What the result of `steady_sliding` has of the variables of quantities."""
BY_FLOQUET: Mapping[str, Sequence[str]] = {
    "floquet": (
        "growth_rate",
        "period",
        "stick_fraction",
        "multiplier_re",
        "multiplier_im",
        "sliding_growth_rate",
    ),
    "campbell": ("growth_rate", "stick_slip_frequency"),
    "sensitivity": ("growth_rate", "cycle"),
}
"""Variables of quantities that `floquet` gives."""
OF_CYCLES_REACHED = ("cycle", "growth_rate", "period", "releases", "period_ratio")
"""Variables of `regions` of the cycle to which a motion comes, which need not be that near its start."""
WITHIN_HORIZON = ("outcome", "first_separation")
SCANS: Mapping[str, Callable[..., Any]] = {
    "critical_speed": critical_speed,
    "hysteresis": hysteresis,
}
"""Functions of quantities that vary the speed by themselves."""


def call_of(name: str, quantity: Quantity) -> Call:
    """The call for a point of a study of a quantity.

    Parameters
    ----------
    name : of the quantity
    quantity : with its options
    """
    columns = [*quantity.COLUMNS]
    if name == "sensitivity":  # samples of one sequence
        columns = [*WITHIN_HORIZON, *BY_FLOQUET[name]]
    if name == "regions":  # computed as planes, where neighbours decide how an outcome is known
        columns = [*WITHIN_HORIZON, *OF_CYCLES_REACHED]
    parameter = getattr(quantity, "parameter", "")
    return Call(
        name,
        quantity.model_dump(mode="json", exclude_defaults=True),
        columns,
        _recipes(name, quantity),
        range_begins(quantity),
        _along(name, quantity),
        "parameter_values" if name == "sensitivity" else "",
        name == "sliding" and parameter == "mu_k",
        COMPUTES.get(name, ""),
        HEADLINES.get(name, ()),
    )


def _along(name: str, quantity: Any) -> dict[str, list[str]]:
    """The dimensions and variables with values of each parameter that a quantity varies itself."""
    match name:
        case "branches":
            return {quantity.parameter: ["value", "sweep_value"]}
        case "sliding":
            return {quantity.parameter: ["value"]}
        case "stability_curves":
            return {quantity.x: ["x"], quantity.y: ["y"]}
        case "critical_speed":
            return {"Omega": ["scan_Omega"]}
        case "hysteresis":
            return {"Omega": ["sweep_Omega"]}
    return {}


def _recipes(name: str, quantity: Any) -> list[Recipe]:
    """The calls of functions of a case that give variables of a quantity."""
    recipes = []
    if name in BY_FLOQUET:
        numbers = {variable: OF_CYCLES[variable] for variable in BY_FLOQUET[name]}
        recipes.append(Recipe("dm.floquet", _tolerance_of_cycles(quantity), numbers))
    if name == "sliding":
        recipes.append(Recipe("dm.steady_sliding", [], OF_SLIDING))

    # datasets that have the variables under their own names; a point's status is not among them
    own = [variable for variable in quantity.COLUMNS if variable != "status"]
    if name in ("outcome", "sensitivity"):
        shown = own if name == "outcome" else WITHIN_HORIZON
        arguments = _given(outcome, _options_of_outcome(quantity))
        recipes.append(Recipe("dm.outcome", arguments, dict.fromkeys(shown, ""), takes_kick=True))
    if name == "regions":  # a separation that is timed there was simulated all along
        options = _options_of_outcome(quantity)
        timed = options | {"extrapolate": False}
        for variable, how in zip(WITHIN_HORIZON, (options, timed), strict=True):
            recipes.append(Recipe("dm.outcome", _given(outcome, how), {variable: ""}))
    if name in SCANS and quantity.scan.scale == "linear":
        arguments = _given(SCANS[name], _options_of_scan(quantity))
        recipes.append(Recipe(f"dm.{name}", arguments, dict.fromkeys(own, "")))
    if name == "basins":
        options = {**quantity.model_dump(), "energies": list(quantity.energies)}
        arguments = _given(basins, options)
        recipes.append(Recipe("dm.basins", arguments, dict.fromkeys(own, ""), takes_kick=True))
    return recipes


def _tolerance_of_cycles(quantity: Any) -> list[str]:
    """The tolerance of `floquet`, if it is not the usual one."""
    if quantity.tol == type(quantity).model_fields["tol"].default:
        return []
    return [f"tol={quantity.tol!r}"]


def range_begins(quantity: Quantity) -> dict[str, float]:
    """The least value of each parameter that a quantity varies by itself."""
    match quantity:
        case Ramps():
            return {"Omega": quantity.low}
        case StabilityCurves():
            return {quantity.x: quantity.x_range[0], quantity.y: quantity.y_lines.start}
    if not quantity.scanned:
        return {}
    scanning: Any = quantity
    return dict.fromkeys(quantity.scanned, scanning.scan.start)


def _options_of_outcome(quantity: Any) -> dict[str, Any]:
    """The arguments of `outcome` that are options of a quantity, under the names that it has."""
    options = quantity.model_dump()
    options["tol"] = options.get("motion_tol", options["tol"])
    options.setdefault("evaluation_time", min(1.0, quantity.horizon))
    return options


def _options_of_scan(quantity: Any) -> dict[str, Any]:
    """The arguments of functions that scan a range, from a quantity's options."""
    scan = quantity.scan
    options = {
        **quantity.model_dump(),
        "bounds": (scan.start, scan.stop),
        "step": (scan.stop - scan.start) / scan.intervals,
    }
    if "horizons" in options:
        options["horizon"] = list(options["horizons"])
    return options


def _given(function: Callable[..., Any], options: Mapping[str, Any]) -> list[str]:
    """The arguments of a function, after the case, that differ from its defaults, in Python."""
    _, *parameters = inspect.signature(function).parameters.values()
    arguments = []
    for parameter in parameters:
        if parameter.name not in options:  # such as the bar of its progress
            continue
        value = options[parameter.name]
        if value not in (parameter.default, [parameter.default]):
            arguments.append(f"{parameter.name}={value!r}")
    return arguments
