"""The explorer in a real browser, as wide as a screen and as narrow as a telephone."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from disc_model.explorer.page import LEVELS, WORDS, Picture, page
from tests import needs
from tests.explorer import made_up
from tests.workflow.browser import Page, browser

pytestmark = [pytest.mark.slow, needs.BROWSER.mark]

SIZES = {"wide": (1400, 1000), "narrow": (360, 740)}
SEEN = Path(__file__).with_name("seen.js").read_text(encoding="utf-8")
READY = "return document.getElementById('grids').ariaBusy === 'false'"


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("explorer")
    Image.new("RGB", (1200, 500), "#0072B2").save(folder / "one.png")
    Image.new("RGB", (1200, 900), "#D55E00").save(folder / "two.png")
    pictures = [Picture("Figures", name, f"The caption of {name}.", folder / f"{name}.png") for name in ("one", "two")]
    (folder / "explorer.html").write_text(page("Made up", made_up.contents()[::-1], pictures), encoding="utf-8")
    return folder / "explorer.html"


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    with browser(tmp_path_factory.mktemp("profile")) as opened:
        yield opened


@pytest.fixture(params=SIZES)
def shown(request: pytest.FixtureRequest, session: Page, file: Path) -> Iterator[Page]:
    """The page, opened anew; the console stays clean."""
    session.resize(*SIZES[request.param])
    session.prefer("light")
    session.open(file)
    session.wait_for(READY)
    yield session
    assert [message for message in session.messages() if message["level"] == "SEVERE"] == []


def text(shown: Page, id_: str) -> str:
    found: str = shown.run("return document.getElementById(arguments[0]).innerText", id_)
    return found


def ask(shown: Page, what: str, *arguments: object) -> Any:
    """What a function of seen.js finds."""
    return shown.run(f"{SEEN}\nreturn seen.{what}(...arguments);", *arguments)


def choose(shown: Page, label: str, option: str) -> None:
    ask(shown, "choose", label, option)
    shown.wait_for(READY)


def options(shown: Page, label: str) -> list[str]:
    found: list[str] = ask(shown, "options", label)
    return found


def centre(shown: Page, i: int, j: int) -> tuple[float, float]:
    """The middle of a cell, in the window; the map is brought into view."""
    x, y = ask(shown, "centre", i, j)
    return x, y


def colour(shown: Page, i: int, j: int) -> str:
    """The colour a little below and left of a cell's middle, where no ring and no dot is."""
    red, green, blue = ask(shown, "colour", i, j)
    return f"#{red:02x}{green:02x}{blue:02x}"


def test_it_fits_the_window_and_needs_no_network(shown: Page) -> None:
    assert shown.run("return document.documentElement.scrollWidth <= window.innerWidth")
    loaded = shown.run("return performance.getEntriesByType('resource').map(x => x.name)")
    assert [name for name in loaded if not name.startswith("data:")] == []
    # small type of books, in CSS pixels
    assert min(ask(shown, "sizesOfType", "p, li, td, th, label, select, button, figcaption")) >= 12


def test_every_choice_draws_something(shown: Page) -> None:
    drawn = set()
    for study in options(shown, "Study"):
        choose(shown, "Study", study)
        for across in options(shown, "Across"):
            choose(shown, "Across", across)
            for up in options(shown, "Up"):
                choose(shown, "Up", up)
                for variable in options(shown, "Variable"):
                    choose(shown, "Variable", variable)
                    drawn.add((study, across, up, variable))
                    assert ask(shown, "colours") > 4, (study, across, up, variable)
    # a variable without one of the two dimensions is not among those of the plane
    assert {("plane", "Omega", "N", "releases"), ("line", "N_Omega", "", "period")} <= drawn
    assert ("plane", "Omega", "normalization", "releases") not in drawn
    choose(shown, "Study", "line")
    assert text(shown, "motion-note").startswith("Of this quantity")


def test_pointing_says_the_value_of_what_is_chosen(shown: Page) -> None:
    study, seen = made_up.plane(), set()
    for norm in range(2):
        choose(shown, "normalization", str(norm))
        seen.add(colour(shown, 3, 1))
        for i, j in ((0, 0), (3, 1)):
            shown.point(*centre(shown, i, j))
            value = float(study["growth_rate"].isel(Omega=i, N=j, normalization=norm))
            phrase = text(shown, "hovered")
            assert f"Omega = {study['Omega'].values[i]:g} rad s⁻¹" in phrase
            assert f"growth_rate {value:.5g} s⁻¹".replace("-", "−") in phrase
    assert "orthonormal" in text(shown, "map-title")
    assert len(seen) == 2
    assert text(shown, "motion-note").startswith("No motion is stored")
    choose(shown, "Variable", "outcome")
    assert colour(shown, 0, 0) == WORDS["quiet"].lower()
    shown.run("document.getElementById('fixed').parentElement.open = true")
    assert text(shown, "fixed").endswith("50000 N m⁻¹")


def test_a_point_that_failed_says_so(shown: Page) -> None:
    shown.point(*centre(shown, made_up.FAILED["Omega"], made_up.FAILED["N"]), click=True)
    assert text(shown, "message") == f"failed: {made_up.MESSAGE}"
    assert "no result" in text(shown, "legend")
    assert "failed" in text(shown, "values")
    shown.point(*centre(shown, 0, 0), click=True)
    assert text(shown, "message") == ""


def test_a_point_is_a_case_of_the_package_and_has_an_address(shown: Page) -> None:
    shown.point(*centre(shown, 3, 1), click=True)
    case, address = text(shown, "call"), shown.run("return document.getElementById('link').getAttribute('href')")
    assert case.startswith("dm.Parameters(k=50000, ")
    assert f"Omega={made_up.plane()['Omega'].values[3]:g}" in case
    shown.point(*centre(shown, 0, 0), click=True)
    assert text(shown, "call") != case
    shown.run("location.hash = arguments[0]", address)
    shown.wait_for(f"return document.getElementById('link').getAttribute('href') === '{address}'")
    assert text(shown, "call") == case
    assert shown.run("return csv().split('\\n')[0]") == "Omega (rad s⁻¹),N (N),growth_rate (s⁻¹)"


def test_a_click_shows_the_motion(shown: Page) -> None:
    def history() -> np.ndarray:
        return np.array(shown.run("return motionDrawn && [...motionDrawn.histories[0]]"))

    shown.point(*centre(shown, 0, 0), click=True)
    assert text(shown, "motion-note") == "At this point. After the transient."
    expected = made_up.force(100.0)
    # half a step of 16 bits, and rounding to float
    np.testing.assert_allclose(history(), expected, atol=np.ptp(expected) / LEVELS / 2 + 1e-4)
    assert text(shown, "phases").split() == ["stick", "slip", "separation"]
    # of a point without one of its own, the nearest of the same outcome: once the other one is nearer
    nearest = [(2, 2, "separation", 385, 20), (2, 1, "separation", 385, 20), (3, 0, "quiet", 100, 5)]
    for i, j, outcome, N, Omega in nearest:
        shown.point(*centre(shown, i, j), click=True)
        assert text(shown, "motion-note").startswith(
            f"Nearest stored motion of the same outcome, {outcome}, at N = {N} N, Omega = {Omega} rad s⁻¹, "
            "as_published (ring in the map)."
        )
    shown.point(*centre(shown, 2, 2), click=True)
    np.testing.assert_allclose(history().mean(), made_up.force(385.0).mean(), rtol=1e-4)
    shown.point(*ask(shown, "beginning"))
    assert text(shown, "motion-hovered").startswith("0 ms, P 385 N, u −0.0088 m, psi 0 rad")


def test_text_is_readable_in_light_and_dark(session: Page, file: Path) -> None:
    for scheme in ("light", "dark"):
        session.prefer(scheme)
        session.open(file)
        assert session.contrast("p, li, td, th, label, select, button, figcaption, a, h1") >= 4.5, scheme
        back = session.run("return getComputedStyle(document.body).backgroundColor")
        assert (back == "rgb(255, 255, 255)") == (scheme == "light")
