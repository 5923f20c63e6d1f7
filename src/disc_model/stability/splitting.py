"""Split pairs of modes in steady sliding: whether the difference of their frequencies matters.

A disc that is not quite axisymmetric holds both halves of a pair in place and gives them two
frequencies, omega (1 -+ s/2) with the split s. Seen by the slider, which moves over the disc, the
pair then has besides its mean stiffness

    omega^2 s [-cos 2 l Omega t, sin 2 l Omega t; sin 2 l Omega t, cos 2 l Omega t],

and the equations of steady sliding are periodic: half a turn brings the same disc back. Their
growth rates are logarithms of Floquet multipliers. The split couples the waves that travel with
and against the slider, of which friction feeds one and damps the other. If it is small they stay
apart, as in an axisymmetric disc. If it is large, each half moves by itself, by turns at each place
of the slider, and grows by the mean of both rates. Both limits are no bounds: where pairs couple
with each other or with the slider, the growth rate may be above both or below both.
"""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np

from disc_model.arrays import EqualByValue, Indices
from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import Modes, modal_damping, mode_arrays
from disc_model.display import Summarised
from disc_model.errors import (
    Fault,
    ParameterError,
    raise_faults,
    require,
    violations,
    with_known_names,
)
from disc_model.parameters import Parameters, foreign_case
from disc_model.stability.return_map import Array
from disc_model.stability.sliding import SlidingStatus, growth_rates, split_rows, steady_sliding
from disc_model.units import in_si, is_number

if TYPE_CHECKING:
    import pandas as pd

WIDEST = 0.2  # greatest split; halves that are further apart are modes of their own
STEPS = 10  # of a period of the fastest solution
ORDER = 10  # of the series of exponentials: their error is 1e-9 per step
MOST_STEPS = 100_000  # of half a turn
LARGE = 1e100  # size of a propagator that is scaled down
NOTICED = 0.1  # relative change of the growth rate that matters,
ZERO = 1e-9  # 1/s, growth rate that is 0 but for rounding,
ROUNDING = 1e-12  # and over the largest one
LEAST = 1e-6  # 1/s, if it is more than this, which changes a motion by a tenth in a day,
OF_DAMPING = 0.01  # and than this share of the pairs' damping, which no test finds more accurately


@dataclass(frozen=True, eq=False, repr=False)
class SplitGrowth(Summarised, EqualByValue):
    """Growth rates of steady sliding of a disc with split pairs, and of both limits, which are no
    bounds.

    Attributes
    ----------
    together : 1/s, largest growth rate with the mean frequency of each pair, as `steady_sliding`
        has it
    growth_rate : 1/s, with the splits; it may be above or below both `together` and `apart`
    apart : 1/s, with each half by itself, which large splits approach
    pairs : DataFrame with a row for each pair: diameters, circles, frequency_Hz, split, and growth
        rates together and apart of the modes of steady sliding in which this pair moves most
    damping_rate : 1/s, the least rate at which a pair with a split decays without contact; 0 without damping
    """

    together: float
    growth_rate: float
    apart: float
    pairs: "pd.DataFrame"
    damping_rate: float = 0.0

    def __repr__(self) -> str:
        together, growth_rate, apart = self._texts()
        return f"SplitGrowth(together={together}, growth_rate={growth_rate}, apart={apart})"

    def _texts(self) -> list[str]:
        """The growth rates as numbers; 0 for rounding errors, which are small over the largest."""
        rates = np.array([self.together, self.growth_rate, self.apart])
        rates[np.abs(rates) < max(ZERO, ROUNDING * float(np.abs(rates).max()))] = 0.0
        return [f"{rate:.4g}" for rate in rates.tolist()]

    @property
    def matters(self) -> bool:
        """Whether the splits change the growth rate by more than a tenth, or its sign, and by more
        than can be told: a hundredth of `damping_rate`, and 1e-6/s, since without dampers it may be zero
        to rounding."""
        changes_sign = (self.together > 0) != (self.growth_rate > 0)
        change = abs(self.growth_rate - self.together)
        least = max(LEAST, OF_DAMPING * self.damping_rate)
        return change > least and (changes_sign or change > NOTICED * abs(self.together))

    def _summary(self) -> Iterator[tuple[str, object]]:
        together, growth_rate, apart = self._texts()
        yield "pairs together", f"{together} 1/s"
        yield "with the splits", f"{growth_rate} 1/s"
        yield "halves apart", f"{apart} 1/s"
        yield "the split matters", "yes" if self.matters else "no"


class Pair(NamedTuple):
    """A pair in the rows of steady sliding's Jacobian: its mode, and the places of its
    displacements and velocities."""

    mode: int
    a: int
    alpha: int
    b: int
    beta: int


@with_known_names
def split_growth(case: Parameters, split: float | Iterable[float] | None = None) -> SplitGrowth:
    """Find whether the split of pairs of modes matters to steady sliding: growth rates with equal
    frequencies, with the split, and of each half by itself.

    Antinodes of all pairs lie at the same place of the disc. The growth rates are those of small
    motions; the forced vibration that a split disc has besides is left out. The first and the last
    of them are limits of small and of large splits, and no bounds.

    Parameters
    ----------
    case : the case
    split : relative difference of the two frequencies of each pair, 0 to 0.2 or "20 %": one number,
        or one for each mode in the order of `plate_modes`; if left out, those that `disc.report` has of a
        file

    Returns
    -------
    SplitGrowth

    Raises
    ------
    ParameterError
        If a number is not allowed, no split is known, the case has no steady sliding, or the drive
        is so slow that half a turn takes more than 100,000 steps.

    Examples
    --------
    >>> import disc_model as dm
    >>> modes = {"diameters": [2], "omega": [3000], "amplitude": [0.54], "tangential": [-0.13]}
    >>> disc = dm.Disc(**modes, damping_ratio=[1e-3])
    >>> pad = {"r_0": 0.1, "k": 1e6, "k_p": 1e6, "c_p": 50, "m": 0.5, "mu_s": 0.45, "mu_k": 0.35}
    >>> case = dm.Parameters(N=8000, Omega=80, disc=disc, friction_offset="surface", **pad)
    >>> dm.split_growth(case, 0.001)
    SplitGrowth(together=3.237, growth_rate=3.172, apart=-3.676)
    >>> dm.split_growth(case, 0.02).matters
    True
    """
    rule = "must be >= 0: the split of pairs needs modes of the disc"
    raise_faults(
        foreign_case(case)
        or violations((case.n_diameters >= 0, "n_diameters", case.n_diameters, rule))
    )
    modes = mode_arrays(case)
    splits = _splits(case, split, modes)
    sliding = steady_sliding(case)
    if sliding.status is not SlidingStatus.OK:
        raise ParameterError(Fault((), "", f"there is no steady sliding: {sliding.message}"))

    pairs = _pairs(modes, len(sliding.jacobian))
    table, others = _waves(case, modes, pairs, splits, sliding.jacobian)
    growth_rate = sliding.growth_rate
    if any(splits[pair.mode] > 0 for pair in pairs):
        growth_rate = _floquet_growth(case, modes, pairs, splits, sliding.jacobian)
    apart = max([*table["apart"], *others], default=sliding.growth_rate)
    damping_rate = _damping_rate(case, pairs, splits)
    return SplitGrowth(sliding.growth_rate, growth_rate, float(apart), table, damping_rate)


def _damping_rate(p: Parameters, pairs: list[Pair], splits: list[float]) -> float:
    """The least rate, 1/s, at which a pair with a split decays without contact; 0 if none has one."""
    rates = modal_damping(p) / 2
    return min((float(rates[pair.mode]) for pair in pairs if splits[pair.mode] > 0), default=0.0)


def _splits(p: Parameters, split: Any, modes: Modes) -> list[float]:
    """The split of each mode, checked."""
    count = len(modes.omega)
    if split is None:
        rule = "must be given: the disc does not come from a file with both halves of pairs"
        report = p.disc.report if p.disc is not None else None
        require((report is not None and report.has_shapes, "split", split, rule))
        if report is not None:
            split = report.split
    faults: list[Fault] = []
    split = in_si(split, "1", faults, ("split",))
    raise_faults(faults)
    numbers = split
    if is_number(split):
        numbers = [split] * count
    rule = f"must be one number from 0 to {WIDEST:g}, or one for each of {count} modes"
    is_list = isinstance(numbers, list | tuple | np.ndarray) and np.ndim(numbers) == 1
    require((is_list and len(numbers) == count, "split", split, rule))
    allowed = all(is_number(number) and 0 <= number <= WIDEST for number in numbers)
    require((allowed, "split", split, rule))
    return [float(number) for number in numbers]


def _pairs(modes: Modes, size: int) -> list[Pair]:
    """The pairs in a Jacobian of this size."""
    parts, _, _ = split_rows(modes, np.arange(size))
    a, alpha, b, beta = (part.astype(int).tolist() for part in parts)
    modes_of_pairs = np.flatnonzero(modes.diameters > 0).tolist()
    return [Pair(i, a[i], alpha[i], b[i], beta[i]) for i in modes_of_pairs]


# ---- Both limits


def _waves(
    p: Parameters, modes: Modes, pairs: list[Pair], splits: list[float], jacobian: Array
) -> tuple["pd.DataFrame", list[float]]:
    """Growth rates of the two modes of steady sliding in which each pair moves most, and of all
    other modes."""
    import pandas as pd

    values, vectors = np.linalg.eig(jacobian)
    upper = values.imag > 0
    growth = growth_rates(values)[upper]
    energy = np.abs(vectors[:, upper].T) ** 2 * _weights(p, modes, pairs)
    share = energy / energy.sum(axis=1, keepdims=True)
    used: set[int] = set()
    rows: list[dict[str, Any]] = []
    for pair in pairs:
        of_pair = share[:, [pair.a, pair.alpha, pair.b, pair.beta]].sum(axis=1)
        both = np.argsort(of_pair)[::-1][:2]
        used |= set(both.tolist())
        rates = growth[both]
        rows.append(
            {
                "diameters": int(modes.diameters[pair.mode]),
                "circles": int(modes.circles[pair.mode]),
                "frequency_Hz": float(modes.omega[pair.mode]) / math.tau,
                "split": splits[pair.mode],
                "together": float(rates.max()),
                "apart": float(rates.mean()),
            }
        )
    others = [rate for i, rate in enumerate(growth.tolist()) if i not in used]
    columns = ["diameters", "circles", "frequency_Hz", "split", "together", "apart"]
    return pd.DataFrame(rows, columns=columns), others


def _weights(p: Parameters, modes: Modes, pairs: list[Pair]) -> Array:
    """Weights by which squares of the Jacobian's rows are energies of disc and slider."""
    square = modes.omega**2
    of_pairs = [pair.mode for pair in pairs]
    in_pairs = square[of_pairs]
    slider = [p.k_p * p.r_0**2, p.m * p.r_0**2]
    height = []
    compliance = contact_compliance(p)
    if compliance > 0:
        height = [p.k + 1 / compliance, p.m]
    return np.concatenate(
        [square, np.ones_like(square), in_pairs, np.ones_like(in_pairs), slider, height]
    )


# ---- The periodic equations


class Coupling(NamedTuple):
    """What splits add to the Jacobian of steady sliding, of n pairs.

    rows, columns : (4, n), places of the entries: a and b in the equations of alpha, then of beta
    stiffness : (n,), omega^2 s, 1/s^2
    rate : (n,), 2 l Omega, rad/s
    """

    rows: Indices
    columns: Indices
    stiffness: Array
    rate: Array

    @classmethod
    def of(cls, p: Parameters, modes: Modes, pairs: list[Pair], splits: list[float]) -> Self:
        """The coupling of the pairs that have a split."""
        split = [pair for pair in pairs if splits[pair.mode] > 0]
        _, a, alpha, b, beta = np.array(split).T
        of_pairs = [pair.mode for pair in split]
        return cls(
            rows=np.stack([alpha, alpha, beta, beta]),
            columns=np.stack([a, b, a, b]),
            stiffness=modes.omega[of_pairs] ** 2 * np.array(splits)[of_pairs],
            rate=np.asarray(2 * modes.diameters[of_pairs] * p.Omega, dtype=float),
        )

    def added_to(self, jacobian: Array, t: float) -> Array:
        """The Jacobian with what the splits add at a time, s."""
        cosine = self.stiffness * np.cos(self.rate * t)
        sine = self.stiffness * np.sin(self.rate * t)
        sum_ = jacobian.copy()
        sum_[self.rows, self.columns] += np.stack([-cosine, sine, sine, cosine])
        return sum_


def _floquet_growth(
    p: Parameters, modes: Modes, pairs: list[Pair], splits: list[float], jacobian: Array
) -> float:
    """The largest growth rate of the equations with the splits, 1/s: half a turn by Magnus's method
    of the fourth order, which does not damp fast modes."""
    half_turn = math.pi / p.Omega
    fastest = float(np.abs(np.linalg.eigvals(jacobian)).max())  # also a damper of the slider
    steps = math.ceil(STEPS * half_turn * fastest / math.tau)
    rule = f"must be faster: half a turn takes {steps} steps, and at most {MOST_STEPS} are computed"
    require((steps <= MOST_STEPS, "Omega", p.Omega, rule))

    # the mean of the squares of both frequencies is above the square of their mean
    mean = jacobian.copy()
    for pair in pairs:
        excess = (modes.omega[pair.mode] * splits[pair.mode] / 2) ** 2
        mean[[pair.alpha, pair.beta], [pair.a, pair.b]] -= excess

    coupling = Coupling.of(p, modes, pairs, splits)
    h = half_turn / steps
    gauss = math.sqrt(3) / 6
    propagator = np.eye(len(jacobian))
    logarithm = 0.0  # of what was taken out of the propagator
    for i in range(steps):
        first = coupling.added_to(mean, (i + 0.5 - gauss) * h)
        second = coupling.added_to(mean, (i + 0.5 + gauss) * h)
        commutator = second @ first - first @ second
        exponent = h / 2 * (first + second) + gauss / 2 * h**2 * commutator
        propagator = _exponential_times(exponent, propagator)
        size = float(np.abs(propagator).max())
        if size > LARGE:
            propagator /= size
            logarithm += math.log(size)
    largest = float(np.abs(np.linalg.eigvals(propagator)).max())
    return (math.log(largest) + logarithm) / half_turn


def _exponential_times(exponent: Array, matrix: Array) -> Array:
    """The exponential of a small matrix times another one, by its series."""
    term = matrix
    total = matrix.copy()
    for k in range(1, ORDER + 1):
        term = exponent @ term / k
        total += term
    return total
