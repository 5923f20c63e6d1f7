"""Tables of the measured answers."""

import json

import pandas as pd
import xarray as xr

from disc_model.benchmarks import texts
from disc_model.data.variables import flag_names

MODELS = ("rigid", "residual")
COLUMNS = ["answer", "label", "at", "found", "low", "high", "cells", "error", "seconds", "verdict", "status", "message"]
"""Columns of the report."""


def points(dataset: xr.Dataset) -> pd.DataFrame:
    """All rows, in the order in which they were measured; status, verdict and setting (``at``) in words."""
    found = dataset.to_dataframe()
    counted = found["varies"] == "diameters"
    at = [f"{x:.0f} diameters" if count else f"{kind}={x:g}"
          for count, kind, x in zip(counted, found["varies"], found["setting"], strict=True)]  # fmt: skip
    return found.assign(at=at, **{name: flag_names(dataset[name]) for name in ("status", "verdict")})


def right_numbers(model: pd.DataFrame) -> str:
    """Numbers of nodal diameters with which a reduced model answers correctly."""
    return ", ".join(f"{count:.0f}" for count in model["setting"][model["verdict"] == "right"])


def within(enough: float, units: str) -> str:
    """Tolerance of an answer as text."""
    unit = units.replace("rad s-1", "rad/s").replace("s-1", "1/s")
    return f"{enough:g}" if units == "1" else f"{enough:g} {unit}"


def to_markdown(dataset: xr.Dataset) -> str:
    """The tables as Markdown: a section per question, its correct answer and tolerance; the machine stands above."""
    about = texts.TEXTS["answers_page"].fill(machine=dataset.attrs["machine"])
    titles = {
        name: f"{own['title'].capitalize()}: to {within(own['enough'], own['units'])}, reference to {own['error']}"
        for name, own in json.loads(dataset.attrs["questions"]).items()
    }
    frame = points(dataset)[COLUMNS]
    return texts.report(dataset.attrs["title"], about, frame.assign(answer=frame["answer"].map(titles)), "answer")
