"""Oscillating modes of steady sliding, and which modes of neighbouring cases are the same."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from disc_model.arrays import Array, ComplexArray, Indices
from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import mode_arrays
from disc_model.parameters import Parameters
from disc_model.stability.sliding import (
    SlidingStatus,
    SteadySliding,
    absent,
    described,
    growth_rates,
    join_rows,
    linearised,
    split_rows,
)


@dataclass(frozen=True, eq=False)
class SlidingModes:
    """Oscillating modes of steady sliding; eigenvalues without oscillation are left out.

    Attributes
    ----------
    frequency, growth_rate : Hz, 1/s, shape (n,), in the slider's frame; a growth rate is exactly 0 where it is
        nothing but rounding
    damping_ratio : (n,), negative for a mode that grows, and 0 where the growth rate is
    diameters : (n,), nodal diameters of the disc's modes with most energy; -1 if the slider's in-plane motion has most
    forward : (n,), share of these modes' energy in waves that travel with the slider, seen at f - l Omega / 2 pi
    shapes : (rows of `SteadySliding.jacobian`, n)
    """

    frequency: Array
    growth_rate: Array
    damping_ratio: Array
    diameters: Indices
    forward: Array
    shapes: ComplexArray = field(repr=False)


def sliding_modes(p: Parameters, sliding: SteadySliding | None = None) -> SlidingModes:
    """Modes of steady sliding by ascending frequency; none without steady sliding, which is
    computed if not given."""
    if sliding is None:
        return _sliding_and_modes(p)[1]
    return _modes_of(p, *np.linalg.eig(sliding.jacobian))


def _sliding_and_modes(p: Parameters) -> tuple[SteadySliding, SlidingModes]:
    """Steady sliding and its modes, of which there are none without it. Values and shapes come from
    one solution of the eigenvalue problem, which takes nearly all of the time of 100 modes."""
    found = linearised(p)
    if isinstance(found, SlidingStatus):
        nothing = absent(p, found)
        return nothing, sliding_modes(p, nothing)
    values, vectors = np.linalg.eig(found.jacobian)
    return described(p, found, values), _modes_of(p, values, vectors)


def _modes_of(p: Parameters, values: ComplexArray, vectors: ComplexArray) -> SlidingModes:
    """The modes of eigenvalues, (n,), and eigenvectors, (n, n), by ascending frequency."""
    order = [i for i in np.argsort(values.imag, kind="stable") if values[i].imag > 0]
    growth_rate = growth_rates(values)[order]
    values = values[order]
    vectors = np.asarray(vectors[:, order], dtype=complex)
    if not order:
        nothing = np.zeros(0)
        return SlidingModes(nothing, nothing, nothing, np.zeros(0, np.int64), nothing, vectors)
    modes = mode_arrays(p)
    l = modes.diameters
    omega = modes.omega[:, None]
    (a, alpha, b, beta), (psi, f), _ = split_rows(modes, vectors)
    energy = np.abs(omega * a) ** 2 + np.abs(alpha) ** 2
    energy = energy + np.abs(omega * b) ** 2
    energy = energy + np.abs(beta) ** 2
    numbers = range(int(l.max(initial=0)) + 1)
    by_number = np.array([energy[l == number].sum(axis=0) for number in numbers])
    diameters = by_number.argmax(axis=0)
    most = l[:, None] == diameters

    # a + i b and a - i b are the waves that travel in opposite directions
    with_slider = np.sum(np.abs(omega * (a + 1j * b)) ** 2, axis=0, where=most)
    against = np.sum(np.abs(omega * (a - 1j * b)) ** 2, axis=0, where=most)
    with np.errstate(invalid="ignore"):  # a mode without the disc has no waves
        forward = np.asarray(with_slider / (with_slider + against), dtype=float)

    in_plane = p.r_0**2 * (p.k_p * np.abs(psi) ** 2 + p.m * np.abs(f) ** 2)
    return SlidingModes(
        frequency=values.imag / (2 * math.pi),
        growth_rate=growth_rate,
        damping_ratio=np.asarray((0.0 - growth_rate) / np.abs(values), dtype=float),
        diameters=np.where(in_plane > energy.sum(axis=0), -1, diameters).astype(np.int64),
        forward=forward,
        shapes=vectors,
    )


# least likeness of modes that are followed; otherwise the step is halved, up to `HALVINGS` times
ALIKE = 0.9
HALVINGS = 6


class FollowedModes(NamedTuple):
    """Steady sliding of a case and its modes; their numbers, and likeness (modal assurance
    criterion, the squared cosine of shapes) to the modes of the case before that have them, nan for
    new ones, both (n,)."""

    sliding: SteadySliding
    modes: SlidingModes
    numbers: Indices
    mac: Array


def follow_modes(cases: Sequence[Parameters]) -> list[FollowedModes]:
    """Steady sliding and its modes along cases that differ in numbers.

    Modes keep the numbers that they have by frequency, from 0 on, in the first case; modes that
    appear later have the next ones. Further cases between two are computed until it is clear which
    mode is which.
    """
    followed = list[FollowedModes]()
    shapes = list[ComplexArray]()  # of each number, the last one
    before: Parameters | None = None
    for p in cases:
        sliding, modes = _sliding_and_modes(p)
        numbers, mac = _numbered(shapes, before, p, modes, HALVINGS)
        followed.append(FollowedModes(sliding, modes, numbers, mac))
        before = p
    return followed


def _numbered(
    shapes: list[ComplexArray],
    before: Parameters | None,
    p: Parameters,
    modes: SlidingModes,
    halvings: int,
) -> tuple[Indices, Array]:
    """Numbers and likeness of the modes of a case; `shapes`, by number, become those of this
    case. Where the modes are in doubt, the case `before` is followed to this one by halves of the
    way, up to so many `halvings`."""
    # slow to import, and steady sliding alone does without
    from scipy.optimize import linear_sum_assignment

    if not len(modes.frequency):
        return np.zeros(0, np.int64), np.zeros(0)
    scaled = np.sqrt(energy_weights(p))[:, None] * modes.shapes
    scaled = scaled / np.linalg.norm(scaled, axis=0)
    mac = np.abs(np.array(shapes).reshape(len(shapes), len(scaled)).conj() @ scaled) ** 2
    numbers, places = linear_sum_assignment(-mac)
    if before is not None and halvings and mac[numbers, places].min(initial=1) < ALIKE:
        between = _case_between(before, p)
        if between is not None:
            half = sliding_modes(between)
            if len(half.frequency):
                _numbered(shapes, before, between, half, halvings - 1)
                return _numbered(shapes, between, p, modes, halvings - 1)

    matched = np.full(len(modes.frequency), -1)
    matched[places] = numbers
    likeness = np.full(len(modes.frequency), math.nan)
    likeness[places] = mac[numbers, places]
    matched[matched < 0] = len(shapes) + np.arange(np.sum(matched < 0))
    for number, shape in sorted(zip(matched, scaled.T, strict=True), key=lambda pair: pair[0]):
        shapes[number : number + 1] = [shape]
    return matched, likeness


def _case_between(before: Parameters, after: Parameters) -> Parameters | None:
    """The case halfway between two that differ in numbers; None if they do not differ."""
    ends = dict(after)
    middles = {}
    for name, value in before:
        if isinstance(value, float) and value != ends[name]:
            middles[name] = (value + ends[name]) / 2
    return after.replace(**middles) if middles else None


def energy_weights(p: Parameters) -> Array:
    """Weights of squared rows of the Jacobian in the energy of a motion."""
    modes = mode_arrays(p)
    compliance = contact_compliance(p)
    stiffness = modes.omega**2
    ones = np.ones(len(modes.omega))
    slider = [p.r_0**2 * p.k_p, p.r_0**2 * p.m]
    height = []
    if compliance:
        height = [p.k + 1 / compliance, p.m]
    rows = join_rows(modes, (stiffness, ones, stiffness, ones), slider, height)
    return np.asarray(rows, np.float64)
