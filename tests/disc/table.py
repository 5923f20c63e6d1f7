"""The modes of a case as a disc of its own."""

from disc_model import Disc, Parameters
from disc_model.disc.flexibility import residual_flexibility
from disc_model.disc.plate import modal_damping, mode_arrays, tangential_amplitudes


def disc_of(p: Parameters) -> Disc:
    """The modes of the plate of a case."""
    modes = mode_arrays(p)
    damping_ratios = modal_damping(p) / (2 * modes.omega)
    return Disc(
        diameters=modes.diameters.tolist(), circles=modes.circles.tolist(), omega=modes.omega.tolist(),
        amplitude=modes.psi.tolist(), damping_ratio=damping_ratios.tolist(),
        tangential=tangential_amplitudes(p).tolist() if p.friction_offset else (),
        static_compliance=residual_flexibility(p).total,
    )  # fmt: skip
