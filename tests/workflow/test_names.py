"""Names that the workflow lists without importing the package."""

from __future__ import annotations

from pathlib import Path

from disc_model.benchmarks import scenes


def test_the_rules_name_every_scene_and_every_failure_map() -> None:
    rules = (Path(__file__).parents[2] / "workflow/rules/benchmark.smk").read_text()
    from disc_model.benchmarks.failure_maps import VALUES

    for name in (*scenes.SCENES, *VALUES):
        assert f'"{name}"' in rules
