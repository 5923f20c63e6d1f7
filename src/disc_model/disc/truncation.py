"""Choice of the number of modes: requests for it, and the fewest modes whose coupled frequencies meet a tolerance.

Study files and the command line may give ``n_diameters: auto``, which `read_asked` reads.  `disc_model.mode_choice`
chooses by quantities of the motion, with simulations.  `disc_model.benchmarks.truncation` measures the effect of the
number of modes on all results.
"""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator

from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import coupled_frequencies, mode_arrays
from disc_model.errors import DiscModelError, Fault, ParameterError, raise_faults
from disc_model.parameters import AUTO, CHOOSING, Disc, Parameters
from disc_model.units import Finite, Strict

FREQUENCIES = "frequencies"
"""The quantity by which modes are chosen by default."""
CHOSEN_BY = {FREQUENCIES: 1e-3, "growth": 1e-2, "first_separation": 1e-2, "separation_rate": 1e-1}
"""Quantities by which modes may be chosen, and their default relative tolerances."""
RICH = (20, 6)
"""Diameters and circles of the reference model for frequencies."""
TRUSTED = 1e-4
"""Least tolerance, relative: the coupled frequencies of `RICH` change as much with more modes (5e-5 as published, 2e-4
orthonormal, against 30 diameters and 8 circles).  A tighter tolerance would be met in appearance only, for any
quantity, because growth rates and times depend on the frequencies."""
_PREFIX = "truncation_"
"""Begins the names of `CHOOSING`, beside the parameters of a case."""
BAND = 2.0
"""Upper end of the band of compared frequencies, relative to the lowest frequency of the disc."""


@dataclass(frozen=True)
class ModeChoice:
    """The smallest model that meets a tolerance, and the basis of the choice.

    Attributes
    ----------
    parameters : the case with the chosen n_diameters and n_circles, or with the first modes of its table
    quantity : the quantity by which the modes were chosen
    tolerance, error : requested and reached, relative; of the coupled frequencies in the band, or of the quantity
    modes : number of real modes
    rich : (diameters, circles) of the largest model in the comparison; (modes,) for a table
    values : the quantity for each model computed, by size as in `rich`; empty if the modes were chosen by frequencies
    """

    parameters: Parameters
    tolerance: float
    error: float
    modes: int
    rich: tuple[int, ...]
    quantity: str = FREQUENCIES
    values: Mapping[tuple[int, ...], float] = field(default_factory=dict)

    def to_json(self) -> str:
        """The choice as JSON text, for an attribute of a dataset."""
        disc = self.parameters.disc
        size = {"n_diameters": self.parameters.n_diameters, "n_circles": self.parameters.n_circles}
        record: dict[str, Any] = {
            **(size if disc is None else {"modes_of_the_table": len(disc.omega)}),
            "tolerance": self.tolerance,
            "error": self.error,
            "modes": self.modes,
            "compared_with": list(self.rich),
        }
        if self.quantity == FREQUENCIES:
            record["band"] = BAND
        else:
            values = {",".join(map(str, size)): x if math.isfinite(x) else None for size, x in self.values.items()}
            record |= {"quantity": self.quantity, "values": values}
        return json.dumps(record, sort_keys=True)


class ModeRequest(Strict):
    """Quantity and tolerance for the choice of the number of modes; `CHOSEN_BY` has the default tolerances."""

    quantity: Literal[*CHOSEN_BY] = FREQUENCIES  # type: ignore[valid-type]
    tolerance: Annotated[Finite, Field(ge=TRUSTED)] = CHOSEN_BY[FREQUENCIES]

    @model_validator(mode="before")
    @classmethod
    def _with_tolerance(cls, values: dict[str, Any]) -> dict[str, Any]:
        return {"tolerance": CHOSEN_BY.get(str(values.get("quantity")), CHOSEN_BY[FREQUENCIES])} | values

    @property
    def given(self) -> dict[str, Any]:
        """The request as `read_asked` reads it; the default quantity is left out."""
        quantity = {} if self.quantity == FREQUENCIES else {"truncation_quantity": self.quantity}
        return {"n_diameters": AUTO, "truncation_tolerance": self.tolerance, **quantity}


def by_frequencies(p: Parameters, tolerance: float) -> ModeChoice:
    """Find the model with the fewest real modes whose `frequency_error` is within ``tolerance``.

    For a table the candidates are its first modes; the last one is the whole table.
    """
    sizes: Sequence[tuple[int, ...]]
    if p.disc is None:
        p = resized(p, RICH)
        every = product(range(RICH[0] + 1), range(RICH[1] + 1))
        sizes = sorted(every, key=lambda size: (count_modes(p, size), size[1]))[:-1]
    else:
        sizes = [(count,) for count in counts(p.disc)]
    modes, right = mode_arrays(p), coupled_frequencies(p, contact_compliance(p))
    top = BAND * float(modes.omega.min())
    for size in sizes:
        of_size = slice(*size) if p.disc is not None else (modes.diameters <= size[0]) & (modes.circles <= size[1])
        chosen = resized(p, size)
        error = _worst(coupled_frequencies(p, contact_compliance(chosen), of_size), right, top)
        if error <= tolerance:
            return ModeChoice(chosen, tolerance, error, count_modes(p, size), RICH if p.disc is None else sizes[-1])
    raise DiscModelError(
        f"tolerance={tolerance:g}: no model up to {RICH} (diameters, circles) meets it; enlarge the tolerance"
    )


def counts(disc: Disc) -> range:
    """Possible numbers of first modes of a table: at least one of these modes must move under the slider."""
    return range(1 + next(i for i, each in enumerate(disc.amplitude) if each), len(disc.omega) + 1)


def resized(p: Parameters, size: tuple[int, ...]) -> Parameters:
    """The case with the modes of a size: up to these diameters and circles, or so many first modes of its table."""
    if p.disc is not None:
        return p.replace(disc=p.disc.first(*size))
    return p.replace(n_diameters=size[0], n_circles=size[1])


def count_modes(p: Parameters, size: tuple[int, ...]) -> int:
    """Number of real modes of `resized`: pairs count as two."""
    return real_modes(*size) if p.disc is None else size[0] + sum(l > 0 for l in p.disc.diameters[: size[0]])


def read_asked(values: Mapping[str, Any]) -> tuple[Parameters, ModeRequest | None]:
    """Parameters from the values of a file or command line, and the request to choose their modes, if there is one.

    With ``n_diameters="auto"`` the modes are chosen by ``truncation_quantity`` (`FREQUENCIES` by default) and
    ``truncation_tolerance`` (that of `CHOSEN_BY` by default); the parameters' own number of modes is then meaningless.

    Raises
    ------
    ParameterError
        If a value breaks a rule; the message lists every fault.
    """
    rest, request, faults = asked_modes(values)
    if values.get("n_diameters") == AUTO:
        rest["n_circles"] = 0
    try:
        p = Parameters.model_validate(rest)
    except ParameterError as error:
        raise ParameterError(*error.faults, *faults) from None
    raise_faults(faults)
    return p, request


def asked_modes(values: Mapping[str, Any]) -> tuple[dict[str, Any], ModeRequest | None, list[str]]:
    """Split the values of a file or command line: values without the request for a choice of modes, request, faults.

    The request is None if the number of modes is given, or if there are faults.
    """
    rest = {name: value for name, value in values.items() if name not in CHOOSING}
    stated = {name.removeprefix(_PREFIX): values[name] for name in CHOOSING if name in values}
    if rest.get("n_diameters") != AUTO:
        rule = f"is used with n_diameters={AUTO!r} only"
        return rest, None, [Fault.of((_PREFIX + name,), value, rule) for name, value in stated.items()]
    del rest["n_diameters"]
    try:
        return rest, ModeRequest(**stated), []
    except ParameterError as error:
        return rest, None, [Fault((_PREFIX + fault.path[0],), fault.value, fault.rule) for fault in error.faults]


def frequency_error(p: Parameters, rich: Parameters) -> float:
    """Largest relative error of the coupled frequencies of ``p`` within the band, with ``rich`` as the reference.

    The band reaches up to `BAND` times the disc's lowest frequency.  A frequency of ``rich`` that is missing in ``p``
    counts as an error of 1.
    """
    mine, right = (coupled_frequencies(case, contact_compliance(case)) for case in (p, rich))
    return _worst(mine, right, BAND * float(mode_arrays(rich).omega.min()))


def _worst(mine: np.ndarray, right: np.ndarray, top: float) -> float:
    right = right[right <= top]
    if mine.size < right.size:
        return 1.0
    return min(1.0, float(np.max(np.abs(mine[: right.size] / right - 1.0), initial=0.0)))


def real_modes(diameters: int, circles: int) -> int:
    """Number of real modes of a model: pairs count as two."""
    return (circles + 1) * (2 * diameters + 1)
