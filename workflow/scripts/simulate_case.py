"""Simulate one case, given as the text of `disc_model.simulation.case.CaseSpec.canonical`, and save
it."""

from pathlib import Path

from disc_model.data.dataset import save
from disc_model.errors import script
from disc_model.simulation.case import CaseSpec
from disc_model.simulation.named_case import run_case


@script
def main(case: str, output: str) -> None:
    path = Path(output)
    path.parent.mkdir(parents=True, exist_ok=True)
    save(run_case(CaseSpec.model_validate_json(case)), path)
