"""Every variable of a sweep of every function is drawn under its own name, in its unit, and with
its values."""

import functools
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.data.variables import typeset
from disc_model.figures import rate_scale
from disc_model.figures.classes import GROWING, UNKNOWN_STARTS, name_of
from disc_model.figures.gap_rows import rows_above
from disc_model.figures.rate_scale import ANOTHER_BORDER, OPEN
from disc_model.figures.words import label_of, unit_text
from disc_model.studies.run import describe
from tests.blocks import RIG
from tests.figures.measured import Shown, assert_shows
from tests.figures.reading import as_map, labels
from tests.refusals import refusal

CASE = dm.Parameters(N=385, Omega=15, n_diameters=2)
SPEEDS = [10.0, 12.0, 14.0]  # rad/s
LOADS = [300.0, 385.0]  # N
KNOWN = {"psi": "Angle ψ", "outcome": "Outcome", "critical_speed": "Critical speed for separation"}
KNOWN["value"] = "Critical static friction μ_s for instability of the cycle"
KNOWN["border"] = "Static friction μ_s above which the cycle stays unstable"
KNOWN |= {"onset_speed": "Speed at separation onset"}
KNOWN |= {"offset_speed": "Speed at separation end"}
"""Words of variables that have a symbol, or a shorter name than the one that explains them."""
WITHIN = {
    "critical_speed": " within 3 s",
    "outcome": " within 3 s",
    "separating_fraction": ", within 2 s",
    "separating_fraction_low": ", within 2 s",
    "separating_fraction_high": ", within 2 s",
    "critical_energy": ", within 2 s",
    "critical_energy_lower": ", within 2 s",
    "critical_energy_sampled": ", within 2 s",
    "time_stick": " within 0.5 s",
    "time_slip": " within 0.5 s",
    "time_separation": " within 0.5 s",
    "energy_residual": " within 0.5 s",
    "energy_residual_transverse": " within 0.5 s",
    "energy_residual_inplane": " within 0.5 s",
    "n_events": " within 0.5 s",
}
"""The time for which motions are followed, behind the names of variables that depend on it."""


def own(case: dm.Parameters) -> xr.Dataset:
    """A function of a user's own: with names and units, and without."""
    attributes = {"units": "mm", "long_name": "range of my slider"}
    word = "small"
    if case.Omega > 11:
        word = "large"
    values = {"reach": ((), 0.02 * case.Omega, attributes), "count": ((), 3 + case.N), "size": word}
    return xr.Dataset(values)


FUNCTIONS: dict[Callable[..., Any], dict[str, Any]] = {
    dm.floquet: {},
    dm.steady_sliding: {},
    dm.outcome: {"horizon": 3},
    dm.critical_speed: {"bounds": (10, 12), "horizon": 3, "precision": 1.0},
    dm.basins: {"energies": [1e-4, 0.1], "horizon": 2},
    dm.hysteresis: {"bounds": (14, 15), "dwell": 2, "max_dwell": 2, "evaluation_time": 1},
    dm.lyapunov_exponents: {"duration": 0.5},
    dm.simulate: {"t_end": 0.5},
    dm.critical: {"name": "mu_s", "bounds": (0.3, 0.5), "points": 3, "precision": 0.01},
    dm.continue_cycle: {"name": "mu_s", "bounds": (0.399, 0.401)},
    own: {},
}


SEARCH_OMEGA = (dm.critical_speed, dm.hysteresis)
"""Functions that vary the speed by themselves, which is no axis of a sweep of them."""


@functools.cache
def swept(function: Callable[..., Any]) -> xr.Dataset:
    """A sweep over speed and preload; what does not depend on the speed is the same at all of them."""
    if function not in SEARCH_OMEGA:
        return dm.sweep(function, CASE, Omega=SPEEDS, N=LOADS, **FUNCTIONS[function])
    study = dm.sweep(function, CASE, N=LOADS, **FUNCTIONS[function])
    study = study.expand_dims(Omega=SPEEDS)
    study["Omega"].attrs.update(units="rad s-1", long_name="speed of the drive point")
    return study


def words_of(variable: xr.DataArray) -> str:
    """What a label has to say: the long name, or the name, without what nan means and remarks."""
    name = str(variable.name)
    words = str(variable.attrs.get("long_name", name.replace("_", " "))).split(", nan ")[0]
    words = words.split("; ")[0]
    words = words.replace("disturbances of ", "")
    within = WITHIN.get(name, "")
    if name == "surface_speed" and "late stretch" not in words:
        within = " within 0.5 s"
    return KNOWN.get(name, words[0].upper() + words[1:]) + within


def unit_of(variable: xr.DataArray) -> str:
    """The unit of a dataset in the notation of labels."""
    unit = str(variable.attrs.get("units", "1"))
    return {"1": "", "s-1": "1/s", "rad s-1": "rad/s"}.get(unit, unit)


def numbers_over_the_grid(study: xr.Dataset) -> list[str]:
    return [
        str(name)
        for name, values in study.items()
        if {*values.dims} == {"Omega", "N"}
        and values.dtype.kind == "f"
        and "comment" not in values.attrs  # which says that these are True and False
    ]


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda function: function.__name__)
def test_numbers_have_their_name_and_unit_on_the_axis(function: Callable[..., Any]) -> None:
    study = swept(function)
    names = numbers_over_the_grid(study)
    assert names or function is dm.continue_cycle
    for name in names:
        line = study.sel(N=385)
        if not np.isfinite(line[name]).any():
            line = line.assign({name: (("Omega",), [1.0, 2.0, 4.0], line[name].attrs)})
        _, ax = pyplot.subplots()
        dm.plot_sweep(line, name, ax=ax)
        assert_shows(
            ax.figure, Shown(0, "y", words_of(study[name]), line[name], unit_of(study[name]))
        )
        assert_shows(ax.figure, Shown(0, "x", "Speed Ω", SPEEDS, "rad/s"))
        pyplot.close("all")


UNASKED = {
    dm.floquet: "Growth rate of the stick-slip cycle (1/s)",
    dm.steady_sliding: "Growth rate of steady sliding (1/s)",
    dm.outcome: "Outcome within 3 s",
    dm.critical_speed: "Critical speed for separation within 3 s (rad/s)",
    dm.basins: "Share of 2 starts, kicked with 0.0001, 0.1 J",
    dm.hysteresis: "Speed at separation onset (rad/s)",
    dm.lyapunov_exponents: "Largest Lyapunov exponent (1/s)",
    dm.simulate: "Number of separations within 0.5 s",
    dm.critical: r"Critical static friction $\mathrm{μ_s}$ for instability of the cycle",
    own: "Range of my slider (mm)",
}
"""Labels of what is drawn if no variable is asked for."""


@pytest.mark.parametrize("function", UNASKED, ids=lambda function: function.__name__)
def test_what_is_drawn_unasked_is_named(function: Callable[..., Any]) -> None:
    ax = dm.plot_sweep(swept(function).sel(N=385))
    assert " ".join(ax.get_ylabel().split()) == UNASKED[function]
    assert ax.get_xlabel() == "Speed Ω (rad/s)"
    title = "N = 385 N, nodal diameters up to 2"
    if function is dm.hysteresis:
        title = "N = 385 N, stays of 2 s, nodal diameters up to 2"
    assert ax.figure.get_suptitle() == title, "what does not vary"
    pyplot.close("all")


def test_a_border_of_stability_says_why_there_is_none() -> None:
    """It had no value, under a name that was hard to read."""
    critical = dm.critical
    study = swept(critical).sel(N=385)
    unit = {"units": "rad s-1"}
    meaning = "speed of the drive point above which the motion stays unstable"
    size = study.sizes["Omega"]
    border = np.where(np.arange(size) < 2, np.nan, 12.0)
    critical_speed = {**unit, "long_name": "critical value of speed of the drive point"}
    crossings = np.repeat(border[:, np.newaxis], 2, axis=1)
    study.attrs["options"] = '{"bounds": [13, 25], "name": "Omega"}'
    study = study.drop_vars(["crossings", "value"]).assign(
        border=("Omega", border, {**unit, "long_name": meaning}),
        value=("Omega", np.full(size, 10.0), critical_speed),
        crossings=(("Omega", "crossings_index"), crossings),
        at_lower_bound=("Omega", np.arange(size) == 0),
    )
    ax = dm.plot_sweep(study, "border")
    label = "Speed Ω above which the motion stays unstable (rad/s)"
    assert " ".join(ax.get_ylabel().split()) == label
    said = [row.reason for row in rows_above(ax)]
    unstable = "unstable at all values from 13 to 25 rad/s"
    assert said == [unstable, "stable at the upper bound, 25 rad/s"]
    both = dm.plot_sweep(study, ["value", "border"])
    assert both.get_ylabel() == "Speed Ω (rad/s)"
    pyplot.close("all")


@pytest.mark.parametrize("width", [84, pytest.param(174, marks=pytest.mark.slow)])
def test_a_line_from_a_tongue_to_the_main_border_is_open(width: int) -> None:
    """One line joined them, with a greatest value at 0.24 that there is not."""
    study = xr.Dataset(
        {"value": ("mu_k", [9.14, 12.61, 9.48]), "border": ("mu_k", [15.74, 12.61, 9.48])},
        {"mu_k": [0.20, 0.24, 0.28]},
    )
    _, ax = pyplot.subplots(figsize=(width / 25.4, 60 / 25.4), layout="constrained")
    dm.plot_sweep(study, "value", ax=ax)
    heights = ax.lines[0].get_ydata()
    assert np.flatnonzero(np.isnan(heights)).tolist() == [1]
    assert said_above(ax) == [ANOTHER_BORDER]
    [row] = rows_above(ax)[0].rows
    assert row.get_xdata() == pytest.approx([0.22])
    assert said_above(dm.plot_sweep(study, "border")) == []
    pyplot.close("all")


MAPS = {
    dm.floquet: ("growth_rate", "releases", "stable", "bifurcation_type"),
    dm.steady_sliding: ("contact_force", "stable"),
    dm.outcome: ("u_max", "outcome", "status"),
    dm.basins: ("separating_fraction",),
    dm.simulate: ("n_events", "status"),
    own: ("reach", "count", "size"),
}
"""Numbers and words of sweeps that are drawn as maps."""


@pytest.mark.parametrize(
    ("function", "name"), [(function, name) for function, names in MAPS.items() for name in names]
)
def test_maps_have_a_bar_for_numbers_and_a_legend_for_words(
    function: Callable[..., Any], name: str
) -> None:
    study = swept(function)
    ax = as_map(study, name)
    figure = ax.figure
    assert ax.get_xlabel() == "Speed Ω (rad/s)"
    assert ax.get_ylabel() == "Preload N (N)"
    [legend] = figure.legends or [None]
    if legend:
        entries = {text.get_text() for text in legend.get_texts()}
    else:
        entries = set()
    of_truth = "comment" in study[name].attrs
    if study[name].dtype.kind in "fi" and not of_truth:
        values = study[name].values
        expected = Shown(1, "bar", words_of(study[name]), values, unit_of(study[name]))
        assert_shows(figure, expected)
        of_starts = {"undecided", UNKNOWN_STARTS.label, GROWING.label}
        assert entries <= {"no cycle found", "stable", "unresolved", "no value", *of_starts}
    else:
        assert len(figure.axes) == 1, "no bar"
        said = {"False": "no", "True": "yes"}
        values = study[name].values
        if of_truth:
            values = values[np.isfinite(values)] == 1
        found = map(str, np.unique(values))
        words = {said.get(word, name_of(word)) for word in found if word}
        assert words <= entries <= words | {"unresolved", "no cycle found", "no value"}
        title = " ".join(legend.get_title().get_text().split())
        assert title == words_of(study[name])
    pyplot.close("all")


@pytest.mark.parametrize("log", [False, True])
@pytest.mark.parametrize(
    ("variable", "label"),
    [
        ("growth_rate", "Growth rate of the stick-slip cycle (1/s)"),
        ("period", "Period of the stick-slip cycle (ms)"),
    ],
)
def test_a_sweep_without_any_value_has_no_scale(variable: str, label: str, log: bool) -> None:
    """A bar from 0 to 1, or from -0.3 to 0.3 per second, was made up where nothing had a value."""
    study = dm.sweep(dm.floquet, CASE, Omega=SPEEDS, N=LOADS)
    study[variable] = study[variable].where(False)
    plane = as_map(study, variable, log=log)
    [ax] = plane.figure.axes
    [legend] = ax.figure.legends
    assert "no value" in [text.get_text() for text in legend.get_texts()]
    assert legend.get_title().get_text() == label
    curve = as_map(study.isel(N=0), variable, log=log)
    assert [*curve.get_yticks(), *curve.get_yticks(minor=True)] == []
    assert curve.get_ylabel().replace("\n", " ") == label
    assert "no value" in [text.get_text() for text in curve.texts]
    pyplot.close("all")


def plane() -> xr.Dataset:
    """Growth rates over speed and preload."""
    axes = {"Omega": SPEEDS, "N": LOADS}
    attrs = {"units": "s-1", "long_name": "growth rate"}
    return xr.Dataset({"growth_rate": ([*axes], 0.01 * np.arange(6.0).reshape(3, 2), attrs)}, axes)


@pytest.mark.parametrize(
    ("x", "lines", "label", "names"),
    [
        ("", "N", "Speed Ω (rad/s)", ["Preload N = 300 N", "385 N"]),
        ("Omega", "N", "Speed Ω (rad/s)", ["Preload N = 300 N", "385 N"]),
        ("", "Omega", "Preload N (N)", ["Speed Ω = 10 rad/s", "12 rad/s", "14 rad/s"]),
    ],
)
def test_two_dimensions_of_numbers_are_lines_if_asked_for(
    x: str, lines: str, label: str, names: list[str]
) -> None:
    ax = dm.plot_sweep(plane(), "growth_rate", x, lines=lines)
    [legend] = ax.figure.legends
    assert ax.get_xlabel() == label
    assert [text.get_text() for text in legend.get_texts()] == names
    drawn = [line for line in ax.lines if line.get_label() in names]
    for i, line in enumerate(drawn):
        values = plane()["growth_rate"].isel({lines: i}).values
        np.testing.assert_array_equal(line.get_ydata(), values)
    pyplot.close("all")


@pytest.mark.parametrize(
    ("selected", "x", "lines", "said"),
    [
        ({}, "", "mu_k", "lines='mu_k': must be another dimension than x (known: Omega, N)"),
        ({}, "Omega", "Omega", "lines='Omega': must be another dimension than x (known: N)"),
        ({}, "", 3, "lines=3: must be a name"),
        (
            {"N": 300},
            "",
            "N",
            "lines='N': must be a second dimension, but growth_rate varies along Omega only",
        ),
    ],
)
def test_what_is_no_second_dimension_has_no_lines(
    selected: dict[str, float], x: str, lines: Any, said: str
) -> None:
    with refusal(re.escape(said)):
        dm.plot_sweep(plane().sel(selected), "growth_rate", x, lines=lines)


def test_shares_are_bars_and_no_lines() -> None:
    with refusal("lines='N': must be left out, because basin_fraction is drawn as bars"):
        dm.plot_sweep(swept(dm.basins).sel(Omega=10), "basin_fraction", lines="N")


PAIRS = {"N": [385.0, 300.0, 350.0, 320.0], "mu_k": [0.24, 0.2, 0.3, 0.41]}
"""The last pair is no case, as mu_k is above mu_s."""


def outcomes() -> xr.Dataset:
    """Five outcomes on a map, of which one has a first separation."""
    words = [["quiet", "growing", "undecided"], ["separation", "at_rest", "quiet"]]
    first = [[np.nan, np.nan, np.nan], [0.5, np.nan, np.nan]]
    axes = {"N": [100.0, 200.0], "Omega": [10.0, 20.0, 30.0]}
    values = {"outcome": ([*axes], words), "first_separation": ([*axes], first, {"units": "s"})}
    return xr.Dataset(values, axes, attrs={"options": '{"horizon": 3}'})


def rates() -> xr.Dataset:
    """Growth rates of either sign, one of them alone among others, and a place without a cycle."""
    rate = np.full((4, 5), 0.1)
    rate[2:, :3] = -0.1
    rate[3, 3] = np.nan
    rate[0, 2] = 0.3
    cycle = np.where(np.isfinite(rate), "followed", "no_cycle")
    axes = {"N": [100.0, 200.0, 300.0, 400.0], "Omega": [10.0, 12.0, 14.0, 16.0, 18.0]}
    attrs = {"units": "s-1", "long_name": "growth rate of disturbances of the stick-slip cycle"}
    values = {"growth_rate": ([*axes], rate, attrs), "cycle": ([*axes], cycle)}
    return xr.Dataset(values, axes)


def test_runs_without_a_separation_have_none_within_their_time() -> None:
    """They had "no value"."""
    study = dm.sweep(dm.simulate, CASE, t_end=0.5, Omega=[5.0, 6.0])
    assert np.isnan(study["first_separation"]).all()
    ax = dm.plot_sweep(study, "first_separation")
    assert [text.get_text() for text in ax.texts] == ["none within 0.5 s"]
    study["time_reached"][0] = 0.2
    ax = dm.plot_sweep(study, "first_separation")
    assert [text.get_text() for text in ax.texts] == ["none within 0.5 s, or ended early"]
    pyplot.close("all")


@pytest.mark.parametrize(
    ("name", "label", "factor"),
    [
        ("Omega", "Critical speed Ω (rad/s)", 1.0),
        ("k_p", "Critical in-plane spring $k_p$ (kN/m)", 1e-3),
        ("mu_k_over_mu_s", "Critical ratio μ_k/μ_s", 1.0),
        ("E", "Critical Young's modulus E (GPa)", 1e-9),
    ],
)
def test_a_critical_value_has_the_name_of_its_parameter(
    name: str, label: str, factor: float
) -> None:
    words = {**describe(name), "long_name": f"critical value of {describe(name)['long_name']}"}
    found, by = label_of(xr.DataArray(1.0, name="value", attrs=words))
    assert typeset(found) == typeset(label)
    assert by == factor


def test_points_without_a_separation_are_no_points_without_a_value() -> None:
    study = outcomes()
    assert labels(as_map(study, "first_separation").figure) == ["none within 3 s"]
    # where departures are extrapolated, some separations have no time
    study.attrs["options"] = '{"horizon": 3, "extrapolate": true}'
    shown = labels(as_map(study, "first_separation").figure)
    assert shown == ["none within 3 s, or not timed"]
    pyplot.close("all")


def settling(*, longer: bool) -> xr.Dataset:
    """Sweeps of the speed at two loads, of which one motion in contact at 300 N settles only in
    longer stays; separation begins nowhere at 200 N."""
    dims = ("N", "direction", "sweep_Omega")
    rates = np.zeros((2, 2, 3))
    rates[1, :, 2] = 9.0
    settled = np.full(rates.shape, "settled", dtype="U9")
    if not longer:
        settled[:, 0, 1] = "undecided"
    data = {
        "separation_rate": (dims, rates),
        "range": (dims, rates + 0.1),
        "sweep_settled": (dims, settled),
        "onset_speed": ("N", [np.nan, 14.0], {"units": "rad s-1"}),
        "offset_speed": ("N", [np.nan, 14.0], {"units": "rad s-1"}),
    }
    coords = {"N": [200.0, 300.0], "direction": ["up", "down"], "sweep_Omega": [10.0, 12.0, 14.0]}
    return xr.Dataset(data, coords)


def filled_points(ax: Any) -> list[tuple[float, float]]:
    """The points of a panel with a filled mark."""
    filled = [line for line in ax.lines if line.get_markerfacecolor() != "none"]
    return [
        (x, y)
        for line in filled
        for x, y in line.get_xydata().tolist()
        if line.get_marker() in "os"
    ]


@pytest.mark.parametrize("longer", [False, True])
def test_points_that_rest_on_motions_which_had_not_settled_are_filled(longer: bool) -> None:
    """The message of `hysteresis` said so, and the picture did not."""
    words = "not settled"
    sweep = settling(longer=longer)
    ax = as_map(sweep.sel(N=300), "range")
    assert filled_points(ax) == ([] if longer else [(12.0, 0.1)])
    assert (f"filled: {words}" in labels(ax.figure)) == (not longer)

    axes = as_map(sweep, ["onset_speed", "offset_speed"])
    assert filled_points(axes) == ([] if longer else [(300.0, 14.0)])
    assert (f"filled: {words}" in labels(axes.figure)) == (not longer)
    said = said_above(axes)
    assert any(words in each for each in said) == (not longer), "nor may that there is none"

    plane = as_map(sweep.sel(direction="up"), "range")
    hatched = [patch for patch in plane.patches if patch.get_hatch()]
    assert len(hatched) == (not longer)
    assert (words in labels(plane.figure)) == (not longer)


def said_above(ax: Any) -> list[str]:
    """The words above a panel that say what its marks there mean, from the lowest row on."""
    return [" ".join(row.words.get_text().split()) for row in rows_above(ax)]


def test_a_smooth_line_of_growth_rates_is_not_open() -> None:
    """Nor are points without order, steady sliding, which is one equilibrium, or a logarithmic scale
    of rates of one sign."""
    smooth = dm.sweep(dm.floquet, CASE, Omega=[12, 12.5, 13])
    assert said_above(dm.plot_sweep(smooth, "growth_rate")) == []
    rates = xr.DataArray([0.2, 5.0, 80.0], {"mu_s": [0.1, 0.2, 0.3]}, name="growth_rate")
    study = rates.to_dataset()
    assert said_above(dm.plot_sweep(study)) == [OPEN]
    assert said_above(dm.plot_sweep(study, log=True)) == []
    study["growth_rate"].attrs["long_name"] = "growth rate of steady sliding"
    assert said_above(dm.plot_sweep(study)) == []


@pytest.mark.parametrize("x", PAIRS)
def test_paired_samples_are_points_over_one_of_their_columns(x: str) -> None:
    """They had no picture."""
    pairs = dm.sweep(dm.floquet, CASE, zip=PAIRS)
    ax = dm.plot_sweep(pairs, "period", x)
    points, *gaps = ax.lines
    assert points.get_linestyle() == "None"
    np.testing.assert_array_equal(points.get_xdata(), pairs[x].values)
    np.testing.assert_array_equal(points.get_ydata(), 1e3 * pairs["period"].values)
    marked = np.concatenate([line.get_xdata() for line in gaps])
    missing = pairs["period"].isnull().values
    assert missing.any()
    assert sorted(marked) == sorted(pairs[x].values[missing])
    assert "failed" in [text.get_text() for text in ax.texts]
    pyplot.close("all")


def test_paired_samples_have_a_mark_for_each_value_of_an_axis_beside_them() -> None:
    pairs = dm.sweep(dm.floquet, CASE, zip=PAIRS, Omega=SPEEDS[:2])
    ax = dm.plot_sweep(pairs, x="mu_k")
    assert len({line.get_marker() for line in ax.lines[:2]}) == 2
    assert ax.get_xlabel().startswith("Kinetic friction")
    with refusal("x='m': must be one of N, mu_k, Omega"):
        dm.plot_sweep(pairs, x="m")
    pyplot.close("all")


def test_samples_with_names_are_listed_as_in_their_table() -> None:
    """They were in the order of their preloads."""
    case = dm.Parameters(N=385, Omega=15, n_diameters=2)
    table = {"sample": ["A", "B", "C"], "N": [390.0, 300.0, 350.0], "k": [11e3, 12e3, 13e3]}
    study = dm.sweep(lambda case: case.N, case, zip=table, Omega=[12, 13])
    ax = dm.plot_sweep(study, "value", x="Omega")
    said = labels(ax.figure)
    assert [text.rpartition(" ")[2] for text in said] == ["A", "B", "C"]
    pyplot.close("all")


def test_discs_of_a_sweep_are_told_apart_in_the_legend() -> None:
    """Both had the same name, or no picture."""
    columns = {"diameters": [2, 3], "omega": [900.0, 1500.0], "amplitude": [1.0, 1.0]}
    discs = [dm.Disc(**columns, damping_ratio=[ratio] * 2) for ratio in (1e-3, 1e-4)]
    case = dm.Parameters(N=100, Omega=20, r_0=0.2, disc=discs[0])
    swept = dm.sweep(dm.steady_sliding, case, Omega=[20.0, 30.0], disc=discs)
    ax = dm.plot_sweep(swept, "growth_rate")
    names = [text.get_text() for text in ax.figure.legends[0].get_texts()]
    assert [name.partition(":")[0] for name in names] == ["disc 1", "disc 2"]
    pyplot.close("all")


def test_units_of_datasets_become_those_of_labels() -> None:
    written = {"s-1": "1/s", "N s m-1": "N s/m", "rad s-2": "rad/s²", "m2": "m²", "1": "", "": ""}
    assert {unit: unit_text(unit) for unit in written} == written
    assert unit_text("m/s") == "m/s", "a user's own"


def test_a_sweep_in_other_units_is_drawn_in_those_of_its_label() -> None:
    """A displacement in m, which labels give in mm."""

    def height(case: dm.Parameters) -> dict[str, float]:
        return {"u": 1e-6 * case.Omega}

    study = dm.sweep(height, CASE, Omega=SPEEDS)
    study["u"].attrs.update(units="m", long_name="vertical displacement of the slider")
    ax = dm.plot_sweep(study, "u")
    assert ax.get_ylabel() == "Slider u (mm)"
    np.testing.assert_allclose(ax.lines[0].get_ydata(), 1e-3 * np.array(SPEEDS))
    pyplot.close("all")


def test_a_sweep_of_three_dimensions_is_to_be_narrowed_by_its_reader() -> None:
    axes = {"N": [1.0, 2.0], "Omega": [1.0, 2.0], "m": [1.0, 2.0]}
    rates = [*axes], np.zeros((2, 2, 2))
    study = xr.Dataset({"growth_rate": rates}, axes)
    with refusal(r"study='N, Omega, m': must vary along at most"):
        dm.plot_sweep(study)


def test_shares_by_energy_over_the_speed_say_what_to_select_first() -> None:
    """The energy was called no axis at all, and the other refusal named a load that was none."""
    study = swept(dm.basins).sel(N=385)
    selection = r"study\.sel\(Omega=10\)"
    with refusal(f"x='energy': is an axis of basin_fraction_by_energy: .*{selection}"):
        dm.plot_sweep(study, x="energy")
    with refusal(f"must vary along at most two: .*{selection}"):
        dm.plot_sweep(study, "basin_fraction_by_energy")
    ax = dm.plot_sweep(study.sel(Omega=10), x="energy")
    assert ax.get_xlabel() == "Energy of the kick (J)"
    pyplot.close("all")


def test_many_paired_samples_are_joined_by_no_line() -> None:
    """They have no order; more than sixty of them were joined all the same."""
    places = np.random.default_rng(1).random((2, 100))
    first, second = places
    attrs = {"units": "m", "long_name": "height"}
    coordinates = {"N": ("pair", first), "m": ("pair", second)}
    study = xr.Dataset({"height": ("pair", first * second, attrs)}, coordinates)
    ax = dm.plot_sweep(study)
    dots, *others = [line for line in ax.lines if len(line.get_xdata()) == 100]
    assert dots.get_marker() == "."
    for line in (dots, *others):
        assert line.get_linestyle() == "None"
    pyplot.close("all")


def own_rates(case: dm.Parameters) -> dict[str, Any]:
    """Numbers of both signs, and a zero; none at the largest speed and load."""
    if case.Omega > 13 and case.N > 310:
        raise dm.ParameterError("no value here")
    rate = (case.Omega - 12.0) ** 3
    return {"cycle_rate": rate, "good": rate > 0, "size": "large" if rate > 0 else "small"}


def test_a_logarithmic_scale_leaves_no_cell_or_point_blank() -> None:
    found = dm.sweep(own_rates, CASE, Omega=SPEEDS, N=LOADS)
    ax = as_map(found, "cycle_rate", log=True, labels={"bar": "My rate"})
    assert ax.figure.axes[1].get_ylabel() == "My rate"
    colours = ax.collections[0].to_rgba(ax.collections[0].get_array())
    expected = found["cycle_rate"].transpose("N", "Omega").notnull()
    np.testing.assert_array_equal(colours[..., 3] > 0, expected)
    with refusal("bar"):
        as_map(found.isel(N=0), "cycle_rate", labels={"bar": "My rate"})
    line = as_map(found.isel(N=0), "cycle_rate", log=True)
    assert line.get_yscale() == "symlog"
    assert line.get_ylabel() == "Cycle rate"
    low, high = line.get_ylim()
    assert low < -8 < 8 < high, "all values are within the axis"
    pyplot.close("all")


@pytest.mark.parametrize(("name", "words"), [("good", ["no", "yes"]), ("size", ["large", "small"])])
def test_words_and_truth_keep_their_classes_where_a_point_failed(
    name: str, words: list[str]
) -> None:
    """Truth was drawn in colours from 0 to 1, and a failed point as a class without a name."""
    found = dm.sweep(own_rates, CASE, Omega=SPEEDS, N=LOADS)
    ax = as_map(found, name)
    assert len(ax.figure.axes) == 1
    [legend] = ax.figure.legends
    assert sorted(text.get_text() for text in legend.get_texts()) == sorted([*words, "failed"])
    line = as_map(found.sel(N=385), name)
    assert [text.get_text() for text in line.texts] == ["failed"]
    assert [tick.get_text() for tick in line.get_yticklabels()] == [words[name == "size"]]
    pyplot.close("all")


def searched(case: dm.Parameters) -> dict[str, Any]:
    """A critical value as `critical` returns it: at the bound of 10 rad/s for small loads."""
    return {"value": max(10.0, case.N / 20), "at_lower_bound": case.N < 210}


def test_values_at_the_bound_of_a_search_are_told_from_those_found() -> None:
    """35 of 60 samples stood at 10 rad/s as if they had been found there."""
    line = as_map(dm.sweep(searched, CASE, N=[180, 200, 300, 385]), "value")
    [arrows] = [each for each in line.lines if each.get_marker() == r"$\downarrow$"]
    assert arrows.get_xdata().tolist() == [180, 200]
    assert arrows.get_ydata().tolist() == [10, 10]
    [legend] = line.figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["at or below the lower bound"]
    plane = as_map(dm.sweep(searched, CASE, N=[180, 200, 300], Omega=SPEEDS), "value")
    [legend] = plane.figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["at or below the lower bound"]
    none = as_map(dm.sweep(searched, CASE, N=[300, 385]), "value")
    assert not none.figure.legends
    pyplot.close("all")


def test_a_critical_speed_at_the_lowest_of_its_scan_is_marked() -> None:
    speeds = {"critical_speed": ("N", [10.0, 12.0], {"units": "rad s-1"})}
    study = xr.Dataset(speeds, {"N": [300.0, 385.0], "scan_Omega": [10.0, 11.0, 12.0]})
    ax = dm.plot_sweep(study)
    [arrows] = [each for each in ax.lines if each.get_marker() == r"$\downarrow$"]
    assert arrows.get_xdata().tolist() == [300]
    pyplot.close("all")


def rate(case: dm.Parameters) -> dict[str, float]:
    return {"rate": case.N * case.Omega}


def test_growth_rates_of_samples_are_drawn_over_their_names() -> None:
    """A line of growth rates has gaps, between which names were to be numbers."""
    table = {"sample": ["A", "B", "C"], "N": [385.0, 300.0, 320.0], "Omega": [15.0, 10.0, 12.0]}
    ax = dm.plot_sweep(dm.sweep(dm.floquet, CASE, zip=table), "growth_rate", x="sample")
    [line] = [each for each in ax.lines if len(each.get_xdata()) == 3]
    assert list(line.get_xdata()) == ["A", "B", "C"]


@pytest.mark.filterwarnings("error:invalid value", "error:overflow")
@pytest.mark.parametrize("axes", [{}, {"mu_k": [0.15, 0.2]}])
def test_growth_rates_below_any_axis_are_named(axes: dict[str, list[float]]) -> None:
    """On a rigid disc they are -inf: a line left their speeds out, and a map had "no value"."""
    speeds = [1.0, 1.5, 2.0, 2.5]
    growth = dm.sweep(dm.floquet, RIG, Omega=speeds, **axes)
    assert np.isneginf(growth["growth_rate"].values).any()
    ax = dm.plot_sweep(growth, "growth_rate")
    said = [text.get_text() for text in ax.figure.findobj(pyplot.Text)]
    assert "growth rate −∞" in said
    low, high = ax.get_xlim()
    assert low <= 1.0
    assert high >= 2.5
    pyplot.close("all")


def test_a_sweep_over_words_alone_is_drawn_over_them() -> None:
    """It was refused: nothing was "over the grid"."""
    forces = ["vertical", "normal"]
    ax = dm.plot_sweep(dm.sweep(rate, CASE, contact_force=forces), "rate")
    names = [text.get_text() for text in ax.get_xticklabels()]
    assert names == ["vertical contact force", "normal contact force"]
    norms = {"normalization": ["as_published", "orthonormal"]}
    two = dm.plot_sweep(dm.sweep(rate, CASE, contact_force=forces, **norms), "rate")
    assert labels(two.figure) == ["modes as published", "orthonormal modes"]
    pyplot.close("all")


def test_values_that_do_not_ascend_are_drawn_in_their_order() -> None:
    """Lines went back and forth, and cells of maps lay on each other."""
    loads = [385.0, 300.0, 340.0]
    line = as_map(dm.sweep(rate, CASE, N=loads), "rate")
    assert line.lines[0].get_xdata().tolist() == sorted(loads)
    np.testing.assert_allclose(line.lines[0].get_ydata(), 15 * np.sort(loads))
    plane = as_map(dm.sweep(rate, CASE, N=loads, Omega=[10, 12]), "rate")
    [mesh] = plane.collections
    np.testing.assert_allclose(mesh.get_array()[0], 10 * np.sort(loads))
    pyplot.close("all")


def test_points_at_numbers_that_are_not_finite_have_no_place() -> None:
    """An empty cell of a table is nan, along which nothing can be drawn."""
    loads = [300.0, np.nan, 385.0, np.inf]
    plane = dm.sweep(dm.steady_sliding, CASE, N=[300.0, 350.0, 385.0, 400.0], Omega=[10.0, 12.0])
    # which a sweep refuses, and a file of another program may have
    plane = plane.assign_coords(N=loads)
    ax = dm.plot_sweep(plane.sel(Omega=10.0), "growth_rate")
    np.testing.assert_array_equal(ax.lines[0].get_xdata(), [300.0, 385.0])
    mesh = as_map(plane, "growth_rate").collections[0]
    assert mesh.get_array().size == 4
    pairs = dm.sweep(dm.steady_sliding, CASE, zip={"N": loads, "Omega": [9.0, 10, 11, 12]})
    as_map(pairs, "growth_rate").figure.draw_without_rendering()
    pyplot.close("all")


def test_what_cannot_be_drawn_says_how_it_can() -> None:
    with refusal("study='a single point': must have two points"):
        dm.plot_sweep(dm.sweep(rate, CASE))
    spectra = dm.sweep(lambda case: {"line": np.arange(3) * case.N}, CASE, N=LOADS)
    twice = spectra.assign(line=spectra["line"].expand_dims(channel=2))
    with refusal(r"by study.isel\(\w+=0\)$"):
        dm.plot_sweep(twice, "line")
    dm.plot_sweep(twice.isel(line_index=1, channel=0), "line")
    pyplot.close("all")


def test_points_without_a_cycle_are_not_unstable_ones() -> None:
    """They were drawn as "no", as if a cycle were unstable."""
    stable = dm.sweep(dm.floquet, CASE, Omega=[10, 12], N=[300, 385])
    assert stable["status"].sel(Omega=12, N=300) == "no_cycle"
    ax = as_map(stable, "stable")
    [legend] = ax.figure.legends
    assert "no cycle found" in [text.get_text() for text in legend.get_texts()]
    line = as_map(stable.sel(N=300), "stable")
    assert [text.get_text() for text in line.texts] == ["no cycle found"]
    pyplot.close("all")


def test_a_line_of_small_rates_is_open_between_two_cycles() -> None:
    """It was joined through zero: from one cycle to another, at 385 N and mu_k = 0.15."""
    rates = np.array([-0.0011, -0.0042, -0.0138, -0.0406, 0.0393, 0.0121, 0.0058])
    assert np.flatnonzero(rate_scale.opens(rates)).tolist() == [3]
    assert not rate_scale.opens(np.abs(rates[:4])).any()
    peak = np.array([0.01, 0.03, 0.06, 0.03, 0.01])
    assert not rate_scale.opens(peak).any()
    assert rate_scale.opens(rates[:1]).size == 0


def test_complex_numbers_are_not_drawn_by_their_real_part() -> None:
    found = dm.sweep(lambda case: {"z": 1j * case.Omega, "size": case.Omega}, CASE, Omega=[10, 14])
    with refusal("variable='z': is complex: draw a part of it, as by study.assign"):
        dm.plot_sweep(found, "z")
    assert dm.plot_sweep(found).get_ylabel() == "Size"


def test_limits_end_the_axis_of_lines_and_the_colours_of_maps() -> None:
    grid = dm.sweep(dm.steady_sliding, CASE, Omega=[10, 20, 40], N=[300, 400])
    bar = as_map(grid, limits=(0, 2)).collections[0].norm
    assert (bar.vmin, bar.vmax) == (0, 2)
    line = as_map(grid.sel(N=300), limits=(-0.5, 2))
    assert line.get_ylim() == (-0.5, 2)
    for wrong in ((3, 1), 2, ("a", "b"), (0, np.inf)):
        with refusal("limits=.*must be two ascending numbers"):
            as_map(grid, limits=wrong)


def test_counts_and_verdicts_of_a_point_without_a_cycle_are_missing() -> None:
    """Its sticks were 0."""
    found = dm.sweep(dm.floquet, dm.Parameters(N=385, Omega=15), Omega=[15, 15.5])
    assert found["status"].values.tolist() == ["ok", "no_cycle"]
    for name in ("sticks", "releases", "stable"):
        assert found[name].values.tolist() == pytest.approx([1, np.nan], nan_ok=True)
        assert said_above(dm.plot_sweep(found, name)) == ["no cycle found"]
    assert found["stable"].attrs["comment"].startswith("1 for True")
    pyplot.close("all")


def test_zeros_alone_have_a_logarithmic_picture() -> None:
    """They ended in an error of numpy."""
    found = dm.sweep(dm.floquet, CASE, Omega=[10, 12])
    ax = dm.plot_sweep(found, "separations", log=True)
    assert ax.get_yticks().tolist() == [0]


def test_growth_rates_have_a_linear_scale_on_request() -> None:
    rates = xr.DataArray(
        [[-3.0, 0.1], [0.2, 5.0]], {"N": [1.0, 2], "Omega": [1.0, 2]}, name="growth_rate"
    )
    study = rates.to_dataset()
    assert as_map(study.isel(N=0)).get_yscale() == "symlog"
    assert as_map(study.isel(N=0), log=False).get_yscale() == "linear"
    [norm] = [each.norm for each in as_map(study, log=False).collections if each.norm]
    assert type(norm).__name__ == "Normalize"
    assert (norm.vmin, norm.vmax) == (-5, 5)


@pytest.mark.parametrize("name", ["a", "E", "Omega", "mu_k_over_mu_s"])
def test_own_results_with_names_of_parameters_are_no_parameters(name: str) -> None:
    """A number "a" was drawn as the inner radius, in mm."""
    found = dm.sweep(lambda case: {name: 2 * case.N}, CASE, N=LOADS)
    ax = dm.plot_sweep(found, name)
    assert ax.get_ylabel() == name
    assert ax.lines[0].get_ydata().tolist() == [600.0, 770.0]
    pyplot.close("all")


def test_kinds_of_cycles_are_named_by_words() -> None:
    """They were "stick_slip" and "slipping"."""
    rates = xr.DataArray(np.ones((2, 2)), dims=("kind", "N"), name="growth_rate")
    study = rates.to_dataset().assign_coords(kind=["stick_slip", "slipping"], N=LOADS)
    ax = dm.plot_sweep(study, "growth_rate")
    assert labels(ax.figure) == ["stick-slip cycle", "cycle that never sticks"]
    pyplot.close("all")


def test_infinite_values_are_marked_above_the_panel() -> None:
    """They had no mark, and the axis ended before them."""
    study = xr.Dataset({"size": ("N", [1.0, 2.0, np.inf])}, {"N": [*LOADS, 400.0]})
    ax = dm.plot_sweep(study, "size")
    [row] = rows_above(ax)
    assert row.words.get_text() == "infinite"
    assert row.rows[0].get_xdata().tolist() == [400.0]
    pyplot.close("all")
