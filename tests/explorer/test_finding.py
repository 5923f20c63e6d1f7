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


def test_a_table_has_all_digits_of_stored_numbers(opened: Open) -> None:
    """It had five digits, those that the page shows."""
    stated = Stated(call={"headlines": ["critical_speed"]})
    with opened([contents_of("speeds", speeds(), stated=stated)]) as shown:
        _, *rows = shown.page.run("return csv()").split("\n")
    numbers = [np.float32(row.split(",")[-1]) for row in rows]
    np.testing.assert_array_equal(numbers, speeds()["critical_speed"].values.astype(np.float32))
