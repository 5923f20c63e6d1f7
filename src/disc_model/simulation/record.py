"""What a simulation keeps: events, uniform samples in windows, Poincare samples, energy audits."""

from __future__ import annotations

import math
from typing import Annotated, Self

from pydantic import Field, model_validator

from disc_model.errors import Fault, ParameterError
from disc_model.schema import Checked, Real, shown

Time = Annotated[Real, Field(ge=0, allow_inf_nan=False)]


class Window(Checked):
    """Uniform samples at ``rate`` in [start, stop].

    What jumps at a switch (phase and P; velocities of slider and disc at an impact) is at that very instant what it was
    before.  So it is 6e-14 of the time later, because the time of a switch is rounded.  A sample at the start of a run
    shows the state from which the run starts.

    Parameters
    ----------
    start, stop : s, absolute times
    rate : Hz
    theta : rad, angle of the point fixed to the disc at radius r_0 where ``w_point`` is taken
    envelope : if given, the least and the greatest of each ``envelope`` successive samples are kept instead of them;
        samples that do not fill a bin are left out
    """

    start: Time
    stop: Time
    rate: Annotated[Real, Field(gt=0, allow_inf_nan=False)]
    theta: Annotated[Real, Field(allow_inf_nan=False)] = 1.0
    envelope: Annotated[int, Field(ge=2)] | None = None

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if not self.start < self.stop:
            raise ParameterError(Fault(("start",), shown(self.start), f"must be < stop={shown(self.stop)}"))
        return self

    @property
    def count(self) -> int:
        """Number of samples before any folding."""
        return int(math.floor((self.stop - self.start) * self.rate * (1 + 1e-15) + 1e-9)) + 1


class Poincare(Checked):
    """Samples at the drive's period, t = i 2 pi/Omega (i whole), within [start, stop]; ``theta`` as in `Window`."""

    start: Time = 0.0
    stop: Annotated[Real, Field(gt=0)] = math.inf
    theta: Annotated[Real, Field(allow_inf_nan=False)] = 1.0

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if not self.start < self.stop:
            raise ParameterError(Fault(("start",), shown(self.start), f"must be < stop={shown(self.stop)}"))
        return self


class Record(Checked):
    """What a simulation keeps; by default the events and the statistics alone.

    Parameters
    ----------
    windows : uniform samples
    poincare : samples at the drive's period
    events : whether to keep the table of events (they are counted in any case)
    energy : audit both energy balances on every step instead of every 64th (costs a factor of about ten in time)
    """

    windows: tuple[Window, ...] = ()
    poincare: Poincare | None = None
    events: bool = True
    energy: bool = False
