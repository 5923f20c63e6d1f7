"""Which studies a figure can show, alone and beside others: all that could end in an error once they are computed."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from disc_model.figures.kinds import PLOTS, General, Plot
from disc_model.parameters import Parameters
from disc_model.studies.document import QUANTITIES
from disc_model.studies.study import parse_study

CONFIG = Path(__file__).parents[3] / "config" / "studies"
NORMS = ["as_published", "orthonormal"]
NO_NUMBER = "must be one parameter, and a number"


def plot(kind: str, **given: Any) -> Plot:
    return PLOTS[kind].model_validate({"kind": kind, **given})


def values(**dims: list[Any]) -> dict[str, list[tuple[Any, ...]]]:
    return {
        name: [value if isinstance(value, tuple) else (value,) for value in column] for name, column in dims.items()
    }


def study(quantity: str, options: dict[str, Any] | None = None, base: str = "as_published", **dims: list[Any]) -> Any:
    own = {} if "normalization" in dims else {"normalization": base}
    return SimpleNamespace(quantity=quantity, options=SimpleNamespace(**options or {}), base=own, values=values(**dims))


MAP = {"kind": "stability_map", "x": "N", "y": "k"}
CRITICAL = {"kind": "critical_speed"}
THRESHOLDS = {"kind": "thresholds"}
GROWTH = {"kind": "growth_map"}
BIFURCATION = {"kind": "bifurcation", "x": "k"}


def marked(x: float, y: float) -> dict[str, Any]:
    return MAP | {"marks": {"F2": {"x": x, "y": y, "paper": "stable"}}}


@pytest.mark.parametrize(
    ("given", "dims", "faults"),
    [
        (MAP, {"N": [1], "k": [2]}, []),
        (MAP, {"N": [1], "k": [2], "normalization": NORMS}, []),
        (MAP | {"x": "n_diameters"}, {"n_diameters": [1], "k": [2]}, []),
        # one that has faults of its own is only meant to be there
        (MAP, {"N": [1], "k": [], "c": []}, []),
        (MAP, {"N": [1]}, ["y = 'k': is no dimension of this study (known: N)"]),
        (MAP | {"y": "N"}, {"N": [1]}, ["y = 'N': must differ from x"]),
        (MAP | {"x": "kick_u"}, {"kick_u": [0, 1e-3], "k": [2]}, []),
        (marked(1, 0.3), {"N": [1], "k": [0.1 + 0.2]}, []),
        (marked(1.5, 2), {"N": [1, 2], "k": [2]}, ["marks.F2.x = 1.5: must be a value of N, such as an extra one"]),
        (MAP | {"x": "contact"}, {"contact": ["bonded"], "k": [1]}, [f"x = 'contact': {NO_NUMBER}"]),
        (MAP | {"x": "N_c"}, {"N_c": [(1, 2)], "k": [1]}, [f"x = 'N_c': {NO_NUMBER}"]),
        (
            MAP,
            {"N": [1], "k": [2], "c": [0], "contact": ["bonded"]},
            ["kind = 'stability_map': can show N, k, normalization, but not c, contact as well"],
        ),
        (
            MAP | {"others": {"growht": "g"}},
            {"N": [1], "k": [2]},
            ["others.growht = 'g': unknown role, did you mean growth? (known: growth)"],
        ),
        (
            {"kind": "region_map", "x": "N", "y": "k", "others": {"curves": "c"}},
            {"N": [1], "k": [2]},
            ["others.curves = 'c': needs x: Omega and y: N"],
        ),
        (CRITICAL, {"N": [1]}, []),
        (CRITICAL, {"c": [1]}, ["kind = 'critical_speed': needs the dimension N"]),
        (CRITICAL, {"N": [1], "normalization": NORMS}, ["kind = 'critical_speed': can show one normalization only"]),
        (CRITICAL, {"N": [1], "k": [1]}, ["kind = 'critical_speed': can show N, normalization, but not k as well"]),
        (
            THRESHOLDS | {"others": {"hysteresis": "h"}},
            {"N": [1]},
            [
                "others.hysteresis = 'h': unknown role (known: curves, cycle)",
                "others.curves: is required: a study of the quantity stability_curves",
            ],
        ),
        (GROWTH, {"N": [1], "Omega": [1]}, []),
        (GROWTH, {"k": [1]}, ["kind = 'growth_map': needs the dimension N and Omega"]),
        (BIFURCATION, {"k": [1]}, []),
        (BIFURCATION | {"x": "normalization"}, {"normalization": NORMS}, [f"x = 'normalization': {NO_NUMBER}"]),
    ],
)
def test_what_a_figure_can_show(given: dict[str, Any], dims: dict[str, list[Any]], faults: list[str]) -> None:
    assert [fault.in_file for fault in plot(**given).faults(values(**dims))] == faults


def curves(x: str, y: str, **dims: list[Any]) -> Any:
    return study("stability_curves", {"x": x, "y": y}, **dims)


@pytest.mark.parametrize(
    ("given", "role", "other", "faults"),
    [
        (MAP, "growth", study("floquet", k=[1], N=[2]), []),
        (MAP, "growth", study("floquet", k=[1], N=[2], normalization=NORMS), []),
        (MAP, "growth", study("outcome", k=[1]), ["must be a study of the quantity floquet, and not outcome"]),
        (MAP, "growth", study("floquet", N=[1]), ["must vary N, k beside normalization, and not N"]),
        (
            MAP,
            "growth",
            study("floquet", base="orthonormal", N=[1], k=[2]),
            ["must be computed for the same normalization: as_published"],
        ),
        (CRITICAL, "hysteresis", study("hysteresis", N=[2]), []),
        (CRITICAL, "hysteresis", study("hysteresis", N=[2], c=[1]), ["must vary N beside normalization, and not N, c"]),
        (THRESHOLDS, "curves", curves("Omega", "N", normalization=NORMS), []),
        (
            GROWTH,
            "curves",
            curves("N", "c_p", normalization=NORMS),
            ["must have options.x = 'Omega', and not 'N'", "must have options.y = 'N', and not 'c_p'"],
        ),
        (GROWTH, "curves", curves("Omega", "N", k=[1, 2]), ["must vary nothing beside normalization, and not k"]),
        (BIFURCATION, "lyapunov", study("lyapunov", k=[1]), []),
        (BIFURCATION, "lyapunov", study("lyapunov", m=[1]), ["must vary k beside normalization, and not m"]),
    ],
)
def test_what_it_can_show_beside(given: dict[str, Any], role: str, other: Any, faults: list[str]) -> None:
    shown = plot(**given)
    own = study(shown.quantities[0], **{name: [1] for name in shown.dims})
    assert list(shown.misfits_of(role, own, other)) == faults


@pytest.mark.parametrize("folder", [CONFIG, CONFIG / "test"], ids=["paper", "test"])
def test_the_figures_of_the_repository_can_be_drawn(folder: Path) -> None:
    """All are checked, alone and beside others, as their studies are read."""
    grids, _ = parse_study({"study": "all", "studies": [str(folder / "*.yaml")]}).grids()
    assert any(grid.plots for grid in grids.values())


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
