"""What a newcomer looks for first is where it is looked for."""

from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_the_site_begins_with_what_it_is_and_how_to_install_it() -> None:
    text = (ROOT / "docs" / "index.md").read_text()
    assert text.index("elastic disc") < text.index("## Install") < text.index("make env") < text.index("toctree")


def test_who_makes_the_site_is_told_where_it_begins() -> None:
    rule = (ROOT / "Makefile").read_text().partition("\ndocs:")[2].partition("\n\n")[0]
    assert "html docs docs/_build/html" in rule
    assert "docs/_build/html/index.html" in rule.partition("@echo")[2]


def test_a_study_of_one_s_own_leads_to_the_explorer() -> None:
    """Its page was named with the paper's study alone."""
    assert "make explore" in (ROOT / "README.md").read_text()
    assert "make explore STUDY=" in (ROOT / "docs" / "studies.md").read_text()
