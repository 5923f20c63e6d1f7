"""Special points of a branch: the parabola that suggests a pair of folds, and a pair of multipliers
that crosses the unit circle and becomes two real ones within a step."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import brentq

from disc_model.stability.continuation.special import _least_of_parabola, _neimark_sackers
from disc_model.stability.continuation.spectrum import spectrum_of

AT_CROSSING = 1 / 3  # where the determinant of `_point` is 1


def _point(t: float) -> SimpleNamespace:
    """A point with two multipliers: complex up to t = 0.46, of modulus 1 at `AT_CROSSING`, and real
    beyond."""
    determinant = 0.99 + 0.03 * t
    trace = 1.9 + 0.2 * t
    jacobian = np.array([[trace, -determinant], [1.0, 0.0]])
    return SimpleNamespace(t=t, spectrum=spectrum_of(jacobian))


class _Line:
    """A tracer of the points of `_point`."""

    def locate(self, before, after, test):
        if test(before) * test(after) > 0:
            return None
        return _point(brentq(lambda t: test(_point(t)), before.t, after.t, xtol=1e-14))


@pytest.mark.parametrize("lengths", [(1.0, 2.0), (2.0, 1.0), (0.5, 3.0), (1.0, 1.0)])
@pytest.mark.parametrize(("place", "least"), [(0.2, 1.0), (-0.3, 0.5), (0.0, -2.0)])
def test_a_parabola_has_its_least_value_where_it_was_made_to(
    lengths: tuple[float, float], place: float, least: float
) -> None:
    behind, ahead = lengths
    values = [(x - place) ** 2 + least for x in (-behind, 0.0, ahead)]
    found = _least_of_parabola(lengths, values)
    assert found == pytest.approx((place, least), abs=1e-12)


@pytest.mark.parametrize("ends", [(0.0, 1.0), (1.0, 0.0)])
def test_a_pair_that_is_real_at_one_end_of_a_step_has_crossed_the_circle_within_it(ends) -> None:
    before, after = map(_point, ends)
    [(kind, point, multiplier)] = _neimark_sackers(_Line(), before, after)
    assert kind == "neimark_sacker"
    assert point.t == pytest.approx(AT_CROSSING, abs=1e-9)  # rounding over the slope, 0.015
    assert abs(multiplier) == pytest.approx(1, abs=1e-12)
    assert multiplier.imag > 0


def test_a_pair_that_becomes_real_within_the_circle_crosses_nowhere() -> None:
    assert not list(_neimark_sackers(_Line(), _point(0.4), _point(1.0)))
