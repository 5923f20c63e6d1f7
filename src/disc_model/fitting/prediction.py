"""What a case predicts of quantities that can be measured, by their names.

Cycles are those of `floquet`; a block on a rigid disc, which has no modes, is simulated.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from functools import cached_property
from typing import NamedTuple

import numpy as np

from disc_model.data.variables import unit_of_mode
from disc_model.disc.modes import coupled_natural_frequencies, plate_modes
from disc_model.engine.jit.cache import compiling
from disc_model.errors import suggestion
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.stability.cycle import find_cycle
from disc_model.stability.floquet import cycle_near_start
from disc_model.stability.sliding import steady_sliding

MODE = re.compile(r"(frequency|damping_ratio)_(\d+)_(\d+)")
"""Names of quantities of one mode: nodal diameters, nodal circles."""
COUPLED = re.compile(r"coupled_frequency_([1-9]\d*)")
"""Names of natural frequencies with the slider attached, by their number from the lowest on."""

REPEATS = 1e-6
"""Relative difference of successive periods up to which a simulated motion counts as a cycle."""
TOLERANCE = 1e-12
"""Relative residual of cycles."""
LONGEST = 6
"""Number of times that a simulation is doubled until the motion repeats."""


class Unpredicted(Exception):
    """A case has no such quantity; the message says why."""


class Cycle(NamedTuple):
    """A stick-slip cycle: its period (s), growth rate (1/s; nan if it is not known), share of
    stick, and number of releases in a period."""

    period: float
    growth_rate: float
    stick_fraction: float
    releases: int


class Prediction:
    """What one case predicts; each part is computed at its first use.

    Attributes
    ----------
    case : the case
    """

    def __init__(self, case: Parameters) -> None:
        self.case = case

    @cached_property
    def modes(self) -> dict[tuple[int, int], float]:
        """Natural frequencies of the disc, rad/s, by numbers of nodal diameters and circles."""
        table = plate_modes(self.case)
        numbers = zip(table["diameters"], table["circles"], strict=True)
        return {
            (int(l), int(c)): float(omega)
            for (l, c), omega in zip(numbers, table["omega"], strict=True)
        }

    @cached_property
    def coupled(self) -> np.ndarray:
        """Natural frequencies with the slider attached, rad/s, ascending."""
        return coupled_natural_frequencies(self.case)

    @cached_property
    def cycle(self) -> Cycle:
        """The stick-slip cycle near the static start. Raises `Unpredicted` without one."""
        if is_rigid(self.case):
            return block_cycle(self.case)
        with compiling():
            found = find_cycle(self.case, TOLERANCE)
        if math.isnan(found.period):
            raise Unpredicted(found.message.removeprefix(f"{found.status.value}: "))
        return Cycle(found.period, found.growth_rate, found.stick_fraction, found.releases)

    @cached_property
    def near_motion(self) -> bool | None:
        """Whether the motion from the static start may be near that cycle, as of `floquet`."""
        with compiling():
            return cycle_near_start(self.case, TOLERANCE).near_motion

    @cached_property
    def sliding(self) -> complex:
        """Leading eigenvalue of steady sliding, 1/s, with an imaginary part >= 0. Raises
        `Unpredicted` without steady sliding."""
        found = steady_sliding(self.case)
        if not found.eigenvalues.size:
            raise Unpredicted(found.message.removeprefix(f"{found.status.value}: "))
        leading = complex(found.eigenvalues[0])
        return complex(leading.real, abs(leading.imag))

    def frequency(self, diameters: int, circles: int) -> float:
        """Natural frequency of a mode of the disc, Hz."""
        try:
            return self.modes[diameters, circles] / math.tau
        except KeyError:
            modes = f"the case has no mode of {diameters} nodal diameters and {circles} circles"
            raise Unpredicted(modes) from None

    def damping_ratio(self, diameters: int, circles: int) -> float:
        """Damping ratio of a mode of the disc."""
        omega = math.tau * self.frequency(diameters, circles)
        case = self.case
        if case.disc is not None:
            return case.disc.numbers[f"damping_ratio_{diameters}_{circles}"]
        if case.damping_ratio is not None:
            return case.damping_ratio
        return case.D_star / (2 * case.D) * omega

    def coupled_frequency(self, number: int) -> float:
        """Natural frequency with the slider attached, Hz, by its number from the lowest on."""
        if number > len(self.coupled):
            raise Unpredicted(f"the case has {len(self.coupled)} frequencies")
        return float(self.coupled[number - 1]) / math.tau

    def of(self, name: str) -> float:
        """Return a quantity by its name, in its unit. Raises `Unpredicted` if the case has none."""
        mode = MODE.fullmatch(name)
        if mode and mode[1] == "frequency":
            return self.frequency(int(mode[2]), int(mode[3]))
        if mode:
            return self.damping_ratio(int(mode[2]), int(mode[3]))
        coupled = COUPLED.fullmatch(name)
        if coupled:
            return self.coupled_frequency(int(coupled[1]))
        value = QUANTITIES[name].of(self)
        if not math.isfinite(value):
            raise Unpredicted("it is not defined")
        return value


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


class Quantity(NamedTuple):
    """A quantity of a case: its unit, its meaning, and how it follows from a prediction."""

    unit: str
    meaning: str
    of: Callable[[Prediction], float]


def _stick_time(prediction: Prediction) -> float:
    cycle = prediction.cycle
    return cycle.stick_fraction * cycle.period / cycle.releases


def _slip_time(prediction: Prediction) -> float:
    cycle = prediction.cycle
    return (1 - cycle.stick_fraction) * cycle.period / cycle.releases


def _slip_length(prediction: Prediction) -> float:
    """The slider advances by r_0 Omega T in a period, and only while it slips."""
    case = prediction.case
    cycle = prediction.cycle
    return case.r_0 * case.Omega * cycle.period / cycle.releases


QUANTITIES: Mapping[str, Quantity] = {
    "period": Quantity("s", "period of the stick-slip cycle", lambda x: x.cycle.period),
    "growth_rate": Quantity("1/s", "growth rate of the cycle", lambda x: x.cycle.growth_rate),
    "stick_fraction": Quantity("1", "share of stick", lambda x: x.cycle.stick_fraction),
    "stick_time": Quantity("s", "duration of stick, mean of a period's releases", _stick_time),
    "slip_time": Quantity("s", "duration of slip, mean of a period's releases", _slip_time),
    "slip_length": Quantity("m", "path of a slip, mean of a period's releases", _slip_length),
    "sliding_growth_rate": Quantity(
        "1/s", "growth rate of steady sliding", lambda x: x.sliding.real
    ),
    "sliding_frequency": Quantity(
        "Hz", "frequency of its leading mode, seen from the slider", lambda x: x.sliding.imag / math.tau
    ),
}  # fmt: skip
"""Quantities by name, beside those of single modes."""

OF_STEADY_CYCLES = ("period", "stick_fraction", "stick_time", "slip_time", "slip_length")
"""Quantities of a stick-slip cycle that are measured while it goes on."""
NAMES = (*QUANTITIES, "frequency_2_0", "damping_ratio_2_0", "coupled_frequency_1")
"""Names as messages list them; the last three stand for those of all modes."""


def is_of_modes(name: object) -> bool:
    """Return whether a quantity is one of the disc's modes, which every motion of a case shares."""
    return isinstance(name, str) and bool(MODE.fullmatch(name) or COUPLED.fullmatch(name))


def is_of_steady_cycle(name: object) -> bool:
    """Return whether a quantity is one of a stick-slip cycle that goes on, unlike its growth rate."""
    return isinstance(name, str) and name in OF_STEADY_CYCLES


def unit_of(name: str) -> str:
    """Return the unit of a quantity, "" for an unknown name."""
    if name in QUANTITIES:
        return QUANTITIES[name].unit
    mode = MODE.fullmatch(name)
    if mode and mode[1] == "damping_ratio":
        return "1"
    if mode or COUPLED.fullmatch(name):
        return "Hz"
    return ""


def unit_of_parameter(name: str) -> str:
    """Return the unit of a parameter or of a number of a disc's table; "" without one."""
    unit = Parameters.unit(name) or unit_of_mode(name)
    return "" if unit == "1" else unit


def unknown_quantity(name: object) -> str:
    """Return the rule that an unknown name of a quantity breaks."""
    return "is no quantity of a case" + suggestion(name, NAMES)
