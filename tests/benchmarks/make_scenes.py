"""Compute the right answers of the benchmark's scenes, in minutes.

Run from the repository's root::

    python -m tests.benchmarks.make_scenes
"""

import json
import math
from itertools import accumulate
from pathlib import Path

from benchmarks.scenes import problem, stated
from disc_model import benchmarks
from disc_model.errors import script
from tests.references import stored
from tests.references.make_stored_references import decimal, repeated
from tests.references.stored import rounded
from tests.references.taylor import problem_of


def of_benchmark(name):
    """Return the answer of a scene: event times, kinds and the state at the end."""
    task = problem(name)
    p = task.parameters
    run, difference = repeated(problem_of(p), stored.reference_state(task.start, p), task.t_end)
    final = stored.engine_state(rounded(run.state()), p)
    return {
        "parameters": stated(p),
        "t_end": task.t_end,
        "largest_difference_to_check_run": difference,
        "kinds": [e["kind"] for e in run.events],
        "times": [decimal(e["time"]) for e in run.events],
        "final": stored.as_json(final),
    }


def rigid_cycle():
    """Return stick-slip on a rigid disc from a relaxed spring, in closed form.

    The contact force is N, and there is no damping; the motion is followed up to its third event. At
    E = 1e20 Pa the disc's remaining flexibility, k psi^2/omega^2, is 3e-9: this is exact to about
    that.
    """
    task = problem("rigid")
    p = task.parameters
    omega = math.sqrt(p.k_p / p.m)
    held = p.mu_s * p.N / (p.k_p * p.r_0)
    slipping = p.mu_k * p.N / (p.k_p * p.r_0)
    excess = held - slipping
    slip = 2.0 / omega * (math.pi - math.atan(excess * omega / p.Omega))
    stick = (held - (slipping - excess)) / p.Omega
    times = [*accumulate([held / p.Omega, slip, stick])]

    since = omega * (task.t_end - times[-1])
    psi = slipping + excess * math.cos(since) + p.Omega / omega * math.sin(since)
    f = p.Omega + excess * omega * math.sin(since) - p.Omega * math.cos(since)
    final = task.start.replace(time=task.t_end, phase="slip", direction=1, psi=psi, f=f)
    return {
        "parameters": stated(p),
        "t_end": task.t_end,
        "largest_difference_to_check_run": 1e-9 * task.t_end,
        "kinds": ["stick_to_slip", "slip_to_stick", "stick_to_slip"],
        "times": [f"{t:.25f}" for t in times],
        "final": stored.as_json(final),
    }


@script
def main():
    """Write the answers of all scenes."""
    scenes = {name: of_benchmark(name) for name in ("stick_slip", "separating", "many_modes")}
    scenes["rigid"] = rigid_cycle()
    target = Path(benchmarks.__file__).parent / "data" / "benchmark_reference.json"
    target.write_text(json.dumps(scenes, indent=1) + "\n", encoding="utf-8")
