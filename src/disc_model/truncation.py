"""How many modes a case needs: the fewest whose coupled frequencies meet a tolerance.

With ``contact_compliance="residual"`` every candidate has the flexibility of the modes that it leaves out, and so has
the model compared with.

Study files and the command line may say ``n_diameters: auto``; `read_parameters` makes `Parameters` of that.
`disc_model.benchmarks.truncation` measures what the choice does to everything else.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from disc_model.errors import DiscModelError, Fault, ParameterError
from disc_model.flexibility import contact_give
from disc_model.parameters import Parameters
from disc_model.plate import coupled_frequencies, mode_arrays
from disc_model.schema import is_number, number, shown

AUTO = "auto"
"""What a file gives as ``n_diameters`` to have the modes chosen."""
TOLERANCE = 1e-3
"""Relative; taken where none is given."""
RICH = (20, 6)
"""Diameters and circles of the model that frequencies are compared with."""
TRUSTED = 1e-4
"""Relative; how much the coupled frequencies of `RICH` change with still more modes (5e-5 as published, 2e-4
orthonormal, against 30 diameters and 8 circles).  A tighter tolerance would be met in appearance only."""
BAND = 2.0
"""Frequencies up to so many times the lowest one of the disc are what a study of this motion asks for."""


@dataclass(frozen=True)
class ModeChoice:
    """The smallest model that meets a tolerance, and what it was chosen from.

    Attributes
    ----------
    parameters : with n_diameters and n_circles chosen
    tolerance, error : asked for and reached, relative, of the coupled frequencies in the band
    modes : number of real modes
    rich : (diameters, circles) of the model compared with
    band : see `frequency_error`
    """

    parameters: Parameters
    tolerance: float
    error: float
    modes: int
    rich: tuple[int, int]
    band: float

    def to_json(self) -> str:
        """The choice as text, to be kept beside the results (a dataset's attribute)."""
        chosen = {"n_diameters": self.parameters.n_diameters, "n_circles": self.parameters.n_circles}
        record = {"tolerance": self.tolerance, "error": self.error, "modes": self.modes, "band": self.band}
        return json.dumps(chosen | record | {"compared_with": list(self.rich)}, sort_keys=True)


def choose_modes(
    case: Parameters | Mapping[str, Any],
    tolerance: float = TOLERANCE,
    *,
    band: float = BAND,
    rich: tuple[int, int] = RICH,
) -> ModeChoice:
    """Find the model with the fewest real modes whose coupled frequencies in the band are right to ``tolerance``.

        >>> disc_model.choose_modes({"N": 385, "Omega": 15.1}, 1e-3).parameters.n_diameters
        3

    Parameters
    ----------
    case : `Parameters`, or values to make them of; their n_diameters and n_circles are ignored
    tolerance : relative, at least `TRUSTED`
    band : the frequencies asked for reach up to ``band`` times the lowest one of the disc
    rich : highest diameters and circles of the model taken as right, and the largest candidate

    Raises
    ------
    ParameterError
        If a value of the case breaks a rule, the tolerance is below `TRUSTED`, the band not above 0, or ``rich`` no
        pair of whole numbers.
    DiscModelError
        If no smaller model meets the tolerance.
    """
    tolerance, faults = _checked("tolerance", tolerance)
    if not (is_number(band) and 0 < band < math.inf):
        faults.append(Fault(("band",), shown(band), "must be finite and > 0"))
    if not (isinstance(rich, tuple | list) and len(rich) == 2 and all(isinstance(n, int) and n >= 0 for n in rich)):
        faults.append(Fault(("rich",), shown(rich), "must be two whole numbers >= 0, of diameters and circles"))
    given: object = case
    if not isinstance(given, Parameters | Mapping):
        faults.append(Fault(("case",), shown(case), "must be Parameters, or a mapping of names to values"))
    if faults:
        raise ParameterError(*faults)
    size = {"n_diameters": rich[0], "n_circles": rich[1]}
    p = case.replace(**size) if isinstance(case, Parameters) else Parameters.model_validate({**case, **size})
    modes = mode_arrays(p)
    right, top = _frequencies(p), band * float(modes.omega.min())
    candidates = sorted((real_modes(d, c), c, d) for d in range(rich[0] + 1) for c in range(rich[1] + 1))
    for count, circles, diameters in candidates[:-1]:
        kept = (modes.circles <= circles) & (modes.diameters <= diameters)
        chosen = p.replace(n_diameters=diameters, n_circles=circles)
        mine = coupled_frequencies(modes.omega[kept], modes.psi[kept], p.m, p.k, contact_give(chosen))
        error = _worst(mine, right, top)
        if error <= tolerance:
            return ModeChoice(chosen, tolerance, error, count, rich, band)
    raise DiscModelError(f"tolerance={tolerance:g}: no model up to {rich} (diameters, circles) meets it; enlarge rich")


def read_parameters(values: Mapping[str, Any]) -> tuple[Parameters, str]:
    """Parameters as files and command lines give them, and how their modes were chosen, as JSON.

    With ``n_diameters="auto"`` the modes are chosen by ``truncation_tolerance`` (`TOLERANCE` if not given). The text is
    empty where the number of modes is given.

    Raises
    ------
    ParameterError
        Listing every fault.
    DiscModelError
        If no model meets the tolerance.
    """
    rest, tolerance, faults = asked_modes(values)
    if tolerance is None:
        return _with_faults(rest, faults), ""
    choice = choose_modes(_with_faults({**rest, "n_circles": 0}, faults), tolerance)
    return choice.parameters, choice.to_json()


def asked_modes(values: Mapping[str, Any]) -> tuple[dict[str, Any], float | None, list[str]]:
    """What files and command lines say of the choice of modes.

    Returns
    -------
    values : without what asks for a choice
    tolerance : by which to choose; None if the number of modes is given, or the tolerance is none
    faults : in what asks for a choice
    """
    rest = {name: value for name, value in values.items() if name != "truncation_tolerance"}
    given = values.get("truncation_tolerance", TOLERANCE)
    if rest.get("n_diameters") != AUTO:
        if "truncation_tolerance" not in values:
            return rest, None, []
        return rest, None, [Fault(("truncation_tolerance",), shown(given), f"is used with n_diameters={AUTO!r} only")]
    del rest["n_diameters"]
    tolerance, faults = _checked("truncation_tolerance", given)
    return rest, None if faults else tolerance, faults


def _checked(name: str, value: Any) -> tuple[float, list[str]]:
    """A tolerance as a number, and what is wrong with it."""
    try:
        tolerance = float(number(value))
    except ValueError:
        return math.nan, [Fault((name,), shown(value), "must be a number")]
    if not TRUSTED <= tolerance < math.inf:
        return math.nan, [Fault((name,), shown(tolerance), f"must be finite and >= {TRUSTED:g}")]
    return tolerance, []


def _with_faults(values: Mapping[str, Any], faults: list[str]) -> Parameters:
    """Parameters, unless there are faults, found before or now."""
    try:
        p = Parameters.model_validate(values)
    except ParameterError as error:
        raise ParameterError(*error.faults, *faults) from None
    if faults:
        raise ParameterError(*faults)
    return p


def frequency_error(p: Parameters, rich: Parameters, band: float = BAND) -> float:
    """Largest relative error of the coupled frequencies of ``p`` within the band, ``rich`` taken as right.

    The band reaches up to ``band`` times the disc's lowest frequency.  A frequency of ``rich`` that ``p`` lacks counts
    as an error of 1.
    """
    return _worst(_frequencies(p), _frequencies(rich), band * float(mode_arrays(rich).omega.min()))


def _frequencies(p: Parameters) -> np.ndarray:
    """Coupled frequencies of a case under its own law of contact, rad/s."""
    modes = mode_arrays(p)
    return coupled_frequencies(modes.omega, modes.psi, p.m, p.k, contact_give(p))


def _worst(mine: np.ndarray, right: np.ndarray, top: float) -> float:
    right = right[right <= top]
    if mine.size < right.size:
        return 1.0
    return min(1.0, float(np.max(np.abs(mine[: right.size] / right - 1.0), initial=0.0)))


def real_modes(diameters: int, circles: int) -> int:
    """Number of real modes of a model: pairs count as two."""
    return (circles + 1) * (2 * diameters + 1)
