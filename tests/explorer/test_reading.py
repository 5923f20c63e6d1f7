"""What a careful reader of the explorer's page sees of motions, marks, ends of axes and scales."""

import numpy as np
import pytest

from disc_model.explorer import Stated
from disc_model.explorer import study_contents as contents_of
from disc_model.studies.registry import quantity_of
from tests import needs
from tests.explorer.test_finding import Open, opened
from tests.explorer.test_page import flagged, motions, plane

pytestmark = [pytest.mark.slow, needs.BROWSER.mark]

__all__ = ["opened"]  # a fixture

OUTCOMES = "failed quiet steady_sliding undecided separation"


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
