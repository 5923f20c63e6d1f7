"""The explorer's page: what it is told of studies and motions, all in one file, and nothing
fetched."""

import base64
import io
import json
import re
import zlib
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from PIL import Image

from disc_model.data.variables import PHASES, TRUTH
from disc_model.explorer import PAGE_WIDTH, PICTURE_WIDTH, Picture, Stated, page
from disc_model.explorer import study_contents as contents_of
from disc_model.explorer.contents import _named
from disc_model.figures.classes import LOOKS, STABLE, UNRESOLVED
from disc_model.figures.growth import isolated
from disc_model.studies.motions import SAMPLES, Motions
from disc_model.studies.registry import quantity_of
from disc_model.studies.run import describe

AXES: dict[str, list[Any]] = {"N": [100.0, 200.0, 385.0], "Omega": [5.0, 10.0, 15.1, 20.0]}
AXES["normalization"] = ["as_published", "orthonormal"]
FAILED = {"N": 1, "Omega": 2, "normalization": 0}
"""Place of the one point that failed."""
WITHOUT_CYCLE = {"N": 1, "Omega": 1, "normalization": 0}
"""Place of a point in the middle of the plane that has no cycle."""
MESSAGE = 'SimulationError: </script> & "worse"'
CAPTION = 'A curve of f < 0 & "more"'


def flagged(words: str, first: int = 0) -> dict[str, object]:
    return {
        "flag_values": np.arange(first, first + len(words.split()), dtype=np.int8),
        "flag_meanings": words,
    }


def plane() -> xr.Dataset:
    """Two axes that are numbers and one of words."""
    place = tuple(FAILED.values())
    shape = tuple(map(len, AXES.values()))
    status = np.zeros(shape, np.int8)
    outcome = np.zeros(shape, np.int8)
    message = np.full(shape, "", dtype=object)
    status[place] = 1
    outcome[1:, 2:] = 1
    message[place] = MESSAGE
    growth = np.linspace(-0.2, 0.4, status.size).reshape(shape)
    growth[place] = np.nan
    cycle = np.ones(shape, np.int8)
    apart = tuple(WITHOUT_CYCLE.values())
    growth[apart] = np.nan
    cycle[[place[0], apart[0]], [place[1], apart[1]], [place[2], apart[2]]] = [2, 0]
    data = {
        "status": ([*AXES], status, flagged("ok failed")),
        "outcome": ([*AXES], outcome - 1, flagged("quiet separation", first=-1)),
        "cycle": ([*AXES], cycle, flagged("no_cycle followed nearby_only")),
        "growth_rate": ([*AXES], growth, {"long_name": "growth rate", "units": "s-1"}),
        "releases": (
            ["N", "Omega"],
            np.arange(12).reshape(3, 4),
            {"long_name": "number of releases", "units": "1"},
        ),
        "message": ([*AXES], message),
    }
    coords = {name: (name, values, describe(name)) for name, values in AXES.items()}
    return xr.Dataset(
        data,
        coords,
        {
            "title": "A plane <b>",
            "quantity": "outcome",
            "base": json.dumps({"k": 5e4, "m": 0.2, "friction_decay": "inf"}),
            "options": json.dumps({"horizon": 200}),
        },
    )


def line() -> xr.Dataset:
    """A zip, which has no coordinate of its own."""
    data = {"period": ("N_Omega", [0.0148, 0.02, np.nan], {"long_name": "period", "units": "s"})}
    coords = {
        "N": ("N_Omega", AXES["N"], describe("N")),
        "Omega": ("N_Omega", [20.0, 15.1, 12.0], describe("Omega")),
    }
    return xr.Dataset(data, coords, {"title": "A line"})


def force(N: float) -> np.ndarray:
    """The contact force of a point, N."""
    angle = np.linspace(0, 12, SAMPLES)
    factor = 1 + 0.5 * np.sin(angle)
    force = N * factor
    return force.astype(np.float32)


def motions() -> xr.Dataset:
    """Histories at three points of the plane, one of which failed; the slider slips, sticks and is
    apart in turn."""
    points = [
        (100.0, 5.0, "as_published"),
        (385.0, 20.0, "as_published"),
        (100.0, 5.0, "orthonormal"),
    ]
    phase = np.repeat([2, 1, 3, 2], SAMPLES // 4).astype(np.int8)
    rows = {
        "P": np.stack([force(point[0]) for point in points]),
        "u": np.full((3, SAMPLES), -0.0088, np.float32),
    }
    rows["psi"] = np.tile(np.linspace(0, 0.05, SAMPLES, dtype=np.float32), (3, 1))
    data = {
        name: (("point", "sample"), values, Motions.COLUMNS[name].attributes)
        for name, values in rows.items()
    }
    data |= {
        "status": ("point", np.array([0, 0, 1], np.int8), flagged("ok failed")),
        "length": ("point", [0.03, 0.05, np.nan], {"units": "s"}),
        "phase": (
            ("point", "sample"),
            np.tile(phase, (3, 1)),
            flagged(" ".join(("none", *PHASES))),
        ),
    }
    return xr.Dataset(
        data,
        {
            name: ("point", list(values))
            for name, values in zip(AXES, zip(*points, strict=True), strict=True)
        },
    )


def contents() -> list[dict[str, Any]]:
    """What the page is told of both studies."""
    return [
        contents_of("plane", plane(), motions(), Stated("After the transient.")),
        contents_of("line", line()),
    ]


def numbers(stored: dict[str, Any], kind: str) -> np.ndarray:
    size = np.dtype(kind).itemsize
    planes = np.frombuffer(zlib.decompress(base64.b64decode(stored["data"])), np.uint8).reshape(
        size, -1
    )
    return np.frombuffer(planes.T.tobytes(), kind)


def test_numbers_flags_and_messages_come_through() -> None:
    """Each as its words, whatever numbers stand for them; as JSON, and with units."""
    told = contents()[0]
    study = plane()
    assert json.loads(json.dumps(told, allow_nan=False)) == told
    variables = {variable["name"]: variable for variable in told["variables"]}
    assert set(variables) == set(study.data_vars) - {"message"}
    for name in ("growth_rate", "releases"):
        values = study[name].transpose(*variables[name]["dims"])
        found = numbers(variables[name], "<f4").reshape(values.shape)
        np.testing.assert_array_equal(found, values.astype("<f4"), "five digits were kept")
    assert variables["growth_rate"]["unit"] == "1/s"
    assert variables["growth_rate"]["title"] == "growth rate"
    words = np.array(variables["outcome"]["flags"])[numbers(variables["outcome"], "u1")]
    assert (
        words.tolist()
        == np.where(study["outcome"].values == 0, "separation", "quiet").ravel().tolist()
    )
    text = np.array(told["messages"]["words"])[numbers(told["messages"], "<u4")].reshape(
        study["message"].shape
    )
    assert (text == study["message"].values).all()
    spring = {
        "name": "k",
        "symbol": "k",
        "label": "Spring k",
        "title": "spring of the slider, normal to the disc",
        "unit": "kN/m",
        "value": 5e4,
        "shown": 50.0,
        "usual": True,
    }
    assert told["fixed"][0] == spring
    assert [one["usual"] for one in told["fixed"]] == [True, False, True]
    assert variables["outcome"]["label"] == "Outcome within 200 s"
    traced = {trace["label"]: trace["unit"] for trace in told["motions"]["traces"]}
    assert traced == {"Contact force P": "N", "Slider u": "mm", "Angle ψ": "rad"}
    origins = {trace["name"]: trace["origin"] for trace in told["motions"]["traces"]}
    assert origins == {"P": "", "u": "from the undeformed disc", "psi": ""}
    labels = {dim["name"]: dim["label"] for dim in told["dims"]}
    symbols = {dim["symbol"] for dim in told["dims"]}
    assert symbols == {
        "N",
        "Ω",
        "scale of the mode shapes: coefficient of Jₗ equal to 1, or Eq. (17)",
    }
    horizon = _named("horizon", {"long_name": "horizon", "units": "s"})
    assert horizon["symbol"] == "horizon"
    assert _named("contact_arc", describe("contact_arc"))["symbol"] == "arc of the pad"
    known = {"N": "Preload N", "Omega": "Speed Ω", "mu_k": "Kinetic friction μₖ"}
    assert {name: known[name] for name in labels if name in known} == {
        name: label for name, label in labels.items() if name in known
    }
    assert known.keys() & labels.keys(), "axes are called as in figures"


def test_points_without_a_number_have_the_class_that_figures_show() -> None:
    """All were grey and "no value", where the study's figure told two reasons apart."""
    variables = {variable["name"]: variable for variable in contents()[0]["variables"]}
    gaps = variables["growth_rate"]["gaps"]
    codes = numbers(gaps, "u1").reshape(plane()["growth_rate"].shape)
    for place, word in ((FAILED, "nearby_only"), (WITHOUT_CYCLE, "no_cycle")):
        look = gaps["looks"][codes[tuple(place.values())] - 1]
        expected = LOOKS[word]
        assert look == {"word": word, **expected._asdict(), "ink": expected.ink}
    assert np.count_nonzero(codes) == 2, "all other points have a rate"
    assert variables["releases"]["gaps"] is None
    unknown = contents()[1]["variables"][0]["gaps"]
    assert [look["label"] for look in unknown["looks"]] == ["no value"]
    assert numbers(unknown, "u1").tolist() == [0, 0, 1]


def test_a_sample_that_was_not_simulated_has_no_time_for_this_reason() -> None:
    """It was said to be "none within 500 s, or not timed", and separates at 90 s."""
    study = plane().isel(normalization=0, drop=True)
    shape = study["growth_rate"].shape
    outcomes = np.ones(shape, np.int8)
    outcomes[0, 0] = 0
    study["outcome"] = (study["growth_rate"].dims, outcomes, flagged("not_simulated quiet"))
    study["first_separation"] = (study["growth_rate"].dims, np.full(shape, np.nan), {"units": "s"})
    study["status"] = study["outcome"].copy(data=np.zeros(shape, np.int8))
    study["status"].attrs = flagged("ok failed")
    study.attrs["options"] = '{"horizon": 500, "extrapolate": true}'
    variables = {one["name"]: one for one in contents_of("samples", study)["variables"]}
    gaps = variables["first_separation"]["gaps"]
    assert [look["label"] for look in gaps["looks"]] == ["none within 500 s", "not simulated"]


def marked(variable: dict[str, Any], shape: tuple[int, ...]) -> dict[tuple[str, ...], np.ndarray]:
    """The points that a page marks, by the label of the mark and the axes of the map."""
    found = {}
    for mark in variable["marks"]:
        cells = numbers(mark, "u1").reshape(shape).astype(bool)
        found[mark["look"]["label"], *mark["axes"]] = cells
    return found


def test_maps_have_the_marks_of_figures() -> None:
    """The explorer had neither the figures' dots for "stable" nor the hatching of "unresolved"."""
    study = plane()
    # one cell alone among others, in the plane of the second normalization
    study["outcome"].values[0, 1, 1] = 0
    variables = {one["name"]: one for one in contents_of("plane", study)["variables"]}

    growth = marked(variables["growth_rate"], study["growth_rate"].shape)
    stable = growth[STABLE.label, "N", "Omega"]
    np.testing.assert_array_equal(stable, study["growth_rate"].values < 0)
    outcome = marked(variables["outcome"], study["outcome"].shape)
    unresolved = outcome[UNRESOLVED.label, "N", "Omega"]
    assert np.argwhere(unresolved).tolist() == [[0, 1, 1]]
    for variable, name in (("growth_rate", STABLE), ("outcome", UNRESOLVED)):
        looks = [mark["look"] for mark in variables[variable]["marks"]]
        assert {**name._asdict(), "ink": name.ink} in looks
    assert variables["status"]["marks"] == [], "no map of statuses in figures has one"
    assert variables["releases"]["marks"] == []


def test_unresolved_cells_are_those_of_each_plane_of_numbers() -> None:
    study = plane()
    study["growth_rate"].values[:, 1, 1] = -1.0
    variables = {one["name"]: one for one in contents_of("plane", study)["variables"]}
    marks = marked(variables["growth_rate"], study["growth_rate"].shape)
    cells = xr.DataArray(marks[UNRESOLVED.label, "N", "Omega"], dims=study["growth_rate"].dims)
    for i in range(study.sizes["normalization"]):
        chosen = study.isel(normalization=i).transpose("N", "Omega")
        np.testing.assert_array_equal(
            cells.isel(normalization=i).transpose("N", "Omega"), isolated(chosen, "growth_rate")
        )
    assert (UNRESOLVED.label, "N", "normalization") not in marks, "nothing lies between words"


def test_a_page_opens_on_the_axes_of_a_figure() -> None:
    told = contents_of("plane", plane(), stated=Stated(axes=("N", "Omega")))
    assert told["axes"] == ["N", "Omega"]
    assert contents_of("plane", plane(), stated=Stated(axes=("k", "N")))["axes"] == ["N"]
    assert contents_of("plane", plane(), stated=Stated(variable="releases"))["first"] == "releases"


def test_units_are_those_of_the_figures() -> None:
    """Figures had rpm and the explorer rad/s, and a height was in m beside a plot in mm."""
    study = plane()
    attrs = {"long_name": "displacement, least", "units": "m"}
    study["u_min"] = (["N", "Omega"], np.full((3, 4), -0.0123), attrs)
    told = contents_of("plane", study, stated=Stated(units={"Omega": "rpm"}))
    dims = {dim["name"]: dim for dim in told["dims"]}
    assert (dims["Omega"]["unit"], dims["Omega"]["si_unit"]) == ("rpm", "rad/s")
    np.testing.assert_allclose(dims["Omega"]["values"], study["Omega"] * 30 / np.pi, rtol=1e-11)
    assert dims["Omega"]["parts"]["Omega"] == AXES["Omega"], "calls have SI units"
    assert (dims["N"]["unit"], dims["N"]["si_unit"]) == ("N", "")
    [height] = [one for one in told["variables"] if one["name"] == "u_min"]
    assert height["unit"] == "mm"
    np.testing.assert_allclose(numbers(height, "<f4"), -12.3, rtol=2.0**-24)
    told = contents_of("plane", study, stated=Stated(units={"Omega": "rad/s"}))
    dims = {dim["name"]: dim for dim in told["dims"]}
    assert dims["Omega"]["si_unit"] == "", "a heading said Ω = 5 rad/s (5 rad/s)"


@pytest.mark.parametrize(
    ("quantity", "name", "unit"),
    [
        ("branches", "range", "mm"),
        ("branches", "sweep_range", "mm"),
        ("range_law", "pinned_range", "mm"),
        ("basins", "attractor_period", "ms"),
        ("locking", "separation_interval", "ms"),
    ],
)
def test_ranges_and_periods_of_all_quantities_have_the_units_of_figures(
    quantity: str, name: str, unit: str
) -> None:
    """The range of a sweep was in m beside that of a branch in mm."""
    column = quantity_of(quantity).COLUMNS[name]
    assert _named(name, column.attributes)["unit"] == unit


def test_values_of_a_parameter_have_its_name_and_unit() -> None:
    """The axis of a study of branches was "Omega in the sweep, SI units"."""
    swept = {"long_name": "m in the sweep, SI units"}
    along = {"long_name": "parameter along the branch, SI units"}
    study = xr.Dataset(
        {"value": ("branch_point", [0.1, 0.3], along), "range": ("sweep_value", [1.0, 2.0])},
        {"sweep_value": ("sweep_value", [0.1, 0.2], swept)},
        {"quantity": "branches", "options": json.dumps({"parameter": "m"})},
    )
    told = contents_of("branches", study)
    [dim] = [dim for dim in told["dims"] if dim["name"] == "sweep_value"]
    assert (dim["label"], dim["unit"], dim["values"]) == ("Mass m", "g", [100, 200])
    [value] = [one for one in told["variables"] if one["name"] == "value"]
    assert (value["label"], value["unit"]) == ("Mass m", "g")
    curves = {"x": ("curve_point", [5.0]), "y": ("curve_point", [200.0])}
    options = json.dumps({"x": "Omega", "y": "N"})
    study = xr.Dataset(curves, {}, {"quantity": "stability_curves", "options": options})
    labels = [one["label"] for one in contents_of("curves", study)["variables"]]
    assert labels == ["Speed Ω", "Preload N"]


def test_an_axis_that_ends_at_infinity_is_told_in_words() -> None:
    """JSON has no infinity, and the page could not be made."""
    names = {"N": "friction_decay"}
    study = plane().rename(names).assign_coords(friction_decay=[0.5, 2.0, np.inf])
    seen = motions().rename(names)
    seen = seen.assign_coords(friction_decay=("point", [0.5, np.inf, 0.5]))
    told = contents_of("plane", study, seen)
    assert json.loads(json.dumps(told, allow_nan=False)) == told
    dims = {dim["name"]: dim["values"] for dim in told["dims"]}
    assert dims["friction_decay"] == ["0.5", "2", "inf"]
    place = told["motions"]["names"].index("friction_decay")
    assert [point["at"][place] for point in told["motions"]["points"]] == ["0.5", "inf"]


class Reader(HTMLParser):
    """Tags, and what stands in scripts and styles."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.code: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data):
        if (
            self.tags
            and self.tags[-1][0] in ("script", "style")
            and self.lasttag == self.tags[-1][0]
        ):
            self.code.append(data)


def test_all_is_in_the_page_and_stays_in_its_place(tmp_path: Path) -> None:
    """Nothing is fetched; a message ends no script, and a title brings no tag."""
    path = tmp_path / "fig.png"
    Image.new("RGB", (PAGE_WIDTH, 500), "#0072B2").save(path)
    text = page(
        "A <title>", contents(), [Picture(f"Sec. {i}", "One", CAPTION, path) for i in (1, 2)]
    )
    reader = Reader(text)
    addresses = [
        value
        for _, attrs in reader.tags
        for name, value in attrs.items()
        if name in ("src", "href")
    ]
    assert len(addresses) >= 4
    for address in addresses:
        assert re.match(r"data:|#", str(address))
    assert not re.search(r"url\(|@import|fetch\(|XMLHttpRequest|https?://", "".join(reader.code))
    assert [tag for tag, _ in reader.tags].count("script") == 2
    told = json.loads(next(code for code in reader.code if code.startswith("{")))
    assert MESSAGE in told["studies"][0]["messages"]["words"]
    assert "<title>A &lt;title&gt;</title>" in text
    (data, other) = re.findall(r'src="data:image/webp;base64,([^"]+)"', text)
    assert data == other
    with Image.open(io.BytesIO(base64.b64decode(data))) as picture:
        assert picture.size == (PICTURE_WIDTH, round(500 * PICTURE_WIDTH / PAGE_WIDTH))
        # a lossy format: a few steps of 256
        assert picture.convert("RGB").getpixel((9, 9)) == pytest.approx((0, 0x72, 0xB2), abs=7)
    assert text.count("<figcaption>A curve of f &lt; 0 &amp; &#34;more&#34;</figcaption>") == 2
    assert text.index("<h3>Sec. 1</h3>") < text.index("<h3>Sec. 2</h3>")


def test_verdicts_have_the_words_and_classes_of_figures() -> None:
    """The page had 1 for yes, and "no value" where a stable cycle is not examined."""
    omitted = "nan if this is not examined: of a stable cycle, and without one"
    truth = {**TRUTH, "units": "1", "long_name": f"whether the motion is near, {omitted}"}
    study = xr.Dataset(
        {
            "status": ("Omega", np.zeros(3, np.int8), flagged("ok failed")),
            "near_motion": ("Omega", [1.0, 0.0, np.nan], truth),
        },
        {"Omega": [10.0, 12.0, 14.0]},
    )
    told = {one["name"]: one for one in contents_of("s", study)["variables"]}
    words = [told["near_motion"]["flags"][code] for code in numbers(told["near_motion"], "u1")]
    assert words == ["yes", "no", "no_value"]
    looks = dict(zip(told["near_motion"]["flags"], told["near_motion"]["looks"], strict=True))
    assert looks["no_value"]["label"] == "stable: not examined"
