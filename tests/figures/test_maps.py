"""Maps of outcomes, regions and growth rates: cells, lines, marks, and what is said of them."""

import json
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib.collections import LineCollection

from disc_model.data.variables import OUTCOMES_TO_HORIZON
from disc_model.figures.cells import edges_of, scale_of, unresolved, unresolved_motions
from disc_model.figures.style import save
from disc_model.studies.quantities.regions import Regions
from tests.figures.reading import ON_EACH_SCALE, draw, labels

NORMS = ["as_published", "orthonormal"]

# ---- cells


def _hatched(ax: Any) -> list[Any]:
    """Centres of the cells, y and x, below each hatch of a panel."""
    outlines = [
        patch.get_path().vertices.reshape(-1, 5, 2)[:, :4]
        for patch in ax.patches
        if patch.get_hatch()
    ]
    return [corners.mean(axis=1)[:, ::-1] for corners in outlines]


def test_edges_of_cells_are_halfway_on_the_scale_of_the_axis() -> None:
    axes = {"N": [100.0, 200.0, 400.0], "c_p": [0.01, 0.1, 1.0, 10.0]}
    across, up = edges_of(xr.DataArray(np.zeros((3, 4)), axes, ("N", "c_p")))
    np.testing.assert_allclose(up, [100.0, 150.0, 300.0, 400.0], rtol=1e-12)
    np.testing.assert_allclose(across, 10.0 ** np.array([-2, -1.5, -0.5, 0.5, 1]), rtol=1e-12)


@pytest.mark.parametrize(
    ("values", "scale"),
    [
        (np.geomspace(2, 40, 12), "log"),
        (np.geomspace(40, 2, 12), "log"),
        (np.geomspace(1, 10, 3), "log"),
        (np.geomspace(2, 19, 12), "linear"),
        (np.linspace(2, 40, 12), "linear"),
        (np.geomspace(2, 40, 12).round(1), "linear"),
        (np.array([1.0, 10.0]), "linear"),
        (-np.geomspace(2, 40, 12), "linear"),
    ],
)
def test_equal_ratios_over_a_decade_are_on_a_logarithmic_scale(
    values: np.ndarray, scale: str
) -> None:
    """Speeds of `numpy.geomspace` stood on a linear axis, most of them at its end."""
    assert scale_of("Omega", values) == scale


# ---- outcomes and regions


def made_up(x: str, values: list[float], norms: list[str]) -> xr.Dataset:
    """A plane in which the cycle loses stability at the third value of x, and ends above the second
    load."""
    dims = ("N", x, "normalization")
    shape = (4, len(values), len(norms))
    growth = np.where(np.arange(len(values)) < 2, -0.1, 0.1)[None, :, None] * np.ones(shape)
    growth[2:] = np.nan
    followed = np.where(np.isfinite(growth), 1, 0)
    outcome = np.where(np.isnan(growth), "undecided", np.where(growth < 0, "quiet", "separation"))
    outcome[3, 1] = "growing"
    codes = {"outcome": np.vectorize(OUTCOMES_TO_HORIZON.index)(outcome)}
    codes |= dict.fromkeys(("cycle", "branch_continues_first", "branch_continues_second"), followed)
    data = {
        name: (dims, values, {"flag_meanings": " ".join(Regions.COLUMNS[name].flags)})
        for name, values in codes.items()
    }
    data["growth_rate"] = (dims, growth)
    axes = {"N": [100.0, 200, 300, 400], x: values, "normalization": norms}
    return xr.Dataset(data, axes, {"options": json.dumps({"horizon": 900.0})})


def mark(x: float, y: float, paper: str) -> dict[str, Any]:
    return {"x": x, "y": y, "paper_outcome": paper}


def lengths(ax: Any) -> list[int]:
    return [
        len(lines.get_segments()) for lines in ax.collections if isinstance(lines, LineCollection)
    ]


@ON_EACH_SCALE
def test_regions_have_borders_marks_and_what_does_not_fit(
    x: str, values: list[float], scale: str, tmp_path
) -> None:
    marks = {"F2": mark(values[0], 100, "quiet"), "b": mark(values[-1], 400, "separation")}
    figure = draw("region_map", made_up(x, values, NORMS), x=x, y="N", marks=marks, title="All")
    shown, _, growth, _ = figure.axes[:4]
    assert shown.get_xscale() == scale
    # the cycle's stability changes at two loads between the second and third value; stable ones end
    # at two values
    assert lengths(shown) == lengths(growth) == [2, 2]
    assert {text.get_text() for text in shown.texts} == {"F2", "b"}
    # between two that are alike
    assert len(_hatched(shown)[0]) == 1
    named = {
        "quiet",
        "separation",
        "undecided",
        "cycle loses stability",
        "stable cycle ends (fold)",
    }
    named |= {"All", "paper: quiet", "paper: separation", "no cycle found", "unresolved"}
    assert named <= set(labels(figure))
    contradicted = "b: paper: “separation”, static start: undecided."
    assert f"Within 900 s of the static start.\n{contradicted}" in labels(figure)
    path = tmp_path / "map.png"
    save(figure, path)


def test_a_stable_cycle_ends_towards_lower_values_as_well() -> None:
    study = made_up("Omega", [5.0, 10, 20], NORMS[:1])
    loads = study["N"]
    turned = study.isel(N=slice(None, None, -1)).assign_coords(N=loads)
    panels = [draw("region_map", each, x="Omega", y="N").axes[0] for each in (study, turned)]
    assert lengths(panels[0]) == lengths(panels[1]) == [2, 2]


def test_no_fold_is_where_a_motion_without_a_cycle_stays_quiet() -> None:
    study = made_up("Omega", [5.0, 10, 20], NORMS[:1])
    study["outcome"][2, 0] = OUTCOMES_TO_HORIZON.index("quiet")
    assert lengths(draw("region_map", study, x="Omega", y="N").axes[0]) == [2, 1]


@pytest.mark.parametrize(("dims", "along"), [(("N", "Omega"), 2), (("Omega", "N"), 1)])
def test_a_neutral_border_follows_a_branch_along_its_own_dimension(
    dims: tuple[str, ...], along: int
) -> None:
    """The cycle changes along the speed, which is the first or the second dimension."""
    names = ["branch_continues_first", "branch_continues_second"]
    study = made_up("Omega", [5.0, 10, 20], NORMS[:1]).transpose(*dims, ...)
    crossed = names.pop(along - 1)
    study[names[0]] = xr.zeros_like(study[names[0]])
    assert lengths(draw("region_map", study, x="Omega", y="N").axes[0]) == [2, 2]
    study[crossed] = xr.zeros_like(study[crossed])
    assert lengths(draw("region_map", study, x="Omega", y="N").axes[0]) == [0, 2]


def test_curves_are_shown_in_a_region_map(plane: xr.Dataset) -> None:
    figure = draw(
        "region_map",
        made_up("Omega", [5.0, 10, 20], NORMS[:1]),
        {"curves": plane},
        x="Omega",
        y="N",
    )
    assert not lengths(figure.axes[0]), "in place of borders of cells"


def outcomes(
    dims: tuple[str, ...], axes: dict[str, Any], codes: np.ndarray, **attrs: str
) -> xr.Dataset:
    words = {"flag_meanings": "failed quiet growing separation"}
    return xr.Dataset({"outcome": (dims, codes, words)}, axes, attrs)


def test_contact_is_lost_at_the_range_of_the_mode_that_friction_feeds() -> None:
    """Of two modes, the second moves more in the plane; at 100 Hz its inertia is far above k."""
    dims = ("Omega", "N", "disc", "contact")
    contacts = ["unilateral", "bilateral"]
    axes = {"Omega": [10.0, 20], "N": [8000.0], "disc": ["a"], "contact": contacts}
    study = outcomes(dims, axes, np.full((2, 1, 1, 2), 3))
    values = np.full((2, 1, 1, 2), 0.01)
    study = study.assign(
        u_max=(dims, values), u_min=(dims, -values), surface_speed=(dims, 50 * values)
    )
    omega = [10.0, 200 * np.pi]
    disc = {"a": {"omega": omega, "tangential": [0.1, -0.4]}}
    study.attrs = {
        "base": '{"disc": "table", "k": 1e4, "m": 0.5, "c": 0}',
        "discs": json.dumps(disc),
    }
    figure = draw("late_range", study, by="disc", thickness=0.01)
    assert len(figure.axes) == 2
    (lost,) = [line for line in figure.axes[0].lines if line.get_linestyle() == ":"]
    expected = 2 * 8000 / (0.5 * omega[1] ** 2 - 1e4) / 0.01
    assert lost.get_ydata()[0] == pytest.approx(expected)
    # 2 thicknesses, wherever motions separate
    words = [text.get_text() for text in figure.axes[0].texts]
    factor = f"{2 / expected:.2g}"
    assert words == [
        "contact lost, N = 8 kN",
        f"with separation: {factor} times\nthe range at which\ncontact is lost",
    ]
    (reversal,) = [line for line in figure.axes[1].lines if line.get_linestyle() == ":"]
    assert reversal.get_ydata()[0] == 1
    assert max(figure.axes[1].lines[0].get_ydata()) == pytest.approx(0.5)


def test_ranges_late_in_the_motion_are_in_thicknesses() -> None:
    dims = ("Omega", "N", "disc", "contact")
    axes = {
        "Omega": [10.0, 20],
        "N": [8000.0],
        "disc": ["a", "b"],
        "contact": ["unilateral", "bilateral"],
    }
    study = outcomes(dims, axes, np.full((2, 1, 2, 2), 3))
    top = np.full((2, 1, 2, 2), 0.01)
    top[..., 1] = 0.05
    study = study.assign(u_max=(dims, top), u_min=(dims, -top)).assign_attrs(
        base='{"disc": "table"}'
    )
    figure = draw("late_range", study, by="disc", thickness=0.01)
    lines = [line for line in figure.axes[0].lines if line.get_linestyle() != "None"]
    assert [line.get_ydata()[0] for line in lines] == pytest.approx([2.0, 10.0])
    column = draw("late_range", study, by="disc", thickness=0.01, width="column")
    assert [bool(ax.get_xlabel()) for ax in column.axes] == [False, True]
    named = {"N = 8 kN", "with separation", "separates", "beyond linear plate theory"}
    assert named <= set(labels(figure))
    assert not [ax for ax in figure.axes if ax.texts], "lines would lie on it"


def test_a_cell_that_none_around_is_like_is_unresolved_unless_it_is_undecided() -> None:
    """A single separation beside two outcomes counted as resolved; a diagonal band is one."""
    q, g, s, u = "quiet", "growing", "separation", "undecided"
    alone = np.array([[q, q, q, q], [q, q, s, g], [g, g, g, g], [g, u, g, g], [s, g, g, g]])
    assert np.argwhere(unresolved_motions(alone)).tolist() == [[1, 2]]
    band = np.array([[q, q, q, s], [q, q, s, g], [g, g, g, g]])
    assert not unresolved_motions(band).any()
    between = np.array([[q, u, q], [q, s, q]])  # and an edge, beyond which a class may go on
    assert np.argwhere(unresolved_motions(between)).tolist() == [[1, 1]]


@pytest.mark.parametrize(
    ("words", "marked"),
    [
        (["quiet", "growing", "quiet"], [False, True, False]),
        (["quiet", "growing", "growing"], [False, False, False]),
        (["", "growing", ""], [False, False, False]),
        (["quiet", "", "quiet"], [False, True, False]),
    ],
)
def test_a_cell_between_two_others_that_are_alike_is_unresolved(
    words: list[str], marked: list[bool]
) -> None:
    across = np.array([words])
    [row] = unresolved(across).tolist()
    assert row == marked
    [column] = unresolved(across.T).T.tolist()
    assert column == marked


@pytest.mark.parametrize("contacts", [["unilateral", "bilateral"], ["unilateral"]])
@pytest.mark.parametrize("modes", [["as_published"], ["as_published", "orthonormal"]])
def test_ranges_of_one_model_or_contact_are_drawn(modes: list[str], contacts: list[str]) -> None:
    """One normalization was no dimension any more, and drawing failed."""
    dims = ("Omega", "N", "normalization", "contact")
    axes = {"Omega": [10.0, 20], "N": [8.0], "normalization": modes, "contact": contacts}
    shape = (2, 1, len(modes), len(contacts))
    study = outcomes(dims, axes, np.full(shape, 3))
    top = np.full(shape, 0.01)
    study = study.assign(u_max=(dims, top), u_min=(dims, -top), surface_speed=(dims, 0 * top))
    figure = draw("late_range", study.assign_attrs(base="{}"), by="normalization")
    assert len(figure.axes) == len(modes)
    drawn = [line for line in figure.axes[0].lines if line.get_linestyle() != "None"]
    assert len(drawn) == len(contacts)
    assert ("separation ignored" in labels(figure)) == (len(contacts) > 1)
