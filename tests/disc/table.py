"""The modes of a case as the table of a disc."""

import numpy as np

from disc_model import Disc, Parameters
from disc_model.disc.files.table import table_text
from disc_model.disc.flexibility import residual_flexibility
from disc_model.disc.plate import damping_ratios, mode_arrays, tangential_amplitudes


def disc_table(p: Parameters) -> str:
    """The modes of a case as a table, with enough digits for `read_disc` to restore each number
    exactly."""
    if p.disc is not None:
        return table_text(p.disc)
    modes = mode_arrays(p)
    if p.friction_offset:
        tangential = tangential_amplitudes(p)
    else:
        tangential = np.zeros(0)
    return table_text(
        Disc(
            diameters=modes.diameters.tolist(), circles=modes.circles.tolist(), omega=modes.omega.tolist(),
            amplitude=modes.psi.tolist(), damping_ratio=damping_ratios(p).tolist(), tangential=tangential.tolist(),
            static_compliance=residual_flexibility(p).total,
        )
    )  # fmt: skip
