"""Which studies a figure can show, alone and beside others: all that could end in an error once they are computed."""

from importlib.util import find_spec

from disc_model.figures.kinds import PLOTS, General
from disc_model.parameters import Parameters
from disc_model.studies.document import QUANTITIES


def test_every_plot_knows_its_quantity_its_dimensions_and_who_draws_it() -> None:
    plane = {"x": "N", "y": "Omega"}
    needed = {"stability_map": plane, "region_map": plane, "bifurcation": {"x": "Omega"}, "basins": {"x": "Omega"}}
    for kind, plot in PLOTS.items():
        if issubclass(plot, General):  # of any quantity, see test_general
            continue
        made = plot(kind=kind, **needed.get(kind, {}))
        assert made.quantities
        assert {*made.quantities} <= QUANTITIES.keys()
        assert find_spec(made.module)
        assert set(made.dims) <= {*Parameters.model_fields}
