"""The report in a real browser: everything in it can be opened, every figure loads, and the console stays clean."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from tests import needs
from tests.workflow.browser import Page, browser
from tests.workflow.conftest import Project

pytestmark = [pytest.mark.workflow, pytest.mark.slow, needs.BROWSER.mark]

CATEGORIES = {"Claims of the paper", "Figures of the paper", "Provenance"}


def results_by_place(page: Page) -> dict[tuple[str, str], list[str]]:
    """Files in the report, by category and subcategory; "" for the one subcategory of a category, which has no menu."""
    found = page.wait_for("return typeof categories === 'undefined' ? null : categories")
    return {
        (name, part if len(parts) > 1 else ""): files for name, parts in found.items() for part, files in parts.items()
    }


def look_at_everything(page: Page, report: Path) -> list[str]:
    """Open every result through the report's own menus; raises if one does not show."""
    seen = []
    for (category, part), files in results_by_place(page).items():
        open_list(page, report, category, part, len(files))
        names = set()
        for i in range(len(files)):
            page.run(f"document.querySelectorAll('a[iconname=eye]')[{i}].click()")
            names.add(shown_file(page, names))
        assert names == set(files)
        seen += files
    return seen


def open_list(page: Page, report: Path, category: str, part: str, count: int) -> None:
    """Go to the list of a category's results from the start. The menus take no click while they are being drawn."""
    page.open(report)
    page.wait_for("return document.body.innerText.includes('GENERAL')")
    for text in [category, *([part] if part else [])]:
        time.sleep(0.5)
        page.click(text)
    page.wait_for(f"return document.querySelectorAll('a[iconname=eye]').length === {count}")
    time.sleep(0.5)


def shown_file(page: Page, before: set[str]) -> str:
    """The result that is now in view: a picture that was decoded, or a page with some height; not one of before."""
    found: str = page.wait_for(
        """const views = [...document.querySelectorAll("img, iframe")]
             .filter(x => x.offsetWidth > 300 && x.offsetHeight > 100)
             .filter(x => x.tagName === "IFRAME" || (x.complete && x.naturalWidth > 900));
           const files = Object.keys(results).filter(name => !arguments[0].includes(name));
           return files.find(name => views.some(x => x.src === results[name].data_uri));""",
        sorted(before),
    )
    return found


def assert_clean(page: Page) -> None:
    severe = [message for message in page.messages() if message["level"] == "SEVERE"]
    assert severe == []


@pytest.fixture(scope="module")
def report(finished: Project) -> Path:
    """The report of the small study."""
    finished.complete("--report", "results/tiny/report.html")
    return finished.folder / "results" / "tiny" / "report.html"


@pytest.mark.parametrize("dark", [False, True])
def test_every_result_of_the_report_opens(report: Path, tmp_path: Path, dark: bool) -> None:
    with browser(tmp_path / "profile", dark=dark) as page:
        page.open(report)
        assert {category for category, _ in results_by_place(page)} >= CATEGORIES
        seen = look_at_everything(page, report)
        assert_clean(page)
    assert {Path(file).name for file in seen} == {"fig11.png", "fig13.png", "claims.html", "provenance.html"}


def test_the_report_needs_no_network(report: Path, tmp_path: Path) -> None:
    with browser(tmp_path / "profile") as page:
        page.open(report)
        page.wait_for("return document.body.innerText.includes('An elastic disc')")
        loaded = page.run("return performance.getEntriesByType('resource').map(x => x.name)")
    assert [name for name in loaded if not name.startswith(("data:", "file:", "blob:"))] == []


def test_pages_are_readable_on_light_and_dark(finished: Project, tmp_path: Path) -> None:
    contrast = """
        const parse = text => text.match(/[0-9.]+/g).slice(0, 3).map(Number);
        const light = c => { const [r, g, b] = parse(c).map(x => x / 255)
            .map(x => x <= 0.03928 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
            return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
        const back = light(getComputedStyle(document.body).backgroundColor);
        return Math.min(...[...document.querySelectorAll("td, td div, td span, p, h1")].map(x => {
            const text = light(getComputedStyle(x).color);
            return (Math.max(text, back) + 0.05) / (Math.min(text, back) + 0.05); }));"""
    with browser(tmp_path / "profile") as page:
        for scheme in ("light", "dark"):
            page.prefer(scheme)
            for name in ("claims.html", "provenance.html"):
                page.open(finished.folder / "results" / "tiny" / name)
                assert page.run(contrast) >= 4.5, (scheme, name)


@pytest.mark.skipif("DISC_MODEL_REPORT" not in os.environ, reason="DISC_MODEL_REPORT does not name a report")
def test_a_given_report(tmp_path: Path) -> None:
    started = time.monotonic()
    with browser(tmp_path / "profile") as page:
        report = Path(os.environ["DISC_MODEL_REPORT"])
        page.open(report)
        seen = look_at_everything(page, report)
        assert_clean(page)
    assert len(seen) > 30
    assert time.monotonic() - started < 600
