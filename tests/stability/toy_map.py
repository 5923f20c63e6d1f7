"""A return map that can be solved by hand, in the place of the slider's: folds and neutral curves
are known exactly.

Coordinates x_0, x_1, x_2; with speed Omega and load N

    x_0 -> x_0 + 0.3 (mu - (x_0 - 1)^2),  mu = (fold(N) - Omega) / 10,  fold(N) = 16 + 0.02 (N -
    300) (x_1, x_2) -> exp(0.1 g) (x_1, x_2) turned by 1.2 rad,  g = ((Omega - 10) / 4)^2 + ((N -
    300) / 100)^2 - 1

There are two cycles, x_0 = 1 +- sqrt(mu), up to the speed fold(N), where they meet.  The upper one
is stable within the ellipse g = 0.  Damper and spring do nothing.  Beyond 30 rad/s the motion loses
contact; below 2 rad/s the derivatives are no numbers.
"""

import math

import numpy as np
import pytest

from disc_model.parameters import Parameters
from disc_model.stability import continuation
from disc_model.stability import cycle as floquet
from disc_model.stability.return_map import Counts, Flight, Passage

PERIOD, ANGLE = 0.015, 1.2
ROTATION = np.array([[math.cos(ANGLE), -math.sin(ANGLE)], [math.sin(ANGLE), math.cos(ANGLE)]])
RETURNED, LOST = (
    next(code for code, name in floquet.ENDS.items() if name == n)
    for n in ("returned", "lost_contact")
)


def fold_at(N):
    """Speed at which the two cycles meet, rad/s."""
    return 16 + 0.02 * (N - 300)


def outside(Omega, N):
    """g: negative inside the ellipse in which the cycle is stable."""
    return ((Omega - 10) / 4) ** 2 + ((N - 300) / 100) ** 2 - 1


def cycle_at(Omega, N, upper=True):
    """The cycle's point."""
    distance = math.sqrt((fold_at(N) - Omega) / 10)
    return np.array([1 + (distance if upper else -distance), 0.0, 0.0])


def growth_at(Omega, N, upper=True):
    """Growth rate, 1/s."""
    slope = 1 - 0.6 * (cycle_at(Omega, N, upper)[0] - 1)
    return max(0.1 * outside(Omega, N), math.log(abs(slope))) / PERIOD


class ToyMap:
    """As `disc_model.stability.return_map.ReturnMap`."""

    size = 3
    scale = np.ones(3)
    diameters = np.array([0, 1, 1])
    static = np.array([2.0, 0.0, 0.0])
    first_release = Passage(RETURNED, 0.0, static)
    deflection = 2.0

    def __init__(
        self,
        p: Parameters,
        tol: float = 1e-12,
        parameters: tuple[str, ...] = (),
        *,
        patient: bool = False,
    ) -> None:
        self.parameters, self.tol, self._names = p, tol, parameters

    def evaluate(self, x, *, releases=1, tangent=True, may_separate=False, coarse=False):
        Omega, N = self.parameters.Omega, self.parameters.N
        known, start = (PERIOD, 0.3 * PERIOD, Counts(1, 0, 0, 0, 1)), x
        end, jacobian = np.asarray(x, float), np.eye(3)
        for _ in range(releases):
            if not np.all(np.abs(end) < 1e100):  # far beyond the fold
                return Flight(LOST, *known, start, end, jacobian, np.zeros((3, len(self._names))))
            turned = math.exp(0.1 * outside(Omega, N)) * ROTATION
            step = np.zeros((3, 3))
            step[0, 0], step[1:, 1:] = 1 - 0.6 * (end[0] - 1), turned
            rest = turned @ end[1:]
            end = np.array([end[0] + 0.3 * ((fold_at(N) - Omega) / 10 - (end[0] - 1) ** 2), *rest])
            jacobian = step @ jacobian
        turn = {"Omega": 0.2 * (Omega - 10) / 16, "N": 0.2 * (N - 300) / 1e4, "c": 0.0, "k": 0.0}
        rate = {"Omega": -0.03, "N": 6e-4, "c": 0.0, "k": 0.0}
        by = np.array([[rate[name], *(turn[name] * rest)] for name in self._names]).reshape(-1, 3).T
        outcome = RETURNED if Omega <= 30 else LOST
        return Flight(outcome, *known, start, end, jacobian, by if Omega >= 2 else by * math.nan)

    def state(self, x):
        return np.array(x)

    def point(self, state):
        return np.array(state)


@pytest.fixture
def toy(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cycles are those of the toy."""
    for module in (continuation, floquet):
        monkeypatch.setattr(module, "ReturnMap", ToyMap)
