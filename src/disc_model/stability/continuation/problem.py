"""F(x, q) = R(x, q) - x of a return map R: its zeros are cycles, as a curve or surface over the
free parameters q.

Unknowns are z = (C x / size, q / scales), where C is one but for a compliant contact. The map is a
`SectionMap`: that of stick-slip cycles is `disc_model.stability.return_map.ReturnMap`, that of
cycles that slip all the time `disc_model.stability.slipping_map.SlippingMap`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from disc_model.data.variables import GIVE_A_GUESS, value_with_unit
from disc_model.errors import Fault, ModeError, ParameterError
from disc_model.parameters import DEFAULTS, RESIDUAL, Parameters
from disc_model.stability.continuation.compliance import CompliantPlate
from disc_model.stability.continuation.curve import CurvePoint, Evaluation, Rejected, curve_point
from disc_model.stability.cycle import FloquetResult
from disc_model.stability.return_map import (
    ENDS,
    PARAMETERS,
    Array,
    Counts,
    Orbit,
    ReturnMap,
    newton_step,
)

# typical values of parameters whose value in Table 1 is missing or 0
USUAL = {
    "Omega": 20.0,
    "N": 300.0,
    "c": 0.5,
    "c_p": 0.5,
    "contact_compliance": 1e-8,
    "contact_arc": 0.4,
    "damping_ratio": 1e-3,
    "friction_decay": 1.0,
    "viscous_friction": 0.01,
}
SMALLEST = 0.2  # of a parameter's scale, over its typical value
SMALLEST_OF_SPAN = 0.1  # of a parameter's scale, over the largest value of interest
# In a stiff contact a cycle bends within a millionth of the static deflection: a parameter then counts
# for so much less that its folds are round, and steps are so much shorter.
STRETCH = 100.0
EXACT = 1e-9  # last correction of a point on such a contact; on any other one the first is the last
DIFFERENCE = 1e-5  # over a parameter's scale: orbits are accurate to 1e-13, their second derivatives of order one
# Beside a grazing release orbits depend on a parameter like a square root, with a curvature without
# bounds: a difference of two orbits is that of shorter changes there, until their mean differs from
# the orbit between them by this share of the difference, whose own error is about its square.
CURVED = 1e-3
SHORTER = 0.1
MOST_SHORTER = 6

WITHOUT_RETURN = {
    "time_over": "the slider slips on without sticking",
    "lost_contact": "the motion does not return: it loses contact",
    "off_section": "the motion does not return: it is not released, or not in contact, where it starts",
    "paradox": "the motion does not return: it runs into Painleve's paradox",
    "stalled": "the motion does not return: switches follow each other without the clock moving",
    "non_finite": "the motion does not return: it overflows",
    "stops": "the motion does not return: the slider stops",
    "vanished": "the cycle shrinks to steady sliding",
}
"""Words for the end of a motion that does not return to the section."""


def parameter_scale(p: Parameters, name: str, farthest: float = 0.0) -> float:
    """The change of a parameter that counts as one: its value, a fifth of a typical one, or a tenth
    of the `farthest` value to which it is followed, whichever is most."""
    value = abs(p.numbers[name])
    usual = USUAL.get(name, DEFAULTS.get(name))
    typical = SMALLEST * usual if isinstance(usual, float) else 0.0
    return max(value, typical, SMALLEST_OF_SPAN * abs(farthest)) or 1.0


def stretch_of(p: Parameters, name: str) -> float:
    """The factor of a parameter's scale in a case: the compliance itself, which changes the
    frequency of the contact's vibration, has none."""
    return STRETCH if has_own_vibration(p) and name != "contact_compliance" else 1.0


def has_own_vibration(p: Parameters) -> bool:
    """Whether the contact has a stiffness of its own, which may be so high that it vibrates alone:
    that of the modes left out does not."""
    return p.contact_compliance not in (0, RESIDUAL)


class CycleProblem:
    """F of the cycles of a case, in the free parameters `names`.

    With an `order` of events cycles may lose contact, and have as many releases in a period; `scale`
    replaces a parameter's own. `points` of the section are over `size`, the norm of the static
    deflection, in the coordinates of the case `base`; those of another case differ from them where
    the disc's frequencies do. The compression of a compliant contact is one of the unknowns, in the
    place of the slider's height: Newton's method and distances would otherwise be those of the
    contact's vibration.
    """

    def __init__(
        self,
        base: Parameters,
        names: tuple[str, ...],
        scale: float | None,
        tol: float,
        order: Counts | None = None,
        make_map: type[ReturnMap] | None = None,
    ) -> None:
        self.base = base
        self.names = names
        self.tol = tol
        self.exact = EXACT if has_own_vibration(base) else math.inf
        self.order = order
        self.make_map: type[ReturnMap] = make_map or ReturnMap
        self.reference = self.make_map(base, tol)
        self.n = self.reference.size
        self.size = self.reference.deflection
        self._to_unknowns = self.reference.compression
        self._from_unknowns = np.linalg.inv(self._to_unknowns)
        self.scales = np.array([scale or parameter_scale(base, name) for name in names])
        self._differentiable = tuple(name for name in names if name in PARAMETERS)
        self._plate: CompliantPlate | None = None
        if CompliantPlate.is_needed(base, names):
            self._plate = CompliantPlate(base, names[0])
        self._map: ReturnMap | None = None  # the map of the parameters last used
        self._values: tuple[float, ...] = ()

    def case(self, z: Array) -> Parameters:
        """The case at a point; raises `ParameterError` where there is none."""
        values = (z[self.n :] * self.scales).tolist()
        p = self.base.replace(**dict(zip(self.names, values, strict=True)))
        if self._plate is not None:
            p = p.replace(contact_compliance=self._plate.at(values[0]))
        return p

    def words(self, point: CurvePoint) -> str:
        """The values of the free parameters at a point, such as "Omega = 15.0949 rad/s"."""
        values = point.z[self.n :] * self.scales
        return ", ".join(map(value_with_unit, self.names, values.tolist()))

    def map_at(self, z: Array) -> ReturnMap:
        """The return map of the case at a point."""
        values = tuple(z[self.n :].tolist())
        if self._map is None or values != self._values:
            self._map = self._make_map(z)
            self._values = values
        return self._map

    def _make_map(self, z: Array) -> ReturnMap:
        try:
            p = self.case(z)
            missing = min(p.Omega, p.N, p.k_p) <= 0
            if missing:
                raise Rejected("the drive, the preload or the in-plane spring vanishes")
            patient = self.order is not None
            return self.make_map(p, self.tol, self._differentiable, patient=patient)
        except (ParameterError, ModeError) as fault:
            raise Rejected(str(fault)) from None

    def section_point(self, z: Array) -> Array:
        """The point of the section, in the coordinates of the map at z."""
        return self.reference_point(z) / self._turn(self.map_at(z))

    def reference_point(self, z: Array) -> Array:
        """The point of the section, in the coordinates of the case `base`."""
        return self._from_unknowns @ (z[: self.n] * self.size)

    def _turn(self, section_map: ReturnMap) -> Array:
        """Factors from the coordinates of a map to those of the reference."""
        return self.reference.scale / section_map.scale

    def follow(self, z: Array, *, tangent: bool, releases: int | None = None) -> Orbit:
        """The motion from a point to its return, or to another number of releases, whatever its
        end."""
        if releases is None:
            releases = self.order.releases if self.order else 1
        return self.map_at(z).evaluate(
            self.section_point(z),
            releases=releases,
            tangent=tangent,
            may_separate=self.order is not None,
        )

    def _return(
        self, z: Array, *, tangent: bool, releases: int | None = None
    ) -> tuple[Orbit, Array]:
        """The motion from a point to its return, or to another number of releases, and F."""
        orbit = self.follow(z, tangent=tangent, releases=releases)
        if not orbit.returned:
            raise Rejected(WITHOUT_RETURN[ENDS[orbit.outcome]])
        change = (orbit.end - orbit.start) * self._turn(self.map_at(z))
        return orbit, self._to_unknowns @ change / self.size

    def residual(self, z: Array, releases: int | None = None) -> Array:
        """F at z, of cycles with another number of releases if there is one."""
        return self._return(z, tangent=False, releases=releases)[1]

    def evaluate(self, z: Array, releases: int | None = None) -> Evaluation:
        """F at z, with its derivatives, of cycles with another number of releases if there is
        one."""
        orbit, residual = self._return(z, tangent=True, releases=releases)
        turn = self._turn(self.map_at(z))
        of_section = orbit.jacobian * turn[:, None] / turn[None, :]
        jacobian = self._to_unknowns @ of_section @ self._from_unknowns
        by_parameters = np.zeros((self.n, len(self.names)))
        column = 0
        for i, name in enumerate(self.names):
            if name in self._differentiable:
                change = self._to_unknowns @ (orbit.by[:, column] * turn) / self.size
                by_parameters[:, i] = change * self.scales[i]
                column += 1
            else:
                by_parameters[:, i] = self._difference(z, residual, i, releases)
        by = np.hstack([jacobian - np.eye(self.n), by_parameters])
        if not (np.all(np.isfinite(by)) and np.all(np.isfinite(residual))):
            raise Rejected("the variational equations are singular: a switch is grazed")
        return Evaluation(residual, by, orbit, jacobian)

    def _difference(self, z: Array, here: Array, i: int, releases: int | None) -> Array:
        """Derivative of F, which is `here` at z, by the i-th scaled parameter, by a difference of
        orbits."""
        change = DIFFERENCE / stretch_of(self.base, self.names[i])
        for _ in range(MOST_SHORTER):
            try:
                rise, bend = self._changes(z, here, i, change, releases)
            except Rejected:  # which a shorter change may pass
                pass
            else:
                if np.linalg.norm(bend) <= CURVED * np.linalg.norm(rise):
                    break
            change *= SHORTER
        else:
            rise, _ = self._changes(z, here, i, change, releases)
        return np.asarray(rise / (2 * change), dtype=float)

    def _changes(
        self, z: Array, here: Array, i: int, change: float, releases: int | None
    ) -> tuple[Array, Array]:
        """The rise of F over two changes of the i-th scaled parameter, to second order, and its bend:
        on both sides of z, or on one at a limit of the parameter, such as 0."""
        move = np.zeros(len(z))
        move[self.n + i] = change
        # x stays the same point of the reference's coordinates
        if self._is_case(z - move) == self._is_case(z + move):
            ahead = self.residual(z + move, releases)
            behind = self.residual(z - move, releases)
            return ahead - behind, (ahead + behind) / 2 - here
        if self._is_case(z - move):
            rise, bend = self._changes_aside(z, here, -move, releases)
            return -rise, bend
        return self._changes_aside(z, here, move, releases)

    def _changes_aside(
        self, z: Array, here: Array, move: Array, releases: int | None
    ) -> tuple[Array, Array]:
        """The rise of F over two moves, from differences on one side, and its bend."""
        near = self.residual(z + move, releases)
        far = self.residual(z + 2 * move, releases)
        return 4 * near - 3 * here - far, far / 2 + here / 2 - near

    def _is_case(self, z: Array) -> bool:
        """Whether the parameters of z are those of a case."""
        try:
            self.case(z)
        except ParameterError:
            return False
        return True

    def place(self, cycle: FloquetResult) -> Array:
        """z of a cycle of the case `base`; raises `ParameterError` if it cannot be followed."""
        if cycle.state is None or (cycle.releases > 1 and not self.order):
            ended = cycle.message.removesuffix(f": {GIVE_A_GUESS}")  # `another_start` says it
            found = f"that can be followed, but the search ended with {ended}"
            rule = f"must have a cycle of one release {found}; {another_start(self.names)}"
            fault = Fault(("case",), "", rule)
            if self.order:
                fault = Fault(("guess",), "", f"must lie near a cycle {found}")
            raise ParameterError(fault)
        return self.place_at(self.reference.point(cycle.state))

    def moved_to(self, z: Array, x: Array) -> Array:
        """z at the point x of the section, in the coordinates of the map at z."""
        unknowns = self._to_unknowns @ (x * self._turn(self.map_at(z))) / self.size
        return np.concatenate([unknowns, z[self.n :]])

    def place_at(self, x: Array) -> Array:
        """z of a point of the section of the case `base`."""
        values = np.array([self.base.numbers[name] for name in self.names])
        return np.concatenate([self._to_unknowns @ x / self.size, values / self.scales])

    def start(self, cycle: FloquetResult, along: Array) -> CurvePoint:
        """A cycle of the case `base` as a point of the curve in one parameter, with the tangent
        along a vector; raises `ParameterError` if it cannot be followed."""
        z = self.place(cycle)
        try:
            found = self.evaluate(z)
        except Rejected as lost:
            rule = f"must have a cycle that can be followed, but at its state {lost}"
            fault = Fault(("case",), "", f"{rule}; {another_start(self.names)}")
            raise ParameterError(fault) from None
        left = np.append(found.residual, np.zeros(len(self.names)))
        rows = np.eye(len(z))[self.n :]
        return curve_point(z - newton_step(np.vstack([found.by, rows]), left), found, along)

    def leading_diameters(self, point: CurvePoint) -> int:
        """Nodal diameters of the modes with most energy in the leading multiplier's eigenvector; -1
        on a rigid disc."""
        spectrum = point.spectrum
        diameters = self.reference.diameters
        if not len(diameters):
            return -1
        leading = int(np.argmax(np.abs(spectrum.values)))
        energy = np.abs(spectrum.right[: len(diameters), leading]) ** 2
        return int(np.argmax(np.bincount(diameters, energy)))


def another_start(names: Sequence[str]) -> str:
    """What to do where a case has no cycle to start from, in the free parameters `names`."""
    return (
        f"start from another value of {' or '.join(names)}, or give a state near a cycle as guess,"
        " such as the last one of a longer simulation"
    )


def growth_rate(multiplier: complex, period: float) -> float:
    """Growth rate of a multiplier, 1/s."""
    return math.log(abs(multiplier)) / period if multiplier else -math.inf
