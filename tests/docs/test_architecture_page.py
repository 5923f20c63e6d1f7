"""docs/architecture.md speaks of what is there."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
sys.path.insert(0, str(ROOT / "docs" / "drawings"))
import floors  # noqa: E402

PATHS = sorted(set(re.findall(r"`([\w./-]+(?:/|\.(?:py|yaml|smk|toml)))`", PAGE)))


@pytest.mark.parametrize("path", PATHS)
def test_every_path_exists(path):
    found = (ROOT / path, ROOT / "src" / "disc_model" / path)
    assert any(place.is_dir() if path.endswith("/") else place.is_file() for place in found)


def test_the_page_names_paths():
    assert len(PATHS) > 40


def test_every_floor_is_in_the_picture():
    """In the order in which `lint-imports` holds them; `make drawings` draws it anew."""
    drawn = re.findall(
        r'class="name"[^>]*>(\w+)<', (ROOT / "docs" / "drawings" / "floors.svg").read_text(encoding="utf-8")
    )
    assert drawn == [part for floor in floors.floors() for part in floor]
    assert drawn == re.findall(r'class="name"[^>]*>(\w+)<', floors.draw())


def test_every_part_of_the_package_is_among_the_rooms():
    rooms = PAGE.split("## What each room may know")[1].split("\n## ")[0]
    rest = {"flexibility", "errors"}
    named = set(re.findall(r"`(\w+)(?:/|\.py)`", rooms))
    assert {part for floor in floors.floors() for part in floor} - rest <= named
