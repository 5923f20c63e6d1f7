"""Where a benchmark runs."""

import os

import pytest

from disc_model.benchmarks.hardware import machine, one_core


def test_the_machine_is_named() -> None:
    assert "cores" in machine()


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="this system does not bind processes to cores")
def test_a_process_is_on_one_core_meanwhile_and_has_all_of_them_back() -> None:
    before = os.sched_getaffinity(0)

    @one_core()
    def broken_off() -> None:
        assert len(os.sched_getaffinity(0)) == 1
        raise KeyError("broken off")

    with pytest.raises(KeyError, match="broken off"):
        broken_off()
    assert os.sched_getaffinity(0) == before
