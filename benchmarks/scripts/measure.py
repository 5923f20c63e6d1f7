"""Measure a part of the benchmark, and write it as CSV: a study of `STUDIES` and its arguments."""

from benchmarks.answers import answers
from benchmarks.failure_maps import failure_map
from benchmarks.work_precision import work_precision
from disc_model.errors import script

STUDIES = {"work_precision": work_precision, "answers": answers, "failure_maps": failure_map}


@script
def main(output: str, study: str, *of: str) -> None:
    STUDIES[study](*of).to_csv(output, index=False)
