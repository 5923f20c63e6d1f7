"""Names of version 0.2 that were replaced, and their successors: keys, values, variables, commands and functions."""

import functools
from collections.abc import Collection
from pathlib import Path


@functools.cache
def successors() -> dict[str, list[str]]:
    """Successors by the old name, as in renamed.toml; a name with several meanings has several successors."""
    import tomllib  # for messages on errors alone

    found = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
    pairs = found.pop("with_interval").items()
    return found | {f"{old}{end}": [f"{new}{end}"] for old, new in pairs for end in ("", "_low", "_high")}


def renamed(name: object, known: Collection[str]) -> str:
    """Addition to a message on a replaced name, if its successor is among the known names; else ""."""
    new = next((new for new in successors().get(str(name), ()) if new in known), "")
    return f": it is now called {new}" if new else ""
