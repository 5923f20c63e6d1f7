"""A wheel and a bronze disc as discs of the model: shapes, frequencies, damping (B, C, D)."""

import math

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


def peaks() -> pd.DataFrame:
    """Return what was read at the wheel's planned peaks, by numbers of nodal diameters; B is in its
    columns of errors."""
    table = read("wheel.csv")
    planned = table["peak"].str.isdigit()
    return table[planned & (table["amplitudes"] == "read")].set_index("diameters")


def bodies() -> dict[str, dict[int, float]]:
    """Return the measured natural frequencies of both bodies, Hz, by nodal diameters."""
    return {"wheel": peaks()["frequency_Hz"].to_dict(), "bronze disc": BRONZE}


def frequencies() -> list[Comparison]:
    """Return C: natural frequencies of uniform plates with a thickness fitted to the lowest."""
    found = []
    for body, measured in bodies().items():
        p = plate(body, measured[2], max(measured))
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


def plate(body: str, lowest: float, diameters: int) -> dm.Parameters:
    """Return a uniform plate whose mode with two nodal diameters has a given frequency (Hz)."""
    known = PLATES[body]
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
    table = peaks()[["frequency_Hz", "damping_ratio"]]
    lowest = table.loc[2]
    start = plate("wheel", lowest["frequency_Hz"], 5).replace(D_star=1.0)
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
