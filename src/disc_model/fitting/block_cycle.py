"""Stick-slip cycles of a block on a rigid disc, which has no modes: they are simulated."""

import math
from typing import NamedTuple

from disc_model.data.variables import GIVE_A_GUESS
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate

REPEATS = 1e-6
"""Relative difference of successive periods up to which a simulated motion counts as a cycle."""
LONGEST = 6
"""Number of times that a simulation is doubled until the motion repeats."""


BY_A_FUNCTION = (
    "measure by a function of the case that calls floquet with a guess and returns the quantity"
)
"""Advice on a motion whose cycle is not found, of a fit, which takes no guess."""


class Unpredicted(Exception):
    """A case has no such quantity; the message says why."""


def no_cycle(reason: str) -> Unpredicted:
    """That the cycle of a motion was not found, with the advice that a fit can follow."""
    return Unpredicted(reason.replace(GIVE_A_GUESS, BY_A_FUNCTION))


class Cycle(NamedTuple):
    """A stick-slip cycle: its period (s), growth rate (1/s; nan if it is not known), share of
    stick, and number of releases in a period."""

    period: float
    growth_rate: float
    stick_fraction: float
    releases: int


def is_rigid(p: Parameters) -> bool:
    """Whether the disc has no modes, and the slider is a block on a belt."""
    return p.disc is None and p.n_diameters < 0


def block_cycle(p: Parameters) -> Cycle:
    """Find the stick-slip cycle of a block on a rigid disc, by simulation from the static start.

    Raises `Unpredicted` if the motion does not repeat from one release to the next.
    """
    if min(p.k_p, p.Omega, p.N, p.mu_s) == 0:
        raise Unpredicted("without load, friction, spring and drive nothing sticks and slips")
    loading = p.mu_s * p.N / (p.r_0 * p.k_p * p.Omega)
    swing = math.tau * math.sqrt(p.m / p.k_p)
    t_end = 3 * (loading + swing)
    for _ in range(LONGEST):
        run = simulate(p, t_end)
        run.raise_for_status()
        events = run.events
        releases = events["time"][events["kind"] == "stick_to_slip"].to_numpy()
        stops = events["time"][events["kind"] == "slip_to_stick"].to_numpy()
        if len(releases) >= 3:
            last = releases[-1] - releases[-2]
            before = releases[-2] - releases[-3]
            if abs(last - before) <= REPEATS * last:
                stop = stops[stops > releases[-2]][0]
                return Cycle(float(last), math.nan, float((releases[-1] - stop) / last), 1)
        t_end *= 2
    raise Unpredicted(f"stick and slip do not repeat within {t_end / 2:.3g} s")
