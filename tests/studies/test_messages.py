"""What is said of bad study files, command lines and values, word by word: `messages.json` beside this file.

``python -m tests.studies.test_messages`` writes the texts anew. A text that changes has to be looked at: it must say
no less than before.
"""

import contextlib
import io
import json
from collections.abc import Callable
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace
from typing import Any

import pytest

import disc_model as dm
from disc_model import cli
from disc_model.figures.kinds import PLOTS
from disc_model.plausibility import doubts
from disc_model.stability.continuation import continue_cycle
from disc_model.stability.lyapunov import lyapunov_exponents
from disc_model.stability.return_map import ReturnMap
from disc_model.studies.study import StudyError, misfits_of, parse_study, read_yaml
from disc_model.truncation import read_asked
from tests.trees import places, planted

FILE = Path(__file__).with_name("messages.json")
TEXTS: dict[str, list[dict[str, Any]]] = json.loads(FILE.read_text(encoding="utf-8"))
PLANTED = (None, True, -1, "x", [], {"x": 1})
"""What is put in the place of each value of the studies that are right."""


def faults_of(raw: Any) -> list[str]:
    """Of a file's content, or of its text, those of its grids included."""
    try:
        parse_study(read_yaml(raw)[0] if isinstance(raw, str) else raw).grids()
    except StudyError as error:
        return list(error.faults)
    return []


def values_of(dims: dict[str, list[Any]]) -> dict[str, list[tuple[Any, ...]]]:
    """Values along the dimensions of a study; those of a zip are lists in the file."""
    return {name: [tuple(one) if isinstance(one, list) else (one,) for one in row] for name, row in dims.items()}


def faults_of_figure(plot: dict[str, Any], dims: dict[str, list[Any]]) -> list[str]:
    """Of a figure of a study with these dimensions."""
    return [fault.in_file for fault in PLOTS[plot["kind"]].model_validate(plot).faults(values_of(dims))]


def faults_beside(plot: dict[str, Any], role: str, other: dict[str, Any]) -> list[str]:
    """Of another study that a figure shows beside its own."""
    shown = PLOTS[plot["kind"]].model_validate(plot)
    own = {"quantity": shown.quantities[0], "options": {}, "base": {"normalization": "as_published"}}
    own_study, other_study = (
        SimpleNamespace(
            quantity=one["quantity"],
            options=SimpleNamespace(**one["options"]),
            base=one["base"],
            values=values_of(one["dims"]),
        )
        for one in (own | {"dims": {name: [1] for name in shown.dims}}, other)
    )
    return list(misfits_of(shown, role, own_study, other_study))


def table(text: str) -> dm.Disc:
    """A disc from the text of its table."""
    with TemporaryDirectory() as folder:
        (path := Path(folder) / "disc.csv").write_text(text)
        return dm.read_disc(path)


KINDS = {"p": dm.Parameters, "record": dm.Record, "execution": dm.Execution, "ramps": dm.Ramp}


def given_to(function: Callable[..., Any]) -> Callable[..., Any]:
    """The function, for arguments of which cases, records and ramps are written as mappings."""

    def made(name: str, value: Any) -> Any:
        if isinstance(value, list) and name == "ramps":
            return tuple(dm.Ramp(**one) for one in value)
        return KINDS[name](**value) if name in KINDS and isinstance(value, dict) else value

    return lambda **given: function(**{name: made(name, value) for name, value in given.items()})


@cache
def slipping() -> dm.State:
    """Of a disc of two modes."""
    return dm.simulate(dm.Parameters(N=200, Omega=50, n_diameters=1), 0.0371).final_state


def simulated_from(**changes: Any) -> None:
    """The case of `slipping`, from that state with some values changed."""
    dm.simulate(dm.Parameters(N=200, Omega=50, n_diameters=1), 1.0, initial_state=slipping().replace(**changes))


def shown(r: float, theta: float, **case: Any) -> None:
    """The deflection of another case in a state of one of five modes."""
    dm.deflection(dm.Parameters(**case), dm.snapshots(dm.Parameters(N=200, Omega=20), 0.1), r, theta)


PUBLIC = "Parameters Window Poincare Record Disc Ramp choose_modes simulate snapshots floquet steady_sliding"
STABILITY = (continue_cycle, lyapunov_exponents, ReturnMap)
MADE = {
    **{name: given_to(getattr(dm, name)) for name in PUBLIC.split()},
    **{one.__name__: given_to(one) for one in (*STABILITY, simulated_from, shown, table)},
    "read_asked": lambda **v: read_asked(v),
}
CHECKED = {
    "figure": faults_of_figure,
    "figure beside": faults_beside,
    "doubts": lambda **given: list(doubts(dm.Parameters(**given)).values()),
    "yaml": lambda text: faults_of(text),
}


def faults_of_value(value: dict[str, dict[str, Any]]) -> list[str]:
    """Of what is made with these arguments, or of a figure; or what is doubted in parameters that are right."""
    [(what, given)] = value.items()
    if what in CHECKED:
        return CHECKED[what](**given)
    with pytest.raises(dm.ParameterError) as error:
        MADE[what](**given)
    return list(error.value.faults)


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


@pytest.mark.parametrize("entry", TEXTS["values"], ids=lambda entry: " ".join(entry["faults"])[:60])
def test_texts_of_bad_values(entry: dict[str, Any]) -> None:
    assert faults_of_value(entry["value"]) == entry["faults"]


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
    for entry in TEXTS["values"]:
        entry["faults"] = faults_of_value(entry["value"])
    for entry in TEXTS["planted"]:
        entry["faults"] = planted_faults(entry["study"])
    for entry in TEXTS["commands"]:
        entry["said"] = said_to(entry["command"])
    lines = {kind: ",\n".join(_line(entry) for entry in entries) for kind, entries in TEXTS.items()}
    text = ",\n".join(f'"{kind}": [\n{line}\n]' for kind, line in lines.items())
    FILE.write_text(f"{{\n{text}\n}}\n", encoding="utf-8")


def _line(entry: dict[str, Any]) -> str:
    """An entry on two lines, or as many as it has texts, so that differences are seen."""
    phrase, faults = (json.dumps(value, ensure_ascii=False) for value in entry.values())
    if isinstance(entry.get("faults"), dict):
        faults = json.dumps(entry["faults"], ensure_ascii=False, indent=1)
    first, second = entry
    return f'{{"{first}": {phrase},\n "{second}": {faults}}}'


if __name__ == "__main__":
    _written()
