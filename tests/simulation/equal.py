"""When results are the same."""

import dataclasses

import numpy as np

from disc_model.simulation.result import Result
from disc_model.simulation.states import State


def same(a: Result, b: Result) -> None:
    """All but the wall time, and the case that is named, is equal, bit for bit."""
    np.testing.assert_array_equal(a.event_rows, b.event_rows)
    assert [*a.samples] == [*b.samples]
    for one, other in zip(a.samples.values(), b.samples.values(), strict=True):
        assert list(one) == list(other)
        for name in one:
            assert one[name].tobytes() == other[name].tobytes(), name
    for name in {field.name for field in dataclasses.fields(State)} - {"case_key"}:
        np.testing.assert_array_equal(
            getattr(a.final_state, name), getattr(b.final_state, name), err_msg=name
        )
    assert a.status == b.status
    assert a.message == b.message
    assert a.u_0 == b.u_0
    assert a.parameters == b.parameters
    np.testing.assert_array_equal(a.first_separation, b.first_separation)
    assert set(a.statistics) == set(b.statistics)
    for name in set(a.statistics) - {"wall_time"}:
        np.testing.assert_array_equal(a.statistics[name], b.statistics[name], err_msg=name)
