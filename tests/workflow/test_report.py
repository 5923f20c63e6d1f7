"""The report in a real browser: everything in it can be opened, every figure loads, and the console
stays clean."""

from pathlib import Path

import pytest

from tests import needs
from tests.workflow.browser import browser
from tests.workflow.conftest import Project

pytestmark = [pytest.mark.slow, needs.BROWSER.mark]


def test_the_report_holds_every_result_and_needs_no_network(
    finished: Project, tmp_path: Path
) -> None:
    finished.complete("--report", "report.html")
    path = tmp_path / "profile"
    with browser(path) as page:
        page.open(finished.folder / "report.html")
        found = page.wait_for("return typeof categories === 'undefined' ? null : categories")
        page.wait_for("return document.body.innerText.includes('An elastic disc')")
        loaded = page.run("return performance.getEntriesByType('resource').map(x => x.name)")
        assert not [message for message in page.messages() if message["level"] == "SEVERE"]
    assert [name for name in loaded if not name.startswith(("data:", "file:", "blob:"))] == []
    assert found.keys() >= {"Claims of the paper", "Figures", "Maps and curves", "Provenance"}
    files = {
        Path(file).name for parts in found.values() for inside in parts.values() for file in inside
    }
    assert files >= {"fig11.png", "fig13.png", "chart.png", "claims.html", "provenance.html"}
