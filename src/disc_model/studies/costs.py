"""What computing costs: processor time of a simulated second and of a cycle, for any case.

Measured with one thread of an AMD EPYC processor (Zen 4). Estimates of a study's points err by up to
three, because motions end when their outcome is known, and lost contact costs more than kept one.
"""

import math
import time
from typing import NamedTuple

import numpy as np

from disc_model.disc.plate import mode_arrays
from disc_model.parameters import Parameters


class UnitCosts(NamedTuple):
    """Processor times (s) from which quantities make their cost: of a second of simulated motion,
    and of finding a cycle with its multipliers."""

    second: float
    cycle: float


PAPER = UnitCosts(second=4e-4, cycle=2e-3)  # with the paper's nine modes
MODES = 9  # of the paper's disc, pairs counted as two
FASTEST = 4383.0  # rad/s, its highest natural frequency
SLIDER = math.sqrt(2e4 / 0.1)  # rad/s, natural frequency of its slider, in the plane of the disc
SLOWEST_SLIDER = 0.3  # least frequency of a slider that counts, relative: others hardly ever slip

# Factors of other laws of contact, for seconds and for cycles: measured at 300 N and 14 rad/s
COMPLIANT = UnitCosts(3.0, 2.2)
NORMAL = UnitCosts(1.7, 1.15)
FALLING = UnitCosts(1.7, 1.2)

REFERENCE_LOOP = 0.0097  # s, of `_loop` on the machine of the measurements


def unit_costs(p: Parameters) -> UnitCosts:
    """Costs for a case.

    The time of a step grows with the number of modes, the number of steps with the highest
    frequency, and the number of releases with the slider's frequency; of a cycle, only one release
    counts. The exponents are fitted to 3 to 26 modes of the plate, a steel disc and a brake-like
    one, of which they give the costs within a factor of two.
    """
    modes = mode_arrays(p)
    count = int(np.sum(np.where(modes.diameters > 0, 2, 1)))
    size = max(count, 3) / MODES
    fastest = float(np.max(modes.omega, initial=FASTEST / 4)) / FASTEST
    slider = max(math.sqrt(max(p.k_p, 0.0) / p.m) / SLIDER, SLOWEST_SLIDER)
    second = PAPER.second * slider * (size * fastest) ** 0.65
    cycle = PAPER.cycle * size * (size * fastest) ** 0.5
    laws = []
    if p.contact_compliance != 0:
        laws.append(COMPLIANT)
    if p.contact_force == "normal":
        laws.append(NORMAL)
    if p.friction_decay < math.inf or p.viscous_friction > 0:
        laws.append(FALLING)
    for law in laws:
        second *= law.second
        cycle *= law.cycle
    return UnitCosts(second, cycle)


def machine_factor() -> float:
    """How many times as long as on the machine of the measurements this one takes, by a loop of
    some hundredths of a second; the least of three tries, which other programs disturb least."""
    return min(_loop() for _ in range(3)) / REFERENCE_LOOP


def _loop() -> float:
    """Processor time (s) of a loop of arithmetic."""
    began = time.process_time()
    value = 0.5
    for _ in range(400_000):
        value = 3.7 * value * (1.0 - value)
    return time.process_time() - began
