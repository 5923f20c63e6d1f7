"""What a careful reader of the explorer's page sees of motions, marks, ends of axes and scales."""

import json
from typing import Any

import numpy as np
import pytest
import xarray as xr

from disc_model.explorer import Stated
from disc_model.explorer import study_contents as contents_of
from disc_model.studies.registry import quantity_of
from tests import needs
from tests.explorer.test_finding import Open, opened
from tests.explorer.test_page import flagged, motions, plane

pytestmark = [pytest.mark.slow, needs.BROWSER.mark]

__all__ = ["opened"]  # a fixture

OUTCOMES = "failed quiet steady_sliding undecided separation"
SENTENCES = {
    "quiet": "The motion on the cycle that it has settled to.",
    "steady_sliding": "The steady sliding that the motion has settled to.",
    "undecided": "The motion at the horizon.",
    "separation": "The motion a while after the first separation.",
}


@pytest.mark.parametrize("word", list(SENTENCES))
def test_the_page_says_what_a_motion_is(opened: Open, word: str) -> None:
    """It said of every motion that it is one of three."""
    study = plane()
    code = OUTCOMES.split().index(word)
    study["outcome"] = study["outcome"].copy(data=np.full(study["outcome"].shape, code, np.int8))
    study["outcome"].attrs = flagged(OUTCOMES)
    assert sentence(opened, study, "outcome").endswith(f" {SENTENCES[word]}")


def sentence(opened: Open, study: xr.Dataset, name: str) -> str:
    """What the page says of the motion at the point that is shown, as of a study of a quantity."""
    quantity = quantity_of(name)
    stated = Stated(quantity.motion, motion_by=quantity.motion_by)
    with opened([contents_of("plane", study, motions(), stated)]) as shown:
        return str(shown.text("motion-note"))


KINDS = "failed quiet separating irregular"


@pytest.mark.parametrize("word", ["quiet", "separating", "irregular"])
def test_the_page_says_what_a_motion_comes_to_after_its_transient(opened: Open, word: str) -> None:
    """Samples of a bifurcation diagram have a kind, which the sentence on the motion did not say."""
    study = plane().drop_vars(["outcome", "growth_rate"])
    code = KINDS.split().index(word)
    study["kind"] = study["status"].copy(data=np.full(study["status"].shape, code, np.int8))
    study["kind"].attrs = flagged(KINDS)
    said = sentence(opened, study, "bifurcation")
    assert said.endswith(quantity_of("bifurcation").motion_by[word])


def test_every_word_of_what_a_motion_comes_to_has_its_sentence() -> None:
    for name in ("outcome", "regions", "bifurcation"):
        quantity = quantity_of(name)
        words = quantity.COLUMNS["kind" if name == "bifurcation" else "outcome"].flags
        assert {*words} - {"failed"} <= {*quantity.motion_by}


def test_the_page_says_whether_the_cycle_that_it_shows_is_stable(opened: Open) -> None:
    """It was the cycle, "stable or not"."""
    study = plane().drop_vars("outcome")
    quantity = quantity_of("floquet")
    stated = Stated(quantity.motion, motion_by=quantity.motion_by)
    said = {}
    with opened([contents_of("plane", study, motions(), stated)]) as shown:
        for word, sign in (("stable", -1), ("unstable", 1)):
            rates = study["growth_rate"].values
            found = np.argwhere(sign * rates > 0)[0].tolist()
            shown.page.run(
                "choose({N: arguments[0], Omega: arguments[1], normalization: arguments[2]})",
                *found,
            )
            said[word] = shown.text("motion-note")
    for word, text in said.items():
        assert quantity.motion_by[word] in text


def test_maps_end_at_their_first_and_last_values(opened: Open) -> None:
    """A map of 76 to 248 rpm had an axis from 65 to 258 rpm; the figure ends at the data."""
    with opened([contents_of("plane", plane())]) as shown:
        for first, last, begin, end in shown.ask("ends"):
            assert [begin, end] == [first, last]
        # cells of words are whole
        shown.choose("Up", "normalization")
        borders = shown.page.run("return drawn.ys.borders")
        assert borders == [-0.5, 0.5, 1.5]


def test_the_ends_of_a_curve_can_be_chosen(opened: Open) -> None:
    """Its marks are whole within the frame, and room beside them belongs to them."""
    with opened([contents_of("plane", plane())]) as shown:
        shown.choose("Up", "")
        ends = shown.page.run(
            "const {box, horizontal, xs} = drawn;"
            "return [horizontal(xs.at[0]) - box.left, box.right - horizontal(xs.at.at(-1))]"
        )
        left_of_all = (
            "const {left, top} = document.getElementById('map').getBoundingClientRect();"
            "const event = {clientX: left + drawn.box.left + 1, clientY: top + drawn.box.top + 9};"
            "return cellAt(document.getElementById('map'), event)[view.x]"
        )
        assert shown.page.run(left_of_all) == 0
    assert ends == pytest.approx([8, 8])


def test_a_chosen_class_is_marked_unlike_stable_points(opened: Open) -> None:
    """Dots of points known by simulation lay among the dots of stable growth rates."""
    with opened([contents_of("plane", plane())]) as shown:
        drawn = {}
        record = (
            "const names = []; const ink = document.createElement('canvas').getContext('2d');"
            "for (const name of ['arc', 'lineTo']) ink[name] = () => names.push(name);"
            "markOfClass(ink, chosenClass(), 8, 8, 3); return [...new Set(names)]"
        )
        for option in ("growth_rate=stable", "outcome=quiet"):
            shown.choose("Marks", option)
            drawn[option] = shown.page.run(record)
    assert drawn["growth_rate=stable"] == ["arc"]
    assert drawn["outcome=quiet"] == ["lineTo"]


def test_only_classes_that_occur_can_be_marked(opened: Open) -> None:
    """The list had all words of all flags, most of which no point had."""
    with opened([contents_of("plane", plane())]) as shown:
        assert "outcome=separation" in shown.ask("options", "Marks")
        study = plane()
        study["outcome"].values[:] = -1
    with opened([contents_of("plane", study)]) as shown:
        options = shown.ask("options", "Marks")
    assert "outcome=quiet" in options
    assert "outcome=separation" not in options


def test_a_study_that_is_not_found_stands_apart(opened: Open) -> None:
    """It stood among those that the search had found."""
    told = [contents_of(f"map_{i}", plane()) for i in range(9)]
    search = (
        "const field = document.querySelector('#search input');"
        "field.value = arguments[0]; field.dispatchEvent(new Event('input'));"
        "return [...document.querySelector('#controls select').children].map(one =>"
        " one.label && one.children.length ? [one.label, one.children[0].value] : one.value)"
    )
    with opened(told) as shown:
        apart = ["still shown, but not found", "map_0"]
        assert shown.page.run(search, "map_7") == ["map_7", apart]
        assert shown.page.run(search, "map_0") == ["map_0"]


def along_speed(values: list[float], long_name: str, units: str) -> xr.Dataset:
    """A study of one variable over the speed."""
    speeds = {"Omega": np.linspace(10.0, 16.0, len(values))}
    data = {"found": ("Omega", values, {"long_name": long_name, "units": units})}
    return xr.Dataset(data, speeds, {"title": "Line"})


def test_an_axis_without_any_value_has_no_numbers(opened: Open) -> None:
    """A time of separation that no point had was on an axis from 0 to 1 s."""
    study = along_speed([np.nan] * 4, "time", "s")
    with opened([contents_of("line", study)]) as shown:
        assert shown.page.run("return drawn.ys.ticks()") == []


def test_counts_are_not_joined(opened: Open) -> None:
    """A line led from period 1 to 0, "not shown", and back."""
    joined = {}
    for name, values in {"count": [1.0, 0.0, 1.0, 2.0], "number": [1.0, 0.5, 1.0, 2.0]}.items():
        with opened([contents_of("line", along_speed(values, "period", "1"))]) as shown:
            joined[name] = shown.page.run("return isJoined()")
    assert joined == {"count": False, "number": True}


@pytest.mark.parametrize(
    ("numbers", "middle"), [([31.9, 47.3], 39.6), ([0.0] * 18 + [60.0, 140.0], 70.0)]
)
def test_few_values_have_an_even_scale(opened: Open, numbers: list[float], middle: float) -> None:
    """The scale of two times had the ticks 31.9, 32.2, 33, 36, 47.3."""
    with opened([contents_of("plane", plane())]) as shown:
        ticks: list[Any] = shown.page.run(
            "view.colours = 'auto'; return colouring(arguments[0], {}).ticks(600)", numbers
        )
    assert ticks[2][1] == pytest.approx(middle)


@pytest.mark.parametrize(("word", "time"), [("separation", 1000), ("quiet", 60)])
def test_a_motion_is_simulated_until_it_separates(opened: Open, word: str, time: int) -> None:
    """Where its time is not known, a call of 60 s showed a motion in contact."""
    study = plane()
    code = OUTCOMES.split().index(word)
    study["outcome"] = study["outcome"].copy(data=np.full(study["outcome"].shape, code, np.int8))
    study["outcome"].attrs = flagged(OUTCOMES)
    untimed = np.full(study["outcome"].shape, np.nan)
    meaning = {"units": "s", "long_name": "time of the first separation"}
    study["first_separation"] = (study["outcome"].dims, untimed, meaning)
    stated = Stated(call={"options": {"horizon": 1000}})
    with opened([contents_of("plane", study, None, stated)]) as shown:
        call = shown.text("motion-call")
    assert call.endswith(f", {time}).plot()")


def test_a_word_among_the_fixed_values_has_no_unit(opened: Open) -> None:
    """It read "friction on the surface mm"."""
    study = plane()
    study.attrs["base"] = json.dumps({"friction_offset": "surface", "friction_decay": "inf"})
    with opened([contents_of("plane", study)]) as shown:
        rows = shown.page.run(
            "return [...document.querySelectorAll('#fixed td')].map(x => x.textContent)"
        )
    assert rows == ["friction on the surface", "inf s/m"]
