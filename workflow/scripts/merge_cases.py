"""Merge the files of cases, each named after its case, into one; labels: JSON, by case its title and reference."""

import json
from pathlib import Path

from disc_model.data.dataset import load_cases, save
from disc_model.errors import script
from disc_model.studies.merge import merge_cases


@script
def main(labels: str, output: str, *cases: str) -> None:
    save(merge_cases(load_cases([Path(case) for case in cases]), json.loads(labels)), output)
