"""Mode shapes of universal files: those of the plate, written and read back."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import disc_model as dm
from disc_model.disc.plate import mode_shapes
from tests import needs

pytestmark = needs.UNIVERSAL_FILES.mark

P = dm.Parameters(N=0, Omega=0, normalization="orthonormal")
RADII, ANGLES = np.array([0.06, 0.08, 0.1, 0.12]), np.arange(24) * np.pi / 12
R, ANGLE = (grid.ravel() for grid in np.meshgrid(RADII, ANGLES, indexing="ij"))
MASS = 2.5


def written(path: Path, **changes: Any) -> Path:
    """A universal file of the plate, both halves of each pair turned by 0.3 rad, and a mode in the
    disc's plane."""
    import pyuff

    file = pyuff.UFF(str(path))
    numbers = np.arange(1, R.size + 1)
    nodes = {
        "type": 15,
        "node_nums": numbers,
        "x": R * np.cos(ANGLE),
        "y": R * np.sin(ANGLE),
        "z": 0 * R,
    }
    plain = dict.fromkeys(("def_cs", "disp_cs", "color"), 0 * numbers)
    file.write_sets(nodes | plain, "overwrite")
    modes, shapes = dm.plate_modes(P), mode_shapes(P, RADII)
    moves = []
    for l, omega, shape in zip(modes["diameters"], modes["omega"], shapes, strict=True):
        for half in range(1 + (l > 0)):
            wave = np.cos(l * (ANGLE - 0.3) + half * np.pi / 2)
            # the halves of a pair differ a little in frequency, as in a test
            moves.append((omega * (1 + 0.01 * half), np.repeat(shape, ANGLES.size) * wave))
    moves.append((5000.0, 1e-6 * np.random.default_rng(1).standard_normal(R.size)))
    for i, (omega, z) in enumerate(moves):
        data = {
            "type": 55, "model_type": 1, "analysis_type": 2, "data_ch": 2, "spec_data_type": 8, "data_type": 2,
            "n_data_per_node": 3, "load_case": 0, "mode_n": i + 1, "freq": omega / (2 * np.pi), "modal_m": MASS,
            "modal_damp_vis": 0.01, "modal_damp_his": 0.0, "node_nums": numbers, "r1": 0 * z, "r2": 0 * z,
            "r3": -np.sqrt(MASS) * z,
        }  # fmt: skip
        file.write_sets(data | changes, "add")
    return path


def test_the_modes_of_a_universal_file_are_found(tmp_path: Path) -> None:
    disc = dm.Disc.from_uff(written(tmp_path / "modes.uff"), P.r_0)
    modes = dm.plate_modes(P)
    assert list(disc.diameters) == modes["diameters"].tolist()
    paired = np.where(modes["diameters"] > 0, 1.005, 1.0)
    np.testing.assert_allclose(
        disc.omega, modes["omega"] * paired, rtol=1e-5
    )  # the file has six digits
    np.testing.assert_allclose(disc.amplitude, np.abs(modes["psi"]), rtol=1e-4)
    np.testing.assert_allclose(disc.damping_ratio, 0.01)
    assert np.allclose(disc.radii, RADII)
    shapes = mode_shapes(P, RADII)
    np.testing.assert_allclose(
        disc.shapes, shapes * np.sign(shapes[:, 2:3]), atol=1e-4 * np.abs(shapes).max()
    )
    again = tmp_path / "disc.csv"
    disc.to_csv(again)
    assert dm.Disc.from_csv(again) == disc


def test_what_a_universal_file_lacks_is_said(tmp_path: Path) -> None:
    path = written(tmp_path / "modes.uff")
    with pytest.raises(
        dm.ParameterError, match=r"modes.uff=0: must give coordinates in m of 3 or more nodes"
    ):
        dm.Disc.from_uff(path, 0.09)
    with pytest.raises(dm.ParameterError, match=r"modal mass=0: must be > 0"):
        dm.Disc.from_uff(written(tmp_path / "none.uff", modal_m=0.0), P.r_0)
    with pytest.raises(dm.ParameterError, match=r"must be a universal file that can be read"):
        dm.Disc.from_uff(tmp_path / "no.uff", P.r_0)
