"""Samples at the very instant of a switch: the side before it, whichever way the switch is reached."""

import numpy as np

from disc_model import Window, simulate
from disc_model.simulation.result import EVENT_KINDS, PHASES
from tests.references import printed

ULP = 2.0**-52
#: Lands, sticks, is released and lets go again within 0.02 s.
P = printed.P.model_copy(update={"N": 100.0})


def test_a_sample_on_a_switch_shows_the_side_before_it() -> None:
    """Moved by less than rounding moves a switch it still does; moved by more it shows the side after."""
    start = printed.lively("separation", p=P)
    events = simulate(P, 0.02, initial_state=start).events
    before = [start.phase, *events["phase"].iloc[:-1]]
    apart = np.diff(events["time"], prepend=0.0, append=1.0) > 1e-6
    seen = set()
    for i in np.flatnonzero(apart[1:] & apart[:-1]):
        t, kind, after = events["time"].iloc[i], events["kind"].iloc[i], events["phase"].iloc[i]
        if after == before[i]:
            continue
        seen.add(kind)
        offsets = (-1e-10, *(ULP * t * np.array([-200, -1, 0, 1, 200])), 1e-10)
        windows = {f"w{offset:+}": Window(start=t + offset, stop=t + offset + 1e-3, rate=999) for offset in offsets}
        samples = simulate(P, t + 2e-3, windows, initial_state=start).samples.values()
        phases = [PHASES[int(sample["phase"][0])] for sample in samples]
        assert phases == [before[i]] * 6 + [after], kind
        # what is continuous on either side changes by its rate times 1e-10 s: P by less than 1e7 N/s
        forces = [sample["P"][0] for sample in samples]
        np.testing.assert_allclose(forces[1:6], forces[0], rtol=0, atol=1e-3)
    assert seen == set(EVENT_KINDS) - {"slip_reversal"}, "a kind of switch that changes the phase is missing"
