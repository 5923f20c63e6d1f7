"""Amplitudes under the slider beside the shapes of a disc at several radii."""

import numpy as np

import disc_model as dm
from disc_model.disc.plate import mode_shapes

R_0 = 0.1  # m
SHAPES = {"radii": [0.08, 0.1, 0.12], "shapes": [[0.3, 0.431, 0.5], [0.35, 0.556, 0.7]]}


def case_of(*amplitudes: float) -> dm.Parameters:
    """A case with a disc of two modes with some amplitudes; 0.431 and 0.556 are those of the
    shapes."""
    disc = dm.Disc(diameters=[0, 1], omega=[5840, 3460], amplitude=amplitudes, **SHAPES)
    return dm.Parameters(N=100, Omega=10, disc=disc, r_0=R_0, k=1e6, k_p=1e6, m=0.5)


def test_a_shape_is_drawn_as_it_is_given() -> None:
    """The amplitude stood in it at the slider, as a kink."""
    r = np.linspace(0.08, 0.12, 41)
    smooth = mode_shapes(case_of(0.431, 0.556), r)
    found = mode_shapes(case_of(-0.2, 0.556), r)
    np.testing.assert_allclose(found, smooth, rtol=1e-12)
