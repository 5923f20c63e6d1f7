"""The explorer's page: contents of studies, packed for JSON, with pictures, style and script in one
file."""

import base64
import io
import json
import zlib
from collections.abc import Mapping, Sequence
from importlib.resources import files
from itertools import groupby
from operator import attrgetter
from pathlib import Path
from typing import Any, NamedTuple

import jinja2
import numpy as np
import xarray as xr
from cmcrameri import cm
from matplotlib.colors import to_hex
from numpy.typing import NDArray
from PIL import Image, ImageOps

from disc_model.data.variables import attributes
from disc_model.figures.classes import looks_of
from disc_model.figures.drawing import PHASE_COLOURS
from disc_model.parameters import RATIOS, Parameters

# ---- Contents of studies: numbers packed, words as they are

TRACES = ("P", "u", "psi")
LEVELS = 65535  # steps between the least and the greatest value of a stored history
BITS = 17  # number of bits kept of the 23 of a 32-bit mantissa: five digits, as many as are shown


def study_contents(
    name: str, study: xr.Dataset, motions: xr.Dataset | None = None, text: str = ""
) -> dict[str, Any]:
    """Contents of a merged study: fixed parameters, dimensions, variables, messages; motions, and a
    text on these."""
    study = study.transpose(*study.sizes)
    base = json.loads(study.attrs.get("base", "{}"))
    messages = None
    if "message" in study:  # as indices into the distinct ones; most points share theirs
        words, indices = np.unique(study["message"].values.astype(str), return_inverse=True)
        messages = {
            "dims": [*study["message"].dims],
            "words": words.tolist(),
            "data": packed(indices, "<u4"),
        }
    return {
        "name": name,
        "title": str(study.attrs.get("title", "")) or name,
        "fixed": [
            _named(name, attributes(name)) | {"value": value} for name, value in base.items()
        ],
        "dims": [_dimension(study, str(dim)) for dim in study.sizes],
        "variables": [
            _variable(x) for x in study.data_vars.values() if x.ndim and x.dtype.kind in "biuf"
        ],
        "messages": messages,
        "motions": None if motions is None else motion_contents(motions, text),
    }


def motion_contents(motions: xr.Dataset, text: str = "") -> dict[str, Any]:
    """Histories along `point` and `sample` with 16 bits per sample, phases as runs; failed ones are
    left out."""
    good = motions.isel(point=np.flatnonzero(motions["status"].values == 0))
    names = [str(name) for name in good.coords if good[name].dims == ("point",)]
    points = zip(*(good[name].values.tolist() for name in names), strict=True)
    lengths, phases = good["length"].values.tolist(), good["phase"].values
    return {
        "text": text,
        "names": names,
        "samples": good.sizes["sample"],
        "phases": good["phase"].attrs["flag_meanings"].split(),
        "traces": [
            {"name": name, "unit": good[name].attrs["units"], **traces(good[name].values)}
            for name in TRACES
        ],
        "points": [
            {"at": list(coordinates), "length": length, "phase": runs(phase)}
            for coordinates, length, phase in zip(points, lengths, phases, strict=True)
        ],
    }


def traces(values: NDArray[np.floating[Any]]) -> dict[str, Any]:
    """Packed histories, shape (points, samples); ``least + step * n`` errs by half a step, 8e-6 of
    each range."""
    least = values.min(axis=1, keepdims=True, initial=np.inf).astype(float)
    step = (values.max(axis=1, keepdims=True, initial=-np.inf).astype(float) - least) / LEVELS
    numbers = np.rint(np.divide(values - least, step, out=np.zeros(values.shape), where=step > 0))
    return {
        "least": least.ravel().tolist(),
        "step": step.ravel().tolist(),
        "data": packed(numbers, "<u2"),
    }


def runs(values: NDArray[np.integer[Any]]) -> list[list[int]]:
    """Runs of equal values: the index where each begins, and its value."""
    begins = np.flatnonzero(np.diff(values, prepend=values[0] + 1))
    return [[int(i), int(values[i])] for i in begins]


def packed(values: NDArray[Any], kind: str) -> str:
    """An array, last dimension fastest, as base64: first bytes of all numbers, then second ones and
    so on, deflated."""
    numbers = np.ascontiguousarray(values, dtype=kind).reshape(-1)
    planes = numbers.view(np.uint8).reshape(-1, numbers.itemsize).T
    return base64.b64encode(zlib.compress(planes.tobytes(), 9)).decode("ascii")


def shortened(values: NDArray[Any]) -> NDArray[np.float32]:
    """Numbers rounded to `BITS` bits of their mantissa; the other bits are zero, which compresses
    well."""
    whole = np.array(values, dtype=np.float32)
    bits, shift = whole.view(np.uint32), np.uint32(23 - BITS)
    rounded = (bits + np.uint32(1 << (shift - 1))) >> shift << shift
    return np.where(np.isfinite(whole), rounded.view(np.float32), whole)


def _named(name: str, attrs: Mapping[str, Any]) -> dict[str, Any]:
    """Name, label and unit of a parameter or variable."""
    return {
        "name": name,
        "title": str(attrs.get("long_name", name)),
        "unit": str(attrs.get("units", "")),
    }


def _dimension(study: xr.Dataset, dim: str) -> dict[str, Any]:
    """Values along a dimension; for a zip, which has no coordinate of its own, its parameters as
    text."""
    if dim in study.coords:
        values = study[dim].values.tolist()
        return _named(dim, study[dim].attrs) | {"values": values, "parts": {dim: values}}
    along = {str(name): x.values.tolist() for name, x in study.coords.items() if x.dims == (dim,)}
    columns = along or {dim: list(range(study.sizes[dim]))}
    texts = [
        [f"{name} = {x if isinstance(x, str) else f'{x:g}'}" for x in column]
        for name, column in columns.items()
    ]
    words = [", ".join(row) for row in zip(*texts, strict=True)]
    return {"name": dim, "title": ", ".join(columns), "unit": "", "values": words, "parts": columns}


def _variable(variable: xr.DataArray) -> dict[str, Any]:
    """Numbers as 32-bit floats of `BITS`; flags as bytes with words and their looks, those of the
    figures."""
    attrs, values = variable.attrs, variable.values
    described = _named(str(variable.name), attrs) | {"dims": list(variable.dims)}
    if "flag_meanings" in attrs:
        words = str(attrs["flag_meanings"]).split()
        codes = np.atleast_1d(attrs.get("flag_values", range(len(words))))
        looks = [look._asdict() | {"ink": look.ink} for look in looks_of(words).values()]
        data = packed(np.searchsorted(codes, values), "u1")
        return described | {"flags": words, "looks": looks, "data": data}
    return described | {"data": packed(shortened(values), "<f4")}


# ---- The page

PICTURE_WIDTH = 1100  # width of a page-wide figure, pixels; narrower ones are scaled alike
PAGE_WIDTH = 2055  # width of such a figure as drawn, pixels
QUALITY = 80
SCRIPTS = (
    "contents",
    "view",
    "drawing",
    "map",
    "point",
    "motion",
    "start",
)  # in the order of their dependence


class Picture(NamedTuple):
    heading: str
    title: str
    caption: str
    file: Path


def page(title: str, studies: Sequence[Mapping[str, Any]], pictures: Sequence[Picture]) -> str:
    """The whole page, for studies as from `study_contents`, and pictures grouped by heading."""
    maps = {"sequential": cm.batlow, "diverging": cm.vik}
    contents = {
        "studies": studies,
        "maps": {
            kind: [to_hex(colour) for colour in colours(range(256))]
            for kind, colours in maps.items()
        },
        "phases": PHASE_COLOURS,
        "parameters": [*Parameters.model_fields, *RATIOS],
    }
    texts = json.dumps(contents, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    template = jinja2.Template(
        _part("page.html"), autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True
    )
    return template.render(
        title=title,
        embedded=embedded,
        style=_part("page.css"),
        figures=[
            (heading, [*group]) for heading, group in groupby(pictures, key=attrgetter("heading"))
        ],
        contents=texts.replace(
            "<", "\\u003c"
        ),  # so that none of them ends the enclosing HTML element
        script="\n".join(['"use strict";', *(_part(f"{name}.js") for name in SCRIPTS)]),
    )


def embedded(file: Path) -> str:
    """A picture, reduced in size, as a data URL."""
    with Image.open(file) as picture:
        small = ImageOps.scale(
            picture.convert("RGB"), PICTURE_WIDTH / PAGE_WIDTH, Image.Resampling.LANCZOS
        )
    buffer = io.BytesIO()
    small.save(buffer, "WEBP", quality=QUALITY, method=6)
    return f"data:image/webp;base64,{base64.b64encode(buffer.getvalue()).decode('ascii')}"


def _part(name: str) -> str:
    return files(__package__).joinpath("static", name).read_text(encoding="utf-8")
