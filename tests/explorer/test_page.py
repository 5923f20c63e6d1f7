"""The page as text: all in it, nothing fetched, nothing that breaks out of its place."""

import base64
import io
import json
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
from PIL import Image

from disc_model.explorer.page import PAGE_WIDTH, PICTURE_WIDTH, Picture, page
from tests.explorer import made_up

CAPTION = 'A curve of f < 0 & "more"'


@pytest.fixture
def figure(tmp_path: Path) -> Path:
    file = tmp_path / "fig.png"
    Image.new("RGB", (PAGE_WIDTH, 500), "#0072B2").save(file)
    return file


@pytest.fixture
def text(figure: Path) -> str:
    pictures = [Picture("Sec. 1", "One", CAPTION, figure), Picture("Sec. 2", "Two", CAPTION, figure)]
    return page("A <title>", made_up.contents(), pictures)


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
        if self.tags and self.tags[-1][0] in ("script", "style") and self.lasttag == self.tags[-1][0]:
            self.code.append(data)


def test_nothing_is_fetched(text):
    reader = Reader(text)
    addresses = [value for _, attrs in reader.tags for name, value in attrs.items() if name in ("src", "href")]
    assert len(addresses) >= 4
    assert all(re.match(r"data:|#", str(address)) for address in addresses)
    assert {"script", "style"} <= {tag for tag, _ in reader.tags}
    assert not re.search(r"url\(|@import|fetch\(|XMLHttpRequest|https?://", "".join(reader.code))


def test_texts_of_studies_stay_in_their_place(text):
    """A message that ends a script, a title with a tag."""
    reader = Reader(text)
    told = json.loads(next(code for code in reader.code if code.startswith("{")))
    assert made_up.MESSAGE in told["studies"][0]["messages"]["words"]
    assert [tag for tag, _ in reader.tags].count("script") == 2
    assert "<title>A &lt;title&gt;</title>" in text


def test_figures_have_pictures_and_captions(text):
    (data, other) = re.findall(r'src="data:image/webp;base64,([^"]+)"', text)
    assert data == other
    with Image.open(io.BytesIO(base64.b64decode(data))) as picture:
        assert picture.size == (PICTURE_WIDTH, round(500 * PICTURE_WIDTH / PAGE_WIDTH))
        # a lossy format: a few steps of 256
        assert picture.convert("RGB").getpixel((9, 9)) == pytest.approx((0, 0x72, 0xB2), abs=7)
    assert text.count("<figcaption>A curve of f &lt; 0 &amp; &#34;more&#34;</figcaption>") == 2
    assert text.index("<h3>Sec. 1</h3>") < text.index("<h3>Sec. 2</h3>")
