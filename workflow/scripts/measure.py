"""Measure a part of the benchmark: truncation, contact_truncation, or answers, answer_maps or failure_maps of a method.

part : such as truncation, answers/RK4 or failure_maps/RK4_stick_slip
"""

import xarray as xr

from disc_model.benchmarks.answers.measure import measure
from disc_model.benchmarks.failure_maps import answer_map, failure_map
from disc_model.benchmarks.truncation import contact_study, truncation_study
from disc_model.data.dataset import save
from disc_model.errors import script

PARTS = {
    "truncation": lambda _: truncation_study(),
    "contact_truncation": lambda _: contact_study(),
    "answers": measure,
    "answer_maps": answer_map,
    "failure_maps": lambda name: failure_map(*name.split("_", 1)),
}


@script
def main(part: str, output: str) -> None:
    kind, _, name = part.partition("/")
    save(xr.DataTree(PARTS[kind](name)), output)
