"""Cases on which several tests agree: a block on a rigid disc, and a disc of steel."""

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
STEEL = Parameters(
    N=5000, Omega=60, E=210e9, rho=7850, nu=0.3, h=6e-3, m=0.3, k=5e5, k_p=2e5, mu_s=0.45, mu_k=0.35,
    damping_ratio=5e-4, normalization="orthonormal", friction_offset="surface",
)  # fmt: skip
"""Under a pad, growth of its steady sliding converges with the number of modes."""
