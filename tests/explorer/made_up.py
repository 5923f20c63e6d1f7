"""Made-up studies with all that merged datasets may hold, and motions at some of their points."""

import json

import numpy as np
import xarray as xr

from disc_model.data.variables import PHASES
from disc_model.explorer.page import study_contents
from disc_model.studies.motions import SAMPLES, Motions
from disc_model.studies.run import describe

N, OMEGA, MODES = [100.0, 200.0, 385.0], [5.0, 10.0, 15.1, 20.0], ["as_published", "orthonormal"]
FAILED = {"N": 1, "Omega": 2, "normalization": 0}
"""Place of the one point that failed."""
UNDIVIDED = {"N": 2, "Omega": 3, "normalization": 0}
"""Place of the one point that was not simulated."""
MESSAGE = 'SimulationError: </script> & "worse"'


def flagged(long_name: str, words: str, first: int = 0) -> dict[str, object]:
    codes = np.arange(first, first + len(words.split()), dtype=np.int8)
    return {"long_name": long_name, "flag_values": codes, "flag_meanings": words}


def plane() -> xr.Dataset:
    """Two axes that are numbers and one of words."""
    dims = ("N", "Omega", "normalization")
    shape = (len(N), len(OMEGA), len(MODES))
    place = tuple(FAILED[dim] for dim in dims)
    status, outcome, origin = (np.zeros(shape, np.int8) for _ in range(3))
    status[place], outcome[1:, 2:], origin[tuple(UNDIVIDED[dim] for dim in dims)] = 1, 1, 1
    growth = np.linspace(-0.2, 0.4, status.size).reshape(shape)
    growth[place] = np.nan
    message = np.full(shape, "", dtype=object)
    message[place] = MESSAGE
    data = {
        "status": (dims, status, flagged("what became of the computation", "ok failed")),
        "outcome": (dims, outcome - 1, flagged("what becomes of the start", "quiet separation", first=-1)),
        "growth_rate": (dims, growth, {"long_name": "growth rate", "units": "s-1"}),
        "method": (dims, origin, flagged("how the value is known", "simulation inferred")),
        "releases": (dims[:2], np.arange(12).reshape(3, 4), {"long_name": "number of releases", "units": "1"}),
        "message": (dims, message),
    }
    coords = {name: (name, values, describe(name)) for name, values in zip(dims, (N, OMEGA, MODES), strict=True)}
    return xr.Dataset(data, coords, {"title": "A plane <b>", "quantity": "outcome", "base": json.dumps({"k": 5e4})})


def line() -> xr.Dataset:
    """A zip, which has no coordinate of its own, and nothing else."""
    dim = "N_Omega"
    data = {
        "status": (dim, np.zeros(3, np.int8), flagged("what became of it", "ok failed")),
        "period": (dim, [0.0148, 0.02, np.nan], {"long_name": "period", "units": "s"}),
        "message": (dim, np.array(["", "", ""], dtype=object)),
    }
    coords = {"N": (dim, N, describe("N")), "Omega": (dim, [20.0, 15.1, 12.0], describe("Omega"))}
    return xr.Dataset(data, coords, {"title": "A line"})


def force(N: float) -> np.ndarray:
    """The made-up contact force of a point, N."""
    return (N * (1 + 0.5 * np.sin(np.linspace(0, 12, SAMPLES)))).astype(np.float32)


def motions() -> xr.Dataset:
    """Histories at three points of the plane, one of which failed; the slider sticks, slips and is apart in turn."""
    points = [(100.0, 5.0, "as_published"), (385.0, 20.0, "as_published"), (100.0, 5.0, "orthonormal")]
    status = np.array([0, 0, 1], np.int8)
    phase = np.repeat([1, 2, 3, 1], SAMPLES // 4).astype(np.int8)
    rows = {
        "P": np.stack([force(point[0]) for point in points]),
        "u": np.full((3, SAMPLES), -0.0088, np.float32),
        "psi": np.tile(np.linspace(0, 0.05, SAMPLES, dtype=np.float32), (3, 1)),
    }
    about = {name: Motions.COLUMNS[name].attributes for name in rows}
    data = {name: (("point", "sample"), values, about[name]) for name, values in rows.items()}
    names = " ".join(("none", *PHASES))
    data |= {
        "status": ("point", status, flagged("status", "ok failed")),
        "length": ("point", [0.03, 0.05, np.nan], {"units": "s"}),
        "phase": (("point", "sample"), np.tile(phase, (3, 1)), flagged("phase", names)),
    }
    coords = {name: ("point", [point[i] for point in points]) for i, name in enumerate(("N", "Omega", "normalization"))}
    return xr.Dataset(data, coords)


def contents() -> list[dict[str, object]]:
    """What the page is told of both studies."""
    return [study_contents("plane", plane(), motions(), "After the transient."), study_contents("line", line())]
