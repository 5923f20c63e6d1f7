"""How a reader finds a study and a point in the explorer, and reads what is drawn there."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from PIL import Image

from disc_model.explorer import Picture, Stated, page
from disc_model.explorer import study_contents as contents_of
from disc_model.studies.run import describe
from tests import needs
from tests.explorer.test_in_browser import READY, Explorer
from tests.explorer.test_page import FAILED, flagged, plane
from tests.workflow.browser import browser

pytestmark = [pytest.mark.slow, needs.BROWSER.mark]

Open = Callable[..., Any]


@pytest.fixture
def opened(tmp_path: Path) -> Callable[..., Any]:
    """Opens the page of some studies."""

    @contextmanager
    def open_(
        told: list[dict[str, Any]], size: tuple[int, int] = (1280, 800)
    ) -> Iterator[Explorer]:
        picture = tmp_path / "one.png"
        Image.new("RGB", (1200, 500), "#0072B2").save(picture)
        path = tmp_path / "explorer.html"
        pictures = [Picture("Section", "One", "A caption.", picture)]
        path.write_text(page("Made up", told, pictures), encoding="utf-8")
        with browser(tmp_path / "profile") as shown:
            shown.resize(*size)
            shown.open(path)
            shown.wait_for(READY)
            yield Explorer(shown)

    return open_


def modes() -> xr.Dataset:
    """A larger study than the plane, of which no growth rate is over two numbers of the grid: of the
    quantity's modes along the speed."""
    speeds = np.linspace(1, 40, 40)
    data = {
        "status": ("Omega", np.zeros(40, np.int8), flagged("ok failed")),
        "growth_rate": ("Omega", np.ones(40), {"long_name": "growth rate", "units": "s-1"}),
        "mode_kind": (["Omega", "mode"], np.ones((40, 9), np.int8), flagged("none disc")),
    }
    coords = {"Omega": ("Omega", speeds, describe("Omega")), "mode": np.arange(9.0)}
    return xr.Dataset(data, coords, {"title": "Modes"})


def limits() -> xr.Dataset:
    """A study of which no figure names axes: critical speeds over the preload, for two horizons, and
    numbers along its branches."""
    loads = np.linspace(100, 400, 7)
    data = {
        "status": ("N", np.zeros(7, np.int8), flagged("ok failed")),
        "settled": (["N", "horizon"], np.ones((7, 2), np.int8), flagged("no yes")),
        "critical_speed": (["N", "horizon"], np.ones((7, 2)), {"long_name": "critical speed"}),
        "point_range": (["branch_point"], np.ones(20), {"long_name": "range"}),
    }
    points = ("branch_point", np.arange(20.0), {"long_name": "number of the point"})
    coords = {"N": ("N", loads, describe("N")), "horizon": [200.0, 500.0], "branch_point": points}
    return xr.Dataset(data, coords, {"title": "Limits"})


def test_a_study_without_a_figure_opens_on_a_curve_of_numbers_over_its_grid(opened: Open) -> None:
    """It opened on a map of two rows, the horizons, and on a flag."""
    with opened([contents_of("limits", limits())]) as shown:
        seen = shown.page.run("return [view.x, view.y, view.variable.name]")
    assert seen == ["N", "", "critical_speed"]


def test_it_opens_on_the_largest_map_of_growth_rates_or_outcomes(opened: Open) -> None:
    """It opened on two bands of colour, the kinds of modes along the speed."""
    outcomes = plane().drop_vars("growth_rate").isel(Omega=slice(2))
    told = [
        contents_of("modes", modes()),
        contents_of("outcomes", outcomes),
        contents_of("plane", plane(), stated=Stated(has_figures=False)),
    ]
    with opened(told) as shown:
        assert shown.page.run("return view.study.name") == "outcomes"
    with opened([*told, contents_of("larger", plane())]) as shown:
        assert shown.page.run("return [view.study.name, view.variable.name]") == [
            "larger",
            "growth_rate",
        ]


def test_results_of_points_that_failed_are_not_hatched(opened: Open) -> None:
    """Where the cycle was not found, the kind of a mode that is known was called "no result"."""
    study = plane()
    study["kind"] = study["outcome"].copy(data=np.ones(study["outcome"].shape, np.int8))
    study["kind"].attrs = flagged("none disc slider")
    with opened([contents_of("plane", study)]) as shown:
        shown.choose("Variable", "kind")
        cell = FAILED["Omega"], FAILED["N"]
        assert len(shown.ask("coloursOf", *cell)) == 1
        assert shown.text("legend") == "disc"
    study["kind"][tuple(FAILED.values())] = 0
    with opened([contents_of("plane", study)]) as shown:
        shown.choose("Variable", "kind")
        assert len(shown.ask("coloursOf", *cell)) > 1
        assert shown.text("legend").split("\n")[-1] == "no result: failed"
    study["status"].attrs = flagged("ok no_cycle")
    with opened([contents_of("plane", study)]) as shown:
        shown.choose("Variable", "kind")
        assert "no result" not in shown.text("legend"), "it was computed, and is none"


@pytest.mark.parametrize("most", [1, 2, 7, 250])
def test_counts_have_whole_ticks(opened: Open, most: int) -> None:
    """A bar of 0 to 2 unstable modes had the ticks 0.035 and 0.14."""
    counts = np.zeros((3, 4))
    counts[1, 1:] = [most, 1, 0]
    study = plane()
    study["releases"] = (["N", "Omega"], counts, study["releases"].attrs)
    with opened([contents_of("plane", study)]) as shown:
        shown.choose("Variable", "releases")
        ticks = shown.page.run(
            "return ['auto', 'linear', 'stretched'].map(colours => {"
            "view.colours = colours;"
            "const numbers = places().map(cell => value(view.study, view.variable, cell.place));"
            "return colouring(numbers, view.variable).ticks(600).map(([, x]) => x);})"
        )
        for shown_ticks in ticks:
            assert [shown_ticks[0], shown_ticks[-1]] == [0, most]
            assert all(x == round(x) for x in shown_ticks)
            assert shown_ticks == sorted({*shown_ticks})


def test_a_link_says_where_it_does_not_lead(opened: Open) -> None:
    """A link to N = 999 N showed the nearest point, or another value that does not vary, silently."""
    with opened([contents_of("plane", plane())]) as shown:
        for address, warning in {
            "study=plane&N=200": "",
            "study=plane&N=999": "The link's N = 999 is not in this study: the nearest point is shown.",
            "study=plane&k=50000": "",
            "study=plane&k=40000": "The link's k = 40000 is not that of this study, k = 50000.",
            "study=plane&mu=1": "The link's mu = 1 is not in this study.",
        }.items():
            shown.page.run("location.hash = arguments[0]", address)
            shown.page.wait_for("return location.hash === '#' + arguments[0]", address)
            shown.page.wait_for(
                "return document.getElementById('warning').textContent === arguments[0] || null",
                warning,
            )


def test_studies_are_found_by_words(opened: Open) -> None:
    """There were 45 in one list."""
    told = [contents_of(f"map_{i}", plane()) for i in range(9)]
    told += [contents_of("modes", modes(), stated=Stated(call={"quantity": "campbell"}))]
    search = (
        "const field = document.querySelector('#search input');"
        "field.value = arguments[0]; field.dispatchEvent(new Event('input'));"
    )
    with opened(told) as shown:
        assert shown.page.run("return document.querySelectorAll('#controls optgroup').length") == 2
        shown.page.run(search, "MODES camp")
        assert shown.ask("options", "Study") == ["modes", "map_0"], "the one that is shown stays"
        assert shown.text("search").startswith("Find a study: 1 of 10")
        shown.page.run(
            "const field = document.querySelector('#search input');"
            "field.dispatchEvent(new KeyboardEvent('keydown', {key: 'Enter'}))"
        )
        shown.page.wait_for("return view.study.name === 'modes'")
        shown.page.run(search, "nowhere")
        assert shown.text("search-says") == (
            "No study matches “nowhere”: modes is still shown, and the list has all studies."
        )
        assert len(shown.ask("options", "Study")) == 10
        shown.page.run(search, "")
        assert shown.text("search-says") == ""
        assert len(shown.ask("options", "Study")) == 10
    with opened(told[:2]) as shown:
        assert shown.page.run("return document.getElementById('search').hidden")


def test_figures_are_folded_on_a_telephone(opened: Open) -> None:
    """Forty screens of figures stood below the map."""
    is_open = "return document.querySelector('#figures details').open"
    with opened([contents_of("plane", plane())]) as shown:
        assert shown.page.run(is_open)
    with opened([contents_of("plane", plane())], (390, 844)) as shown:
        assert not shown.page.run(is_open)


def test_a_study_opens_on_a_variable_that_has_values(opened: Open) -> None:
    """Motions that never separate had empty maps of the phases of their releases."""
    study = modes().drop_vars("growth_rate")
    empty = np.full((40, 9), np.nan)
    phases = xr.DataArray(empty, dims=["Omega", "mode"], attrs={"units": "1"})
    motion = xr.DataArray(np.ones(40, np.int8), dims="Omega", attrs=flagged("undecided in_contact"))
    study = study.drop_vars("mode_kind").assign(phase=phases, motion=motion)
    with opened([contents_of("locking", study)]) as shown:
        assert shown.page.run("return [view.variable.name, view.x, view.y]") == [
            "motion",
            "Omega",
            "",
        ]


def speeds() -> xr.Dataset:
    """Critical speeds over the preload, of two scans each, and the outcomes of the scans."""
    loads = np.linspace(100, 400, 7)
    scanned = ("scan_Omega", np.linspace(5, 24, 20), describe("Omega"))
    counted = ("sample", np.arange(300), {"long_name": "number of the sample"})
    rates = np.linspace(-1, 1, 2100).reshape(7, 300)
    rates[2, 7:] = np.nan
    rates[3] = np.nan
    data = {
        "status": ("N", np.zeros(7, np.int8), flagged("ok failed")),
        "scan_outcome": (["N", "scan_Omega"], np.ones((7, 20), np.int8), flagged("quiet gone")),
        "critical_speed": ("N", np.linspace(12, 13, 7) / 3, {"long_name": "critical speed"}),
        "rate": (["N", "sample"], rates, {"long_name": "rate", "units": "s-1"}),
    }
    coords = {"N": ("N", loads, describe("N")), "scan_Omega": scanned, "sample": counted}
    return xr.Dataset(data, coords, {"title": "Speeds"})


def test_a_study_opens_on_what_it_is_about(opened: Open) -> None:
    """That of critical speeds opened on outcomes, and did not list the critical speed."""
    for headlines, seen in {
        ("gone", "critical_speed"): ["N", "", "critical_speed"],
        ("scan_outcome",): ["N", "scan_Omega", "scan_outcome"],
        ("rate",): ["N", "", "rate"],
    }.items():
        stated = Stated(call={"quantity": "critical_speed", "headlines": headlines})
        with opened([contents_of("speeds", speeds(), stated=stated)]) as shown:
            assert shown.page.run("return [view.x, view.y, view.variable.name]") == seen
            listed = shown.ask("options", "Variable")
        assert {*listed} == {*speeds().data_vars}, "all of them can be chosen"


def test_a_choice_that_changes_another_says_so(opened: Open) -> None:
    """Axes replaced the variable in silence, and a variable of other axes could not be chosen."""
    stated = Stated(call={"headlines": ["scan_outcome"]})
    axes = "return [view.x, view.y, view.variable.name]"
    with opened([contents_of("speeds", speeds(), stated=stated)]) as shown:
        assert shown.text("warning") == ""
        shown.choose("Variable", "critical_speed")
        assert shown.page.run(axes) == ["N", "", "critical_speed"]
        assert shown.text("warning") == (
            "“Critical speed for separation” does not vary with “Speed Ω”, so the axes have changed: "
            "across is now “Preload N”, up “none: a curve”."
        )
        shown.choose("Across", "scan_Omega")
        assert shown.page.run(axes) == ["scan_Omega", "", "scan_outcome"]
        assert shown.text("warning") == (
            "“Critical speed for separation” does not vary with “Speed Ω”: “Outcome” is shown instead."
        )
        shown.choose("Up", "sample")
        assert shown.page.run(axes) == ["scan_Omega", "", "scan_outcome"]
        assert shown.text("warning") == (
            "Nothing varies with both “Speed Ω” and “Number of the sample”: a curve is shown."
        )
        shown.choose("Variable", "scan_outcome")
        assert shown.text("warning") == ""
        follow = "return follow(arguments[0]).then(update)"
        shown.page.run(follow, "study=speeds&x=scan_Omega&y=N&variable=critical_speed")
        assert shown.page.run(axes) == ["N", "", "critical_speed"]
        assert "does not vary with “Speed Ω”" in shown.text("warning")


def test_all_samples_stand_as_points_above_their_parameter(opened: Open) -> None:
    """Their numbers were joined by a line along a count, which means nothing."""
    joined = "return isJoined()"
    with opened([contents_of("speeds", speeds())]) as shown:
        shown.choose("Variable", "rate")
        assert shown.page.run("return view.spread") == "sample"
        assert not shown.page.run(joined)
        assert "number of the sample" not in shown.text("map-title")
        assert shown.text("legend") == "no value", "where all samples have none"
        # a click is on the nearest point, and its table has all of them
        near = "const y = drawn.heights[1 * 300 + 40]; return nearestAcross(1, y + 0.001);"
        assert shown.page.run(near) == 40
        assert len(shown.page.run("return csv()").split("\n")) == 1 + 7 * 300
        shown.page.run("choose({...view.place, N: 1, sample: 40})")
        link = shown.ask("link")
        shown.choose("sample", "3")
        assert shown.page.run("return [view.spread, view.place.sample]") == ["", 3]
        assert shown.page.run(joined), "over the preload"
        shown.page.run("return follow(arguments[0]).then(update)", link.removeprefix("#"))
        assert shown.page.run("return [view.spread, view.place.sample]") == ["sample", 40]
        shown.choose("Across", "sample")
        assert not shown.page.run(joined), "along the samples"


def test_a_table_has_all_digits_of_stored_numbers(opened: Open) -> None:
    """It had five digits, those that the page shows."""
    stated = Stated(call={"headlines": ["critical_speed"]})
    with opened([contents_of("speeds", speeds(), stated=stated)]) as shown:
        _, *rows = shown.page.run("return csv()").split("\n")
    numbers = [np.float32(row.split(",")[-1]) for row in rows]
    np.testing.assert_array_equal(numbers, speeds()["critical_speed"].values.astype(np.float32))


def test_a_number_that_may_be_infinite_has_its_name(opened: Open) -> None:
    """The heading of a point ended with "inf"."""
    study = limits()[["settled"]].rename(N="friction_decay", horizon="n")
    decays = ("friction_decay", [0.5, 1, 2, 3, 4, 5, np.inf], describe("friction_decay"))
    with opened([contents_of("decays", study.assign_coords(friction_decay=decays))]) as shown:
        said = shown.page.run("return where({friction_decay: 6, n: 0})")
    assert said.startswith("d = inf s/m"), said


def test_a_study_opens_where_its_map_has_values(opened: Open) -> None:
    """That of a brake's mass opened on the disc's middle plane, where nothing grows: on one colour."""
    for nothing in (np.nan, 0.0):
        study = plane()
        study["growth_rate"].values[:, :, 0] = nothing
        with opened([contents_of("plane", study)]) as shown:
            assert shown.page.run("return view.place.normalization") == 1, nothing
            assert "orthonormal" in shown.text("map-title")


def test_powers_of_ten_are_factors(opened: Open) -> None:
    """A damping was "2.3333 10⁻⁵ N m s"."""
    with opened([contents_of("plane", plane())]) as shown:
        said = shown.page.run("return [withUnit('2.3', '10⁻⁵ N m s'), withUnit('2.3', 'N')]")
    assert said == ["2.3·10⁻⁵ N m s", "2.3 N"]


def test_the_chosen_value_is_told_after_a_change_of_axes(opened: Open) -> None:
    """The line below the map was blank until the next click, though the point was still marked."""
    with opened([contents_of("plane", plane())]) as shown:
        shown.page.run("choose({N: 2, Omega: 3, normalization: 0})")
        for label, option in {"Up": "normalization", "Across": "N", "Variable": "outcome"}.items():
            shown.choose(label, option)
            said = shown.text("hovered")
            assert "N = 385 N" in said or "Ω = 20 rad/s" in said, label
            assert shown.page.run("return view.variable.label") in said
        shown.point(0, 0)
        pointed = shown.text("hovered")
        shown.page.run("element('map').dispatchEvent(new Event('pointerleave'))")
        left = shown.text("hovered")
    assert "N = 100 N" in pointed
    assert "N = 385 N" in left, "the chosen point again"
