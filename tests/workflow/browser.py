"""A real browser, driven over WebDriver with the standard library alone."""

import contextlib
import json
import socket
import subprocess
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tests import needs

BROWSER, DRIVER = (needs.program(*names) for names in needs.BROWSER.programs)
OPTIONS = [
    f"--{name}"
    for name in ("headless=new", "no-sandbox", "disable-gpu", "disable-background-networking")
]
OPTIONS.append("--disable-dev-shm-usage")


class Page:
    """A page opened in a browser of its own."""

    def __init__(self, address: str) -> None:
        self.address = address

    def call(self, method: str, path: str, body: Any = None) -> Any:
        if body is None:
            data = None
        else:
            data = json.dumps(body).encode()
        headers = {"Content-Type": "application/json"}
        request = urllib.request.Request(
            self.address + path, method=method, data=data, headers=headers
        )
        with urllib.request.urlopen(request, timeout=120) as answer:
            return json.load(answer)["value"]

    def open(self, file: Path) -> None:
        self.call("POST", "/url", {"url": file.resolve().as_uri()})

    def run(self, script: str) -> Any:
        """Result of the body of a JavaScript function."""
        return self.call("POST", "/execute/sync", {"script": script, "args": []})

    def wait_for(self, script: str) -> Any:
        """The first result that is not false, null or empty; fails after 20 s."""
        until = time.monotonic() + 20
        while not (found := self.run(script)):
            assert time.monotonic() < until, f"still waiting for {script}"
            time.sleep(0.05)
        return found

    def click(self, x: float, y: float) -> None:
        """Click at a place in the window."""
        steps = [
            {"type": "pointerMove", "x": round(x), "y": round(y), "duration": 0},
            {"type": "pointerDown", "button": 0},
            {"type": "pointerUp", "button": 0},
        ]
        source = {
            "type": "pointer",
            "id": "mouse",
            "parameters": {"pointerType": "mouse"},
            "actions": steps,
        }
        self.call("POST", "/actions", {"actions": [source]})

    def messages(self) -> list[dict[str, Any]]:
        """What the page wrote to the console since this was last asked."""
        return list(self.call("POST", "/se/log", {"type": "browser"}))


@contextlib.contextmanager
def browser(profile: Path) -> Iterator[Page]:
    """A headless Chromium with an empty profile."""
    assert needs.BROWSER.met, needs.BROWSER.reason
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    driver = subprocess.Popen(
        [DRIVER, f"--port={port}"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    try:
        root = Page(f"http://127.0.0.1:{port}")
        _wait(root)
        arguments = [*OPTIONS, "--window-size=1400,1000", f"--user-data-dir={profile}"]
        wanted = {
            "browserName": "chrome",
            "goog:chromeOptions": {"args": arguments, "binary": BROWSER},
            "goog:loggingPrefs": {"browser": "ALL"},
        }
        session = root.call("POST", "/session", {"capabilities": {"alwaysMatch": wanted}})[
            "sessionId"
        ]
        page = Page(f"{root.address}/session/{session}")
        try:
            yield page
        finally:
            page.call("DELETE", "")
    finally:
        driver.terminate()
        driver.wait(20)


def _wait(root: Page) -> None:
    until = time.monotonic() + 30
    while True:
        try:
            root.call("GET", "/status")
        except (urllib.error.URLError, ConnectionError):
            assert time.monotonic() < until, "chromedriver does not answer"
            time.sleep(0.1)
        else:
            return
