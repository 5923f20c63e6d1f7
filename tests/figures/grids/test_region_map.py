"""Maps of regions."""

from __future__ import annotations

import json

import numpy as np
import xarray as xr
from matplotlib.collections import LineCollection, QuadMesh

from disc_model.figures.grids import region_map as maps
from disc_model.figures.kinds import Mark, RegionMap
from disc_model.figures.parts import axis_of, save
from disc_model.studies.grids.quantities import regions
from tests.figures.grids.reading import ON_EACH_SCALE, labels

PLOT = RegionMap(x="Omega", y="N")


def made_up(x: str, values: list[float], norms: list[str]) -> xr.Dataset:
    """A plane in which the cycle loses stability at the third value of x, and ends above the second load."""
    dims = ("N", x, "normalization")
    shape = (4, len(values), len(norms))
    growth = np.where(np.arange(len(values)) < 2, -0.1, 0.1)[None, :, None] * np.ones(shape)
    growth[2:] = np.nan
    followed = np.where(np.isfinite(growth), 1, 0)
    outcome = np.where(np.isnan(growth), "undecided", np.where(growth < 0, "quiet", "separation"))
    outcome[3, 0] = "growing"
    codes = {"outcome": np.vectorize(regions.COURSES.index)(outcome), "origin": np.full(shape, 2)}
    codes |= dict.fromkeys(("cycle", "joined_first", "joined_second"), followed)
    data = {
        name: (dims, values, {"flag_meanings": " ".join(regions.COLUMNS[name].variable.flags)})
        for name, values in codes.items()
    }
    data["growth_rate"] = (dims, growth)
    axes = {"N": [100.0, 200, 300, 400], x: values, "normalization": norms}
    return xr.Dataset(data, axes, {"options": json.dumps({"horizon": 900.0})})


def lengths(ax) -> list[int]:
    return [len(lines.get_segments()) for lines in ax.collections if isinstance(lines, LineCollection)]


@ON_EACH_SCALE
def test_cells_borders_and_marks(x: str, values: list[float], scale: str, tmp_path) -> None:
    study = made_up(x, values, ["as_published", "orthonormal"])
    marks = {"F2": Mark(x=values[0], y=100, paper="quiet"), "b": Mark(x=values[-1], y=400, paper="separation")}
    figure = maps.draw(study, {}, RegionMap(x=x, y="N", marks=marks))
    outcome, _, growth, _ = figure.axes[:4]
    assert outcome.get_xscale() == scale
    # the cycle's stability changes at two loads between the second and third value; stable ones end at two values
    assert lengths(outcome) == lengths(growth) == [2, 2]
    assert {text.get_text() for text in outcome.texts} == {"F2", "b"}
    (branch,) = growth.texts
    assert (branch.get_text(), branch.get_position()) == ("A", (values[1] * axis_of(x)[1], 100))
    named = {"stays quiet", "separation", "undecided", "cycle loses stability", "stable cycle ends (fold)"}
    named |= {"the paper: stays quiet", "the paper: separation", "no cycle found"}
    assert named <= set(labels(figure))
    assert not any("inferred" in text for text in labels(figure))
    said = "Within 900 s of the published start.\n24 of 24 points simulated. F2: in Fig. 2 of the paper."
    alone = "Points unlike all beside them: 2."
    contradicted = "b: the paper says “separation”, the published start: undecided."
    branches = "A, B, ...: branches, on which one cycle goes on from point to point."
    assert f"{said}\n{alone}\n{contradicted}\n{branches}" in labels(figure)
    save(figure, tmp_path / "map.png")


def colours(ax) -> set[tuple]:
    return {
        tuple(np.round(mesh.cmap(mesh.norm(code)), 3))
        for mesh in ax.collections
        if isinstance(mesh, QuadMesh)
        for code in np.unique(mesh.get_array().compressed())
    }


def test_what_lies_inside_an_undivided_cell_is_paler(tmp_path) -> None:
    study = made_up("Omega", [5.0, 10, 20], ["as_published"])
    worked_out = colours(maps.draw(study, {}, PLOT).axes[0])
    study["origin"][0] = regions.ORIGINS.index("undivided_cell")
    figure = maps.draw(study, {}, PLOT)
    assert colours(figure.axes[0]) > worked_out
    assert "paler: inferred from the corners of a cell" in labels(figure)


def test_a_cycle_does_not_end_where_it_was_only_not_followed() -> None:
    """Any cell without a cycle that was followed was said to be beyond a fold, and the picture showed the tiles."""
    study = made_up("Omega", [5.0, 10, 20], ["as_published"])
    for name, code in (
        ("cycle", regions.CYCLES.index("only_near")),  # another is near
        ("outcome", regions.COURSES.index("quiet")),  # it is inferred to stay quiet
    ):
        other = study.copy(deep=True)
        other[name][2:] = code
        other["origin"][2:] = regions.ORIGINS.index("undivided_cell")
        figure = maps.draw(other, {}, PLOT)
        assert lengths(figure.axes[0]) == [2, 0]
        said = " ".join(labels(figure))
        assert "ends" not in said
        assert ("Inferred to stay quiet, though the start was followed to no cycle: 6." in said) == (name == "outcome")


def test_what_did_not_vary_is_said() -> None:
    study = made_up("Omega", [5.0, 10, 20], ["as_published"]).rename(N="m")
    study.attrs["base"] = json.dumps({"N": 200.0, "c": 0.0, "contact": "separable", "D_star": 2e-5})
    figure = maps.draw(study, {}, RegionMap(x="Omega", y="m", title="Made up"))
    said = figure.legends[0].get_title().get_text()  # a title of the figure would lie over this legend
    assert said == "Made up\nN = 200 N, D* = 2e-05 N m s"


def test_points_unlike_all_beside_them_are_counted() -> None:
    """An outcome of its own in a corner, one in the middle; two that lie side by side are not alone."""
    study = made_up("Omega", [0.0, 1, 2, 3, 4], ["as_published"])
    study["outcome"][:] = regions.COURSES.index("quiet")
    for row, column in ((0, 0), (2, 1), (1, 3), (2, 3)):
        study["outcome"][row, column] = regions.COURSES.index("growing")
    assert maps.standing_alone(study, PLOT) == 2
    assert maps.standing_alone(study.isel(N=[1, 2], Omega=[3, 4]), PLOT) == 0


def test_a_case_at_which_paper_start_and_cycle_do_not_agree_is_explained() -> None:
    study = made_up("Omega", [5.0, 10, 20], ["as_published"])
    marks = {
        "F1": Mark(x=5, y=100, paper="quiet"),  # quiet, as the paper says, and the cycle is stable
        "F2": Mark(x=5, y=200, paper="separation"),  # quiet, and the paper separates
        "F3": Mark(x=20, y=100, paper="separation"),
    }
    study["growth_rate"].loc[{"Omega": 20}] = -0.2
    said = maps.contradictions(study, PLOT.model_copy(update={"marks": marks}))
    assert said == [
        "F2: the paper says “separation”, the published start: stays quiet.",
        "F3: separation, beside a cycle that is stable (-0.2/s): another motion is reached.",
    ]


def test_a_plane_that_lies_the_other_way_round(tmp_path) -> None:
    study = made_up("Omega", [5.0, 10, 20], ["orthonormal"]).isel(normalization=0, drop=True)
    study.attrs["base"] = json.dumps({"normalization": "orthonormal"})
    figure = maps.draw(study, {}, RegionMap(x="N", y="Omega"))
    assert lengths(figure.axes[0]) == [2, 2]
    assert figure.axes[0].get_ylabel() == "Speed Ω (rad/s)"
