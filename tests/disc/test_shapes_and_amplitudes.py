"""Amplitudes under the slider beside the shapes of a disc at several radii."""

import warnings

import numpy as np
import pytest

import disc_model as dm
from disc_model.disc import plausibility
from disc_model.disc.plate import mode_shapes

R_0 = 0.1  # m
SHAPES = {"radii": [0.08, 0.1, 0.12], "shapes": [[0.3, 0.431, 0.5], [0.35, 0.556, 0.7]]}


@pytest.fixture(autouse=True)
def nothing_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """No doubt was told before."""
    monkeypatch.setattr(plausibility, "_reported", set())


def case_of(*amplitudes: float) -> dm.Parameters:
    """A case with a disc of two modes with some amplitudes; 0.431 and 0.556 are those of the
    shapes."""
    disc = dm.Disc(diameters=[0, 1], omega=[5840, 3460], amplitude=amplitudes, **SHAPES)
    return dm.Parameters(N=100, Omega=10, disc=disc, r_0=R_0, k=1e6, k_p=1e6, m=0.5)


def told_of(*cases: dm.Parameters) -> list[str]:
    """Warnings of some cases."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        for case in cases:
            dm.plate_modes(case)
    return [str(warning.message) for warning in caught]


def test_every_mode_is_compared_with_its_shape() -> None:
    """Only the mode of the largest amplitude was."""
    assert told_of(case_of(0.431, 0.556)) == []
    [text] = told_of(case_of(0.31, 0.556))
    assert "mode 1 moves by 0.431 kg^-1/2 there by its shape, and its amplitude is 0.31" in text
    [text] = told_of(case_of(0.31, 0.9))
    assert "mode 2 moves" in text
    assert text.endswith("; 1 other mode alike")


def test_each_disc_is_doubted_once() -> None:
    """A second disc was not, in the same process."""
    first = case_of(0.31, 0.556)
    second = case_of(0.62, 0.556)
    varied = first.replace(amplitude_0_0=0.33)
    texts = told_of(first, first, varied, second, second)
    assert [text.rpartition(" ")[2] for text in texts] == ["0.31", "0.62"]


def test_a_shape_is_drawn_as_it_is_given() -> None:
    """The amplitude stood in it at the slider, as a kink."""
    r = np.linspace(0.08, 0.12, 41)
    smooth = mode_shapes(case_of(0.431, 0.556), r)
    found = mode_shapes(case_of(-0.2, 0.556), r)
    np.testing.assert_allclose(found, smooth, rtol=1e-12)
