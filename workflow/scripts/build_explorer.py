"""Write the page on which grid studies, motions and figures are looked at.

What it holds is read from standard input as JSON: ``title``; ``studies``, each with ``name``, ``data`` and ``motions``
(netCDF files; the latter may be "") and what these show as ``said``; ``pictures``, each with ``heading``, ``title``,
``caption`` and ``file`` (PNG).
"""

from __future__ import annotations

import argparse
import json
import logging
import sys
from pathlib import Path

from disc_model.data.dataset import load_inputs
from disc_model.errors import exit_on_error
from disc_model.explorer.contents import study_contents
from disc_model.explorer.page import Picture, page

log = logging.getLogger(__name__)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", type=Path, help="HTML file to write")
    args = parser.parse_args()
    logging.basicConfig(level=logging.INFO, format="%(name)s: %(message)s")
    plan = json.load(sys.stdin)
    studies = []
    for study in plan["studies"]:
        given = [Path(study[role]) for role in ("data", "motions") if study[role]]
        data, *motions = (tree.to_dataset() for tree in load_inputs(given))
        studies.append(study_contents(study["name"], data, next(iter(motions), None), study["said"]))
    pictures = [Picture(**{**picture, "file": Path(picture["file"])}) for picture in plan["pictures"]]
    text = page(plan["title"], studies, pictures)
    args.output.write_text(text, encoding="utf-8")
    log.info("%d studies, %d figures, %.1f MB", len(studies), len(pictures), len(text.encode()) / 1e6)


if __name__ == "__main__":
    exit_on_error(main)
