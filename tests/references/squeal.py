"""Complex eigenvalues of steady sliding as brake engineers look at them: largest growth first."""

import numpy as np

from tests.references.growth import steady_eigenvalues


class Squeal:
    """A case by the names of `Parameters`, and its modes: frequency omega (rad/s), amplitudes psi and
    t under the slider (1/sqrt(kg)), nodal diameters l, damping d = 2 xi omega (1/s)."""

    def __init__(self, p, omega, psi, l, d, t):
        self.modes = (p.model_dump(), omega, psi, l, d, t)

    def eigenvalues(self):
        """All eigenvalues (1/s) of the matrix of `growth.SteadySliding`, largest real part first."""
        values, _ = steady_eigenvalues(*self.modes)
        return values[np.argsort(-values.real)]
