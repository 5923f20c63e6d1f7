"""Measure a part of the benchmark: truncation, contact_truncation, or answers, answer_maps or failure_maps of a method.

part : such as truncation, answers/RK4 or failure_maps/RK4_stick_slip
"""

import logging

import xarray as xr

from disc_model.benchmarks.answers.measure import Row, measure
from disc_model.benchmarks.failure_maps import answer_map, failure_map
from disc_model.benchmarks.truncation import contact_study, truncation_study
from disc_model.data.dataset import save
from disc_model.errors import script


def report(row: Row) -> None:
    logging.info(
        "%s %s %g: %.10g, error %.3g, %.4g s, %s %s",
        *(row.answer, row.line, row.setting, row.found, row.error, row.seconds, row.status.name, row.message),
    )


PARTS = {
    "truncation": lambda _: truncation_study(),
    "contact_truncation": lambda _: contact_study(),
    "answers": lambda method: measure(method, progress=report),
    "answer_maps": answer_map,
    "failure_maps": lambda name: failure_map(*name.split("_", 1)),
}


@script
def main(part: str, output: str) -> None:
    kind, _, name = part.partition("/")
    save(xr.DataTree(PARTS[kind](name)), output)
