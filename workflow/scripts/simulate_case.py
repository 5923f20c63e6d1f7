"""Simulate one case, given as the text of `disc_model.simulation.case.CaseSpec.canonical`, and save it.

A killed job continues when it is run again, from a hidden file beside its output. Snakemake does not know this file and
leaves it when it removes the output of a failed job.
"""

from pathlib import Path

from disc_model.data.dataset import save
from disc_model.errors import script
from disc_model.mode_choice import choose_when_run
from disc_model.simulation.api import run_case
from disc_model.simulation.case import CaseSpec
from disc_model.simulation.recorder import SET_ASIDE


@script
def main(case: str, output: str) -> None:
    place = Path(output)
    place.parent.mkdir(parents=True, exist_ok=True)
    checkpoint = place.with_name(f".{place.stem}.checkpoint")
    save(run_case(CaseSpec.from_canonical(case), checkpoint, choose_when_run), place)
    for former in checkpoint.parent.glob(f"{checkpoint.name}.*{SET_ASIDE}"):  # of former contents of the case
        former.unlink()
    checkpoint.unlink(missing_ok=True)
