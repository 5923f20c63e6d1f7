"""Eigenvalues of steady sliding from the equations as they stand, nothing eliminated by hand; only
numpy.

The unknowns are the rates of all coordinates and the forces V, R and T; the equations of motion, of
contact and of friction stand in two matrices, left @ unknowns = right @ coordinates, linear about
the state in which the slider rests in space.  There the modes rest in the slider's frame too, so
that they follow from the forces by one linear system.
"""

import numpy as np


def steady_eigenvalues(values, omega, psi, l, damping, tangential):
    """Eigenvalues (1/s), and V, R, T (N); ``damping`` is 2 xi omega, ``tangential`` the surface's
    amplitude of modes.

    values : by the names of `Parameters`; the contact is rigid if ``contact_compliance`` is 0
    """
    N, Omega, m, k, c, k_p, c_p, mu, r_0 = (
        float(values[name]) for name in ("N", "Omega", "m", "k", "c", "k_p", "c_p", "mu_k", "r_0")
    )
    decay = float(values.get("friction_decay", np.inf))
    falling = 0.0
    if np.isfinite(decay):
        above = (float(values["mu_s"]) - mu) / (1 + decay * r_0 * Omega)
        mu = mu + above
        falling = -above * decay * r_0 / (1 + decay * r_0 * Omega)
    C = float(values.get("contact_compliance", 0))
    lean = values.get("contact_force") == "normal"
    omega, psi, l, d, t = (np.asarray(x, float) for x in (omega, psi, l, damping, tangential))
    n = len(omega)
    O = np.zeros((len(omega),) * 2)
    I = np.eye(len(omega))
    turn = np.diag(l * Omega)
    spring = np.diag(omega**2)
    damp = np.diag(d)
    # rates of a, b, alpha, beta without forces, at the constant speed Omega
    modal = np.block(
        [[O, turn, I, O], [-turn, O, O, I], [-spring, O, -damp, turn], [O, -spring, -turn, -damp]]
    )
    zero = np.zeros(n)
    pair = np.repeat([l > 0], 4, axis=0) | np.array([[True], [False], [True], [False]])
    present = np.flatnonzero(pair.ravel())

    def resting(V, T):
        """All coordinates of the modes under these forces."""
        rest = np.zeros(4 * n)
        load = np.concatenate([zero, zero, -psi * V, t * T])[present]
        rest[present] = np.linalg.solve(modal[np.ix_(present, present)], -load)
        return rest

    # V = N + k (w - C V - u_0) by secants, V being almost linear in itself; friction works on the
    # slope
    u_0 = -N * np.sum(psi**2 / omega**2) - C * N
    V = N
    R = N
    for _ in range(20):
        shapes = [(V * step, resting(V * step, mu * R * step)) for step in (1, 1.01)]
        residual, further = (N + k * (psi @ x[:n] - C * force - u_0) - force for force, x in shapes)
        V = V - residual * 0.01 * V / (further - residual)
        slope = np.sum(l * psi * shapes[0][1][n : 2 * n]) / r_0
        R = V
        if lean:
            R = V / (1 - mu * slope)
    T = mu * R
    q = resting(V, T)
    a, b, alpha, beta = q.reshape(4, n)
    B = np.sum(l * psi * b)

    # coordinates a, b, alpha, beta, psi, f, (u, v); unknowns: their rates, V, R, T
    scalars = 2
    if C:
        scalars = 4
    size = 4 * n + scalars
    psi_row = 4 * n
    f_row = 4 * n + 1
    u_row = 4 * n + 2
    v_row = 4 * n + 3
    vertical = size
    normal = size + 1
    tangent = size + 2
    left = np.eye(size + 3)
    right = np.zeros((size + 3, size))
    right[: 4 * n, : 4 * n] = modal
    turned = [l * b, -l * a, l * beta, -l * alpha]
    right[: 4 * n, f_row] = np.concatenate(turned)
    left[2 * n : 3 * n, vertical] = psi
    left[3 * n : 4 * n, tangent] = -t
    right[psi_row, f_row] = -1
    # m r_0 f' = r_0 F - T (- R B / r_0)
    pull = np.zeros(size)
    pull[psi_row] = k_p
    pull[f_row] = -c_p
    steep = np.zeros(size)
    steep[n : 2 * n] = l * psi
    left[f_row, f_row] = m * r_0
    left[f_row, tangent] = 1
    right[f_row] = r_0 * pull
    if lean:
        left[f_row, normal] = B / r_0
        right[f_row] -= R * steep / r_0
    height = np.zeros(size)
    climb = np.zeros(size)
    if C:
        right[u_row, v_row] = left[v_row, vertical] = 1
        height[u_row] = climb[v_row] = 1
        left[v_row, v_row] = m
        left[v_row, vertical] = -1
        right[v_row] = -k * height - c * climb
        left[vertical, vertical] = C
        right[vertical, :n] = psi
        right[vertical, u_row] = -1
    else:
        height[:n] = psi
        # u' = w' = sum psi a', and m u'' = V - N - k (u - u_0) - c u'
        climb[: 4 * n] = np.concatenate([psi, zero, zero, zero]) @ modal
        climb[f_row] = B
        left[vertical] = 0
        left[vertical, :size] = m * climb
        left[vertical, vertical] = -1
        right[vertical] = -k * height - c * climb
    # R = V (+ T B / r_0), T = mu R, where mu may fall with the speed r_0 f
    left[normal, vertical] = -1
    if lean:
        left[normal, tangent] = -B / r_0
        right[normal] = T * steep / r_0
    left[tangent, normal] = -mu
    right[tangent, f_row] = falling * R
    kept = np.append(present, np.arange(4 * n, size))
    rates = np.linalg.solve(left, right)[np.ix_(kept, kept)]
    return np.linalg.eigvals(rates), (V, R, T)


def couple(offset, psi, l, r_0):
    """Tangential amplitudes of modes at a surface ``offset`` (m) from the middle plane."""
    return -offset / r_0 * np.asarray(l) * np.asarray(psi)
