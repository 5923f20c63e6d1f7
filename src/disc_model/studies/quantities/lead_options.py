"""What a study file may say about where a motion starts."""

from __future__ import annotations

from disc_model.studies.axes import Finite
from disc_model.studies.faults import Strict
from disc_model.studies.quantities.options import Positive, Tolerance


class Preparation(Strict):
    """Another case, and how long it is simulated from the published start: its last state is where the point starts.

    parameters : those that differ from the point's
    time : s
    """

    parameters: dict[str, Finite]
    time: Positive


class Lead(Strict):
    """Where a motion starts.

    prepare : after another motion, such as one that has separated; the published start if not given
    """

    prepare: Preparation | None = None
    tol: Tolerance = 1e-10
