"""What is gone since version 0.2 is refused with one line that names its successor."""

import importlib
from collections.abc import Iterator
from typing import Any, get_args

import pytest
from pydantic import BaseModel

import disc_model
from disc_model import cli
from disc_model.data.variables import SCALARS, Variable
from disc_model.errors import ParameterError
from disc_model.figures.kinds import KINDS, Mark
from disc_model.renamed import renamed, successors
from disc_model.studies.document import QUANTITIES, STATIC, VARIED, BifurcationOptions, RecordSpec
from disc_model.studies.grids.merge import summary_of

MODELS: list[type[BaseModel]] = [*(entry.options for entry in QUANTITIES.values()), *KINDS.values(), Mark, RecordSpec]


def columns(quantity: str) -> dict[str, Variable]:
    """Variables of the datasets of a quantity."""
    module = importlib.import_module(f"disc_model.studies.grids.quantities.{quantity}")
    summary = summary_of(quantity)
    return {**module.COLUMNS, **(summary.COLUMNS if summary else {})}


def places() -> Iterator[set[str]]:
    """Names that can stand in one place."""
    for quantity in QUANTITIES:
        yield {*columns(quantity)}
        yield {dim for column in columns(quantity).values() for dim in column.dims}
    yield from ({*model.model_fields} for model in MODELS)
    yield {*disc_model.__all__}
    yield from (set(SCALARS), set(VARIED), {STATIC}, set(cli.COMMANDS), set(cli.studies.KINDS))
    for model, key in ((BifurcationOptions, "section"), (Mark, "paper_outcome")):
        yield set(get_args(model.model_fields[key].annotation))


@pytest.mark.parametrize(("old", "new"), [(old, new) for old, several in successors().items() for new in several])
def test_a_successor_is_there_where_its_name_is_not(old: str, new: str) -> None:
    there = [names for names in places() if new in names]
    assert there
    assert not [names for names in there if old in names]
    assert any(renamed(old, names) == f": it is now called {new}" for names in there)


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.__name__)
def test_a_key_that_is_gone_is_refused_with_its_successor(model: Any) -> None:
    for old, several in successors().items():
        new = next((new for new in several if new in model.model_fields), None)
        if new is not None:
            with pytest.raises(ParameterError) as error:
                model.model_validate({old: 1})
            assert f"{old}=1: unknown key: it is now called {new}" in error.value.faults


def test_values_and_commands_that_are_gone_are_refused_with_their_successors(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with pytest.raises(ParameterError) as error:
        BifurcationOptions.model_validate({"transient": 1, "section": "switch"})
    (fault,) = error.value.faults
    assert fault == "section='switch': must be 'stroboscopic' or 'event': it is now called event"
    for words, new in ((["warm"], "compile"), (["list", "stale", "my.yaml"], "outdated")):
        with pytest.raises(SystemExit):
            cli.main(words)
        assert capsys.readouterr().err.endswith(f": it is now called {new}\n")
    with pytest.raises(AttributeError, match="it is now called coupled_natural_frequencies"):
        disc_model.__getattr__("slider_at_rest_frequencies")
