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

from disc_model.disc.modes import coupled_natural_frequencies, plate_modes
from disc_model.engine.jit.cache import compiling
from disc_model.errors import suggestion
from disc_model.fitting.block_cycle import Cycle, Unpredicted, block_cycle, is_rigid, no_cycle
from disc_model.parameters import Parameters
from disc_model.stability.cycle import FloquetResult, find_cycle
from disc_model.stability.floquet import beside_motion
from disc_model.stability.sliding import steady_sliding

MODE = re.compile(r"(frequency|damping_ratio)_(\d+)_(\d+)")
"""Names of quantities of one mode: nodal diameters, nodal circles."""
COUPLED = re.compile(r"coupled_frequency_([1-9]\d*)")
"""Names of natural frequencies with the slider attached, by their number from the lowest on."""

TOLERANCE = 1e-12
"""Relative residual of cycles."""


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
        found = self._found
        if math.isnan(found.period):
            reason = found.message.removeprefix(f"{found.status.value}: ")
            raise no_cycle(reason)
        return Cycle(found.period, found.growth_rate, found.stick_fraction, found.releases)

    @cached_property
    def _found(self) -> FloquetResult:
        """What the search for the cycle near the static start has found."""
        with compiling():
            return find_cycle(self.case, TOLERANCE)

    @cached_property
    def near_motion(self) -> bool | None:
        """Whether the motion from the static start may be near that cycle, as of `floquet`."""
        with compiling():
            return beside_motion(self._found).near_motion

    @cached_property
    def sliding(self) -> complex:
        """Leading eigenvalue of steady sliding, 1/s, with an imaginary part >= 0; its real part is 0
        where it is nothing but rounding. Raises `Unpredicted` without steady sliding."""
        found = steady_sliding(self.case)
        if not found.eigenvalues.size:
            raise Unpredicted(found.message.removeprefix(f"{found.status.value}: "))
        return complex(found.growth_rate, abs(found.eigenvalues[0].imag))

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


def unknown_quantity(name: object) -> str:
    """Return the rule that an unknown name of a quantity breaks."""
    return "is no quantity of a case" + suggestion(name, NAMES)
