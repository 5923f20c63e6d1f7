"""Cycles as zeros of F(x, q) = R(x, q) - x, in scaled unknowns.

R is the return map, x the point of the section and q the free parameters; the Jacobian of F by both comes from the
variational equations.  Distances mix the point, over the norm of the static deflection, with the parameters, over
their scales.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from disc_model.errors import ParameterError
from disc_model.parameters import Parameters
from disc_model.simulation.result import State
from disc_model.stability.newton import rounding
from disc_model.stability.return_map import OUTCOMES, RETURNED, Flight, ReturnMap

Array = NDArray[np.float64]

CORRECTIONS = 8
"""Newton steps allowed to a corrector before the arclength is halved."""


class Lost(Exception):
    """The corrector found no cycle, or the motion no return; the message says which."""


@dataclass(frozen=True)
class CyclePoint:
    z: Array
    residual: Array
    by: Array
    flight: Flight
    jacobian: Array


class CycleProblem:
    """F(x, q) in scaled unknowns z = (x / size, q / scales)."""

    def __init__(self, p: Parameters, names: tuple[str, ...], scales: Mapping[str, float] | None, tol: float) -> None:
        self.base, self.names, self.tol = p, names, tol
        self._reference = reference = ReturnMap(p, tol)
        self.n = reference.size
        self.scale = reference.scale
        self.size = float(np.linalg.norm(reference.static))
        given = dict(scales or {})
        self.scales = np.array([given.get(name, default_scale(p, name)) for name in names])

    def case(self, z: Array) -> Parameters:
        values = z[self.n :] * self.scales
        try:
            return self.base.replace(**dict(zip(self.names, map(float, values), strict=True)))
        except ParameterError as error:
            raise Lost(str(error)) from None

    def unknowns(self, state: State) -> Array:
        """z of a state on the section in the case at hand."""
        q = np.array([getattr(self.base, name) for name in self.names]) / self.scales
        return np.concatenate([self._reference.point(state) / self.size, q])

    def evaluate(self, z: Array) -> CyclePoint:
        p = self.case(z)
        if min(p.Omega, p.N, p.k_p) <= 0:
            raise Lost("the drive, the preload or the in-plane spring vanishes")
        map_ = ReturnMap(p, self.tol, self.names)
        x = z[: self.n] * self.size / self.scale * map_.scale
        flight, end, jacobian, by = map_.evaluate(x)
        if flight.outcome != RETURNED:
            raise Lost(f"the motion does not return: {OUTCOMES[flight.outcome]}")
        # into the reference's coordinates: they differ where E is free
        turn = self.scale / map_.scale
        jacobian = jacobian * turn[:, None] / turn[None, :]
        residual = (end - x) * turn / self.size
        if not (np.all(np.isfinite(jacobian)) and np.all(np.isfinite(by)) and np.all(np.isfinite(residual))):
            raise Lost("the variational equations are singular: a switch is grazed")
        parameters = by * turn[:, None] * self.scales[None, :] / self.size
        return CyclePoint(z, residual, np.hstack([jacobian - np.eye(self.n), parameters]), flight, jacobian)

    def correct(self, z: Array, rows: Array, targets: Array) -> CyclePoint:
        """Solve F = 0 with `rows` z = `targets`."""
        point = self.evaluate(z)
        last = math.inf
        for _ in range(CORRECTIONS):
            right = np.concatenate([point.residual, rows @ point.z - targets])
            error = float(np.linalg.norm(right))
            if error <= 30 * self.tol:
                return point
            if error > 0.8 * last:
                if error <= rounding(self.tol, 1e4):
                    return point
                break
            last = error
            point = self.evaluate(point.z - newton_step(np.vstack([point.by, rows]), right))
        raise Lost("Newton's method does not converge")

    def leading_diameters(self, jacobian: Array) -> int:
        """Nodal diameters of the modes with most energy in the leading multiplier's eigenvector."""
        values, vectors = np.linalg.eig(jacobian)
        energy = np.abs(vectors[:, np.argmax(np.abs(values))]) ** 2
        return int(np.argmax(np.bincount(self._reference.diameters, energy)))

    def tangents(self, point: CyclePoint) -> Array:
        """Orthonormal basis of the null space of F's Jacobian: (number of parameters, n + number of parameters)."""
        _, _, rows = np.linalg.svd(point.by)
        return np.asarray(rows[self.n :], dtype=float)


def newton_step(matrix: Array, right: Array) -> Array:
    """Solution of a linear system; raises `Lost` if it has none, or more than one."""
    try:
        return np.asarray(np.linalg.solve(matrix, right), dtype=float)
    except np.linalg.LinAlgError:
        raise Lost("Newton's method does not converge: its matrix is singular") from None


def default_scale(p: Parameters, name: str) -> float:
    """Change of a parameter that counts as much as the static deflection itself: its value, or part of a usual one."""
    usual = {
        "Omega": 20.0,
        "N": 300.0,
        "D_star": 1e-5,
        "c": 0.5,
        "c_p": 0.5,
        "k": 5e4,
        "k_p": 2e4,
        "E": 1.5e11,
        "m": 0.1,
    }
    return max(abs(float(getattr(p, name))), 0.2 * usual[name])
