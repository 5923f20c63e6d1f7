"""Points that the rule of a study leaves out, in the explorer, and where it opens a study."""

from collections.abc import Iterator

import pytest

from disc_model.explorer import Stated, page
from disc_model.explorer import study_contents as contents_of
from tests import needs
from tests.explorer.left_out import CALL, RULE, ruled
from tests.explorer.test_in_browser import READY, Explorer
from tests.workflow.browser import browser


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Explorer]:
    """The page of the study; a figure of it stands at the value that is left out."""
    folder = tmp_path_factory.mktemp("left_out")
    path = folder / "explorer.html"
    stated = Stated(call=CALL, at={"mu_s": 0.2})
    told = [contents_of("ruled", ruled(), stated=stated)]
    path.write_text(page("Made up", told, []), encoding="utf-8")
    with browser(folder / "profile") as opened:
        opened.resize(1280, 800)
        opened.open(path)
        opened.wait_for(READY)
        yield Explorer(opened)


@pytest.mark.slow
@needs.BROWSER.mark
def test_a_study_opens_where_there_are_values(shown: Explorer) -> None:
    """It opened on an empty map, as the words of a class are not gaps."""
    assert "μₛ = 0.4" in shown.text("map-title")
    assert shown.text("point").endswith("quiet")
    assert shown.text("call").endswith('found["outcome"].item()')


@pytest.mark.slow
@needs.BROWSER.mark
@pytest.mark.parametrize("variable", ["outcome", "P_max"])
def test_a_point_that_is_left_out_has_no_call(shown: Explorer, variable: str) -> None:
    """Its call raised an error, and "left out:" had no reason."""
    shown.choose("Variable", variable)
    shown.page.run("choose({Omega: 2, N: 1, mu_s: 1})")
    assert shown.text("point").endswith("left out")
    assert RULE in shown.text("call-says")
    assert shown.text("message") == f"left out: by the study's rule “{RULE}”"
    assert shown.text("call") == ""
    assert shown.page.run("return element('motion-by-call').hidden")
