"""The block on a rigid disc on which several tests agree."""

from disc_model import Parameters

RIG = Parameters(
    n_diameters=-1,
    m=0.538,
    k=0,
    k_p=6957,
    c_p=5.946,
    N=10,
    mu_s=0.6,
    mu_k=0.2,
    friction_decay=10,
    r_0=0.1,
    Omega=2,
)
"""A published rig: between the Hopf point of steady sliding, 0.159 m/s, and the end of stick-slip,
0.2306 m/s, both are stable."""
