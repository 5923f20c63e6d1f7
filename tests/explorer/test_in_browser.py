"""A trip through the explorer in a real browser, as wide as a screen and as narrow as a
telephone."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from PIL import Image

import disc_model as dm
from disc_model.explorer import LEVELS, Picture, Stated, page
from disc_model.explorer import study_contents as contents_of
from disc_model.figures.classes import LOOKS, STABLE, UNRESOLVED, lightness
from tests import needs
from tests.explorer.test_page import FAILED, MESSAGE, WITHOUT_CYCLE, contents, force, motions, plane
from tests.workflow.browser import Page, browser

pytestmark = [pytest.mark.slow, needs.BROWSER.mark]

SEEN = Path(__file__).with_name("seen.js").read_text(encoding="utf-8")
READY = "return document.getElementById('grids').ariaBusy === 'false'"
READABLE = "p, li, td, th, label, select, button, figcaption"


class Explorer:
    """The opened page."""

    def __init__(self, opened: Page) -> None:
        self.page = opened

    def text(self, id_: str) -> str:
        return str(self.page.run("return document.getElementById(arguments[0]).innerText", id_))

    def ask(self, what: str, *arguments: object) -> Any:
        """What a function of seen.js finds."""
        return self.page.run(f"{SEEN}\nreturn seen.{what}(...arguments);", *arguments)

    def choose(self, label: str, option: str) -> None:
        self.ask("choose", label, option)
        self.page.wait_for(READY)

    def point(self, i: int, j: int, *, click: bool = False) -> None:
        """At the middle of a cell of the map."""
        self.page.point(*self.ask("centre", i, j), click=click)

    def history(self) -> np.ndarray:
        """The contact force that is drawn."""
        return np.array(self.page.run("return motionDrawn && [...motionDrawn.histories[0]]"))


@pytest.mark.parametrize("size", [(1400, 1000), (360, 740)], ids=["wide", "narrow"])
def test_a_trip_through_the_page(size: tuple[int, int], tmp_path: Path) -> None:
    one_path = tmp_path / "one.png"
    Image.new("RGB", (1200, 500), "#0072B2").save(one_path)
    pictures = [Picture("Figures", "one", "A caption.", one_path)]
    explorer_path = tmp_path / "explorer.html"
    explorer_path.write_text(page("Made up", contents()[::-1], pictures), encoding="utf-8")
    profile_path = tmp_path / "profile"
    with browser(profile_path) as opened:
        opened.resize(*size)
        for scheme in ("dark", "light"):
            opened.prefer(scheme)
            opened.open(explorer_path)
            opened.wait_for(READY)
            # what guidelines for accessible pages ask for
            assert opened.contrast(f"{READABLE}, a, h1") >= 4.5, scheme
        shown = Explorer(opened)
        fits(shown)
        draws_every_choice(shown)
        tells_of_points(shown)
        shows_motions(shown)
        assert [message for message in opened.messages() if message["level"] == "SEVERE"] == []


def test_its_maps_have_the_marks_of_figures(tmp_path: Path) -> None:
    """There were neither the dots of "stable" nor the hatching of "unresolved"."""
    study = plane()
    alone = (0, 1, 0)
    study["outcome"].values[alone] = 0  # separates, unlike the cells around it
    study.attrs["title"] = "What becomes of the motion, over speed and preload"
    explorer_path = tmp_path / "explorer.html"
    told = [
        contents_of("without", plane(), stated=Stated(has_figures=False)),
        contents_of("plane", study),
    ]
    explorer_path.write_text(page("Made up", told, []), encoding="utf-8")
    with browser(tmp_path / "profile") as opened:
        opened.resize(1280, 1000)
        opened.open(explorer_path)
        opened.wait_for(READY)
        shown = Explorer(opened)
        assert opened.run("return view.study.name") == "plane", "the first one with figures"

        # marks lie over the colours of their cells
        assert STABLE.label in shown.text("legend").split("\n")
        white_dots = shown.ask("coloursOf", 0, 0)
        assert is_light(white_dots)
        assert shown.ask("colourOf", float(study["growth_rate"][0, 0, 0])) in white_dots
        assert not is_light(shown.ask("coloursOf", 3, 2)), "its disturbances grow"
        shown.choose("Variable", "outcome")
        assert UNRESOLVED.label in shown.text("legend").split("\n")
        N, Omega, _ = alone
        hatched = shown.ask("coloursOf", Omega, N)
        assert LOOKS["separation"].face in hatched
        assert is_light(hatched)
        assert shown.ask("coloursOf", 3, 0) == [LOOKS["quiet"].face]

        # what is chosen for marks stays
        shown.choose("Marks", "growth_rate=stable")
        assert shown.text("legend").endswith(STABLE.label)
        shown.choose("Up", "normalization")
        assert opened.run("return document.getElementById('controls').Marks.value") == (
            "growth_rate=stable"
        )

        # a narrow selector has the whole text below it
        assert shown.ask("below") == []
        opened.resize(360, 740)
        shown.choose("Up", "normalization")
        assert any(text.endswith("speed and preload") for text in shown.ask("below"))
        assert opened.run("return document.documentElement.scrollWidth <= window.innerWidth")


def test_a_point_without_a_cycle_shows_no_motion_of_others(tmp_path: Path) -> None:
    """A click on "no cycle found" showed a neighbour's cycle, which grows or decays."""
    study = plane().drop_vars(["outcome", "message"])
    explorer_path = tmp_path / "explorer.html"
    stated = Stated("The cycle.", axes=("N", "Omega"), variable="releases")
    told = [contents_of("cycles", study, motions(), stated)]
    explorer_path.write_text(page("Made up", told, []), encoding="utf-8")
    with browser(tmp_path / "profile") as opened:
        opened.open(explorer_path)
        opened.wait_for(READY)
        shown = Explorer(opened)
        figure = ["N", "Omega", "releases"]
        assert opened.run("return [view.x, view.y, view.variable.name]") == figure
        shown.choose("Variable", "growth_rate")
        hidden = "return document.getElementById('motion').hidden"
        shown.point(WITHOUT_CYCLE["N"], WITHOUT_CYCLE["Omega"], click=True)
        assert shown.text("motion-note") == "No motion of this kind is stored: no cycle found."
        assert opened.run(hidden)
        assert opened.run("return nearestMotion()") is None, "and no ring in the map"
        # the call makes a picture of the motion
        call = shown.text("motion-call")
        assert call == "dm.simulate(dm.Parameters(m=0.2, N=200, Omega=10, normalization=" + (
            '"as_published"), 60).plot()'
        )
        assert len(eval(call, {"dm": dm})) == 3
        # a disc is not written twice
        disc = [{"name": "disc", "value": {"omega": [100.5] * 100}, "usual": False}]
        long = "return simulation({...view.study, ...arguments[0]}, view.place, view.variable)"
        call = {**view_call(), "columns": ["growth_rate"]}
        known = {"fixed": disc, "call": call}
        assert opened.run(long, known) == "dm.simulate(case, 60).plot()"
        # a stable cycle stands for another one, and not for one that grows
        for place, kind, N in (((0, 2), "stable", 100), ((1, 3), "unstable", 385)):
            shown.point(*place, click=True)
            said = f"Nearest stored motion of the same kind, {kind}, at N = {N} N"
            assert shown.text("motion-note").startswith(said)
            assert not opened.run(hidden)


def test_a_motion_is_shown_beyond_its_first_separation(tmp_path: Path) -> None:
    """A motion that separates at 130 s had a call of 60 s, whose picture keeps contact."""
    times = ("N", [130.01, 12.0, np.nan], {"units": "s"})
    axes = {"N": [340.0, 360.0, 380.0]}
    study = xr.Dataset({"first_separation": times}, axes, {"base": json.dumps({"Omega": 36})})
    explorer_path = tmp_path / "explorer.html"
    explorer_path.write_text(page("Made up", [contents_of("s", study)], []), encoding="utf-8")
    calls = []
    with browser(tmp_path / "profile") as opened:
        opened.open(explorer_path)
        opened.wait_for(READY)
        for i in range(3):
            opened.run("choose({N: arguments[0]})", i)
            calls.append(Explorer(opened).text("motion-call"))
    ends = [call.split("), ")[1] for call in calls]
    assert ends == ["150).plot()", "60).plot()", "60).plot()"]


def view_call() -> dict[str, Any]:
    """A call of a study that gives all variables of `columns`."""
    return {"quantity": "floquet", "options": {}, "recipes": [], "begins": {}, "along": {}}


def is_light(colours: list[str]) -> bool:
    """Whether some are white but for smooth edges: marks on dark cells."""
    return any(lightness(colour) > 0.8 for colour in colours)


def started_study() -> xr.Dataset:
    """Points that start from the state of another case, each with a kick of its own."""
    options = {
        "prerun": {"parameters": {"Omega": 15.1}, "time": 2.0},
        "perturbation": {"u_velocity": 0.5},
    }
    attrs = {"base": json.dumps({"N": 385, "Omega": 13}), "options": json.dumps(options)}
    kicks = {"perturbation_u": [0.0, -2.75e-3]}
    return xr.Dataset({"u_max": ("perturbation_u", [0.0, 1.0])}, kicks, attrs)


def test_the_motion_of_a_point_begins_at_its_start(tmp_path: Path) -> None:
    """All points had the call of the motion from the static start, which may come to something else."""
    started = started_study()
    base = {"base": started.attrs["base"]}
    options = {"prerun": None, "perturbation": {"u": 1e-4}}
    attrs = {**base, "options": json.dumps(options)}
    alike = xr.Dataset({"u_max": ("c_p", [1.0, 2.0])}, {"c_p": [0.0, 0.02]}, attrs)
    static = xr.Dataset({"u_max": ("c_p", [1.0, 2.0])}, {"c_p": [0.0, 0.02]}, base)
    explorer_path = tmp_path / "explorer.html"
    every = {"started": started, "alike": alike, "static": static}
    told = [contents_of(name, study) for name, study in every.items()]
    explorer_path.write_text(page("Made up", told, []), encoding="utf-8")
    case = "dm.Parameters(N=385, Omega=13)"
    begun = f"case = {case}\nstart = dm.initial_state(case, "
    drawn = "dm.simulate(case, 60, initial_state=start).plot()"
    after = 'prerun={"parameters": {"Omega": 15.1}, "time": 2}'
    expected = (
        f'{begun}{{"u_velocity": 0.5}}, {after})\n{drawn}',
        f'{begun}{{"u_velocity": 0.5, "u": -0.00275}}, {after})\n{drawn}',
    )
    parts = ("call", "motion-says", "motion-call")
    with browser(tmp_path / "profile") as opened:
        opened.open(explorer_path)
        opened.wait_for(READY)
        shown = Explorer(opened)
        calls = []
        for kick in range(2):
            opened.run("choose({perturbation_u: arguments[0]})", kick)
            calls.append([shown.text(x) for x in parts])
        shown.choose("Study", "alike")
        assert 'start = dm.initial_state(case, {"u": 0.0001})' in shown.text("motion-call")
        shown.choose("Study", "static")
        opened.run("choose({c_p: arguments[0]})", 0)
        at_rest = [shown.text(x) for x in parts]
    for said, text in zip(calls, expected, strict=True):
        assert said[0] == case
        assert said[2] == text
    assert at_rest[1:] == [
        "The motion of this case from the static start:",
        f"dm.simulate({case}, 60).plot()",
    ]

    _, says, motion = calls[1]
    assert says == "The motion of this case from its start:"
    names: dict[str, Any] = {"dm": dm}
    *before_run, simulated = motion.split("\n")
    exec("\n".join(before_run), names)
    run = eval(simulated.removesuffix(".plot()").replace("60", "0.01"), names)
    start = names["start"]
    before = dm.simulate(names["case"].replace(Omega=15.1), 2).final_state
    # the kick is added to a height of some 9 mm, whose rounding is 1e-18 m
    assert start.u - before.u == pytest.approx(-2.75e-3, abs=1e-15)
    assert run.status.complete


def fits(shown: Explorer) -> None:
    """It fits the window and needs no network."""
    assert shown.page.run("return document.documentElement.scrollWidth <= window.innerWidth")
    loaded = shown.page.run("return performance.getEntriesByType('resource').map(x => x.name)")
    assert [name for name in loaded if not name.startswith("data:")] == []
    assert shown.ask("titleFits"), "the title of the colour bar was cut on telephones"
    assert shown.ask("untitled") == []
    # small type of books, in CSS pixels
    assert min(shown.ask("sizesOfType", READABLE)) >= 12


def draws_every_choice(shown: Explorer) -> None:
    axes = "Object.assign(view, {x: arguments[0], y: arguments[1]}); chooseAxes(); update();"
    drawn = set()
    for study in shown.ask("options", "Study"):
        shown.choose("Study", study)
        for across in shown.ask("options", "Across"):
            shown.choose("Across", across)
            for up in shown.ask("options", "Up"):
                for variable in shown.ask("options", "Variable"):
                    shown.page.run(axes, across, up)
                    shown.choose("Variable", variable)
                    seen = shown.page.run("return [view.x, view.y, view.variable.name]")
                    assert seen[-1] == variable, "all variables can be chosen"
                    drawn.add((study, *seen))
                    assert shown.ask("colours") > 4, (study, *seen)
    # one without one of the two dimensions has other axes
    assert {("plane", "Omega", "N", "releases"), ("line", "N_Omega", "", "period")} <= drawn
    assert ("plane", "Omega", "normalization", "releases") not in drawn


def tells_of_points(shown: Explorer) -> None:
    """Values, messages, the case as a call of the package, an address, and a table."""
    study = plane()
    seen = set()
    for label, option in {
        "Study": "plane",
        "Across": "Omega",
        "Up": "N",
        "Variable": "growth_rate",
    }.items():
        shown.choose(label, option)
    for norm in range(2):
        shown.choose("normalization", str(norm))
        seen.add(tuple(shown.ask("colour", 3, 1)))
        for i, j in ((0, 0), (3, 1)):
            shown.point(i, j)
            value = float(study["growth_rate"].isel(Omega=i, N=j, normalization=norm))
            phrase = shown.text("hovered")
            assert f"Ω = {study['Omega'].values[i]:g} rad/s" in phrase
            assert f"Growth rate: {value:.5g} 1/s".replace("-", "−") in phrase
    assert len(seen) == 2
    assert shown.text("motion-note").startswith("No motion is stored")
    shown.choose("normalization", "0")
    shown.point(FAILED["Omega"], FAILED["N"], click=True)
    assert shown.text("message") == f"failed: {MESSAGE}"
    assert "cycle nearby, not followed" in shown.text("legend")
    shown.point(3, 1, click=True)
    assert shown.text("message") == ""
    case = shown.text("call")
    link = "return document.getElementById('link').getAttribute('href')"
    assert case.startswith("dm.Parameters(m=0.2, N="), "without what a case has anyway"
    assert f"Omega={study['Omega'].values[3]:g}" in case
    address = shown.page.run(link)
    shown.point(0, 0, click=True)
    assert shown.text("call") != case
    shown.page.run("location.hash = arguments[0]", address)
    shown.page.wait_for(f"{link} === '{address}'")
    assert shown.text("call") == case
    heads, first = shown.page.run("return csv().split('\\n').slice(0, 2)")
    assert heads == "Omega (rad/s),N (N),normalization,growth_rate (1/s)"
    assert first == "5,100,as_published,-0.2"
    shown.choose("Variable", "outcome")
    red, green, blue = shown.ask("colour", 0, 0)
    assert f"#{red:02x}{green:02x}{blue:02x}" == LOOKS["quiet"].face


def shows_motions(shown: Explorer) -> None:
    """Of the point that is clicked; without one of its own, the nearest of the same outcome."""
    shown.point(0, 0, click=True)
    assert shown.text("motion-note") == "At this point. After the transient."
    expected = force(100.0)
    # half a step of 16 bits, and rounding to float
    drawn = shown.history()
    step = np.ptp(expected) / LEVELS
    tolerance = step / 2 + 1e-4
    np.testing.assert_allclose(drawn, expected, atol=tolerance)
    assert shown.text("phases").split() == ["stick", "slip", "separation"]
    for i, j, outcome, N, Omega in [(3, 0, "quiet", 100, 5), (2, 1, "separation", 385, 20)]:
        shown.point(i, j, click=True)
        near = (
            f"Nearest stored motion of the same kind, {outcome}, at N = {N} N, Ω = {Omega} rad/s, "
        )
        assert shown.text("motion-note").startswith(f"{near}modes as published (ring in the map).")
    # a motion of another slice has no place in this one
    same, other = shown.page.run(
        "const shownAxes = [view.x, view.y];"
        "const third = view.study.dims.find((dim) => !shownAxes.includes(dim.name)).name;"
        "const places = {...motionPlaces(view.study, nearestMotion())};"
        "places[third] = 1 - places[third];"
        "return [isInMap(nearestMotion()), isInMap({places})];"
    )
    assert (same, other) == (True, False)
    shown.page.point(*shown.ask("beginning"))
    assert shown.text("motion-hovered").startswith(
        "0 ms, Contact force P 385 N, Slider u −8.8 mm from the undeformed disc, Angle ψ 0 rad"
    )
