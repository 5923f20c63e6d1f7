"""Special points of a branch: the parabola that suggests a pair of folds."""

import pytest

from disc_model.stability.continuation.special import _least_of_parabola


@pytest.mark.parametrize("lengths", [(1.0, 2.0), (2.0, 1.0), (0.5, 3.0), (1.0, 1.0)])
@pytest.mark.parametrize(("place", "least"), [(0.2, 1.0), (-0.3, 0.5), (0.0, -2.0)])
def test_a_parabola_has_its_least_value_where_it_was_made_to(
    lengths: tuple[float, float], place: float, least: float
) -> None:
    behind, ahead = lengths
    values = [(x - place) ** 2 + least for x in (-behind, 0.0, ahead)]
    found = _least_of_parabola(lengths, values)
    assert found == pytest.approx((place, least), abs=1e-12)
