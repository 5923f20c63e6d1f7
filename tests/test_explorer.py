"""The explorer: one page of all points of studies, and of motions stored at some of them."""

import base64
import gzip
import json
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from disc_model.data.variables import PHASES
from disc_model.explorer import page, study_contents
from disc_model.figures.looks import LOOKS
from disc_model.figures.shown import shown
from disc_model.studies.motions import SAMPLES
from tests import needs
from tests.figures.examples import EXAMPLES, KINDS_OF_STUDIES
from tests.workflow.browser import browser

LARGEST = 10e6  # bytes, of a page of 45 studies
AXES: dict[str, list[Any]] = {
    "N": [100.0, 200.0, 385.0],
    "Omega": [5.0, 10.0, 15.1, 20.0],
    "normalization": ["as_published", "orthonormal"],
}
UNITS = {"N": "N", "Omega": "rad s-1", "friction_decay": "s m-1"}
STATED = {"units": {}, "axes": ["Omega", "N"], "motion": "The motion at the horizon."}
MESSAGE = 'SimulationError: </script> & "worse"'
MOTIONS = [(100.0, 5.0, "as_published"), (385.0, 20.0, "as_published"), (100.0, 5.0, "orthonormal")]


def flagged(words: str) -> dict[str, Any]:
    return {"flag_values": np.arange(len(words.split()), dtype=np.int8), "flag_meanings": words}


def along(dim: str, **values: Any) -> dict[str, Any]:
    """Coordinates that vary along a dimension."""
    return {name: (dim, x, {"units": UNITS.get(name, "")}) for name, x in values.items()}


def plane() -> xr.Dataset:
    """Outcomes over preload, speed and the scale of modes: contact is lost from 200 N and 15.1 rad/s
    on, and one point failed."""
    shape = tuple(map(len, AXES.values()))
    outcome = np.zeros(shape, np.int8)
    outcome[1:, 2:] = 1
    status = np.zeros(shape, np.int8)
    rate = np.linspace(-0.2, 0.4, status.size).reshape(shape)
    message = np.full(shape, "", dtype=object)
    failed = (0, 3, 1)
    status[failed], rate[failed], message[failed] = 1, np.nan, MESSAGE
    says = {"long_name": "growth rate", "units": "s-1", "missing": "there is no cycle"}
    data = {
        "status": ([*AXES], status, flagged("ok failed")),
        "outcome": ([*AXES], outcome, flagged("stick_slip separation")),
        "growth_rate": ([*AXES], rate, says),
        "P_max": ([*AXES], 1e3 * rate**2, {"long_name": "greatest contact force", "units": "N"}),
        "releases": (["N", "Omega"], np.arange(12).reshape(3, 4), {"units": "1"}),
        "message": ([*AXES], message),
    }
    coordinates = {name: along(name, **{name: x})[name] for name, x in AXES.items()}
    base = json.dumps({"m": 0.2, "friction_decay": "inf"})
    return xr.Dataset(data, coordinates, {"title": "A plane <b>", "base": base})


def motions() -> xr.Dataset:
    """Histories at three points of the plane, one of which failed."""
    time = np.linspace(0, 12, SAMPLES)
    force = np.outer([N for N, _, _ in MOTIONS], 1 + 0.5 * np.sin(time))
    phase = np.tile(np.repeat([2, 1, 3, 2], SAMPLES // 4).astype(np.int8), (3, 1))
    dims = ("point", "sample")
    data = {
        "status": ("point", np.array([0, 0, 1], np.int8), flagged("ok failed")),
        "length": ("point", [0.03, 0.05, np.nan], {"units": "s"}),
        "P": (dims, force.astype(np.float32), {"units": "N"}),
        "u": (dims, np.full((3, SAMPLES), -0.0088, np.float32), {"units": "m"}),
        "psi": (dims, np.tile(time / 200, (3, 1)).astype(np.float32), {"units": "rad"}),
        "phase": (dims, phase, flagged(" ".join(["none", *PHASES]))),
    }
    places = dict(zip(AXES, map(list, zip(*MOTIONS, strict=True)), strict=True))
    return xr.Dataset(data, {**along("point", **places), "sample": range(SAMPLES)})


def told() -> dict[str, Any]:
    return study_contents("plane", plane(), motions(), STATED)


def unpacked(study: dict[str, Any]) -> Any:
    """What the page unpacks of a study."""
    return json.loads(gzip.decompress(base64.b64decode(study["contents"])))


def group_of(study: dict[str, Any], variable: str) -> dict[str, Any]:
    """The group of variables in which one is shown."""
    lists = {}
    for group in unpacked(study)["groups"]:
        for param in group["spec"]["params"]:
            if param["name"] in ("classes", "numbers"):
                lists.update(dict.fromkeys(param["bind"]["options"], group))
    return lists[variable]


def numbers_of(column: list[str]) -> np.ndarray:
    return np.array(column, dtype=float)


class Addresses(HTMLParser):
    """What a page loads, by the attributes of its elements."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.found: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found += [str(x) for name, x in attrs if name in ("src", "href", "data", "srcset")]


def test_the_page_is_one_file_that_loads_nothing() -> None:
    text = page("Made up", [told()])
    assert Addresses(text).found == ["data:,"]  # no icon is asked for
    style = text.partition("<style>")[2].partition("</style>")[0]
    assert "url(" not in style
    assert "@import" not in style
    assert "A plane &lt;b&gt;" in text
    assert page("Made up", [told()]) == text, "equal studies give equal bytes"


def test_the_paper_fits_into_ten_megabytes() -> None:
    """A study as large as its largest maps, of numbers that no packing makes smaller."""
    shape = (47, 47, 2)
    random = np.random.default_rng(0)
    names = ("growth_rate", "first_separation", "simulated_time")
    data = {name: ([*AXES], random.normal(size=shape), {"units": "s"}) for name in names}
    flags = random.integers(0, 3, shape).astype(np.int8)
    data["outcome"] = ([*AXES], flags, flagged("stick_slip growing separation"))
    numbers = {"N": np.linspace(50, 600, 47), "Omega": np.linspace(5, 50, 47)}
    large = xr.Dataset(data, {**numbers, "normalization": AXES["normalization"]})
    libraries = len(page("Empty", []))
    assert libraries < 1e6
    size = len(study_contents("large", large, None, STATED)["contents"])
    assert libraries + 45 * size < LARGEST


def test_classes_have_the_words_and_colours_of_figures() -> None:
    group = group_of(told(), "outcome")
    expected = [LOOKS["stick_slip"], LOOKS["separation"]]
    assert {*group["points"]["outcome"]} == {look.label for look in expected}
    [panel, _] = group["spec"]["hconcat"]
    scale = panel["layer"][0]["encoding"]["color"]["scale"]
    colours = dict(zip(scale["domain"], scale["range"], strict=True))
    for look in expected:
        assert colours[look.label] == look.face
    assert {*group["points"]["normalization"]} == {"modes as published", "orthonormal modes"}


@pytest.mark.parametrize("units", [{}, {"Omega": "rpm", "P": "kN"}])
def test_a_point_has_all_values_of_the_dataset(units: dict[str, str]) -> None:
    study = study_contents("plane", plane(), None, {**STATED, "units": units})
    group = group_of(study, "growth_rate")
    expected = shown(plane(), units).to_dataframe(dim_order=[*AXES]).reset_index()
    assert {*expected} <= {*group["points"]}
    assert {*expected} == {*group["told"]}
    for name in ("N", "Omega", "growth_rate", "P_max", "releases"):
        found = numbers_of(group["points"][name])
        np.testing.assert_allclose(found, expected[name].to_numpy(), rtol=1e-6)
    assert group["points"]["message"] == expected["message"].tolist()
    assert group["told"]["growth_rate"] == ["Growth rate (1/s)", "no value: there is no cycle"]
    assert group["told"]["P_max"][0].endswith(f"({units.get('P', 'N')})")


def test_over_two_numbers_there_are_maps_and_over_one_lines() -> None:
    study = study_contents("plane", plane(), None, STATED)
    _, numbers = group_of(study, "growth_rate")["spec"]["hconcat"]
    assert [layer["mark"]["type"] for layer in numbers["layer"]] == ["rect", "rect"]
    assert numbers["layer"][0]["encoding"]["x"]["title"] == "Speed Ω (rad/s)"
    line = study_contents("line", plane().isel(Omega=1), None, STATED)
    _, numbers = group_of(line, "growth_rate")["spec"]["hconcat"]
    assert [layer["mark"]["type"] for layer in numbers["layer"]] == ["line", "circle", "point"]
    assert numbers["layer"][0]["encoding"]["x"]["title"] == "Preload N (N)"


def test_places_that_are_zipped_or_infinite_are_told_in_words() -> None:
    data = {"period": ("N_Omega", [0.0148, np.nan], {"long_name": "period", "units": "s"})}
    at = along("N_Omega", N=[100.0, 385.0], Omega=[20.0, 15.1])
    zipped = group_of(study_contents("z", xr.Dataset(data, at), None, STATED), "period")
    assert zipped["points"]["N_Omega"] == ["N = 100 N, Ω = 20 rad/s", "N = 385 N, Ω = 15.1 rad/s"]
    data = {"period": ("friction_decay", [0.0148, 0.0149], {"units": "s"})}
    endless = xr.Dataset(data, along("friction_decay", friction_decay=[0.1, np.inf]))
    group = group_of(study_contents("d", endless, None, STATED), "period")
    assert group["points"]["friction_decay"] == ["d = 0.1 s/m", "d = inf s/m"]


def test_a_single_point_is_shown() -> None:
    one = plane().isel(N=[0], Omega=[0], normalization=[0])
    group = group_of(study_contents("one", one, None, STATED), "growth_rate")
    assert numbers_of(group["points"]["growth_rate"]) == [-0.2]


def test_motions_say_what_they_are_and_those_that_failed_are_left_out() -> None:
    contents = unpacked(told())
    stored = contents["motions"]
    assert stored["point"] == [
        "N = 100 N, Ω = 5 rad/s, modes as published",
        "N = 385 N, Ω = 20 rad/s, modes as published",
    ]
    assert stored["text"] == [STATED["motion"]] * 2
    own = np.array(contents["samples"]["point"]) == stored["point"][1]
    for name, factor in (("P", 1), ("u", 1e3), ("psi", 1)):
        found = numbers_of(contents["samples"][name])[own]
        np.testing.assert_allclose(found, factor * motions()[name][1], rtol=1e-6, atol=1e-9)


@pytest.mark.slow
@pytest.mark.compiled
@pytest.mark.parametrize("name", [each.__name__ for each in KINDS_OF_STUDIES])
def test_every_variable_of_a_quantity_is_on_the_page(name: str) -> None:
    study: Any = EXAMPLES[name]().inputs["study"]
    study = study.drop_vars([coordinate for coordinate, x in study.coords.items() if not x.ndim])
    contents = unpacked(study_contents(name, study, None, STATED))
    on_page = {variable for group in contents["groups"] for variable in group["points"]}
    assert {variable for variable, x in study.items() if x.size} <= on_page


# ---- In a browser

READY = "return document.querySelector('canvas') && document.querySelector('h3')?.innerText"
VALUES = "return [...document.querySelectorAll('table')[0].rows].map(r => [...r.cells].map(c => c.innerText))"
CORNER = """
const {x, y} = document.querySelector("canvas").getBoundingClientRect();
return [x, y];
"""
LOADED = "return performance.getEntriesByType('resource').map(x => x.name)"


@pytest.mark.slow
@needs.BROWSER.mark
def test_a_click_shows_the_point_and_the_motion_nearest_to_it(tmp_path: Path) -> None:
    path = tmp_path / "explorer.html"
    closed = study_contents("closed", plane(), None, STATED)
    path.write_text(page("Made up", [told(), closed]), encoding="utf-8")
    with browser(tmp_path / "profile") as opened:
        opened.open(path)
        first = "Motion at N = 100 N, Ω = 5 rad/s, modes as published"
        assert opened.wait_for(READY) == first
        x, y = opened.run(CORNER)
        right_end, top = 400, 30  # of the map of classes, pixels: 20 rad/s and 385 N
        opened.click(x + right_end, y + top)
        opened.wait_for(f"{READY} !== {first!r}")
        title = opened.run("return document.querySelector('h3').innerText")
        values = {name: value for _, value, name in opened.run(VALUES)}
        drawn = len(opened.run("return [...document.querySelectorAll('canvas')]"))
        messages = [each["message"] for each in opened.messages() if each["level"] == "SEVERE"]
        loaded = [name for name in opened.run(LOADED) if not name.startswith("data:")]
    assert title == "Motion at N = 385 N, Ω = 20 rad/s, modes as published"
    point = shown(plane()).isel(N=2, Omega=3, normalization=0)
    assert values["outcome"] == LOOKS["separation"].label
    assert float(values["growth_rate"]) == pytest.approx(point["growth_rate"].item(), rel=1e-6)
    assert float(values["N"]) == 385.0
    assert drawn == 2, "the charts of a study that is closed are not drawn"
    assert messages == []
    assert loaded == []
