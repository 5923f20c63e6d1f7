"""Where a motion starts, as files say it: from the static equilibrium, after another motion, with a kick."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import Field, create_model, field_validator

from disc_model.errors import Fault, ParameterError
from disc_model.parameters import Parameters
from disc_model.schema import Finite, Positive, Strict

START = "start"
"""The axis of a grid along which motions start in different ways, by name."""
Coordinate = Literal["u", "u_velocity", "f"]

_OPTIONAL: dict[str, Any] = {
    name: (Annotated[field.annotation, field], None) for name, field in Parameters.model_fields.items()
}
SomeParameters = create_model("SomeParameters", __base__=Parameters, **_OPTIONAL)
"""Parameters of which any may be left out; rules between several are checked if all of them are there."""


class Preparation(Strict):
    """Another case, and how long it is simulated from the published start: its last state is where the motion starts.

    parameters : those that differ from the motion's own
    time : s
    """

    parameters: dict[str, Any]
    time: Positive

    @field_validator("parameters")
    @classmethod
    def _checked(cls, given: dict[str, Any]) -> dict[str, Any]:
        """As `Parameters` understands them: floats, whole numbers, words."""
        if given.get("n_diameters") == "auto":
            raise ParameterError(Fault(("n_diameters",), "'auto'", "must be a whole number, that of the points"))
        checked = SomeParameters(**given)
        return {name: getattr(checked, name) for name in given}


class Start(Strict):
    """Where a motion starts; the published start if nothing is given.

    prepare : after another motion, such as one that has separated
    kick : what is added to a coordinate: ``u`` (m) and ``u_velocity`` (m/s) of the slider and of the disc under it,
        ``f`` (rad/s), the slider's angular velocity
    """

    prepare: Preparation | None = None
    kick: dict[Coordinate, Finite] = Field({})

    def kicked(self, more: dict[str, float]) -> Self:
        """With further kicks added to its own."""
        kick = {name: self.kick.get(name, 0.0) + more.get(name, 0.0) for name in {*self.kick, *more}}  # type: ignore[call-overload]
        return self.model_copy(update={"kick": kick})
