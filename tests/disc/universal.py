"""A writer of universal files with a disc whose modes are known, by pyuff."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pyuff

MODES = [
    (1, 551.0, 0.55, -0.27),
    (0, 929.0, 0.43, 0.0),
    (2, 1212.0, 0.54, -0.13),
    (3, 1920.0, 0.5, -0.1),
]
"""Nodal diameters, Hz, and amplitudes across the disc and along the path, kg^-1/2."""
ANGLES = np.arange(24) * np.pi / 12
RADII = (0.08, 0.1, 0.13)  # m


def write_modes(  # noqa: PLR0913
    path: Path,
    modes: Iterable[tuple[int, float, float, float]] = MODES,
    *,
    sets: tuple[int, int] = (15, 55),
    mass: float = 1.0,
    size: float = 1.0,
    angles: Any = ANGLES,
    heights: Iterable[float] = (0.006,),
    system: int = 0,
    half_apart: float = np.pi / 2,
    first: Iterable[dict[str, Any]] = (),
    **changes: Any,
) -> Path:
    """Write both halves of pairs, turned by 0.3 rad and 0.1 % apart; the lower face moves along the path
    the other way. `size`: file units per m; `changes`: of all datasets of modes."""
    r, angle, z = (x.ravel() for x in np.meshgrid(RADII, angles, [*heights], indexing="ij"))
    numbers = np.arange(1, r.size + 1)
    places = {"x": size * r * np.cos(angle), "y": size * r * np.sin(angle), "z": size * z}
    plain = dict.fromkeys(("def_cs", "disp_cs", "color"), np.full(r.size, system))
    written = [*first, {"type": sets[0], "node_nums": numbers, **plain, **places}]
    for l, frequency, amplitude, tangential in modes:
        for half in range(1 + (l > 0)):
            phase = l * (angle - 0.3) - half * half_apart
            axial = amplitude * np.cos(phase)
            along = -tangential * np.sin(phase) * np.sign(z)
            shape = np.stack([-along * np.sin(angle), along * np.cos(angle), axial], axis=1)
            shape *= np.sqrt(mass) * (r / 0.1)[:, None] ** 2
            omega = frequency * (1 + 1e-3 * (half - 0.5) * (l > 0))
            written.append(_dataset(sets[1], omega, mass, numbers, shape) | changes)
    pyuff.UFF(str(path)).write_sets(written, "overwrite")
    return path


def _dataset(number: int, frequency: float, mass: float, nodes: Any, shape: Any) -> dict[str, Any]:
    """A dataset of a mode with a damping ratio of 0.002."""
    if number == 55:
        return {
            "type": 55, "model_type": 1, "analysis_type": 2, "data_ch": 2, "spec_data_type": 8, "data_type": 2,
            "n_data_per_node": 3, "load_case": 1, "mode_n": 1, "freq": frequency, "modal_m": mass,
            "modal_damp_vis": 0.001, "modal_damp_his": 0.002, "node_nums": nodes,
            "r1": shape[:, 0], "r2": shape[:, 1], "r3": shape[:, 2],
        }  # fmt: skip
    texts = dict.fromkeys(("analysis_dataset_name", "id1", "id2", "id3", "id4", "id5"), "NONE")
    return texts | {
        "type": 2414, "analysis_dataset_label": 1, "dataset_location": 1, "model_type": 1, "analysis_type": 2,
        "data_characteristic": 2, "result_type": 8, "data_type": 2,
        "number_of_data_values_for_the_data_component": 3, "record12_field2": frequency, "record12_field4": mass,
        "record12_field5": 0.001, "record12_field6": 0.002, "node_nums": nodes, "data_at_node": shape,
    }  # fmt: skip
