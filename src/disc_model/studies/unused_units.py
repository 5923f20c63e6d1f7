"""Units that a study file gives of what none of its figures shows."""

from collections.abc import Collection, Iterator, Mapping

from disc_model.data.variables import FOUND_SPEEDS, ranged_variable
from disc_model.figures.kinds import General, Plot
from disc_model.studies.quantity import Quantity


def unused_units(
    plots: Mapping[str, Plot], given: Collection[str], quantity: Quantity
) -> Iterator[str]:
    """A warning for each unit of what no figure of a grid shows, of those that can show any variable:
    what others show is known to their drawings alone.

    given : parameters that the file varies or gives, which stand on axes or above the figure
    """
    if not all(isinstance(plot, General) for plot in plots.values()):
        return
    shown = {*given, *quantity.scanned}
    for plot in plots.values():
        if isinstance(plot, General):
            shown |= _shown_by(plot)
    for name, plot in plots.items():
        for key, unit in plot.units.items():
            if key not in shown:
                yield f"figures.{name}.units.{key}={unit!r}: no figure shows anything in this unit"


def _shown_by(plot: General) -> set[str]:
    """The parameters and sampled variables in whose units a figure shows anything."""
    variable = plot.variable
    found = {variable, ranged_variable(variable), *plot.axes.values(), *plot.at}
    if variable in FOUND_SPEEDS:
        found.add("Omega")
    return found
