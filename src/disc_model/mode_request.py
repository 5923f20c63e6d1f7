"""Requests for the number of modes of a case, in study files and on the command line; `mode_choice`
meets them.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from disc_model.errors import Fault, ParameterError, raise_faults
from disc_model.parameters import AUTO, CHOOSING, Parameters
from disc_model.units import Finite, Strict, Unit

FREQUENCIES = "frequencies"  # the quantity by which modes are chosen by default
SLIDING_GROWTH = "sliding_growth"  # the growth rate of steady sliding
# quantities by which modes may be chosen, and their default relative tolerances
CHOSEN_BY = {FREQUENCIES: 1e-3, "growth": 1e-2, SLIDING_GROWTH: 1e-2, "first_separation": 1e-2}
# Least tolerance, relative: the coupled frequencies of `mode_choice.RICH` change as much with more modes (5e-5
# as published, 2e-4 orthonormal, against 30 diameters and 8 circles), and growth rates and times
# depend on the frequencies.
TRUSTED = 1e-4
_PREFIX = "truncation_"  # begins the names of `CHOOSING`, beside the parameters of a case


class ModeRequest(Strict):
    """Quantity and tolerance for the choice of the number of modes, and the highest frequency of growing
    modes that are judged, Hz; `CHOSEN_BY` has the default tolerances."""

    quantity: Literal[*CHOSEN_BY] = FREQUENCIES  # type: ignore[valid-type]
    tolerance: Annotated[Finite, Field(ge=TRUSTED)] = CHOSEN_BY[FREQUENCIES]
    highest_frequency: Annotated[Finite, Field(gt=0), Unit("Hz")] | None = None

    @model_validator(mode="before")
    @classmethod
    def _with_tolerance(cls, values: dict[str, Any]) -> dict[str, Any]:
        tolerance = CHOSEN_BY.get(str(values.get("quantity")), CHOSEN_BY[FREQUENCIES])
        return {"tolerance": tolerance, **values}

    @model_validator(mode="after")
    def _of_sliding(self) -> Self:
        """A highest frequency is that of modes of steady sliding."""
        if self.highest_frequency is not None and self.quantity != SLIDING_GROWTH:
            rule = f"is used with quantity={SLIDING_GROWTH!r} only"
            raise_faults([Fault.of(("highest_frequency",), self.highest_frequency, rule)])
        return self

    @property
    def given(self) -> dict[str, Any]:
        """The request as `read_asked` reads it; the default quantity is left out."""
        given = {"n_diameters": AUTO, "truncation_tolerance": self.tolerance}
        if self.quantity != FREQUENCIES:
            given["truncation_quantity"] = self.quantity
        return given


def read_asked(values: Mapping[str, Any]) -> tuple[Parameters, ModeRequest | None]:
    """Parameters of a file, and the request for their modes; their own number is then
    meaningless."""
    rest, request = asked_modes(values)
    if request is not None:
        rest["n_circles"] = 0
    return Parameters.model_validate(rest), request


def asked_modes(values: Mapping[str, Any]) -> tuple[dict[str, Any], ModeRequest | None]:
    """Values without those of `CHOOSING`, and the request that these make."""
    rest = {name: value for name, value in values.items() if name not in CHOOSING}
    stated = {name.removeprefix(_PREFIX): values[name] for name in CHOOSING if name in values}
    if rest.get("n_diameters") != AUTO:
        rule = f"is used with n_diameters={AUTO!r} only"
        raise_faults([Fault.of((_PREFIX + name,), value, rule) for name, value in stated.items()])
        return rest, None
    del rest["n_diameters"]
    try:
        return rest, ModeRequest(**stated)
    except ParameterError as error:
        faults = (
            Fault((_PREFIX + fault.path[0],), fault.value, fault.rule) for fault in error.faults
        )
        raise ParameterError(*faults) from None
