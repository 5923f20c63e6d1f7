"""A trip through the explorer in a real browser, as wide as a screen and as narrow as a
telephone."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from cmcrameri import cm
from matplotlib.colors import to_hex
from PIL import Image

import disc_model as dm
from disc_model.explorer import LEVELS, Picture, Stated, page
from disc_model.explorer import study_contents as contents_of
from disc_model.figures.classes import LOOKS, STABLE, UNRESOLVED, lightness
from disc_model.figures.colours import growth_colours, growth_norm
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


def test_it_opens_where_there_is_a_value(tmp_path: Path) -> None:
    """It opened on the middle of the map, and told of a point without one that it has none."""
    explorer_path = tmp_path / "explorer.html"
    explorer_path.write_text(page("Made up", [contents_of("plane", plane())], []), encoding="utf-8")
    with browser(tmp_path / "profile") as opened:
        opened.prefer("dark")
        opened.open(explorer_path)
        opened.wait_for(READY)
        shown = Explorer(opened)
        assert "no cycle" not in shown.text("point")
        # neither of the two points in the middle has a rate; the next are above and below
        assert re.search(r"N = (100|385) N, Ω = (10|15.1) rad/s", shown.text("point"))
        draws_gaps_and_scale(shown)
        moves_by_arrow_keys(shown)
        keeps_what_is_chosen_in_the_link(shown)
        follows_values_of_links(shown)
        names_selectors_as_axes(shown)
        names_classes_along_a_curve(shown)
        keeps_words_of_axes_inside(shown)
        draws_dots_on_curves(shown)


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


def test_map_bar_and_legend_are_seen_at_once(tmp_path: Path) -> None:
    """In a usual window the bar and the legend were below its edge."""
    explorer_path = tmp_path / "explorer.html"
    explorer_path.write_text(page("Made up", [contents_of("plane", plane())], []), encoding="utf-8")
    end_of = "return document.getElementById(arguments[0]).getBoundingClientRect().bottom"
    with browser(tmp_path / "profile") as opened:
        opened.resize(1280, 800)
        opened.open(explorer_path)
        opened.wait_for(READY)
        assert opened.run("return document.documentElement.scrollHeight > window.innerHeight")
        assert Explorer(opened).text("legend")
        for id_ in ("map", "legend"):
            assert opened.run(end_of, id_) <= 800


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


def test_bars_say_where_growth_rates_lie_beyond_them(tmp_path: Path) -> None:
    """A rate of 44 1/s had the colour of 0.3 1/s, and the bar said nothing of it."""
    explorer_path = tmp_path / "explorer.html"
    explorer_path.write_text(page("Made up", contents(), []), encoding="utf-8")
    scale = {"width": 0.01, "end": 0.3}
    few = [-0.1, 0.0, 0.01, 0.02, 44.4]
    # zeros of undamped modes by rounding, and rates of which most are large
    most = [0.0] * 60 + [1e-12] * 60 + [*range(1, 101)]
    own = "return scaleOfColours(...arguments)"
    beyond = "return coloursOfRates(...arguments).beyond"
    with browser(tmp_path / "profile") as opened:
        opened.open(explorer_path)
        opened.wait_for(READY)
        assert opened.run(own, few, scale) == scale, "that of the figures"
        assert opened.run(own, most, scale)["end"] == 99
        assert opened.run(beyond, few, scale) == ["", "≥ 0.3"]
        assert opened.run(beyond, [-3.0, *few[:-1]], scale) == ["≤ −0.3", ""]
        assert opened.run(beyond, most, scale) == ["", "≥ 99"]
        assert Explorer(opened).ask("wordsOfBar", few, scale)[-1] == "≥ 0.3"


def test_bars_have_the_signs_that_growth_rates_have(tmp_path: Path) -> None:
    """They went as far to the other side, and had no numbers at their ends, unlike those of figures."""
    explorer_path = tmp_path / "explorer.html"
    explorer_path.write_text(page("Made up", contents(), []), encoding="utf-8")
    scale = {"width": 0.01, "end": 0.3}
    ends = "return coloursOfRates(...arguments).ticks().map(([at, rate]) => rate)"
    zero = "return [coloursOfRates(...arguments).colour(0), contents.maps.diverging[128]]"
    with browser(tmp_path / "profile") as opened:
        opened.open(explorer_path)
        opened.wait_for(READY)
        for rates in ([0.01, 0.2], [-0.2, -0.01], [-0.2, 1e-12], [-0.2, 0.1], [0.0, 0.0]):
            expected = growth_colours(np.array(rates)).places
            found = opened.run(ends, rates, scale)[: len(expected)]
            assert sorted(found) == pytest.approx(expected), rates
            found, neutral = opened.run(zero, rates, scale)
            assert found == neutral
        words = Explorer(opened).ask("wordsOfBar", [0.01, 0.2], scale)
        assert words == ["0", "0.01", "0.03", "0.1", "0.3"]


def view_call() -> dict[str, Any]:
    """A call of a study that gives all variables of `columns`."""
    return {"quantity": "floquet", "options": {}, "recipes": [], "begins": {}, "along": {}}


def test_a_curve_of_growth_rates_has_the_dots_of_stable_ones(tmp_path: Path) -> None:
    """Maps had them, curves and studies of one dimension did not."""
    study = plane().isel(N=2, normalization=0, drop=True)
    study["growth_rate"].values[:] = [-0.02, -0.3, 30.0, 0.02]
    explorer_path = tmp_path / "explorer.html"
    explorer_path.write_text(page("Made up", [contents_of("line", study)], []), encoding="utf-8")
    with browser(tmp_path / "profile") as opened:
        opened.prefer("dark")
        opened.open(explorer_path)
        opened.wait_for(READY)
        shown = Explorer(opened)
        assert shown.text("legend").split("\n")[-1] == f"Growth rate: {STABLE.label}"
        opened.run("choose({Omega: 2})")  # its dashed line would cover a dot
        # a dot of radius 3 without its line has some 20 pixels; one stands on the frame
        assert 20 < shown.ask("whites") < 60
        heights = opened.run(
            "return [-0.02, 0, 0.02, 30].map(x => drawn.vertical(Math.asinh(x / arguments[0])))",
            growth_norm(study["growth_rate"].values).linear_width,
        )
        steps = np.diff(heights)
        assert steps[0] == pytest.approx(steps[1])
        assert (steps < -10).all(), "hundredths are told apart beside tens"


def is_light(colours: list[str]) -> bool:
    """Whether some are white but for smooth edges: marks on dark cells."""
    return any(lightness(colour) > 0.8 for colour in colours)


def started_study() -> xr.Dataset:
    """Points that start elsewhere than in the static start: named starts, each with kicks."""
    starts = {
        "apart": {"prerun": {"parameters": {"Omega": 15.1}, "time": 2.0}, "perturbation": {}},
        "kicked": {"prerun": None, "perturbation": {"u_velocity": 0.5}},
        "static": {"prerun": None, "perturbation": {}},
    }
    axes: dict[str, list[Any]] = {"start": [*starts], "perturbation_u": [0.0, -2.75e-3]}
    attrs = {"base": json.dumps({"N": 385, "Omega": 13}), "starts": json.dumps(starts)}
    values = np.arange(6.0).reshape(3, 2)
    return xr.Dataset({"u_max": ([*axes], values)}, axes, attrs)


def test_the_motion_of_a_point_begins_at_its_start(tmp_path: Path) -> None:
    """All points had the call of the motion from the static start, which may come to something else."""
    started = started_study()
    options = {"prerun": None, "perturbation": {"u": 1e-4}}
    attrs = {"base": started.attrs["base"], "options": json.dumps(options)}
    alike = xr.Dataset({"u_max": ("c_p", [1.0, 2.0])}, {"c_p": [0.0, 0.02]}, attrs)
    explorer_path = tmp_path / "explorer.html"
    told = [contents_of("started", started), contents_of("alike", alike)]
    explorer_path.write_text(page("Made up", told, []), encoding="utf-8")
    case = "dm.Parameters(N=385, Omega=13)"
    begun = f"case = {case}\nstart = dm.initial_state(case, "
    drawn = "dm.simulate(case, 60, initial_state=start).plot()"
    after = 'prerun={"parameters": {"Omega": 15.1}, "time": 2}'
    expected = {
        (0, 0): f"{begun}{after})\n{drawn}",
        (0, 1): f'{begun}{{"u": -0.00275}}, {after})\n{drawn}',
        (1, 0): f'{begun}{{"u_velocity": 0.5}})\n{drawn}',
        (1, 1): f'{begun}{{"u_velocity": 0.5, "u": -0.00275}})\n{drawn}',
        (2, 0): f"dm.simulate({case}, 60).plot()",
        (2, 1): f'{begun}{{"u": -0.00275}})\n{drawn}',
    }
    with browser(tmp_path / "profile") as opened:
        opened.open(explorer_path)
        opened.wait_for(READY)
        shown = Explorer(opened)
        calls = {}
        for start, kick in expected:
            opened.run("choose({start: arguments[0], perturbation_u: arguments[1]})", start, kick)
            calls[start, kick] = [shown.text(x) for x in ("call", "motion-says", "motion-call")]
        shown.choose("Study", "alike")
        assert 'start = dm.initial_state(case, {"u": 0.0001})' in shown.text("motion-call")
    for place, text in expected.items():
        assert calls[place][0] == case
        assert calls[place][2] == text
    assert calls[2, 0][1] == "The motion of this case from the static start:"

    _, says, motion = calls[0, 1]
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


def moves_by_arrow_keys(shown: Explorer) -> None:
    """The chosen point goes where the key points, and stays inside the map."""
    press = "view.place = {...view.place}; move({key: arguments[0], preventDefault() {}});"
    where = "return [view.place[view.x], view.place[view.y]];"
    shown.page.run("choose({...view.place, [view.x]: 0, [view.y]: 0});")
    steps = {"ArrowUp": [0, 1], "ArrowRight": [1, 1], "ArrowDown": [1, 0], "ArrowLeft": [0, 0]}
    for key, expected in steps.items():
        assert shown.page.run(press + where, key) == expected, key
    assert shown.page.run(press + where, "ArrowLeft") == [0, 0]
    for key, expected in {
        "End": [3, 0],
        "PageUp": [3, 2],
        "Home": [0, 2],
        "PageDown": [0, 0],
    }.items():
        assert shown.page.run(press + where, key) == expected, key


def draws_gaps_and_scale(shown: Explorer) -> None:
    """A point without a rate has its class's colour and name, others the figures' colours."""
    face = LOOKS["no_cycle"].face
    place = (WITHOUT_CYCLE["Omega"], WITHOUT_CYCLE["N"])
    seen = [shown.ask("pixel", *place, shift) for shift in range(-4, 5)]
    assert face in seen, "between the lines of its pattern"
    shown.point(*place)
    assert shown.text("hovered").endswith("no cycle found")
    assert {"no cycle found", "cycle nearby, not followed"} <= {*shown.text("legend").split("\n")}
    rates = plane()["growth_rate"].values
    norm = growth_norm(rates)
    for rate in (-0.2, -0.01, 0.003, 0.1, 0.4):
        share = float(np.clip(norm(rate), 0, 1))
        expected = to_hex(cm.vik(round(share * 255)))
        assert shown.ask("colourOf", rate) == expected, rate


def keeps_what_is_chosen_in_the_link(shown: Explorer) -> None:
    shown.choose("Colours", "linear")
    shown.choose("Marks", "outcome=separation")
    link = shown.ask("link")
    shown.choose("Colours", "stretched")
    shown.choose("Marks", "")
    shown.page.run("location.hash = arguments[0]", link)
    shown.page.wait_for(f"{SEEN}\nreturn seen.link() === '{link}'")
    controls = "return ['Colours', 'Marks'].map(x => document.getElementById('controls')[x].value)"
    assert shown.page.run(controls) == ["linear", "outcome=separation"]


def follows_values_of_links(shown: Explorer) -> None:
    """Links counted cells, and led to another point after a change of the axes."""
    place = "return [view.place.N, view.place.Omega, view.place.normalization]"

    def follow(link: str) -> Any:
        shown.page.run("return follow(arguments[0]).then(update)", link)
        return shown.page.run(place)

    shown.page.run("choose({N: 2, Omega: 2, normalization: 1})")
    link = shown.ask("link")
    said = "&N=385&Omega=15.1&normalization=orthonormal"
    assert link.endswith(said)
    head = "study=plane&x=Omega&y=N&variable=growth_rate&colours=auto&dots="
    assert follow(head + "&N=100&Omega=20&normalization=as_published") == [0, 3, 0]
    assert shown.text("warning") == ""
    assert follow(head + said) == [2, 2, 1]
    # a value that is gone, a word that is gone, another study, a link of an older page
    assert follow(head + "&N=210&Omega=20&normalization=as_published") == [1, 3, 0]
    assert shown.text("warning") == (
        "The link's N = 210 is not in this study: the nearest point is shown."
    )
    assert follow(head + "&N=100&Omega=20&normalization=mean") == [0, 3, 0]
    assert shown.text("warning") == "The link's normalization = mean is not in this study."
    before = follow(head + "&N=385&Omega=20&normalization=as_published")
    assert follow("study=gone&N=100") == before
    assert "“gone” is not on this page" in shown.text("warning")
    follow("study=plane&across=Omega&up=N&variable=growth_rate&N=0&Omega=0&normalization=1")
    assert shown.text("warning").startswith("This link is of an older page")
    shown.point(0, 0, click=True)
    assert shown.text("warning") == ""


def names_selectors_as_axes(shown: Explorer) -> None:
    """Those of dimensions that are not on the map said "N" and "normalization"."""
    label = "return document.getElementById('controls')[arguments[0]].parentElement.firstChild.data"
    options = "return [...document.getElementById('controls').N.options].map(x => x.text)"
    shown.choose("Variable", "growth_rate")
    assert shown.page.run(label, "normalization") == "Scale of the mode shapes"
    shown.choose("Up", "")
    assert shown.page.run(label, "N") == "Preload N"
    assert shown.page.run(options) == ["100 N", "200 N", "385 N"]
    dots = "return [...document.getElementById('controls').Marks.options].map(x => x.text)"
    assert {"none", "Growth rate: stable", "Outcome within 200 s: quiet"} <= {*shown.page.run(dots)}
    shown.choose("Up", "N")


def names_classes_along_a_curve(shown: Explorer) -> None:
    """The axis had the words of the dataset, such as "at_rest"."""
    flag = {"flags": ["quiet", "at_rest"], "looks": [{"label": "quiet"}, {"label": "stick"}]}
    ticks = "return scaleOfNumbers(arguments[0], [0, 1]).ticks()"
    assert shown.page.run(ticks, flag) == [[0, "quiet"], [1, "stick"]]


def keeps_words_of_axes_inside(shown: Explorer) -> None:
    """On telephones, the title of a narrow axis and its last number were cut."""
    ends = shown.ask("endsOfWords", [120, 200], "a title longer than the axis", "1·10⁶")
    for left, right in ends:
        assert left >= 0
        assert right <= 200 + 14, "the room on the right of maps"


def draws_dots_on_curves(shown: Explorer) -> None:
    """A curve had the selector, and no dots."""
    shown.page.run(
        "choose({...view.place, Omega: 1})"
    )  # its dashed line would cover a dot on the frame
    shown.choose("Up", "")
    shown.choose("N", "2")
    dots = {}
    for option in ("", "outcome=separation", "outcome=quiet"):
        shown.choose("Marks", option)
        dots[option] = shown.ask("whites")
    # a dot of radius 3 without its line has some 15 to 20 pixels; there are two of each class
    assert dots[""] == 0
    assert dots["outcome=separation"] >= 15
    assert dots["outcome=quiet"] >= 15


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


@pytest.mark.parametrize("values", [[385.0, 385.0], [-9.695, -9.6949], [0.0, 1.0], [-3e-5, 4e-5]])
def test_panels_of_a_motion_have_two_ticks_or_more(values: list[float], tmp_path: Path) -> None:
    """Some had one, such as 385, from which no amplitude can be read."""
    explorer_path = tmp_path / "explorer.html"
    explorer_path.write_text(page("Made up", contents(), []), encoding="utf-8")
    with browser(tmp_path / "profile") as opened:
        opened.open(explorer_path)
        opened.wait_for(READY)
        ticks = opened.run("return rangeOf(arguments[0]).ticks", values)
    assert len({text for _, text in ticks}) >= 2


def test_a_motion_that_stands_still_is_a_flat_line(tmp_path: Path) -> None:
    """The last of a decay filled its panel."""
    explorer_path = tmp_path / "explorer.html"
    explorer_path.write_text(page("Made up", contents(), []), encoding="utf-8")
    with browser(tmp_path / "profile") as opened:
        opened.open(explorer_path)
        opened.wait_for(READY)
        moves = opened.run("return rangeOf(arguments[0], 30)", [-1e-3, 1e-3])
        still = opened.run("return rangeOf(arguments[0], 30)", [-1e-7, 1e-7])
    assert moves["greatest"] < 2e-3
    assert still["greatest"] == pytest.approx(1.5)
    assert "1" in [text for _, text in still["ticks"]]
