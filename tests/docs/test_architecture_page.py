"""docs/architecture.md speaks of what is there."""

import re
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
sys.path.insert(0, str(ROOT / "docs" / "drawings"))
import layers  # noqa: E402

PATHS = sorted(set(re.findall(r"`([\w./-]+(?:/|\.(?:py|yaml|smk|toml)))`", PAGE)))


@pytest.mark.parametrize("path", PATHS)
def test_every_path_exists(path):
    found = (ROOT / path, ROOT / "src" / "disc_model" / path)
    assert any(place.is_dir() if path.endswith("/") else place.is_file() for place in found)


def test_every_layer_is_in_the_picture():
    """In the order in which `lint-imports` holds them; `make drawings` draws it anew."""
    drawn = re.findall(
        r'class="name"[^>]*>(\w+)<', (ROOT / "docs" / "drawings" / "layers.svg").read_text(encoding="utf-8")
    )
    assert drawn == [part for layer in layers.layers() for part in layer]
    assert drawn == re.findall(r'class="name"[^>]*>(\w+)<', layers.draw())
