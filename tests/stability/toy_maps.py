"""Return maps that can be solved by hand, in the place of the slider's: points, folds and neutral
curves are known exactly.

The `FoldMap` has coordinates x_0, x_1, x_2; with speed Omega and load N

    x_0 -> x_0 + 0.3 (mu - (x_0 - 1)^2),  mu = (fold(N) - Omega) / 10,  fold(N) = 16 + 0.02 (N -
    300) (x_1, x_2) -> exp(0.1 g) (x_1, x_2) turned by 1.2 rad,  g = ((Omega - 10) / 4)^2 + ((N -
    300) / 100)^2 - 1

There are two cycles, x_0 = 1 +- sqrt(mu), up to the speed fold(N), where they meet.  The upper one
is stable within the ellipse g = 0.  Damper and spring do nothing.  Beyond 30 rad/s the motion loses
contact; below 2 rad/s the derivatives are no numbers.
"""

import math
from typing import ClassVar

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from disc_model import Parameters, State
from disc_model.stability import cycle
from disc_model.stability.return_map import Counts, Orbit, Passage

PERIOD = 0.015
ANGLE = 1.2
COUNTS = Counts(1, 0, 0, 0, 1)
ROTATION = np.array([[math.cos(ANGLE), -math.sin(ANGLE)], [math.sin(ANGLE), math.cos(ANGLE)]])
RETURNED, LOST = (
    next(code for code, name in cycle.ENDS.items() if name == n)
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
    if not upper:
        distance = -distance
    return np.array([1 + distance, 0.0, 0.0])


def growth_at(Omega, N, upper=True):
    """Growth rate, 1/s."""
    slope = 1 - 0.6 * (cycle_at(Omega, N, upper)[0] - 1)
    return max(0.1 * outside(Omega, N), math.log(abs(slope))) / PERIOD


class ToyMap:
    """As `disc_model.stability.return_map.ReturnMap`, from a formula of the subclass."""

    size: int
    scale: np.ndarray
    diameters: np.ndarray
    static: np.ndarray
    deflection = 1.0

    def __init__(
        self,
        p: Parameters,
        tol: float = 1e-12,
        parameters: tuple[str, ...] = (),
        *,
        patient: bool = False,
    ) -> None:
        self.parameters = p
        self.tol = tol
        self._names = parameters

    def step(self, x):
        """End, derivative by x, and derivatives by parameters, by their names."""
        raise NotImplementedError

    def counts(self, x):
        return COUNTS

    def evaluate(self, x, *, releases=1, tangent=True, coarse=False):
        start = np.asarray(x, float)
        end = start
        jacobian = np.eye(self.size)
        by = np.zeros((self.size, len(self._names)))
        known = (PERIOD, 0.3 * PERIOD, self.counts(start), start)
        for _ in range(releases):
            if not np.all(np.abs(end) < 1e100):  # far beyond the fold
                return Orbit(LOST, *known, end, jacobian, by)
            end, step, changes = self.step(end)
            jacobian = step @ jacobian
        for i, name in enumerate(self._names):
            by[:, i] = changes.get(name, 0.0)
        outcome = LOST
        if self.parameters.Omega <= 30:
            outcome = RETURNED
        singular = 1.0
        if self.parameters.Omega < 2:
            singular = math.nan
        return Orbit(outcome, *known, end, jacobian, by * singular)

    def apart(self, x, y):
        return float(np.linalg.norm(x - y)) / self.deflection

    def returns(self, x, most):
        for _ in range(most):
            orbit = self.evaluate(x, tangent=False)
            if orbit.outcome != RETURNED:
                return
            x = orbit.end
            yield x

    @property
    def first_release(self):
        return Passage(RETURNED, 0.0, self.static)

    def state(self, x):
        known = {"time": 0.0, "psi": 0.0, "f": 0.0, "u": 0.0, "u_velocity": 0.0}
        rest = np.zeros(len(x))
        return State(
            **known, phase="stick", direction=1, a=np.array(x), b=rest, alpha=rest, beta=rest
        )

    def point(self, state):
        return np.array(state.a)


class FoldMap(ToyMap):
    """The map of the head of this file."""

    size = 3
    scale = np.ones(3)
    diameters = np.array([0, 1, 1])
    static = np.array([2.0, 0.0, 0.0])
    deflection = 2.0

    def step(self, x):
        Omega = self.parameters.Omega
        N = self.parameters.N
        turned = math.exp(0.1 * outside(Omega, N)) * ROTATION
        jacobian = np.zeros((3, 3))
        jacobian[0, 0] = 1 - 0.6 * (x[0] - 1)
        jacobian[1:, 1:] = turned
        rest = turned @ x[1:]
        end = np.array([x[0] + 0.3 * ((fold_at(N) - Omega) / 10 - (x[0] - 1) ** 2), *rest])
        changes = {
            "Omega": np.array([-0.03, *(0.2 * (Omega - 10) / 16 * rest)]),
            "N": np.array([6e-4, *(0.2 * (N - 300) / 1e4 * rest)]),
        }
        return end, jacobian, changes


class RoundMap(ToyMap):
    """x -> x + 0.2 (1 - (x - 2)^2 - ((Omega - middle(N)) / 4)^2), middle(N) = 12 + 0.01 (N - 300): the
    cycles are a closed curve, with folds at 8 and 16 rad/s for 300 N. Those of x > 2 are stable."""

    size = 1
    scale = np.ones(1)
    diameters = np.zeros(1, np.int64)
    static = np.array([3.0])

    def step(self, x):
        far = (self.parameters.Omega - 12 - 0.01 * (self.parameters.N - 300)) / 4
        end = x + 0.2 * (1 - (x - 2) ** 2 - far**2)
        jacobian = np.array([[1 - 0.4 * (x[0] - 2)]])
        return end, jacobian, {"Omega": np.array([-0.1 * far]), "N": np.array([0.001 * far])}


class ResonantMap(ToyMap):
    """y -> RHO exp(i t) y + FORCE for y = x_0 + i x_1, with the angle t = Omega - 12 - LEAN |y|^2.

    Cycles obey |y|^2 |1 - RHO exp(i t)|^2 = FORCE^2, from which Omega follows for each |y|: beside a
    small cycle there is a narrow peak, which leans over two folds.
    """

    RHO: ClassVar = 0.999
    FORCE: ClassVar = 2e-4
    LEAN: ClassVar = 0.15
    size = 2
    scale = np.ones(2)
    diameters = np.ones(2, np.int64)
    static = np.zeros(2)

    def step(self, x):
        y = complex(*x)
        angle = self.parameters.Omega - 12 - self.LEAN * abs(y) ** 2
        factor = self.RHO * np.exp(1j * angle)
        end = factor * y + self.FORCE
        by_angle = 1j * factor * y
        columns = [
            factor - 2 * self.LEAN * x[0] * by_angle,
            1j * factor - 2 * self.LEAN * x[1] * by_angle,
        ]
        jacobian = np.array([[c.real for c in columns], [c.imag for c in columns]])
        return _pair(end), jacobian, {"Omega": _pair(by_angle)}

    @classmethod
    def folds(cls):
        """Speeds of both folds, rad/s: the extremes of Omega over |y| on the far flank of the
        peak."""
        largest = cls.FORCE / (1 - cls.RHO)
        sizes = np.linspace(0.05, 1, 2000)[:-1] * largest
        turns = np.flatnonzero(np.diff(np.sign(np.diff(cls.flank(sizes))))) + 1
        found = []
        for i, sense in zip(turns, (1, -1), strict=True):  # first a least speed, then a largest
            around = sizes[i - 1], sizes[i + 1]
            extreme = minimize_scalar(
                lambda size, sense=sense: sense * cls.flank(size),
                bounds=around,
                method="bounded",
                options={"xatol": 1e-10},
            )
            found.append(sense * extreme.fun)
        return np.sort(found)

    @classmethod
    def flank(cls, size):
        """Speed at which a cycle of a size is on the far flank, rad/s."""
        cosine = (1 + cls.RHO**2 - (cls.FORCE / size) ** 2) / (2 * cls.RHO)
        return 12 + cls.LEAN * size**2 + np.arccos(cosine)


class BrokenMap(ToyMap):
    """x -> 0.5 x + 0.125 (Omega - 12), but 3 less where x > 1: the cycles x = (Omega - 12) / 4 end at
    16 rad/s, and no cycle continues them."""

    size = 1
    scale = np.ones(1)
    diameters = np.zeros(1, np.int64)
    static = np.zeros(1)

    def step(self, x):
        end = 0.5 * x + 0.125 * (self.parameters.Omega - 12) - (3 if x[0] > 1 else 0)
        return end, np.array([[0.5]]), {"Omega": np.array([0.125])}


def _pair(value):
    return np.array([value.real, value.imag])


def use(monkeypatch: pytest.MonkeyPatch, toy: type[ToyMap]) -> None:
    """Let cycles be those of a toy."""
    for module in ("cycle", "continuation.cycles"):
        monkeypatch.setattr(f"disc_model.stability.{module}.ReturnMap", toy)
    heights = "disc_model.stability.continuation.branch.extremes_of_cycle"
    monkeypatch.setattr(heights, lambda *_: (-1e-6, 1e-6))  # these are no motions of a slider


@pytest.fixture
def fold_map(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cycles are those of the `FoldMap`."""
    use(monkeypatch, FoldMap)
