"""The engine beside the long-double reference: the same switches, samples and energy."""

import numpy as np

from disc_model import Execution, Window, simulate
from tests.contact_laws import course_of, turned
from tests.references import stored, taylor


def followed(p, span, start=None, *, ramps=(), tol=1e-15, within=1e-13, theta=None):
    """A run of the engine that agrees with one of the reference, which is returned, too.

    Parameters
    ----------
    p : the case
    span : s, from the time 0
    start : a `stored.State`; the static start if None
    ramps : of Omega and N
    tol, within : of the engine, and by how many s its switches may be off
    theta : angle (rad) at which the disc is observed, if samples are compared
    """
    q = taylor.problem_of(p)
    course = course_of(p, ramps) if ramps else ()
    reference = taylor.Reference(q, start or q.equilibrium(), course=course)
    windows = {} if theta is None else {"w": Window(rate=1e3, theta=theta)}
    run = simulate(
        p,
        span,
        windows,
        tol=tol,
        initial_state=start and stored.engine_state(start, p),
        ramps=ramps,
        execution=Execution(audit_every_step=True),
    )
    for sample in run.samples.values():
        drives = [turned(course_of(p, ramps), t) for t in sample["time"]]
        times = zip(sample["time"], drives, strict=True)
        rows = [reference.run(t).sample(drive, theta) for t, drive in times]
        for name, values in zip(taylor.SAMPLED, np.transpose(rows), strict=True):
            allowed = 1e-9 * np.abs(values).max()
            np.testing.assert_allclose(sample[name], values, rtol=0, atol=allowed, err_msg=name)

    events = reference.run(span).events
    assert list(run.events["kind"]) == [event["kind"] for event in events]
    times = [float(event["time"]) for event in events]
    np.testing.assert_allclose(run.events["time"], times, rtol=0, atol=within)
    assert run.statistics["audited_steps"] == run.statistics["steps"]
    assert run.statistics["energy_residual"] < (1e-13 if p.stretching == "none" else 1e-12)
    return run, reference
