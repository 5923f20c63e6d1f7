"""What is said of bad study files and command lines, word by word: `messages.json` beside this file.

``python -m tests.studies.test_messages`` writes the texts anew. A text that changes has to be looked at: it must say
no less than before.
"""

from __future__ import annotations

import contextlib
import io
import json
from pathlib import Path
from typing import Any

import pytest

from disc_model import cli
from disc_model.studies.study import StudyError, parse_study
from tests.trees import places, planted

FILE = Path(__file__).with_name("messages.json")
TEXTS: dict[str, list[dict[str, Any]]] = json.loads(FILE.read_text(encoding="utf-8"))
PLANTED = (None, True, -1, "x", [], {"x": 1})
"""What is put in the place of each value of the studies that are right."""


def faults_of(raw: Any) -> list[str]:
    """Of a file's content, those of its grids included."""
    try:
        parse_study(raw).grids()
    except StudyError as error:
        return list(error.faults)
    return []


def said_to(arguments: list[str]) -> str:
    """What a command line that is wrong writes to stderr."""
    with contextlib.redirect_stderr(io.StringIO()) as err, pytest.raises(SystemExit) as ended:
        cli.main(arguments)
    assert ended.value.code == 2
    return err.getvalue()


def planted_faults(raw: Any) -> dict[str, str]:
    """Faults of a study that is right with each value in turn replaced by each of `PLANTED`, where there are any."""
    found = {}
    for path in places(raw)[1:]:
        for value in PLANTED:
            if faults := faults_of(planted(raw, path, value)):
                found[f"{'.'.join(map(str, path))} = {value!r}"] = " | ".join(faults)
    return found


@pytest.mark.parametrize("entry", TEXTS["studies"], ids=lambda entry: entry["faults"][0][:60])
def test_texts_of_bad_studies(entry: dict[str, Any]) -> None:
    assert faults_of(entry["study"]) == entry["faults"]


@pytest.mark.parametrize("entry", TEXTS["planted"], ids=lambda entry: entry["study"].get("quantity", "cases"))
def test_texts_of_one_bad_value(entry: dict[str, Any]) -> None:
    assert planted_faults(entry["study"]) == entry["faults"]


@pytest.mark.parametrize("entry", TEXTS["commands"], ids=lambda entry: " ".join(entry["command"])[:60])
def test_texts_of_bad_command_lines(entry: dict[str, Any]) -> None:
    assert said_to(entry["command"]) == entry["said"]


def _written() -> None:
    """The file with today's texts."""
    for entry in TEXTS["studies"]:
        entry["faults"] = faults_of(entry["study"])
    for entry in TEXTS["planted"]:
        entry["faults"] = planted_faults(entry["study"])
    for entry in TEXTS["commands"]:
        entry["said"] = said_to(entry["command"])
    for kind, entries in TEXTS.items():
        TEXTS[kind] = [entry for entry in entries if entry.get("faults", entry.get("said"))]
    lines = {kind: ",\n".join(_line(entry) for entry in entries) for kind, entries in TEXTS.items()}
    text = ",\n".join(f'"{kind}": [\n{line}\n]' for kind, line in lines.items())
    FILE.write_text(f"{{\n{text}\n}}\n", encoding="utf-8")


def _line(entry: dict[str, Any]) -> str:
    """An entry on two lines, or as many as it has texts, so that differences are seen."""
    said, faults = (json.dumps(value, ensure_ascii=False) for value in entry.values())
    if isinstance(entry.get("faults"), dict):
        faults = json.dumps(entry["faults"], ensure_ascii=False, indent=1)
    first, second = entry
    return f'{{"{first}": {said},\n "{second}": {faults}}}'


if __name__ == "__main__":
    _written()
