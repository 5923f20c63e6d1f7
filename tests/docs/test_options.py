"""The page of all options of quantities."""

from pathlib import Path

from docs.write_options import page_text

from disc_model.studies.options import options_of, value_text
from disc_model.studies.registry import quantity_names, quantity_of

PAGE = Path(__file__).parents[2] / "docs" / "study_options.md"


def test_the_page_is_made_from_the_models() -> None:
    """After a change of an option: make schema."""
    assert PAGE.read_text(encoding="utf-8") == page_text()


def test_every_option_is_described_with_its_form_unit_and_default() -> None:
    for name in quantity_names():
        quantity = quantity_of(name)
        options = options_of(quantity)
        assert {option.name for option in options} == set(quantity.model_fields)
        for option in options:
            assert option.meaning not in ("", "None"), (name, option.name)
            assert (option.default == "required") == quantity.model_fields[
                option.name
            ].is_required()
    basins = {option.name: option for option in options_of(quantity_of("basins"))}
    assert basins["energies"][1:4] == ("list of numbers", "J", "[0]")
    assert basins["n_starts"][1:4] == ("whole number from 1 to 100000", "", "1")
    assert basins["confidence"][1:4] == ("number > 0 and < 1", "", "0.95")
    branches = {option.name: option for option in options_of(quantity_of("branches"))}
    assert branches["scan"][1:4] == (
        "range {start, stop, count or step}",
        "that of `parameter`",
        "required",
    )
    assert branches["sweep_from"][1:4] == ("number", "that of `parameter`", "")


def test_values_of_options_are_shown_as_files_have_them() -> None:
    shown = {0.5: "0.5", 480.0: "480", 3: "3", True: "true", None: "", "event": "event"}
    assert {value: value_text(value) for value in shown} == shown
    assert value_text((0.0, 1e-10)) == "[0, 1e-10]"
    assert value_text({"u": 1e-3}) == "{u: 0.001}"
