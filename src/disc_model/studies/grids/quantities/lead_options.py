"""What a study file may say about where a motion starts."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import create_model, field_validator

from disc_model.parameters import Parameters
from disc_model.studies.faults import Strict
from disc_model.studies.grids.quantities.options import Positive, Tolerance

_OPTIONAL: dict[str, Any] = {
    name: (Annotated[field.annotation, field], None) for name, field in Parameters.model_fields.items()
}
_Some = create_model("_Some", __base__=Parameters, **_OPTIONAL)
"""Parameters of which any may be left out; rules between several are checked if all of them are there."""


class Preparation(Strict):
    """Another case, and how long it is simulated from the published start: its last state is where the point starts.

    parameters : those that differ from the point's
    time : s
    """

    parameters: dict[str, Any]
    time: Positive

    @field_validator("parameters")
    @classmethod
    def _checked(cls, given: dict[str, Any]) -> dict[str, Any]:
        """As `Parameters` understands them: floats, whole numbers, words."""
        if given.get("n_diameters") == "auto":
            raise ValueError("n_diameters='auto': must be a whole number, that of the points")
        checked = _Some(**given)
        return {name: getattr(checked, name) for name in given}


class Lead(Strict):
    """Where a motion starts.

    prepare : after another motion, such as one that has separated; the published start if not given
    """

    prepare: Preparation | None = None
    tol: Tolerance = 1e-10
