"""Measure a part of the benchmark.

part : work_precision, truncation or contact_truncation, or a study and what it is of, such as answers/RK4,
    answer_maps/RK4 or failure_maps/RK4_stick_slip
"""

import xarray as xr

from disc_model.benchmarks.answers import answers
from disc_model.benchmarks.maps import answer_map, failure_map
from disc_model.benchmarks.truncation import contact_study, truncation_study
from disc_model.benchmarks.work_precision import work_precision
from disc_model.data.dataset import save
from disc_model.errors import script

STUDIES = {
    "work_precision": work_precision,
    "truncation": truncation_study,
    "contact_truncation": contact_study,
    "answers": answers,
    "answer_maps": answer_map,
    "failure_maps": failure_map,
}


@script
def main(part: str, output: str) -> None:
    study, _, of = part.partition("/")
    save(xr.DataTree(STUDIES[study](*of.split("_", 1)) if of else STUDIES[study]()), output)
