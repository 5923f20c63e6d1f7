"""Write the explorer page by the plan that its rule hands to standard input as JSON."""

import json
import logging
import sys
from pathlib import Path

from disc_model.data.dataset import load_result
from disc_model.errors import script
from disc_model.explorer import page, study_contents


@script
def main(output: str) -> None:
    plan = json.load(sys.stdin)
    studies = []
    for study in plan["studies"]:
        data, motions = (
            load_result(study[role]).to_dataset() if study[role] else None
            for role in ("data", "motions")
        )
        studies.append(study_contents(study["name"], data, motions, study["stated"]))
    text = page(plan["title"], studies)
    Path(output).write_text(text, encoding="utf-8")
    logging.info("%d studies, %.1f MB", len(studies), len(text.encode()) / 1e6)
