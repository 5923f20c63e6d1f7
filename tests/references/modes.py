"""Disc modes to 17 digits, by mpmath: the numbers that every stored reference starts from.

Clamped-free annular Kirchhoff plate without nodal circles, R(r) = A J_l + B Y_l + C I_l + G K_l of beta r.
Written apart from `disc_model.plate` (extended precision, no scaling, one determinant) to judge it.
"""

from __future__ import annotations

import mpmath as mp


def _rows(diameters, beta, p):
    """The 4x4 matrix of clamping at a and vanishing moment and Kirchhoff shear at b."""
    n, nu, a, b = diameters, mp.mpf(p["nu"]), mp.mpf(p["a"]), mp.mpf(p["b"])

    def derivatives(shape, r):
        """Value and three derivatives in r; second and third from Bessel's equation."""
        x, ordinary = beta * r, shape in (mp.besselj, mp.bessely)
        y0 = shape(n, x)
        y1 = (-1 if shape is mp.besselk else 1) * shape(n - 1, x) - n / x * y0
        q = n**2 / x**2 - (1 if ordinary else -1)
        y2 = -y1 / x + q * y0
        y3 = -y2 / x + y1 / x**2 + q * y1 - 2 * n**2 / x**3 * y0
        return y0, beta * y1, beta**2 * y2, beta**3 * y3

    columns = []
    for shape in (mp.besselj, mp.bessely, mp.besseli, mp.besselk):
        r0, r1 = derivatives(shape, a)[:2]
        w0, w1, w2, w3 = derivatives(shape, b)
        moment = w2 + nu * (w1 / b - n**2 * w0 / b**2)
        laplacian_slope = w3 + w2 / b - w1 / b**2 - n**2 * (w1 / b**2 - 2 * w0 / b**3)
        shear = laplacian_slope - (1 - nu) * n**2 / b**2 * (w1 - w0 / b)
        columns.append([r0, r1, moment, shear])
    return mp.matrix(columns).T


def _scaled_determinant(rows):
    """Rows and columns scaled first: `mp.det` calls a badly scaled matrix singular and returns 0."""
    for i in range(4):
        rows[i, :] = rows[i, :] / mp.norm(rows[i, :], mp.inf)
    for j in range(4):
        rows[:, j] = rows[:, j] / mp.norm(rows[:, j], mp.inf)
    return mp.det(rows)


def modes_mpmath(p, n_diameters=4, digits=40):
    """omega (rad/s) and psi (psi_0 = Psi_0, psi_l = sqrt(2) Psi_l; as published) for l = 0..n_diameters.

    `p` maps the names of `stored.BASE` to floats, taken as exact. Returns two lists of mpf.
    """
    guess = [1491.927, 1516.757, 1823.881, 2774.194, 4383.044]
    with mp.workdps(digits):
        q = {name: mp.mpf(value) for name, value in p.items()}
        stiffness = q["E"] * q["h"] ** 3 / 12 / (1 - q["nu"] ** 2)
        scale = (q["rho"] * q["h"] / stiffness) ** mp.mpf("0.25")
        omega, psi = [], []
        for l in range(n_diameters + 1):
            start = scale * mp.sqrt(guess[l])
            beta = mp.findroot(
                lambda x, l=l: _scaled_determinant(_rows(l, x, p)),
                (start * 0.9999, start * 1.0001),
                solver="secant",
                tol=mp.mpf(10) ** (4 - 2 * digits),
                verify=False,
            )
            rows = _rows(l, beta, p)
            rest = mp.lu_solve(rows[:3, 1:], -rows[:3, 0])
            r = beta * q["r_0"]
            shape = (
                mp.besselj(l, r) + rest[0] * mp.bessely(l, r) + rest[1] * mp.besseli(l, r) + rest[2] * mp.besselk(l, r)
            )
            omega.append((beta / scale) ** 2)
            psi.append(abs(shape) * mp.sqrt(2 if l else 1) / mp.sqrt(q["rho"] * q["h"]) / q["b"])
    return omega, psi
