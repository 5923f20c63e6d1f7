"""A wheel and a bronze disc as discs of the model: shapes, frequencies, damping (B, C, D)."""

import math
from typing import NamedTuple

import pandas as pd
from docs.measurements.comparison import Comparison, read, within

import disc_model as dm

SHAPES = 0.1
"""Greatest root mean square difference of a shape."""
FREQUENCIES = 0.05
"""Tolerance of natural frequencies, relative."""
DAMPING = 0.25
"""Tolerance of damping ratios, relative."""
BRONZE = {2: 299.125, 3: 712.0, 4: 1320.0}
"""Natural frequencies of the bronze disc, Hz, by nodal diameters. They are copied by hand from
EXPERIMENT_HZ in src/eigenfrequencies/validation/testcase/laval.py of
github.com/RentschlerTobias/eigenfrequencies at 595baeb39f2f316c6ddeaa100ec00704d39e7a4a."""
PLATES = {
    "wheel": {"E": 210e9, "nu": 0.3, "rho": 7850.0, "b": 0.3, "a": 0.003, "r_0": 0.25},
    "bronze disc": {"E": 75.854e9, "nu": 0.34, "rho": 8910.0, "b": 0.1, "a": 0.001, "r_0": 0.09},
}
"""Plates that stand for both. The clamp is a hundredth of the radius, which changes modes with two or
more nodal diameters by less than a millionth. The ratios of frequencies depend on nu alone, which is
stated for the bronze disc and assumed for the wheel; E, rho and b of the wheel, which are not known,
and its thickness only set their scale."""
POISSON = (0.25, 0.35)
"""Other Poisson's ratios for which the wheel is computed, which was not planned."""


class Shape(NamedTuple):
    """Errors of a mode's shape on the rim.

    Parameters
    ----------
    mode : numbers of nodal diameters in words
    real : of the real parts of the amplitudes read at the peak
    complex : of the complex amplitudes read there
    other : least error of the real parts with another number of diameters
    """

    mode: str
    real: float
    complex: float
    other: float


def peaks(amplitudes: str) -> pd.DataFrame:
    """Return what was found of the wheel's planned modes, by numbers of nodal diameters.

    Parameters
    ----------
    amplitudes : "read" at the peak, "1 fitted" or "2 fitted"
    """
    table = read("wheel.csv")
    planned = table["peak"].str.isdigit()
    return table[planned & (table["amplitudes"] == amplitudes)].set_index("diameters")


def shapes() -> list[Shape]:
    """Return B: root mean square differences of measured shapes on the rim from the model's."""
    found = []
    for diameters, row in peaks("read").iterrows():
        errors = Shape(
            mode=f"{diameters} nodal diameters",
            real=row["error_real"],
            complex=row["error_complex"],
            other=row["error_other"],
        )
        found.append(errors)
    return found


def bodies() -> dict[str, dict[int, float]]:
    """Return the measured natural frequencies of both bodies, Hz, by nodal diameters."""
    return {"wheel": peaks("read")["frequency_Hz"].to_dict(), "bronze disc": BRONZE}


def frequencies(nu: float = PLATES["wheel"]["nu"]) -> list[Comparison]:
    """Return C: natural frequencies of uniform plates with a thickness fitted to the lowest.

    Parameters
    ----------
    nu : Poisson's ratio that is assumed for the wheel; that of the bronze disc is stated
    """
    found = []
    for body, measured in bodies().items():
        ratio = nu if body == "wheel" else PLATES[body]["nu"]
        p = plate(body, measured[2], max(measured), ratio)
        modes = dm.plate_modes(p).set_index("diameters")["omega"]
        for diameters in sorted(measured)[1:]:
            value = measured[diameters]
            expected = modes[diameters] / math.tau
            agrees = within(value, expected, FREQUENCIES)
            what = f"{body}, {diameters} nodal diameters"
            found.append(Comparison(what, value, expected, "Hz", agrees))
    return found


def squares() -> list[float]:
    """Return predicted over measured frequencies, in the order of `frequencies`, if they rise with
    the square of the number of nodal diameters."""
    found = []
    for measured in bodies().values():
        for diameters in sorted(measured)[1:]:
            found.append(measured[2] * (diameters / 2) ** 2 / measured[diameters])
    return found


def plate(body: str, lowest: float, diameters: int, nu: float) -> dm.Parameters:
    """Return a uniform plate whose mode with two nodal diameters has a given frequency (Hz)."""
    known = dict(PLATES[body])
    known["nu"] = nu
    start = dm.Parameters(
        N=0,
        Omega=0,
        h=0.04 * known["b"],
        n_diameters=diameters,
        normalization="orthonormal",
        **known,
    )
    return fitted(start, "h", "frequency_2_0", lowest, 0.1)


def fitted(
    start: dm.Parameters, name: str, quantity: str, value: float, uncertainty: float
) -> dm.Parameters:
    """Return a case with one parameter fitted to one measured value."""
    measured = [{"quantity": quantity, "value": value, "uncertainty": uncertainty}]
    result = dm.fit(start, [name], measured)
    return start.replace(**result.params.valuesdict())


def damping() -> list[Comparison]:
    """Return D: damping ratios of the wheel by each of the two laws, set by the lowest mode."""
    table = peaks("read")[["frequency_Hz", "damping_ratio"]]
    lowest = table.loc[2]
    start = plate("wheel", lowest["frequency_Hz"], 5, PLATES["wheel"]["nu"]).replace(D_star=1.0)
    damped = fitted(start, "D_star", "damping_ratio_2_0", lowest["damping_ratio"], 1e-5)
    found = []
    for diameters, row in table.iterrows():
        if diameters == 2:
            continue
        value = row["damping_ratio"]
        # D_star damps a mode in proportion to its frequency, here the measured one
        rising = damped.D_star / (2 * start.D) * math.tau * row["frequency_Hz"]
        for law, expected in (("D_star", rising), ("damping_ratio", lowest["damping_ratio"])):
            agrees = within(value, expected, DAMPING)
            what = f"{diameters} nodal diameters, by {law}"
            found.append(Comparison(what, value, float(expected), "", agrees))
    return found
